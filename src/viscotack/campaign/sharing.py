"""Shards of a plan for the job arrays of a batch system, and merging of their folders.

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
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.files.lock import locked

from .cases import Cases
from .identity import difference
from .ordering import names_of
from .plan import Plan
from .store import Store
from .verifying import verify

_SHARD = re.compile(r"([1-9]\d{0,6})/([1-9]\d{0,6})")
# Rows that are written to one part.
_PART = 10_000


def shard_of(plan: Plan, shard: str) -> Plan:
    """Select a shard of a plan.

    Parameters
    ----------
    plan : Plan
        The whole plan.
    shard : str
        Number of the shard and of shards, "3/20".

    Returns
    -------
    Plan
        Every n-th case of the plan.

    Raises
    ------
    ValueError
        If there is no such shard, or it has no cases.

    Examples
    --------
    >>> from viscotack import AtDepth, Elastic, Groups
    >>> from viscotack.campaign import every_combination
    >>> solid = Elastic(rubbery_modulus=1, poisson_ratio=0)
    >>> base = Groups(tabor=1.0, material=solid, start=AtDepth(5.0), rate=1.0)
    >>> plan = every_combination(base, {"tabor": [1, 2, 3, 4]})
    >>> len(shard_of(plan, "1/2").cases)
    2
    """
    number, count = _numbers(shard)
    if count > len(plan.cases):
        raise InputError(f"a plan of {len(plan.cases)} cases has no {count} shards")
    return replace(plan, cases=plan.cases[number - 1 :: count], shard=shard)


def merge(folders: Sequence[str | os.PathLike[str]], out: str | os.PathLike[str]) -> Store:
    """Merge several campaigns into one folder.

    Parameters
    ----------
    folders : sequence of path
        Campaigns of the same kind, settings and program; each is verified before. Cases that are in
        several are taken from the first.
    out : path
        Folder of the merged campaign, new or empty. An interrupted merge resumes when it is
        called again with the same folders.

    Raises
    ------
    ValueError
        If a folder is damaged, or the campaigns differ in kind, settings or program.

    Returns
    -------
    Store
        The merged campaign.

    Examples
    --------
    >>> import tempfile
    >>> from viscotack import AtDepth, Elastic, Groups
    >>> from viscotack.campaign import every_combination
    >>> solid = Elastic(rubbery_modulus=1, poisson_ratio=0)
    >>> base = Groups(tabor=1.0, material=solid, start=AtDepth(5.0), rate=1.0)
    >>> plan = every_combination(base, {"tabor": [1, 2]})
    >>> with tempfile.TemporaryDirectory() as out:
    ...     parts = [f"{out}/{k}" for k in (1, 2)]
    ...     for k, part in enumerate(parts, 1):
    ...         Path(part).mkdir()
    ...         _ = Store.create(part, shard_of(plan, f"{k}/2"))
    ...     len(merge(parts, f"{out}/all").plan().cases)
    2
    """
    stores = [Store(folder) for folder in folders]
    if not stores:
        raise InputError("there is nothing to merge: give the folders of campaigns")
    for store in stores:
        if wrong := verify(store).wrong:
            raise InputError(f"{store.folder} is not merged: {wrong[0]}")
        _check_alike(stores[0], store)
    out, names = Path(out), [str(store.folder.resolve()) for store in stores]
    _check_free(out, names)
    cases = _together(stores)
    out.mkdir(parents=True, exist_ok=True)
    with locked(out) as hold:
        _check_free(out, names)  # no other merge started meanwhile
        store = Store.merged(out, stores, cases, hold, names)
        store.tidy()
        runs = [
            {**run, "folder": str(one.folder)} for one in stores for run in one.provenance["runs"]
        ]
        _copy(stores, store)
        store.note_merged(runs)
    return store


def _check_free(out: Path, names: list[str]) -> None:
    """Refuse a folder that holds anything but the beginning of this very merge."""
    if not (out / "provenance.json").exists():
        return
    begun = Store(out).merging
    if not begun:
        raise InputError(f"{out} holds a campaign already; give another --out")
    if begun != names:
        raise InputError(
            f"{out} holds a merge of {', '.join(begun)} that has not ended; give the same folders "
            "in the same order, or another --out"
        )


def _copy(stores: Sequence[Store], out: Store) -> None:
    """Copy the rows of campaigns, each case once; failures only for cases without a result."""
    known = [
        names_of(parts.tables(["name"])) for one in (out, *stores) for parts in one.parts().values()
    ]
    every = Cases(np.unique(np.concatenate(known)), {})
    copied = np.zeros(len(every), bool)
    copied[every.places(np.concatenate(known[:2]))] = True  # by a merge that was killed
    for one in stores:
        for rows in _fresh(one.parts()["results"].tables(), every, copied):
            out.add(rows, [])
    for one in stores:
        with one.ordered_failures() as failures:
            for rows in _fresh(failures.chunks(), every, copied):
                out.add([], rows)


def _fresh(
    tables: Iterator[Any], every: Cases, copied: npt.NDArray[np.bool_]
) -> Iterator[list[dict[str, Any]]]:
    """Yield the rows of cases that have not been copied, each once; they are then."""
    for table in tables:
        for begin in range(0, table.num_rows, _PART):
            some = table.slice(begin, _PART)
            places, first = np.unique(every.places(names_of([some])), return_index=True)
            fresh = (places >= 0) & ~copied[places]  # not what was added since names were read
            rows = some.take(np.sort(first[fresh])).to_pylist()
            copied[places[fresh]] = True
            yield [{name: v for name, v in row.items() if v is not None} for row in rows]


def _numbers(shard: str) -> tuple[int, int]:
    found = _SHARD.fullmatch(shard)
    if found is None or int(found[1]) > int(found[2]):
        raise InputError(f"a shard is written '3/20', the third of twenty; got {shard!r}")
    return int(found[1]), int(found[2])


def _together(stores: Sequence[Store]) -> Cases:
    """Join the cases of several campaigns; of shards of one plan in its order."""
    words = [store.provenance.get("shard") for store in stores]
    shards = [_numbers(shard) if shard else (1, 1) for shard in words]
    each = [store.cases() for store in stores]
    found = Cases.joined(each)
    counts = {count for _, count in shards}
    if len(counts) == 1 and counts != {1}:
        (count,) = counts
        places = [
            np.arange(len(cases)) * count + number
            for cases, (number, _) in zip(each, shards, strict=True)
        ]
        found = found[np.argsort(np.concatenate(places), kind="stable")]
    return found.first_of_each()


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
    runs = [(store.folder, run) for store in (one, other) for run in store.provenance["runs"]]
    known = [(folder, run["identity"]) for folder, run in runs if "identity" in run]
    for folder, identity in known[1:]:
        if words := difference(identity, known[0][1]):
            raise InputError(
                f"{folder} was run by another program than {known[0][0]}: {words}; their rows do "
                "not belong in one table"
            )
