"""The database of a campaign, ``study.db`` in its folder: plan, cases, results, failures, runs.

The runner alone writes, a transaction for the cases that have ended since the last one; everybody
else may read meanwhile. The journal is a rollback journal, which also works on a network file
system and in a folder that may only be read.
"""

import csv
import io
import json
import os
import socket
import sqlite3
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from itertools import islice
from pathlib import Path
from typing import Any

from viscotack.errors import InputError
from viscotack.files.frame import arrow, frame
from viscotack.files.text import cell, read_text
from viscotack.files.whole import Target, writing_whole

from .case import CaseSettings, identity
from .plan import Case, Plan, numbers_of, restored_kind

_TABLES = {
    "plan": "facts TEXT NOT NULL",
    "cases": "name TEXT PRIMARY KEY, place INTEGER NOT NULL, inputs TEXT NOT NULL",
    "results": "name TEXT PRIMARY KEY, failure TEXT, reason TEXT, row TEXT NOT NULL",
    "runs": "number INTEGER PRIMARY KEY, facts TEXT NOT NULL",
}
# What is stored for a case first counts, but a failure for what comes after it.
_ADD = (
    "INSERT INTO results VALUES (?, ?, ?, ?) ON CONFLICT (name) DO UPDATE SET failure = "
    "excluded.failure, reason = excluded.reason, row = excluded.row WHERE results.failure NOTNULL"
)
# Time for which a writer waits for readers, and they for it [s].
_PATIENCE = 600.0
# Rows that are read at a time; the writer waits no longer than for these.
_ROWS = 1000
# Rows that are held at a time.
_HELD = 10_000
Row = Mapping[str, Any]
# Failures that another run may not meet: it tries their cases again.
PASSING = ("crashed", "worker died")


class FolderInUse(InputError):
    """Another run writes to the folder."""


