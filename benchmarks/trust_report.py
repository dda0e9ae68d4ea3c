"""What the rows of `trust.py` say: each figure beside what is asked of it, and the worst cases."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from random_problems import problem

from viscotack import Apart, AtDepth, AtForce, Groups, Sphere

Row = dict[str, Any]
# What another processor may change, beside the stated error; what theory leaves to round-off.
SHARE, ROUND_OFF = 0.1, 1e-9
LARGEST_RESIDUAL = 1e-3
# Beyond so many times the asked accuracy an answer is none.
UNRESOLVED = 10.0
# A pull-off force is that of the start where the test began past the minimum.
PAST = 0.999
LISTED = 15


@dataclass(frozen=True)
class Run:
    """A file of rows: how its problems were asked, and how each ended."""

    name: str
    head: Mapping[str, Any]
    rows: Mapping[int, Row]

    @property
    def answered(self) -> dict[int, Row]:
        """The rows that have an answer."""
        return {number: row for number, row in self.rows.items() if row["end"] == "answered"}


@dataclass(frozen=True)
class Figure:
    """What was found, what is asked, and the cases that fall short: the worst has the largest."""

    name: str
    found: str
    asked: str = ""
    short: tuple[tuple[float, int, str], ...] = ()


def read(file: Path) -> Run:
    head, *rows = (json.loads(line) for line in file.read_text().splitlines())
    return Run(file.stem, head, {row["number"]: row for row in sorted(rows, key=_number)})


def _number(row: Row) -> int:
    return row["number"]


def report(files: Iterable[Path]) -> None:
    """Print the figures of runs; the first is the one that the others are held against."""
    first, *others = map(read, files)
    figures = [*ends(first), *bounds(first), energy(first), *estimates(first)]
    for other in others:
        finer = other.head["accuracy"] < first.head["accuracy"]
        figures += coverage(first, other) if finer else same(first, other)
    for run in (first, *others):
        kernels = sorted({row["kernels"] for row in run.rows.values() if "kernels" in row})
        print(
            f"{run.name}: {len(run.rows)} problems of seed {run.head['seed']} at accuracy "
            f"{run.head['accuracy']:g}, package {run.head['source']}, kernels {'; '.join(kernels)}"
        )
    for figure in figures:
        asked = f"asked: {figure.asked}" if figure.asked else ""
        print(f"{figure.name:<62}{figure.found:>24}  {asked}".rstrip())
    for figure in figures:
        if figure.short:
            print(f"\n{figure.name}: {len(figure.short)}")
        for _, number, words in sorted(figure.short, reverse=True)[:LISTED]:
            print(f"  {number:4d} {words}: {first.rows[number]['case']}")


def ends(run: Run) -> list[Figure]:
    """Return how many were answered, why others were not, and what it took."""
    counts = Counter(row["end"] for row in run.rows.values())
    left = len(run.rows) - counts["answered"]
    short = tuple(
        (row.get("seconds", np.inf), number, f"{row['end']}, {_reason(row['status'])}")
        for number, row in run.rows.items()
        if row["end"] != "answered"
    )
    figures = [
        Figure("answered", _of(counts["answered"], len(run.rows))),
        Figure("not answered", _of(left, len(run.rows)), "at most 2 %", short),
    ]
    reasons = Counter(
        f"{row['end']}: {_reason(row['status'], numbers=False)}"
        for row in run.rows.values()
        if row["end"] != "answered"
    )
    figures += [Figure(f"  {reason[:58]}", str(n)) for reason, n in reasons.most_common()]
    seconds = [row["seconds"] for row in run.answered.values()]
    median, most = np.median(seconds), np.quantile(seconds, 0.99)
    return [
        *figures,
        Figure("processor time: median, 99 % below", f"{median:.2f} s, {most:.1f} s"),
    ]


def _reason(status: str, *, numbers: bool = True) -> str:
    words = status.splitlines()[0][:150]
    return words if numbers else re.sub(r"-?\d[\d.]*(e[-+]?\d+)?", "#", words)


def _of(part: int, whole: int) -> str:
    return f"{part} of {whole}, {100 * part / max(whole, 1):.1f} %"


@lru_cache(maxsize=2000)
def _problem(seed: int, number: int) -> Any:
    return problem(seed, number)


def bounds(run: Run) -> list[Figure]:
    """Return how many forces lie where theory allows no force, by more than their stated error.

    An elastic sphere that starts in contact, before its force minimum, has 1 to 4/3 in units of
    JKR's force; a viscoelastic one that is pulled from a relaxed contact at most (4/3)/k. That it
    has at least 1 is what simulations show, and no theorem.
    """
    figures = []
    for name, asked, kind, low, high in (
        ("elastic spheres outside 1 to 4/3", "0", _elastic, 1.0, 4 / 3),
        ("relaxed viscoelastic spheres above (4/3)/k", "0", _relaxed, 0.0, 4 / 3),
        ("relaxed viscoelastic spheres below 1 (no theorem)", "", _relaxed, 1.0, np.inf),
    ):
        short, whole = [], 0
        for number, row in run.answered.items():
            groups = _problem(run.head["seed"], number)
            if row["force"] is None or not kind(groups, row):
                continue
            whole += 1
            force, error = row["force"], _stated(row, "force", run)
            outside = max(low * (1 - error) / force, force * groups.modulus_ratio / high - error)
            if outside > 1 + ROUND_OFF:
                short.append((outside, number, f"force {force:.5g}, stated error {error:.1g}"))
        figures.append(Figure(name, _of(len(short), whole), asked, tuple(short)))
    return figures


def _elastic(groups: Any, row: Row) -> bool:
    return (
        isinstance(groups, Groups)
        and isinstance(groups.geometry, Sphere)
        and groups.modulus_ratio == 1
        and groups.rate is not None
        and _before_minimum(groups, row)
    )


def _relaxed(groups: Any, row: Row) -> bool:
    return (
        isinstance(groups, Groups)
        and isinstance(groups.geometry, Sphere)
        and groups.modulus_ratio < 1
        and not groups.moves
        and _before_minimum(groups, row)
    )


def _before_minimum(groups: Groups, row: Row) -> bool:
    """Return whether a contact is there at the start, and pulls no harder later by having begun."""
    start = groups.start
    pressed = isinstance(start, AtForce) or (isinstance(start, AtDepth) and start.depth >= 0)
    return pressed or (not isinstance(start, Apart) and row["start_force"] > -PAST * row["force"])


def _stated(row: Row, name: str, run: Run) -> float:
    return row["estimate"].get(name, run.head["accuracy"])


def energy(run: Run) -> Figure:
    short = tuple(
        (row["residual"], number, f"residual {row['residual']:.1e}")
        for number, row in run.answered.items()
        if row["residual"] > LARGEST_RESIDUAL
    )
    return Figure("energy residual above 1e-3", _of(len(short), len(run.answered)), "0", short)


def estimates(run: Run) -> list[Figure]:
    """Return how many answers say that they are worse than asked, and worse than an answer is."""
    accuracy = run.head["accuracy"]
    said = {n: row["estimate"].get("force", 0.0) for n, row in run.answered.items()}
    beyond = sum(error > accuracy for error in said.values())
    short = tuple(
        (error, number, f"stated error {error:.2g}")
        for number, error in said.items()
        if error > UNRESOLVED * accuracy
    )
    return [
        Figure("estimate above the asked accuracy", _of(beyond, len(said))),
        Figure("answered with more than ten times it", _of(len(short), len(said)), "0", short),
    ]


def same(run: Run, other: Run) -> list[Figure]:
    """Return whether outcomes, events and forces are those of another processor, or of noise."""
    both = [number for number in run.rows if number in other.rows]
    otherwise, off, compared = [], [], 0
    for number in both:
        was, now = run.rows[number], other.rows[number]
        changed = [n for n in ("end", "outcome", "events") if was.get(n) != now.get(n)]
        if changed:
            said = "; ".join(f"{n} {was.get(n)!r}, {now.get(n)!r}" for n in changed)
            otherwise.append((float(len(changed)), number, said))
        forces = was.get("force"), now.get("force")
        if None in forces:
            continue
        compared += 1
        share = abs(forces[1] / forces[0] - 1) / _stated(was, "force", run)
        if share > SHARE:
            off.append((share, number, f"force {forces[0]:.6g}, {forces[1]:.6g}"))
    equal = _of(len(both) - len(otherwise), len(both))
    asked = "all" if other.head["noise"] else "99.5 %"
    return [
        Figure(f"{other.name}: outcome and events equal", equal, "all", tuple(otherwise)),
        Figure(
            f"{other.name}: force within a tenth of its stated error",
            _of(compared - len(off), compared),
            asked,
            tuple(off),
        ),
    ]


def coverage(run: Run, finer: Run) -> list[Figure]:
    """Return how often stated errors cover the true ones, and by how much they exceed them."""
    figures = []
    for name, asked, most in (("force", "95 %", "below 5"), ("work", "95 %", "")):
        short, ratios = [], []
        for number, row in run.answered.items():
            best = finer.answered.get(number, {}).get(name)
            stated = row["estimate"].get(name)
            if best is None or stated is None or row[name] is None:
                continue
            error = abs(row[name] - best) / max(abs(row[name]), abs(best), np.finfo(float).tiny)
            ratios.append(stated / max(error, np.finfo(float).tiny))
            if error > stated:
                said = f"{row[name]:.6g}, finer {best:.6g}, stated error {stated:.1g}"
                short.append((error / stated, number, said))
        covered = _of(len(ratios) - len(short), len(ratios))
        ratio = f"{np.median(ratios):.2f}" if ratios else "none"
        figures += [
            Figure(f"error of the {name} covered by the stated one", covered, asked, tuple(short)),
            Figure(f"stated over true error of the {name}, median", ratio, most),
        ]
    return figures
