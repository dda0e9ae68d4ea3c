r"""How wide an interval is: as far as errors usually reach there, times what was measured to hold.

A network of its own says how far errors of log10 of force, of work, of the curve in tension and of
log10 of the travel to zero force reach nine times of ten around a case, from its inputs and from
how far the networks are apart (:mod:`viscotack.surrogate.training.calibration`). It is smooth, so
that widths are. An interval is as many times that wide as held the wanted share of cases from
which no network had learned.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError

from . import physics
from .network import Networks

Array = npt.NDArray[np.float64]

CONFIDENCES = (0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98)
# What the network says of, and how many inputs it has: the groups, how near they are to ends of
# their ranges, and the spreads of two answers.
OF, INPUTS = ("force", "work", "curve", "travel"), len(physics.INPUTS) + 3
# How far from an end an input counts as near it, in halves of its range.
_NEAR = 0.03
# Spreads of log10 below this tell nothing more, and their logarithms are of order one.
_LEAST_SPREAD, _DECADES = 1e-5, 2.0


def told(groups: Array, spreads: tuple[Array, Array]) -> Array:
    """Return what the network of the errors is told of cases, shape (n, INPUTS).

    Parameters
    ----------
    groups : ndarray, shape (n, 5)
    spreads : tuple of ndarray, shape (n,)
        Of the networks of force and work, log10.
    """
    return told_of(physics.scaled(groups), spreads)


def told_of(scaled: Array, spreads: tuple[Array, Array]) -> Array:
    """Return the same from five inputs that are scaled, each from -1 to 1 over its range."""
    apart = [np.log10((s + _LEAST_SPREAD) / _LEAST_SPREAD) / _DECADES - 1 for s in spreads]
    # beyond a face there is no row, and networks know less of what is there
    near = np.exp((np.abs(scaled) - 1) / _NEAR)
    faces = sum(near[:, i] for i in range(1, len(physics.INPUTS))) + near[:, 0]
    return np.column_stack([scaled, faces - 1, *apart])


@dataclass(frozen=True, eq=False)
class Trust:
    """Half widths of intervals.

    Attributes
    ----------
    reach : Networks
        log10 of how far errors of ``OF`` usually reach, shape (m, n, 4) for m networks; their mean
        counts. Errors of a curve are parts of the pull-off force, the others of log10.
    levels : ndarray, shape (4, confidences)
        How many times as wide half an interval is.
    """

    reach: Networks
    levels: Array

    def widths(
        self, groups: Array, spreads: tuple[Array, Array], confidence: float
    ) -> tuple[Array, ...]:
        """Return the half widths of the intervals of ``OF``, arrays of shape (n,)."""
        return self.widths_told(told(groups, spreads), confidence)

    def widths_told(self, inputs: Array, confidence: float) -> tuple[Array, ...]:
        """Return the half widths where the network is told these inputs, arrays of shape (n,)."""
        if confidence not in CONFIDENCES:
            raise InputError(
                f"the confidence must be one of {', '.join(map(str, CONFIDENCES))}, for which "
                f"intervals were measured; got {confidence!r}"
            )
        usual = 10.0 ** self.reach(inputs).mean(axis=0)
        level = self.levels[:, CONFIDENCES.index(confidence)]
        return tuple(usual[:, i] * level[i] for i in range(len(OF)))
