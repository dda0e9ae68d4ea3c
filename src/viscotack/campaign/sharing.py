"""Shards of a plan for the job arrays of a batch system, and merging of their folders.

Shard k of n has every n-th case from the k-th on, so that all take about as long. A shard is a
campaign like any other; nothing is shared while they run.
"""

import json
import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from viscotack.errors import InputError

from .identity import difference
from .plan import Plan
from .store import ADD, Store, check_same, created, locked, numbers_of


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
    number, count = numbers_of(shard)
    if count > len(plan.cases):
        raise InputError(f"a plan of {len(plan.cases)} cases has no {count} shards")
    return replace(plan, cases=plan.cases[number - 1 :: count], shard=shard)


def merge(folders: Sequence[str | os.PathLike[str]], out: str | os.PathLike[str]) -> Store:
    """Merge several campaigns into one folder.

    Parameters
    ----------
    folders : sequence of path
        Campaigns of the same kind, settings and program. A case that is in several has the result
        of the first that has one.
    out : path
        Folder of the merged campaign, new or empty; it has all of them or nothing.

    Raises
    ------
    ValueError
        If the campaigns differ in kind, settings or program, or `out` holds a campaign.

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
    ...         _ = Store.create(part, shard_of(plan, f"{k}/2"))
    ...     len(merge(parts, f"{out}/all").plan().cases)
    2
    """
    stores, out = [Store(folder) for folder in folders], Path(out)
    if not stores:
        raise InputError("there is nothing to merge: give the folders of campaigns")
    for store in stores:
        _check_alike(stores[0], store)
    out.mkdir(parents=True, exist_ok=True)
    facts = stores[0].facts | {"shard": None}
    # shards of one plan state the places of their cases in it; other cases come one after another
    counts = {(store.facts["shard"] or "").partition("/")[2] for store in stores}
    are_shards = len(counts) == 1 and counts != {""}
    with locked(out), created(out) as db:
        if db.execute("SELECT count(*) FROM facts").fetchone()[0]:
            raise InputError(f"{out} holds a campaign already; give another --out")
        db.executemany(
            "INSERT INTO facts VALUES (?, ?)", ((n, json.dumps(v)) for n, v in facts.items())
        )
        for store in stores:
            (last,) = db.execute("SELECT coalesce(max(place), 0) FROM cases").fetchone()
            shift = 0 if are_shards else last
            with store.database() as part:
                cases = part.execute("SELECT name, place + ?, inputs FROM cases", (shift,))
                db.executemany("INSERT OR IGNORE INTO cases VALUES (?, ?, ?)", cases)
                db.executemany(ADD, part.execute("SELECT * FROM results ORDER BY rowid"))
                db.executemany(
                    "INSERT INTO runs (facts) VALUES (?)", part.execute("SELECT facts FROM runs")
                )
    return Store(out)


def _check_alike(one: Store, other: Store) -> None:
    """Refuse campaigns whose rows do not belong in one table."""
    first, second = (store.facts | {"shard": None} for store in (one, other))
    check_same(str(one.folder), first, str(other.folder), second)
    runs = [(store.folder, run) for store in (one, other) for run in store.runs()]
    for folder, run in runs[1:]:
        if words := difference(run["identity"], runs[0][1]["identity"]):
            raise InputError(
                f"{folder} was run by another program than {runs[0][0]}: {words}; their rows do "
                "not belong in one table"
            )
