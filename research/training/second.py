"""Second networks of force and work, with which the first ones must agree, and intervals anew.

``python -m research.training.second CONTACT --out DIR --labels DIR`` fits those of `sphere`,
`solids` or `punch`, adds them to the file of the package, measures its intervals and writes it
into the folder. They know other inputs, have another form, and learn from further rows: where the
force has two maxima of about the same height (`deep`, `sharp`, and soft punches), and where an
adversary found errors (`hard`, `steep`, `punch_faces`). Rows that measure intervals or
judge are left out. Intervals hold the rows of the sets that measure, and fresh cases of another
seed (`fresh_cases`), of which curves are known at all steps of the simulations.
Levels of other solids come from fresh cases of another
seed, from which no network has learned: networks of the reach that know only a half of the cases
with two maxima are so much worse there that levels from the other half are 1.6 times too large.
With ``--intervals`` the second networks of the file are kept, and only its intervals are measured
again.
"""

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from viscotack import datasets
from viscotack.arrays import Array
from viscotack.prediction.surrogate import store
from viscotack.prediction.surrogate.contact import SECOND_WAY
from viscotack.prediction.surrogate.model import Surrogate
from viscotack.prediction.surrogate.network import Networks
from viscotack.version import __version__

from . import fresh_cases
from . import train_punch as punches
from . import train_solids as solids
from . import train_sphere as spheres
from .calibration import ENOUGH, Apart, by_set, judged, levelled, trusted, untested
from .fitting import Fit
from .joining import together
from .refining import scaled_task
from .rows import FAR_OFF, LEARNED, Rows, certain, joined, read
from .shop import Shop

HOW = {
    "sphere": Fit(hidden=(48, 48, 48), steps=2500, penalty=1e-8, scale=1.0),
    "solids": Fit(hidden=(48, 48, 48), steps=4000, penalty=5e-7, scale=1.0),
    "punch": Fit(hidden=(32, 32, 32), steps=3000, penalty=1e-7, scale=1.0),
}
MEMBERS = {"sphere": 1, "solids": 1, "punch": 3}
# Every so many rows of `broad` are learned from as solids too.
_THINNED = 10
# Seed of the fresh cases that measure intervals. Designs with fewer than `ENOUGH` tell how far
# errors reach, as rows do that were sought where errors are large.
SEED = 41
# Seed and numbers of the cases of other solids that measure levels, and their accuracy: intervals
# are judged at every step, and finer simulations have more steps.
LEVELS, FINE = (43, {"other solids": 600, "two peaks": 700}), 2e-4
# Seed and number of the soft punches that second networks learn from.
SOFT = 45, {"soft punches": 300}
# Errors of punches below these, about those of the labels, count alike, so that few lie beyond
# three half widths.
LEAST = np.array([4e-4, 5e-4, 3e-4, 1e-4])
# What a surrogate is given, and force and work of these tests.
Taught = tuple[Any, Array, Array]


def learned(contact: str, labels: Path) -> Taught:
    """Return the tests that second networks learn from."""
    if contact == "punch":
        rows = joined([*punches.parted()[0], punches.faces().chosen(slice(0, None, 2))])
        made, pairs = store.shipped("punch"), _labelled(fresh_cases.drawn(*SOFT), labels)
        soft = np.array([[found["force"], found["work"]] for _, found in pairs])
        given = fresh_cases.given_of(made, [case for case, _ in pairs])
        numbers = np.vstack([np.column_stack([rows.force, rows.work]), soft])
        return np.vstack([rows.groups, given]), *numbers.T
    if contact == "sphere":
        whole = spheres.parted()[0]
        varied = whole.chosen(whole.origin != LEARNED.index("thesis"))
        rows = joined([varied, read(*FAR_OFF, "deep")])
        return rows.groups, rows.force, rows.work
    some = [
        solids.parted(solids.table())["learn"],
        solids.read(datasets.load("sharp")),
        solids.power_laws(_THINNED),
        solids.as_solids(read("deep")),
    ]
    likes = [one.like(store.shipped("solids")) for one in some]
    names = likes[0].__dataclass_fields__
    like = type(likes[0])(**{n: np.concatenate([getattr(x, n) for x in likes]) for n in names})
    rows = joined([one.rows for one in some])
    return like, rows.force, rows.work


def fitted(made: Surrogate, of: Taught, how: Fit, shop: Shop) -> Networks:
    """Return second networks that have learned the share of the way, and work over force."""
    given, force, work = of
    tests = made.tests(given)
    low, high = tests.second_limits
    share = (np.log10(force) - low) / np.maximum(high - low, SECOND_WAY)
    work = np.log10(work / force)
    task = scaled_task(tests.told_of_second, np.column_stack([share, work]))
    begun = [shop.fit(task.task, how, seed=i) for i in range(MEMBERS[made.contact.name])]
    return task.of(together([one.result() for one in begun]))


