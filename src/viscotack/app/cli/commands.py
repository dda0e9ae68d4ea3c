"""The commands: reads flags and files, runs the simulation, writes words, tables and pictures.

Exit status: 0 done, 1 the simulation failed (its status says why), 2 the input is wrong or a file
could not be written, 3 a defect of viscotack.
With --json exactly one object goes to standard output, everything else to standard error.
"""

import traceback
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import Annotated, NoReturn

import typer
from typer import Argument, Context, Option

from viscotack.app.cli.asking import answers
from viscotack.cards import card_of
from viscotack.errors import InputError
from viscotack.files.text import harmless
from viscotack.geometry import Cone
from viscotack.operations.declare.questions import (
    Door,
    given_of,
    question_of,
    shift_deviation_of,
    stated,
    temperature_of,
)
from viscotack.pictures import plot
from viscotack.problem import Case, Problem
from viscotack.problem.accuracy import Accuracy as AccuracyCard
from viscotack.problem.accuracy import TimeLimit
from viscotack.problem.case_file import read_case, shift_deviation
from viscotack.problem.nouns import own_nouns
from viscotack.version import __version__

application = typer.Typer(
    help="How hard must one pull? Detachment of soft, sticky, rate-dependent contacts.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)


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
        f"{found if found in ('sphere', 'punch', 'profile') else 'case'} {case}"
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


def _door_of(problem: Problem) -> str:
    """Return the command that simulates a problem in SI."""
    return "profile" if isinstance(problem.geometry, Cone) else problem.geometry.word


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
