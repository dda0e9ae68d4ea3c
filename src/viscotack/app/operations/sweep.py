"""The operation ``sweep``: simulate variations of a problem, one row for each case."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, ClassVar

from viscotack.errors import TOO_LARGE, InputError
from viscotack.model.problem import RoughCase
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY

from .options import case, csv_file, rows
from .parts.record_words import units_of
from .request import Answer, Caller, Request
from .simulate import Accuracy, Limit, Until

if TYPE_CHECKING:
    from viscotack.campaign import CaseSettings
    from viscotack.model.problem.rows import Kind

# Exit status where some cases have no result.
_SOME_FAILED = 4


class Sweep(Request):
    """Simulate variations of a problem, one row for each case.

    The first row of the table, CSV or the first sheet of an .xlsx workbook, names the replaced
    numbers by the keys of the problem file, with units there or in the cells: "speed [um/s]" or
    "30 um/s". Other columns are carried along. The row of a failed case contains the reason, and
    the exit status is then 4. An interrupted sweep keeps no results; use a campaign for long runs.

    Example: viscotack sweep lens.toml speeds.csv --csv forces.csv
    """

    word: ClassVar = "sweep"
    outputs: ClassVar = (csv_file("Write a row for each case."),)
    takes_own: ClassVar = True

    problem: Any = case("The problem in SI, also of a rough surface.", rough=True)
    cases: Path | tuple[Mapping[str, Any], ...] = rows(
        'A row for each case: a key of the problem file, such as "speed" or "sphere.radius", and '
        "its value. All rows have the same names.",
        metavar="CASES.csv",
        argument=True,
        default=...,
    )
    accuracy: Accuracy = DEFAULT_ACCURACY
    until: Until = "pull-off"
    time_limit: Limit = 120.0

    def answer(self, caller: Caller) -> Answer:
        """Simulate one case after the other, telling ``share``."""
        from viscotack.campaign import CaseSettings
        from viscotack.model.problem.rows import changes_of

        from .parts.predict_table import answered_rows, shown_rows

        stated, cases = self.stated(caller), caller.rows(self.cases)
        rough = isinstance(stated.problem, RoughCase)
        if not cases or any(row.keys() != cases[0].keys() for row in cases):
            raise InputError("all cases must replace the same numbers of the problem")
        changes = changes_of(stated.problem, cases[0])
        kind = changes.kind()
        warnings: list[str] = []
        for number, row in enumerate(cases, 1):  # all are read before the first is simulated
            try:
                inputs = {} if changes.is_empty(row) else changes.values(row)
            except InputError as error:
                raise InputError(f"case {number}: {error}") from None
            warnings += [f"case {number}: {words}" for words in changes.unusual(inputs)]
        settings = CaseSettings(self.accuracy, self.until, self.time_limit, own=caller.own)

        def answer(row: Mapping[str, Any]) -> dict[str, Any]:
            return _row(kind, changes.values(row), settings)

        found = answered_rows(changes, cases, answer, caller.tell, "reason")
        failed = sum(bool(row["reason"]) for row in found if row["inputs"] is not None)
        return Answer(
            found,
            data={"rows": found, "failed": failed},
            words={"rows": shown_rows(changes, found, "reason"), "failed": failed},
            units={} if rough else units_of(stated.problem.outputs),
            files={"csv": _flat(cases, found)},
            notes=(*stated.notes, *changes.notes, *warnings),
            status=_SOME_FAILED if failed else 0,
        )


def _row(kind: "Kind", inputs: dict[str, float], settings: "CaseSettings") -> dict[str, Any]:
    """Return the row of a case: inputs, results, and the reason if it failed."""
    from viscotack.app.operations.request import plain
    from viscotack.campaign import measure
    from viscotack.campaign.case import Unsolved
    from viscotack.model.problem.case_file import run_id

    began = perf_counter()
    row: dict[str, Any] = {"inputs": inputs, "outputs": None, "reason": ""}
    try:
        problem = kind.problem(inputs)
        found = measure(problem, settings)
        outputs = {name: x for name, x in found.items() if not isinstance(x, list | tuple | dict)}
        row |= {"run_id": run_id(problem), "outputs": plain(outputs)}
    except (InputError, Unsolved) as error:
        row["reason"] = str(error)
    except ArithmeticError:
        row["reason"] = TOO_LARGE
    return row | {"wall_time_s": perf_counter() - began}


def _flat(
    cases: Sequence[Mapping[str, Any]], rows: Sequence[Mapping[str, Any]]
) -> list[dict[str, Any]]:
    """Return rows of the same columns, for a table: those of the cases, and the results."""
    empty = dict.fromkeys(name for row in rows for name in row["outputs"] or ())
    found = []
    for given, row in zip(cases, rows, strict=True):
        # of a problem without dimensions the numbers of the case are among the outputs too
        outputs = empty | (row["outputs"] or {})
        table = {**given, "run_id": row.get("run_id"), **outputs, **given}
        wall_time = row.get("wall_time_s", 0.0)
        found.append(table | {"reason": row["reason"], "wall_time_s": wall_time})
    return found
