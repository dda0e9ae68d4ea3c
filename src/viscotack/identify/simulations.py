"""Simulated pull-off forces of many tests, in worker processes."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.pool import Limits, Pool, Setup
from viscotack.problem import Problem
from viscotack.result.observables import pull_off_force

from .computed import Computed, packaged

ACCURACY = 5e-3
_WORKERS = 2
_FEW = 40  # cases up to which no process is started, because that takes longer
_LIMITS = Limits(seconds=60.0)


class Simulations:
    """Pull-off forces of problems by simulation; no problem is simulated twice.

    A context manager: worker processes begin with the first large batch and end with the block.
    """

    def __init__(self, computed: Computed | None = None) -> None:
        self._pool: Pool | None = None
        self._computed = Computed() if computed is None else computed
        self._known: dict[Problem, float] = {}

    def __enter__(self) -> "Simulations":
        return self

    def __exit__(self, kind: Any, *_: object) -> None:
        if self._pool is not None:
            self._pool.dismiss(at_once=kind is not None)

    @property
    def count(self) -> int:
        """Number of simulated problems."""
        return len(self._known)

    def forces(self, problems: Sequence[Problem]) -> Array:
        """Return the pull-off forces [N], nan where a simulation ends without one."""
        new = [one for one in dict.fromkeys(problems) if one not in self._known]

        def compute() -> dict[str, Array]:
            few = len(new) <= _FEW or not packaged(new[0].material)
            found = list(map(_force, new)) if few else self._pooled(new)
            return {"force": np.array(found)}

        if new:
            kept = packaged(new[0].material)
            found = self._computed.of((ACCURACY, new), compute) if kept else compute()
            self._known |= dict(zip(new, found["force"].tolist(), strict=True))
        return np.array([self._known[one] for one in problems])

    def _pooled(self, problems: Sequence[Problem]) -> list[float]:
        if self._pool is None:
            self._pool = Pool(Setup(f"{__name__}:prepare", None), _WORKERS)
        pool, found, handed = self._pool, {}, 0
        while len(found) < len(problems):
            while handed < len(problems) and pool.room(len(problems) - handed):
                pool.hand(handed, f"{__name__}:simulate", problems[handed], _LIMITS)
                handed += 1
            for number, event in pool.collect(1.0):
                found[number] = event.what if event.kind == "answer" else np.nan
            _in_time()
        return [found[i] for i in range(len(problems))]


def prepare(_: None) -> None:
    """Prepare nothing in a worker."""


def simulate(problem: Problem, tell: Callable[[Any], None], _: None) -> float:
    """Return the pull-off force of a problem [N] in a worker."""
    return _force(problem)


def _force(problem: Problem) -> float:
    # imported on first use, because most series need no simulation
    from viscotack.bem import SimulationError
    from viscotack.methods import solve

    with suppress(InputError, SimulationError):
        found = solve(problem, until="pull-off", accuracy=ACCURACY, estimate_error=False)
        return pull_off_force(found) * problem.scales().force
    _in_time()
    return np.nan


def _in_time() -> None:
    """Refuse to go on where the time limit of the caller has been met."""
    from viscotack.clock import met

    if limit := met():
        raise InputError(f"{limit} while tests were simulated; give more time")
