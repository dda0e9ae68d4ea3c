"""Linear viscoelastic solids with no branch, one branch, or a series of branches."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, ClassVar

import numpy as np
import numpy.typing as npt

from viscotack.cards import Pairs, conform
from viscotack.errors import InputError
from viscotack.model.materials.constants import (
    GlassyModulus,
    PoissonRatio,
    RetardationTime,
    RubberyModulus,
    like_input,
    nonnegative,
)
from viscotack.model.materials.material import Complex, Real, Solid
from viscotack.model.materials.modes import Modes, compressed, maxwell, reciprocal, voigt
from viscotack.units import positive


@dataclass(frozen=True, kw_only=True)
class Elastic(Solid):
    """Elastic solid, without memory.

    Parameters
    ----------
    rubbery_modulus : float
        Young's modulus E0 [Pa], positive.
    poisson_ratio : float
        Poisson ratio nu, between 0 and 0.5.

    Examples
    --------
    >>> rubber = Elastic(rubbery_modulus=1e6, poisson_ratio=0.5)
    >>> f"{rubber.contact_modulus:.4g} Pa"
    '1.333e+06 Pa'
    """

    word: ClassVar[str] = "elastic"

    rubbery_modulus: RubberyModulus
    poisson_ratio: PoissonRatio

    @property
    def glassy_modulus(self) -> float:
        """Short-time Young's modulus [Pa], here the rubbery one."""
        return self.rubbery_modulus

    @property
    def time_unit(self) -> float:
        """Unit of dimensionless times [s]: 1 s, as there is no characteristic time."""
        return 1.0

    def relaxation(self, time: npt.ArrayLike) -> Real:
        """Return the relaxation modulus [Pa], constant, at times [s]."""
        t = nonnegative("time", time, "s")
        return like_input(np.full(t.shape, self.rubbery_modulus))

    def creep(self, time: npt.ArrayLike) -> Real:
        """Return the creep compliance [1/Pa], constant, at times [s]."""
        t = nonnegative("time", time, "s")
        return like_input(np.full(t.shape, 1 / self.rubbery_modulus))

    def complex_modulus(self, omega: npt.ArrayLike) -> Complex:
        """Return the complex modulus [Pa], real and constant, at angular frequencies [rad/s]."""
        w = nonnegative("omega", omega, "rad/s")
        return like_input(np.full(w.shape, complex(self.rubbery_modulus)))

    def reduced(self) -> "Elastic":
        """Return the dimensionless solid: rubbery modulus 1, Poisson ratio 0."""
        return Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)


@dataclass(frozen=True, kw_only=True)
class StandardSolid(Solid):
    r"""Standard linear solid with one retardation time.

    .. math:: E_0 C(t) = 1 + (k - 1) e^{-t/\tau_0}, \quad k = E_0/E_\infty

    (Eq. 3.26 of Maghami, PhD thesis (2025)).

    Parameters
    ----------
    rubbery_modulus : float
        Long-time Young's modulus E0 [Pa], positive.
    glassy_modulus : float
        Short-time Young's modulus [Pa], not below the rubbery one.
    tau0 : float
        RETARDATION time [s], positive. The relaxation time is k tau0: `relaxation_time`.
    poisson_ratio : float
        Poisson ratio nu, between 0 and 0.5.

    Examples
    --------
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, tau0=2.0, poisson_ratio=0.5
    ... )
    >>> f"{solid.creep(2.0) * 1e6:.4f} 1/MPa, relaxes in {solid.relaxation_time:.2f} s"
    '0.6689 1/MPa, relaxes in 0.20 s'
    """

    word: ClassVar[str] = "sls"

    rubbery_modulus: RubberyModulus
    glassy_modulus: GlassyModulus
    tau0: RetardationTime
    poisson_ratio: PoissonRatio

    @property
    def relaxation_time(self) -> float:
        """Relaxation time k tau0 [s], never longer than the retardation time."""
        return self.modulus_ratio * self.tau0

    def relaxation(self, time: npt.ArrayLike) -> Real:
        """Return the relaxation modulus [Pa], from glassy to rubbery, at times [s]."""
        t = nonnegative("time", time, "s")
        E0, Einf = self.rubbery_modulus, self.glassy_modulus
        return like_input(E0 + (Einf - E0) * np.exp(-t / self.relaxation_time))

    def creep(self, time: npt.ArrayLike) -> Real:
        """Return the creep compliance [1/Pa], from glassy to rubbery, at times [s] (Eq. 3.26)."""
        t = nonnegative("time", time, "s")
        C0, Cinf = 1 / self.rubbery_modulus, 1 / self.glassy_modulus
        # Eq. 3.26 with expm1, which avoids cancellation for t << tau0
        return like_input(Cinf - (C0 - Cinf) * np.expm1(-t / self.tau0))

    def complex_modulus(self, omega: npt.ArrayLike) -> Complex:
        """Return E' + i E'' [Pa] at angular frequencies [rad/s]."""
        w = nonnegative("omega", omega, "rad/s")
        E0, Einf = self.rubbery_modulus, self.glassy_modulus
        return like_input(E0 + (Einf - E0) * maxwell(w * self.relaxation_time))

    def complex_compliance(self, omega: npt.ArrayLike) -> Complex:
        """Return 1/(E' + i E'') = C' - i C'' [1/Pa] at angular frequencies [rad/s]."""
        w = nonnegative("omega", omega, "rad/s")
        C0, Cinf = 1 / self.rubbery_modulus, 1 / self.glassy_modulus
        return like_input(Cinf + (C0 - Cinf) * voigt(w * self.tau0))

    def _modes(self, *window: float) -> Modes:
        k = self.modulus_ratio
        return compressed(k, np.array([1 - k]), np.array([self.tau0]), *window, error=1e-15)


