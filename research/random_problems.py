"""Random problems of every kind, without dimensions: each is made of a seed and its number alone.

Drawn are the law first, with its strength from 0.3 to 1,000 dg/h0, then the Tabor number over the
range of that law, from 0.01 to 30, and a machine whose depths, forces and speeds are large and
small beside what this contact needs.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from viscotack import (
    Apart,
    Approach,
    AtDepth,
    AtForce,
    AtRadius,
    Bonded,
    Cone,
    Disc,
    Dugdale,
    Dwell,
    Elastic,
    Exponential,
    Frictionless,
    Groups,
    LennardJones,
    LoadTo,
    MeasuredProfile,
    MoveTo,
    PowerLawProfile,
    Prony,
    RelaxationPowerLaw,
    RetardationPowerLaw,
    Retract,
    Sphere,
    StandardSolid,
    Tabulated,
    WavySphere,
)
from viscotack.geometry import FlatPunch, Layer
from viscotack.theory.elastic import indenter
from viscotack.traction import effective_range

sys.path.append(str(Path(__file__).parents[1] / "examples" / "own"))
from rounded_cone import RoundedCone  # noqa: E402

STRENGTHS = (0.3, 1000.0)
EFFECTIVE_TABOR = (0.01, 30.0)
# Speeds, in (mu + range of the law) a time unit, and durations in time units.
SPEEDS, DURATIONS = (1e-2, 1e4), (1e-2, 1e2)
# Largest pressure that may be asked of a wall, beside what it bears at no gap at all.
_BORNE = 0.5
_PUNCHES, _WITH_SPRING, _WITH_HISTORY = 0.1, 1 / 3, 1 / 3
# Layers under shapes of revolution: thickness [beta] and base.
THICKNESSES = (0.05, 100.0)
BASES = (Frictionless(), *(Bonded(poisson_ratio=nu) for nu in (0.0, 0.3, 0.45, 0.49, 0.5)))
# Radii [beta] at which random profiles are tabulated.
_RADII = np.linspace(0.0, 6.0, 121)


class Luck:
    """Random draws of the kinds that are needed here."""

    def __init__(self, *seed: int) -> None:
        self._random = np.random.default_rng(seed)

    def decades(self, low: float, high: float) -> float:
        """Return a number whose logarithm is anywhere between two."""
        return float(10 ** self._random.uniform(np.log10(low), np.log10(high)))

    def within(self, low: float, high: float, size: int | None = None) -> Any:
        """Return a number between two, or an array of such numbers."""
        found = self._random.uniform(low, high, size)
        return float(found) if size is None else found

    def count(self, low: int, high: int) -> int:
        """Return a whole number between two, which are among them."""
        return int(self._random.integers(low, high + 1))

    def one(self, weights: dict[Any, float]) -> Any:
        """Return one of some things, each as often as its weight says."""
        share = np.array(list(weights.values()))
        return list(weights)[self._random.choice(len(share), p=share / share.sum())]

    def happens(self, share: float) -> bool:
        """Return whether something happens that does so in this share of cases."""
        return bool(self._random.random() < share)


def problem(seed: int, number: int, *, films: bool = False) -> Groups:
    """Return one problem, with `films` of a shape of revolution on a layer.

    Those of one seed are the same however many are asked for.
    """
    luck = Luck(seed, number)
    material = solid(luck)
    drawn = film if films else punch if luck.happens(_PUNCHES) else tip
    return drawn(luck, material, with_history=luck.happens(_WITH_HISTORY))


def solid(luck: Luck) -> Any:
    """Return a reduced material with a modulus ratio from 1e-3 to 1."""
    kind = luck.one(
        {Elastic: 0.2, StandardSolid: 0.25, RetardationPowerLaw: 0.3, Prony: 0.15}
        | {RelaxationPowerLaw: 0.1}
    )
    if kind is Elastic:
        return Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    glassy = luck.decades(1.0, 1e3)
    if kind is Prony:
        arms = luck.count(2, 6)
        share = luck.within(0.05, 1.0, arms)
        times = 10.0 ** -np.cumsum([0.0, *luck.within(0.3, 1.2, arms - 1)])
        arm = (glassy - 1) * share / share.sum()
        branches = [(float(E), float(t)) for E, t in zip(arm, times, strict=True)]
        return Prony(rubbery_modulus=1.0, branches=branches, poisson_ratio=0.0)
    more = {} if kind is StandardSolid else {"exponent": luck.within(0.2, 1.5)}
    return kind(rubbery_modulus=1.0, glassy_modulus=glassy, tau0=1.0, poisson_ratio=0.0, **more)


def law(luck: Luck) -> Any:
    """Return a reduced law of any kind, strength and shape."""
    match luck.one({"lennard-jones": 0.2, "exponential": 0.35, "dugdale": 0.2, "table": 0.25}):
        case "lennard-jones":
            return LennardJones(1.0, 1.0)
        case "exponential":
            return Exponential(1.0, 1.0, decay=float(np.exp(-1)) / luck.decades(*STRENGTHS))
        case "dugdale":
            return Dugdale(1.0, 1.0, rise=luck.decades(1e-5, 0.1), fall=luck.decades(0.02, 1.0))
        case _:
            return table(luck)


def table(luck: Luck) -> Tabulated:
    """Return a table with a stiff wall, a peak, and a tail that is short, long or has steps."""
    peak = luck.decades(0.01, 0.3)
    u = np.sort(luck.within(peak, 1.0, luck.count(2, 6)))
    height = (1 - u) ** luck.decades(0.3, 5.0)
    if luck.happens(0.3):
        height = height * luck.within(0.5, 1.3, len(u))
    opening = np.array([0.0, peak, *u, 1.0])
    tension = np.array([0.0, 1.0, *np.minimum(height, 1.0), 0.0])
    # the work is 1, so that the length of the table is what makes it strong or weak
    length = 1 / (np.trapezoid(tension, opening) * luck.decades(*STRENGTHS))
    wall = min(peak * length, 0.5) * np.array([-1.0, -0.5, -0.2])
    return Tabulated.of_points(
        np.array([*(1 + wall), *(1 + length * opening)]), np.array([-1e3, -10.0, -1.0, *tension])
    ).reduced()


@dataclass(frozen=True)
class Scene:
    """What a machine needs to know of a contact: its lengths [h0], loads, and how to press."""

    travel: float
    apart: float
    load: float
    press: Callable[[], Any]

    def speed(self, luck: Luck, stiffness: float | None) -> float:
        """Return a speed of the drive: more of it where a soft spring takes most of the way."""
        lost = 0.0 if stiffness is None else self.load / (stiffness * self.travel)
        return self.travel * (1 + lost) * luck.decades(*SPEEDS)


def tip(luck: Luck, material: Any, *, with_history: bool) -> Groups:
    """Return an indenter of revolution, mostly a sphere, on a half-space."""
    shape = luck.one({"sphere": 0.78, "cone": 0.06, "power": 0.1, "own": 0.06})
    # a cone's tip presses harder than a sphere, and a solid that is pressed fast is glassy
    firmness = (1.0 if shape == "sphere" else 0.1) * (material.modulus_ratio if with_history else 1)
    traction, tabor, widest = bearing(luck, firmness)
    reach = effective_range(traction)
    travel = tabor + reach

    def press() -> Any:
        match luck.one({"depth": 0.5, "force": 0.3, "pulled": 0.08, "radius": 0.12}):
            case "depth":
                return AtDepth(min(travel * luck.decades(0.03, 30), tabor * widest**2))
            case "force":
                return AtForce(min(luck.decades(0.01, 100), widest**3 / 3.5))
            case "pulled":
                return AtForce(luck.within(-0.9, 0.0))
            case _:
                return AtRadius(min(luck.within(1.3, 6.0), widest / np.pi ** (1 / 3)))

    end = traction.points[-1][0] if isinstance(traction, Tabulated) else 1 + 3 * reach
    scene = Scene(travel, end + 6 * travel, 1.0, press)
    stiffness, machine = driven(luck, material, scene, with_history)
    return Groups(
        tabor=tabor,
        material=material,
        traction=traction,
        geometry=geometry(luck, shape),
        stiffness=stiffness,
        **machine,
    )


def bearing(luck: Luck, firmness: float) -> tuple[Any, float, float]:
    """Return a law, a Tabor number, and the widest contact [beta] whose pressure the law bears.

    A law whose wall ends at gap 0 has no answer where a stiff solid is pressed through it: such
    pairs are not drawn.
    """
    while True:
        traction = law(luck)
        tabor = luck.decades(*EFFECTIVE_TABOR) * effective_range(traction)
        wall = _BORNE * firmness * borne(traction)
        # Hertz: (2/pi) a/mu in dg/h0, for a contact radius in beta
        widest = np.pi / 2 * tabor * wall
        if widest > 4:
            return traction, tabor, widest


def borne(traction: Any) -> float:
    """Return the repulsion [dg/h0] of a law next to gap 0; of a steep one before it overflows."""
    return -float(traction.traction(max(0.01, 1 - 20 * effective_range(traction))))


def geometry(luck: Luck, shape: str) -> Any:
    """Return a reduced shape, of slope 1 at distance 1."""
    if shape == "sphere":
        return Sphere(1.0)
    if shape == "cone":
        return Cone(1.0)
    if shape == "power":
        q = luck.within(1.2, 6.0)
        return PowerLawProfile(1 / q, q)
    rounding = luck.decades(0.1, 10)
    return RoundedCone(float(np.hypot(1, rounding)), rounding)


def punch(luck: Luck, material: Any, *, with_history: bool) -> Groups:
    """Return a flat punch on a layer, free to slide or bonded."""
    while True:
        traction = law(luck)
        firmness = material.modulus_ratio if with_history else 1.0
        if borne(traction) * firmness > 100 * traction.strength:
            break
    size, thickness = luck.decades(3, 100), luck.decades(1, 30)
    # by its own length a punch of unit stress is pushed in so far
    pushed = thickness / (0.64 * traction.strength)
    travel = pushed + effective_range(traction)

    def press() -> Any:
        if luck.happens(0.5):
            return AtDepth(pushed * luck.decades(0.03, 3))
        return AtForce(luck.decades(0.01, 3))

    scene = Scene(travel, 10 * effective_range(traction) + pushed, 0.1, press)
    stiffness, machine = driven(luck, material, scene, with_history)
    return Groups(
        tabor=None,
        cohesion=luck.decades(0.01, 0.1),
        geometry=FlatPunch(size),
        body=Layer(
            thickness,
            Bonded(poisson_ratio=luck.within(0.3, 0.49)) if luck.happens(0.3) else Frictionless(),
        ),
        material=material,
        traction=traction,
        stiffness=stiffness,
        **machine,
    )


def film(luck: Luck, material: Any, *, with_history: bool) -> Groups:
    """Return a shape of revolution, of six kinds, on a layer."""
    kind = luck.one(dict.fromkeys(("sphere", "cone", "power", "disc", "measured", "wavy"), 1.0))
    body = Layer(luck.decades(*THICKNESSES), luck.one(dict.fromkeys(BASES, 1.0)))
    drawn = indenter.drawn(
        1.0, shape=Sphere(1.0), body=body, contact_modulus=1.0, work_of_adhesion=1.0
    )
    # of a half-space; a thin layer presses harder and lengthens less
    share = min(1.0, float(drawn) / np.sqrt(2 * np.pi))
    firmness = (1.0 if kind == "sphere" else 0.1) * (material.modulus_ratio if with_history else 1)
    traction, tabor, widest = bearing(luck, firmness * share)
    travel = tabor * share + effective_range(traction)
    end = traction.points[-1][0] if isinstance(traction, Tabulated) else 1.0

    def press() -> Any:
        match luck.one({"depth": 0.5, "force": 0.4, "radius": 0.0 if kind == "disc" else 0.1}):
            case "depth":
                return AtDepth(travel * luck.decades(0.03, 10))
            case "force":
                return AtForce(luck.decades(0.01, 10))
            case _:
                return AtRadius(min(luck.within(1.3, 3.0), widest / np.pi ** (1 / 3)))

    scene = Scene(travel, end + 3 * effective_range(traction) + 6 * travel, 1.0, press)
    stiffness, machine = driven(luck, material, scene, with_history)
    return Groups(
        tabor=tabor,
        material=material,
        traction=traction,
        geometry=detailed(luck, kind) or geometry(luck, kind),
        body=body,
        stiffness=stiffness,
        **machine,
    )


def detailed(luck: Luck, kind: str) -> Any:
    """Return a reduced disc, tip of measured heights or wavy sphere; None of another kind."""
    if kind == "wavy":
        return WavySphere(1.0, luck.decades(0.01, 0.5), luck.within(0.3, 1.2))
    if kind == "disc":
        width = luck.within(0.05, 0.3)
        return Disc(1.0, width, width * luck.within(0.2, 1.0)) if luck.happens(0.5) else Disc(1.0)
    if kind != "measured":
        return None
    at, wide, high = luck.within(0.3, 1.2), luck.within(0.1, 0.4), luck.decades(0.03, 1.0)
    height = luck.one(
        {
            (lambda r: max(r * r - at * at, 0.0) / 2): 1,  # worn flat
            (lambda r: r * r / 2 + high * np.exp(-((r / at) ** 2))): 1,  # a hollow tip
            (lambda r: r * r / 2 + high * np.exp(-(((r - at) / wide) ** 2))): 1,  # a ring
        }
    )
    profile = MeasuredProfile.sampled(height, _RADII)
    return profile.reduced(1.0, 1 / profile.equivalent_radius(1.0))


def driven(
    luck: Luck, material: Any, scene: Scene, with_history: bool
) -> tuple[float | None, dict[str, Any]]:
    """Return the spring of a machine, and what the machine does."""
    stiffness = luck.decades(1e-6, 1e6) if luck.happens(_WITH_SPRING) else None
    if with_history:
        return stiffness, history(luck, material, scene, stiffness)
    return stiffness, {"start": scene.press(), "rate": scene.speed(luck, stiffness)}


def history(luck: Luck, material: Any, scene: Scene, stiffness: float | None) -> dict[str, Any]:
    """Return a start and what comes after it, of one of five kinds."""

    def speed() -> float:
        return scene.speed(luck, stiffness)

    def wait() -> Dwell:
        return Dwell(luck.decades(*DURATIONS), luck.one({"drive": 1, "depth": 1, "force": 1}))

    kinds = {"touch": 0.25, "press on": 0.2, "hang": 0.2, "cycles": 0.2}
    # a drive that moves by the clock says nothing of the contact behind a soft spring
    kinds |= {} if stiffness is not None else {"wander": 0.15}
    match luck.one(kinds):
        case "touch":
            moves = (Approach(speed(), deeper(scene)), *(wait(),) * luck.count(0, 1))
            return {"start": Apart(scene.apart), "moves": moves, "rate": speed()}
        case "press on":
            moves = (wait(), Approach(speed(), deeper(scene)), wait())
            return {"start": AtForce(0.0), "moves": moves, "rate": speed()}
        case "hang":
            load = -scene.load * luck.decades(0.3, 1.2 / material.modulus_ratio)
            hang = (LoadTo(load, luck.decades(1e-3, 1)), Dwell(luck.decades(1, 1e4), "force"))
            return {"start": AtForce(0.0), "moves": hang, "rate": None}
        case "cycles":
            back = AtDepth(1 - scene.apart)
            moves = (Approach(speed(), deeper(scene)), Retract(speed(), back)) * luck.count(1, 2)
            return {"start": Apart(scene.apart), "moves": moves, "rate": speed()}
        case _:
            moves = tuple(
                MoveTo(scene.travel * luck.within(-1, 4), luck.decades(*DURATIONS))
                for _ in range(luck.count(2, 5))
            )
            return {"start": scene.press(), "moves": moves, "rate": speed()}


def deeper(scene: Scene) -> Any:
    """Return a state that an approach can end in: one that pulls it has at its beginning."""
    while True:
        state = scene.press()
        if not isinstance(state, AtForce) or state.force > 0:
            return state


def words(groups: Groups) -> str:
    """Return a problem in a few words."""
    material: Any = groups.material
    traction: Any = groups.traction
    if groups.in_plane_strain:
        what = (
            f"punch {groups.geometry.half_width:.3g} on {groups.body.thickness:.3g} "
            f"{type(groups.body.base).__name__.lower()}, cohesion {groups.cohesion:.2g}"
        )
    else:
        shape: Any = groups.geometry
        what = f"{shape.word}, mu {groups.tabor:.3g} (effective {groups.effective_tabor:.3g})"
        if isinstance(groups.body, Layer):
            what += f" on {groups.body.thickness:.3g} {groups.body.base}"
    numbers = {n: getattr(traction, n) for n in ("decay", "rise", "fall") if hasattr(traction, n)}
    of_law = "".join(f" {name} {value:.2g}" for name, value in numbers.items())
    machine = [_brief(groups.start), *map(_brief, groups.moves)]
    machine += [] if groups.rate is None else [f"pull {groups.rate:.3g}"]
    machine += [] if groups.stiffness is None else [f"spring {groups.stiffness:.2g}"]
    return (
        f"{what}; {traction.word}{of_law} strength {traction.strength:.3g}; "
        f"{material.word} k {material.modulus_ratio:.3g}; {', '.join(machine)}"
    )


def _brief(noun: Any) -> str:
    """Return a start or a move as its name and its numbers."""
    values = [_brief(v) if hasattr(v, "__dict__") else v for v in vars(noun).values()]
    said = " ".join(v if isinstance(v, str) else f"{v:.3g}" for v in values)
    return f"{type(noun).__name__} {said}"
