r"""A forecast of pull-off forces from a rate series: at other speeds, loads and temperatures.

Interfaces are drawn from the posterior of the series. For each of them ln of the forces measured
and of those forecast err together, by theory and material, with the covariance

.. math:: C = \begin{pmatrix} C_{mm} + N & C_{mf} \\ C_{fm} & C_{ff} \end{pmatrix} ,

N the noise of the measured ones. Given their residuals r the forecast is normal, with mean
:math:`C_{fm} (C_{mm} + N)^{-1} r` and covariance
:math:`C_{ff} - C_{fm} (C_{mm} + N)^{-1} C_{mf}`: near speeds that were measured it is the data
that speak, far from them the model.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.materials import Passport
from viscotack.materials.conversion import slowed
from viscotack.protocol import Approach, AtForce, Dwell, Move
from viscotack.units import readable

from .doubt import allowed, covariance, log_forces, theory_covariance
from .rate_series import RateSeriesFit
from .sampling import Posterior, posterior
from .search import LEAST_TABOR

_MOST = 200  # speeds
_DRAWS, _TIMES = 200, 10  # interfaces drawn, and forces of each


@dataclass(frozen=True, eq=False)
class RateForecast:
    """Pull-off forces to expect.

    Parameters
    ----------
    speed : ndarray, shape (n,)
        Of the retraction [m/s].
    force, low, high : ndarray, shape (n,)
        Median and ends of the band [N]: of the mean of many tests, without the noise of one.
    level : float
        Of the band.
    preload, temperature : float, float or None
        For which [N], [K].
    dwell : float or None
        Time under the preload [s]; None for a contact that has relaxed.
    posterior : Posterior
        Interfaces from which it was drawn.
    words : tuple of str
        What to know of it.
    """

    speed: Array
    force: Array
    low: Array
    high: Array
    level: float
    preload: float
    temperature: float | None
    dwell: float | None
    posterior: Posterior
    words: tuple[str, ...]


def forecast_rates(
    fit: RateSeriesFit,
    speed: npt.ArrayLike,
    *,
    preload: float | None = None,
    temperature: float | None = None,
    dwell: float | None = None,
    approach_speed: float | None = None,
    stiffness: float | None = None,
    theory: float | None = None,
    level: float | None = None,
    seed: int = 0,
) -> RateForecast:
    """Return pull-off forces with a band, from a rate series that was fitted.

    Parameters
    ----------
    fit : RateSeriesFit
        Of the series.
    speed : array_like, shape (n,)
        Of the retraction [m/s].
    preload : float, optional
        Under which the contact relaxes [N]; else the mean one of the series.
    temperature : float, optional
        Of the forecast [K]; else that of the series. The passport must say how times shift.
    dwell : float, optional
        Time under the preload [s], after an approach at `approach_speed`; else until all has
        relaxed.
    approach_speed : float, optional
        [m/s]; goes with `dwell`.
    stiffness : float, optional
        Of the machine [N/m], inf for a rigid one; else that of the series.
    theory : float, optional
        Relative standard uncertainty of the forward model; else that of the fit.
    level : float, optional
        Of the band; else that of the fit.
    seed : int
        Of the random numbers.

    Raises
    ------
    OutOfRange
        If the theory does not hold at a speed, or the temperature was not measured.
    ValueError
        If a number is wrong.
    """
    v = np.atleast_1d(np.asarray(speed, dtype=float))
    level = fit.level if level is None else level
    loads = np.array([one.preload for one in fit.series], dtype=float)
    load = float(loads.mean()) if preload is None else preload
    spring = fit.stiffness if stiffness is None else stiffness
    _check(v, load, level, spring, dwell, approach_speed)
    passport = fit.passport if temperature is None else fit.passport.moved_to(temperature)
    _check_growth(fit, passport)
    known = fit.forward.beside(passport.material)
    w, gap = fit.work_of_adhesion, fit.equilibrium_gap
    law = None if fit.growth is None else fit.growth.law
    middle = known.pulled(w, gap, v, load, growth=law)
    _refuse(v, middle.effective_tabor)
    pressed: tuple[Move, ...] = ()
    if dwell is not None and approach_speed is not None:
        pressed = Approach(approach_speed, to=AtForce(load)), Dwell(dwell, hold="force")
    spring = None if spring == np.inf else spring
    loaded = np.full(v.size, load)
    changed, refused = known.changed(w, gap, v, loaded, stiffness=spring, moves=pressed, growth=law)
    for i, why in refused.items():
        raise OutOfRange(f"at {readable(v[i], 'm/s', digits=3)}: {why}")

    measured = np.array([one.speed for one in fit.series])
    theory = fit.theory if theory is None else theory
    spread = _together(fit, passport, (measured, loads), (v, load), theory)
    m = measured.size
    # of the fit: noise, theory and material of the forces that were measured
    gain = np.linalg.solve(fit.covariance, spread[:m, m:]).T
    left = spread[m:, m:] - gain @ spread[:m, m:]
    root = _root(left)

    chain = posterior(fit.objective, fit.best, seed=seed)
    draws = chain.thinned(_DRAWS)
    works, gaps = draws[:, :1], draws[:, 1:2]
    laws = None
    if fit.growth is not None:
        laws = fit.growth.opening.growth(gaps, draws[:, 2:3], draws[:, 3:])
    forecast = np.log(known.pulled(works, gaps, v, load, growth=laws).force)
    at = fit.forward.pulled(works, gaps, measured, loads, growth=laws).force
    force = np.array([one.force.value for one in fit.series]) / fit.yielding
    moved = forecast + np.log(force / at) @ gain.T
    rng = np.random.default_rng(seed)
    noise = rng.standard_normal((_TIMES, *moved.shape)) @ root.T
    sample = np.exp(moved + noise).reshape(-1, v.size) * changed
    part = (1 - level) / 2
    low, median, high = np.quantile(sample, [part, 0.5, 1 - part], axis=0)
    return RateForecast(
        v,
        median,
        low,
        high,
        level,
        load,
        passport.temperature,
        dwell,
        chain,
        tuple(_words(fit, v, middle.crack_speed, chain)),
    )


def _check(
    speed: Array,
    preload: float,
    level: float,
    stiffness: float | None,
    dwell: float | None,
    approach: float | None,
) -> None:
    if not (speed.ndim == 1 and 0 < speed.size <= _MOST and np.all(speed > 0)):
        raise InputError(f"a forecast is for 1 to {_MOST} positive speeds [m/s], got {speed!r}")
    if not (preload > 0 and 0 < level < 1):
        raise InputError(
            f"preload must be positive and level a part of one, got {preload} N, {level}"
        )
    if stiffness is not None and not stiffness > 0:
        raise InputError(f"the stiffness of a machine must be positive, got {stiffness} N/m")
    if (dwell is None) != (approach is None):
        raise InputError("dwell time and approach speed go together; say both or neither")
    if dwell is not None and approach is not None and not (dwell >= 0 and approach > 0):
        raise InputError(
            f"a dwell is not negative and an approach speed positive, got {dwell} s, {approach} m/s"
        )


def _check_growth(fit: RateSeriesFit, passport: Passport) -> None:
    if fit.growth is not None and passport.temperature != fit.passport.temperature:
        raise InputError(
            "how the growth of an interface with speed changes with temperature is not known: "
            f"forecast at {fit.passport.temperature:g} K, that of the series, or measure a series "
            f"at {passport.temperature:g} K"
        )


def _refuse(speed: Array, effective: Array) -> None:
    bad = effective < LEAST_TABOR
    if np.any(bad):
        raise OutOfRange(
            f"at {readable(speed[bad].min(), 'm/s', digits=3)} the zone at the edge is as "
            "large as the contact and the theory does not hold; ask slower speeds, or simulate"
        )


def _together(
    fit: RateSeriesFit,
    passport: Passport,
    measured: tuple[Array, Array],
    wanted: tuple[Array, float],
    theory: float,
) -> Array:
    """Return how theory and material err together, over speeds measured and wanted."""
    speed = np.concatenate([measured[0], wanted[0]])
    spread = theory_covariance(speed, theory)
    solids = allowed(fit.passport)
    if not solids:
        return spread
    moved = allowed(passport) if passport.allowed else _slowed(fit.passport, passport, solids)
    w, gap = fit.work_of_adhesion, fit.equilibrium_gap
    load = np.full(wanted[0].size, wanted[1])
    law = None if fit.growth is None else fit.growth.law
    first = log_forces(fit.forward, solids, w, gap, *measured, law)
    known = fit.forward.beside(passport.material)
    second = log_forces(known, moved, w, gap, wanted[0], load, law)
    rows = np.concatenate([first, second], axis=1)
    return spread + covariance(rows)


def _slowed(first: Passport, second: Passport, solids: Sequence[object]) -> Sequence[object]:
    """Return solids drawn by intervals at another temperature."""
    if second.temperature == first.temperature or second.temperature is None:
        return solids
    factor = first.shift_factor(second.temperature)
    return [slowed(solid, factor) for solid in solids]


def _root(covariance: Array) -> Array:
    """Return a square root of a covariance that may be singular."""
    values, vectors = np.linalg.eigh((covariance + covariance.T) / 2)
    return vectors * np.sqrt(np.maximum(values, 0.0))


def _words(fit: RateSeriesFit, speed: Array, crack: Array, chain: Posterior) -> list[str]:
    said = []
    measured = [one.speed for one in fit.series]
    if speed.min() < 0.5 * min(measured) or speed.max() > 2 * max(measured):
        said.append(
            f"speeds from {readable(min(measured), 'm/s', digits=3, to=max(measured))} were "
            "measured; beyond them the forecast rests on the material and the theory"
        )
    said.append(
        f"the edge is at {readable(crack.min(), 'm/s', digits=2, to=crack.max())} at pull-off"
    )
    if any(ends.split for ends in fit.intervals.values()):
        said.append("the band is drawn around the likelier of two ranges; the other may differ")
    if not chain.converged:
        said.append(
            "the walk through the posterior is short: its correlation time is "
            f"{chain.correlation_time:.0f} steps"
        )
    if not allowed(fit.passport):
        said.append("the band does not hold any doubt about the material: none is stated")
    return said
