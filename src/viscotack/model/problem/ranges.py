"""Verified ranges of numbers, and descriptions of values outside."""

from collections.abc import Mapping

# Tolerance for rounding at the end of a range.
_ROUNDED = 1e-9


def at_least(value: float, least: float) -> bool:
    """Return whether a positive number reaches the lower end of a range, within rounding.

    Converting a number from SI to groups may change its last digit.
    """
    return value >= least * (1 - _ROUNDED)


def at_most(value: float, most: float) -> bool:
    """Return whether a positive number is at most the upper end of a range, within rounding."""
    return value <= most * (1 + _ROUNDED)


def outside(values: Mapping[str, float], ranges: Mapping[str, tuple[float, float]]) -> str:
    """Describe the values outside their ranges, or return an empty string.

    Examples
    --------
    >>> outside({"tabor": 20.0, "rate": 1.0}, {"tabor": (0.3, 8.0), "rate": (0.1, 1e8)})
    'tabor is 20, verified from 0.3 to 8'
    """
    found = []
    for name, value in values.items():
        least, most = ranges[name]
        if not (at_least(value, least) and at_most(value, most)):
            found.append(f"{name} is {value:.4g}, verified from {least:g} to {most:g}")
    return "; ".join(found)
