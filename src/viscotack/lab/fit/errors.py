r"""Correlated errors of measured numbers, and the uncertainty of fitted quantities.

Least squares assumes independent residuals of equal variance. Laboratory data often differ: a clamp
that slips moves both moduli of one sweep together, a drifting transducer bends a creep curve over
a decade, noise grows towards one end. The fitted constants hardly change, but their intervals do:
for the level of the curve, a hundred points in five sweeps carry the information of five numbers.

The errors e (residuals of the logarithms over their noise) are assumed to have the covariance

.. math::

    V_\theta = s^2 \left( D_g + a^2 Z Z^T + b^2 K_\ell \right) ,

where D_g is diagonal with exp(g u) along the axis (u from -1 to 1; its mean is 1), Z assigns points
to sweeps, and K_l is a drift, \|K_ij\| = exp(-\|ln x_i - ln x_j\|/l) within one part.
The residuals r of a fit with slopes J have the restricted likelihood (Patterson & Thompson,
Biometrika 58 (1971) 545, doi:10.1093/biomet/58.3.545)

.. math::

    -2 \ln L(\theta) = \ln |V_\theta| + \ln |J^T V_\theta^{-1} J| + (M - p) \ln r^T P_\theta r .

The result averages over a table of theta, weighted by likelihood times prior. The error of a fitted
quantity, the sum w_i e_i, then has a mixture of Student distributions with variances w^T V w. Few
data, which cannot distinguish a drift from a slope, thus give wider intervals than many. For
independent errors the mixture reduces to a slightly wider Student's t.
"""

from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import numpy.typing as npt
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import brentq
from scipy.stats import t as student

from viscotack.arrays import Array

from .observed import Observed

_TRENDS = (-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0)  # of the logarithm of the variance
_SHARED = (0.5, 1.0, 2.0, 4.0, 8.0)  # ratio of the common to the independent error
_LENGTHS = (0.7, 2.3, 7.0)  # of a drift: a third of a decade, one, three
_TREND_PRIOR = 1.0  # standard deviation of a trend, before the data
# Prior probability of independent errors: instruments drift over time, less so over frequency.
_OWN, _OWN_IN_TIME = 0.8, 0.4
_ROWS = 160  # above this number, neighbours are averaged first


@dataclass(frozen=True)
class _Form:
    """One covariance of the errors: trend, error common to a sweep, drift and its length."""

    trend: float
    sweep: float = 0.0
    drift: float = 0.0
    length: float = 1.0

    @property
    def shared(self) -> bool:
        """Whether the errors are correlated."""
        return self.sweep > 0 or self.drift > 0


@dataclass(frozen=True, eq=False)
class Rows:
    """Part, position on the axis and sweep of each number, in the order of the residuals."""

    part: npt.NDArray[np.int64]
    log: Array
    sweep: npt.NDArray[np.int64] | None

    @classmethod
    def of(cls, data: Observed) -> "Rows":
        """Return the rows of measured numbers."""
        parts, points = data.values.shape
        sweep = None
        if data.sweep is not None and 1 < np.unique(data.sweep).size < points:
            sweep = np.tile(data.sweep, parts)
        return cls(np.repeat(np.arange(parts), points), np.tile(np.log(data.at), parts), sweep)

    def covariance(self, form: _Form) -> Array:
        """Return the covariance matrix of a form; its uncorrelated part has mean diagonal 1."""
        span = max(float(np.ptp(self.log)), 1e-12)
        u = 2 * (self.log - np.min(self.log)) / span - 1
        own = np.exp(form.trend * u)
        V = np.diag(own / np.mean(own))
        if form.sweep and self.sweep is not None:
            V += form.sweep**2 * (self.sweep[:, None] == self.sweep)
        if form.drift:
            near = np.exp(-np.abs(self.log[:, None] - self.log) / form.length)
            V += form.drift**2 * near * (self.part[:, None] == self.part)
        return V


