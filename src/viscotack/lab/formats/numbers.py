"""Parse numbers of laboratory files: decimal commas, gaps and malformed cells."""

import math
import re
from collections.abc import Iterable, Sequence

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.sweeps import celsius

_NUMBER = re.compile(r"[+-]?([0-9]+[.,]?[0-9]*|[.,][0-9]+)([eE][+-]?[0-9]+)?")
_PLAIN = re.compile(r"[0-9.eE+\- ]*")
_GROUPED = re.compile(r"[+-]?[1-9][0-9]{0,2}([.,][0-9]{3})+")
_MISSING = {
    "", "-", "--", "---", "----", "*", "***", "nan", "na", "n/a", "n.a.", "#n/a", "none", "null",
    "missing", "#div/0!", "#value!", "#num!", "#wert!", "#zahl!", "1.#qnan", "-1.#ind", "1.#inf",
}  # fmt: skip
# written by loggers where nothing was measured
_FILLERS = (-999.0, -9999.0, -99999.0)
CLOCK = re.compile(r"([0-9]+):([0-5]?[0-9]):([0-5]?[0-9](?:[.,][0-9]+)?)")
_MINUTES = re.compile(r"([0-9]+):([0-5]?[0-9](?:[.,][0-9]+)?)")


def number(text: str, mark: str) -> float:
    """Parse the number in a cell; nan for a gap.

    Parameters
    ----------
    text : str
        A cell; ``---`` and the like are gaps.
    mark : {".", ","}
        Decimal mark. The other mark is rejected.

    Raises
    ------
    ValueError
        If the cell contains anything else, or a number too large for a float.

    Examples
    --------
    >>> number("8,5e3", ","), number("---", ",")
    (8500.0, nan)
    """
    plain = text.strip().strip('"').replace("\u2212", "-").replace("\u00a0", "")
    if plain.casefold() in _MISSING:
        return math.nan
    other = "," if mark == "." else "."
    if plain.startswith("="):
        raise InputError(f"the formula {plain[:40]!r} has no value; save the file with values")
    if _NUMBER.fullmatch(plain) is None or other in plain:
        raise InputError(f"expected a number, got {text[:40]!r}")
    value = float(plain.replace(mark, "."))
    if math.isinf(value):
        raise InputError(f"the number {text[:40]!r} is too large")
    return value


def seconds(text: str) -> float:
    """Return the seconds of a clock time, ``hh:mm:ss`` or ``mm:ss``; nan for a gap.

    Examples
    --------
    >>> seconds("01:02:03.5"), seconds("2:03")
    (3723.5, 123.0)
    """
    match = CLOCK.fullmatch(text.strip()) or _MINUTES.fullmatch(text.strip())
    if match is None and text.strip().casefold() in _MISSING:
        return math.nan
    if match is None:
        raise InputError(f"expected a time such as 00:01:30, got {text[:40]!r}")
    total = 0.0
    for part in match.groups():
        total = 60 * total + float(part.replace(",", "."))
    return total


def without_fillers(values: Array) -> tuple[Array, int]:
    """Replace -999, -9999 and -99999 by nan where all other numbers are far above; count them.

    Examples
    --------
    >>> without_fillers(np.array([1.0, -9999, 3])), without_fillers(np.array([-9998.0, -9999]))
    ((array([ 1., nan,  3.]), 1), (array([-9998., -9999.]), 0))
    """
    for filler in _FILLERS:
        filled = values == filler
        if filled.any() and not np.any(values[~filled] < filler / 10):
            return np.where(filled, math.nan, values), int(filled.sum())
    return values, 0


def is_number(cell: str) -> bool:
    """Return whether a cell looks like a number."""
    try:
        float(cell.strip().replace(",", "."))
    except ValueError:
        return False
    return True


