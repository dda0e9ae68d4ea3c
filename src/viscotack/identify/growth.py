r"""Unknowns of an interface that grows with speed, and what is said of it.

Reference speed and exponent of Gent and Schultz's law go together: a series says how strong the
interface is where it was pulled, and with which power that changes. So the unknowns are the
exponent n and the *strengthening*

.. math:: S = 1 + G(\omega/h_0) ,

the strength over that at rest where the gap opens as fast as by an edge in the middle of the
series: an edge of speed v opens the gap with :math:`v \Delta\gamma_0/(E_0^* h_0)`, about, so that
:math:`\omega = v \Delta\gamma_0/E_0^*` is one number for all ranges that are looked at. S = 1 is an
interface that does not grow.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.stats import chi2

from viscotack.arrays import Array
from viscotack.theory.crack.contact import GrowingCracks
from viscotack.traction.growing import reference_speed
from viscotack.units import readable

from .forward import Forward, Growth, Pulled
from .objective import Parameter

STRENGTHENING, EXPONENT = "strengthening", "exponent"
# The largest strengthening that is looked for; exponents, and those of the lattice.
LARGEST = 30.0
EXPONENTS = (0.2, 0.8)
_LATTICE = (0.2, 0.4, 0.6, 0.8)
# Of the lattice: its least growth, what it has beyond the largest one, and how much faster solids
# beside may be.
_LEAST, _MORE, _FASTER = 0.03, 1.5, 3.0
# Growth that is as good as none.
_LEAST_TOLD = 1e-3
# The part of series that need no growth and would be said to need it.
_CHANCE = 0.01


@dataclass(frozen=True)
class Opening:
    """Where the strength of an interface is read.

    Parameters
    ----------
    product : float
        Opening speed times range of attraction [m2/s].
    """

    product: float

    def speed(self, gap: npt.ArrayLike) -> Array:
        """Return the opening speed [m/s] at ranges h0 [m]."""
        return self.product / np.asarray(gap, dtype=float)

    def growth(
        self, gap: npt.ArrayLike, strengthening: npt.ArrayLike, exponent: npt.ArrayLike
    ) -> Growth:
        """Return the law of ranges, strengthenings and exponents."""
        more = np.asarray(strengthening, dtype=float) - 1
        more = np.where(more > _LEAST_TOLD, more, 0.0)
        return Growth(reference_speed(more, self.speed(gap), exponent), exponent)

    def of(self, values: Mapping[str, float]) -> Growth:
        """Return the law of parameters."""
        return self.growth(values["equilibrium_gap"], values[STRENGTHENING], values[EXPONENT])


@dataclass(frozen=True)
class Share:
    """What the edge takes at the pull-off of one speed, and who takes it.

    Parameters
    ----------
    speed, edge_speed : float
        Of the drive and of the edge [m/s].
    energy : float
        Of the edge [works of adhesion].
    bulk, interface : float
        By what each of the two multiplies the work of adhesion.
    """

    speed: float
    edge_speed: float
    energy: float
    bulk: float
    interface: float


@dataclass(frozen=True)
class FoundGrowth:
    """How the interface of a rate series grows with speed.

    Parameters
    ----------
    strengthening : float
        Strength over that at rest, where the gap opens with `opening_speed`.
    exponent : float
        n of Gent and Schultz's law.
    opening_speed : float
        Of the gap under an edge in the middle of the series [m/s].
    reference_speed : float
        v0 of the law [m/s]; infinite without growth.
    better_by : float
        By what the misfit is less than that of the best interface without growth, which has two
        parameters fewer.
    chance : float
        The part of series of interfaces without growth that would be better by so much.
    shares : tuple of Share
        Of bulk and interface at the speeds of the series.
    opening : Opening
        Where strengthening is read, for any range.
    """

    strengthening: float
    exponent: float
    opening_speed: float
    reference_speed: float
    better_by: float
    chance: float
    shares: tuple[Share, ...]
    opening: Opening

    @property
    def law(self) -> Growth:
        """Reference speed and exponent."""
        return Growth(self.reference_speed, self.exponent)

    @property
    def values(self) -> dict[str, float]:
        """The parameters by name."""
        return {STRENGTHENING: self.strengthening, EXPONENT: self.exponent}

    def words(self) -> list[str]:
        """Return what the data say of growth as a whole."""
        sure = self.chance < _CHANCE
        said = [
            f"{'the interface grows with speed' if sure else 'growth is not needed'}: without it "
            f"the misfit is {self.better_by:.1f} more, by chance in {self.chance:.1%} of cases"
        ]
        if np.isfinite(self.reference_speed):
            said.append(
                f"Gent-Schultz: reference speed {readable(self.reference_speed, 'm/s', digits=3)} "
                f"of the gap, exponent {self.exponent:.2f}"
            )
        for one in sorted({self.shares[0], self.shares[-1]}, key=lambda share: share.speed):
            said.append(
                f"at {readable(one.speed, 'm/s', digits=3)} the edge takes "
                f"{one.energy:.3g} works of adhesion: "
                f"{one.bulk:.3g} by the bulk times {one.interface:.3g} by the interface"
            )
        return said


def growing(forward: Forward, opening: Opening, gaps: tuple[float, float]) -> Forward:
    """Return the pull-offs of a material with a lattice of cracks for all growths looked for."""
    unit = forward.material.time_unit
    speeds = [float(opening.speed(gap)) * unit / gap for gap in gaps]
    lattice = GrowingCracks(
        forward.material,
        (_LEAST, _MORE * (LARGEST - 1)),
        (min(speeds) / _FASTER, max(speeds) * _FASTER),
        _LATTICE,
    )
    return Forward(forward.material, forward.radius, lattice)


def growth_parameters() -> tuple[Parameter, Parameter]:
    """Return the unknowns of growth."""
    return (
        Parameter(STRENGTHENING, 1.0, LARGEST, 2.0),
        Parameter(EXPONENT, *EXPONENTS, 0.4, logarithmic=False),
    )


def found_growth(
    values: Mapping[str, float], opening: Opening, better_by: float, speed: Array, pulled: Pulled
) -> FoundGrowth:
    """Return the record of the most likely growth."""
    rows = zip(speed, pulled.crack_speed, pulled.energy, pulled.interface, strict=True)
    shares = tuple(
        Share(float(v), float(edge), float(energy), float(energy / work), float(work))
        for v, edge, energy, work in rows
    )
    return FoundGrowth(
        strengthening=values[STRENGTHENING],
        exponent=values[EXPONENT],
        opening_speed=float(opening.speed(values["equilibrium_gap"])),
        reference_speed=float(opening.of(values).reference_speed),
        better_by=max(better_by, 0.0),
        # the noise is known, so that misfits differ as chi squared; an exponent of no growth is
        # free and a growth not negative, which makes chance less likely still
        chance=float(chi2.sf(max(better_by, 0.0), 2)),
        shares=shares,
        opening=opening,
    )
