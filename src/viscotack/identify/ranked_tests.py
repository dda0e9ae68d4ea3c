r"""Rank tests by how much each narrows a forecast, or the interface, before it is made.

Interfaces sampled from the posterior of a rate series give ln of the force of each candidate test
(c) and of each wanted answer (q); with the errors of theory, material and machine their joint
covariance is known. A test with the relative noise :math:`\sigma` leaves of a wanted variance

.. math:: V_{q|c} = V_{qq} - \frac{V_{qc}^2}{V_{cc} + \sigma^2} ,

the linear update of a normal distribution (Lindley 1956, doi:10.1214/aoms/1177728069). The best
test leaves the smallest mean variance; the next one follows from the covariance that it leaves.
No test is simulated or fitted for this.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.units import readable

from .covariances import ModelError
from .forecasting import conditioned
from .forward import Interface
from .pull_off import Trial
from .rate_fit import RateSeriesFit
from .search import LEAST_TABOR

# Number of sampled interfaces, step of logarithms for slopes, and most candidates.
_DRAWS, _STEP, _MOST = 100, 0.05, 500
# Least noise of a test [-]; a rig without scatter would make every test decisive.
_QUIET = 1e-3


@dataclass(frozen=True)
class RankedTest:
    """A test and what it leaves of the uncertainty.

    Attributes
    ----------
    trial : Trial
        The test, with its preload and radius.
    force : float
        Predicted pull-off force [N].
    uncertain : float
        Relative standard uncertainty of this prediction.
    left : float
        Standard deviation of ln of the wanted answers after the test, root mean square.
    """

    trial: Trial
    force: float
    uncertain: float
    left: float


@dataclass(frozen=True)
class NextTests:
    """Tests in the order of what they leave of the uncertainty, the best first.

    Attributes
    ----------
    ranked : tuple of RankedTest
        All tests, each alone.
    sequence : tuple of RankedTest
        The best test, the best after it, and so on; `left` counts all up to it.
    now : float
        Standard deviation of ln of the wanted answers today, root mean square.
    noise : float
        Relative noise of a test.
    refused : tuple of (Trial, str)
        Tests for which the theory does not hold, with the reason.
    words : tuple of str
        Remarks.
    """

    ranked: tuple[RankedTest, ...]
    sequence: tuple[RankedTest, ...]
    now: float
    noise: float
    refused: tuple[tuple[Trial, str], ...]
    words: tuple[str, ...]


def next_tests(
    fit: RateSeriesFit,
    candidates: Sequence[Trial],
    *,
    wanted: Sequence[Trial] = (),
    noise: float | None = None,
    repeats: int = 1,
    count: int = 3,
) -> NextTests:
    """Rank tests by how much each narrows a wanted answer.

    Parameters
    ----------
    fit : RateSeriesFit
        Fit of the series measured so far.
    candidates : sequence of Trial
        Tests that can be made, at the temperature of the series.
    wanted : sequence of Trial
        Tests whose forces are forecast; by default work of adhesion and range are wanted.
    noise : float, optional
        Relative standard deviation of the force of one test; by default that of the series.
    repeats : int
        Number of repetitions of each test.
    count : int
        Length of the sequence.

    Returns
    -------
    NextTests
        The tests in order.

    Raises
    ------
    OutOfRange
        If the theory holds for no candidate, or not for a wanted test.
    ValueError
        If an argument is invalid.
    """
    stated = fit.search.tests.stated
    tests, asked = [stated(one) for one in candidates], [stated(one) for one in wanted]
    if not 0 < len(tests) <= _MOST or len(asked) > _MOST:
        raise InputError(
            f"give 1 to {_MOST} candidates and up to {_MOST} wanted tests; got {len(tests)} and "
            f"{len(asked)}"
        )
    if repeats < 1 or count < 1:
        raise InputError(f"repeats and count must be at least 1, got {repeats} and {count}")
    if noise is not None and not 0 < noise < 1:
        raise InputError(f"the noise must lie between 0 and 1, got {noise:g}")
    one = max(noise or noise_of(fit), _QUIET)
    why = {each: _invalid(fit, each) for each in dict.fromkeys([*tests, *asked])}
    for each in asked:
        if why[each]:
            raise OutOfRange(f"no forecast of {each.words}: {why[each]}")
    refused = tuple((each, why[each]) for each in tests if why[each])
    tests = [each for each in tests if not why[each]]
    if not tests:
        raise OutOfRange(f"the theory holds for none of the tests: {refused[0][1]}")
    mean, covariance = _joint(fit, [*tests, *asked], about_interface=not asked)
    n, variance = len(tests), one**2 / repeats

    def after(covariance: Array, test: int) -> Array:
        """Return the covariance after a test."""
        column = covariance[:, test]
        return covariance - np.outer(column, column) / (column[test] + variance)

    def left(covariance: Array) -> float:
        """Return the root mean square deviation of the wanted answers, which follow the tests."""
        return float(np.sqrt(max(np.mean(np.diag(covariance)[n:]), 0.0)))

    now = left(covariance)
    forces, uncertain = np.exp(mean).tolist(), np.sqrt(np.diag(covariance)).tolist()
    ranked = [
        RankedTest(each, forces[i], uncertain[i], left(after(covariance, i)))
        for i, each in enumerate(tests)
    ]
    sequence: list[RankedTest] = []
    for _ in range(min(count, n)):
        best = int(np.argmin([left(after(covariance, i)) for i in range(n)]))
        covariance = after(covariance, best)
        sequence.append(replace(ranked[best], left=left(covariance)))
    words = []
    if fit.ageing is not None:
        words.append(f"all tests are {readable(fit.given.middle_time, 's', digits=2)} in contact")
    if len(fit.solutions) > 1:
        words.append(
            f"{len(fit.solutions)} separate interfaces fit the series; the ranking takes their "
            "samples as one normal distribution"
        )
    what = "ln(force) of the forecast" if asked else "ln(work of adhesion) and ln(range)"
    words.append(f"now, and left with a test: standard deviation of {what}, root mean square")
    order = tuple(sorted(ranked, key=lambda x: x.left))
    return NextTests(order, tuple(sequence), now, one, refused, tuple(words))


def noise_of(fit: RateSeriesFit) -> float:
    """Return the relative noise of a test of a series: median over its speeds."""
    given = fit.given.scatter, fit.between_speeds
    rows = [(x.force.uncertainty / x.force.value, *given) for x in fit.series]
    return float(np.median(np.linalg.norm(rows, axis=1)))


def _invalid(fit: RateSeriesFit, trial: Trial) -> str:
    """Return why the theory does not hold for a test, or ""."""
    one = fit.search.tests.of([trial])
    try:
        one.forward.check(dwell=one.moves)
        found = one.pulled(fit.interface)
    except InputError as error:
        return str(error)
    effective = float(found.effective_tabor[0])
    if effective < LEAST_TABOR:
        return (
            f"the cohesive zone is as large as the contact: effective Tabor number {effective:.3g},"
            f" valid from {LEAST_TABOR:g}"
        )
    return "" if np.isfinite(found.force[0]) else "there is no pull-off"


def _joint(
    fit: RateSeriesFit, tests: Sequence[Trial], *, about_interface: bool
) -> tuple[Array, Array]:
    """Return mean and joint covariance of ln of the forces, and of work and range if wanted."""
    draws = fit.sampled().thinned(_DRAWS)
    interfaces = np.log(np.hstack([draws["work_of_adhesion"], draws["equilibrium_gap"]]))
    order = sorted(range(len(tests)), key=lambda i: tests[i].radius or 0.0)
    groups = [
        fit.search.tests.of(list(same))._replace(moves=())
        for _, same in groupby((tests[i] for i in order), key=lambda x: x.radius)
    ]
    model = ModelError.of_theory(fit.given.theory_error, len(tests))
    moved, spread = conditioned(fit, groups, draws, model)
    back = np.argsort(order)
    moved, spread = moved[:, back], spread[np.ix_(back, back)]
    for i, each in enumerate(tests):
        if each.dwell is not None:
            moved[:, i] += _history_effect(fit, each, interfaces)
    if about_interface:
        moved = np.concatenate([moved, interfaces], axis=1)
        spread = np.pad(spread, (0, 2))
    return moved.mean(axis=0), np.cov(moved.T) + spread


def _history_effect(fit: RateSeriesFit, trial: Trial, interfaces: Array) -> Array:
    """Return ln of the ratio of the force after a dwell to that of a relaxed contact.

    It is linear in `interfaces`, ln of work and range, about the most likely interface.
    """
    middle, tests = np.log(fit.interface[:2]), fit.search.tests.of([trial])

    def ratio(at: Array) -> float:
        work, gap = np.exp(at).tolist()
        found = tests.changed(Interface(work, gap, fit.interface.growth))
        if why := str(found.refused[0]):
            raise OutOfRange(f"{trial.words}: {why}")
        return float(np.log(found.ratio[0]))

    own = ratio(middle)
    slopes = np.array([(ratio(middle + step) - own) / _STEP for step in _STEP * np.eye(2)])
    return own + (interfaces - middle) @ slopes
