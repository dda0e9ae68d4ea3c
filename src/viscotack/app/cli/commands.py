"""The commands: reads flags and files, runs the simulation, writes words, tables and pictures.

Exit status: 0 done, 1 the simulation failed (its status says why), 2 the input is wrong or a file
could not be written, 3 a defect of viscotack.
With --json exactly one object goes to standard output, everything else to standard error.
"""

import json
import sys
import traceback
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer
from typer import Argument, Context, Option

from viscotack.app.cli.asking import answers, asking
from viscotack.app.questions import (
    OF_FILE,
    PROFILE,
    PUNCH,
    SPHERE,
    Door,
    given_of,
    question_of,
    shift_deviation_of,
    stated,
    temperature_of,
)
from viscotack.cards import card_of
from viscotack.errors import InputError
from viscotack.files.text import harmless
from viscotack.geometry import Cone
from viscotack.pictures import plot
from viscotack.problem import Case, Problem
from viscotack.problem.accuracy import DEFAULT_ACCURACY, TimeLimit
from viscotack.problem.accuracy import Accuracy as AccuracyCard
from viscotack.problem.case_file import read_case, shift_deviation
from viscotack.problem.nouns import known, own_nouns
from viscotack.result import Outcome, Result, load, save, write_csv
from viscotack.result.cycles import write_cycles
from viscotack.result.observables import Observable, summary
from viscotack.units import parse
from viscotack.version import __version__

from .cycle_table import table_of_cycles
from .writing import Writing, check_files

