"""Evaluate signals of a rig whose pull-off force, work and contact depth are known.

    python benchmarks/rig_signals.py [textbook|disturbed|labs] [--count 500] [--seed 1] [--worst 5]

`textbook`: approach by Hertz or JKR, dwell, retraction by JKR that ends with a jump or gradually;
60 to 600 points, 30 to 70 % of approach and retraction free of contact, white noise of 0.2 to 1 %
of the range of forces, and a drift, linear or slow, of up to 5 % of it.
`disturbed`: the same with one of 15 disturbances that the evaluation does not know.
`labs`: the curves of `labs.py` without scatter between tests, under four kinds of noise and drift.

An answer is wrong if it is off by more than five of its stated uncertainties. Seed 1 was kept out
of development.
"""

import argparse
import time
from dataclasses import dataclass
from functools import cache

import numpy as np

from viscotack.lab.tack import TackRecord, evaluate
from viscotack.theory import jkr

QUANTITIES = ("pull_off_force", "work_to_pull_off", "preload_depth")
WRONG = 5.0  # stated uncertainties


@dataclass(frozen=True)
class Signal:
    """A record with the true values of QUANTITIES, and the keywords of its evaluation."""

    record: TackRecord
    truth: tuple[float, ...]
    known: dict


@dataclass(frozen=True)
class Pure:
    """A test without faults: time, depth and force, first indices of its parts, and its truth."""

    time: np.ndarray
    depth: np.ndarray
    force: np.ndarray
    parts: tuple[int, int, int, int]  # contact, dwell, retraction, detachment
    truth: tuple[float, ...]

    @property
    def range(self):
        """Range of forces."""
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
        (
            int(np.argmax(approach > 0)),
            down,
            down + hold,
            down + hold + int(np.argmax(retraction < leaves)),
        ),
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
    """Return a textbook signal."""
    test = pure(rng)
    noise = test.range * 10 ** rng.uniform(np.log10(2e-3), -2)
    force = test.force + drifting(rng, test) + noise * rng.standard_normal(test.time.size)
    return Signal(TackRecord(test.time, force, test.depth, into=1), test.truth, {})


