"""The surrogate of any linear solid, from the set `solids` to its file and its scores.

``python -m viscotack.surrogate.training.solids --out DIR``: the window in which a power law must be
like a solid is sought by least squares of the logarithms of the forces, nineteen numbers for all
solids; then it is learned how far errors reach, and measured how many times that half an interval
must be. Solids that are kept apart are never learned from, and the family of the stretched
exponentials neither.
"""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import dataclass, fields, replace
from datetime import UTC, datetime
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import least_squares

from viscotack import __version__, datasets
from viscotack.campaign.random_solids import STRETCHED
from viscotack.materials import spectrum

from .. import solids, store
from ..alike import TIMES
from ..network import together
from ..solids import FEATURES, PARTS, TRUST_INPUTS, Likeness, Solids
from ..trust import OF, Trust
from .calibration import LEAST, REACH, levels_of
from .fitting import Fit, Task, fit
from .recipe import untested
from .rows import Rows, of_table
from .scores import curve_errors, travel_errors

Array = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

# Numbers of solids from here on were chosen where the answer feels them.
CHOSEN = 100_000
# Of solids drawn evenly, and of those chosen, one in so many measures intervals, and one judges.
_EVEN, _OF_CHOSEN = 3, 5
# Labels that are worse than this tell nothing [part of the force].
_WORST_LABEL = 1e-2
# Errors of log10 of the force that count in full, and how often the window is improved, by what
# differences.
_SOFT, _LOOKS, _STEP = 5e-3, 3, 3e-3
# How much a window is held to the one that it began with.
_HELD = 1e-3
# Every so many rows of `broad` tell how far errors of power laws reach.
_THINNED = 20
HOW = Fit(hidden=(16, 16), steps=700, scale=1.0, penalty=1e-3)
# The window that is improved: from 0.25 +- 0.6 decades everywhere least squares end in a worse
# place.
_BEGUN = np.array(
    [
        [-0.038, -1.542, 0.019],
        [0.047, 0.838, 0.525],
        [0.598, 0.526, 0.046],
        [-0.049, 0.197, 0.01],
        [-0.164, -0.461, -1.175],
        [0.255, -0.015, 0.194],
    ]
)
_FLOOR = 0.000321


@dataclass(frozen=True, eq=False)
class Tests:
    """Simulated tests on solids, a row each.

    Attributes
    ----------
    tabor, modulus_ratio, preload : ndarray, shape (n,)
    creep : ndarray, shape (n, 15)
        At ``TIMES`` in units of h0 over the speed.
    rows : Rows
        What came out; its groups are nothing yet.
    number : ndarray, shape (n,)
        Of the solid; -1 of a power law.
    """

    tabor: Array
    modulus_ratio: Array
    preload: Array
    creep: Array
    rows: Rows
    number: Array

    def __len__(self) -> int:
        return len(self.tabor)

    def chosen(self, which: Any) -> Tests:
        """Return the rows of a mask."""
        some = {f.name: getattr(self, f.name)[which] for f in fields(self) if f.name != "rows"}
        return Tests(rows=self.rows.chosen(which), **some)

    def like(self, made: Solids) -> Likeness:
        """Return the power laws that stand for the solids."""
        return made.like(self.tabor, self.modulus_ratio, self.preload, self.creep)


def read(table: Any) -> Tests:
    """Return the tests of a table with the columns of the set `solids`."""
    names = ("tabor", "modulus_ratio", "preload", "rate", "solid")
    tabor, k, preload, rate, number = (np.array(table.column(n).to_pylist(), float) for n in names)
    spectra = (table.column(f"retardation_{what}").to_pylist() for what in ("weights", "times"))
    creep = np.array(
        [
            ratio + (1 - ratio) * (-np.expm1(-TIMES[:, None] / speed / np.array(tau)) @ np.array(w))
            for ratio, speed, w, tau in zip(k, rate, *spectra, strict=True)
        ]
    )
    # groups are put in when it is known which power law stands for the solid
    rows = of_table(table.append_column("exponent", [[1.0] * len(k)]))
    found = Tests(tabor, k, preload, creep, rows, number)
    worst = np.array(table.column("force_error").to_pylist())
    return found.chosen(worst <= _WORST_LABEL)


