r"""Independent simulation of an indenter on a bonded layer, for comparison; imports no viscotack.

SI units throughout. The surface moves by the pressure on uniform rings: closed forms of the uniform
disc on a half-space (Love), and for the layer a Hankel integral of what its base changes. The
transfer function is found numerically, by the matrix exponential of Navier's equations through the
thickness. The hereditary integral of the standard solid is summed over all past steps.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import expm
from scipy.special import ellipe, ellipk, j0, j1

# Wave number times thickness beyond which a layer is a half-space, and number of panels up to it.
_LAST, _POINTS = 13.0, 24


@dataclass(frozen=True)
class LennardJonesLaw:
    """Traction of Lennard-Jones, tension positive [Pa], at a gap [m]."""

    work: float
    gap0: float

    def tension(self, gap: Any) -> Any:
        x = self.gap0 / gap
        return 8 * self.work / (3 * self.gap0) * (x**3 - x**9)

    def slope(self, gap: Any) -> Any:
        x = self.gap0 / gap
        return 8 * self.work / (3 * self.gap0**2) * (9 * x**10 - 3 * x**4)

    def beyond(self, gap: float) -> float:
        """Return the work to separate from this gap [J/m^2]."""
        x = self.gap0 / gap
        return 8 * self.work / 3 * (x * x / 2 - x**8 / 8)


def surface_compliance(s: float, poisson_ratio: float) -> float:
    """Return u E*/(2 p) s/b of a bonded layer under p J0(s r/b), 1 on a half-space.

    With u_r = U J1 and u_z = W J0, Navier's equations are linear in (U, W, U', W'); the lower face
    is fixed, the upper one free of shear.
    """
    nu = poisson_ratio
    G, lame = 0.5 / (1 + nu), nu / ((1 + nu) * (1 - 2 * nu))  # E = 1
    P = lame + 2 * G
    matrix = np.array(
        [
            [0, 0, 1, 0],
            [0, 0, 0, 1],
            [P / G * s * s, 0, 0, (lame + G) / G * s],
            [0, G / P * s * s, -(lame + G) / P * s, 0],
        ]
    )
    through = expm(matrix)[:, 2:]  # of U' and W' at the lower face
    shear = through[2] - s * through[1]
    normal = lame * s * through[0] + P * through[3]
    shape = np.linalg.solve(np.array([shear, normal]), np.array([0.0, 1.0]))
    return float(through[1] @ shape) * s / (2 * (1 - nu * nu))


def influence(edges: Any, thickness: float, poisson_ratio: float) -> Any:
    """Return the displacement [m] at ring middles under unit pressures on rings, for E* = 1."""
    r = (edges[1:] + edges[:-1]) / 2
    discs = _disc_on_half_space(r, edges[1:])
    s, weight = _panels(r[-1] / thickness)
    kappa = np.array([surface_compliance(x, poisson_ratio) for x in s])
    xi = s / thickness
    waves = j0(np.multiply.outer(r, xi)) * (2 * (kappa - 1) * weight / thickness / xi)
    discs = discs + waves @ (edges[1:] * j1(np.multiply.outer(xi, edges[1:])))
    return np.diff(discs, axis=1, prepend=0.0)


def _panels(widest: float) -> tuple[Any, Any]:
    nodes, weights = np.polynomial.legendre.leggauss(_POINTS)
    ends = np.linspace(0.0, _LAST, 4 + int(_LAST * widest / 6))
    half = np.diff(ends)[:, None] / 2
    return (ends[:-1, None] + half * (1 + nodes)).ravel(), (half * weights).ravel()


def _disc_on_half_space(r: Any, a: Any) -> Any:
    """Return the displacement at r under unit pressure on discs of radius a, for E* = 1."""
    r, a = r[:, None], a[None, :]
    inside = 4 * a / np.pi * ellipe(np.minimum(r / a, 1) ** 2)
    m = np.minimum(a / r, 1) ** 2
    outside = 4 * r / np.pi * (ellipe(m) - (1 - m) * ellipk(np.minimum(m, 1 - 1e-15)))
    return np.where(r < a, inside, outside)


@dataclass(frozen=True)
class Case:
    """An indenter of this profile that is pulled from rest at a constant speed."""

    rise: Callable[[Any], Any]
    law: LennardJonesLaw
    thickness: float
    poisson_ratio: float
    contact_modulus: float
    depth: float
    speed: float
    # of the standard solid: relaxed over instantaneous modulus, and retardation time
    ratio: float = 1.0
    time: float = 1.0
    # radius of the sphere whose flank acts beyond the mesh; 0 without a flank
    radius: float = 0.0


def pull(case: Case, edges: Any, travel: float) -> tuple[Any, Any]:
    """Return depths and forces [N, compression positive] until the force has risen again.

    The depth falls by equal steps `travel`. In each, Newton's method balances the traction and the
    opening, compliance at once times pressure plus what the past has left.
    """
    B = influence(edges, case.thickness, case.poisson_ratio) / case.contact_modulus
    area = np.pi * np.diff(edges * edges)
    middle = (edges[1:] + edges[:-1]) / 2
    rigid, law = case.rise(middle), case.law
    step = travel / case.speed
    past: list[Any] = []
    depths, forces, depth = [], [], case.depth
    gap = np.maximum(law.gap0 + rigid - depth, law.gap0)
    while True:
        c, left = _heredity(case, step, past)
        free = law.gap0 + rigid - depth + left
        gap = _balanced(B, c, law, free, gap)
        tension = law.tension(gap)
        past.append(-B @ tension)  # displacement into the relaxed solid
        force = -float(area @ tension)
        if case.radius:
            force -= 2 * np.pi * case.radius * law.beyond(float(gap[-1]))
        depths.append(depth)
        forces.append(force)
        if len(forces) > 3 and min(forces) < 0 and force > 0.9 * min(forces):
            return np.array(depths), np.array(forces)
        depth -= travel


def _balanced(B: Any, c: float, law: Any, free: Any, gap: Any) -> Any:
    """Return the gap = free + displacement by the pressure, c B p with p = -tension."""
    for _ in range(200):
        off = gap - free + c * (B @ law.tension(gap))
        jacobian = np.eye(len(gap)) + c * B * law.slope(gap)
        change = -np.linalg.solve(jacobian, off)
        largest = np.max(np.abs(change) / gap)
        gap = gap + change * min(1.0, 0.3 / max(largest, 1e-300))
        if largest < 1e-10:
            return gap
    raise ArithmeticError("no equilibrium")


def _heredity(case: Case, step: float, past: list[Any]) -> tuple[float, Any]:
    """Return the weight of the present relaxed displacement, and the sum over past ones.

    The displacement is k e(t) + int_0^inf (1 - k)/T exp(-s/T) e(t - s) ds, e(t) being that of the
    relaxed solid; e is linear between steps, and before the first one the solid is at rest.
    """
    if not past:
        return 1.0, 0.0  # at rest
    k, x = case.ratio, step / case.time
    n = len(past)
    # weights of int_0^1 exp(-x s) (1 - s, s) x ds on each step
    whole = -np.expm1(-x)
    late = (whole - x * np.exp(-x)) / x
    early = whole - late
    decay = np.exp(-x * np.arange(n))
    weight = np.zeros(n + 1)  # of the states, the present one first
    weight[:-1] += decay * early
    weight[1:] += decay * late
    weight[-1] += np.exp(-x * n)
    weight *= 1 - k
    weight[0] += k
    left = np.tensordot(weight[1:], np.array(past[::-1]), axes=1)
    return float(weight[0]), left


GAP0 = 1e-3


def sphere(
    tabor: float, thickness: float, ratio: float, rate: float, *, spacing: float, travel: float
) -> tuple[Any, Any]:
    """Return depths [h0] and forces [1.5 pi R dg] of a sphere of R = 1, E* = 1 from a depth of h0.

    Thickness and spacing are in beta, the travel of a step in h0, the rate in h0 per retardation
    time.
    """
    work = (tabor * GAP0) ** 1.5
    beta = work ** (1 / 3)
    case = Case(
        rise=lambda r: r * r / 2,
        law=LennardJonesLaw(work, GAP0),
        thickness=thickness * beta,
        poisson_ratio=0.49,
        contact_modulus=1.0,
        depth=GAP0,
        speed=rate * GAP0,
        ratio=ratio,
        radius=1.0,
    )
    depth, force = pull(case, beta * np.arange(0.0, 6.0 + spacing / 2, spacing), travel * GAP0)
    return depth / GAP0, force / (1.5 * np.pi * work)


def disc(tabor: float, thickness: float, *, rings: int, travel: float) -> tuple[Any, Any]:
    """Return depths [h0] and forces of a disc of radius a = 1 on an elastic layer, E* = 1.

    The thickness is in a, the force in 1.5 pi R dg with R = a sqrt(a E*/dg).
    """
    work = (tabor * GAP0) ** 2
    law = LennardJonesLaw(work, GAP0)
    case = Case(np.zeros_like, law, thickness, 0.49, 1.0, depth=0.0, speed=GAP0)
    depth, force = pull(case, np.linspace(0.0, 1.0, rings + 1), travel * GAP0)
    return depth / GAP0, force / (1.5 * np.pi * np.sqrt(work))


def disc_stiffness(thickness: float, rings: int) -> float:
    """Return the force per depth of a rigid disc of radius 1 for E* = 1."""
    edges = 1 - np.linspace(1.0, 0.0, rings + 1) ** 2
    pressure = np.linalg.solve(influence(edges, thickness, 0.49), np.ones(rings))
    return float(pressure @ (np.pi * np.diff(edges * edges)))


def pull_off(depth: Any, force: Any) -> float:
    """Return the largest tension, by a parabola through three steps."""
    i = int(np.argmin(force))
    fit = np.polyfit(depth[i - 1 : i + 2], force[i - 1 : i + 2], 2)
    return -float(np.polyval(fit, -fit[1] / (2 * fit[0])))
