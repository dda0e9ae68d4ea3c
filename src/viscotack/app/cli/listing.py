"""The list of all commands: each is imported when it runs, shows its help or is completed."""

from collections.abc import Callable
from typing import Any

import typer
from typer.core import TyperCommand

from viscotack.operations import Declared, declared

from .commands import application

_GROUPS = {
    "simulate": "Simulate a contact.",
    "theory": "Evaluate a closed-form theory.",
    "material": "Fit, show, convert and export materials.",
    "test": "Evaluate files of a tack tester or microscope: pull-off forces and speeds.",
    "identify": "Fit work of adhesion and range of attraction to measured curves.",
    "campaign": "Run many problems by a plan; resumable, results as a table.",
}


class Later(TyperCommand):
    """A command whose options are not known yet; its callback returns the complete command."""

    def make_context(self, *words: Any, **more: Any) -> Any:
        """Parse arguments with the complete command, which also runs and prints the help."""
        complete = self.callback
        assert complete is not None
        return complete().make_context(*words, **more)


def add_commands() -> None:
    """Add the commands of all operations to the application."""
    groups: dict[str, typer.Typer] = {}
    for each in declared().values():
        for path, words, complete in _commands(each):
            first, _, rest = path.partition(" ")
            place = application
            if rest:
                if first not in groups:
                    groups[first] = typer.Typer(
                        help=_GROUPS.get(first, ""), no_args_is_help=True, rich_markup_mode=None
                    )
                    application.add_typer(groups[first], name=first)
                place = groups[first]
            place.command(rest or first, cls=Later, help=words)(complete)


def _commands(each: Declared) -> list[tuple[str, str, Callable[[], Any]]]:
    """Return the commands of an operation: path, help and completion."""
    if not each.helps:
        return [(each.word, each.help, _completing(each.word))]
    return [
        (f"{each.word} {name}", words, _completing(each.word, name))
        for name, words in each.helps.items()
    ]


def _completing(word: str, name: str | None = None) -> Callable[[], Any]:
    """Return the function that imports an operation and makes its command."""

    def complete() -> Any:
        from .reading import command_of

        return command_of(word, name)

    return complete
