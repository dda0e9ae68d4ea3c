"""Contact of any shape of revolution on any body, with a numerical JKR solution.

The reduced profile f has the slope 1 at 1, and its rigid gap is 1 + mu f(r).

If the slope of a shape falls somewhere (waves, rings, a hollow), a depth or force may have several
contact radii. The search for a relaxed contact starts at the largest one, as if everything inside
had been pressed together; the equilibrium solver then finds the openings inside. The mesh resolves
the details of the shape: over a panel of width h, the profile deviates from a chord linear in r^2
by :math:`h^2 |f'' - f'/r| / 8`.

**Contact of a disc and a body: mesh up to the disc edge, whole disc in contact at rest.** Lengths
along the surface are in units of the disc radius. With a sharp edge, the contact covers the whole
disc until a crack from the edge detaches it in one jump: JKR has no stable smaller contact
(Kendall).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt
from scipy.ndimage import maximum_filter1d
from scipy.optimize import brentq

from viscotack.errors import InputError
from viscotack.model.geometry import Disc, Layer, Shape, detail, end
from viscotack.model.protocol import Apart, AtForce, AtRadius, Start
from viscotack.simulate.contacts.contact import Relaxed
from viscotack.simulate.contacts.revolution import RevolutionContact
from viscotack.simulate.mesh import Grading, check_count, finer
from viscotack.simulate.settings import Settings
from viscotack.simulate.surface import Surface
from viscotack.theory._roots import least
from viscotack.theory.elastic import indenter, on_layer

# Range of radii [beta] in which contacts are searched for.
_LEAST, _MOST = 1e-6, 1e9
# Ends of the search for the minima of a shape without details [beta].
_NEAR_BETA = np.exp([-5.0, 5.0])
# Search radii for a shape with details: number per detail, and largest total number.
_LOOKS, _MOST_LOOKS = 8, 4000
# Initial outer limit of the search [beta, or details].
_FAR = 8.0
# JKR contacts are looked for up to this multiple of the radius to which a profile is known.
_BEYOND = 2.0
# Allowed deviation of a chord from such a shape, as a fraction of the range of the law; largest
# number of nodes per detail; and points per detail of the grid from which nodes are chosen.
_CHORD, _PER_DETAIL, _GRID = 0.01, 12, 16
_UNBOUND = (
    "the indenter does not rise to {:g} h0 within {:g} lengths beta; a shape rises without bound"
)
# Gap, in ranges of the law, beyond which nodes are graded; relative growth from panel to panel.
_NEAR, _WIDER = 3.0, 0.2


@dataclass(frozen=True)
class ShapeContact(RevolutionContact):
    """A reduced shape of revolution; see :class:`viscotack.simulate.contacts.contact.Contact`."""

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
        """Return the largest radius [beta] at which the indenter has risen by this much [h0]."""
        return self._where_last(self.rise, rise, _LEAST)

    def bare_radius(self, depth: float) -> float:
        """Return the contact radius [beta] at a depth [h0] without adhesion."""
        if depth <= 0:
            return 0.0
        # a convex shape sinks less than this at a third of the radius at which it has risen so far
        low = self.radius_of_rise(depth) / 3 if np.isinf(detail(self.shape)) else _LEAST
        return self._where_last(self._bare_depth, depth, low, self._widest)

    def jkr_depth(self, radius: Any) -> Any:
        """Return the JKR depth [h0] at a contact radius [beta]."""
        return self.tabor * indenter.depth(radius, **self._jkr)

    def jkr_radius(self, depth: float) -> float:
        """Return the JKR contact radius [beta] at a depth [h0]; past its end the last there was."""
        return self._where_last(self.jkr_depth, depth, self._lowest(self.jkr_depth), self._widest)

    def jkr_radius_at_force(self, force: float) -> float:
        """Return the JKR contact radius [beta] at a force [R dg]; past its end the last."""
        return self._where_last(self._jkr_force, force, self._lowest(self._jkr_force), self._widest)

    def jkr_gap(self, nodes: npt.NDArray, radius: float) -> npt.NDArray:
        """Return the JKR gap [h0] around a contact of this radius [beta]."""
        return self.tabor * indenter.gap(nodes, contact_radius=radius, **self._jkr)

    def relaxed_pull_off(self, edge: float) -> float:
        """Return the force [output unit] with which the relaxed solid pulls off at this edge.

        For a power law on a layer, see :meth:`.sphere.SphereContact.relaxed_pull_off`. Other shapes
        return infinity (no bound), because they may have several contacts and pull-offs.
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

    def relaxed(self, start: Start | Apart, settings: Settings) -> Relaxed:
        """Return the relaxed state of a start; reject contacts beyond the known profile."""
        found = super().relaxed(start, settings)
        if found.edge > end(self.shape):
            raise InputError(
                f"the relaxed contact of {start} would be larger than the profile is known, "
                f"{end(self.shape):.4g} lengths beta; press less, or give rows farther out"
            )
        return found

    def grading(self, settings: Settings, depth: float) -> Grading:
        """Return the grading of the nodes, which resolves the details of the shape."""
        grading = super().grading(settings, depth)
        if np.isinf(detail(self.shape)):
            return grading
        highest = max(depth, self.rise(self.jkr_radius(depth)), 0.0) + _NEAR * self.span
        near = min(self.radius_of_rise(highest), grading.outer_radius)
        return DetailedGrading(**asdict(grading), own=self._own_nodes(near, grading.outer_radius))

    def _own_nodes(self, near: float, outer: float) -> npt.NDArray:
        """Return nodes [beta] whose chords resolve the shape up to the radius `near`.

        Beyond that radius the node distances grow.
        """
        length = detail(self.shape)
        check_count(near / length)
        r = np.linspace(0.0, near, max(int(np.ceil(_GRID * near / length)), 64) + 1)
        ratio = np.asarray(self.shape.flank(r[1:])) / r[1:]
        bent = r[1:-1] * np.abs(np.diff(ratio)) / np.diff(r[1:])
        bent = maximum_filter1d(np.pad(bent, (1, 1), mode="edge"), _GRID + 1)
        allowed = 8 * _CHORD * self.span / (self.tabor * np.maximum(bent, 1e-300))
        many = 1 / _graded(r, np.maximum(np.sqrt(allowed), length / _PER_DETAIL))
        count = np.concatenate([[0.0], np.cumsum((many[1:] + many[:-1]) / 2 * np.diff(r))])
        check_count(count[-1])
        count *= max(1.0, 2 / count[-1])  # two panels at least
        own = np.interp(np.arange(int(count[-1]) + 1), count, r)
        step = float(own[-1] - own[-2])
        longer = int(np.ceil(np.log1p(_WIDER * 2 * outer / step) / np.log1p(_WIDER)))
        return np.append(own, own[-1] + step * np.cumsum((1 + _WIDER) ** np.arange(1, longer + 1)))

    def deepest(self, start: Start) -> float:
        """Return the approximate depth [h0] of a start, by JKR as far as it is known."""
        if isinstance(start, AtRadius):
            widest = self._widest_on_layer / self.edge_unit
            start = AtRadius(min(start.contact_radius, widest))
        return super().deepest(start)

    @property
    def _known(self) -> float:
        """Radius [beta] to which the profile is known."""
        return end(self.shape)

    @property
    def _widest_on_layer(self) -> float:
        """Largest radius [beta] at which JKR is known for this shape on this body."""
        solved = isinstance(self.body, Layer) and np.isfinite(detail(self.shape))
        return on_layer.LARGEST * self.body.decay_length if solved else np.inf

    @property
    def _widest(self) -> float:
        """Largest radius [beta] at which JKR contacts are looked for."""
        return min(_BEYOND * self._known, self._widest_on_layer, _MOST)

    def _where_last(self, function: Any, value: float, low: float, most: float = _MOST) -> float:
        """Return the largest radius at which an eventually increasing function has this value.

        The function is evaluated up to the radius `most`.
        """
        if np.isinf(detail(self.shape)):
            return inverse(lambda a: float(function(a)), value, low)
        far = min(self._far, most)
        while True:
            radii, found = self._seen(function, far)
            below = np.flatnonzero(found < value)
            if not below.size:
                return low
            last = int(below[-1])
            if 2 * radii[last] < far or (far == most and radii[last] < far):
                break
            if far == most == _MOST:
                raise InputError(_UNBOUND.format(value, most))
            if far == most == self._widest_on_layer:
                raise InputError(
                    f"the contact would be wider than {on_layer.LARGEST:g} thicknesses of the "
                    "layer, too wide for a shape with details; press less, or make the layer "
                    "thicker"
                )
            if far == most:
                raise InputError(
                    "the contact would be larger than the profile is known, "
                    f"{self._known:.4g} lengths beta; press less, or give rows farther out"
                )
            far = min(2 * far, most)
        ends = float(radii[last]), float(radii[last + 1])
        # the function at one radius has other digits than at many
        if function(ends[0]) >= value or function(ends[1]) <= value:
            return float(np.interp(value, found[last : last + 2], radii[last : last + 2]))
        return float(brentq(lambda a: float(function(a)) - value, *ends, xtol=1e-14 * ends[1]))  # type: ignore[arg-type]

    @property
    def _far(self) -> float:
        """Initial outer radius [beta] of the search on a shape with details.

        For a measured profile it is the radius to which the profile is known.
        """
        known = end(self.shape)
        return known if np.isfinite(known) else max(_FAR, _FAR * detail(self.shape))

    def _bare_depth(self, radius: Any) -> Any:
        return self.tabor * indenter.bare_depth(radius, shape=self.shape, body=self.body)

    def _jkr_force(self, radius: Any) -> Any:
        return indenter.force(radius, **self._jkr)

    def _lowest(self, function: Any) -> float:
        """Return the radius [beta] at which a function is least, of all its minima."""
        if function.__name__ not in self._minima:
            if np.isinf(detail(self.shape)):
                found = least(function, _NEAR_BETA)
            else:
                radii, values = self._seen(function, min(self._far, self._widest))
                found = float(radii[np.argmin(values)])
            self._minima[function.__name__] = found
        return self._minima[function.__name__]

    def _seen(self, function: Any, far: float) -> tuple[npt.NDArray, npt.NDArray]:
        """Return search radii [beta] for a shape with details, and the function values there."""
        key = function.__name__, far
        if key not in self._kept:
            many = int(min(_LOOKS * far / detail(self.shape), _MOST_LOOKS))
            even = np.linspace(0.0, far, max(many, _LOOKS) + 1)[1:]
            radii = np.unique(np.concatenate([np.geomspace(_LEAST, far, 100), even]))
            self._kept[key] = radii, np.asarray(function(radii))
        return self._kept[key]

    @cached_property
    def _minima(self) -> dict[str, float]:
        return {}

    @cached_property
    def _kept(self) -> dict[tuple[str, float], tuple[npt.NDArray, npt.NDArray]]:
        return {}


