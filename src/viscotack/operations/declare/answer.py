"""What an operation answers, and what it may write beside it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    from viscotack.files.whole import Target

Told = Mapping[str, Any]
# What may be wanted of every answer beside its files, by HTTP and the page.
WORDS, DRAWN = "words", "drawn"


@dataclass(frozen=True)
class Output:
    """A file that an operation may write.

    Attributes
    ----------
    name : str
        Of the file among those of the operation: ``csv``, ``plot``.
    words : str
        What is in it.
    kind : str
        "text", "picture", or "binary" for what is neither.
    flags : tuple of str
        Spelling on the command line, where it is not ``--name``.
    metavar, done : str
        What stands for the name in help, and what is said when it is written.
    needed : bool
        Whether the operation is asked for this file.
    usual : str
        Where it goes when nobody says.
    ending : str
        That its name must have, ".mat"; "" for any.
    """

    name: str
    words: str
    kind: Literal["text", "picture", "binary"] = "text"
    flags: tuple[str, ...] = ()
    metavar: str = "FILE"
    done: str = ""
    needed: bool = False
    usual: str = ""
    ending: str = ""

    @property
    def flag(self) -> str:
        """The flag that messages name."""
        return next((f for f in self.flags if f.startswith("--")), f"--{self.name}")

    @property
    def said(self) -> str:
        """What is said when it is written."""
        return self.done or ("drew" if self.kind == "picture" else "wrote")


def csv_file(words: str = "Write a table; - is standard output.", name: str = "csv") -> Output:
    """Return the output that is a table."""
    return Output(name, words)


def picture(words: str = "Draw to a .png, .pdf or .svg file.", name: str = "plot") -> Output:
    """Return the output that is a picture."""
    return Output(name, words, "picture")


@dataclass(frozen=True)
class Caller:
    """Who asks: what is told while the answer is made, and what is wanted of it.

    Attributes
    ----------
    tell : callable
        Is given what an operation tells of itself: ``share`` of its work, what it is ``doing``,
        ``words`` on how far it is, whether they are ``urgent``. It may raise, which ends the
        operation.
    wants : frozenset of str
        Names of the outputs that will be written.
    also : tuple of classes
        Laws, materials, shapes and observables of the user's own.
    own : tuple of str
        The files that they stand in.
    folder : Path
        That names in a study are relative to, where it is written to a stream.
    """

    tell: Callable[[Told], None] = lambda told: None
    wants: frozenset[str] = frozenset()
    also: tuple[Any, ...] = ()
    own: tuple[str, ...] = ()
    folder: Path = Path()


@dataclass(frozen=True)
class Answer:
    """What came of an operation. All but `found` is made when it is asked for.

    Attributes
    ----------
    found : object
        As Python has it.
    record : callable
        Returns it as plain data, numbers in SI with the unit in the name: what ``--json`` prints
        and HTTP answers.
    words : callable
        Returns it as lines that a person reads.
    files : mapping
        Name of an output -> what writes it to a target.
    pictures : mapping
        Name of an output -> what draws it and returns a figure.
    drawn : callable, optional
        Returns curves for the page, beside the record.
    notes : tuple of str
        What is said beside the answer: files that were refused, doubts.
    status : int
        Exit status of the command: 1 where the simulation failed, 4 where some cases did.
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
        """Return the words."""
        return self.words()