def power_laws(every: int) -> Tests:
    """Return every so many rows of `broad`, as tests on solids like others."""
    rows = of_table(datasets.load("broad")).chosen(slice(None, None, every))
    mu, k, n, preload, rate = rows.groups.T
    crept = np.array([spectrum.crept(e, TIMES / r) for e, r in zip(n, rate, strict=True)])
    creep = k[:, None] + (1 - k[:, None]) * crept
    return Tests(mu, k, preload, creep, rows, np.full(len(rows), -1.0))


def parts(tests: Tests) -> dict[str, Mask]:
    """Return which rows are learned from, measure intervals, judge, and are of the other family."""
    number = tests.number
    even, other = number < CHOSEN, number >= STRETCHED
    place = np.where(even, number % _EVEN, number % _OF_CHOSEN)
    found = {"measure": ~other & (place == 0), "judge": ~other & (place == 1), "other": other}
    return {"learn": ~(found["measure"] | found["judge"] | other), **found}


def first() -> Solids:
    """Return solids with the window that is improved, and no intervals yet."""
    return Solids(
        power_law=store.shipped(),
        window=_BEGUN,
        floor=_FLOOR,
        trust=untested(TRUST_INPUTS),
        spread=np.zeros((len(TIMES), len(TIMES))),
        farthest=np.full(2, np.inf),
    )


def learned(tests: Tests, begun: Solids) -> Solids:
    """Return solids whose window was sought on tests."""
    target = np.log10(tests.rows.force)
    held = np.concatenate([begun.window.ravel(), [np.log(begun.floor)]])

    def put(u: Array) -> Solids:
        # differences are taken with steps that go with the numbers, and many of these are 0
        v = held + u - 1
        return replace(begun, window=v[:-1].reshape(FEATURES, PARTS), floor=float(np.exp(v[-1])))

    def off(u: Array) -> Array:
        made = put(u)
        error = np.log10(made.evaluate(tests.like(made)).pull_off_force) - target
        # large ones count in proportion, not squared
        soft = _SOFT * np.sign(error) * np.sqrt(2 * (np.sqrt(1 + (error / _SOFT) ** 2) - 1))
        return np.concatenate([soft, _HELD * (u - 1)])

    found = least_squares(off, np.ones_like(held), max_nfev=_LOOKS, diff_step=_STEP)
    return put(found.x)


def with_range(made: Solids, tests: Tests) -> Solids:
    """Return solids that know how far those learned from are from power laws."""
    over = tests.like(made).first.over
    sizes, axes = np.linalg.eigh(over.T @ over / len(over))
    # directions in which hardly any solid differs are as far as the last ones in which some do
    made = replace(made, spread=axes / np.sqrt(np.maximum(sizes, 1e-4 * sizes[-1])))
    like = tests.like(made)
    return replace(made, farthest=np.array([like.first.unlike.max(), made.far(like).max()]))


@dataclass(frozen=True, eq=False)
class Judged:
    """How far answers are off, and what the network of the errors is told.

    Attributes
    ----------
    told : ndarray, shape (n, TRUST_INPUTS)
    error : ndarray, shape (n, 4)
        Of log10 of force and work, the largest of the curve over the pull-off force, and of log10
        of the travel to zero force; that is nan for starts in tension.
    """

    told: Array
    error: Array

    def chosen(self, which: Any) -> Judged:
        """Return the rows of a mask."""
        return Judged(self.told[which], self.error[which])


def judged(made: Solids, tests: Tests) -> Judged:
    """Return how far answers are off on tests."""
    like = tests.like(made)
    said = made.evaluate(like)
    rows = replace(tests.rows, groups=like.groups)
    curve = np.nanmax(np.abs(curve_errors(made.power_law, rows, said)), axis=1)
    force = np.log10(said.pull_off_force / rows.force)
    work = np.log10(said.work_to_pull_off / rows.work)
    travel = travel_errors(made.power_law, rows, said)
    return Judged(made.told(like, said), np.column_stack([force, work, curve, travel]))


