"""Units of files of other programs, and functions shared by all formats."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NoReturn

from viscotack.errors import InputError
from viscotack.model.materials.branched_solids import Prony
from viscotack.model.materials.checks import positive
from viscotack.model.materials.shift import Shift
from viscotack.units import parse

_COMMENT = re.compile(r"units:\s*pressure\s+(\S+?),\s*time\s+(\S+)")


@dataclass(frozen=True)
class Units:
    """The units of the numbers in a file.

    Parameters
    ----------
    pressure : str
        Such as "Pa" or "MPa".
    time : str
        Such as "s" or "ms".

    Examples
    --------
    >>> Units("MPa", "ms").pascal, Units("MPa", "ms").second
    (1000000.0, 0.001)
    """

    pressure: str
    time: str

    def __post_init__(self):
        positive("a unit of pressure", self.pascal, "Pa")
        positive("a unit of time", self.second, "s")

    @property
    def pascal(self) -> float:
        """The unit of pressure in Pa."""
        # avoid importing the units library for SI
        return 1.0 if self.pressure == "Pa" else parse(f"1 {self.pressure}", "Pa")

    @property
    def second(self) -> float:
        """The unit of time in s."""
        return 1.0 if self.time == "s" else parse(f"1 {self.time}", "s")

    def words(self) -> str:
        """Return the comment that states the units."""
        return f"units: pressure {self.pressure}, time {self.time}"


SI = Units("Pa", "s")
_INCOMPRESSIBLE = "incompressible solid, written with a bulk modulus that does not relax"


@dataclass(frozen=True)
class Card:
    """Data of a material to export.

    Attributes
    ----------
    material : Prony
        The series.
    bulk_modulus : float or None
        Bulk modulus [Pa], constant in time, of an incompressible solid: the programs forbid a
        Poisson ratio of 0.5.
    shift : WLF, Arrhenius, TabulatedShift or None
        Temperature dependence of the times.
    """

    material: Prony
    bulk_modulus: float | None = None
    shift: Shift | None = None

    def elastic(self, tensile: float) -> tuple[float, float]:
        """Convert a tensile modulus of the material to the exported constants.

        Returns the Young's modulus [Pa] and the Poisson ratio. Without a bulk modulus both are
        unchanged.
        """
        if self.bulk_modulus is None:
            return tensile, self.material.poisson_ratio
        K, G = self.bulk_modulus, tensile / 3
        return 9 * K * G / (3 * K + G), (3 * K - 2 * G) / (2 * (3 * K + G))

    def notes(self) -> tuple[str, ...]:
        """Return the comments on the bulk modulus."""
        if self.bulk_modulus is None:
            return ()
        E = self.material.glassy_modulus
        less = 100 * (1 - self.elastic(E)[0] / E)
        return (
            f"{_INCOMPRESSIBLE}: {self.bulk_modulus!r} Pa",
            f"Young's modulus at short times is {less:.2g} % below the incompressible one",
        )


def as_told(
    text: str, modulus: float, poisson_ratio: float, *, given: bool = False
) -> tuple[float, float]:
    """Return Young's modulus [Pa] and Poisson ratio of the original material of a text.

    A comment states where a bulk modulus replaces a Poisson ratio of 0.5; it is ignored if
    one of the two was given in addition to the text.
    """
    if given or _INCOMPRESSIBLE not in text:
        return modulus, poisson_ratio
    return 3 * modulus * shear_factor(poisson_ratio), 0.5


def stated_number(text: str, pattern: str, what: str) -> float | None:
    """Return the number after a pattern in a text, or None."""
    found = re.search(pattern + r"\s+(\S+)", text)
    return found and number(found[1], text.count("\n", 0, found.start()) + 1, what)


def rows_of(text: str, comment: str) -> Iterator[tuple[int, list[str], str]]:
    """Yield number, words and text of each line that contains more than a comment."""
    for line, raw in enumerate(text.splitlines(), 1):
        if words := raw.split(comment)[0].replace(",", " ").split():
            yield line, words, raw


def units_of(text: str, units: Units | None) -> Units:
    """Return the given units, or those stated by a comment in the text."""
    if units is not None:
        return units
    found = _COMMENT.search(text)
    if found is None:
        raise InputError(
            "the text does not state its units; give them (units=Units('MPa', 's'), or on the "
            "command line --pressure-unit and --time-unit)"
        )
    return Units(*found.groups())


def head(mark: str, units: Units, notes: tuple[str, ...]) -> list[str]:
    """Format notes and units as comment lines."""
    lines = [line for note in notes for line in note.splitlines()]
    return [f"{mark} {line}" for line in (*lines, units.words())]


def shear_factor(poisson_ratio: float) -> float:
    """Return G/E = 1/(2 (1 + nu))."""
    return 1 / (2 * (1 + poisson_ratio))


def number(word: str, line: int, what: str) -> float:
    """Parse a number; raise an error that names the line."""
    try:
        value = float(word.lower().replace("d", "e"))  # Fortran writes 1.0D+00
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"line {line}: {what} must be a number, got {word!r}")
    return value


def series(
    rubbery_modulus: float, branches: list[tuple[float, float]], poisson_ratio: float
) -> Prony:
    """Return the solid; raise an error without branches."""
    if not branches:
        raise InputError("the text contains no branch of a Prony series")
    return Prony(
        rubbery_modulus=rubbery_modulus,
        branches=tuple(branches),
        poisson_ratio=poisson_ratio,
    )


def from_ratios(
    modulus: float, ratios: list[tuple[float, float]], poisson_ratio: float, *, instantaneous: bool
) -> Prony:
    """Return the solid whose branches are fractions of the instantaneous modulus.

    Parameters
    ----------
    modulus : float
        Young's modulus [Pa], instantaneous or long-term.
    ratios : list of (float, float)
        Fraction g_i of the instantaneous modulus, and relaxation time [s].
    poisson_ratio : float
        Poisson ratio.
    instantaneous : bool
        Which modulus was given.
    """
    rest = 1 - sum(sorted(g for g, _ in ratios))
    if rest <= 0:
        raise InputError(
            f"the ratios to the instantaneous modulus sum to {1 - rest:.12g}; a solid needs a sum "
            "below 1, otherwise its long-term modulus is not positive"
        )
    glassy = modulus if instantaneous else modulus / rest
    rubbery = modulus * rest if instantaneous else modulus
    return series(rubbery, [(g * glassy, time) for g, time in ratios if g > 0], poisson_ratio)


def other_bulk(line: int, shear: float, bulk: float) -> NoReturn:
    """Raise an error for a bulk series that differs from the shear series."""
    raise InputError(
        f"line {line}: shear and bulk relax differently ({shear:g} and {bulk:g}), so the "
        "Poisson ratio would depend on time, but here it must be constant. Make the bulk series "
        "equal to the shear series, or state an incompressible solid (Poisson ratio 0.5)"
    )
