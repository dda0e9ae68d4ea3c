"""Read public files of tack tests and force curves, and hold them against the raw numbers.

    python -m research.public_tack_files FOLDER... [--names]

Records of JPK texts are held against the columns that NumPy reads. For every cycle that is read:
the pull-off against the raw extremum of that retraction, and the speed against a line through
position over time that is fitted here, between the last zero crossing of the force and the pull-
off. Every file that is not read stands there with the reason.
"""

import argparse
import re
import sys
import warnings
from collections import Counter
from pathlib import Path

import numpy as np

from viscotack.errors import InputError
from viscotack.lab import tack

DATA = {".csv", ".txt", ".nid", ".ibw", ".jpk-force", ".tab", ".xlsx", ".jpk-force-map", ".h5"}
INTERVAL = re.compile(r"(.*)_Interval_\d+")


def groups_of(folder):
    """Return the files of each test, by a name."""
    found = {}
    for path in sorted(folder.rglob("*")):
        if not path.is_file() or path.suffix.lower() not in DATA:
            continue
        match = INTERVAL.fullmatch(path.stem)
        name = str(path.relative_to(folder).parent / (match[1] if match else path.name))
        found.setdefault(name, []).append(path)
    return found


def raw_numbers(record, cycle):
    """Return the extremum and the slope of this retraction, from the numbers of the file alone."""
    span = (record.time >= cycle.time[cycle.segments.retract]) & (
        record.time <= cycle.time[cycle.segments.end - 1]
    )
    t, F, x = record.time[span], record.force[span], record.position[span]
    sign = np.sign(F[0]) or 1.0
    tension = -sign * F
    at = int(np.argmax(tension))
    pressed = np.flatnonzero(tension[:at] <= 0)
    begin = int(pressed[-1]) if pressed.size else 0
    slope = (
        abs(np.polyfit(t[begin : at + 1], x[begin : at + 1], 1)[0]) if at - begin > 5 else np.nan
    )
    level = float(np.median(tension[-max(tension.size // 20, 5) :]))
    whole = abs(float(np.polyfit(t, x, 1)[0]))
    return float(tension[at]), float(tension[at]) - level, float(slope), whole


def misread(path):
    """Return whether a record of a JPK text differs from the columns that NumPy reads."""
    text = path.read_text(encoding="latin-1")
    names = re.search(r"(?m)^# columns: (.*)$", text)
    if names is None:
        return False
    columns = dict(zip(names[1].split(), np.loadtxt(path, encoding="latin-1").T, strict=True))
    (record,) = tack.read(path)
    height = next(columns[n] for n in ("measuredHeight", "tipSampleSeparation") if n in columns)
    mine = record.time, record.force, record.position
    theirs = columns["seriesTime"], columns["vDeflection"], height
    return not all(map(np.array_equal, mine, theirs))


def outcome(paths):
    """Return the rows of the cycles that were read, and the reasons of the others."""
    rows = []
    found = tack.survey(paths)
    for one in found.evaluations:
        for cycle in one.cycles:
            raw, above, slope, whole = raw_numbers(one.record, cycle)
            rows.append(
                (
                    cycle.pull_off_force.value / raw - 1 if raw > 0 else np.nan,
                    cycle.pull_off_force.value / above - 1,
                    cycle.speed.value / slope - 1,
                    cycle.mean_speed.value / whole - 1,
                    cycle,
                )
            )
    return rows, [reason for _, reason in found.reasons]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folders", nargs="+", type=Path, metavar="FOLDER")
    parser.add_argument("--names", action="store_true", help="a line for each file")
    arguments = parser.parse_args()
    warnings.simplefilter("error", RuntimeWarning)
    broken = 0
    for folder in arguments.folders:
        rows, why, files = [], Counter(), 0
        for name, paths in groups_of(folder).items():
            files += 1
            try:
                read, reasons = outcome(paths)
                if any(path.suffix == ".txt" and misread(path) for path in paths):
                    raise InputError("other numbers than NumPy reads")
            except (InputError, RuntimeWarning) as error:
                broken += 1
                print(f"BROKEN {name}: {error}")
                continue
            rows += read
            why.update(re.sub(r"[-+]?[0-9][0-9.eE+-]*", "#", reason)[:110] for reason in reasons)
            if arguments.names:
                forces = " ".join(f"{cycle.pull_off_force.value:.3g} N" for *_, cycle in read)
                print(f"  {name}: {forces or reasons[0] if forces or reasons else '-'}")
        print(f"{folder}: {files} tests, {len(rows)} cycles read, {why.total()} refused")
        if rows:
            table = np.abs(np.array([row[:4] for row in rows]))
            labels = ("pull-off", "pull-off above the end of the curve", "speed", "mean speed")
            for label, column in zip(labels, table.T, strict=True):
                known = column[np.isfinite(column)]
                print(
                    f"  {label}: {np.sum(known <= 0.01)} of {known.size} within 1 % of the raw "
                    f"numbers, largest difference {known.max():.2%}"
                )
        for reason, count in why.most_common():
            print(f"  {count} refused: {reason}")
    sys.exit(bool(broken))


if __name__ == "__main__":
    main()
