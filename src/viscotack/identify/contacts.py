r"""Elastic contact curves for fits: contact radius, depth and force of each model.

JKR, DMT and Maugis-Dugdale give all three; Carpick's equation, a one-parameter interpolation
between DMT and JKR, gives force and radius. Curves extend from the largest contact to the
instability of a rigid drive.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from viscotack.arrays import Array
from viscotack.theory import dmt, jkr, maugis, transition

from .likelihood import Parameter

Values = Mapping[str, float]

_POINTS = 1200


@dataclass(frozen=True)
class ElasticModel:
    """An elastic contact model for a slow test.

    Parameters
    ----------
    name : str
        "jkr", "dmt", "maugis" or "carpick".
    range_parameter : str or None
        Name of the third unknown: "maugis_parameter" [-] or "transition" [-].
    by_radius : callable
        (contact radii, values, sphere's radius) -> forces.
    by_depth : callable or None
        (depths, values, sphere's radius) -> forces; None for a model without depth.
    """

    name: str
    range_parameter: str | None
    by_radius: Callable[[Array, Values, float], Array]
    by_depth: Callable[[Array, Values, float], Array] | None


def _two(values: Values, radius: float) -> dict[str, float]:
    return {
        "radius": radius,
        "contact_modulus": values["contact_modulus"],
        "work_of_adhesion": values["work_of_adhesion"],
    }


def _jkr_by_radius(a: Array, values: Values, radius: float) -> Array:
    return np.asarray(jkr.force(a, **_two(values, radius)))


def _dmt_by_radius(a: Array, values: Values, radius: float) -> Array:
    return np.asarray(dmt.force(a, **_two(values, radius)))


def _with_strength(values: Values, radius: float) -> dict[str, float]:
    """Return the Maugis sphere with the cohesive strength of the given Maugis parameter."""
    case = _two(values, radius)
    per_strength = float(maugis.maugis_parameter(strength=1.0, **case))
    return case | {"strength": values["maugis_parameter"] / per_strength}


def _maugis_curve(case: Mapping[str, float], excess: Array) -> tuple[Array, Array, Array]:
    """Return contact radius, depth and force where the cohesive radius exceeds it by `excess`."""
    state = maugis.curve(1 + excess, **case)
    a, d, P = (np.asarray(x) for x in (state.contact_radius, state.depth, state.force))
    return a, d, P


def _maugis_by_radius(a: Array, values: Values, radius: float) -> Array:
    case = _with_strength(values, radius)
    excess = np.geomspace(1e-9, 1e6, 150)
    coarse, _, _ = _maugis_curve(case, excess)
    # refine near the requested radii: a smaller contact has a relatively larger zone
    first = max(int(np.sum(coarse > a.max())) - 1, 0)
    last = min(int(np.sum(coarse >= a.min())), excess.size - 1)
    radii, _, force = _maugis_curve(case, np.geomspace(excess[first], excess[last], 200))
    curve = CubicSpline(radii[::-1], force[::-1])
    return np.asarray(curve(np.clip(a, radii[-1], radii[0])))


def _carpick_by_radius(a: Array, values: Values, radius: float) -> Array:
    r"""Compute the force at a contact radius from Carpick's equation.

    .. math:: P = P_{po} \left[ \left( (1 + \alpha) (a/a_0)^{3/2} - \alpha \right)^2 - 1 \right]
    """
    alpha = values["transition"]
    lam = transition.maugis_parameter(alpha)
    case = _two(values, radius)
    force = transition.pull_off_force(lam, radius=radius, work_of_adhesion=case["work_of_adhesion"])
    a0 = transition.contact_radius_without_load(lam, **case)
    root = (1 + alpha) * (a / a0) ** 1.5 - alpha
    return np.asarray(force * (root**2 - 1))


def _jkr_by_depth(depth: Array, values: Values, radius: float) -> Array:
    case = _two(values, radius)
    # below the instability of a rigid drive the force is that at it
    stable = np.maximum(depth, jkr.instability(**case).depth)
    return np.asarray(jkr.force(jkr.contact_radius_at_depth(stable, **case), **case))


def _dmt_by_depth(depth: Array, values: Values, radius: float) -> Array:
    a = np.sqrt(radius * np.maximum(depth, 0.0))
    return np.asarray(dmt.force(a, **_two(values, radius)))


def _maugis_by_depth(depth: Array, values: Values, radius: float) -> Array:
    case = _with_strength(values, radius)
    excess = np.geomspace(1e-9, 1e6, 150)
    _, coarse, _ = _maugis_curve(case, excess)
    first = max(int(np.argmax(coarse <= depth.max())) - 1, 0)
    # with a rigid drive the contact is stable while the depth decreases
    turned = np.flatnonzero(np.diff(coarse) >= 0)
    last = min(int(turned[0]) + 1, excess.size - 1) if turned.size else excess.size - 1
    _, d, P = _maugis_curve(case, np.geomspace(excess[first], excess[last], _POINTS))
    if not turned.size:
        touching = float(maugis.touching_radius(**case))
        free = maugis.curve_without_contact(np.linspace(touching, 1e-3 * touching, 200), **case)
        d, P = np.append(d, np.asarray(free.depth)), np.append(P, np.asarray(free.force))
    turned = np.flatnonzero(np.diff(d) >= 0)
    stop = int(turned[0]) + 1 if turned.size else d.size
    # beyond the end of the curve the force at the end
    return np.interp(depth, d[:stop][::-1], P[:stop][::-1])


MODELS: dict[str, ElasticModel] = {
    "jkr": ElasticModel("jkr", None, _jkr_by_radius, _jkr_by_depth),
    "dmt": ElasticModel("dmt", None, _dmt_by_radius, _dmt_by_depth),
    "maugis": ElasticModel("maugis", "maugis_parameter", _maugis_by_radius, _maugis_by_depth),
    "carpick": ElasticModel("carpick", "transition", _carpick_by_radius, None),
}

# Unknowns of the range of attraction, with the values searched.
RANGES = {
    "maugis_parameter": Parameter("maugis_parameter", 0.02, 60.0, 1.0),
    "transition": Parameter("transition", 1e-3, 0.979, 0.6, logarithmic=False),
}
