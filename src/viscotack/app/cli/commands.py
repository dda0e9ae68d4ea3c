"""The commands: reads flags and files, runs the simulation, writes words, tables and pictures.

Exit status: 0 done, 1 the simulation failed (its status says why), 2 the input is wrong or a file
could not be written, 3 a defect of viscotack.
With --json exactly one object goes to standard output, everything else to standard error.
"""

import dis
import json
import sys
import traceback
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer
from typer import Argument, Option

from viscotack import __version__
from viscotack.pictures import plot
from viscotack.problem import Problem
from viscotack.problem.case_file import read_case
from viscotack.problem.problems import Case
from viscotack.problem.profile_problem import ProfileProblem
from viscotack.problem.punch_problem import PunchProblem
from viscotack.result import Outcome, Result, load, save, write_csv
from viscotack.result.observables import summary
from viscotack.result.outputs import kind_of

from .flags import problem_from_flags
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
SaveFile = Annotated[
    Path | None,
    Option("--save", "-o", metavar="FILE", help="Save all of the result, for viscotack show."),
]
HowFar = Annotated[
    Until,
    Option("--until", help="Stop just past the force minimum, or when the surfaces are apart."),
]
Accuracy = Annotated[
    float, Option("--accuracy", metavar="RELATIVE", help="Accuracy wanted of the pull-off force.")
]
AsJson = Annotated[
    bool, Option("--json", help="Print one JSON object on standard output instead of words.")
]


def flag(name: str, metavar: str, words: str) -> Any:
    """Return an option of a command that states a problem."""
    return Option(name, metavar=metavar, help=words, show_default=False)


CaseFile = Annotated[
    Path | None,
    Argument(
        metavar="CASE.toml",
        help="A problem in SI with units, instead of the flags of the problem; docs/input.md "
        "describes it.",
        show_default=False,
    ),
]
Ratio = Annotated[
    float | None, flag("--modulus-ratio", "K", "Rubbery over glassy modulus, in (0, 1].")
]
Exponent = Annotated[float | None, flag("--exponent", "N", "Exponent of the power law, in (0, 3].")]
Rate = Annotated[
    float | None,
    flag(
        "--rate",
        "RATE",
        "Retraction speed, in h0/tau0 (prony: h0 per unit of time); with --move it may be left "
        "out, and the test ends with the last move.",
    ),
]
Gap = Annotated[
    float | None,
    flag("--apart", "GAP", "Or: start at rest with the surfaces this far apart, in h0."),
]
Moves = Annotated[
    list[str] | None,
    flag(
        "--move",
        "WORDS",
        "What the machine does before the retraction; give it once for each move. 'approach "
        "SPEED to WHERE', 'retract SPEED to WHERE' (WHERE: depth, force or radius and a "
        "number), 'move to DEPTH in TIME', 'load to FORCE in TIME', 'dwell TIME', 'hold "
        "drive|depth|force TIME'; all dimensionless.",
    ),
]
LawName = Annotated[
    str | None,
    flag(
        "--law",
        "LAW",
        "Forces across the gap: lennard-jones (also when left out), dugdale, "
        "exponential:DECAY (decay length over h0), or table:FILE, a CSV file with the header "
        "'gap_nm,traction_kPa' or other units.",
    ),
]


@application.callback(invoke_without_command=True)
def _viscotack(
    version: Annotated[bool, Option("--version", help="Print the version and exit.")] = False,
) -> None:
    if version:
        typer.echo(f"viscotack {__version__}")
        raise typer.Exit


