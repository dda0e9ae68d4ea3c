r"""Fit an elastic contact to every curve of a folder: work of adhesion and modulus, with scatter.

Each retraction gives the work of adhesion, the contact modulus and, against depth, the unknown zero
of the depth, by least squares. Their standard errors are those of the linearised model,
:math:`s^2 (J^T J)^{-1}` with the scatter s of the residuals: they contain the noise of one curve
only. Curves of equal temperature and speed are averaged; the interval of a mean is Student's, from
the scatter between the curves.

The work is that of the fastest place of the edge: of a viscoelastic solid it grows with speed and
is an upper bound of the work of adhesion (:func:`viscotack.identify.identify_slow`).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import t

from viscotack.errors import InputError
from viscotack.lab.tack import Cycle
from viscotack.lab.tack.record import Measured
from viscotack.lab.tack.repeats import same_speeds, temperature_of

from .approach import of_every
from .contacts import MODELS
from .slow_tests import SlowTest, slow_test, with_own_scatter


@dataclass(frozen=True, eq=False)
class CurveFit:
    """Elastic contact fitted to one retraction.

    Attributes
    ----------
    cycle : Cycle
        The curve.
    model : str
        "jkr" or "dmt".
    test : SlowTest
        Its fitted points.
    values : mapping
        All fitted values, by the names of the model.
    work_of_adhesion, contact_modulus : Measured
        [J/m2] and [Pa], with the standard error of the fit.
    scatter : float
        Standard deviation of the residuals [N].
    """

    cycle: Cycle
    model: str
    test: SlowTest
    values: Mapping[str, float]
    work_of_adhesion: Measured
    contact_modulus: Measured
    scatter: float


@dataclass(frozen=True)
class Mean:
    """Mean of repeated curves, their standard deviation, and the interval of the mean.

    The deviation and the ends are None for a single curve.
    """

    value: float
    deviation: float | None
    low: float | None
    high: float | None


@dataclass(frozen=True, eq=False)
class CurveGroup:
    """Curves of one temperature [K] and speed [m/s], and their means [J/m2], [Pa] and [N]."""

    curves: tuple[CurveFit, ...]
    temperature: float | None
    speed: float
    work_of_adhesion: Mean
    contact_modulus: Mean
    pull_off_force: Mean


def fit_curves(
    cycles: Sequence[Cycle],
    radius: float,
    *,
    model: str = "jkr",
    contact_modulus: tuple[float, float] | None = None,
) -> tuple[tuple[CurveFit, ...], tuple[str, ...]]:
    """Fit JKR or DMT to the retraction of every cycle.

    Parameters
    ----------
    cycles : sequence of Cycle
        Evaluated cycles of tack tests or force curves.
    radius : float
        Radius of the sphere [m].
    model : {"jkr", "dmt"}
        Elastic contact, of a large or a small Tabor number.
    contact_modulus : (float, float), optional
        Known E0* and its standard uncertainty [Pa]; fitted without a prior by default.

    Returns
    -------
    fits : tuple of CurveFit
        Of the curves that can be fitted.
    refused : tuple of str
        The others, each with its reason.

    Raises
    ------
    InputError
        If the model is another one.
    """
    if model not in ("jkr", "dmt"):
        raise InputError(f"model must be jkr or dmt, got {model!r}", field="model")

    def fitted(cycle: Cycle) -> CurveFit:
        test = slow_test(cycle, radius)
        size, ((objective, best),) = with_own_scatter(test, [MODELS[model]], contact_modulus)
        errors = np.sqrt(np.diag(objective.covariance(best)))
        work, modulus = (
            Measured(best.values[one.name], float(error) * best.values[one.name])
            for one, error in zip(objective.parameters[:2], errors, strict=False)
        )
        scatter = float(size * np.mean(test.sigma))
        return CurveFit(cycle, model, test, best.values, work, modulus, scatter)

    return of_every(cycles, fitted)


def group_curves(fits: Sequence[CurveFit], level: float = 0.9) -> tuple[CurveGroup, ...]:
    """Return the means of the curves of each temperature and speed, coldest and slowest first.

    Parameters
    ----------
    fits : sequence of CurveFit
        Of :func:`fit_curves`.
    level : float
        Confidence level of the intervals of the means.
    """
    if not 0 < level < 1:
        raise InputError(f"level must lie between 0 and 1, got {level!r}", field="level")
    groups = []
    for same in same_speeds([fit.cycle for fit in fits]):
        # in the order of the files, which shows a drift
        curves = tuple(fit for fit in fits if any(fit.cycle is cycle for cycle in same))
        work = _mean([fit.work_of_adhesion.value for fit in curves], level)
        modulus = _mean([fit.contact_modulus.value for fit in curves], level)
        force = _mean([one.pull_off_force.value for one in same], level)
        speed = float(np.mean([one.speed.value for one in same]))
        groups.append(CurveGroup(curves, temperature_of(same), speed, work, modulus, force))
    return tuple(groups)


def _mean(values: Sequence[float], level: float) -> Mean:
    mean = float(np.mean(values))
    if len(values) == 1:
        return Mean(mean, None, None, None)
    deviation = float(np.std(values, ddof=1))
    half = float(t.ppf((1 + level) / 2, len(values) - 1)) * deviation / np.sqrt(len(values))
    return Mean(mean, deviation, mean - half, mean + half)
