"""The page of the published table and its pictures, from rows that `compare` returns."""

from collections import defaultdict
from collections.abc import Callable, Sequence
from pathlib import Path
from textwrap import fill

import numpy as np

from .compare import Inputs, Row, inputs_of
from .draw import draw

_CORRECTED = (
    "[corrected.csv](corrected.csv) has, for the 1,200 rows of the sample in tests/data and for "
    "all that are off by more than 2 %, the inputs, the published values, ours with the errors "
    "that we state, and the differences; force in 1.5 pi R dg0, work in 1.5 pi R dg0 h0. "
    "`--corrected FILE` writes it. Inputs and published values are (c) 2025 Ali Maghami, MIT "
    "licence."
)
# Rows that need an explanation of their own.
FAR = 0.05

REGIONS: dict[str, Callable[[Row], bool]] = {
    "all": lambda row: True,
    "mu up to 0.1": lambda row: row["tabor"] <= 0.1,
    "mu above 0.1 and up to 1": lambda row: 0.1 < row["tabor"] <= 1,
    "mu above 1": lambda row: row["tabor"] > 1,
    "n up to 0.3": lambda row: row["exponent"] <= 0.3,
    "n above 0.3 and up to 0.8": lambda row: 0.3 < row["exponent"] <= 0.8,
    "n above 0.8": lambda row: row["exponent"] > 0.8,
    "k = 0.1": lambda row: row["modulus_ratio"] == 0.1,
    "k below 0.1": lambda row: row["modulus_ratio"] < 0.1,
    "k above 0.1": lambda row: row["modulus_ratio"] > 0.1,
    "rate up to 1e2": lambda row: row["rate"] <= 1e2,
    "rate 1e2 to 1e4": lambda row: 1e2 < row["rate"] <= 1e4,
    "rate 1e4 to 1e6": lambda row: 1e4 < row["rate"] <= 1e6,
    "rate 1e6 to 1e10": lambda row: 1e6 < row["rate"] <= 1e10,
    "rate above 1e10": lambda row: row["rate"] > 1e10,
    "depth up to 1": lambda row: row["preload"] <= 1,
    "depth above 1 and up to 20": lambda row: 1 < row["preload"] <= 20,
    "depth above 20": lambda row: row["preload"] > 20,
}


def percent(value: float, digits: int = 2) -> str:
    """Return a share in percent."""
    return f"{100 * value:.{digits}f} %"


def column(rows: Sequence[Row], name: str) -> np.ndarray:
    """Return a column of the rows that have a number there."""
    values = np.array([row[name] for row in rows], float)
    return values[np.isfinite(values)]


def regions(rows: Sequence[Row]) -> list[str]:
    """Return the table of differences by region."""
    lines = ["| region | rows | median | with its sign | 95 % below | largest | above 2 % |"]
    lines.append("|---|---|---|---|---|---|---|")
    for name, inside in REGIONS.items():
        off = column([row for row in rows if inside(row)], "force_difference")
        if off.size:
            size = np.abs(off)
            lines.append(
                f"| {name} | {off.size:,} | {percent(np.median(size))} | "
                f"{100 * np.median(off):+.2f} % | {percent(np.quantile(size, 0.95))} | "
                f"{percent(size.max(), 1)} | {np.sum(size > 0.02)} |"
            )
    return lines


def decided(rows: Sequence[Row]) -> list[str]:
    """Return what converged runs say of the rows that are apart, and a line for each far one."""
    apart = [row for row in rows if "table_error" in row]
    if not apart:
        return ["No row is off by more than 2 %."]
    ours, theirs = (np.abs(column(apart, f"{who}_error")) for who in ("our", "table"))
    lines = [
        f"{len(apart)} rows are off by more than 2 %, {percent(len(apart) / len(rows))} of the "
        "table. All were run again with an accuracy of 1e-4. The simulation here is off by "
        f"{percent(np.median(ours), 3)} in the median and {percent(ours.max())} at most, the "
        f"published value by {percent(np.median(theirs), 1)} and {percent(theirs.max(), 1)}. In "
        f"{np.sum(ours < theirs)} of the {len(apart)} rows the published value is the one that "
        f"is off, in {np.sum(column(apart, 'table_error') > 0)} it is too high.",
        "",
        f"The {np.sum(theirs > FAR)} rows that are off by more than {percent(FAR, 0)}, each "
        "decided by its converged run:",
        "",
        "| mu | k | n | depth | rate | published | here | same inputs elsewhere in the table |",
        "|---|---|---|---|---|---|---|---|",
    ]
    same = by_inputs(rows)
    for row in sorted(apart, key=lambda row: -abs(row["table_error"])):
        if abs(row["table_error"]) <= FAR and abs(row["force_difference"]) <= FAR:
            continue
        others = [other for other in same[inputs_of(row)] if other is not row]
        offs = ", ".join(f"{100 * other['force_difference']:+.1f} %" for other in others)
        lines.append(
            f"| {row['tabor']:g} | {row['modulus_ratio']:g} | {row['exponent']:g} | "
            f"{row['preload']:.4g} | {row['rate']:.3g} | {100 * row['table_error']:+.1f} % | "
            f"{100 * row['our_error']:+.2f} % | {offs or '-'} |"
        )
    return lines


