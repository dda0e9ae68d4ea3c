r"""Contact receding from rest at constant speed, vectorised over thousands of cases.

The opening inside the contact has been zero at all times, so the pressure is that of the
relaxed solid at the hereditary depth :math:`D_e = D_0 - r \int_0^t \psi ds`, with the relaxation
psi from 1/k to 1: exact for forces of short range and any spectrum. The edge is the steady crack,

.. math:: \frac{(D_e - g(a))^2}{2 \pi a} = \Gamma(V), \quad V = -\mu^2 \frac{da}{dt}.

On a layer of one material on a rigid base the same holds with energy release rate and force of
:class:`._profile.LayerProfile`, because at every wavelength the layer moves as an elastic one does,
times the creep. The zone of the crack must be short beside the thickness too.

The radius is the independent variable: for each radius the time is computed at which the edge
reaches it. Units as in :mod:`._profile`; times in the material's unit.

**Limits and error of a receding crack, from simulations of films.** Of 56 simulations with
Lennard-Jones forces (thickness 0.1 to 3 beta, Tabor numbers 5 to 16, modulus ratios 0.03 and 0.1,
Poisson ratios 0.3 to 0.5 and sliding) the theory (:func:`recede`) applies to 29, and is within 3
% + 7 % times :math:`\ell a/b^2` of each; :math:`\ell` is the length of the cohesive zone and a the
contact radius, both at pull-off. The number is limited to 0.5: on thinner films the forces reach
through the film, and the force is smaller, down to half.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from viscotack.arrays import Array
from viscotack.theory.crack.contact._profile import Profile
from viscotack.theory.crack.contact.growing import GrowingEdges, NeighbourEdges
from viscotack.theory.crack.contact.history import Chain, Edge, Even, chain_of, hereditary_travel
from viscotack.theory.crack.steady import SteadyCrack

# Number of radii of a curve, and the smallest one: over that of the start, and of the elastic
# pull-off.
_RADII, _SMALLEST = 160, 0.25
# An edge that starts fast absorbs its energy near the start, where the tension may be largest:
# number of additional radii in the first step, and fraction at which they begin.
_AT_REST, _FIRST = 40, 1e-11
# Largest relative difference of two runs for which their times are extrapolated.
_LARGE_ERROR = 0.05
# Half-width of the bracket of ln t over the error of the previous guess, and its limits; iterations
# to the root.
_WIDER, _WIDTHS, _ROUNDS, _CLOSE = 3.0, (5e-3, 0.2), 60, 1e-6
# Number of rows of the tabulated travel.
_ROWS = 4000


class Curves(NamedTuple):
    """Curves of receding contacts, each array of shape (radii, cases).

    Attributes
    ----------
    time : ndarray
        Time since the start [material's unit].
    radius : ndarray
        Contact radius [beta].
    depth : ndarray
        Depth [beta^2/R].
    force : ndarray
        Force of short-range adhesion [R dg], compression positive.
    speed : ndarray
        Speed of the edge [E0* h0^2/(dg tau)], positive.
    amplification : ndarray
        Energy at the edge [dg].
    """

    time: Array
    radius: Array
    depth: Array
    force: Array
    speed: Array
    amplification: Array


def recede(
    crack: SteadyCrack | GrowingEdges | NeighbourEdges,
    profile: Profile,
    *,
    radius: Array,
    rate: Array,
    tabor: Array,
    radii: int = _RADII,
) -> Curves:
    """Compute the curves of contacts that recede from rest.

    Parameters
    ----------
    crack : SteadyCrack
        Crack of the solid with the reduced law, common to all cases; or one edge per case.
    profile : Profile
        Profile of the reduced shape, on a half-space or on a layer.
    radius, rate, tabor : ndarray
        For each case: radius of the relaxed start [beta], speed [beta^2/R per time unit of the
        material], Tabor number.
    radii : int
        Number of points of a curve; fewer are faster, and sufficient to compare similar cases.
    """
    a0, r, mu = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in (radius, rate, tabor)))
    chain = chain_of(crack.modes)
    edge = crack if isinstance(crack, GrowingEdges | NeighbourEdges) else Edge(crack, 1)
    travel = _Travel(chain, profile, a0, r, mu)
    start = profile.relaxed_depth(a0)
    # end at the smallest radius at pull-off, that of the elastic contact
    least = np.minimum(_SMALLEST * profile.elastic_radius, a0 / 2)
    way = a0 * np.exp(_parts(radii)[:, None] * np.log(least / a0))

    def marched(a: Array) -> tuple[Array, Array]:
        return _marched(a, profile, edge, travel, start=start, rate=r, mobility=mu**2)

    # first order in the steps: the difference of two runs at the same radii estimates the error
    (coarse, slow), (fine, fast) = marched(way[::2]), marched(way)
    a = way[::2]
    bare, drawn = profile.depth(a), profile.drawn(a)
    fine, fast = fine[::2], fast[::2]

    def lifted(time: Array) -> tuple[Array, Array]:
        effective = start - r * travel(time)
        return effective, (np.minimum(effective - bare, 0.0) / drawn) ** 2

    # do not extrapolate if the difference is large, or leads to more energy than a
    # crack can dissipate
    time = np.maximum(2 * fine - coarse, 0.0)
    bad = (np.abs(fine - coarse) > _LARGE_ERROR * fine) | (lifted(time)[1] > edge.limit)
    time = np.maximum.accumulate(np.where(bad, fine, time), axis=0)
    effective, energy = lifted(time)
    return Curves(
        time=time,
        radius=a,
        depth=start - r * time,
        force=profile.force(a, effective),
        speed=np.where(bad, fast, np.maximum(2 * fast - slow, 0.0)),
        # beyond this point the contact jumps, because the available energy exceeds that of any
        # crack
        amplification=np.minimum(energy, edge.limit),
    )


def _parts(radii: int) -> Array:
    """Return fractions of ln a; every second one forms a coarser grid."""
    even = np.linspace(0.0, 1.0, radii)
    first = np.geomspace(_FIRST, even[1], _AT_REST * radii // _RADII)
    coarse = np.concatenate([[0.0], first, even[2:]])
    return np.sort(np.concatenate([coarse, (coarse[1:] + coarse[:-1]) / 2]))


def _marched(
    a: Array,
    profile: Profile,
    edge: Edge | GrowingEdges | NeighbourEdges,
    travel: _Travel,
    *,
    start: Array,
    rate: Array,
    mobility: Array,
) -> tuple[Array, Array]:
    """Return the times at which the edges reach the radii, and their speeds."""
    time, speed = np.zeros_like(a), np.zeros_like(a)
    receded = np.log(a[0] - a[1:])
    ends = travel.first - 12.0, travel.last
    guess = np.full(start.shape, (travel.first + travel.last) / 2)
    width = np.full(start.shape, _WIDTHS[1])
    for i in range(1, len(a)):
        g, around = profile.depth(a[i]), profile.drawn(a[i]) ** 2
        step = mobility * (a[i - 1] - a[i])

        def excess(
            log: Array,
            before: Array = time[i - 1],
            step: Array = step,
            g: Array = g,
            around: Array = around,
        ) -> tuple[Array, Array]:
            t = np.exp(log)
            effective = start - rate * travel(before + t)
            found = np.minimum(effective - g, 0.0) ** 2 / around
            return np.log((found + 1e-300) / edge.amplification(step / t)), t

        if i > 2:
            # the speed is about a power of the way of the edge
            last, power = np.log(speed[i - 2 : i]), np.diff(receded[i - 3 : i], axis=0)
            faster = (last[1] - last[0]) * power[1] / power[0]
            guess = np.clip(np.log(step) - last[1] - faster, *ends)
        found, t = _root(excess, guess, width, ends)
        width = np.clip(_WIDER * np.abs(found - guess), *_WIDTHS)
        time[i], speed[i], guess = time[i - 1] + t, step / t, found
    return time, speed


def _root(
    excess: Callable[[Array], tuple[Array, Array]],
    guess: Array,
    width: Array,
    ends: tuple[float, float],
) -> tuple[Array, Array]:
    """Return the zero of an increasing function near a guess, and the value there.

    If there is none between the ends, return the nearer end. `width` is half that of the first
    bracket. Uses regula falsi with Anderson-Bjorck weights, and bisection in every fourth round.
    """
    low, high = guess - width, guess + width
    below, above = excess(low)[0], excess(high)[0]
    while np.any(far := (below > 0) & (low > ends[0])) or np.any((above < 0) & (high < ends[1])):
        width = 4 * width
        beyond = (above < 0) & (high < ends[1])
        high, above = np.where(far, low, high), np.where(far, below, above)
        low, below = np.where(beyond, high, low), np.where(beyond, above, below)
        low = np.where(far, np.maximum(low - width, ends[0]), low)
        high = np.where(beyond, np.minimum(high + width, ends[1]), high)
        below = np.where(far, excess(low)[0], below)
        above = np.where(beyond, excess(high)[0], above)
    inside = (below < -_CLOSE) & (above > _CLOSE)
    x = np.where(below >= -_CLOSE, low, high)
    side = np.zeros(guess.shape, dtype=int)
    for i in range(_ROUNDS):
        # a kink of the function slows regula falsi
        part = 0.5 if i % 4 == 3 else -below / np.where(inside, above - below, 1.0)
        x = np.where(inside, low + part * (high - low), x)
        found = excess(x)
        inside &= np.abs(found[0]) >= _CLOSE
        if not np.any(inside):
            break
        left = found[0] < 0
        old = np.where(left, below, above)
        weight = 1 - found[0] / np.where(old == 0, 1.0, old)
        weight = np.where(weight > 0, weight, 0.5)
        scaled = np.where(side == np.where(left, -1, 1), weight, 1.0)
        above = np.where(left, above * scaled, found[0])
        below = np.where(left, found[0], below * scaled)
        side = np.where(left, -1, 1)
        low, high = np.where(left, x, low), np.where(left, high, x)
    return x, found[1]


class _Travel:
    """Hereditary travel, tabulated in ln t over the relevant times."""

    def __init__(self, chain: Chain, profile: Profile, a0: Array, r: Array, mu: Array) -> None:
        far = np.max(profile.depth(a0) + 4 * np.sqrt(a0) + 4) * 30
        self.last = float(np.log(np.max(far / r)))
        self.first = float(np.log(np.min(1e-9 / r)))
        log = np.linspace(self.first, self.last + 1, _ROWS)
        travel = np.log(hereditary_travel(chain, np.exp(log)))
        self._travel = Even(self.first, self.last + 1, travel)

    def __call__(self, time: Array) -> Array:
        with np.errstate(divide="ignore"):
            log = np.log(time)
        # earlier the solid is glassy
        return np.exp(self._travel(log) + np.minimum(log - self.first, 0.0))


# Relative error: a constant, and a factor of l a/b^2, which is limited.
ERROR, ERROR_BY_ZONE, MOST_ZONE = 0.03, 0.07, 0.5
# Smallest modulus ratio, as simulated.
LEAST_RATIO = 0.03
# Smallest Tabor number over the cube root of the energy at pull-off; smallest start over the radius
# at pull-off, or travel of the edge in zone lengths.
_LEAST_TABOR, _LEAST_START, _LEAST_ZONES = 2.9, 1.2, 10.0


def outside(effective: float, start: float, through: float, zones: float = 0.0) -> str:
    """Return why the theory of a receding crack does not hold at a pull-off, or "".

    Parameters
    ----------
    effective : float
        Effective Tabor number at the energy of the edge.
    start : float
        Contact radius of the start over that at pull-off.
    through : float
        Length of the cohesive zone times contact radius over the squared thickness of a film; 0 on
        a half-space.
    zones : float
        Travel of the edge until pull-off in lengths of the cohesive zone, if known.
    """
    if effective < _LEAST_TABOR:
        return (
            f"the cohesive zone is too long: effective Tabor number {effective:.3g} at the energy "
            f"of the edge, valid from {_LEAST_TABOR:g}"
        )
    if start < _LEAST_START and zones < _LEAST_ZONES:
        why = f"the start is {start:.3g} times the radius at pull-off, valid from "
        why += f"{_LEAST_START:g} times"
        return why + (f" or {_LEAST_ZONES:g} zone lengths, not {zones:.2g}" if zones else "")
    if through > MOST_ZONE:
        return (
            "the film is too thin for the range of the forces: zone length times contact radius "
            f"is {through:.2g} times the squared thickness, valid up to {MOST_ZONE:g}; the force "
            "is an upper limit"
        )
    return ""