@dataclass(frozen=True, kw_only=True)
class DetailedGrading(Grading):
    """A grading at least as fine as the nodes that resolve the shape.

    Attributes
    ----------
    own : ndarray
        Nodes that resolve the shape; they never move, so remeshing does not interpolate there.
    """

    rings: ClassVar[bool] = True

    own: npt.NDArray

    def nodes(self, edge: float, first_edge: float) -> npt.NDArray:
        """Return the nodes, from 0 outwards, for an edge and the first edge of the run."""
        return finer(super().nodes(edge, first_edge), self.own)


def _graded(position: npt.NDArray, spacing: npt.NDArray) -> npt.NDArray:
    """Return the largest spacing that nowhere exceeds this one, nor grows faster than `_WIDER`.

    Beside much shorter panels the discrete compliance would not be positive definite.
    """
    outwards = np.minimum.accumulate(spacing - _WIDER * position) + _WIDER * position
    back = (spacing + _WIDER * position)[::-1]
    return np.minimum(outwards, np.minimum.accumulate(back)[::-1] - _WIDER * position)


def inverse(function: Callable[[float], float], value: float, low: float) -> float:
    """Return the radius at which a function increasing above `low` has this value, else `low`."""
    if value <= function(low):
        return low
    high = 2 * low
    while function(high) < value:
        high *= 2
        if high > _MOST:
            raise InputError(_UNBOUND.format(value, _MOST))
    return float(brentq(lambda a: function(a) - value, low, high, xtol=1e-14 * high))  # type: ignore[arg-type]


