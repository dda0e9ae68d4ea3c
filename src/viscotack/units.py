"""Words with units: text such as "5.19 mm" becomes a number in SI, and a number text for people.

All other modules use plain floats in SI. The unit library is imported by the first call of
:func:`parse`, not by ``import viscotack``.
"""

import math
import re
from functools import lru_cache
from typing import Any

from viscotack.errors import InputError

_NUMBER_AND_UNIT = re.compile(
    r"\s*([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)\s*(.*?)\s*"
)
_DECIMAL_COMMA = re.compile(r"\s*[+-]?\d*,\d+(?:[eE][+-]?\d+)?\s*[A-Za-zµμ°Ω%][^,]*|[+-]?\d*,\d+")
# Users write "J/m2" or "J/m^2"; the unit library needs "J/m**2".
# The unit library ignores other characters and would read "5 ?m" as metres.
_UNIT_MARKS = re.compile(r"[A-Za-zµμ°Ω%0-9 .·⋅*/^()⁻¹²³-]*")
# Powers of numbers are rejected because 9^9^9^9 would never finish; so are very long units.
_POWER_OF_NUMBER = re.compile(r"[\d¹²³]\s*(\^|\*\*|⁻)|\d\s*[¹²³]")
_LONGEST = 60
# Units of the field with their prefixes, read without the unit library: mN, um/s, mJ/m^2.
_PLAIN = re.compile(r"([GMkmunpµμ]?)(Pa|Hz|[msNJ])(?:/([GMkmunpµμ]?)([msN])(?:\^?([2]))?)?")
_POWERS = {"G": 9, "M": 6, "k": 3, "": 0, "m": -3, "u": -6, "µ": -6, "μ": -6, "n": -9, "p": -12}
_EXPONENT = re.compile(r"(?<=[A-Za-zµμΩ])\^?(-?\d+)")

# Largest first; "u" is what keyboards have for micro.
_PREFIXES = [(float(f"1e{power}"), p) for p, power in _POWERS.items() if p.isascii()]
# The units that take a prefix; thousands of seconds are no ks, and no speed is in km/s.
_PREFIXED = "N N/m Pa J J/m^2 J/m2 J/m J/mol m/N N/s Hz s m m/s".split()
_NOT_ABOVE_ONE = ("s", "m", "m/s")
# Beyond these no prefix makes a number readable.
_SMALLEST, _LARGEST = 1e-15, 1e12
_MOST_DIGITS = 8  # of an interval, and decimals of an uncertainty


@lru_cache(maxsize=1)
def _registry() -> Any:
    import pint

    return pint.UnitRegistry()


def parse(value: str | float, unit: str) -> float:
    """Convert a quantity with its unit to a number in a given SI unit.

    Parameters
    ----------
    value : str or float
        Text such as ``"5.19 mm"``, or a number that is already in `unit`. Text without a unit is
        rejected unless `unit` is ``"1"``.
    unit : str
        SI unit of the result, such as ``"m"``, ``"J/m^2"`` or ``"1"`` for a dimensionless number.

    Returns
    -------
    float
        The value in `unit`; finite.

    Raises
    ------
    ValueError
        If the text is not a number with a unit, the unit is unknown or has another dimension, or
        the number is not finite.

    Examples
    --------
    >>> parse("5.19 mm", "m")
    0.00519
    >>> parse("152.3 mJ/m2", "J/m^2")
    0.1523
    """
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        raise InputError(f"expected a quantity such as '1 {unit}', got {value!r}")
    if not isinstance(value, str):
        return finite("the number", value, unit)
    match = _NUMBER_AND_UNIT.fullmatch(value)
    if match is None or match[2].startswith(","):
        what, example = ("number", "5.19") if unit == "1" else ("number and a unit", f"5.19 {unit}")
        if _DECIMAL_COMMA.fullmatch(value):
            example = value.strip().replace(",", ".")
            example += f" {unit}" if unit != "1" and example[-1].isdigit() else ""
        raise InputError(
            f"{value!r:.80} is not a {what}; write it like '{example}', with a decimal point"
        )
    number, words = float(match[1]), match[2]
    if words == "" and unit != "1":
        raise InputError(f"{value!r} has no unit; write it behind the number, as in '1 {unit}'")
    if words not in ("", unit):
        power = _power_of_ten(words, unit)
        if power is None:
            number = _converted(value, number, words, unit)
        else:
            digits, _, exponent = match[1].lower().partition("e")
            # 15 digits, as for all other units
            number = float(f"{float(f'{digits}e{int(exponent or 0) + power}'):.15g}")
    if unit == "K" and number < 0:
        raise InputError(f"{value!r} lies below absolute zero")
    return finite(repr(value), number, unit)


