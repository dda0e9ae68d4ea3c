r"""Kramers-Kronig test: whether storage and loss modulus belong to one causal solid.

.. math:: E''(\omega) = -\frac{2\omega}{\pi} \int_0^\infty \frac{E'(u)}{\omega^2 - u^2}\,du

(Eq. 4.26 of Maghami, PhD thesis (2025); principal value). A master curve that obeys it may still be
wrong, but one that violates it has a wrong shift, a faulty sweep or a compliance error of the rig.
"""

import numpy as np
import numpy.typing as npt
from scipy.special import spence

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.sweeps import MasterCurve

from .nonnegative import nonnegative

_PER_DECADE = 5.0  # relaxation times; a time between grid points causes a 3 % error of loss
_BEYOND = 1.5  # decades beyond the data, for relaxation outside the range


def causal_misfit(master: MasterCurve) -> tuple[float, float] | None:
    """Return the root mean square of ln(measured/causal) of storage and of loss modulus.

    Each relaxation mode obeys Eq. 4.26 exactly, and so does every sum of modes with positive
    weights. Non-negative least squares of relative residuals gives the nearest such sum, with five
    modes per decade and equal weights of all points and both moduli. None with fewer than four
    points or less than half a decade.
    """
    omega = master.angular_frequency
    decades = float(np.log10(omega[-1] / omega[0]))
    if omega.size < 4 or decades < 0.5:
        return None
    count = int(_PER_DECADE * (decades + 2 * _BEYOND)) + 1
    times = np.geomspace(10**-_BEYOND / omega[-1], 10**_BEYOND / omega[0], count)
    ratio = omega[:, None] * times
    # first column: rubbery modulus
    storage = np.hstack((np.ones((omega.size, 1)), ratio**2 / (1 + ratio**2)))
    loss = np.hstack((np.zeros((omega.size, 1)), ratio / (1 + ratio**2)))
    columns = np.vstack((storage / master.storage[:, None], loss / master.loss[:, None]))
    columns /= np.linalg.norm(columns, axis=0)
    sides = np.column_stack((columns, np.ones(2 * omega.size)))
    # QR: the triangular factor replaces thousands of rows
    triangle = np.asarray(np.linalg.qr(sides, mode="r"))
    causal = np.maximum(columns @ nonnegative(triangle[:, :-1], triangle[:, -1]), 1e-12)
    storage_off, loss_off = np.split(np.log(causal), 2)
    return float(np.sqrt(np.mean(storage_off**2))), float(np.sqrt(np.mean(loss_off**2)))


def contradiction(master: MasterCurve, *, tolerance: float = 0.1) -> str:
    """Describe how storage and loss modulus violate causality; empty if they do not.

    The nearest pair that obeys the Kramers-Kronig relation is fitted with equal weights of all
    points.

    Parameters
    ----------
    master : MasterCurve
        Storage and loss modulus.
    tolerance : float
        Relative deviation from the nearest causal pair that is accepted.

    Returns
    -------
    str
        A sentence, or an empty string.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e9, tau0=1.0, poisson_ratio=0.5)
    >>> omega = np.geomspace(1e-2, 1e6, 40)
    >>> modulus = solid.complex_modulus(omega)
    >>> contradiction(MasterCurve(293.15, omega, modulus.real, modulus.imag, "E"))
    ''
    """
    off = causal_misfit(master)
    if off is None or max(off) <= tolerance:
        return ""
    return (
        "storage and loss modulus contradict each other (Kramers-Kronig): the nearest causal solid "
        f"is {100 * np.expm1(off[0]):.2g} % off in storage and {100 * np.expm1(off[1]):.2g} % in "
        "loss. A shift, a sweep or a calibration is wrong"
    )


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
