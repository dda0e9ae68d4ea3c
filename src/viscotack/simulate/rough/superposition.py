r"""Pull-off of a rough surface by superposition: each asperity as a sphere of its own.

The theory of Fuller and Tabor (1975, doi:10.1098/rspa.1975.0138) with the asperities of the map and
the pull of each of them computed as that of a sphere: by steady cracks where they are valid, else
by simulation. All of them belong to one rigid plate. At its position z asperity i of height
:math:`h_i` has the depth :math:`z - (h_{max} - h_i)`, and the forces add up. The rest of the map
attracts like a rigid one, by the tensions in its gaps less those in the gaps of the paraboloids of
the asperities that touch. Of asperities without a map, those that do not touch at the start attract
like rigid ones (Derjaguin), :math:`2 \pi R_i \varphi`.

The asperities do not know each other: what a contact displaces elsewhere, and contacts that grow
together, are left out. The measure

.. math:: s = \frac{1}{A} \sum_i \pi \Big(a_i + \sqrt{2 R_i h_0}\Big)^2

is the share of the surface that the contacts at the start (radius a by JKR) and the surroundings of
all that touch cover. Where the energy of full contact of a map is below the work of adhesion
(:mod:`viscotack.simulate.rough.criteria`), contacts may spread over the whole map, which
asperities do not know.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq
from scipy.spatial import KDTree

from viscotack.errors import InputError
from viscotack.model.geometry import HalfSpace, Sphere
from viscotack.model.materials import Elastic
from viscotack.model.problem import Problem
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.model.protocol import Apart, Approach, AtDepth, Retraction
from viscotack.model.surfaces import Asperities, summits
from viscotack.model.traction import has_rest
from viscotack.simulate import solve
from viscotack.simulate.curve_family import (
    Curve,
    Family,
    Pull,
    nodes_between,
    pad_curve,
    side_by_side,
)
from viscotack.simulate.solver import SimulationError
from viscotack.theory.elastic import jkr

from .criteria import stickiness
from .problem import RoughProblem

# Largest share of the surface for which results are given (research/grid.py superposition).
LARGEST_SHARE = 0.15
# Largest difference of the force from that of the grid there, viscoelastic and elastic; fast pulls
# differ most.
_BANDS = (0.4, 0.06)
# Ratio of neighbouring radii between which curves are interpolated, and most radii.
_RATIO, _MOST = 1.6, 6
# Starts of the curves of a viscoelastic asperity.
_STARTS = 4
# Margin of the starts over the deepest, and most rounds in which it is found.
_MARGIN, _DEEPER = 0.05, 5
# Height [equilibrium gaps] of the plate at the end, and positions on the way.
_AWAY, _POSITIONS = 12.0, 120
# Gap from which, and depth to which an asperity approaches [equilibrium gaps].
_APART, _TOUCHED = 8.0, 0.5
# Part of the depth of the jump at which a relaxed contact exists too.
_INSIDE = 0.75
# Asperities around a pixel, of which the lowest gap counts.
_NEIGHBOURS = 6


@dataclass(frozen=True, eq=False)
class Superposition:
    """Pull-off of a surface by superposition.

    Attributes
    ----------
    curve : Curve
        Force by position of the plate, positive in compression; positions increase into the solid.
    asperities : Asperities
        All summits.
    touching : int
        Number of them in contact at the start.
    share : float
        Share s of the surface covered by contacts and their surroundings.
    full_contact : float
        Elastic energy of full contact over the work of adhesion; inf for asperities without a map,
        and for a map that continues beyond its sides.
    method : str
        Tiers of the spheres.
    band : float
        Largest relative difference from the grid that was measured where `inside` holds.
    """

    curve: Curve
    asperities: Asperities
    touching: int
    share: float
    full_contact: float
    method: str
    band: float

    @property
    def pull_off_force(self) -> float:
        """Largest tension [N]."""
        return self.curve.pull_off_force

    @property
    def pull_off_stress(self) -> float:
        """Largest tension over the area of the surface [Pa]."""
        return self.pull_off_force / self.asperities.area

    @property
    def work_of_separation(self) -> float:
        """Work of the drive in tension to separation [J]."""
        return self.curve.work

    @property
    def inside(self) -> bool:
        """Whether the asperities are far enough apart, and too rough to be flattened."""
        return not self.why

    @property
    def why(self) -> str:
        """Reason why the result is not reliable, empty if it is."""
        if self.share > LARGEST_SHARE:
            return (
                f"contacts and their surroundings cover {self.share:.2g} of the surface, and "
                f"superposition holds up to {LARGEST_SHARE}: asperities are neighbours; simulate"
            )
        if self.full_contact < 1:
            return (
                f"full contact takes {self.full_contact:.2g} of the work of adhesion, so that "
                "contacts may spread over the whole map; simulate"
            )
        return ""

    @property
    def summary(self) -> dict[str, Any]:
        """Numbers of the answer in SI."""
        return {
            "pull_off_force_N": self.pull_off_force,
            "pull_off_stress_Pa": self.pull_off_stress,
            "work_of_separation_J": self.work_of_separation,
            "asperities": len(self.asperities.radii),
            "touching": self.touching,
            "pull_off_force_error": self.band if self.inside else None,
            "share": self.share,
            "inside": self.inside,
            "why": self.why,
            "method": self.method,
        }

    def rows(self) -> list[dict[str, float]]:
        """Return the curve as rows of a table."""
        return [
            {"position_m": float(z), "force_N": float(force)}
            for z, force in zip(self.curve.position, self.curve.force, strict=True)
        ]


def superposed(
    problem: RoughProblem,
    *,
    asperities: Asperities | None = None,
    accuracy: float = DEFAULT_ACCURACY,
    force_outside: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Superposition:
    """Compute the pull-off of a rough surface by superposition of its asperities.

    Parameters
    ----------
    problem : RoughProblem
        Surface, solid, interface and test: on a half-space, from a relaxed start straight to the
        retraction.
    asperities : Asperities, optional
        Asperities of the surface; by default the summits of its map.
    accuracy : float
        Relative error of the simulations of spheres.
    force_outside : bool
        Whether to answer although asperities are neighbours or may be flattened.
    progress : callable, optional
        Called with the completed share of the work, 0 to 1.

    Raises
    ------
    ValueError
        If the problem is of another kind, no asperity touches, asperities cover more than 0.15 of
        the surface, or full contact takes less than the work of adhesion.

    Examples
    --------
    >>> from viscotack import AtForce, Elastic, LennardJones, Retraction
    >>> from viscotack.model.surfaces import bumps
    >>> problem = RoughProblem(
    ...     surface=bumps(64, 10e-6, radius=50e-6, spacing=320e-6, height=10e-6),
    ...     material=Elastic(rubbery_modulus=3e6, poisson_ratio=0.5),
    ...     traction=LennardJones(work_of_adhesion=0.05, equilibrium_gap=0.5e-6),
    ...     protocol=Retraction(start=AtForce(1e-5), speed=1e-6),
    ... )
    >>> found = superposed(problem)
    >>> f"{found.touching} bumps, {found.pull_off_force * 1e6:.1f} uN"
    '4 bumps, 68.1 uN'
    """
    _check(problem)
    found = summits(problem.surface) if asperities is None else asperities
    if problem.surface.beyond is not None and asperities is None and len(found.radii) == 1:
        found = replace(found, radii=np.array([problem.surface.beyond]))
    below = found.heights.max() - found.heights
    rubber: Any = problem.material
    still = Elastic(rubbery_modulus=rubber.rubbery_modulus, poisson_ratio=rubber.poisson_ratio)
    speed, tell = float(problem.protocol.speed or 0.0), progress or (lambda share: None)
    nodes = nodes_between(float(found.radii.min()), float(found.radii.max()), _RATIO, _MOST)
    guess = _position(problem, found, below)
    elastic = rubber.modulus_ratio == 1
    many = nodes.size * (1 if elastic else 1 + _STARTS)
    done = 0

    def rows(material: Any, starts: list[npt.NDArray]) -> Family:
        nonlocal done
        curves = []
        for radius, depths in zip(nodes, starts, strict=True):
            row = []
            for start in depths:
                row.append(
                    pad_curve(
                        _pull(problem, material, radius, speed, accuracy), AtDepth(float(start))
                    )
                )
                done += 1
                tell(min(done / many, 1.0))
            curves.append(tuple(row))
        return Family(nodes, tuple(curves), starts[0].size == 1)

    try:
        h0 = problem.traction.equilibrium_gap
        touch = np.array([_touch(_pull(problem, still, R, speed, accuracy)) for R in nodes])
        deepest = max(guess, 0.0) * (1 + 2 * _MARGIN) + h0
        for _ in range(_DEEPER):
            rest = rows(still, [np.array([deepest])] * nodes.size)
            z = _start(problem, rest, found, below)
            if z <= deepest:
                break
            deepest = (1 + _MARGIN) * z
        else:
            raise InputError("the start of the asperities was not found; press less")
        used = rest
        if not elastic:
            top = max(z, 0.0) * (1 + _MARGIN) + _MARGIN * h0
            used = rows(rubber, [np.linspace(_INSIDE * x, top, _STARTS) for x in touch])
    except SimulationError as error:
        raise InputError(f"an asperity was not computed: {error}") from None
    depth = z - below
    least = np.interp(found.radii, nodes, touch)
    touching = depth >= least
    if not touching.any():
        raise InputError("no asperity touches at the start; press harder")
    starts = np.maximum(depth, _INSIDE * least)[touching]
    curves = [
        used.curve(float(d), float(R)) for d, R in zip(starts, found.radii[touching], strict=True)
    ]
    parts = [_beginning(curve.moved(z - curve.start), z) for curve in curves]
    away = _Away(problem, found, z, depth, touching, asperities is None)
    parts.append(away.curve(min(part.end for part in parts)))
    curve = side_by_side(parts)
    if problem.protocol.stiffness is not None:
        curve = curve.behind(problem.protocol.stiffness)
    share = _share(problem, depth[touching], found.radii[touching]) / found.area
    alone = asperities is not None or problem.surface.beyond is not None
    full = np.inf if alone else stickiness(problem).full_contact
    answer = Superposition(
        curve, found, int(touching.sum()), share, full, used.method, _BANDS[elastic]
    )
    if not (answer.inside or force_outside):
        raise InputError(answer.why)
    return answer


def _check(problem: RoughProblem) -> None:
    """Refuse problems of other kinds."""
    test = problem.protocol
    if not isinstance(problem.body, HalfSpace):
        raise InputError("superposition is for a half-space; simulate the layer")
    if test.moves or problem.starts_apart or test.speed is None:
        raise InputError("superposition begins with a relaxed contact; simulate other histories")
    if problem.surface.periodic and isinstance(test.start, AtDepth):
        raise InputError(
            "the depth of a periodic map is that of the mean plane, which superposition does not "
            "have; give a preload force"
        )
    if test.stiffness is not None and problem.material.modulus_ratio != 1:
        raise InputError(
            "superposition knows the speed of asperities only without a spring; simulate"
        )
    if has_rest(problem.traction):
        raise InputError("an interface that grows or ages is not computed on rough surfaces")


def _pull(
    problem: RoughProblem, material: Any, radius: float, speed: float, accuracy: float
) -> Pull:
    pad = Problem(
        material=material,
        traction=problem.traction,
        geometry=Sphere(radius=float(radius)),
        protocol=Retraction(start=AtDepth(0.0), speed=speed),
    )
    return Pull(pad, speed, accuracy=accuracy)


def _touch(pull: Pull) -> float:
    """Return the depth near which an elastic sphere that approaches jumps into contact [m]."""
    h0 = pull.pad.traction.equilibrium_gap
    approach = Approach(speed=pull.speed, to=AtDepth(_TOUCHED * h0))
    test = Retraction(start=Apart(_APART * h0), moves=(approach,), speed=pull.speed)
    found = solve(replace(pull.pad, protocol=test), until="pull-off", estimate_error=False)
    first = int(np.argmax(np.nan_to_num(found.contact_radius) > 0))
    # the step before is the last one without contact
    return min(float(found.depth[max(first - 1, 0)]) * h0, 0.0)


def _jkr(problem: RoughProblem, depth: npt.NDArray, radii: npt.NDArray) -> tuple[Any, Any]:
    """Return radii [m] and forces [N] of relaxed contacts by JKR."""
    solid = {
        "contact_modulus": problem.material.contact_modulus,
        "work_of_adhesion": problem.traction.work_of_adhesion,
    }
    a = np.asarray(jkr.contact_radius_at_depth(depth, radius=radii, **solid))
    return a, np.asarray(jkr.force(a, radius=radii, **solid))


def _position(problem: RoughProblem, found: Asperities, below: npt.NDArray) -> float:
    """Return about the position of the plate at the start [m]."""
    start: Any = problem.protocol.start
    if isinstance(start, AtDepth):
        return start.depth

    def missing(z: float) -> float:
        touching = z >= below
        if not touching.any():
            return -start.force
        return (
            float(_jkr(problem, z - below[touching], found.radii[touching])[1].sum()) - start.force
        )

    return _crossing(missing, start.force, problem, float(below.max()))


def _crossing(
    missing: Callable[[float], float], force: float, problem: RoughProblem, most: float
) -> float:
    """Return the deepest position at which the force vanishes that is missing."""
    high = problem.traction.equilibrium_gap
    while missing(high) <= 0:
        high *= 1.5
        if high > 100 * (most + problem.traction.equilibrium_gap) + 1e-2:
            raise InputError(f"the asperities do not carry the force at the start, {force:.4g} N")
    low = high
    while missing(low) > 0:
        if low < -problem.traction.equilibrium_gap:
            raise InputError(f"no contact of asperities carries {force:.4g} N at rest")
        low = low / 1.5 if low > 1e-3 * high else low - 0.1 * high
    return float(brentq(missing, low, high, xtol=1e-6 * high))  # type: ignore[arg-type]


def _start(problem: RoughProblem, rest: Family, found: Asperities, below: npt.NDArray) -> float:
    """Return the position of the plate at the start [m], by the curves at rest."""
    start: Any = problem.protocol.start
    if isinstance(start, AtDepth):
        return start.depth

    def missing(z: float) -> float:
        forces = rest.start_forces(z - below, found.radii)
        away = below > z
        attraction = 2 * np.pi * found.radii[away] @ _energy(problem, z - below[away])
        return float(forces.sum() + attraction) - start.force

    return _crossing(missing, start.force, problem, float(below.max()))


def _energy(problem: RoughProblem, depth: npt.NDArray) -> npt.NDArray:
    """Return the interface energy [J/m^2] of rigid surfaces at the apex, not positive."""
    law = problem.traction
    gap = 1 - np.asarray(depth) / law.equilibrium_gap
    return law.work_of_adhesion * np.asarray(law.reduced().energy(gap))


def _beginning(curve: Curve, start: float) -> Curve:
    """Return a curve whose first position is this one to the last digit."""
    position = np.minimum(curve.position, start)
    position[0] = start
    return Curve(position, curve.force, curve.lost)


@dataclass(frozen=True, eq=False)
class _Away:
    """What attracts like a rigid surface: all but the asperities that touch."""

    problem: RoughProblem
    found: Asperities
    z: float  # position of the plate at the start [m]
    depth: npt.NDArray  # of the asperities there [m]
    touching: npt.NDArray
    has_map: bool

    def curve(self, end: float) -> Curve:
        """Return the curve from the start to where the force of the others ends, or farther."""
        last = min(end, -_AWAY * self.problem.traction.equilibrium_gap)
        position = np.linspace(self.z, last, _POSITIONS)
        forces = self._of_map(position) if self.has_map else self._of_asperities(position)
        return Curve(np.append(position, last), np.append(forces, 0.0))

    def _of_asperities(self, position: npt.NDArray) -> npt.NDArray:
        depth, radii = self.depth[~self.touching], self.found.radii[~self.touching]
        energy = [_energy(self.problem, depth + z - self.z) for z in position]
        return 2 * np.pi * np.array(energy) @ radii

    def _of_map(self, position: npt.NDArray) -> npt.NDArray:
        problem, surface = self.problem, self.problem.surface
        h0, law = problem.traction.equilibrium_gap, problem.traction.reduced()
        rows, columns = surface.heights.shape
        x, y = np.meshgrid(np.arange(rows) + 0.5, np.arange(columns) + 0.5, indexing="ij")
        places = surface.pixel * np.stack([x.ravel(), y.ravel()], axis=1)
        box = surface.size if surface.periodic else None
        positions, radii = self.found.positions[self.touching], self.found.radii[self.touching]
        tree: Any = KDTree(positions % surface.size if box else positions, boxsize=box)
        near = min(_NEIGHBOURS, len(radii))
        distance, which = tree.query(places, k=[*range(1, near + 1)])
        # gaps [h0] at position 0, of the map and of the lowest paraboloid
        own = 1 + (self.found.heights.max() - surface.heights.ravel()) / h0
        below = (self.z - self.depth[self.touching])[which]
        round_ = (1 + (below + distance**2 / (2 * radii[which])) / h0).min(axis=1)
        strongest = law.edge_gap
        unit = surface.pixel**2 * (problem.traction.work_of_adhesion / h0)

        def tension(gap: npt.NDArray) -> float:
            return float(np.sum(law.traction(np.maximum(gap, strongest))))

        return np.array(
            [unit * (tension(round_ - z / h0) - tension(own - z / h0)) for z in position]
        )


def _share(problem: RoughProblem, depth: npt.NDArray, radii: npt.NDArray) -> float:
    """Return the area covered by contacts and their surroundings [m^2]."""
    a, _ = _jkr(problem, np.maximum(depth, 0.0), radii)
    return float(np.pi * ((a + np.sqrt(2 * radii * problem.traction.equilibrium_gap)) ** 2).sum())
