"""Storage of a campaign in a folder: plan, settings, provenance, results and failures.

::

    plan.toml or plan.csv     the plan as it was given
    cases.parquet             name and inputs of every case
    provenance.json           kind, settings, and who ran it when with which versions; the hashes
                              of all files, under a seal of its own
    results/*.parquet         a row per solved case
    failures/*.parquet        a row per case without a result, with the reason
    lock                      held while a run writes
"""

import hashlib
import os
import platform
import socket
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import asdict, replace
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.files.arrow import arrow
from viscotack.files.bounded import LARGEST_PART
from viscotack.files.lock import Hold
from viscotack.files.parquet import read_parquet
from viscotack.files.whole import remove_drafts, write_whole
from viscotack.version import __version__

from .case import CaseSettings
from .cases import Cases, Names, Standing
from .identity import digest, identity, permitted
from .ordering import Ordered, in_order, names_of
from .parts import Ledger, Parts, parquet
from .plan import Plan, restored_kind
from .provenance import FORMAT, FORMAT_VERSION, read_provenance, write_provenance

_TABLES = ("results", "failures")
_FILES = ("cases.parquet", "plan.toml", "plan.csv")
# Names that are words of Python at a time, and cases that are written at a time.
_SLICE, _WRITTEN = 20_000, 50_000
# Settings that change the numbers of a result, and so must be the same for all of a folder.
_PHYSICAL = ("accuracy", "until")