# Upper bound of the depth [h0] in any test of a disc.
_DEEPEST = 1e7


@dataclass(frozen=True)
class DiscContact(ShapeContact):
    """A reduced disc; see :class:`viscotack.simulate.contacts.contact.Contact`."""

    shape: Disc

    def radius_of_rise(self, rise: float) -> float:
        """Return the radius [beta] of the disc, the end of its profile."""
        return self.shape.radius

    @property
    def _known(self) -> float:
        """Infinity: the edge of a disc limits its contact, not its known range."""
        return np.inf

    def bare_radius(self, depth: float) -> float:
        """Return the contact radius [beta] at a depth [h0] without adhesion."""
        if self.shape.is_sharp:
            return self.shape.radius if depth > 0 else 0.0
        return min(super().bare_radius(depth), self.shape.radius)

    def jkr_radius(self, depth: float) -> float:
        """Return the JKR contact radius [beta] at a depth [h0], at most that of the disc."""
        radius = self.shape.radius
        return radius if self.shape.is_sharp else min(super().jkr_radius(depth), radius)

    def jkr_gap(self, nodes: npt.NDArray, radius: float) -> npt.NDArray:
        """Return the JKR gap [h0] around a contact of this radius [beta]."""
        if radius >= self.shape.radius:
            return np.zeros_like(nodes)
        return super().jkr_gap(nodes, radius)

    def relaxed_pull_off(self, edge: float) -> float:
        """Return the force [output unit] at the strength of the law on a contact of this radius.

        An upper bound whatever the work of adhesion, which decides the force of a disc at an edge.
        """
        if not edge > 0:
            return 0.0
        return np.pi * edge**2 * self.law.strength * 2 * self.tabor / (3 * np.pi)

    def deepest(self, start: Start) -> float:
        """Return the depth [h0] of a start; at given force that of the whole disc."""
        if isinstance(start, AtForce):
            whole = indenter.stiffness(self.shape.radius, contact_modulus=1.0, body=self.body)
            return self.tabor * 1.5 * np.pi * start.force / float(whole)
        return _DEEPEST if isinstance(start, AtRadius) else super().deepest(start)

    def relaxed(self, start: Start | Apart, settings: Settings) -> Relaxed:
        """Return the relaxed state of a start; reject a start by radius for a sharp edge."""
        if isinstance(start, AtRadius) and self.shape.is_sharp:
            raise InputError(
                "a disc with a sharp edge is in contact as a whole: start it at a depth or a force"
            )
        return super().relaxed(start, settings)

    def flank_power(self, radius: float) -> tuple[float, float]:
        """Return 0, because the disc has no flank, and an arbitrary exponent."""
        return 0.0, 2.0

    def surface(self, nodes: npt.NDArray) -> Surface:
        """Return the body with these nodes [beta], the last at the end of the disc."""
        return replace(super().surface(nodes), whole=self.shape.radius)

    def grading(self, settings: Settings, depth: float) -> Grading:
        """Return the grading of the nodes, which end with the disc."""
        return settings.grading_to_end(self.zone, self.law, self.shape.radius, self.body)
