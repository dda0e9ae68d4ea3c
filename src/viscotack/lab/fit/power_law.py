r"""Fit solids with few constants: both power laws, the fractional solids and the standard solid.

:func:`scipy.optimize.least_squares` minimises the sum of squares of ln(measured/fitted)
over the logarithms of the constants, from the best starts of a coarse search. Intervals are those
of the linearised problem; for a poorly determined constant, those of the profile: the
constant is varied and all others refitted, until the sum of squares exceeds the limit of the
confidence level (Venzon & Moolgavkar, Applied Statistics 37 (1988) 87-94). If the profile never
reaches the limit, the interval has no bound on that side. The limit follows from the residuals,
including correlated errors (:mod:`.errors`).
"""

import itertools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from viscotack.arrays import Array
from viscotack.cards import cards
from viscotack.errors import InputError
from viscotack.model.materials import (
    FractionalZener,
    RelaxationPowerLaw,
    RetardationPowerLaw,
    StandardSolid,
)
from viscotack.model.materials.modes import reciprocal

from .errors import errors
from .observed import Observed
from .report import FitReport, Interval, rated

_POOR = 0.25  # half-width of the interval of ln(constant) above which the profile is computed


KINDS = {
    "power-law": RetardationPowerLaw,
    "relaxation-power-law": RelaxationPowerLaw,
    "sls": StandardSolid,
    "fractional-zener": FractionalZener,
}
_FAR = np.log(1e4)  # search range of a plateau about the measured moduli
_COARSE = 1e-3
_SKETCH = 60  # number of points used to compare minima
_MODULI = ("rubbery_modulus", "glassy_modulus")
_TRIED = {
    "rubbery_modulus": (1.0,),
    "exponent": (0.08, 0.15, 0.25, 0.4, 0.6, 0.9, 1.3, 1.9, 2.7),
    "order": (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9),
}