class Store:
    """Folder of a campaign; :func:`run` writes it.

    Parameters
    ----------
    folder : path
        As ``viscotack campaign run --out`` made it. Reading needs no lock, also while a run writes.
    hold : Hold, optional
        The lock of who writes, who confirms it before every change.

    Raises
    ------
    FileNotFoundError
        If there is no such folder.
    ValueError
        If it holds no campaign, a damaged one, or one of a newer version.
    """

    def __init__(self, folder: str | os.PathLike[str], hold: Hold | None = None) -> None:
        self.folder, self._hold = Path(folder), hold
        self._provenance = read_provenance(self.folder)
        self._parts = {
            name: Parts(self.folder / name, partial(self._ledger, name), partial(self._note, name))
            for name in _TABLES
        }

    @classmethod
    def create(
        cls, folder: str | os.PathLike[str], plan: Plan, hold: Hold | None = None, **facts: Any
    ) -> "Store":
        """Return the store for a plan, new or with the results of an earlier plan.

        The caller holds the lock of the folder; further facts are kept in the provenance.

        Raises
        ------
        ValueError
            If the folder holds cases of another kind, accuracy or shard, or of user-defined files
            that have been edited since.
        """
        stated = {
            "kind": plan.kind.name,
            "problem": plan.base,
            "settings": asdict(plan.settings),
            "rejected": plan.rejected,
            "repeated": plan.repeated,
            "shard": plan.shard,
        } | facts
        files = {f"plan{plan.suffix}": plan.source.encode()} if plan.source else {}
        return cls._begun(Path(folder), stated, plan.cases, files, hold)

    @classmethod
    def merged(
        cls, folder: Path, stores: Sequence["Store"], cases: Cases, hold: Hold, names: list[str]
    ) -> "Store":
        """Begin the store of a merge of campaigns, whose problem is not built for that.

        Errors as of `create`; the caller holds the lock of the folder.
        """
        given = stores[0].provenance
        stated = {name: given[name] for name in ("kind", "problem", "settings")}
        stated |= {"rejected": given["rejected"], "repeated": given["repeated"]}
        stated |= {"shard": None, "merging": names}
        return cls._begun(folder, stated, cases, {}, hold)

    @classmethod
    def _begun(
        cls,
        folder: Path,
        stated: dict[str, Any],
        cases: Cases,
        sources: dict[str, bytes],
        hold: Hold | None,
    ) -> "Store":
        _refuse_links(folder)
        header: dict[str, Any] = {
            "format": FORMAT,
            "format_version": FORMAT_VERSION,
            "runs": [],
            "parts": {name: Ledger().record() for name in _TABLES},
            "lost": [],
        } | stated
        if (folder / "provenance.json").exists():
            old = read_provenance(folder)
            _check_same(folder, old, header)
            header |= {name: old[name] for name in ("runs", "parts", "lost")}
        files = {"cases.parquet": parquet(lambda: _tables_of_cases(cases)), **sources}
        hashes = {name: hashlib.sha256(content).hexdigest() for name, content in files.items()}
        if hold is not None:
            hold.confirm()
        # Until both are written either counts: at any instant the folder is in order.
        known = {name: hash_of(folder / name) for name in files}
        header["files"] = {
            name: list(dict.fromkeys([new, *filter(None, [known[name]])]))
            for name, new in hashes.items()
        }
        write_provenance(folder, header)
        for name in (name for name in files if known[name] != hashes[name]):
            write_whole(folder / name, files[name])
        header["files"] = {name: [new] for name, new in hashes.items()}
        write_provenance(folder, header)
        return cls(folder, hold)

    @property
    def settings(self) -> CaseSettings:
        """How the cases are solved."""
        return CaseSettings(**self._provenance["settings"])

    @property
    def merging(self) -> list[str]:
        """The folders of a merge that has not ended; [] for a campaign that is whole."""
        return self._provenance.get("merging", [])

    @property
    def provenance(self) -> Mapping[str, Any]:
        """Kind, settings and runs, as in provenance.json."""
        return self._provenance

    def plan(self, own: Iterable[str | os.PathLike[str]] = ()) -> Plan:
        """Build the stored plan, so that a run can go on without the file it came from.

        Parameters
        ----------
        own : iterable of path
            Python files that may be executed: those that the campaign was planned with.

        Raises
        ------
        InputError
            If it was planned with other files, or a file has been edited since.
        """
        given, settings = self._provenance, self.settings
        files = permitted(settings.own, settings.own_sha256, map(Path, own), self.folder)
        settings = replace(settings, own=files)
        cases = self.cases()
        return Plan(
            kind=restored_kind(given["kind"], given["problem"], cases.columns, settings.nouns()),
            cases=cases,
            settings=settings,
            base=given["problem"],
            rejected=given["rejected"],
            repeated=given["repeated"],
            shard=given.get("shard"),
        )

    def tidy(self) -> None:
        """Clean up after a killed run, and delete removed parts; the caller holds a lock.

        Nothing is removed that a run of this campaign has not written.
        """
        _refuse_links(self.folder)
        for name, parts in self._parts.items():
            parts.settle()
            if missing := parts.forget_missing():
                lost = [f"{name}/{part.name} with {part.rows} rows" for part in missing]
                self._write(lost=[*self._provenance["lost"], *lost])
        remove_drafts(self.folder)

    def confirm(self) -> None:
        """Renew the lock of the running campaign; FolderInUse if it was removed."""
        if self._hold is not None:
            self._hold.confirm()

    def add(
        self, results: Sequence[Mapping[str, Any]], failures: Sequence[Mapping[str, Any]]
    ) -> None:
        """Store rows durably; the caller holds the lock."""
        self._parts["results"].append(results)
        self._parts["failures"].append(failures)

    def note_run(self, number: int | None = None, **facts: Any) -> int:
        """Add a run with its machine and versions to the provenance, or facts to one; its number.

        The caller holds the lock.
        """
        runs = [dict(run) for run in self._provenance["runs"]]
        if number is None:
            runs.append(
                {
                    "began": datetime.now(UTC).isoformat(timespec="seconds"),
                    "host": socket.gethostname(),
                    "process": os.getpid(),
                    "platform": platform.platform(),
                    "python": platform.python_version(),
                    "viscotack": __version__,
                    "identity": identity(),
                }
            )
            number = len(runs) - 1
        runs[number] |= facts
        self._note_settled(runs=runs)
        return number

    def note_merged(self, runs: list[dict[str, Any]]) -> None:
        """Keep the runs of the campaigns that this one is whole of; the caller holds the lock."""
        self._note_settled(runs=runs, merging=[])

    def _note_settled(self, **facts: Any) -> None:
        # what was written last is there: no part is only coming any more
        for parts in self._parts.values():
            parts.settle()
        self._write(**facts)

    def standing(self, cases: Cases) -> Standing:
        """Return the state of the cases, from the stored files."""
        standing = Standing.of(len(cases))
        standing.note_results(cases.places(self._names("results")))
        for table in self._parts["failures"].tables(["name", "failure"]):
            names, failures = (table.column(n).to_pylist() for n in ("name", "failure"))
            standing.note_failures(cases.places(names), failures)
        return standing

    def reasons(self) -> Counter[tuple[str, str]]:
        """Return how often each failure was met, with its reason, by cases that have no result."""
        found: Counter[tuple[str, str]] = Counter()
        with self.ordered_failures() as failures:
            for table in failures.chunks():
                kinds, whys = (table.column(name).to_pylist() for name in ("failure", "reason"))
                found.update(zip(kinds, whys, strict=True))
        return found

    def results(self) -> Any:
        """Return the results as a pyarrow.Table, a row per case, in the order of the plan."""
        with self.ordered_results() as ordered:
            return ordered.table()

    def failures(self) -> Any:
        """Return the failures as a pyarrow.Table, without cases that were solved later."""
        with self.ordered_failures() as ordered:
            return ordered.table()

    def ordered_results(self) -> AbstractContextManager[Ordered]:
        """Hold the results in the order of the plan, however many; see `ordering.in_order`.

        Of two rows of a case the first counts: what was stored is not run again.
        """
        cases, names = self.cases(), self._names("results")
        return self._in_order("results", cases, names, np.arange(len(names)))

    def ordered_failures(self) -> AbstractContextManager[Ordered]:
        """Hold the last failure of every case without a result, in the order of the plan."""
        cases, names = self.cases(), self._names("failures")
        each, places = np.unique(names, return_inverse=True)
        solved = self.standing(Cases(each, {})).done[places]
        return self._in_order("failures", cases, names, np.flatnonzero(~solved)[::-1])

    def _names(self, table: str) -> Names:
        return names_of(self._parts[table].tables(["name"]))

    def _in_order(
        self, table: str, cases: Cases, names: Names, counts: Any
    ) -> AbstractContextManager[Ordered]:
        return in_order(self._parts[table].tables, names, cases, counts)

    def parts(self) -> dict[str, Parts]:
        """Return the tables by the names of their directories."""
        return self._parts

    def files(self) -> dict[str, list[str]]:
        """Return the other files, with the hashes that each may have."""
        return self._provenance.get("files", {})

    def lost(self) -> list[str]:
        """Return sentences for parts that were removed, whose cases are run again."""
        lost = self._provenance.get("lost", [])
        return [f"{self.folder}/{words} was removed by somebody" for words in lost]

    def cases(self) -> Cases:
        """Read the planned cases; nothing is executed."""
        path = self.folder / "cases.parquet"
        try:
            hashes = self.files().get(path.name) or [str(hash_of(path))]
            present = hash_of(path)
            table = read_parquet(path, present if present in hashes else hashes[0])
        except FileNotFoundError:
            raise InputError(
                f"{self.folder} has lost its cases.parquet; run again with the plan"
            ) from None
        # in slices: a million words of Python's would be 150 MB
        names = names_of(table.to_batches(max_chunksize=_SLICE))
        inputs = {
            name: table.column(name).to_numpy(zero_copy_only=False)
            for name in table.column_names
            if name != "name"
        }
        return Cases(names, inputs)

    def _ledger(self, name: str) -> Ledger:
        """Return the ledger of a table: of who writes the one it has, else that on the disk."""
        if self._hold is None:
            self._provenance = read_provenance(self.folder)
        try:
            return Ledger.of(self._provenance["parts"][name])
        except (KeyError, TypeError) as error:
            raise InputError(f"{self.folder}/provenance.json is damaged: {error}") from None

    def _note(self, name: str, ledger: Ledger) -> None:
        self._write(parts={**self._provenance["parts"], name: ledger.record()})

    def _write(self, **changed: Any) -> None:
        self.confirm()
        self._provenance = {**self._provenance, **changed}
        write_provenance(self.folder, self._provenance)


