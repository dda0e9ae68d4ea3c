"""What a rig wrote of one tack test, in SI: time, force, position, perhaps the contact radius."""

from dataclasses import dataclass

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.arrays import array, store
from viscotack.lab.sweeps import Source

# beyond what any rig has: a damaged number, or a wrong unit
_LARGEST = {"time": ("s", 1e10), "force": ("N", 1e8), "position": ("m", 1e4)}


@dataclass(frozen=True, eq=False)
class TackRecord:
    """One continuous record of a tack test.

    Parameters
    ----------
    time : array_like, shape (N,)
        Since any moment [s]; rising.
    force : array_like, shape (N,)
        With the sign of the file [N].
    position : array_like, shape (N,)
        Of the drive [m], with the sign of the file: gap, depth or travel.
    into : {1, -1, 0}
        Whether a position that grows is further into the solid, further away, or the file does
        not say.
    compliance : float
        Between drive and contact [m/N], of a cantilever that the file names; 0 without.
    contact_radius : array_like, shape (N,), optional
        From a camera [m]; nan where there is none.
    source : Source
        Where the numbers come from.

    Raises
    ------
    ValueError
        If lengths differ, a number is not finite, time does not rise or the numbers are few.
    """

    time: Array
    force: Array
    position: Array
    into: int = 0
    compliance: float = 0.0
    contact_radius: Array | None = None
    source: Source = Source()

    def __post_init__(self):
        length = None
        for name, (unit, most) in _LARGEST.items():
            row = array(name, getattr(self, name), unit, length)
            length = row.size
            if not np.all(np.abs(row) <= most):
                raise InputError(
                    f"{name} must be finite and at most {most:g} {unit}, got {_worst(row):g} "
                    f"{unit}; is the unit right?"
                )
            store(self, name, row)
        steps = np.diff(self.time)
        if np.any(steps < 0):
            at = int(np.argmin(steps))
            raise InputError(
                f"time must rise, but {self.time[at]:g} s is followed by {self.time[at + 1]:g} s; "
                "are these two tests, or rows out of order?"
            )
        if self.into not in (-1, 0, 1):
            raise InputError(f"into must be 1, -1 or 0, got {self.into!r}")
        if not 0 <= self.compliance < np.inf:
            raise InputError(f"compliance must not be negative [m/N], got {self.compliance!r}")
        if self.contact_radius is not None:
            row = array("contact_radius", self.contact_radius, "m", length)
            if np.any(row < 0) or np.any(np.isinf(row)):
                raise InputError(f"contact_radius must not be negative [m], got {np.nanmin(row):g}")
            store(self, "contact_radius", row)

    def __len__(self) -> int:
        return self.time.size


def _worst(row: Array) -> float:
    broken = row[~np.isfinite(row)]
    return float(broken[0] if broken.size else row[np.argmax(np.abs(row))])