class Store:
    """The stored campaign of a folder; :func:`viscotack.campaign.run` writes it.

    Parameters
    ----------
    folder : path
        As ``viscotack campaign run --out`` made it. It may be read while a run writes.

    Raises
    ------
    FileNotFoundError
        If there is no such folder.
    ValueError
        If it holds no campaign, a damaged one, or one of a newer version.

    Attributes
    ----------
    facts : dict
        ``kind``, ``problem``, ``settings``, ``own`` and ``shard``, as stored.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        if not self.folder.is_dir():
            raise FileNotFoundError(2, "No such folder", str(folder))
        self.path = self.folder / "study.db"
        if not self.path.exists():
            raise InputError(f"{folder} holds no campaign: it has no study.db")
        with self.database() as db:
            if not db.execute("SELECT * FROM sqlite_master WHERE name = 'plan'").fetchone():
                raise InputError(f"{folder} holds no campaign: its study.db has no plan")
            self.facts: dict[str, Any] = _facts(db) or {}

    @classmethod
    def create(cls, folder: str | os.PathLike[str], plan: Plan) -> "Store":
        """Store a plan in a folder, new or with the results of an earlier plan.

        Raises
        ------
        ValueError
            If the folder holds cases of another kind, accuracy or shard, or of other user-defined
            files.
        """
        stated = {
            "kind": plan.kind.name,
            "problem": plan.base,
            "settings": asdict(plan.settings),
            "own": [(Path(path).name, read_text(path)) for path in plan.settings.own],
            "shard": plan.shard,
        }
        facts = json.loads(json.dumps(stated))  # as they are when they are read
        shard, shards = numbers_of(plan.shard) if plan.shard else (1, 1)
        with _created(Path(folder)) as db:
            if old := _facts(db):
                _check_same(folder, old, "the plan", facts)
            db.execute("DELETE FROM plan")
            db.execute("INSERT INTO plan VALUES (?)", (json.dumps(facts),))
            db.execute("DELETE FROM cases")
            db.executemany(
                "INSERT INTO cases VALUES (?, ?, ?)",
                (
                    (case.name, i * shards + shard, json.dumps(case.inputs))
                    for i, case in enumerate(plan.cases)
                ),
            )
        return cls(folder)

    def database(self) -> AbstractContextManager[sqlite3.Connection]:
        """Open the database; what the block writes is kept whole, or not at all."""
        return _opened(self.path)

    @property
    def settings(self) -> CaseSettings:
        """How the cases are solved."""
        return CaseSettings(**self.facts["settings"])

    def cases(self) -> list[Case]:
        """Return the planned cases; nothing is executed."""
        with self.database() as db:
            found = db.execute("SELECT name, inputs FROM cases ORDER BY place")
            return [Case(name, json.loads(inputs)) for name, inputs in found]

    def plan(self, own: Iterable[str | os.PathLike[str]] = ()) -> Plan:
        """Build the stored plan, so that a run can go on without the file it came from.

        Parameters
        ----------
        own : iterable of path
            Python files that may be executed: those that the campaign was planned with.

        Raises
        ------
        InputError
            If one of them is missing, or has been edited since.
        """
        facts = self.facts
        given = {read_text(path): str(Path(path).resolve()) for path in own}
        for name, source in facts["own"]:
            if source not in given:
                raise InputError(
                    f"{self.folder} was planned with {name}, Python that would be executed: permit "
                    f"it as it was then, --with {name} on the command line, own=[...] in Python"
                )
        files = tuple(given[source] for _, source in facts["own"])
        settings = replace(self.settings, own=files)
        return Plan(
            kind=restored_kind(facts["kind"], facts["problem"], settings.nouns),
            cases=tuple(self.cases()),
            settings=settings,
            base=facts["problem"],
            shard=facts["shard"],
        )

    def add(self, rows: Iterable[Mapping[str, Any]]) -> None:
        """Store the rows of cases that have ended; those of failures have a ``failure``."""
        with self.database() as db:
            db.executemany(
                _ADD,
                ((r["name"], r.get("failure"), r.get("reason"), json.dumps(r)) for r in rows),
            )

    def ended(self) -> dict[str, str | None]:
        """Return the names of the cases that have ended, with the kind of failure or None."""
        with self.database() as db:
            return dict(db.execute("SELECT name, failure FROM results"))

    def counts(self) -> tuple[int, int, int]:
        """Return the number of cases of the plan, with a result, and with a failure."""
        with self.database() as db:
            found = db.execute(
                "SELECT count(*), count(results.name) - count(failure), count(failure) "
                "FROM cases LEFT JOIN results USING (name)"
            )
            return found.fetchone()

    def reasons(self) -> Counter[tuple[str, str]]:
        """Return how often each failure was met, with its reason."""
        with self.database() as db:
            found = db.execute(
                "SELECT failure, reason, count(*) FROM results WHERE failure IS NOT NULL "
                "GROUP BY failure, reason"
            )
            return Counter({(failure, reason): count for failure, reason, count in found})

    def results(self) -> "Rows":
        """Return the rows of the solved cases, in the order of the plan."""
        return Rows(self, "failure IS NULL")

    def failures(self) -> "Rows":
        """Return the rows of the failed cases, in the order of the plan."""
        return Rows(self, "failure IS NOT NULL")

    def runs(self) -> list[dict[str, Any]]:
        """Return when, where and with which versions the cases were run."""
        with self.database() as db:
            found = db.execute("SELECT facts FROM runs ORDER BY number")
            return [json.loads(facts) for (facts,) in found]

    def note_run(self) -> None:
        """Store that a run begins, with its machine and versions."""
        facts = {
            "began": datetime.now(UTC).isoformat(timespec="seconds"),
            "host": socket.gethostname(),
            "process": os.getpid(),
            "identity": identity(),
        }
        with self.database() as db:
            db.execute("INSERT INTO runs (facts) VALUES (?)", (json.dumps(facts),))


@dataclass(frozen=True)
class Rows:
    """Rows of a table of a store, as dictionaries; read whenever they are gone through.

    Rows of cases that are not in the plan any more come last.
    """

    store: Store
    condition: str

    def __iter__(self) -> Iterator[dict[str, Any]]:
        with self.store.database() as db:
            numbers = db.execute(
                "SELECT results.rowid FROM results LEFT JOIN cases USING (name) "
                f"WHERE {self.condition} ORDER BY place IS NULL, place, name"
            ).fetchall()
        for begin in range(0, len(numbers), _ROWS):
            some = [number for (number,) in numbers[begin : begin + _ROWS]]
            with self.store.database() as db:
                found = dict(
                    db.execute(
                        f"SELECT rowid, row FROM results WHERE {self.condition} "
                        f"AND rowid IN ({', '.join(map(str, some))})"
                    )
                )
            yield from (json.loads(found[number]) for number in some if number in found)

    def to_frame(self) -> Any:
        """Return the rows as a pandas DataFrame."""
        return frame(list(self))


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
    >>> from viscotack.campaign import every_combination, shard_of
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
    first = stores[0]
    runs = [(store.folder, run["identity"]) for store in stores for run in store.runs()]
    for store in stores:
        facts = store.facts | {"shard": first.facts["shard"]}
        _check_same(first.folder, first.facts, store.folder, facts)
    for folder, program in runs:
        if program != runs[0][1]:
            raise InputError(
                f"{folder} was run by another program than {runs[0][0]} ({program}, and not "
                f"{runs[0][1]}); their rows do not belong in one table"
            )
    out.mkdir(parents=True, exist_ok=True)
    # shards of one plan state the places of their cases in it; other cases come one after another
    counts = {(store.facts["shard"] or "").partition("/")[2] for store in stores}
    are_shards = len(counts) == 1 and counts != {""}
    with locked(out), _created(out) as db:
        if _facts(db):
            raise InputError(f"{out} holds a campaign already; give another `out`")
        facts = json.dumps(first.facts | {"shard": None})
        db.execute("INSERT INTO plan VALUES (?)", (facts,))
        for store in stores:
            (last,) = db.execute("SELECT coalesce(max(place), 0) FROM cases").fetchone()
            shift = 0 if are_shards else last
            with store.database() as part:
                cases = part.execute("SELECT name, place + ?, inputs FROM cases", (shift,))
                db.executemany("INSERT OR IGNORE INTO cases VALUES (?, ?, ?)", cases)
                db.executemany(_ADD, part.execute("SELECT * FROM results ORDER BY rowid"))
                db.executemany(
                    "INSERT INTO runs (facts) VALUES (?)", part.execute("SELECT facts FROM runs")
                )
    return Store(out)


def _facts(db: sqlite3.Connection) -> dict[str, Any] | None:
    found = db.execute("SELECT facts FROM plan").fetchone()
    return found and json.loads(found[0])


@contextmanager
def _created(folder: Path) -> Iterator[sqlite3.Connection]:
    """Open the database of a folder, which is made where there is none; as `Store.database`."""
    folder.mkdir(parents=True, exist_ok=True)
    with _opened(folder / "study.db", "rwc") as db:
        db.execute("BEGIN IMMEDIATE")
        for name, columns in _TABLES.items():
            db.execute(f"CREATE TABLE IF NOT EXISTS {name} ({columns})")
        yield db


@contextmanager
def _opened(path: Path, mode: str = "rw") -> Iterator[sqlite3.Connection]:
    db = None
    try:
        address = f"{path.resolve().as_uri()}?mode={mode}"
        db = sqlite3.connect(address, timeout=_PATIENCE, uri=True)
        db.execute("PRAGMA journal_mode = TRUNCATE")
        db.execute("PRAGMA synchronous = FULL")
        with db:
            yield db
    except sqlite3.OperationalError as error:
        raise OSError(
            f"cannot use {path}: {error}; what was stored before is safe: run again when there is "
            "space and the folder may be written"
        ) from error
    except sqlite3.DatabaseError as error:
        if type(error) is sqlite3.DatabaseError:
            raise InputError(f"{path} is damaged: {error}") from None
        raise
    finally:
        if db is not None:
            db.close()


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold a folder for one run; the system lets go of it when its process ends, however it ends.

    Raises
    ------
    FolderInUse
        If another run holds it.
    """
    held = None
    try:
        held = sqlite3.connect(folder / "lock", timeout=0, isolation_level=None)
        held.execute("BEGIN EXCLUSIVE")
    except sqlite3.OperationalError as error:
        if held is not None:
            held.close()
        if error.sqlite_errorcode != sqlite3.SQLITE_BUSY:
            raise OSError(f"cannot lock {folder}: {error}") from error
        runs = Store(folder).runs() if (folder / "study.db").exists() else []
        by = f", process {runs[-1]['process']} on {runs[-1]['host']}" if runs else ""
        raise FolderInUse(
            f"{folder} is in use by another run{by}; wait for it, or give another `out`"
        ) from None
    try:
        yield
    finally:
        held.close()


