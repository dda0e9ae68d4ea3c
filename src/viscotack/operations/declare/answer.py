"""Answers of operations, and the files that they can write."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    from viscotack.files.whole import Target

Told = Mapping[str, Any]
# Outputs besides files that HTTP and the page may request of every answer.
WORDS, DRAWN = "words", "drawn"


@dataclass(frozen=True)
class Output:
    """A file that an operation can write.

    Attributes
    ----------
    name : str
        Name of the output: ``csv``, ``plot``.
    words : str
        Description of its content.
    kind : str
        "text", "picture" or "binary".
    flags : tuple of str
        Command-line options, if not ``--name``.
    metavar, done : str
        Placeholder in the help text, and message after writing.
    needed : bool
        Whether the output is required.
    usual : str
        Default destination.
    endings : tuple of str
        Endings of file names that suit the format; () for any.
    """

    name: str
    words: str
    kind: Literal["text", "picture", "binary"] = "text"
    flags: tuple[str, ...] = ()
    metavar: str = "FILE"
    done: str = ""
    needed: bool = False
    usual: str = ""
    endings: tuple[str, ...] = ()

    @property
    def flag(self) -> str:
        """Command-line option that messages name."""
        return next((f for f in self.flags if f.startswith("--")), f"--{self.name}")

    @property
    def said(self) -> str:
        """Message after the file was written."""
        return self.done or ("drew" if self.kind == "picture" else "wrote")


def csv_file(words: str = "Write a table; - is standard output.", name: str = "csv") -> Output:
    """Declare a CSV table as output."""
    return Output(name, words, endings=(".csv", ".txt", ".dat"))


def picture(words: str = "Draw to a .png, .pdf or .svg file.", name: str = "plot") -> Output:
    """Declare a figure as output."""
    return Output(name, words, "picture")


@dataclass(frozen=True)
class Caller:
    """Context of a request: progress callback, wanted outputs and user-defined classes.

    Attributes
    ----------
    tell : callable
        Called with progress data: completed ``share``, current step ``doing``, message ``words``,
        and whether it is ``urgent``. An exception that it raises ends the operation.
    wants : frozenset of str
        Names of the outputs that will be written.
    also : tuple of classes
        User-defined laws, materials, shapes and observables.
    own : tuple of str
        Files that define them.
    folder : Path
        Base folder of relative file names in a study that is written to a stream.

    Examples
    --------
    >>> Caller(wants=frozenset({"csv"})).also
    ()
    """

    tell: Callable[[Told], None] = lambda told: None
    wants: frozenset[str] = frozenset()
    also: tuple[Any, ...] = ()
    own: tuple[str, ...] = ()
    folder: Path = Path()


@dataclass(frozen=True)
class Answer:
    """Result of an operation, returned by :func:`ask`; representations are created on demand.

    Attributes
    ----------
    found : object
        The result as a Python object.
    record : callable
        Returns plain data, numbers in SI with the unit in the name, as printed by ``--json`` and
        returned over HTTP.
    words : callable
        Returns text for the terminal.
    files : mapping
        Name of an output -> function that writes it to a target.
    pictures : mapping
        Name of an output -> function that returns a figure.
    drawn : callable, optional
        Returns curves for the page.
    notes : tuple of str
        Warnings and remarks, such as rejected files.
    status : int
        Exit status of the command: 1 if the simulation failed, 4 if some cases failed.
    """

    found: Any
    record: Callable[[], Any]
    words: Callable[[], str]
    files: Mapping[str, Callable[["Target"], None]] = field(default_factory=dict)
    pictures: Mapping[str, Callable[[], Any]] = field(default_factory=dict)
    drawn: Callable[[], dict[str, Any]] | None = None
    notes: tuple[str, ...] = ()
    status: int = 0

    def __str__(self) -> str:
        """Return the text."""
        return self.words()
