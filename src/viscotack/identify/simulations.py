"""Simulated pull-off forces of many tests, in worker processes."""

from collections.abc import Sequence
from contextlib import suppress
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.problem import Problem
from viscotack.result.observables import pull_off_force
from viscotack.system import Processes, begin_worker

from .computed import Computed, packaged

ACCURACY = 5e-3
_WORKERS = 2
_FEW = 40  # cases up to which no process is started, because that takes longer
_LONGEST = 60.0  # time of a simulation [s]


class Simulations:
    """Pull-off forces of problems by simulation; no problem is simulated twice.

    A context manager: worker processes begin with the first large batch and end with the block.
    """

    def __init__(self, computed: Computed | None = None) -> None:
        self._pool: Processes | None = None
        self._computed = Computed() if computed is None else computed
        self._known: dict[Problem, float] = {}

    def __enter__(self) -> "Simulations":
        return self

    def __exit__(self, kind: Any, *_: object) -> None:
        if self._pool is not None:
            self._pool.kill() if kind is not None else self._pool.shutdown()

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
            self._pool = Processes(_WORKERS, _begin, ())
        found = []
        for force in self._pool.map(_force_in_worker, problems):
            found.append(force)
            _in_time()
        return found


def _begin() -> None:
    begin_worker()


def _force_in_worker(problem: Problem) -> float:
    from viscotack.clock import limited

    try:
        with limited(_LONGEST):
            return _force(problem)
    except InputError:  # it took too long
        return np.nan


def _force(problem: Problem) -> float:
    # imported on first use, because most series need no simulation
    from viscotack.simulate import SimulationError, solve

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