@dataclass(frozen=True, eq=False)
class Errors:
    """Posterior of the error covariance, given the residuals of a fit.

    Attributes
    ----------
    rows : Rows
        Part, position and sweep of the numbers.
    forms : tuple of _Form
        Candidate covariances.
    weights : ndarray, shape (F,)
        Probability of each; the sum is 1.
    scales : ndarray, shape (F,)
        Factor s of each.
    degrees : int
        Numbers minus constants.
    """

    rows: Rows
    forms: tuple[_Form, ...]
    weights: Array
    scales: Array
    degrees: int

    def half_width(self, influences: Array, level: float) -> Array:
        """Return the half-width of the confidence intervals of quantities.

        Parameters
        ----------
        influences : ndarray, shape (Q, M)
            Derivative of each quantity with respect to the error of each number.
        level : float
            Of the interval from -half to half, in (0, 1).
        """
        deviations = np.sqrt([np.diag(V) for V in self._covariances(influences)]).T
        far = float(student.ppf((1 + level) / 2, self.degrees)) * (1 + 1e-9)
        half = np.max(deviations, axis=1) * far
        for i in np.flatnonzero(half):
            each = np.maximum(deviations[i], 1e-12 * half[i] / far)

            def excess(q: float, each: Array = each) -> float:
                inside = 2 * student.cdf(q / each, self.degrees) - 1
                return float(np.sum(self.weights * inside)) - level

            half[i] = brentq(excess, 0.0, half[i], xtol=1e-6 * half[i])
        return half

    def covariance(self, influences: Array) -> Array:
        """Return the covariance of quantities, shape (Q, Q)."""
        return np.einsum("f,fij->ij", self.weights, np.array(self._covariances(influences)))

    def drawn(self, count: int, random: np.random.Generator, *, sure: bool = True) -> Array:
        """Return random errors, shape (count, M); unless `sure`, their size is random too."""
        which = random.choice(len(self.forms), size=count, p=self.weights)
        found = np.empty((count, self.rows.log.size))
        for i in np.unique(which):
            mine = which == i
            root = np.linalg.cholesky(self.rows.covariance(self.forms[i]))
            own = random.normal(size=(int(np.sum(mine)), root.shape[0]))
            found[mine] = self.scales[i] * own @ root.T
        if sure:
            return found
        # a normal distribution of uncertain deviation gives Student's t
        return found * np.sqrt(self.degrees / random.chisquare(self.degrees, size=(count, 1)))

    def words(self) -> str:
        """Describe the correlation of the errors in words; empty for independent errors."""
        shared = np.array([form.shared for form in self.forms])
        if np.sum(self.weights[shared]) < 0.5:
            return ""
        likely = self.forms[int(np.argmax(np.where(shared, self.weights, 0)))]
        size = self.scales[self.forms.index(likely)]
        if likely.sweep:
            common = 100 * size * likely.sweep
            return f"the points of one sweep have a common error of {common:.2g} %"
        common, decades = 100 * size * likely.drift, likely.length / np.log(10)
        near = f"neighbouring points have correlated errors of {common:.2g} %"
        return f"{near} over {decades:.1g} decades: a local misfit, or the instrument drifts"

    def _covariances(self, influences: Array) -> list[Array]:
        """Return the covariance of quantities under each form."""
        return [
            s**2 * influences @ self.rows.covariance(form) @ influences.T
            for form, s in zip(self.forms, self.scales, strict=True)
        ]


