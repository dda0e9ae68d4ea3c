r"""The implicit law shared by the theories of a steady viscoelastic crack.

Both theories have the form, for a retardation spectrum of weights w and times tau,

.. math:: \frac{\Delta\gamma_0}{\Delta\gamma_{eff}} = \frac1\Gamma
          = c_\infty + \sum_j w_j \, \psi(A / \tau_j), \quad A = \Gamma \, \tau_0 / s,

with a response psi that rises from 0 to 1 and a dimensionless speed s. At a given A everything
is explicit. As a function of x = ln A, ln Gamma is analytic for \|Im x\| < pi/2, so Chebyshev
polynomials on panels of unit length represent it to round-off; the speed or the amplification is
then inverted on the panels, at a cost independent of the number of modes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.model.materials import Material
from viscotack.theory._checks import Number, Values, at_least, plain

Array = npt.NDArray[np.floating[Any]]
# psi and 1 - psi, each without cancellation
Response = Callable[[Array], tuple[Array, Array]]

# The nearest singularities of a panel lie at pi, in half panels: 6.44^-20 is below round-off.
_DEGREE = 20
_POINTS = np.cos(np.pi * np.arange(_DEGREE, -1, -1) / _DEGREE)
_TO_COEFFICIENTS = np.linalg.inv(np.polynomial.chebyshev.chebvander(_POINTS, _DEGREE))
# A mode faster than A by this factor responds instantaneously; one slower by the second does not.
_FASTER, _SLOWER = 1e-13, 1e9
# Tolerance of the creep, relative to the glassy compliance, which governs fast cracks.
_TOLERANCE = 1e-14
# A over the time of a mode above which the mode has responded; its square must not overflow.
_RESPONDED = 1e150
_BLOCK = 2**18


class Passage(NamedTuple):
    """Cracks with given passage times of the tip; all quantities are explicit.

    Attributes
    ----------
    log_speed : ndarray
        ln of the dimensionless speed.
    log_amplification : ndarray
        ln Gamma.
    log_odds : ndarray
        ln of (Gamma - 1)/(1/k - Gamma), without cancellation at both ends.
    """

    log_speed: Array
    log_amplification: Array
    log_odds: Array


class Theory(NamedTuple):
    """A crack theory: the response of a mode, and s over the dimensionless speed."""

    response: Response
    factor: float

    def passage(self, log_time: Values, *, material: Material) -> Passage:
        """Return the cracks whose tip, of length Gamma l, passes in exp(log_time) time units."""
        y = np.asarray(log_time, dtype=float)
        k = material.modulus_ratio
        glassy, rubbery = _parts(y - np.log(self.factor), material, self.response)
        log_gamma = -np.log(k + glassy)
        with np.errstate(divide="ignore"):
            odds = np.log(k) + np.log(rubbery) - np.log(glassy)
        return Passage(log_gamma - y, log_gamma, odds)

    def amplification_of_passage(
        self, low: float, high: float, *, material: Material
    ) -> Callable[[Array], Array]:
        """Return Gamma as a function of the log_time of :meth:`passage`, in an interval."""
        start, grid = _grid(low - np.log(self.factor), high - np.log(self.factor))
        glassy, _ = _parts(grid, material, self.response)
        coefficients = -np.log(material.modulus_ratio + glassy) @ _TO_COEFFICIENTS.T
        return lambda y: np.exp(_evaluated(y - np.log(self.factor), start, coefficients))

    def amplification(self, speed: Values, *, material: Material) -> Number:
        """Return Gamma at dimensionless speeds, not negative, with s = factor * speed."""
        s = self.factor * at_least(0, "a crack that closes is another problem", speed=speed)
        s = np.asarray(s)
        moving = np.ravel(s[s > 0])
        found = np.ones(s.shape)
        if material.modulus_ratio < 1 and moving.size:
            log = np.log(moving)
            # Gamma lies between 1 and 1/k, and A between 1/s and 1/(k s)
            low, high = -np.max(log), -np.min(log) - np.log(material.modulus_ratio)
            start, grid = _grid(low, high)
            glassy, _ = _parts(grid, material, self.response)
            # from the smaller of the two parts, accurate at both ends
            coefficients = -np.log(material.modulus_ratio + glassy) @ _TO_COEFFICIENTS.T
            falling = _minus_position(coefficients, start)
            found[s > 0] = _in_blocks(
                lambda y: np.exp(_evaluated(_inverted(y, start, falling), start, coefficients)), log
            )
        return plain(found)

    def speed(self, amplification: Values, *, material: Material) -> Number:
        """Return the dimensionless speed at which Gamma is reached, 1 <= Gamma < 1/k."""
        gamma = np.asarray(
            at_least(
                1,
                "the energy of the slowest crack is the work of adhesion",
                amplification=amplification,
            )
        )
        k = material.modulus_ratio
        if np.any(gamma * k >= 1) and np.any(gamma > 1):
            raise InputError(
                f"amplification must be below glassy over rubbery modulus {1 / k:.6g}, reached "
                f"at infinite speed, got {np.max(gamma)}"
            )
        found = np.zeros(gamma.shape)
        above = np.ravel(gamma[gamma > 1])
        if above.size:
            # use the odds of the glassy part, which are steep in x at both ends
            odds = np.log((1 / above - k) / (1 - 1 / above))
            low, high = _bracket(np.min(odds), np.max(odds), material, self.response)
            start, grid = _grid(low, high)
            glassy, rubbery = _parts(grid, material, self.response)
            coefficients = -np.log(glassy / rubbery) @ _TO_COEFFICIENTS.T
            x = _in_blocks(lambda y: _inverted(y, start, coefficients), -odds)
            found[gamma > 1] = above * np.exp(-x) / self.factor
        return plain(found)


def _parts(x: Array, material: Material, response: Response) -> tuple[Array, Array]:
    """Return 1/Gamma - k and 1 - 1/Gamma at x = ln A, A in time units."""
    unit, k = material.time_unit, material.modulus_ratio
    modes = material.retardation_modes(
        shortest=_FASTER * unit * np.exp(np.min(x)),
        longest=_SLOWER * unit * np.exp(np.max(x)),
        tolerance=_TOLERANCE * k,
    )
    w, tau = np.array(modes.weights), np.array(modes.times) / unit
    A = np.exp(np.ravel(x))
    # modes too fast for the window respond instantaneously
    glassy = np.full(A.size, max(modes.instantaneous - k, 0.0))
    rubbery = np.zeros(A.size)
    rows = max(1, _BLOCK // max(1, tau.size))
    for i in range(0, A.size, rows):
        with np.errstate(over="ignore"):
            passed = np.minimum(A[i : i + rows, None] / tau, _RESPONDED)
        done, rest = response(passed)
        glassy[i : i + rows] += done @ w
        rubbery[i : i + rows] = rest @ w
    return glassy.reshape(x.shape), rubbery.reshape(x.shape)


def _in_blocks(function: Callable[[Array], Array], values: Array) -> Array:
    """Evaluate a function of many values in blocks, to limit memory."""
    size = _BLOCK // (_DEGREE + 1)
    return np.concatenate([function(values[i : i + size]) for i in range(0, values.size, size)])


def _bracket(
    least: float, most: float, material: Material, response: Response
) -> tuple[float, float]:
    """Return a bracket of x in which the odds of the glassy part pass both values."""
    low, high = -16.0, 16.0
    while True:
        glassy, rubbery = _parts(np.array([low, high]), material, response)
        with np.errstate(divide="ignore"):
            odds = np.log(glassy) - np.log(rubbery)
        if odds[0] <= least and odds[1] >= most:
            return low, high
        low = 2 * low if odds[0] > least else low
        high = 2 * high if odds[1] < most else high
        if max(-low, high) > 500:
            raise InputError(
                "amplification is reached only at a speed beyond 1e-200 or 1e200; "
                "choose a value farther from 1 and from glassy over rubbery modulus"
            )


def _grid(low: float, high: float) -> tuple[float, Array]:
    """Return the start of the panels and their points, shape (panels, degree + 1)."""
    # margin for round-off in the bounds
    start = low - 0.01
    panels = int(np.ceil(high - low + 0.02))
    return start, start + np.arange(panels)[:, None] + (_POINTS + 1) / 2


def _minus_position(coefficients: Array, start: float) -> Array:
    """Return the coefficients of the function minus x."""
    shifted = coefficients.copy()
    shifted[:, 0] -= start + np.arange(len(coefficients)) + 0.5
    shifted[:, 1] -= 0.5
    return shifted


def _evaluated(x: Array, start: float, coefficients: Array) -> Array:
    panel = np.clip((x - start).astype(int), 0, len(coefficients) - 1)
    z = 2 * (x - start - panel) - 1
    return np.polynomial.chebyshev.chebval(z, np.take(coefficients.T, panel, axis=1), tensor=False)


def _inverted(value: Array, start: float, coefficients: Array) -> Array:
    """Return x at which a function that decreases over all panels has each value."""
    ends = coefficients @ np.polynomial.chebyshev.chebvander(np.array([-1.0, 1.0]), _DEGREE).T
    panel = np.searchsorted(-ends[:, 0], -value, side="right") - 1
    panel = np.clip(panel, 0, len(coefficients) - 1)
    c = np.take(coefficients.T, panel, axis=1)
    slopes = np.polynomial.chebyshev.chebder(c)
    low, high = np.full(value.shape, -1.0), np.full(value.shape, 1.0)
    z = np.zeros(value.shape)
    for _ in range(60):
        rest = np.polynomial.chebyshev.chebval(z, c, tensor=False) - value
        low, high = np.where(rest > 0, z, low), np.where(rest > 0, high, z)
        slope = np.polynomial.chebyshev.chebval(z, slopes, tensor=False)
        with np.errstate(divide="ignore", invalid="ignore"):
            new = z - rest / slope
        # Newton's step where it stays between the bounds, bisection elsewhere
        newton = (new >= low) & (new <= high)
        new = np.where(newton, new, (low + high) / 2)
        # the error after a step of Newton is of the order of its square
        settled = np.abs(new - z) < np.where(newton, 1e-8, 1e-15)
        z = new
        if np.all(settled):
            break
    return start + panel + (z + 1) / 2
