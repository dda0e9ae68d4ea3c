"""The theory of a crack at the edge, learned: cases, answers, networks.

Solids are drawn from a Sobol sequence of modulus ratio and exponent; of each the cracks are solved
once, and some cases with other Tabor numbers, starts and rates are marched at once. Answered solids
are kept in the folder of the shop, so that a run that was stopped goes on. About five minutes.
"""

import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.stats import qmc

from viscotack.errors import InputError
from viscotack.model.problem.rows import KINDS
from viscotack.prediction.surrogate import short_range
from viscotack.prediction.surrogate.contact import Contact
from viscotack.prediction.surrogate.model import Surrogate
from viscotack.prediction.surrogate.network import Networks
from viscotack.prediction.surrogate.physics import INPUTS, PRELOAD, RATE, TABOR, Array
from viscotack.prediction.surrogate.short_range import HIGH, LOW, ShortRangeContact
from viscotack.prediction.surrogate.trust import OF
from viscotack.result.curve import POINTS
from viscotack.simulate.crack_contact.by_crack import CrackContact, crack_contacts, unloading

from .fitting import Fit, Task
from .refining import Looks, Stage, scaled_task, twice
from .rows import Rows, of_arrays
from .scores import errors, labels_of
from .shop import Shop

# Solids, cases of each, and the part of the solids that no network learns from.
SOLIDS, CASES, _KEPT = 128, 48, 0.125
_SEED = 31
FORCE = Looks(
    Fit((24, 24, 24), steps=2000, scale=0.1, penalty=1e-7),
    Stage(Fit((24, 24, 24), steps=1500, scale=3e-3, penalty=1e-6), 0.03),
)
STATE = Fit((24, 24, 24), steps=2000, scale=1.0, penalty=1e-8)
CURVE = Looks(
    Fit((32, 32, 32), steps=2000, scale=1.0, penalty=1e-8),
    Stage(Fit((24, 24, 24), steps=1500, scale=0.03, penalty=1e-6), 0.03),
)
_MEMBERS = 2
# Steps of a curve of the theory at which the networks are compared with it.
STEPS = 60


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


def answers(rows: Array) -> tuple[Array, Array, Array]:
    """Return numbers and curves of cases of one solid; nan without an answer.

    Force, amplification, zones and work, shape (n, 4); travel left, force and contact radius
    at the points of a trajectory, shape (n, 3, 24); and travel and tension at steps of the theory
    from zero force, or a start in tension, to the pull-off, shape (n, 2, STEPS).
    """
    found, curves = np.full((len(rows), 4), np.nan), np.full((len(rows), 3, POINTS), np.nan)
    steps = np.full((len(rows), 2, STEPS), np.nan)
    kind = KINDS["sphere"]
    problems = [kind.problem(dict(zip(INPUTS, row, strict=True))) for row in rows.tolist()]
    try:
        said = crack_contacts([p.groups() for p in problems])
    except InputError:
        return found, curves, steps
    for i, one in enumerate(said):
        if isinstance(one, CrackContact) and one.pull_off_force is not None:
            numbers = (one.pull_off_force, one.amplification_at_pull_off, one.zones)
            found[i] = np.array([*numbers, one.work_to_pull_off], dtype=float)
            curves[i], whole = unloading(one)
            # even in the number of steps, which are shorter where the force changes
            places = np.linspace(0, whole.shape[1] - 1, STEPS)
            steps[i] = [np.interp(places, np.arange(len(x)), x) for x in whole]
    return found, curves, steps


