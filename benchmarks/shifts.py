"""Shift factors beside those that others published, from folders of their files.

    python benchmarks/shifts.py --reptate FOLDER [--mastercurves FOLDER] [--pyvisco FOLDER]
        [--package-says FILE] [--full]

RepTate (GPL-3, github.com/jorge-ramirez-upm/RepTate): `data/PI_LINEAR`, sweeps of ten melts of
polyisoprene with different lengths of chain, and the WLF law of all of them in the headings of its
master curves. mastercurves (GPL-3, github.com/krlennon/mastercurves): creep of polystyrene
digitised from Plazek (1965), doi:10.1021/j100894a039. pyvisco (BSD-3, github.com/NREL/pyvisco):
relaxation tests with the shifts that code found. Their data stay where they are; the table goes to
docs/materials.md.

With --package-says the shifts that another program found are printed beside: a JSON object, name
of the melt -> [[T in C, log10 a_T], ...] relative to -30 C.
"""

import argparse
import csv
import json
import math
import re
from pathlib import Path

import numpy as np

from viscotack.lab import (
    CreepTest,
    FrequencySweeps,
    contradiction,
    master_curve,
    nearest_law,
    read_relaxations,
    read_shifts,
    superposed,
    superposition,
)
from viscotack.materials.shift import TabulatedShift

QUANTILE = 1.6448536269514722  # of a 90 % interval
ZERO = 273.15
REFERENCE = -30.0  # C
MELTS = {
    "PI4k": 5.1, "PI14k": 13.5, "PI26k": 23.4, "PI33K": 33.6, "PI88K": 94.9, "PI223k": 225.9,
    "PI400k": 483.1, "PI600k": 634.5, "PI1000k": 1131.0,
}  # fmt: skip
# temperatures of Plazek's creep of polystyrene
PLAZEK = (97, 100.6, 101.8, 104.5, 106.7, 109.6, 114.5, 125, 133.8, 144.9)  # C


def sweep(path):
    """Return the temperature [C] in the heading and frequency, storage, loss of each row."""
    lines = path.read_text(encoding="latin-1").splitlines()
    temperature = float(re.search(r"(?:^|;)\s*T=([-\d.]+)", lines[0]).group(1))
    rows = []
    for line in lines[1:]:
        try:
            row = [float(word) for word in line.split()[:3]]
        except ValueError:
            continue
        if len(row) == 3 and min(row) > 0:
            rows.append(row)
    return temperature, np.array(rows)


def melt(folder, name):
    """Return the sweeps of one melt, those of one temperature together."""
    parts = [sweep(path) for path in sorted((folder / "osc").glob(f"{name}*.osc"))]
    rows = np.concatenate([rows for _, rows in parts])
    lengths = [len(rows) for _, rows in parts]
    return FrequencySweeps(
        np.repeat([T + ZERO for T, _ in parts], lengths),
        *rows.T,
        kind="G",
        sweep=np.repeat(np.arange(len(parts)), lengths),
    )


def constants(folder, mass):
    """Return the header of the published master curve of a melt, as numbers."""
    for path in folder.glob("PI_*.tts"):
        head = path.read_text(encoding="latin-1").splitlines()[0]
        pairs = dict(pair.split("=", 1) for pair in head.split(";") if "=" in pair)
        if math.isclose(float(pairs["Mw"]), mass):
            return {key: float(pairs[key]) for key in ("C1", "C2", "T", "CTg", "Rho0", "C3")}
    raise SystemExit(f"{folder} has no master curve of {mass} kg/mol")


def by_source(celsius, mass, header):
    """Return log10 a_T to REFERENCE: WLF with the glass transition of the chain's length."""

    def law(T):
        c2, at = header["C2"] + header["CTg"] / mass, header["T"] - header["CTg"] / mass
        return -header["C1"] * (header["C2"] + header["T"]) * (T - at) / (c2 + at) / (c2 + T)

    return law(celsius) - law(REFERENCE)


def density(celsius, header):
    """Return log10 of the factor that takes a modulus to REFERENCE, by the source's density."""

    def product(T):
        return (header["Rho0"] - 1e-3 * header["C3"] * T) * (T + ZERO)

    return np.log10(product(REFERENCE) / product(celsius))


def said(found, truth, doubt):
    off = found - truth
    held = np.abs(off) <= QUANTILE * doubt + 1e-9
    return f"{np.max(np.abs(off)):>8.3f} {np.sum(held):>3}/{held.size}"


