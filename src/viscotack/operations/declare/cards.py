"""Cards of the options of an operation: description, type, unit and range.

An option is a field of an operation with a card in its annotation. The type of the field determines
the rest: ``float | None`` is optional, ``tuple[Path, ...]`` can be repeated. The card converts the
input of the user, text or number, in the same way for every front end.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import Any, ClassVar, Protocol

from viscotack.cards import Quantity, plausible
from viscotack.errors import InputError
from viscotack.files.bounded import note_read
from viscotack.units import is_number, parse

# Of a table that an operation keeps in memory.
_MOST_ROWS = 100_000


class Place(Protocol):
    """Origin of a request; resolves file names."""

    @property
    def also(self) -> tuple[Any, ...]:
        """User-defined classes."""
        ...

    def file(self, name: str) -> Path:
        """Return the path of a file named by an option; InputError if it is not accessible."""
        ...

    def within(self, path: Path) -> "Place":
        """Return the place that resolves the file names inside a file."""
        ...


@dataclass(frozen=True)
class Card:
    """Base class of the cards of options.

    Attributes
    ----------
    words : str
        Description of the option, a sentence or two.
    metavar : str
        Placeholder of the value in help texts.
    flags : tuple of str
        Command-line options, if not ``--name``.
    argument : bool
        Whether it is a positional argument on the command line.
    example : str
        Example of a value.
    objects : tuple of classes
        Classes whose instances Python may pass unchanged.
    late : bool
        Whether it is read after the other options, because reading is slow.
    single : bool
        Whether a tuple is a single value, not repeated values.
    form : str
        Kind of field on the page.
    """

    late: ClassVar[bool] = False
    single: ClassVar[bool] = False
    # of the field that a page draws for it
    form: ClassVar[str] = "text"

    words: str
    metavar: str = field(default="", kw_only=True)
    flags: tuple[str, ...] = field(default=(), kw_only=True)
    argument: bool = field(default=False, kw_only=True)
    example: str = field(default="", kw_only=True)
    objects: tuple[type, ...] = field(default=(), kw_only=True)

    def value(self, given: Any, place: Place) -> Any:
        """Convert the input; instances of `objects` are returned unchanged."""
        return given if isinstance(given, self.objects) else self.read(given, place)

    def read(self, value: Any, place: Place) -> Any:
        """Convert the input to the value of the option; InputError if it is invalid."""
        raise NotImplementedError

    def written(self, value: Any) -> Any:
        """Convert a value to the form in a study file; reading it gives the same value."""
        return value

    @property
    def asks(self) -> tuple[str, ...]:
        """Names of the inputs, if the option consists of several."""
        return ()

    @property
    def schema(self) -> dict[str, Any]:
        """JSON schema of a value."""
        return {"type": "string", "maxLength": 200_000}


@dataclass(frozen=True)
class Number(Card):
    """A number, given as text with a unit, "5.19 mm", or as a number in SI.

    Attributes
    ----------
    unit : str
        SI unit; "1" for a pure number.
    above, least, most : float or None
        Open lower bound, closed lower bound and closed upper bound.
    bare : bool
        Whether text without a unit is accepted and means the SI unit.
    """

    form: ClassVar = "number"

    unit: str = field(default="1", kw_only=True)
    above: float | None = field(default=None, kw_only=True)
    least: float | None = field(default=None, kw_only=True)
    most: float | None = field(default=None, kw_only=True)
    bare: bool = field(default=False, kw_only=True)

    def read(self, value: Any, place: Place) -> float:
        """Return the number in SI, within its range."""
        if self.bare and isinstance(value, str) and is_number(value):
            value = float(value)
        number = parse(value, self.unit)
        range_ = Quantity(self.unit, "", "", above=self.above, least=self.least, most=self.most)
        return plausible("it", range_.checked("it", number), self.unit)

    def written(self, value: Any) -> Any:
        """Return the number with its unit and all its digits."""
        return value if self.unit == "1" else f"{float(value)!r} {self.unit}"

    @property
    def schema(self) -> dict[str, Any]:
        """A number in SI, or text with a unit."""
        bounds = {"exclusiveMinimum": self.above, "minimum": self.least, "maximum": self.most}
        number: dict[str, Any] = {"type": "number"}
        number |= {name: bound for name, bound in bounds.items() if bound is not None}
        text = {"type": "string", "maxLength": 200}
        return {"anyOf": [number, text]} | ({"unit": self.unit} if self.unit != "1" else {})


def number_of(card: Quantity, **more: Any) -> Number:
    """Create the card of an option from the card of a number.

    Description, unit, range and example are taken from the card; keywords are those of `Number`.
    """
    words = f"{card.words[0].upper()}{card.words[1:]}"
    words += f"; must {card.range}" if card.bounded else ""
    words += f', for example "{card.example}".' if card.example else "."
    ends = {"above": card.above, "least": card.least, "most": card.most}
    example = f'"{card.example}"' if card.example else ""
    return Number(words, unit=card.unit, example=example, **ends, **more)


@dataclass(frozen=True)
class Known(Number):
    """A known number and its standard uncertainty: two options.

    The value of the field is a pair. A study may state both in a list.
    """

    single: ClassVar = True

    uncertainty: str = field(default="Its standard uncertainty; needed with it.", kw_only=True)

    def written(self, value: Any) -> Any:
        """Return both numbers with their unit."""
        return [Number.written(self, each) for each in value]


@dataclass(frozen=True)
class Two(Card):
    """Two quantities with a comma between them, "8.86,101.6 K", or a list; the value is a pair."""

    single: ClassVar = True

    units: tuple[str, str] = field(default=("1", "1"), kw_only=True)

    def read(self, value: Any, place: Place) -> tuple[float, float]:
        """Return both numbers in SI."""
        both = value.split(",") if isinstance(value, str) else value
        if not isinstance(both, list | tuple) or len(both) != 2:
            raise InputError(f"needs two values with a comma between them, got {value!r:.60}")
        return self.number(both[0], self.units[0]), self.number(both[1], self.units[1])

    def number(self, value: Any, unit: str) -> float:
        """Return one of them in SI."""
        return parse(value.strip() if isinstance(value, str) else value, unit)

    def written(self, value: Any) -> Any:
        """Return both with their units and all their digits."""
        return ",".join(f"{x!r} {u}" for x, u in zip(value, self.units, strict=True))

    @property
    def schema(self) -> dict[str, Any]:
        """Text, or two numbers in SI."""
        pair = {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}
        return {"anyOf": [{"type": "string", "maxLength": 200}, pair]}


@dataclass(frozen=True)
class Whole(Card):
    """A whole number."""

    form: ClassVar = "number"

    least: int | None = field(default=None, kw_only=True)
    most: int | None = field(default=None, kw_only=True)

    def read(self, value: Any, place: Place) -> int:
        """Return the number within its range."""
        try:
            number = int(value) if not isinstance(value, str) or is_number(value) else None
        except (TypeError, ValueError, OverflowError):
            number = None
        is_fraction = isinstance(value, float) and value != number
        if number is None or is_fraction or isinstance(value, bool):
            raise InputError(f"expected a whole number, got {value!r:.60}")
        low = self.least is not None and number < self.least
        if low or (self.most is not None and number > self.most):
            least = "" if self.least is None else f"at least {self.least}"
            most = "" if self.most is None else f"at most {self.most}"
            raise InputError(f"must be {' and '.join(filter(None, (least, most)))}, got {number}")
        return number

    @property
    def schema(self) -> dict[str, Any]:
        """A whole number within its range."""
        bounds = {"minimum": self.least, "maximum": self.most}
        return {"type": "integer"} | {k: v for k, v in bounds.items() if v is not None}


@dataclass(frozen=True)
class Text(Card):
    """Text that the operation interprets."""

    def read(self, value: Any, place: Place) -> str:
        """Return the words."""
        if isinstance(value, bool) or not isinstance(value, str | int | float):
            raise InputError(f"expected text, got {value!r:.60}")
        if not str(value).strip():
            raise InputError("must not be empty")
        return str(value)


@dataclass(frozen=True)
class Choice(Card):
    """One of several words."""

    form: ClassVar = "choice"

    choices: tuple[str, ...] = field(default=(), kw_only=True)

    def read(self, value: Any, place: Place) -> str:
        """Return the word, one of the choices."""
        if value not in self.choices:
            raise InputError(f"must be one of {', '.join(self.choices)}, got {value!r:.60}")
        return value

    @property
    def schema(self) -> dict[str, Any]:
        """The choices."""
        return {"type": "string", "enum": list(self.choices)}


_SAID = {"true": True, "false": False, "1": True, "0": False, "yes": True, "no": False}


@dataclass(frozen=True)
class Switch(Card):
    """Yes or no."""

    form: ClassVar = "switch"

    def read(self, value: Any, place: Place) -> bool:
        """Return whether it is on."""
        found = value if isinstance(value, bool) else _SAID.get(str(value).lower())
        if found is None:
            raise InputError(f"must be true or false, got {value!r:.60}")
        return found

    @property
    def schema(self) -> dict[str, Any]:
        """True or false."""
        return {"type": "boolean"}


@dataclass(frozen=True)
class File(Card):
    """A file that the operation reads; over HTTP it is sent with the request.

    Attributes
    ----------
    elsewhere : bool
        Whether it replaces another option on the command line and has no option of its own.
    """

    form: ClassVar = "file"

    elsewhere: bool = field(default=False, kw_only=True)

    def read(self, value: Any, place: Place) -> Path:
        """Return the path of the file."""
        return place.file(_name(value))

    def written(self, value: Any) -> Any:
        """Return the path; `study_text` makes it relative to the study."""
        return Path(value)


@dataclass(frozen=True)
class Placed:
    """A file that names other files, and the place that named it.

    Attributes
    ----------
    path : Path
        The file.
    place : Place
        Of the request.
    """

    path: Path
    place: Place

    @property
    def inside(self) -> Place:
        """The place of the names that stand in the file."""
        return self.place.within(self.path)


@dataclass(frozen=True)
class FileOfNames(File):
    """A file that names other files; over HTTP these must be sent with the request."""

    def read(self, value: Any, place: Place) -> Placed:
        """Return the path of the file, which the operation reads, and its place."""
        return Placed(super().read(value, place), place)

    def written(self, value: Any) -> Any:
        """Return the path; `study_text` makes it relative to the study."""
        return value.path


@dataclass(frozen=True)
class Named(Card):
    """A published name or a file; the value is text that the operation interprets.

    Parameters
    ----------
    published : callable
        Returns the names.
    text : str
        Beginning of a text that is content, not a name, such as ``[material]``.
    """

    form: ClassVar = "named"

    published: Callable[[], Iterable[str]] = field(default=tuple, kw_only=True)
    text: str = field(default="", kw_only=True)

    def read(self, value: Any, place: Place) -> str:
        """Return the name, the content, or the path of the file."""
        words = _name(value)
        return str(place.file(words)) if self._is_file(words) else words

    def written(self, value: Any) -> Any:
        """Return the name or the content; `study_text` makes a path relative to the study."""
        return Path(value) if self._is_file(value) else value

    def _is_file(self, words: str) -> bool:
        is_content = bool(self.text) and words.lstrip().startswith(self.text)
        return not is_content and words not in self.published()


@dataclass(frozen=True)
class Naming:
    """Words that end with the path of a file."""

    words: str
    file: Path


@dataclass(frozen=True)
class Spelled(Card):
    """Text that may contain a file name, with or without a keyword, such as ``prony:FILE``.

    Parameters
    ----------
    before : tuple of str
        Keywords, with the separator, that precede a file name.
    endings : tuple of str
        Endings of file names without keyword.
    """

    before: tuple[str, ...] = field(default=(), kw_only=True)
    endings: tuple[str, ...] = field(default=(), kw_only=True)

    def read(self, value: Any, place: Place) -> str:
        """Return the words, in which a name of a file is the path of it."""
        words, file = self._split(_name(value))
        return f"{words}{place.file(file)}" if file else words

    def written(self, value: Any) -> Any:
        """Return the words; `study_text` makes a path among them relative to the study."""
        words, file = self._split(value)
        return Naming(words, Path(file)) if file else words

    def _split(self, words: str) -> tuple[str, str]:
        """Return the words before the name of a file, and that name; "" where there is none."""
        for keyword in self.before:
            # the first one, and not the end of another word
            begin = f":{words}".find(f":{keyword}")
            end = begin + len(keyword)
            if begin >= 0 and words[end:]:
                return words[:end], words[end:]
        return ("", words) if words.endswith(self.endings or "\0") else (words, "")


@dataclass(frozen=True)
class Folder(Card):
    """A folder on the machine that runs the operation."""

    form: ClassVar = "folder"

    def read(self, value: Any, place: Place) -> Path:
        """Return the path of the folder, into which no output may be written."""
        note_read(path := place.file(_name(value)))
        return path

    def written(self, value: Any) -> Any:
        """Return the path; `study_text` makes it relative to the study."""
        return Path(value)


@dataclass(frozen=True)
class Table(Card):
    """Rows by name: a list of objects, or the name of a CSV file or workbook with a heading.

    Cells of a file are text; the operation reads them, because it knows their units. An empty row
    is one of empty texts.
    """

    form: ClassVar = "rows"

    def read(self, value: Any, place: Place) -> tuple[Mapping[str, Any], ...]:
        """Return the rows."""
        if isinstance(value, str | Path):
            return rows_of_file(place.file(_name(value)))
        if not isinstance(value, list | tuple) or not all(isinstance(r, Mapping) for r in value):
            raise InputError(f"expected rows, [{{'name': number}}, ...], got {value!r:.60}")
        return tuple({str(name): cell for name, cell in row.items()} for row in value)

    def written(self, value: Any) -> Any:
        """Return the rows as tables."""
        return [dict(row) for row in value]

    @property
    def schema(self) -> dict[str, Any]:
        """A list of objects of numbers and text."""
        cell = {"type": ["number", "string"], "maxLength": 200}
        row = {"type": "object", "additionalProperties": cell}
        return {"type": "array", "items": row, "minItems": 1}


@dataclass(frozen=True)
class FileOrRows(File):
    """A table in a file, which the operation reads, or its rows as for `Table`."""

    def read(self, value: Any, place: Place) -> Any:
        """Return the path of the file, or the rows."""
        if isinstance(value, list | tuple):
            return Table(self.words).read(value, place)
        return super().read(value, place)

    def written(self, value: Any) -> Any:
        """Return the path, or the rows as tables."""
        return Path(value) if isinstance(value, str | Path) else [dict(row) for row in value]

    @property
    def schema(self) -> dict[str, Any]:
        """The name of a file, or a list of objects."""
        return {"anyOf": [super().schema, Table(self.words).schema]}


def rows_of_file(path: Path) -> tuple[Mapping[str, str], ...]:
    """Return the rows of a table by its headings."""
    from viscotack.campaign.listed import read_words

    names, lines = read_words(path, empty=True)
    rows = tuple(dict(zip(names, row, strict=True)) for _, row in islice(lines, _MOST_ROWS + 1))
    if len(rows) > _MOST_ROWS:
        raise InputError(f"{path} has more than {_MOST_ROWS:,} rows; run a campaign")
    return rows


def _name(value: Any) -> str:
    if not isinstance(value, str | Path) or not str(value) or "\0" in str(value):
        raise InputError(f"expected the name of a file, got {value!r:.60}")
    return str(value)
