"""How far a contact whose edge is a steady crack may be from a simulation.

`benchmarks/crack_contact.py` compares the two, and here is where. What the theory leaves out is the
length of the zone beside the contact, and beside the way of its edge: both are in the band.
"""

from __future__ import annotations

from itertools import dropwhile
from typing import Any

import numpy as np

from viscotack.geometry import Sphere
from viscotack.problem import Groups
from viscotack.problem.ranges import outside
from viscotack.protocol import Approach, Dwell, LoadTo, Retract
from viscotack.traction import LennardJones, grows

# Bands: what simulations at the default accuracy are off, what the second correction for the
# range leaves [over effective^2], what is left of the start when the edge has gone some zones, what
# a history adds (`benchmarks/crack_contact.py`); and what simulations of interfaces that grow were
# off beside that (`tests/ladder/test_growing_crack.py`).
_GROWING_BAND = 0.02
_LEAST_BAND, _RANGE_BAND, _START_BAND, _HISTORY_BAND = 0.004, 0.12, 0.15, 0.012
# Largest Tabor number for which simulations were compared.
SIMULATED = 200.0
# Simulated contacts with which the theory was compared; rate in h0 over the unit of time. From
# rest, Lennard-Jones forces, a sphere and a rigid machine: beyond what was simulated zones only
# become shorter beside the contact and the way of its edge.
_MEASURED = {
    "tabor": (3.0, 100.0),
    "modulus_ratio": (0.03, 1.0),
    "rate over the Tabor number": (0.3, 100.0),
}
_MEASURED_FROM_REST = {
    "tabor": (3.0, 1e6),
    "modulus_ratio": (1e-4, 1.0),
    "rate over the Tabor number": (1e-6, 1e6),
}
# Whole histories (`benchmarks/crack_histories.py`): of up to so many of these moves.
_MEASURED_HISTORIES = {
    "tabor": (8.0, 60.0),
    "modulus_ratio": (0.03, 1.0),
    "rate over the Tabor number": (0.3, 100.0),
    "speed of a move over the Tabor number": (0.3, 100.0),
    "number of moves": (1, 3),
}
_KINDS = Approach | Retract | Dwell | LoadTo
# Softer springs were not simulated; a rigid machine is the limit of stiffer ones.
_SPRINGS = {"stiffness times the Tabor number": (0.1, np.inf)}


def band_parts(energy: Any, effective: Any, zones: Any) -> tuple[Any, Any, Any]:
    """Return what the band of a retraction from rest is made of, parts of the force.

    What simulations themselves are off, the range of the forces, and few zones on the way: in
    simulations the force is some 0.1 over the zones lower, whatever part of 1/k the energy is,
    and not where the crack takes hardly more than at rest.

    Parameters
    ----------
    energy, effective, zones : float or ndarray
        Amplification at the pull-off, effective Tabor number, and way of the edge in zones.
    """
    by_way = _START_BAND * (1 - 1 / np.maximum(energy, 1.0)) / np.maximum(zones, 1.0)
    return _LEAST_BAND, _RANGE_BAND / effective**2, by_way


def band_of(
    groups: Groups, energy: float, effective: float, zones: float
) -> tuple[float, bool, str]:
    """Return the band of the force, whether it was measured there, and words."""
    accuracy, by_range, by_way = band_parts(energy, effective, zones)
    parts = {
        "accuracy of the simulations compared with": accuracy,
        f"range of the forces, effective Tabor number {effective:.3g}": by_range,
        f"way of {zones:.3g} zones to the pull-off": by_way,
    }
    if history_of(groups):
        parts["history"] = _HISTORY_BAND * min(1.0, 10 / effective)
    if grows(groups.traction):
        parts["interface that grows with the opening speed"] = _GROWING_BAND
    band = float(sum(parts.values()))
    why = "; ".join(f"{name}: {part:.2%}" for name, part in parts.items())
    if elsewhere := not_measured(groups):
        why += f"; this band was measured elsewhere, and is not known to hold here: {elsewhere}"
    elif groups.effective_tabor > SIMULATED:
        why += f"; compared up to a Tabor number of {SIMULATED:g}, beyond which it shrinks"
    return band, not elsewhere, why


def history_of(groups: Groups) -> tuple[Any, ...]:
    """Return the moves that change something: not the dwells of a start, which is at rest."""
    return tuple(dropwhile(lambda move: isinstance(move, Dwell), groups.moves))


def not_measured(groups: Groups) -> str:
    """Return in words where the band was not measured on problems like it, or ""."""
    moves, unit = history_of(groups), groups.material.time_unit / groups.tabor
    values = {"tabor": groups.effective_tabor, "modulus_ratio": groups.modulus_ratio}
    # an elastic contact knows no rate
    if groups.rate is not None and groups.modulus_ratio < 1:
        values["rate over the Tabor number"] = groups.rate * unit
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
    found += [f"a move is a {name}, verified for histories without" for name in sorted(others)]
    return "; ".join(word for word in found if word)
