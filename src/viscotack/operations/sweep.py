"""The operation ``sweep``: simulate variations of a problem, one row for each case."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from viscotack.cards import card_of
from viscotack.errors import TOO_LARGE, InputError
from viscotack.problem import RoughCase
from viscotack.problem.accuracy import DEFAULT_ACCURACY, TimeLimit
from viscotack.units import readable

from .declare.answer import Answer, Caller, csv_file
from .declare.cards import Table, number_of
from .declare.options import Operation
from .declare.statement import INDENTERS, Stated, Statement
from .simulate import Accuracy, Until

if TYPE_CHECKING:
    from viscotack.campaign import CaseSettings
    from viscotack.campaign.columns import Kind

# Exit status where some cases have no result.
_SOME_FAILED = 4


@dataclass(frozen=True, kw_only=True)
class Sweep(Operation):
    """Simulate variations of a problem, one row for each case.

    The first row of the table has the paths of the replaced numbers, in the units listed by
    viscotack campaign inputs. The row of a failed case contains the reason, and the exit status is
    then 4. An interrupted sweep keeps no results; use a campaign for long runs.

    Example: viscotack sweep lens.toml speeds.csv --csv forces.csv
    """

    word: ClassVar = "sweep"
    outputs: ClassVar = (csv_file("Write a row for each case; - is standard output."),)
    takes_own: ClassVar = True

    problem: Annotated[
        Statement,
        Stated(
            "The problem whose numbers are replaced, in SI; a case or a rough surface.",
            indenters=INDENTERS,
            spelling="case",
            rough=True,
        ),
    ]
    cases: Annotated[
        Sequence[Mapping[str, float]],
        Table(
            'A row for each case: the path of a number of the problem, such as "protocol.speed", '
            "and its value. All rows have the same paths.",
            metavar="CASES.csv",
            argument=True,
        ),
    ]
    accuracy: Accuracy = DEFAULT_ACCURACY
    until: Until = "pull-off"
    time_limit: Annotated[float, number_of(card_of(TimeLimit), metavar="TIME")] = 120.0

    def __post_init__(self) -> None:
        if any(row.keys() != self.cases[0].keys() for row in self.cases):
            raise InputError("all cases must replace the same numbers of the problem")

    def answer(self, caller: Caller) -> Answer:
        """Simulate one case after the other, telling ``share`` and the new ``rows``."""
        from viscotack.campaign import CaseSettings

        from .parts.tables import rows_as_csv

        kind = self._kind(caller.also)
        settings = CaseSettings(self.accuracy, self.until, self.time_limit, own=caller.own)
        rows: list[dict[str, Any]] = []
        for number, inputs in enumerate(self.cases, 1):
            rows.append(_row(kind, inputs, settings))
            words = f"{number} of {len(self.cases)} cases done"
            caller.tell({"share": number / len(self.cases), "rows": rows[-1:], "words": words})
        failed = sum(bool(row["reason"]) for row in rows)
        return Answer(
            rows,
            record=lambda: {"rows": rows, "failed": failed},
            words=lambda: _words(self.problem.problem, rows, failed),
            files={"csv": rows_as_csv(_flat(rows))},
            notes=self.problem.notes,
            status=_SOME_FAILED if failed else 0,
        )

    def _kind(self, also: tuple[Any, ...]) -> "Kind":
        """Return the kind of case, which builds problems from numbers."""
        from viscotack.campaign.columns import kind_of_problem
        from viscotack.problem.inputs import check_exponent

        check_exponent(self.problem.problem, self.cases[0])
        return kind_of_problem(self.problem.problem, set(self.cases[0]), also)


def _row(kind: "Kind", inputs: Mapping[str, float], settings: "CaseSettings") -> dict[str, Any]:
    """Return the row of a case: inputs, results, and the reason if it failed."""
    from viscotack.campaign import measure
    from viscotack.campaign.case import Unsolved
    from viscotack.problem.record import run_id

    from .parts.json_data import plain

    began = perf_counter()
    row: dict[str, Any] = {"inputs": dict(inputs), "outputs": None, "reason": ""}
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


def _flat(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return rows of the same columns, for a table."""
    from viscotack.files.text import cell

    empty = dict.fromkeys(name for row in rows for name in row["outputs"] or ())
    return [
        {
            **row["inputs"],
            "run_id": row.get("run_id"),
            **empty,
            **(row["outputs"] or {}),
            **row["inputs"],  # of a problem without dimensions they are among the numbers too
            "reason": cell(row["reason"]),
            "wall_time_s": row["wall_time_s"],
        }
        for row in rows
    ]


def _shown(problem: Any) -> tuple[str, str, str]:
    """Return the name of the pull-off among the outputs, its unit and words."""
    if isinstance(problem, RoughCase):
        return "pull_off_force_N", "N", "pull-off force"
    kind = problem.outputs
    name = f"pull_off_{kind.name_of('force')}"
    shown = kind.observables[name]
    if problem.scales() is None:
        return name, shown.unit.text, shown.words
    return f"{name}_{shown.unit.tail}", shown.unit.si, shown.words


def _words(problem: Any, rows: Sequence[Mapping[str, Any]], failed: int) -> str:
    key, unit, about = _shown(problem)
    lines = []
    for row in rows:
        inputs = ", ".join(f"{path} {value:.6g}" for path, value in row["inputs"].items())
        found = row["reason"] or f"{about} {readable(row['outputs'][key], unit, digits=5)}"
        lines.append(f"  {inputs}: {found}")
    return "\n".join([*lines, f"{len(rows) - failed} of {len(rows)} cases done, {failed} failed"])
