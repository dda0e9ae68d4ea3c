"""Test of superposition that weights all points equally.

A best shift always exists; whether the shifted sweeps form one curve is a separate question. No
outlier is down-weighted here, and both moduli have equal weights.
"""

from itertools import pairwise

import numpy as np
from numpy.polynomial import Chebyshev

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.sweeps import FrequencySweeps
from viscotack.model.materials.shift import TabulatedShift

from .master_curve import shifted_by
from .overlap import Curve
from .shift_factors import BEST, FEWEST, level_curves, steps_between, temperature_levels

_TOLERANCE = 0.1  # relative deviation from one curve above which sweeps do not superpose
_APART = 0.1  # decades; larger differences contradict each other
_SIGMAS = 3.0
_POINTS = 3  # smallest number of points of each sweep in the overlap for a comparison


def superposition(sweeps: FrequencySweeps, shifts: TabulatedShift) -> tuple[str, ...]:
    """Return the contradictions to superposition of shifted sweeps where neighbours overlap.

    Parameters
    ----------
    sweeps : FrequencySweeps
        Measured sweeps, at two or more temperatures.
    shifts : TabulatedShift
        Shifts to test, from any method; interpolated between the rows of the table.

    Returns
    -------
    tuple of str
        A sentence for each contradiction; empty if the sweeps superpose.

    Raises
    ------
    ValueError
        If the table does not cover all temperatures of the sweeps.

    Examples
    --------
    >>> omega = np.geomspace(1, 100, 10)
    >>> sweeps = FrequencySweeps(
    ...     np.repeat([293.15, 303.15], 10),
    ...     np.tile(omega, 2),
    ...     np.concatenate([1e6 * omega**0.5, 1e6 * (omega / 10) ** 0.5]),
    ...     np.concatenate([1e6 * omega**0.5, 1e6 * (omega / 10) ** 0.5]),
    ...     "E",
    ...     np.repeat([0, 1], 10),
    ... )
    >>> superposition(sweeps, TabulatedShift(293.15, (293.15, 303.15), (0.0, -1.0)))
    ()
    """
    temperature, levels = temperature_levels(sweeps)
    along, up, _ = shifted_by(shifts, temperature, temperature, shifts.temperature[0])
    shapely = [i for i, level in enumerate(levels) if len(level) >= FEWEST]
    curves = level_curves(temperature[shapely], [levels[i] for i in shapely])
    pairs = list(pairwise(shapely))
    between = [
        f"those at {temperature[i] - 273.15:.4g} and {temperature[j] - 273.15:.4g} C"
        for i, j in pairs
    ]
    found = []
    moved = [c.moved(along[i], up[i]) for i, c in zip(shapely, curves, strict=True)]
    scatters = np.array([_scatters(a, b) for a, b in pairwise(moved)]).reshape(-1, 2, 2)
    for name, (common, own) in zip(("storage", "loss"), np.moveaxis(scatters, 0, -1), strict=True):
        # two noisy sweeps may still superpose
        off = common > np.maximum(np.log1p(_TOLERANCE), 2 * own)
        if off.any():
            worst = int(np.argmax(np.where(off, common, 0)))
            found.append(
                f"sweeps do not superpose in {name}: {between[worst]} differ by "
                f"{100 * np.expm1(common[worst]):.2g} % where they overlap ({off.sum()} such "
                "pairs): moduli that move with temperature (allow a vertical shift), a glass, two "
                "processes or a faulty sweep (leave it out)"
            )
    try:
        steps = steps_between(temperature[shapely], curves, *BEST)
    except InputError:
        return tuple(found)
    used = np.array([along[j] - along[i] for i, j in pairs])
    asked = np.array([step.shift for step in steps])
    doubt = np.sqrt([step.variance + step.common**2 for step in steps])
    apart = np.abs(used - asked)
    off = apart > np.maximum(_APART, _SIGMAS * doubt)
    if off.any():
        worst = int(np.argmax(np.where(off, apart, 0)))
        found.append(
            f"storage and loss modulus give other shifts than those used: {between[worst]} are "
            f"shifted by {used[worst]:.2f} decades, not {asked[worst]:.2f} +- {doubt[worst]:.2f} "
            f"({off.sum()} such steps)"
        )
    return tuple(found)


def _scatters(a: Curve, b: Curve) -> list[tuple[float, float]]:
    """Return the scatter of each modulus about a common curve, and about separate curves.

    nan where too few points overlap.
    """
    low, high = max(a.x[0], b.x[0]) - 1e-9, min(a.x[-1], b.x[-1]) + 1e-9
    one, other = (c.chosen((c.x >= low) & (c.x <= high)) for c in (a, b))
    if min(one.x.size, other.x.size) < _POINTS:
        return [(np.nan, np.nan)] * 2
    x = np.concatenate((one.x, other.x))
    return [
        (
            _scatter(x, np.concatenate((ya, yb))),
            float(np.hypot(_scatter(one.x, ya), _scatter(other.x, yb)) / np.sqrt(2)),
        )
        for ya, yb in zip(one.y, other.y, strict=True)
    ]


def _scatter(x: Array, y: Array) -> float:
    """Return the scatter of ln(y) about the polynomial with the smallest one."""
    left = []
    # a temperature measured twice repeats its frequencies
    for degree in range(max(min(5, np.unique(np.round(x, 3)).size - 2), 0) + 1):
        residual = y - Chebyshev.fit(x, y, degree)(x)
        left.append(float(np.sum(residual**2)) / (x.size - degree - 1))
    return float(np.log(10) * np.sqrt(min(left)))
