r"""Steady crack by a Galerkin method in the half-plane, in logarithmic polar coordinates.

A second formulation of the steady crack: nothing of the package is used. The relaxed solid is
replaced by a harmonic function phi in the half-plane y > 0, whose boundary value is the opening e
and whose traction is :math:`\sigma = \tfrac12 \partial \phi/\partial y`. With :math:`z = e^{u + i
\theta}` Laplace's equation keeps its form, so

.. math:: \int \int (\phi_u v_u + \phi_\theta v_\theta) \, du \, d\theta
          + 2 \int v \, \sigma(1 + w) \, dx = 0

for every test function v, with quadratic elements in u and one element of high degree in theta.
The opening w of the viscoelastic solid lags behind e along the boundary, :math:`w = c e + \sum
w_j d_j`, :math:`l_j d_j' = e - d_j`. At the outer radius :math:`\phi = A \sqrt\rho
\cos(\theta/2)`; the energy is :math:`\Gamma = \pi A^2/16`. Gaps are in h0, lengths in E0* h0^2/dg,
stresses in dg/h0. A mesh from 1e-3 to 1e6 needs some hundred elements, because the radii are
geometric; so the same equations hold for a closing crack, whose memory comes from the open side.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
import scipy

LEAST_RADIUS, LARGEST_RADIUS = 1e-3, 1e6
# Gap at the origin: half of the work of the Lennard-Jones law is done.
_CLOSE, _ROUNDS, _LEAST_GAP = 1e-9, 60, 0.6
# A mode shorter than this part of the least element has no memory, one longer than this many meshes
# does not creep on them.
_SHORT, _LONG = 1e-3, 1e4
# Parts of this law in the laws that lead to its elastic crack.
# Slowest crack times the mean retardation time, and the least step in decades.
_SLOWEST, _LEAST_STEP = 0.01, 0.01
_PARTS = (0.0, 0.2, 0.5, 0.8, 1.0)


def lennard_jones(gap):
    """Return traction and stiffness of the 3-9 law at gaps [h0]."""
    third = gap**-3.0
    return 8 / 3 * (third - third**3), 8 / 3 * (9 * third**3 - 3 * third) / gap


def _mixed(part):
    """Return a law between w e^-w, with which the iteration starts, and Lennard-Jones."""

    def law(gap):
        traction, stiffness = lennard_jones(gap)
        w = gap - 1
        return (
            part * traction + (1 - part) * w * np.exp(-w),
            part * stiffness + (1 - part) * (1 - w) * np.exp(-w),
        )

    return law


def half_gap():
    """Return the gap at which half of the work of adhesion is done."""
    # the work from h to infinity is (4 h^-2 - h^-8)/3
    return scipy.optimize.brentq(lambda h: (4 * h**-2 - h**-8) / 3 - 0.5, 1.0, 9.0)


class Crack(NamedTuple):
    """One crack: energy, far amplitude, and position, gap and traction along the boundary."""

    energy: float
    amplitude: float
    position: np.ndarray
    gap: np.ndarray
    traction: np.ndarray
    elastic: np.ndarray


class Boundary(NamedTuple):
    """Boundary nodes in ascending order, weights dx, Schur complement, and two loads.

    ``load`` is that of a far field of amplitude 1, ``load_next`` that of the next one,
    rho^(3/2) cos(3 theta/2).
    """

    x: np.ndarray
    weight: np.ndarray
    matrix: np.ndarray
    load: np.ndarray
    load_next: np.ndarray


def _lobatto(n):
    """Return Gauss-Lobatto nodes on [-1, 1] and the stiffness and mass matrices of their basis."""
    inner = np.polynomial.legendre.Legendre.basis(n - 1).deriv().roots()
    nodes = np.concatenate([[-1.0], np.sort(np.real(inner)), [1.0]])
    points, weights = np.polynomial.legendre.leggauss(n + 1)
    vandermonde = np.polynomial.legendre.legvander(nodes, n - 1)
    to_legendre = np.linalg.inv(vandermonde)
    at = np.polynomial.legendre.legvander(points, n - 1) @ to_legendre
    slopes = np.stack(
        [
            np.polynomial.legendre.legval(points, np.polynomial.legendre.legder(c))
            for c in np.eye(n)
        ],
        axis=1,
    )
    slope = slopes @ to_legendre
    return nodes, slope.T @ (weights[:, None] * slope), at.T @ (weights[:, None] * at)


@lru_cache(maxsize=6)
def boundary(elements, degree, largest=LARGEST_RADIUS):
    """Eliminate the interior: return the equations of the boundary nodes."""
    u = np.linspace(np.log(LEAST_RADIUS), np.log(largest), 2 * elements + 1)
    h = 2 * (u[1] - u[0])
    stiff1 = np.array([[7, -8, 1], [-8, 16, -8], [1, -8, 7]]) / (3 * h)
    mass1 = np.array([[4, 2, -1], [2, 16, 2], [-1, 2, 4]]) * h / 30
    size = u.size
    stiff, mass, simpson = np.zeros((size, size)), np.zeros((size, size)), np.zeros(size)
    for i in range(0, size - 1, 2):
        stiff[i : i + 3, i : i + 3] += stiff1
        mass[i : i + 3, i : i + 3] += mass1
        simpson[i : i + 3] += np.array([1, 4, 1]) * h / 6
    nodes, stiff_t, mass_t = _lobatto(degree + 1)
    half = np.pi / 2
    full = scipy.sparse.kron(scipy.sparse.csr_matrix(stiff), half * mass_t)
    full = (full + scipy.sparse.kron(scipy.sparse.csr_matrix(mass), stiff_t / half)).tocsc()
    theta = half * (nodes + 1)
    index = np.arange(size * theta.size).reshape(size, theta.size)
    far = index[-1]
    # theta = pi is the negative side; ascending in x
    edge = np.concatenate([index[-2::-1, -1], index[:-1, 0]])
    inside = index[:-1, 1:-1].ravel()
    radius = np.exp(u)
    outer = np.sqrt(radius[-1]) * np.cos(theta / 2)
    outer = np.column_stack([outer, radius[-1] ** 1.5 * np.cos(1.5 * theta)])
    solve = scipy.sparse.linalg.splu(full[inside][:, inside])
    coupling = full[edge][:, inside]
    right = np.column_stack([full[inside][:, edge].toarray(), full[inside][:, far] @ outer])
    eliminated = coupling @ solve.solve(right)
    matrix = full[edge][:, edge].toarray() - eliminated[:, :-2]
    load = full[edge][:, far] @ outer - eliminated[:, -2:]
    weight = (radius * simpson)[:-1]
    # the half-disc inside the least radius carries the traction of its edge
    weight[0] += LEAST_RADIUS
    return Boundary(
        np.concatenate([-radius[-2::-1], radius[:-1]]),
        np.concatenate([weight[::-1], weight]),
        matrix,
        *load.T,
    )


def memory(x, instantaneous, modes, speed):
    """Return the matrix from e to w for material that passes with a speed, of either sign.

    ``modes`` are pairs of weight and retardation time. The delayed part of each mode is exact for e
    that is linear between nodes, and zero where the material enters.
    """
    if speed == 0:
        return np.eye(x.size)
    if speed < 0:
        # the material comes from the other end
        return memory(-x[::-1], instantaneous, modes, -speed)[::-1, ::-1]
    distance, steps = np.maximum(x[:, None] - x, 0.0), np.diff(x)
    total = instantaneous * np.eye(x.size)
    for weight, time in modes:
        length = speed * time
        if length < _SHORT * steps.min():
            total[np.diag_indices(x.size)] += weight
            continue
        if length > _LONG * distance[-1, 0]:
            total[:, 0] += weight
            continue
        ratio = steps / length
        mean = np.where(ratio < 1e-6, 1 - ratio / 2, -np.expm1(-ratio) / np.maximum(ratio, 1e-30))
        decay = np.tril(np.exp(-np.minimum(distance / length, 500.0)))
        total[:, 1:] += weight * decay[:, 1:] * (1 - mean)
        total[:, :-1] += weight * decay[:, 1:] * (mean - np.exp(-ratio))
        # slow relative to the outer radius: fully crept where it enters
        total[:, 0] += weight * decay[:, 0]
    return total


def _solved(edge, lag, guess, pinned, law=lennard_jones):
    """Solve the balance by a damped Newton method; None if it does not converge."""
    n = edge.x.size
    middle = n // 2
    matrix = np.zeros((n + 1, n + 1))
    matrix[n, :n] = lag[middle]

    def state(y):
        gap = 1 + lag @ y[:-1]
        traction, stiffness = law(np.maximum(gap, _LEAST_GAP / 2))
        balance = edge.matrix @ y[:-1] + edge.load * y[-1] + 2 * edge.weight * traction
        return gap, traction, stiffness, np.append(balance, gap[middle] - pinned)

    y = guess.copy()
    gap, traction, stiffness, rest = state(y)
    for _ in range(_ROUNDS):
        matrix[:n, :n] = edge.matrix + (2 * edge.weight * stiffness)[:, None] * lag
        matrix[:n, n] = edge.load
        step = np.linalg.solve(matrix, -rest)
        part = 1.0
        while True:
            found = state(y + part * step)
            if found[0].min() > _LEAST_GAP or part < 1e-3:
                break
            part /= 2
        y = y + part * step
        gap, traction, stiffness, rest = found
        if np.max(np.abs(part * step[:-1]) / (1 + np.abs(y[:-1]))) < _CLOSE and part == 1:
            return y, gap, traction
    return None


class Solid(NamedTuple):
    """Creep of a solid: instantaneous compliance, and pairs of weight and retardation time."""

    instantaneous: float
    modes: tuple

    @staticmethod
    def standard(modulus_ratio):
        """Return a standard solid whose retardation time is the unit of time."""
        return Solid(modulus_ratio, ((1 - modulus_ratio, 1.0),))

    @staticmethod
    def power_law(modulus_ratio, exponent, *, step=0.4, shortest=-30.0):
        """Return a solid with the retardation spectrum tau^n e^-tau/Gamma(n) per ln tau.

        The trapezoidal rule in ln tau, whose error falls as exp(-pi^2/step).
        """
        y = np.arange(shortest, 4.0, step)
        weights = step * np.exp(exponent * y - np.exp(y) - scipy.special.gammaln(exponent))
        return Solid(
            modulus_ratio + (1 - modulus_ratio) * (1 - weights.sum()),
            tuple(zip((1 - modulus_ratio) * weights, np.exp(y), strict=True)),
        )


def cracks(solid, speeds, *, elements=160, degree=18, step=0.2, largest=LARGEST_RADIUS):
    """Return the cracks at speeds of one sign, ascending in magnitude [E0* h0^2/(dg tau)].

    The cracks are followed from the elastic one in steps of ``step`` decades.
    """
    edge = boundary(elements, degree, largest)
    pinned = half_gap()
    x = edge.x
    amplitude = 4 / np.sqrt(np.pi)
    real, width = (pinned - 1) / amplitude, 0.5
    z = x + real**2 - (width / (2 * real)) ** 2 + 1j * width
    guess = np.append(amplitude * np.real(np.sqrt(z)), amplitude)
    for part in _PARTS:
        found = _solved(edge, np.eye(x.size), guess, pinned, _mixed(part))
        if found is None:
            raise RuntimeError("no elastic crack was found")
        guess = found[0]
    results = []
    # the energy of the slowest cracks grows as the speed times the mean retardation time
    mean = sum(weight * time for weight, time in solid.modes)
    at = np.log10(_SLOWEST / mean) if mean > 0 else 0.0
    for speed in speeds:
        if speed == 0 or solid.instantaneous == 1:
            results.append(_crack(edge, found))
            continue
        aim, now = np.log10(abs(speed)), step
        if not results or at > aim:
            at = min(at, aim) - step
        while at < aim:
            nearer = min(at + now, aim)
            lag = memory(x, solid.instantaneous, solid.modes, np.sign(speed) * 10.0**nearer)
            next_one = _solved(edge, lag, found[0], pinned)
            if next_one is None:
                now /= 2
                if now < _LEAST_STEP:
                    raise RuntimeError(f"no crack was found beyond a speed of {10.0**at:.4g}")
                continue
            at, found, now = nearer, next_one, min(1.5 * now, step)
        results.append(_crack(edge, found))
    return results


def _crack(edge, found):
    y, gap, traction = found
    amplitude = float(y[-1])
    return Crack(np.pi * amplitude**2 / 16, amplitude, edge.x, gap, traction, y[:-1])
