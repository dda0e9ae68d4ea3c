"""Read the dataclasses of a problem from tables: of a TOML file, of JSON, or of a request.

A table has the fields of a class. Each number is described once, by the card in its annotation;
pydantic reads the fields and makes their JSON schema. Errors name the file, the table and the key.
"""

import difflib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import MISSING, dataclass, field, fields
from functools import lru_cache
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from viscotack.cards import Pairs, Quantity, cards, plausible
from viscotack.errors import InputError, wrong_value
from viscotack.units import parse

if TYPE_CHECKING:
    from pydantic import TypeAdapter, ValidationError

    from viscotack.model.problem.nouns import Nouns

T = TypeVar("T")

# Hint for unknown laws, materials and shapes.
OWN = "; give a user-defined one with --with FILE.py, in Python with also="
# Tables of one kind of file: the command that reads it, and what it has.
_ELSEWHERE = {
    "surface": ("rough", "a map of heights"),
    "sphere": ("simulate case", "one sphere"),
    "punch": ("simulate case", "one punch"),
    **dict.fromkeys(("stamp", "donor", "receiver", "pull"), ("window", "one of several contacts")),
    **dict.fromkeys(("pad", "array"), ("array", "many contacts")),
    **dict.fromkeys(("targets", "bounds"), ("design", "what a design is for")),
}


class UnknownNoun(InputError):
    """A table names an unknown law, material, shape or body."""


def _known() -> "Nouns":
    """Return the classes of this package."""
    # known classes include materials, whose passports are read here
    from viscotack.model.problem.nouns import known

    return known()


@dataclass(frozen=True)
class Reading:
    """How the values of tables are read.

    Attributes
    ----------
    where : str
        Name of the file or request in messages.
    nouns : Nouns
        Known classes.
    beside : callable or None
        Returns the path of a file named in a table; None where tables may not name files.
    bare : bool
        Whether numbers without a unit are in SI, as in JSON. In a file that a person writes they
        are refused, and magnitudes are checked.
    units : mapping
        Units of what the machine controls, by the measures of the cards.
    pure : bool
        Whether all numbers are dimensionless.
    """

    where: str
    nouns: "Nouns" = field(default_factory=_known)
    beside: Callable[[str], Path] | None = None
    bare: bool = False
    units: Mapping[str, str] = field(default_factory=dict)
    pure: bool = False

    def unit(self, card: Quantity) -> str:
        """Return the unit of the number that a card describes."""
        return "1" if self.pure else self.units.get(card.measure, card.unit)

    def number(self, card: Quantity, value: Any) -> float:
        """Return a number in the unit of its card; InputError for a wrong unit or size."""
        unit = self.unit(card)
        return card.checked("", self.parsed(value, unit, card.example_in(unit)), unit)

    def pairs(self, card: Pairs, value: Any) -> tuple[tuple[float, float], ...]:
        """Return the pairs of numbers that a card describes."""
        units = ("1", "1") if self.pure else card.units
        try:
            return tuple(
                (self.parsed(x, units[0], card.example), self.parsed(y, units[1], card.example))
                for x, y in value
            )
        except (TypeError, ValueError) as error:
            if isinstance(error, InputError):
                raise
            raise InputError(
                f"must be a list of pairs, {card.words}, got {value!r:.60}; write for example "
                f"{card.example}"
            ) from None

    def key(self, table: str, key: str, card: Quantity, value: Any) -> float:
        """Return the number of a key that is no field of the table's class."""
        try:
            return self.number(card, value)
        except InputError as error:
            words = f"{self.where}, [{table}] {_after(key, str(error).strip())}"
            raise InputError(words, field=f"{table}.{key}") from None

    def parsed(self, value: Any, unit: str, example: str = "") -> float:
        """Return a number in a unit."""
        example = f'"{example or f"1 {unit}"}"'
        if isinstance(value, Real) and not isinstance(value, bool):
            if unit != "1" and not self.bare:
                of = example.strip('"').partition(" ")[2]
                raise InputError(
                    f"has no unit, got {value!r}; write the number and its unit in quotes, "
                    f'"{value:.12g} {of}"'
                )
            return float(value)
        if not isinstance(value, str):
            wanted = "a number" if unit == "1" else f"text with a unit, {example}"
            raise InputError(f"must be {wanted}, got {value!r:.60}")
        return plausible("", parse(value, unit), unit)

    def given(self, table: Any, name: str) -> dict[str, Any]:
        """Return a copy of a table of this name; InputError if it is missing."""
        if not isinstance(table, Mapping):
            raise InputError(
                f"{self.where}: the table [{name}] is missing; see docs/input.md", field=name
            )
        return dict(table)

    def file(self, table: str, key: str, name: Any) -> Path:
        """Return the path of a file named in a table; InputError where none may be named."""
        if not isinstance(name, str):
            raise InputError(f"{self.where}, [{table}] {key} must name a file, got {name!r:.60}")
        if self.beside is None:
            raise InputError(
                f"{self.where}, [{table}] {key} names a file, {name!r:.60}, which is not allowed "
                "in a request; write the numbers themselves"
            )
        return self.beside(name)

    def choice(
        self,
        table: Mapping[str, Any],
        name: str,
        key: str,
        known: Mapping[str, Any],
        hint: str = "",
    ) -> Any:
        """Return the class that a table names by a word."""
        given = table.get(key)
        if not isinstance(given, str) or given not in known:
            got = f"got {given!r:.60}" if key in table else "it is missing"
            raise UnknownNoun(
                f"{self.where}, [{name}] {key} must be one of {', '.join(known)}; {got}{hint}",
                field=f"{name}.{key}",
            )
        return known[given]


