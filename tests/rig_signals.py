"""Signals of a rig whose pull-off force, work and contact depth are known.

Approach by Hertz or JKR, dwell, retraction by JKR that ends with a jump or gradually; 60 to 600
points, 30 to 70 % of approach and retraction free of contact, white noise of 0.2 to 1 % of the
range of forces, and a drift of up to 5 % of it.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from viscotack.lab.tack import TackRecord, evaluate
from viscotack.theory import jkr

QUANTITIES = ("pull_off_force", "work_to_pull_off", "preload_depth")
WRONG = 5.0  # stated uncertainties


@dataclass(frozen=True)
class Pure:
    """A test without faults: time, depth and force, and its truth."""

    time: np.ndarray
    depth: np.ndarray
    force: np.ndarray
    truth: tuple[float, ...]

    @property
    def range(self):
        return float(np.ptp(self.force))


@cache
def retraction_law():
    """Return depth and force of JKR's stable branch, for unit radius, modulus and work."""
    unit = {"radius": 1.0, "contact_modulus": 1.0, "work_of_adhesion": 1.0}
    last = jkr.instability(**unit)
    radius = np.linspace(float(last.contact_radius), 12.0, 4000)
    return jkr.depth(radius, **unit), jkr.force(radius, **unit), unit


def jkr_force(depth, work):
    """Return the force at these depths for a work of adhesion."""
    depths, forces, _ = retraction_law()
    # lengths go as work^(2/3), forces as work
    length = work ** (2 / 3)
    return np.interp(depth / length, depths, work * forces, left=0.0)


def pure(rng):
    """Return a test of a sphere by JKR, without noise and drift."""
    depths, forces, unit = retraction_law()
    least = jkr.pull_off(**unit)
    pull_off = -float(least.force)
    preload = pull_off * 10 ** rng.uniform(-0.5, 0.5)
    deep = float(np.interp(preload, forces[np.argmin(forces) :], depths[np.argmin(forces) :]))
    count = 10 ** rng.uniform(np.log10(60), np.log10(600))
    down, hold, up = (round(share * count) for share in (0.4, 0.08, 0.52))
    free_down, free_up = rng.uniform(0.3, 0.7, 2)
    # the retraction ends with JKR's jump, or the force fades over a distance
    gradual = rng.random() < 0.5
    leaves = float(least.depth) - rng.uniform(0.3, 2.0) if gradual else float(depths[0])
    approach = np.linspace(-deep * free_down / (1 - free_down), deep, down)
    away = leaves - (deep - leaves) * free_up / (1 - free_up)
    retraction = np.linspace(deep, away, up)
    at = float(least.depth)
    back = np.interp(retraction, depths, forces, left=0.0)
    if gradual:
        share = np.clip((at - retraction) / (at - leaves), 0, 1)
        fading = -pull_off * (1 - share**2) ** rng.integers(1, 3)
        back = np.where(retraction < at, fading, back)
    work = 10 ** rng.uniform(-1.3, 0) if rng.random() < 0.5 else 0.0
    hertz = 4 / 3 * np.maximum(approach, 0) ** 1.5
    pressed = jkr_force(approach, work) * (approach > 0) if work else hertz
    held = preload + (pressed[-1] - preload) * np.exp(-np.linspace(0, 5, hold))
    fast = np.abs(deep - away)
    clocks = [np.full(down, np.ptp(approach) * 10 ** rng.uniform(-0.3, 0.3) / down)]
    clocks += [np.full(hold, fast * rng.uniform(0.1, 0.5) / hold), np.full(up, fast / up)]
    work_done = float(jkr.work_to_pull_off(**unit))
    return Pure(
        np.cumsum(np.concatenate(clocks)),
        np.concatenate([approach, np.full(hold, deep), retraction]),
        np.concatenate([pressed, held, back]),
        (pull_off, work_done, deep),
    )


def drifting(rng, test):
    """Return a zero and a drift, linear or slow, of up to 5 % of the range of forces."""
    x = (test.time - test.time[0]) / np.ptp(test.time)
    size = test.range * 10 ** rng.uniform(-2.5, -1.3)
    if rng.random() < 0.5:
        course = x * rng.choice([-1, 1])
    else:
        course = 0.5 * np.sin(2 * np.pi * (x / rng.uniform(1, 4) + rng.random()))
    return test.range * rng.uniform(-0.2, 0.2) + size * course


def textbook(rng):
    """Return a record of a textbook signal, and the true values of QUANTITIES."""
    test = pure(rng)
    noise = test.range * 10 ** rng.uniform(np.log10(2e-3), -2)
    force = test.force + drifting(rng, test) + noise * rng.standard_normal(test.time.size)
    return TackRecord(test.time, force, test.depth, into=1), test.truth


def judged(record, truth):
    """Return errors over truth and over stated uncertainties, or the reason of a refusal."""
    try:
        found = evaluate(record)
    except ValueError as error:
        return str(error)
    if not found.cycles:
        return found.refused[0].reason
    cycle = found.cycles[0]
    answers = [getattr(cycle, name) for name in QUANTITIES]
    return [
        ((one.value - true) / abs(true), (one.value - true) / max(one.uncertainty, 1e-300))
        for one, true in zip(answers, truth, strict=True)
    ]