def decimal_mark(cells: Iterable[str]) -> str:
    """Determine the decimal mark of a table from its numbers.

    Raises
    ------
    ValueError
        If points and commas are mixed, or every comma may be a thousands separator.

    Examples
    --------
    >>> decimal_mark(["0,1", "1,234"])
    ','
    """
    found = [cell.strip() for cell in cells if _NUMBER.fullmatch(cell.strip())]
    with_comma = [cell for cell in found if "," in cell]
    if not with_comma:
        return "."
    if any("." in cell for cell in found):
        raise InputError("numbers have decimal points and commas; set `decimal` to one of them")
    if all(_GROUPED.fullmatch(cell) for cell in with_comma):
        raise InputError(f"{with_comma[0]!r} has a decimal or thousands mark; set `decimal`")
    return ","


def plain_numbers(cells: Sequence[str]) -> Array | None:
    """Parse many cells quickly; None if one of them needs :func:`number`.

    Cells of digits, points, signs and exponents only are parsed by :class:`float`, with the same
    result as :func:`number`. Any other cell, or a number too large for a float, gives None.

    Notes
    -----
    100,000 rows of three columns take 0.7 s of processor time, mostly to split lines into cells.
    The parser of pandas takes 0.1 s, and as long again to be imported, but it pads short rows,
    which here must be detected as damage.

    Examples
    --------
    >>> plain_numbers(["1.5", "2e3"]), plain_numbers(["1.5", "1,5"])
    (array([1.5e+00, 2.0e+03]), None)
    """
    if _PLAIN.fullmatch(" ".join(cells)) is None:
        return None
    try:
        values = np.fromiter(map(float, cells), dtype=float, count=len(cells))
    except ValueError:
        return None
    return values if np.all(np.isfinite(values)) else None


def half_digit(text: str) -> float:
    """Return half a unit of the last digit of a written number.

    Examples
    --------
    >>> half_digit("0.150"), half_digit("12"), half_digit("1.5E3")
    (0.0005, 0.5, 50.0)
    """
    mantissa, _, exponent = text.strip().lower().replace(",", ".").partition("e")
    decimals = len(mantissa.partition(".")[2])
    power = int(exponent) if re.fullmatch(r"[+-]?[0-9]{1,3}", exponent) else 0
    return 0.5 * 10.0 ** (power - decimals)


# ---- unusual values, which may indicate a wrong unit ---------------------------------------------

_ROOM = 263.0, 323.0  # K: temperatures of a room or a refrigerator
_COLD = 100.0  # K; few laboratories measure below
_HARD, _SOFT = 3e10, 0.1  # Pa: beyond polymers and bones, below weak gels


def doubtful_temperature(kelvins: Array, in_kelvin: bool) -> list[str]:
    """Return a note if temperatures look as if they were in another unit.

    Examples
    --------
    >>> doubtful_temperature(np.array([566.15, 571.15]), False)
    ['check: 293 C to 298 C would be temperatures of a room in kelvin']
    """
    known = kelvins[np.isfinite(kelvins)]
    if not known.size:
        return []
    low, high = float(known.min()), float(known.max())
    if in_kelvin and high < _COLD:
        return [f"check: {low:.4g} to {high:.4g} K would be usual if in Celsius"]
    if in_kelvin or low - 273.15 < _ROOM[0] or high - 273.15 > _ROOM[1]:
        return []
    return [f"check: {celsius(low)} to {celsius(high)} would be temperatures of a room in kelvin"]


def doubtful_modulus(modulus: Array) -> list[str]:
    """Return a note if a modulus is unusual for polymers, gels and tissues.

    Examples
    --------
    >>> doubtful_modulus(np.array([1e-3, 2e-3]))
    ['check: moduli of 0.001 to 0.002 Pa are below weak gels or above bone']
    """
    low, high = float(np.min(modulus)), float(np.max(modulus))
    if _SOFT <= high <= _HARD:
        return []
    return [f"check: moduli of {low:.2g} to {high:.2g} Pa are below weak gels or above bone"]
