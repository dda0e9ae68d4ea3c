"""Make a dataset: a campaign, its less certain cases again and finer, and one file of it all.

A campaign has one accuracy. Most cases are far better than it, some are not: those whose error
estimates miss the targets are run again with a quarter of the error, and with a sixteenth. Each
pass is a campaign of its own in the folder, and so resumable.
"""

import json
import os
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from viscotack.files.arrow import arrow
from viscotack.files.whole import write_whole
from viscotack.version import __version__

from ..campaign import Plan, Progress, Store, read_plan, run
from .columns import KEPT, units
from .files import METADATA_KEY, plan_path

# How much finer each pass is than the one before it, and how many there are.
_FINER, _PASSES = 4.0, 3
LICENCE = "CC BY 4.0"
CITATION = "The viscotack developers: open datasets of viscoelastic detachment, made with viscotack"


@dataclass(frozen=True)
class Targets:
    """Largest relative errors that a case should have; a less certain one is run again, finer.

    Attributes
    ----------
    force, work : float
        Of the pull-off force (or stress) and of the work to pull-off.
    """

    force: float = 2e-3
    work: float = 5e-3


# Passes and targets of a set that are not those of the others.
_ONCE_MORE = (2, Targets(force=4e-3, work=2e-2))
# Of those that measure and judge what is known to 0.1 %.
_TO_JUDGE = (2, Targets(force=2e-3, work=2e-2))
_OF_SETS = {
    "fresh": _TO_JUDGE,
    "unseen": _TO_JUDGE,
    "hard": _ONCE_MORE,
    "steep": _ONCE_MORE,
    "punch_faces": _ONCE_MORE,
    # what is learned from it errs by more; rows state what they are uncertain by
    "solids": (1, Targets(force=4e-3, work=2e-2)),
    "rough": (1, Targets(force=2e-2, work=1e-1)),
}


def how(name: str) -> tuple[int, Targets]:
    """Return how many passes a set is run in, and the errors that its cases should have."""
    return _OF_SETS.get(name, (_PASSES, Targets()))


def make(
    name: str,
    folder: str | os.PathLike[str],
    *,
    workers: int = 1,
    targets: Targets | None = None,
    cases: int | None = None,
    report: Callable[[Progress], None] | None = None,
) -> Path:
    """Run what of a dataset has not been run, and return the file of it.

    Parameters
    ----------
    name : str
        One of ``viscotack.datasets.NAMES``, whose plan is run.
    folder : path
        Where the campaigns are kept, ``first``, ``finer-1`` and ``finer-2``; run again to go on.
    workers : int
        Processes.
    targets : Targets, optional
        Which errors make a case run again; leave it out for 0.2 % and 0.5 %, and for `fresh` and
        `hard` 0.4 % and 2 %, which have one finer pass; `solids` and `rough` have none.
    cases : int, optional
        Only so many cases from the beginning of the plan, which for a Sobol fill are spread over
        the whole range.
    report : callable, optional
        Called with the progress of each campaign.

    Returns
    -------
    Path
        ``NAME.parquet`` in the folder.

    Raises
    ------
    RuntimeError
        If a campaign was stopped before its end.
    """
    folder = Path(folder)
    passes, usual = how(name)
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
            raise RuntimeError(f"stopped; run again with {folder} to go on")
        stores.append(Store(place))
        plan = _uncertain(plan, stores[-1], targets)
    target = folder / f"{name}.parquet"
    write_dataset(name, stores, target, cases=cases)
    return target


def _uncertain(plan: Plan, store: Store, targets: Targets) -> Plan:
    """Return the plan, finer, of the cases that miss the targets by their estimates, or failed."""
    limits = {"error_estimate": targets.force, "error_estimate_work": targets.work}
    missed = {
        row["name"]
        for row in store.results().select(["name", *limits]).to_pylist()
        if any(row[name] is None or row[name] > limit for name, limit in limits.items())
    }
    missed |= {row["name"] for row in store.failures().to_pylist()}
    return replace(
        plan,
        cases=tuple(case for case in plan.cases if case.name in missed),
        settings=replace(plan.settings, accuracy=plan.settings.accuracy / _FINER),
        source="",
    )


def write_dataset(
    name: str, stores: list[Store], target: Path, *, cases: int | None = None
) -> None:
    """Write one file of campaigns with the same cases, each case from the last one that has it.

    Stated errors are the estimates of the solver, but no less than columns.least_errors. With
    `cases` only so many from the beginning of the plan: what a campaign has done that goes on.
    """
    pa = arrow()
    rows: dict[str, Mapping[str, Any]] = {}
    for store in stores:
        accuracy = store.settings.accuracy
        for row in store.results().to_pylist():
            if row["error_estimate"] is not None:  # else nobody knows what it is worth
                rows[row["name"]] = row | {"accuracy": accuracy}
    planned = [case.name for case in stores[0].cases()[:cases]]
    solved = [rows[case] for case in planned if case in rows]
    kind = stores[0].provenance["kind"]
    columns = {
        column.name: pa.array([column.value(row) for row in solved], column.type(pa))
        for column in KEPT[kind]
    }
    facts = {
        "name": name,
        "licence": LICENCE,
        "citation": CITATION,
        "viscotack": __version__,
        "made": _days(stores),
        "settings": [asdict(store.settings) for store in stores],
        "cases": len(planned),
        "failures": _failures(stores[0], rows, set(planned)),
        "columns": units(kind),
        "plan": plan_path(name).read_text(encoding="utf-8"),
    }
    table = pa.table(columns).replace_schema_metadata({METADATA_KEY: json.dumps(facts)})
    sink = pa.BufferOutputStream()
    pa.parquet.write_table(table, sink, compression="zstd", compression_level=19)
    write_whole(target, sink.getvalue())


def _failures(store: Store, rows: Mapping[str, Any], planned: set[str]) -> list[dict[str, Any]]:
    """Return the cases without a result, with their inputs and the reason."""
    left_out = ("name", "wall_time_s")
    found = store.failures().to_pylist()
    kept = [row for row in found if row["name"] in planned and row["name"] not in rows]
    return [{k: v for k, v in row.items() if k not in left_out} for row in kept]


def _days(stores: list[Store]) -> list[str]:
    """Return the days on which cases were run."""
    runs = [begun for store in stores for begun in store.provenance["runs"]]
    return sorted({begun["began"][:10] for begun in runs})
