"""What a campaign keeps, in one folder: plan, settings, provenance, results and failures.

::

    plan.toml or plan.csv     the plan as it was given
    cases.parquet             what it stands for: name and inputs of every case
    provenance.json           kind, settings, and who ran it when with which versions
    results/*.parquet         a row per solved case
    failures/*.parquet        a row per case without a result, with the reason
    lock                      held while a run writes
"""

import json
import os
import platform
import socket
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from viscotack import __version__
from viscotack.errors import InputError
from viscotack.files.whole import write_whole
from viscotack.problem.older import upgraded, upgraded_path

from .case import CaseSettings
from .parts import Parts, arrow, write_table
from .plan import Case, Plan, restored_kind

_FORMAT, _FORMAT_VERSION = "viscotack campaign", 1
# Settings that change the numbers of a result, and so must be the same for all of a folder.
_PHYSICAL = ("accuracy", "until")


class Store:
    """A campaign's folder.

    Parameters
    ----------
    folder : path
        As ``viscotack campaign run --out`` made it. Reading needs no lock, also while a run writes.

    Raises
    ------
    FileNotFoundError
        If there is no such folder.
    ValueError
        If it holds no campaign, a damaged one, or one of a newer version.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        self._provenance = _read_provenance(self.folder)
        self._results, self._failures = (
            Parts(self.folder / name) for name in ("results", "failures")
        )

    @classmethod
    def create(cls, folder: str | os.PathLike[str], plan: Plan) -> "Store":
        """Return the store for a plan, new or with what was stored under an earlier plan.

        The caller holds the lock of the folder.

        Raises
        ------
        ValueError
            If the folder holds cases of another kind or accuracy.
        """
        folder = Path(folder)
        header: dict[str, Any] = {
            "format": _FORMAT,
            "format_version": _FORMAT_VERSION,
            "kind": plan.kind.name,
            "problem": plan.base,
            "settings": asdict(plan.settings),
            "rejected": plan.rejected,
            "repeated": plan.repeated,
            "runs": [],
        }
        if (folder / "provenance.json").exists():
            old = _read_provenance(folder)
            _check_same(folder, old, header)
            header["runs"] = old["runs"]
        pa = arrow()
        names = dict.fromkeys(name for case in plan.cases for name in case.inputs)
        table: dict[str, Any] = {"name": pa.array([c.name for c in plan.cases], pa.string())}
        for name in names:
            table[name] = pa.array([c.inputs.get(name) for c in plan.cases], pa.float64())
        write_table(pa.table(table), folder / "cases.parquet")
        if plan.source:
            write_whole(folder / f"plan{plan.suffix}", plan.source.encode())
        _write_provenance(folder, header)
        return cls(folder)

    @property
    def settings(self) -> CaseSettings:
        """How the cases are solved."""
        return CaseSettings(**self._provenance["settings"])

    @property
    def provenance(self) -> Mapping[str, Any]:
        """Kind, settings and runs, as in provenance.json."""
        return self._provenance

    def plan(self) -> Plan:
        """Return the stored plan, so that a run can go on without the file it came from."""
        try:
            table = arrow().parquet.read_table(self.folder / "cases.parquet", partitioning=None)
        except FileNotFoundError:
            raise InputError(
                f"{self.folder} has lost its cases.parquet; run again with the plan"
            ) from None
        inputs = [name for name in table.column_names if name != "name"]
        cases = tuple(
            Case(row.pop("name"), {upgraded_path(k): v for k, v in row.items() if v is not None})
            for row in table.to_pylist()
        )
        given = self._provenance
        return Plan(
            kind=restored_kind(given["kind"], given["problem"], inputs, self.settings.own),
            cases=cases,
            settings=self.settings,
            base=given["problem"],
            rejected=given["rejected"],
            repeated=given["repeated"],
        )

    def tidy(self) -> None:
        """Remove what a killed run left behind; the caller holds the lock."""
        for parts in (self._results, self._failures):
            parts.tidy()
        for path in self.folder.glob("*.draft"):
            path.unlink(missing_ok=True)

    def add(
        self, results: Sequence[Mapping[str, Any]], failures: Sequence[Mapping[str, Any]]
    ) -> None:
        """Store rows durably; the caller holds the lock."""
        self._results.append(results)
        self._failures.append(failures)

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
                }
            )
            number = len(runs) - 1
        runs[number] |= facts
        self._provenance = {**self._provenance, "runs": runs}
        _write_provenance(self.folder, self._provenance)
        return number

    def finished(self) -> tuple[set[str], dict[str, str]]:
        """Return the names of the cases with a result, and the failures by name of the others."""
        done, table = _names(self._results), self._failures.read(["name", "failure"])
        failed = {row["name"]: row["failure"] for row in table.to_pylist()}
        return done, {name: failure for name, failure in failed.items() if name not in done}

    def results(self) -> Any:
        """Return the results as a pyarrow.Table, a row per case, in the order of the plan."""
        return self._ordered(_renamed(self._results.read()))

    def failures(self) -> Any:
        """Return the failures as a pyarrow.Table, without cases that were solved later."""
        table = self._failures.read()
        if not table.num_rows:
            return table
        done = _names(self._results)
        last = {name: i for i, name in enumerate(table.column("name").to_pylist())}
        kept = [i for name, i in last.items() if name not in done]
        return self._ordered(table.take(kept)) if kept else table.slice(0, 0)

    def _ordered(self, table: Any) -> Any:
        if not table.num_rows:
            return table
        path = self.folder / "cases.parquet"
        planned = arrow().parquet.read_table(path, columns=["name"], partitioning=None)
        place = {name: i for i, name in enumerate(planned.column("name").to_pylist())}
        names = table.column("name").to_pylist()
        # What an earlier plan had and this one has not comes last, by name.
        order = sorted(range(len(names)), key=lambda i: (place.get(names[i], len(place)), names[i]))
        return table.take(order)


def _renamed(table: Any) -> Any:
    """Return a table in which inputs of older versions have the paths that numbers have now."""
    old = [name for name in table.column_names if upgraded_path(name) != name]
    for name in old:
        new, values = upgraded_path(name), table.column(name)
        if new in table.column_names:
            merged = arrow().compute.coalesce(table.column(new), values)
            table = table.set_column(table.column_names.index(new), new, merged).drop_columns(name)
        else:
            names = [new if given == name else given for given in table.column_names]
            table = table.rename_columns(names)
    return table


def _names(parts: Parts) -> set[str]:
    table = parts.read(["name"])
    return set(table.column("name").to_pylist()) if table.num_rows else set()


def _check_same(folder: Path, old: Mapping[str, Any], new: Mapping[str, Any]) -> None:
    for what in ("kind", "problem"):
        if upgraded(old[what]) != new[what]:
            raise InputError(
                f"{folder} holds cases of another {what} ({old['kind']}); give another --out"
            )
    differ: Iterable[str] = (n for n in _PHYSICAL if old["settings"][n] != new["settings"][n])
    for name in differ:
        raise InputError(
            f"{folder} holds cases with {name} = {old['settings'][name]}, the plan asks for "
            f"{new['settings'][name]}; give another --out, or the same {name}"
        )


def _read_provenance(folder: Path) -> dict[str, Any]:
    path = folder / "provenance.json"
    if not folder.is_dir():
        raise FileNotFoundError(2, "No such folder", str(folder))
    if not path.exists():
        raise InputError(f"{folder} holds no campaign: it has no provenance.json")
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        if found["format"] != _FORMAT:
            raise InputError("it is of another kind")
        version = found["format_version"]
    except (ValueError, KeyError, TypeError) as error:
        raise InputError(f"{path} is damaged: {error}") from None
    if version > _FORMAT_VERSION:
        raise InputError(f"{folder} was written by a newer version of viscotack; update viscotack")
    return found


def _write_provenance(folder: Path, content: Mapping[str, Any]) -> None:
    write_whole(folder / "provenance.json", (json.dumps(content, indent=2) + "\n").encode())
