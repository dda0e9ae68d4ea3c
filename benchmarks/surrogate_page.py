"""Write what the shipped surrogate is worth into docs/surrogate.md.

`python -m benchmarks.surrogate_page [--table PATH] [--write]`: everything is worked out anew from
the shipped files: errors and intervals on rows that nothing was learned from, by set; speed here;
and how far it is from the published rows, of which tests/data has a sample. `benchmarks/judging.py`
judges by fresh cases.
"""

from __future__ import annotations

import argparse
import csv
from dataclasses import replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from training.calibration import by_set
from training.rows import LEARNED
from training.train_sphere import parted
from viscotack import Groups, predict
from viscotack.materials import RetardationPowerLaw
from viscotack.protocol import AtDepth, AtForce
from viscotack.surrogate import physics, store
from viscotack.surrogate.store import shipped

from .cases import add_table, published_rows

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "surrogate.md"
CORRECTED = ROOT / "replication/published/corrected.csv"

# More rows than any table has.
ALL = 1_000_000
SETS = {"all": "all"} | {name: f"`{name}`" for name in LEARNED}
Scores = dict[str, Any]


def percent(value: float) -> str:
    """Return a share in percent, two digits that matter; nothing for what there is not."""
    if np.isnan(value):
        return ""
    return f"{100 * value:.2g} %" if value < 0.095 else f"{100 * value:.1f} %"


def errors(scores: Scores) -> list[str]:
    """Return the table of errors and covers by set."""
    lines = [
        "| rows kept apart | | MSE of log10 | median | 95 % below | largest | "
        "90 % interval holds | half width, median |",
        "|---|---|---:|---:|---:|---:|---:|---:|",
    ]
    for key, name in SETS.items():
        if key not in scores:
            continue
        for what in ("force", "work"):
            one = scores[key][what]
            lines.append(
                f"| {name}, {scores[key]['rows']} | {what} | {one['mse_log10']:.1e} | "
                f"{percent(one['median'])} | {percent(one['95 %'])} | {percent(one['largest'])} | "
                f"{percent(one['cover'])} | {percent(one['half width'])} |"
            )
    return lines


def curves(scores: Scores) -> str:
    """Return the sentence about curves."""
    one = scores["all"]["curve"]
    return (
        "The force along the part in tension, at the same travel from zero force, is off at worst "
        f"by {percent(one['median'])} of the pull-off force in the median case, by less than "
        f"{percent(one['90 %'])} in nine of ten and {percent(one['99 %'])} in 99 of 100."
    )


def seconds(problem: Groups) -> float:
    """Return the time of a prediction, the median of some."""
    predict(problem)
    times = []
    for _ in range(50):
        began = process_time()
        predict(problem)
        times.append(process_time() - began)
    return float(np.median(times))


def speed() -> str:
    """Return the sentence about time, of this machine."""
    random = np.random.default_rng(0)
    u = random.random((100_000, 5))
    groups = physics.LOW * (physics.HIGH / physics.LOW) ** u
    shipped().evaluate(groups[:10])
    began = process_time()
    said = shipped().evaluate(groups)
    shipped().intervals(groups, said)
    bulk = process_time() - began
    material = RetardationPowerLaw(
        rubbery_modulus=1.0, glassy_modulus=10.0, exponent=0.8, tau0=1.0, poisson_ratio=0.0
    )
    one = Groups(tabor=3.24, material=material, start=AtDepth(73.0), rate=316.23)
    single, by_force, outside = (
        seconds(problem)
        for problem in (one, replace(one, start=AtForce(5.0)), replace(one, rate=1e13))
    )
    size = store.SHIPPED.stat().st_size
    weights = sum(shipped().networks[name].parameters for name in ("force", "work"))
    return (
        f"One `viscotack.predict`, with its curve and intervals, takes {1e3 * single:.2f} ms of a "
        f"processor, {1e3 * by_force:.2f} ms from a start by force, {1e3 * outside:.1f} ms a "
        f"little beyond the range; 100,000 forces and works with intervals {bulk:.2f} s. The file "
        f"has {size / 1e6:.2f} MB, {weights} weights for force and work."
    )


