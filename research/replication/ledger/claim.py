"""The claims of the thesis, rows of claims.toml, and how they are judged."""

import tomllib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import StrEnum
from functools import cache
from importlib import import_module
from math import isnan
from pathlib import Path
from typing import Any

from viscotack import InputError

from ..figures.catalogue import figures
from ..kept import Numbers

# Difference that is said [%].
_LEAST = 0.002
# Returns the numbers of a figure by its name.
Of = Callable[[str], Numbers]


class Verdict(StrEnum):
    """What became of a claim."""

    HOLDS = "holds"
    CORRECTED = "holds with correction"
    THEN = "holds as measured then"
    FAILS = "does not hold"
    OPEN = "cannot be decided"


class Standing(StrEnum):
    """How firmly a claim stands, as corrected where it needs a correction."""

    PROVEN = "proven"
    CONSISTENT = "consistent"
    CONJECTURE = "conjecture"
    REFUTED = "refuted"


@dataclass(frozen=True)
class Measured:
    """The number on which a verdict rests, and what stands in the ledger, with unit and error."""

    value: float
    words: str


def listed(form: str, *columns: Iterable[Any]) -> str:
    """Return the rows of some columns in the words of a form, one after the other."""
    return ", ".join(form.format(*row) for row in zip(*columns, strict=True))


@dataclass(frozen=True)
class Claim:
    """A claim: a row of claims.toml, which says what its fields are."""

    name: str
    place: str
    says: str
    thesis: float | str
    measure: Callable[[Of], Measured]
    stands: tuple[float, float]
    verdict: Verdict
    evidence: str

    def judged(self, of: Of) -> tuple[Measured, Standing]:
        """Measure it, and say how firmly it stands.

        A claim is proven if neither a simulation nor a trained model is needed.

        Raises
        ------
        ValueError
            If the verdict does not stand with what was measured.
        """
        needed: set[str] = set()

        def noted(name: str) -> Numbers:
            needed.add(name)
            return of(name)

        found = self.measure(noted)
        low, high = self.stands
        if isnan(found.value) or not low <= found.value <= high:
            raise InputError(
                f"claim {self.name}: measured {found.value:.5g}, and the verdict '{self.verdict}' "
                f"stands between {low:g} and {high:g}; look at it again"
            )
        if self.verdict in (Verdict.FAILS, Verdict.OPEN):
            refuted = self.verdict is Verdict.FAILS
            return found, Standing.REFUTED if refuted else Standing.CONJECTURE
        alone = all(figures()[name].theory for name in needed) and self.verdict is not Verdict.THEN
        return found, Standing.PROVEN if alone else Standing.CONSISTENT

    def row(self, found: Measured, standing: Standing) -> str:
        """Return its line of the ledger."""
        thesis, apart = str(self.thesis), "-"
        if isinstance(self.thesis, float):
            thesis = f"{self.thesis:.6g}"
            if self.thesis:
                off = 100 * (found.value / self.thesis - 1)
                # what is below that is round-off, which another processor has otherwise
                apart = f"{off:+.3g} %" if abs(off) > _LEAST else "0"
        cells = (
            f"`{self.name}`",
            f"{self.says} ({self.place})",
            thesis,
            found.words,
            apart,
            f"**{self.verdict}**, {standing}",
            self.evidence,
            f"`claim {self.name}`",
        )
        return "| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |"


def _claim(row: dict[str, Any]) -> Claim:
    room, function = row["measure"].split(".")
    measure = getattr(import_module(f".{room}", __package__), function)
    judged = {
        "measure": measure,
        "stands": tuple(row["stands"]),
        "verdict": Verdict(row["verdict"]),
    }
    return Claim(**row | judged)


@cache
def chapters() -> dict[str, tuple[Claim, ...]]:
    """Return the claims of the thesis by its chapters; the last part is what it does not say."""
    with Path(__file__).with_name("claims.toml").open("rb") as file:
        parts = tomllib.load(file)["chapter"]
    return {part["name"]: tuple(_claim(row) for row in part["claim"]) for part in parts}


def named(name: str) -> Claim:
    """Return a claim by its name."""
    claims = {claim.name: claim for part in chapters().values() for claim in part}
    if name not in claims:
        raise InputError(f"there is no claim {name!r}; there are {', '.join(claims)}")
    return claims[name]
