"""Amplitudes that may not be negative, by linear least squares."""

import numpy as np
import numpy.typing as npt
from scipy.optimize import lsq_linear, nnls

from viscotack.arrays import Array

# Iterations for each amplitude. Columns of neighbouring times are nearly parallel, and the active
# set goes in and out among them: every other sweep of noisy moduli takes more than the 3 that are
# customary, none more than 10 that ends at all.
_PATIENCE = 30
# Amplitudes that add less than this to every number are none.
_NOTHING = 1e-9


def nonnegative(columns: npt.NDArray, numbers: Array) -> Array:
    """Return the amplitudes, none negative, with which columns come nearest to numbers.

    The active set of Lawson and Hanson (1974), which ends in a finite number of steps in exact
    arithmetic. In floating point it may go round among columns that are parallel to round-off, in
    about one of fifty noisy sweeps; such a problem goes to the reflective trust region of Branch,
    Coleman & Li (1999), doi:10.1137/S1064827595289108, which always ends. What it leaves a hair
    above zero is set to zero where that changes no number.

    Parameters
    ----------
    columns : ndarray, shape (M, N)
        What each amplitude of 1 adds to the numbers, over their noise.
    numbers : ndarray, shape (M,)
        Numbers over their noise.
    """
    # the same triangle has the same amplitudes, and a hundred thousand rows become a few
    if columns.shape[0] > 2 * columns.shape[1]:
        frame, columns = np.linalg.qr(columns)
        numbers = frame.T @ numbers
    try:
        return nnls(columns, numbers, maxiter=_PATIENCE * columns.shape[1])[0]
    except RuntimeError:
        return _reflected(columns, numbers)


def _reflected(columns: npt.NDArray, numbers: Array) -> Array:
    """Return the amplitudes by a search that always ends."""
    size = np.linalg.norm(columns, axis=0)
    size[size == 0] = 1.0
    found = lsq_linear(columns / size, numbers, bounds=(0, np.inf), tol=1e-13, max_iter=500).x
    found[found < _NOTHING * np.linalg.norm(numbers)] = 0.0
    return found / size
