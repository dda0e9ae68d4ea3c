"""The operations ``simulate`` and ``show``: simulate a contact, and show a saved result."""

from collections.abc import Iterable
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from viscotack.cards import card_of
from viscotack.errors import InputError
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY, TimeLimit
from viscotack.model.problem.accuracy import Accuracy as AccuracyCard
from viscotack.units import readable

from .flags import INDENTERS
from .request import (
    Answer,
    Caller,
    Contact,
    File,
    Option,
    Output,
    Request,
    csv_file,
    number_of,
    picture,
)

if TYPE_CHECKING:
    from viscotack.result import Result
    from viscotack.result.observables import Observable

# How far to pull, and the accuracy of a simulation.
Until = Annotated[
    Literal["pull-off", "detached"],
    Option(
        "Stop past the largest tension, or when the surfaces are apart.",
    ),
]
Accuracy = Annotated[float, number_of(card_of(AccuracyCard), metavar="RELATIVE")]
HowLong = Annotated[
    float | None,
    number_of(card_of(TimeLimit), metavar="TIME"),
]
PlotKind = Annotated[
    Literal["force", "radius", "overview", "energy", "sensitivities"],
    Option(
        "force: against depth; radius: force against contact radius; overview: four pictures; "
        "energy: energy balance; sensitivities: elasticities by the inputs, if they were computed.",
    ),
]
_FILES = (
    picture(),
    csv_file("Write the curve as a table; - is standard output."),
    csv_file(
        "Write a table with a row for each cycle of the test: snap-in, peak, pull-off, work, "
        "hysteresis, time to detachment; - is standard output.",
        "cycles",
    ),
)


class Simulate(Request):
    """Simulate the detachment of a sphere, cone, other profile, or punch on a layer.

    The problem is given by dimensionless numbers, or in SI by a case file.
    """

    word: ClassVar = "simulate"
    outputs: ClassVar = (
        *_FILES,
        Output(
            "save",
            "Save all of the result, for viscotack show.",
            "binary",
            flags=("--save", "-o"),
            done="saved",
            endings=(".npz",),
        ),
    )
    takes_own: ClassVar = True
    helps: ClassVar = {
        "sphere": """Pull a rigid sphere off a soft viscoelastic half-space.

    The problem is stated by dimensionless numbers, or in SI by a file. R is the sphere radius,
    E0 the rubbery modulus, dg0 the work of adhesion, h0 the equilibrium gap, tau0 the time of the
    material.

    Example: viscotack simulate sphere --tabor 3.24 --modulus-ratio 0.1 --exponent 0.8
    --preload 73 --rate 316.23
    """,
        "punch": """Pull a rigid flat punch off a soft viscoelastic layer.

    Plane strain. The problem is stated by dimensionless numbers, or in SI by a file. a is the half
    width of the punch, b the thickness of the layer, E0* the rubbery contact modulus, dg0 the work
    of adhesion, sigma0 the strength of the interface, h0 the equilibrium gap, tau0 the time of the
    material, and a0 = pi E0* dg0/(2 sigma0^2).

    Example: viscotack simulate punch --size 64.85 --thickness 3.24 --cohesion 0.05
    --modulus-ratio 0.1 --preload 1 --rate 10
    """,
        "profile": """Pull a cone, or another indenter with the profile A r^q, off a viscoelastic
    half-space.

    By dimensionless numbers, R being the equivalent radius (a measured profile by --points), or in
    SI by a file that has a table [profile] in place of [sphere]: `slope` of a cone, or `exponent`,
    and `height` at a radius `at_radius`.

    Example: viscotack simulate profile examples/from_toml/cone.toml
    """,
        "disc": """Pull a disc, the flat end of a cylinder, off a soft viscoelastic half-space or
    a layer.

    The problem is given by dimensionless numbers with R = a sqrt(a E0*/dg0), a the radius of the
    disc, so that the Tabor number is sqrt(a dg0/E0*)/h0; the edge is sharp. In SI it is given by a
    file with a table [disc] in place of [sphere]: `radius`, and `edge_width` and `edge_height` of a
    rounded edge. Kendall's pull-off force is 1.064 of the unit 1.5 pi R dg0.

    Example: viscotack simulate disc --tabor 8 --modulus-ratio 0.1 --exponent 0.8 --preload 0
    --rate 10
    """,
        "case": """Simulate the problem of a case file in SI, with any indenter.

    For a user-defined shape, the table has its name and --with gives its Python file.

    Example: viscotack simulate case examples/from_toml/cone.toml
    """,
    }

    problem: Annotated[
        Any,
        Contact(
            "The contact and the moves of the machine.",
            indenters=INDENTERS,
            spelling="commands",
        ),
    ]
    until: Until = "detached"
    accuracy: Accuracy = DEFAULT_ACCURACY
    time_limit: HowLong = None
    whole: Annotated[
        bool,
        Option(
            "Simulate the whole retraction. By default a retraction from more than 1000 h0 starts "
            "at a smaller depth with the same result."
        ),
    ] = False
    profiles: Annotated[
        bool, Option("Also keep pressure and gap along the radius, at the steps of the solver.")
    ] = False
    sensitivities: Annotated[
        bool,
        Option(
            "Also compute the elasticities of force, work, depth and contact radius at pull-off "
            "by every input, from simulations with each changed by 2 %."
        ),
    ] = False
    plot_kind: PlotKind = "force"

    def answer(self, caller: Caller) -> Answer:
        """Solve the problem and report its curve while it grows."""
        from viscotack.result import save

        from .parts.running import run

        stated = self.stated(caller)
        result = run(
            stated.problem,
            caller.tell,
            accuracy=self.accuracy,
            until=self.until,
            time_limit=self.time_limit,
            whole=self.whole,
            points="points" in caller.wants,
            profiles=self.profiles,
            sensitivities=self.sensitivities,
        )
        answer = _answer(result, self.plot_kind, caller)
        files = {**answer.files, "save": lambda target: save(result, target)}
        notes = (*stated.notes, *answer.notes)
        return replace(answer, files=files, notes=notes)


