"""Tables of cases with their predictions: without dimensions, or changes of one problem."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.campaign.listed import EMPTY, read_words
from viscotack.clock import TimeUp, limited
from viscotack.errors import TOO_LARGE, InputError
from viscotack.files.whole import Target
from viscotack.model.problem.rows import Changes, changes_of, plain_heading
from viscotack.prediction.predict import predict
from viscotack.prediction.prediction import prediction_summary
from viscotack.prediction.table import (
    METHOD,
    WORK,
    answers_of,
    kind_of,
    predict_table,
    with_interval,
)
from viscotack.units import is_number

from ..request import Answer, Content, Told, columns_of
from ..statement import Statement
from .record_words import read, units_of
from .tables import write_workbook

Rows = Sequence[Mapping[str, Any]]
Tell = Callable[[Told], None]
_SHEET = 2**20 - 1  # rows of a sheet below its headings
# Of the record of a prediction: what is equal in all rows, or an object.
_LEFT_OUT = ("problem", "versions")
_ABOUT = ("method", "inside", "band", "cautions", "why")


def predict_file(path: Path, confidence: float, tell: Tell) -> Answer:
    """Return the answer to the cases of a table of spheres or punches without dimensions.

    The table is a CSV file, or the first sheet of a workbook .xlsx.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If columns or rows are not those of a table of spheres or punches.
    """
    headings, lines = read_words(path, empty=True)
    rows = [[cell.strip() for cell in row] for _, row in lines]
    given = dict(zip(map(plain_heading, headings), zip(*rows, strict=True), strict=True))
    kind = kind_of(given)
    words = {name: given[name] for name in given if name in {*kind.columns, *kind.choices}}
    try:
        kind.check(set(words))
    except InputError as error:
        raise InputError(
            f"{path}: {error}, and the headings {', '.join(headings)}; a table in SI changes a "
            "problem, which stands before it: viscotack predict lens.toml cases.xlsx"
        ) from None
    _refuse_answered(path, given, answers_of(kind))
    numbers = {n: [float(x) if is_number(x) else np.nan for x in xs] for n, xs in words.items()}
    try:
        found = predict_table(
            numbers,
            confidence=confidence,
            report=lambda done, count: tell({"words": f"{done} of {count} rows answered"}),
        )
    except ValueError as error:
        raise InputError(f"{path}: {error}") from None
    empty = np.array([not any(row) for row in rows])
    found["why"][empty] = EMPTY
    for i in np.flatnonzero((found["method"] == "") & ~empty).tolist():
        if wrong := [n for n in words if not is_number(words[n][i])]:
            found["why"][i] = f"{wrong[0]} is {words[wrong[0]][i]!r}, not a number"
    record = _counts(found["method"].tolist(), found["inside"], found["why"])
    files = _files(dict(zip(headings, given.values(), strict=True)) | found)
    return Answer(found, data=record | {"confidence": confidence}, files=files)


def predict_changes(
    stated: Statement,
    rows: Rows,
    tell: Tell,
    *,
    time_limit: float | None = None,
    **options: Any,
) -> Answer:
    """Return the predictions of a problem with the numbers of each row in place of its own.

    A row is answered as its problem alone would be, with the same options of `predict`; one that
    has no answer has the reason. `time_limit` [s] is that of a row.
    """
    changes = changes_of(stated.problem, rows[0])
    kind, names = changes.kind(), _columns(stated.problem)
    _refuse_answered("the table", rows[0], [*names, *_ABOUT])
    # a passport describes the material of the problem, not one with other numbers
    is_other = any(c.number.path.startswith("material.") for c in changes.columns)
    options |= {
        "passport": None if is_other else stated.passport,
        "shift_deviation": stated.deviation,
    }

    def answer(row: Mapping[str, Any]) -> dict[str, Any]:
        inputs, outputs, why = None, None, ""
        try:
            inputs = changes.values(row)
            with limited(time_limit):
                outputs = prediction_summary(predict(kind.problem(inputs), **options))
        except (InputError, TimeUp) as error:
            why = str(error)
        except ArithmeticError:
            why = TOO_LARGE
        else:
            outputs = {name: x for name, x in outputs.items() if name not in _LEFT_OUT}
            why = outputs.pop("why")
            if outputs["inside"] and outputs["method"] in METHOD.values():
                why = ""
        whys = filter(None, [*changes.unusual(inputs or {}), why])
        return {"inputs": inputs, "outputs": outputs, "why": "; ".join(whys)}

    found = answered_rows(changes, rows, answer, tell, "why")
    told = [
        {
            **row,
            **read(one["outputs"] or {}, **names, method="method", inside="inside", band="band"),
            "cautions": " ".join((one["outputs"] or {}).get("cautions", ())),
            "why": one["why"],
        }
        for row, one in zip(rows, found, strict=True)
    ]
    table: dict[str, Any] = columns_of(told)
    table["inside"] = np.array([bool(x) for x in table["inside"]])
    record = _counts(table["method"], table["inside"], table["why"]) | {"rows": found}
    return Answer(
        found,
        data=record,
        words=record | {"rows": shown_rows(changes, found, "why", "interval")},
        units=units_of(stated.problem.groups().outputs),
        files=_files(table),
        notes=(*stated.improbable, *changes.notes),
    )


def answered_rows(
    changes: Changes,
    rows: Rows,
    answer: Callable[[Mapping[str, Any]], dict[str, Any]],
    tell: Tell,
    why: str,
) -> list[dict[str, Any]]:
    """Return the answer to each row, told when it comes; an empty one has the reason `why`."""
    found: list[dict[str, Any]] = []
    for number, row in enumerate(rows, 1):
        empty = {"inputs": None, "outputs": None, why: EMPTY}
        carried = changes.carried_of(row)
        one = empty if changes.is_empty(row) else answer(row)
        found.append(one | ({"carried": carried} if carried else {}))
        words = f"{number} of {len(rows)} rows answered"
        tell({"share": number / len(rows), "words": words})
    return found


def shown_rows(changes: Changes, found: Rows, why: str, *more: str) -> list[dict[str, Any]]:
    """Return what the text says of rows: the pull-off, or why there is none."""
    problem: Any = changes.problem
    pulled, tail = "pull_off_force", "_N"
    if hasattr(problem, "outputs"):  # not of a rough surface
        pulled = f"pull_off_{problem.outputs.name_of('force')}"
        unit = problem.outputs.observables[pulled].unit
        tail = "" if problem.scales() is None else f"_{unit.tail}"
    names = [f"{name}{tail}" for name in (pulled, *more)]
    return [
        {"case": changes.words(one)}
        | {name: (one["outputs"] or {}).get(name) for name in names}
        | {"why": one[why] if one["outputs"] is None else ""}
        for one in found
    ]


def _columns(problem: Any) -> dict[str, str]:
    """Return the headings of the numbers of the answers -> paths in the record."""
    outputs = problem.groups().outputs
    in_si = problem.scales() is not None
    pulled = f"pull_off_{outputs.name_of('force')}"
    found: dict[str, str] = {}
    for name, interval in ((pulled, "interval"), (WORK[0], "work_interval")):
        unit = outputs.observables[name].unit
        tail, head = (f"_{unit.tail}", f" [{unit.si}]") if in_si else ("", "")
        paths = f"{name}{tail}", f"{interval}{tail}.0", f"{interval}{tail}.1"
        found |= zip((f"{each}{head}" for each in with_interval(name)), paths, strict=True)
    return found


def _counts(methods: Sequence[str], inside: Any, why: Any) -> dict[str, Any]:
    """Return how many rows have an answer, by method, and how many have none."""
    return {
        "rows": len(methods),
        "inside": int(np.sum(inside)),
        "methods": dict(sorted(Counter(filter(None, methods)).items())),
        "unanswered": sum(
            not method and reason != EMPTY for method, reason in zip(methods, why, strict=True)
        ),
    }


def _refuse_answered(where: Any, headings: Mapping[str, Any], answers: Sequence[str]) -> None:
    """Refuse a table that has columns of answers already."""
    if there := [name for name in answers if name in headings]:
        raise InputError(
            f"{where} has the columns {', '.join(there)} already, which the answers are to have; "
            "rename or leave them out"
        )


def _files(table: Mapping[str, Any]) -> dict[str, Content]:
    """Return the columns of a table, for CSV and for a workbook."""

    def in_workbook(target: Target) -> None:
        columns = {n: [_in_sheet(x) for x in np.asarray(v, object)] for n, v in table.items()}
        if len(next(iter(columns.values()))) > _SHEET:
            raise InputError("the table has more rows than a sheet can have; write csv")
        write_workbook({"predictions": columns}, target)

    return {"csv": table, "xlsx": in_workbook}


def _in_sheet(value: Any) -> Any:
    """Return an entry of a table as a cell of a workbook; nothing where there is no number."""
    if value == "" or value != value:
        return None
    return float(value) if isinstance(value, str) and is_number(value) else value
