"""Numbers of pages that are computed when the pages are compared, each in less than a second.

A function returns a number, names with numbers, or the lines of a table; `records.py` says how a
page names it. To add one, write it and name it in `COMPUTED`.
"""

from __future__ import annotations

import json
import re
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from steady_crack import LAWS, SPEEDS, standard

from viscotack import datasets as sets
from viscotack.forecast import predict
from viscotack.operations.parts.library import library_table
from viscotack.problem.case_file import case_of_tables
from viscotack.protocol import AtForce, Retraction
from viscotack.surrogate import store
from viscotack.theory import SteadyCrack, lennard_jones, maugis, punch

ROOT = Path(__file__).resolve().parents[1]
# Versions in the table of costs.
LINES = 4


def steady_crack() -> list[str]:
    """Return the energies of the steady crack, a row for opening and one for closing."""
    crack = SteadyCrack(standard(), LAWS["Lennard-Jones"])
    opening, closing = (crack.amplification(sign * SPEEDS) for sign in (1, -1))
    return [
        f"| V | {' | '.join(f'{v:,g}' for v in SPEEDS)} |",
        "|---" * (len(SPEEDS) + 1) + "|",
        f"| opening | {' | '.join(f'{x:.{_decimals(x)}f}' for x in opening)} |",
        f"| closing | {' | '.join(f'{x:.4f}' for x in closing)} |",
    ]


def shore() -> list[str]:
    """Return Young's moduli by Shore A hardness, by Gent's relation."""
    S = np.arange(20, 81, 10)
    E = 0.0981 * (56 + 7.62336 * S) / (0.137505 * (254 - 2.54 * S))
    return [
        f"| Shore A | {' | '.join(map(str, S))} |",
        "|---" * (len(S) + 1) + "|",
        f"| E, MPa | {' | '.join(f'{x:.2f}' for x in E)} |",
    ]


def gripper_tip() -> list[str]:
    """Return pull-off forces of the tip of docs/grippers.md [mN], a row for each preload."""
    words = re.search(r"```toml\n(.*?)```", (ROOT / "docs/grippers.md").read_text("utf-8"), re.S)
    assert words is not None, "the page states the tip"
    tip = case_of_tables(tomllib.loads(words[1]))
    speeds, preloads = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2), (1e-4, 5e-3, 0.1)
    rows = ["| preload, mN | 1 um/s | 10 um/s | 100 um/s | 1 mm/s | 10 mm/s |", "|---:" * 6 + "|"]
    for preload in preloads:
        pulls = (Retraction(AtForce(preload), speed) for speed in speeds)
        forces = [predict(replace(tip, protocol=pull)).pull_off_force for pull in pulls]
        unit = 1e3 * tip.scales().force
        rows.append(f"| {1e3 * preload:g} | {' | '.join(f'{unit * x:.2f}' for x in forces)} |")
    return rows


def punch_envelope() -> list[str]:
    """Return the exact pull-off stress of a layer over the larger of its two limits."""
    b = np.array([0.05, 0.2, 0.5, 1.0, 4 / np.pi, 2.0, 5.0, 10.0])
    kind = {"contact_modulus": 1.0, "work_of_adhesion": 1.0}
    exact = punch.crossover.pull_off_stress(b, half_width=1.0, base=punch.Frictionless(), **kind)
    thin = punch.laws.thin_layer_pull_off_stress(b, base=punch.Frictionless(), **kind)
    wide = punch.laws.half_plane_pull_off_stress(1.0, **kind)
    ratio = exact / np.maximum(thin, wide)
    heads = ["4/pi" if abs(x - 4 / np.pi) < 1e-9 else f"{x:g}" for x in b]
    return [
        f"| b/a | {' | '.join(heads)} |",
        "|---" * (len(b) + 1) + "|",
        f"| exact over envelope | {' | '.join(f'{x:.3f}' for x in ratio)} |",
    ]


