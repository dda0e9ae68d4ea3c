"""Surrogate of spheres on any linear solid, as a tier: an equivalent power law with corrections."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from viscotack.errors import OutOfRange
from viscotack.model.materials import RetardationPowerLaw
from viscotack.model.problem import Groups
from viscotack.prediction.surrogate import linear_solids, physics, store
from viscotack.theory.elastic.lennard_jones import pull_off_ratio

from . import power_laws
from .beyond import beyond
from .learned import INSIDE, further_prediction, within
from .power_laws import inputs_of_sphere
from .prediction import Prediction
from .tier import ANY, SOLIDS, SURROGATE, Question, Uncertain

# Any linear solid: its creep is compared with that of the training data.
VERIFIED = replace(power_laws.VERIFIED, solids=ANY)
# Times of the modes that lag, in h0 over the speed, and their tolerance; the longest lag over the
# smallest rate up to which the excess of the force is nearly proportional to it, and the part of
# the excess that depends on the spectrum.
_SHORTEST, _LONGEST, _TOLERANCE = 1e-9, 1e3, 1e-6
_MOST_LAG, _OF_SPECTRUM, _ROUNDED = 5.0, 0.1, 1e-6


def by_solids(asked: Question) -> Prediction:
    """Evaluate the surrogate of solids other than power laws by retardation."""
    groups, solids = asked.groups, store.shipped("solids")
    if isinstance(groups.material, RetardationPowerLaw):
        raise OutOfRange(f"power laws by retardation are covered by the tier {SURROGATE!r}")
    rows, out = asked.once(inputs_of_sphere)
    if out:
        raise OutOfRange(out)
    like = _like(groups, float(rows[0, physics.PRELOAD]))
    if not solids.inside(like).all():
        most, farthest = solids.constants["farthest"]
        (far,) = linear_solids.far(like, solids.constants["spread"])
        raise OutOfRange(
            "the creep of the solid around h0 over the speed is unlike that of all solids in the "
            f"training data: it deviates from a power law by {like.unlike[0]:.2g} of the "
            "difference between glass and rubber, in logarithms, while the training data deviate "
            f"by up to {most:.2g} (in their directions by {far:.2g}, up to {farthest:.2g})"
        )
    slowest = physics.LIMITS["rate"][0]
    over = like.groups[0, physics.RATE] / slowest
    lag, variance = _lag(groups) if over <= _MOST_LAG else (np.inf, 0.0)
    if lag <= _MOST_LAG * slowest:
        return _by_lag(asked, like, lag, variance)
    if over <= 1 + _ROUNDED:
        raise Uncertain(
            "the solid is slower than its equivalent power law: its mean retardation time is "
            f"{lag:.3g} h0 over the speed"
        )
    why = (
        f"{INSIDE}; around the times of the test the solid creeps like a power law by retardation "
        f"with the exponent {like.groups[0, physics.EXPONENT]:.3g}, within {like.unlike[0]:.1g} of "
        "the difference between glass and rubber, in logarithms"
    )
    return within(asked, solids, solids.tests(like), SOLIDS, why)


def _like(groups: Groups, depth: float) -> linear_solids.Alike:
    """Return the power law equivalent to the solid of a test, for a start at a depth [h0]."""
    assert groups.rate is not None, "checked by the allow-list"
    material, k = groups.material, groups.modulus_ratio
    creep = np.asarray(material.creep(linear_solids.TIMES / groups.rate)) * material.rubbery_modulus
    # rounding may place it outside the range
    creep = np.clip(creep, k, 1.0)
    one = np.ones(1)
    learned = store.shipped("solids")
    return linear_solids.like(learned, groups.tabor * one, k * one, depth * one, creep[None])


def _lag(groups: Groups) -> tuple[float, float]:
    """Return the mean retardation time, in h0 over the speed, and its relative variance."""
    assert groups.rate is not None, "checked by the allow-list"
    modes = groups.material.retardation_modes(
        shortest=_SHORTEST / groups.rate, longest=_LONGEST / groups.rate, tolerance=_TOLERANCE
    )
    weights, times = np.array(modes.weights), groups.rate * np.array(modes.times)
    mean, square = (float(weights @ x) / (1 - groups.modulus_ratio) for x in (times, times**2))
    return mean, square / mean**2 - 1 if mean > 0 else 0.0


def _by_lag(asked: Question, like: linear_solids.Alike, lag: float, variance: float) -> Prediction:
    """Evaluate the surrogate of power laws for a solid that hardly lags behind the test.

    The force exceeds its slow limit in proportion to the mean retardation time, whatever the
    spectrum. The power law with the same mean and, as far as in the range, the same variance has
    nearly the same force.
    """
    learned, rows = store.shipped(), like.groups.copy()
    # the retardation times of a power law have the mean n tau0, and a relative variance of 1/n
    n = float(np.clip(1 / max(variance, _ROUNDED), *physics.LIMITS["exponent"]))
    columns = [physics.MODULUS_RATIO, physics.EXPONENT, physics.RATE]
    rows[0, columns] = asked.groups.modulus_ratio, n, lag / n
    why = f"the solid is nearly relaxed: it lags behind by {lag:.3g} h0 over the speed"
    if lag / n >= physics.LIMITS["rate"][0]:
        found = within(asked, learned, learned.tests(rows), SOLIDS, f"{INSIDE}; {why}")
    else:
        further = beyond(learned, rows, asked.confidence)
        found = further_prediction(asked, further, SOLIDS, why)
    slow, (low, high) = float(pull_off_ratio(asked.groups.tabor)), found.interval
    wider = _OF_SPECTRUM * max(found.pull_off_force - slow, 0.0)
    return replace(found, interval=(max(low - wider, min(low, slow)), high + wider))


TIERS = {SOLIDS: ((VERIFIED,), by_solids)}
