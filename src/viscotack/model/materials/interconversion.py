r"""Exact interconversion of sums of exponentials: modulus to compliance and back.

The modulus of a Prony series is a rational function whose zeros alternate with its
poles on the negative real axis: the zeros are the retardation rates, the poles the relaxation
rates (Gross, Mathematical Structure of the Theories of Viscoelasticity, 1953).
Nothing is fitted: each zero is computed to round-off in its own interval.
"""

import numpy as np

from viscotack.arrays import Array


def reciprocal(floor: float, weights: Array, poles: Array) -> tuple[Array, Array]:
    r"""Compute the partial fractions of the reciprocal of a sum of exponentials.

    .. math::

        f(x) = f_0 + \sum_i g_i \frac{x}{x - p_i} , \qquad
        \frac{1}{f(x)} = \frac{1}{f(\infty)} + \sum_j c_j \frac{z_j}{z_j - x} , \qquad
        0 < z_1 < p_1 < z_2 < p_2 < \dots

    With x = -s and p the relaxation rates, f is the modulus of a Prony series, floor its rubbery
    modulus, and (z, c) are the retardation rates and their compliances. With x = -1/s and p the
    retardation times, f is a compliance, floor its glassy value, and (z, c) are the relaxation
    times and their moduli. Both cases use the same algebra.

    Parameters
    ----------
    floor : float
        f(0), positive.
    weights : ndarray, shape (N,)
        g, positive, in the unit of floor.
    poles : ndarray, shape (N,)
        p, positive, strictly ascending.

    Returns
    -------
    weights : ndarray, shape (N,)
        c, positive, in the inverse unit of floor; sum(c) = 1/floor - 1/(floor + sum(g)).
    zeros : ndarray, shape (N,)
        z, in the unit of the poles, ascending.

    Notes
    -----
    Each zero is written as z = p_a + D s(w) = p_b - D s(-w), between its poles p_a and p_b at
    distance D, with s the logistic function: both distances are exact to round-off, however
    close the zero is to a pole. There f/x = P(w) - Q(w), two sums of positive terms, and
    ln P - ln Q falls from +inf to -inf with a slope between -1 and 0, -1 at both ends: Newton's
    method needs 5 to 10 steps for all zeros together. The weights are sums of positive terms as
    well. Measured: f(x) (1/f)(x) = 1 on the imaginary axis to 3e-15 for the 400 nodes of a power
    law, and to 4e-14 for up to 60 random poles over 25 decades with weights over 14 decades.

    Examples
    --------
    A standard solid of 1 MPa and 9 MPa with a relaxation time of 0.1 s has a retardation time of 1
    s:

    >>> compliance, rate = reciprocal(1e6, np.array([9e6]), np.array([1 / 0.1]))
    >>> f"{compliance[0]:.3g} 1/Pa in {1 / rate[0]:.3g} s"
    '9e-07 1/Pa in 1 s'
    """
    # f(x)/x has an additional pole at x = 0, with weight floor
    p = np.concatenate(([0.0], poles))
    g = np.concatenate(([floor], weights))
    below = np.tri(p.size - 1, p.size, dtype=bool)  # [j, i]: pole i lies below zero j
    offset = np.abs(p - np.where(below, p[:-1, None], p[1:, None]))
    width = np.diff(p)

    def distances(w: Array) -> tuple[Array, Array, Array, Array]:
        """Return s(w), s(-w), and the distances of each zero to its two poles and to every pole."""
        up, down = 1 / (1 + np.exp(-w)), 1 / (1 + np.exp(w))
        near = np.where(below, (width * up)[:, None], (width * down)[:, None])
        return up, down, near, offset + near

    def split(terms: Array) -> tuple[Array, Array]:
        """Return the sums over the poles below and over those above each zero."""
        return np.einsum("ji,ji->j", terms, below), np.einsum("ji,ji->j", terms, ~below)

    w = np.zeros(width.size)
    low, high = np.full(w.size, -600.0), np.full(w.size, 600.0)
    for _ in range(100):
        up, down, near, far = distances(w)
        terms = g / far
        P, Q = split(terms)
        F = np.log(P / Q)
        terms *= near / far
        steep_P, steep_Q = split(terms)
        # the slope is at most 1, so the zero is at least F away
        low, high = np.where(F > 0, w + F, low), np.where(F > 0, high, w + F)
        new = w + F / (down * steep_P / P + up * steep_Q / Q)
        slack = 1e-9 * (1 + np.abs(w))  # rounding may put a found zero just outside its bracket
        new = np.where((new > low - slack) & (new < high + slack), new, (low + high) / 2)
        change = np.max(np.abs(new - w) / (1 + np.abs(w)))
        w = new
        if change < 1e-9:  # quadratic convergence
            break

    up, down, _, far = distances(w)
    zeros = np.where(w < 0, p[:-1] + width * up, p[1:] - width * down)
    with np.errstate(over="ignore"):  # a zero at its pole has no weight
        return 1 / np.sum(g * (zeros[:, None] / far) ** 2, axis=1), zeros
