r"""Do storage and loss modulus belong to one causal solid? The relation of Kramers and Kronig.

.. math:: E''(\omega) = -\frac{2\omega}{\pi} \int_0^\infty \frac{E'(u)}{\omega^2 - u^2}\,du

(Eq. 4.26 of Maghami, PhD thesis (2025); principal value). A master curve that obeys it need not be
right, but one that does not has a wrong shift, a wrong sweep or a loss modulus from the machine.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.special import spence

from viscotack.arrays import Array
from viscotack.errors import InputError

from .nonnegative import nonnegative
from .sweeps import MasterCurve

_PER_DECADE = 5.0  # relaxation times: a single one off the grid costs 3 % of loss
_TRUST = 0.1  # weight of loss: it decides only what storage leaves open
_BEYOND = 1.5  # decades beyond the data, for what happens there
_FREEDOM = 4.0  # degrees of freedom of Student's t
_FINEST = 1e-3  # relative scatter below which there is nothing to judge
_ROUNDS = 8


@dataclass(frozen=True, eq=False)
class Consistency:
    """How far a master curve is from obeying the relation of Kramers and Kronig.

    Parameters
    ----------
    storage_residual, loss_residual : ndarray, shape (N,)
        Measured over consistent modulus, less one; positive where too much was measured.
    suspect : ndarray of bool, shape (N,)
        Points where one of the two exceeds the tolerance.
    flagged : tuple of int
        Sweeps of which more than half the points are suspect; empty without numbers of sweeps.
    tolerance : float
        As given, relative.
    """

    storage_residual: Array
    loss_residual: Array
    suspect: npt.NDArray[np.bool_]
    flagged: tuple[int, ...]
    tolerance: float

    @property
    def typical(self) -> tuple[float, float]:
        """Median size of the residual of storage and of loss."""
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
            f"of a consistent pair in the median; {part:.3g} % of the points off by more than "
            f"{100 * self.tolerance:g} %; flagged sweeps: {sweeps}"
        )


def consistency(master: MasterCurve, *, tolerance: float = 0.1, alike: bool = False) -> Consistency:
    r"""Compare a master curve with the nearest pair of moduli that obey Kramers and Kronig.

    Parameters
    ----------
    master : MasterCurve
        Four or more points over half a decade or more.
    tolerance : float
        Relative difference beyond which a point is suspect, in (0, 1).
    alike : bool
        Whether all points and both moduli count alike. That says whether the pair is causal as a
        whole; without it, which points are not.

    Returns
    -------
    Consistency

    Raises
    ------
    ValueError
        If there are too few points to say anything.

    Notes
    -----
    Each relaxation mode obeys Eq. 4.26 exactly, and so does every sum of modes with positive
    weights. The nearest such sum to the storage modulus is found by non-negative least squares of
    relative residuals, five modes per decade, with a weight that falls for outliers, so that a bad
    sweep is seen and not followed. The loss modulus counts a tenth: it decides what storage leaves
    open, which is what happens beyond the data and where storage hardly rises.

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
            f"{omega.size} points over {decades:.2g} decades of frequency are too few to check"
        )
    count = int(_PER_DECADE * (decades + 2 * _BEYOND)) + 1
    times = np.geomspace(10**-_BEYOND / omega[-1], 10**_BEYOND / omega[0], count)
    ratio = omega[:, None] * times
    # the first column is the rubbery modulus
    storage = np.hstack((np.ones((omega.size, 1)), ratio**2 / (1 + ratio**2)))
    loss = np.hstack((np.zeros((omega.size, 1)), ratio / (1 + ratio**2)))
    columns = np.vstack((storage / master.storage[:, None], loss / master.loss[:, None]))
    columns /= np.linalg.norm(columns, axis=0)
    sides = np.column_stack((columns, np.ones(2 * omega.size)))
    trust = np.repeat([1.0, 1.0 if alike else _TRUST], omega.size)
    tail = np.ones(2 * omega.size)
    for _ in range(1 if alike else _ROUNDS):
        # the triangle of all rows says the same as the rows, which may be thousands
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
    """Return the root mean square of ln(measured/causal) of storage and of loss.

    Every point and both moduli count alike. None where there are too few points to say anything.
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
    r"""Return the loss modulus that belongs to a storage modulus (Eq. 4.26).

    .. math:: E''(\omega) = \frac{1}{\pi} \int_{-\infty}^{\infty}
        \frac{dE'}{d\ln u} \ln\coth\left|\tfrac12 \ln\frac{u}{\omega}\right|\,d\ln u

    which is Eq. 4.26 integrated by parts, exactly for a storage modulus that is straight in ln u
    between the points and constant beyond them.

    Parameters
    ----------
    angular_frequency : array_like, shape (N,)
        Ascending [rad/s], each once, positive.
    storage : array_like, shape (N,)
        Storage modulus [Pa], smooth: noise between close points becomes large in the loss.

    Returns
    -------
    ndarray, shape (N,)
        Loss modulus [Pa]. It lacks what the storage modulus does beyond the ends, which is felt
        within about a decade of them.

    Raises
    ------
    ValueError
        If the frequencies do not ascend.

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
    """Return the integral of ln coth|t/2| from 0 to y, an odd function: pi^2/4 at infinity."""
    z = np.exp(-np.abs(y))
    # Legendre's chi function is half the difference of two dilogarithms
    return np.sign(y) * (np.pi**2 / 4 - (spence(1 - z) - spence(1 + z)))
