r"""Physical baseline of a contact, used by the single class of surrogates.

The networks do not predict the pull-off force itself but a fraction s of the way between two
limits,

.. math:: \log \hat P = (1 - s) \log \hat P_\text{slow} + s \log \hat P_\text{fast} ,
          \qquad 0 < s < 1 ,

so that every prediction lies between them. A contact defines the limits, the inputs with their
ranges, and the inputs of the networks: :mod:`.physics` (a sphere on a power law),
:mod:`.linear_solids` (on any other linear solid), :mod:`.punch_physics` and :mod:`.short_range`
(large Tabor numbers).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
import numpy.typing as npt
from numpy.lib.mixins import NDArrayOperatorsMixin

from viscotack.arrays import Array

from .line import Curves, curves
from .network import Networks
from .trust import Answers, error_inputs

# A network's output is zero where the fraction is one half.
STEEP = 4.0
LEAST_WAY = 1e-4
# Least distance of the limits for the second networks, which learn the share as it is.
SECOND_WAY = 0.05


def share(output: Array) -> Array:
    """Return the fraction s between two limits for an output of a network.

    Examples
    --------
    >>> share(np.array([-9.0, 0.0, 9.0])).round(6).tolist()
    [0.0, 0.5, 1.0]
    """
    return 1 / (1 + np.exp(-STEEP * output))


def between(low: Array, high: Array, output: Array) -> Array:
    """Interpolate the logarithm between two limits at the fraction of an output."""
    return low + np.maximum(high - low, LEAST_WAY) * share(output)


def mean_limit(limit: Array) -> Array:
    """Average a limit over its networks, if there are several."""
    return limit if limit.ndim == 1 else limit.mean(axis=0)


def scaled_logarithms(values: Array, low: Array, high: Array) -> Array:
    """Scale logarithms linearly to [-1, 1] between two ends.

    Parameters
    ----------
    values : ndarray, shape (n, inputs)
    low, high : ndarray, shape (inputs,)
        log10 of the ends.
    """
    return (2 * np.log10(values) - (low + high)) / (high - low)


@dataclass(frozen=True, eq=False)
class Further:
    """Corrections of force and work (None if there are none), and further outputs of a contact.

    Attributes
    ----------
    force, work : ndarray, shape (n,)
        Added to the output that defines the fraction, and to log10 of work over force.
    more : mapping of str to ndarray
        Further numbers for the :class:`~.trust.Answers`.
    """

    force: Array | None = None
    work: Array | None = None
    more: Mapping[str, Array] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Contact:
    """Tests of one contact: inputs, ranges, limits of the force, and inputs of the networks.

    Attributes
    ----------
    networks : mapping of str to Networks
        The networks by name: ``force`` interpolates between the limits; ``work`` predicts
        log10 of work over force; ``start`` the relaxed start; ``give`` log10 of the travel to zero
        force; ``line`` the shapes of a curve; ``second`` force and work again, independently of
        the others. Limits may be networks too.
    constants : mapping of str to ndarray
        Further fitted numbers.
    rows : ndarray, shape (n, inputs)
        Inputs of the tests in the order of ``inputs``.
    """

    networks: Mapping[str, Networks]
    constants: Mapping[str, Array]
    rows: Array

    # Name in files, the inputs, smallest and largest value of each, and log10 of the ends that are
    # scaled to -1 and 1.
    name: ClassVar[str]
    inputs: ClassVar[tuple[str, ...]]
    low: ClassVar[Array]
    high: ClassVar[Array]
    ends: ClassVar[tuple[Array, Array]]
    # Networks shared with the sphere on power laws, which are not stored in the file.
    shared: ClassVar[tuple[str, ...]] = ()
    # Columns that define a relaxed start, its depth last; number of depths and of refinements of
    # the search for it; error message if there is none.
    start_inputs: ClassVar[list[int]] = []
    search: ClassVar[tuple[int, int]]
    no_start: ClassVar[str]
    # Whether the work is an input of the networks of the travel to zero force, and the unit of
    # force times depth in units of the work.
    give_knows_work: ClassVar[bool] = True
    work_unit: ClassVar[float] = 1.0
    # Whether predictions are smooth functions of the rows.
    smooth: ClassVar[bool] = True

    @classmethod
    def of(
        cls, networks: Mapping[str, Networks], constants: Mapping[str, Array], given: Any
    ) -> Self:
        """Return the tests with these inputs, one per row."""
        # keep traced arrays (used to export formulas) as they are
        stands = isinstance(given, NDArrayOperatorsMixin)
        rows: Any = given if stands else np.asarray(given, dtype=float)
        return cls(networks, constants, rows)

    # Inputs ---------------------------------------------------------------------------------

    @staticmethod
    def unit(rows: Array) -> Array | None:
        """Return the units of the inputs' ranges, shape (n, inputs); None for units of 1."""
        return None

    @cached_property
    def ranged(self) -> Array:
        """Inputs in the units of their ranges."""
        unit = self.unit(self.rows)
        return self.rows if unit is None else self.rows / unit

    @cached_property
    def scaled(self) -> Array:
        """Logarithms of the inputs, scaled to [-1, 1] over the training range, (n, inputs)."""
        return scaled_logarithms(self.ranged, *self.ends)

    def inside(self) -> npt.NDArray[np.bool_]:
        """Return a mask of the inputs inside the training range, shape (n, inputs)."""
        # include the ends, whatever their rounding
        return (self.ranged >= self.low * (1 - 1e-9)) & (self.ranged <= self.high * (1 + 1e-9))

    def holds(self, said: Answers) -> npt.NDArray[np.bool_]:
        """Return a mask of the tests to which the surrogate applies, shape (n,)."""
        return np.ones(len(self.rows), dtype=bool)

    def deeper(self, factors: Array) -> Contact:
        """Return copies of the tests with depths multiplied by factors, shape (times, n)."""
        rows = np.tile(self.rows, (len(factors), 1))
        rows[:, self.start_inputs[-1]] *= factors.ravel()
        return replace(self, rows=rows)

    # Force ----------------------------------------------------------------------------------

    @cached_property
    def slow(self) -> Array:
        """log10 of the slow limit of the force, shape (n,), or (m, n) for m networks."""
        raise NotImplementedError

    @property
    def least(self) -> Array | None:
        """log10 of a proven lower bound of the force, shape (n,); None if there is none."""
        return None

    @cached_property
    def fast(self) -> Array:
        """log10 of the fast limit of the force, shape (n,), or (m, n) for m networks."""
        raise NotImplementedError

    @cached_property
    def told(self) -> Array:
        """Inputs of the networks of the force, shape (n, columns)."""
        return self.scaled

    def further(self, output: Array) -> Further:
        """Return corrections, from the outputs of the networks of the force, shape (m, n)."""
        return Further()

    @cached_property
    def second_limits(self) -> tuple[Array, Array]:
        """log10 of the limits of the force for the second networks, shape (n,) each."""
        return mean_limit(self.slow), mean_limit(self.fast)

    @cached_property
    def told_of_second(self) -> Array:
        """Inputs of the second networks, shape (n, columns)."""
        return np.column_stack([self.scaled, *self.second_limits])

    @cached_property
    def second(self) -> tuple[Array, Array]:
        """log10 of force and work by the second networks, shape (n,) each.

        Their outputs are the share of the way between the limits, and log10 of work over force.
        """
        said = self.networks["second"](self.told_of_second).mean(axis=0)
        low, high = self.second_limits
        part = np.minimum(np.maximum(said[:, 0], 0.0), 1.0)
        force = low + part * np.maximum(high - low, SECOND_WAY)
        return force, force + said[:, 1]

    def told_of_errors(self, answers: Answers) -> Array:
        """Return the inputs of the networks of the errors, shape (n, columns)."""
        return error_inputs(self.scaled, answers, self.second)

    # Start, work and curve ------------------------------------------------------------------

    @property
    def said_of_start(self) -> Array:
        """Outputs of the networks of the start, shape (m, n, outputs)."""
        return self.networks["start"](self.scaled[:, self.start_inputs])

    @cached_property
    def start(self) -> tuple[Array, Array]:
        """Force and contact radius of the relaxed starts, shape (n,) each."""
        return self.started(self.said_of_start.mean(axis=0))

    def started(self, said: Array) -> tuple[Array, Array]:
        """Return force and radius of starts, from outputs of shape (n, outputs)."""
        raise NotImplementedError

    def knowing(self, force: Array) -> Array:
        """Return the inputs of networks that depend on log10 of the force, shape (n, columns)."""
        raise NotImplementedError

    def give(self, said: Array) -> Array:
        """Return (travel to zero force) * radius / force, from the output of its networks."""
        return 10**said

    def curves(self, answers: Answers) -> Curves:
        """Return the unloading curves of predictions."""
        known = self.knowing(np.log10(answers.pull_off_force))
        with_work = np.column_stack([known, np.log10(answers.work_to_pull_off)])
        give = self.networks["give"](with_work if self.give_knows_work else known)
        force, radius = self.start
        return curves(
            self.networks["line"](with_work)[0],
            give=self.give(give[..., 0].mean(axis=0)),
            preload=self.rows[:, self.start_inputs[-1]],
            force=force,
            radius=radius,
            pull_off=answers.pull_off_force,
            work=answers.work_to_pull_off / self.work_unit,
        )
