"""Non-negative linear least squares."""

import numpy as np
import numpy.typing as npt
from scipy.optimize import lsq_linear, nnls

from viscotack.arrays import Array

# Iterations per amplitude. Columns of neighbouring times are nearly parallel, so the active set
# changes often: half of the noisy sweeps need more than the usual 3, and none that converges more
# than 10.
_PATIENCE = 30
# Amplitudes that contribute less than this to every number are zero.
_NOTHING = 1e-9


def nonnegative(columns: npt.NDArray, numbers: Array) -> Array:
    """Return the non-negative amplitudes whose sum of columns is nearest to the numbers.

    Uses the active set of Lawson and Hanson (1974), which is finite in exact
    arithmetic. In floating point it may cycle among columns that are parallel to round-off, in
    about one of fifty noisy sweeps. Such a problem is solved by the reflective trust region of
    Branch, Coleman & Li (1999), doi:10.1137/S1064827595289108, which always converges; negligible
    amplitudes are then set to zero.

    Parameters
    ----------
    columns : ndarray, shape (M, N)
        Contribution of unit amplitudes to the numbers, over their noise.
    numbers : ndarray, shape (M,)
        Numbers over their noise.
    """
    # QR: a small triangular system with the same solution replaces up to 100,000 rows
    if columns.shape[0] > 2 * columns.shape[1]:
        frame, columns = np.linalg.qr(columns)
        numbers = frame.T @ numbers
    try:
        return nnls(columns, numbers, maxiter=_PATIENCE * columns.shape[1])[0]
    except RuntimeError:
        return _reflected(columns, numbers)


def _reflected(columns: npt.NDArray, numbers: Array) -> Array:
    """Return the amplitudes by the reflective trust region, which always converges."""
    size = np.linalg.norm(columns, axis=0)
    size[size == 0] = 1.0
    found = lsq_linear(columns / size, numbers, bounds=(0, np.inf), tol=1e-13, max_iter=500).x
    found[found < _NOTHING * np.linalg.norm(numbers)] = 0.0
    return found / size
