"""What every material answers, in one place: words, units and signs."""

from typing import Protocol

import numpy as np
import numpy.typing as npt

from viscotack.materials.modes import Modes

Real = float | npt.NDArray[np.float64]
Complex = complex | npt.NDArray[np.complex128]


class Material(Protocol):
    """Describe a linear viscoelastic, isotropic solid with a constant Poisson ratio.

    A type for the checker: a new material needs these names and nothing else. Quantities are
    uniaxial (E, not the contact modulus E*), in SI, angular frequencies in rad/s. A number gives a
    number, an array an array of its shape; times and frequencies lie in [0, inf], anything else
    raises ValueError.
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
        """Return the creep in exponential modes, for a window of time.

        Parameters
        ----------
        shortest, longest : float
            Times [s] between which the modes must hold, positive.
        tolerance : float
            Largest error of E0 C(t), dimensionless, in (0, 1). It is absolute: for fast events in
            a solid of small k ask for a fraction of E0 C(shortest). Theories of cracks ask for
            1e-14 k: below `viscotack.materials.modes.FINEST`, 3e-14, rounding decides, and the
            modes are the closest there are.

        Returns
        -------
        Modes
            With a stated error that holds for shortest <= time <= longest; not above the larger
            of the tolerance and `FINEST`.
        """
        ...

    def reduced(self) -> "Material":
        """Return the dimensionless twin: rubbery modulus 1, time unit 1, Poisson ratio 0."""
        ...
