"""Allow-lists of the tiers: shapes, bodies, laws, solids and tests for which each was verified."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from viscotack.problem import Groups

# For `Verified.solids`: any linear solid.
ANY: tuple[type, ...] = ()


@dataclass(frozen=True)
class Verified:
    """The classes for which a tier was compared with simulations; one tuple per kind.

    Classes are compared exactly, because a subclass may behave differently.

    Attributes
    ----------
    shapes, bodies, laws : tuple of type
        Indenters, bodies (for a layer the class of its base) and traction laws.
    solids : tuple of type
        Materials; empty for any linear solid, if the tier itself compares its creep or its
        modulus with the verified ones.
    starts : tuple of type
        States in which the test may begin.
    moves, springs : bool
        Whether moves before the retraction, and a compliant machine, are allowed.
    ranges : mapping
        Smallest and largest value of each input, for :func:`viscotack.problem.ranges.outside`.
    """

    shapes: tuple[type, ...]
    bodies: tuple[type, ...]
    laws: tuple[type, ...]
    solids: tuple[type, ...]
    starts: tuple[Any, ...]
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
                return f"the {what} is {given.__name__}; verified only for {_names(allowed)}"
        return self._refuses_test(groups, groups.units["stiffness"])

    def _refuses_test(self, groups: Groups, unit: str) -> str:
        if type(groups.start) not in self.starts:
            words = [start.word for start in self.starts]
            # a user-defined subclass has the word of its base, so its class is named
            is_own = isinstance(groups.start, self.starts)
            given = type(groups.start).__name__ if is_own else f"{groups.start}"
            return f"the test begins with {given}; verified only for {_listed(words)}"
        if groups.moves and not self.moves:
            return (
                f"the machine moves before the retraction: {groups.moves[0]!r}; verified only for "
                "a retraction from rest"
            )
        if groups.stiffness is not None and not self.springs:
            return (
                f"the machine has a stiffness of {groups.stiffness:.4g} x {unit}; verified only "
                "for a rigid machine"
            )
        if groups.rate is None and not self.moves:
            return "the test has no retraction at constant speed"
        return ""


def _names(classes: tuple[type, ...]) -> str:
    return _listed([each.__name__ for each in classes])


def _listed(words: list[str]) -> str:
    *others, last = words
    return f"{', '.join(others)} and {last}" if others else last
