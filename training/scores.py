"""What a surrogate is worth, on rows that it has not learned from."""

from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.interpolate import PchipInterpolator

from viscotack.result.trajectory import PRESSED
from viscotack.surrogate import physics
from viscotack.surrogate.contact import between
from viscotack.surrogate.line import Curves
from viscotack.surrogate.model import Surrogate
from viscotack.surrogate.network import Networks, together
from viscotack.surrogate.physics import Array

from .fitting import Fit
from .recipe import begin_forces
from .rows import BANDED, BANDS, LEARNED, Rows, band
from .shop import Shop

_CONFIDENCE = 0.9
# Between these lie the regions: three ranges of Tabor number, times three of rate.
_TABORS, _RATES = (0.1, 1.0), (10.0, 1e5)
REGIONS = (len(_TABORS) + 1) * (len(_RATES) + 1)


def region(groups: Array) -> npt.NDArray[np.intp]:
    """Return the number of the region of each row, from 0 to REGIONS - 1.

    Examples
    --------
    >>> region(np.array([[0.05, 0.1, 0.6, 1.0, 1.0], [5.0, 0.1, 0.6, 1.0, 1e9]])).tolist()
    [0, 8]
    """
    tabor = np.searchsorted(_TABORS, groups[:, physics.TABOR])
    rate = np.searchsorted(_RATES, groups[:, physics.RATE])
    return tabor * (len(_RATES) + 1) + rate


def scores(surrogate: Surrogate, rows: Rows) -> dict[str, Any]:
    """Return errors, covers and errors of the curves by set, ready for JSON."""
    sets = {name: rows.chosen(rows.origin == i) for i, name in enumerate(LEARNED)}
    return {name: _of(surrogate, some) for name, some in {"all": rows, **sets}.items() if len(some)}


def _of(surrogate: Surrogate, rows: Rows) -> dict[str, Any]:
    said = surrogate.evaluate(rows.groups)
    between = surrogate.intervals(rows.groups, said, confidence=_CONFIDENCE)
    where = region(rows.groups)
    answer: dict[str, Any] = {"rows": len(rows)}
    for name, found, ends, true in (
        ("force", said.pull_off_force, between.pull_off_force, rows.force),
        ("work", said.work_to_pull_off, between.work_to_pull_off, rows.work),
    ):
        error = np.log10(found / true)
        held = (ends[:, 0] <= true) & (true <= ends[:, 1])
        answer[name] = {
            "mse_log10": float(np.mean(error**2)),
            "median": float(np.median(np.abs(found / true - 1))),
            "95 %": float(np.quantile(np.abs(found / true - 1), 0.95)),
            "largest": float(np.max(np.abs(found / true - 1))),
            "cover": float(held.mean()),
            "cover by region": [
                float(held[where == r].mean()) if np.any(where == r) else None
                for r in range(REGIONS)
            ],
            "half width": float(np.median(ends[:, 1] / ends[:, 0]) ** 0.5 - 1),
        }
    return answer | {"curve": _curve(surrogate.curves(rows.groups, said), rows)}


def _curve(found: Curves, rows: Rows) -> dict[str, float]:
    """Return how far predicted curves are off, root mean square over the points in tension."""
    error = np.sqrt(np.nanmean(curve_errors(found, rows) ** 2, axis=1))
    return {
        "median": float(np.median(error)),
        "90 %": float(np.quantile(error, 0.9)),
        "99 %": float(np.quantile(error, 0.99)),
    }


def curve_errors(found: Curves, rows: Rows) -> Array:
    """Return how far curves are off at the stored points in tension, shape (n, 24).

    Parts of the pull-off force, at the same travel from zero force, or from a start in tension; nan
    for points in compression. Where zero force is: :func:`travel_errors`.
    """
    travel = rows.trajectory_left[:, :1] - rows.trajectory_left - _to_zero(rows)[:, None]
    error = np.full(travel.shape, np.nan)
    for i in range(len(rows)):
        first = PRESSED if rows.start_force[i] > 0 else 0
        known = found.depth[i, first] - found.depth[i, first:]
        force = _at(travel[i, first:], known, found.force[i, first:])
        error[i, first:] = (force - rows.trajectory_force[i, first:]) / rows.force[i]
    return error


def travel_errors(found: Curves, rows: Rows) -> Array:
    """Return errors of log10 of the travel to zero force, shape (n,); nan for starts in tension."""
    pressed = rows.start_force > 0
    travel = np.where(pressed, found.depth[:, 0] - found.depth[:, PRESSED], 1.0)
    return np.where(pressed, np.log10(travel / np.where(pressed, _to_zero(rows), 1.0)), np.nan)


def _to_zero(rows: Rows) -> Array:
    """Return the travel to zero force, 0 for starts in tension."""
    return np.where(rows.start_force > 0, rows.give * rows.start_force / rows.start_radius, 0.0)


def _at(travel: Array, known: Array, force: Array) -> Array:
    """Return forces at travels; beyond the last known one the last force."""
    kept = np.append(True, np.diff(known) > 0)
    curve = PchipInterpolator(known[kept], force[kept])
    return curve(np.clip(travel, known[0], known[-1]))


@dataclass(frozen=True, eq=False)
class Band:
    """A band of one input, and networks for the force that learn from the other bands."""

    column: int
    number: int
    held: Rows
    forces: list[Future[Networks]]


def begin_bands(rows: Rows, limits: Surrogate, how: Fit, shop: Shop) -> list[Band]:
    """Begin to learn the force without each band of Tabor number, modulus ratio and exponent."""
    found = []
    for column in BANDED:
        of_row = band(rows, column)
        for number in range(BANDS):
            held = of_row == number
            forces = begin_forces(rows.chosen(~held), limits, how, shop)
            found.append(Band(column, number, rows.chosen(held), forces))
    return found


def score_band(one: Band, limits: Surrogate) -> dict[str, Any]:
    """Return how well the force of a band is told from the other bands, ready for JSON."""
    groups, true = one.held.groups, np.log10(one.held.force)
    networks = together([future.result() for future in one.forces])
    tests = limits.tests(groups)
    said = between(tests.slow, tests.fast, networks(tests.told)[..., 0])
    error = said.mean(axis=0) - true
    values = groups[:, one.column]
    return {
        "input": physics.INPUTS[one.column],
        "from": float(values.min()),
        "to": float(values.max()),
        "edge": one.number in (0, BANDS - 1),
        "rows": len(one.held),
        "r2": float(1 - np.mean(error**2) / np.var(true)),
        "mse_log10": float(np.mean(error**2)),
    }