def _power_of_ten(words: str, unit: str) -> int | None:
    """Return the power of ten between two units that differ in their prefixes; None for others."""
    found, wanted = _PLAIN.fullmatch(words), _PLAIN.fullmatch(unit)
    if not found or not wanted or found.group(2, 4, 5) != wanted.group(2, 4, 5):
        return None
    above, below = (_POWERS[found[at] or ""] - _POWERS[wanted[at] or ""] for at in (1, 3))
    return above - below * int(found[5] or 1)


# cached because the page parses the same text at every move of a slider, 1 ms each time
@lru_cache(maxsize=4096)
def _converted(text: str, number: float, words: str, unit: str) -> float:
    import pint

    registry = _registry()
    if len(words) > _LONGEST or _POWER_OF_NUMBER.search(words):
        raise InputError(
            f"{text!r:.80}: the exponents in a unit must be plain numbers, such as 'kg m^-1 "
            f"s^-2'; expected a quantity in {unit}"
        )
    if _UNIT_MARKS.fullmatch(words) is None:
        raise InputError(f"{text!r}: unknown unit {words!r}; expected a quantity in {unit}")
    try:
        quantity = registry.Quantity(number, registry.parse_units(_EXPONENT.sub(r"**\1", words)))
        target = registry.parse_units("" if unit == "1" else _EXPONENT.sub(r"**\1", unit))
        converted = float(quantity.to(target).magnitude)
    except pint.DimensionalityError:
        raise InputError(
            f"{text!r} has the wrong dimension; expected "
            + ("a number without a unit" if unit == "1" else f"a quantity in {unit}")
        ) from None
    except Exception:
        # The unit library raises a dozen kinds of exception for text that it cannot parse.
        raise InputError(
            f"{text!r}: unknown unit {words!r}; expected a quantity in {unit}"
        ) from None
    # "18.76 ms" and "0.01876 s" must give the same float, without rounding of the factor.
    return number if converted == number else float(f"{converted:.15g}")


def finite(name: str, value: Any, unit: str) -> float:
    """Convert a value to a finite float; InputError with name and unit otherwise."""
    words = "" if unit == "1" else f" {unit}"
    try:
        if isinstance(value, str) and not is_number(value):
            raise ValueError
        # Adding zero turns -0.0 into 0.0: equal objects then have equal records.
        number = float(value) + 0.0
    except (TypeError, ValueError, OverflowError):
        cure = (
            f"; viscotack.parse({value!r}, {unit!r}) reads text" if isinstance(value, str) else ""
        )
        of = "a dimensionless number" if unit == "1" else f"a number in {unit}"
        raise InputError(f"{name} must be {of}, got {value!r}{cure}") from None
    if not math.isfinite(number):
        raise InputError(f"{name} must be finite, got {number}{words}")
    return number


def is_number(text: str) -> bool:
    """Whether a text is a number without a unit, in the digits 0 to 9.

    Examples
    --------
    >>> is_number("-1.5e3"), is_number("1_000"), is_number("\u0663")
    (True, False, False)
    """
    try:
        float(text)
    except ValueError:
        return False
    return text.isascii() and "_" not in text


def positive(name: str, value: Any, unit: str) -> float:
    """Convert a value to a positive finite float; InputError with name and unit otherwise."""
    number = finite(name, value, unit)
    if number <= 0:
        raise InputError(f"{name} must be positive, got {as_given(number, unit)}")
    return number


def as_given(value: float, unit: str) -> str:
    """Text of a number that a user gave, with all its digits, for messages."""
    if unit in _PREFIXED:
        return readable(value, unit, digits=12)
    return f"{value}" if unit == "1" else f"{value} {unit}"