@simulate.command("sphere")
def simulate_sphere(
    case: CaseFile = None,
    tabor: Annotated[
        float | None,
        flag("--tabor", "MU", "Tabor number, (R dg0^2/(E0*^2 h0^3))^(1/3)."),
    ] = None,
    material: Annotated[
        str | None,
        flag(
            "--material",
            "MATERIAL",
            "power-law (also when left out): modified power law by its retardation spectrum. "
            "elastic: no memory; --rate is only needed in SI, in h0/s. sls: standard linear solid, "
            "tau0 is its retardation time. prony:FILE: CSV file with the header "
            "'modulus_ratio,relaxation_time_s' and a branch a row, its modulus over the rubbery "
            "modulus and its relaxation time. The unit of time (of --rate and of the crack speed) "
            "is then that of the header: s, ms, ..., or none. FILE.toml: a passport, as `viscotack "
            "material fit` writes it.",
        ),
    ] = None,
    modulus_ratio: Ratio = None,
    exponent: Exponent = None,
    preload: Annotated[
        float | None,
        flag("--preload", "DEPTH", "Relaxed start at this depth, in h0, positive into the solid."),
    ] = None,
    preload_force: Annotated[
        float | None,
        flag(
            "--preload-force",
            "FORCE",
            "Or: relaxed start under this force, in 1.5 pi R dg0, positive in compression.",
        ),
    ] = None,
    preload_radius: Annotated[
        float | None,
        flag(
            "--preload-radius",
            "RADIUS",
            "Or: relaxed start at this contact radius, in (pi R^2 dg0/E0*)^(1/3).",
        ),
    ] = None,
    apart: Gap = None,
    move: Moves = None,
    stiffness: Annotated[
        float | None,
        flag("--stiffness", "K", "Of the machine, in 1.5 pi R dg0/h0; rigid when left out."),
    ] = None,
    rate: Rate = None,
    law: LawName = None,
    radius: Annotated[
        str | None,
        flag(
            "--radius",
            "LENGTH",
            'For answers in SI as well: sphere radius R with its unit, "5.19 mm". The next ones '
            "go with it.",
        ),
    ] = None,
    contact_modulus: Annotated[
        str | None,
        flag("--contact-modulus", "PRESSURE", 'SI: E0* = E0/(1 - nu^2), "1.94 MPa".'),
    ] = None,
    work_of_adhesion: Annotated[
        str | None,
        flag("--work-of-adhesion", "ENERGY", 'SI: dg0, "0.1523 J/m^2"; or --equilibrium-gap.'),
    ] = None,
    equilibrium_gap: Annotated[
        str | None, flag("--equilibrium-gap", "LENGTH", 'SI: h0, "1.55 um".')
    ] = None,
    tau0: Annotated[
        str | None, flag("--tau0", "TIME", 'SI: the time of the material, "18.76 ms".')
    ] = None,
    poisson_ratio: Annotated[
        str | None, flag("--poisson-ratio", "NU", "SI: Poisson ratio, 0 to 0.5.")
    ] = None,
    until: HowFar = Until.DETACHED,
    accuracy: Accuracy = 2e-3,
    plot_file: PlotFile = None,
    plot_kind: PlotWhat = PlotKind.FORCE,
    csv_file: CsvFile = None,
    save_file: SaveFile = None,
    as_json: AsJson = False,
) -> None:
    """Pull a rigid sphere off a soft viscoelastic half-space.

    The problem is stated by dimensionless numbers, or in SI by a file. R is the sphere radius,
    E0 the rubbery modulus, dg0 the work of adhesion, h0 the equilibrium gap, tau0 the time of the
    material.

    Example: viscotack simulate sphere --tabor 3.24 --modulus-ratio 0.1 --exponent 0.8
    --preload 73 --rate 316.23
    """
    flags = {
        "tabor": tabor,
        "material": material,
        "modulus-ratio": modulus_ratio,
        "exponent": exponent,
        "preload": preload,
        "preload-force": preload_force,
        "preload-radius": preload_radius,
        "apart": apart,
        "move": move or None,
        "stiffness": stiffness,
        "rate": rate,
        "law": law,
        "radius": radius,
        "contact-modulus": contact_modulus,
        "work-of-adhesion": work_of_adhesion,
        "equilibrium-gap": equilibrium_gap,
        "tau0": tau0,
        "poisson-ratio": poisson_ratio,
    }
    carry_out(
        lambda: stated_problem(case, flags, problem_from_flags, Problem),
        accuracy=accuracy,
        until=until,
        case=case,
        files=(plot_file, csv_file, save_file),
        plot_kind=plot_kind,
        as_json=as_json,
    )


@simulate.command("profile")
def simulate_profile(
    case: Annotated[Path, Argument(metavar="CASE.toml", help="Problem in SI, see docs/input.md.")],
    until: HowFar = Until.DETACHED,
    accuracy: Accuracy = 2e-3,
    plot_file: PlotFile = None,
    plot_kind: PlotWhat = PlotKind.FORCE,
    csv_file: CsvFile = None,
    save_file: SaveFile = None,
    as_json: AsJson = False,
) -> None:
    """Pull a cone, or another indenter with the profile A r^q, off a viscoelastic half-space.

    The file has a table [profile] in place of [sphere]: `slope` of a cone, or `exponent`, and
    `height` at a radius `at_radius`.

    Example: viscotack simulate profile examples/from_toml/cone.toml
    """
    carry_out(
        lambda: stated_problem(case, {}, problem_from_flags, ProfileProblem),
        accuracy=accuracy,
        until=until,
        case=case,
        files=(plot_file, csv_file, save_file),
        plot_kind=plot_kind,
        as_json=as_json,
    )


def stated_problem(
    case: Path | None, flags: Mapping[str, Any], from_flags: Callable[[Any], Case], kind: type
) -> Case:
    """Return the problem that a file or the flags state; one in a file must be of the kind."""
    if case is None:
        return from_flags(flags)
    given = [f"--{name}" for name, value in flags.items() if value is not None]
    if given:
        raise ValueError(f"{case} states the whole problem; leave out {', '.join(given)}")
    problem = read_case(case)
    if not isinstance(problem, kind):
        found = {PunchProblem: "punch", ProfileProblem: "profile"}.get(type(problem), "sphere")
        raise ValueError(f"{case} states a {found}, which has commands of its own")
    return problem


