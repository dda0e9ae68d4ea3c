r"""Unknowns and results of an interface whose strength grows with speed.

Reference speed and exponent of the Gent-Schultz law are strongly correlated: a series determines
the strength of the interface at the measured speeds, and its power of speed. Therefore the unknowns
are the exponent n and the *strengthening*

.. math:: S = 1 + G(\omega/h_0) ,

the strength over that at rest, at the opening speed under an edge in the middle of the
series. An edge of speed v opens the gap at about :math:`v \Delta\gamma_0/(E_0^* h_0)`, so that
:math:`\omega = v \Delta\gamma_0/E_0^*` is the same for all ranges h0. S = 1 is an
interface without growth.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.stats import chi2

from viscotack.arrays import Array
from viscotack.model.traction.growing import reference_speed
from viscotack.theory.crack.contact import GrowingCracks

from .forward import Forward, Growth, Pulled
from .likelihood import Parameter

STRENGTHENING, EXPONENT = "strengthening", "exponent"
# The largest strengthening searched, the unknowns of growth, and exponents of the lattice.
LARGEST = 30.0
UNKNOWNS = (
    Parameter(STRENGTHENING, 1.0, LARGEST, 2.0),
    Parameter(EXPONENT, 0.2, 0.8, 0.4, logarithmic=False),
)
_LATTICE = (0.2, 0.32, 0.5, 0.8)
# Of the lattice: its least growth, its margin beyond the largest one, and how much faster similar
# solids may be.
_LEAST, _MORE, _FASTER = 0.03, 1.5, 3.0
# Growth that is negligible.
_LEAST_TOLD = 1e-3


@dataclass(frozen=True)
class Opening:
    """Opening speed at which the strength of an interface is compared.

    Parameters
    ----------
    product : float
        Opening speed times range of attraction [m2/s].
    """

    product: float

    def speed(self, gap: npt.ArrayLike) -> Array:
        """Return the opening speed [m/s] at ranges h0 [m]."""
        return self.product / np.asarray(gap, dtype=float)

    def growth(self, values: Mapping[str, Any]) -> Growth:
        """Return the growth law of a set of parameters, or of arrays of them."""
        more, exponent = np.asarray(values[STRENGTHENING], dtype=float) - 1, values[EXPONENT]
        more = np.where(more > _LEAST_TOLD, more, 0.0)
        speed = self.speed(values["equilibrium_gap"])
        return Growth(reference_speed(more, speed, exponent), exponent)


@dataclass(frozen=True)
class FoundGrowth:
    """Fitted growth of an interface with speed.

    Parameters
    ----------
    strengthening : float
        Strength over that at rest, at `opening_speed`.
    opening_speed : float
        Opening speed of the gap under an edge in the middle of the series [m/s].
    reference_speed, exponent : float
        v0 [m/s] and n of the Gent-Schultz law; v0 is infinite without growth.
    better_by : float
        Reduction of the misfit compared with the best interface without growth, which has two
        parameters fewer.
    pulled : Pulled
        Pull-offs at the speeds of the series, whose energy is the product of two factors on the
        work of adhesion, by bulk and interface.
    """

    strengthening: float
    opening_speed: float
    reference_speed: float
    exponent: float
    better_by: float
    pulled: Pulled

    @property
    def chance(self) -> float:
        """Probability of such a reduction of the misfit for an interface without growth."""
        # the noise is known, so the difference of misfits is chi-squared; without growth the
        # exponent is free and growth is not negative, which makes chance even less likely
        return float(chi2.sf(self.better_by, 2))


def growing(forward: Forward, opening: Opening, gaps: tuple[float, float]) -> Forward:
    """Return a forward model with a lattice of cracks for all growth laws searched."""
    unit = forward.material.time_unit
    speeds = [float(opening.speed(gap)) * unit / gap for gap in gaps]
    given = (
        (_LEAST, _MORE * (LARGEST - 1)),
        (min(speeds) / _FASTER, max(speeds) * _FASTER),
        _LATTICE,
    )
    kept = partial(forward.stored, ("lattice", *given))
    return replace(forward, lattice=GrowingCracks(forward.material, *given, kept=kept))
