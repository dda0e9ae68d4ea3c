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

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.surrogate import physics
from viscotack.surrogate.answers import Answers, Intervals
from viscotack.surrogate.model import Surrogate
from viscotack.theory import lennard_jones

# Range of the extrapolation that was compared with simulations.
LEAST_TABOR, MOST_RATE, LEAST_RATIO = 1e-3, 1e16, 1e-6
SLOWER = "below a rate of {:g} the force tends to its slow limit in proportion to the rate"
# Increase of half an interval of log10 per decade of smaller Tabor number.
_WIDER = 2.5e-2
# The same for a modulus ratio below the range: for the slopes of force and work at the limit of
# the networks, and as a fraction of the extrapolation.
_SLOPE, _PART = np.array([1.5e-3, 4e-3]), 0.25
# The same for the work below the rates of the range.
_LAGS = 2e-3
# Ratio of two rates of which the forces give the slope; the same below the range, where the
# forces differ little from each other, and the largest ratio of logarithms of work and force.
_NEAR, _FASTER, _MOST_WORK = 1.001, 5.0, 10.0
# Largest slope with the modulus ratio: force in proportion to 1/k.
_STEEPEST = 1 - 1e-6


@dataclass(frozen=True, eq=False)
class Beyond:
    """Predictions beyond the training range, in the form of those inside.

    Attributes
    ----------
    answers : Answers
    intervals : Intervals
    with_work : bool
        Whether the work is predicted.
    why : str
        Reason in words.
    certain : bool
        Whether the surrogate is certain at the limit; false only below its rates.
    """

    answers: Answers
    intervals: Intervals
    with_work: bool
    why: str
    certain: bool = True


_Said = tuple[Answers, Intervals]


def beyond(learned: Surrogate, groups: Array, confidence: float) -> Beyond | None:
    """Predict one row of groups that exceeds only these three limits.

    Returns
    -------
    Beyond or None
        None if the row exceeds another limit, exceeds these too far, or if the surrogate is not
        certain at the limit.
    """
    mu, rate = groups[0, physics.TABOR], groups[0, physics.RATE]
    low, high = learned.limits["tabor"][0], learned.limits["rate"][1]
    k, least = groups[0, physics.MODULUS_RATIO], learned.limits["modulus_ratio"][0]
    at_end = groups.copy()
    slowest = learned.limits["rate"][0]
    at_end[0, physics.TABOR] = max(mu, low)
    at_end[0, physics.RATE] = min(max(rate, slowest), high)
    at_end[0, physics.MODULUS_RATIO] = max(k, least)
    near = LEAST_TABOR <= mu and rate <= MOST_RATE and k >= LEAST_RATIO
    if not (near and learned.inside(at_end).all()) or (k < least and (mu < low or rate > high)):
        return None
    said, held, force_doubtful, work_doubtful = _evaluated(learned, at_end, confidence)
    if force_doubtful and rate >= slowest:
        return None
    why = []
    if rate < slowest:
        said, held = _slowed(learned, at_end, (said, held), float(rate / slowest))
        why.append(SLOWER.format(slowest))
    if rate > high:
        rows = at_end.copy()
        rows[0, physics.EXPONENT] = learned.limits["exponent"][1]
        glassy = learned.tests(rows)
        most = learned.evaluate(glassy)
        ends = (said, held), (most, learned.intervals(glassy, most, confidence=confidence))
        said, held = _between(*ends, _parts(learned, at_end, ends, float(rate / high)))
        why.append(
            f"above a rate of {high:g} the force lies between its value there and the fast limit"
        )
    if mu < low:
        factor = float(lennard_jones.pull_off_ratio(mu) / lennard_jones.pull_off_ratio(low))
        wider = _WIDER * float(np.log10(low / mu))
        said, held = _times(said, held, (factor, 1.0), (wider, 0.0))
        why.append(f"below a Tabor number of {low:g} adhesion hardly changes the surface")
    if k < least:
        ways = _with_ratio(learned, at_end, float(k / least))
        said, held = _times(said, held, np.exp(ways), _SLOPE + _PART * np.abs(ways) / np.log(10))
        why.append(
            f"below a modulus ratio of {least:g} the force is extrapolated by its slope there"
        )
    with_work, certain = mu >= low and not work_doubtful, not force_doubtful
    return Beyond(said, held, with_work, "; ".join(why), certain)


def _evaluated(
    learned: Surrogate, at_end: Array, confidence: float
) -> tuple[Answers, Intervals, bool, bool]:
    """Return a prediction at the limit, its intervals, and whether force and work are doubtful."""
    tests = learned.tests(at_end)
    said = learned.evaluate(tests)
    force_doubtful, work_doubtful = learned.doubtful(tests, said)[0].tolist()
    held = learned.intervals(tests, said, confidence=confidence)
    return said, held, force_doubtful, work_doubtful


