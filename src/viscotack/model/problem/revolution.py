r"""An indenter of revolution: scales, Tabor number, limits and outputs.

The relaxed solid and the profile f define a length along the surface, and an equivalent radius,

.. math:: \beta f'(\beta)^2 = \frac{\Delta\gamma_0}{E_0^*}, \quad R = \frac{\beta}{f'(\beta)}, \quad
          \mu = \left(\frac{R \Delta\gamma_0^2}{E_0^{*2} h_0^3}\right)^{1/3}
              = \frac{\beta^2}{R h_0},

For a sphere R is its radius, and all scales have the form of those of the sphere: forces in
:math:`1.5 \pi R \Delta\gamma_0`, contact radii in :math:`(\pi R^2 \Delta\gamma_0/E_0^*)^{1/3}`. For
another shape R depends on the modulus and the work of adhesion, like the elastic pull-off force,
but not on the range h_0. For a power law :math:`z = A r^q`,
:math:`\beta = (\Delta\gamma_0/(E_0^* (q A)^2))^{1/(2 q - 1)}`.

Source for the sphere: Maghami, PhD thesis (2025), Eq. 4.19, 4.24 and 31, the Tabor number as
corrected in Eq. 31.
"""

from dataclasses import dataclass
from math import exp, log
from typing import Any

import numpy as np
import scipy

from viscotack.errors import InputError
from viscotack.model.geometry import Disc, Layer, detail, end, equivalent_radius
from viscotack.model.problem.outputs import DETAILED, REVOLUTION, InSI, Kind, time_unit
from viscotack.model.protocol import AtDepth, AtForce, AtRadius, Units, states
from viscotack.model.protocol_words import SPHERE_UNITS
from viscotack.units import positive

# Largest contact radius over sphere radius. At 0.5 the paraboloid's gap differs by 7 % from the
# sphere's and strains are of order a/R: the limit of linear elasticity of the half-space. For
# another shape it is the steepest flank at the edge of a contact.
LARGEST_CONTACT = STEEPEST_FLANK = 0.5
# Largest depth of a contact over the thickness of a layer.
DEEPEST_LAYER = 0.5
# Tabor numbers that the mesh of a simulation resolves; tested from 0.01 to 10.
SIMULATED_TABOR = (1e-6, 200.0)
# The largest one for an elastic solid, whose edge is resolved at rest.
ELASTIC_TABOR = 30.0
# Upper limit of the search for a radius: 10^15 m.
_FAR = log(1e15)
# Radii per detail of a shape at which its slope is looked at, and the most of them.
_LOOKS, _MOST_LOOKS = 16, 100_000
# Radii at which the depth of a shape with details on a layer is sampled.
_SAMPLES = 200
# Units of a protocol, in SI and dimensionless.
SI = SPHERE_UNITS | {"stiffness": "N/m"}
GROUPS = {
    "depth": "h0",
    "force": "1.5 pi R dg0",
    "radius": "(pi R^2 dg0/E0*)^(1/3)",
    "speed": "h0/tau0",
    "time": "tau0",
    "stiffness": "1.5 pi R dg0/h0",
}


@dataclass(frozen=True)
class Scales:
    """SI values of the units of the outputs, from :meth:`viscotack.Problem.scales`.

    Attributes
    ----------
    force : float
        1.5 pi R Delta-gamma_0 [N], the JKR pull-off force.
    length : float
        h_0 [m], for depths and gaps.
    radius : float
        (pi R^2 Delta-gamma_0/E_0*)^(1/3) [m], for contact radii.
    work : float
        1.5 pi R Delta-gamma_0 h_0 [J].
    time : float
        The material's time unit [s].
    edge_speed : float
        (R^2 Delta-gamma_0/E_0*)^(1/3) over the time unit [m/s]; no pi.
    stress : float
        Delta-gamma_0/h_0 [Pa], for pressures and tractions.
    """

    force: float
    length: float
    radius: float
    work: float
    time: float
    edge_speed: float
    stress: float


def outputs(shape: Any) -> Kind:
    """Return the kind of a problem; a shape with details has the outputs of rings."""
    return REVOLUTION if np.isinf(detail(shape)) else DETAILED


def radius_of(problem: Any) -> float:
    """Return the radius R [m] of the sphere with the same Tabor number and scales."""
    adhesion = problem.traction.work_of_adhesion / problem.material.contact_modulus
    return equivalent_radius(problem.geometry, adhesion)


