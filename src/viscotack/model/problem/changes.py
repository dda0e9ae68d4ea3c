"""Tables of changes: each row replaces numbers of one problem; other columns are carried along.

A column is named by a key of the problem file (``radius``, ``sphere.radius``) or by the path of the
number (``sphere.radius``), with its unit in the heading (``radius [mm]``,
``radius_mm``) or in the cells (``5.19 mm``).
"""

import difflib
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from viscotack.cards import cards, plausible, unusual
from viscotack.errors import InputError
from viscotack.model.geometry import BODIES, SHAPES
from viscotack.model.materials.words import MODELS
from viscotack.model.problem.inputs import Input, inputs_of
from viscotack.model.problem.problem import Problem
from viscotack.model.problem.rough_case import RoughCase
from viscotack.model.protocol import Retraction
from viscotack.model.traction import LAWS
from viscotack.units import is_number, parse, readable

from .kinds import INPUTS, Kind, kind_of_problem, plain_heading

_IN_BRACKETS = re.compile(r"(.*?)\s*[\[(]\s*([^\[\]()]+?)\s*[\])]")
# Keys of problem files that no table of changes may vary, beside the numbers of all classes.
_WORDS = (
    "base cycles history law model moves passport preload_depth preload_force preload_radius "
    "preload_stress start strength temperature"
)
_ALIKE = 0.8  # similarity of a misspelled heading


@dataclass(frozen=True)
class Column:
    """A column that replaces a number of the problem.

    Attributes
    ----------
    heading : str
        Of the table.
    number : Input
        The number of the problem.
    unit : str
        Unit in the heading; "" for none.
    in_si : bool
        Whether the unit of the number is one of the world.
    """

    heading: str
    number: Input
    unit: str
    in_si: bool

    def read(self, cell: Any) -> float:
        """Return the number of a cell in the unit of the input; InputError if it has none."""
        unit = self.number.unit if self.in_si else "1"
        try:
            return plausible("it", parse(self._stated(cell), unit), self.number.unit)
        except InputError as error:
            words = str(error).removeprefix("it ")
            joint = " " if words.startswith("must ") else ": "
            raise InputError(f"{self.heading}{joint}{words}") from None

    def _stated(self, cell: Any) -> Any:
        """Return a cell with its unit; a number in Python, and below a path, is in SI."""
        text = cell.strip() if isinstance(cell, str) else cell
        if text == "":
            raise InputError("the cell is empty")
        if isinstance(text, str) and not is_number(text):
            return text
        if isinstance(text, bool) or not isinstance(text, str | int | float):
            return text
        if self.unit:
            return f"{text} {self.unit}"
        if isinstance(text, str) and self.in_si and self.number.unit != "1":
            if self.heading != self.number.path:
                example = self.number.card.example or f"1 {self.number.unit}"
                raise InputError(
                    f"{text!r} has no unit; write it in the heading, "
                    f"'{self.heading} [{example.split(' ', 1)[1]}]', or in the cells, '{example}'"
                )
            return float(text)
        return text


@dataclass(frozen=True)
class Changes:
    """The columns of a table of changes.

    Attributes
    ----------
    problem : Problem, Groups or RoughCase
        The problem that all rows change.
    columns : tuple of Column
        Those that replace numbers.
    carried : tuple of str
        Headings of the others.
    """

    problem: Any
    columns: tuple[Column, ...]
    carried: tuple[str, ...]

    def kind(self) -> Kind:
        """Return the kind of case whose problems differ in the replaced numbers."""
        return kind_of_problem(self.problem, {column.number.path for column in self.columns})

    @property
    def notes(self) -> tuple[str, ...]:
        """Remark on the columns that change nothing."""
        if not self.carried:
            return ()
        return (f"columns without effect, carried along: {', '.join(self.carried)}",)

    def values(self, row: Mapping[str, Any]) -> dict[str, float]:
        """Return the replaced numbers of a row by path."""
        return {column.number.path: column.read(row[column.heading]) for column in self.columns}

    def is_empty(self, row: Mapping[str, Any]) -> bool:
        """Return whether a row has no cell with content."""
        return not any(str(cell).strip() for cell in row.values())

    def unusual(self, values: Mapping[str, float]) -> list[str]:
        """Return warnings of numbers of a row with an improbable magnitude."""
        of = {column.number.path: column for column in self.columns}
        told = (unusual(of[p].heading, x, of[p].number.unit) for p, x in values.items())
        return [words for words in told if words]

    def words(self, row: Mapping[str, Any]) -> str:
        """Return the first cell of a row that changes nothing, and the replaced numbers."""
        said = [str(cell) for cell in row.get("carried", {}).values() if str(cell).strip()][:1]
        for column in self.columns if row["inputs"] else ():
            number, value = column.number, row["inputs"][column.number.path]
            unit = number.unit if column.in_si else ""
            said.append(f"{number.path} {readable(value, unit, digits=6)}")
        return ", ".join(said)

    def carried_of(self, row: Mapping[str, Any]) -> dict[str, Any]:
        """Return the cells of a row that change nothing."""
        return {heading: row[heading] for heading in self.carried}