@dataclass(frozen=True, eq=False)
class Search:
    """Free constants of a model in logarithms, their bounds, and the data."""

    data: Observed
    kind: Any
    names: tuple[str, ...]
    known: dict[str, float]
    low: Array
    high: Array

    @classmethod
    def of(cls, data: Observed, model: str, known: Mapping[str, float]) -> "Search":
        """Return the search for a model's constants, except the known ones."""
        kind = KINDS[model]
        names = tuple(name for name in cards(kind) if name != "poisson_ratio")
        for name in known:
            if name not in names:
                raise InputError(f"model {model} has no constant {name}; it has {', '.join(names)}")
        softest, stiffest = data.moduli
        middle = np.log(softest * stiffest) / 2
        slow, fast = data.frequencies
        bounds = {
            "rubbery_modulus": (np.log(softest) - _FAR, middle),
            "glassy_modulus": (middle, np.log(stiffest) + _FAR),
            "exponent": (np.log(0.02), np.log(3.0) - 1e-9),
            "tau0": (-np.log(fast) - 2 * _FAR, -np.log(slow) + 2 * _FAR),
        }
        if "order" in names:
            card = cards(kind)["order"].card
            bounds["order"] = np.log(card.least) + 1e-9, np.log(card.most) - 1e-9
        free = [name for name in names if name not in known]
        if not free:
            raise InputError("all constants are given, so nothing is left to fit; omit one")
        low, high = np.array([bounds[name] for name in free]).T
        search = cls(data, kind, names, {k: float(v) for k, v in known.items()}, low, high)
        search.solid((low + high) / 2)  # raises the material's error for impossible constants
        return search

    @property
    def free(self) -> list[str]:
        """Names of the constants to be found."""
        return [name for name in self.names if name not in self.known]

    def solid(self, x: Array) -> Any:
        """Return the solid whose free constants have the natural logarithms x."""
        values = self.known | dict(zip(self.free, np.exp(x).tolist(), strict=True))
        return self.kind(**values, poisson_ratio=self.data.poisson_ratio)

    def misfit(self, x: Array) -> Array:
        """Return the residuals over their noise, shape (P N,)."""
        with np.errstate(divide="ignore"):
            logs = np.log(quick(self.data, self.solid(x), self.data.at))
        # zero loss far outside the range: keep it finite so that the search can continue
        return np.clip(self.data.weighed(np.log(self.data.values) - logs).ravel(), -50, 50)

    def polished(self, x: Array, fixed: int | None = None) -> Any:
        """Return the nearest local minimum, optionally with one constant fixed.

        None if no constant is left.
        """
        x = np.clip(x, self.low + 1e-9, self.high - 1e-9)
        others = np.arange(x.size) != (-1 if fixed is None else fixed)
        if not others.any():
            return None
        # a few digits suffice for the profile
        options: Any = {"xtol": 1e-10} if fixed is None else {"xtol": 1e-4, "ftol": 1e-5}
        if not self.data.in_frequency:  # predictions accurate to 1e-6 need wide differences
            options["diff_step"] = _COARSE

        def misfit(part: Array) -> Array:
            whole = x.copy()
            whole[others] = part
            return self.misfit(whole)

        bounds = self.low[others], self.high[others]
        return least_squares(misfit, x[others], bounds=bounds, **options)

    def minimum(self) -> Any:
        """Return the best of the local minima found from the best starts."""
        data, places = self.data, self.places(3)
        each = -(-data.at.size // _SKETCH)
        if each <= 2:
            return min((self.polished(x) for x in places), key=lambda result: result.cost)
        # a subset of the points suffices to rank the starts
        few = replace(data, at=data.at[::each], values=data.values[:, ::each], sweep=None)
        rough = [replace(self, data=few).polished(x) for x in places]
        return self.polished(min(rough, key=lambda result: result.cost).x)

    def places(self, count: int) -> list[Array]:
        """Return the best starts of a coarse search over spectrum, time and modulus ratio.

        The response of a normalised solid is computed once over a wide range. A change of time is a
        shift along the axis, and a change of modulus a shift of the logarithm.
        """
        data = self.data
        softest, stiffest = data.moduli
        slow, fast = data.frequencies
        sign = -1 if data.quantity == "creep" else 1
        shifts = np.linspace(-3, 3 + np.log10(fast / slow), 40) - np.log10(fast)
        if "tau0" in self.known:
            shifts = np.log10([self.known["tau0"]])
        table_at = np.geomspace(data.at[0] * 1e-9, data.at[-1] * 1e9, 240)
        ranked = []
        for twin, known in self._twins(softest / stiffest):
            # evaluated at omega tau0 or time/tau0
            with np.errstate(divide="ignore"):
                table = np.log(quick(data, twin, table_at))
            for shift in shifts:
                way = shift if data.in_frequency else -shift
                x = np.log(data.at) + way * np.log(10)
                logs = np.array([np.interp(x, np.log(table_at), row) for row in table])
                off = np.log(data.values) - np.clip(logs, -80, 80)
                modulus = sign * float(np.median(off))
                cost = float(np.sum(np.abs(data.weighed(off - sign * modulus))))
                moduli = {name: modulus + known[name] for name in _MODULI if name in known}
                place = known | moduli | {"tau0": shift * np.log(10)}
                ranked.append((cost, [place[name] for name in self.free]))
        ranked.sort(key=lambda entry: entry[0])
        return [np.array(place) for _, place in ranked[:count]]

    def _twins(self, ratio: float) -> Iterator[tuple[Any, dict[str, float]]]:
        """Yield trial solids with tau0 = 1 s, and the logarithms of their constants."""
        tried = _TRIED | {"glassy_modulus": tuple(1 / ratio / np.array([0.9, 0.2, 0.01]))}
        # moduli are relative to one of them
        tried |= {name: (value,) for name, value in self.known.items() if name not in _MODULI}
        tried = {name: tried[name] for name in self.names if name != "tau0"}
        for values in itertools.product(*tried.values()):
            constants = dict(zip(tried, values, strict=True))
            twin = self.kind(**constants, tau0=1.0, poisson_ratio=0.0)
            yield twin, {name: float(np.log(value)) for name, value in constants.items()}

    def profile_end(self, x: Array, i: int, side: int, deviation: float, allowed: float) -> float:
        """Return the value of constant i at which the profile reaches its limit, or inf."""
        end = self.high[i] if side > 0 else self.low[i]
        start = x.copy()

        def excess(value: float) -> float:
            """Return the minimised sum of squares minus its limit."""
            nonlocal start
            moved = start.copy()
            moved[i] = value
            found = self.polished(moved, fixed=i)
            if found is not None:
                moved[np.arange(x.size) != i] = found.x
                start = moved
            return float(np.sum(self.misfit(moved) ** 2)) - allowed

        near, below = float(x[i]), float(np.sum(self.misfit(x) ** 2)) - allowed
        if below >= 0:  # a fit without residuals: the interval has zero width
            return near
        step = float(np.clip(deviation, 1e-4, 1.0))
        while True:
            far = near + side * step
            if side * (end - far) <= 0:
                far = end
            above = excess(far)
            if above > 0:
                return _profile_zero(excess, (near, below), (far, above), 1e-4 + 1e-3 * step)
            if far == end:
                return side * np.inf
            near, below, step = far, above, 1.6 * step


def _profile_zero(
    excess: Callable[[float], float],
    below: tuple[float, float],
    above: tuple[float, float],
    within: float,
) -> float:
    """Return the zero of a profile, by the Illinois variant of false position.

    The profile is only as exact as the minimisation behind each value, and a repeated evaluation
    may change the sign. This routine never evaluates a point twice.
    """
    (near, under), (far, over) = below, above
    while abs(far - near) > within:
        place = near + (far - near) * float(np.clip(-under / (over - under), 0.1, 0.9))
        value = excess(place)
        if value > 0:
            far, over, under = place, value, 0.5 * under
        else:
            near, under, over = place, value, 0.5 * over
    return (near + far) / 2


def quick(data: Observed, solid: Any, at: Array) -> Array:
    """Predict measured numbers from a solid; where the exact way is slow, from its modes (1e-6).

    The relaxation of the retardation form and the creep of the relaxation form interconvert
    hundreds of modes at each step of a search. The few modes that the window needs take a few
    milliseconds.
    """
    long = {"relaxation": RetardationPowerLaw, "creep": RelaxationPowerLaw}
    if not isinstance(solid, long.get(data.quantity, ())):
        return data.predicted(solid, at)
    # the smallest measured E0 C(t), not the glassy one far outside the window
    seen = solid.rubbery_modulus / data.moduli[1]
    least = min(max(solid.modulus_ratio, 0.1 * seen), 1.0)
    modes = solid.retardation_modes(
        shortest=float(at[0]) / 30, longest=float(at[-1]) * 30, tolerance=1e-6 * least
    )
    if data.quantity == "creep":
        return np.asarray(modes.creep(at))[None, :] / solid.rubbery_modulus
    E, tau = reciprocal(modes.instantaneous, np.array(modes.weights), np.array(modes.times))
    return solid.rubbery_modulus * (1 + np.exp(-at[:, None] / tau) @ E)[None, :]


def fit_constants(
    data: Observed,
    *,
    model: str,
    known: Mapping[str, float],
    level: float | None = None,
    draws: int = 0,
    seed: int = 0,
) -> FitReport:
    """Fit a power law or a standard solid to measured numbers.

    Parameters
    ----------
    data : Observed
        Measured numbers.
    model : str
        "power-law", "relaxation-power-law" or "sls".
    known : mapping
        Constants that are given, not fitted, by name, in SI.
    level : float or None
        Confidence level of the intervals, in (0, 1); None for no intervals.
    draws : int
        Number of solids to sample.
    seed : int
        Of the random numbers.

    Raises
    ------
    ValueError
        If a known constant is unknown to the model or impossible, or nothing is left to fit.
    """
    search = Search.of(data, model, known)
    best = search.minimum()
    found = rated(data, model, search.solid(best.x), len(search.free))
    if level is None:
        return found
    known_errors = errors(data, data.weighed(data.residuals(found.material)), best.jac)
    influences = np.linalg.pinv(best.jac)
    half = known_errors.half_width(influences, level)
    poor = bool(np.any(half > _POOR) or np.min([best.x - search.low, search.high - best.x]) < 1e-3)
    # linearised, or by the profile where the linearisation is poor
    ends = np.array([best.x - half, best.x + half]).T
    if poor:
        # limit on the sum of squares; zero for a constant without influence
        moved = np.sum(influences**2, axis=1)
        more = np.divide(half**2, moved, out=np.full(half.size, np.inf), where=moved > 0)
        allowed = 2 * best.cost + more
        for i, (deviation, limit) in enumerate(zip(half, allowed, strict=True)):
            ends[i] = [search.profile_end(best.x, i, side, deviation, limit) for side in (-1, 1)]
    fitted = dict(zip(search.free, np.exp(ends), strict=True))
    intervals = []
    for name in search.names:
        value = float(getattr(found.material, name))
        low, high = map(float, fitted.get(name, (value, value)))
        intervals.append(Interval(name, value, low, high, known=name not in fitted))
    return replace(
        found,
        intervals=tuple(intervals),
        shared=known_errors.words(),
        draws=_draws(search, best.x, known_errors.covariance(influences), ends, draws, seed),
    )


def _draws(
    search: Search, x: Array, covariance: Array, ends: Array, count: int, seed: int
) -> tuple[Any, ...]:
    """Sample solids from the normal distribution of the constants, within their bounds."""
    if not count:
        return ()
    # the spread of an unbounded constant is limited to its interval
    low = np.maximum(search.low, np.where(np.isfinite(ends[:, 0]), -np.inf, x - 1.0)) + 1e-9
    high = np.minimum(search.high, np.where(np.isfinite(ends[:, 1]), np.inf, x + 1.0)) - 1e-9
    # by eigenvectors: an undetermined constant makes the matrix indefinite by round-off
    value, axes = np.linalg.eigh((covariance + covariance.T) / 2)
    along = np.random.default_rng(seed).normal(size=(count, x.size))
    drawn = x + along * np.sqrt(np.maximum(value, 0.0)) @ axes.T
    return tuple(search.solid(np.clip(each, low, high)) for each in drawn)
