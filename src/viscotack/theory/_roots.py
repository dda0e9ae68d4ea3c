"""Vectorised root finding, one root per element, and a minimum."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import scipy

# Bisections that reduce a bracket of a hundred to round-off.
_HALVINGS = 64
_ROUNDS = 150


def halved(function: Callable[[Any], Any], low: Any, high: Any) -> Any:
    """Find the zero of a decreasing function by bisection; return an end if there is none."""
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        above = function(middle) > 0
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    return (low + high) / 2


def regula_falsi(function: Callable[[Any], Any], low: Any, high: Any, *, noise: Any) -> Any:
    """Find the zero of an increasing function to values below `noise`."""
    below, above = function(low), function(high)
    x, before = low, np.zeros(np.shape(low))
    for round_ in range(_ROUNDS):
        span = above - below
        x = (low + high) / 2
        if round_ % 4 < 3:
            x = np.where(span > 0, low - below * (high - low) / np.where(span > 0, span, 1.0), x)
        found = function(x)
        if np.all(np.abs(found) <= noise):
            break
        side = np.where(found < 0, -1.0, 1.0)
        # an end that stays twice gets half of its weight (Illinois)
        again = np.where(side == before, 0.5, 1.0)
        below, above = (
            np.where(side < 0, found, below * again),
            np.where(side > 0, found, above * again),
        )
        low, high = np.where(side < 0, x, low), np.where(side > 0, x, high)
        before = side
    return x


def least(function: Callable[[float], Any], ends: Any) -> float:
    """Find where a function that falls and then grows is least, between two positive numbers.

    The search is in the logarithm, to five digits.
    """
    found: Any = scipy.optimize.minimize_scalar(
        lambda x: float(function(float(np.exp(x)))), bounds=tuple(np.log(ends)), method="bounded"
    )
    return float(np.exp(found.x))