def published() -> dict[str, float]:
    """Return what the page of the published table, which its command writes, states of all rows."""
    text = " ".join((ROOT / "replication/published/README.md").read_text("utf-8").split())
    found = re.search(
        r"([\d,]+) rows of the table .*?differs by (\S+) % in the median; 95 % of the rows are "
        r"below (\S+) %, the largest is (\S+) %.*?took (\d+) s .*?(\d+) rows are off by more than "
        r"2 %.*?is off by \S+ % in the median and (\S+) % at most",
        text,
    )
    assert found is not None
    rows, median, below, largest, seconds, apart, ours = (
        float(each.replace(",", "")) for each in found.groups()
    )
    shares = {"median": median, "below": below, "largest": largest, "ours": ours}
    counts = {"rows": rows, "seconds": seconds, "apart": apart}
    return counts | {name: percent / 100 for name, percent in shares.items()}


def verification() -> dict[str, float]:
    """Return what the page of comparisons, which its command writes, states of forces."""
    page = (ROOT / "docs/verification.md").read_text("utf-8")
    elastic = re.findall(r"(?m)^\| elastic, .* \| peer \|.*\(([-+.\d]+) %\)", page)
    found = re.search(
        r"pull-off of (\d+) published detachments .*?median ([\d.]+) %, 95 % below ([\d.]+) %", page
    )
    assert elastic and found is not None
    rows, median, below = (float(x) for x in found.groups())
    largest = max(abs(float(x)) for x in elastic)
    shares = {"elastic": largest, "median": median, "below": below}
    return {"rows": rows} | {name: percent / 100 for name, percent in shares.items()}


def elastic_pull_off() -> list[str]:
    """Return simulated elastic pull-off forces and those of Maugis by the Tabor number."""
    words = {
        0.01: "`theory.bradley` (4/3)",
        0.1: "simulate; Maugis is {:.0f} % low",
        0.3: "simulate; Maugis is {:.0f} % low",
        1.0: "simulate; Maugis is {:.0f} % low",
        3.24: "`theory.jkr` (1) is {:.0f} % low",
        5.0: "`theory.jkr` is {:.0f} % low",
    }
    rows = []
    for tabor, use in words.items():
        force = float(lennard_jones.pull_off_ratio(tabor))
        strength = 16 / (9 * np.sqrt(3)) * tabor
        unit = {"radius": 1.0, "contact_modulus": 1.0, "work_of_adhesion": 1.0}
        other = maugis.pull_off_force(strength=strength, **unit) / (1.5 * np.pi)
        low = 100 * (1 - (other if "Maugis" in use else 1.0) / force)
        shown = f"{other:.3f}" if tabor > 0.05 else ""
        rows.append(f"| {tabor:g} | {force:.3f} | {shown} | {use.format(low)} |")
    return ["| μ | simulated | Maugis | use |", "|---:|---:|---:|---|", *rows]


def ranges() -> dict[str, list[str]]:
    """Return the ranges of the surrogates of spheres and punches, as tables."""
    remarks = {
        "sphere": {
            "tabor": "",
            "modulus_ratio": "rubbery over glassy",
            "exponent": "of power laws",
            "preload": "h0; starts by force or radius are turned into a depth",
            "rate": "h0/tau0; of power laws, others may be pulled at any",
        },
        "punch": {
            "size": "half width, a0",
            "thickness": "a0",
            "modulus_ratio": "rubbery over glassy",
            "preload": "sigma0, about; the depths that this is follow from size and thickness, "
            "and a refusal says them",
            "rate": "h0/tau0, tau0 the retardation time",
        },
    }
    names = {"tabor": "Tabor number", "modulus_ratio": "modulus ratio"}
    found = {}
    for contact, remark in remarks.items():
        limits = store.load(store.FILES[contact]).limits
        rows = ["| input | from | to | remark |", "|---|---:|---:|---|"]
        for key, words in remark.items():
            name = "stress of the start" if (contact, key) == ("punch", "preload") else key
            low, high = (f"{x:g}".replace("e+0", "e").replace("e+", "e") for x in limits[key])
            row = f"| {names.get(name, name)} | {low} | {high} | {words} |"
            rows.append(row.replace("  ", " "))
        found[contact] = rows
    return found


