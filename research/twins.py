r"""The plain twins: the published algorithms, slow and obvious, to test the fast solver against.

Appendix V of Maghami, PhD thesis (2025), with the misprints of Eq. 4.13 and 34 corrected: equally
spaced nodes, overlapping triangles by quadrature, a fixed time step, the full hereditary sum and a
dense Newton. Nothing is shared with the fast solver but the statement of the problem. It costs
O(steps^2 nodes + steps nodes^3) and needs several hundred nodes unless the Tabor number is small.

In the thesis's units: r in beta, gap and depth in h0, pressure sigma in dg/(mu h0), time in the
material's unit:

.. math::

    h_i = 1 - \delta + \tfrac12 \mu r_i^2 + u_i, \qquad
    u_i^{(q)} = \mu \sum_j G_{ij} \Big\{\sigma_j^{(0)} +
      \sum_{m=0}^{q-1} \bar C_{q-1-m} \big(\sigma_j^{(m+1)} - \sigma_j^{(m)}\big)\Big\}

with the mean creep compliance of each step,
:math:`\bar C_p = \frac{1}{dt}\int_{t_p}^{t_{p+1}} C\,dt`, which is exact for a pressure that
is linear over the steps.

**The punch**: chapter 3 there. M + 1 equally spaced nodes under the punch, full triangles at the
ends too, without use of the symmetry.

The full end triangles reach beyond the punch, so that M + 1 triangles bear where M would: the
cohesive limit comes out as (M + 1)/M, and every stress too high by about as much.

Lengths are in a0, gap and depth in h0, the pressure p in dg/h0 and positive in compression:

.. math::

    h_i = 1 - \delta + u_i, \qquad u_i^{(q)} = \frac{\pi}{2 \hat\sigma_0^2} \sum_j G_{ij}
      \Big\{p_j^{(0)} + \sum_{m=0}^{q-1} \bar C_{q-1-m} \big(p_j^{(m+1)} - p_j^{(m)}\big)\Big\}

with :math:`\hat\sigma_0 = 16/(9\sqrt3)`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.linalg import toeplitz
from scipy.special import ellipkm1, sici, xlogy

from viscotack.model.geometry import Base
from viscotack.model.materials import Material
from viscotack.model.problem import Case, Groups, Problem
from viscotack.result import Outcome, Result, receding_speed

EDGE_GAP = 3 ** (1 / 6)
_GAUSS, _WEIGHT = np.polynomial.legendre.leggauss(20)
# kappa differs from 1 by exp(-beta) times a square: nothing is left at the end.
_END = 60.0
_S, _DS = (_GAUSS + 1) / 2, _WEIGHT / 2  # on (0, 1)


def kernel(r: npt.NDArray, s: npt.NDArray, distance: npt.NDArray) -> npt.NDArray:
    """Return s G(r, s) of Eq. 4.14 with the exact distance |r - s| passed beside them."""
    large = np.maximum(r, s)
    # 1 - q^2 with q = small/large, from the distance: K is logarithmic where r meets s
    one_minus = distance * (r + s) / large**2
    return 4 / np.pi * s / large * ellipkm1(np.minimum(one_minus, 1.0))


def hat_matrix(nodes: int, spacing: float) -> npt.NDArray:
    """Return G[i, j] of Eq. 30: displacement at node i under triangle j of unit height, E* = 1.

    Triangle 0 is a cone and the last one half a triangle.
    """
    r = spacing * np.arange(nodes)
    G = np.zeros((nodes, nodes))
    rows = r[:, None]
    for j in range(nodes):
        for k in (j - 1, j + 1):  # the two panels of triangle j
            if not 0 <= k < nodes:
                continue
            # s runs from the peak (1) to the foot (0); t^5 crowds points at both logarithms
            for at, other in ((j, k), (k, j)):
                # half panel next to node `at`
                x = 0.5 * _S**5
                dx = 2.5 * _S**4 * _DS
                s = r[at] + (r[other] - r[at]) * x
                height = 1 - x if at == j else x
                distance = np.where(np.arange(nodes)[:, None] == at, spacing * x, np.abs(rows - s))
                G[:, j] += (kernel(rows, s[None, :], distance) * (height * dx)).sum(1) * spacing
    return G


def mean_compliance(material: Material, step: float, count: int) -> npt.NDArray:
    """Return the mean of E0 C(t) over each of `count` steps."""
    start = step * np.arange(count)[:, None]
    x, dx = np.tile(_S, (count, 1)), np.tile(_DS, (count, 1))
    x[0], dx[0] = _S**5, 5 * _S**4 * _DS  # C rises like t^n at first
    creep = np.asarray(material.creep(start + step * x)) * material.rubbery_modulus
    return (creep * dx).sum(axis=1)


def lennard_jones(gap: npt.NDArray, tabor: float) -> tuple[npt.NDArray, npt.NDArray]:
    """Return sigma and its derivative by the gap, Eq. 32; compression positive."""
    sigma = -8 / 3 * tabor * (gap**-3 - gap**-9)
    return sigma, -8 / 3 * tabor * (-3 * gap**-4 + 9 * gap**-10)


def newton(
    matrix: npt.NDArray, free: npt.NDArray, tabor: float, gap: npt.NDArray, most: int
) -> npt.NDArray:
    """Solve gap = free + matrix sigma(gap) and return the gap."""
    for _ in range(most):
        sigma, slope = lennard_jones(gap, tabor)
        residual = gap - free - matrix @ sigma
        change = np.linalg.solve(np.eye(len(gap)) - matrix * slope, -residual)
        # Keep the gaps positive and the steps modest: the ninth power explodes.
        part = min(1.0, 0.3 / max(np.max(-change / gap), 1e-300), 1.0 / np.max(np.abs(change)))
        gap = gap + part * change
        if part == 1.0 and np.max(np.abs(change)) < 1e-9:
            return gap
    raise ArithmeticError(f"Newton did not converge in {most} iterations")


def _jkr_gap(r: npt.NDArray, tabor: float, depth: float) -> npt.NDArray:
    """Return the gap of the JKR contact at this depth, from which Newton starts."""
    a = np.linspace((np.pi / 8) ** (1 / 3), 60.0, 200_000)
    a = a[np.argmin(np.abs(tabor * (a * a - np.sqrt(2 * np.pi * a)) - depth))]
    x = np.maximum(r / a, 1.0)
    hertz = a * a / np.pi * (np.sqrt(x * x - 1) + (x * x - 2) * np.arccos(1 / x))
    return 1 + tabor * (hertz + np.sqrt(2 * np.pi * a) * 2 / np.pi * np.arccos(1 / x))


def plain_sphere(
    problem: Problem | Groups, *, nodes: int, outer_radius: float, steps: int, last_depth: float
) -> Result:
    """Simulate the retraction of a sphere with the published algorithm: see :func:`retract`.

    The nodes are equally spaced from 0 to `outer_radius` [beta], beyond which the force of the tail
    is added; the thesis takes 500.
    """
    groups = problem.groups()
    start: Any = groups.start
    mu, depth = groups.tabor, start.depth
    r = np.linspace(0.0, outer_radius, nodes)
    G = mu * hat_matrix(nodes, r[1])
    ring = np.pi * r[1] * 2 * r
    ring[0], ring[-1] = np.pi * r[1] ** 2 / 3, np.pi * r[1] * (r[-1] - r[1] / 3)
    return retract(
        problem,
        depth=depth,
        matrix=G,
        base=1 + 0.5 * mu * r * r,
        tabor=mu,
        guess=_jkr_gap(r, mu, depth),
        force=lambda sigma, gap: _force(ring, sigma, gap),
        edge=lambda gap: _edge(r, gap),
        edge_unit=np.pi ** (1 / 3),
        steps=steps,
        last_depth=last_depth,
    )


def retract(
    problem: Case,
    *,
    depth: float,
    matrix: npt.NDArray,
    base: npt.NDArray,
    tabor: float,
    guess: npt.NDArray,
    force: Callable[[npt.NDArray, npt.NDArray], float],
    edge: Callable[[npt.NDArray], float],
    edge_unit: float,
    steps: int,
    last_depth: float,
) -> Result:
    """March from a relaxed depth to the last one [h0] in equal steps: the loop of Appendix V.

    The problem starts by depth and has a Lennard-Jones law. The result ends early just past the
    first minimum of the force, where a jump may follow: a larger second peak of a fast deep pull is
    not seen. A status "stopped" means that Newton's method failed.

    Displacement [h0] is `matrix` times sigma, `base` the gap [h0] at depth zero, `guess` the gap
    from which the first Newton starts; `force` tells the force of sigma and gap, `edge` the contact
    edge, of which speeds count `edge_unit` each.
    """
    groups = problem.groups()
    rate_of_drive = groups.rate
    assert rate_of_drive is not None
    dt = (depth - last_depth) / rate_of_drive / steps
    C = mean_compliance(groups.material, dt, steps)

    gap = newton(matrix, base - depth, tabor, guess, 200)
    first = sigma = lennard_jones(gap, tabor)[0]
    changes = np.zeros((steps, len(gap)))
    times, depths, forces, edges = [0.0], [depth], [force(sigma, gap)], [edge(gap)]
    status = f"{Outcome.IN_CONTACT} at the end of the travel"
    lowest, rate = 0, np.zeros(len(gap))
    for q in range(1, steps + 1):
        depth -= rate_of_drive * dt
        past = first + C[q - 1 : 0 : -1] @ changes[: q - 1] if q > 1 else first
        predicted = np.maximum(gap + rate, 0.7 * gap)
        free = base - depth + matrix @ (past - C[0] * sigma)
        try:
            found = newton(C[0] * matrix, free, tabor, predicted, 30)
        except (ArithmeticError, np.linalg.LinAlgError) as failure:
            status = f"{Outcome.STOPPED} because {failure} at depth {depth:.4g} h0; take more steps"
            break
        rate, gap = found - gap, found
        new = lennard_jones(gap, tabor)[0]
        changes[q - 1], sigma = new - sigma, new
        times.append(q * dt)
        depths.append(depth)
        forces.append(force(sigma, gap))
        edges.append(edge(gap))
        lowest = q if forces[q] < forces[lowest] else lowest
        if q > lowest + 2 and forces[lowest] < 0 and forces[q] > 0.9 * forces[lowest]:
            status = f"{Outcome.IN_CONTACT} just past the pull-off"
            break
    return Result(
        problem=problem,
        time=np.array(times),
        depth=np.array(depths),
        force=np.array(forces),
        contact_radius=np.array(edges),
        edge_speed=edge_unit * receding_speed(times, edges),
        status=status,
    )


def _force(ring: npt.NDArray, sigma: npt.NDArray, gap: npt.NDArray) -> float:
    """Return the force [1.5 pi R dg0]; the tail beyond the last node is (8/3)/gap^2 in pi R dg0."""
    return float(2 * (ring @ sigma) / (2 * np.pi) - 8 / 3 / gap[-1] ** 2) / 1.5


def _edge(r: npt.NDArray, gap: npt.NDArray) -> float:
    """Return the contact radius [(pi R^2 dg/E0*)^(1/3)], nan without an edge."""
    return float("nan") if gap[-1] < EDGE_GAP else crossing(r, gap) / np.pi ** (1 / 3)


def crossing(place: npt.NDArray, gap: npt.NDArray) -> float:
    """Return where the gap last passes that of the largest tension; nan where it never does."""
    below = np.flatnonzero(gap < EDGE_GAP)
    if len(below) == 0:
        return float("nan")
    i = below[-1]
    if i == len(place) - 1:
        return float(place[-1])
    share = (EDGE_GAP - gap[i]) / (gap[i + 1] - gap[i])
    return float(place[i] + share * (place[i + 1] - place[i]))


def triangle_matrix(triangles: int, size: float, thickness: float, base: Base) -> npt.NDArray:
    r"""Return G[i, j], displacement at node i under triangle j of unit pressure, E* = 1.

    .. math:: G_{ij} = -\frac{4 b}{\pi} \left[ I_{A0} + I_A(i-j) + 4 z I_{AR}(i-j) \right],
              \quad z = \frac{a}{2 b M}

    Eq. 3.19 to 3.22, of the other sign: compression is positive. The ratio of hyperbolic functions
    there is minus the base's transfer function at beta/2.
    """
    M, z = triangles, size / (2 * thickness * triangles)
    beta, weight = _panels(0.0, 1.0, 1)
    head = base.transfer(beta / 2) * np.sin(beta * z) ** 2 / beta**3 @ weight
    # beyond 1 the transfer function is taken off and put back: an integral in closed form
    w = 2 * z
    tail = ((1 - np.cos(w)) / 2 + w / 2 * (np.sin(w) - w * sici(w)[1])) / 2
    beta, weight = _panels(1.0, _END, 60)
    tail -= (1 - base.transfer(beta / 2)) * np.sin(beta * z) ** 2 / beta**3 @ weight
    first = -2 / z * (head + tail)
    j = np.arange(M + 1)
    # the panels follow the oscillation
    beta, weight = _panels(0.0, _END, 60 + int(_END * z * M / 5))
    decaying = weight * (1 - base.transfer(beta / 2)) * np.sin(beta * z) ** 2 / beta**3
    second = -4 / z * np.array([decaying @ np.sin(beta * z * n) ** 2 for n in j])
    half_plane = (
        xlogy((j + 1) ** 2, j + 1) + xlogy((j - 1) ** 2, np.abs(j - 1)) - 2 * xlogy(j * j, j)
    ) / 4
    return toeplitz(-4 * thickness / np.pi * (first + second + 4 * z * half_plane))


def _panels(low: float, high: float, count: int) -> tuple[npt.NDArray, npt.NDArray]:
    """Return Gauss points and weights on `count` equal panels."""
    edges = np.linspace(low, high, count + 1)
    half = np.diff(edges)[:, None] / 2
    return (edges[:-1, None] + half * (1 + _GAUSS)).ravel(), (half * _WEIGHT).ravel()


def plain_punch(problem: Case, *, triangles: int, steps: int, last_depth: float) -> Result:
    """Simulate the retraction of a punch with the published algorithm: see :func:`retract`.

    `triangles` is M, the spacings under the punch; the thesis takes 200.
    """
    groups = problem.groups()
    start: Any = groups.start
    strength = groups.traction.strength
    punch: Any = groups.geometry
    layer: Any = groups.body
    size = punch.half_width
    x = np.linspace(-size, size, triangles + 1)
    G = triangle_matrix(triangles, size, layer.thickness, layer.base)
    return retract(
        problem,
        depth=start.depth,
        matrix=G * (np.pi / (2 * strength**2)),
        base=np.ones(len(x)),
        tabor=1.0,
        guess=np.ones(len(x)),
        force=lambda p, _: float(p.sum()) / (triangles * strength),
        edge=lambda gap: crossing(x, gap),
        edge_unit=1.0,
        steps=steps,
        last_depth=last_depth,
    )