def trusted(made: Solids, known: Judged, kept: Judged) -> Solids:
    """Return solids with intervals: their reach from all, their levels from those kept apart.

    Two networks of the reach learn from a half of those kept apart each, and each is judged by the
    other half, as in :mod:`viscotack.surrogate.training.calibration`.
    """
    halves = [np.arange(len(kept.told)) % 2 == i for i in (0, 1)]
    members, scores = [], []
    for seed, half in enumerate(halves):
        some = kept.chosen(half)
        inputs = np.concatenate([known.told, some.told])
        error = np.concatenate([known.error, some.error])
        told = np.isfinite(error)
        target = np.log10(np.maximum(np.where(told, np.abs(error), 1.0), LEAST))
        task = Task(inputs, target, told.astype(float), quantile=REACH)
        members.append(fit(task, HOW, seed=seed))
        other = kept.chosen(~half)
        scores.append(np.abs(other.error) / 10 ** members[-1](other.told)[0])
    return replace(made, trust=Trust(together(members), levels_of(np.concatenate(scores))))


def scores(made: Solids, found: Judged, *, confidence: float = 0.9) -> dict[str, Any]:
    """Return what answers and intervals are worth on rows, ready for JSON."""
    widths = np.column_stack(made.trust.widths(found.told, confidence))
    answer: dict[str, Any] = {"rows": len(found.told)}
    for i, name in enumerate(OF):
        known = np.isfinite(found.error[:, i])
        error, width = np.abs(found.error[known, i]), widths[known, i]
        answer[name] = {
            "mse": float(np.mean(error**2)),
            "median": float(np.median(error)),
            "90 %": float(np.quantile(error, 0.9)),
            "98 %": float(np.quantile(error, 0.98)),
            "largest": float(error.max()),
            "cover": float(np.mean(error <= width)),
            "half width": float(np.median(width)),
            "worst in half widths": float(np.max(error / width)),
        }
    return answer


def make(table: Any) -> tuple[Solids, dict[str, Any]]:
    """Return what was learned from a table, and what it is worth."""
    tests = read(table)
    part = {name: tests.chosen(mask) for name, mask in parts(tests).items()}
    made = with_range(learned(part["learn"], first()), part["learn"])
    known = [judged(made, part["learn"]), judged(made, power_laws(_THINNED))]
    both = Judged(*(np.concatenate([getattr(j, f.name) for j in known]) for f in fields(Judged)))
    made = trusted(made, both, judged(made, part["measure"]))
    judge = part["judge"]
    even = judge.number < CHOSEN
    found = {
        "judged by, drawn evenly": scores(made, judged(made, judge.chosen(even))),
        "judged by, chosen": scores(made, judged(made, judge.chosen(~even))),
        "stretched exponentials": scores(made, judged(made, part["other"])),
    }
    counts = {name: len(some) for name, some in part.items()}
    return made, {"rows": counts, "scores": found}


def main() -> None:
    """Learn, measure, write and say what it is worth."""
    parser = argparse.ArgumentParser(prog="python -m viscotack.surrogate.training.solids")
    parser.add_argument("--out", type=Path, required=True, help="folder of the file")
    parser.add_argument("--table", type=Path, help="Parquet file in place of the set `solids`")
    parser.add_argument("--rows", type=int, help="only so many rows, from the beginning")
    given = parser.parse_args()
    began = perf_counter()
    if given.table is None:
        table = datasets.load("solids")
    else:
        import pyarrow.parquet as pq

        table = pq.read_table(given.table)
    table = table.slice(0, given.rows or table.num_rows)
    made, found = make(table)
    facts = {
        "viscotack": __version__,
        "made": datetime.now(UTC).date().isoformat(),
        **found,
    }
    given.out.mkdir(parents=True, exist_ok=True)
    solids.save(made, given.out / "solids.npz", facts)
    print(json.dumps(facts, indent=1))
    print(f"{perf_counter() - began:.0f} s", file=sys.stderr)


if __name__ == "__main__":
    main()