def replication() -> dict[str, float]:
    """Return figures and minutes of processor time of the kept numbers of the replication."""
    kept = [json.loads(x.read_text("utf-8")) for x in (ROOT / "replication/kept").glob("*.json")]
    seconds = sum(each["processor_seconds"] for each in kept)
    return {"parts": len(kept), "minutes": seconds / 60}


def datasets() -> dict[str, dict[str, float]]:
    """Return rows and size of each published set, and the size of all."""
    from pyarrow.parquet import read_metadata

    found = {}
    for name in sets.NAMES:
        path = sets.path(name)
        size = path.stat().st_size / 1e6
        found[name] = {"rows": read_metadata(path).num_rows, "megabytes": size}
    found["all"] = {"megabytes": sum(each["megabytes"] for each in found.values())}
    return found


def coverage_of_spheres() -> list[str]:
    """Return least, median and largest value of each input and of the force, a row for each set."""
    columns = ("tabor", "modulus_ratio", "exponent", "preload", "rate", "pull_off_force")
    return _coverage(("thesis", "broad", "chosen", "fast", "solids", "rough"), columns)


def coverage_of_punches() -> list[str]:
    """Return least, median and largest value of each input and of the stress, a row a set."""
    columns = ("size", "thickness", "cohesion", "modulus_ratio", "preload", "rate")
    names = ("punch", "punch_limits", "punch_starts")
    return _coverage(names, (*columns, "pull_off_stress"))


def _coverage(names: tuple[str, ...], columns: tuple[str, ...]) -> list[str]:
    from pyarrow.parquet import read_table

    rows = []
    for name in names:
        table, cells = read_table(sets.path(name)), []
        for column in columns:
            values = np.zeros(0)
            if column in table.column_names:
                values = table[column].to_numpy().astype(float)
            values = values[np.isfinite(values)]
            three = (values.min(), np.median(values), values.max()) if len(values) else ()
            # one number where all rows have it
            cells.append(", ".join(dict.fromkeys(f"{x:.3g}" for x in three)))
        rows.append(f"| `{name}` | {' | '.join(cells)} |")
    heads = " | ".join(f"`{column}`" for column in columns)
    return [f"| set | {heads} |", "|---" * (len(columns) + 1) + "|", *rows]


def library() -> list[str]:
    """Return the table of the published materials."""
    return library_table().split("\n")


def public_files() -> dict[str, float]:
    """Return how many public files are read and refused, from the page that its command writes."""
    page = (ROOT / "docs/public-files.md").read_text("utf-8")
    found = re.search(
        r"(\d+) files\n +(\d+) read as .*\n +(\d+) read with .*\n +(\d+) refused", page
    )
    assert found is not None
    files, bare, flagged, refused = (float(x) for x in found.groups())
    counts = {"files": files, "bare": bare, "flagged": flagged, "refused": refused}
    return counts | {"read": bare + flagged}


def history() -> list[str]:
    """Return a table of the last lines of the history of costs, a column each."""
    lines = [json.loads(x) for x in (ROOT / "benchmarks/history.jsonl").read_text().splitlines()]
    lines = lines[-LINES:]
    rows = []
    for kind, unit in (("times", ""), ("instructions", ", 1e9 instructions")):
        for name in lines[-1][kind]:
            found = (f"{x[kind][name]:.3g}" if name in x[kind] else "-" for x in lines)
            rows.append(f"| {name}{unit} | {' | '.join(found)} |")
    heads = " | ".join(f"`{line['commit']}`, {line['date']}" for line in lines)
    return [f"| | {heads} |", "|---" + "|---:" * len(lines) + "|", *rows]


COMPUTED: dict[str, Any] = {
    function.__name__: function
    for function in (
        steady_crack,
        shore,
        gripper_tip,
        punch_envelope,
        published,
        verification,
        elastic_pull_off,
        ranges,
        replication,
        datasets,
        coverage_of_spheres,
        coverage_of_punches,
        library,
        public_files,
        history,
    )
}


def _decimals(value: float) -> int:
    return 4 if value < 1.1 else 3
