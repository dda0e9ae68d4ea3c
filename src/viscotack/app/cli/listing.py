"""The list of all commands: each is imported when it runs, shows its help or is completed."""

from collections.abc import Callable
from typing import Any

import typer
from typer.core import TyperCommand, TyperGroup

from viscotack.app.operations import COMMANDS, SECTIONS

from .commands import application

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
                formatter.write_dl([(n, self.commands[n].get_short_help_str(70)) for n in names])


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
