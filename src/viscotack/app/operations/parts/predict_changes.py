"""Predictions of a table of changes of one problem, row by row."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from viscotack.campaign.listed import EMPTY
from viscotack.clock import TimeUp, limited
from viscotack.errors import TOO_LARGE, InputError
from viscotack.model.problem.changes import Changes, changes_of
from viscotack.prediction import predict
from viscotack.prediction.prediction import prediction_summary
from viscotack.prediction.table import METHOD, WORK, with_interval

from ..request import Answer, Told
from ..statement import Statement
from .predict_table import in_sheet, refuse_answered
from .record_words import units_of
from .tables import write_table
from .workbook import write_workbook

if TYPE_CHECKING:
    from viscotack.files.whole import Target

Rows = Sequence[Mapping[str, Any]]
# Of the record of a prediction: what is equal in all rows, or an object.
_LEFT_OUT = ("problem", "versions")
_ABOUT = ("method", "inside", "band", "cautions", "why")


def predict_changes(
    stated: Statement,
    rows: Rows,
    tell: Callable[[Told], None],
    *,
    time_limit: float | None = None,
    **options: Any,
) -> Answer:
    """Return the predictions of a problem with the numbers of each row in place of its own.

    A row is answered as its problem alone would be, with the same options of `predict`; one that
    has no answer has the reason. `time_limit` [s] is that of a row.
    """
    changes = changes_of(stated.problem, rows[0])
    kind = changes.kind()
    names = _columns(stated.problem)
    refuse_answered("the table", rows[0], [*names, *_ABOUT])
    # a passport describes the material of the problem, not one with other numbers
    is_other = any(c.number.path.startswith("material.") for c in changes.columns)
    passport = None if is_other else stated.passport

    def answer(inputs: Mapping[str, float]) -> dict[str, Any]:
        with limited(time_limit):
            one = predict(
                kind.problem(inputs),
                shift_deviation=stated.deviation,
                passport=passport,
                **options,
            )
            return prediction_summary(one)

    known: dict[tuple[float, ...], dict[str, Any]] = {}
    found: list[dict[str, Any]] = []
    for number, row in enumerate(rows, 1):
        if changes.is_empty(row):
            one: dict[str, Any] = {"inputs": None, "outputs": None, "why": EMPTY}
        else:
            one = _answered(row, changes, answer, known)
        if carried := changes.carried_of(row):
            one = one | {"carried": carried}
        found.append(one)
        words = f"{number} of {len(rows)} rows answered"
        tell({"share": number / len(rows), "rows": found[-1:], "words": words})
    record = _record(found)
    table = _table(rows, found, names)

    def in_workbook(target: "Target") -> None:
        given = {
            n: [in_sheet(x) for x in np.asarray(v, dtype=object).tolist()] for n, v in table.items()
        }
        write_workbook({"predictions": given}, target)

    return Answer(
        found,
        data=lambda: record,
        words=lambda: _shown(changes, found, record),
        units=units_of(stated.problem.groups().outputs),
        files={"csv": lambda target: write_table(table, target), "xlsx": in_workbook},
        notes=(*stated.improbable, *changes.notes),
    )


def _answered(
    row: Mapping[str, Any],
    changes: Changes,
    answer: Callable[[Mapping[str, float]], dict[str, Any]],
    known: dict[tuple[float, ...], dict[str, Any]],
) -> dict[str, Any]:
    """Return the inputs of a row and its prediction, or the reason why it has none."""
    try:
        inputs = changes.values(row)
    except InputError as error:
        return {"inputs": None, "outputs": None, "why": str(error)}
    case = tuple(inputs.values())
    if case not in known:
        outputs, why = None, ""
        try:
            summary = answer(inputs)
        except (InputError, TimeUp) as error:
            why = str(error)
        except ArithmeticError:
            why = TOO_LARGE
        else:
            outputs = {name: x for name, x in summary.items() if name not in _LEFT_OUT}
            why = outputs.pop("why")
            if outputs["inside"] and outputs["method"] in METHOD.values():
                why = ""
        warnings = changes.unusual(inputs)
        known[case] = {"outputs": outputs, "why": "; ".join(filter(None, [*warnings, why]))}
    return {"inputs": inputs, **known[case]}


def _columns(problem: Any) -> dict[str, tuple[str, int | None]]:
    """Return the headings of the numbers of the answers -> names in the record, ends of pairs."""
    outputs = problem.groups().outputs
    in_si = problem.scales() is not None
    pulled = f"pull_off_{outputs.name_of('force')}"
    found: dict[str, tuple[str, int | None]] = {}
    for name, interval in ((pulled, "interval"), (WORK[0], "work_interval")):
        unit = outputs.observables[name].unit
        tail, head = (f"_{unit.tail}", f" [{unit.si}]") if in_si else ("", "")
        sources = (f"{name}{tail}", None), (f"{interval}{tail}", 0), (f"{interval}{tail}", 1)
        headings = [f"{each}{head}" for each in with_interval(name)]
        found |= dict(zip(headings, sources, strict=True))
    return found


def _table(rows: Rows, found: Rows, names: Mapping[str, tuple[str, int | None]]) -> dict[str, Any]:
    """Return the columns of the table as given, and those of the answers."""
    table: dict[str, Any] = {heading: [row[heading] for row in rows] for heading in rows[0]}
    answers = [one["outputs"] or {} for one in found]
    for heading, (name, end) in names.items():
        values = [one.get(name) for one in answers]
        if end is not None:
            values = [None if pair is None else pair[end] for pair in values]
        table[heading] = ["" if value is None else value for value in values]
    table["method"] = [one.get("method", "") for one in answers]
    table["inside"] = np.array([bool(one.get("inside")) for one in answers])
    table["band"] = [one.get("band", "") for one in answers]
    table["cautions"] = [" ".join(one.get("cautions", ())) for one in answers]
    return table | {"why": [one["why"] for one in found]}


def _record(found: Rows) -> dict[str, Any]:
    answers = [one["outputs"] for one in found if one["outputs"] is not None]
    return {
        "rows": list(found),
        "inside": sum(one["inside"] for one in answers),
        "methods": dict(sorted(Counter(one["method"] for one in answers).items())),
        "unanswered": sum(one["outputs"] is None and one["why"] != EMPTY for one in found),
    }


def _shown(changes: Changes, found: Rows, record: Mapping[str, Any]) -> dict[str, Any]:
    """Return what the text says: of each row the pull-off, or why there is none."""
    problem = changes.problem
    outputs = problem.groups().outputs
    name, interval = f"pull_off_{outputs.name_of('force')}", "interval"
    if problem.scales() is not None:
        tail = outputs.observables[name].unit.tail
        name, interval = f"{name}_{tail}", f"{interval}_{tail}"
    rows = [
        {"case": changes.words(one)}
        | {n: (one["outputs"] or {}).get(n) for n in (name, interval)}
        | {"why": one["why"] if one["outputs"] is None else ""}
        for one in found
    ]
    return {**record, "rows": rows}
