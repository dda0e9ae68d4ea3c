"""Options of requests: what a field of a request takes, and the files that it can write."""

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import NoneType
from typing import Any, ClassVar, Literal, get_args, get_origin

from pydantic import Field
from pydantic.fields import FieldInfo
from pydantic_core import core_schema

from viscotack.cards import Quantity, plausible
from viscotack.errors import InputError
from viscotack.units import is_number, parse

_OBJECT = {"type": "object"}
# Words of what can be stated by flags.
INDENTERS = ("sphere", "punch", "profile", "disc")


@dataclass(frozen=True)
class Option:
    """Description of a field of a request.

    Attributes
    ----------
    words : str
        A sentence or two for the user.
    metavar : str
        Placeholder of the value in help texts.
    flags : tuple of str
        Command-line options, if not ``--name``.
    argument : bool
        Whether it is a positional argument on the command line.
    example : str
        Example of a value.
    """

    words: str
    metavar: str = field(default="", kw_only=True)
    flags: tuple[str, ...] = field(default=(), kw_only=True)
    argument: bool = field(default=False, kw_only=True)
    example: str = field(default="", kw_only=True)

    # of the field that the page draws for it, if its type does not tell
    form: ClassVar[str] = ""

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        """Add the description to the JSON schema of the type."""
        found = handler(schema)
        return {k: v for k, v in found.items() if k != "title"} | {"description": self.words}


class _Read(Option):
    """An option whose value a function of its own reads; the type may be optional, or repeated."""

    schema: ClassVar[dict[str, Any]] = {"type": "string", "maxLength": 200_000}

    def read(self, value: Any) -> Any:
        """Return the value; InputError if it is invalid."""
        raise NotImplementedError

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        """Read each value by `read`."""
        kinds = get_args(source) or (source,)
        found: Any = core_schema.no_info_plain_validator_function(self.read)
        if get_origin(source) is tuple and Ellipsis in kinds:
            return core_schema.tuple_variable_schema(found)
        return core_schema.nullable_schema(found) if NoneType in kinds else found

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        """Return the JSON schema of a value, or of a list of them."""
        if schema["type"] == "tuple":
            return {"type": "array", "items": self.schema, "description": self.words}
        return self.schema | {"description": self.words}


@dataclass(frozen=True)
class Number(_Read):
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

    unit: str = "1"
    above: float | None = field(default=None, kw_only=True)
    least: float | None = field(default=None, kw_only=True)
    most: float | None = field(default=None, kw_only=True)
    bare: bool = field(default=False, kw_only=True)

    def read(self, value: Any) -> float:
        """Return the number in SI, within its range."""
        if self.bare and isinstance(value, str) and is_number(value):
            value = float(value)
        number = parse(value, self.unit)
        range_ = Quantity(self.unit, "", "", above=self.above, least=self.least, most=self.most)
        return plausible("", range_.checked("", number), self.unit)

    @property
    def schema(self) -> dict[str, Any]:  # type: ignore[override]
        """A number in SI, or text with a unit."""
        bounds = {"exclusiveMinimum": self.above, "minimum": self.least, "maximum": self.most}
        number = {"type": "number"} | {k: x for k, x in bounds.items() if x is not None}
        unit = {"unit": self.unit} if self.unit != "1" else {}
        return {"anyOf": [number, {"type": "string", "maxLength": 200}]} | unit


def number_of(card: Quantity, **more: Any) -> Number:
    """Return the option of a number that a card describes; keywords are those of `Number`."""
    words = f"{card.words[0].upper()}{card.words[1:]}"
    words += f"; must {card.range}" if card.least is not None or card.most is not None else ""
    words += f', "{card.example}".' if card.example else "."
    ends = {"above": card.above, "least": card.least, "most": card.most}
    return Number(words, unit=card.unit, example=card.example, **ends, **more)


@dataclass(frozen=True)
class Text(_Read):
    """Text, checked and converted by a function."""

    to: Callable[[Any], Any] = field(default=str, kw_only=True)

    def read(self, value: Any) -> Any:
        """Return what the function makes of the text; a value that is no text is kept."""
        return self.to(value)


def two_of(value: Any) -> tuple[Any, Any]:
    """Return two values with a comma between them, "8.86,101.6 K", or those of a list."""
    both = [x.strip() for x in value.split(",")] if isinstance(value, str) else value
    if not isinstance(both, list | tuple) or len(both) != 2:
        raise InputError(f"needs two values with a comma between them, got {value!r:.60}")
    return both[0], both[1]


@dataclass(frozen=True)
class File(Option):
    """A file that the operation reads; over HTTP its name is that of a file which was sent."""

    form: ClassVar = "file"


@dataclass(frozen=True)
class Named(_Read):
    """A passport: an object, the name of a published one, a file, or the text of [material]."""

    form: ClassVar = "named"
    metavar: str = field(default="PASSPORT", kw_only=True)

    def read(self, value: Any) -> Any:
        """Return the object, or its name."""
        from viscotack.model.materials.passport import Passport

        if isinstance(value, Passport):
            return value
        if not isinstance(value, str | os.PathLike):
            raise InputError(f"must be a passport or its name, got {value!r:.60}")
        return str(value)


