"""Rows to learn from: what the datasets say, as inputs and targets of the networks."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.interpolate import PchipInterpolator

from viscotack import datasets
from viscotack.arrays import Array
from viscotack.model.problem.outputs import REVOLUTION, Kind
from viscotack.prediction.surrogate import line, physics
from viscotack.result.curve import POINTS, PRESSED, TENSILE

# Sets that force, work and curve are learned from; the fast limit is learned from one of its own.
LEARNED, FAST = ("broad", "thesis", "chosen"), "fast"
# Those that were drawn where errors reach far; they tell how far. Second networks alone learn them.
FAR_OFF = ("hard", "steep")
# Largest stated errors of force and work of rows that may judge others.
MOST_ERRORS = (3e-3, 1e-2)


@dataclass(frozen=True, eq=False)
class Rows:
    """Simulated detachments, a row each."""

    groups: Array  # inputs in the order of ``physics.INPUTS``
    force: Array
    work: Array
    start_force: Array  # of the relaxed start
    start_radius: Array
    line: Array  # what a network should say of the curve, shape (n, line.OUTPUTS)
    known: Array  # 1.0 where the row has it, 0.0 where not
    # Travel to zero force times radius over force of the start; 1.0 where that is in tension.
    give: Array
    trajectory_force: Array  # as in the dataset, to judge by, shape (n, 24)
    trajectory_left: Array
    origin: npt.NDArray[np.intp]  # which set the row is of

    def __len__(self) -> int:
        return len(self.force)

    def chosen(self, which: Any) -> "Rows":
        """Return the rows of a mask or an index."""
        return Rows(**{f.name: getattr(self, f.name)[which] for f in fields(self)})


def read(*names: str) -> Rows:
    """Return the rows of some sets, one after the other."""
    return joined([of_table(datasets.load(name), number) for number, name in enumerate(names)])


def joined(parts: list[Rows]) -> Rows:
    """Return rows one after the other."""
    return Rows(
        **{f.name: np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(Rows)}
    )


def certain(name: str) -> npt.NDArray[np.bool_]:
    """Return which rows of a set state errors of at most 0.3 % of the force and 1 % of the work."""
    table = datasets.load(name)
    force, work = (table.column(f"{of}_error").to_numpy() for of in ("force", "work"))
    return (force <= MOST_ERRORS[0]) & (work <= MOST_ERRORS[1])


def of_table(
    table: Any,
    number: int = 0,
    *,
    inputs: Sequence[str] = physics.INPUTS,
    kind: Kind = REVOLUTION,
) -> Rows:
    """Return the rows of a table with the columns of a dataset, as those of one set.

    Of a punch forces are mean stresses, compression positive, and radii ligaments.
    """
    what, edge = kind.name_of("force"), kind.name_of("contact_radius")
    sense = kind.of("force").factor(None)

    def column(key: str) -> Array:
        return np.array(table.column(key).to_pylist(), dtype=float)

    groups = np.column_stack([column(key) for key in inputs])
    curve = sense * column(f"trajectory_{what}"), column(f"trajectory_{edge}")
    left = column("trajectory_travel_left")
    numbers = column(f"pull_off_{what}"), column("work_to_pull_off")
    return of_arrays(groups, *numbers, *curve, left, number)


def of_arrays(
    groups: Array,
    peak: Array,
    work: Array,
    force: Array,
    radius: Array,
    left: Array,
    number: int = 0,
) -> Rows:
    """Return rows of pull-off force, work, and force, radius and travel left of a trajectory."""
    said, known = _curves(force, radius)
    travel = left[:, 0] - left[:, PRESSED]
    return Rows(
        groups=groups,
        force=peak,
        work=work,
        start_force=force[:, 0],
        start_radius=radius[:, 0],
        line=said,
        known=known,
        give=np.where(force[:, 0] > 0, travel * radius[:, 0] / np.abs(force[:, 0]), 1.0),
        trajectory_force=force,
        trajectory_left=left,
        origin=np.full(len(peak), number),
    )


def _curves(force: Array, radius: Array) -> tuple[Array, Array]:
    """Return what a network should say of stored curves, and where the curves say it."""
    start, peak = force[:, :1], -force[:, -1:]
    p = start[:, 0] > 0
    n = len(force)
    said, known = np.zeros((n, line.OUTPUTS)), np.zeros((n, line.OUTPUTS))
    shape = np.empty((n, TENSILE))
    radii = radius / radius[:, :1]
    shape[p] = force[p, PRESSED:] / -peak[p]
    shape[~p], tense_radii = (
        _coarser(values[~p]) for values in ((start - force) / (peak + start), radii)
    )
    said[:, line.SHAPE], known[:, line.SHAPE] = shape[:, 1:-1], 1.0
    said[p, line.PRESSING], known[p, line.PRESSING] = (force / start)[p, 1:PRESSED], 1.0
    said[p, line.RADII], known[p, line.RADII] = radii[p, 1:], 1.0
    # a start in tension has the radii of the second part only
    second = slice(line.RADII.stop - TENSILE + 1, line.RADII.stop)
    said[~p, second], known[~p, second] = tense_radii[:, 1:], 1.0
    # where the surfaces are apart, or nearly, there is no radius
    absent = ~np.isfinite(said)
    said[absent], known[absent] = 0.0, 0.0
    return said, known


def _coarser(values: Array) -> Array:
    """Return values at 16 even steps of those at 24."""
    old, new = (np.linspace(0.0, 1.0, count) for count in (POINTS, TENSILE))
    return PchipInterpolator(old, values, axis=1)(new)
