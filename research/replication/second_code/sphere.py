r"""Pull-off of a sphere by a Galerkin method in Abel's variable, with the law on a graded mesh.

A second formulation of the round contact: no elliptic integrals and nothing of the package. With
:math:`b(s) = \int_s^\infty t \, \sigma(t) \, dt/\sqrt{t^2 - s^2}` the tensions raise the relaxed
surface by :math:`u(r) = \frac4\pi \int_0^r b(s) \, ds/\sqrt{r^2 - s^2}` over E0*, so that the
matrix of linear elements is :math:`\frac4\pi B^T W B`. The opening of the relaxed solid is
:math:`e = r^2/2 - D - u`, the gap :math:`h_0 + w`, and w lags behind e for an edge that recedes at
a steady speed.

The contact is sought for a given place of the edge, where half of the work of adhesion is done, so
its unknowns are e and the depth D. The pull-off is the largest tension over all places: an elastic
contact needs no steps in time. With a speed the contact is quasi-steady: each place has the memory
of a crack that came at this speed, and D is the hereditary depth. Lengths along the surface are in
beta, heights in beta^2/R, forces in R dg, speeds as in :mod:`.half_plane`.
"""

import numpy as np
import scipy

from .half_plane import Solid, half_gap, lennard_jones, memory

# Spacing at the edge over the zone, growth of the elements, largest radius over the contact's.
SPACING, GROWTH, OUTER = 0.06, 0.07, 30.0
_GAUSS, _ROUNDS, _CLOSE, _LEAST_GAP = 4, 80, 1e-10, 0.6
# Of the march: tolerance of a gap [h0], largest way of the edge in a step [spacings], and largest
# step of the depth.
_MARCHED, _MOVED, _LARGEST_STEP = 1e-7, 3.0, 0.05
# Places of the edge around the guess, for the parabola through the largest tension.
_PLACES = (-0.12, -0.04, 0.04, 0.12)


def mesh(edge, zone, *, refined=1.0):
    """Return radii from 0 outwards, finest at the edge."""
    spacing, growth = SPACING * zone / refined, GROWTH / refined
    inner, outer = [0.0], [0.0]
    while inner[-1] < edge:
        inner.append(inner[-1] + np.hypot(spacing, growth * inner[-1]))
    while outer[-1] < OUTER * edge:
        outer.append(outer[-1] + np.hypot(spacing, growth * outer[-1]))
    inside = edge * (1 - np.array(inner[:0:-1]) / inner[-1])
    return np.concatenate([inside, edge + np.array(outer)]), len(inner) - 1


def operator(r):
    """Return the matrix from tensions at the nodes to the rise of the surface, and the masses."""
    points, weights = np.polynomial.legendre.leggauss(_GAUSS)
    half = np.diff(r)[:, None] / 2
    s = (r[:-1, None] + half * (1 + points)).ravel()
    w = (half * weights).ravel()
    # over q = sqrt(t^2 - s^2), in which t is smooth; differences of radii without cancellation
    dr, low = np.diff(r), np.maximum(r[:-1], s[:, None])
    high = np.maximum(r[1:], s[:, None])
    first, last = (np.sqrt((x - s[:, None]) * (x + s[:, None])) for x in (low, high))
    B = np.zeros((s.size, r.size))
    for point, weight in zip(points, weights, strict=True):
        q = first + (last - first) / 2 * (1 + point)
        t = np.sqrt(q**2 + s[:, None] ** 2)
        beyond = (q - first) * (q + first) / (t + low) + (low - r[:-1])
        part = weight * (last - first) / 2
        B[:, 1:] += part * beyond / dr
        B[:, :-1] += part * (1 - beyond / dr)
    mass = np.zeros(r.size)
    mass[1:] += dr * (r[:-1] + 2 * r[1:]) / 6
    mass[:-1] += dr * (2 * r[:-1] + r[1:]) / 6
    return 4 / np.pi * (B.T * w) @ B / mass[:, None], mass


def pull_off(tabor, *, solid=None, speed=0.0, energy=1.0, refined=1.0):
    """Return the largest tension over 1.5 pi, elastic or of an edge of a steady speed.

    ``energy`` is that of the plane crack at this speed, which sets the mesh and the first guess.
    """
    guess = (9 * np.pi * energy / 8) ** (1 / 3)
    edge = guess * (1 + np.array(_PLACES))
    tension = [_tension(tabor, at, solid, speed, energy, refined) for at in edge]
    curve = np.polynomial.Polynomial.fit(edge, tension, 3)
    turns = np.real(curve.deriv().roots())
    best = turns[np.argmin(np.abs(turns - guess))]
    return curve(best) / (1.5 * np.pi)


def _tension(tabor, edge, solid, speed, energy, refined):
    """Return the tension for a place of the edge."""
    zone = energy / tabor**2
    r, middle = mesh(edge, zone, refined=refined)
    rise, mass = operator(r)
    solid = Solid(1.0, ()) if solid is None else solid
    lag = memory(r * tabor**2, solid.instantaneous, solid.modes, speed)
    pinned, n = half_gap(), r.size
    opening, depth = _jkr(r, edge, energy)
    e = opening + (pinned - 1) / tabor * np.exp(-(((r - edge) / zone) ** 2))
    matrix = np.zeros((n + 1, n + 1))
    matrix[n, :n] = lag[middle] * tabor
    for _ in range(_ROUNDS):
        gap = 1 + tabor * (lag @ e)
        traction, stiffness = lennard_jones(np.maximum(gap, _LEAST_GAP / 2))
        rest = np.append(e - r**2 / 2 + depth + rise @ (tabor * traction), gap[middle] - pinned)
        matrix[:n, :n] = np.eye(n) + rise @ ((tabor**2 * stiffness)[:, None] * lag)
        matrix[:n, n] = 1.0
        step = np.linalg.solve(matrix, -rest)
        part = 1.0
        while np.min(1 + tabor * (lag @ (e + part * step[:n]))) < _LEAST_GAP and part > 1e-3:
            part /= 2
        e, depth = e + part * step[:n], depth + part * step[n]
        if part == 1 and np.max(np.abs(step[:n])) * tabor < _CLOSE:
            return 2 * np.pi * float(mass @ (tabor * traction))
    raise RuntimeError(f"no contact was found with its edge at {edge:.4g} at {tabor:g}")


