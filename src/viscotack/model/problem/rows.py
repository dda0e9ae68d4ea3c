"""Rows of numbers as problems: cases of campaigns, and tables of changes of one problem.

A kind of case is a row of numbers with names. ``"sphere"`` has those of ``viscotack simulate
sphere`` (power law), ``"solid"`` those of a sphere on one of many random solids, ``"punch"`` those
of a punch on a layer of a standard solid; of any other problem each number is an input, named by
its path.

In a table of changes each row replaces numbers of one problem; other columns are carried along. A
column is named by a key of the problem file (``radius``) or by the path of the number
(``sphere.radius``), with its unit in the heading (``radius [mm]``, ``radius_mm``) or in the cells
(``5.19 mm``).
"""

import difflib
import re
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, fields
from functools import partial
from typing import Any

from viscotack.cards import Quantity, card_of, cards, plausible, unusual
from viscotack.errors import InputError, placed
from viscotack.model.geometry import BODIES, SHAPES, FlatPunch, Layer
from viscotack.model.materials import MODELS, RetardationPowerLaw, StandardSolid
from viscotack.model.materials.constants import ModulusRatio
from viscotack.model.materials.random_solids import LAST, random_solid
from viscotack.model.problem import plane, revolution
from viscotack.model.problem.case_file import STARTS, GroupsTable, PassportTable, ProtocolTable
from viscotack.model.problem.inputs import Input, changed, check_paths, inputs_of
from viscotack.model.problem.problem import Groups
from viscotack.model.protocol import Apart
from viscotack.model.traction import LAWS
from viscotack.units import is_number, parse, readable

Inputs = Mapping[str, float]
_IN_BRACKETS = re.compile(r"(.*?)\s*[\[(]\s*([^\[\]()]+?)\s*[\])]")
_ALIKE = 0.8  # similarity of a misspelled heading


@dataclass(frozen=True)
class Kind:
    """A kind of case.

    Attributes
    ----------
    name : str
        As a plan writes it.
    columns : tuple of str
        Inputs that every case has.
    problem : callable
        Returns the problem of a case from its inputs by name; ValueError where they are impossible.
    choices : tuple of str
        Inputs of which a case has exactly one; () for none.
    inputs : mapping
        What they are and what they are measured in, by name.
    """

    name: str
    columns: tuple[str, ...]
    problem: Callable[[Inputs], Any]
    choices: tuple[str, ...]
    inputs: Mapping[str, Input]

    def check(self, given: set[str]) -> None:
        """Refuse input names that do not state a case of this kind."""
        chosen = given & set(self.choices)
        if given - chosen != set(self.columns) or len(chosen) != bool(self.choices):
            choice = f" and exactly one of {', '.join(self.choices)}" if self.choices else ""
            raise InputError(
                f"a case of kind {self.name!r} has the inputs {', '.join(self.columns)}{choice}, "
                f"got {', '.join(sorted(given)) or 'none'}"
            )


_STARTS = {key: kind for key, kind in STARTS["1"].items() if kind is not Apart}


def _case(kind: str, inputs: Inputs) -> Groups:
    """Return the dimensionless problem of a row."""
    k = card_of(ModulusRatio).checked("modulus_ratio", inputs["modulus_ratio"])
    unit = {"rubbery_modulus": 1.0, "glassy_modulus": 1 / k, "tau0": 1.0, "poisson_ratio": 0.0}
    (start,) = (make(inputs[name]) for name, make in _STARTS.items() if name in inputs)
    numbers: dict[str, Any] = {name: inputs.get(name) for name in ("tabor", "cohesion", "rate")}
    if kind == "punch":
        body = Layer(inputs["thickness"])
        material, shape = StandardSolid(**unit), FlatPunch(inputs["size"])
        return Groups(material=material, start=start, geometry=shape, body=body, **numbers)
    if kind == "solid":
        return Groups(material=random_solid(inputs["solid"], k), start=start, **numbers)
    material = RetardationPowerLaw(**unit, exponent=inputs["exponent"])
    return Groups(material=material, start=start, **numbers)


