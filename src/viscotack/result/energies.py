"""The books of a run: where the work of the drive has gone, at every step."""

from dataclasses import dataclass, field, fields

import numpy as np

from viscotack.arrays import Array


@dataclass(frozen=True, eq=False)
class Energies:
    """Energies over a run, in the unit of work [1.5 pi R Delta-gamma_0 h_0; a punch sigma_0 h_0].

    Drive work = change of spring, elastic and interface energy + heat + interface heat + jumps +
    transfer.

    Attributes
    ----------
    drive : ndarray, shape (n,)
        Work of the drive so far.
    elastic, interface, spring : ndarray, shape (n,)
        Stored in the solid, across the gap (negative in contact, 0 far apart), in the machine.
    heat : ndarray, shape (n,)
        Made in the solid so far, summed from its modes.
    jumps, transfer : ndarray, shape (n,)
        Lost so far in jumps, and in moving from mesh to mesh.
    mode_time, mode_heat : ndarray, shape (m,)
        Retardation time of each mode [time unit], and the heat it made in all.
    interface_heat : ndarray, shape (n,)
        Made so far in an interface that grows with the opening speed, summed from its tensions.
    mode_weight : ndarray, shape (m,)
        Compliance of each mode over that of the relaxed solid; nan in older results. The rest to 1
        is that of the instantaneous response.
    """

    drive: Array
    elastic: Array
    interface: Array
    spring: Array
    heat: Array
    jumps: Array
    transfer: Array
    mode_time: Array
    mode_heat: Array
    interface_heat: Array = field(default_factory=lambda: np.empty(0))  # of older results
    mode_weight: Array = field(default_factory=lambda: np.empty(0))

    def __post_init__(self) -> None:
        if np.size(self.interface_heat) == 0:
            object.__setattr__(self, "interface_heat", np.zeros(np.shape(self.drive)))
        if np.size(self.mode_weight) != np.size(self.mode_time):
            object.__setattr__(self, "mode_weight", np.full(np.shape(self.mode_time), np.nan))
        for one in fields(self):
            values = np.array(getattr(self, one.name), dtype=float)
            values.setflags(write=False)
            object.__setattr__(self, one.name, values)
