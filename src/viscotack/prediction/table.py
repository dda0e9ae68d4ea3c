"""Vectorised predictions: a table of cases in, a table of predictions out, row by row."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.prediction.surrogate import store
from viscotack.prediction.surrogate.model import Surrogate
from viscotack.prediction.surrogate.trust import check_confidence

from .learned import not_certain
from .predict import predict
from .prediction import MEASURED
from .tier import LEARNED_PUNCH, SURROGATE

if TYPE_CHECKING:
    from viscotack.model.problem.rows import Kind


def with_interval(name: str) -> tuple[str, str, str]:
    """Return the columns of a number and the ends of its interval."""
    return name, f"{name}_low", f"{name}_high"


# Columns of the force (or stress) by kind of case, and of the work.
FORCE = {
    "sphere": with_interval("pull_off_force"),
    "punch": with_interval("pull_off_stress"),
}
WORK = with_interval("work_to_pull_off")
# Column of each kind of start.
_BY = {"preload_force": "force", "preload_radius": "contact_radius"}
METHOD = {"sphere": SURROGATE, "punch": LEARNED_PUNCH}


def kind_of(names: Collection[str]) -> Kind:
    """Return the kind of cases in a table with these columns; spheres have a Tabor number.

    Examples
    --------
    >>> kind_of(("size", "thickness", "cohesion", "modulus_ratio", "rate", "preload")).name
    'punch'
    """
    from viscotack.model.problem.rows import KINDS

    return KINDS["punch" if "tabor" not in names and "size" in names else "sphere"]


def answers_of(kind: Kind) -> tuple[str, ...]:
    """Return the columns of the predictions of a kind of case, in order."""
    return *FORCE[kind.name], *WORK, "method", "inside", "band", "why"


def predict_table(
    columns: Mapping[str, npt.ArrayLike],
    *,
    confidence: float = 0.9,
    model: Surrogate | None = None,
    report: Callable[[int, int], None] | None = None,
) -> dict[str, npt.NDArray[Any]]:
    """Predict the pull-off force and the work to pull-off of many spheres or punches.

    Parameters
    ----------
    columns : mapping of str to array_like, shape (n,)
        Inputs as in a campaign. Spheres on power-law solids: tabor, modulus_ratio, exponent,
        rate [h0/tau0], and one of preload [h0], preload_force [1.5 pi R dg0] and preload_radius
        [(pi R^2 dg0/E0*)^(1/3)]. Flat punches on layers of a standard solid: size and
        thickness [a0], cohesion, modulus_ratio, rate [h0/tau0], and preload [h0] or preload_force
        [sigma0].
    confidence : float
        Fraction of cases inside the intervals: 0.5, 0.6, 0.7, 0.8, 0.9, 0.95 or 0.98.
    model : Surrogate, optional
        A surrogate to use alone, as in :func:`viscotack.predict`; rows outside its range have no
        number.
    report : callable, optional
        Progress callback, called with the number of finished rows and the total after each row
        that theories predict.

    Returns
    -------
    dict of str to ndarray, shape (n,)
        One row per input row: `pull_off_force` [1.5 pi R dg0] and `work_to_pull_off`
        [1.5 pi R dg0 h0], for punches `pull_off_stress` [sigma0] and the work [dg0], their
        intervals `..._low` and `..._high`, `method`, `inside` (the training range), `band`
        (measured or not) and `why` it is not inside. Spheres outside are predicted by a theory.
        If no theory applies, the surrogate is not certain, or the case is invalid, numbers are
        nan, `method` is "" and `why` states the reason; nothing is simulated.

    Raises
    ------
    ValueError
        If columns are missing, unknown or of different lengths, or the confidence is not in the
        list.

    Notes
    -----
    More than 1e5 rows per second for the surrogate. A row predicted by theories takes
    0.05 to 0.2 s; equal rows are computed once.

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
    check_confidence(confidence)
    kind, given = kind_of(columns), _arrays(columns)
    kind.check(set(given))
    if model is not None and model.contact.name != kind.name:
        raise InputError(f"model is of {model.contact.name!r}, the columns are of {kind.name!r}")
    learned, force = model or store.shipped(kind.name), FORCE[kind.name]
    method, count = METHOD[kind.name], len(next(iter(given.values())))
    table: dict[str, npt.NDArray[Any]] = {n: np.full(count, np.nan) for n in (*force, *WORK)}
    table |= {"method": np.full(count, "", dtype=object), "inside": np.zeros(count, dtype=bool)}
    table |= {name: np.full(count, "", dtype=object) for name in ("band", "why")}

    rows, by = _rows(learned, given)
    # the cohesion of a punch affects crack speeds only, but a case needs one
    possible = given.get("cohesion", np.ones(count)) > 0
    at = np.flatnonzero(learned.inside(rows).all(axis=1) & possible)
    if at.size:
        tests = learned.tests(rows[at])
        said = learned.evaluate(tests)
        held = learned.intervals(tests, said, confidence=confidence)
        held = learned.with_start_doubt(tests, said, held, by=by, confidence=confidence)
        certain = ~learned.doubtful(tests, said)
        for names, name, some in zip(
            (force, WORK), ("pull_off_force", "work_to_pull_off"), certain.T, strict=True
        ):
            values, pairs = getattr(said, name)[some], getattr(held, name)[some]
            _put(table, names, at[some], values, pairs.T)
        out, second = ~certain[:, 0], 10 ** tests.second[0]
        numbers = said.pull_off_force[out], held.pull_off_force[out, 1], second[out]
        table["why"][at[out]] = [
            not_certain(method, *each) for each in np.column_stack(numbers).tolist()
        ]
        sure = at[certain[:, 0]]
        table["method"][sure], table["inside"][sure] = method, True
        table["band"][sure] = MEASURED

    done, others = len(at), np.setdiff1d(np.arange(count), at)
    for case, at in _equal_rows(given, others).items():
        try:
            problem = kind.problem(dict(zip(given, case, strict=True)))
            found = predict(problem, confidence=confidence, model=model)
        except (ValueError, OverflowError) as error:
            table["why"][at] = str(error)
        else:
            _put(table, force, at, found.pull_off_force, found.interval)
            _put(table, WORK, at, found.work_to_pull_off, found.work_interval)
            table["method"][at], table["inside"][at] = found.method, found.inside
            table["band"][at] = found.band
            table["why"][at] = "" if found.inside and found.method == method else found.why
        done += len(at)
        if report is not None:
            report(done, count)
    return table


