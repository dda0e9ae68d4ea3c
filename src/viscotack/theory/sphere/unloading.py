r"""Unloading curve of a viscoelastic sphere from the motion of its contact edge.

The bulk is relaxed, so depth, force and contact radius are related as in JKR with a work
of adhesion G, and the edge recedes as a Persson-Brener crack with that energy:

.. math:: \delta = \frac{a^2}{R} - \sqrt{\frac{2 \pi a G}{E_0^*}}, \quad
          P = \frac{4 E_0^* a^3}{3 R} - \sqrt{8 \pi E_0^* a^3 G}, \quad
          \frac{G}{\Delta\gamma_0} = \Gamma\!\left(-\frac{da}{dt}\right), \quad
          \frac{d\delta}{dt} = -r

after Muller (1999) (no DOI known to this package; used by Ciavarella (2021),
doi:10.1080/01694243.2021.1882766), with the law of :mod:`viscotack.theory.crack.persson_brener` in
place of a power law. Range: large Tabor number, and retraction slow enough for the bulk to relax
while the edge moves. In fast retraction the bulk stiffens as well, and the curve
is only approximate. Compared with simulations of power-law solids (k = 0.1, n 0.4 to 1.6, deep
preload) with alpha = pi/9 in the tip length, the pull-off force is

- at mu = 3.24: 3 % low up to rates of 10 h0/tau0, all of it the range of the forces (the
  elastic :func:`viscotack.theory.elastic.lennard_jones.pull_off_ratio`), and up to 18 % low at 100
  to 1e4;
- at mu = 8: within 3.5 % up to 100, 6 % low beyond.
"""

from __future__ import annotations

import bisect
import math
from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import scipy

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.theory._checks import contact_scales, positive
from viscotack.theory.crack import CrackLaw
from viscotack.theory.elastic import jkr

# Fractions of the range of Gamma from 1 to 1/k that are tabulated; linear beyond.
_LOW, _HIGH = 1e-10, 1 - 1e-4
_PER_DECADE = 12
# ln of the first passage times, their step, and the end of the search.
_SPAN, _COARSE, _WIDEST = 16.0, 2.0, 500.0
# Power of Gamma of the speed beyond the table, which approximates a wall at 1/k.
_WALL = 3e3
# Gamma - 1 that is negligible.
_FIRST = 1e-5
# Curves end at this fraction of the radius scale, or where Gamma k exceeds this: an unstable edge.
_SMALLEST = 1e-3
_GLASSY = 1.03
# ln of the largest dimensionless speed of such an edge.
_FREE = 600.0
_TOLERANCE = 1e-8
# Longest step relative to the radius at the start.
_LONGEST = 0.02


class Unloading(NamedTuple):
    """An unloading curve, returned by :func:`retraction`: arrays of equal length, SI.

    Attributes
    ----------
    time : ndarray
        Time [s] from the start of retraction.
    depth, contact_radius, force : ndarray
        Depth [m], contact radius [m] and force [N], positive in compression.
    edge_speed : ndarray
        Speed of the receding edge [m/s], positive.
    amplification : ndarray
        G over work of adhesion.
    """

    time: Array
    depth: Array
    contact_radius: Array
    force: Array
    edge_speed: Array
    amplification: Array

    @property
    def pull_off_force(self) -> float:
        """Pull-off force [N], the positive number -min(force), by a parabola of three states."""
        i = int(np.clip(np.argmin(self.force), 1, len(self.force) - 2))
        x, y = self.depth[i - 1 : i + 2] - self.depth[i], self.force[i - 1 : i + 2]
        if y[1] > min(y[0], y[2]) or np.any(np.diff(x) == 0):
            return -float(np.min(self.force))
        left, right = (y[1] - y[0]) / (x[1] - x[0]), (y[2] - y[1]) / (x[2] - x[1])
        bend = (right - left) / (x[2] - x[0])
        slope = left - bend * x[0]
        return -float(y[1] - slope**2 / (4 * bend)) if bend > 0 else -float(y[1])


