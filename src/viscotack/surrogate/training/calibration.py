r"""How wide the intervals are to be: conformal, on whole cells of materials that were kept apart.

The cells are boxes of Tabor number, modulus ratio and exponent; all rows of a cell are learned from
or kept apart together, so that a row is never judged by its neighbours. A second surrogate, of the
same recipe, learns all but an eighth of the cells. The scores
:math:`|\Delta \log_{10}| / (\sigma + \sigma_0)` of the rows in these give the widths (Lei et al.,
doi:10.1080/01621459.2017.1307116, with a category for each region), computed by crepes.
"""

import warnings
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from ..model import Surrogate
from ..physics import Array
from ..trust import CONFIDENCES, REGIONS, Trust, region
from .rows import Rows, cells


@dataclass(frozen=True, eq=False)
class Apart:
    """What surrogates said of rows that they had not learned from.

    Attributes
    ----------
    groups : ndarray, shape (n, 5)
    force, work : ndarray, shape (n,)
        Errors of log10.
    force_spread, work_spread : ndarray, shape (n,)
        Of the networks, log10.
    """

    groups: Array
    force: Array
    work: Array
    force_spread: Array
    work_spread: Array

    def chosen(self, which: npt.NDArray[np.bool_]) -> "Apart":
        """Return the rows of a mask."""
        return Apart(**{f.name: getattr(self, f.name)[which] for f in fields(self)})


def judged(surrogate: Surrogate, rows: Rows) -> Apart:
    """Return how far a surrogate is off on some rows."""
    said = surrogate.evaluate(rows.groups)
    return Apart(
        groups=rows.groups,
        force=np.log10(said.pull_off_force / rows.force),
        work=np.log10(said.work_to_pull_off / rows.work),
        force_spread=said.force_spread,
        work_spread=said.work_spread,
    )


def kept_cells(rows: Rows, *, seed: int) -> npt.NDArray[np.bool_]:
    """Return which rows lie in cells that are kept apart, an eighth of the cells."""
    cell = cells(rows)
    names = np.random.default_rng(seed).permutation(np.unique(cell))
    return np.isin(cell, names[: len(names) // 8])


def trusted(surrogate: Surrogate, apart: Apart) -> Surrogate:
    """Return a surrogate whose intervals hold what was kept apart."""
    return replace(surrogate, trust=_measured(apart))


def _measured(apart: Apart) -> Trust:
    floors = np.array([np.median(np.abs(apart.force)), np.median(np.abs(apart.work))])
    where = region(apart.groups)
    force = _widths(apart.force, apart.force_spread + floors[0], where)
    work = _widths(apart.work, apart.work_spread + floors[1], where)
    return Trust(force=force, work=work, floors=floors)


def _widths(errors: Array, sigmas: Array, where: npt.NDArray[np.intp]) -> Array:
    """Return how many sigmas half an interval is wide, shape (regions, confidences)."""
    regressor = _crepes().ConformalRegressor()
    regressor.fit(np.abs(errors), sigmas=sigmas, bins=where)
    zeros, ones, regions = np.zeros(REGIONS), np.ones(REGIONS), np.arange(REGIONS)
    with warnings.catch_warnings():
        # A region with too few rows for a confidence gets no end to its interval, which is right.
        warnings.filterwarnings("ignore", message="the no. of calibration examples")
        columns = [
            regressor.predict_int(zeros, sigmas=ones, bins=regions, confidence=level)[:, 1]
            for level in CONFIDENCES
        ]
    return np.column_stack(columns)


def _crepes() -> Any:
    try:
        import crepes
    except ImportError:
        raise ModuleNotFoundError(
            "intervals are measured with crepes; install it with pip install 'viscotack[train]'"
        ) from None
    return crepes


def covers(apart: Apart, cell: npt.NDArray[np.intp], *, confidence: float = 0.9) -> dict[str, Any]:
    """Return the share of rows kept apart that intervals hold which rows of other cells gave.

    Half of the cells measure the intervals of the other half, and the other way round. The share is
    that of all rows, and of the rows of each region.
    """
    half = np.isin(cell, np.random.default_rng(0).permutation(np.unique(cell))[::2])
    where, spreads = region(apart.groups), (apart.force_spread, apart.work_spread)
    by_half = [
        (some, _measured(apart.chosen(~some)).factors(apart.groups, spreads, confidence))
        for some in (half, ~half)
    ]
    answer: dict[str, Any] = {}
    for index, name in enumerate(("force", "work")):
        error, held = np.abs(getattr(apart, name)), np.empty(len(cell), dtype=bool)
        for some, factors in by_half:
            held[some] = (error <= np.log10(factors[index]))[some]
        answer[name] = float(held.mean())
        answer[f"{name} by region"] = [float(held[where == r].mean()) for r in range(REGIONS)]
    return answer
