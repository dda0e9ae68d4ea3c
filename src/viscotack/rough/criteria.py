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

Both are elastic; with the relaxed modulus they concern a slow pull, with the instantaneous one a
fast pull of a contact that was formed fast.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from viscotack.bem.grid.plane import Plane

from .problem import RoughProblem


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
    """

    full_contact: float
    full_contact_fast: float
    fuller_tabor: float


def stickiness(problem: RoughProblem) -> Stickiness:
    """Return measures of stickiness of a problem.

    The energy of a map that is not periodic is that of its part without mean and tilt, repeated.

    Examples
    --------
    >>> from viscotack import AtDepth, Elastic, LennardJones, Retraction
    >>> from viscotack.surfaces import HeightMap
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
    return Stickiness(
        full,
        full / problem.material.modulus_ratio,
        E * spread.rms_height**1.5 * spread.rms_curvature**0.5 / work,
    )