def carry_out(
    state: Callable[[], Case],
    *,
    accuracy: float,
    until: Until,
    case: Path | None,
    files: tuple[Path | None, Path | None, Path | None],
    plot_kind: PlotKind,
    as_json: bool,
) -> None:
    """Simulate a problem and report; the files are for picture, table and result.

    `case` is the file that states the problem, if one does: it is never written.
    """
    plot_file, csv_file, save_file = files
    with wrong_input():
        named = {"--plot": plot_file, "--csv": csv_file, "--save": save_file}
        check_files(named, as_json=as_json, reads=(case,))
        problem = state()
        from viscotack.bem import solve

        with _progress() as progress:
            result = solve(
                problem, accuracy=accuracy, until=str(until), throw=False, progress=progress
            )
    write = Writing()
    write("saved", save_file, lambda file: save(result, file))
    _report(result, write, as_json, plot_file, plot_kind, csv_file)
    if result.outcome is Outcome.STOPPED:
        raise typer.Exit(1)


@application.command("show")
def show(
    file: Annotated[Path, Argument(metavar="FILE.npz", help="A result that --save wrote.")],
    plot_file: PlotFile = None,
    plot_kind: PlotWhat = PlotKind.FORCE,
    csv_file: CsvFile = None,
    as_json: AsJson = False,
) -> None:
    """Show a saved result.

    Prints its summary; writes its curve as a table or draws it if wanted.
    """
    with wrong_input():
        check_files({"--plot": plot_file, "--csv": csv_file}, as_json=as_json, reads=(file,))
        if file.is_dir():
            raise ValueError(f"{file} is a folder; give the name of a file")
        result = load(file)
    _report(result, Writing(), as_json, plot_file, plot_kind, csv_file)


def _report(
    result: Result,
    write: Writing,
    as_json: bool,
    plot_file: Path | None,
    kind: PlotKind,
    csv_file: Path | None,
) -> None:
    write("wrote", csv_file, lambda file: write_csv(result, file))
    write.picture(plot_file, lambda: _DRAW[kind](result))
    answer = summary(result)
    write.answer(
        json.dumps(answer, indent=2, allow_nan=False) if as_json else _words(result, answer)
    )
    write.end()


def _words(result: Result, answer: dict[str, Any]) -> str:
    """Return a summary as lines a person reads."""
    lines = [answer["status"]]
    for name, observable in kind_of(result.problem).observables.items():
        value, unit = answer[name], observable.unit
        if value is None:
            continue
        line = f"  {observable.words:<21}{value:>12.5g}  {unit.text:<30}"
        if f"{name}_{unit.tail}" in answer:
            line += f"= {answer[f'{name}_{unit.tail}']:.4g} {unit.si}"
        lines.append(line.rstrip())
        if answer.get(f"{name}_note"):
            lines.append(f"  {'':<21}  {answer[f'{name}_note']}")
    if answer["error_estimate"] is None:
        lines.append("  numerical error      not known: no coarser run to compare with")
    for name, share in (answer["error_estimate"] or {}).items():
        if share is not None:
            lines.append(f"  {'error of the ' + name:<21}{share:>12.1e}  estimated, relative")
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
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    looks = (TextColumn("pulling"), BarColumn(), TimeElapsedColumn())
    with Progress(*looks, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("pulling", total=1.0)
        yield lambda done: bar.update(task, completed=done)


@contextmanager
def wrong_input() -> Iterator[None]:
    """Turn an error about the input into a paragraph on standard error and exit status 2.

    An error that something inside raised unasked is a defect: its traceback, and exit status 3.
    """
    try:
        yield
    except FileNotFoundError as error:
        _stop(f"there is no file {error.filename}")
    except IsADirectoryError as error:
        _stop(f"{error.filename} is a folder; give the name of a file")
    except OSError as error:
        _stop(str(error))
    except OverflowError:
        _stop("a number of the input is too large or too small to compute with; check its unit")
    except Exception as error:
        if isinstance(error, ValueError) and _raised_here(error):
            _stop(str(error))
        traceback.print_exc()
        _stop(
            "this is a defect of viscotack and not of the input; please report the lines above", 3
        )


def _raised_here(error: BaseException) -> bool:
    """Return whether a `raise` in the package made the error, and not something it called."""
    place = error.__traceback__
    while place is not None and place.tb_next is not None:
        place = place.tb_next
    if place is None:
        return False
    # int(nan) and the like have no frame of their own: only the instruction tells
    asked = place.tb_frame.f_code.co_code[place.tb_lasti] == dis.opmap["RAISE_VARARGS"]
    module = place.tb_frame.f_globals.get("__name__", "")
    return asked and module.partition(".")[0] == __name__.partition(".")[0]


def _stop(message: str, status: int = 2) -> NoReturn:
    typer.echo(f"viscotack: {message}", err=True)
    raise typer.Exit(status)
