"""The operation ``uncertainty``: the band of a force from tolerances, and which input matters."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from viscotack.errors import InputError
from viscotack.units import readable

from .declare.answer import Answer, Caller, csv_file, picture
from .declare.cards import Number, Text, Whole
from .declare.options import Operation
from .declare.statement import INDENTERS, Stated, Statement

if TYPE_CHECKING:
    from viscotack.forecast.uncertainty import Uncertainty


@dataclass(frozen=True, kw_only=True)
class OfUncertainty(Operation):
    """Propagate tolerances of inputs to the pull-off force, and show which input matters.

    Each --scatter names a number of the problem, as listed by viscotack campaign inputs, and its
    relative standard deviation. The best tier within the budget predicts drawn problems, and its
    own error counts too.

    Example: viscotack uncertainty lens.toml --scatter "geometry.radius 2 %"
    --scatter "traction.work_of_adhesion 15 %"
    """

    word: ClassVar = "uncertainty"
    outputs: ClassVar = (
        csv_file("Write a row for each input; - is standard output."),
        picture("Draw the shares of the variance to a .png, .pdf or .svg file."),
    )
    takes_own: ClassVar = True

    problem: Annotated[
        Statement,
        Stated("The problem at its stated inputs.", indenters=INDENTERS, spelling="case"),
    ]
    scatter: Annotated[
        tuple[str, ...],
        Text('A number and its relative standard deviation, "protocol.speed 5 %".', metavar="TEXT"),
    ]
    confidence: Annotated[
        float, Number("Fraction inside the band.", above=0, most=0.999, metavar="PART")
    ] = 0.9
    samples: Annotated[int, Whole("Number of predictions.", least=6, most=10_000)] = 256
    seed: Annotated[int, Whole("Seed of the drawn problems.", least=0, most=2**32 - 1)] = 0
    budget: Annotated[
        float,
        Number(
            "Time budget of each prediction, as for viscotack predict.",
            unit="s",
            above=0,
            bare=True,
            metavar="SECONDS",
        ),
    ] = 1.0

    def answer(self, caller: Caller) -> Answer:
        """Predict the drawn problems, telling ``share``."""
        from viscotack.forecast.uncertainty import uncertainty
        from viscotack.pictures.uncertainty import draw_uncertainty

        from .parts.tables import rows_as_csv

        deviations = dict(deviation_of(text) for text in self.scatter)
        if len(deviations) < len(self.scatter):
            raise InputError("each number may be named once")
        problem: Any = self.problem.problem
        found = uncertainty(
            problem,
            deviations,
            confidence=self.confidence,
            samples=self.samples,
            seed=self.seed,
            budget=self.budget,
            also=caller.also,
            progress=lambda share: caller.tell({"share": share}),
        )
        rows = [
            {
                "input": name,
                "deviation": deviations.get(name),
                "first": x,
                "total": found.total[name],
            }
            for name, x in found.first.items()
        ]
        kind = problem.outputs
        force = kind.observables[f"pull_off_{kind.name_of('force')}"]
        unit = force.unit.text if problem.scales() is None else force.unit.si
        return Answer(
            found,
            record=lambda: _record(found, rows, unit),
            words=lambda: _words(found, rows, force.words, unit),
            files={"csv": rows_as_csv(rows)},
            pictures={"plot": lambda: draw_uncertainty(found)},
            notes=self.problem.notes,
        )


def deviation_of(text: str) -> tuple[str, float]:
    """Return the path and the relative standard deviation of a text, "geometry.radius 2 %"."""
    name, _, rest = text.strip().partition(" ")
    rest = rest.strip()
    try:
        part = float(rest.removesuffix("%")) / (100 if rest.endswith("%") else 1)
    except ValueError:
        raise InputError(
            f'expected a number of the problem and its deviation, "geometry.radius 2 %", got '
            f"{text!r:.60}"
        ) from None
    return name, part


def _record(found: "Uncertainty", rows: list[dict[str, Any]], unit: str) -> dict[str, Any]:
    """Return the numbers of the answer."""
    return {
        "pull_off": found.pull_off_force,
        "median": found.median,
        "interval": list(found.interval),
        "unit": unit,
        "confidence": found.confidence,
        "deviation": found.deviation,
        "inputs": rows,
        "index_error": found.index_error,
        "interpolation_error": found.interpolation_error,
        "methods": dict(found.methods),
    }


def _words(found: "Uncertainty", rows: list[dict[str, Any]], force: str, unit: str) -> str:
    """Return the answer as lines."""
    low, high = found.interval
    tiers = ", ".join(f"{name} ({count})" for name, count in found.methods.items())
    lines = [
        f"{force} {readable(found.pull_off_force, unit)}, in {found.confidence:.0%} of the cases "
        f"{readable(low, unit, to=high)}",
        f"by {tiers}",
        "share of the variance of ln(force), alone and with the other inputs:",
    ]
    width = max(len(row["input"]) for row in rows)
    for row in sorted(rows, key=lambda x: -x["total"]):
        by = "" if row["deviation"] is None else f"  (deviation {row['deviation']:.3g})"
        lines.append(f"  {row['input']:{width}s}  {row['first']:6.1%}  {row['total']:6.1%}{by}")
    return "\n".join(lines)