def tabor_number(problem: Any) -> float:
    """Return the Tabor number of a problem."""
    w, h0 = problem.traction.work_of_adhesion, problem.traction.equilibrium_gap
    return (problem.radius * w**2 / (problem.material.contact_modulus**2 * h0**3)) ** (1 / 3)


def lengths(problem: Any) -> tuple[float, float]:
    """Return the units of distances along the surface, beta, and of heights, beta^2/R [m]."""
    R = problem.radius
    along = (R**2 * problem.traction.work_of_adhesion / problem.material.contact_modulus) ** (1 / 3)
    return along, along**2 / R


def check_groups(groups: Any) -> None:
    """Raise an error for groups with a shape that is not reduced."""
    shape = groups.geometry
    if np.isfinite(detail(shape)):
        radius = equivalent_radius(shape, 1.0)
        if abs(radius - 1) > 1e-6:
            raise InputError(
                f"the {shape.word} of dimensionless groups must be reduced, of equivalent radius "
                f"1, got {radius:g}; problem.groups().geometry is so"
            )
        return
    slope = float(shape.flank(1.0))
    if abs(slope - 1) > 1e-6:
        raise InputError(
            "the geometry of dimensionless groups must be reduced (slope 1 at distance 1), "
            f"got {shape!r} of slope {slope:g}; use problem.groups().geometry"
        )


def si_units(
    groups: Any,
    contact_modulus: float,
    radius: float | None,
    *,
    equilibrium_gap: float = 0.0,
    work_of_adhesion: float = 0.0,
) -> InSI:
    """Return the SI units of dimensionless groups, given either gap or work of adhesion."""
    if radius is None:
        raise InputError(
            "give the radius R [m], for a shape other than a sphere the equivalent radius"
        )
    R, E = positive("radius", radius, "m"), contact_modulus
    w = work_of_adhesion or float(np.sqrt(groups.tabor**3 * E**2 * equilibrium_gap**3 / R))
    h0 = equilibrium_gap or (R * w**2 / (E**2 * groups.tabor**3)) ** (1 / 3)
    along = (R**2 * w / E) ** (1 / 3)
    return InSI(
        h0,
        w,
        1.5 * np.pi * R * w,
        contact_radius=(np.pi * R**2 * w / E) ** (1 / 3),
        along=along,
        height=along**2 / R,
    )


def scales_of(problem: Any) -> Scales:
    """Return the SI values of the units of the dimensionless outputs."""
    w, h0 = problem.traction.work_of_adhesion, problem.traction.equilibrium_gap
    beta, _ = lengths(problem)
    force, time = 1.5 * np.pi * problem.radius * w, time_unit(problem.material, problem.traction)
    return Scales(
        force=force,
        length=h0,
        radius=np.pi ** (1 / 3) * beta,
        work=force * h0,
        time=time,
        edge_speed=beta / time,
        stress=w / h0,
    )


def to_groups(scales: Scales) -> Units:
    """Return the factors that convert a protocol from SI to groups."""
    return Units(1 / scales.length, 1 / scales.force, 1 / scales.radius, 1 / scales.time)


def check(problem: Any) -> None:
    """Raise an error for a problem in SI beyond small strain.

    Raises
    ------
    ValueError
        If the flank would be steeper than 0.5 at the JKR contact edge, for a sphere a contact
        larger than half its radius; if the same holds at the radius where the undeformed gap is
        h_0; or if a layer would be pressed to less than half its thickness.
    """
    if isinstance(problem.geometry, Disc):
        _check_disc(problem)
    else:
        _check_flank(problem)


def _check_disc(problem: Any) -> None:
    disc, most = problem.geometry, LARGEST_CONTACT * problem.geometry.radius
    rim = float(disc.flank(disc.radius))
    if rim > 2 * STEEPEST_FLANK:
        raise InputError(
            f"the rounded edge is too steep: its slope is {rim:.3g} at the rim, and it may be up "
            f"to {2 * STEEPEST_FLANK:g}, that of a quarter of a circle; make it wider"
        )
    stiffness, limit = 2 * disc.radius, "half its radius"
    if isinstance(body := problem.body, Layer):
        from viscotack.theory.elastic import on_layer

        on_layer.check_disc(disc.radius, body)
        stiffness = float(on_layer.stiffness(np.array(disc.radius), body))
        if DEEPEST_LAYER * body.thickness < most:
            most, limit = DEEPEST_LAYER * body.thickness, "half the thickness of the layer"
    stiffness *= problem.material.contact_modulus
    for state in states(problem.protocol):
        if isinstance(state, AtRadius):
            continue
        is_depth = isinstance(state, AtDepth)
        depth = state.depth if is_depth else state.force / stiffness
        if depth > most:
            raise InputError(
                f"{state} exceeds small strain: it presses the disc deeper than {limit}, "
                f"{most:.3g} m"
            )


