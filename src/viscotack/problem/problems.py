"""Whatever can be simulated: one pair of classes for each kind of indenter, SI and groups."""

from . import Groups, Problem
from .profile_problem import ProfileGroups, ProfileProblem
from .punch_problem import PunchGroups, PunchProblem

Case = Problem | Groups | PunchProblem | PunchGroups | ProfileProblem | ProfileGroups
