"""Energy balance of a run at every step."""

from dataclasses import dataclass, fields

import numpy as np

from viscotack.arrays import Array


@dataclass(frozen=True, eq=False)
class Energies:
    """Energies over a run, in units of 1.5 pi R Delta-gamma_0 h_0 (for a punch sigma_0 h_0).

    Stored by :func:`viscotack.solve` in the `energy` of a result.

    Drive work = change of spring, elastic and interface energy + heat + interface heat + jumps +
    transfer.

    Attributes
    ----------
    drive : ndarray, shape (n,)
        Cumulative work of the drive.
    elastic, interface, spring : ndarray, shape (n,)
        Energy stored in the solid, across the gap (negative in contact, 0 far apart), and in the
        machine.
    heat : ndarray, shape (n,)
        Cumulative dissipation in the solid, summed over its modes.
    jumps, transfer : ndarray, shape (n,)
        Cumulative loss in jumps, and in transfers between meshes.
    mode_time, mode_heat : ndarray, shape (m,)
        Retardation time of each mode [time unit], and its total dissipation.
    interface_heat : ndarray, shape (n,)
        Cumulative dissipation in an interface whose tension grows with the opening speed.
    mode_weight : ndarray, shape (m,)
        Compliance of each mode over that of the relaxed solid. The instantaneous response has the
        remainder to 1.
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
    interface_heat: Array
    mode_weight: Array

    def __post_init__(self) -> None:
        for one in fields(self):
            values = np.array(getattr(self, one.name), dtype=float)
            values.setflags(write=False)
            object.__setattr__(self, one.name, values)
