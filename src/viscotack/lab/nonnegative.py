"""Amplitudes that may not be negative, by linear least squares."""

import numpy as np
import numpy.typing as npt
from scipy.optimize import nnls

from viscotack.errors import InputError

Array = npt.NDArray[np.float64]

# Iterations for each amplitude. Columns of neighbouring times are nearly parallel, and the active
# set goes in and out among them: every other sweep of noisy moduli takes more than the 3 that are
# customary, none more than 10.
_PATIENCE = 100


def nonnegative(columns: npt.NDArray, numbers: Array) -> Array:
    """Return the amplitudes, none negative, with which columns come nearest to numbers.

    Parameters
    ----------
    columns : ndarray, shape (M, N)
        What each amplitude of 1 adds to the numbers, over their noise.
    numbers : ndarray, shape (M,)
        Numbers over their noise.

    Raises
    ------
    InputError
        If the search does not end.
    """
    rows, count = columns.shape
    try:
        amplitudes, _misfit = nnls(columns, numbers, maxiter=_PATIENCE * count)
    except RuntimeError as error:
        raise InputError(
            f"no best set of {count} amplitudes, none negative, was found for {rows} numbers in "
            f"{_PATIENCE * count} iterations; ask for fewer arms, or fit a law of few constants"
        ) from error
    return amplitudes
