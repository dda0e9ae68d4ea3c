"""Requests: each task of a user as a pydantic model, whose fields are its options.

The command line, HTTP, the page, study files and Python make the same requests. A request holds
what was asked, as plain data; files, passports and problems that it names are read by its answer,
through the caller.
"""

import os
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from inspect import cleandoc
from itertools import islice
from pathlib import Path
from types import NoneType
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self, TypeVar, get_args, get_origin

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined, core_schema

from viscotack.cards import Quantity, plausible
from viscotack.errors import TOO_LARGE, InputError
from viscotack.units import is_number, parse

if TYPE_CHECKING:
    from viscotack.files.whole import Target

    from .statement import Statement

# Rows of a table that an operation keeps in memory.
_MOST_ROWS = 100_000
# Values of options that were not given.
_LEFT_OUT: tuple[Any, ...] = (None, "", [], ())


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
    words += f"; must {card.range}" if card.bounded else ""
    words += f', for example "{card.example}".' if card.example else "."
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
    schema: ClassVar = {
        "anyOf": [
            {"type": "string", "maxLength": 200},
            {
                "type": "array",
                "items": {
                    "type": "object",
                    "additionalProperties": {"type": ["number", "string"], "maxLength": 200},
                },
                "minItems": 1,
            },
        ]
    }

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
    whole : bool
        Whether a case file with any indenter is accepted.
    rough : bool
        Whether a file of ``viscotack rough`` is accepted, which states a map of heights.
    table, expected : str
        Option that receives the name of a table given in place of the problem, and what else may
        stand there.
    """

    form: ClassVar = "problem"
    schema: ClassVar = {
        "anyOf": [
            {"type": "object", "description": "Tables of a case, or the flags of an indenter."},
            {"type": "string", "maxLength": 200, "description": "Name of a case file."},
        ]
    }

    argument: bool = field(default=True, kw_only=True)
    indenters: tuple[str, ...] = field(default=("sphere",), kw_only=True)
    spelling: Literal["flags", "word", "case"] = field(default="flags", kw_only=True)
    whole: bool = field(default=True, kw_only=True)
    rough: bool = field(default=False, kw_only=True)
    table: str = field(default="", kw_only=True)
    expected: str = field(default="", kw_only=True)

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
    done: str = "wrote"
    needed: bool = False
    usual: str = ""
    endings: tuple[str, ...] = ()

    @property
    def flag(self) -> str:
        """Command-line option that messages name."""
        return next((f for f in self.flags if f.startswith("--")), f"--{self.name}")


def csv_file(words: str = "Write a table.", name: str = "csv") -> Output:
    """Declare a CSV table as output."""
    words = f"{words.removesuffix('.')}; - is standard output."
    return Output(name, words, endings=(".csv", ".txt", ".dat"))


def main_file(words: str, *endings: str, **more: Any) -> Output:
    """Declare the file of ``-o``."""
    return Output("output", words, flags=("-o", "--output"), endings=endings, **more)


def picture(words: str = "Draw.", name: str = "plot") -> Output:
    """Declare a figure as output."""
    words = f"{words.removesuffix('.')} to a .png, .pdf or .svg file."
    return Output(name, words, "picture", done="drew")


Told = Mapping[str, Any]
# Outputs besides files that HTTP and the page may request of every answer.
WORDS, DRAWN = "words", "drawn"


@dataclass(frozen=True)
class Answer:
    """Result of an operation, returned by :func:`ask`; representations are created on demand.

    Attributes
    ----------
    found : object
        The result as a Python object.
    data : callable
        Returns the record: numbers in SI with the unit in the name.
    words : callable, optional
        Returns text for the terminal, or the part of the record that is shown there; default:
        all of it.
    units : mapping
        Units of dimensionless numbers of the record by name, for the text.
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
    data: Callable[[], Any]
    words: Callable[[], Any] | None = None
    units: Mapping[str, str] = field(default_factory=dict)
    files: Mapping[str, Callable[["Target"], None]] = field(default_factory=dict)
    pictures: Mapping[str, Callable[[], Any]] = field(default_factory=dict)
    drawn: Callable[[], dict[str, Any]] | None = None
    notes: tuple[str, ...] = ()
    status: int = 0

    def record(self) -> Any:
        """Return the record as plain data, as printed by ``--json`` and returned over HTTP."""
        from .parts.json_data import plain

        return plain(self.data())

    def __str__(self) -> str:
        """Return the text for the terminal."""
        from .parts.json_data import plain
        from .parts.record_words import record_words

        shown = self.data() if self.words is None else self.words()
        return shown if isinstance(shown, str) else record_words(plain(shown), self.units)


