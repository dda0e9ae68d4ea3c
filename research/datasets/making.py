"""Compute a dataset: a campaign, refined reruns of its less accurate cases, and one output file.

A campaign has one accuracy setting. Most cases are far more accurate than required. Cases whose
error estimates exceed the targets are run again with a quarter of the error, and then with a
sixteenth. Each pass is a separate resumable campaign in the folder.
"""

import json
import os
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from viscotack.campaign import Plan, Progress, Store, read_plan, run
from viscotack.datasets.files import METADATA_KEY, plan_path
from viscotack.files.frame import arrow
from viscotack.files.whole import write_whole
from viscotack.version import __version__

from .columns import KEPT, units

# Refinement factor of each pass relative to the previous one, and number of passes.
_FINER, _PASSES = 4.0, 3
LICENCE = "CC BY 4.0"
CITATION = "The viscotack developers: open datasets of viscoelastic detachment, made with viscotack"


@dataclass(frozen=True)
class Targets:
    """Target relative errors of the pull-off force (or stress) and of the work to pull-off.

    Less accurate cases are run again with refinement.
    """

    force: float = 2e-3
    work: float = 5e-3


# Passes and targets of sets with other values.
_ONCE_MORE = (2, Targets(force=4e-3, work=2e-2))
# Sets for validation and testing, known to 0.1 %.
_TO_JUDGE = (2, Targets(force=2e-3, work=2e-2))
_OF_SETS = {
    "fresh": _TO_JUDGE,
    "unseen": _TO_JUDGE,
    "hard": _ONCE_MORE,
    "steep": _ONCE_MORE,
    "punch_faces": _ONCE_MORE,
    # surrogates trained on it have larger errors; rows state their uncertainty
    "solids": (1, Targets(force=4e-3, work=2e-2)),
    "rough": (1, Targets(force=2e-2, work=1e-1)),
    "deep": (1, Targets(force=2e-2, work=1e-1)),
    "sharp": (1, Targets(force=2e-2, work=1e-1)),
}


def make(
    name: str,
    folder: str | os.PathLike[str],
    *,
    workers: int = 1,
    targets: Targets | None = None,
    cases: int | None = None,
    report: Callable[[Progress], None] | None = None,
) -> Path:
    """Run the missing cases of a dataset, and return the path of its file, ``NAME.parquet``.

    The folder has the campaigns ``first``, ``finer-1`` and ``finer-2``; run again to continue. With
    `cases` only the first cases of the plan are computed, which for a Sobol plan cover the whole
    range. `report` is called for each campaign.
    """
    folder = Path(folder)
    passes, usual = _OF_SETS.get(name, (_PASSES, Targets()))
    targets = targets or usual
    plan = read_plan(plan_path(name))
    plan = replace(plan, cases=plan.cases[:cases])
    stores: list[Store] = []
    for number in range(passes):
        if not plan.cases:
            break
        place = folder / (f"finer-{number}" if number else "first")
        done = run(plan, place, workers=workers, report=report)
        if done.stopped:
            raise RuntimeError(f"the campaign was stopped; run again with {folder} to continue")
        stores.append(Store(place))
        plan = _uncertain(plan, stores[-1], targets)
    target = folder / f"{name}.parquet"
    write_dataset(name, stores, target, cases=cases)
    return target


def _uncertain(plan: Plan, store: Store, targets: Targets) -> Plan:
    """Return the refined plan of the cases that failed or exceed the targets."""
    limits = {"error_estimate": targets.force, "error_estimate_work": targets.work}
    missed = {
        row["name"]
        for row in store.results()
        if any(row.get(name) is None or row[name] > limit for name, limit in limits.items())
    }
    missed |= {row["name"] for row in store.failures()}
    return replace(
        plan,
        cases=tuple(case for case in plan.cases if case.name in missed),
        settings=replace(plan.settings, accuracy=plan.settings.accuracy / _FINER),
    )


def write_dataset(
    name: str, stores: list[Store], target: Path, *, cases: int | None = None
) -> None:
    """Write one file from campaigns of the same cases, each case from the last one that has it.

    Stated errors are the estimates of the solver, but at least those of columns.least_errors. With
    `cases` only the first cases of the plan are written, also from an unfinished campaign.
    """
    pa = arrow()
    rows: dict[str, Mapping[str, Any]] = {}
    for store in stores:
        accuracy = store.settings.accuracy
        for row in store.results():
            if row.get("error_estimate") is not None:  # otherwise its accuracy is unknown
                rows[row["name"]] = row | {"accuracy": accuracy}
    planned = [case.name for case in stores[0].cases()[:cases]]
    solved = [rows[case] for case in planned if case in rows]
    kind = stores[0].facts["kind"]
    columns = {
        column.name: pa.array([column.value(row) for row in solved], column.type(pa))
        for column in KEPT[kind]
    }
    facts = {
        "name": name,
        "licence": LICENCE,
        "citation": CITATION,
        "viscotack": __version__,
        "made": sorted({begun["began"][:10] for store in stores for begun in store.runs()}),
        "settings": [asdict(store.settings) for store in stores],
        "cases": len(planned),
        "failures": [
            {key: value for key, value in row.items() if key not in ("name", "wall_time_s")}
            for row in stores[0].failures()
            if row["name"] in planned and row["name"] not in rows
        ],
        "columns": units(kind),
        "plan": plan_path(name).read_text(encoding="utf-8"),
    }
    table = pa.table(columns).replace_schema_metadata({METADATA_KEY: json.dumps(facts)})
    sink = pa.BufferOutputStream()
    pa.parquet.write_table(table, sink, compression="zstd", compression_level=19)
    write_whole(target, sink.getvalue())
