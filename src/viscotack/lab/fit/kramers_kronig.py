r"""Kramers-Kronig test: whether storage and loss modulus belong to one causal solid.

.. math:: E''(\omega) = -\frac{2\omega}{\pi} \int_0^\infty \frac{E'(u)}{\omega^2 - u^2}\,du

(Eq. 4.26 of Maghami, PhD thesis (2025); principal value). A master curve that obeys it may still be
wrong, but one that violates it has a wrong shift, a faulty sweep or a compliance error of the rig.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.special import spence

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.sweeps import MasterCurve

from .nonnegative import nonnegative

_PER_DECADE = 5.0  # relaxation times; a time between grid points causes a 3 % error of loss
_TRUST = 0.1  # weight of loss: it determines only what storage leaves undetermined
_BEYOND = 1.5  # decades beyond the data, for relaxation outside the range
_FREEDOM = 4.0  # degrees of freedom of Student's t
_FINEST = 1e-3  # relative scatter below which points are not tested
_ROUNDS = 8


@dataclass(frozen=True, eq=False)
class Consistency:
    """Deviation of a master curve from the Kramers-Kronig relation, see :func:`consistency`.

    Parameters
    ----------
    storage_residual, loss_residual : ndarray, shape (N,)
        Measured over consistent modulus, minus one; positive where the measured one is larger.
    suspect : ndarray of bool, shape (N,)
        Points where one of the two exceeds the tolerance.
    flagged : tuple of int
        Sweeps with more than half of their points suspect; empty if sweeps are not numbered.
    tolerance : float
        Relative tolerance used.
    """

    storage_residual: Array
    loss_residual: Array
    suspect: npt.NDArray[np.bool_]
    flagged: tuple[int, ...]
    tolerance: float

    @property
    def typical(self) -> tuple[float, float]:
        """Median size of the residuals of storage and of loss modulus."""
        return (
            float(np.median(np.abs(self.storage_residual))),
            float(np.median(np.abs(self.loss_residual))),
        )

    def __str__(self) -> str:
        storage, loss = self.typical
        part = 100 * float(np.mean(self.suspect))
        sweeps = ", ".join(map(str, self.flagged)) or "none"
        return (
            f"Kramers-Kronig: storage within {100 * storage:.2g} %, loss within {100 * loss:.2g} % "
            f"of a consistent pair (median); {part:.3g} % of the points deviate by more than "
            f"{100 * self.tolerance:g} %; flagged sweeps: {sweeps}"
        )


def consistency(master: MasterCurve, *, tolerance: float = 0.1, alike: bool = False) -> Consistency:
    r"""Compare a master curve with the nearest pair of moduli that obeys Kramers-Kronig.

    Parameters
    ----------
    master : MasterCurve
        Four or more points over at least half a decade.
    tolerance : float
        Relative difference above which a point is suspect, in (0, 1).
    alike : bool
        True: equal weights of all points and both moduli, to test whether the pair as a whole is
        causal. False: robust weights, to find the suspect points.

    Returns
    -------
    Consistency

    Raises
    ------
    ValueError
        If there are too few points.

    Notes
    -----
    Each relaxation mode obeys Eq. 4.26 exactly, and so does every sum of modes with positive
    weights. Non-negative least squares of relative residuals gives the nearest such sum to the
    storage modulus, with five modes per decade and reduced weights of outliers, so that a faulty
    sweep is detected and not fitted. The loss modulus has a weight of 0.1: it determines only what
    storage leaves undetermined: relaxation beyond the data and where storage hardly rises.

    Examples
    --------
    >>> from viscotack.materials import StandardSolid
    >>> sls = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e9, tau0=1.0, poisson_ratio=0.5
    ... )
    >>> omega = np.geomspace(1e-2, 1e6, 40)
    >>> modulus = sls.complex_modulus(omega)
    >>> good = MasterCurve(293.15, omega, modulus.real, modulus.imag, "E")
    >>> bool(consistency(good).suspect.any())
    False
    >>> bad = MasterCurve(293.15, omega, modulus.real, 3 * modulus.imag, "E")
    >>> bool(consistency(bad).suspect.any())
    True
    """
    if not 0 < tolerance < 1:
        raise InputError(f"tolerance must lie between 0 and 1, got {tolerance!r}")
    omega = master.angular_frequency
    decades = float(np.log10(omega[-1] / omega[0]))
    if omega.size < 4 or decades < 0.5:
        raise InputError(
            f"{omega.size} points over {decades:.2g} decades of frequency are too few for a "
            "Kramers-Kronig test (at least 4 over 0.5 decades)"
        )
    count = int(_PER_DECADE * (decades + 2 * _BEYOND)) + 1
    times = np.geomspace(10**-_BEYOND / omega[-1], 10**_BEYOND / omega[0], count)
    ratio = omega[:, None] * times
    # first column: rubbery modulus
    storage = np.hstack((np.ones((omega.size, 1)), ratio**2 / (1 + ratio**2)))
    loss = np.hstack((np.zeros((omega.size, 1)), ratio / (1 + ratio**2)))
    columns = np.vstack((storage / master.storage[:, None], loss / master.loss[:, None]))
    columns /= np.linalg.norm(columns, axis=0)
    sides = np.column_stack((columns, np.ones(2 * omega.size)))
    trust = np.repeat([1.0, 1.0 if alike else _TRUST], omega.size)
    tail = np.ones(2 * omega.size)
    for _ in range(1 if alike else _ROUNDS):
        # QR: the triangular factor replaces thousands of rows
        weighted = sides * (trust * np.sqrt(tail))[:, None]
        triangle = np.asarray(np.linalg.qr(weighted, mode="r"))
        part = nonnegative(triangle[:, :-1], triangle[:, -1])
        residual = columns @ part - 1
        scatter = [float(np.mean(half)) for half in np.split(tail * residual**2, 2)]
        scatter = np.repeat(scatter, omega.size) + _FINEST**2
        tail = (_FREEDOM + 1) / (_FREEDOM + residual**2 / scatter)
    consistent = 1 + residual
    off = 1 / np.maximum(consistent, 1e-12) - 1
    storage_off, loss_off = off[: omega.size], off[omega.size :]
    suspect = (np.abs(storage_off) > tolerance) | (np.abs(loss_off) > tolerance)
    flagged = ()
    if master.sweep is not None:
        flagged = tuple(
            int(number)
            for number in np.unique(master.sweep)
            if np.mean(suspect[master.sweep == number]) > 0.5
        )
    return Consistency(storage_off, loss_off, suspect, flagged, tolerance)


def causal_misfit(master: MasterCurve) -> tuple[float, float] | None:
    """Return the root mean square of ln(measured/causal) of storage and of loss modulus.

    All points and both moduli have equal weights. None if there are too few points.
    """
    try:
        found = consistency(master, alike=True)
    except ValueError:
        return None
    storage, loss = (
        float(np.sqrt(np.mean(np.log1p(residual) ** 2)))
        for residual in (found.storage_residual, found.loss_residual)
    )
    return storage, loss


def loss_from_storage(angular_frequency: npt.ArrayLike, storage: npt.ArrayLike) -> Array:
    r"""Compute the loss modulus that belongs to a storage modulus (Eq. 4.26).

    .. math:: E''(\omega) = \frac{1}{\pi} \int_{-\infty}^{\infty}
        \frac{dE'}{d\ln u} \ln\coth\left|\tfrac12 \ln\frac{u}{\omega}\right|\,d\ln u

    This is Eq. 4.26 integrated by parts, exact for a storage modulus that is linear in ln u
    between the points and constant beyond them.

    Parameters
    ----------
    angular_frequency : array_like, shape (N,)
        Strictly ascending angular frequencies [rad/s], positive.
    storage : array_like, shape (N,)
        Storage modulus [Pa], smooth: noise between close points is amplified in the loss.

    Returns
    -------
    ndarray, shape (N,)
        Loss modulus [Pa]. The contribution of storage beyond the ends is missing, which matters
        within about a decade of them.

    Raises
    ------
    ValueError
        If the frequencies do not ascend, or the shapes differ.

    Examples
    --------
    >>> omega = np.geomspace(1e-4, 1e4, 801)
    >>> maxwell = 1e6 * omega**2 / (1 + omega**2)
    >>> f"{loss_from_storage(omega, maxwell)[400]:.4g}"  # 1e6 / 2 at omega = 1 rad/s
    '5e+05'
    """
    omega = np.asarray(angular_frequency, dtype=float)
    modulus = np.asarray(storage, dtype=float)
    if omega.ndim != 1 or omega.size < 2 or omega.shape != modulus.shape:
        raise InputError(
            f"expected two rows of the same length, got shapes {omega.shape} and {modulus.shape}"
        )
    if not (omega[0] > 0 and np.all(np.diff(omega) > 0) and np.all(np.isfinite(modulus))):
        raise InputError("frequencies must be positive and ascend, moduli must be finite")
    y = np.log(omega)
    slope = np.diff(modulus) / np.diff(y)
    return np.diff(_integral(y[None, :] - y[:, None]), axis=1) @ slope / np.pi


def _integral(y: Array) -> Array:
    """Return the integral of ln coth|t/2| from 0 to y, an odd function with limit pi^2/4."""
    z = np.exp(-np.abs(y))
    # Legendre's chi function is half the difference of two dilogarithms
    return np.sign(y) * (np.pi**2 / 4 - (spence(1 - z) - spence(1 + z)))
