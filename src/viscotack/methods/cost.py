r"""Forecast of the processor time of a simulation, by a coarse run of at most 1.5 s.

The coarse run is made for errors of 8 %. Where it ends, the simulation takes about

.. math:: T = 0.62\, t\, n^{0.36}\, (\epsilon/\epsilon_0)^{-0.25}

of processor time, t being that of the coarse run, n the number of nodes at the deepest state and
epsilon the accuracy, 0.002 for epsilon_0 (67 drawn problems: within a factor of 1.4 in two of
three). A coarse run that does not end has completed a share of the motion, which enters as a weak
power, because the shares of time and motion differ by a factor of up to ten.
"""

from __future__ import annotations

from time import process_time

from viscotack.bem.contacts.punch import PunchContact
from viscotack.bem.contacts.revolution import RevolutionContact
from viscotack.bem.mesh import MOST_NODES
from viscotack.bem.settings import Settings
from viscotack.bem.solver import contact_of
from viscotack.errors import InputError
from viscotack.problem import Case, Groups
from viscotack.problem.accuracy import DEFAULT_ACCURACY, LOOSEST_ACCURACY
from viscotack.protocol import Apart, Approach, Retract
from viscotack.result import Outcome

from .solving import solve

# Longest coarse run [s of processor time], and its tolerance over the loosest one.
LONGEST = 1.5
_COARSER = 4.0
# Wall time of a relaxed start, which reports no progress, over the longest processor time.
_WALL = 8.0
# The formula for a coarse run that ends: factor, powers of the nodes and of the accuracy.
_FACTOR, _NODES, _ACCURACY = 0.62, 0.36, -0.25
# For one that does not end: factor, power of the completed share, and the smallest that counts.
_UNFINISHED, _SHARE, _LEAST = 0.8, -0.3, 0.05


class _Enough(Exception):
    """The coarse run has taken its time."""


def processor_time(
    problem: Case,
    *,
    accuracy: float = DEFAULT_ACCURACY,
    until: str = "detached",
    longest: float = LONGEST,
) -> float | None:
    """Return the processor time that :func:`viscotack.solve` will take [s].

    It is mostly within a factor of 3, and None where the coarse run has no start.

    Parameters
    ----------
    problem : Problem or Groups
        The problem.
    accuracy, until
        As for :func:`viscotack.solve`.
    longest : float
        Processor time of the coarse run [s], at most.
    """
    began, share = process_time(), 0.0

    def progress(done: float) -> None:
        nonlocal share
        share = done
        if process_time() - began > longest:
            raise _Enough

    factor = _FACTOR
    try:
        nodes = _nodes(problem.groups(), Settings.for_accuracy(accuracy))
        result = solve(
            problem,
            settings=Settings.for_accuracy(LOOSEST_ACCURACY).coarser(_COARSER),
            until=until,
            estimate_error=False,
            throw=False,
            progress=progress,
            time_limit=_WALL * longest,
        )
        if result.method != "simulation":
            return process_time() - began  # a theory, whatever the accuracy
        ended = result.outcome is not Outcome.STOPPED
    except _Enough:
        ended = False
    except InputError:
        return None
    if not ended:
        factor *= _UNFINISHED * max(share, _LEAST) ** _SHARE
    coarse = process_time() - began
    return factor * coarse * nodes**_NODES * (accuracy / DEFAULT_ACCURACY) ** _ACCURACY


def _nodes(groups: Groups, settings: Settings) -> int:
    """Return the number of nodes of the first mesh, at the deepest state of a test."""
    contact = contact_of(groups)
    states = [groups.start, *(m.to for m in groups.moves if isinstance(m, Approach | Retract))]
    depth = max(1 - s.gap if isinstance(s, Apart) else contact.deepest(s) for s in states)
    if isinstance(contact, PunchContact):
        edge = contact.size
    else:
        assert isinstance(contact, RevolutionContact)
        edge = contact.jkr_radius(depth)
    try:
        return len(contact.grading(settings, depth).nodes(edge, edge))
    except InputError:
        return MOST_NODES