class Show(Request):
    """Show a saved result.

    Prints its summary; writes its curve as a table or draws it if wanted.
    """

    word: ClassVar = "show"
    outputs: ClassVar = _FILES
    takes_own: ClassVar = True

    file: Annotated[Path, File("A result that --save wrote.", metavar="FILE.npz", argument=True)]
    plot_kind: PlotKind = "force"

    def answer(self, caller: Caller) -> Answer:
        """Load the result."""
        return _answer(saved(caller.file(self.file), caller), self.plot_kind, caller)


def saved(file: Path, caller: Caller) -> "Result":
    """Return the result in a file."""
    if file.is_dir():
        raise InputError(f"{file} is a folder; give the name of a file")
    from viscotack.result import load

    return load(file, also=caller.also)


def _answer(result: "Result", plot_kind: str, caller: Caller) -> Answer:
    from viscotack.model.problem.nouns import known
    from viscotack.plot import simulation as plot
    from viscotack.result import Outcome, write_csv
    from viscotack.result.cycles import write_cycles
    from viscotack.result.observables import summary

    from .parts.running import drawn_of

    also = known(caller.also).observables
    draw = {
        "force": plot.draw_force,
        "radius": plot.draw_radius,
        "overview": plot.draw_overview,
        "energy": plot.draw_energy,
        "sensitivities": plot.draw_sensitivities,
    }[plot_kind]
    stopped = result.outcome is Outcome.STOPPED
    files: dict[str, Any] = {"csv": lambda target: write_csv(result, target)}
    if not stopped:
        files["cycles"] = lambda target: write_cycles(result, target)
    found = summary(result, also)
    if result.sensitivities is not None:
        found["sensitivities"] = asdict(result.sensitivities)
    return Answer(
        result,
        record=lambda: found,
        words=lambda: _words(result, found, also),
        files=files,
        pictures={"plot": lambda: draw(result)},
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
        f"{result.accuracy:g}; repeat with a smaller --accuracy"
    )


def _words(result: "Result", answer: dict[str, Any], also: "Iterable[Observable]") -> str:
    """Return a summary as lines a person reads."""
    from .parts.cycle_table import table_of_cycles
    from .parts.sensitivity_table import table_of_sensitivities

    lines, kind = [answer["status"]], result.problem.outputs
    said = {name: (output.words, output.unit) for name, output in kind.observables.items()}
    seen = answer[next(iter(said))] is not None
    said |= {own.name: (own.words, kind.units[own.measure]) for own in also}
    for name, (words, unit) in said.items():
        value, note = answer[name], answer.get(f"{name}_note")
        if value is None:
            if note and seen:  # of all numbers this one is missing
                lines.append(f"  {words:<21}  not known: {note}")
            continue
        line = f"  {words:<21}{value:>12.5g}  {unit.text:<30}"
        if f"{name}_{unit.tail}" in answer:
            line += f"= {readable(answer[f'{name}_{unit.tail}'], unit.si)}"
        lines.append(line.rstrip())
        if note:
            lines.append(f"  {'':<21}  {note}")
    lines += table_of_cycles(result, answer["cycles"])
    if began := answer["shallow_start"]:
        lines += [
            f"  begun at depth       {began['depth']:>12.5g}  h0 and not {began['asked']:.4g} h0, "
            "which changes the force",
            f"  {'':<33}  by {began['force']:.0e} of it at most, the work by {began['work']:.0e}, "
            f"the depth by {began['shift']:.1g} h0;",
            f"  {'':<33}  curve and time begin there (--whole marches all of it)",
        ]
    if answer["error_estimate"] is None:
        lines.append("  numerical error      not known: no coarser run to compare with")
    for name, error in (answer["error_estimate"] or {}).items():
        if error is not None:
            unit = "h0, estimated" if name == "depth" else "estimated, relative"
            lines.append(f"  {'error of the ' + name:<21}{error:>12.1e}  {unit}")
    if result.sensitivities is not None:
        lines += table_of_sensitivities(result.sensitivities)
    cost = answer["statistics"]
    if cost.get("steps") is not None and answer["wall_time_s"] is not None:
        lines.append(f"  {cost['steps']:.0f} steps in {answer['wall_time_s']:.2f} s")
    return "\n".join(lines)
