"""One case of a campaign: solve it within its limits and return a row. Runs in the workers.

A row contains the numbers of ``viscotack.summary``, key points of the curve and a resampled
trajectory, about a thousandth of the size of a result. A table must not mix rows of different
programs, which are told apart by their versions and the hash of their source.
"""

import hashlib
import platform
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Annotated, Any

import numpy
import scipy

from viscotack.cards import Quantity, conform
from viscotack.errors import InputError
from viscotack.model.problem import RoughCase
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY, Accuracy
from viscotack.model.problem.nouns import known, own_nouns
from viscotack.result import Outcome
from viscotack.result.curve import curve
from viscotack.result.observables import pull_off, summary
from viscotack.simulate import solve
from viscotack.simulate.rough import problem_of, pull, stickiness
from viscotack.version import __version__

_PACKAGE = Path(__file__).parents[1]


@cache
def identity() -> str:
    """Return the versions on which numbers depend, and a hash of the source of this package."""
    source = hashlib.sha256()
    for path in sorted(_PACKAGE.rglob("*.py")):
        content = path.read_bytes()
        source.update(f"{path.relative_to(_PACKAGE).as_posix()} {len(content)}\n".encode())
        source.update(content)
    return (
        f"viscotack {__version__}, source {source.hexdigest()[:16]}, "
        # a change of its last part does not change numbers
        f"python {'.'.join(platform.python_version_tuple()[:2])}, "
        f"numpy {numpy.__version__}, scipy {scipy.__version__}"
    )


# Entries of the summary for readers or of histories, left out of tables of pull-offs.
_LEFT_OUT = (
    "problem versions run_id events statistics error_estimate accuracy accuracy_met shallow_start "
    "cycles time_to_detachment time_to_detachment_s"
).split()
_COST = ("steps", "nodes", "modes", "newton_iterations")


@dataclass(frozen=True)
class CaseSettings:
    """Accuracy, end and limits of the cases of a campaign.

    Attributes
    ----------
    accuracy : float
        Required relative error of the pull-off force.
    until : {"pull-off", "detached"}
        End of the simulation. Full separation ("detached") takes about twice the time and is
        needed for the work of separation.
    time_limit : float
        Time limit of a case [s]; a longer case is a failure. If it does not end by itself, its
        process is ended after twice this time.
    memory_limit : float
        Memory limit of a case [bytes], in addition to the idle worker; kept on Linux.
    own : tuple of str
        Python files with user-defined laws, materials, shapes and observables.

    Examples
    --------
    >>> CaseSettings(accuracy=0.01, time_limit=60.0).until
    'pull-off'
    """

    accuracy: Accuracy = DEFAULT_ACCURACY
    until: str = "pull-off"
    time_limit: Annotated[
        float,
        Quantity("s", "t", "longest wall time of a case", above=0, example="10 min"),
    ] = 600.0
    memory_limit: Annotated[
        float,
        Quantity("byte", "M", "most memory of a case beside its worker", above=0, example="400 MB"),
    ] = 400e6
    own: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.until not in ("detached", "pull-off"):
            raise InputError(f"until must be 'detached' or 'pull-off', got {self.until!r}")
        conform(self)
        object.__setattr__(self, "own", tuple(map(str, self.own)))

    @cached_property
    def nouns(self) -> tuple[Any, ...]:
        """The user-defined classes, which are read once."""
        return own_nouns(self.own)


class Unsolved(Exception):
    """A simulation that stopped before its end, with the reason."""


def measure(problem: Any, settings: CaseSettings) -> dict[str, Any]:
    """Solve a problem and return its row in a campaign.

    Parameters
    ----------
    problem : Problem, Groups or RoughCase
        The problem.
    settings : CaseSettings
        Accuracy, end and limits.

    Returns
    -------
    dict
        Numbers of the summary, key points of the curve and the trajectory, by column.

    Raises
    ------
    Unsolved
        If the simulation stopped before its end.
    ValueError
        If the problem has no relaxed start, or its result no pull-off.

    Examples
    --------
    >>> from viscotack import AtDepth, Elastic, Groups
    >>> solid = Elastic(rubbery_modulus=1, poisson_ratio=0)
    >>> row = measure(Groups(1.0, solid, AtDepth(5.0), rate=1.0), CaseSettings(accuracy=0.02))
    >>> f"{row['pull_off_force']:.2f}"
    '1.12'
    """
    if isinstance(problem, RoughCase):
        return _of_rough(problem, settings)
    # a trajectory begins at the start that the row states
    result = solve(
        problem,
        accuracy=settings.accuracy,
        until=settings.until,
        whole=True,
        throw=False,
        time_limit=settings.time_limit,
    )
    if result.outcome is Outcome.STOPPED:
        raise Unsolved(result.status)
    found = pull_off(result)
    answer = summary(result, known(settings.nouns).observables)
    errors, cost = answer["error_estimate"] or {}, answer["statistics"]
    row = {name: value for name, value in answer.items() if name not in _LEFT_OUT}
    row |= {"error_estimate": errors.get("force"), "error_estimate_work": errors.get("work")}
    row |= {"error_estimate_depth": errors.get("depth")}
    row |= {name: cost.get(name) for name in _COST} | {"jumps": len(result.events)}
    row |= {"versions": ", ".join(f"{k} {v}" for k, v in answer["versions"].items())}
    return row | curve(result, found)


def _of_rough(case: RoughCase, settings: CaseSettings) -> dict[str, Any]:
    """Return the row of a rough surface: its answer, statistics and measures of stickiness."""
    problem = problem_of(case)
    found = pull(problem, accuracy=settings.accuracy, time_limit=settings.time_limit)
    if found.outcome is Outcome.STOPPED:
        raise Unsolved(found.status)
    spread, cost = problem.roughness, found.statistics
    row = found.summary | {"warnings": "; ".join(found.warnings)}
    row |= {"rms_height_m": spread.rms_height, "rms_slope": spread.rms_slope}
    row |= {"pixels_per_zone": problem.zone.pixels} | stickiness(problem).record
    row |= {name: cost.get(name) for name in _COST if name != "nodes"}
    return row | {"versions": identity()}
