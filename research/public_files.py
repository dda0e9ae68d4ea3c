"""Read every rheology file of public repositories, and hold what was read against another parse.

``python -m research.public_files FOLDER...`` takes checkouts of RepTate, RheoJAX, pyRheo,
mastercurves, pyvisco, RHEOS and of the other repositories of docs/public-files.md (any folders do),
reads each data file in them as it is, and prints how many

- are read, and say numbers, temperature and kind of an independent parse (pandas, or a few lines,
  from a recipe for each kind of file below that knows nothing of the readers),
- are refused until the flags named in the refusal are given, and then say those numbers,
- are refused for a reason that a rheologist accepts: they hold no linear viscoelastic test, or do
  not say what their columns are,
- are misread, or refused for any other reason. These are listed, and the exit status is then 1.

Then it prints the numbers by repository; ``--names FILE`` writes the
outcome of every file. A minute.
"""

import argparse
import csv
import io
import json
import re
import sys
import tomllib
import warnings
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path

import numpy as np
import pandas as pd

from viscotack import lab
from viscotack.errors import InputError

# Endings of data, paths of other files, and what is refused, whatever is given: path, words of the
# refusal, and why that is right.
EXPECTED = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
MEGA = 1e6


@dataclass(frozen=True)
class Recipe:
    """How to parse the files whose path fits, without the readers; `factors` take them to SI."""

    fits: tuple[str, ...]
    test: str
    parse: Callable[[Path], list[pd.DataFrame]]
    factors: tuple[float, ...] = (1.0, 1.0, 1.0)
    kind: str = "G"
    celsius: Callable[[Path], list[pd.DataFrame]] | None = None


def recipe_of(name, recipes):
    """Return the first recipe that fits a path, or None."""
    return next((r for r in recipes if any(fnmatch(name, word) for word in r.fits)), None)


# ---- independent parses ------------------------------------------------------------------------


