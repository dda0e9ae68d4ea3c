"""Pull-off forces of one pad by the fast tiers, with their intervals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

from viscotack.errors import InputError
from viscotack.forecast import predict
from viscotack.forecast.tiers import AT_ONCE
from viscotack.geometry import Sphere
from viscotack.materials import Material
from viscotack.problem import Problem
from viscotack.protocol import AtForce, Retraction

# Budgets of a prediction [s]: surrogates alone, and theories.
SURROGATES, THEORIES = AT_ONCE, 0.5


@dataclass(frozen=True)
class Force:
    """Pull-off force of one pad with its 90 % interval [N], and the name of its tier."""

    value: float
    low: float
    high: float
    method: str


@dataclass(frozen=True)
class Pad:
    """One pad and how it is pulled, in SI: a sphere on a half-space.

    Attributes
    ----------
    material : str
        Name of the material.
    radius, preload, speed : float
        Radius of the sphere [m], force of the relaxed start [N] on this pad, and speed [m/s].
    """

    material: str
    radius: float
    preload: float
    speed: float


class Forces(Protocol):
    """What predicts the forces of pads."""

    def force(self, pad: Pad) -> Force | str:
        """Return the force of a pad, or a reason."""
        ...


@dataclass(frozen=True, eq=False)
class FastTier:
    """Predictions of pads, each computed once.

    Attributes
    ----------
    materials : mapping of str to material
        Materials by their names.
    traction : traction law
        The interface.
    budget : float
        Largest cost of a tier [s], as for :func:`viscotack.predict`.
    """

    materials: Mapping[str, Material]
    traction: Any
    budget: float
    known: dict[Pad, Force | str] = field(default_factory=dict, repr=False)

    def problem(self, pad: Pad) -> Problem:
        """Return the problem of a pad; InputError if it exceeds small strain."""
        return Problem(
            material=self.materials[pad.material],
            traction=self.traction,
            geometry=Sphere(pad.radius),
            protocol=Retraction(AtForce(pad.preload), pad.speed),
        )

    def force(self, pad: Pad) -> Force | str:
        """Return the force of a pad, or the reason why no tier within the budget predicts it."""
        if pad not in self.known:
            try:
                self.known[pad] = self._predicted(self.problem(pad))
            except InputError as reason:
                self.known[pad] = str(reason)
        return self.known[pad]

    def _predicted(self, problem: Problem) -> Force:
        found, unit = predict(problem, budget=self.budget), problem.scales().force
        low, high = found.interval
        return Force(found.pull_off_force * unit, low * unit, high * unit, found.method)
