"""Forces, works and held loads of one pad by the fast tiers, with their intervals.

**Forces between the pads that theories predicted: radial basis functions of logarithms.** A theory
takes about 0.1 s, too long for every design of a search. The interpolation suggests designs, and
the theory then predicts each of them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from math import hypot, pi
from typing import Any

import numpy as np
from scipy.interpolate import RBFInterpolator

from viscotack.arrays import Array
from viscotack.design.space import OF_PADS
from viscotack.errors import InputError, OutOfRange
from viscotack.identify.computed import Computed
from viscotack.identify.forward import Forward, Interface
from viscotack.model.geometry import Bonded, Frictionless, HalfSpace, Layer, PowerLawProfile, Sphere
from viscotack.model.materials import Material
from viscotack.model.materials.conversion import scaled
from viscotack.model.problem import Problem
from viscotack.model.protocol import AtForce, Retraction
from viscotack.model.traction import LennardJones
from viscotack.prediction.predict import predict
from viscotack.prediction.tiers import AT_ONCE
from viscotack.simulate.crack_contact.by_crack import LEAST_TABOR
from viscotack.theory import SteadyCrack, jkr, lennard_jones

# Relative standard error of the load against simulations.
HELD_ERROR = 0.01
# Loads and radii of the integral; smallest radius, and excess of the least load over the elastic
# pull-off force; part of the largest energy at which the edge is as good as detached.
_LOADS, _RADII, _LAST, _EXCESS, _MOST = 60, 200, 0.02, 1e-4, 0.98


def held_load(problem: Problem, time: float) -> float:
    r"""Return the largest dead load that a relaxed sphere holds for a time.

    Under the tension P an elastic contact of the radius a releases the energy

    .. math:: G(a, P) = \frac{(4 E_0^* a^3/3R + P)^2}{8 \pi E_0^* a^3} ,

    and its edge recedes at the speed of a crack of that energy. The time to detachment is the
    integral of da over the speed from the relaxed radius under the preload. Loads below the elastic
    pull-off force are held for ever, and loads above the instantaneous one not at all. The load is
    multiplied by the elastic pull-off ratio at the effective Tabor number, as in
    :mod:`viscotack.simulate.crack_contact.by_crack`.

    Parameters
    ----------
    problem : Problem
        Sphere on a half-space, relaxed under a force; speed and stiffness do not matter.
    time : float
        Time to detachment [s].

    Returns
    -------
    float
        Tension [N]; the elastic pull-off force for a time that no larger load is held.

    Raises
    ------
    OutOfRange
        If the cohesive zone is as large as the contact.
    ValueError
        For another shape, body, law or start.
    """
    shape: Any = problem.geometry
    body, start = problem.body, problem.protocol.start
    known = isinstance(shape, Sphere) and isinstance(body, HalfSpace)
    if not (known and type(problem.traction) is LennardJones and isinstance(start, AtForce)):
        raise InputError(
            "the load held for a time is known for spheres on a half-space with Lennard-Jones "
            "forces that begin under a preload"
        )
    material, law, R = problem.material, problem.traction, shape.radius
    E, w, h0 = material.contact_modulus, law.work_of_adhesion, law.equilibrium_gap
    mu = (R * w**2 / E**2) ** (1 / 3) / h0
    crack = SteadyCrack(material.reduced(), LennardJones(1.0, 1.0))
    beta = (R**2 * w / E) ** (1 / 3)
    first = float(
        jkr.contact_radius_at_force(
            start.force / (R * w), radius=1.0, contact_modulus=1.0, work_of_adhesion=1.0
        )
    )
    # tensions in R dg, radii in beta; above the strongest radius the edge runs at once
    a = first * np.geomspace(1.0, _LAST, _RADII)
    strongest = np.max(np.sqrt(8 * pi * _MOST * crack.largest * a**3) - 4 / 3 * a**3)
    load = np.geomspace(1.5 * pi * (1 + _EXCESS), strongest, _LOADS)
    energy = (4 / 3 * a**3 + load[:, None]) ** 2 / (8 * pi * a**3)
    least = energy.min(axis=1)
    if not mu * least[0] ** (-1 / 3) >= LEAST_TABOR:
        raise OutOfRange(
            f"the cohesive zone is as large as the contact: effective Tabor number "
            f"{mu * least[0] ** (-1 / 3):.3g}, valid from "
            f"{LEAST_TABOR:g}"
        )
    # beyond the largest energy the edge is at its largest speed
    fast = np.minimum(energy, _MOST * crack.largest)
    speed = np.asarray(crack.speed(np.maximum(fast, 1 + _EXCESS / 10)))
    unit = E * h0**2 / (w * material.time_unit)  # of the speed of an edge [m/s]
    times = beta / unit * -np.trapezoid(1 / speed, a, axis=1)
    tension = load * np.asarray(lennard_jones.pull_off_ratio(mu * least ** (-1 / 3))) * R * w
    order = np.argsort(times)
    if time >= times[order[-1]]:
        return float(tension[order[-1]])
    return float(np.exp(np.interp(np.log(time), np.log(times[order]), np.log(tension[order]))))


# Budgets of a prediction [s]: surrogates alone, and theories.
SURROGATES, THEORIES = AT_ONCE, 0.5
# Relative standard error of the theory on a layer, and normal deviate of an interval of 90 %.
_ON_LAYER, _DEVIATE = 0.03, 1.645


@dataclass(frozen=True)
class Force:
    """A force of one pad with its 90 % interval [N], or a work [J], and the name of its tier.

    Attributes
    ----------
    value, low, high : float
        The number and the ends of its interval.
    method : str
        Name of the tier.
    work : Force or None
        Work to pull-off of the same pull [J]; None where the tier has no interval of it.
    """

    value: float
    low: float
    high: float
    method: str
    work: Force | None = None

    def times(self, factor: float) -> Force:
        """Return the number of several pads."""
        work = None if self.work is None else self.work.times(factor)
        return Force(factor * self.value, factor * self.low, factor * self.high, self.method, work)


@dataclass(frozen=True)
class Pad:
    """One pad and how it is pulled, in SI.

    Attributes
    ----------
    material : str
        Name of the material.
    radius, preload, speed : float
        Radius of the tip [m], force of the relaxed start [N] on this pad, and speed [m/s].
    modulus, thickness, exponent, backing : float or None
        As in :class:`.space.Choice`.
    bonded : bool
        Whether a layer is bonded to its base.
    """

    material: str
    radius: float
    preload: float
    speed: float
    modulus: float | None = None
    thickness: float | None = None
    exponent: float | None = None
    backing: float | None = None
    bonded: bool = False


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
    between : callable, optional
        Interpolates the force of a pad in place of a tier.
    """

    materials: Mapping[str, Material]
    traction: Any
    budget: float
    between: Callable[[Pad], Force | str] | None = None
    known: dict[Pad, Force | str] = field(default_factory=dict, repr=False)
    loads: dict[tuple[Pad, float], Force | str] = field(default_factory=dict, repr=False)
    computed: Computed = field(default_factory=Computed, repr=False)

    def material(self, pad: Pad) -> Any:
        """Return the material of a pad, with its modulus."""
        stated: Any = self.materials[pad.material]
        if pad.modulus is None:
            return stated
        return scaled(stated, modulus=pad.modulus / stated.rubbery_modulus, time=1.0)

    def problem(self, pad: Pad) -> Problem:
        """Return the problem of a pad; InputError if it exceeds small strain."""
        R, q, body = pad.radius, pad.exponent, HalfSpace()
        if pad.thickness is not None:
            nu = self.materials[pad.material].poisson_ratio
            base = Bonded(poisson_ratio=nu) if pad.bonded else Frictionless()
            body = Layer(pad.thickness, base)
        return Problem(
            material=self.material(pad),
            traction=self.traction,
            geometry=Sphere(R) if q is None else PowerLawProfile(1 / (q * R ** (q - 1)), q),
            body=body,
            protocol=Retraction(AtForce(pad.preload), pad.speed, stiffness=pad.backing),
        )

    def force(self, pad: Pad) -> Force | str:
        """Return the force of a pad, or the reason why no tier within the budget predicts it."""
        if self.between is not None:
            return self.between(pad)
        predicted = self._predicted if pad.thickness is None else self._on_layer
        return _once(self.known, pad, lambda: predicted(pad, self.problem(pad)))

    def held(self, pad: Pad, time: float) -> Force | str:
        """Return the dead load that a pad holds for a time [s], or the reason why none is known."""
        pad = replace(pad, speed=1.0, backing=None)  # neither matters under a dead load

        def load() -> Force:
            load, error = held_load(self.problem(pad), time), _DEVIATE * HELD_ERROR
            return Force(load, load * (1 - error), load * (1 + error), "steady crack")

        return _once(self.loads, (pad, time), load)

    def _predicted(self, pad: Pad, problem: Problem) -> Force:
        found = predict(problem, budget=self.budget)
        force = problem.outputs.observables["pull_off_force"].unit
        work = problem.outputs.observables["work_to_pull_off"].unit
        unit, joule = (getattr(problem.scales(), x.scale) for x in (force, work))
        low, high = found.interval
        more = None
        if found.work_to_pull_off is not None and found.work_interval is not None:
            least, most = found.work_interval
            more = Force(found.work_to_pull_off * joule, least * joule, most * joule, found.method)
        return Force(found.pull_off_force * unit, low * unit, high * unit, found.method, more)

    def _on_layer(self, pad: Pad, problem: Problem) -> Force:
        """Return the force by the steady crack at the edge of a sphere on a layer."""
        law, body = self.traction, problem.body
        if type(law) is not LennardJones or pad.exponent is not None or pad.backing is not None:
            raise InputError(
                "on a layer only spheres with Lennard-Jones forces and a rigid backing are known"
            )
        assert isinstance(body, Layer), "of a pad with a thickness"
        known = Forward(problem.material, pad.radius, body=body, computed=self.computed)
        speed, load = np.array([pad.speed]), np.array([pad.preload])
        given = (law.work_of_adhesion, law.equilibrium_gap, speed, load)
        if reason := str(known.changed(Interface(*given[:2]), speed, load).refused[0]):
            raise InputError(reason)
        force = float(known.pulled(*given).force[0])
        error = _DEVIATE * hypot(_ON_LAYER, float(known.layer_error(*given)[0]))
        return Force(force, force * (1 - error), force * (1 + error), "crack contact on a layer")


