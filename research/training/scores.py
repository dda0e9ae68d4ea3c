"""Errors of a surrogate on cases that it has not learned from."""

from typing import Any

import numpy as np
from scipy.interpolate import PchipInterpolator

from viscotack.arrays import Array
from viscotack.prediction.surrogate.line import Curves
from viscotack.prediction.surrogate.trust import Answers
from viscotack.result.curve import PRESSED

from .rows import Rows

Label = dict[str, Any]


def labels_of(rows: Rows) -> list[Label]:
    """Return rows in the form of the labels of `fresh_cases`, at stored points."""
    found = []
    for i in range(len(rows)):
        first = PRESSED if rows.start_force[i] > 0 else 0
        left = rows.trajectory_left[i]
        found.append(
            {
                "force": rows.force[i],
                "work": rows.work[i],
                "to_zero": left[0] - left[first],
                "travel": left[first] - left[first:],
                "tension": -rows.trajectory_force[i, first:],
            }
        )
    return found


def curve_error(curve: Curves, label: Label) -> float:
    """Return the largest error of the tension of one curve at a simulated step.

    At the same travel from zero force, or from a start in tension, by monotone cubics between the
    points of the curve; steps beyond its end are compared with its last force.
    """
    first = PRESSED if curve.force[0] > 0 else 0
    travel, tension = curve.depth[first] - curve.depth[first:], -curve.force[first:]
    kept = np.append(True, np.diff(travel) > 0)
    if kept.sum() == 1:
        return float(np.max(np.abs(tension[0] - label["tension"])))
    at = np.clip(label["travel"], 0.0, travel[-1])
    read = PchipInterpolator(travel[kept], tension[kept])(at)
    return float(np.max(np.abs(read - label["tension"])))


def errors(said: Answers, curves: Curves, labels: list[Label]) -> Array:
    """Return the errors of ``trust.OF``, shape (n, 4); of a start in tension no travel."""
    force, work, to_zero = (np.array([x[n] for x in labels]) for n in ("force", "work", "to_zero"))
    each = [
        Curves(*one) for one in zip(curves.depth, curves.force, curves.contact_radius, strict=True)
    ]
    off = [
        curve_error(curve, label) / label["force"]
        for curve, label in zip(each, labels, strict=True)
    ]
    travel = curves.depth[:, 0] - curves.depth[:, PRESSED]
    pressed = (curves.force[:, 0] > 0) & (to_zero > 0)
    travel = np.where(pressed, np.log10(travel / np.where(pressed, to_zero, 1.0)), np.nan)
    of_numbers = np.log10(said.pull_off_force / force), np.log10(said.work_to_pull_off / work)
    return np.column_stack([*of_numbers, off, travel])