def _inputs() -> dict[str, Input]:
    """Return the inputs of all kinds; forces of a punch are stresses in sigma0."""
    found: dict[str, Any] = {
        name: cards(Groups)[name].card for name in ("tabor", "cohesion", "rate")
    }
    found |= {name: next(iter(cards(start).values())).card for name, start in _STARTS.items()}
    found |= {
        **plane.SIZES,
        "modulus_ratio": card_of(ModulusRatio),
        "exponent": cards(RetardationPowerLaw)["exponent"].card,
        "solid": Quantity("1", "N", "number of a random solid", least=0, most=LAST, example="7"),
    }
    unit: Any = revolution.GROUPS
    return {
        name: Input(name, None, unit.get(card.measure, card.unit), card, pure=True)
        for name, card in found.items()
    }


INPUTS = _inputs()
KINDS: Mapping[str, Kind] = {
    name: Kind(
        name=name,
        columns=tuple(columns.split()),
        problem=partial(_case, name),
        choices=starts,
        inputs={each: INPUTS[each] for each in (*columns.split(), *starts)},
    )
    for name, columns, starts in (
        ("sphere", "tabor modulus_ratio exponent rate", tuple(_STARTS)),
        ("solid", "tabor modulus_ratio solid rate", tuple(_STARTS)),
        (
            "punch",
            "size thickness cohesion modulus_ratio rate",
            ("preload", "preload_force"),
        ),
    )
}


def plain_heading(name: str) -> str:
    """Return a heading in lower case, with underscores, as columns of cases are named.

    >>> plain_heading(" Pull-off Force")
    'pull_off_force'
    """
    return re.sub(r"[\s-]", "_", name.strip()).lower()


def kind_of_columns(headings: Iterable[str]) -> Kind:
    """Return the kind whose cases a table with these columns states."""
    names = {plain_heading(name) for name in headings}
    for kind in KINDS.values():
        if set(kind.columns) <= names <= kind.inputs.keys():
            return kind
    known = "; ".join(
        f"{kind.name}: {', '.join([*kind.columns, ' or '.join(kind.choices)])}"
        for kind in KINDS.values()
    )
    raise InputError(
        f"no kind of case has exactly the columns {', '.join(sorted(names))}; known kinds are "
        f"{known}; a table that changes a problem is a [[list]] of a plan that names the problem"
    )


