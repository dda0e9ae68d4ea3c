"""A growing table as Parquet files that appear whole or not at all, and a ledger of them.

A part holds the rows ``000007-000007.parquet`` of one append. When 32 parts of equal span have come
together they are merged into one, so that 1e5 appends leave about a hundred files.

The ledger lists the parts with hash and number of rows; no other file in the directory is read or
removed. The caller stores the ledger durably. It is updated *before* a part is written, and before
merged parts are removed, so that ledger and files are consistent at any instant:

============================  ==========================================================
ledger                        files
============================  ==========================================================
kept A, B                     A, B
kept A, B; coming C           A, B and perhaps C: C counts if it is there
kept A, B; coming AB for two  A, B and perhaps AB: it does not count yet
kept AB; replaced A, B        AB and perhaps A, B: they do not count, and may be removed
============================  ==========================================================
"""

import hashlib
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from viscotack.errors import InputError
from viscotack.files.arrow import arrow
from viscotack.files.parquet import read_parquet
from viscotack.files.whole import is_draft, remove_drafts, write_new

# Parts of equal span that are merged, and the largest part that a merge makes [bytes].
_MERGED = 32
_LARGEST = 30e6
_TRIES = 5
_NAME = re.compile(r"(\d{6,18})-(\d{6,18})\.parquet")


@dataclass(frozen=True)
class Part:
    """A part of the table: name of its file, hash of its bytes, and number of rows."""

    name: str
    sha256: str
    rows: int

    @property
    def span(self) -> tuple[int, int]:
        """First and last append in it."""
        if (found := _span(self.name)) is None:
            raise InputError(f"{self.name!r} is no name of a part of a table")
        return found


@dataclass(frozen=True)
class Ledger:
    """Which parts a table has; see the table at the top of this module.

    Attributes
    ----------
    kept : tuple of Part
        In the order of their rows.
    coming : Part or None
        One that is being written.
    instead_of : int
        Of how many of the last kept ones; 0 for new rows.
    replaced : tuple of Part
        Files that hold nothing that is not kept, and may be removed.
    """

    kept: tuple[Part, ...] = ()
    coming: Part | None = None
    instead_of: int = 0
    replaced: tuple[Part, ...] = ()

    def record(self) -> dict[str, Any]:
        """Return the ledger as a dictionary of strings and numbers, for JSON."""
        return asdict(self)

    @classmethod
    def of(cls, record: Mapping[str, Any]) -> "Ledger":
        """Return the ledger of a record."""
        kept, replaced = (tuple(Part(**p) for p in record[name]) for name in ("kept", "replaced"))
        coming = record["coming"] and Part(**record["coming"])
        return cls(kept, coming, record["instead_of"], replaced)


