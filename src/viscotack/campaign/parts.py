"""A growing table as Parquet files that appear whole or not at all.

A part holds the rows ``000007-000007.parquet`` of one append. When 32 parts of equal span have come
together they are merged into one, so that 1e5 appends leave about a hundred files. A part whose
span lies within that of another was merged already and is ignored: at any instant the directory
says the same.
"""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from viscotack.errors import InputError
from viscotack.files.whole import Target, write_whole

# Parts of equal span that are merged, and the largest part that a merge makes [bytes].
_MERGED = 32
_LARGEST = 100e6
_TRIES = 5


def arrow() -> Any:
    """Return the library of the store, or say how to get it."""
    try:
        import pyarrow
        import pyarrow.compute
        import pyarrow.parquet
    except ImportError:
        raise ModuleNotFoundError(
            "campaigns are stored in Parquet, which needs pyarrow; install it with "
            "pip install 'viscotack[campaign]'"
        ) from None
    return pyarrow


class Parts:
    """A table in a directory, to which rows are only added.

    Parameters
    ----------
    folder : Path
        The directory; made by the first append.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def append(self, rows: Sequence[Mapping[str, Any]]) -> None:
        """Add rows; when this returns they survive a crash of the program and of the machine.

        Raises
        ------
        OSError
            If the disk is full or the directory is not writable; the table is then as before.
        """
        if not rows:
            return
        spans = self._spans()
        number = max((last for _, last in spans), default=0) + 1
        self._write(table_of(rows), number, number)
        self._merge([*spans, (number, number)])

    def read(self, columns: Sequence[str] | None = None) -> Any:
        """Return the rows in the order in which they came, as a pyarrow.Table.

        Raises
        ------
        ValueError
            If a file is damaged; with its name.
        """
        pa = arrow()
        for attempt in range(_TRIES):
            try:
                tables = [self._read(span, columns) for span in self._spans()]
                break
            except FileNotFoundError:
                # merged into a larger part since the directory was read
                if attempt == _TRIES - 1:
                    raise
        return pa.concat_tables(tables, promote_options="permissive") if tables else pa.table({})

    def tidy(self) -> None:
        """Remove what a killed run left: drafts, and parts that were merged."""
        if not self.folder.is_dir():
            return
        kept = {_name(span) for span in self._spans()}
        for path in self.folder.iterdir():
            if path.suffix == ".draft" or (path.suffix == ".parquet" and path.name not in kept):
                path.unlink(missing_ok=True)

    def _spans(self) -> list[tuple[int, int]]:
        """Return first and last append of each part that counts, in order."""
        found = sorted(
            (int(first), int(last))
            for path in (self.folder.glob("*-*.parquet") if self.folder.is_dir() else ())
            for first, _, last in [path.stem.partition("-")]
        )
        kept: list[tuple[int, int]] = []
        # of two parts with one beginning the longer, which is sorted behind, holds the other
        for first, last in found:
            if kept and kept[-1][0] == first:
                kept[-1] = (first, last)
            elif not kept or first > kept[-1][1]:
                kept.append((first, last))
        return kept

    def _merge(self, spans: list[tuple[int, int]]) -> None:
        last = spans[-_MERGED:]
        lengths = {b - a for a, b in last}
        size = sum((self.folder / _name(span)).stat().st_size for span in last)
        if len(last) < _MERGED or len(lengths) > 1 or size > _LARGEST:
            return
        whole = (last[0][0], last[-1][1])
        pa = arrow()
        tables = [self._read(span, None) for span in last]
        self._write(pa.concat_tables(tables, promote_options="permissive"), *whole)
        for span in last:
            (self.folder / _name(span)).unlink()
        self._merge([*spans[:-_MERGED], whole])

    def _read(self, span: tuple[int, int], columns: Sequence[str] | None) -> Any:
        pa, path = arrow(), self.folder / _name(span)
        try:
            return pa.parquet.read_table(path, columns=columns, partitioning=None)
        except FileNotFoundError:
            raise
        except (OSError, pa.ArrowException) as error:
            raise InputError(
                f"{path} is damaged: {error}; move it away, and run the campaign again for its "
                "cases"
            ) from None

    def _write(self, table: Any, first: int, last: int) -> None:
        self.folder.mkdir(parents=True, exist_ok=True)
        write_table(table, self.folder / _name((first, last)))


def write_table(table: Any, path: Target) -> None:
    """Write a table to a Parquet file, whole or not at all, and durably."""
    pa = arrow()
    sink = pa.BufferOutputStream()
    pa.parquet.write_table(table, sink, compression="zstd")
    write_whole(path, sink.getvalue())


def table_of(rows: Sequence[Mapping[str, Any]]) -> Any:
    """Return rows as a table; a column is of words, of lists of numbers, whole or real numbers."""
    pa = arrow()
    names = dict.fromkeys(name for row in rows for name in row)
    values = {name: [row.get(name) for row in rows] for name in names}
    return pa.table({name: pa.array(v, _type(pa, v)) for name, v in values.items()})


def _type(pa: Any, values: Iterable[Any]) -> Any:
    kinds = {type(v) for v in values if v is not None}
    if not kinds:  # another part may say what it is
        return pa.null()
    if str in kinds or kinds and all(issubclass(k, str) for k in kinds):
        return pa.string()
    if list in kinds:
        return pa.list_(pa.float64())
    if bool in kinds:
        return pa.bool_()
    return pa.int64() if kinds == {int} else pa.float64()


def _name(span: tuple[int, int]) -> str:
    return f"{span[0]:06d}-{span[1]:06d}.parquet"
