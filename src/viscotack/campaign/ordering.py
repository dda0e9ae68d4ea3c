"""Rows in the order of a plan, however many: sorted in two passes, with the disk between them.

Each part is split into boxes of neighbouring rows, and each box is sorted. A sort of pyarrow holds
all rows in memory. Its partitioned datasets need more memory than these boxes, and they read files
without comparing the hashes of parts, which another process may merge meanwhile.
"""

import tempfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.files.arrow import arrow

from .cases import Cases, Names, packed

# Rows in memory at a time: 15 MB of a campaign.
_HELD = 10_000
# A column beside those of the rows.
_RANK = " rank"


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
    tables: Callable[[], Iterable[Any]],
    names: Names,
    cases: Cases,
    counts: npt.NDArray[np.int64],
) -> Iterator[Ordered]:
    """Hold the rows of a table in the order of a plan, each name once.

    Parameters
    ----------
    tables : callable
        Returns the rows, some at a time; more than `names` where another process adds rows.
    names : array of bytes
        The names of the rows, in the same order.
    cases : Cases
        The plan. Rows of cases that are not in it come behind, by name.
    counts : array of int
        Places of the rows that count; of rows with the same name the one that comes first here.
    """
    pa = arrow()
    ranks = _ranks(names, cases, counts)
    del cases, names, counts  # of a million 100 MB, and not needed any more
    count = int(np.count_nonzero(ranks >= 0))
    with tempfile.TemporaryDirectory(prefix="viscotack-") as folder:
        schemas, widths, begin = [pa.schema([])], {}, 0
        boxes: dict[int, list[Path]] = {}
        for number, table in enumerate(tables()):
            here = ranks[begin : begin + table.num_rows]
            begin += table.num_rows
            if not len(here):
                break  # rows that were added meanwhile
            table = table.slice(0, len(here))
            schemas.append(table.schema)
            for name, width in measured(table).items():
                widths[name] = max(width, widths.get(name, 0))
            table = table.append_column(_RANK, pa.array(here))
            for box in np.unique(here[here >= 0] // _HELD).tolist():
                rows = table.take(np.flatnonzero((here >= 0) & (here // _HELD == box)))
                path = Path(folder, f"{box}-{number}.arrow")
                with pa.ipc.new_stream(str(path), rows.schema) as stream:
                    stream.write_table(rows)
                boxes.setdefault(box, []).append(path)
        schema = pa.unify_schemas(schemas, promote_options="permissive")

        def chunks() -> Iterator[Any]:
            for box in sorted(boxes):
                some = map(_unordered, boxes[box])
                rows = pa.concat_tables([schema.empty_table(), *some], promote_options="permissive")
                yield rows.take(np.argsort(rows.column(_RANK).to_numpy())).drop_columns(_RANK)
                pa.default_memory_pool().release_unused()

        yield Ordered(schema, count, widths, chunks)


def _unordered(path: Path) -> Any:
    """Read the rows of a box, without threads of Arrow; see `parts`."""
    pa = arrow()
    with pa.OSFile(str(path)) as file:
        return pa.ipc.open_stream(file, options=pa.ipc.IpcReadOptions(use_threads=False)).read_all()


def names_of(tables: Iterable[Any]) -> Names:
    """Return the names of all rows of tables; as words of Python a table at a time only."""
    found = [packed(table.column("name").to_pylist()) for table in tables]
    return np.concatenate(found) if found else packed(())


def measured(table: Any) -> dict[str, int]:
    """Return the length of the longest list in each column of lists."""
    pa = arrow()
    lists = [field.name for field in table.schema if pa.types.is_list(field.type)]
    lengths = {name: pa.compute.list_value_length(table.column(name)) for name in lists}
    return {name: pa.compute.max(found).as_py() or 0 for name, found in lengths.items()}


def _ranks(names: Names, cases: Cases, counts: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Return the place of each row among those that count; -1 for one that does not."""
    places = cases.places(names)
    # rows of an earlier plan come last, by name
    others = places < 0
    places[others] = len(cases) + np.unique(names[others], return_inverse=True)[1]
    _, first = np.unique(places[counts], return_index=True)
    ranks = np.full(len(names), -1)
    ranks[counts[first]] = np.arange(len(first))
    return ranks