@dataclass(frozen=True, kw_only=True)
class Prony(Solid):
    r"""Generalised Maxwell (Wiechert) solid: a spring in parallel with Maxwell branches.

    .. math:: R(t) = E_0 + \sum_i E_i e^{-t/\tau_i}

    Parameters
    ----------
    rubbery_modulus : float
        Long-time Young's modulus E0 [Pa], positive.
    branches : sequence of (float, float)
        Modulus E_i [Pa] and RELAXATION time tau_i [s] of each branch, both positive, all times
        different. Stored as a tuple sorted by time.
    poisson_ratio : float
        Poisson ratio nu, between 0 and 0.5.

    Notes
    -----
    The creep compliance is exact: its retardation times are the zeros of the modulus between the
    relaxation times, see :func:`viscotack.model.materials.modes.reciprocal`.

    References
    ----------
    Park & Schapery (1999), Methods of interconversion between linear viscoelastic material
    functions. Part I, International Journal of Solids and Structures 36, 1653-1675.

    Examples
    --------
    >>> solid = Prony(
    ...     rubbery_modulus=1e6, branches=[(5e6, 1e-3), (4e6, 1.0)], poisson_ratio=0.5
    ... )
    >>> solid.branches[0], solid.modulus_ratio
    ((5000000.0, 0.001), 0.1)
    >>> f"{solid.relaxation(1.0):.4g} Pa, {solid.creep(1.0):.4g} 1/Pa"
    '2.472e+06 Pa, 3.446e-07 1/Pa'
    """

    word: ClassVar[str] = "prony"

    rubbery_modulus: RubberyModulus
    branches: Annotated[
        tuple[tuple[float, float], ...],
        Pairs(
            ("Pa", "s"),
            "E_i, tau_i",
            "modulus and relaxation time of each branch",
            example='[["5 MPa", "1 ms"], ["4 MPa", "1 s"]]',
            advice="use Elastic for a solid without any; ten per decade of time suffice",
        ),
    ]
    poisson_ratio: PoissonRatio

    def __post_init__(self):
        conform(self)
        pairs = sorted(self.branches, key=lambda pair: pair[1])
        for modulus, time in pairs:
            positive("a modulus of branches", modulus, "Pa")
            positive("a time of branches", time, "s")
        for (_, time), (_, following) in pairwise(pairs):
            if following < time * (1 + 1e-9):
                raise InputError(
                    "the times of branches must differ by more than 1e-9 (relative), got "
                    f"{time!r} s and {following!r} s; merge the two by adding their moduli"
                )
        object.__setattr__(self, "branches", tuple(pairs))

    @property
    def glassy_modulus(self) -> float:
        """Short-time Young's modulus [Pa]: the rubbery one and all branches."""
        return self.rubbery_modulus + sum(modulus for modulus, _ in self.branches)

    @property
    def time_unit(self) -> float:
        """Unit of dimensionless times [s]: the longest relaxation time."""
        return self.branches[-1][1]

    def relaxation(self, time: npt.ArrayLike) -> Real:
        """Return the relaxation modulus [Pa], from glassy to rubbery, at times [s]."""
        t = nonnegative("time", time, "s")
        E, tau = np.array(self.branches).T
        return like_input(self.rubbery_modulus + np.exp(-t[..., None] / tau) @ E)

    def creep(self, time: npt.ArrayLike) -> Real:
        """Return the creep compliance [1/Pa], from glassy to rubbery, at times [s]."""
        t = nonnegative("time", time, "s")
        C, rate = self.retardation()
        return like_input(1 / self.glassy_modulus - np.expm1(-t[..., None] * rate) @ C)

    def complex_modulus(self, omega: npt.ArrayLike) -> Complex:
        """Return E' + i E'' [Pa] at angular frequencies [rad/s]."""
        w = nonnegative("omega", omega, "rad/s")
        E, tau = np.array(self.branches).T
        return like_input(self.rubbery_modulus + maxwell(w[..., None] * tau) @ E)

    def _modes(self, *window: float) -> Modes:
        C, rate = self.retardation()
        weights, times = self.rubbery_modulus * C[::-1], 1 / rate[::-1]
        return compressed(self.modulus_ratio, weights, times, *window, error=1e-14)

    def reduced(self) -> "Prony":
        """Return the dimensionless solid: rubbery modulus 1, longest time 1, Poisson ratio 0."""
        E0, unit = self.rubbery_modulus, self.time_unit
        branches = tuple((E / E0, tau / unit) for E, tau in self.branches)
        return Prony(rubbery_modulus=1.0, branches=branches, poisson_ratio=0.0)

    def retardation(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Return the compliances [1/Pa] and retardation rates [1/s], rates ascending."""
        E, tau = np.array(self.branches[::-1]).T
        return reciprocal(self.rubbery_modulus, E, 1 / tau)
