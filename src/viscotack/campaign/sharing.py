"""One plan in many folders: shards for the job arrays of a batch system, and one folder of all.

Shard k of n has every n-th case from the k-th on, so that all take about as long. A shard is a
campaign like any other; nothing is shared while they run.
"""

import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.files.lock import locked

from .cases import Cases
from .identity import difference
from .plan import Plan
from .store import Store
from .verifying import verify

_SHARD = re.compile(r"([1-9]\d{0,6})/([1-9]\d{0,6})")
# Rows that are written to one part.
_PART = 10_000


def shard_of(plan: Plan, shard: str) -> Plan:
    """Return a part of a plan, such as shard "3/20", the third of twenty.

    Raises
    ------
    ValueError
        If there is no such shard, or no case is left for it.
    """
    number, count = _numbers(shard)
    if count > len(plan.cases):
        raise InputError(f"a plan of {len(plan.cases)} cases has no {count} shards")
    return replace(plan, cases=plan.cases[number - 1 :: count], shard=shard)


def merge(folders: Sequence[str | os.PathLike[str]], out: str | os.PathLike[str]) -> Store:
    """Return one campaign of several, in the order of the plan that they are shards of.

    Parameters
    ----------
    folders : sequence of path
        Campaigns of the same kind, settings and program; each is verified before. Cases that are in
        several are taken from the first.
    out : path
        Where to; must not hold a campaign yet.

    Raises
    ------
    ValueError
        If one is damaged, or they differ in more than their cases.
    """
    stores = [Store(folder) for folder in folders]
    if not stores:
        raise InputError("there is nothing to merge: give the folders of campaigns")
    for store in stores:
        if wrong := verify(store).wrong:
            raise InputError(f"{store.folder} is not merged: {wrong[0]}")
        _check_alike(stores[0], store)
    out = Path(out)
    if (out / "provenance.json").exists():
        raise InputError(f"{out} holds a campaign already; give another --out")
    plans = [store.plan() for store in stores]
    cases = _together(plans)
    out.mkdir(parents=True, exist_ok=True)
    whole = replace(plans[0], cases=cases, shard=None, source="")
    with locked(out) as hold:
        store = Store.create(out, whole, hold)
        runs = [
            {**run, "folder": str(one.folder)} for one in stores for run in one.provenance["runs"]
        ]
        _copy(stores, store)
        store.note_merged(runs)
    return store


def _copy(stores: Sequence[Store], out: Store) -> None:
    """Copy the rows of campaigns, each case once; a failure only where nobody has a result."""
    seen: set[str] = set()
    for one in stores:
        for rows in _fresh(one.parts()["results"].tables(), seen):
            out.add(rows, [])
    for one in stores:
        with one.ordered_failures() as failures:
            for rows in _fresh(failures.chunks(), seen):
                out.add([], rows)


def _fresh(tables: Iterator[Any], seen: set[str]) -> Iterator[list[dict[str, Any]]]:
    for table in tables:
        for begin in range(0, table.num_rows, _PART):
            rows = [
                {name: value for name, value in row.items() if value is not None}
                for row in table.slice(begin, _PART).to_pylist()
                if row["name"] not in seen
            ]
            seen.update(row["name"] for row in rows)
            yield rows


def _numbers(shard: str) -> tuple[int, int]:
    found = _SHARD.fullmatch(shard)
    if found is None or int(found[1]) > int(found[2]):
        raise InputError(f"a shard is written '3/20', the third of twenty; got {shard!r}")
    return int(found[1]), int(found[2])


def _together(plans: Sequence[Plan]) -> Cases:
    """Return the cases of several plans; of shards of one plan in its order."""
    shards = [_numbers(plan.shard) if plan.shard else (1, 1) for plan in plans]
    cases = [case for plan in plans for case in plan.cases]
    order = [
        (index * count + number - 1 if count > 1 else index, number)
        for plan, (number, count) in zip(plans, shards, strict=True)
        for index in range(len(plan.cases))
    ]
    alike = len({count for _, count in shards}) == 1 and shards[0][1] > 1
    places = sorted(range(len(cases)), key=order.__getitem__) if alike else range(len(cases))
    found = Cases.of(cases)
    return found[np.fromiter(places, int, len(cases))].first_of_each()


def _check_alike(one: Store, other: Store) -> None:
    first, second = one.provenance, other.provenance
    for what in ("kind", "problem"):
        if first[what] != second[what]:
            raise InputError(
                f"{one.folder} and {other.folder} hold cases of another {what}: they are no shards "
                "of one plan"
            )
    for name in ("accuracy", "until", "own_sha256"):
        was, now = (given["settings"].get(name) for given in (first, second))
        if was != now:
            raise InputError(f"{one.folder} has {name} = {was}, {other.folder} has {now}")
    known: list[tuple[Store, dict[str, str]]] = [
        (store, run["identity"])
        for store in (one, other)
        for run in store.provenance["runs"]
        if "identity" in run
    ]
    for store, identity in known[1:]:
        if words := difference(identity, known[0][1]):
            raise InputError(
                f"{store.folder} was run by another program than {known[0][0].folder}: {words}; "
                "their rows do not belong in one table"
            )
