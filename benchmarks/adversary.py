"""An adversary that looks for the worst violation of an interval; simulation is the judge.

`python -m benchmarks.adversary [--cases 120] [--seed 1] [--out FILE.jsonl] [--punch]`: an evolution
over the whole range of the five inputs of a sphere, or of a punch on a layer. It begins with the
cases of the sets that lie furthest out of their intervals, and with some at random; each round it
varies those that were worst, simulates the new ones at an accuracy of 2e-4, and keeps what is
worse, in half widths of the 90 % interval of force or work, whichever is larger. A simulation
counts as far as it knows itself: its stated error is taken off. One or two seconds a case; with
--out it goes on where it was stopped.

`python -m benchmarks.adversary --by disagreement --labels FOLDER [--cases 40] [--seed 1]
[--designs punches ...]`: of 4,000 drawn cases of each design of `training/fresh_cases.py`, it
simulates those that surrogates answer and in which the second networks differ most, in half widths
of the interval of force or work. `--by rows --labels FOLDER [--cases 20]`: of all rows of the sets
of other solids, those of whose force or work the surrogate differs most, and a simulation at 2e-4
decides whether it or the row is off. With --write numbers of cases and the worst go into the
record `adversary`; docs/surrogate.md has a table of the worst cases.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np

from training import train_punch as punches
from training import train_solids as solids
from training.calibration import given_of as given_numbers
from training.fresh_cases import COUNTS, Case, drawn, given_of, labelled
from training.rows import LEARNED, Rows, joined, read
from viscotack import Groups, solve, summary
from viscotack.campaign.columns import KINDS
from viscotack.surrogate import physics, punch_physics, store
from viscotack.surrogate.model import Surrogate

from .fresh_coverage import judged
from .judging import words, worst

# Cases that are varied at a time, how far the first variations reach in halves of the range, and by
# what they shrink each round.
_KEPT, _REACH, _SHRINK = 6, 0.15, 0.9
# Cases of each design among which those with the largest disagreement are sought.
_DRAWN = 4000


class OfSphere:
    """What is searched of a sphere."""

    inputs, low, high = physics.INPUTS, np.log10(physics.LOW), np.log10(physics.HIGH)
    force = "pull_off_force"

    @staticmethod
    def learned() -> Surrogate:
        """Return what is to be caught."""
        return store.shipped()

    @staticmethod
    def row(place: np.ndarray) -> np.ndarray:
        """Return the inputs at a place of the range."""
        return 10**place

    @staticmethod
    def place(row: np.ndarray) -> np.ndarray:
        """Return where in the range inputs are."""
        return np.log10(row)

    @staticmethod
    def rows() -> Rows:
        """Return what is known beforehand."""
        return read(*LEARNED)

    @classmethod
    def problem(cls, row: np.ndarray) -> Groups:
        """Return the problem of inputs."""
        return KINDS["sphere"].problem(dict(zip(cls.inputs, row.tolist(), strict=True)))


class OfPunch:
    """What is searched of a punch: the stress of its start in place of its depth."""

    inputs = punch_physics.INPUTS
    low, high = np.log10(punch_physics.LOW), np.log10(punch_physics.HIGH)
    force = "pull_off_stress"

    @staticmethod
    def learned() -> Surrogate:
        """Return what is to be caught."""
        return store.shipped("punch")

    @staticmethod
    def row(place: np.ndarray) -> np.ndarray:
        """Return the inputs at a place of the range."""
        found = 10**place
        found[punch_physics.PRELOAD] *= punch_physics.compliance(found[None])[0]
        return found

    @staticmethod
    def place(row: np.ndarray) -> np.ndarray:
        """Return where in the range inputs are."""
        return np.log10(row / punch_physics.unit(row[None])[0])

    @staticmethod
    def rows() -> Rows:
        """Return what is known beforehand."""
        return joined([punches.read(name) for name in punches.LEARNED])

    @classmethod
    def problem(cls, row: np.ndarray) -> Groups:
        """Return the problem of inputs."""
        stated = dict(zip(cls.inputs, row.tolist(), strict=True))
        return KINDS["punch"].problem({"cohesion": 0.05, **stated})


Of = type[OfSphere] | type[OfPunch]


def violation(
    of: Of, row: np.ndarray, true: tuple[float, float], stated: tuple[float, float]
) -> float:
    """Return how many half widths the worse of force and work is off, less their stated errors.

    Numbers that the surrogate withholds count as 0.
    """
    said = of.learned().evaluate(row[None])
    held = of.learned().intervals(row[None], said)
    given = ~of.learned().doubtful(row[None], said)[0]
    found = []
    for value, pair, known, error in zip(
        (said.pull_off_force, said.work_to_pull_off),
        (held.pull_off_force, held.work_to_pull_off),
        true,
        stated,
        strict=True,
    ):
        half = np.log(pair[0, 1] / value[0])
        found.append(max(abs(np.log(value[0] / known)) - error, 0.0) / half)
    return float(max(given * found))


def simulated(of: Of, row: np.ndarray) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """Return force and work of a case and their stated errors; None where there is no answer."""
    result = solve(of.problem(row), accuracy=2e-4, until="pull-off", throw=False)
    error, said = result.error_estimate, summary(result)
    numbers = said[of.force], said["work_to_pull_off"]
    if error is None or "work" not in error or None in numbers:
        return None
    return numbers, (error["force"], error["work"])


def worst_known(of: Of, count: int) -> list[list[float]]:
    """Return the cases of the sets that lie furthest out of their intervals."""
    rows = of.rows()
    said = of.learned().evaluate(rows.groups)
    held = of.learned().intervals(rows.groups, said)
    off = np.abs(np.log(said.pull_off_force / rows.force))
    off /= np.log(held.pull_off_force[:, 1] / said.pull_off_force)
    off[of.learned().doubtful(rows.groups, said)[:, 0]] = 0.0
    return rows.groups[np.argsort(-off)[:count]].tolist()


def suspects(design: str, count: int, seed: int) -> list[Case]:
    """Return the answered cases of a design in which the second networks differ most."""
    counts = {design: _DRAWN}
    found: list[tuple[float, Case]] = []
    for contact, kind in (("sphere", "sphere"), ("solids", "solid"), ("punch", "punch")):
        cases = [case for case in drawn(seed, counts) if case.kind == kind]
        if not cases:
            continue
        made = store.shipped(contact)
        tests = made.tests(given_of(made, cases))
        said = made.evaluate(tests)
        held = made.intervals(tests, said)
        apart = []
        for value, pair, other in zip(
            (said.pull_off_force, said.work_to_pull_off),
            (held.pull_off_force, held.work_to_pull_off),
            tests.second,
            strict=True,
        ):
            apart.append(np.abs(other - np.log10(value)) / np.log10(pair[:, 1] / value))
        inside = np.asarray(tests.inside().all(axis=1))
        given = ~made.doubtful(tests, said) & inside[:, None]
        worst = np.where(given, np.array(apart).T, 0.0).max(axis=1)
        found += zip(worst.tolist(), cases, strict=True)
    return [case for _, case in sorted(found, key=lambda pair: -pair[0])[:count]]


def furthest_rows(count: int) -> list[Case]:
    """Return the rows of other solids whose force or work differs most from that given."""
    made, tests = store.shipped("solids"), solids.read(solids.table())
    apart = solids.judged(made, tests)
    given = given_numbers(made.trust, apart)[:, :2]
    off = np.where(given, 10 ** np.abs(apart.error[:, :2]) - 1, 0.0).max(axis=1)
    order = np.argsort(-off)[:count]
    names = [name for name in physics.INPUTS if name != "exponent"]
    places = [physics.INPUTS.index(name) for name in names]
    rows = np.column_stack([tests.rows.groups[:, places], tests.number])[order]
    inputs = [dict(zip([*names, "solid"], row, strict=True)) for row in rows.tolist()]
    cases = [Case("rows", "solid", one | {"solid": int(one["solid"])}) for one in inputs]
    print(f"{len(tests)} rows; furthest: {', '.join(f'{x:.1%}' for x in off[order])}")
    return cases


def simulated_suspects(some: dict[str, list[Case]], labels: Path) -> dict[str, dict[str, float]]:
    """Simulate the suspects of each design, print the worst, and return what to record."""
    found, said = [], {}
    for design, cases in some.items():
        known = labelled(cases, labels, 2e-4)
        some = [judged(case, label) for case, label in known if "failed" not in label]
        found += some
        off = np.array([np.nanmax(one.ratio[:2], initial=0.0) for one in some])
        print(
            f"{design}: {len(some)} simulated; {np.mean(off > 1):.0%} beyond their "
            f"interval; worst {off.max():.1f} half widths",
            flush=True,
        )
        said[f"suspects-{design.replace(' ', '-')}"] = {
            "cases": len(some),
            "worst": float(off.max()),
        }
    for one in worst(found, max(len(found) // 4, 5)):
        print(words(one))
    return said


def main() -> None:
    """Search and print what was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=120)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--punch", action="store_true", help="of a punch on a layer")
    parser.add_argument("--by", choices=("evolution", "disagreement", "rows"), default="evolution")
    parser.add_argument("--labels", type=Path, help="folder of the labels of disagreement")
    parser.add_argument("--write", action="store_true", help="into the records")
    parser.add_argument("--designs", nargs="+", choices=tuple(COUNTS), default=list(COUNTS))
    given = parser.parse_args()
    if given.by != "evolution":
        if given.labels is None:
            parser.error(f"--by {given.by} needs --labels")
        if given.by == "rows":
            some = {"rows": furthest_rows(given.cases)}
        else:
            some = {name: suspects(name, given.cases, given.seed) for name in given.designs}
        said = simulated_suspects(some, given.labels)
        if given.write:
            print(json.dumps(said, indent=1))
        return
    of: Of = OfPunch if given.punch else OfSphere
    random = np.random.default_rng(given.seed)
    done: list[tuple[float, list[float]]] = []
    if given.out is not None and given.out.exists():
        done = [tuple(json.loads(line)) for line in given.out.read_text().splitlines()]
    beginning = [np.array(row) for row in worst_known(of, _KEPT)]
    beginning += [of.row(of.low + u * (of.high - of.low)) for u in random.random((_KEPT, 5))]
    while len(done) < given.cases:
        number = len(done)
        if number < len(beginning):
            row = beginning[number]
        else:
            best = sorted(done, reverse=True)[:_KEPT]
            reach = _REACH * _SHRINK ** (number / _KEPT) + 0.01
            parent = of.place(np.array(best[number % len(best)][1]))
            step = reach * random.standard_t(3, 5) * (of.high - of.low) / 2
            row = of.row(np.clip(parent + step, of.low, of.high))
        found = simulated(of, row)
        done.append((-1.0 if found is None else violation(of, row, *found), row.tolist()))
        if given.out is not None:
            with given.out.open("a") as file:
                file.write(json.dumps(done[-1]) + "\n")
    off = np.array([each for each, _ in done if each >= 0])
    print(f"{len(off)} simulated; {np.mean(off > 1):.0%} beyond their interval")
    if given.write:
        name = "punch" if given.punch else "sphere"
        print(json.dumps({name: {"cases": len(off), "worst": float(off.max())}}, indent=1))
    print("worst, half widths, and its case:")
    for each, row in sorted(done, reverse=True)[:5]:
        words = ", ".join(f"{n} {x:.4g}" for n, x in zip(of.inputs, row, strict=True))
        print(f"  {each:.2f}  {words}")


if __name__ == "__main__":
    main()
