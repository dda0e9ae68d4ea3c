r"""Cautions on the material of a prediction, and on linear theory.

The interval of a prediction is the error of its method. How well material and interface describe
the real contact is not part of it, and matters more where one of these cautions applies.

The edge of a contact at pull-off moves at v through its cohesive zone, whose length is that of a
slow crack, :math:`0.75\,\beta/\mu_s^2`, times the amplification :math:`\Gamma`. The highest
frequency that it excites is the cut-off of Persson and Brener,
:math:`\omega = 2 \pi v \mu_s^2/(0.75\,\beta\,\Gamma)`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from viscotack.errors import InputError
from viscotack.model.materials import Elastic
from viscotack.model.materials.passport import allowed
from viscotack.model.problem import Case, Problem
from viscotack.units import readable

from .tier import Question

if TYPE_CHECKING:
    from viscotack.model.materials.passport import Passport

# Crack speed above which silicone experiments exceed linear theory [m/s].
LINEAR_SPEED = 100e-6
# Length of the zone of a relaxed edge [beta], times the squared Tabor number.
REST_ZONE = 0.75


def cautions_on(problem: Case, *, passport: Passport | None = None) -> tuple[str, ...]:
    """Find the cautions on a prediction of this problem, as sentences.

    Parameters
    ----------
    problem : Problem or Groups
        The problem of the prediction.
    passport : Passport or None
        Passport of its material, at the temperature of the problem.

    Returns
    -------
    tuple of str
        A sentence if the material was tested at one rate only, if its passport has an uncertainty,
        if the edge excites it outside of its measured frequencies, and if the edge is faster than
        linear theory describes. Where no theory knows the edge (layers, discs, punches), no caution
        depends on its speed.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups
    >>> from viscotack.model.materials.library import published
    >>> passport = published("dragon-skin-30")
    >>> case = Groups(
    ...     tabor=10.0, material=passport.material.reduced(), start=AtDepth(30), rate=1.0
    ... )
    >>> cautions_on(case, passport=passport)[0].split(":")[0]
    "'Dragon Skin 30 (platinum silicone of Smooth-On)' was tested at one rate"
    """
    groups = problem.groups()
    elastic = isinstance(groups.material, Elastic)
    found = []
    if passport is not None and elastic:
        found.append(
            f"{passport.name!r} was tested at one rate: its dependence on speed is unknown. The "
            "force is that of this modulus at every speed; a fast pull of a real rubber holds more."
        )
    if passport is not None and allowed(passport):
        found.append(
            "The interval leaves out the uncertainty of the measured constants of "
            f"{passport.name!r}; for a problem in SI, `viscotack uncertainty` with the passport "
            "includes it."
        )
    in_si = isinstance(problem, Problem)
    measured = None if passport is None else passport.frequencies
    if elastic or not (in_si or measured) or (edge := _edge_of(Question(problem))) is None:
        return tuple(found)
    speed, energy = edge
    if passport is not None and measured is not None:
        zone = REST_ZONE / groups.effective_tabor**2 * max(energy, 1.0)
        frequency = 2 * np.pi * speed / zone / passport.material.time_unit
        low, high, here = (x / (2 * np.pi) for x in (*measured, frequency))
        if not low <= here <= high:
            found.append(
                f"The edge excites the material at about {readable(here, 'Hz', digits=2)}; "
                f"{passport.name!r} was measured from {readable(low, 'Hz', digits=3, to=high)}, so "
                "the force rests on an extrapolation of its model."
            )
    if in_si and (words := beyond_linear(speed * problem.scales().edge_speed)):
        found.append(words)
    return tuple(found)


def beyond_linear(speed: float) -> str:
    """Return the caution for an edge of this speed [m/s], "" if linear theory may hold."""
    if speed <= LINEAR_SPEED:
        return ""
    return (
        f"The edge moves at about {readable(speed, 'm/s', digits=2)}. Above "
        f"{readable(LINEAR_SPEED, 'm/s')}, forces in silicone experiments exceeded every linear "
        "theory: expect a larger force."
    )


def _edge_of(asked: Question) -> tuple[float, float] | None:
    """Return speed [beta/time unit] and energy [work of adhesion] of the edge at pull-off.

    None for contacts of which no theory knows it.
    """
    # only here: predictions by a surrogate need no theory
    from .closed_forms import is_classic, is_plain
    from .theories import crack_of, forms_of

    try:
        if is_classic(asked.groups) and is_plain(asked.groups):
            forms = asked.once(forms_of)
            return None if forms.edge_speed is None else (forms.edge_speed, forms.edge_energy)
        found = crack_of(asked)
    except (InputError, OverflowError):
        return None
    if isinstance(found, InputError) or found.crack_speed_at_pull_off is None:
        return None
    return found.crack_speed_at_pull_off, found.amplification_at_pull_off or 1.0
