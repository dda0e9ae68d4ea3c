"""The command-line application: its commands, imported when they run, and its error handling.

Exit status: 0 success; 1 the simulation failed (its status gives the reason); 2 invalid input, or a
file could not be written; 3 a defect of viscotack; 130 interrupted by ctrl-C.
With --json exactly one object is written to standard output, everything else to standard error.
"""

import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer
from typer import Argument, Option
from typer.core import TyperCommand, TyperGroup

from viscotack.app.operations import COMMANDS, SECTIONS
from viscotack.errors import TOO_LARGE, InputError
from viscotack.files.text import harmless
from viscotack.version import __version__

if TYPE_CHECKING:
    from viscotack.app.operations.request import Request

application = typer.Typer(
    help="How hard must one pull? Detachment of soft, sticky, rate-dependent contacts.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)

AsJson = Annotated[
    bool, Option("--json", help="Print one JSON object on standard output instead of words.")
]
Force = Annotated[
    bool, Option("--force", help="Replace output files that exist; never a file that was read.")
]
With = Annotated[
    list[Path] | None,
    Option(
        "--with",
        metavar="FILE.py",
        help="A Python file with user-defined laws, materials, shapes or observables "
        "(docs/own.md). The file is executed. Can be repeated.",
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


@contextmanager
def wrong_input(kind: "type[Request] | None" = None) -> Iterator[None]:
    """Report invalid input on standard error and exit with status 2.

    An option of the request `kind` that an error names is spelled as a flag.

    Any unexpected exception is a defect: its traceback is printed, and the exit status is 3.
    """
    try:
        yield
    except InputError as error:
        _stop(_spelled(error, kind))
    except FileNotFoundError as error:
        _stop(f"there is no file {error.filename}")
    except IsADirectoryError as error:
        _stop(f"{error.filename} is a folder; give the name of a file")
    except BrokenPipeError:
        raise
    except OSError as error:
        _stop(str(error))
    except OverflowError:
        _stop(TOO_LARGE)
    except typer.Exit:
        raise
    except Exception:
        traceback.print_exc()
        _stop(
            "this is a defect of viscotack and not of the input; please report the lines above", 3
        )


@application.command("study")
def study_command(
    file: Annotated[
        Path,
        Argument(
            metavar="STUDY.toml",
            help='A study: operation = "identify rates", its options by name, and a table [write] '
            "with the output files; docs/operations.md describes it.",
            show_default=False,
        ),
    ],
    own: With = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Run the operation of a study file with its options.

    File names in the study are relative to its folder. The output is the same as of the command of
    the operation.

    Example: viscotack study lens.toml
    """
    with wrong_input():
        from viscotack.app.operations.study import read_study

        from .running import carry_out

        study = read_study(file)
        files = {output: study.write.get(output.name) for output in study.request.outputs}
        carry_out(study.request, files, own or (), force=force, as_json=as_json, study=file)


def _spelled(error: InputError, kind: "type[Request] | None") -> str:
    """Return the message of an error, with the field that it names as the flag."""
    from viscotack.app.operations.flags import in_flags

    words, name = str(error), error.field
    if name and words.startswith(name):
        words = f"`{name}`{words.removeprefix(name)}"
    return in_flags(words, kind)


def _stop(message: str, status: int = 2) -> NoReturn:
    typer.echo(harmless(f"viscotack: {message}"), err=True)
    raise typer.Exit(status)


_GROUPS = {
    "theory": "Evaluate a closed-form theory.",
    "material": "Fit, show, convert and export materials.",
    "export": "Write contacts for other programs.",
    "test": "Evaluate files of a tack tester or microscope: pull-off forces and speeds.",
    "identify": "Fit work of adhesion and range of attraction to measured curves.",
    "campaign": "Run many problems by a plan; resumable, results as a table.",
}


class BySection(TyperGroup):
    """A group whose help lists the commands by what a person does."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the commands of each section."""
        for title, commands in SECTIONS.items():
            names = dict.fromkeys(name.partition(" ")[0] for name in commands)
            with formatter.section(title):
                formatter.write_dl([(n, self.commands[n].get_short_help_str(80)) for n in names])


class Later(TyperCommand):
    """A command whose options are not known yet; its callback returns the complete command."""

    def make_context(self, *words: Any, **more: Any) -> Any:
        """Parse arguments with the complete command, which also runs and prints the help."""
        complete = self.callback
        assert complete is not None
        return complete().make_context(*words, **more)


def add_commands() -> None:
    """Add the commands of all operations to the application."""
    application.info.cls = BySection
    groups: dict[str, typer.Typer] = {}
    for name, (module, summary) in COMMANDS.items():
        if not module:
            continue
        first, _, rest = name.partition(" ")
        place = application
        if rest:
            if first not in groups:
                words = _GROUPS[first]
                groups[first] = typer.Typer(help=words, no_args_is_help=True, rich_markup_mode=None)
                application.add_typer(groups[first], name=first)
            place = groups[first]
        place.command(rest or first, cls=Later, help=summary)(_completing(name))


def _completing(name: str) -> Callable[[], Any]:
    """Return the function that imports an operation and makes its command."""

    def complete() -> Any:
        from .making import command_of

        return command_of(name)

    return complete