def measured(made: Surrogate, designs: Sequence[Apart]) -> Surrogate:
    """Return a surrogate with intervals from its errors on the sets, and on fresh designs."""
    fresh = [one for one in designs if len(one.told) >= ENOUGH]
    few = [one for one in designs if len(one.told) < ENOUGH]
    match made.contact.name:
        case "sphere":
            known, test = spheres.parted()
            kept = [*(_stored(made, rows) for rows in spheres.measuring_rows(test)), *fresh]
            # networks have not learned from `deep`, and force has two maxima there
            far = [read(name).chosen(certain(name)) for name in FAR_OFF]
            hard = [_stored(made, joined(far)), _stored(made, read("deep")), *few]
            some = _stored(made, known.chosen(slice(None, None, 2)))
            seeds = (0, 1), (0, 1)
            return trusted(made, some, kept, hard=hard, seeds=seeds)
        case "punch":
            known, measuring = (joined(rows) for rows in punches.parted())
            kept = joined([measuring, punches.faces().chosen(slice(0, None, 2))])
            kept = [_stored(made, kept), *fresh]
            some = _stored(made, known)
            return trusted(made, some, kept, hard=few, least=LEAST)
    part, sharp = solids.parted(solids.table()), datasets.load("sharp")
    return solids.measured(made, part, [solids.read(sharp)], fresh)


def _stored(made: Surrogate, rows: Rows) -> Apart:
    """Return errors on rows of data sets, without those of curves, which they keep at points."""
    return judged(made, rows).without_curves()


def scores_of(made: Surrogate, before: dict[str, Any]) -> dict[str, Any]:
    """Return the scores of a surrogate, in the form of its file, from those before."""
    match made.contact.name:
        case "sphere":
            return before | {"kept apart at random": by_set(made, spheres.parted()[1])}
        case "punch":
            return punches.scores(made)
    return solids.scores(made, solids.parted(solids.table()))


def _labelled(
    cases: list[fresh_cases.Case], labels: Path, accuracy: float = fresh_cases.ACCURACY
) -> list[tuple[fresh_cases.Case, dict[str, Any]]]:
    """Return the cases that have an answer, with their labels."""
    pairs = fresh_cases.labelled(cases, labels, accuracy)
    return [pair for pair in pairs if "failed" not in pair[1]]


def fresh_apart(
    made: Surrogate,
    folder: Path,
    *,
    draw: tuple[int, Mapping[str, int]] = (SEED, fresh_cases.COUNTS),
    answered: bool = False,
    accuracy: float = fresh_cases.ACCURACY,
) -> list[Apart]:
    """Return how far a surrogate is off on the fresh cases of its kind, a set for each design.

    With `answered` only cases count that the surrogate answers.
    """
    kind = {"sphere": "sphere", "solids": "solid", "punch": "punch"}[made.contact.name]
    cases = [c for c in fresh_cases.drawn(*draw) if c.kind == kind]
    if answered:
        tests = made.tests(fresh_cases.given_of(made, cases))
        doubtful = made.doubtful(tests, made.evaluate(tests))[:, 0]
        asked = tests.inside().all(axis=1) & ~doubtful
        cases = [case for case, one in zip(cases, asked, strict=True) if one]
    known = _labelled(cases, folder, accuracy)
    found = []
    for design in dict.fromkeys(case.design for case, _ in known):
        some, labels = zip(*(pair for pair in known if pair[0].design == design), strict=True)
        given = fresh_cases.given_of(made, list(some))
        found.append(fresh_cases.apart(made, given, list(labels)))
    return found


def main() -> None:
    """Fit, measure and write."""
    parser = argparse.ArgumentParser(prog="python -m research.training.second")
    parser.add_argument("contact", choices=tuple(HOW))
    parser.add_argument("--out", type=Path, required=True, help="folder of networks and the file")
    parser.add_argument("--labels", type=Path, required=True, help="folder of the fresh labels")
    parser.add_argument("--intervals", action="store_true", help="keep the second networks")
    chosen = parser.parse_args()
    path = store.FILES[chosen.contact]
    made = store.load(path)
    if not chosen.intervals:
        of = learned(chosen.contact, chosen.labels)
        with Shop(chosen.out / "networks") as shop:
            found = fitted(made, of, HOW[chosen.contact], shop)
        made = made.having(second=found)
    made = measured(made, fresh_apart(made, chosen.labels))
    fresh: dict[str, Any] = {"seed": SEED, "counts": fresh_cases.COUNTS}
    if chosen.contact == "solids":
        some = fresh_apart(made, chosen.labels, draw=LEVELS, answered=True, accuracy=FINE)
        # levels measured on designs that the networks of the reach do not know
        assert made.trust is not None
        trust = untested(made.trust.reach)
        made = replace(made, trust=levelled(trust, [[(trust, one)] for one in some]))
        fresh["levels"] = {"seed": LEVELS[0], "answered": sum(len(one.told) for one in some)}
    sealed = ("form", "sha256", "contact", "power law")
    facts = {name: each for name, each in store.facts(path).items() if name not in sealed}
    facts["scores"] = scores_of(made, facts.get("scores", {}))
    facts["second"] = {"fresh": fresh, "made": __version__}
    chosen.out.mkdir(parents=True, exist_ok=True)
    store.save(made, chosen.out / path.name, facts)
    print(chosen.out / path.name)


if __name__ == "__main__":
    main()
