"""The theory of a crack at the edge, learned: cases, answers, networks.

``python -m training.short_range --out DIR``. Solids are drawn from a Sobol
sequence of modulus ratio and exponent; of each the cracks are solved once, and some cases with
other Tabor numbers, starts and rates are marched at once. Answered solids are kept in the folder,
so that a run that was stopped goes on.
"""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.stats import qmc

from viscotack.campaign.columns import KINDS
from viscotack.errors import InputError
from viscotack.methods.by_crack import CrackContact, crack_contacts
from viscotack.surrogate import short_range, store
from viscotack.surrogate.model import Surrogate
from viscotack.surrogate.network import added, together
from viscotack.surrogate.physics import INPUTS, PRELOAD, RATE, TABOR, Array
from viscotack.surrogate.short_range import HIGH, LOW, ShortRangeContact
from viscotack.version import __version__

from .fitting import Fit, Task, fit
from .recipe import scaled_task

# Solids, cases of each, and the part of the solids that no network learns from.
SOLIDS, CASES, _KEPT = 128, 48, 0.125
_SEED = 31
FIRST = Fit((24, 24, 24), steps=2000, scale=0.1, penalty=1e-7)
SECOND, GAIN = Fit((24, 24, 24), steps=1500, scale=3e-3, penalty=1e-6), 0.03
_MEMBERS = 2


def solids(count: int) -> Array:
    """Return modulus ratios and exponents, shape (count, 2)."""
    generator: dict[str, Any] = {"seed": _SEED}
    part = qmc.Sobol(2, **generator).random(count)
    low, high = (np.log10(end[1:3]) for end in (LOW, HIGH))
    return 10 ** (low + part * (high - low))


def cases(solid: Array, number: int, count: int) -> Array:
    """Return rows of groups of a solid: Tabor number, start and rate drawn in their logarithms."""
    random = np.random.default_rng((_SEED, number))
    u = random.random((count, 3))
    tabor, start, time = (
        LOW[i] * (HIGH[i] / LOW[i]) ** part
        for i, part in zip((TABOR, PRELOAD, RATE), u.T, strict=True)
    )
    both = np.broadcast_to(solid, (count, 2))
    return np.column_stack([tabor, both, start * tabor, time * tabor])


def answers(rows: Array) -> Array:
    """Return force, amplification, zones and work of cases of one solid; nan without an answer."""
    found = np.full((len(rows), 4), np.nan)
    kind = KINDS["sphere"]
    problems = [kind.problem(dict(zip(INPUTS, row, strict=True))) for row in rows.tolist()]
    try:
        said = crack_contacts([p.groups() for p in problems])
    except InputError:
        return found
    for i, one in enumerate(said):
        if isinstance(one, CrackContact) and one.pull_off_force is not None:
            numbers = (one.pull_off_force, one.amplification_at_pull_off, one.zones)
            found[i] = np.array([*numbers, one.work_to_pull_off], dtype=float)
    return found


def simulated(folder: Path, count: int, each: int) -> tuple[Array, Array, npt.NDArray[np.intp]]:
    """Return groups, answers and solids of the cases, those of the folder read from it."""
    folder.mkdir(parents=True, exist_ok=True)
    groups, said, number = [], [], []
    for i, solid in enumerate(solids(count)):
        file = folder / f"{i:04d}.npz"
        if not file.exists():
            rows = cases(solid, i, each)
            np.savez(file, groups=rows, said=answers(rows))
        with np.load(file, allow_pickle=False) as held:
            groups.append(held["groups"])
            said.append(held["said"])
            number.append(np.full(len(held["said"]), i))
        print(f"\r{i + 1} of {count} solids", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return np.concatenate(groups), np.concatenate(said), np.concatenate(number)


def learn(groups: Array, said: Array) -> Surrogate:
    """Return networks that say what the theory says; their error is not known yet."""
    tests = Surrogate(ShortRangeContact, {}).tests(groups)
    target = np.log10(said[:, :1])
    force = Task(tests.told, target, np.ones_like(target), (tests.slow, tests.fast))
    others = np.column_stack([np.log10(said[:, 1] - 1 + short_range.LEAST), np.log10(said[:, 2])])
    state = scaled_task(tests.told, others)
    forces = []
    for seed in range(_MEMBERS):
        one = fit(force, FIRST, seed=seed)
        left = replace(force, before=one(tests.told)[0], gain=GAIN)
        forces.append(added(one, fit(left, SECOND, seed=seed)))
    how = Fit(FIRST.hidden, steps=FIRST.steps, scale=1.0, penalty=1e-8)
    networks = {"force": together(forces), "state": state.of(fit(state.task, how, seed=0))}
    return Surrogate(ShortRangeContact, networks, constants={"error": np.zeros(2)})


def measured(made: Surrogate, groups: Array, said: Array) -> tuple[Surrogate, dict[str, Any]]:
    """Return networks with their error on cases of other solids, and what they are worth.

    Parameters
    ----------
    made : Surrogate
        That has not learned from these cases.
    groups : ndarray, shape (n, 5)
    said : ndarray, shape (n, 4)
        Force, amplification, zones and work by the theory.
    """
    tests = made.tests(groups)
    found = made.evaluate(tests)
    inside = tests.inside().all(axis=1) & tests.holds(found)
    ratio = (found.pull_off_force / said[:, 0])[inside]
    off = np.abs(ratio - 1)
    error = np.quantile(off, [0.9, 0.98])
    scores = {
        "cases": int(inside.sum()),
        "mse_log10": float(np.mean(np.log10(ratio) ** 2)),
        "median": float(np.median(off)),
        "90 %": float(error[0]),
        "98 %": float(error[1]),
        "largest": float(off.max()),
    }
    return replace(made, constants={"error": error}), scores


def main() -> None:
    """Ask the theory, learn, measure and write."""
    parser = argparse.ArgumentParser(prog="python -m training.short_range")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--solids", type=int, default=SOLIDS)
    given = parser.parse_args()
    began = perf_counter()
    groups, said, number = simulated(given.out / "solids", given.solids, CASES)
    known = np.isfinite(said[:, 0])
    # every so many of a Sobol sequence would be a box of it
    apart = np.random.default_rng(_SEED).permutation(given.solids)[: round(_KEPT * given.solids)]
    kept = np.isin(number, apart)
    made = learn(groups[known & ~kept], said[known & ~kept])
    made, scores = measured(made, groups[known & kept], said[known & kept])
    facts = {
        "viscotack": __version__,
        "made": datetime.now(UTC).date().isoformat(),
        "solids": given.solids,
        "cases": len(groups),
        "answered": int(known.sum()),
        "scores": scores,
    }
    store.save(made, given.out / "short_range.npz", facts)
    print(json.dumps(facts, indent=1))
    print(f"{perf_counter() - began:.0f} s", file=sys.stderr)


if __name__ == "__main__":
    main()
