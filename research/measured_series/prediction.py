"""Predict the approach and the pull-off at other speeds from single tests at 20 nm/s."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

import viscotack as vt
from viscotack.arrays import Array
from viscotack.theory import film, jkr

from .curves import RADIUS, STIFFNESS, curves, jkr_fit

# The only files that are opened for a prediction: single tests, by speeds of 19.3 to 19.8 nm/s.
SINGLE = {
    "PDMS": (
        "PDMS/09.09/EM-PDMS-110-10-110, 20nms,2,2um",
        "PDMS/12.09/EM-PDMS-110-10-110, 20nms,2,2um-2",
        "PDMS/12.09/EM-PDMS-125-10-125, 20nms,2,5um-3",
        "PDMS/12.09/EM-PDMS-150-10-150, 20nms,3um-4",
        "PDMS/13.09/EM-PDMS-150-10-150-20nms-3um-5",
    ),
    "10:1": ("PDMS_10-1/test-4", "PDMS_10-1/test-5", "PDMS_10-1/test-6"),
}
SPEEDS = (6.6e-9, 19.7e-9, 38.8e-9)  # m/s
BASE = 1  # index of the speed of the single tests
PRELOAD = 1e-6  # N; compressions of 0.96 to 3.2 uN change the measured pull-off by less than 1 %
POISSON = 0.5
# Published spectrum of Sylgard 184, 10:1 (Maghami, PhD thesis (2025), Eq. 4.27).
MODULUS_RATIO, EXPONENT, TIME = 1.458 / 3089, 0.2207, 18.76e-3
Solid = vt.RetardationPowerLaw | vt.FractionalZener
SHORT = 0.2e-9  # m, range at which the matched spectra are computed
_FAR = 5.0  # ranges of attraction between the surfaces at the start, beside the reach of LARGE
_START = 3e-9  # m


@dataclass(frozen=True)
class Measured:
    """Mean of the single tests of a silicone at the base speed; SI units."""

    contact_modulus: float
    work_of_adhesion: float
    jump_in_force: float
    pull_off_force: float


@dataclass(frozen=True)
class Row:
    """One prediction in the units of the table."""

    solid: str
    spectrum: str
    range_nm: float
    work_mJ_per_m2: float
    time_constant_s: float
    speed_nm_per_s: float
    jump_in_nN: float
    pull_off_nN: float
    snap_off_nm: float
    force_over_that_at_base: float
    slope: float
    band: float


def measured(repository: Path, solid: str) -> Measured:
    every = [curve for name in SINGLE[solid] for curve in curves(repository, name)]
    for curve in every:
        if not 19e-9 < curve.speed < 20.5e-9:
            raise ValueError(f"a test at {curve.speed * 1e9:.1f} nm/s is not a slow single test")
    modulus, work = np.mean([jkr_fit(curve) for curve in every], axis=0)
    return Measured(
        float(modulus),
        float(work),
        # the median, for a curve whose approach has a step before the contact
        float(np.median([curve.jump_in_force for curve in every])),
        float(np.mean([-curve.force.min() for curve in every])),
    )


def published(contact_modulus: float, time: float = TIME) -> vt.RetardationPowerLaw:
    """Scale the published spectrum to a modulus, and shift it in time."""
    rubbery = contact_modulus * (1 - POISSON**2)
    return vt.RetardationPowerLaw(
        rubbery_modulus=rubbery,
        glassy_modulus=rubbery / MODULUS_RATIO,
        exponent=EXPONENT,
        tau0=time,
        poisson_ratio=POISSON,
    )


def rouse(contact_modulus: float, time: float) -> vt.FractionalZener:
    """Return a network of free chains, whose modulus rises with the root of the frequency."""
    rubbery = contact_modulus * (1 - POISSON**2)
    return vt.FractionalZener(
        rubbery_modulus=rubbery,
        glassy_modulus=rubbery / MODULUS_RATIO,
        order=0.5,
        tau0=time,
        poisson_ratio=POISSON,
    )


@dataclass(frozen=True)
class Pull:
    """Simulated test in SI units."""

    jump_in_force: float
    pull_off_force: float
    travel_to_snap_off: float
    band: float


def pull(solid: Solid, work: float, gap: float, speed: float) -> Pull:
    """Simulate approach, 10 s of rest and retraction behind the spring."""
    moves = (vt.Approach(speed=speed, to=vt.AtForce(PRELOAD)), vt.Dwell(duration=10.0))
    problem = vt.Problem(
        material=solid,
        traction=vt.LennardJones(work_of_adhesion=work, equilibrium_gap=gap),
        geometry=vt.Sphere(radius=RADIUS),
        protocol=vt.Retraction(
            start=vt.Apart(gap=_START + _FAR * gap), moves=moves, speed=speed, stiffness=STIFFNESS
        ),
    )
    found, scales = vt.crack_contact(problem), problem.scales()
    if found.pull_off_force is None:
        raise ValueError(f"no pull-off: {found.why}")
    loading = found.force[: int(found.force.argmax())]
    after = found.time[-1] - found.time[int(found.force.argmin())]
    return Pull(
        -float(loading.min()) * scales.force,
        found.pull_off_force * scales.force,
        float(after) * scales.time * speed,
        float(found.band),
    )


def matched(
    test: Measured, law: Callable[[float, float], Solid], gap: float
) -> tuple[float, float]:
    """Find work [J/m2] and time [s] that give the jump-in and the pull-off at the base speed."""

    def misfit(unknown: Array) -> Array:
        work, time = np.exp(unknown)
        found = pull(law(test.contact_modulus, time), work, gap, SPEEDS[BASE])
        return np.log(
            [found.jump_in_force / test.jump_in_force, found.pull_off_force / test.pull_off_force]
        )

    start = np.log([0.9 * test.work_of_adhesion, 1e-5])
    best = least_squares(misfit, start, diff_step=0.02, xtol=1e-4, max_nfev=25)
    if np.abs(best.fun).max() > 0.01:
        print(f"  not matched within 1 %: jump-in and pull-off off by {np.expm1(best.fun)}")
    work, time = np.exp(best.x)
    return float(work), float(time)


def rows(solid: str, test: Measured) -> Iterator[Row]:
    """Yield the predictions for a silicone."""
    modulus = test.contact_modulus
    cases: list[tuple[str, float, float, float, Solid]] = [
        ("published", gap, test.work_of_adhesion, TIME, published(modulus))
        for gap in (SHORT, 0.5e-9, 1e-9, 10e-9)
    ]
    for name, law in (("matched, published shape", published), ("matched, Rouse", rouse)):
        work, time = matched(test, law, SHORT)
        cases.append((name, SHORT, work, time, law(modulus, time)))
    for name, gap, work, time, material in cases:
        pulls = [pull(material, work, gap, speed) for speed in SPEEDS]
        forces = np.array([found.pull_off_force for found in pulls])
        slope = np.polyfit(np.log(SPEEDS), np.log(forces), 1)[0]
        for speed, found in zip(SPEEDS, pulls, strict=True):
            yield Row(
                solid,
                name,
                gap * 1e9,
                work * 1e3,
                time,
                speed * 1e9,
                found.jump_in_force * 1e9,
                found.pull_off_force * 1e9,
                found.travel_to_snap_off * 1e9,
                found.pull_off_force / float(forces[BASE]),
                float(slope),
                found.band,
            )


def exact_sphere_over_parabola(test: Measured) -> tuple[float, float]:
    """Return pull-off force and contact radius [R] of an exact sphere over those of a parabola.

    Small strain, Sneddon's contact of a sphere with the energy of Johnson, Kendall and Roberts
    (Maugis, Langmuir 11 (1995) 679, doi:10.1021/la00002a055).
    """
    a = np.linspace(0.05, 0.6, 20000)
    log = np.log((1 + a) / (1 - a))
    bare = test.contact_modulus * RADIUS**2 * ((1 + a**2) / 2 * log - a)
    edge = np.sqrt(8 * np.pi * test.work_of_adhesion * test.contact_modulus * (a * RADIUS) ** 3)
    force = bare - edge
    least = jkr.pull_off_force(radius=RADIUS, work_of_adhesion=test.work_of_adhesion)
    return -float(force.min()) / float(least), float(a[force.argmin()])


def layer_over_half_space(test: Measured, thickness: float) -> float:
    """Return the pull-off force on a bonded layer over that on a half-space."""
    case = {"contact_modulus": test.contact_modulus, "work_of_adhesion": test.work_of_adhesion}
    sphere = vt.Sphere(radius=RADIUS)
    layer = vt.Layer(thickness=thickness, base=vt.Bonded(poisson_ratio=POISSON))
    thin = film.pull_off(shape=sphere, body=layer, **case)
    return float(thin.force / film.pull_off(shape=sphere, body=vt.HalfSpace(), **case).force)
