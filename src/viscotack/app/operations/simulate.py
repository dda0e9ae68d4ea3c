"""The operations ``simulate`` and ``show``: simulate a contact, and show a saved result."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from viscotack.cards import card_of
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY, TimeLimit
from viscotack.model.problem.accuracy import Accuracy as AccuracyCard

from .flags import INDENTERS
from .options import Option, binary_file, contact, csv_file, input_file, number_of, picture, switch
from .parts.record_words import units_of
from .request import Answer, Caller, Request

if TYPE_CHECKING:
    from viscotack.result import Result

# How far to pull, and the accuracy of a simulation.
Until = Annotated[
    Literal["pull-off", "detached"],
    Option("Stop past the largest tension, or when the surfaces are apart."),
]
Accuracy = Annotated[float, number_of(card_of(AccuracyCard))]
Limit = Annotated[float, number_of(card_of(TimeLimit))]
HowLong = Annotated[float | None, number_of(card_of(TimeLimit))]
PlotKind = Annotated[
    Literal["force", "radius", "overview", "energy", "sensitivities"],
    Option(
        "Force against depth, or against contact radius; four pictures; the energy balance; or "
        "elasticities by the inputs, if they were computed."
    ),
]
_FILES = (
    picture(),
    csv_file("Write the curve as a table."),
    csv_file("Write a row for each cycle: snap-in, peak, pull-off, work, hysteresis.", "cycles"),
)


class Simulate(Request):
    """Pull a sphere, a cone or another profile, a disc, or a punch on a layer off a soft body.

    The contact is stated in SI, without dimensions, or by a file in SI. E0 is the rubbery modulus,
    E0* = E0/(1 - nu^2), dg0 the work of adhesion, h0 the range of the attraction, tau0 the time of
    the solid, R the radius of a sphere. A profile has an equivalent R; that of a disc of radius a,
    with a sharp edge, is a sqrt(a E0*/dg0). A punch is in plane strain, with
    a0 = pi E0* dg0/(2 strength^2). A shape of your own is stated by a file, and by --with.

    In SI: viscotack simulate sphere --radius "5 mm" --material pdms-10-1
    --work-of-adhesion "150 mJ/m^2" --equilibrium-gap "2 um" --preload-force "1.5 mN"
    --speed "10 um/s"

    By a file: viscotack simulate examples/from_toml/cone.toml --plot cone.png

    Without dimensions: viscotack simulate sphere --tabor 3.24 --modulus-ratio 0.1 --exponent 0.8
    --preload 73 --rate 316.23
    """

    word: ClassVar = "simulate"
    outputs: ClassVar = (
        *_FILES,
        binary_file("save", "Save all of the result, for viscotack show.", ".npz", "--save", "-o"),
    )
    takes_own: ClassVar = True
    problem: Any = contact(
        "The indenter and its flags; or a problem in SI.",
        metavar="sphere|punch|profile|disc|CASE.toml",
        indenters=INDENTERS,
        spelling="word",
        default=...,
    )
    until: Until = "detached"
    accuracy: Accuracy = DEFAULT_ACCURACY
    time_limit: HowLong = None
    whole: bool = switch(
        "Begin where stated; by default a retraction from more than 1000 h0 begins at a smaller "
        "depth with the same result."
    )
    profiles: bool = switch("Also keep pressure and gap along the radius.")
    sensitivities: bool = switch(
        "Also compute the elasticities at pull-off by every input, each changed by 2 %."
    )
    plot_kind: PlotKind = "force"

    def answer(self, caller: Caller) -> Answer:
        """Solve the problem and report its curve while it grows."""
        from viscotack.result import save

        from .parts.running import run

        stated = self.stated(caller)
        how = ("accuracy", "until", "time_limit", "whole", "profiles", "sensitivities")
        result = run(stated.problem, caller.tell, **self.values(*how))
        answer = _answer(result, self.plot_kind, caller)
        files = {**answer.files, "save": lambda target: save(result, target)}
        notes = (*stated.notes, *answer.notes)
        return replace(answer, files=files, notes=notes)


class Show(Request):
    """Show a saved result.

    Example: viscotack show lens.npz --plot lens.png
    """

    word: ClassVar = "show"
    outputs: ClassVar = _FILES
    takes_own: ClassVar = True

    file: Path = input_file("A result that --save wrote.", "FILE.npz")
    plot_kind: PlotKind = "force"

    def answer(self, caller: Caller) -> Answer:
        """Load the result."""
        from viscotack.result import load

        return _answer(load(caller.file(self.file), also=caller.also), self.plot_kind, caller)


def _answer(result: "Result", plot_kind: str, caller: Caller) -> Answer:
    from viscotack.model.problem.nouns import known
    from viscotack.plot import simulation as plot
    from viscotack.result import Outcome, write_csv
    from viscotack.result.cycles import write_cycles
    from viscotack.result.observables import summary

    from .parts.running import drawn_of

    also, kind = known(caller.also).observables, result.problem.outputs
    stopped = result.outcome is Outcome.STOPPED
    files: dict[str, Any] = {"csv": lambda target: write_csv(result, target)}
    if not stopped:
        files["cycles"] = lambda target: write_cycles(result, target)
    found = summary(result, also)
    if result.sensitivities is not None:
        found["sensitivities"] = result.sensitivities
    return Answer(
        result,
        data=found,
        words=_shown(result, found),
        units=units_of(kind) | {own.name: kind.units[own.measure].text for own in also},
        files=files,
        pictures={"plot": lambda: getattr(plot, f"draw_{plot_kind}")(result)},
        drawn=lambda: drawn_of(result),
        notes=(_not_met(result),) if result.accuracy_met is False and not stopped else (),
        status=int(stopped),
    )


def _not_met(result: "Result") -> str:
    """Return the warning for a run that misses the required accuracy."""
    stated = result.error_estimate or {}
    name, error = next((n, stated[n]) for n in ("force", "time") if n in stated)
    return (
        f"viscotack: the estimated error of the {name} is {error:.2e}, above the required "
        f"{result.accuracy:g}; repeat with a smaller `accuracy`"
    )


# What the text leaves out: inputs, what the status says, and how the answer was computed.
_UNSAID = ("outcome", "accuracy", "accuracy_met", "method", "energy_residual", "events")


def _shown(result: "Result", record: dict[str, Any]) -> dict[str, Any]:
    """Return what the text says of a record."""
    shown = {n: x for n, x in record.items() if n not in (*_UNSAID, *result.groups.inputs)}
    if len(record["cycles"]) < 2 and all(x["snap_in_depth"] is None for x in record["cycles"]):
        del shown["cycles"]  # the pull-off says it all
    if began := record["shallow_start"]:
        shown["shallow_start"] = (
            f"begun at {began['depth']:.5g} h0, where curve and time begin, and not at "
            f"{began['asked']:.4g} h0; what that changes is in the errors"
        )
    of = {"force": f"pull_off_{result.problem.outputs.name_of('force')}_error"}
    of["work"] = "work_to_pull_off_error"
    if (errors := shown.pop("error_estimate")) is None:
        shown["numerical_error"] = "not known: no coarser run to compare with"
    shown |= {of.get(n, f"error_of_the_{n}"): error for n, error in (errors or {}).items()}
    shown["wall_time_s"] = shown.pop("wall_time_s")
    if (found := result.sensitivities) is not None:
        first = next(iter(found.elasticities.values()), {})
        shown["sensitivities"] = [
            {"d ln y/d ln x of": name}
            | {f"ln_{y}": slopes.get(name) for y, slopes in found.elasticities.items()}
            | {f"ln_{y}_uncertainty": errors.get(name) for y, errors in found.errors.items()}
            for name in sorted(found.inputs, key=lambda name: -abs(first.get(name, 0.0)))
        ]
        shown["no_elasticity"] = [f"of {name}: {why}" for name, why in found.refused.items()]
    return shown
