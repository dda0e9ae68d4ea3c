r"""Fit the plain edge law to a rate series: an elastic solid, and losses at its edge alone.

.. math:: G = w \left( 1 + \left( \frac{v}{v_0} \right)^n \right)

in the speed v of the edge (:mod:`viscotack.theory.sphere.edge_law`). It needs no spectrum of the
material, and does not separate losses of the bulk from those of the interface: w, v0 and n describe
this pair of surfaces in the measured range of speeds. Its forecast ends a factor of ten beyond.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError, OutOfRange
from viscotack.lab.tack.repeats import SAME
from viscotack.model.geometry import Layer
from viscotack.theory.sphere import edge_law
from viscotack.units import readable

from .contact_time import PER_DECADE
from .forward import Forward
from .rate_series import RateSeries
from .search import Search, SeriesFit, Table, lattice, settled
from .words import edge_words

_LEAST = 4  # speeds
# Searched: works of adhesion below the largest that the forces allow, speeds v0 beyond those of the
# drive, exponents; and their numbers of values.
_WORKS, _SPEEDS, _EXPONENTS = 1e-3, 1e4, (0.1, 1.2)
_COUNTS = 9, 23, 10
_FURTHEST = 10.0  # factor beyond the measured speeds


@dataclass(frozen=True, eq=False)
class EdgeFit(SeriesFit):
    """Edge law fitted to a rate series.

    The unknowns are "work_of_adhesion" [J/m2], "reference_speed" [m/s] and "exponent", and with
    several times in contact at one speed "growth_per_decade".
    """

    @cached_property
    def words(self) -> tuple[str, ...]:
        """Sentences on the result and on what the data do not determine."""
        return tuple(edge_words(self))


def identify_edge(series: RateSeries) -> EdgeFit:
    """Fit work of adhesion, reference speed and exponent of an edge law to a rate series.

    Parameters
    ----------
    series : RateSeries
        The tests; of the material only the relaxed contact modulus is used.

    Raises
    ------
    InputError
        If the series has fewer than four speeds, or whole curves, growth, a history or a layer.
    """
    if series.curves or series.growth or series.history or isinstance(series.body, Layer):
        raise InputError(
            "the edge law is fitted to pull-off forces of relaxed contacts on thick samples; omit "
            "curves, growth, history and thickness"
        )
    speed = series.speed
    if np.unique(speed).size < _LEAST:
        raise InputError(f"the edge law has three unknowns: pull off at {_LEAST} or more speeds")
    most = series.largest_work
    works, speeds, exponents = _COUNTS
    axes = {
        "work_of_adhesion": np.geomspace(_WORKS * most, most, works),
        "reference_speed": np.geomspace(speed.min() / _SPEEDS, speed.max() * _SPEEDS, speeds),
        "exponent": np.geomspace(*_EXPONENTS, exponents),
    }
    forces = edge_forces(series, lattice(axes), speed, series.load)
    forward = Forward(series.passport.material, series.radius)
    search = Search.of(series, forward, Table(axes, np.log(forces)[..., None]))
    if series.stiffness is not None:
        values = search.best().values
        stiff = series.stiffness / (1 + series.compliance_uncertainty)
        other = edge_forces(replace(series, stiffness=stiff), values, speed, series.load)
        softer = np.log(other / edge_forces(series, values, speed, series.load))
        search = replace(search, spread=search.spread + np.outer(softer, softer))
    return EdgeFit.of(settled(search))


def edge_forces(
    series: RateSeries,
    values: Mapping[str, Any],
    speed: npt.ArrayLike,
    load: npt.ArrayLike,
    decades: Array | None = None,
) -> Array:
    """Return pull-off forces [N] of the sphere of a series with edge laws, at speeds and loads.

    `decades` are those from the middle time in contact.
    """
    law = dict(values)
    per_decade = law.pop(PER_DECADE, 0.0)
    if decades is not None:
        law["work_of_adhesion"] = law["work_of_adhesion"] * (1 + per_decade * decades)
    return np.asarray(
        edge_law.pull_off_force(
            speed,
            preload=load,
            radius=series.radius,
            contact_modulus=series.passport.material.contact_modulus,
            stiffness=series.stiffness,
            **law,
        )
    )


def refuse_far(series: RateSeries, speed: Array) -> None:
    """Raise an error for speeds more than ten times beyond the measured ones."""
    low, high = series.speed.min(), series.speed.max()
    factor = _FURTHEST * (1 + SAME)
    bad = speed[(speed < low / factor) | (speed > high * factor)]
    if bad.size:
        raise OutOfRange(
            f"an edge law holds up to {_FURTHEST:g} times beyond its tests, "
            f"{readable(low, 'm/s', to=high)}, not at {readable(bad[0], 'm/s', digits=3)}: measure "
            "there, or give the material of a dynamic test to `viscotack identify rates`"
        )
