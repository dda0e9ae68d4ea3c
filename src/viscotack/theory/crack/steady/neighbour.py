r"""The crack of a solid that is near to one whose cracks are known: at no cost.

An edge takes up what the solid has crept while the zone passes, :math:`1/\Gamma = \bar c(t)`,
:math:`t = x \Gamma/V` (Schapery's argument), with x a number of about a third that depends on law
and spectrum. No zone passes at once, so that the creep is a mean one,

.. math:: \bar c(t) = \int_0^\infty c(s) e^{-s/t} ds/t = k + \sum_j w_j \frac{t}{t + \tau_j} .

The number x is found from the known crack, at every height of :math:`\Gamma` between 1 and 1/k,
and kept for the neighbour: what is left is how x changes from one solid to the next, of second
order in what differs. (With c(t) itself instead of the mean, solids of few arms are 5 % off.)
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.materials import Modes
from viscotack.theory._checks import Values

from ._branch import energy_of_odds
from .cracks import SteadyCrack, modes_of

# ln of the odds (Gamma - 1)/(1/k - Gamma) between which both are compared, and how many.
_ODDS = np.linspace(-14.0, 12.0, 400)
_OF = np.exp(_ODDS)


@dataclass(frozen=True)
class NeighbourCrack:
    r"""The opening cracks of a solid near one whose cracks are known, with the same law.

    Parameters
    ----------
    known : SteadyCrack
        Of the solid beside it.
    material : Material
        The neighbour, at most a few ten per cent away in its constants.

    Notes
    -----
    Speeds in the neighbour's own unit, as everywhere. Of power laws with a constant changed by 10
    to 100 %, and Prony series with arms changed by 20 %, energies are those of its own cracks
    within 1.1 % (`tests/ladder/test_neighbour_crack.py`).
    """

    known: SteadyCrack
    material: Any

    @cached_property
    def modes(self) -> Modes:
        """Creep in modes, as of :class:`SteadyCrack`."""
        return modes_of(self.material)

    @property
    def largest(self) -> float:
        """The amplification at infinite speed."""
        return 1 / self.modes.instantaneous

    def speed(self, amplification: Values) -> Array:
        """Return opening speeds [E0* h0^2/(dg tau)] of energies between 1 and 1/k."""
        gamma = np.asarray(amplification, dtype=float)
        odds = np.log((gamma - 1) / (self.largest - gamma))
        return np.exp(np.interp(odds, _ODDS, self._log_speeds))

    def amplification(self, speed: Values) -> Array:
        """Return the energy over the work of adhesion at opening speeds."""
        v = np.log(np.asarray(speed, dtype=float))
        return energy_of_odds(
            np.exp(np.interp(v, self._log_speeds, _ODDS)), self.modes.instantaneous
        )

    @cached_property
    def _log_speeds(self) -> Array:
        known = self.known
        energy = energy_of_odds(_OF, self.modes.instantaneous)
        of_known = energy_of_odds(_OF, known.modes.instantaneous)
        first = np.log(np.asarray(known.speed(of_known)))
        # V = x Gamma/t, with the same x at the same odds
        change = np.log(energy / of_known)
        return np.maximum.accumulate(first + change - _passing(self.modes) + _passing(known.modes))


def _passing(modes: Modes) -> Array:
    """Return ln of the times at which the creep has the energies of :data:`_ODDS`."""
    tau, weights = np.array(modes.times), np.array(modes.weights)
    time = np.geomspace(1e-8 * tau[0], 1e8 * tau[-1], 2000)
    part = time[:, None] / (time[:, None] + tau)
    crept, rest = part @ weights, (1 - part) @ weights
    # odds = k (1 - c)/(c - k), which falls with time
    odds = np.log(modes.instantaneous) + np.log(rest) - np.log(crept)
    return np.interp(-_ODDS, -odds, np.log(time))
