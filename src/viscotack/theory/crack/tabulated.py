"""Tabulated retardation spectrum as a material for the crack theories.

Source: the definition of a retardation spectrum.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.model.materials import Modes
from viscotack.theory._checks import WIDEST_GAP as WIDEST_GAP
from viscotack.theory._checks import Values, ascending

_FEWEST = 4
_STEP = 0.02


@dataclass(frozen=True)
class TabulatedSpectrum:
    r"""Linear solid with a tabulated retardation spectrum.

    .. math:: C(t) = \frac1{E_\infty} + \int L(\tau) (1 - e^{-t/\tau}) \, d \ln\tau, \quad
              \frac1{E_\infty} = \frac1{E_0} - \int L \, d \ln\tau

    The spectrum is linear between the points in ln tau, zero outside; a table must therefore extend
    to where L is small. Use it as ``material`` of :mod:`viscotack.theory.crack.persson_brener` or
    :mod:`viscotack.theory.crack.greenwood`; the time unit is then one second.

    Parameters
    ----------
    rubbery_modulus : float
        E0 [Pa].
    times : sequence of float
        Retardation times [s], ascending, at most a decade apart.
    densities : sequence of float
        L [1/Pa] per unit of ln tau, not negative; its integral must be below 1/E0.

    Raises
    ------
    ValueError
        If times are not positive and ascending, leave a gap, or the densities are invalid.

    Examples
    --------
    >>> from viscotack.theory import persson_brener
    >>> rubber = TabulatedSpectrum(
    ...     rubbery_modulus=1e6, times=(1e-3, 1e-2, 1e-1, 1.0), densities=(0, 1e-7, 2e-7, 0)
    ... )
    >>> f"{rubber.modulus_ratio:.3f} {persson_brener.amplification(1.0, material=rubber):.3f}"
    '0.309 1.171'
    """

    rubbery_modulus: float
    times: tuple[float, ...]
    densities: tuple[float, ...]

    def __post_init__(self) -> None:
        E = float(self.rubbery_modulus)
        if not 0 < E < np.inf:
            raise InputError(f"rubbery_modulus must be a positive, finite number [Pa], got {E}")
        t, L = np.asarray(self.times, dtype=float), np.asarray(self.densities, dtype=float)
        if t.ndim != 1 or t.shape != L.shape or t.size < _FEWEST:
            raise InputError(
                f"a spectrum needs {_FEWEST} or more times and as many densities, got "
                f"{t.size} times and {L.size} densities"
            )
        if not np.all(np.isfinite(t) & (t > 0)):
            raise InputError("times must be positive and finite [s]; remove the empty rows")
        ascending(t, "times", "s", "sort the table (times from frequencies are in reverse order)")
        if not np.all(np.isfinite(L) & (L >= 0)):
            raise InputError(
                f"densities must be finite and not negative [1/Pa], got a minimum of {np.min(L):g}"
            )
        total = float(np.sum((L[1:] + L[:-1]) / 2 * np.diff(np.log(t))))
        if not 0 < total * E < 1:
            raise InputError(
                f"the integral of the spectrum is {total:.4g} 1/Pa and must lie between 0 and the "
                f"rubbery compliance {1 / E:.4g} 1/Pa; check the units of the densities"
            )
        object.__setattr__(self, "rubbery_modulus", E)
        object.__setattr__(self, "times", tuple(t.tolist()))
        object.__setattr__(self, "densities", tuple(L.tolist()))

    @property
    def modulus_ratio(self) -> float:
        """Rubbery over glassy modulus, k, in (0, 1); no unit."""
        return 1 - float(np.sum(self._modes()[1]))

    @property
    def glassy_modulus(self) -> float:
        """Glassy modulus [Pa]."""
        return self.rubbery_modulus / self.modulus_ratio

    @property
    def time_unit(self) -> float:
        """Unit of time of dimensionless speeds, one second [s]."""
        return 1.0

    def creep(self, time: Values) -> float | npt.NDArray[np.float64]:
        """Return the creep compliance [1/Pa] at times [s]."""
        found = np.asarray(
            self.retardation_modes(shortest=1.0, longest=1.0, tolerance=0.1).creep(time)
        )
        return (
            found.item() / self.rubbery_modulus if found.ndim == 0 else found / self.rubbery_modulus
        )

    def retardation_modes(self, *, shortest: float, longest: float, tolerance: float) -> Modes:
        """Return all modes of the table, because there are few."""
        times, weights = self._modes()
        return Modes(1 - float(np.sum(weights)), tuple(weights), tuple(times), 0.0)

    def _modes(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Return times and weights, by the trapezoidal rule on refined linear pieces."""
        x, L = np.log(self.times), np.array(self.densities)
        pieces = [
            np.linspace(a, b, int(np.ceil((b - a) / _STEP)) + 1)[:-1]
            for a, b in zip(x[:-1], x[1:], strict=True)
        ]
        fine = np.concatenate([*pieces, x[-1:]])
        width = np.diff(fine)
        share = (np.append(width, 0.0) + np.append(0.0, width)) / 2
        return np.exp(fine), np.interp(fine, x, L) * share * self.rubbery_modulus