def theory() -> str:
    """Return the sentence about the learned theory of large Tabor numbers."""
    file = store.FILES["short range"]
    facts = store.facts(file)
    one, size = facts["scores"], file.stat().st_size
    words = ", ".join(
        f"the {name} differs from the theory by {percent(one[name]['median'])} in the median, "
        f"{percent(one[name]['90 %'])} in nine of ten and {percent(one[name]['largest'])} at most"
        for name in ("force", "work", "curve")
    )
    return (
        f"The learned theory of a crack at the edge: {facts['solids']} solids, {facts['answered']} "
        f"cases that it answered. On {one['cases']} of solids kept apart, {words} (of a curve over "
        f"the pull-off force, at any step). Works and curves are given in "
        f"{percent(one['with work'])}. Its file has {size / 1e6:.2f} MB."
    )


def published(table: Path) -> str:
    """Return the sentence about the published rows."""
    rows = published_rows(table, ALL, 0)
    groups = np.array(
        [[row["mu"], row["k"], row["n"], row["alphaload"], -row["runload"]] for row in rows]
    )
    force = np.array([row["outputAmplification"] for row in rows])
    inside = shipped().inside(groups).all(axis=1)
    said = shipped().evaluate(groups[inside])
    off = np.abs(said.pull_off_force / force[inside] - 1)
    return (
        f"Of {len(rows):,} rows that the authors of the thesis published, {inside.sum():,} lie "
        f"in the range: the forces differ by {percent(float(np.median(off)))} in the median and by "
        f"less than {percent(float(np.quantile(off, 0.95)))} in 95 % of them. {outliers()}"
    )


def outliers() -> str:
    """Return the sentence about rows whose published numbers differ from simulations."""
    with CORRECTED.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    groups = np.array([[float(row[name]) for name in physics.INPUTS] for row in rows])
    inside = shipped().inside(groups).all(axis=1)
    said = shipped().evaluate(groups)
    held = shipped().intervals(groups, said)
    given = ~shipped().doubtful(groups, said)
    words = []
    for i, (name, value, ends) in enumerate(
        (
            ("force", said.pull_off_force, held.pull_off_force),
            ("work", said.work_to_pull_off, held.work_to_pull_off),
        )
    ):
        true, published = (
            np.array([float(row[f"{of}{name}"] or "nan") for row in rows])
            for of in ("", "published_")
        )
        some = inside & given[:, i] & np.isfinite(true)
        ours, theirs = (np.abs(x / true - 1)[some] for x in (value, published))
        of_held = np.mean((ends[:, 0] <= true) & (true <= ends[:, 1]), where=some)
        words.append(
            f"{name}s of {some.sum():,}, which the published ones miss by "
            f"{percent(float(np.nanmedian(theirs)))} in the median and "
            f"{percent(np.nanmax(theirs))} at most, within {percent(float(np.median(ours)))} and "
            f"{percent(ours.max())}; {percent(float(of_held))} lie in their 90 % intervals"
        )
    return (
        f"Of the {len(rows):,} [rows simulated at 1e-4](../replication/published/README.md) "
        f"because the published force or work is off, the surrogate has {'; '.join(words)}."
    )


def solids() -> str:
    """Return the table of other solids, from the metadata of their file."""
    lines = [
        "| solids, rows | | given | median | 90 % below | largest | 90 % interval holds | "
        "half width, median | worst, half widths |",
        "|---|---|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for name, scores in store.facts(store.FILES["solids"])["scores"].items():
        for what in ("force", "work", "curve"):
            one = scores[what]
            shares = ("given", "median", "90 %", "largest", "cover", "half width")
            numbers = " | ".join(percent(one[share]) for share in shares)
            worst = one["worst, half widths"]
            lines.append(f"| {name}, {scores['rows']} | {what} | {numbers} | {worst:.1f} |")
    return "\n".join(lines)


def replaced(text: str, start: str, end: str, words: str) -> str:
    """Return a text with the words between two marks."""
    before, rest = text.split(start, 1)
    return f"{before}{start}\n\n{words}\n\n{end}{rest.split(end, 1)[1]}"


def main() -> None:
    """Print, or write into the pages."""
    parser = argparse.ArgumentParser(description=__doc__)
    add_table(parser)
    parser.add_argument("--write", action="store_true")
    chosen = parser.parse_args()
    at_random = by_set(shipped(), parted()[1])
    parts = [
        "\n".join(errors(at_random)),
        curves(at_random),
        speed(),
        theory(),
    ]
    parts.append(published(chosen.table))
    words = "\n\n".join(parts)
    print(words)
    if chosen.write:
        text = PAGE.read_text(encoding="utf-8")
        text = replaced(text, "<!-- scores -->", "<!-- end -->", words)
        text = replaced(text, "<!-- solids -->", "<!-- end of solids -->", solids())
        PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