def prefixed(largest: float, unit: str) -> tuple[float, str]:
    """SI prefix by size: the factor of the unit in which a quantity is at least 1, and its name.

    Parameters
    ----------
    largest : float
        The quantity, or the largest one of a column or an axis, in `unit`.
    unit : str
        SI unit such as ``"N"``; a unit that takes no prefix is returned with the factor 1.

    Examples
    --------
    >>> prefixed(4.31e-3, "N")
    (0.001, 'mN')
    """
    size = abs(largest)
    if unit not in _PREFIXED or not _SMALLEST <= size < _LARGEST:
        return 1.0, unit
    known = [(f, p) for f, p in _PREFIXES if f <= 1 or unit not in _NOT_ABOVE_ONE]
    factor, prefix = next((x for x in known if size >= x[0]), known[-1])
    return factor, prefix + unit


def readable(
    value: float,
    unit: str,
    *,
    digits: int = 4,
    to: float | None = None,
    uncertainty: float | None = None,
    like: float = 0.0,
) -> str:
    """Text of a quantity for people, with an SI prefix by its size.

    JSON and tables have plain SI numbers instead.

    Parameters
    ----------
    value : float
        In `unit`.
    unit : str
        SI unit, as for :func:`prefixed`; "1" for a pure number.
    digits : int
        Significant digits of the value.
    to : float, optional
        Upper end of the range that `value` begins; with the same prefix, unless it is more than
        a thousand times as large; omitted if it reads the same.
    uncertainty : float, optional
        Standard uncertainty, written with two digits, and the value to the same place; omitted
        below the last of `digits`.
    like : float
        A larger quantity, whose prefix is taken.

    Examples
    --------
    >>> readable(4.314e-3, "N")
    '4.314 mN'
    >>> readable(1.7e-6, "m/s", to=213e-6)
    '1.7 to 213 um/s'
    >>> readable(0.1523, "J/m^2", uncertainty=0.0021)
    '152.3 +- 2.1 mJ/m^2'
    >>> readable(1e-6, "m/s", uncertainty=6e-13)
    '1 um/s'
    """
    if to is not None and 0 < 1000 * abs(value) < abs(to):
        return f"{readable(value, unit, digits=digits)} to {readable(to, unit, digits=digits)}"
    sizes = value, to or 0.0, like, uncertainty or 0.0
    rounded = max((float(f"{x:.{digits}g}") for x in sizes), key=abs)
    factor, name = prefixed(rounded, "" if unit == "1" else unit)

    def number(x: float, digits: int) -> str:
        # a number of three digits has them all, not an exponent
        kept = float(f"{x / factor:.{digits}g}")
        return f"{kept:.{max(digits, 4)}g}"

    text = number(value, digits)
    if to is not None and number(to, digits) != text:
        text += f" to {number(to, digits)}"
    if uncertainty is not None and not uncertainty < 10.0**-digits * abs(value):
        text = _both_to_one_place(value / factor, uncertainty / factor)
    return f"{text} {name}".rstrip()


def readable_interval(low: float, high: float, unit: str, *, digits: int = 3) -> str:
    """Text of an interval, with at least two digits of its width.

    Examples
    --------
    >>> readable_interval(0.1528, 0.15311, "J/m^2")
    '152.8 to 153.11 mJ/m^2'
    >>> readable_interval(142e-9, 161e-9, "m")
    '142 to 161 nm'
    """
    width, size = high - low, max(abs(low), abs(high))
    if 0 < width < size < math.inf:
        digits = max(digits, min(2 + math.ceil(math.log10(size / width)), _MOST_DIGITS))
    return readable(low, unit, digits=digits, to=high)


def _both_to_one_place(value: float, uncertainty: float) -> str:
    """Text of a value and its uncertainty, both to the second digit of the uncertainty."""
    if not math.isfinite(value) or not 0 < uncertainty < math.inf:
        return f"{value:.4g} +- {uncertainty:.2g}"
    rounded = float(f"{uncertainty:.1e}")
    decimals = 1 - math.floor(math.log10(rounded))
    if decimals > _MOST_DIGITS or rounded >= 10.0**_MOST_DIGITS:
        # beyond all prefixes
        place = max(decimals + math.floor(math.log10(abs(value) or rounded)), 0)
        return f"{value:.{place}e} +- {rounded:.1e}"
    shown = max(decimals, 0)
    return f"{round(value, decimals) + 0.0:.{shown}f} +- {rounded:.{shown}f}"