def simulated(folder: Path, count: int, each: int) -> tuple[list[Array], npt.NDArray[np.intp]]:
    """Return groups and answers of the cases, and their solids; some from the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    found, number = [], []
    for i, solid in enumerate(solids(count)):
        file = folder / f"{i:04d}.npz"
        if not file.exists():
            rows = cases(solid, i, each)
            np.savez(file, rows, *answers(rows))
        with np.load(file, allow_pickle=False) as held:
            found.append([held[f"arr_{j}"] for j in range(4)])
            number.append(np.full(each, i))
        print(f"\r{i + 1} of {count} solids", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return [np.concatenate(x) for x in zip(*found, strict=True)], np.concatenate(number)


def networks(tests: Contact, said: Array, rows: Rows, shop: Shop) -> dict[str, Networks]:
    """Return networks of the force, of energy and zones at the pull-off, of work and curve.

    Of each test `said` has force, amplification, zones and work, and `rows` the curve.
    """
    target, unit = np.log10(said[:, :1]), np.log10(rows.groups[:, TABOR])
    force, pressed = target[:, 0], rows.start_force > 0
    known = tests.knowing(force)
    with_work = np.column_stack([known, np.log10(rows.work)])
    give = (np.log10(rows.give) - unit)[pressed]
    of_force = Task(tests.told, target, np.ones_like(target), (tests.slow, tests.fast))
    others = np.column_stack([np.log10(said[:, 1] - 1 + short_range.LEAST), np.log10(said[:, 2])])
    state = scaled_task(tests.told, others)
    work = scaled_task(known, (np.log10(rows.work) - force - unit)[:, None])
    gives, line = (
        scaled_task(with_work[pressed], give[:, None]),
        scaled_task(with_work, rows.line, rows.known),
    )
    begun = {
        "force": twice([of_force] * _MEMBERS, FORCE, shop),
        "work": twice([work.task] * _MEMBERS, CURVE, shop),
        "give": twice([gives.task], CURVE, shop),
        "state": shop.fit(state.task, STATE).result,
        "line": shop.fit(line.task, CURVE.first).result,
    }
    found = {name: done() for name, done in begun.items()}
    scaled = {"state": state, "work": work, "give": gives, "line": line}
    return found | {name: each.of(found[name]) for name, each in scaled.items()}


def measured(made: Surrogate, rows: Rows, steps: Array) -> tuple[Surrogate, dict[str, Any]]:
    """Return a surrogate with its errors on cases of solids that it has not learned from.

    Curves are compared at `steps` of travel and tension, shape (n, 2, STEPS).
    """
    tests = made.tests(rows.groups)
    assert isinstance(tests, ShortRangeContact)
    said = made.evaluate(tests)
    at_steps = [
        label | {"travel": travel, "tension": tension}
        for label, (travel, tension) in zip(labels_of(rows), steps, strict=True)
    ]
    within = tests.inside().all(axis=1) & tests.holds(said)
    log = np.abs(errors(said, tests.curves(said), at_steps)[within])
    # work and curve are given only where the networks agree
    log[~tests.agree(said)[within], 1:] = np.nan
    # of a curve over the pull-off force, the others of log10
    off = np.column_stack([10 ** log[:, :2] - 1, log[:, 2], 10 ** log[:, 3] - 1])
    shares = {"median": 0.5, "90 %": 0.9, "98 %": 0.98, "largest": 1.0}
    found = np.nanquantile(off, list(shares.values()), axis=0).T
    scores = {n: dict(zip(shares, x.tolist(), strict=True)) for n, x in zip(OF, found, strict=True)}
    given = float(np.mean(np.isfinite(log[:, 1])))
    cases = {
        "cases": int(within.sum()),
        "with work": given,
        "mse_log10": float(np.mean(log[:, 0] ** 2)),
    }
    return replace(made, constants={"error": found[:, 1:3]}), cases | scores


def learned(
    shop: Shop, *, quick: bool = False
) -> tuple[Surrogate, tuple[str, ...], dict[str, Any]]:
    """Return the surrogate of large Tabor numbers with its errors, no sets, and its facts."""
    count = SOLIDS // 8 if quick else SOLIDS
    found, number = simulated(shop.folder / "solids", count, CASES)
    answered = np.flatnonzero(np.isfinite(found[1]).all(axis=1))
    groups, said, points, steps = (x[answered] for x in found)
    left, force, radius = np.moveaxis(points, 1, 0)
    rows = of_arrays(groups, said[:, 0], said[:, 3], force, radius, left)
    # every so many of a Sobol sequence would be a box of it
    apart = np.random.default_rng(_SEED).permutation(count)[: round(_KEPT * count)]
    kept = np.isin(number[answered], apart)
    made = Surrogate(ShortRangeContact, {}, constants={"error": np.zeros((len(OF), 2))})
    tests = made.tests(groups[~kept])
    made = made.having(**networks(tests, said[~kept], rows.chosen(~kept), shop))
    made, scores = measured(made, rows.chosen(kept), steps[kept])
    counts = {"solids": count, "cases": len(number), "answered": len(groups)}
    return made, (), {**counts, "scores": scores}
