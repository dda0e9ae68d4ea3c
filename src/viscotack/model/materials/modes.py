"""Exponential modes of the creep of a linear viscoelastic solid."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.materials.checks import like_input, nonnegative

# Rounding error of E0 C(t) as a sum of exponentials, and the smallest tolerance of modes.
# Below it the closest modes are returned with their error.
ROUNDING, FINEST = 1e-14, 3e-14
_BLOCK = 2**18  # elements of one temporary array


@dataclass(frozen=True)
class Modes:
    r"""Creep compliance as exponential modes, relative to the rubbery compliance.

    .. math:: E_0 C(t) = c_\infty + \sum_j w_j (1 - e^{-t/\tau_j})

    Parameters
    ----------
    instantaneous : float
        Instantaneous compliance c_inf, dimensionless, positive; with the weights it sums to 1.
    weights : tuple of float
        Weight of each mode (w), dimensionless, positive.
    times : tuple of float
        Retardation time of each mode (tau) [s], ascending.
    error : float
        Bound on the error of E0 C(t), dimensionless, in the window of time of the modes. At shorter
        times the modes are too compliant.

    Examples
    --------
    >>> modes = Modes(instantaneous=0.1, weights=(0.9,), times=(2.0,), error=0.0)
    >>> f"{modes.creep(2.0):.4f}"
    '0.6689'
    """

    instantaneous: float
    weights: tuple[float, ...]
    times: tuple[float, ...]
    error: float

    def __post_init__(self):
        object.__setattr__(self, "instantaneous", float(self.instantaneous))
        object.__setattr__(self, "weights", tuple(float(w) for w in self.weights))
        object.__setattr__(self, "times", tuple(float(t) for t in self.times))
        object.__setattr__(self, "error", float(self.error))
        if len(self.weights) != len(self.times):
            raise InputError(
                f"modes need one time for each weight, got {len(self.weights)} weights "
                f"and {len(self.times)} times"
            )

    def creep(self, time: npt.ArrayLike) -> float | Array:
        """Return E0 C, dimensionless, at times [s]; it rises from `instantaneous` at 0 to 1."""
        t = nonnegative("time", time, "s")
        crept = -np.expm1(-t[..., None] / np.array(self.times)) @ np.array(self.weights)
        return like_input(self.instantaneous + crept)


def maxwell(x: Array) -> npt.NDArray[np.complexfloating]:
    """Return i x/(1 + i x), a Maxwell branch at x = omega tau in [0, inf], without cancellation."""
    with np.errstate(divide="ignore", over="ignore"):
        return 1 / (1 + (1 / x) ** 2) + 1j / (x + 1 / x)


def voigt(x: Array) -> npt.NDArray[np.complexfloating]:
    """Return 1/(1 + i x), a Voigt element at x = omega tau in [0, inf], without cancellation."""
    with np.errstate(divide="ignore", over="ignore"):
        return 1 / (1 + x**2) - 1j / (x + 1 / x)


def blockwise(rows: Callable[[Array], npt.NDArray], weights: Array, x: Array) -> npt.NDArray:
    """Compute ``rows(x) @ weights`` in blocks to limit memory; the result has the shape of x.

    Parameters
    ----------
    rows : callable
        (column of x, shape (n, 1)) -> array of shape (n, N).
    weights : ndarray, shape (N,)
        Weights of the columns of that array.
    x : ndarray
        Arguments.
    """
    count = max(1, _BLOCK // max(weights.size, 1))
    flat = np.ravel(x)
    with np.errstate(over="ignore", under="ignore"):
        blocks = [rows(flat[i : i + count, None]) @ weights for i in range(0, flat.size, count)]
    return np.concatenate([*blocks, []]).reshape(np.shape(x))


def compressed(
    instantaneous: float,
    weights: Array,
    times: Array,
    shortest: float,
    longest: float,
    tolerance: float,
    *,
    error: float,
) -> Modes:
    """Reduce modes, with the same creep for shortest <= time <= longest.

    The fastest modes become instantaneous; the slowest become one mode of the same weight and the
    same initial creep rate. Each of the two reductions uses at most half of the tolerance.

    Parameters
    ----------
    instantaneous : float
        Instantaneous compliance, in units of the rubbery compliance.
    weights, times : ndarray, shape (N,)
        The modes to compress; times [s] ascending.
    shortest, longest : float
        Window of time [s].
    tolerance : float
        Largest additional error, relative to the rubbery compliance.
    error : float
        Error of the given modes, in the same unit; included in that of the result.

    Returns
    -------
    Modes
        At least the modes that the window needs, with a strict bound on the error.
    """
    w, tau = weights, times
    # replacing 1 - exp(-t/tau) by 1 has the error exp(-t/tau), largest at the shortest time
    lost = np.cumsum(w * np.exp(-shortest / tau))
    fast = int(np.searchsorted(lost, tolerance / 2, side="right"))
    instantaneous = instantaneous + float(np.sum(w[:fast]))
    error = error + (float(lost[fast - 1]) if fast else 0.0)
    w, tau = w[fast:], tau[fast:]
    if w.size == 0:
        return Modes(instantaneous, (), (), error)

    def tail(x: Array) -> Array:
        """Return cumulative sums from the slowest mode on."""
        return np.cumsum(x[::-1])

    weight, rate = tail(w), tail(w / tau)
    time = weight / rate
    excess = -weight * np.expm1(-longest / time) - tail(-w * np.expm1(-longest / tau))
    # the excess grows while the mode creeps faster than those it replaces; it is below the weight
    fastest = rate * np.exp(-longest / time)
    growing = fastest * (1 + 1e-12) > tail(w / tau * np.exp(-longest / tau))
    bound = np.where(growing, np.minimum(np.abs(excess), weight), weight)
    bound[0] = 0.0  # one mode replaces itself
    beyond = np.flatnonzero(bound > tolerance / 2)
    slow = int(beyond[0]) if beyond.size else w.size
    return Modes(
        instantaneous=instantaneous,
        weights=(*w[: w.size - slow], weight[slow - 1]),
        times=(*tau[: w.size - slow], time[slow - 1]),
        error=error + float(bound[slow - 1]),
    )
