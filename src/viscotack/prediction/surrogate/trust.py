r"""Widths of intervals: a predicted local error size times a calibrated factor.

A separate network predicts the 90 % quantile of the errors around a case, of log10 of the force, of
log10 of the work, of the curve in tension and of log10 of the travel to zero force. Its inputs are
those of the case, the spread of the networks, and the slope of the force between its limits
(``research/training/calibration.py``). It is smooth, so the widths are too. The factor is chosen
such that the interval includes the desired fraction of cases outside the training data.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError

from .network import Networks


@dataclass(frozen=True, eq=False)
class Answers:
    """Predicted numbers, dimensionless; arrays of shape (n,).

    Attributes
    ----------
    pull_off_force : ndarray
        [1.5 pi R dg0], positive.
    work_to_pull_off : ndarray
        [1.5 pi R dg0 h0], from zero force or from a start in tension; nan if not predicted.
    force_spread, work_spread : ndarray
        Standard deviation of log10 between the networks.
    way, share : ndarray
        log10 of the fast over the slow limit of the force, and the fraction of it that is reached.
    more : mapping of str to ndarray
        Further outputs of the contact (:meth:`.contact.Contact.further`).
    """

    pull_off_force: Array
    work_to_pull_off: Array
    force_spread: Array
    work_spread: Array
    way: Array
    share: Array
    more: Mapping[str, Array] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Intervals:
    """Intervals of the simulated numbers.

    Attributes
    ----------
    pull_off_force, work_to_pull_off : ndarray, shape (n, 2)
        As in :class:`Answers`.
    curve : ndarray, shape (n,)
        Largest error of tensile forces over the pull-off force, at the same travel from
        zero force or from a start in tension.
    travel : ndarray, shape (n, 2)
        Travel from a compressed start to zero force, relative to that of the curve.
    """

    pull_off_force: Array
    work_to_pull_off: Array
    curve: Array
    travel: Array


CONFIDENCES = (0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98)
# Outputs of the network, and number of its inputs: five groups, their proximity to the ends of
# their ranges, the spreads of two predictions, position and slope of the force between its limits,
# and the differences of two predictions from those of the second networks.
OF, INPUTS = ("force", "work", "curve", "travel"), 12
# Distance from an end below which an input is near it, relative to half its range.
_NEAR = 0.03
# Spreads of log10 below this have no effect; their logarithms are of order one.
_LEAST_SPREAD, _DECADES = 1e-5, 2.0
# Differences of log10 below this have no effect, and their columns in the inputs.
_LEAST_DIFFERENCE, _COMPARED = 1e-3, slice(10, INPUTS)
# Differences of log10 of force and work between both models below which they agree, and the
# largest predicted error of a number that is given. Of 1,868 fresh works within it the worst was
# off by 5.8 %; with 5 % for works two were off by more than 10 %.
AGREED, WIDEST = np.log10([1.02, 1.06]), np.log10(1.03)
# Smallest distinguished distance of the fraction from 0 and 1, and smallest slope.
_LEAST_SHARE = 1e-6


def error_inputs(scaled: Array, answers: Answers, second: tuple[Array, Array]) -> Array:
    """Return the inputs of the network of the errors, shape (n, INPUTS).

    An error of the output of the network for the fraction s changes the force by s (1 - s) times
    the distance between its limits.

    Parameters
    ----------
    scaled : ndarray, shape (n, 5)
        Inputs of the cases, each scaled to [-1, 1] over its range.
    answers : Answers
        Predictions for the cases.
    second : pair of ndarray, shape (n,)
        log10 of force and work by the second networks.
    """
    spreads = answers.force_spread, answers.work_spread
    apart = [np.log10((s + _LEAST_SPREAD) / _LEAST_SPREAD) / _DECADES - 1 for s in spreads]
    # there are no training rows beyond a face, so networks are less accurate there
    near = np.exp((np.abs(scaled) - 1) / _NEAR)
    faces = sum(near[:, i] for i in range(1, scaled.shape[1])) + near[:, 0]
    share = np.minimum(np.maximum(answers.share, _LEAST_SHARE), 1 - _LEAST_SHARE)
    climb = np.log10(np.maximum(share * (1 - share) * answers.way, _LEAST_SHARE)) / 3 + 1
    place = np.log(share / (1 - share)) / 5
    values = answers.pull_off_force, answers.work_to_pull_off
    differ = [
        np.log10(np.abs(other - np.log10(x)) + _LEAST_DIFFERENCE) + 2
        for x, other in zip(values, second, strict=True)
    ]
    return np.column_stack([scaled, faces - 1, *apart, climb, place, *differ])


def check_confidence(confidence: float) -> None:
    """Raise an InputError for a confidence without measured intervals."""
    if confidence not in CONFIDENCES:
        raise InputError(
            f"confidence must be one of {', '.join(map(str, CONFIDENCES))}, for which intervals "
            f"were measured; got {confidence!r}"
        )


@dataclass(frozen=True, eq=False)
class Trust:
    """Half-widths of intervals.

    Attributes
    ----------
    reach : Networks
        log10 of the error sizes of ``OF``, shape (m, n, 4) for m networks; their mean is used.
        Errors of a curve are relative to the pull-off force, the others are in log10.
    levels : ndarray, shape (4, confidences)
        Calibrated factors on the half-widths.
    joint : ndarray, shape (confidences,)
        Further factors with which force, work and curve together are inside.
    """

    reach: Networks
    levels: Array
    joint: Array

    def doubtful(self, inputs: Array) -> npt.NDArray[np.bool_]:
        """Return a mask of the forces and works that are not certain, shape (n, 2).

        A number is doubtful if its predicted error exceeds ``WIDEST``, or if it differs from that
        of the second networks, which have other inputs, another form and further training rows, by
        more than this error and ``AGREED``; a work also if its force is. Where the force has two
        maxima of about the same height, both models are wrong in different ways.
        """
        error = 10.0 ** self.reach(inputs).mean(axis=0)[:, :2]
        apart = 10 ** (inputs[:, _COMPARED] - 2) - _LEAST_DIFFERENCE
        excess = np.maximum(apart / np.maximum(error, AGREED), error / WIDEST)
        return np.column_stack([excess[:, 0], np.maximum(excess[:, 0], excess[:, 1])]) > 1

    def widths(self, inputs: Array, confidence: float, *, joint: bool = False) -> tuple[Array, ...]:
        """Return the half-widths of the intervals of ``OF``, arrays of shape (n,).

        Parameters
        ----------
        inputs : ndarray
            As from :func:`error_inputs`.
        confidence : float
            One of ``CONFIDENCES``.
        joint : bool
            Whether force, work and curve together are to be inside with this confidence.
        """
        check_confidence(confidence)
        usual = 10.0 ** self.reach(inputs).mean(axis=0)
        level = self.levels[:, CONFIDENCES.index(confidence)]
        if joint:
            level = level * self.joint[CONFIDENCES.index(confidence)]
        return tuple(usual[:, i] * level[i] for i in range(len(OF)))

    def intervals(
        self, inputs: Array, answers: Answers, confidence: float, *, joint: bool = False
    ) -> Intervals:
        """Return intervals around predictions, from the inputs of the network of the errors."""
        *halves, curve, travel = self.widths(inputs, confidence, joint=joint)
        values = answers.pull_off_force, answers.work_to_pull_off
        force, work = (
            np.column_stack([v / 10**half, v * 10**half])
            for v, half in zip(values, halves, strict=True)
        )
        with np.errstate(over="ignore"):  # an uncertain prediction may overflow
            travels = np.column_stack([10**-travel, 10**travel])
        return Intervals(force, work, curve, travels)