def _check_flank(problem: Any) -> None:
    shape, h0 = problem.geometry, problem.traction.equilibrium_gap
    if np.isinf(detail(shape)):
        rim = _where(lambda r: float(shape.gap(r)), h0)
        # the largest allowed contact
        a = _where(lambda r: float(shape.flank(r)), STEEPEST_FLANK)
    else:
        # where it is steepest up to this gap, and to where it is not too steep and known
        r = _radii(shape)
        near = r[np.asarray(shape.gap(r)) <= h0]
        rim = float(near[np.argmax(np.abs(shape.flank(near)))])
        steep = np.flatnonzero(np.abs(shape.flank(r)) > STEEPEST_FLANK)
        a = float(r[steep[0]]) if steep.size else float(r[-1])
    flank = float(shape.flank(rim))
    if flank > STEEPEST_FLANK:
        raise InputError(
            f"the flank of {shape} is too steep: its slope is {flank:.3g} where the gap "
            f"is equilibrium_gap = {h0:.3g} m, valid up to {STEEPEST_FLANK}"
        )
    limit = f"the slope of the flank at the edge of its contact would be over {STEEPEST_FLANK}"
    pressed = _pressed_through(problem)
    if pressed < a:
        a, limit = pressed, f"its depth would be over {DEEPEST_LAYER} thicknesses of the layer"
    if a >= exp(_FAR):
        return  # the flank is nowhere as steep
    from viscotack.theory.elastic import indenter

    solid: Any = {
        "shape": shape,
        "body": problem.body,
        "contact_modulus": problem.material.contact_modulus,
        "work_of_adhesion": problem.traction.work_of_adhesion,
    }
    for state in states(problem.protocol):
        if isinstance(state, AtDepth):
            given, most, unit = state.depth, indenter.depth(a, **solid), "m"
        elif isinstance(state, AtForce):
            given, most, unit = state.force, indenter.force(a, **solid), "N"
        else:
            given, most, unit = state.contact_radius, a, "m"
        if given > most:
            raise InputError(
                f"{state} exceeds small strain: {limit}; it may be up to {most:.3g} {unit}, or "
                "more with a larger indenter"
            )


def _pressed_through(problem: Any) -> float:
    """Return the radius [m] of the deepest contact allowed on a layer, inf if none."""
    shape, body = problem.geometry, problem.body
    if not isinstance(body, Layer):
        return np.inf

    from viscotack.theory.elastic import indenter, on_layer

    def excess(radius: Any) -> Any:
        depth = indenter.bare_depth(radius, shape=shape, body=body)
        return np.asarray(depth) / (DEEPEST_LAYER * body.thickness) - 1

    if np.isfinite(detail(shape)):
        far = min(float(_radii(shape)[-1]), on_layer.LARGEST * body.thickness)
        radii = np.linspace(0.0, far, _SAMPLES + 1)[1:]
        deep = np.flatnonzero(excess(radii) > 0)
        return float(radii[deep[0]]) if deep.size else np.inf
    least, most = 1e-3 * body.thickness, 1e3 * body.thickness
    if excess(most) < 0:
        return np.inf
    if excess(least) >= 0:
        return least
    return float(scipy.optimize.brentq(excess, least, most))  # type: ignore[arg-type]


def _radii(shape: Any) -> Any:
    """Return radii [m] at which a shape with details is sampled."""
    far = min(end(shape), equivalent_radius(shape, 1.0))
    many = int(min(_LOOKS * far / detail(shape), _MOST_LOOKS))
    return np.linspace(0.0, far, max(many, _LOOKS) + 1)


def _where(function: Any, value: float) -> float:
    """Return the radius [m] at which a rising function has this value, 1e15 if none."""
    if function(exp(_FAR)) <= value:
        return exp(_FAR)
    if function(exp(-_FAR)) >= value:
        return exp(-_FAR)
    found = scipy.optimize.brentq(lambda x: log(max(function(exp(x)), 1e-300) / value), -_FAR, _FAR)
    return exp(float(found))  # type: ignore[arg-type]
