"""Accuracy and time limit of a simulation, and what lies outside of verified ranges."""

from collections.abc import Mapping
from typing import Annotated

from viscotack.cards import Quantity

# Accuracy at which the settings of a simulation are defined.
DEFAULT_ACCURACY = 2e-3
LOOSEST_ACCURACY = 0.02

Accuracy = Annotated[
    float,
    Quantity(
        "1",
        "",
        "accuracy wanted of the pull-off force, relative",
        least=1e-6,
        most=LOOSEST_ACCURACY,
        example="2e-3",
    ),
]
Accuracy.__doc__ = """Relative error of the pull-off force asked of a simulation, 1e-6 to 0.02.

A dimensionless float; the default is ``DEFAULT_ACCURACY``, 2e-3. Mesh, steps, reach and
retardation modes follow from it together, see :meth:`viscotack.simulate.Settings.for_accuracy`. The
error estimate of the result is compared with it: ``result.accuracy_met``, and above ten times the
accuracy the status "unresolved". The work to pull-off has up to five times the error of the force.

When to change it: 0.02 for a first look or many cases; 5e-4 beside the default for the error of a
curve, which has no estimate of its own; a smaller value where the stated error is too large. Ten
times smaller takes about three times as many steps, on a finer mesh.
"""

TimeLimit = Annotated[
    float,
    Quantity(
        "s",
        "",
        "longest wall time of all simulations for an answer, or for a row of a table",
        above=0,
        example="90 s",
    ),
]


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