def harmless_name(name: str) -> str:
    """Return the last part of a file name, without what has a meaning in paths or shells."""
    bare = re.split(r"[/\\]", name)[-1]
    name = re.sub(r"[^\w.+\- ()]", "_", bare).lstrip(".")[-100:]
    # a file system counts bytes, up to 255
    return name.encode()[-255:].decode(errors="ignore") or "file"


@dataclass(frozen=True)
class Caller:
    """Who asks: progress, wanted outputs, classes of the user, and where named files lie.

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
        Base folder of relative file names.
    sent : bool
        Whether only files of the folder may be named, by their last names: those of a request
        over HTTP.
    read : list of Path
        Files that were named so far, for those who write the outputs.
    """

    tell: Callable[[Told], None] = lambda told: None
    wants: frozenset[str] = frozenset()
    also: tuple[Any, ...] = ()
    own: tuple[str, ...] = ()
    folder: Path = Path()
    sent: bool = False
    read: list[Path] = field(default_factory=list)

    def file(self, name: str | os.PathLike[str]) -> Path:
        """Return the path of a named file, which no output may overwrite."""
        text = os.fspath(name)
        if not text or "\0" in text:
            raise InputError(f"expected the name of a file, got {text!r:.60}")
        path = self.folder / text
        if self.sent:
            path = self.folder / harmless_name(text)
            if self.folder == Path() or not path.is_file():
                raise InputError(f"no file called {path.name!r:.100} was sent with the request")
        self.read.append(path)
        return path

    def within(self, file: Path) -> Self:
        """Return the caller of the names inside a file, which are relative to its folder."""
        return self if self.sent else replace(self, folder=file.parent)

    def rows(self, given: Any) -> tuple[Mapping[str, Any], ...]:
        """Return the rows of an option, which may be in a file."""
        if not isinstance(given, Path):
            return tuple(given)
        from viscotack.campaign.listed import read_words

        path = self.file(given)
        names, lines = read_words(path, empty=True)
        rows = tuple(dict(zip(names, row, strict=True)) for _, row in islice(lines, _MOST_ROWS + 1))
        if len(rows) > _MOST_ROWS:
            raise InputError(f"{path} has more than {_MOST_ROWS:,} rows; run a campaign")
        return rows


