"""Fresh cases of the surrogates with labels from simulation, drawn from a seed and kept on disk.

Power laws, other solids and punches, even in the logarithms of their ranges, power laws on the
faces of their range, the region in which a pull-off may have two maxima, power laws at light
tension, where the sets that networks learned from are less accurate than their intervals are wide,
three sorts of punches where an adversary found errors, power laws of large Tabor numbers, and
contacts of engineers. Each case is simulated to its pull-off at an accuracy of 5e-4 (of 1e-4 at
light tension) and appended to a file of the folder; a run that was stopped continues. About a third
of a second a case, more at large Tabor numbers.
"""

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
from viscotack.model.problem.rows import KINDS
from viscotack.prediction.surrogate import linear_solids, physics, punch_physics, short_range
from viscotack.prediction.surrogate.linear_solids import TIMES, SolidContact
from viscotack.prediction.surrogate.model import Surrogate
from viscotack.result.curve import retraction

from .calibration import Apart
from .contacts import FAMILIES, contact
from .contacts import problem as contact_problem
from .scores import errors

Random = np.random.Generator
Ends = Sequence[tuple[float, float]]
# Kind and inputs of a case.
Drawn = tuple[str, dict[str, float]]

ACCURACY = 5e-4
# Accuracy of labels where those of the data sets are biased by as much as intervals are wide.
FINER = {"light tension": 1e-4}
_DIGITS = 8
# Numbers of random solids that no data set has; one in eight solids is a stretched exponential.
_SOLIDS, _STRETCHED = (600_000, STRETCHED), 0.125
# Decades beyond the times of a solid within which a test may lie.
_BEYOND = 2.5
# Tabor number, modulus ratio, depth [h0], and rate times retardation time over depth.
TWO_PEAKS = ((0.05, 5.0), (1e-4, 1e-2), (20.0, 500.0), (0.5, 2.0))
# Where intervals of an earlier surrogate held least.
LIGHT_TENSION = {"tabor": (0.017, 0.074), "modulus_ratio": (7e-4, 0.3), "preload": (0.035, 0.21)}
# Largest Tabor number of the design of large ones: beyond it a simulation takes minutes.
LARGEST = 20.0
# Where an adversary found errors of five half widths of earlier intervals, and of works: size,
# thickness, modulus ratio, stress of the start, and rate times retardation time over depth.
_PUNCHES: dict[str, tuple[int, tuple[Ends, ...]]] = {
    "soft punches": (
        6,
        (
            ((1.0, 200.0), (10.0, 1000.0), (1e-3, 0.02), (0.1, 10.0), (0.1, 100.0)),
            ((1.0, 6.0), (100.0, 1000.0), (1e-3, 5e-3), (1.0, 10.0), (0.1, 4.0)),
        ),
    ),
    "shallow soft punches": (
        7,
        (((1.0, 4.0), (100.0, 1000.0), (1e-3, 4e-3), (1.5e-3, 0.05), (1.0, 30.0)),),
    ),
    "wide punches": (
        9,
        (((40.0, 200.0), (1.0, 5.0), (0.35, 0.7), (2.0, 10.0), (1.0, 1e4)),),
    ),
}
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


def _sphere(limits: Mapping[str, tuple[float, float]], random: Random) -> Drawn:
    """Draw a sphere on a power law in the range of the surrogate, or in a part of it."""
    ends = {**physics.LIMITS, **limits}
    return "sphere", {name: between(random, *ends[name]) for name in physics.INPUTS}


def _on_face(random: Random) -> Drawn:
    """Draw a sphere on a power law with one input at an end of its range."""
    kind, inputs = _sphere({}, random)
    name = physics.INPUTS[int(random.integers(len(physics.INPUTS)))]
    return kind, inputs | {name: physics.LIMITS[name][int(random.integers(2))]}


def _large_tabor(random: Random) -> Drawn:
    """Draw a sphere on a power law with a Tabor number from 10 to ``LARGEST``."""
    ends = zip(physics.INPUTS, short_range.LOW, short_range.HIGH, strict=True)
    inputs = {name: between(random, low, high) for name, low, high in ends}
    inputs["tabor"] = between(random, short_range.LOW[0], LARGEST)
    for name in ("preload", "rate"):
        inputs[name] *= inputs["tabor"]
    return "sphere", inputs


