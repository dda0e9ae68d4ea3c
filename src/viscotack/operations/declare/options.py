"""Options of operations, and the conversion of user input to an operation.

An operation is a frozen dataclass. Its fields are its options, each with a card; a field whose type
is a `Part` contributes the options of that part. All front ends pass a mapping, option -> input, to
:func:`take`, the only function that converts input.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, dataclass, fields
from difflib import get_close_matches
from functools import lru_cache
from inspect import cleandoc
from pathlib import Path
from typing import Annotated, Any, ClassVar, Self, TypeVar, get_args, get_origin, get_type_hints

from viscotack.errors import TOO_LARGE, InputError, OutOfRange
from viscotack.files.bounded import note_read

from .answer import Answer, Caller, Output
from .cards import Card, Known, Place
from .wording import flag, listed

# not inside a word, such as a file name
_FLAG = re.compile(r"(?<![\w-])--[a-z][a-z0-9-]*(?!\w)")
# Options that front ends add to every operation.
OF_DOORS = ("outputs", "attached", "operation", "write", "json", "with", "force")


class Part:
    """Group of options shared by several operations; a frozen dataclass."""

    # of the table that holds them in a study file
    table: ClassVar[str] = ""


class Operation:
    """Base class of operations; :func:`operation` returns one by name.

    Subclasses are frozen dataclasses. Their docstring is the help text: a summary line, details,
    and an example of the command.

    Attributes
    ----------
    word : str
        Name of the operation and its command: ``identify rates``.
    outputs : tuple of Output
        Files that it can write.
    takes_own : bool
        Whether it accepts user-defined laws, materials, shapes or observables.
    refused : mapping
        Front end that does not offer the operation -> reason: ``{"http": "..."}``.
    helps : mapping
        Help text of each command, if the operation has several.
    """

    word: ClassVar[str]
    outputs: ClassVar[tuple[Output, ...]] = ()
    takes_own: ClassVar[bool] = False
    refused: ClassVar[Mapping[str, str]] = {}
    helps: ClassVar[Mapping[str, str]] = {}

    def answer(self, caller: Caller) -> Answer:
        """Compute the answer; implementations import numerical modules here, not on top."""
        raise NotImplementedError

    @classmethod
    def of(cls, **given: Any) -> Self:
        """Create the operation from its options: numbers in SI, or text with units."""
        return take(cls, given, Here())


Asked = TypeVar("Asked", bound=Operation)


@dataclass(frozen=True)
class Here:
    """Origin of a local request: file names are relative to the working folder or to a study.

    Attributes
    ----------
    folder : Path
        Base folder of relative names.
    also : tuple of classes
        User-defined classes.
    """

    folder: Path = Path()
    also: tuple[Any, ...] = ()

    def file(self, name: str) -> Path:
        """Return the path of a file, which no output may overwrite."""
        path = self.folder / name
        if path.is_file():
            note_read(path)
        return path

    def within(self, path: Path) -> "Here":
        """Return the place for file names inside a file: they are relative to its folder."""
        return Here(path.parent, self.also)


@dataclass(frozen=True)
class Option:
    """An option of an operation.

    Attributes
    ----------
    name : str
        Name in Python, HTTP and study files; with dashes on the command line.
    card : Card
        Description, type, unit and range.
    default : object
        Default value; `dataclasses.MISSING` if the option is required.
    many : bool
        Whether it can be repeated.
    part : str
        Field of the operation that holds the part to which the option belongs; "" for an option of
        the operation itself.
    table : str
        Table of a study file that contains the option; "" for none.
    field : str
        Field of the operation or part that receives the value.
    """

    name: str
    card: Card
    default: Any
    many: bool
    part: str
    table: str
    field: str

    @property
    def needed(self) -> bool:
        """Whether the option is required."""
        return self.default is MISSING

    @property
    def uncertainty(self) -> bool:
        """Whether the option is the uncertainty of another option."""
        return self.name != self.field

    @property
    def words(self) -> str:
        """Description for the user."""
        card = self.card
        return card.uncertainty if isinstance(card, Known) and self.uncertainty else card.words

    @property
    def flag(self) -> str:
        """Spelling in messages."""
        spelled = () if self.uncertainty else self.card.flags
        return next((f for f in spelled if f.startswith("--")), flag(self.name))


@lru_cache(maxsize=256)
def options(kind: type) -> tuple[Option, ...]:
    """Return the options of an operation, including those of its parts.

    Raises
    ------
    TypeError
        If a field has no card, or two options have one name: a defect of the declaration.
    """
    found = tuple(_options(kind, "", ""))
    names = [option.name for option in found]
    twice = {name for name in names if names.count(name) > 1 or name in OF_DOORS}
    if twice:
        raise TypeError(f"{kind.__name__} declares {', '.join(sorted(twice))} twice")
    return found


def _options(kind: Any, part: str, table: str) -> Iterator[Option]:
    hints = get_type_hints(kind, include_extras=True)
    for field in fields(kind):
        hint = hints[field.name]
        if isinstance(hint, type) and issubclass(hint, Part):
            yield from _options(hint, field.name, hint.table)
            continue
        card = next((x for x in getattr(hint, "__metadata__", ()) if isinstance(x, Card)), None)
        if get_origin(hint) is not Annotated or card is None:
            raise TypeError(f"{kind.__name__}.{field.name} has no card")
        many = not card.single and _is_many(get_args(hint)[0])
        default = field.default
        if field.default_factory is not MISSING:
            default = field.default_factory()
        yield Option(field.name, card, default, many, part, table, field.name)
        if isinstance(card, Known):
            name = f"{field.name}_uncertainty"
            yield Option(name, card, None, False, part, table, field.name)


def _is_many(hint: Any) -> bool:
    parts = [hint, *get_args(hint)]
    return any(get_origin(part) is tuple for part in parts)


def take(kind: type[Asked], given: Mapping[str, Any], place: Place) -> Asked:
    """Create an operation from user input; the only place where input is converted.

    Parameters
    ----------
    kind : class
        The operation.
    given : mapping
        Name of an option -> text, number, list of these, or Python object. None and empty lists
        mean that the option is not given.
    place : Place
        Resolves file names.

    Raises
    ------
    InputError
        If a name is unknown, options are missing (all are listed), a value is invalid, or options
        exclude each other. Messages spell options ``--name``; :func:`spelled` converts them.
    """
    known = {option.name: option for option in options(kind)}
    said = {name: value for name, value in given.items() if not _is_left_out(value)}
    _refuse_unknown(kind, said, known)
    values: dict[str, dict[str, Any]] = {}
    # in the order of declaration, because front ends give options in different orders; fast ones
    # first, so that an invalid one is reported before a problem is built
    for option in sorted(known.values(), key=lambda each: each.card.late):
        if (name := option.name) not in said:
            continue
        value = said[name]
        if isinstance(option.card, Known) and isinstance(value, list | tuple):
            both = name, f"{name}_uncertainty"
            if option.uncertainty or len(value) != len(both) or both[1] in said:
                raise InputError(f"{option.flag}: a list has the value and its uncertainty")
            for each, number in zip(both, value, strict=True):
                values.setdefault(option.part, {})[each] = _one(option, number, place)
            continue
        values.setdefault(option.part, {})[name] = _read(option, value, place)
    missing = [
        option.flag for option in known.values() if option.needed and option.name not in said
    ]
    if missing:
        raise InputError(f"{listed(missing)} missing; see --help")
    for option in known.values():
        if isinstance(option.card, Known) and not option.uncertainty:
            _pair(option, values.get(option.part, {}))
    parts = {name: get_type_hints(kind)[name](**chosen) for name, chosen in values.items() if name}
    return kind(**values.get("", {}), **parts)


def _is_left_out(value: Any) -> bool:
    return value is None or (isinstance(value, list | tuple | str) and len(value) == 0)


def _refuse_unknown(kind: type, given: Mapping[str, Any], known: Mapping[str, Option]) -> None:
    unknown = [name for name in given if name not in known]
    if unknown:
        near = get_close_matches(unknown[0], known, n=1)
        meant = f"; did you mean {near[0]}?" if near else ""
        word = getattr(kind, "word", kind.__name__)
        raise InputError(
            f"{word} has no option {unknown[0]!r:.60}{meant}; known options are {', '.join(known)}"
        )


def _read(option: Option, value: Any, place: Place) -> Any:
    if not option.many:
        return _one(option, value, place)
    several = value if isinstance(value, list | tuple) else [value]
    return tuple(_one(option, each, place) for each in several)


def _one(option: Option, value: Any, place: Place) -> Any:
    try:
        return option.card.value(value, place)
    except InputError as error:
        words = str(error).removeprefix("it ")
        if option.card.argument or words.startswith(option.flag):
            raise
        joint = " " if words.startswith(("must ", "needs ")) else ": "
        example = f"; for example {option.card.example}" if option.card.example else ""
        raise InputError(f"{option.flag}{joint}{words}{example}") from None


def _pair(option: Option, values: dict[str, Any]) -> None:
    """Combine a number and its uncertainty into one value; both or neither must be given."""
    number, uncertainty = values.get(option.name), values.pop(f"{option.name}_uncertainty", None)
    if (number is None) != (uncertainty is None):
        raise InputError(
            f"{option.flag} and {option.flag}-uncertainty belong together; give both or neither"
        )
    if number is not None:
        values[option.name] = (number, uncertainty)


def answered(asked: Operation, caller: Caller) -> Answer:
    """Run an operation; InputError if arithmetic overflows or a simulation stops early.

    A plain division by zero is a defect of the operation.
    """
    try:
        return asked.answer(caller)
    except (OverflowError, FloatingPointError):
        raise InputError(TOO_LARGE) from None
    except RuntimeError as error:
        # imported late, so that commands which do not simulate start fast
        from viscotack.bem import SimulationError

        if not isinstance(error, SimulationError):
            raise
        raise InputError(str(error)) from None


def spelled(message: str, kind: type[Operation]) -> str:
    """Convert the option names in a message to the spelling of HTTP, study files and Python."""
    asked = {name for option in options(kind) for name in option.card.asks}
    flags = {f"--{name}": name.replace("-", "_") for name in asked}
    flags |= {option.flag: option.name for option in options(kind)}
    flags |= {output.flag: output.name for output in kind.outputs}

    def name(found: re.Match[str]) -> str:
        return flags.get(found[0], found[0])

    message = message.replace("; see --help", "")
    return _FLAG.sub(name, message)


def respelled(error: InputError, kind: type[Operation]) -> InputError:
    """Return an error with its message converted by :func:`spelled`."""
    known = OutOfRange if isinstance(error, OutOfRange) else InputError
    return known(spelled(str(error), kind))


def summary(kind: type) -> str:
    """Return the first sentence of an operation's docstring."""
    return cleandoc(kind.__doc__ or "").partition("\n\n")[0].replace("\n", " ")