def _jkr(r, edge, energy=1.0):
    """Return opening and depth of the contact without range: Hertz's shape, JKR's opening."""
    j = np.sqrt(2 * np.pi * edge * energy)
    outside = np.maximum(r, edge)
    angle = np.arccos(edge / outside)
    shape = edge * np.sqrt(outside**2 - edge**2) + (outside**2 - 2 * edge**2) * angle
    return (shape + 2 * j * angle) / np.pi, edge**2 - j


def retraction(tabor, solid, *, depth, rate, least, spacing):
    """Return the largest tension [1.5 pi R dg] of a relaxed contact retracted at a constant rate.

    Marched in time; lengths in beta, depths in beta^2/R, the rate in beta^2/R per unit of time.
    ``least`` is the smallest radius that the edge may reach, ``spacing`` that of the nodes from
    there to the start. The displacement of the solid lags behind that of the relaxed solid, node
    by node; the memory is exact for displacements linear in time.
    """
    start = _hertzian_radius(depth)
    inner = _graded(least, spacing)[::-1]
    outer = _graded(OUTER * start, spacing)
    fine = np.linspace(least, start + 40 * spacing, int(round((start - least) / spacing)) + 41)
    r = np.concatenate([least - inner[:-1], fine[:-1], fine[-1] + outer])
    r[0] = 0.0
    rise, mass = operator(r)
    weights, times = (np.array(x) for x in zip(*solid.modes, strict=True))

    def settled(D, lag, compliance, e):
        """Return relaxed openings e for which the law holds, with w = compliance e + lag."""
        known = r**2 / 2 - D
        for _ in range(_ROUNDS):
            # gap: the shape less the rise of the solid, of which a part is given
            w = known - lag - compliance * (known - e)
            gap = 1 + tabor * w
            traction, stiffness = lennard_jones(np.maximum(gap, _LEAST_GAP / 2))
            rest = e - known + rise @ (tabor * traction)
            matrix = np.eye(r.size) + rise @ np.diag(tabor**2 * stiffness * compliance)
            step = np.linalg.solve(matrix, -rest)
            part = 1.0
            while part > 1e-3:
                trial = known - lag - compliance * (known - e - part * step)
                if np.min(1 + tabor * trial) > _LEAST_GAP:
                    break
                part /= 2
            e = e + part * step
            if part == 1 and np.max(np.abs(step)) * tabor < _MARCHED:
                return e, 1 + tabor * (known - lag - compliance * (known - e))
        return None

    found = settled(depth, 0.0, 1.0, _jkr(r, start)[0])
    if found is None:
        raise RuntimeError("no relaxed contact was found")
    e, gap = found
    u = r**2 / 2 - depth - e
    memory = np.repeat(u[:, None], times.size, axis=1)
    time, dt = 0.0, 1e-4 / rate
    edge = r[np.argmax(gap > half_gap())]
    last, forces, instants = depth, [_force(mass, gap, tabor)], [0.0]
    while True:
        x = dt / times
        decay, mean = np.exp(-x), -np.expm1(-x) / x
        lag = memory @ (weights * decay) + u * (weights @ (mean - decay))
        compliance = solid.instantaneous + weights @ (1 - mean)
        D = depth - rate * (time + dt)
        found = settled(D, lag, compliance, e - (D - last))
        if found is None or (now := r[np.argmax(found[1] > half_gap())]) < edge - _MOVED * spacing:
            dt /= 2
            continue
        e, gap = found
        new = r**2 / 2 - D - e
        memory = memory * decay + u[:, None] * (mean - decay) + new[:, None] * (1 - mean)
        u, time = new, time + dt
        dt *= 1.5 if edge - now < _MOVED / 3 * spacing else 1.0
        dt = min(dt, _LARGEST_STEP / rate)
        edge, last = now, D
        forces.append(_force(mass, gap, tabor))
        instants.append(time)
        if forces[-1] < 0.98 * max(forces) and max(forces) > 0:
            break
        if edge < least + 5 * spacing:
            raise RuntimeError("the edge left the fine mesh before the pull-off")
    i = int(np.argmax(forces))
    curve = np.polynomial.Polynomial.fit(instants[i - 2 : i + 3], forces[i - 2 : i + 3], 4)
    grid = np.linspace(instants[i - 1], instants[i + 1], 400)
    return float(np.max(curve(grid)))


def _force(mass, gap, tabor):
    return 2 * np.pi * float(mass @ (tabor * lennard_jones(gap)[0])) / (1.5 * np.pi)


def _hertzian_radius(depth):
    """Return the radius of the larger relaxed contact without range at a depth."""
    # a^2 - sqrt(2 pi a) rises beyond the radius at which it is least
    least, most = (np.pi / 8) ** (1 / 3), 3 + np.sqrt(3 * max(depth, 1.0))
    return scipy.optimize.brentq(lambda a: a**2 - np.sqrt(2 * np.pi * a) - depth, least, most)


def _graded(length, spacing):
    """Return distances from 0 to a length, geometric beyond the first ones."""
    found = [0.0]
    while found[-1] < length:
        found.append(found[-1] + np.hypot(spacing, GROWTH * found[-1]))
    return np.array(found) * (length / found[-1])
