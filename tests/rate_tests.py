"""Rate series of a lens on a rubber of moderate contrast, computed, measured and fitted."""

from dataclasses import replace
from pathlib import Path

import numpy as np

import viscotack as vt
from viscotack.identify import PullOff, RateSeries, identify_rates
from viscotack.identify.forward import Forward
from viscotack.lab.tack import Measured

RUBBER = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1e-2, poisson_ratio=0.5)
RADIUS, WORK, GAP, PRELOAD = 5.19e-3, 0.1523, 200e-9, 1.5e-3
SPEEDS = np.geomspace(1e-6, 1e-3, 6)
RIG = Path(__file__).parents[1] / "examples" / "from_rig"
LENS = [str(RIG / f"lens_{v}_um_s.csv") for v in (1, 30, 1000)]


def linear(speeds=SPEEDS, material=RUBBER, gap=GAP):
    """Return the pull-off forces of a linear solid [N]."""
    return Forward(material, RADIUS).pulled(WORK, gap, np.asarray(speeds), PRELOAD).force


def of_single_cracks(forward, interface, speeds, *law):
    """Return pull-offs [N] for a work, a gap and a preload, each of a crack of its own."""
    work, gap, preload = interface
    found = [vt.crack_contact(forward.problem(work, gap, preload, float(v), *law)) for v in speeds]
    unit = 1.5 * np.pi * forward.radius * work
    return np.array([one.pull_off_force for one in found]) * unit


def measured(forces, relative, speeds=SPEEDS, **more):
    """Return pull-offs with a relative uncertainty of their forces."""
    rows = zip(speeds, forces, strict=True)
    return [PullOff(float(v), Measured(float(P), relative * float(P)), **more) for v, P in rows]


def fitted(forces, relative, speeds=SPEEDS, **more):
    case = {"material": RUBBER, "radius": RADIUS, "preload": PRELOAD} | more
    return identify_rates(RateSeries(measured(forces, relative, speeds), **case))


def of_other(fit, **changes):
    """Return a fit as if its series had other settings."""
    return replace(fit, search=replace(fit.search, series=replace(fit.given, **changes)))


def holds(forecast, forces):
    """Whether the band of a forecast holds forces."""
    return bool(np.all((forecast.low < forces) & (forces < forecast.high)))
