r"""Independent simulation of an indenter on a bonded layer, for comparison; imports no viscotack.

The radius and E* are 1. The surface moves by the pressure on uniform rings: closed forms of the
uniform disc on a half-space (Love), and for the layer a Hankel integral of what its base changes.
The transfer function is found numerically, by the matrix exponential of Navier's equations through
the thickness. The hereditary integral of the standard solid is summed over all past steps.
"""

import numpy as np
from scipy.linalg import expm
from scipy.special import ellipe, ellipk, j0, j1

NU = 0.49
GAP0 = 1e-3  # small beside the radius
# Wave number times thickness beyond which a layer is a half-space, and number of points of a panel.
_LAST, _POINTS = 13.0, 24


def surface_compliance(s, poisson_ratio):
    """Return u E*/(2 p) s/b of a bonded layer under p J0(s r/b), 1 on a half-space.

    With u_r = U J1 and u_z = W J0, Navier's equations are linear in (U, W, U', W'); the lower face
    is fixed, the upper one free of shear.
    """
    nu = poisson_ratio
    G, lame = 0.5 / (1 + nu), nu / ((1 + nu) * (1 - 2 * nu))  # E = 1
    P = lame + 2 * G
    matrix = np.zeros((4, 4))
    matrix[:2, 2:] = np.eye(2)
    matrix[2] = [P / G * s * s, 0, 0, (lame + G) / G * s]
    matrix[3] = [0, G / P * s * s, -(lame + G) / P * s, 0]
    through = expm(matrix)[:, 2:]  # of U' and W' at the lower face
    shear = through[2] - s * through[1]
    normal = lame * s * through[0] + P * through[3]
    shape = np.linalg.solve(np.array([shear, normal]), np.array([0.0, 1.0]))
    return float(through[1] @ shape) * s / (2 * (1 - nu * nu))


def influence(edges, thickness):
    """Return the displacement at ring middles under unit pressures on rings."""
    r = (edges[1:] + edges[:-1]) / 2
    nodes, weights = np.polynomial.legendre.leggauss(_POINTS)
    ends = np.linspace(0.0, _LAST, 4 + int(_LAST * r[-1] / thickness / 6))
    half = np.diff(ends)[:, None] / 2
    s, weight = (ends[:-1, None] + half * (1 + nodes)).ravel(), (half * weights).ravel()
    kappa = np.array([surface_compliance(x, NU) for x in s])
    xi = s / thickness
    waves = j0(np.multiply.outer(r, xi)) * (2 * (kappa - 1) * weight / s)
    discs = _disc_on_half_space(r[:, None], edges[None, 1:])
    discs = discs + waves @ (edges[1:] * j1(np.multiply.outer(xi, edges[1:])))
    return np.diff(discs, axis=1, prepend=0.0)


def _disc_on_half_space(r, a):
    """Return the displacement at r under unit pressure on discs of radius a."""
    inside = 4 * a / np.pi * ellipe(np.minimum(r / a, 1) ** 2)
    m = np.minimum(a / r, 1) ** 2
    outside = 4 * r / np.pi * (ellipe(m) - (1 - m) * ellipk(np.minimum(m, 1 - 1e-15)))
    return np.where(r < a, inside, outside)


def pull(rise, edges, thickness, work, depth, travel, *, duration=0.0, ratio=1.0, flank=False):
    """Return depths and forces from rest until the force has risen again, after its least.

    The depth falls by equal steps `travel`, each of a duration in retardation times; `ratio` is the
    relaxed over the instantaneous modulus. In each, Newton's method balances the traction and the
    opening, compliance at once times pressure plus what the past has left. With a flank the sphere
    goes on beyond the mesh.
    """
    B, area = influence(edges, thickness), np.pi * np.diff(edges * edges)
    rigid = rise((edges[1:] + edges[:-1]) / 2)
    gap, past, depths, forces = np.maximum(GAP0 + rigid - depth, GAP0), [], [], []
    while len(forces) <= 3 or min(forces) >= 0 or forces[-1] <= 0.9 * min(forces):
        c, left = _heredity(ratio, duration, past)
        gap = _balanced(c * B, work, GAP0 + rigid - depth + left, gap)
        pulled = tension(gap, work)
        past.append(-B @ pulled)  # displacement into the relaxed solid
        x = GAP0 / float(gap[-1])
        beyond = 8 * work / 3 * (x * x / 2 - x**8 / 8)  # to separate from the last gap
        forces.append(-float(area @ pulled) - 2 * np.pi * beyond * flank)
        depths.append(depth)
        depth -= travel
    return np.array(depths), np.array(forces)


