"""Which numbers state a case: the columns of a plan, by kind, and the problem that they make.

A kind is a row of numbers with names. ``"sphere"`` has those of ``viscotack simulate sphere``
(power law), ``"punch"`` those of a punch on a layer of a standard solid; with
``problem = "FILE.toml"`` any number of that problem in SI is an input, named by its path.
"""

import copy
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from viscotack.problem.punch_problem import PunchGroups
from viscotack.problem.record import from_dict, to_dict

from ..bem import has_start
from ..materials import RetardationPowerLaw, StandardSolid
from ..problem import Groups
from ..protocol import AtDepth, AtForce, AtRadius
from ..units import positive

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
    """

    name: str
    columns: tuple[str, ...]
    problem: Callable[[Inputs], Any]
    choices: tuple[str, ...] = ()
    cost: Mapping[str, float] = field(default_factory=dict)

    def check(self, given: set[str]) -> None:
        """Refuse input names that do not state a case of this kind."""
        unknown = given - {*self.columns, *self.choices}
        missing = set(self.columns) - given
        chosen = given & set(self.choices)
        if unknown or missing or len(chosen) != bool(self.choices):
            choice = f" and exactly one of {', '.join(self.choices)}" if self.choices else ""
            raise ValueError(
                f"a case of kind {self.name!r} has the inputs {', '.join(self.columns)}{choice}, "
                f"got {', '.join(sorted(given)) or 'none'}"
            )


_STARTS = {"preload": AtDepth, "preload_force": AtForce, "preload_radius": AtRadius}


def _sphere(inputs: Inputs) -> Groups:
    material = RetardationPowerLaw(**_reduced(inputs), exponent=inputs["exponent"])
    return Groups(
        tabor=inputs["tabor"], material=material, start=_start(inputs), rate=inputs["rate"]
    )


def _punch(inputs: Inputs) -> PunchGroups:
    return PunchGroups(
        size=inputs["size"],
        thickness=inputs["thickness"],
        cohesion=inputs["cohesion"],
        material=StandardSolid(**_reduced(inputs)),
        start=_start(inputs),
        rate=inputs["rate"],
    )


def _start(inputs: Inputs) -> AtDepth | AtForce | AtRadius:
    (start,) = (make(inputs[name]) for name, make in _STARTS.items() if name in inputs)
    return start


def _reduced(inputs: Inputs) -> dict[str, float]:
    ratio = positive("modulus_ratio", inputs["modulus_ratio"], "1")
    if ratio > 1:
        raise ValueError(
            f"modulus_ratio is the rubbery over the glassy modulus, in (0, 1], got {ratio:g}"
        )
    return {
        "rubbery_modulus": 1.0,
        "glassy_modulus": 1 / ratio,
        "tau0": 1.0,
        "poisson_ratio": 0.0,
    }


def has_relaxed_contact(problem: Any) -> bool:
    """Return whether the relaxed start of a problem exists; some milliseconds where in doubt.

    Pressed to a depth, or by a force, that is not negative, sphere and punch are always in
    contact: the gap in the middle is then at most h0, below that of peak tension. Else the start is
    looked for.
    """
    start = problem.groups().start
    if isinstance(start, AtDepth) and start.depth >= 0:
        return True
    if isinstance(start, AtForce) and start.force >= 0:
        return True
    return has_start(problem)


# A kind more is an entry more. The powers of the cost were fitted to the times of 1,000 cases.
KINDS = {
    "sphere": Kind(
        name="sphere",
        columns=("tabor", "modulus_ratio", "exponent", "rate"),
        choices=tuple(_STARTS),
        problem=_sphere,
        cost={"tabor": -0.14, "preload": 0.33, "rate": -0.02},
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
    raise ValueError(f"its columns ({', '.join(sorted(names))}) are of no kind; known are {known}")


def kind_of_problem(base: Any, names: set[str]) -> Kind:
    """Return the kind whose cases are a problem with some of its numbers replaced.

    Parameters
    ----------
    base : Problem
        The problem that the other numbers come from.
    names : set of str
        Paths of the numbers in ``to_dict(base)``, such as ``protocol.speed``; in SI.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, RetardationPowerLaw
    >>> material = RetardationPowerLaw(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, exponent=0.8, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> base = Groups(tabor=3.24, material=material.reduced(), start=AtDepth(73), rate=316.23)
    >>> kind_of_problem(base, {"start.depth"}).problem({"start.depth": 20.0}).start
    AtDepth(depth=20.0)
    """
    record = to_dict(base)
    for name in names:
        _put(copy.deepcopy(record), name, 0.0)
    return Kind(
        name="problem",
        columns=tuple(sorted(names)),
        problem=partial(_replaced, record),
    )


def _replaced(record: dict[str, Any], inputs: Inputs) -> Any:
    changed = copy.deepcopy(record)
    for name, value in inputs.items():
        _put(changed, name, float(value))
    return from_dict(changed)


def _put(record: Any, path: str, value: float) -> None:
    """Replace the number at a path such as ``material.branches.0.1`` in a record."""
    *way, last = path.split(".")
    at = record
    for step in way:
        at = _entry(at, step, path)
    old = _entry(at, last, path)
    if isinstance(old, bool) or not isinstance(old, int | float):
        raise ValueError(f"{path} is not a number of the problem but {old!r:.60}")
    at[int(last) if isinstance(at, list) else last] = value


def _entry(at: Any, step: str, path: str) -> Any:
    if isinstance(at, dict) and step in at:
        return at[step]
    if isinstance(at, list) and step.isdigit() and int(step) < len(at):
        return at[int(step)]
    known = [k for k in at if k != "type"] if isinstance(at, dict) else range(len(at or []))
    raise ValueError(
        f"the problem has no number {path!r}: at {step!r} there is {', '.join(map(str, known))}"
    )