@dataclass(frozen=True)
class Rows(_Read):
    """A table: a list of objects, or the name of a CSV file or workbook with a heading.

    Cells of a file are text; the operation reads them, because it knows their units.

    Attributes
    ----------
    elsewhere : bool
        Whether it replaces the problem on the command line and has no option of its own.
    """

    form: ClassVar = "rows"
    schema: ClassVar = {"anyOf": [{"type": "string"}, {"type": "array", "items": _OBJECT}]}

    elsewhere: bool = field(default=False, kw_only=True)

    def read(self, value: Any) -> Path | tuple[Mapping[str, Any], ...]:
        """Return the name of the file, or the rows."""
        if isinstance(value, str | os.PathLike):
            return Path(value)
        if not isinstance(value, list | tuple) or not all(isinstance(r, Mapping) for r in value):
            raise InputError(f"must be rows, [{{'name': number}}, ...], got {value!r:.60}")
        return tuple({str(name): cell for name, cell in row.items()} for row in value)


@dataclass(frozen=True)
class Contact(_Read):
    """A problem: an object, the name of a case file, its tables, or the flags of an indenter.

    Attributes
    ----------
    indenters : tuple of str
        Indenters that can be stated by flags.
    spelling : str
        On the command line the indenter is an argument ("word") or follows from the flags
        ("flags"), or only a case file is accepted ("case").
    in_si : bool
        Whether flags state it in SI alone.
    rough : bool
        Whether a file of ``viscotack rough`` is accepted, which states a map of heights.
    table : str
        Option that receives the name of a table given in place of the problem.
    """

    form: ClassVar = "problem"
    schema: ClassVar = {"anyOf": [_OBJECT, {"type": "string"}]}

    argument: bool = field(default=True, kw_only=True)
    indenters: tuple[str, ...] = field(default=("sphere",), kw_only=True)
    spelling: Literal["flags", "word", "case"] = field(default="flags", kw_only=True)
    in_si: bool = field(default=False, kw_only=True)
    rough: bool = field(default=False, kw_only=True)
    table: str = field(default="", kw_only=True)

    def read(self, value: Any) -> Any:
        """Return the problem as it was given; the answer reads it."""
        return value


def _declares(kind: type[Option]) -> Callable[..., Any]:
    """Return the function that declares a field: ``radius: float = number("Radius.", "m")``.

    Its arguments are those of the option, the `default`, and the limits of whole numbers. A field
    may be left out, unless its default is ``...``.
    """

    def declare(*words: str, default: Any = None, **more: Any) -> Any:
        limits = {name: more.pop(name) for name in ("ge", "le") if name in more}
        info: Any = Field(default, **limits)
        info.metadata.append(kind(*words, **more))
        return info

    return declare


option, number, text = map(_declares, (Option, Number, Text))
file_name, named, rows, contact = map(_declares, (File, Named, Rows, Contact))


def input_file(words: str, metavar: str) -> Any:
    """Declare a file, or several, that must be given as an argument."""
    return file_name(words, metavar=metavar, argument=True, default=...)


def case(words: str, **more: Any) -> Any:
    """Declare a problem that must be given by a file."""
    return contact(words, indenters=INDENTERS, spelling="case", default=..., **more)


def switch(words: str, **more: Any) -> Any:
    """Declare an option that is off by default."""
    return option(words, default=False, **more)


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
    needed: bool = False
    usual: str = ""
    endings: tuple[str, ...] = ()

    @property
    def flag(self) -> str:
        """Command-line option that messages name."""
        return next((f for f in self.flags if f.startswith("--")), f"--{self.name}")


def csv_file(words: str = "Write a table.", name: str = "csv") -> Output:
    """Declare a CSV table as output."""
    return Output(name, words, endings=(".csv", ".txt", ".dat"))


def main_file(words: str, *endings: str, **more: Any) -> Output:
    """Declare the file of ``-o``."""
    return Output("output", words, flags=("-o", "--output"), endings=endings, **more)


def binary_file(name: str, words: str, ending: str, *flags: str) -> Output:
    """Declare a binary file as output."""
    return Output(name, words, "binary", flags, endings=(ending,))


def picture(words: str = "Draw.", name: str = "plot") -> Output:
    """Declare a figure as output."""
    words = f"{words.removesuffix('.')} to a .png, .pdf or .svg file."
    return Output(name, words, "picture")


def option_of(info: FieldInfo) -> Option:
    """Return the description of a field."""
    return next(each for each in info.metadata if isinstance(each, Option))


def is_many(info: FieldInfo) -> bool:
    """Return whether a field takes several values."""
    return get_origin(info.annotation) is tuple and Ellipsis in get_args(info.annotation)


def choices_of(info: FieldInfo) -> tuple[str, ...]:
    """Return the words that a field may have; () for any."""
    kinds = [info.annotation]
    for kind in kinds:
        if get_origin(kind) is Literal:
            return get_args(kind)
        kinds += get_args(kind)
    return ()


def flag_of(name: str, option: Option) -> str:
    """Return an option as the command line spells it."""
    return next((f for f in option.flags if f.startswith("--")), f"--{name.replace('_', '-')}")


def quoted(names: Iterable[str]) -> str:
    """Return options as a message names them; the command line spells them ``--name``.

    Examples
    --------
    >>> quoted(["modulus_ratio", "rate"])
    '`modulus_ratio`, `rate`'
    """
    return ", ".join(f"`{name}`" for name in names)
