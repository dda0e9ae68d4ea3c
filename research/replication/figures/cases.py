"""The problems of the thesis in the words of the package, and what is measured of them."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

import viscotack as vt
from research.cases import reduced
from viscotack import theory

# "Unless differently stated": chapter 4 and chapter 3.
TABOR, K = 3.24, 0.1
SIZE, COHESION = 64.85, 0.05
FOUR = (3.24, 6.48, 12.97, 32.42)
EXPONENTS = (0.4, 0.6, 0.8, 1.6)
STANDARD = 0.0
# Critical over peak stress of chapter 4, and dg0/(sigma0 h0) of the Lennard-Jones law.
ALPHA, ALPHA_LJ = np.pi / 9, 9 * np.sqrt(3) / 16
# Chapter 4 counts forces in pi R dg0, the package as chapter 5 in 1.5 pi R dg0.
CHAPTER_4 = 1.5

# Silicone rubber and lens of section 4.6, SI.
PDMS = vt.RetardationPowerLaw(
    rubbery_modulus=1.458e6,
    glassy_modulus=3089e6,
    exponent=0.2207,
    tau0=0.01876,
    poisson_ratio=0.5,
)
LENS, PDMS_WORK, PRELOAD = 5.19e-3, 0.1523, 1.5e-3
RANGES = {"30.8 nm": 30.8e-9, "200 nm": 200e-9, "1.55 um": 1.55e-6}


def solid(k: float = K, exponent: float = STANDARD) -> Any:
    """Return a reduced solid: a power law by its retardation, or the standard one; elastic at 1."""
    return reduced(k, exponent)


def sphere(
    rate: float,
    start: Any,
    *,
    tabor: float = TABOR,
    k: float = K,
    exponent: float = STANDARD,
    **others: Any,
) -> vt.Groups:
    """Return a sphere pulled off a relaxed solid; a number for a start is its depth [h0]."""
    at = vt.AtDepth(float(start)) if isinstance(start, int | float) else start
    return vt.Groups(tabor=tabor, material=solid(k, exponent), start=at, rate=rate, **others)


def punch(thickness: float, rate: float, **changes: Any) -> vt.Groups:
    """Return the punch of chapter 3 on a layer of a thickness [a0]."""
    standard = vt.Groups(
        tabor=None,
        geometry=vt.FlatPunch(SIZE),
        body=vt.Layer(thickness),
        cohesion=COHESION,
        material=solid(),
        start=vt.AtDepth(1.0),
        rate=rate,
    )
    return replace(standard, **changes)


def glassy_punch(thickness: float, size: float = SIZE) -> vt.Groups:
    """Return the punch on an elastic layer of the glassy modulus, whose a0 is 1/k times as long."""
    wide = {"geometry": vt.FlatPunch(K * size), "cohesion": K * COHESION}
    return punch(K * thickness, 1.0, material=solid(1.0), **wide)


def lens(speed: float, gap: float, start: Any = None, material: Any = PDMS) -> vt.Problem:
    """Return the lens on silicone rubber, pulled at a speed [m/s], by forces of a range [m]."""
    return vt.Problem(
        material=material,
        traction=vt.LennardJones(work_of_adhesion=PDMS_WORK, equilibrium_gap=gap),
        geometry=vt.Sphere(radius=LENS),
        protocol=vt.Retraction(start=start or vt.AtForce(PRELOAD), speed=speed),
    )


class Work(NamedTuple):
    """A case, and how it is solved."""

    case: Any
    until: str = "pull-off"
    accuracy: float = 2e-3
    estimate: bool = True


def detached(work: Work) -> dict[str, float]:
    """Return what a simulation says of a detachment; nan where it says nothing.

    ``force``, ``work``, ``speed`` (of the edge), for a punch ``ligament`` in the units of
    :mod:`viscotack.result`; ``separation`` where it is run so far; relative errors of force and
    work.
    """
    result = vt.solve(
        work.case,
        accuracy=work.accuracy,
        until=work.until,
        estimate_error=work.estimate,
        throw=False,
    )
    error = result.error_estimate or {}
    found = {
        "force": _or_nan(vt.pull_off_force, result),
        "force_error": float(error.get("force", np.nan)),
        "work": _or_nan(vt.work_to_pull_off, result),
        "work_error": float(error.get("work", np.nan)),
        "speed": _or_nan(vt.crack_speed_at_pull_off, result),
    }
    if result.groups.in_plane_strain:
        found["ligament"] = _or_nan(vt.ligament_at_pull_off, result)
    if work.until == "detached":
        found["separation"] = _or_nan(vt.work_of_separation, result)
    return found


def table(each: Any, works: list[Work], shape: tuple[int, ...] | None = None) -> dict[str, Any]:
    """Return what came of many cases, an array for each quantity."""
    rows = list(each(detached, works))
    return {
        name: np.array([row[name] for row in rows]).reshape(shape or len(rows)) for name in rows[0]
    }


def curve(result: vt.Result, points: int = 160) -> dict[str, Any]:
    """Return depth, force, radius and time of a run at so many of its steps, evenly by force."""
    way = np.abs(np.diff(result.force)) / np.ptp(result.force)
    way = way + np.abs(np.diff(result.depth)) / np.ptp(result.depth)
    along = np.concatenate([[0.0], np.cumsum(way)])
    steps = np.unique(np.searchsorted(along, np.linspace(0, along[-1], points)))
    steps = np.minimum(steps, len(result.time) - 1)
    series = ("time", "depth", "force", "contact_radius")
    return {name: getattr(result, name)[steps] for name in series}


def tip_speed(edge_speed: Any, tabor: float = TABOR, alpha: float = ALPHA) -> Any:
    r"""Return v tau0/l0 of an edge speed of the package, in (R^2 dg0/E0*)^(1/3)/tau0.

    .. math:: \frac{\beta}{l_0} = \frac{\pi \alpha^2}{\alpha_{LJ}^2} \mu^2
    """
    return np.asarray(edge_speed) * np.pi * alpha**2 / ALPHA_LJ**2 * tabor**2


def elastic_ratio(tabor: Any) -> Any:
    """Return f(mu), the elastic Lennard-Jones pull-off force over that of JKR."""
    return theory.lennard_jones.pull_off_ratio(tabor)


def _or_nan(observable: Callable[[vt.Result], float], result: vt.Result) -> float:
    try:
        return float(observable(result))
    except ValueError:
        return np.nan