def text_of(path):
    """Return the text of a file, without a last line that has no end: the readers leave it out."""
    content = path.read_bytes()
    if content[:2] == b"\xff\xfe":
        return content[: len(content) // 2 * 2].decode("utf-16").rpartition("\n")[0] + "\n"
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("latin-1")
    return text.rpartition("\n")[0] + "\n"


def below(word, separator, columns, *, decimal="."):
    """Return a parse of the rows below each line that holds a word, by the places of columns."""

    def parse(path):
        lines = text_of(path).replace("\r", "").split("\n")
        starts = [i for i, line in enumerate(lines) if word in line]
        tables = []
        for start, end in zip(starts, [*starts[1:], len(lines)], strict=True):
            rows = [
                line
                for line in lines[start + 1 : end]
                if re.match(r"(Data point)?\s*[-+\d.]", line)
            ]
            rows = [row for row in rows if row.count(separator) >= max(columns)]
            if rows:
                table = pd.read_csv(io.StringIO("\n".join(rows)), sep=separator, header=None,
                                    decimal=decimal, float_precision="round_trip")  # fmt: skip
                tables.append(table.iloc[:, list(columns)])
        return tables

    return parse


def either(path):
    """Return a table of words in the first line, apart by commas or tabs, perhaps of Germany."""
    text = text_of(path).replace("\r", "")
    head = next(
        line for line in text.split("\n") if re.match(r"(Angular|Time|Shear|freq|time|om)", line)
    )
    separator = "\t" if "\t" in head else "," if "," in head else " "
    decimal = "," if separator == "\t" and re.search(r"\d,\d", text) else "."
    return below(head, separator, range(2 + (head.count(separator) > 1)), decimal=decimal)(path)


def from_second(path):
    """Return the rows of RepTate: whatever is all numbers below the first line."""
    rows = []
    for line in path.read_text(encoding="latin-1").rpartition("\n")[0].split("\n")[1:]:
        try:
            rows.append([float(word) for word in line.split()][:3])
        except ValueError:
            continue
    return [pd.DataFrame([row for row in rows if row])]


def step_of(key):
    """Return a parse of RepTate's files whose second column is divided by a number of line 1."""

    def parse(path):
        (table,) = from_second(path)
        level = re.search(rf"{key}\s*=\s*([\d.eE+-]+)", path.read_text(encoding="latin-1"))
        table = table.iloc[:, :2].copy()
        table[1] /= float(level[1]) if level and float(level[1]) else 1.0
        return [table]

    return parse


def excel(sheet, names, skip=(1,), header=0):
    def parse(path):
        table = pd.read_excel(path, sheet_name=sheet, skiprows=list(skip), header=header)
        found = [next(n for n in table.columns if n in name.split("|")) for name in names]
        return [table[found]]

    return parse


def trios(step, names):
    """Return a parse of the steps of TRIOS whose name holds a word, by the names of columns."""

    def parse(path):
        blocks = re.split(r"(?im)^\[step\]\s*$", text_of(path).replace("\r", ""))[1:]
        tables = []
        for block in blocks:
            lines = block.split("\n")
            if step not in lines[1]:
                continue
            at = next(i for i, line in enumerate(lines) if names[0] in line.split("\t"))
            head = lines[at].split("\t")
            rows = [line.split("\t") for line in lines[at + 2 :] if line.strip()]
            rows = [row for row in rows if len(row) == len(head)]
            frame = pd.DataFrame(rows, columns=range(len(head)))
            tables.append(frame[[head.index(name) for name in names]].astype(float))
        return tables

    return parse


def quotient(path):
    """Return time and stress over strain of the invented exports of RheoJAX."""
    (table,) = below("Time(s)", "\t", (0, 1, 2))(path)
    return [pd.DataFrame({0: table[0], 1: table[1] / table[2]})]


def creep_sheet(path):
    raw = pd.read_excel(path, sheet_name=0, header=None)
    at = next(i for i, row in raw.iterrows() if {"Time", "Compliance"} <= set(row))
    head, rows = list(raw.loc[at]), raw.loc[at + 2 :]
    return [rows[[head.index("Time"), head.index("Compliance")]].dropna().astype(float)]


def side_by_side(path):
    """Return the pairs of columns of a wide table, each with the first column."""
    table = pd.read_csv(path, skiprows=2, header=None, encoding="utf-8-sig")
    return [table[[0, i, i + 1]].dropna() for i in range(1, table.shape[1] - 1, 2)]


def json_lists(path):
    data = json.loads(path.read_text())["Experiment"]["Results"][0]["DataSet"][0]["Data"]
    table = pd.DataFrame(data["values"], columns=[c["name"] for c in data["columns"]])
    return [table[["Time", "Relaxation Modulus"]]]


TO_SI = {"Hz": 2 * np.pi, "rad/s": 1.0, "Pa": 1.0, "MPa": 1e6, "1/Pa": 1.0, "s": 1.0, "°C": 1.0}


def sheet_of(path):
    """Return the rows of a text or of the first sheet with more than ten rows, as text."""
    if path.suffix in (".xls", ".xlsx"):
        sheets = pd.read_excel(path, sheet_name=None, header=None, dtype=object)
        # the first sheet of frequencies, or the first one with a table
        tables = [t for t in sheets.values() if len(t) > 10]
        tables = [t for t in tables if "requency" in t.head(3).to_string()] + tables
        table = next((t for k, t in sheets.items() if "requency" in k), tables[0])
        return [["" if pd.isna(c) else str(c).strip() for c in row] for row in table.to_numpy()]
    text = text_of(path).replace("\r", "")
    return list(csv.reader(io.StringIO(text), delimiter="\t" if "\t" in text else ","))


def columns(*names):
    """Return a parse of columns by their whole headings, with units beside or below them.

    Rows without all numbers are samples of waves, or other text.
    """

    def parse(path):
        rows = sheet_of(path)
        known = [[cell.partition(" (")[0].strip("# ") for cell in row] for row in rows]
        words = [name.split("|") for name in names]
        at = next(i for i, row in enumerate(known) if all(set(w) & set(row) for w in words))
        places = [min(known[at].index(name) for name in w if name in known[at]) for w in words]
        beside = [re.search(r"[([](.*)[)\]]$", rows[at][i]) for i in places]
        below = next((r for r in rows[at + 1 : at + 4] if {"Pa", "[Pa]"} & set(r)), [""] * 99)
        units = [m[1] if m else below[i].strip("[]") for i, m in zip(places, beside, strict=True)]
        scale = [TO_SI.get(unit, 1.0) for unit in units]
        found = []
        for row in rows[at + 1 :]:
            try:
                values = [float(row[i].replace(",", ".")) for i in places]
            except (ValueError, IndexError):
                if found and path.suffix == ".xlsx" and names[0] == "Time":
                    break
                continue
            found.append([value * s for value, s in zip(values, scale, strict=True)])
        return [pd.DataFrame(found)]

    return parse


def rheowin(path):
    """Return the sweeps of a table, or of tables side by side, of RheoWin: segments that sweep."""
    rows, found = sheet_of(path), []
    for first in (i for i, name in enumerate(rows[0]) if name == "t in s"):
        names = ("f in Hz", "G' in Pa", 'G" in Pa', "T in °C")
        places = [rows[0].index(name, first) for name in names]
        filled = [row for row in rows[1:] if all(row[i].strip() for i in places)]
        numbers = [[float(row[i].replace(",", ".")) for i in places] for row in filled]
        table = pd.DataFrame(numbers)
        segment = [row[max(first - 1, 0)].partition("|")[0] for row in filled]
        sweeps = table.groupby(segment).filter(lambda part: part[0].nunique() > 1)
        found.append(sweeps * [HERTZ, 1, 1, 1])
    return found


HERTZ = 2 * np.pi
OMEGA = "Frequency|Angular Frequency"
MODULI = ("Storage Modulus", "Loss Modulus")
ARES = ("Angular frequency", "Storage modulus", "Loss modulus")
NEWER = (
    Recipe(("Thin-Rheology/*attempt FREQ4*.csv", "Thin-Rheology/*freq*.csv",
            "Thin-Rheology/*attempt 2.csv", "Thin-Rheology/*attempt2.csv",
            "Thin-Rheology/*CC_DG_expts*"), "dma", columns(OMEGA, *MODULI)),
    Recipe(("Thin-Rheology/*01-08-2021_air_creep*", "Thin-Rheology/*creep tests*"), "creep",
           columns("Time", "Creep Compliance")),
    Recipe(("rheology-data-toolkit/*Stress Relaxation 1.csv",), "relaxation",
           columns("Time", "Relaxation Modulus")),
    Recipe(("rheology-data-toolkit/*ARES_G2*",), "dma", columns(*ARES),
           celsius=columns(*ARES, "Temperature")),
    Recipe(("RheometerPlots/*viscoelastic-recovery*", "RheometerPlots/*frequency*sweep*"), "dma",
           rheowin, celsius=rheowin),
    Recipe(("dma-prony-validation/*tf_015p.csv",), "dma",
           columns("freq_hz", "G_storage_pa", "G_loss_pa"), (HERTZ, 1, 1),
           celsius=columns("freq_hz", "G_storage_pa", "G_loss_pa", "temperature_C")),
    Recipe(("perssonmodelling/*measured_dma.txt",), "dma",
           columns("Frequency", "E' Storage Modulus", "E'' Loss Modulus"), kind="E"),
    Recipe(("MATLAB-DMA2Prony/*.xlsx",), "dma",
           columns("Frequency", "Storage Modulus", "Loss Modulus"),
           celsius=columns("Frequency", "Storage Modulus", "Loss Modulus", "Temperature")),
)  # fmt: skip
RECIPES = (
    *NEWER,
    Recipe(("*freq_user_master.csv", "*freq_user_raw.csv"), "dma", below("f,", ",", (0, 1, 2)),
           (HERTZ, MEGA, MEGA)),
    Recipe(("*time_user_master.csv", "*time_user_raw.csv"), "relaxation", below("t,", ",", (0, 1)),
           (1, MEGA)),
    Recipe(("*__shift_factors.csv",), "shifts", below("T,", ",", (0, 1))),
    Recipe(("*freq_Eplexor*.xls",), "dma", excel("Exported Data", ("f", "E'|G'", "E''|G''")),
           (HERTZ, MEGA, MEGA)),
    Recipe(("*PI_634.5k_T-35.xlsx",), "dma",
           excel(0, ("w (rad/s)", "G'(Pa)", "G''(Pa)"), skip=(0,))),
    Recipe(("*creep_recovery.xlsx",), "creep", creep_sheet),
    Recipe(("*PI_94.9k_T-35_TH_h.tts",), "dma", either),
    Recipe(("*.osc", "*.tts"), "dma", from_second),
    Recipe(("*.gt",), "relaxation", step_of("gamma")),
    Recipe(("*.creep",), "creep", step_of("stress")),
    Recipe(("*frequency_sweep_tts.txt",), "dma", trios("", ARES), (1, MEGA, MEGA)),
    Recipe(("*multi_technique.txt",), "dma", trios("Frequency sweep", ARES), (1, MEGA, MEGA)),
    Recipe(("*creep_experiment.txt",), "creep", trios("Creep", ("Step time", "Compliance")),
           (60, 1 / MEGA)),
    Recipe(("*trios/frequency_sweep.csv",), "dma", below("rad/s", "\t", (1, 2, 3))),
    Recipe(("*trios/relaxation.json",), "relaxation", json_lists),
    Recipe(("*trios_synthetic_*mb.txt",), "relaxation", quotient),
    Recipe(("*rheocompass/creep_test.csv",), "creep", below("[s]", "\t", (0, 3))),
    Recipe(("*rheocompass/relaxation_test.csv",), "relaxation", below("[s]", "\t", (0, 3))),
    Recipe(("*rheocompass/frequency_sweep.csv", "*rheocompass/multi_interval.csv"), "dma",
           below("[rad/s]", "\t", (0, 1, 2))),
    Recipe(("*HC1_stressrelaxation*.csv",), "relaxation",
           below("[s]", "\t", (1, 4, 2), decimal=",")),
    Recipe(("*ttw_[0-9][0-9].csv",), "dma", side_by_side),
    Recipe(("*/stressrelaxation_*.csv", "*polypropylene_relaxation.csv",
            "*master_curve_ps_relaxation_data.csv", "*rel_lapo_*.csv",
            "*relaxation_hb_calibrated.csv", "*epm_relaxation_synthetic.csv",
            "*relaxation_modulus.csv", "*space_delimited.txt", "*tab_delimited.txt",
            "*relaxation_sample.csv"), "relaxation", either),
    Recipe(("*/creep_ps*.csv", "*polystyrene_creep.csv", "*creep_perihepatic_data.csv",
            "*creep_mucus_data.csv", "*creep_compliance.csv"), "creep", either),
    Recipe(("*/oscillation_*.csv", "*/ttw_*_*.csv", "*/foam_dma_*.csv", "*/cnf_0-3*.csv",
            "*/PI_*.csv", "*master_curve_ps_oscillation_data.csv", "*ps_saos_mc_data.csv",
            "*/epstein.csv", "*bayesian_owchirp_tts.csv"), "dma", either),
)  # fmt: skip


def celsius(path, name):
    """Return the temperatures that a file states [C], or None where it states none."""
    recipe = recipe_of(name, NEWER)
    if recipe is not None:
        tables = recipe.celsius(path) if recipe.celsius else []
        return pd.concat(tables).iloc[:, -1].to_numpy(dtype=float) if tables else None
    if fnmatch(name, "*freq_user_raw.csv"):
        return below("f,", ",", (3,))(path)[0].to_numpy().ravel()
    if fnmatch(name, "*time_user_raw.csv"):
        # a test has the mean of its points, which the file numbers
        table = below("t,", ",", (2, 3))(path)[0]
        return np.sort(table.groupby(3)[2].mean().to_numpy())
    if fnmatch(name, "*freq_Eplexor*.xls"):
        return excel("Exported Data", ("T",))(path)[0].to_numpy().ravel()
    if fnmatch(name, "*ttw_[0-9][0-9].csv"):
        head = pd.read_csv(path, nrows=1, header=None, encoding="utf-8-sig").to_numpy().ravel()
        return np.array([t for t in head.astype(float) if np.isfinite(t)])
    for word, step in (("frequency_sweep_tts", ""), ("multi_technique.txt", "Frequency sweep"),
                       ("creep_experiment", "Creep")):  # fmt: skip
        if word in name:
            return pd.concat(trios(step, ("Temperature",))(path)).to_numpy().ravel()
    if "HC1_" in name:
        return below("[s]", "\t", (6,), decimal=",")(path)[0].to_numpy().ravel()
    if "trios/relaxation.json" in name:
        data = json.loads(path.read_text())["Experiment"]["Results"][0]["DataSet"][0]["Data"]
        at = [column["name"] for column in data["columns"]].index("Temperature")
        return np.array([row[at] for row in data["values"]], dtype=float)
    if "creep_recovery.xlsx" in name:
        return np.array([25.0])
    text = path.read_bytes().decode("latin-1")
    if path.suffix in (".osc", ".tts", ".gt", ".creep"):
        stated = re.findall(r"(?:^|[;\s])T\s*=\s*([-\d.]+)", text.partition("\n")[0])
    else:
        stated = re.findall(r"(?m)^Temperature:?\s*([-\d.]+) *(?:\xc2?\xb0)?C", text)
    return np.array(stated, dtype=float) if stated else None


def other_temperature(test, stated):
    """Return what is wrong with the temperature that was read, or nothing."""
    if isinstance(test, tuple):
        found = np.array([each.temperature for each in test]) - 273.15
        same = stated is not None and np.allclose(found, stated, rtol=0, atol=1e-9)
        return "" if same else "other temperatures than the file states"
    found = np.atleast_1d(np.asarray(test.temperature, dtype=float)) - 273.15
    if stated is None:
        return "" if np.all(np.isnan(found)) else "a temperature that the file does not state"
    if isinstance(test, lab.FrequencySweeps):
        # of each point one that stands in the file; tables may hold more than the sweeps
        far = np.min(np.abs(found[:, None] - stated[None, :]), axis=1)
    else:
        far = np.abs(found - stated.mean()) - 0.5
    return "" if np.all(far < 1e-6) else "another temperature than the file states"


# ---- what is compared --------------------------------------------------------------------------


def expected(path, recipe):
    """Return the points of the independent parse, in SI, one row each, in a fixed order."""
    factors = recipe.factors
    tables = [table.to_numpy(dtype=float) for table in recipe.parse(path)]
    if "HC1_" in path.name:
        # strain within 5 % of its level, the middle of the upper half
        (table,) = tables
        strain = np.abs(table[:, 2])
        level = np.median(strain[strain > strain.max() / 2])
        tables = [table[np.abs(strain - level) <= 0.05 * level][:, :2]]
    if not tables:
        raise LookupError(f"the recipe finds nothing in {path}")
    points = np.concatenate([t[:, : 2 + (t.shape[1] > 2)] for t in tables])
    points = points * np.array(factors[: points.shape[1]])
    points = points[np.all(np.isfinite(points), axis=1)]
    if recipe.test != "shifts":
        points = points[np.all(points > 0, axis=1)]
    return ordered(points, recipe.test)


def ordered(points, test):
    # a sweep may repeat a row, of which one is used
    points = np.unique(points, axis=0) if test == "dma" else points
    return points[np.lexsort(points.T[::-1])]


def found(test, name):
    if name == "dma":
        return ordered(np.column_stack((test.angular_frequency, test.storage, test.loss)), name)
    if name == "shifts":
        points = np.column_stack((np.array(test.temperature) - 273.15, test.values))
    else:
        column = "modulus" if name == "relaxation" else "compliance"
        several = test if isinstance(test, tuple) else (test,)
        points = np.concatenate(
            [np.column_stack((each.time, getattr(each, column))) for each in several]
        )
    return ordered(points, name)


GIVEN = {
    "`modulus_unit`": ("modulus_unit", "Pa"),
    "`time_unit`": ("time_unit", "s"),
    "`frequency_unit`": ("frequency_unit", "rad/s"),
    "`temperature_unit`": ("temperature_unit", "degC"),
    "`kind`": ("kind", "G"),
}


def outcome(path, name):
    """Return the outcome and the words for one file."""
    recipe = recipe_of(name, RECIPES)
    refusal = next((r for r in EXPECTED["refused"] if fnmatch(name, r[0])), None)
    refusal = None if recipe in NEWER else refusal
    # a shift table is no test, and has a reader of its own
    shifts = (recipe and recipe.test == "shifts") or "TTS_Acierno" in name
    reader = lab.read_shifts if shifts else lab.read
    flags = {}
    try:
        try:
            test = reader(path)
        except InputError as error:
            flags = dict(GIVEN[flag] for flag in GIVEN if flag in str(error))
            if not flags or "does not state" not in str(error):
                raise
            test = reader(path, **flags)
    except InputError as error:
        words = str(error).replace(str(path), "")
        if refusal and re.search(refusal[1], words):
            return "refused", refusal[2]
        return "UNEXPECTED", words
    if refusal is not None or recipe is None:
        return "MISREAD", "read, and should have been refused, or no recipe is there"
    # steps at several temperatures are several tests
    kind = type(test[0] if isinstance(test, tuple) else test).__name__
    names = {"dma": "FrequencySweeps", "relaxation": "RelaxationTest", "creep": "CreepTest",
             "shifts": "TabulatedShift"}  # fmt: skip
    if kind != names[recipe.test]:
        return "MISREAD", f"read as {kind}"
    try:
        mine, theirs = found(test, recipe.test), expected(path, recipe)
    except Exception as error:
        return "MISREAD", f"no independent parse: {error!r}"
    if mine.shape != theirs.shape:
        return "MISREAD", f"{len(mine)} points, {len(theirs)} in the independent parse"
    if not np.allclose(mine, theirs, rtol=1e-9, atol=1e-9 if shifts else 0):
        return "MISREAD", "other numbers than the independent parse"
    if recipe.test != "shifts":
        tensile = ("_user_" in name or "Eplexor" in name) and "shear" not in name
        one = test[0] if isinstance(test, tuple) else test
        if one.kind != ("E" if tensile else recipe.kind):
            return "MISREAD", f"taken for kind {one.kind}"
        if wrong := other_temperature(test, celsius(path, name)):
            return "MISREAD", wrong
    if flags:
        missing = {"modulus_unit": "unit", "time_unit": "unit", "frequency_unit": "unit"}
        lacking = dict.fromkeys(missing.get(flag, flag.replace("_", " ")) for flag in flags)
        return "asked", "does not say " + ", ".join(lacking)
    return "read", f"{len(mine)} points"


def files_of(folders):
    for folder in map(Path, folders):
        for path in sorted(folder.rglob("*")):
            name = f"{folder.name}/{path.relative_to(folder)}"
            if (
                path.suffix.lower() not in EXPECTED["data"]
                or not path.is_file()
                or not path.stat().st_size
            ):
                continue
            if not any(fnmatch(name.lower(), word) for word in EXPECTED["no_data"]):
                yield name, path


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folders", nargs="+", metavar="FOLDER")
    parser.add_argument("--names", type=Path, help="write a CSV row for each file here")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    results = {name: outcome(path, name) for name, path in files_of(arguments.folders)}
    counts = Counter(kind for kind, _ in results.values())
    print(words_of(counts, len(results)))
    wrong = {name: why for name, why in results.items() if why[0] in ("MISREAD", "UNEXPECTED")}
    for name, (kind, why) in wrong.items():
        print(f"{kind} {name}: {why}")
    print("\n".join(rows_of(results)))
    if arguments.names is not None:
        with arguments.names.open("w", encoding="utf-8", newline="") as file:
            rows = [(name, kind, why) for name, (kind, why) in results.items()]
            csv.writer(file).writerows([("file", "outcome", "reason"), *rows])
    sys.exit(bool(wrong or not results))


def words_of(counts, total):
    lines = {
        "read": "read as they are, with the numbers of an independent parse",
        "asked": "read with the flags that the refusal names, with those numbers",
        "refused": "refused for a reason in the list",
        "MISREAD": "misread",
        "UNEXPECTED": "refused for another reason",
    }
    return "\n".join([f"{total} files", *(f"{counts[k]:5d} {v}" for k, v in lines.items())])


def rows_of(results):
    """Rows of a table: number of files by repository and outcome."""
    groups = Counter(
        (name.partition("/")[0], kind if kind == "read" else f"{kind}: {why}")
        for name, (kind, why) in results.items()
    )
    return [f"| {folder} | {kind} | {number} |" for (folder, kind), number in groups.items()]


if __name__ == "__main__":
    main()