def _solid(random: Random) -> Drawn:
    """Draw a sphere on another solid, its test within or near the times of the solid."""
    low, high = (STRETCHED, 2 * STRETCHED) if random.random() < _STRETCHED else _SOLIDS
    number = int(random.integers(low, high))
    names = ("tabor", "modulus_ratio", "preload")
    test = {name: between(random, *physics.LIMITS[name]) for name in names}
    _, times = creep_spectrum(number, test["modulus_ratio"])
    rate = between(random, 10**-_BEYOND / times[-1], 10**_BEYOND / times[0])
    return "solid", {**test, "solid": number, "rate": rate}


def _two_peaks(random: Random) -> Drawn:
    """Draw a deep pull, about as fast as its bulk relaxes: two in three on standard solids."""
    tabor, ratio, depth, part = (between(random, *ends) for ends in TWO_PEAKS)
    test = {"tabor": tabor, "modulus_ratio": ratio, "preload": depth}
    sort = random.random()
    if sort < 1 / 6:
        return "sphere", test | {"exponent": between(random, 0.7, 2.0), "rate": part * depth}
    few = sort >= 5 / 6
    while True:
        number = int(random.integers(*_SOLIDS))
        weights, times = creep_spectrum(number, ratio)
        if 1 < len(times) <= 4 if few else len(times) == 1:
            break
    time = float(np.exp(weights @ np.log(times)))
    return "solid", {**test, "solid": number, "rate": part * depth / time}


def _on_layer(inputs: Sequence[float]) -> Drawn:
    """Return a punch whose start is told by its stress."""
    given = list(inputs)
    given[punch_physics.PRELOAD] *= float(punch_physics.compliance(np.array([given]))[0])
    return "punch", {"cohesion": 0.05, **dict(zip(punch_physics.INPUTS, given, strict=True))}


def _punch(random: Random) -> Drawn:
    """Draw a punch on a layer in the range of the surrogate."""
    ends = zip(punch_physics.LOW, punch_physics.HIGH, strict=True)
    return _on_layer([between(random, low, high) for low, high in ends])


def _hard_punch(ranges: Sequence[Ends], random: Random) -> Drawn:
    """Draw a punch from ranges, of two from the latter in half of the draws."""
    ends = ranges[int(random.random() < 0.5)] if len(ranges) == 2 else ranges[0]
    *inputs, part = (between(random, *each) for each in ends)
    kind, found = _on_layer([*inputs, part])
    return kind, found | {"rate": part * found["preload"]}


# The number of each design in the seed of its draw, and what draws kind and inputs of its cases.
DESIGNS: dict[str, tuple[int, Callable[[Random], Drawn]]] = {
    "power laws": (0, partial(_sphere, {})),
    "other solids": (1, _solid),
    "punches": (2, _punch),
    "two peaks": (3, _two_peaks),
    "light tension": (4, partial(_sphere, LIGHT_TENSION)),
    "large Tabor numbers": (5, _large_tabor),
    "faces": (8, _on_face),
}
DESIGNS |= {name: (i, partial(_hard_punch, ends)) for name, (i, ends) in _PUNCHES.items()}
DESIGNS |= {
    name: (100 + i, partial(lambda family, random: ("contact", contact(family, random)), name))
    for i, name in enumerate(FAMILIES)
}


def drawn(seed: int, counts: Mapping[str, int]) -> list[Case]:
    """Return cases of some designs, in an order whose beginning has its share of each."""
    found: list[tuple[float, Case]] = []
    for name, count in counts.items():
        number, draw = DESIGNS[name]
        random = np.random.default_rng([seed, number])
        found += [((i + 0.5) / count, Case(name, *draw(random))) for i in range(count)]
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
    cases: list[Case], folder: Path, accuracy: float = ACCURACY
) -> Iterator[tuple[Case, dict[str, Any]]]:
    """Iterate over cases with their labels; missing ones are simulated.

    Labels of `FINER` designs are at least as accurate as stated there. Each accuracy has a file.
    """
    folder.mkdir(parents=True, exist_ok=True)
    known: dict[Path, dict[str, Any]] = {}
    for case in cases:
        wanted = min(accuracy, FINER.get(case.design, accuracy))
        path = folder / f"labels-{wanted:g}.jsonl"
        if path not in known:
            known[path] = _stored(path)
        if case.key not in known[path]:
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
    parser.add_argument(
        "--counts",
        nargs="+",
        metavar="DESIGN=NUMBER",
        default=[f"{name}={count}" for name, count in COUNTS.items()],
        help=f"cases of {', '.join(DESIGNS)}",
    )
    parser.add_argument("--accuracy", type=float, default=ACCURACY)


def counts_of(words: Sequence[str]) -> dict[str, int]:
    """Return the numbers of cases of each design from an option."""
    parts = (each.rpartition("=") for each in words)
    return {name: int(count) for name, _, count in parts}
