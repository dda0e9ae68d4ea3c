"""Access to one table of a case file by the cards of a class.

Every error names the file, the table and the key, and gives an example.
"""

import difflib
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from viscotack.cards import Field, Pairs, cards, plausible
from viscotack.errors import InputError
from viscotack.units import parse

# Hint for unknown laws, materials and shapes.
OWN = "; give a user-defined one with --with FILE.py"


def refuse_named(
    path: Path | str, tables: Mapping[str, Any], words: Iterable[str], why: str
) -> None:
    """Raise an InputError where the name of a table or key has one of some words."""
    found = [name for name in _names(tables) if any(word in name for word in words)]
    if found:
        raise InputError(f"{path}: {found[0]!r} is not computed; {why}")


# Tables of one kind of file: the command that reads it, and what it has.
_ELSEWHERE = {
    "surface": ("rough", "a map of heights"),
    "sphere": ("simulate case", "one sphere"),
    "punch": ("simulate case", "one punch"),
}


def refuse_maps(where: str, tables: Iterable[str]) -> None:
    """Raise an InputError for the tables of a window, an array or a design."""
    for word, names in (
        ("window", {"stamp", "donor", "receiver"}),
        ("array", {"pad", "array"}),
        ("design", {"targets", "bounds"}),
    ):
        if found := names & set(tables):
            raise InputError(
                f"{where}: [{min(found)}] belongs to a file of `viscotack {word}`, which has "
                "several contacts; cases and campaigns have one"
            )


def _names(tables: Mapping[str, Any]) -> Iterable[str]:
    """Yield the keys of tables and of the tables inside them."""
    for name, value in tables.items():
        yield name
        if isinstance(value, Mapping):
            yield from _names(value)


