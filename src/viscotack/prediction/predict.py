"""Predict by the best tier within a time budget: surrogate, theory or simulation."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from statistics import NormalDist
from typing import TYPE_CHECKING, Any

import numpy as np

from viscotack.errors import InputError
from viscotack.model.materials.conversion import slowed
from viscotack.model.problem import Case
from viscotack.prediction.surrogate.trust import check_confidence

from .cautions import cautions_on
from .prediction import Prediction, depth_between
from .tier import Question
from .tiers import EXACT, SOON, best, by_model

if TYPE_CHECKING:
    from viscotack.model.materials.passport import Passport
    from viscotack.prediction.surrogate.model import Surrogate


def predict(
    problem: Case,
    *,
    confidence: float = 0.9,
    joint: bool = False,
    shift_deviation: float = 0.0,
    budget: float = SOON,
    exact: bool = False,
    model: Surrogate | None = None,
    passport: Passport | None = None,
) -> Prediction:
    """Predict the pull-off force, the work to pull-off and the unloading curve.

    Parameters
    ----------
    problem : Problem or Groups
        In SI or dimensionless.
    confidence : float
        Fraction of cases inside the intervals: 0.5, 0.6, 0.7, 0.8, 0.9, 0.95 or 0.98, for
        which they were measured. Bands of theories and simulations exist for 0.9 only.
    joint : bool
        Whether force, work and curve of a surrogate are inside together with this confidence,
        instead of each alone; :attr:`Prediction.joint` is true where such intervals were measured.
    shift_deviation : float
        Standard deviation of log10 a_T, the uncertainty of the material's times, from
        :meth:`viscotack.model.materials.passport.Passport.shift_deviation`. It widens the
        intervals: the problem is also predicted for slower and faster material.
    budget : float
        Largest time of the prediction [s]. Up to 0.01 s only surrogates are used; from 0.02 s also
        closed forms, from 0.5 s the contact whose edge is a steady crack, from 1 s the simulation
        where a surrogate is not certain, from 3 s also where none applies. The cost of a tier is a
        fixed number, so the same budget gives the same result on every machine.
    exact : bool
        Whether to simulate regardless of the time: the result of :func:`viscotack.solve`.
    model : Surrogate, optional
        A surrogate to use alone in place of the tiers.
    passport : Passport, optional
        Passport of the material at the temperature of the problem, for
        :attr:`Prediction.cautions`; it does not change the numbers.

    Returns
    -------
    Prediction
        Prediction of the best verified tier within the budget.

    Raises
    ------
    OutOfRange
        If no tier within the budget was verified for this problem; the message names the input and
        its range.
    ValueError
        If there is no relaxed contact to pull off, or the confidence is not in the list.
    TypeError
        If `problem` is not a problem, for example a file name.

    Notes
    -----
    The surrogates of spheres cover the retraction at constant speed from a relaxed solid, with
    the Lennard-Jones traction and a rigid machine. They were trained on
    :class:`viscotack.RetardationPowerLaw`. Any other linear solid is replaced by the power law with
    the same creep around the times of the test (:mod:`.surrogate.linear_solids`), with intervals
    measured on other solids. The surrogate of flat punches covers the same test on a layer of a
    standard solid that slides on its base (:mod:`.surrogate.punch_physics`).
    :mod:`.tiers` lists the other tiers and their verified ranges.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, RetardationPowerLaw
    >>> material = RetardationPowerLaw(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, exponent=0.8, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> groups = Groups(tabor=3.24, material=material.reduced(), start=AtDepth(73), rate=316.23)
    >>> answer = predict(groups)
    >>> f"{answer.pull_off_force:.1f} by {answer.method}"
    '7.3 by surrogate'
    """
    asked = Question(problem, confidence, joint, model)
    check_confidence(confidence)
    if not budget > 0:
        raise InputError(f"budget must be a positive time in seconds, got {budget!r}")
    if model is not None and exact:
        raise InputError("give either a model or exact=True; a simulation does not use the model")
    if model is not None:
        found = by_model(asked)
    else:
        found = EXACT.ask(asked) if exact else best(asked, budget)
    found = replace(found, warn=partial(cautions_on, problem, passport=passport))
    if not shift_deviation > 0:
        return found
    decades = NormalDist().inv_cdf((1 + confidence) / 2) * shift_deviation
    others = [
        predict(
            _slower(problem, factor),
            confidence=confidence,
            joint=joint,
            budget=budget,
            exact=exact,
            model=model,
        )
        for factor in (10.0**-decades, 10.0**decades)
    ]
    return _widened_by(found, others, shift_deviation)


def _slower(problem: Case, factor: float) -> Case:
    """Return a problem whose material times are multiplied by a factor."""
    return replace(problem, material=slowed(problem.material, factor))


def _widened_by(found: Prediction, others: list[Prediction], deviation: float) -> Prediction:
    """Return a prediction whose intervals include the uncertainty of the material's times."""
    work = None
    if found.work_to_pull_off is not None and found.work_interval is not None:
        known = [each.work_to_pull_off for each in others if each.work_to_pull_off is not None]
        work = _widened(found.work_to_pull_off, found.work_interval, known)
    forces = [each.pull_off_force for each in others]
    wider = replace(
        found,
        interval=_widened(found.pull_off_force, found.interval, forces),
        work_interval=work,
        **_curve_widened(found, others),
        why=f"{found.why}; intervals include an uncertainty of {deviation:.2g} decades of the "
        "material's times, from its shift",
    )
    return replace(wider, depth_interval=depth_between(wider))


def _curve_widened(found: Prediction, others: list[Prediction]) -> dict[str, Any]:
    """Return the bands of a curve, widened to include the curves of other predictions."""
    curve = found.curve
    if curve is None or found.curve_band is None:
        return {}
    far = max(abs(each.pull_off_force - found.pull_off_force) for each in others)
    wider: dict[str, Any] = {"curve_band": float(np.hypot(found.curve_band, far))}
    if found.zero_force_depth is None or found.zero_force_interval is None:
        return wider
    start, (low, high) = float(curve.depth[0]), found.zero_force_interval
    known = [start - x for each in others if (x := each.zero_force_depth) is not None]
    least, most = _widened(start - found.zero_force_depth, (start - high, start - low), known)
    return wider | {"zero_force_interval": (start - most, start - least)}


def _widened(
    value: float, interval: tuple[float, float], others: list[float]
) -> tuple[float, float]:
    """Return an interval widened by other predictions, in quadrature of logarithms."""
    low, high = interval
    down = max([np.log(value / other) for other in others if other < value], default=0.0)
    up = max([np.log(other / value) for other in others if other > value], default=0.0)
    return (
        float(value * np.exp(-np.hypot(np.log(value / low), down))) if low > 0 else low,
        float(value * np.exp(np.hypot(np.log(high / value), up))),
    )
