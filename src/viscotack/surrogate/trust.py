r"""How wide an interval is: as far as errors reach there, times what was measured to hold.

A network of its own says how far errors of log10 of force, of work, of the curve in tension and of
log10 of the travel to zero force reach around a case, all but one in fifty, from its inputs, from
how far the networks are apart and from how steeply the force climbs between its limits there
(:mod:`training.calibration`). It is smooth, so that widths are. An interval is
as many times that wide as held the wanted share of cases from which no network had learned.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError

from .answers import Answers, Intervals
from .network import Networks

CONFIDENCES = (0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98)
# What the network says of, and how many inputs it has: five groups, how near they are to ends of
# their ranges, the spreads of two answers, and where between its limits the force is, and how
# steep.
OF, INPUTS = ("force", "work", "curve", "travel"), 10
# How far from an end an input counts as near it, in halves of its range.
_NEAR = 0.03
# Spreads of log10 below this tell nothing more, and their logarithms are of order one.
_LEAST_SPREAD, _DECADES = 1e-5, 2.0
# Parts of the way this near to its ends are as good as there, and so are as small climbs.
_LEAST_SHARE = 1e-6


def error_inputs(scaled: Array, answers: Answers) -> Array:
    """Return what the network of the errors is told of cases, shape (n, INPUTS).

    An error of the output of a network that says where between its limits the force is changes
    the force by as much as s (1 - s) times the way between them.

    Parameters
    ----------
    scaled : ndarray, shape (n, 5)
        Inputs of the cases, each from -1 to 1 over its range.
    answers : Answers
        What is said of them.
    """
    spreads = answers.force_spread, answers.work_spread
    apart = [np.log10((s + _LEAST_SPREAD) / _LEAST_SPREAD) / _DECADES - 1 for s in spreads]
    # beyond a face there is no row, and networks know less of what is there
    near = np.exp((np.abs(scaled) - 1) / _NEAR)
    faces = sum(near[:, i] for i in range(1, scaled.shape[1])) + near[:, 0]
    share = np.minimum(np.maximum(answers.share, _LEAST_SHARE), 1 - _LEAST_SHARE)
    climb = np.log10(np.maximum(share * (1 - share) * answers.way, _LEAST_SHARE)) / 3 + 1
    place = np.log(share / (1 - share)) / 5
    return np.column_stack([scaled, faces - 1, *apart, climb, place])


@dataclass(frozen=True, eq=False)
class Trust:
    """Half widths of intervals.

    Attributes
    ----------
    reach : Networks
        log10 of how far errors of ``OF`` reach, shape (m, n, 4) for m networks; their mean counts.
        Errors of a curve are parts of the pull-off force, the others of log10.
    levels : ndarray, shape (4, confidences)
        How many times as wide half an interval is.
    """

    reach: Networks
    levels: Array

    def widths(self, inputs: Array, confidence: float) -> tuple[Array, ...]:
        """Return the half widths of the intervals of ``OF``, arrays of shape (n,).

        Parameters
        ----------
        inputs : ndarray
            As :func:`error_inputs` has them.
        confidence : float
            One of ``CONFIDENCES``.
        """
        if confidence not in CONFIDENCES:
            raise InputError(
                f"the confidence must be one of {', '.join(map(str, CONFIDENCES))}, for which "
                f"intervals were measured; got {confidence!r}"
            )
        usual = 10.0 ** self.reach(inputs).mean(axis=0)
        level = self.levels[:, CONFIDENCES.index(confidence)]
        return tuple(usual[:, i] * level[i] for i in range(len(OF)))

    def intervals(self, inputs: Array, answers: Answers, confidence: float) -> Intervals:
        """Return intervals around answers, so wide where the network is told these inputs."""
        *halves, curve, travel = self.widths(inputs, confidence)
        values = answers.pull_off_force, answers.work_to_pull_off
        force, work = (
            np.column_stack([v / 10**half, v * 10**half])
            for v, half in zip(values, halves, strict=True)
        )
        with np.errstate(over="ignore"):  # what is hardly known has no end that a number holds
            travels = np.column_stack([10**-travel, 10**travel])
        return Intervals(force, work, curve, travels)
