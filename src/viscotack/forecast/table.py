"""Many answers at once: a table of cases in, a table of predictions out, row by row."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from statistics import NormalDist
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError

from .answer import check_confidence, predict
from .prediction import MEASURED

if TYPE_CHECKING:
    from viscotack.surrogate.model import Surrogate

Array = npt.NDArray[np.float64]

FORCE = ("pull_off_force", "pull_off_force_low", "pull_off_force_high")
WORK = ("work_to_pull_off", "work_to_pull_off_low", "work_to_pull_off_high")
# What a column tells of a start.
_BY = {"preload_force": "force", "preload_radius": "contact_radius"}
# Columns of an answer, in their order.
ANSWERS = (*FORCE, *WORK, "method", "inside", "band", "why")


def predict_table(
    columns: Mapping[str, npt.ArrayLike],
    *,
    confidence: float = 0.9,
    report: Callable[[int, int], None] | None = None,
) -> dict[str, npt.NDArray[Any]]:
    """Return the pull-off force and the work to pull-off of many spheres on power-law solids.

    Parameters
    ----------
    columns : mapping of str to array_like, shape (n,)
        The inputs of a campaign of spheres: tabor, modulus_ratio, exponent, rate [h0/tau0], and one
        of preload [h0], preload_force [1.5 pi R dg0] and preload_radius [(pi R^2 dg0/E0*)^(1/3)].
    confidence : float
        Part of the cases that the intervals are to hold: 0.5, 0.6, 0.7, 0.8, 0.9, 0.95 or 0.98.
    report : callable, optional
        Called with the number of rows answered and that of all, after each that went to the
        theories.

    Returns
    -------
    dict of str to ndarray, shape (n,)
        A row for each row, in its order: `pull_off_force` [1.5 pi R dg0] and `work_to_pull_off`
        [1.5 pi R dg0 h0], their intervals `..._low` and `..._high`, `method`, `inside`, whether
        the `band` was measured, and `why` it is not inside. A row outside has the answer of a
        theory, without work; where none applies, or the case is impossible, numbers are nan,
        `method` is "" and `why` says it.

    Raises
    ------
    ValueError
        If columns are missing or unknown, or of different lengths, or the confidence is not one of
        those.

    Notes
    -----
    More than 1e5 rows a second where the surrogate answers; a row that goes to the theories takes
    0.05 to 0.2 s, once however often it stands in the table.

    Examples
    --------
    >>> case = {"tabor": 3.24, "modulus_ratio": 0.1, "exponent": 0.8, "preload": 73.0}
    >>> rates = [1.0, 316.23, -1.0]
    >>> found = predict_table({name: [x] * 3 for name, x in case.items()} | {"rate": rates})
    >>> found["method"].tolist()
    ['surrogate', 'surrogate', '']
    >>> str(found["why"][2])
    'rate must be positive, got -1.0 h0 per time unit'
    """
    from viscotack.campaign.columns import KINDS
    from viscotack.surrogate import store
    from viscotack.surrogate.physics import INPUTS, PRELOAD, TABOR

    check_confidence(confidence)
    kind, given = KINDS["sphere"], _arrays(columns)
    kind.check(set(given))
    learned, count = store.shipped(), len(next(iter(given.values())))
    (start,) = set(given) & set(kind.choices)
    unknown = np.full(count, np.nan)
    rows = np.stack([given.get(n, unknown) for n in INPUTS], axis=1)
    if start != "preload":
        known = learned.inside(rows)[:, TABOR]
        rows[known, PRELOAD] = _depths(learned, given["tabor"][known], given[start][known], start)
    table: dict[str, npt.NDArray[Any]] = {n: np.full(count, np.nan) for n in FORCE + WORK}
    table |= {"method": np.full(count, "", dtype=object), "inside": np.zeros(count, dtype=bool)}
    table |= {name: np.full(count, "", dtype=object) for name in ("band", "why")}
    _fill(table, rows, learned, confidence, _BY.get(start))
    done = int(table["inside"].sum())
    for case, at in _equal_rows(given, np.flatnonzero(~table["inside"])).items():
        try:
            found = predict(
                kind.problem(dict(zip(given, case, strict=True))), confidence=confidence
            )
        except (ValueError, OverflowError) as error:
            table["why"][at] = str(error)
        else:
            _put(table, FORCE, at, found.value, found.interval)
            _put(table, WORK, at, found.work_to_pull_off, found.work_interval)
            table["method"][at], table["inside"][at] = found.method, found.inside
            table["band"][at] = found.band
            table["why"][at] = "" if found.curve is not None else found.why
        done += len(at)
        if report is not None:
            report(done, count)
    return table


def _arrays(columns: Mapping[str, npt.ArrayLike]) -> dict[str, Array]:
    given = {name: np.asarray(values, dtype=float) for name, values in columns.items()}
    shapes = {name: values.shape for name, values in given.items()}
    if len(set(shapes.values())) > 1 or any(len(shape) != 1 for shape in shapes.values()):
        words = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
        raise InputError(f"columns must be rows of numbers of one length, got shapes {words}")
    return given


def _equal_rows(
    given: dict[str, Array], at: npt.NDArray[np.intp]
) -> dict[tuple[float, ...], list[int]]:
    """Return the places of the cases among some rows, by their inputs in the order given."""
    places: dict[tuple[float, ...], list[int]] = {}
    cases = zip(*(values[at].tolist() for values in given.values()), strict=True)
    for i, case in zip(at.tolist(), cases, strict=True):
        places.setdefault(case, []).append(i)
    return places


def _depths(learned: Surrogate, tabor: Array, start: Array, name: str) -> Array:
    """Return the depths of relaxed starts [h0]; nan where the surrogate knows none."""
    keyword = _BY[name]
    # a series of rates has one start
    pairs, where = np.unique(np.stack([tabor, start], axis=1), axis=0, return_inverse=True)
    found = np.full(len(pairs), np.nan)
    for i, (mu, value) in enumerate(pairs.tolist()):
        try:
            found[i] = learned.start_depth(mu, **{keyword: value})
        except ValueError:
            continue  # said row by row, by `predict`
    return found[where.ravel()]


def _fill(
    table: dict[str, Any], rows: Array, learned: Surrogate, confidence: float, by: str | None
) -> None:
    """Put the answers of the surrogate in the table, where it knows them.

    `by` is what was told of the starts, None for their depths.
    """
    at = np.flatnonzero(learned.inside(rows).all(axis=1))
    if not at.size:
        return
    inside = rows[at]
    answers = learned.evaluate(inside)
    held = learned.intervals(inside, answers, confidence=confidence)
    if by is not None:
        half = NormalDist().inv_cdf((1 + confidence) / 2)
        held = learned.with_start_doubt(inside, answers, held, by=by, quantile=half)
    _put(table, FORCE, at, answers.pull_off_force, held.pull_off_force.T)
    _put(table, WORK, at, answers.work_to_pull_off, held.work_to_pull_off.T)
    table["method"][at], table["inside"][at] = "surrogate", True
    table["band"][at] = MEASURED


def _put(
    table: dict[str, Any], names: tuple[str, str, str], at: Any, value: Any, pair: Any
) -> None:
    if value is None:
        return  # a theory has no work
    value_name, low, high = names
    table[value_name][at] = value
    table[low][at], table[high][at] = pair
