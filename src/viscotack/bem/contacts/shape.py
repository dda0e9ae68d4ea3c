"""Any shape of revolution on any body, its JKR contact by numbers.

The reduced profile f has the slope 1 at 1, and its rigid gap is 1 + mu f(r).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq, minimize_scalar

from viscotack.bem.contacts.revolution import RevolutionContact
from viscotack.errors import InputError
from viscotack.geometry import Layer, Shape
from viscotack.theory.elastic import indenter, on_layer

# Radii [beta] between which contacts are looked for.
_LEAST, _MOST = 1e-6, 1e9


@dataclass(frozen=True)
class ShapeContact(RevolutionContact):
    """A reduced shape of revolution; see :class:`viscotack.bem.contacts.contact.Contact`."""

    shape: Shape

    @property
    def _jkr(self) -> dict[str, Any]:
        # lengths along the surface in beta, depths in mu h0, forces in R dg
        solid = {"contact_modulus": 1.0, "work_of_adhesion": 1.0}
        return {"shape": self.shape, "body": self.body} | solid

    def rise(self, radius: Any) -> Any:
        """Return how far [h0] the indenter is above its lowest point at a radius [beta]."""
        return self.tabor * self.shape.gap(radius)

    def radius_of_rise(self, rise: float) -> float:
        """Return the radius [beta] at which the indenter has risen by this much [h0]."""
        return inverse(lambda r: float(self.rise(r)), rise, _LEAST)

    def bare_radius(self, depth: float) -> float:
        """Return the contact radius [beta] at a depth [h0] without adhesion."""
        if depth <= 0:
            return 0.0
        of = {"shape": self.shape, "body": self.body}
        return inverse(lambda a: self.tabor * float(indenter.bare_depth(a, **of)), depth, _LEAST)

    def jkr_depth(self, radius: float) -> float:
        """Return the JKR depth [h0] at a contact radius [beta]."""
        return self.tabor * float(indenter.depth(radius, **self._jkr))

    def jkr_radius(self, depth: float) -> float:
        """Return the JKR contact radius [beta] at a depth [h0]; past its end the last there was."""
        return inverse(self.jkr_depth, depth, self._last_by_depth)

    def jkr_radius_at_force(self, force: float) -> float:
        """Return the JKR contact radius [beta] at a force [R dg]; past its end the last."""
        return inverse(self._jkr_force, force, self._last_by_force)

    def jkr_gap(self, nodes: npt.NDArray, radius: float) -> npt.NDArray:
        """Return the JKR gap [h0] around a contact of this radius [beta]."""
        return self.tabor * indenter.gap(nodes, contact_radius=radius, **self._jkr)

    def relaxed_pull_off(self, edge: float) -> float:
        """Return the force [output unit] with which the relaxed solid pulls off at this edge.

        Of a power on a layer, as :meth:`.sphere.SphereContact.relaxed_pull_off`. There is no bound
        for other shapes, which may have several contacts, each with a pull-off of its own.
        """
        if not isinstance(self.body, Layer) or not isinstance(self.shape, on_layer.POWERS):
            return np.inf
        pressed = self.rise(edge) - 0.5 * self.span if edge > 0 else 0.0
        if not pressed > 0:
            return 0.0
        radius = self.radius_of_rise(pressed)
        force = on_layer.relaxed_pull_off(radius, self.shape, self.body)
        return max(force, 0.0) / (1.5 * np.pi)

    def flank_power(self, radius: float) -> tuple[float, float]:
        """Return r/f', and r f'/f."""
        flank = float(self.shape.flank(radius))
        return radius / flank, radius * flank / float(self.shape.gap(radius))

    def _jkr_force(self, radius: float) -> float:
        return float(indenter.force(radius, **self._jkr))

    @cached_property
    def _last_by_depth(self) -> float:
        return _lowest(self.jkr_depth)

    @cached_property
    def _last_by_force(self) -> float:
        return _lowest(self._jkr_force)


def _lowest(function: Callable[[float], float]) -> float:
    """Return the radius at which a function that falls and then grows is least."""
    # all lengths are of the order of beta where adhesion and elasticity balance
    found = minimize_scalar(
        lambda x: function(float(np.exp(x))), bounds=(-5.0, 5.0), method="bounded"
    )
    return float(np.exp(found.x))


def inverse(function: Callable[[float], float], value: float, low: float) -> float:
    """Return where a function that grows from a radius on has this value; `low` past its end."""
    if value <= function(low):
        return low
    high = 2 * low
    while function(high) < value:
        high *= 2
        if high > _MOST:
            raise InputError(
                f"the indenter does not rise to {value:g} h0 within {_MOST:g} lengths beta; "
                "a shape rises without bound"
            )
    return float(brentq(lambda a: function(a) - value, low, high, xtol=1e-14 * high))  # type: ignore[arg-type]