@dataclass(frozen=True)
class Read:
    """Marks a field of a table that a function of the value and the reading reads."""

    function: Callable[[Any, Reading], Any]

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        """Read the value by the function."""
        from pydantic_core import core_schema

        return core_schema.with_info_plain_validator_function(
            lambda value, info: self.function(value, info.context)
        )


@lru_cache(maxsize=256)
def adapter(kind: Any) -> "TypeAdapter[Any]":
    """Return pydantic's reader of a dataclass with cards."""
    from pydantic import TypeAdapter

    kind.__pydantic_config__ = {"extra": "forbid", "arbitrary_types_allowed": True}
    return TypeAdapter(kind)


def read_as(kind: type[T], table: Any, reading: Reading, name: str) -> T:
    """Return an object of a dataclass from a table.

    Parameters
    ----------
    kind : type
        Dataclass whose fields the table states.
    table : mapping
        Names of the fields -> values.
    reading : Reading
        How values are read.
    name : str
        Name of the table in messages.

    Raises
    ------
    InputError
        If a key is unknown or missing, or a value has a wrong unit, type or size.
    """
    from pydantic import ValidationError

    where, table = f"{reading.where}, [{name}]", reading.given(table, name)
    refuse_unknown(where, table, (f.name for f in fields(kind) if f.init), "key", table=name)  # type: ignore[arg-type]
    try:
        return adapter(kind).validate_python(table, context=reading)
    except ValidationError as error:
        loc = error.errors()[0]["loc"]
        at = f"{name}.{loc[0]}" if loc else name
        raise InputError(f"{where} {_words(kind, error, reading)}", field=at) from None
    except ArithmeticError as error:
        raise InputError(f"{where}: {error}", field=name) from None


def _words(kind: Any, error: "ValidationError", reading: Reading) -> str:
    """Return the message of what is wrong with a table."""
    found = error.errors(include_url=False)
    if missing := [str(each["loc"][-1]) for each in found if each["type"] == "missing"]:
        listed = " and ".join([", ".join(missing[:-1]), missing[-1]] if missing[1:] else missing)
        examples = ", ".join(f"{name} = {_example(kind, name, reading)}" for name in missing)
        verb = "are" if missing[1:] else "is"
        return f"{listed} {verb} missing; write for example {examples}"
    first = found[0]
    key = str(first["loc"][0]) if first["loc"] else ""
    return _after(key, wrong_value(first)) if key else wrong_value(first)


def _after(key: str, words: str) -> str:
    """Return what is wrong with a key, behind its name."""
    return f"{key} {words}" if words.startswith(("must ", "has no unit")) else f"{key}: {words}"


def _example(kind: Any, name: str, reading: Reading) -> str:
    """Return an example of a value as TOML."""
    if (found := cards(kind, Pairs).get(name)) is not None:
        return found.card.example
    if (found := cards(kind).get(name)) is None:
        return '"..."'
    example = found.card.example_in(reading.unit(found.card))
    return example if reading.unit(found.card) == "1" else f'"{example}"'


def refuse_unknown(
    where: str,
    given: Iterable[str],
    known: Iterable[str],
    what: str,
    more: str = "",
    *,
    table: str = "",
) -> None:
    """Raise an error for unknown names of tables, or of keys of a table, with a suggestion."""
    known = sorted(known)
    for name in given:
        if name not in known:
            if what == "table" and name in _ELSEWHERE:
                command, noun = _ELSEWHERE[name]
                raise UnknownNoun(
                    f"{where}: unknown table {name!r}: it states {noun}, in a file of "
                    f"`viscotack {command}`; expected {', '.join(known)}",
                    field=name,
                )
            close = difflib.get_close_matches(str(name), known, n=1)
            hint = f"did you mean {close[0]}?" if close else f"expected {', '.join(known)}{more}"
            kind = UnknownNoun if what == "table" else InputError
            field = f"{table}.{name}" if table else name
            raise kind(f"{where}: unknown {what} {name!r}; {hint}", field=field)


def refuse_named(where: str, tables: Mapping[str, Any], words: Iterable[str], why: str) -> None:
    """Raise an InputError where the name of a table or key has one of some words."""
    for name, value in tables.items():
        if any(word in name for word in words):
            raise InputError(f"{where}: {name!r} is not computed; {why}")
        if isinstance(value, Mapping):
            refuse_named(where, value, words, why)


def stated(noun: Any) -> dict[str, Any]:
    """Return the fields of a noun that differ from their defaults, as the values of a table."""
    found = {}
    for each in fields(noun):
        value = getattr(noun, each.name)
        if each.default is MISSING or value != each.default:
            found[each.name] = _plain(value)
    return found


def _plain(value: Any) -> Any:
    return [_plain(entry) for entry in value] if isinstance(value, tuple) else value