def _check_same(one: Any, first: Mapping[str, Any], other: Any, second: Mapping[str, Any]) -> None:
    """Refuse the facts of two campaigns whose rows do not belong in one table."""
    for name in ("kind", "problem", "shard", "own", "accuracy", "until"):
        was, now = ({**facts["settings"], **facts}[name] for facts in (first, second))
        if was != now:
            told = "" if name in ("problem", "own") else f": {was}, and {now}"
            raise InputError(
                f"{one} and {other} have not the same {name}{told}; give another `out`, or the same"
            )


def export(rows: Iterable[Row], path: Target, *, trajectories: bool = True) -> None:
    """Write rows to a file, complete or not at all.

    Parameters
    ----------
    rows : iterable of mapping
        `Store.results` or `Store.failures`, or a list; they are gone through twice.
    path : path or binary file
        Its ending chooses the format: ``.csv`` or ``.parquet``; an open file gets CSV.
    trajectories : bool
        Whether columns of lists are written as well; in CSV each place of a list is a column,
        ``trajectory_force_01`` and so on.

    Raises
    ------
    ValueError
        If the ending is unknown, or there are no rows.

    Examples
    --------
    >>> import io
    >>> file = io.BytesIO()
    >>> export([{"name": "a", "pull_off_force": 0.5}], file)
    >>> file.getvalue().decode().split()
    ['name,pull_off_force', 'a,0.5']
    """
    suffix = Path(path).suffix.lower() if isinstance(path, str | os.PathLike) else ".csv"
    if suffix not in _WRITERS:
        raise InputError(f"{path}: the ending must be one of {', '.join(_WRITERS)}")
    # kinds of values of each column, and the length of its longest list
    columns: dict[str, tuple[set[type], int]] = {}
    for row in rows:
        for name, value in row.items():
            kinds, width = columns.get(name, (set(), 0))
            if isinstance(value, list):
                width = max(width, len(value))
            columns[name] = kinds | {type(value)} - {type(None)}, width
    if not columns:
        raise InputError(f"there is nothing to write to {path}: the table has no rows")
    if not trajectories:
        columns = {name: kept for name, kept in columns.items() if list not in kept[0]}
    _WRITERS[suffix](rows, columns, path)


