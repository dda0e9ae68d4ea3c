"""The list of all commands: each is imported when it runs, shows its help or is completed."""

from collections.abc import Callable
from typing import Any

import typer
from typer.core import TyperCommand

from viscotack.operations import Declared, declared

from .commands import application

_GROUPS = {
    "simulate": "Simulate a contact.",
    "theory": "Ask a closed form.",
    "material": "From a laboratory's file to a material, and on to other programs.",
    "test": "From the files of a tack tester or a microscope to pull-off forces and speeds.",
    "identify": "From measured curves to the interface: work of adhesion and range of attraction.",
    "campaign": "Run many problems: a plan, a folder that survives every stop, a table.",
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
    """Return the commands of an operation: path, help, and what completes it."""
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
