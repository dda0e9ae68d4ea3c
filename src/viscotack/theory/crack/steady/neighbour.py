r"""Crack of a solid similar to one with known cracks, without further computation.

The energy of an edge follows from the creep of the solid during the passage of the zone,
:math:`1/\Gamma = \bar c(t)`, :math:`t = x \Gamma/V` (Schapery's argument), with a number x of about
a third that depends on law and spectrum. Passage times are distributed, so the creep is averaged,

.. math:: \bar c(t) = \int_0^\infty c(s) e^{-s/t} ds/t = k + \sum_j w_j \frac{t}{t + \tau_j} .

The number x is determined from the known crack, for every :math:`\Gamma` between 1 and 1/k,
and used for the neighbour. The error is the change of x between the solids, of second
order in their difference. (With c(t) itself instead of the mean, the error is 5 % for solids of
few arms.)
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.model.materials import Modes
from viscotack.theory._checks import Values

from ._branch import energy_of_odds
from .cracks import SteadyCrack, modes_of

# ln of the odds (Gamma - 1)/(1/k - Gamma) at which both are compared, and their number.
_ODDS = np.linspace(-14.0, 12.0, 400)
_OF = np.exp(_ODDS)


@dataclass(frozen=True)
class NeighbourCrack:
    r"""Opening cracks of a solid similar to one with known cracks, with the same law.

    Parameters
    ----------
    known : SteadyCrack
        Crack of the known solid.
    material : Material
        The neighbour, with constants that differ by at most a few ten per cent.

    Notes
    -----
    Speeds are in the neighbour's own unit. For power laws with a constant changed by 10
    to 100 %, and Prony series with arms changed by 20 %, the energies agree with those of its own
    cracks within 1.1 % (`tests/ladder/test_steady_crack.py`).

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> from viscotack.model.traction import LennardJones
    >>> solid = dict(rubbery_modulus=1, tau0=1, poisson_ratio=0)
    >>> known = SteadyCrack(StandardSolid(glassy_modulus=10, **solid), LennardJones(1, 1))
    >>> neighbour = NeighbourCrack(known, StandardSolid(glassy_modulus=11, **solid))
    >>> f"{float(neighbour.amplification(10.0)):.2f}, not {known.amplification(10.0):.2f}"
    '4.05, not 3.96'
    """

    known: SteadyCrack
    material: Any

    @cached_property
    def modes(self) -> Modes:
        """Creep in modes, as for :class:`SteadyCrack`."""
        return modes_of(self.material)

    @property
    def largest(self) -> float:
        """Amplification at infinite speed."""
        return 1 / self.modes.instantaneous

    @property
    def zone_length(self) -> float:
        """Length of the cohesive zone at rest [E0* h0^2/dg], which depends on the law alone."""
        return self.known.zone_length

    def speed(self, amplification: Values) -> Array:
        """Return opening speeds [E0* h0^2/(dg tau)] of energies between 1 and 1/k."""
        gamma = np.asarray(amplification, dtype=float)
        odds = np.log((gamma - 1) / (self.largest - gamma))
        return np.exp(np.interp(odds, _ODDS, self._log_speeds))

    def amplification(self, speed: Values) -> Array:
        """Return the energy over the work of adhesion at opening speeds [E0* h0^2/(dg tau)]."""
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
    """Return ln of the times at which the averaged creep has the energies of :data:`_ODDS`."""
    tau, weights = np.array(modes.times), np.array(modes.weights)
    time = np.geomspace(1e-8 * tau[0], 1e8 * tau[-1], 2000)
    part = time[:, None] / (time[:, None] + tau)
    crept, rest = part @ weights, (1 - part) @ weights
    # odds = k (1 - c)/(c - k), decreasing with time
    odds = np.log(modes.instantaneous) + np.log(rest) - np.log(crept)
    return np.interp(-_ODDS, -odds, np.log(time))
