"""Materials: their attributes and methods with units and signs, and what solids share."""

from dataclasses import replace
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from viscotack.cards import conform
from viscotack.errors import InputError
from viscotack.model.materials.modes import Modes
from viscotack.units import positive

Real = float | npt.NDArray[np.float64]
Complex = complex | npt.NDArray[np.complex128]


class Material(Protocol):
    """Linear viscoelastic, isotropic solid with a constant Poisson ratio.

    A protocol for type checkers, see for example :class:`viscotack.StandardSolid`. A new material
    needs these attributes and methods only. Quantities are uniaxial (E, not the contact modulus
    E*), in SI, angular frequencies in rad/s. Methods accept a number or an array and return the
    same shape. Times and frequencies must be in [0, inf]; other values raise ValueError.
    """

    @property
    def rubbery_modulus(self) -> float:
        """Long-time Young's modulus E0 [Pa]."""
        ...

    @property
    def glassy_modulus(self) -> float:
        """Short-time Young's modulus [Pa], not below the rubbery one."""
        ...

    @property
    def poisson_ratio(self) -> float:
        """Poisson ratio nu, dimensionless, in [0, 0.5]."""
        ...

    @property
    def modulus_ratio(self) -> float:
        """Rubbery over glassy modulus k, dimensionless, in (0, 1]."""
        ...

    @property
    def contact_modulus(self) -> float:
        """Relaxed contact modulus E0* = E0/(1 - nu^2) [Pa]."""
        ...

    @property
    def time_unit(self) -> float:
        """Unit of dimensionless times [s]."""
        ...

    def relaxation(self, time: npt.ArrayLike) -> Real:
        """Return the stress after a unit step of strain [Pa], from glassy to rubbery."""
        ...

    def creep(self, time: npt.ArrayLike) -> Real:
        """Return the strain after a unit step of stress [1/Pa], from glassy to rubbery."""
        ...

    def complex_modulus(self, omega: npt.ArrayLike) -> Complex:
        """Return E' + i E'' [Pa], both parts not negative."""
        ...

    def complex_compliance(self, omega: npt.ArrayLike) -> Complex:
        """Return 1/(E' + i E'') = C' - i C'' [1/Pa]."""
        ...

    def retardation_modes(self, *, shortest: float, longest: float, tolerance: float) -> Modes:
        """Approximate the creep by exponential modes in a window of time.

        Parameters
        ----------
        shortest, longest : float
            Times [s] between which the modes must be valid, positive.
        tolerance : float
            Largest absolute error of E0 C(t), dimensionless, in (0, 1). For fast events in a solid
            of small k, request a fraction of E0 C(shortest). Theories of cracks request 1e-14 k:
            below `viscotack.model.materials.modes.FINEST`, 3e-14, rounding limits the accuracy,
            and the closest modes are returned.

        Returns
        -------
        Modes
            With a stated error for shortest <= time <= longest, at most the larger of the tolerance
            and `FINEST`.
        """
        ...

    def reduced(self) -> "Material":
        """Return the dimensionless solid: rubbery modulus 1, time unit 1, Poisson ratio 0."""
        ...


class Solid:
    """Common part of the solids of this package: everything except their two spectra.

    A solid has one complex function at least; the other is its reciprocal.
    """

    rubbery_modulus: Any
    glassy_modulus: Any
    poisson_ratio: Any
    tau0: Any

    def __post_init__(self) -> None:
        conform(self)
        glassy, rubbery = self.glassy_modulus, self.rubbery_modulus
        if glassy < rubbery:
            raise InputError(
                "glassy_modulus (short times) must not be below rubbery_modulus (long times), got "
                f"{glassy:g} Pa < {rubbery:g} Pa; check whether they are interchanged"
            )

    @property
    def modulus_ratio(self) -> float:
        """Rubbery over glassy modulus k, dimensionless, in (0, 1]."""
        return self.rubbery_modulus / self.glassy_modulus

    @property
    def contact_modulus(self) -> float:
        """Relaxed contact modulus E0* = E0/(1 - nu^2) [Pa]."""
        return self.rubbery_modulus / (1 - self.poisson_ratio**2)

    @property
    def time_unit(self) -> float:
        """Unit of dimensionless times [s]: tau0."""
        return self.tau0

    def complex_modulus(self, omega: npt.ArrayLike) -> Complex:
        """Return E' + i E'' [Pa] at angular frequencies [rad/s]."""
        return 1 / self.complex_compliance(omega)

    def complex_compliance(self, omega: npt.ArrayLike) -> Complex:
        """Return 1/(E' + i E'') = C' - i C'' [1/Pa] at angular frequencies [rad/s]."""
        return 1 / self.complex_modulus(omega)

    def retardation_modes(self, *, shortest: float, longest: float, tolerance: float) -> Modes:
        """Return modes of the creep for shortest <= time <= longest [s]; see `Material`."""
        shortest, longest = positive("shortest", shortest, "s"), positive("longest", longest, "s")
        tolerance = positive("tolerance", tolerance, "1/rubbery_modulus")
        if longest < shortest:
            raise InputError(
                f"longest must not be below shortest, got {longest:g} s < {shortest:g} s"
            )
        if tolerance >= 1:
            raise InputError(
                "tolerance is relative to the rubbery compliance and must be below 1, got "
                f"{tolerance:g}"
            )
        if self.modulus_ratio == 1:
            return Modes(instantaneous=1.0, weights=(), times=(), error=0.0)
        return self._modes(shortest, longest, tolerance)

    def _modes(self, shortest: float, longest: float, tolerance: float) -> Modes:
        raise NotImplementedError

    def reduced(self) -> Any:
        """Return the dimensionless solid: rubbery modulus 1, time unit 1, Poisson ratio 0."""
        solid: Any = self
        glassy = self.glassy_modulus / self.rubbery_modulus
        units = {"rubbery_modulus": 1.0, "tau0": 1.0, "poisson_ratio": 0.0}
        return replace(solid, glassy_modulus=glassy, **units)


def word_of(material: Material) -> str:
    """Return the word of a material's model in files.

    Examples
    --------
    >>> from viscotack import Elastic
    >>> word_of(Elastic(rubbery_modulus=1e6, poisson_ratio=0.5))
    'elastic'
    """
    word = getattr(material, "word", None)
    if word is None:
        raise InputError(
            f"{type(material).__name__} has no word in files; define "
            'word: ClassVar[str] = "..." in the class, different from those of other materials'
        )
    return word
