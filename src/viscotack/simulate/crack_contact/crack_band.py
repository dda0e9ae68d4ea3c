"""Uncertainty of the steady-crack contact model, measured against simulations.

This module contains the outcome of a comparison with simulations, and its range.
The model neglects the zone length relative to the contact radius and to the travel of the edge;
the band has a term for each.
"""

from __future__ import annotations

from itertools import dropwhile
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.model.geometry import Sphere
from viscotack.model.problem import Groups
from viscotack.model.problem.ranges import outside
from viscotack.model.protocol import Approach, Dwell, LoadTo, Retract
from viscotack.model.traction import LennardJones, grows

# Contributions to the band: error of the simulations at default accuracy; second-order effect of
# the range [over effective^2]; influence of the start [over zone lengths]; histories; and growing
# interfaces (`tests/ladder/test_growing_crack.py`).
_GROWING_BAND = 0.02
_LEAST_BAND, _RANGE_BAND, _START_BAND, _HISTORY_BAND = 0.004, 0.12, 0.15, 0.012
# What work, curve and travel to zero force are less certain by than the force, at Tabor numbers of
# 10 to 40: nine of ten of 18 simulated cases, even in the logarithms of the inputs.
FURTHER = np.array([0.0, 0.016, 0.005, 0.003])
# Largest Tabor number with simulations for comparison.
SIMULATED = 200.0
# Ranges of the simulations for comparison; rate in h0 per time unit. For a sphere with
# Lennard-Jones forces, a rigid machine and a start from rest the ranges are wider: outside the
# simulated ones the zone only becomes shorter relative to the contact and to the travel.
_MEASURED = {
    "tabor": (3.0, 100.0),
    "modulus_ratio": (0.03, 1.0),
    "rate over the Tabor number": (0.3, 100.0),
}
_MEASURED_FROM_REST = {
    "tabor": (3.0, 1e6),
    "modulus_ratio": (1e-4, 1.0),
    "rate over the Tabor number": (0.0, 1e6),
}
# Ranges of the simulated histories.
_MEASURED_HISTORIES = {
    "tabor": (8.0, 60.0),
    "modulus_ratio": (0.03, 1.0),
    "rate over the Tabor number": (0.3, 100.0),
    "speed of a move over the Tabor number": (0.3, 100.0),
    "number of moves": (1, 3),
}
_KINDS = Approach | Retract | Dwell | LoadTo
# Softer springs were not simulated; stiffer ones tend to the rigid machine.
_SPRINGS = {"stiffness times the Tabor number": (0.1, np.inf)}


def band_parts(energy: Any, effective: Any, zones: Any) -> tuple[Any, Any, Any]:
    """Contributions to the band of a retraction from rest, relative to the force.

    The contributions are the error of the simulations, the range of the forces, and a short travel
    of the edge. In simulations the force is lower by about 0.1 over the number of zone lengths,
    independent of energy, but not for an amplification near 1.

    Parameters
    ----------
    energy, effective, zones : float or ndarray
        Amplification at pull-off, effective Tabor number, and travel of the edge in zone lengths.
    """
    by_way = _START_BAND * (1 - 1 / np.maximum(energy, 1.0)) / np.maximum(zones, 1.0)
    return _LEAST_BAND, _RANGE_BAND / effective**2, by_way


def curve_bands(energy: float, effective: float, zones: float) -> Array:
    """Bands of force, work, curve and travel to zero force of a retraction from rest, shape (4,).

    Of the curve over the pull-off force, the others relative; parameters as :func:`band_parts`.
    """
    return sum(map(float, band_parts(energy, effective, zones))) + FURTHER


def band_of(
    groups: Groups, energy: float, effective: float, zones: float
) -> tuple[float, bool, str]:
    """Return the band of the force, whether it was measured for such a problem, and why."""
    accuracy, by_range, by_way = band_parts(energy, effective, zones)
    parts = {
        "accuracy of the simulations used for comparison": accuracy,
        f"range of the forces, effective Tabor number {effective:.3g}": by_range,
        f"travel of {zones:.3g} zone lengths to pull-off": by_way,
    }
    if history_of(groups):
        parts["history"] = _HISTORY_BAND * min(1.0, 10 / effective)
    if grows(groups.traction):
        parts["interface that grows with the opening speed"] = _GROWING_BAND
    band = float(sum(parts.values()))
    why = "; ".join(f"{name}: {part:.2%}" for name, part in parts.items())
    if elsewhere := not_measured(groups):
        why += f"; this band was measured for other problems and may not hold here: {elsewhere}"
    elif groups.effective_tabor > SIMULATED:
        why += f"; measured up to a Tabor number of {SIMULATED:g}, extrapolated beyond"
    return band, not elsewhere, why


def history_of(groups: Groups) -> tuple[Any, ...]:
    """Return the moves without initial dwells, which do not change a relaxed contact."""
    return tuple(dropwhile(lambda move: isinstance(move, Dwell), groups.moves))


def not_measured(groups: Groups) -> str:
    """Describe why the band was not measured for such a problem; "" if it was."""
    moves, unit = history_of(groups), groups.material.time_unit / groups.tabor
    values = {"tabor": groups.effective_tabor, "modulus_ratio": groups.modulus_ratio}
    # an elastic contact does not depend on the rate
    if groups.rate is not None and groups.modulus_ratio < 1:
        values["rate over the Tabor number"] = groups.rate * unit
    if groups.modulus_ratio == 1 and not grows(groups.traction):
        # beyond the simulated Tabor numbers an elastic contact is that of JKR
        values["tabor"] = min(values["tabor"], _MEASURED["tabor"][1])
    simple = isinstance(groups.geometry, Sphere) and isinstance(groups.traction, LennardJones)
    measured = _MEASURED_FROM_REST if simple and groups.stiffness is None else _MEASURED
    if groups.stiffness is not None:
        measured = measured | _SPRINGS
        values["stiffness times the Tabor number"] = groups.stiffness * groups.tabor
    if not moves:
        return outside(values, measured)
    measured = measured | _MEASURED_HISTORIES
    values["number of moves"] = len(moves)
    speeds = [move.speed * unit for move in moves if isinstance(move, Approach | Retract)]
    found = [outside(values, measured)]
    if groups.modulus_ratio < 1:
        name = "speed of a move over the Tabor number"
        found += [outside({name: speed}, measured) for speed in speeds]
    others = {type(move).__name__ for move in moves if not isinstance(move, _KINDS)}
    found += [f"moves of type {name} were not compared" for name in sorted(others)]
    return "; ".join(word for word in found if word)