def retraction(
    depth: float,
    law: CrackLaw,
    *,
    speed: float,
    radius: float,
    contact_modulus: float,
    work_of_adhesion: float,
) -> Unloading:
    """Compute the curve of a sphere retracted from a relaxed contact at constant speed.

    Parameters
    ----------
    depth : float
        Depth of the relaxed start [m], not below that of
        :func:`viscotack.theory.elastic.jkr.instability`.
    law : CrackLaw
        Crack law of the edge. The errors above hold for Persson and Brener with the length of
        :func:`viscotack.theory.crack.persson_brener.crack_tip_length`.
    speed : float
        Retraction speed r [m/s], positive.
    radius, contact_modulus, work_of_adhesion : float
        Relaxed contact, as in :mod:`viscotack.theory.elastic.jkr` [m, Pa, J/m^2].

    Returns
    -------
    Unloading
        Curve until the contact has vanished, or has only the glassy equilibrium left.

    Raises
    ------
    ValueError
        If the material is elastic; then :mod:`viscotack.theory.elastic.jkr` gives the curve.

    Notes
    -----
    The equation is stiff near the start, where the edge creeps in equilibrium with the drive; an
    implicit method solves it in 5 to 10 ms. Its errors are about 2e-5 of the force. Where
    the edge is slower than at Gamma = 1.00001 the curve is that of JKR to this precision.

    Examples
    --------
    >>> from viscotack.model.materials import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> law = CrackLaw(theory="persson-brener", material=solid, tip_length=1e-6)
    >>> curve = retraction(
    ...     5e-5, law, speed=1e-6, radius=5e-3, contact_modulus=2e6, work_of_adhesion=0.15
    ... )
    >>> f"{curve.pull_off_force * 1e3:.2f} mN"
    '9.71 mN'
    """
    if law.largest <= 1:
        raise InputError("an elastic solid has no rate dependence; use theory.jkr")
    r = float(positive(speed=speed))
    case = dict(radius=radius, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion)
    length, height, load = (float(x) for x in contact_scales(**case))
    start = float(np.asarray(jkr.contact_radius_at_depth(depth, **case))) / length
    d0 = depth / height
    # edge speed in the scale of contact radius per scale of depth travelled
    unit = law.speed_unit / length * height / r
    log_speed = _log_speed(law.reduced())
    # a slower edge is in equilibrium within _FIRST, and would only make the problem stiffer
    unit = min(unit, math.exp(-log_speed(math.log(_FIRST))))

    def amplification(path: float, a: float) -> tuple[float, float]:
        """Return Gamma and the depth; the path is the combined motion of drive and edge."""
        d = d0 - path + (start - a)
        return max(a**2 - d, 0.0) ** 2 / (2 * a), d

    def motion(path: float, state: Any) -> list[float]:
        gamma, _ = amplification(path, max(float(state[0]), _SMALLEST))
        if gamma <= 1:
            return [0.0]
        # bounded for both slow and fast edges
        return [-1 / (1 + math.exp(min(-log_speed(math.log(gamma - 1)), _FREE)) / unit)]

    solver = scipy.integrate.LSODA(
        motion,
        0.0,
        [start],
        np.inf,
        rtol=_TOLERANCE,
        atol=_TOLERANCE * start,
        first_step=1e-9 * start,
        max_step=_LONGEST * start,
    )
    path, radii = [0.0], [start]
    while True:
        solver.step()
        a = float(solver.y[0])
        gamma, _ = amplification(solver.t, max(a, _SMALLEST))
        if solver.status == "failed":
            raise RuntimeError(f"the motion could not be integrated beyond a = {a * length:.3g} m")
        if a <= _SMALLEST or gamma * law.material.modulus_ratio > _GLASSY:
            break
        path.append(float(solver.t))
        radii.append(a)
    a = np.array(radii)
    gamma, d = np.array([amplification(s, x) for s, x in zip(path, radii, strict=True)]).T
    speeds = [log_speed(math.log(x - 1)) if x > 1 else -np.inf for x in gamma.tolist()]
    edge = unit * np.exp(np.minimum(speeds, _FREE))
    return Unloading(
        # remove backward motion of the drive by round-off while only the edge moves
        time=np.maximum.accumulate(d0 - d) * height / r,
        depth=d * height,
        contact_radius=a * length,
        force=(4 / 3 * a**3 - 2 * a * (a**2 - d)) * load,
        edge_speed=edge * length / height * r,
        amplification=gamma,
    )


# cached: half of the work, and the same for every load, speed and size
@lru_cache(maxsize=32)
def _log_speed(law: CrackLaw) -> Callable[[float], float]:
    """Tabulate ln of the speed as a function of ln(Gamma - 1), of a law without dimensions."""
    k = law.material.modulus_ratio
    speeds, odds = _table(law)
    spline = scipy.interpolate.CubicSpline(odds, speeds)
    # plain floats, because the function is evaluated thousands of times with scalars
    knots, cubics = odds.tolist(), spline.c.T.tolist()
    slowest, fastest, slope = float(speeds[0]), float(speeds[-1]), float(spline(odds[0], 1))
    # of the last Gamma - 1, from its odds
    room = 1 / k - 1
    wall = float(np.log(room) - np.log1p(np.exp(-odds[-1])))

    def log_speed(q: float) -> float:
        if q >= wall:
            return fastest + _WALL * (q - wall)
        x = q - math.log(room - math.exp(q))
        if x <= knots[0]:
            return slowest + slope * (x - knots[0])
        i = min(bisect.bisect_right(knots, x), len(cubics)) - 1
        c, d = cubics[i], min(x, knots[-1]) - knots[i]
        return ((c[0] * d + c[1]) * d + c[2]) * d + c[3]

    return log_speed


def _table(law: CrackLaw) -> tuple[Array, Array]:
    """Return ln speed and the ln of (Gamma - 1)/(1/k - Gamma) from slow to fast."""
    first, last = (np.log(part / (1 - part)) for part in (_LOW, _HIGH))
    low, high = -_SPAN, _SPAN
    while max(-low, high) < _WIDEST:
        # coarse first, to find where the law is curved
        times = np.arange(high, low, -_COARSE)
        odds = law.passage(times).log_odds
        if odds[0] < first and odds[-1] > last:
            high = float(times[np.flatnonzero(odds < first)[-1]])
            low = float(times[np.flatnonzero(odds > last)[0]])
            found = law.passage(np.arange(high, low - 0.1, -np.log(10) / _PER_DECADE))
            rows = slice(
                int(np.flatnonzero(found.log_odds <= first)[-1]),
                int(np.searchsorted(found.log_odds, last)) + 1,
            )
            return np.array(found.log_speed[rows], float), np.array(found.log_odds[rows], float)
        low, high = low if odds[-1] > last else 2 * low, high if odds[0] < first else 2 * high
    raise InputError(
        "the creep of the solid covers too many decades of time for the speed of the edge to be "
        "tabulated; use a modulus ratio farther from 1, or a narrower spectrum"
    )
