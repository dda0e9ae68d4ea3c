r"""Random linear solids by number: a number defines the same solid in every run on every machine.

A solid is defined by its creep compliance over the relaxed compliance,

.. math:: c(t) = k + (1 - k) \sum_j w_j (1 - e^{-t/\tau_j}), \quad \sum_j w_j = 1,

with at most 40 retardation times: one for standard solids, 2 to 12 random times for Prony series,
and three per decade for smooth spectra, whose sum agrees with the integral over the spectrum to
1e-5. The weights are drawn as fractions of the rise of the compliance from glass to rubber, or as
fractions of the rise of its logarithm. Rubbers need the second choice: the logarithm of their
compliance rises uniformly, whereas fractions of the compliance put nearly the whole rise of the
logarithm into the first retardation time.

Numbers below ``STRETCHED`` give solids of the families in ``_FAMILIES``. Numbers from ``STRETCHED``
give stretched exponentials (Kohlrausch), a separate family for tests of models trained on the
others.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.materials import Prony
from viscotack.model.materials.conversion import relaxation_series

# Largest number, and that from which solids are stretched exponentials.
LAST, STRETCHED = 2_000_000, 1_000_000
# Decades of time over which arms are spread, and those of a smooth spectrum at most.
_SPAN, _WIDEST = 8.0, 12.8
_PER_DECADE = 3
# Part of a spectrum that is cut off at each of its ends.
_CUT = 1e-3
# Weights less than this of the largest are left out.
_LEAST = 1e-9
_DIGITS = 9
# A number is rounded: the last digits of a power are not the same on every machine.
_FAMILIES: tuple[tuple[float, str], ...] = (
    (0.08, "standard"),
    (0.42, "arms"),
    (0.20, "bumps"),
    (0.15, "fractional"),
    (0.15, "skewed"),
)


def creep_spectrum(number: float, modulus_ratio: float) -> tuple[Array, Array]:
    """Return weights, of sum 1, and retardation times of a random solid, ascending.

    Parameters
    ----------
    number : float
        A whole number, 0 to ``LAST``.
    modulus_ratio : float
        Rubbery over glassy modulus; weights that are shares of a logarithm depend on it.

    Examples
    --------
    >>> weights, times = creep_spectrum(7, 0.1)
    >>> len(weights) == len(times) <= 40, round(float(weights.sum()), 6)
    (True, 1.0)
    """
    if not 0 <= number <= LAST or number != int(number):
        raise InputError(f"the number of a random solid is whole, 0 to {LAST:,}; got {number:g}")
    random = np.random.Generator(np.random.PCG64(int(number)))
    weights, times = np.ones(1), np.ones(1)
    if number >= STRETCHED:
        weights, times = _stretched(random)
    else:
        # of a family that is drawn as well
        ends = np.cumsum([share for share, _ in _FAMILIES])
        place = min(int(np.searchsorted(ends, random.random(), side="right")), len(_FAMILIES) - 1)
        family, by_logarithm = _FAMILIES[place][1], random.random() < 0.5
        if family == "arms":
            weights, times = _arms(random)
        elif family != "standard":
            weights, times = _smooth(_DENSITIES[family](random))
        if by_logarithm and family != "standard":
            # the logarithm of the creep climbs from k to 1 in these shares
            climbed = modulus_ratio ** (1 - np.cumsum(weights / weights.sum()))
            weights = np.diff(climbed, prepend=modulus_ratio)
    kept = weights > _LEAST * weights.max()
    weights, times = _rounded(weights[kept] / weights[kept].sum()), _rounded(times[kept])
    return weights, times


def random_solid(number: float, modulus_ratio: float) -> Prony:
    """Return a random solid with rubbery modulus 1 and Poisson ratio 0.

    Examples
    --------
    >>> solid = random_solid(7, 0.1)
    >>> f"{solid.modulus_ratio:.6f}"
    '0.100000'
    """
    k = modulus_ratio
    weights, times = creep_spectrum(number, k)
    elements = zip((1 - k) * weights / weights.sum(), times, strict=True)
    series = relaxation_series(elements, glassy_modulus=1 / k, poisson_ratio=0.0)
    E, tau = np.array(series.branches).T
    kept = _LEAST * E.max() < E
    branches = tuple(zip(_rounded(E[kept]), _rounded(tau[kept]), strict=True))
    return Prony(rubbery_modulus=1.0, branches=branches, poisson_ratio=0.0)


def _arms(random: np.random.Generator) -> tuple[Array, Array]:
    """Return shares and times of 2 to 12 arms at random places."""
    count = 2 + int(11 * random.random())
    span = _SPAN * random.random()
    times = 10 ** np.sort(span * (random.random(count) - 0.5))
    times *= 1 + 1e-6 * np.arange(count)  # no two are the same
    unevenness = 0.3 + 2.7 * random.random()
    return (-np.log1p(-random.random(count))) ** unevenness + 1e-6, times


def _bumps(random: np.random.Generator) -> Callable[[Array], Array]:
    count = 1 + int(3 * random.random())
    places = np.log(10) * _SPAN * (random.random(count) - 0.5)
    widths = np.log(10) * (0.2 + 1.6 * random.random(count) ** 2)
    heights = 0.05 + random.random(count)

    def density(x: Array) -> Array:
        each = (x[:, None] - places) / widths
        return np.exp(-(each**2) / 2) @ (heights / widths)

    return density


def _skewed(random: np.random.Generator) -> Callable[[Array], Array]:
    """Return the spectrum of a fractional element of two orders, to the one side or the other."""
    order = 0.25 + 0.7 * random.random()
    found = _negami(order, 0.2 + 0.8 * random.random())
    return found if random.random() < 0.5 else lambda x: found(-x)


def _negami(order: float, second: float) -> Callable[[Array], Array]:
    """Return the density per ln tau of (1 + (i w)^order)^-second (Havriliak and Negami)."""

    def density(x: Array) -> Array:
        u, angle = np.exp(order * x), order * np.pi
        turned = np.arctan2(np.sin(angle), u + np.cos(angle))
        size = (u**2 + 2 * u * np.cos(angle) + 1) ** (-second / 2)
        return u**second * size * np.sin(second * turned)

    return density


_DENSITIES: dict[str, Callable[[np.random.Generator], Callable[[Array], Array]]] = {
    "bumps": _bumps,
    # a fractional element of one order (Cole and Cole)
    "fractional": lambda random: _negami(0.2 + 0.75 * random.random(), 1.0),
    "skewed": _skewed,
}


def _stretched(random: np.random.Generator) -> tuple[Array, Array]:
    """Return the spectrum of exp(-t^order), that of a stable distribution of the rates."""
    order = 0.25 + 0.6 * random.random()
    phi = np.pi * (np.arange(400) + 0.5) / 400
    outer = 1 / (1 - order)
    height = (np.sin(order * phi) / np.sin(phi)) ** outer * np.sin((1 - order) * phi)
    height /= np.sin(order * phi)

    def density(x: Array) -> Array:
        # Zolotarev's integral, all of whose terms are positive; the rate is exp(-x)
        power = np.exp(order * outer * x)[:, None]
        return np.sum(height * power * np.exp(-height * power), axis=1)

    return _smooth(density)


def _smooth(density: Callable[[Array], Array]) -> tuple[Array, Array]:
    """Return shares and times of a density per ln tau, three nodes a decade, its tails cut."""
    step = np.log(10) / _PER_DECADE
    x = step * np.arange(-60, 61)
    shares = density(x)
    passed = np.cumsum(shares) / np.sum(shares)
    first, last = np.searchsorted(passed, [_CUT, 1 - _CUT])
    most = int(_WIDEST * _PER_DECADE)
    if last - first > most:
        # the part around the middle of the spectrum
        middle = int(np.searchsorted(passed, 0.5))
        first = int(np.clip(middle - most // 2, first, last - most))
        last = first + most
    kept = slice(int(first), int(last) + 1)
    return shares[kept], np.exp(x[kept])


def _rounded(values: Array) -> Array:
    return np.array([float(f"{value:.{_DIGITS}g}") for value in values])
