"""Fresh cases of the surrogates with labels from simulation, drawn from a seed and kept on disk.

`python -m research.training.fresh_cases --seed 41 --labels FOLDER [--counts punches=150]`:
power laws, other solids and punches, even in the logarithms of their ranges, power laws on the
faces of their range, the region in which a pull-off may have two maxima, power laws at light
tension, where the sets that networks learned from are less accurate than their intervals are wide,
three sorts of punches where an adversary found errors, power laws of large Tabor numbers, and
contacts of engineers. Each case is simulated to its pull-off at an accuracy of 5e-4 (of 1e-4 at
light tension) and appended to a file of the folder; a run that was stopped continues. About a third
of a second a case, more at large Tabor numbers.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from viscotack import Groups, InputError, Outcome, Problem, peaks, pull_off, solve, work_to_pull_off
from viscotack.model.materials.random_solids import STRETCHED, creep_spectrum
from viscotack.model.problem.kinds import KINDS
from viscotack.prediction.surrogate import linear_solids, physics, punch_physics, short_range
from viscotack.prediction.surrogate.alike import TIMES
from viscotack.prediction.surrogate.linear_solids import SolidContact
from viscotack.prediction.surrogate.model import Surrogate
from viscotack.result.curve import retraction

from .calibration import Apart
from .contacts import FAMILIES, contact
from .contacts import problem as contact_problem
from .drawing import BOXES
from .scores import errors

ACCURACY = 5e-4
# Numbers of random solids that no data set has; one in eight solids is a stretched exponential.
_SOLIDS, _STRETCHED = (600_000, STRETCHED), 0.125
# Decades beyond the times of a solid within which a test may lie.
_BEYOND = 2.5
# Tabor number, modulus ratio, depth [h0], and rate times retardation time over depth.
TWO_PEAKS = ((0.05, 5.0), (1e-4, 1e-2), (20.0, 500.0), (0.5, 2.0))
# Size, thickness, modulus ratio, stress of the start, and rate times retardation time over depth.
SOFT_PUNCHES = (
    ((1.0, 200.0), (10.0, 1000.0), (1e-3, 0.02), (0.1, 10.0), (0.1, 100.0)),
    ((1.0, 6.0), (100.0, 1000.0), (1e-3, 5e-3), (1.0, 10.0), (0.1, 4.0)),
)
SHALLOW_PUNCHES = (1.0, 4.0), (100.0, 1000.0), (1e-3, 4e-3), (1.5e-3, 0.05), (1.0, 30.0)
WIDE_PUNCHES = (40.0, 200.0), (1.0, 5.0), (0.35, 0.7), (2.0, 10.0), (1.0, 1e4)
Random = np.random.Generator
_DIGITS = 8
# Numbers of cases of each design that measure intervals.
COUNTS = {
    "power laws": 3000,
    "faces": 600,
    "other solids": 1000,
    "punches": 550,
    "two peaks": 300,
    "light tension": 300,
    "soft punches": 400,
    "shallow soft punches": 100,
    "wide punches": 200,
}
# Largest Tabor number of the design of large ones: beyond it a simulation takes minutes.
LARGEST = 20.0
# Accuracy of labels where those of the data sets are biased by as much as intervals are wide.
FINER = {"light tension": 1e-4}


@dataclass(frozen=True)
class Case:
    """A case of a campaign: its design, its kind and its inputs by name."""

    design: str
    kind: str
    inputs: dict[str, float]

    @property
    def problem(self) -> Problem | Groups:
        """The problem, of a contact of an engineer in SI."""
        return contact_problem(self.inputs) if self.kind == "contact" else self.groups

    @property
    def groups(self) -> Groups:
        """The dimensionless problem of a case of a campaign."""
        return KINDS[self.kind].problem(self.inputs)

    @property
    def key(self) -> str:
        """Identifies the case in a file of labels."""
        return json.dumps([self.kind, self.inputs])


def between(random: Random, low: float, high: float) -> float:
    """Return a number that is uniform in its logarithm."""
    return float(f"{low * (high / low) ** random.random():.{_DIGITS}g}")


def power_law(random: Random) -> Case:
    """Draw a sphere on a power law in the range of the surrogate."""
    inputs = {name: between(random, *ends) for name, ends in physics.LIMITS.items()}
    return Case("power laws", "sphere", inputs)


def on_face(random: Random) -> Case:
    """Draw a sphere on a power law with one input at an end of its range."""
    inputs = power_law(random).inputs
    name = physics.INPUTS[int(random.integers(len(physics.INPUTS)))]
    return Case("faces", "sphere", inputs | {name: physics.LIMITS[name][int(random.integers(2))]})


def solid(random: Random) -> Case:
    """Draw a sphere on another solid, its test within or near the times of the solid."""
    low, high = (STRETCHED, 2 * STRETCHED) if random.random() < _STRETCHED else _SOLIDS
    number = int(random.integers(low, high))
    test = {
        name: between(random, *physics.LIMITS[name])
        for name in ("tabor", "modulus_ratio", "preload")
    }
    _, times = creep_spectrum(number, test["modulus_ratio"])
    rate = between(random, 10**-_BEYOND / times[-1], 10**_BEYOND / times[0])
    return Case("other solids", "solid", {**test, "solid": number, "rate": rate})


def punch(random: Random) -> Case:
    """Draw a punch on a layer in the range of the surrogate."""
    drawn = [
        between(random, low, high)
        for low, high in zip(punch_physics.LOW, punch_physics.HIGH, strict=True)
    ]
    row = np.array([drawn])
    drawn[punch_physics.PRELOAD] *= float(punch_physics.compliance(row)[0])
    inputs = dict(zip(punch_physics.INPUTS, drawn, strict=True))
    return Case("punches", "punch", {"cohesion": 0.05, **inputs})


def soft_punch(random: Random) -> Case:
    """Draw a punch on a thick, soft layer, pulled about as fast as it relaxes: half of them deep.

    There an adversary found errors of five half widths of earlier intervals.
    """
    return _on_layer("soft punches", SOFT_PUNCHES[int(random.random() < 0.5)], random)


def shallow_punch(random: Random) -> Case:
    """Draw a narrow punch on a thick, soft layer from a shallow start.

    There an adversary found errors of works.
    """
    return _on_layer("shallow soft punches", SHALLOW_PUNCHES, random)


def wide_punch(random: Random) -> Case:
    """Draw a wide punch on a thin, nearly elastic layer, pulled fast from a deep start.

    There an adversary found errors of five half widths of earlier intervals.
    """
    return _on_layer("wide punches", WIDE_PUNCHES, random)


def _on_layer(design: str, ends: tuple[tuple[float, float], ...], random: Random) -> Case:
    size, thickness, ratio, stress, part = (between(random, *each) for each in ends)
    depth = stress * float(punch_physics.compliance(np.array([[size, thickness]]))[0])
    drawn = (size, thickness, ratio, depth, part * depth)
    inputs = dict(zip(punch_physics.INPUTS, drawn, strict=True))
    return Case(design, "punch", {"cohesion": 0.05, **inputs})


def two_peaks(random: Random) -> Case:
    """Draw a deep pull, about as fast as its bulk relaxes: two in three on standard solids."""
    tabor, ratio, depth, part = (between(random, *ends) for ends in TWO_PEAKS)
    test = {"tabor": tabor, "modulus_ratio": ratio, "preload": depth}
    sort = random.random()
    if sort < 1 / 6:
        sharp = {"exponent": between(random, 0.7, 2.0), "rate": part * depth}
        return Case("two peaks", "sphere", test | sharp)
    number, time = _with_few_times(random, ratio, 1 if sort < 5 / 6 else 4)
    return Case("two peaks", "solid", {**test, "solid": number, "rate": part * depth / time})


def light_tension(random: Random) -> Case:
    """Draw a sphere on a power law with a small Tabor number from a start in light tension."""
    ends = physics.LIMITS | BOXES["box of light tension"]
    inputs = {name: between(random, *ends[name]) for name in physics.INPUTS}
    return Case("light tension", "sphere", inputs)


def large_tabor(random: Random) -> Case:
    """Draw a sphere on a power law with a Tabor number from 10 to ``LARGEST``."""
    ends = zip(physics.INPUTS, short_range.LOW, short_range.HIGH, strict=True)
    inputs = {name: between(random, low, high) for name, low, high in ends}
    inputs["tabor"] = between(random, short_range.LOW[0], LARGEST)
    for name in ("preload", "rate"):
        inputs[name] *= inputs["tabor"]
    return Case("large Tabor numbers", "sphere", inputs)


def of_engineers(family: str, random: Random) -> Case:
    """Draw a contact of engineers."""
    return Case(family, "contact", contact(family, random))


def _with_few_times(random: Random, ratio: float, most: int) -> tuple[int, float]:
    """Return a random solid of few retardation times, and their weighted mean."""
    while True:
        number = int(random.integers(*_SOLIDS))
        weights, times = creep_spectrum(number, ratio)
        if len(times) <= most and (most == 1 or len(times) > 1):
            return number, float(np.exp(weights @ np.log(times)))


# The number of each design in the seed of its draw, and what draws its cases.
DESIGNS: dict[str, tuple[int, Callable[[Random], Case]]] = {
    "power laws": (0, power_law),
    "other solids": (1, solid),
    "punches": (2, punch),
    "two peaks": (3, two_peaks),
    "light tension": (4, light_tension),
    "large Tabor numbers": (5, large_tabor),
    "soft punches": (6, soft_punch),
    "shallow soft punches": (7, shallow_punch),
    "faces": (8, on_face),
    "wide punches": (9, wide_punch),
} | {name: (100 + i, partial(of_engineers, name)) for i, name in enumerate(FAMILIES)}


def drawn(seed: int, counts: Mapping[str, int]) -> list[Case]:
    """Return cases of some designs, in an order whose beginning has its share of each."""
    found: list[tuple[float, Case]] = []
    for name, count in counts.items():
        number, draw = DESIGNS[name]
        random = np.random.default_rng([seed, number])
        found += [((i + 0.5) / count, draw(random)) for i in range(count)]
    return [case for _, case in sorted(found, key=lambda pair: pair[0])]


def label(case: Case, accuracy: float = ACCURACY) -> dict[str, Any]:
    """Return what a simulation has for a case, or why it has nothing.

    Numbers are those of `viscotack.summary`; `travel` [h0] and `tension` are those of all steps
    between zero force, or a start in tension, and the pull-off.
    """
    try:
        result = solve(
            case.problem, accuracy=accuracy, until="pull-off", estimate_error=False, throw=False
        )
        if result.outcome is Outcome.STOPPED:
            return {"failed": result.status}
        found, work = pull_off(result), work_to_pull_off(result)
    except InputError as error:
        return {"failed": str(error)}
    depth, force, _ = retraction(result)
    before = depth >= found.depth
    depth, force = depth[before], force[before]
    zero, first = depth[0], 0
    if force[0] > 0:
        first = int(np.flatnonzero(force > 0)[-1]) + 1
        if first == len(depth):
            return {"failed": "the pull-off follows a compressed step at once"}
        part = force[first - 1] / (force[first - 1] - force[first])
        zero = depth[first - 1] + part * (depth[first] - depth[first - 1])
    return {
        "force": found.force,
        "work": work,
        "peaks": [[peak.force, peak.depth] for peak in peaks(result)],
        "depth": found.depth,
        "to_zero": float(depth[0] - zero),
        "travel": (zero - depth[first:]).round(9).tolist(),
        "tension": (-force[first:]).round(9).tolist(),
    }


def labelled(
    cases: list[Case],
    folder: Path,
    accuracy: float = ACCURACY,
    *,
    missing: bool = True,
    needed: Callable[[Case], bool] = lambda _: True,
) -> Iterator[tuple[Case, dict[str, Any]]]:
    """Iterate over cases with their labels; missing ones are simulated, or skipped.

    Labels of `FINER` designs are at least as accurate as stated there. Each accuracy has a file.
    The label of a case that is not needed is empty.
    """
    folder.mkdir(parents=True, exist_ok=True)
    known: dict[Path, dict[str, Any]] = {}
    for case in cases:
        wanted = min(accuracy, FINER.get(case.design, accuracy))
        path = folder / f"labels-{wanted:g}.jsonl"
        if path not in known:
            known[path] = _stored(path)
        if case.key not in known[path]:
            if not needed(case):
                yield case, {}
                continue
            if not missing:
                continue
            known[path][case.key] = found = label(case, wanted)
            with path.open("a", encoding="utf-8") as file:
                file.write(json.dumps({"key": case.key, "label": found}) + "\n")
        yield case, known[path][case.key]


def _stored(path: Path) -> dict[str, Any]:
    if not path.exists():
        return {}
    entries = map(json.loads, path.read_text(encoding="utf-8").splitlines())
    return {entry["key"]: entry["label"] for entry in entries}


def apart(made: Surrogate, given: Any, labels: list[dict[str, Any]]) -> Apart:
    """Return how far a surrogate is off; of a curve at any simulated step."""
    tests = made.tests(given)
    said = made.evaluate(tests)
    return Apart(tests.told_of_errors(said), errors(said, tests.curves(said), labels))


def given_of(made: Surrogate, cases: list[Case]) -> Any:
    """Return what a surrogate is given for cases of its kind."""
    if made.contact is not SolidContact:
        return np.array([[case.inputs[name] for name in made.contact.inputs] for case in cases])
    tabor, k, depth = (
        np.array([case.inputs[n] for case in cases]) for n in ("tabor", "modulus_ratio", "preload")
    )
    creep = np.array(
        [case.groups.material.creep(TIMES / case.inputs["rate"]) for case in cases], dtype=float
    )
    return linear_solids.like(made, tabor, k, depth, np.clip(creep, k[:, None], 1.0))


def add_draw(parser: argparse.ArgumentParser) -> None:
    """Add the options of a draw."""
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--labels", type=Path, required=True, help="folder of the labels")
    add_counts(parser, COUNTS)
    parser.add_argument("--accuracy", type=float, default=ACCURACY)


def add_counts(parser: argparse.ArgumentParser, usual: Mapping[str, int]) -> None:
    """Add the option of the numbers of cases of each design."""
    parser.add_argument(
        "--counts",
        nargs="+",
        metavar="DESIGN=NUMBER",
        default=[f"{name}={count}" for name, count in usual.items()],
        help=f"cases of {', '.join(DESIGNS)}",
    )


def counts_of(words: Sequence[str]) -> dict[str, int]:
    """Return the numbers of cases of each design from an option."""
    parts = (each.rpartition("=") for each in words)
    return {name: int(count) for name, _, count in parts}


def main() -> None:
    """Simulate what is missing."""
    parser = argparse.ArgumentParser(description=__doc__)
    add_draw(parser)
    given = parser.parse_args()
    cases = drawn(given.seed, counts_of(given.counts))
    failed = 0
    for number, (_, found) in enumerate(labelled(cases, given.labels, given.accuracy), 1):
        failed += "failed" in found
        if number % 50 == 0:
            print(f"{number} of {len(cases)}, {failed} without an answer", flush=True)


if __name__ == "__main__":
    main()