class Request(BaseModel):
    """Base class of requests; :func:`operation` returns one by name.

    The docstring is the help text: a summary line, details, and an example of the command. Each
    field has an `Option` in its annotation.

    Attributes
    ----------
    word : str
        Name of the operation and its command: ``identify rates``.
    outputs : tuple of Output
        Files that it can write.
    takes_own : bool
        Whether it accepts user-defined laws, materials, shapes or observables.
    local : str
        Why it is not available over HTTP; "" where it is.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    word: ClassVar[str]
    outputs: ClassVar[tuple[Output, ...]] = ()
    takes_own: ClassVar[bool] = False
    local: ClassVar[str] = ""

    def answer(self, caller: Caller) -> Answer:
        """Compute the answer; implementations import numerical modules here, not on top."""
        raise NotImplementedError

    def stated(self, caller: Caller) -> "Statement":
        """Return the problem of the option `problem`."""
        from .statement import statement

        option = option_of(type(self).model_fields["problem"])
        assert isinstance(option, Contact), "declared as a problem"
        return statement(getattr(self, "problem", None), option, caller)

    def known(self, name: str) -> tuple[float, float] | None:
        """Return a known number and its standard uncertainty, of two options; None without."""
        both = getattr(self, name), getattr(self, f"{name}_uncertainty")
        if (both[0] is None) != (both[1] is None):
            raise InputError(
                f"{name} and {name}_uncertainty belong together; give both or neither", field=name
            )
        return None if both[0] is None else both

    @classmethod
    def of(cls, **given: Any) -> Self:
        """Create the request from its options: numbers in SI, or text with units."""
        return request_of(cls, given)

    def check(self) -> None:
        """Refuse options that exclude each other."""

    @model_validator(mode="after")
    def _checked(self) -> Self:
        self.check()
        return self

    @model_validator(mode="before")
    @classmethod
    def _given(cls, given: Any) -> Any:
        """Leave out empty values, and take a single value of a repeated option for a list."""
        if not isinstance(given, Mapping):
            return given
        found = {
            n: x for n, x in given.items() if x is not None and x != "" and x != [] and x != ()
        }
        for name, info in cls.model_fields.items():
            if name in found and is_many(info) and not isinstance(found[name], list | tuple):
                found[name] = [found[name]]
        return found


R = TypeVar("R", bound=Request)


def options(kind: type[Request]) -> dict[str, FieldInfo]:
    """Return the fields of a request, its own before those of its bases."""
    names = [n for each in kind.__mro__ for n in vars(each).get("__annotations__", {})]
    return {name: kind.model_fields[name] for name in names if name in kind.model_fields}


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


def request_of(kind: type[R], given: Mapping[str, Any]) -> R:
    """Return a request from what a user gave.

    Raises
    ------
    InputError
        If an option is unknown, missing or invalid; its `field` is the option.
    """
    try:
        return kind.model_validate(dict(given))
    except ValidationError as error:
        raise refusal(kind, error.errors(include_url=False)) from None


def refusal(kind: type[Request], errors: Any) -> InputError:
    """Return the error of a request from those that pydantic found."""
    if missing := [str(each["loc"][-1]) for each in errors if each["type"] == "missing"]:
        return InputError(f"{quoted(missing)} {'are' if missing[1:] else 'is'} missing")
    first = errors[0]
    known = [name for name in map(str, first["loc"]) if name in kind.model_fields]
    own = first.get("ctx", {}).get("error")
    if first["type"] == "extra_forbidden":
        name = str(first["loc"][-1])
        near = get_close_matches(name, kind.model_fields, n=1)
        meant = f"did you mean {near[0]}?" if near else f"it has {', '.join(kind.model_fields)}"
        return InputError(f"{kind.word} has no option {name!r:.60}; {meant}")
    if not known:
        return own if isinstance(own, InputError) else InputError(str(own or first["msg"]))
    got = f", got {first['input']!r:.60}"
    words = str(own) if own else f"must be {_WANTED.get(first['type'], _said(first['msg']))}{got}"
    words = words.strip()
    joint = " " if words.startswith(("must ", "needs ", "lies ")) else ": "
    example = option_of(kind.model_fields[known[0]]).example
    more = f"; for example {example}" if example else ""
    return InputError(f"{known[0]}{joint}{words}{more}", field=known[0])


_WANTED = {
    "string_type": "text",
    "bool_parsing": "true or false",
    "bool_type": "true or false",
    "int_parsing": "a whole number",
    "int_from_float": "a whole number",
    "path_type": "the name of a file",
}


def _said(message: str) -> str:
    return message.removeprefix("Input should be ").removeprefix("a valid ")


def answered(asked: Request, caller: Caller) -> Answer:
    """Run an operation; InputError if arithmetic overflows or a simulation stops early.

    A plain division by zero is a defect of the operation.
    """
    try:
        return asked.answer(caller)
    except (OverflowError, FloatingPointError):
        raise InputError(TOO_LARGE) from None
    except RuntimeError as error:
        # imported late, so that commands which do not simulate start fast
        from viscotack.simulate import SimulationError

        if not isinstance(error, SimulationError):
            raise
        raise InputError(str(error)) from None


def summary(kind: type) -> str:
    """Return the first sentence of an operation's docstring."""
    return cleandoc(kind.__doc__ or "").partition("\n\n")[0].replace("\n", " ")


def described(kind: type[Request]) -> dict[str, Any]:
    """Return name, description, options and outputs as plain data, for the forms of the page."""
    return {
        "word": kind.word,
        "path": kind.word.replace(" ", "/"),
        "summary": summary(kind),
        "help": cleandoc(kind.__doc__ or ""),
        "options": [_described(name, info) for name, info in options(kind).items()],
        "outputs": [{"name": x.name, "words": x.words, "kind": x.kind} for x in kind.outputs],
        "local": kind.local,
    }


def _described(name: str, info: FieldInfo) -> dict[str, Any]:
    option, default = option_of(info), info.default
    kinds = get_args(info.annotation) or (info.annotation,)
    form = option.form or ("choice" if choices_of(info) else "switch" if bool in kinds else "text")
    quoted = option.words.split('"')
    return {
        "name": name,
        # without the flags of the command line
        "words": re.sub("--([a-z-]+)", lambda x: x[1].replace("-", "_"), option.words),
        "form": form,
        "unit": getattr(option, "unit", ""),
        "example": option.example or (quoted[1] if len(quoted) > 2 else ""),
        "choices": list(choices_of(info)),
        "default": default if isinstance(default, str | int | float | bool) else None,
        "needed": default is PydanticUndefined,
        "many": is_many(info),
    }
