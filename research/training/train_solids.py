"""The surrogate of any linear solid from the sets `solids` and `rough`; two to four minutes.

A network learns where the search for the power law that a solid is like begins
(`likeness`); others learn from simulated tests how what that one leaves over bends
force and work. Solids that are kept apart are never learned from, and the family of the stretched
exponentials neither.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack import datasets
from viscotack.arrays import Array
from viscotack.model.materials import power_law
from viscotack.model.materials.random_solids import STRETCHED
from viscotack.prediction.surrogate import linear_solids, store
from viscotack.prediction.surrogate.contact import between
from viscotack.prediction.surrogate.linear_solids import SAMPLES, TIMES, Alike, SolidContact
from viscotack.prediction.surrogate.model import Surrogate
from viscotack.prediction.surrogate.network import Networks

from . import calibration, likeness
from .calibration import Apart, trusted, worth
from .fitting import Fit, Task, fit
from .joining import together
from .rows import Rows, of_table
from .shop import Shop

Mask = npt.NDArray[np.bool_]

LEARNED = ("solids", "rough")
# Numbers of solids from here on were chosen where the answer feels them, and from there on to be
# learned from alone.
CHOSEN, ROUGH = 100_000, 200_000
# Of the first solids drawn evenly, of the others, and of those chosen one in so many measures
# intervals, and one judges.
_FIRST, _EVEN, _OTHERS, _OF_CHOSEN = 900, 3, 6, 5
# Rows of a trial.
_TRIED = 1500
# Labels that are worse than this tell nothing [part of the force].
_WORST_LABEL = 1e-2
# Every so many rows of `broad` tell how far errors of power laws reach.
_THINNED = 20
HOW = Fit(hidden=(16, 16), steps=700, scale=1.0, penalty=1e-3)
# Networks of the bends, and how they are fitted: stopped early, and begun near zero, for rows are
# few. Errors of force and work of log10 from which on a row counts less.
MEMBERS, _GAIN, _SOFT = 4, 0.1, (5e-3, 2e-2)
# How far errors reach is learned from networks that had not seen the test: parts they go without.
_FOLDS = 3
FORCE = Fit(hidden=(32, 32, 32), steps=300, scale=2e-3, penalty=1e-3)
WORK = Fit(hidden=(48, 48), steps=300, scale=8e-3, penalty=1e-3)


@dataclass(frozen=True, eq=False)
class Tests:
    """Simulated tests on solids, a row each."""

    tabor: Array
    modulus_ratio: Array
    preload: Array
    creep: Array  # at ``TIMES`` in units of h0 over the speed, shape (n, 15)
    rows: Rows  # what came out; its groups are nothing yet
    number: Array  # of the solid; -1 of a power law

    def __len__(self) -> int:
        return len(self.tabor)

    def chosen(self, which: Any) -> "Tests":
        """Return the rows of a mask."""
        some = {f.name: getattr(self, f.name)[which] for f in fields(self) if f.name != "rows"}
        return Tests(rows=self.rows.chosen(which), **some)

    def like(self, made: Surrogate) -> Alike:
        """Return the power laws that stand for the solids."""
        return linear_solids.like(made, self.tabor, self.modulus_ratio, self.preload, self.creep)


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
    return as_solids(of_table(datasets.load("broad")).chosen(slice(None, None, every)))


def as_solids(rows: Rows) -> Tests:
    """Return tests on power laws as tests on solids like others."""
    mu, k, n, preload, rate = rows.groups.T
    crept = np.array([power_law.crept(e, TIMES / r) for e, r in zip(n, rate, strict=True)])
    creep = k[:, None] + (1 - k[:, None]) * crept
    return Tests(mu, k, preload, creep, rows, np.full(len(rows), -1.0))


def parts(tests: Tests) -> dict[str, Mask]:
    """Return which rows are learned from, measure intervals, judge, and are of the other family."""
    number = tests.number
    other = number >= STRETCHED
    kept = ~other & (number < ROUGH)
    every = np.where(number < CHOSEN, _OTHERS, _OF_CHOSEN)
    place = number % np.where(number < _FIRST, _EVEN, every)
    found = {"measure": kept & (place == 0), "judge": kept & (place == 1), "other": other}
    return {"learn": ~(found["measure"] | found["judge"] | other), **found}


def parted(table: Any) -> dict[str, Tests]:
    """Return the tests of a table by what they are for: :func:`parts`."""
    tests = read(table)
    return {name: tests.chosen(mask) for name, mask in parts(tests).items()}


def unbent() -> Surrogate:
    """Return a surrogate that finds the power law of a solid, without corrections yet."""
    constants = {
        "floor": np.array(likeness.FLOOR),
        "usual": np.ones(SAMPLES),
        "spread": np.zeros((SAMPLES, SAMPLES)),
        "farthest": np.full(2, np.inf),
    }
    begun = Surrogate(SolidContact, store.shipped().networks, constants=constants)
    return begun.having(begin=likeness.begin(), bend_force=_none(), bend_work=_none())


def _none() -> Networks:
    """Return networks that bend nothing."""
    return Networks((np.zeros((1, 7 + SAMPLES, SAMPLES)),), (np.zeros((1, 1, SAMPLES)),))


def bent(begun: Surrogate, solids: Tests) -> Surrogate:
    """Return a surrogate with corrections of force and work that were learned from tests."""
    like, power_law = solids.like(begun), store.shipped()
    usual = np.sqrt(np.mean(like.over**2, axis=0))
    made = replace(begun, constants={**begun.constants, "usual": usual}).having(bend_work=_none())
    tests = power_law.tests(like.groups)
    output = power_law.networks["force"](tests.told)[..., 0]
    over = linear_solids.scaled_over(like, usual)
    inputs = np.column_stack([linear_solids.features(like, output), over])
    factor = linear_solids.felt(output)
    # one way and one output stand for those of several networks, which hardly differ
    output, limits = output.mean(axis=0), (tests.slow, tests.fast.mean(axis=0))
    plainly, before = between(*limits, output), output[:, None]
    off = np.log10(solids.rows.force / power_law.evaluate(tests).pull_off_force)
    force = Task(inputs, plainly + off, _soft(off, _SOFT[0]), limits, before, _GAIN, factors=over)
    made = made.having(bend_force=_members(force, FORCE))
    off = np.log10(solids.rows.work / made.evaluate(like).work_to_pull_off)
    work = Task(inputs, off, _soft(off, _SOFT[1]), gain=_GAIN, factors=over * factor)
    return made.having(bend_work=_members(work, WORK))


def _soft(off: Array, usual: float) -> Array:
    """Return weights by which errors that are large already count in proportion, not squared."""
    return 1 / np.sqrt(1 + (off / usual) ** 2)


def _members(task: Task, how: Fit) -> Networks:
    task = replace(task, target=task.target[:, None], weight=task.weight[:, None])
    return together([fit(task, how, seed=seed) for seed in range(MEMBERS)])


def with_range(made: Surrogate, tests: Tests) -> Surrogate:
    """Return a surrogate that refuses solids further from power laws than those of tests."""
    like = tests.like(made)
    sizes, axes = np.linalg.eigh(like.over.T @ like.over / len(like.over))
    # directions in which hardly any solid differs are as far as the last ones in which some do
    spread = axes / np.sqrt(np.maximum(sizes, 1e-4 * sizes[-1]))
    farthest = np.array([like.unlike.max(), linear_solids.far(like, spread).max()])
    return replace(made, constants={**made.constants, "spread": spread, "farthest": farthest})


def judged(made: Surrogate, tests: Tests) -> Apart:
    """Return how far answers are off on tests."""
    return calibration.judged(made, tests.rows, tests.like(made))


def across(made: Surrogate, tests: Tests) -> list[Apart]:
    """Return how far answers are off where what they learned from has other tests only."""
    fold = np.arange(len(tests)) % _FOLDS
    return [
        judged(bent(made, tests.chosen(fold != i)), tests.chosen(fold == i)) for i in range(_FOLDS)
    ]


def learned(
    shop: Shop, *, quick: bool = False
) -> tuple[Surrogate, tuple[str, ...], dict[str, Any]]:
    """Return the surrogate of other solids without intervals, its sets and its facts.

    Its networks are small; they are fitted here, and not kept.
    """
    rows = table()
    part = parted(rows.slice(0, _TRIED) if quick else rows)
    made = with_range(bent(unbent(), part["learn"]), part["learn"])
    return made, LEARNED, {"rows": {name: len(some) for name, some in part.items()}}


def scores(made: Surrogate, part: Mapping[str, Tests]) -> dict[str, Any]:
    """Return what a surrogate is worth on the tests that judge, ready for JSON."""
    judge = part["judge"]
    even = judge.number < CHOSEN
    return {
        "judged by, drawn evenly": worth(made, judged(made, judge.chosen(even))),
        "judged by, chosen": worth(made, judged(made, judge.chosen(~even))),
        "stretched exponentials": worth(made, judged(made, part["other"])),
    }


def measured(
    made: Surrogate,
    part: Mapping[str, Tests],
    further: Sequence[Tests] = (),
    fresh: Sequence[Apart] = (),
) -> Surrogate:
    """Return a surrogate with intervals, which hold for the rows that measure and for fresh sets.

    Further tests that it has not learned from tell how far errors reach.
    """
    known = [*across(made, part["learn"]), *(judged(made, x) for x in further)]
    known.append(judged(made, power_laws(_THINNED)))
    both = Apart(*(np.concatenate([getattr(j, f.name) for j in known]) for f in fields(Apart)))
    kept = [judged(made, part["measure"]).without_curves(), *fresh]
    return trusted(made, both.without_curves(), kept, how=HOW)


def table() -> Any:
    """Return the rows of the sets `solids` and `rough`."""
    import pyarrow as pa

    return pa.concat_tables(datasets.load(x).replace_schema_metadata() for x in LEARNED)
