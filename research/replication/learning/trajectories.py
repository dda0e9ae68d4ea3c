r"""The network of section 5.5: six points of the retraction at once.

Travel to the pull-off and the forces at 25, 50, 75, 87.5 and 100 % of it, from Tabor number,
modulus ratio, exponent, rate and preload, the lengths over the Tabor number. 15 % of the rows say
when to stop.

The authors' modified logarithm, :math:`\mathrm{sgn}(y) \ln |y|`, jumps at zero and gives 0.5
and -2 the same value, so forces cannot be had back from it. :math:`\mathrm{sgn}(y) \ln(1 + |y|)`
stands in its place.
"""

from typing import Any

import numpy as np

from ..table import Array, Detachments
from .learners import network

SHARES = (0.0, 0.25, 0.5, 0.75, 0.875, 1.0)
_LAYERS, _HELD_OUT = (100, 100, 100), 0.15


def predictor(rows: Detachments, seed: int) -> Any:
    """Return a network that has learned the six points of all rows; `points_of` asks it."""
    held = _HELD_OUT / (1 - _HELD_OUT)
    return network(*learned_points(rows), _LAYERS, "relu", seed, rounds=500, validation=held)


def points_of(model: Any, rows: Detachments) -> Array:
    """Return the six points, shape (n, 6), that a network gives to the inputs of rows."""
    found = model.predict(_inputs(rows))
    plain = np.sign(found) * np.expm1(np.abs(found))
    return np.column_stack([plain[:, 0] * rows.tabor, plain[:, 1:]])


def learned_points(rows: Detachments) -> tuple[Array, Array]:
    """Return what the network learns from, and what it learns."""
    assert rows.key_points is not None
    travel = rows.key_points[:, :1] / rows.tabor[:, None]
    return _inputs(rows), kept_sign(np.hstack([travel, rows.key_points[:, 1:]]))


def kept_sign(y: Array) -> Array:
    """Return sgn(y) ln(1 + abs(y)).

    Examples
    --------
    >>> [f"{x:.3f}" for x in kept_sign(np.array([-2.0, 0.0, 0.5]))]
    ['-1.099', '0.000', '0.405']
    """
    return np.sign(y) * np.log1p(np.abs(y))


def _inputs(rows: Detachments) -> Array:
    preload, rate = kept_sign(rows.preload / rows.tabor), np.log(rows.rate)
    return np.stack([preload, rate, rows.tabor, np.log(rows.modulus_ratio), rows.exponent], axis=1)
