"""Rows in the order of a plan, however many: sorted in two passes, with the disk between them."""

import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from .cases import Cases
from .parts import arrow

# Rows that are held at once: of a campaign 15 MB.
_HELD = 10_000

# A column beside those of the rows.
_RANK = " rank"

# Returns the rows of a table, some at a time, with all columns or those that are named.
Tables = Callable[[Sequence[str] | None], Iterator[Any]]


@dataclass(frozen=True)
class Ordered:
    """Rows of a table in order, each name once.

    Attributes
    ----------
    schema : pyarrow.Schema
        Of all of them.
    rows : int
        How many there are.
    widths : dict
        Length of the longest list in each column of lists.
    chunks : callable
        Returns the rows, some at a time, as tables with this schema.
    """

    schema: Any
    rows: int
    widths: dict[str, int]
    chunks: Callable[[], Iterator[Any]]

    def table(self) -> Any:
        """Return all rows as one table."""
        return arrow().concat_tables([self.schema.empty_table(), *self.chunks()])


@contextmanager
def in_order(
    tables: Tables, cases: Cases, left_out: npt.NDArray[np.bool_] | None = None
) -> Iterator[Ordered]:
    """Hold the rows of a table in the order of a plan.

    Of rows with the same name the first counts: a case that was stored is not run again, and what a
    second run had none the less is the same.

    Parameters
    ----------
    tables : callable
        With a column ``name``; it is read twice, and rows that came in between are left.
    cases : Cases
        The plan. Rows of cases that are not in it come behind, by name.
    left_out : array of bool, optional
        Rows, in the order in which they came, that do not count; later ones do not either.
    """
    pa = arrow()
    ranks = _ranks(tables, cases, left_out)
    del cases  # of a million 80 MB, and not needed any more
    pa.default_memory_pool().release_unused()
    count = int(np.count_nonzero(ranks >= 0))
    with tempfile.TemporaryDirectory(prefix="viscotack-") as name:
        shelf = _Shelf(Path(name), in_memory=count <= _HELD)
        begin = 0
        for table in tables(None):
            here = ranks[begin : begin + table.num_rows]
            begin += table.num_rows
            shelf.put(table.slice(0, len(here)), here)
            if begin >= len(ranks):
                break
        schema = pa.unify_schemas([pa.schema([]), *shelf.schemas], promote_options="permissive")

        def chunks() -> Iterator[Any]:
            for number in range(-(-count // _HELD)):
                yield shelf.taken(number, schema)

        yield Ordered(schema, count, shelf.widths, chunks)


class _Shelf:
    """Rows by their rank, in boxes of so many; on the disk where there are more boxes than one."""

    def __init__(self, folder: Path, *, in_memory: bool) -> None:
        self._folder, self._in_memory = folder, in_memory
        self._boxes: dict[int, list[Any]] = {}
        self.schemas: list[Any] = []
        self.widths: dict[str, int] = {}

    def put(self, table: Any, ranks: npt.NDArray[np.int64]) -> None:
        pa = arrow()
        table = table.append_column(_RANK, pa.array(ranks))
        self.schemas.append(table.drop_columns(_RANK).schema)
        for name, width in measured(table).items():
            self.widths[name] = max(width, self.widths.get(name, 0))
        for number in np.unique(ranks[ranks >= 0] // _HELD).tolist():
            box = self._boxes.setdefault(number, [])
            rows = table.take(np.flatnonzero((ranks >= 0) & (ranks // _HELD == number)))
            box.append(rows if self._in_memory else self._shelved(number, len(box), rows))

    def taken(self, number: int, schema: Any) -> Any:
        """Return the rows of a box in order."""
        pa = arrow()
        found = [box if self._in_memory else _loaded(box) for box in self._boxes[number]]
        rows = pa.concat_tables([schema.empty_table(), *found], promote_options="permissive")
        rows = rows.take(np.argsort(rows.column(_RANK).to_numpy())).drop_columns(_RANK)
        if not self._in_memory:
            pa.default_memory_pool().release_unused()
        return rows

    def _shelved(self, number: int, place: int, rows: Any) -> Path:
        pa = arrow()
        path = self._folder / f"{number}-{place}.arrow"
        with pa.OSFile(str(path), "wb") as file, pa.ipc.new_file(file, rows.schema) as out:
            out.write_table(rows)
        return path


def measured(table: Any) -> dict[str, int]:
    """Return the length of the longest list in each column of lists."""
    pa = arrow()
    lists = [field.name for field in table.schema if pa.types.is_list(field.type)]
    lengths = {name: pa.compute.list_value_length(table.column(name)) for name in lists}
    return {name: pa.compute.max(found).as_py() or 0 for name, found in lengths.items()}


def _loaded(path: Path) -> Any:
    pa = arrow()
    with pa.OSFile(str(path), "rb") as file:
        return pa.ipc.open_file(file).read_all()


def _ranks(
    tables: Tables, cases: Cases, left_out: npt.NDArray[np.bool_] | None
) -> npt.NDArray[np.int64]:
    """Return the place of each row among those that count; -1 for one that does not."""
    found: list[npt.NDArray[np.int64]] = []
    others: dict[str, int] = {}
    for table in tables(["name"]):
        names = table.column("name").to_pylist()
        here = cases.places(names)
        for i in np.flatnonzero(here < 0).tolist():
            here[i] = -1 - others.setdefault(names[i], len(others))
        found.append(here)
    places = np.concatenate(found) if found else np.zeros(0, np.int64)
    # what an earlier plan had and this one has not comes last, by name
    by_name = {name: len(cases) + i for i, name in enumerate(sorted(others))}
    behind = np.array([by_name[name] for name in others], np.int64)
    places[places < 0] = behind[-1 - places[places < 0]]
    kept = np.arange(len(places))
    if left_out is not None:
        kept = np.flatnonzero(~left_out[: len(places)])
    # stable: of equal places the first row comes first
    kept = kept[np.argsort(places[kept], kind="stable")]
    again = np.diff(places[kept], prepend=-1) == 0
    kept = kept[~again]
    ranks = np.full(len(places), -1)
    ranks[kept] = np.arange(len(kept))
    return ranks
