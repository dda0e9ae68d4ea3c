"""Words with units: the boundary where text such as "5.19 mm" becomes a number in SI.

Everything behind this boundary is a plain float in SI. The unit library is imported by the first
call of :func:`parse`, never by ``import viscotack`` and never inside a loop.
"""

import math
import re
from functools import lru_cache
from typing import Any

from viscotack.errors import InputError

_NUMBER_AND_UNIT = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")
# "J/m2" and "J/m^2" are how people write it; the unit library wants "J/m**2".
# The unit library passes over other marks, and would read "5 ?m" as metres.
_UNIT_MARKS = re.compile(r"[A-Za-zµμ°Ω%0-9 .·⋅*/^()⁻¹²³-]*")
# A power of a number says nothing that a number does not, and 9^9^9^9 is never done. Nor is a unit
# as long as that.
_POWER_OF_NUMBER = re.compile(r"[\d¹²³]\s*(\^|\*\*|⁻)|\d\s*[¹²³]")
_LONGEST = 60
_EXPONENT = re.compile(r"(?<=[A-Za-zµμΩ])\^?(-?\d+)")


@lru_cache(maxsize=1)
def _registry() -> Any:
    import pint

    return pint.UnitRegistry()


def parse(value: str | float, unit: str) -> float:
    """Return a quantity as a number in the given SI unit.

    Parameters
    ----------
    value : str or float
        Text such as ``"5.19 mm"``, or a number, which is taken to be in `unit` already. Text
        without a unit is refused unless `unit` is ``"1"``.
    unit : str
        SI unit of the answer, such as ``"m"``, ``"J/m^2"`` or ``"1"`` for a pure number.

    Returns
    -------
    float
        The value in `unit`; finite.

    Raises
    ------
    ValueError
        If the text is not a number and a unit, the unit is unknown or measures something else, or
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
        raise InputError(
            f"{value!r:.80} is not a {what}; write it like '{example}', with a decimal point"
        )
    number, words = float(match[1]), match[2]
    if words == "" and unit != "1":
        raise InputError(f"{value!r} has no unit; write for example '{match[1]} {unit}'")
    if words != "":
        number = _converted(value, number, words, unit)
    return finite(repr(value), number, unit)


# a page asks for the same words at every move of a slider, and each costs a millisecond
@lru_cache(maxsize=4096)
def _converted(text: str, number: float, words: str, unit: str) -> float:
    import pint

    registry = _registry()
    if len(words) > _LONGEST or _POWER_OF_NUMBER.search(words):
        raise InputError(
            f"{text!r:.80}: a unit is written with numbers as its powers only, such as 'kg m^-1 "
            f"s^-2', and not with powers of numbers; expected something in {unit}"
        )
    if _UNIT_MARKS.fullmatch(words) is None:
        raise InputError(f"{text!r}: the unit {words!r} is not known; expected something in {unit}")
    try:
        quantity = registry.Quantity(number, registry.parse_units(_EXPONENT.sub(r"**\1", words)))
        target = registry.parse_units("" if unit == "1" else _EXPONENT.sub(r"**\1", unit))
        converted = float(quantity.to(target).magnitude)
    except pint.DimensionalityError:
        raise InputError(
            f"{text!r} does not measure the right thing; expected something in {unit}"
        ) from None
    except Exception:
        # The unit library raises a dozen kinds of error for words it cannot read.
        raise InputError(
            f"{text!r}: the unit {words!r} is not known; expected something in {unit}"
        ) from None
    # "18.76 ms" and "0.01876 s" are one quantity: without the rounding of the factor.
    return number if converted == number else float(f"{converted:.15g}")


def finite(name: str, value: Any, unit: str) -> float:
    """Return a value as a finite float, or say which quantity is not one."""
    words = "" if unit == "1" else f" {unit}"
    try:
        # Adding zero turns -0.0 into 0.0: equal objects then have equal records.
        number = float(value) + 0.0
    except (TypeError, ValueError, OverflowError):
        cure = (
            f"; viscotack.parse({value!r}, {unit!r}) reads text" if isinstance(value, str) else ""
        )
        of = "a pure number" if unit == "1" else f"a number in {unit}"
        raise InputError(f"{name} must be {of}, got {value!r}{cure}") from None
    if not math.isfinite(number):
        raise InputError(f"{name} must be finite, got {number}{words}")
    return number


def positive(name: str, value: Any, unit: str) -> float:
    """Return a value as a positive finite float, or say which quantity is not one."""
    number = finite(name, value, unit)
    if number <= 0:
        words = "" if unit == "1" else f" {unit}"
        raise InputError(f"{name} must be positive, got {number}{words}")
    return number
