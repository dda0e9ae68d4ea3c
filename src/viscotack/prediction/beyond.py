r"""Physical extrapolation of the surrogates beyond limits of their training ranges.

**Rates above 1e10 h0/tau0.** The force P lies between that at the limit and that of a solid without
relaxation, the fast limit G of the same start, which is part of the training. It approaches G from
its value :math:`P_0` and slope :math:`s = d \ln P/d \ln r` at the limit :math:`r_0`, so that it is
continuous there:

.. math:: \ln \frac{P}{P_0} = t \ln \frac{G}{P_0} , \qquad
          t = 1 - \left( \frac{r}{r_0} \right)^{-s/\ln (G/P_0)} .

The interval reaches from that at the limit to that for twice the slope, at most that of G. The
logarithm of the work passes the same part t of its way. For exponents above about 0.5 both ends
are equal within the interval.

**Rates below the range.** There the creep lags by a time that is short compared with the test, so
that the force exceeds its slow limit S in proportion to the rate:
:math:`P = S + (P_0 - S) r/r_0`. The logarithm of the work goes the same part of its way, with the
ratio of both that the surrogate has between the limit and ``_FASTER`` times its rate.

**Tabor numbers below 0.01.** Adhesion deforms the solid by about mu gaps or less, and the start's
depth has hardly deformed the surface: at given depth, rate and solid, the force over its
slow limit f(mu) is that at 0.01 within some per cent per decade. The work is not, because it
includes about half a gap of travel that a stiffer contact does not have.

**Modulus ratios below 1e-4.** A crack in a solid of compliance c, relative to the relaxed
one, dissipates an energy of about 1/c, where c is the sum of k and the creep g. So the force is
proportional to 1/(k + g) until k is small compared with g, where it becomes constant. The slope at
the limit, :math:`S = -d \ln P/d \ln k = k_0/(k_0 + g)`, determines the extrapolation:

.. math:: \ln \frac{P(k)}{P(k_0)} = -\ln \left[ 1 - S \left(1 - \frac{k}{k_0}\right) \right] .

Increasing work is extrapolated like the force. Decreasing work is extrapolated in proportion to k,
because it depends on the instantaneous compliance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.prediction.surrogate import physics
from viscotack.prediction.surrogate.model import Surrogate
from viscotack.theory import lennard_jones

# Range of the extrapolation that was compared with simulations.
LEAST_TABOR, MOST_RATE, LEAST_RATIO = 1e-3, 1e16, 1e-6
_SLOWER = "below a rate of {:g} the force tends to its slow limit in proportion to the rate"
# Increase of half an interval of ln(force) per decade of smaller Tabor number.
_WIDER = 2.5e-2 * np.log(10)
# The same of force and work for a modulus ratio below the range: for their slopes at the limit of
# the networks, and as a fraction of the extrapolation.
_SLOPE, _PART = np.array([1.5e-3, 4e-3]) * np.log(10), 0.25
# The same for the work below the rates of the range.
_LAGS = 2e-3 * np.log(10)
# Ratio of two rates of which the forces give the slope; the same below the range, where the
# forces differ little from each other, and the largest ratio of logarithms of work and force.
_NEAR, _FASTER, _MOST_WORK = 1.001, 5.0, 10.0
# Largest slope with the modulus ratio: force in proportion to 1/k.
_STEEPEST = 1 - 1e-6
_SIDES = np.array([[-1.0], [0.0], [1.0]])


@dataclass(frozen=True, eq=False)
class Beyond:
    """A prediction beyond the training range.

    Attributes
    ----------
    numbers : ndarray, shape (3, 2)
        Force and work: lower end of the interval, value, and upper end.
    with_work : bool
        Whether the work is predicted.
    why : str
        Reason in words.
    certain : bool
        Whether the surrogate is certain at the limit; false only below its rates.
    """

    numbers: Array
    with_work: bool
    why: str
    certain: bool = True


def beyond(learned: Surrogate, groups: Array, confidence: float) -> Beyond | None:
    """Predict one row of groups that exceeds only these limits of the sphere on power laws.

    Returns
    -------
    Beyond or None
        None if the row exceeds another limit, exceeds these too far, or if the surrogate is not
        certain at the limit.
    """
    mu, k, rate = groups[0, [physics.TABOR, physics.MODULUS_RATIO, physics.RATE]].tolist()
    (low, _), (least, _) = learned.limits["tabor"], learned.limits["modulus_ratio"]
    slowest, high = learned.limits["rate"]
    at_end = groups.copy()
    at_end[0, physics.TABOR] = max(mu, low)
    at_end[0, physics.RATE] = min(max(rate, slowest), high)
    at_end[0, physics.MODULUS_RATIO] = max(k, least)
    near = LEAST_TABOR <= mu and rate <= MOST_RATE and k >= LEAST_RATIO
    if not (near and learned.inside(at_end).all()) or (k < least and (mu < low or rate > high)):
        return None
    numbers, (force_doubtful, work_doubtful) = _evaluated(learned, at_end, confidence)
    if force_doubtful and rate >= slowest:
        return None
    why, logs = [], np.log(numbers)
    if rate < slowest:
        logs = _slowed(learned, at_end, logs, rate / slowest)
        why.append(_SLOWER.format(slowest))
    if rate > high:
        rows = at_end.copy()
        rows[0, physics.EXPONENT] = learned.limits["exponent"][1]
        glassy, _ = _evaluated(learned, rows, confidence)
        part = _part(learned, at_end, numbers[1, 0], glassy[1, 0], rate / high)
        way = np.log(glassy) - logs
        # the interval reaches from that at the limit to that for twice the slope
        far = logs + min(2 * part, 1.0) * way
        value = logs[1] + -np.expm1(-part) * way[1]
        logs = np.stack([np.minimum(logs, far)[0], value, np.maximum(logs, far)[2]])
        why.append(
            f"above a rate of {high:g} the force lies between its value there and the fast limit"
        )
    if mu < low:
        ratio = lennard_jones.pull_off_ratio(mu) / lennard_jones.pull_off_ratio(low)
        logs[:, 0] += np.log(ratio) + _SIDES[:, 0] * _WIDER * np.log10(low / mu)
        why.append(f"below a Tabor number of {low:g} adhesion hardly changes the surface")
    if k < least:
        ways = _with_ratio(learned, at_end, k / least)
        logs = logs + ways + _SIDES * (_SLOPE + _PART * np.abs(ways))
        why.append(
            f"below a modulus ratio of {least:g} the force is extrapolated by its slope there"
        )
    with_work = mu >= low and not work_doubtful
    return Beyond(np.exp(logs), with_work, "; ".join(why), not force_doubtful)


def slower(learned: Surrogate, groups: Array, confidence: float) -> Beyond | None:
    """Predict one row of groups that exceeds only the smallest rate; None if it does not."""
    column = learned.contact.inputs.index("rate")
    rate, slowest = float(groups[0, column]), learned.limits["rate"][0]
    at_end = groups.copy()
    at_end[0, column] = slowest
    if not (0 < rate < slowest and learned.inside(at_end).all()):
        return None
    numbers, (force_doubtful, work_doubtful) = _evaluated(learned, at_end, confidence)
    logs = _slowed(learned, at_end, np.log(numbers), rate / slowest)
    return Beyond(np.exp(logs), not work_doubtful, _SLOWER.format(slowest), not force_doubtful)


def _evaluated(
    learned: Surrogate, rows: Array, confidence: float
) -> tuple[Array, npt.NDArray[np.bool_]]:
    """Return the numbers of :class:`Beyond`, and whether force and work are doubtful."""
    tests = learned.tests(rows)
    said = learned.evaluate(tests)
    held = learned.intervals(tests, said, confidence=confidence)
    values = [said.pull_off_force[0], said.work_to_pull_off[0]]
    low, high = np.transpose([held.pull_off_force[0], held.work_to_pull_off[0]])
    return np.array([low, values, high]), learned.doubtful(tests, said)[0]


def _slowed(learned: Surrogate, at_end: Array, logs: Array, ratio: float) -> Array:
    """Extrapolate a prediction at the smallest rate to one smaller by a factor."""
    tests, faster = learned.tests(at_end), at_end.copy()
    faster[0, learned.contact.inputs.index("rate")] *= _FASTER
    more = learned.evaluate(faster)
    excess = 1 - np.exp(np.log(10) * np.mean(tests.slow) - logs[1, 0])
    force = np.log1p(-excess * (1 - ratio))
    rise, of_work = np.log([more.pull_off_force[0], more.work_to_pull_off[0]]) - logs[1]
    work = force * np.clip(of_work / max(rise, 1e-9), 0.0, _MOST_WORK)
    logs = logs + [force, work] + _SIDES * [0.0, _LAGS + _PART * abs(work)]
    if tests.least is not None:
        ends = np.maximum(logs[[0, 2], 0], np.log(10) * tests.least)
        logs[[0, 2], 0] = ends
    return logs


def _with_ratio(learned: Surrogate, at_end: Array, ratio: float) -> Array:
    """Return ln of the change of force and work for a modulus ratio smaller by a factor."""
    force, work = (-float(of[0, physics.MODULUS_RATIO]) for of in learned.slopes(at_end))
    steep = float(np.clip(force, 1e-9, _STEEPEST))
    way = -np.log1p(-steep * (1 - ratio))
    return np.array([way, way * min(work / steep, 1.0) if work > 0 else work * (1 - ratio)])


def _part(learned: Surrogate, at_end: Array, force: float, fast: float, ratio: float) -> float:
    """Return what the slope of ln(force) adds up to beyond the largest rate, over the way to go."""
    before = at_end.copy()
    before[0, physics.RATE] /= _NEAR
    # one difference: the derivatives by all inputs take twenty evaluations
    rise = float(np.log(force / learned.evaluate(before).pull_off_force[0]))
    # hardly any way is left where the force is at its fast limit
    return max(rise / np.log(_NEAR), 0.0) * np.log(ratio) / max(np.log(fast / force), 1e-9)
