r"""A rigid map of heights on a soft body, in SI, and its units.

The relaxed solid and the interface define a length along the surface,

.. math:: \ell = \frac{E_0^* h_0^2}{\Delta\gamma_0} ,

in which the gap at the edge of a contact opens by the range of the law: over
:math:`\tfrac34 s^2 \ell` for a law of effective range s
(:func:`viscotack.model.traction.effective_range`). This zone must be resolved by pixels whatever
the shape of the surface is. Where the solid answers more stiffly than at rest the zone is longer.

**Read a rough surface and its test from a TOML file.** The tables [material], [interface],
[protocol] and perhaps [layer] are those of a case file; the table [surface] names a file of heights
or states a generated map.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, cast

import numpy as np

from viscotack.errors import InputError
from viscotack.files.toml import read_toml
from viscotack.model.geometry import HalfSpace, Layer
from viscotack.model.problem import case_file
from viscotack.model.problem.nouns import known
from viscotack.model.problem.outputs import time_unit
from viscotack.model.problem.rough_case import RoughCase
from viscotack.model.protocol import Approach, AtRadius, Retract, Retraction, Units
from viscotack.model.surfaces import HeightMap, Roughness, roughness
from viscotack.model.tables import Reading
from viscotack.model.traction import Traction, effective_range, has_rest, softening
from viscotack.simulate.grid.map_contact import MapContact
from viscotack.simulate.grid.plane import Plane

# Length of the zone in l, of a law as long as Lennard-Jones.
_ZONE = 0.75
# Largest rms slope of small strain, and fewest thicknesses of a layer across a free map.
_STEEPEST, _FEWEST = 0.5, 2.0
# Range of the heights of an even map [equilibrium gaps].
_EVEN = 1e-6
# Most pixels of a map; the memory of the machine may hold fewer.
_MOST = 8192 * 8192
# Pixels per zone: below the first the answer is refused unless forced, below the second there is a
# warning, the third is recommended.
COARSEST, COARSE, FINE = 1.0, 1.5, 2.0


@dataclass(frozen=True)
class Zone:
    """Length over which the gap opens at an edge [m], and how many pixels it has."""

    length: float
    pixels: float


@dataclass(frozen=True)
class RoughProblem:
    """A rigid map of heights that is pressed against a soft body and pulled off, in SI.

    Parameters
    ----------
    surface : HeightMap
        Heights of the rigid surface. A rough solid against a flat rigid surface is the same problem
        in the linear theory of small slopes.
    material : Elastic, StandardSolid, Prony, RetardationPowerLaw or RelaxationPowerLaw
        Material of the soft body.
    traction : LennardJones, Dugdale, Exponential or Tabulated
        Traction law of the interface; one that grows or ages is refused.
    protocol : Retraction
        State at rest, moves and retraction. Depth 0 is where the highest point has the equilibrium
        gap to the undeformed body; of a periodic half-space depth is that of its mean plane. Forces
        are those of the whole map [N].
    body : HalfSpace or Layer
        Soft body.

    Raises
    ------
    ValueError
        If a part is of the wrong kind, the rms slope is above 0.5, or a layer is so thick beside
        the map that loads are felt at its neighbours.

    Examples
    --------
    >>> from viscotack import AtDepth, Elastic, LennardJones, Retraction
    >>> from viscotack.model.surfaces import self_affine
    >>> problem = RoughProblem(
    ...     surface=self_affine(64, 5e-6, hurst=0.8, rms_height=1e-6, seed=1, shortest=60e-6),
    ...     material=Elastic(rubbery_modulus=1.5e6, poisson_ratio=0.5),
    ...     traction=LennardJones(work_of_adhesion=0.15, equilibrium_gap=1.5e-6),
    ...     protocol=Retraction(start=AtDepth(1e-6), speed=1e-6),
    ... )
    >>> f"{problem.zone.pixels:.1f} pixels for a zone of {problem.zone.length * 1e6:.1f} um"
    '4.5 pixels for a zone of 22.5 um'
    """

    surface: HeightMap
    material: Any
    traction: Traction
    protocol: Retraction
    body: Any = HalfSpace()

    def __post_init__(self) -> None:
        if not isinstance(self.surface, HeightMap):
            raise InputError(
                f"surface must be a HeightMap, got {type(self.surface).__name__}; read one with "
                "viscotack.model.surfaces.read_map"
            )
        if (many := self.surface.heights.size) > _MOST:
            raise InputError(
                f"the map has {many:,} pixels, and a simulation takes up to {_MOST:,}; cut it, or "
                "make it coarser (HeightMap.coarser) as far as a zone at an edge has 2 pixels"
            )
        if has_rest(self.traction):
            raise InputError(
                "an interface that grows or ages is not computed on rough surfaces; give its law "
                "at rest"
            )
        if not isinstance(self.body, HalfSpace | Layer):
            body = getattr(self.body, "word", type(self.body).__name__)
            raise InputError(f"a map of heights lies on a half-space or a layer, got {body}")
        if (slope := self.roughness.rms_slope) > _STEEPEST:
            raise InputError(
                f"the rms slope of the map is {slope:.3g}, and small strain holds up to "
                f"{_STEEPEST}; give heights and pixel in the same unit, or a smoother map"
            )
        if isinstance(self.body, Layer) and not self.surface.periodic:
            if _FEWEST * self.body.thickness > min(self.surface.size):
                raise InputError(
                    f"a layer under a map without neighbours may be up to 1/{_FEWEST:g} of its "
                    f"side thick, {min(self.surface.size) / _FEWEST:.3g} m; give a wider map, or "
                    "leave the layer out if it is thicker than the map is wide"
                )
        self._check_even()
        protocol = self.protocol
        ends = [m.to for m in protocol.moves if isinstance(m, Approach | Retract)]
        if any(isinstance(state, AtRadius) for state in (protocol.start, *ends)):
            raise InputError("a map has no contact radius; give a depth or a force")

    def _check_even(self) -> None:
        """Refuse an even map that opens in waves under tension before it does so everywhere.

        A wave is held by the stiffness of the body at its wave number against the falling tension
        of the law; on a half-space those longer than pi E*/fall are not.
        """
        surface, law = self.surface, self.traction.reduced()
        if not surface.periodic or np.ptp(surface.heights) > _EVEN * self.traction.equilibrium_gap:
            return
        plane = self.contact.plane
        stiffness, q = plane.stiffness.ravel(), plane.wave_number.ravel()
        least = 1 + int(np.argmin(stiffness[1:]))
        everywhere = np.inf if plane.mean_is_zero else stiffness[0]
        fall = softening(law) * law.strength**2
        if stiffness[least] < min(fall, everywhere):
            raise InputError(
                f"an even map opens under tension in waves of about "
                f"{2 * np.pi / q[least] * self.length:.3g} m, and nothing decides where; give a "
                "narrower map, heights, a thin frictionless layer or a map that does not repeat"
            )

    @cached_property
    def roughness(self) -> Roughness:
        """Statistics of the surface."""
        return roughness(self.surface)

    @property
    def length(self) -> float:
        """Unit of length along the surface, E0* h0^2/dg0 [m]."""
        h0, w = self.traction.equilibrium_gap, self.traction.work_of_adhesion
        return self.material.contact_modulus * h0**2 / w

    @property
    def zone(self) -> Zone:
        """Zone at the edge of a relaxed contact."""
        span = effective_range(self.traction)
        length = _ZONE * span**2 * self.length
        return Zone(length, length / self.surface.pixel)

    @property
    def time(self) -> float:
        """Unit of time [s]."""
        return time_unit(self.material, self.traction)

    @cached_property
    def contact(self) -> MapContact:
        """Dimensionless contact of the simulation."""
        surface, h0, along = self.surface, self.traction.equilibrium_gap, self.length
        top = float(surface.heights.max())
        if surface.beyond is not None:  # its apex lies between the pixels
            top = max(top, 0.0)
        rigid = 1 + (top - surface.heights.ravel()) / h0
        beyond = None if surface.beyond is None else surface.beyond * h0 / along**2
        plane = Plane(
            surface.heights.shape,  # type: ignore[arg-type]
            surface.pixel / along,
            self.body.reduced(along),
            surface.periodic,
        )
        law, curvature = self.traction.reduced(), self.roughness.rms_curvature * along**2 / h0
        unit = law.strength * rigid.size * plane.pixel**2  # pull-off of the whole map
        unit = min(1.5 * np.pi / curvature, unit) if curvature else unit  # or of one asperity, JKR
        return MapContact(plane, rigid, law, unit, beyond, 1 + top / h0)

    @cached_property
    def force(self) -> float:
        """Unit of force [N]."""
        law = self.traction
        per_pixel = law.work_of_adhesion / law.equilibrium_gap * self.length**2
        return self.contact.force * per_pixel

    @property
    def units(self) -> Units:
        """Factors that convert the protocol from SI."""
        return Units(1 / self.traction.equilibrium_gap, 1 / self.force, np.nan, 1 / self.time)


_TOML = (".toml", "")


def read_rough(
    path: str | os.PathLike[str],
    *,
    also: Iterable[Any] = (),
    beside: Callable[[str], Path] | None = None,
) -> RoughProblem:
    """Read a rough surface and its test from a TOML file.

    Parameters
    ----------
    path : path
        The file; docs/rough_surfaces.md describes its tables.
    also : iterable of classes
        User-defined laws and materials that the file may name by their words.
    beside : callable, optional
        Returns the path of a file named in a table; by default relative to the folder of the file.

    Raises
    ------
    ValueError
        If it is not TOML, or a table or key is missing, unknown or invalid.
    """
    case = read_rough_case(path, also=also, beside=beside)
    try:
        return problem_of(case)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def read_rough_case(
    path: str | os.PathLike[str],
    *,
    also: Iterable[Any] = (),
    beside: Callable[[str], Path] | None = None,
) -> RoughCase:
    """Read a rough surface and its test as they are stated, without making the map.

    The parameters are those of :func:`read_rough`. A measured map is stated by its file and hash.
    """
    path = Path(path)
    if path.suffix.lower() not in _TOML and path.is_file():
        raise InputError(
            f"{path} must be a TOML file with a test; name a map of heights in it: [surface] with "
            f'file = "{path.name}"'
        )
    tables = read_toml(path)
    if "surface" not in tables:
        raise InputError(f"{path}: the table [surface] is missing; see docs/rough_surfaces.md")
    reading = Reading(str(path), known(also), beside or path.parent.joinpath)
    return cast(RoughCase, case_file.problem_of(tables, reading))


def problem_of(case: RoughCase) -> RoughProblem:
    """Return the problem that is stated, with its map of heights."""
    return RoughProblem(
        surface=case.surface.map(),
        material=case.material,
        traction=case.traction,
        protocol=case.protocol,
        body=case.body,
    )