def changes_of(problem: Any, headings: Iterable[str]) -> Changes:
    """Find the columns of a table that replace numbers of a problem.

    Parameters
    ----------
    problem : Problem, Groups or RoughCase
        The problem that all rows change.
    headings : iterable of str
        Of the table. Case, and spaces or dashes for underscores, make no difference.

    Raises
    ------
    InputError
        If a heading is misspelled, ambiguous, names a key that the problem does not state as a
        number, or has a wrong unit; if two name one number, or none does.

    Examples
    --------
    >>> from viscotack import AtDepth, Elastic, LennardJones, Problem, Retraction, Sphere
    >>> lens = Problem(
    ...     material=Elastic(rubbery_modulus=1e6, poisson_ratio=0.5),
    ...     traction=LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-6),
    ...     geometry=Sphere(1e-3),
    ...     protocol=Retraction(start=AtDepth(1e-6), speed=1e-5),
    ... )
    >>> found = changes_of(lens, ["sample", "Radius [mm]", "speed"])
    >>> found.values({"sample": "a", "Radius [mm]": "2", "speed": "30 um/s"})
    {'sphere.radius': 0.002, 'protocol.speed': 3e-05}
    >>> found.carried
    ('sample',)
    """
    in_si = isinstance(problem, Problem | RoughCase)
    columns, carried = columns_of(headings, inputs_of(problem), in_si=in_si)
    if not columns:
        known = inputs_of(problem)
        raise InputError(
            f"no column is a number of the problem, got {', '.join(carried) or 'none'}; it has "
            f"{_shown(_names(known), known)}"
        )
    return Changes(problem, columns, carried)


def columns_of(
    headings: Iterable[str], known: Mapping[str, Input], *, in_si: bool
) -> tuple[tuple[Column, ...], tuple[str, ...]]:
    """Return the columns of a table that are one of these inputs, and the other headings.

    Raises
    ------
    InputError
        As :func:`changes_of`, except if none is an input.
    """
    names = _names(known)
    keys, shown = _keys() if in_si else set[str](), _shown(names, known)
    tables = {name.partition(".")[0] for name in names if "." in name}
    columns: list[Column] = []
    carried: list[str] = []
    for heading in map(str, headings):
        name, unit = _split(heading, names, known)
        plain = plain_heading(name)
        near = difflib.get_close_matches(plain, names, 1, _ALIKE)
        paths = names.get(plain, set())
        if len(paths) > 1:
            raise InputError(f"{heading!r} may be {' or '.join(sorted(paths))}; write one of these")
        if paths:
            columns.append(_column(heading, known[next(iter(paths))], unit, in_si=in_si))
        elif plain in keys:
            raise InputError(
                f"the column {heading!r} is no number that this problem states; a table can change "
                f"{shown}"
            )
        elif near or ("." in name and plain.partition(".")[0] in tables):
            hint = f"did you mean {near[0]}? A" if near else "a"
            raise InputError(f"unknown column {heading!r}; {hint} table can change {shown}")
        else:
            carried.append(heading)
    twice = [c.heading for c in columns if sum(c.number.path == d.number.path for d in columns) > 1]
    if twice:
        raise InputError(f"the columns {' and '.join(twice)} state one number; remove one")
    return tuple(columns), tuple(carried)


def _column(heading: str, number: Input, unit: str, *, in_si: bool) -> Column:
    if unit and not in_si:
        raise InputError(f"{heading!r}: the problem is dimensionless; leave out the unit")
    if unit:
        try:
            parse(f"1 {unit}", number.unit)
        except InputError as error:
            raise InputError(f"heading {heading!r}: {error}") from None
    return Column(heading, number, unit, in_si)


def _names(known: Mapping[str, Input]) -> dict[str, set[str]]:
    """Return the names of inputs, in plain spelling -> paths."""
    found: dict[str, set[str]] = {}
    for path in known:
        for name in {path, path.partition(".")[2] or path}:
            found.setdefault(plain_heading(name), set()).add(path)
    return found


def _keys() -> set[str]:
    """Return the keys of problem files and of tables without dimensions, in plain spelling."""
    kinds = (Retraction, *MODELS.values(), *LAWS.values(), *SHAPES.values(), *BODIES.values())
    numbers = {name for kind in kinds for name in cards(kind)}
    return {*map(plain_heading, numbers), *INPUTS, *_WORDS.split()}


def _split(
    heading: str, names: Mapping[str, set[str]], known: Mapping[str, Input]
) -> tuple[str, str]:
    """Return the name and the unit in a heading: radius [mm], radius (mm) or radius_mm."""
    if found := _IN_BRACKETS.fullmatch(heading.strip()):
        return found[1], _unit(found[2])
    plain = plain_heading(heading)
    if plain in names:
        return heading, ""
    for name in sorted(names, key=len, reverse=True):
        if plain.startswith(f"{name}_"):
            rest = heading.strip()[len(name) + 1 :]
            for unit in (rest, _unit(rest.replace("_per_", "/").replace("_", "/", 1))):
                if _is_unit(unit, known[next(iter(names[name]))].unit):
                    return heading.strip()[: len(name)], unit
    return heading, ""


def _unit(text: str) -> str:
    return "" if text in ("1", "-") else text


def _is_unit(text: str, unit: str) -> bool:
    try:
        parse(f"1 {text}", unit)
    except InputError:
        return False
    return bool(text)


def _shown(names: Mapping[str, set[str]], known: Mapping[str, Input]) -> str:
    """Return the numbers of a problem as words, by their shortest unambiguous names."""
    found = []
    for path, number in known.items():
        own = [n for n, paths in names.items() if paths == {path}]
        unit = "" if number.unit == "1" else f" [{number.unit}]"
        found.append(f"{min(own or [path], key=len)}{unit}")
    return ", ".join(found)
