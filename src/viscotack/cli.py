"""The command line: ``viscotack simulate sphere ...``. Words in, words and pictures out."""

from collections.abc import Sequence


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line with these arguments, or with those of the process."""
    # The library of the command line takes a while to import; `import viscotack` never pays it.
    from .theory_commands import application

    application(None if arguments is None else list(arguments), prog_name="viscotack")