class Parts:
    """A table in a directory, to which rows are only added.

    Parameters
    ----------
    folder : Path
        The directory; made by the first append.
    ledger : callable
        Returns the ledger as it is now.
    note : callable
        Keeps another one durably; the caller of what writes holds a lock.
    """

    def __init__(
        self, folder: Path, ledger: Callable[[], Ledger], note: Callable[[Ledger], None]
    ) -> None:
        self.folder, self._ledger, self._note = folder, ledger, note

    def append(self, rows: Sequence[Mapping[str, Any]]) -> None:
        """Add rows; when this returns they survive a crash of the program and of the machine.

        Raises
        ------
        OSError
            If the disk is full or the directory is not writable; the table is then as before.
        """
        if not rows:
            return
        kept = self.kept()
        number = kept[-1].span[1] + 1 if kept else 1
        while (self.folder / _name((number, number))).exists():  # a stranger has the name
            number += 1
        table = table_of(rows)
        self._write(parquet(lambda: [table]), len(rows), (number, number), Ledger(kept))
        self._merge()

    def tables(self, columns: Sequence[str] | None = None) -> Iterator[Any]:
        """Yield the rows in the order in which they came, as tables; also while another one writes.

        Raises
        ------
        ValueError
            If a file is damaged, not what was written, or missing; with its name.
        """
        done = tries = 0
        while True:
            begin = 0
            try:
                for part in self.kept():
                    if begin + part.rows > done:
                        table = self._read(part, columns)
                        skipped, done = max(0, done - begin), begin + part.rows
                        yield table.slice(skipped)
                    begin += part.rows
                return
            except FileNotFoundError as error:
                # merged into a larger part since the ledger was read
                tries += 1
                if tries == _TRIES:
                    raise InputError(
                        f"{error.filename} is missing: it was stored, and has been removed since; "
                        "put it back, or run the campaign again for its cases"
                    ) from None

    def kept(self) -> tuple[Part, ...]:
        """Return the parts that count now."""
        ledger = self._ledger()
        if ledger.coming is None or ledger.instead_of:
            return ledger.kept
        is_there = (self.folder / ledger.coming.name).exists()
        return (*ledger.kept, ledger.coming) if is_there else ledger.kept

    def settle(self) -> None:
        """Clean up after a killed run: incomplete additions and removals of parts, drafts."""
        ledger = self._ledger()
        kept = self.kept()
        for part in (*ledger.replaced, ledger.coming if ledger.instead_of else None):
            if part is not None:
                self._remove(part)
        remove_drafts(self.folder)
        if Ledger(kept) != ledger:
            self._note(Ledger(kept))
        self._merge()

    def forget_missing(self) -> list[Part]:
        """Strike parts that are not there any more, so that their cases are run again; which."""
        kept = self.kept()
        missing = [part for part in kept if not (self.folder / part.name).exists()]
        if missing:
            self._note(Ledger(tuple(part for part in kept if part not in missing)))
        return missing

    def strangers(self) -> list[Path]:
        """Return files that are not in the ledger; they are neither read nor removed."""
        ledger = self._ledger()
        known = {part.name for part in (*ledger.kept, *ledger.replaced)}
        known |= {ledger.coming.name} if ledger.coming else set()
        found = self.folder.glob("*")
        return sorted(path for path in found if path.name not in known and not is_draft(path))

    def checked(self, part: Part) -> Any:
        """Return a part; ValueError if it differs from the part that was written."""
        table = self._read(part, None)
        if table.num_rows != part.rows:
            raise InputError(
                f"{self.folder / part.name} has {table.num_rows} rows, {part.rows} were written"
            )
        return table

    def _merge(self) -> None:
        kept = self.kept()
        last = kept[-_MERGED:]
        lengths = {part.span[1] - part.span[0] for part in last}
        if len(last) < _MERGED or len(lengths) > 1:
            return
        whole = (last[0].span[0], last[-1].span[1])
        paths = [self.folder / part.name for part in last]
        size = sum(path.stat().st_size if path.exists() else _LARGEST for path in paths)
        if size > _LARGEST or (self.folder / _name(whole)).exists():
            return
        merged = self._write(
            parquet(lambda: (self._read(part, None) for part in last)),
            sum(part.rows for part in last),
            whole,
            Ledger(kept, instead_of=_MERGED),
        )
        self._note(Ledger((*kept[:-_MERGED], merged), replaced=last))
        for part in last:
            (self.folder / part.name).unlink()
        self._merge()

    def _write(self, content: Any, rows: int, span: tuple[int, int], ledger: Ledger) -> Part:
        """Write a part after recording it in the ledger."""
        part = Part(_name(span), hashlib.sha256(content).hexdigest(), rows)
        self.folder.mkdir(parents=True, exist_ok=True)
        self._note(replace(ledger, coming=part))
        try:
            write_new(self.folder / part.name, content)
        except OSError:
            with suppress(OSError):  # where nothing can be written it is not there either
                self._note(Ledger(ledger.kept))
            raise
        return part

    def _read(self, part: Part, columns: Sequence[str] | None) -> Any:
        return read_parquet(self.folder / part.name, part.sha256, columns)

    def _remove(self, part: Part) -> None:
        """Remove a file if it is the one that was written."""
        path = self.folder / part.name
        if path.is_file() and hashlib.sha256(path.read_bytes()).hexdigest() == part.sha256:
            path.unlink()


def parquet(tables: Callable[[], Iterable[Any]]) -> Any:
    """Return tables as the bytes of one Parquet file, with a checksum of every page.

    They are read twice, and only one of them is held at a time: columns may differ.
    """
    pa = arrow()
    schema = pa.unify_schemas([table.schema for table in tables()], promote_options="permissive")
    sink = pa.BufferOutputStream()
    write_parquet(sink, schema, tables())
    pa.default_memory_pool().release_unused()
    return sink.getvalue()


def write_parquet(sink: Any, schema: Any, tables: Iterable[Any]) -> None:
    """Write tables one after another; missing columns of a table are empty."""
    pa = arrow()
    options = {"compression": "zstd", "write_page_checksum": True}
    with pa.parquet.ParquetWriter(sink, schema, **options) as writer:
        for table in tables:
            both = [schema.empty_table(), table]
            writer.write_table(pa.concat_tables(both, promote_options="permissive"))


def table_of(rows: Sequence[Mapping[str, Any]]) -> Any:
    """Return rows as a table; a column is of words, of lists of numbers, whole or real numbers."""
    pa = arrow()
    names = dict.fromkeys(name for row in rows for name in row)
    return pa.table({name: _column(pa, [row.get(name) for row in rows]) for name in names})


def _column(pa: Any, values: list[Any]) -> Any:
    found = pa.array(values)  # null where there is no value: another part may say what it is
    return found.cast(pa.list_(pa.float64())) if pa.types.is_list(found.type) else found


def _span(name: str) -> tuple[int, int] | None:
    """Return the first and the last append in a part of this name; None for other files."""
    found = _NAME.fullmatch(name)
    first, last = map(int, found.groups()) if found else (1, 0)
    return (first, last) if first <= last else None


def _name(span: tuple[int, int]) -> str:
    return f"{span[0]:06d}-{span[1]:06d}.parquet"