def slower(learned: Surrogate, groups: Array, confidence: float) -> Beyond | None:
    """Predict one row of groups that exceeds only the smallest rate; None if it does not."""
    column = learned.contact.inputs.index("rate")
    rate, slowest = groups[0, column], learned.limits["rate"][0]
    at_end = groups.copy()
    at_end[0, column] = slowest
    if not (0 < rate < slowest and learned.inside(at_end).all()):
        return None
    said, held, force_doubtful, work_doubtful = _evaluated(learned, at_end, confidence)
    said, held = _slowed(learned, at_end, (said, held), float(rate / slowest))
    why = SLOWER.format(slowest)
    return Beyond(said, held, not work_doubtful, why, not force_doubtful)


def _slowed(learned: Surrogate, at_end: Array, ends: _Said, ratio: float) -> _Said:
    """Extrapolate a prediction at the smallest rate to one smaller by a factor."""
    (said, held), tests, faster = ends, learned.tests(at_end), at_end.copy()
    faster[0, learned.contact.inputs.index("rate")] *= _FASTER
    more = learned.evaluate(faster)
    excess = 1 - 10 ** float(np.mean(tests.slow)) / float(said.pull_off_force[0])
    force = np.log1p(-excess * (1 - ratio))
    rise = np.log(more.pull_off_force[0] / said.pull_off_force[0])
    of_work = np.log(more.work_to_pull_off[0] / said.work_to_pull_off[0])
    work = force * np.clip(of_work / max(rise, 1e-9), 0.0, _MOST_WORK)
    wider = (0.0, _LAGS + _PART * abs(work) / np.log(10))
    said, held = _times(said, held, np.exp([force, work]), wider)
    if tests.least is not None:
        least = 10 ** tests.least[:, None]
        held = replace(held, pull_off_force=np.maximum(held.pull_off_force, least))
    return said, held


def _with_ratio(learned: Surrogate, at_end: Array, ratio: float) -> Array:
    """Return ln of the change of force and work for a modulus ratio smaller by a factor."""
    force, work = (-float(of[0, physics.MODULUS_RATIO]) for of in learned.slopes(at_end))
    steep = float(np.clip(force, 1e-9, _STEEPEST))
    way = -np.log1p(-steep * (1 - ratio))
    return np.array([way, way * min(work / steep, 1.0) if work > 0 else work * (1 - ratio)])


def _parts(
    learned: Surrogate, at_end: Array, ends: tuple[_Said, _Said], ratio: float
) -> tuple[float, float]:
    """Return the part of the way to the fast limit for a rate larger by a factor, and its most."""
    slower = at_end.copy()
    slower[0, physics.RATE] /= _NEAR
    forces = [
        float(said.pull_off_force[0]) for said in (learned.evaluate(slower), ends[0][0], ends[1][0])
    ]
    # one difference: the derivatives by all inputs take twenty evaluations
    steep = max(np.log(forces[1] / forces[0]) / np.log(_NEAR), 0.0) * np.log(ratio)
    way = np.log(forces[2] / forces[1])
    # hardly any way is left where the force is at its fast limit
    passed = float(steep / max(way, 1e-9))
    return -float(np.expm1(-passed)), min(2 * passed, 1.0)


def _between(one: _Said, other: _Said, parts: tuple[float, float]) -> _Said:
    """Return a prediction at a part of the logarithmic way from one to another.

    Its interval contains those of the first and at the larger part.
    """
    (a, held_a), (b, held_b), (part, most) = one, other, parts

    def along(x: Array, y: Array, share: float) -> Array:
        return x ** (1 - share) * y**share

    def hull(x: Array, y: Array) -> Array:
        far = along(x, y, most)
        return np.column_stack([np.minimum(x, far)[:, 0], np.maximum(x, far)[:, 1]])

    return (
        replace(
            a,
            pull_off_force=along(a.pull_off_force, b.pull_off_force, part),
            work_to_pull_off=along(a.work_to_pull_off, b.work_to_pull_off, part),
        ),
        replace(
            held_a,
            pull_off_force=hull(held_a.pull_off_force, held_b.pull_off_force),
            work_to_pull_off=hull(held_a.work_to_pull_off, held_b.work_to_pull_off),
        ),
    )


def _times(
    said: Answers, held: Intervals, factors: npt.ArrayLike, wider: npt.ArrayLike
) -> tuple[Answers, Intervals]:
    """Scale force and work, and widen their intervals by amounts in log10."""
    (force, work), (of_force, of_work) = np.asarray(factors), np.asarray(wider)
    side = np.array([-1.0, 1.0])
    return (
        replace(
            said,
            pull_off_force=said.pull_off_force * force,
            work_to_pull_off=said.work_to_pull_off * work,
        ),
        replace(
            held,
            pull_off_force=held.pull_off_force * force * 10 ** (of_force * side),
            work_to_pull_off=held.work_to_pull_off * work * 10 ** (of_work * side),
        ),
    )
