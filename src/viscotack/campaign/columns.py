"""Kinds of cases: the columns of a plan that define a case, and the problem built from them.

A kind is a row of numbers with names. ``"sphere"`` has those of ``viscotack simulate sphere``
(power law), ``"profile"`` those of a cone or power-law tip, ``"solid"`` those of a sphere on one of
many random solids, ``"punch"`` those of a punch on a layer of a standard solid; with
``problem = "FILE.toml"`` any number of that problem in SI is an input, named by its path.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from viscotack.cards import Quantity, card_of, cards
from viscotack.errors import InputError
from viscotack.model.geometry import FlatPunch, Layer, PowerLawProfile
from viscotack.model.materials import RetardationPowerLaw, StandardSolid
from viscotack.model.materials.constants import ModulusRatio
from viscotack.model.problem import Groups, Problem, RoughCase, plane, revolution
from viscotack.model.problem.inputs import Input, changed, check_paths, inputs_of
from viscotack.model.protocol import AtDepth, AtForce, AtRadius
from viscotack.simulate import has_start
from viscotack.units import positive

from .random_solids import LAST, random_solid

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
    cost : mapping
        Powers of the inputs to which the time of a case is about proportional; for the order.
    inputs : mapping
        What they are and what they are measured in, by name.
    in_si : bool
        Whether that is a unit of the world, so that they may be text, "5 mm".
    """

    name: str
    columns: tuple[str, ...]
    problem: Callable[[Inputs], Any]
    choices: tuple[str, ...] = ()
    cost: Mapping[str, float] = field(default_factory=dict)
    inputs: Mapping[str, Input] = field(default_factory=lambda: INPUTS)
    in_si: bool = False

    def check(self, given: set[str]) -> None:
        """Refuse input names that do not state a case of this kind."""
        unknown = given - {*self.columns, *self.choices}
        missing = set(self.columns) - given
        chosen = given & set(self.choices)
        if unknown or missing or len(chosen) != bool(self.choices):
            choice = f" and exactly one of {', '.join(self.choices)}" if self.choices else ""
            raise InputError(
                f"a case of kind {self.name!r} has the inputs {', '.join(self.columns)}{choice}, "
                f"got {', '.join(sorted(given)) or 'none'}"
            )


_STARTS: dict[str, Any] = {
    "preload": AtDepth,
    "preload_force": AtForce,
    "preload_radius": AtRadius,
}


def _sphere(inputs: Inputs) -> Groups:
    return Groups(tabor=inputs["tabor"], **_test(inputs, RetardationPowerLaw))


def _profile(inputs: Inputs) -> Groups:
    q = inputs["profile_exponent"]
    shape = PowerLawProfile(1 / positive("profile_exponent", q, "1"), q)
    return Groups(tabor=inputs["tabor"], geometry=shape, **_test(inputs, RetardationPowerLaw))


def _solid(inputs: Inputs) -> Groups:
    ratio = card_of(ModulusRatio).checked("modulus_ratio", inputs["modulus_ratio"])
    material = random_solid(inputs["solid"], ratio)
    return Groups(
        tabor=inputs["tabor"], material=material, start=_start(inputs), rate=inputs["rate"]
    )


def _punch(inputs: Inputs) -> Groups:
    return Groups(
        tabor=None,
        cohesion=inputs["cohesion"],
        geometry=FlatPunch(inputs["size"]),
        body=Layer(inputs["thickness"]),
        **_test(inputs, StandardSolid),
    )


def _test(inputs: Inputs, solid: Any) -> dict[str, Any]:
    """Return material, start and rate of a case."""
    ratio = card_of(ModulusRatio).checked("modulus_ratio", inputs["modulus_ratio"])
    constants = {"exponent": inputs["exponent"]} if "exponent" in cards(solid) else {}
    material = solid(
        rubbery_modulus=1.0, glassy_modulus=1 / ratio, tau0=1.0, poisson_ratio=0.0, **constants
    )
    return {"material": material, "start": _start(inputs), "rate": inputs["rate"]}


def _start(inputs: Inputs) -> Any:
    (start,) = (make(inputs[name]) for name, make in _STARTS.items() if name in inputs)
    return start


def _inputs() -> dict[str, Input]:
    """Return the inputs of all kinds, with their cards and units."""
    of = cards(Groups)
    units = revolution.GROUPS
    found = {
        "tabor": (of["tabor"].card, "1"),
        "profile_exponent": (cards(PowerLawProfile)["exponent"].card, "1"),
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


def has_relaxed_contact(problem: Any) -> bool:
    """Return whether the relaxed start of a problem exists; some milliseconds where in doubt.

    Pressed to a depth, or by a force, that is not negative, sphere and punch are always in
    contact: the gap in the middle is then at most h0, below that of peak tension. Else the start is
    looked for with the range of its traction law, with which contacts exist beyond the end of JKR's
    (:func:`viscotack.theory.elastic.relaxed.contact`).
    """
    if isinstance(problem, RoughCase):  # found by the simulation
        return True
    start = problem.groups().start
    if isinstance(start, AtDepth) and start.depth >= 0:
        return True
    if isinstance(start, AtForce) and start.force >= 0:
        return True
    return has_start(problem)


_POWER_LAW = ("modulus_ratio", "exponent", "rate")
# A kind more is an entry more. The powers of the cost were fitted to the times of 1,000 cases.
KINDS = {
    "sphere": Kind(
        name="sphere",
        columns=("tabor", *_POWER_LAW),
        choices=tuple(_STARTS),
        problem=_sphere,
        cost={"tabor": -0.14, "preload": 0.33, "rate": -0.02},
    ),
    "profile": Kind(
        name="profile",
        columns=("tabor", "profile_exponent", *_POWER_LAW),
        choices=tuple(_STARTS),
        problem=_profile,
    ),
    "solid": Kind(
        name="solid",
        columns=("tabor", "modulus_ratio", "solid", "rate"),
        choices=tuple(_STARTS),
        problem=_solid,
    ),
    "punch": Kind(
        name="punch",
        columns=("size", "thickness", "cohesion", "modulus_ratio", "rate"),
        choices=("preload", "preload_force"),
        problem=_punch,
    ),
}


def kind_of_columns(names: set[str]) -> str:
    """Return the kind that a table with these columns states, for a bare CSV file."""
    for kind in KINDS.values():
        if set(kind.columns) <= names <= {*kind.columns, *kind.choices}:
            return kind.name
    known = "; ".join(
        f"{kind.name}: {', '.join([*kind.columns, ' or '.join(kind.choices)])}"
        for kind in KINDS.values()
    )
    raise InputError(
        f"unknown columns ({', '.join(sorted(names))}): no kind of case has exactly these; "
        f"known kinds are {known}"
    )


def kind_of_problem(base: Any, names: set[str], also: Iterable[Any] = ()) -> Kind:
    """Return the kind whose cases are a problem with some of its numbers replaced.

    Parameters
    ----------
    base : Problem, Groups or RoughCase
        The problem that the other numbers come from.
    names : set of str
        Paths of the numbers in the file, such as ``protocol.speed``; in SI.
    also : iterable of classes
        The user's own that the problem is made of.

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
    known = inputs_of(base)
    return Kind(
        name="problem",
        columns=tuple(sorted(names)),
        problem=partial(changed, base),
        inputs=known,
        in_si=isinstance(base, Problem | RoughCase),
    )