def _refuse_links(folder: Path) -> None:
    """Refuse a folder in which a file to be written is a symbolic link."""
    for name in (*_TABLES, "provenance.json", *_FILES):
        if (folder / name).is_symlink():
            raise InputError(
                f"{folder / name} is a symbolic link, and a campaign writes into its own folder "
                "only; put the file or folder itself there"
            )


def table_of_cases(cases: Cases) -> Any:
    """Return cases as a table: name and inputs, with nothing where a case has no such input."""
    pa = arrow()
    columns: dict[str, Any] = {"name": pa.array(cases.names).cast(pa.string())}
    for name, values in cases.columns.items():
        columns[name] = pa.array(values, pa.float64(), from_pandas=True)  # no number is no entry
    return pa.table(columns)


def _tables_of_cases(cases: Cases) -> Iterator[Any]:
    """Yield cases as tables of some of them: a million in one table take 100 MB more."""
    for begin in range(0, max(1, len(cases)), _WRITTEN):
        yield table_of_cases(cases[begin : begin + _WRITTEN])


def hash_of(path: Path) -> str | None:
    """Return the hash of a file as it is now; None if it is not there."""
    return digest(path, LARGEST_PART) if path.exists() else None


def _check_same(folder: Path, old: Mapping[str, Any], new: Mapping[str, Any]) -> None:
    for what in ("kind", "problem"):
        if old[what] != new[what]:
            raise InputError(
                f"{folder} holds cases of another {what} ({old['kind']}); give another --out"
            )
    if old.get("shard") != new["shard"]:
        was, now = (f"shard {s}" if s else "a whole plan" for s in (old.get("shard"), new["shard"]))
        raise InputError(f"{folder} holds {was}, and this is {now}; give another --out")
    for name in _PHYSICAL:
        was, now = old["settings"][name], new["settings"][name]
        if was != now:
            raise InputError(
                f"{folder} holds cases with {name} = {was}, the plan asks for {now}; give another "
                f"--out, or the same {name}"
            )
    before, now = (list(given["settings"].get("own_sha256", ())) for given in (old, new))
    if before and before != now:
        files = ", ".join(new["settings"]["own"]) or "none"
        raise InputError(
            f"{folder} holds cases with user-defined files that have been edited or replaced "
            f"since (now {files}); restore the files, or give another --out"
        )