def tension(gap, work):
    """Return the traction of Lennard-Jones, tension positive."""
    x = GAP0 / gap
    return 8 * work / (3 * GAP0) * (x**3 - x**9)


def _balanced(B, work, free, gap):
    """Return the gap = free + displacement by the pressure, B p with p = -tension."""
    for _ in range(200):
        off = gap - free + B @ tension(gap, work)
        x = GAP0 / gap
        slope = 8 * work / (3 * GAP0**2) * (9 * x**10 - 3 * x**4)
        change = -np.linalg.solve(np.eye(len(gap)) + B * slope, off)
        largest = np.max(np.abs(change) / gap)
        gap = gap + change * min(1.0, 0.3 / max(largest, 1e-300))
        if largest < 1e-10:
            return gap
    raise ArithmeticError("no equilibrium")


def _heredity(k, x, past):
    """Return the weight of the present relaxed displacement, and the sum over past ones.

    The displacement is k e(t) + int_0^inf (1 - k)/T exp(-s/T) e(t - s) ds, e(t) being that of the
    relaxed solid; e is linear between steps of x T, and before the first one the solid is at rest.
    """
    if not past or k == 1:
        return 1.0, 0.0
    # weights of int_0^1 exp(-x s) (1 - s, s) x ds on each step
    whole = -np.expm1(-x)
    late = (whole - x * np.exp(-x)) / x
    decay = np.exp(-x * np.arange(len(past) + 1))
    weight = np.append(decay[:-1] * (whole - late), decay[-1])
    weight[1:] += decay[:-1] * late
    weight *= 1 - k
    return float(weight[0]) + k, np.tensordot(weight[1:], np.array(past[::-1]), axes=1)


def sphere(tabor, thickness, ratio, rate, *, spacing, travel):
    """Return depths [h0] and forces [1.5 pi R dg] of a sphere from a depth of h0.

    Thickness and spacing are in beta, the travel of a step in h0, the rate in h0 per retardation
    time.
    """
    work = (tabor * GAP0) ** 1.5
    beta = work ** (1 / 3)
    edges = beta * np.arange(0.0, 6.0 + spacing / 2, spacing)
    how = {"duration": travel / rate, "ratio": ratio, "flank": True}
    of = (lambda r: r * r / 2), edges, thickness * beta, work, GAP0, travel * GAP0
    depth, force = pull(*of, **how)
    return depth / GAP0, force / (1.5 * np.pi * work)


def disc(tabor, thickness, *, rings, travel):
    """Return depths [h0] and forces of a disc on an elastic layer, its thickness in radii.

    The force is in 1.5 pi R dg with R = a sqrt(a E*/dg).
    """
    work, edges = (tabor * GAP0) ** 2, np.linspace(0.0, 1.0, rings + 1)
    depth, force = pull(np.zeros_like, edges, thickness, work, 0.0, travel * GAP0)
    return depth / GAP0, force / (1.5 * np.pi * np.sqrt(work))


def disc_stiffness(thickness, rings):
    """Return the force per depth of a rigid disc."""
    edges = 1 - np.linspace(1.0, 0.0, rings + 1) ** 2
    pressure = np.linalg.solve(influence(edges, thickness), np.ones(rings))
    return float(pressure @ (np.pi * np.diff(edges * edges)))


def pull_off(depth, force):
    """Return the largest tension, by a parabola through three steps."""
    i = int(np.argmin(force))
    fit = np.polyfit(depth[i - 1 : i + 2], force[i - 1 : i + 2], 2)
    return -float(np.polyval(fit, -fit[1] / (2 * fit[0])))