def polyisoprene(folder, others, full):
    """Print the table of melts; each column: the largest deviation and how many are covered."""
    print(f"log10 a_T to {REFERENCE:g} C beside the source's WLF: largest difference, rows in 90 %")
    print(f"{'melt':<9}{'rows':>5}{'to C':>6}{'both moduli':>15}{'by density':>15}"
          f"{'storage alone':>17}{'stated':>8}{'vertical':>10}{'other':>8}")  # fmt: skip
    for name, mass in MELTS.items():
        sweeps, header = melt(folder, name), constants(folder, mass)
        ways = {
            "most": {"vertical": "auto"},
            "density": {"by": "both", "vertical": 1e-3 * header["C3"] / header["Rho0"]},
            "storage": {"by": "storage", "vertical": "none"},
        }
        tables = {}
        for way, keywords in ways.items():
            try:
                tables[way] = master_curve(
                    sweeps, reference_temperature=REFERENCE + ZERO, **keywords
                )
            except ValueError:
                tables[way] = None
        best = tables["most"].shifts
        celsius = best.temperature - ZERO
        truth = by_source(celsius, mass, header)
        columns = [
            "refused".rjust(15)
            if curve is None
            else said(curve.shifts.log10_shift, truth, curve.shifts.uncertainty).rjust(15)
            for curve in tables.values()
        ]
        alone = tables["storage"]
        stated = "" if alone is None else f"{alone.shifts.uncertainty.max():.2f}"
        up = np.max(np.abs(best.log10_vertical - density(celsius, header)))
        other = ""
        if name in others:
            rows = np.array(others[name])
            theirs = np.interp(celsius, rows[:, 0], rows[:, 1])
            other = f"{np.max(np.abs(theirs - truth)):.3f}"
        print(f"{name:<9}{celsius.size:>5}{celsius[-1]:>6.0f}{''.join(columns)}  "
              f"{stated:>8}{up:>10.3f}{other:>8}")  # fmt: skip
        if not full:
            continue
        for T, found, doubt, true in zip(
            celsius, best.log10_shift, best.uncertainty, truth, strict=True
        ):
            print(f"    {T:>7.1f} C {found:>8.3f} +- {doubt:.3f}   source {true:>8.3f}")
        law = nearest_law(best, reference_temperature=REFERENCE + ZERO)
        print(f"    nearest law: {law and law.law}")
        words = (*superposition(sweeps, best).words(), contradiction(tables["most"]))
        print("    ", *[each for each in words if each] or ["nothing speaks against it"])


def polystyrene(folder):
    """Print the shifts of Plazek's creep, moduli of which were moved by who published them."""
    with (folder / "demos" / "data" / "tts_plazek.csv").open() as file:
        rows = list(csv.reader(file))[2:]
    tests = []
    # the package lists its temperatures from hot to cold
    for k, celsius in enumerate(sorted(PLAZEK, reverse=True)):
        points = [(float(r[2 * k]), float(r[2 * k + 1])) for r in rows if r[2 * k]]
        time, compliance = np.array(points).T
        tests.append(CreepTest(time, compliance, "G", temperature=celsius + ZERO))
    _, table = superposed(tests, reference_temperature=100.6 + ZERO, vertical="none")
    law = nearest_law(table, reference_temperature=100.6 + ZERO)
    print("\ncreep of polystyrene (Plazek), log10 a_T to 100.6 C")
    for T, shift, doubt in zip(
        table.temperature - ZERO, table.log10_shift, table.uncertainty, strict=True
    ):
        print(f"    {T:>7.1f} C {shift:>8.3f} +- {doubt:.3f}")
    print(f"    nearest law: {law and law.law}")


def relaxation(folder):
    """Print the shifts of relaxation tests beside those that pyvisco found from them."""
    tests = read_relaxations(folder / "examples" / "time_user_raw.csv")
    source = read_shifts(folder / "examples" / "time_user_raw__shift_factors.csv")
    zero = float(source.temperature[np.argmin(np.abs(source.log10_shift))])
    _, table = superposed(tests, reference_temperature=zero)
    theirs = TabulatedShift(zero, tuple(source.temperature), tuple(source.log10_shift))
    inside = np.clip(table.temperature, source.temperature[0], source.temperature[-1])
    truth = np.asarray(theirs.log10_shift(inside))
    print("\nrelaxation tests of pyvisco, log10 a_T: largest difference, rows in 90 %")
    print("   ", said(table.log10_shift, truth, table.uncertainty),
          f"; stated up to {table.uncertainty.max():.2f}")  # fmt: skip


if __name__ == "__main__":
    ask = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    ask.add_argument("--reptate", type=Path, metavar="FOLDER")
    ask.add_argument("--mastercurves", type=Path, metavar="FOLDER")
    ask.add_argument("--pyvisco", type=Path, metavar="FOLDER")
    ask.add_argument("--package-says", type=Path, metavar="FILE")
    ask.add_argument("--full", action="store_true", help="every temperature")
    given = ask.parse_args()
    told = {} if given.package_says is None else json.loads(given.package_says.read_text())
    if given.reptate is not None:
        polyisoprene(given.reptate / "data" / "PI_LINEAR", told, given.full)
    if given.mastercurves is not None:
        polystyrene(given.mastercurves)
    if given.pyvisco is not None:
        relaxation(given.pyvisco)