def _once(known: dict[Any, Force | str], key: Any, compute: Callable[[], Force]) -> Force | str:
    """Return a force that is computed once, or the reason why there is none."""
    if key not in known:
        try:
            known[key] = compute()
        except InputError as reason:
            known[key] = str(reason)
    return known[key]


# Numbers of a pad.
_NUMBERS = 3 + len(OF_PADS)
# Pads more than variables that an interpolation needs.
_MORE = 2


def interpolated(fast: FastTier, material: str) -> FastTier | None:
    """Return a tier that interpolates between the known pads of a material; None for too few."""
    known = {pad: force for pad, force in fast.known.items() if pad.material == material}
    answered = {
        pad: force for pad, force in known.items() if not isinstance(force, str) and force.low > 0
    }
    pads = np.array([_logarithms(pad) for pad in known]).reshape(-1, _NUMBERS)
    spans = np.ptp(pads, axis=0) if len(pads) else np.zeros(_NUMBERS)
    varied = spans > 0
    if len(answered) < np.count_nonzero(varied) + _MORE:
        return None
    spans = np.where(varied, spans, 1.0)
    places = np.array([_logarithms(pad) for pad in answered])
    forces = np.array(
        [[f.value / p.radius, f.low / p.radius, f.high / p.radius] for p, f in answered.items()]
    )
    # cubic functions with linear terms
    fitted = RBFInterpolator((places / spans)[:, varied], np.log(forces), kernel="cubic", degree=1)
    # pads that a theory does not predict refuse those nearest to them
    reasons = [None if pad in answered else str(force) for pad, force in known.items()]
    method = next(iter(answered.values())).method

    def force(pad: Pad) -> Force | str:
        at = _logarithms(pad)
        reason = reasons[int(np.argmin(np.sum(((pads - at) / spans) ** 2, axis=1)))]
        if reason is not None:
            return reason
        logarithms = fitted((at[None] / spans)[:, varied])[0]
        value, low, high = (pad.radius * np.exp(logarithms)).tolist()
        return Force(value, low, high, method)

    # loads that are held come from theories that are fast
    return replace(fast, between=force)


def _logarithms(pad: Pad) -> Array:
    more = [getattr(pad, name) or 1.0 for name in OF_PADS]
    return np.log([pad.radius, pad.preload, pad.speed, *more])