_Columns = Mapping[str, tuple[set[type], int]]


def _write_csv(rows: Iterable[Row], columns: _Columns, path: Target) -> None:
    header: list[str] = []
    for name, (_, width) in columns.items():
        header += [f"{name}_{place + 1:02d}" for place in range(width)] or [name]

    def cells(row: Row) -> list[Any]:
        found: list[Any] = []
        for name, (_, width) in columns.items():
            value = row.get(name)
            found += (list(value or ()) + [None] * width)[:width] if width else [value]
        return [cell(value) if isinstance(value, str) else value for value in found]

    with writing_whole(path) as file:
        text = io.TextIOWrapper(file, encoding="utf-8", newline="", write_through=True)
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(map(cell, header))
        writer.writerows(map(cells, rows))
        text.detach()


def _write_parquet(rows: Iterable[Row], columns: _Columns, path: Target) -> None:
    pa = arrow()
    of = {list: pa.list_(pa.float64()), str: pa.string(), float: pa.float64(), int: pa.int64()}
    of[bool] = pa.bool_()
    # a column of whole and other numbers has the others; one without a value has no type
    types = {
        name: next((made for kind, made in of.items() if kind in kinds), pa.null())
        for name, (kinds, _) in columns.items()
    }
    schema, left = pa.schema(types.items()), iter(rows)
    with writing_whole(path) as file, pa.parquet.ParquetWriter(file, schema) as writer:
        while some := list(islice(left, _HELD)):
            writer.write_table(pa.Table.from_pylist(some, schema=schema))


_WRITERS = {".csv": _write_csv, ".parquet": _write_parquet}
