"""Raw data of one tack test in SI: time, force, position and optionally the contact radius."""

from dataclasses import dataclass

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.sweeps import Source, array, store

# above the range of all rigs: a damaged number or a wrong unit
_LARGEST = {"time": ("s", 1e10), "force": ("N", 1e8), "position": ("m", 1e4)}


@dataclass(frozen=True, eq=False)
class TackRecord:
    """One continuous record of a tack test.

    Parameters
    ----------
    time : array_like, shape (N,)
        Time since any origin [s]; strictly increasing.
    force : array_like, shape (N,)
        Force with the sign of the file [N].
    position : array_like, shape (N,)
        Position of the drive [m], with the sign of the file: gap, depth or travel.
    into : {1, -1, 0}
        1 if a larger position is deeper in the solid, -1 if it is further away, 0 if unknown.
    compliance : float
        Compliance between drive and contact [m/N], of a cantilever stated in the file; 0 otherwise.
    contact_radius : array_like, shape (N,), optional
        Measured by a camera [m]; nan where unknown.
    temperature : array_like, shape (N,), optional
        Temperature of the test [K]; nan where unknown.
    source : Source
        Origin of the numbers.

    Raises
    ------
    ValueError
        If lengths differ, a number is not finite, time does not increase or there are too few
        points.
    """

    time: Array
    force: Array
    position: Array
    into: int = 0
    compliance: float = 0.0
    contact_radius: Array | None = None
    temperature: Array | None = None
    source: Source = Source()

    def __post_init__(self):
        length = None
        for name, (unit, most) in _LARGEST.items():
            row = array(name, getattr(self, name), unit, length)
            length = row.size
            if not np.all(np.abs(row) <= most):
                raise InputError(
                    f"{name} must be finite and at most {most:g} {unit}, got {_worst(row):g}; "
                    "check its unit"
                )
            store(self, name, row)
        steps = np.diff(self.time)
        if np.any(steps < 0):
            at = int(np.argmin(steps))
            raise InputError(
                f"time must increase, but {self.time[at + 1]:g} s follows {self.time[at]:g} s"
            )
        if self.into not in (-1, 0, 1):
            raise InputError(f"into must be 1, -1 or 0, got {self.into!r}")
        if not 0 <= self.compliance < np.inf:
            raise InputError(f"compliance must not be negative [m/N], got {self.compliance!r}")
        for name, unit in (("contact_radius", "m"), ("temperature", "K")):
            if getattr(self, name) is not None:
                row = array(name, getattr(self, name), unit, length)
                least = 0.0 if unit == "m" else 1e-300
                if np.any(row < least) or np.any(np.isinf(row)):
                    raise InputError(f"{name} must be positive [{unit}], got {np.nanmin(row):g}")
                store(self, name, row)

    def __len__(self) -> int:
        return self.time.size


def _worst(row: Array) -> float:
    broken = row[~np.isfinite(row)]
    return float(broken[0] if broken.size else row[np.argmax(np.abs(row))])
