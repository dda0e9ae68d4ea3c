"""What the rows of `trust.py` say: each figure beside what is asked of it, and the worst cases."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from random_problems import problem

from viscotack import Apart, AtDepth, AtForce, Groups, HalfSpace, Sphere

Row = dict[str, Any]
# What another processor may change, beside the stated error; what theory leaves to round-off.
SHARE, ROUND_OFF = 0.1, 1e-9
LARGEST_RESIDUAL = 1e-3
# Beyond so many times the asked accuracy an answer is none.
UNRESOLVED = 10.0
# A test that began past the minimum has its largest pull at its start.
PAST = 0.999
TINY = float(np.finfo(float).tiny)
LISTED = 15


@dataclass(frozen=True)
class Run:
    """A file of rows: how its problems were asked, and how each ended."""

    name: str
    head: Mapping[str, Any]
    rows: Mapping[int, Row]

    @property
    def answered(self) -> dict[int, Row]:
        """The rows that have an answer, by number."""
        return {number: row for number, row in self.rows.items() if row["end"] == "answered"}

    def problem(self, number: int) -> Any:
        """Return what was asked."""
        return _problem(self.head["seed"], number, self.head.get("films", False))

    def stated(self, row: Row, name: str = "force") -> float:
        """Return the relative error that an answer states."""
        return row["estimate"].get(name, self.head["accuracy"])


@dataclass(frozen=True)
class Miss:
    """A case that falls short, and how far beyond the others."""

    number: int
    size: float
    words: str


@dataclass(frozen=True)
class Figure:
    """What was found beside what is asked of it, and the cases that fall short."""

    name: str
    found: str
    asked: str = ""
    met: bool = True
    misses: tuple[Miss, ...] = ()


def share(name: str, misses: Iterable[Miss], whole: int, most: float | None = 0.0) -> Figure:
    """Return how many of all fall short, where this part of them may."""
    missed = tuple(misses)
    found = f"{len(missed)} of {whole}, {100 * len(missed) / max(whole, 1):.1f} %"
    asked = "" if most is None else f"at most {100 * most:g} %" if most else "none"
    return Figure(name, found, asked, most is None or len(missed) <= most * whole, missed)


def read(file: Path) -> Run:
    head, *rows = (json.loads(line) for line in file.read_text().splitlines())
    return Run(file.stem, head, {row["number"]: row for row in rows})


def report(files: Iterable[Path]) -> None:
    """Print the figures of runs; the first is the one that the others are held against."""
    first, *others = map(read, files)
    figures = [*ends(first), *bounds(first), *estimates(first)]
    for other in others:
        finer = other.head["accuracy"] < first.head["accuracy"]
        figures += coverage(first, other) if finer else sameness(first, other)
    for run in (first, *others):
        kernels = sorted({row["kernels"] for row in run.rows.values() if "kernels" in row})
        print(
            f"{run.name}: {len(run.rows)} problems of seed {run.head['seed']} at accuracy "
            f"{run.head['accuracy']:g}, package {run.head['source']}, kernels {'; '.join(kernels)}"
        )
    for figure in figures:
        asked = f"asked: {figure.asked}" if figure.asked else ""
        missed = "" if figure.met else " - MISSED"
        print(f"{figure.name:<60}{figure.found:>22}  {asked}{missed}".rstrip())
    for figure in figures:
        if figure.misses:
            print(f"\n{figure.name}: {figure.found}")
        for miss in sorted(figure.misses, key=lambda miss: -miss.size)[:LISTED]:
            print(f"  {miss.number:4d} {miss.words}: {first.rows[miss.number]['case']}")


def ends(run: Run) -> Iterator[Figure]:
    """Yield how many have no answer, for what reasons, and what the others took."""
    without = {n: row for n, row in run.rows.items() if row["end"] != "answered"}
    yield share(
        "without an answer",
        (Miss(n, 0, f"{r['end']}, {_reason(r)}") for n, r in without.items()),
        len(run.rows),
        0.02,
    )
    reasons = Counter(
        f"{r['end']}: {re.sub(r'-?[0-9][0-9.]*(e[-+]?[0-9]+)?', '#', _reason(r))}"
        for r in without.values()
    )
    for reason, number in reasons.most_common():
        yield Figure(f"  {reason[:70]}", str(number))
    rows = run.answered.items()
    high = [(n, row["residual"]) for n, row in rows if row["residual"] > LARGEST_RESIDUAL]
    lost = (Miss(n, residual, f"residual {residual:.1e}") for n, residual in high)
    yield share("energy residual above 1e-3", lost, len(rows))
    seconds = [row["seconds"] for _, row in rows] or [np.nan]
    median, most = np.median(seconds), np.quantile(seconds, 0.99)
    yield Figure("processor time: median, 99 % below", f"{median:.2f} s, {most:.1f} s")


def _reason(row: Row) -> str:
    return row["status"].splitlines()[0][:150]


def bounds(run: Run) -> Iterator[Figure]:
    """Yield how many forces lie where theory allows none, by more than their stated error.

    An elastic sphere that starts in contact, before its force minimum, has 1 to 4/3 in units of
    JKR's force; a viscoelastic one that is pulled from a relaxed contact at most (4/3)/k. That it
    has at least 1 is what simulations show, and no theorem.
    """
    yield _outside("elastic spheres outside 1 to 4/3", run, _elastic, 1.0, 4 / 3)
    yield _outside("relaxed viscoelastic spheres above (4/3)/k", run, _relaxed, 0.0, 4 / 3)
    yield _outside("  below 1, no theorem", run, _relaxed, 1.0, np.inf, most=None)


def _outside(
    name: str,
    run: Run,
    held: Callable[[Groups, Row], bool],
    low: float,
    high: float,
    most: float | None = 0.0,
) -> Figure:
    """Return how many of the spheres that are held to them miss two bounds, the upper over k."""
    misses, whole = [], 0
    for number, row in run.answered.items():
        groups = run.problem(number)
        sphere = isinstance(groups.geometry, Sphere) and isinstance(groups.body, HalfSpace)
        if not sphere or row["force"] is None or not held(groups, row):
            continue
        whole += 1
        force, error = row["force"], run.stated(row)
        beyond = max(low / force, force * groups.modulus_ratio / high)
        if beyond > 1 + error + ROUND_OFF:
            misses.append(Miss(number, beyond, f"force {force:.5g}, stated error {error:.1g}"))
    return share(name, misses, whole, most)


def _elastic(groups: Groups, row: Row) -> bool:
    whole = groups.modulus_ratio == 1 and groups.rate is not None
    return whole and _before_minimum(groups, row)


def _relaxed(groups: Groups, row: Row) -> bool:
    return groups.modulus_ratio < 1 and not groups.moves and _before_minimum(groups, row)


def _before_minimum(groups: Groups, row: Row) -> bool:
    """Return whether a test begins in contact, with its largest pull still to come."""
    start = groups.start
    pressed = isinstance(start, AtForce) or (isinstance(start, AtDepth) and start.depth >= 0)
    return pressed or (not isinstance(start, Apart) and row["start_force"] > -PAST * row["force"])


def estimates(run: Run) -> Iterator[Figure]:
    """Yield how many answers say that they are worse than asked, and too bad to be one."""
    accuracy, rows = run.head["accuracy"], run.answered.items()
    said = [Miss(n, run.stated(row), f"stated error {run.stated(row):.2g}") for n, row in rows]
    worse = [miss for miss in said if miss.size > accuracy]
    found = f"{len(worse)} of {len(said)}, {100 * len(worse) / max(len(said), 1):.1f} %"
    yield Figure("stated error above the asked accuracy", found)
    useless = (miss for miss in worse if miss.size > UNRESOLVED * accuracy)
    yield share("answered with a stated error above ten times it", useless, len(said))


def sameness(run: Run, other: Run) -> Iterator[Figure]:
    """Yield whether outcomes, events and forces are those of another processor, or of noise."""
    both = [(n, run.rows[n], other.rows[n]) for n in run.rows if n in other.rows]
    otherwise, off, compared = [], [], 0
    for number, was, now in both:
        kinds = [kind for kind in ("end", "outcome", "events") if was.get(kind) != now.get(kind)]
        if kinds:
            words = "; ".join(f"{kind} {was.get(kind)}, {now.get(kind)}" for kind in kinds)
            otherwise.append(Miss(number, len(kinds), words))
        forces = was.get("force"), now.get("force")
        if None not in forces:
            compared += 1
            change = abs(forces[1] / forces[0] - 1)
            words = f"force {forces[0]:.7g}, {forces[1]:.7g}, stated error {run.stated(was):.1g}"
            off.append(Miss(number, change / run.stated(was), words))
    yield share(f"{other.name}: other outcome or events", otherwise, len(both))
    far = (miss for miss in off if miss.size > SHARE)
    most = 0.0 if other.head["noise"] else 0.005
    yield share(f"{other.name}: force off by a tenth of its stated error", far, compared, most)


def coverage(run: Run, finer: Run) -> Iterator[Figure]:
    """Yield how often stated errors fall short of the true ones, and how far they exceed them.

    Dead loads are left out: their force is the one that was set.
    """
    for name, most, limit in (("force", 0.05, 5.0), ("work", 0.05, np.inf)):
        misses, ratios = [], []
        for number, row in run.answered.items():
            best = finer.answered.get(number, {}).get(name)
            known = None not in (best, row[name], row["estimate"].get(name))
            if not known or run.problem(number).rate is None:
                continue
            stated = row["estimate"][name]
            error = abs(row[name] - best) / max(abs(row[name]), TINY)
            ratios.append(stated / max(error, TINY))
            if error > stated:
                words = f"{name} {row[name]:.6g}, finer {best:.6g}, stated error {stated:.1g}"
                misses.append(Miss(number, error / stated, words))
        yield share(
            f"{finer.name}: error of the {name} above the stated one", misses, len(ratios), most
        )
        median = float(np.median(ratios)) if ratios else np.nan
        asked = f"below {limit:g}" if limit < np.inf else ""
        yield Figure(
            "  stated over true error, median", f"{median:.2f}", asked, not median >= limit
        )


@lru_cache(maxsize=2000)
def _problem(seed: int, number: int, films: bool) -> Any:
    return problem(seed, number, films=films)
