"""Memory-efficient list of cases and their state: about 60 MB for a million cases."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any, overload

import numpy as np
import numpy.typing as npt

# Number of cases collected before conversion to arrays; arrays of this size are returned to the
# system after joining.
_BLOCK = 20_000

# Failures that another run may not meet: it tries their cases again.
PASSING = ("crashed", "worker died")

Mask = npt.NDArray[np.bool_]
Names = npt.NDArray[np.bytes_]


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
    """Cases as columns of numbers; each is made when it is needed.

    Parameters
    ----------
    names : array of bytes
        The names.
    columns : mapping of str to array
        The inputs; not a number where a case has no such input.
    """

    def __init__(self, names: Names, columns: Mapping[str, npt.NDArray]) -> None:
        self.names, self.columns = names, dict(columns)
        self._sorted: tuple[npt.NDArray, npt.NDArray] | None = None

    @classmethod
    def of(cls, cases: Iterable[Case]) -> "Cases":
        """Return cases that were made one by one; they may be more than there is room for twice."""
        found, left = [], iter(cases)
        while block := list(islice(left, _BLOCK)):
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

    def places(self, names: "Iterable[str] | Names") -> npt.NDArray[np.int64]:
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


def packed(names: Iterable[str]) -> Names:
    """Return names as an array, 16 bytes each for names by content."""
    return np.array([name.encode() for name in names], dtype="S")


@dataclass(frozen=True)
class Standing:
    """How the cases of a plan stand, each at its place.

    Attributes
    ----------
    done, failed : array of bool
        With a result, and with a failure only.
    lasting : array of bool
        Failed for a reason that another run meets again.
    """

    done: Mask
    failed: Mask
    lasting: Mask

    @classmethod
    def of(cls, count: int) -> "Standing":
        """Return the state of a number of untried cases."""
        return cls(*(np.zeros(count, bool) for _ in range(3)))

    def note_results(self, places: npt.NDArray[np.int64]) -> None:
        """Count cases as solved; places of -1 are of no case of the plan."""
        known = places[places >= 0]
        self.done[known] = True
        self.failed[known] = self.lasting[known] = False

    def note_failures(self, places: npt.NDArray[np.int64], failures: Iterable[str]) -> None:
        """Count cases as failed, unless they were solved; the last word on a case counts."""
        for place, failure in zip(places.tolist(), failures, strict=True):
            if place >= 0 and not self.done[place]:
                self.failed[place], self.lasting[place] = True, failure not in PASSING

    def note(
        self,
        cases: Cases,
        results: Iterable[Mapping[str, Any]],
        failures: Iterable[Mapping[str, Any]],
    ) -> None:
        """Count rows that were stored."""
        failures = list(failures)
        self.note_results(cases.places(row["name"] for row in results))
        self.note_failures(
            cases.places(row["name"] for row in failures), [row["failure"] for row in failures]
        )
