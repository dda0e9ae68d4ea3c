"""Write what the shipped surrogate of the punch is worth into docs/surrogate.md.

`python -m benchmarks.punch_page [--write]`: errors and intervals on rows that nothing was learned
from, worked out anew from the shipped file, by set, by rate and by modulus ratio; and speed here.
`--starts` simulates instead how far the depth of the start matters, half a minute.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from training.rows import Rows, joined
from training.train_punch import LEARNED, faces, parts, read, scored
from viscotack import predict, predict_table, solve, summary
from viscotack.campaign.columns import KINDS
from viscotack.surrogate import punch_physics as physics
from viscotack.surrogate import store

PAGE = Path(__file__).resolve().parents[1] / "docs" / "surrogate.md"
_BEGIN, _END = "<!-- punch -->", "<!-- end of punch -->"
# Between these lie the regions of rate and of modulus ratio.
_RATES, _RATIOS = (0.1, 100.0), (0.01, 0.1)
_TWO = ("stress", "work")
_TIMES, _MANY = 200, 100_000
# Random punches whose starts are varied, in this range, and depths of these [h0].
_PUNCHES, _DEPTHS = 12, (0.0, 0.3, 1.0, 3.0, 10.0, 50.0)
_SPREAD = {
    "size": (1.0, 200.0),
    "thickness": (0.1, 1000.0),
    "modulus_ratio": (1e-3, 0.7),
    "rate": (0.1, 1e4),
}


def regions(rows: Rows) -> dict[str, Rows]:
    """Return the rows by words for where they are."""
    found = {"all": rows}
    for i, name in enumerate(LEARNED):
        found[f"`{name}`"] = rows.chosen(rows.origin == i)
    for column, ends, words in (
        (physics.RATE, _RATES, "rate"),
        (physics.MODULUS_RATIO, _RATIOS, "modulus ratio"),
    ):
        where = np.searchsorted(ends, rows.groups[:, column])
        low, high = ends
        names = f"{words} below {low:g}", f"{low:g} to {high:g}", f"above {high:g}"
        found |= {name: rows.chosen(where == i) for i, name in enumerate(names)}
    return {name: some for name, some in found.items() if len(some)}


def percent(value: float) -> str:
    """Return a share in percent, two digits that matter."""
    return f"{100 * value:.2g} %" if value < 0.095 else f"{100 * value:.1f} %"


def table(rows: Rows, edges: Rows) -> list[str]:
    """Return the table of errors and covers."""
    lines = [
        "| rows kept apart | | MSE of log10 | median | 95 % below | largest | "
        "90 % interval holds | half width, median | worst, half widths |",
        "|---|---|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for name, some in (regions(rows) | {"`punch_faces`": edges}).items():
        found = scored(store.shipped("punch"), some)
        for what in ("stress", "work", "curve", "travel") if name == "all" else _TWO:
            lines.append(line(f"{name}, {len(some)}", what, found[what]))
    return lines


def line(name: str, what: str, one: dict[str, Any]) -> str:
    """Return a row of the table."""
    squares = "" if one["mse_log10"] is None else f"{one['mse_log10']:.1e}"
    numbers = [percent(one[key]) for key in ("median", "95 %", "largest")]
    numbers += [f"{100 * one['cover']:.1f} %", percent(one["half width"])]
    return (
        f"| {name} | {what} | {squares} | {' | '.join(numbers)} | {one['worst, half widths']:.1f} |"
    )


def speed() -> str:
    """Return how long answers take here."""
    row = {"size": 64.85, "thickness": 3.24, "cohesion": 0.05, "modulus_ratio": 0.1, "rate": 10.0}
    times = []
    for start in ("preload", "preload_force"):
        problem = KINDS["punch"].problem(row | {start: 1.0})
        predict(problem)
        began = process_time()
        for _ in range(_TIMES):
            predict(problem)
        times.append((process_time() - began) / _TIMES * 1e3)
    many = {name: np.full(_MANY, value) for name, value in (row | {"preload": 1.0}).items()}
    many["rate"] = np.geomspace(1e-3, 1e6, _MANY)
    began = process_time()
    predict_table(many)
    taken = process_time() - began
    size = store.FILES["punch"].stat().st_size / 1e6
    return (
        f"One `viscotack.predict` of a punch takes {times[0]:.2f} ms of a processor, "
        f"{times[1]:.2f} ms from a start by stress; {_MANY:,} stresses and works with intervals "
        f"{taken:.2g} s. The file has {size:.2f} MB."
    )


def starts() -> str:
    """Return stress and work of random punches from starts of several depths, simulated."""
    random, lines = np.random.default_rng(5), []
    for _ in range(_PUNCHES):
        logs = [random.uniform(*np.log10(ends)) for ends in _SPREAD.values()]
        case = dict(zip(_SPREAD, 10 ** np.array(logs), strict=True)) | {"cohesion": 0.05}
        words = []
        for depth in _DEPTHS:
            problem = KINDS["punch"].problem(case | {"preload": depth})
            said = summary(solve(problem, accuracy=5e-4, until="pull-off", throw=False))
            words.append(f"{said['pull_off_stress']:.5f} {said['work_to_pull_off']:.4f}")
        lines.append(" | ".join([", ".join(f"{n} {x:.3g}" for n, x in case.items()), *words]))
    return "\n".join(lines)


def main() -> None:
    """Work it out and print or write it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="into docs/surrogate.md")
    parser.add_argument("--starts", action="store_true", help="simulate starts of several depths")
    given = parser.parse_args()
    if given.starts:
        print(starts())
        return
    sets = [read(name) for name in LEARNED]
    judging = [rows.chosen(parts(len(rows))[1]) for rows in sets]
    for i, rows in enumerate(judging):
        rows.origin[:] = i
    edges = faces().chosen(slice(1, None, 2))
    text = "\n".join([*table(joined(judging), edges), "", speed()])
    print(text)
    if given.write:
        page = PAGE.read_text(encoding="utf-8")
        head, tail = page.split(_BEGIN)[0], page.split(_END)[1]
        PAGE.write_text(f"{head}{_BEGIN}\n\n{text}\n\n{_END}{tail}", encoding="utf-8")


if __name__ == "__main__":
    main()