application = typer.Typer(
    help="How hard must one pull? Detachment of soft, sticky, rate-dependent contacts.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
simulate = typer.Typer(help="Simulate a contact.", no_args_is_help=True, rich_markup_mode=None)
application.add_typer(simulate, name="simulate")


class Until(StrEnum):
    """How far to pull."""

    PULL_OFF = "pull-off"
    DETACHED = "detached"


class PlotKind(StrEnum):
    """What to draw."""

    FORCE = "force"
    RADIUS = "radius"
    OVERVIEW = "overview"
    ENERGY = "energy"


_DRAW = {
    PlotKind.FORCE: plot.draw_force,
    PlotKind.RADIUS: plot.draw_radius,
    PlotKind.OVERVIEW: plot.draw_overview,
    PlotKind.ENERGY: plot.draw_energy,
}

PlotFile = Annotated[
    Path | None, Option("--plot", metavar="FILE", help="Draw to a .png, .pdf or .svg file.")
]
PlotWhat = Annotated[
    PlotKind,
    Option(
        "--plot-kind",
        help="force: against depth; radius: force against contact radius; overview: four pictures; "
        "energy: where the work went.",
    ),
]
CsvFile = Annotated[
    Path | None,
    Option("--csv", metavar="FILE", help="Write the curve as a table; - is standard output."),
]
CyclesFile = Annotated[
    Path | None,
    Option(
        "--cycles",
        metavar="FILE",
        help="Write a table with a row for each cycle of the test: snap-in, peak, pull-off, work, "
        "hysteresis, time to detachment; - is standard output.",
    ),
]
SaveFile = Annotated[
    Path | None,
    Option("--save", "-o", metavar="FILE", help="Save all of the result, for viscotack show."),
]
HowFar = Annotated[
    Until,
    Option("--until", help="Stop past the largest tension, or when the surfaces are apart."),
]
_ACCURACY = question_of(card_of(AccuracyCard))
Accuracy = Annotated[float, Option("--accuracy", metavar="RELATIVE", help=_ACCURACY)]
_TIME_LIMIT = question_of(card_of(TimeLimit))
HowLong = Annotated[
    str | None,
    Option("--time-limit", metavar="TIME", help=_TIME_LIMIT, show_default=False),
]
Whole = Annotated[
    bool,
    Option(
        "--whole",
        help="March the whole retraction, however deep its start: one from more than 1000 h0 "
        "begins else where its depth no longer matters.",
    ),
]
AsJson = Annotated[
    bool, Option("--json", help="Print one JSON object on standard output instead of words.")
]


CaseFile = Annotated[
    Path | None,
    Argument(
        metavar="CASE.toml",
        help="A problem in SI with units, instead of the flags of the problem; docs/input.md "
        "describes it.",
        show_default=False,
    ),
]
With = Annotated[
    list[Path] | None,
    Option(
        "--with",
        metavar="FILE.py",
        help="A Python file with laws, materials, shapes or observables of your own, see "
        "docs/own.md; it is executed. Give it once for each file.",
        show_default=False,
    ),
]


@application.callback(invoke_without_command=True)
def _viscotack(
    version: Annotated[bool, Option("--version", help="Print the version and exit.")] = False,
) -> None:
    if version:
        typer.echo(f"viscotack {__version__}")
        raise typer.Exit


def _simulate(
    context: Context,
    case: CaseFile = None,
    own: With = None,
    until: HowFar = Until.DETACHED,
    accuracy: Accuracy = DEFAULT_ACCURACY,
    time_limit: HowLong = None,
    whole: Whole = False,
    plot_file: PlotFile = None,
    plot_kind: PlotWhat = PlotKind.FORCE,
    csv_file: CsvFile = None,
    cycles_file: CyclesFile = None,
    save_file: SaveFile = None,
    as_json: AsJson = False,
) -> None:
    door = _DOORS.get(context.info_name or "")
    with wrong_input():
        files = Files(plot_file, plot_kind, csv_file, cycles_file)
        named = files.named | {"--save": save_file}
        # the file that states the problem is never written
        check_files(named, as_json=as_json, reads=(case,))
        seconds = _seconds(time_limit)
        problem = stated_problem(case, context, door, own)
        say_deviation(case, context, own)
        from viscotack.methods import solve

        with _progress() as progress:
            result = solve(
                problem,
                accuracy=accuracy,
                until=str(until),
                whole=whole,
                throw=False,
                progress=progress,
                time_limit=seconds,
            )
    write = Writing()
    write("saved", save_file, lambda file: save(result, file))
    _report(result, write, as_json, files, own)
    if result.outcome is Outcome.STOPPED:
        raise typer.Exit(1)
    if result.accuracy_met is False:
        typer.echo(_not_met(result), err=True)


def _not_met(result: Result) -> str:
    """Return what is said of a run that is not as accurate as it was asked to be."""
    stated = result.error_estimate or {}
    name, error = next((n, stated[n]) for n in ("force", "time") if n in stated)
    return (
        f"viscotack: the error of the {name} is estimated at {error:.2e}, more than the "
        f"{result.accuracy:g} that were asked for; ask for a better accuracy"
    )


_DOORS = {door.word: door for door in (SPHERE, PUNCH, PROFILE)}
_HELP = {
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

    By dimensionless numbers, R being the equivalent radius, or in SI by a file that has a table
    [profile] in place of [sphere]: `slope` of a cone, or `exponent`, and `height` at a radius
    `at_radius`.

    Example: viscotack simulate profile examples/from_toml/cone.toml
    """,
}
for _word, _door in _DOORS.items():
    simulate.command(_word, cls=asking(_door.questions), help=_HELP[_word])(_simulate)
simulate.command(
    "case",
    cls=asking(OF_FILE),
    help="""Simulate what a file states in SI, with whatever indenter.

    Shapes of your own have their table by their word, and --with says where they are.

    Example: viscotack simulate case examples/from_toml/cone.toml
    """,
)(_simulate)


def stated_problem(
    case: Path | None,
    context: Context,
    door: Door | None,
    own: Iterable[Path] | None = None,
) -> Case:
    """Return the problem that a file or the flags state; one in a file must be of the door."""
    given, also = answers(context), own_nouns(own or ())
    if case is None:
        if door is None:
            raise InputError("CASE.toml missing: the file that states the problem")
        return stated(door, given, also)
    flags = [f"--{name}" for name in given_of(given) if name != "temperature"]
    if flags:
        raise InputError(f"{case} states the whole problem; leave out {', '.join(flags)}")
    problem = read_case(case, also=also, temperature=temperature_of(given))
    if door is None or door.word == _door_of(problem):
        return problem
    found = _door_of(problem)
    raise InputError(
        f"{case} states a {found}, which has commands of its own: viscotack simulate "
        f"{found if found in _DOORS else 'case'} {case}"
    )


def deviation_of_shift(
    case: Path | None, context: Context, own: Iterable[Path] | None = None
) -> float:
    """Return how well the times of the material are known: standard deviation of log10 a_T."""
    given, also = answers(context), own_nouns(own or ())
    if case is None:
        return shift_deviation_of(given, also)
    return shift_deviation(case, temperature=temperature_of(given), also=also)


def say_deviation(case: Path | None, context: Context, own: Iterable[Path] | None = None) -> None:
    """Say how well the times of the material are known, where an answer does not hold it."""
    if (deviation := deviation_of_shift(case, context, own)) > 0:
        typer.echo(
            f"times of the material are known to {deviation:.2g} decades, from its shift with "
            "temperature, which this answer does not hold; viscotack predict does",
            err=True,
        )


def _seconds(time_limit: str | None) -> float | None:
    """Return the time limit [s] of a flag."""
    if time_limit is None:
        return None
    try:
        return card_of(TimeLimit).checked("it", parse(time_limit, "s"))
    except InputError as error:
        raise InputError(f'--time-limit: {error}; for example --time-limit "90 s"') from None


def _door_of(problem: Problem) -> str:
    """Return the command that simulates a problem in SI."""
    return "profile" if isinstance(problem.geometry, Cone) else problem.geometry.word


@application.command("show")
def show(
    file: Annotated[Path, Argument(metavar="FILE.npz", help="A result that --save wrote.")],
    plot_file: PlotFile = None,
    plot_kind: PlotWhat = PlotKind.FORCE,
    csv_file: CsvFile = None,
    cycles_file: CyclesFile = None,
    own: With = None,
    as_json: AsJson = False,
) -> None:
    """Show a saved result.

    Prints its summary; writes its curve as a table or draws it if wanted.
    """
    with wrong_input():
        files = Files(plot_file, plot_kind, csv_file, cycles_file)
        check_files(files.named, as_json=as_json, reads=(file,))
        if file.is_dir():
            raise InputError(f"{file} is a folder; give the name of a file")
        result = load(file, also=own_nouns(own or ()))
    _report(result, Writing(), as_json, files, own)


@dataclass(frozen=True)
class Files:
    """The files that are wanted beside the answer."""

    plot: Path | None
    kind: PlotKind
    curve: Path | None
    cycles: Path | None

    @property
    def named(self) -> dict[str, Path | None]:
        """The files by their flags."""
        return {"--plot": self.plot, "--csv": self.curve, "--cycles": self.cycles}


def _report(
    result: Result, write: Writing, as_json: bool, files: Files, own: Iterable[Path] | None
) -> None:
    with wrong_input():
        also = known(own_nouns(own or ())).observables
        write("wrote", files.curve, lambda file: write_csv(result, file))
        if result.outcome is not Outcome.STOPPED:
            write("wrote", files.cycles, lambda file: write_cycles(result, file))
        write.picture(files.plot, lambda: _DRAW[files.kind](result))
        answer = summary(result, also)
    write.answer(
        json.dumps(answer, indent=2, allow_nan=False) if as_json else _words(result, answer, also)
    )
    write.end()


def _words(result: Result, answer: dict[str, Any], also: Iterable[Observable]) -> str:
    """Return a summary as lines a person reads."""
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
            line += f"= {answer[f'{name}_{unit.tail}']:.4g} {unit.si}"
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
    cost = answer["statistics"]
    if cost.get("steps") is not None and answer["wall_time_s"] is not None:
        lines.append(f"  {cost['steps']:.0f} steps in {answer['wall_time_s']:.2f} s")
    return "\n".join(lines)


@contextmanager
def _progress() -> Iterator[Callable[[float], None] | None]:
    """Show a bar on standard error while somebody looks at it; yields what moves it."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    # the forecast takes the share of the way for that of the work, which it is about
    looks = (
        TextColumn("pulling"),
        BarColumn(),
        TimeElapsedColumn(),
        TextColumn("gone, about"),
        TimeRemainingColumn(),
        TextColumn("to go"),
    )
    with Progress(*looks, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("pulling", total=1.0)
        yield lambda done: bar.update(task, completed=done)


@contextmanager
def wrong_input() -> Iterator[None]:
    """Turn an error about the input into a paragraph on standard error and exit status 2.

    An error that nobody in here raised on purpose is a defect: its traceback, and exit status 3.
    """
    try:
        yield
    except InputError as error:
        _stop(str(error))
    except FileNotFoundError as error:
        _stop(f"there is no file {error.filename}")
    except IsADirectoryError as error:
        _stop(f"{error.filename} is a folder; give the name of a file")
    except BrokenPipeError:
        raise
    except OSError as error:
        _stop(str(error))
    except OverflowError:
        _stop("a number of the input is too large or too small to compute with; check its unit")
    except typer.Exit:
        raise
    except Exception:
        traceback.print_exc()
        _stop(
            "this is a defect of viscotack and not of the input; please report the lines above", 3
        )


def _stop(message: str, status: int = 2) -> NoReturn:
    typer.echo(harmless(f"viscotack: {message}"), err=True)
    raise typer.Exit(status)
