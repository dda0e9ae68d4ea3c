"""The operation ``uncertainty``: the band of a force by its inputs, and which of them matters."""

from dataclasses import replace
from math import log
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from viscotack.errors import InputError
from viscotack.units import parse, readable

from .forecast import fitted
from .options import case, csv_file, file_name, named, number, option, picture, text
from .parts.record_words import read
from .parts.solid import passport_of
from .request import Answer, Caller, Request

if TYPE_CHECKING:
    from viscotack.prediction.uncertainty import Uncertainty


def _deviation(value: Any) -> tuple[str, float]:
    """Return the path and the relative standard deviation of a text, "sphere.radius 2 %"."""
    name, _, rest = str(value).strip().partition(" ")
    try:
        return name, parse(rest, "1")
    except InputError:
        raise InputError(
            f'expected a number and its deviation, "sphere.radius 2 %", got {value!r:.60}'
        ) from None


class OfUncertainty(Request):
    """Propagate uncertainties of inputs to the pull-off force, and show which input matters.

    Each --scatter names a number of the problem, as listed by viscotack campaign inputs, and its
    relative standard deviation. With --passport the solids sampled from its measurement replace
    the material, and with --study the interfaces sampled from a fitted series replace the
    interface. The best tier within the budget predicts drawn problems, and its own error counts
    too.

    Example: viscotack uncertainty lens.toml --scatter "sphere.radius 2 %"
    --scatter "interface.work_of_adhesion 15 %"
    """

    word: ClassVar = "uncertainty"
    outputs: ClassVar = (
        csv_file("Write a row for each input."),
        picture("Draw the shares of the variance."),
    )
    takes_own: ClassVar = True

    problem: Any = case("The problem at its stated inputs.")
    scatter: tuple[Any, ...] = text(
        'A number and its relative standard deviation, "protocol.speed 5 %".',
        to=_deviation,
        default=(),
    )
    passport: Any = named(
        "A passport in place of the material; its sampled solids are its uncertainty."
    )
    temperature: float | None = number(
        'Temperature, "25 degC"; default: that of the passport.', "K"
    )
    temperature_uncertainty: float | None = number(
        'Its standard uncertainty, "0.5 K", which shifts the times.', "K", above=0
    )
    study: Path | None = file_name("Study of a rate series, in place of the interface.")
    confidence: float = number("Fraction inside the band.", above=0, most=0.999, default=0.9)
    samples: int = option("Number of predictions.", default=256, ge=6, le=10_000)
    seed: int = option("Seed of the drawn problems.", default=0, ge=0, le=2**32 - 1)
    budget: float = number(
        "Of each prediction, as for viscotack predict.", "s", above=0, bare=True, default=1.0
    )

    def answer(self, caller: Caller) -> Answer:
        """Predict the drawn problems, telling ``share``."""
        from viscotack.plot.prediction import draw_uncertainty
        from viscotack.prediction.uncertainty import uncertainty

        deviations = dict(self.scatter)
        if len(deviations) < len(self.scatter):
            raise InputError("each number may be named once")
        problem, sampled, times, notes = self._known(caller)
        found = uncertainty(
            problem,
            deviations,
            sampled=sampled,
            times=times,
            progress=caller.share,
            **self.values("confidence", "samples", "seed", "budget"),
        )
        known = {**deviations, **times}
        rows = [
            {"input": name, "deviation": known.get(name), "first": x, "total": found.total[name]}
            for name, x in found.first.items()
        ]
        kind = problem.outputs
        force = kind.observables[f"pull_off_{kind.name_of('force')}"]
        unit = force.unit.text if problem.scales() is None else force.unit.si
        names = ("median", "interval", "confidence", "deviation", "methods")
        about = {"pull_off": found.pull_off_force, "unit": unit, "inputs": rows}
        return Answer(
            found,
            data=about | read(found, *names, "index_error", "interpolation_error"),
            words=_shown(found, rows, force.words, unit),
            files={"csv": rows},
            pictures={"plot": lambda: draw_uncertainty(found)},
            notes=notes,
        )

    def _known(
        self, caller: Caller
    ) -> tuple[Any, dict[str, Any], dict[str, float], tuple[str, ...]]:
        """Return problem, sampled parts, deviations of ln of the material's times, and notes."""
        stated = self.stated(caller)
        problem: Any = stated.problem
        notes = stated.improbable
        sampled: dict[str, Any] = {}
        times: dict[str, float] = {}
        given = [name for name in ("passport", "study") if getattr(self, name) is not None]
        if given and problem.scales() is None:
            raise InputError(f"`{given[0]}` needs a problem with dimensions, in SI")
        if self.passport is not None:
            from viscotack.model.materials.passport import known_of

            passport = passport_of(self.passport, caller)
            if self.temperature is not None:
                passport = passport.moved_to(self.temperature)
            problem = replace(problem, material=passport.material)
            solids, times = known_of(passport, self.temperature_uncertainty)
            sampled = {"material": solids} if solids else {}
        elif self.temperature is not None or self.temperature_uncertainty is not None:
            raise InputError("a temperature needs a passport, which has the shift of the times")
        elif stated.deviation > 0:
            times["shift"] = stated.deviation * log(10.0)
        if self.study is not None:
            from viscotack.identify import interfaces
            from viscotack.identify.forward import law_of

            fit = fitted(self.study, caller).fit
            problem = replace(problem, traction=law_of(*fit.interface))
            sampled["traction"] = interfaces(fit, _INTERFACES, seed=self.seed)
            if fit.ageing is not None:
                time = readable(fit.given.middle_time, "s", digits=2)
                notes += (f"the interface is that after {time} in contact, whatever the dwell",)
        return problem, sampled, times, notes


# Number of interfaces sampled from a study.
_INTERFACES = 64


def _shown(
    found: "Uncertainty", rows: list[dict[str, Any]], force: str, unit: str
) -> dict[str, Any]:
    """Return what the text says of a record."""
    low, high = found.interval
    return {
        "words": [
            f"{force} {readable(found.pull_off_force, unit)}, in {found.confidence:.0%} of the "
            f"cases {readable(low, unit, to=high)}",
            "shares of the variance of ln(force), first: alone, total: with the other inputs",
        ],
        "inputs": [
            row | {name: f"{row[name]:.1%}" for name in ("first", "total")}
            for row in sorted(rows, key=lambda x: -x["total"])
        ],
        "methods": found.methods,
    }