def kind_of_problem(base: Any, names: set[str]) -> Kind:
    """Return the kind whose cases are a problem with some of its numbers replaced.

    Parameters
    ----------
    base : Problem, Groups or RoughCase
        The problem that the other numbers come from.
    names : set of str
        Paths of the numbers in the file, such as ``protocol.speed``; in SI.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, RetardationPowerLaw
    >>> material = RetardationPowerLaw(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, exponent=0.8, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> base = Groups(tabor=3.24, material=material.reduced(), start=AtDepth(73), rate=316.23)
    >>> kind_of_problem(base, {"preload"}).problem({"preload": 20.0}).start
    AtDepth(depth=20.0)
    """
    check_paths(base, names)
    return Kind(
        name="problem",
        columns=tuple(sorted(names)),
        problem=partial(changed, base),
        choices=(),
        inputs=inputs_of(base),
    )


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
    """

    heading: str
    number: Input
    unit: str = ""

    def read(self, cell: Any) -> float:
        """Return the number of a cell in the unit of the input; InputError if it has none.

        A number in Python, and below a path, is in SI.
        """
        number, unit = self.number, "1" if self.number.pure else self.number.unit
        text = cell.strip() if isinstance(cell, str) else cell
        is_text = isinstance(text, str)
        is_bare = is_number(text) if is_text else type(text) in (int, float)
        try:
            if text == "":
                raise InputError("the cell is empty")
            if is_bare and self.unit:
                text = f"{text} {self.unit}"
            elif is_bare and is_text and unit != "1":
                if self.heading != number.path:
                    example = number.card.example or f"1 {unit}"
                    raise InputError(
                        f"{text!r} has no unit; write it in the heading, '{self.heading} "
                        f"[{example.split(' ', 1)[1]}]', or in the cells, '{example}'"
                    )
                text = float(text)
            return plausible("it", parse(text, unit), number.unit)
        except InputError as error:
            words = str(error).removeprefix("it ")
            joint = " " if words.startswith("must ") else ": "
            raise InputError(f"{self.heading}{joint}{words}") from None


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
            unit = "" if number.pure else number.unit
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
    known = inputs_of(problem)
    columns, carried = columns_of(headings, known)
    if not columns:
        raise InputError(
            f"no column is a number of the problem, got {', '.join(carried) or 'none'}; it has "
            f"{_shown(_names(known), known)}"
        )
    return Changes(problem, columns, carried)


def columns_of(
    headings: Iterable[str], known: Mapping[str, Input]
) -> tuple[tuple[Column, ...], tuple[str, ...]]:
    """Return the columns of a table that are one of these inputs, and the other headings.

    Raises
    ------
    InputError
        As :func:`changes_of`, except if none is an input.
    """
    names, columns, carried = _names(known), list[Column](), list[str]()
    pure, shown = any(number.pure for number in known.values()), _shown(names, known)
    tables = {name.partition(".")[0] for name in names if "." in name}
    for heading in map(str, headings):
        name, unit = _split(heading, names, known)
        plain = plain_heading(name)
        near = difflib.get_close_matches(plain, names, 1, _ALIKE)
        paths = names.get(plain, set())
        if len(paths) > 1:
            raise InputError(f"{heading!r} may be {' or '.join(sorted(paths))}; write one of these")
        if paths:
            number = known[next(iter(paths))]
            if unit and pure:
                raise InputError(f"{heading!r}: the problem is dimensionless; leave out the unit")
            if unit:
                with placed(f"heading {heading!r}:"):
                    parse(f"1 {unit}", number.unit)
            columns.append(Column(heading, number, unit))
        elif not pure and plain in _keys():
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


def _names(known: Mapping[str, Input]) -> dict[str, set[str]]:
    """Return the names of inputs, in plain spelling -> paths."""
    found: dict[str, set[str]] = {}
    for path in known:
        for name in {path, path.partition(".")[2] or path}:
            found.setdefault(plain_heading(name), set()).add(path)
    return found


def _keys() -> set[str]:
    """Return the keys of problem files, in plain spelling: no column that is carried along."""
    tables = (ProtocolTable, GroupsTable, PassportTable)
    kinds: Any = (*tables, *MODELS.values(), *LAWS.values(), *SHAPES.values(), *BODIES.values())
    keys = {field.name for kind in kinds for field in fields(kind)}
    return {*map(plain_heading, keys), "law", "model", "strength", "modulus_ratio"}


def _split(
    heading: str, names: Mapping[str, set[str]], known: Mapping[str, Input]
) -> tuple[str, str]:
    """Return the name and the unit in a heading: radius [mm], radius (mm) or radius_mm."""
    if found := _IN_BRACKETS.fullmatch(heading.strip()):
        return found[1], "" if found[2] in ("1", "-") else found[2]
    plain = plain_heading(heading)
    if plain in names:
        return heading, ""
    for name in sorted(names, key=len, reverse=True):
        rest = heading.strip()[len(name) + 1 :]
        for unit in (rest, rest.replace("_per_", "/").replace("_", "/", 1)):
            if plain.startswith(f"{name}_") and unit:
                with suppress(InputError):
                    parse(f"1 {unit}", known[next(iter(names[name]))].unit)
                    return heading.strip()[: len(name)], unit
    return heading, ""


def _shown(names: Mapping[str, set[str]], known: Mapping[str, Input]) -> str:
    """Return the numbers of a problem as words, by their shortest unambiguous names."""
    found = []
    for path, number in known.items():
        own = [n for n, paths in names.items() if paths == {path}]
        unit = "" if number.unit == "1" else f" [{number.unit}]"
        found.append(f"{min(own or [path], key=len)}{unit}")
    return ", ".join(found)
