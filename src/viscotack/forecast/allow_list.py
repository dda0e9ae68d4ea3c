"""What a tier was verified for: shapes, bodies, laws, solids, tests. All else it refuses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from viscotack.geometry import FlatPunch, HalfSpace
from viscotack.problem import Groups, PunchGroups

# Of `Verified.solids`: any linear solid.
ANY: tuple[type, ...] = ()
# Rounding of a number at the end of a range.
_ROUNDED = 1e-9


@dataclass(frozen=True)
class Verified:
    """The nouns that a tier was compared with simulations for; a tuple of classes each.

    Classes are compared exactly: a subclass may behave otherwise, and is a new noun.

    Attributes
    ----------
    shapes, bodies, laws : tuple of type
        Indenters, bodies (of a layer the class of its base) and traction laws.
    solids : tuple of type
        Materials; empty for any linear solid, where the tier itself compares its creep or its
        modulus with those that it was verified for.
    starts : tuple of type
        States in which the test begins.
    moves, springs : bool
        Whether the machine may move before the retraction, and be compliant.
    ranges : mapping
        Least and largest number of each input; :func:`outside` compares with them.
    """

    shapes: tuple[type, ...]
    bodies: tuple[type, ...]
    laws: tuple[type, ...]
    solids: tuple[type, ...]
    starts: tuple[type, ...]
    moves: bool = False
    springs: bool = False
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    def refuses(self, groups: Groups | PunchGroups) -> str:
        """Return the reason why a problem is not on the list, or an empty string."""
        punch = isinstance(groups, PunchGroups)
        nouns = (
            ("shape", FlatPunch if punch else type(groups.geometry), self.shapes),
            ("body", type(groups.base) if punch else HalfSpace, self.bodies),
            ("traction law", type(groups.traction), self.laws),
            ("solid", type(groups.material), self.solids or (type(groups.material),)),
        )
        for what, given, allowed in nouns:
            if given not in allowed:
                return f"the {what} is {given.__name__}, verified for {_names(allowed)} only"
        return self._refuses_test(groups, "sigma0/h0" if punch else "x 1.5 pi R dg0/h0")

    def _refuses_test(self, groups: Groups | PunchGroups, unit: str) -> str:
        if type(groups.start) not in self.starts:
            return f"the test begins {groups.start!r}, verified for {_names(self.starts)} only"
        if groups.moves and not self.moves:
            return (
                f"the machine moves before the retraction: {groups.moves[0]!r}, verified for a "
                "retraction from rest only"
            )
        if groups.stiffness is not None and not self.springs:
            return (
                f"the machine has a stiffness of {groups.stiffness:.4g} {unit}, verified for a "
                "rigid machine only"
            )
        if groups.rate is None and not self.moves:
            return "the test has no retraction at a constant speed"
        return ""


def at_least(value: float, least: float) -> bool:
    """Return whether a positive number reaches the lower end of a range, however it was rounded.

    A number in SI comes back from its groups with another last digit.
    """
    return value >= least * (1 - _ROUNDED)


def at_most(value: float, most: float) -> bool:
    """Return whether a positive number stays within the upper end, however it was rounded."""
    return value <= most * (1 + _ROUNDED)


def outside(values: Mapping[str, float], ranges: Mapping[str, tuple[float, float]]) -> str:
    """Return the values outside of their ranges in words, or an empty string.

    Examples
    --------
    >>> outside({"tabor": 20.0, "rate": 1.0}, {"tabor": (0.3, 8.0), "rate": (0.1, 1e8)})
    'tabor is 20, verified from 0.3 to 8'
    """
    found = []
    for name, value in values.items():
        least, most = ranges[name]
        if not (at_least(value, least) and at_most(value, most)):
            found.append(f"{name} is {value:.4g}, verified from {least:g} to {most:g}")
    return "; ".join(found)


def _names(classes: tuple[type, ...]) -> str:
    *others, last = [each.__name__ for each in classes]
    return f"{', '.join(others)} and {last}" if others else last
