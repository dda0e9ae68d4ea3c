"""Judge the shipped surrogates, by cases whose seed is drawn after their checksums are fixed.

`python -m benchmarks.judging sums` writes the checksums of the files of the surrogates into
`judging/models.sha256`, to be committed. `draw` draws a seed from the entropy of the system and
writes it into a record, `judging/SEED.json`, with the checksums of the files that its designs need;
it refuses if the committed checksums are not those of the files, or if a record of one of these
designs waits for its judgement. `label --labels FOLDER` simulates these cases
(`training/fresh_cases.py`) in their order, whose beginning has its share of each design; a run that
was stopped continues. `judge --labels FOLDER` judges those that have a label, and writes their
number, the table, the worst cases and every result into the record and a CSV beside it, once. Both
take the newest record without a judgement, or `--seed`. `page` writes all records of the shipped
files into docs/surrogate.md.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import json
import secrets
import subprocess
from collections.abc import Iterator, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from training.contacts import FAMILIES
from training.fresh_cases import DESIGNS, LARGEST, Case, add_counts, counts_of, drawn, labelled
from viscotack.surrogate import physics, store

from .fresh_coverage import OF, Judged, answered, judged, table
from .surrogate_page import PAGE, replaced

FOLDER = Path(__file__).with_name("judging")
SUMS = FOLDER / "models.sha256"
COUNTS = {"power laws": 1500, "other solids": 700, "punches": 500, "two peaks": 300}
ACCURACY, WORST = 2e-4, 5
# Cases of a leaf of a tree that looks for places where intervals fail.
LEAF = 150
# Contacts of the surrogates that answer the cases of each design.
_SPHERES = ("sphere", "solids", "short range")
NEEDED = dict.fromkeys(FAMILIES, _SPHERES) | {
    "power laws": ("sphere",),
    "faces": ("sphere",),
    "light tension": ("sphere",),
    "other solids": ("sphere", "solids"),
    "two peaks": ("sphere", "solids"),
    "large Tabor numbers": ("sphere", "short range"),
    "punches": ("punch",),
    "soft punches": ("punch",),
    "shallow soft punches": ("punch",),
    "wide punches": ("punch",),
    "stamps": ("punch",),
}
_COLUMNS = ("design", "kind", "inputs", "method", *(f"{x}, half widths" for x in OF))
_OFF = ("force, off", "work, off", "joint")


def checksums() -> dict[str, str]:
    """Return the checksum of the file of each surrogate."""
    files = sorted(store.FILES.values())
    return {x.name: hashlib.sha256(x.read_bytes()).hexdigest() for x in files}


def sums() -> str:
    """Return the checksums of the files of the surrogates, as `sha256sum` prints them."""
    return "".join(f"{value}  {name}\n" for name, value in checksums().items())


def models(designs: Mapping[str, Any]) -> dict[str, str]:
    """Return the checksums of the files that answer the cases of some designs."""
    files = {store.FILES[x].name for name in designs for x in NEEDED[name]}
    return {name: value for name, value in checksums().items() if name in files}


def records() -> dict[Path, dict[str, Any]]:
    """Return all records by their files, the newest first."""
    found = {path: json.loads(path.read_text(encoding="utf-8")) for path in FOLDER.glob("*.json")}
    return dict(sorted(found.items(), key=lambda pair: pair[1]["drawn"], reverse=True))


def draw(counts: dict[str, int]) -> Path:
    """Draw the seed of the cases that judge the shipped files, and begin their record."""
    name = f"HEAD:./{SUMS.relative_to(Path.cwd())}"
    committed = subprocess.run(["git", "show", name], capture_output=True, text=True, check=True)
    if committed.stdout != sums():
        raise SystemExit(f"commit {SUMS.name} first: it differs from the files")
    for path, record in records().items():
        if "table" not in record and set(record["counts"]) & set(counts):
            raise SystemExit(f"judge {path.name} first")
    begun = {
        "drawn": datetime.now(UTC).isoformat(timespec="seconds"),
        "seed": secrets.randbits(31),
        "counts": counts,
        "accuracy": ACCURACY,
        "models": models(counts),
    }
    path = FOLDER / f"{begun['seed']}.json"
    path.write_text(json.dumps(begun, indent=1) + "\n", encoding="utf-8")
    return path


def waiting(seed: int | None) -> Path:
    """Return the newest record without a judgement, or that of a seed."""
    for path, record in records().items():
        if "table" not in record and seed in (None, record["seed"]):
            if record["models"] != models(record["counts"]):
                raise SystemExit(f"{path.name} is of other files")
            return path
    raise SystemExit("no such record waits for its judgement")


def _too_large(case: Case) -> bool:
    """Whether a simulation of a contact would take minutes."""
    spherical = case.kind == "contact" and not case.inputs["stamp"]
    return spherical and case.problem.tabor > LARGEST


def known(
    record: dict[str, Any], labels: Path, *, missing: bool
) -> Iterator[tuple[Case, dict[str, Any]]]:
    """Iterate over cases of a record with labels; missing ones are simulated, or left out."""
    cases = [case for case in drawn(record["seed"], record["counts"]) if not _too_large(case)]
    return labelled(cases, labels, record["accuracy"], missing=missing, needed=answered)


def judge(labels: Path, seed: int | None) -> dict[str, Any]:
    """Judge the cases of a record that have a label, and complete it."""
    path = waiting(seed)
    record = json.loads(path.read_text(encoding="utf-8"))
    pairs = list(known(record, labels, missing=False))
    # labels are made in order; what follows the last one was not reached
    pairs = pairs[: max(i for i, (_, label) in enumerate(pairs, 1) if label)]
    found = [judged(case, label) for case, label in pairs if "failed" not in label]
    _write_cases(path.with_suffix(".csv"), found)
    record |= {
        "judged": datetime.now(UTC).isoformat(timespec="seconds"),
        "cases": len(pairs),
        "without a label": len(pairs) - len(found),
        "table": table(found),
        "leaves": leaves(found),
        "worst": [words(one) for one in worst(found)],
    }
    path.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    return record


def leaves(found: list[Judged]) -> str:
    """Return what intervals hold in the leaves of trees grown on the other half, in words.

    "" for too few cases.
    """
    from sklearn.tree import DecisionTreeRegressor

    found = [one for one in found if one.case.kind == "sphere" and one.case.inputs["tabor"] <= 10]
    if len(found) < 4 * LEAF:
        return ""
    place = physics.scaled(np.array([[x.case.inputs[n] for n in physics.INPUTS] for x in found]))
    ratio = np.array([one.ratio for one in found])
    words = []
    for name, over in zip(OF, ratio.T, strict=True):
        known = np.flatnonzero(np.isfinite(over))
        grown, other = known[::2], known[1::2]
        tree = DecisionTreeRegressor(min_samples_leaf=LEAF, random_state=0)
        tree.fit(place[grown], over[grown] > 1)
        of = tree.apply(place[other])
        held = [float(np.mean(over[other][of == leaf] <= 1)) for leaf in np.unique(of)]
        words.append(f"{name} {', '.join(f'{x:.1%}' for x in sorted(held))}")
    return "; ".join(words)


def worst(found: list[Judged], count: int = WORST) -> list[Judged]:
    """Return the answered cases whose force or work lies furthest out of its interval."""
    known = [one for one in found if one.method]
    return sorted(known, key=lambda one: -max(x for x in one.ratio[:2] if x == x))[:count]


def words(one: Judged) -> str:
    """Return a case and its errors in words."""
    inputs = ", ".join(f"{name} {value:g}" for name, value in one.case.inputs.items())
    errors = ", ".join(
        f"{name} off by {off:.2%} ({ratio:.1f} half widths)"
        for name, off, ratio in zip(OF, one.off, one.ratio, strict=False)
        if off == off
    )
    return f"{one.case.design}: {inputs}: {errors}"


def page() -> str:
    """Return what the records of the shipped files say together, in words and a table."""
    found: list[Judged] = []
    said = []
    for path, record in records().items():
        counts, now = record["counts"], checksums()
        of = [x for x in counts if all(record["models"][n] == now[n] for n in _files(x))]
        some = [one for one in _read_cases(path.with_suffix(".csv")) if one.case.design in of]
        if "table" not in record or not some:
            continue
        found += some
        said.append(
            f"Drawn {record['drawn']}, seed {record['seed']}, simulated at {record['accuracy']:g}: "
            f"the first {record['cases']} of {sum(counts.values())} in an order at random; "
            f"{record['without a label']} without an answer of the simulation; "
            f"{len(some)} of the designs whose surrogates are the shipped ones."
        )
    found.sort(key=lambda one: list(DESIGNS).index(one.case.design))
    if held := leaves(found):
        said.append(
            f"Trees with leaves of {LEAF} spheres on power laws or more, grown on one half to find "
            f"where intervals fail; in the other half, intervals hold in each leaf: {held}."
        )
    cases = "\n".join(f"- {words(one)}" for one in worst(found, 2 * WORST))
    return "\n\n".join(
        [*said, table(found), f"The cases furthest out of their intervals:\n\n{cases}"]
    )


def _files(design: str) -> list[str]:
    return [store.FILES[contact].name for contact in NEEDED[design]]


def _write_cases(path: Path, found: list[Judged]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([*_COLUMNS, *_OFF])
        for one in found:
            figures = (*one.ratio, *one.off, one.joint)
            numbers = [f"{x:.6g}" if x == x else "" for x in figures]
            case = one.case
            inputs = json.dumps(case.inputs)
            writer.writerow([case.design, case.kind, inputs, one.method, *numbers])


def _read_cases(path: Path) -> list[Judged]:
    if not path.exists():
        return []
    found = []
    with path.open(newline="", encoding="utf-8") as file:
        for design, kind, inputs, method, *numbers in list(csv.reader(file))[1:]:
            figures = np.array([float(x or "nan") for x in numbers])
            case = Case(design, kind, json.loads(inputs))
            ratio, off = figures[: len(OF)], figures[len(OF) : -1]
            found.append(Judged(case, method, "", ratio, off, float(figures[-1])))
    return found


def main() -> None:
    """Write checksums, draw or judge."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("step", choices=("sums", "draw", "label", "judge", "page"))
    parser.add_argument("--labels", type=Path, help="folder of the labels")
    parser.add_argument("--seed", type=int, help="of the record")
    add_counts(parser, COUNTS)
    given = parser.parse_args()
    if given.step == "sums":
        FOLDER.mkdir(exist_ok=True)
        SUMS.write_text(sums(), encoding="utf-8")
    elif given.step == "draw":
        print(draw(counts_of(given.counts)))
    elif given.step == "page":
        text = PAGE.read_text(encoding="utf-8")
        found = replaced(text, "<!-- judged -->", "<!-- end of judged -->", page())
        PAGE.write_text(found, encoding="utf-8")
    elif given.labels is None:
        parser.error(f"{given.step} needs --labels")
    elif given.step == "label":
        record = json.loads(waiting(given.seed).read_text(encoding="utf-8"))
        for number, _ in enumerate(known(record, given.labels, missing=True), 1):
            print(number, flush=True)
    else:
        print(judge(given.labels, given.seed)["table"])


if __name__ == "__main__":
    main()
