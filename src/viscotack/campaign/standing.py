"""Which cases of a plan have a result, and which have failed: a byte a case and answer."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .cases import Cases

# Failures that another run may not meet: it tries their cases again.
PASSING = ("crashed", "worker died")

Mask = npt.NDArray[np.bool_]


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
        """Return that of so many cases of which none was tried."""
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
