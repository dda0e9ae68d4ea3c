"""Curves of measured files as data for the page."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .json_data import drawn

if TYPE_CHECKING:
    from viscotack.lab import FitReport

# Points of a measured curve, of a fitted one, and how far that is drawn beyond [decades].
_MOST, _CURVE, _BEYOND = 1500, 120, 0.5


def retraction(cycle: Any) -> dict[str, Any]:
    """Return the retraction of a cycle as it is drawn."""
    back = cycle.retraction
    every = max((back.stop - back.start) // _MOST, 1)
    return {
        "file": Path(cycle.source.path).name,
        "cycle": cycle.number,
        "depth": drawn(cycle.depth[back][::every]),
        "force": drawn(cycle.force[back][::every]),
        "pull_off_force": cycle.pull_off_force.value,
        "pull_off_force_uncertainty": cycle.pull_off_force.uncertainty,
        "speed": cycle.speed.value,
        "speed_uncertainty": cycle.speed.uncertainty,
        "preload": cycle.preload.value,
    }


def fit(report: "FitReport") -> dict[str, Any]:
    """Return measured points, fitted curves with their band, and residuals [%]."""
    data = report.observed
    unit = 1 / (2 * np.pi) if data.in_frequency else 1.0
    ends = np.log10(data.at[0]) - _BEYOND, np.log10(data.at[-1]) + _BEYOND
    at = np.logspace(*ends, _CURVE)
    curves = data.predicted(report.material, at)
    low, high = report.band(at) if report.draws else (curves, curves)
    percent = 100 * np.expm1(report.residuals)
    return {
        "x": "frequency" if data.in_frequency else "time",
        "x_unit": "Hz" if data.in_frequency else "s",
        "unit": "1/Pa" if data.quantity == "creep" else "Pa",
        "level": report.level,
        "at": drawn(data.at * unit),
        "curve_at": drawn(at * unit),
        "parts": [
            {
                "name": part,
                "measured": drawn(data.values[i]),
                "fitted": drawn(curves[i]),
                "low": drawn(low[i]),
                "high": drawn(high[i]),
                "residual": drawn(percent[i]),
            }
            for i, part in enumerate(data.parts)
        ],
    }


def shifts(shift: Any) -> dict[str, Any] | None:
    """Return the table of shifts that was found or given, None where a law was."""
    from viscotack.model.materials.shift import TabulatedShift

    if not isinstance(shift, TabulatedShift):
        return None
    rows = np.array(shift.temperature)
    return {
        "temperature": drawn(rows - 273.15),
        "log10_shift": drawn(shift.log10_shift(rows)),
    }
