"""Many cases in little room: a million names and inputs are some sixty megabytes."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, overload

import numpy as np
import numpy.typing as npt

# Bytes of a name by content, and how many cases are gathered before they are put into arrays: those
# of so many numbers the system takes back when they have been joined.
_NAME, _BLOCK = 16, 20_000


@dataclass(frozen=True)
class Case:
    """One case of a plan.

    Attributes
    ----------
    name : str
        By the content of its problem: equal problems have equal names.
    inputs : dict
        The numbers that state it, by column.
    """

    name: str
    inputs: dict[str, float]


class Cases(Sequence[Case]):
    """Cases as columns of numbers; each is made when it is asked for.

    Parameters
    ----------
    names : array of bytes
        The names.
    columns : mapping of str to array
        The inputs; not a number where a case has no such input.
    """

    def __init__(self, names: npt.NDArray[np.bytes_], columns: Mapping[str, npt.NDArray]) -> None:
        self.names, self.columns = names, dict(columns)
        self._sorted: tuple[npt.NDArray, npt.NDArray] | None = None

    @classmethod
    def of(cls, cases: Iterable[Case]) -> "Cases":
        """Return cases that were made one by one; they may be more than there is room for twice."""
        found = []
        for block in _blocks(cases):
            given = dict.fromkeys(name for case in block for name in case.inputs)
            columns = {n: np.array([c.inputs.get(n, np.nan) for c in block], float) for n in given}
            found.append(cls(packed(case.name for case in block), columns))
        return cls.joined(found)

    @classmethod
    def joined(cls, several: "Sequence[Cases]") -> "Cases":
        """Return cases one behind another; they need not have the same inputs."""
        every = dict.fromkeys(name for cases in several for name in cases.columns)
        columns = {
            name: np.concatenate(
                [cases.columns.get(name, np.full(len(cases), np.nan)) for cases in several]
            )
            for name in every
        }
        return cls(np.concatenate([c.names for c in several]) if several else packed(()), columns)

    def __len__(self) -> int:
        return len(self.names)

    @overload
    def __getitem__(self, place: int) -> Case: ...
    @overload
    def __getitem__(self, place: "slice | npt.NDArray") -> "Cases": ...
    def __getitem__(self, place: Any) -> Any:
        if isinstance(place, slice | np.ndarray):
            return Cases(self.names[place], {n: v[place] for n, v in self.columns.items()})
        stated = ((name, float(values[place])) for name, values in self.columns.items())
        # only a number that is not one is not equal to itself
        return Case(bytes(self.names[place]).decode(), {n: v for n, v in stated if v == v})

    def __iter__(self) -> Iterator[Case]:
        return (self[i] for i in range(len(self)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Cases):
            return NotImplemented
        return (
            np.array_equal(self.names, other.names)
            and self.columns.keys() == other.columns.keys()
            and all(
                np.array_equal(v, other.columns[n], equal_nan=True) for n, v in self.columns.items()
            )
        )

    __hash__ = None  # type: ignore[assignment]

    def first_of_each(self) -> "Cases":
        """Return the cases without those that were there before, in the same order."""
        _, first = np.unique(self.names, return_index=True)
        return self if len(first) == len(self) else self[np.sort(first)]

    def places(self, names: "Iterable[str] | npt.NDArray[np.bytes_]") -> npt.NDArray[np.int64]:
        """Return where names are among the cases; -1 where they are not."""
        if self._sorted is None:
            order = np.argsort(self.names, kind="stable")
            self._sorted = order, self.names[order]
        order, known = self._sorted
        wanted = names if isinstance(names, np.ndarray) else packed(names)
        if not len(known):
            return np.full(len(wanted), -1)
        at = np.minimum(np.searchsorted(known, wanted), len(known) - 1)
        return np.where(known[at] == wanted, order[at], -1)


def packed(names: Iterable[str]) -> npt.NDArray[np.bytes_]:
    """Return names as an array; a name that is too long for one by content stays as it is."""
    encoded = [name.encode() for name in names]
    return np.array(encoded, dtype=f"S{max(_NAME, *map(len, encoded), 1)}" if encoded else "S16")


def _blocks(cases: Iterable[Case]) -> Iterator[list[Case]]:
    block: list[Case] = []
    for case in cases:
        block.append(case)
        if len(block) == _BLOCK:
            yield block
            block = []
    if block:
        yield block
