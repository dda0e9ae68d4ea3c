r"""Closed-form measures of whether a rough surface sticks to an elastic body.

**Energy of full contact** (Persson and Tosatti 2001, doi:10.1063/1.1398300). To follow all of the
roughness an elastic half-space stores, per area,

.. math:: U = \frac{E^*}{4} \langle h\, |q| h \rangle

with |q| h the map whose Fourier components are multiplied by their wave number; a wave of amplitude
a stores :math:`E^* q a^2/8`. Where U exceeds the work of adhesion, full contact does not last. On a
layer the wave number is divided by the transfer function.

**Adhesion parameter** (Fuller and Tabor 1975, doi:10.1098/rspa.1975.0138) of asperities of radius R
whose heights scatter by sigma,

.. math:: \theta = \frac{E^* \sigma^{3/2}}{R^{1/2} \Delta\gamma} .

They found little adhesion above about 10. Here sigma is the rms height and 1/R the rms curvature of
the map, which overestimates both for a map with waves of many lengths.

**Repulsion over attraction at small loads** (Pastewka and Robbins 2014,
doi:10.1073/pnas.1320846111, Eq. 10). Patches of contact have the mean pressure
:math:`h' E^*/\kappa`, with the rms slope h' and :math:`\kappa = 2`, and the mean diameter
:math:`d = 4 h'/h''`, with the rms curvature h''. Around them the gap of a Hertzian edge opens like
:math:`g = g_0 (x/d)^{3/2}` with :math:`g_0 = \tfrac43 h' d`, so that the stress
:math:`\Delta\gamma/\rho` attracts over a rim of width :math:`(\rho/g_0)^{2/3} d`. A patch has the
perimeter :math:`\pi/d` per area. The surface sticks where the rim attracts more than the patch
repels, about where

.. math:: \frac{h' E^* \rho}{2 \Delta\gamma} \Big(\frac{h'^2}{h'' \rho}\Big)^{2/3} < 1 .

Constants and this form, whose limit these steps give as :math:`\pi (3/16)^{2/3} = 1.03`, are those
of the example ``rough.py`` of the package Adhesion of one of its authors, which also states that
:math:`\rho/g_0` should be below 0.1. Here the range :math:`\rho` is the work of adhesion over the
strength of the law.

**Bearing area** (after Ciavarella 2018, doi:10.1007/s11012-017-0701-6, for hard surfaces). At a
mean gap u the law attracts over the undeformed heights of the map, except where it would overlap
the body, and the contacts repel with the pressure p(u) of a surface without adhesion. That is not
the published fit but the theory of Persson (2007, doi:10.1103/PhysRevLett.99.125502) for the
spectrum of this map, without adjusted constants: with the mean square :math:`a_q` of the waves of
wave number q, the stiffness S(q) of the body and the variance of pressure
:math:`V(q) = E^{*2} \sum_{q' \le q} S^2 a_{q'}`,

.. math:: U(p) = \frac{E^*}{2} \sum_q S a_q\, \mathrm{erf} \frac{p}{\sqrt{2 V}} , \qquad
          u(p) = \int_p^\infty \frac{dU}{dp'} \frac{dp'}{p'}
               = \frac{E^*}{2\sqrt\pi} \sum_q \frac{S a_q}{\sqrt{2 V}}
                 E_1\Big(\frac{p^2}{2 V}\Big) .

The pull-off stress is the largest attraction less repulsion, or the attraction of the undeformed
map where its highest point begins to touch, if that is larger: a finite map repels no earlier.

All of these are elastic; with the relaxed modulus they concern a slow pull, with the instantaneous
one a fast pull of a contact that was formed fast.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.special import exp1

from viscotack.simulate.grid.plane import Plane

from .problem import RoughProblem

# Proportionality of pressure and slope in contact, and limit of the range (Pastewka and Robbins).
_KAPPA = 2.0
LONGEST_RANGE = 0.1
# Pressures over their rms in full contact at which the bearing area is evaluated, and heights.
_PRESSURES = np.geomspace(1e-10, 1.0, 200)
_HEIGHTS = (np.arange(2000) + 0.5) / 2000
# Gaps of the highest point at which the undeformed map attracts [equilibrium gaps].
_TOUCHING = np.linspace(0.0, 1.0, 11)


@dataclass(frozen=True)
class Stickiness:
    """Measures of stickiness of a rough surface on its relaxed body.

    Attributes
    ----------
    full_contact : float
        Elastic energy of full contact over the work of adhesion; below 1 full contact lasts.
    full_contact_fast : float
        The same with the instantaneous modulus.
    fuller_tabor : float
        Adhesion parameter theta; there is little adhesion above about 10.
    pastewka_robbins : float
        Repulsion over attraction of patches of contact at small loads; below 1 the surface sticks.
    range_over_gap : float
        Range of the law over the gap g0 around patches; the former holds below 0.1.
    bearing_area_stress : float or None
        Pull-off stress of hard surfaces by the bearing area [Pa]; None for a map that is not
        periodic.
    """

    full_contact: float
    full_contact_fast: float
    fuller_tabor: float
    pastewka_robbins: float
    range_over_gap: float
    bearing_area_stress: float | None

    @property
    def record(self) -> dict[str, float | None]:
        """Measures by the names of an answer; None for a range without a gap, of a flat map."""
        reach = self.range_over_gap
        return {
            "full_contact_energy_over_work": self.full_contact,
            "full_contact_energy_over_work_fast": self.full_contact_fast,
            "fuller_tabor": self.fuller_tabor,
            "pastewka_robbins": self.pastewka_robbins,
            "range_over_gap_at_patches": reach if np.isfinite(reach) else None,
            "bearing_area_stress_Pa": self.bearing_area_stress,
        }


def stickiness(problem: RoughProblem) -> Stickiness:
    """Return measures of stickiness of a problem.

    The energy of a map that is not periodic is that of its part without mean and tilt, repeated.

    Examples
    --------
    >>> from viscotack import AtDepth, Elastic, LennardJones, Retraction
    >>> from viscotack.model.surfaces import HeightMap
    >>> x = (np.arange(32) + 0.5) / 32
    >>> wave = HeightMap(1e-6 * np.add.outer(np.cos(2 * np.pi * x), 0 * x), 10e-6, periodic=True)
    >>> problem = RoughProblem(
    ...     surface=wave,
    ...     material=Elastic(rubbery_modulus=0.75e6, poisson_ratio=0.5),
    ...     traction=LennardJones(work_of_adhesion=0.1, equilibrium_gap=1.5e-6),
    ...     protocol=Retraction(start=AtDepth(1e-6), speed=1e-6),
    ... )
    >>> f"{stickiness(problem).full_contact:.5f} {1e6 * 2 * np.pi / 320e-6 * 1e-12 / 8 / 0.1:.5f}"
    '0.02454 0.02454'
    """
    surface, law = problem.surface, problem.traction
    if not surface.periodic:
        surface = surface.levelled()
    shape: tuple[int, int] = surface.heights.shape  # type: ignore[assignment]
    plane = Plane(shape, surface.pixel, problem.body, periodic=True)
    h = surface.heights - surface.heights.mean()
    E, work = problem.material.contact_modulus, law.work_of_adhesion
    full = E * float(np.mean(h * plane.held(h))) / 2 / work
    spread = problem.roughness
    slope, bent = spread.rms_slope, spread.rms_curvature
    reach = work / law.strength
    # a flat map has no patches, and sticks
    widening = slope**2 / (bent * reach) if bent else 0.0
    return Stickiness(
        full,
        full / problem.material.modulus_ratio,
        E * spread.rms_height**1.5 * bent**0.5 / work,
        slope * E * reach / (_KAPPA * work) * widening ** (2 / 3),
        3 / (16 * widening) if widening else np.inf,
        _bearing_area(problem, plane, h) if problem.surface.periodic else None,
    )


def _bearing_area(problem: RoughProblem, plane: Plane, h: npt.NDArray) -> float:
    """Return the pull-off stress [Pa] by attraction over the heights h less Persson's pressure."""
    law, E = problem.traction, problem.material.contact_modulus
    if not np.ptp(h):
        return law.strength

    def pull(gap: float, heights: npt.NDArray) -> float:
        apart = gap - heights
        apart = apart[apart > 0] + law.equilibrium_gap
        return float(np.sum(law.traction(apart))) / heights.size

    some = np.quantile(h, _HEIGHTS)
    pressed = [pull(u, some) - p for u, p in zip(*_mean_gap(plane, E, h), strict=True)]
    rigid = [pull(h.max() + x * law.equilibrium_gap, h) for x in _TOUCHING]
    return max(*pressed, *rigid)


def _mean_gap(plane: Plane, E: float, h: npt.NDArray) -> tuple[npt.NDArray, npt.NDArray]:
    """Return mean gaps [m] and pressures [Pa] of a periodic surface that does not adhere."""
    power = np.abs(np.fft.rfft2(h) / h.size) ** 2
    # the transform has half of the waves
    power[:, 1 : (h.shape[1] + 1) // 2] *= 2
    q, order = np.unique(plane.wave_number, return_inverse=True)
    a = np.bincount(order.ravel(), power.ravel())
    S = np.bincount(order.ravel(), plane.stiffness.ravel()) / np.bincount(order.ravel())
    V = E**2 * np.cumsum(S**2 * a)
    kept = (q > 0) & (V > 0)
    S, a, V = S[kept], a[kept], V[kept]
    pressure = np.sqrt(V[-1]) * _PRESSURES
    weights = E * S * a / (2 * np.sqrt(2 * np.pi * V))
    return exp1(pressure[:, None] ** 2 / (2 * V)) @ weights, pressure