def errors(data: Observed, residuals: Array, slopes: Array) -> Errors:
    """Estimate the error covariance from the residuals of a fit.

    Parameters
    ----------
    data : Observed
        The fitted numbers.
    residuals : ndarray, shape (P, N)
        ln(measured/fitted) over the noise of each part.
    slopes : ndarray, shape (P N, p)
        Change of the fitted logarithms over their noise with each constant.
    """
    rows = Rows.of(data)
    r = residuals.ravel()
    small = _averaged(rows, r, slopes)
    own = _OWN if data.in_frequency else _OWN_IN_TIME
    swept = rows.sweep is not None
    each = (1 - own) / (2 if swept else 1) / len(_SHARED)
    prior = {_Form(0.0): own}
    if swept:
        prior |= {_Form(0.0, sweep=a): each for a in _SHARED}
    drifts = product(_SHARED, _LENGTHS)
    prior |= {_Form(0.0, drift=b, length=length): each / len(_LENGTHS) for b, length in drifts}
    trended = [
        (replace(form, trend=g), share * float(np.exp(-((g / _TREND_PRIOR) ** 2) / 2)))
        for form, share in prior.items()
        for g in _TRENDS
    ]
    likelihood, scales = np.array([_likelihood(*small, form) for form, _ in trended]).T
    posterior = np.log([share for _, share in trended]) + likelihood
    weights = np.exp(posterior - np.max(posterior))
    weights /= np.sum(weights)
    # negligible terms are dropped
    keep = weights > 1e-2 * np.max(weights)
    forms = tuple(form for (form, _), yes in zip(trended, keep, strict=True) if yes)
    degrees = max(min(r.size, small[1].size) - slopes.shape[1], 1)
    return Errors(rows, forms, weights[keep] / np.sum(weights[keep]), scales[keep], degrees)


def _averaged(rows: Rows, r: Array, slopes: Array) -> tuple[Rows, Array, Array, Array]:
    """Average neighbours into at most about _ROWS rows; return rows, residuals, slopes, counts."""
    each = -(-r.size // _ROWS)
    if each == 1:
        return rows, r, slopes, np.ones(r.size)
    sweep = rows.sweep if rows.sweep is not None else np.zeros(r.size, dtype=np.int64)
    order = np.lexsort((rows.log, sweep, rows.part))
    block = rows.part[order] * (np.max(sweep) + 1) + sweep[order]
    fresh = np.concatenate(([True], np.diff(block) != 0))
    first = np.maximum.accumulate(np.where(fresh, np.arange(r.size), 0))
    place = np.arange(r.size) - first
    group = np.cumsum(fresh | (place % each == 0)) - 1
    count = np.bincount(group).astype(float)

    def mean(values: Array) -> Array:
        return np.bincount(group, weights=values[order]) / count

    small = Rows(
        np.round(mean(rows.part.astype(float))).astype(np.int64),
        mean(rows.log),
        None if rows.sweep is None else np.round(mean(sweep.astype(float))).astype(np.int64),
    )
    columns = np.column_stack([mean(column) for column in slopes.T])
    return small, mean(r), columns, count


def _likelihood(rows: Rows, r: Array, J: Array, count: Array, form: _Form) -> tuple[float, float]:
    """Return the logarithm of the restricted likelihood, up to a constant, and the factor s."""
    V = rows.covariance(form)
    own = np.diag(rows.covariance(replace(form, sweep=0.0, drift=0.0)))
    # the mean of n errors has 1/n of the variance
    V[np.diag_indices_from(V)] += own * (1 / count - 1)
    factor = cho_factor(V, lower=True)
    solved = cho_solve(factor, np.column_stack((r, J)))
    normal = J.T @ solved[:, 1:]
    # neighbouring arms are nearly collinear: the pseudo-inverse drops what is undetermined
    value, vector = np.linalg.eigh((normal + normal.T) / 2)
    kept = value > 1e-12 * max(float(value[-1]), 1e-300)
    part = vector[:, kept].T @ (J.T @ solved[:, 0])
    # r^T P r, ln |V| and ln |J^T V^-1 J|
    rest = max(float(r @ solved[:, 0] - np.sum(part**2 / value[kept])), 0.0)
    log_V = 2 * float(np.sum(np.log(np.diag(factor[0]))))
    log_J = float(np.sum(np.log(value[kept])))
    degrees = max(r.size - J.shape[1], 1)
    likelihood = -0.5 * (log_V + log_J + degrees * np.log(max(rest, 1e-300)))
    return likelihood, float(np.sqrt(rest / degrees))