def spikes(rng, test, force):
    at = rng.choice(force.size, max(force.size // 60, 2), replace=False)
    force[at] += test.range * rng.normal(0, 0.3, at.size)


def step(rng, test, force):
    force[rng.integers(force.size) :] += test.range * rng.choice([-1, 1]) * rng.uniform(0.01, 0.05)


def quantised(rng, test, force):
    digit = test.range * rng.uniform(0.005, 0.03)
    force[:] = np.round(force / digit) * digit


def stick_slip(rng, test, force):
    begin, end = test.parts[2], test.parts[3]
    size = 0.05 * test.range * np.linspace(0, 1, end - begin)
    force[begin:end] += size * (np.arange(end - begin) * rng.uniform(0.05, 0.3) % 1 - 0.5)


def drift_changes(rng, test, force):
    x = (test.time - test.time[test.parts[1]]) / np.ptp(test.time)
    force += test.range * 0.03 * (rng.normal() * np.minimum(x, 0) + rng.normal() * np.maximum(x, 0))


def snap_in(rng, test, force):
    part = slice(test.parts[0], test.parts[0] + max((test.parts[1] - test.parts[0]) // 4, 2))
    force[part] -= test.range * rng.uniform(0.05, 0.2) * np.linspace(1, 0, part.stop - part.start)


def snap_off(rng, test, force):
    after = np.arange(force.size - test.parts[3])
    ring = np.exp(-after / 6) * np.cos(after * rng.uniform(0.5, 2))
    force[test.parts[3] :] += 0.15 * test.range * ring


def offset(rng, test, force):
    force += 10 * test.range * rng.normal()


def saturation(rng, test, force):
    force[:] = np.minimum(force, force.max() - test.range * rng.uniform(0, 0.2))


def curved(rng, test, force):
    x = (test.depth - test.depth.max()) / np.ptp(test.depth)
    force += 0.05 * test.range * rng.choice([-1, 1]) * x**2


def drag(rng, test, force):
    speed = np.gradient(test.depth, test.time)
    gap = np.maximum(-test.depth, 0) + 0.2 * test.depth.max()
    force += 0.03 * test.range * speed / np.abs(speed).max() * 0.2 * test.depth.max() / gap


def periodic(rng, test, force):
    turns = rng.uniform(2, 10)
    x = test.time / np.ptp(test.time)
    force += 0.01 * test.range * np.sin(2 * np.pi * (turns * x + rng.random()))


def hum(rng, test, force):
    force += 0.01 * test.range * np.sin(np.arange(force.size) * rng.uniform(1, 3) + rng.random())


DISTURBANCES = {
    "spikes": spikes,
    "step": step,
    "quantised": quantised,
    "dropped samples": None,
    "stick-slip": stick_slip,
    "drift changes": drift_changes,
    "snap-in": snap_in,
    "snap-off": snap_off,
    "few points": None,
    "offset": offset,
    "saturation": saturation,
    "curved baseline": curved,
    "drag": drag,
    "periodic": periodic,
    "hum": hum,
}


def disturbed(rng, kind):
    """Return a signal with one disturbance."""
    test = pure(rng)
    force = test.force + drifting(rng, test)
    force = force + test.range * rng.uniform(0.002, 0.01) * rng.standard_normal(force.size)
    if DISTURBANCES[kind]:
        DISTURBANCES[kind](rng, test, force)
    kept = np.ones(force.size, dtype=bool)
    if kind == "dropped samples":
        begin = rng.integers(force.size)
        kept[begin : begin + max(force.size // 20, 2)] = False
        kept &= rng.random(force.size) > 0.1
    if kind == "few points":
        kept[np.arange(force.size) % max(force.size // 50, 1) > 0] = False
    record = TackRecord(test.time[kept], force[kept], test.depth[kept], into=1)
    return Signal(record, test.truth, {})


def judged(signal):
    """Return errors over truth and over stated uncertainties, or the reason of a refusal."""
    try:
        found = evaluate(signal.record, **signal.known)
    except ValueError as error:
        return str(error)
    if not found.cycles:
        return found.refused[0].reason
    cycle = found.cycles[0]
    answers = [getattr(cycle, name) for name in QUANTITIES]
    return [
        ((one.value - true) / abs(true), (one.value - true) / max(one.uncertainty, 1e-300))
        for one, true in zip(answers, signal.truth, strict=True)
    ]


def report(name, signals, worst=0):
    """Print how many are refused and wrong, errors, and their ratio to the uncertainty."""
    begin = time.process_time()
    found = [judged(signal) for signal in signals]
    each = (time.process_time() - begin) / len(signals)
    answered = [i for i, one in enumerate(found) if not isinstance(one, str)]
    refused = len(found) - len(answered)
    print(f"{name}: {len(found)}, refused {refused}, {each:.4f} s each")
    if not answered:
        return
    rows = np.array([found[i] for i in answered])
    for j, quantity in enumerate(QUANTITIES):
        error, ratio = np.abs(rows[:, j]).T
        print(
            f"  {quantity:17} wrong {np.sum(ratio > WRONG):3d}; error rms "
            f"{np.sqrt(np.mean(error**2)):.2%}, median {np.median(error):.2%}, worst "
            f"{error.max():.1%}; over uncertainty rms {np.sqrt(np.mean(ratio**2)):.2f}, "
            f"within one {np.mean(ratio < 1):.0%}, two {np.mean(ratio < 2):.0%}"
        )
        if worst:
            order = np.argsort(-ratio)[:worst]
            print(
                "    ", ", ".join(f"{answered[i]}: {ratio[i]:.1f} ({error[i]:.1%})" for i in order)
            )
    if worst:
        for i, one in enumerate(found):
            if isinstance(one, str):
                print(f"    {i}: {one}")


@cache
def lab_curves(count, first):
    """Return past time, depth of drive, force, pull-off and compliance of labs' retractions."""
    import labs

    curves = []
    for seed in range(first, first + count):
        lab = labs.slow_enough(labs.lab_of(seed, labs.USUAL))
        for speed in lab["speeds"][::2]:
            past, drive, pressed, pull_off = labs.curve_of(lab, speed)
            curves.append((past, drive, pressed, pull_off, 1 / lab["stiffness"]))
    return curves


LAB_KINDS = ("as labs.py", "1 % noise", "wandering zero", "125 points")


def lab_signal(rng, curve, kind):
    """Return the signal of a lab's test: approach, dwell, retraction, and free of contact."""
    past, drive, force, pull_off, compliance = curve
    count = 125 if kind == "125 points" else 1180
    down, hold, back, out = (round(share * count) for share in (0.25, 0.03, 0.6, 0.12))
    even = np.linspace(0, past[-1], back)
    top, far = drive[0], 0.5 * (drive[0] - drive[-1])
    far = max(far, drive[-1] + 0.4 * max(top, 0.0))
    away = drive[-1] - np.linspace(1 / out, 1, out) * far
    approach = np.linspace(away[-1], top, down)
    height = np.maximum(approach, 0) / top if top > 0 else np.zeros(down)
    push = [force[0] * height**1.5, np.full(hold, force[0]), np.interp(even, past, force)]
    clock = [np.linspace(-1.3, -0.3, down), np.linspace(-0.29, -1e-3, hold), even / past[-1]]
    clock += [1 + far / (drive[0] - drive[-1]) * np.arange(1, out + 1) / out]
    clock = np.concatenate(clock)
    noise = pull_off * (0.01 if kind == "1 % noise" else 0.004)
    zero = 3 * noise * (1 + clock / clock[-1])
    if kind == "wandering zero":
        wander = np.cumsum(rng.standard_normal(clock.size) * np.sqrt(np.diff(clock, prepend=-1.31)))
        zero = zero + 0.01 * pull_off * wander
    push = np.concatenate([*push, np.zeros(out)]) + zero + noise * rng.standard_normal(clock.size)
    way = np.concatenate([approach, np.full(hold, top), np.interp(even, past, drive), away])
    depth = drive - compliance * force
    at = int(np.argmin(force))
    pressed = np.flatnonzero(force[:at] >= 0)
    part = slice(int(pressed[-1]) if pressed.size else 0, at + 1)
    work = float(np.trapezoid(force[part], depth[part]))
    truth = (float(pull_off), work, float(depth[0]))
    return Signal(
        TackRecord(clock * past[-1], push, way, into=1), truth, {"compliance": compliance}
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", nargs="*", default=["textbook", "disturbed", "labs"])
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--worst", type=int, default=0)
    given = parser.parse_args()
    drawn = lambda *key: np.random.default_rng([given.seed, *key])  # noqa: E731
    if "textbook" in given.what:
        report("textbook", [textbook(drawn(i)) for i in range(given.count)], given.worst)
    if "disturbed" in given.what:
        each = max(given.count // 15, 2)
        for j, kind in enumerate(DISTURBANCES):
            report(kind, [disturbed(drawn(j, i), kind) for i in range(each)], given.worst)
    if "labs" in given.what:
        curves = lab_curves(max(given.count // 25, 2), 1000 * given.seed)
        for j, kind in enumerate(LAB_KINDS):
            signals = [lab_signal(drawn(j, i), curve, kind) for i, curve in enumerate(curves)]
            report(f"labs, {kind}", signals, given.worst)


if __name__ == "__main__":
    main()