def by_inputs(rows: Sequence[Row]) -> dict[Inputs, list[Row]]:
    """Return the rows of each case."""
    same: dict[Inputs, list[Row]] = defaultdict(list)
    for row in rows:
        same[inputs_of(row)].append(row)
    return same


def repeated(rows: Sequence[Row]) -> str:
    """Return what repeated inputs say of the table's own scatter."""
    groups = [group for group in by_inputs(rows).values() if len(group) > 1]
    if not groups:
        return "No inputs are repeated in these rows."
    spread = []
    for group in groups:
        values = [row["force"] for row in group]
        spread.append(max(values) / min(values) - 1)
    nearest = [min(abs(row["force_difference"]) for row in group) for group in groups]
    return (
        f"{len(groups)} inputs are stated more than once, {sum(map(len, groups))} rows. Their "
        f"forces differ by {percent(np.median(spread))} in the median, by less than "
        f"{percent(np.quantile(spread, 0.95), 1)} in 95 % and by {percent(max(spread), 1)} at "
        f"most. The one that is nearer to the simulation is off by {percent(np.median(nearest))} "
        f"in the median and {percent(max(nearest), 1)} at most."
    )


def work(rows: Sequence[Row]) -> list[str]:
    """Return what the work column is worth."""
    lines = [
        "| start | rows | median of published/1.5 over ours | 5 % to 95 % | off by over 10 % |"
    ]
    lines.append("|---|---|---|---|---|")
    for words, inside in (("in compression", False), ("in tension", True)):
        ratio = 1 + column([row for row in rows if row["in_tension"] is inside], "work_difference")
        if ratio.size:
            low, high = np.quantile(ratio, [0.05, 0.95])
            lines.append(
                f"| {words} | {ratio.size:,} | {np.median(ratio):.3f} | {low:.3f} to {high:.3f} | "
                f"{percent(float(np.mean(np.abs(ratio - 1) > 0.1)), 1)} |"
            )
    return lines


def page(rows: Sequence[Row]) -> str:
    """Return the page."""
    force = np.abs(column(rows, "force_difference"))
    time = sum(row["ours"]["wall_time_s"] for row in by_first(rows))
    residual = max(row["ours"]["energy_residual"] for row in rows)
    no_work = sum(not np.isfinite(row["work_difference"]) for row in rows)
    parts = [
        "# The published table, put to the test",
        "",
        f"{len(rows):,} rows of the table of detachments that the authors of the thesis "
        "published, each simulated here at the default accuracy of 2e-3. This page is written by "
        "`python -m research.replication.published --table rows.csv "
        "--write research/replication/published`. "
        "Differences are published over ours, less one; they are relative.",
        "",
        f"- The pull-off force differs by {percent(np.median(force))} in the median; 95 % of the "
        f"rows are below {percent(np.quantile(force, 0.95), 1)}, the largest is "
        f"{percent(force.max(), 1)}.",
        f"- {len(by_first(rows)):,} different cases took {time:.0f} s in their workers, "
        f"{1e3 * time / len(by_first(rows)):.0f} ms each with the error estimate.",
        f"- The largest energy residual is {residual:.1e}.",
        "",
        "## By region",
        "",
        "![Distribution of the differences](differences.png)",
        "",
        *regions(rows),
        "",
        "![Where the differences are](regions.png)",
        "",
        "## Where the two are apart",
        "",
        *decided(rows),
        "",
        "## Repeated inputs",
        "",
        repeated(rows),
        "",
        "## The work column",
        "",
        "It is the work to pull-off in pi R dg0 h0: divided by 1.5 it is in the unit of this "
        f"package. {no_work} rows hold 0.01, which stands for no work found, and are left out.",
        "",
        *work(rows),
        "",
        "## The corrected table",
        "",
        _CORRECTED,
        "",
    ]
    return "\n".join(wrapped(part) for part in parts)


def wrapped(part: str) -> str:
    """Return a paragraph in lines of 100, and a table, heading or picture as it is."""
    if part.startswith(("|", "#", "!")):
        return part
    return fill(part, 100, subsequent_indent="  " if part.startswith("- ") else "")


def by_first(rows: Sequence[Row]) -> list[Row]:
    """Return one row of every case."""
    return [group[0] for group in by_inputs(rows).values()]


def write(rows: Sequence[Row], folder: Path) -> None:
    """Write the page and its pictures into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    draw(rows, folder)
    (folder / "README.md").write_text(page(rows), encoding="utf-8", newline="")


def changed(rows: Sequence[Row], kept: str) -> list[str]:
    """Return the lines of the page that a kept page does not have, but for what the runs took."""
    known = set(kept.splitlines())
    return [line for line in page(rows).splitlines() if line not in known and " took " not in line]