class Table:
    """A table of a file, which records the keys that were read."""

    def __init__(
        self,
        path: Path | str,
        name: str,
        tables: Mapping[str, Any],
        beside: Callable[[str], Path] | None = None,
    ) -> None:
        self.path, self.name = path, f"{path}, [{name}]"
        self._beside = beside
        if not isinstance(tables.get(name), dict):
            raise InputError(f"{path}: the table [{name}] is missing; see docs/input.md")
        self.values: Mapping[str, Any] = tables[name]
        self.known: set[str] = set()

    def get(self, key: str, example: str = '"..."') -> Any:
        """Return the value of a key; raise an error with an example if it is missing."""
        self.known.add(key)
        if key not in self.values:
            raise InputError(
                f"{self.name} {key} is missing{self._meant(key)}; write for example "
                f"{key} = {example}"
            )
        return self.values[key]

    def beside(self, key: str, example: str) -> Path:
        """Return the path of a file named by a key, relative to the folder of the case.

        Tables sent in a request may not name files, so that requests cannot read files of the
        server.
        """
        name = self.get(key, example)
        if self._beside is None:
            raise InputError(
                f"{self.name} {key} names a file, {name!r:.60}, which is not allowed in a request; "
                "write the numbers themselves"
            )
        return self._beside(str(name))

    def require(self, fields: Iterable[Field]) -> None:
        """Raise one error that names all missing keys of several cards."""
        asked = {f.name: f.card for f in fields}
        missing = {name: card for name, card in asked.items() if name not in self.values}
        if len(missing) < 2:
            return
        self.known |= asked.keys()
        names = [f"{name}{self._meant(name)}" for name in missing]
        examples = [
            f"{name} = {card.example if isinstance(card, Pairs) else _example_of(card)}"
            for name, card in missing.items()
        ]
        raise InputError(
            f"{self.name} {', '.join(names[:-1])} and {names[-1]} are missing; write for example "
            f"{', '.join(examples)}"
        )

    def _meant(self, key: str) -> str:
        """Suggest the key that may have been meant, in words."""
        given = self.values.keys() - self.known
        close = difflib.get_close_matches(key, given, n=1, cutoff=0.75)
        return f" (is {close[0]} meant?)" if close else ""

    def quantity(self, key: str, unit: str, example: str = "") -> float:
        """Return the number of a key in an SI unit."""
        example = example or _any(unit)
        value = self.get(key, example)
        if unit != "1" and isinstance(value, int | float) and not isinstance(value, bool):
            of = example.strip('"').partition(" ")[2]
            raise InputError(
                f"{self.name} {key} has no unit, got {value!r}; write the number and its unit in "
                f'quotes, {key} = "{value:.12g} {of}"'
            )
        if unit != "1" and not isinstance(value, str):
            raise InputError(
                f"{self.name} {key} must be text with a unit, got {value!r}; "
                f"write for example {key} = {example}"
            )
        try:
            number = parse(value, unit)
        except ValueError as error:
            raise InputError(f"{self.name} {key}: {error}; for example {key} = {example}") from None
        return plausible(f"{self.name} {key}", number, unit)

    def parsed(self, key: str, given: Any, unit: str) -> float:
        """Return one of the numbers of a key in an SI unit; the error names table and key."""
        try:
            return float(parse(given, unit))
        except ValueError as error:
            raise InputError(f"{self.name} {key}: {error}") from None

    def number(self, field: Field, key: str = "", unit: str = "") -> float:
        """Return the number described by a card, from the key of its field or another key."""
        card, key = field.card, key or field.name
        unit = unit or card.unit
        value = self.quantity(key, unit, _example(card.example, unit))
        try:
            return card.checked(key, value, unit)
        except ValueError as error:
            raise InputError(f"{self.name} {error}") from None

    def pairs(self, field: Field) -> tuple[tuple[float, float], ...]:
        """Return the list of pairs described by a card."""
        card, key = field.card, field.name
        given = self.get(key, card.example)
        first, second = card.units
        try:
            return tuple(
                (parse(str(x), first), parse(str(y), second))
                for x, y in (_pair(x, card.words) for x in given)
            )
        except (TypeError, ValueError) as error:
            raise InputError(
                f"{self.name} {key}: {error}; write for example {key} = {card.example}"
            ) from None

    def numbers(self, noun: type) -> dict[str, Any]:
        """Return the numbers of a class stated by the table; those without default are required."""
        plain = cards(noun).values()
        self.require([*(f for f in plain if f.needed), *cards(noun, Pairs).values()])
        found: dict[str, Any] = {
            field.name: self.number(field)
            for field in plain
            if field.needed or field.name in self.values
        }
        return found | {f.name: self.pairs(f) for f in cards(noun, Pairs).values()}

    def word(self, key: str, allowed: Iterable[str], more: str = "") -> str:
        """Return the word of a key, one of those allowed; `more` is a hint for other words."""
        allowed = list(allowed)
        value = self.get(key, f'"{allowed[0]}"')
        if value not in allowed:
            raise InputError(
                f"{self.name} {key} must be one of {', '.join(allowed)}, got {value!r}{more}"
            )
        return value

    def make(self, kind: Any, *value: Any, **values: Any) -> Any:
        """Call a class or a function; errors get the name of the table."""
        try:
            return kind(*value, **values)
        except ValueError as error:
            raise InputError(f"{self.name} {error}") from None

    def finish(self) -> None:
        """Raise an error for keys that were not read."""
        refuse_unknown(self.name, self.values, self.known, "key")


def refuse_unknown(
    where: str, given: Iterable[str], known: Iterable[str], what: str, more: str = ""
) -> None:
    """Raise an error for unknown names, with a suggestion."""
    known = sorted(known)
    for name in given:
        if name not in known:
            if what == "table" and name in _ELSEWHERE:
                command, noun = _ELSEWHERE[name]
                raise InputError(
                    f"{where}: unknown table {name!r}: it states {noun}, in a file of "
                    f"`viscotack {command}`; expected {', '.join(known)}"
                )
            close = difflib.get_close_matches(name, known, n=1)
            hint = f"did you mean {close[0]}?" if close else f"expected {', '.join(known)}{more}"
            raise InputError(f"{where}: unknown {what} {name!r}; {hint}")


def _pair(given: Any, words: str) -> tuple[Any, Any]:
    if not isinstance(given, list) or len(given) != 2:
        raise InputError(f"each entry must be a pair, {words}, got {given!r}")
    return given[0], given[1]


def _any(unit: str) -> str:
    return "1" if unit == "1" else f'"1 {unit}"'


def _example_of(card: Any) -> str:
    return _example(card.example, card.unit) or _any(card.unit)


def _example(text: str, unit: str) -> str:
    """Format an example for TOML: quantities as text, pure numbers without quotes."""
    return text if unit == "1" or not text else f'"{text}"'
