"""Kinds of cases: the columns of a plan that define a case, and the problem built from them.

A kind is a row of numbers with names. ``"sphere"`` has those of ``viscotack simulate sphere``
(power law), ``"solid"`` those of a sphere on one of many random solids, ``"punch"`` those of a
punch on a layer of a standard solid; with ``problem = "FILE.toml"`` any number of that problem in
SI is an input, named by its path.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from viscotack.cards import Quantity, card_of, cards
from viscotack.errors import InputError
from viscotack.model.geometry import FlatPunch, Layer
from viscotack.model.materials import RetardationPowerLaw, StandardSolid
from viscotack.model.materials.constants import ModulusRatio
from viscotack.model.materials.random_solids import LAST, random_solid
from viscotack.model.problem import Groups, Problem, RoughCase, plane, revolution
from viscotack.model.problem.case_file import STARTS
from viscotack.model.problem.inputs import Input, changed, check_paths, inputs_of
from viscotack.model.protocol import Apart

Inputs = Mapping[str, float]


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
    in_si : bool
        Whether that is a unit of the world, so that they may be text, "5 mm".
    """

    name: str
    columns: tuple[str, ...]
    problem: Callable[[Inputs], Any]
    choices: tuple[str, ...]
    inputs: Mapping[str, Input]
    in_si: bool = False

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

_UNIT: dict[str, Any] = {"rubbery_modulus": 1.0, "tau0": 1.0, "poisson_ratio": 0.0}
# Kind -> its solid of a row and a modulus ratio, its inputs, and its starts.
_STATED: Mapping[str, tuple[Callable[[Inputs, float], Any], str, tuple[str, ...]]] = {
    "sphere": (
        lambda row, k: RetardationPowerLaw(**_UNIT, glassy_modulus=1 / k, exponent=row["exponent"]),
        "tabor modulus_ratio exponent rate",
        tuple(_STARTS),
    ),
    "solid": (
        lambda row, k: random_solid(row["solid"], k),
        "tabor modulus_ratio solid rate",
        tuple(_STARTS),
    ),
    "punch": (
        lambda row, k: StandardSolid(**_UNIT, glassy_modulus=1 / k),
        "size thickness cohesion modulus_ratio rate",
        ("preload", "preload_force"),
    ),
}


def _case(solid: Callable[[Inputs, float], Any], inputs: Inputs) -> Groups:
    """Return the dimensionless problem of a row."""
    ratio = card_of(ModulusRatio).checked("modulus_ratio", inputs["modulus_ratio"])
    (start,) = (make(inputs[name]) for name, make in _STARTS.items() if name in inputs)
    punch: dict[str, Any] = {}
    if "size" in inputs:
        punch = {"geometry": FlatPunch(inputs["size"]), "body": Layer(inputs["thickness"])}
    return Groups(
        tabor=inputs.get("tabor"),
        cohesion=inputs.get("cohesion"),
        material=solid(inputs, ratio),
        start=start,
        rate=inputs["rate"],
        **punch,
    )


def _inputs() -> dict[str, Input]:
    """Return the inputs of all kinds, with their cards and units."""
    of = cards(Groups)
    units = revolution.GROUPS
    found = {
        "tabor": (of["tabor"].card, "1"),
        "modulus_ratio": (card_of(ModulusRatio), "1"),
        "exponent": (cards(RetardationPowerLaw)["exponent"].card, "1"),
        "rate": (of["rate"].card, units["speed"]),
        "solid": (
            Quantity("1", "N", "number of a random solid", least=0, most=LAST, example="7"),
            "1",
        ),
    }
    found |= {name: (card, card.unit) for name, card in plane.SIZES.items()}
    found["cohesion"] = (of["cohesion"].card, "1")
    for name, start in _STARTS.items():
        (entry,) = cards(start).values()
        found[name] = (entry.card, units[entry.card.measure])
    return {name: Input(name, None, unit, card) for name, (card, unit) in found.items()}


# What an input is, and what it is measured in; forces of a punch are stresses in sigma0.
INPUTS = _inputs()


KINDS: Mapping[str, Kind] = {
    name: Kind(
        name=name,
        columns=tuple(columns.split()),
        problem=partial(_case, solid),
        choices=starts,
        inputs={each: INPUTS[each] for each in (*columns.split(), *starts)},
    )
    for name, (solid, columns, starts) in _STATED.items()
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
        in_si=isinstance(base, Problem | RoughCase),
    )
