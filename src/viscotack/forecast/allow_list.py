"""What a tier was verified for: shapes, bodies, laws, solids, tests. All else it refuses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from viscotack.problem import Groups

# Of `Verified.solids`: any linear solid.
ANY: tuple[type, ...] = ()


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
        Least and largest number of each input, for :func:`viscotack.problem.ranges.outside`.
    """

    shapes: tuple[type, ...]
    bodies: tuple[type, ...]
    laws: tuple[type, ...]
    solids: tuple[type, ...]
    starts: tuple[type, ...]
    moves: bool = False
    springs: bool = False
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    def refuses(self, groups: Groups) -> str:
        """Return the reason why a problem is not on the list, or an empty string."""
        nouns = (
            ("shape", type(groups.geometry), self.shapes),
            ("body", type(getattr(groups.body, "base", groups.body)), self.bodies),
            ("traction law", type(groups.traction), self.laws),
            ("solid", type(groups.material), self.solids or (type(groups.material),)),
        )
        for what, given, allowed in nouns:
            if given not in allowed:
                return f"the {what} is {given.__name__}, verified for {_names(allowed)} only"
        return self._refuses_test(groups, groups.units["stiffness"])

    def _refuses_test(self, groups: Groups, unit: str) -> str:
        if type(groups.start) not in self.starts:
            return f"the test begins {groups.start!r}, verified for {_names(self.starts)} only"
        if groups.moves and not self.moves:
            return (
                f"the machine moves before the retraction: {groups.moves[0]!r}, verified for a "
                "retraction from rest only"
            )
        if groups.stiffness is not None and not self.springs:
            return (
                f"the machine has a stiffness of {groups.stiffness:.4g} x {unit}, verified for a "
                "rigid machine only"
            )
        if groups.rate is None and not self.moves:
            return "the test has no retraction at a constant speed"
        return ""


def _names(classes: tuple[type, ...]) -> str:
    *others, last = [each.__name__ for each in classes]
    return f"{', '.join(others)} and {last}" if others else last