def _arrays(columns: Mapping[str, npt.ArrayLike]) -> dict[str, Array]:
    given = {name: np.asarray(values, dtype=float) for name, values in columns.items()}
    shapes = {name: values.shape for name, values in given.items()}
    if len(set(shapes.values())) > 1 or any(len(shape) != 1 for shape in shapes.values()):
        words = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
        raise InputError(
            f"columns must be one-dimensional arrays of one length, got shapes {words}"
        )
    return given


def _equal_rows(
    given: dict[str, Array], at: npt.NDArray[np.intp]
) -> dict[tuple[float, ...], list[int]]:
    """Group equal rows: inputs, in the order given, -> indices."""
    places: dict[tuple[float, ...], list[int]] = {}
    cases = zip(*(values[at].tolist() for values in given.values()), strict=True)
    for i, case in zip(at.tolist(), cases, strict=True):
        places.setdefault(case, []).append(i)
    return places


def _rows(learned: Surrogate, given: dict[str, Array]) -> tuple[Array, str]:
    """Return the inputs of the surrogate for each row, and what defined the starts."""
    unknown = np.full(len(given["rate"]), np.nan)
    rows = np.stack([given.get(name, unknown) for name in learned.contact.inputs], axis=1)
    start = next((name for name in _BY if name in given), None)
    if start is None:
        return rows, "depth"
    *others, preload = learned.contact.start_inputs
    known = learned.inside(rows)[:, others].all(axis=1)
    rows[known, preload] = _depths(learned, rows[known][:, others], given[start][known], start)
    return rows, _BY[start]


def _depths(learned: Surrogate, others: Array, start: Array, name: str) -> Array:
    """Return the depths of relaxed starts [h0]; nan where the surrogate defines none."""
    # rows that differ in rate share one start
    starts = np.column_stack([others, start])
    each, where = np.unique(starts, axis=0, return_inverse=True)
    found = np.full(len(each), np.nan)
    for i, (*known, value) in enumerate(each.tolist()):
        try:
            found[i] = learned.start_depth(*known, **{_BY[name]: value})
        except ValueError:
            continue  # `predict` reports the reason row by row
    return found[where.ravel()]


def _put(
    table: dict[str, Any], names: tuple[str, str, str], at: Any, value: Any, pair: Any
) -> None:
    value_name, low, high = names
    # most theories do not predict the work
    table[value_name][at] = np.nan if value is None else value
    table[low][at], table[high][at] = (np.nan, np.nan) if pair is None else pair
