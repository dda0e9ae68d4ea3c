"""Judge the shipped surrogates once, by cases whose seed is drawn after their checksums are fixed.

`python -m benchmarks.judging sums` writes the checksums of the files of the surrogates into
`judging/models.sha256`, to be committed. `draw` draws a seed from the entropy of the system and
writes it into a record, `judging/NAME.json`; it refuses if the committed checksums are not those of
the files, or if these were judged before. `label --labels FOLDER` simulates these cases
(`training/fresh_cases.py`) in their order, whose beginning has its share of each design; a run that
was stopped continues. `judge --labels FOLDER` judges those that have a label, and writes their
number, the table, the worst cases and every result into the record and a CSV beside it, once.
`page` writes the record into docs/surrogate.md.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import json
import secrets
import subprocess
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from training.fresh_cases import DESIGNS, Case, drawn, labelled
from viscotack.surrogate import physics, store

from .fresh_coverage import OF, Judged, answered, judged, table
from .surrogate_page import PAGE, replaced

FOLDER = Path(__file__).with_name("judging")
SUMS = FOLDER / "models.sha256"
COUNTS, ACCURACY, WORST = (1500, 700, 500, 300, 200), 2e-4, 5
# Cases of a leaf of a tree that looks for places where intervals fail.
LEAF = 150


def sums() -> str:
    """Return the checksums of the files of the surrogates, as `sha256sum` prints them."""
    files = sorted(store.FILES.values())
    return "".join(f"{hashlib.sha256(x.read_bytes()).hexdigest()}  {x.name}\n" for x in files)


def record_path() -> Path:
    """Return the record of the shipped files."""
    return FOLDER / f"{hashlib.sha256(sums().encode()).hexdigest()[:12]}.json"


def draw(counts: tuple[int, ...]) -> Path:
    """Draw the seed of the cases that judge the shipped files, and begin their record."""
    name = f"HEAD:./{SUMS.relative_to(Path.cwd())}"
    committed = subprocess.run(["git", "show", name], capture_output=True, text=True, check=True)
    if committed.stdout != sums():
        raise SystemExit(f"commit {SUMS.name} first: it differs from the files")
    path = record_path()
    if path.exists():
        raise SystemExit(f"these files have the record {path.name}")
    begun = {
        "drawn": datetime.now(UTC).isoformat(timespec="seconds"),
        "seed": secrets.randbits(31),
        "counts": counts,
        "accuracy": ACCURACY,
    }
    path.write_text(json.dumps(begun, indent=1) + "\n", encoding="utf-8")
    return path


def known(
    record: dict[str, Any], labels: Path, *, missing: bool
) -> Iterator[tuple[Case, dict[str, Any]]]:
    """Iterate over cases of a record with labels; missing ones are simulated, or left out."""
    cases = drawn(record["seed"], tuple(record["counts"]))
    return labelled(cases, labels, record["accuracy"], missing=missing, needed=answered)


def judge(labels: Path) -> dict[str, Any]:
    """Judge the cases of the record that have a label, and complete it."""
    path = record_path()
    record = json.loads(path.read_text(encoding="utf-8"))
    if "table" in record:
        raise SystemExit(f"{path.name} was judged on {record['judged']}")
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
        "leaves": leaves([one for one in found if one.case.kind == "sphere"]),
        "worst": [words(one) for one in worst(found)],
    }
    path.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    return record


def leaves(found: list[Judged]) -> str:
    """Return what intervals hold in the leaves of trees grown on the other half, in words.

    "" for too few cases.
    """
    from sklearn.tree import DecisionTreeRegressor

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


def worst(found: list[Judged]) -> list[Judged]:
    """Return the answered cases whose force or work lies furthest out of its interval."""
    known = [one for one in found if one.method]
    return sorted(known, key=lambda one: -max(x for x in one.ratio[:2] if x == x))[:WORST]


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
    """Return the records in words; each design as its newest record has it."""
    records = [json.loads(path.read_text(encoding="utf-8")) for path in FOLDER.glob("*.json")]
    records.sort(key=lambda record: record["drawn"], reverse=True)
    known = [record for record in records if "table" in record]
    head, rows, said, worst_cases = "", {}, [], []
    for record in known:
        first, line, *others = record["table"].splitlines()
        head = f"{first}\n{line}"
        new = {row.split(" | ")[0]: row for row in others if not row.startswith("| all")}
        fresh = {name: row for name, row in new.items() if name not in rows}
        rows |= fresh
        if not fresh:
            continue
        said.append(
            f"Drawn {record['drawn']}, seed {record['seed']}, simulated at "
            f"{record['accuracy']:g}: the first {record['cases']} of {sum(record['counts'])} in an "
            f"order at random; {record['without a label']} without an answer of the simulation."
            + (f" {_of_leaves(record['leaves'])}" if record["leaves"] else "")
        )
        of = tuple(name.removeprefix("| ") for name in fresh)
        worst_cases += [words_ for words_ in record["worst"] if words_.startswith(of)]
    table_ = "\n".join([head, *rows.values()])
    cases = "\n".join(f"- {each}" for each in worst_cases)
    return (
        "\n\n".join([*said, table_]) + f"\n\nThe cases furthest out of their intervals:\n\n{cases}"
    )


def _of_leaves(held: str) -> str:
    return (
        f"Trees with leaves of {LEAF} spheres on power laws or more, grown on one half to find "
        f"where intervals fail; in the other half, intervals hold in each leaf: {held}."
    )


def _write_cases(path: Path, found: list[Judged]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        over = [f"{name}, half widths" for name in OF]
        writer.writerow(["design", "inputs", "method", *over, "force, off", "work, off"])
        for one in found:
            numbers = [f"{x:.4g}" if x == x else "" for x in (*one.ratio, *one.off)]
            writer.writerow([one.case.design, json.dumps(one.case.inputs), one.method, *numbers])


def main() -> None:
    """Write checksums, draw or judge."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("step", choices=("sums", "draw", "label", "judge", "page"))
    parser.add_argument("--labels", type=Path, help="folder of the labels")
    parser.add_argument("--counts", type=int, nargs=len(DESIGNS), default=COUNTS)
    given = parser.parse_args()
    if given.step == "sums":
        FOLDER.mkdir(exist_ok=True)
        SUMS.write_text(sums(), encoding="utf-8")
    elif given.step == "draw":
        print(draw(tuple(given.counts)))
    elif given.step == "page":
        text = PAGE.read_text(encoding="utf-8")
        found = replaced(text, "<!-- judged -->", "<!-- end of judged -->", page())
        PAGE.write_text(found, encoding="utf-8")
    elif given.labels is None:
        parser.error(f"{given.step} needs --labels")
    elif given.step == "label":
        record = json.loads(record_path().read_text(encoding="utf-8"))
        for number, _ in enumerate(known(record, given.labels, missing=True), 1):
            print(number, flush=True)
    else:
        print(judge(given.labels)["table"])


if __name__ == "__main__":
    main()
