r"""Interface that ages in contact, in one time step.

An ageing law (:mod:`viscotack.model.traction.ageing`) multiplies the tension of each node by
:math:`F = 1 + q G(t)`, with the time t that the node has been in contact, and the share q of its
bonds that hold. In a step t grows by the
length of the step at the nodes in contact at its beginning, whatever the gaps do meanwhile, so F is
known beforehand and the law has the potential :class:`~viscotack.simulate.growth.Frozen` of the
gap, with which the equilibrium solver of :mod:`.equilibrium` and its test of stability apply
unchanged. The time of a node that comes into contact within a step begins with the end of the
step: of first order in the step, for the edge of an approaching contact only.

A node is in contact where its gap is below that of the largest tension. Beyond, its time stands
still, so that a crack separates it with the work that it has reached. Its bonds break one after
another, so that no node snaps: q falls with the logarithm of the gap, from 1 where the law at rest
has 2 % of its work left to 0 where it has 0.2 %, and does not rise again. The work is then
:math:`\Delta\gamma_0 (1 + 0.99 \, G(t))`. When all are broken, the node is as new. Where a crack
turns earlier, the bonds that hold close again as they are, and gain back what has been paid for
them, no more: heat is never negative after a cycle.

**Heat.** The tensions beyond those at rest do work, all of which is heat. With the mean of the
growth over a step it is, at each node,

.. math:: \frac{G_0 + G_1}{2} \, \left[ \varphi_0(\max(h, h_0)) \right]_{\text{begin}}^{\text{end}},

whatever the way of the gap, also in a jump. The stored energy is that of the law at rest, so a
contact that ages at rest neither stores nor loses energy.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

from viscotack.model.traction import Traction, ages
from viscotack.simulate.growth import Frozen
from viscotack.simulate.settings import Settings

# Shares of the work of adhesion left at the gaps between which bonds break, 8.2 and 26 h0 with
# Lennard-Jones forces, and the largest such gap [h0].
_BREAKS, _BROKEN, _FARTHEST = 2e-2, 2e-3, 1e3


def finer(settings: Settings, law: Any, longest: float = np.inf) -> Settings:
    """Return settings with as many more nodes as the zone of a crack shrinks when a law ages.

    The zone is as long as energy over squared strength, and both grow by the same factor in the
    longest time. A growth without an end has no such factor for an infinite time.
    """
    if not ages(law) or np.isinf(last := min(longest, law.settled)):
        return settings
    factor = 1 + float(law.growth_after(last))
    return replace(settings, nodes_per_zone=factor * settings.nodes_per_zone)


@dataclass(frozen=True, eq=False)
class Contacted:
    """Time in contact at the nodes, at one instant; 0 where there is no bond.

    Attributes
    ----------
    time : ndarray, shape (N,)
        Time in contact [time unit of the modes].
    held : ndarray, shape (N,)
        Share of the bonds that hold, 0 to 1; 0 where there never were any.
    """

    time: npt.NDArray
    held: npt.NDArray

    @classmethod
    def relaxed(cls, base: Traction, ageing: Any, gap: npt.NDArray) -> Contacted:
        """Return the times of a relaxed contact, closed for ever; base is the law at rest."""
        closed = gap < base.edge_gap
        return cls(np.where(closed, ageing.settled, 0.0), np.where(closed, 1.0, 0.0))

    def forgotten(self) -> Contacted:
        """Return the times as they are: they predict nothing."""
        return self

    def carried(self, old: npt.NDArray, nodes: npt.NDArray) -> Contacted:
        """Return the times on other nodes; linear, because they are discontinuous at an edge."""
        time, held = (np.interp(nodes, old, values) for values in (self.time, self.held))
        return Contacted(time, held)

    def factor(self, ageing: Any) -> npt.NDArray:
        """Return the factor of the tension at the nodes."""
        return 1 + self.held * ageing.growth_after(self.time)

    def stepped(self, base: Traction, ageing: Any, gap: npt.NDArray, length: float) -> Frozen:
        """Return the law for a step of this length from these gaps."""
        return Frozen(base, self._older(base, gap, length).factor(ageing))

    def after(
        self, base: Traction, before: npt.NDArray, gap: npt.NDArray, length: float
    ) -> Contacted:
        """Return the times after a step of this length, from the gaps `before` to these."""
        first, last = _gap_with(base, _BREAKS), _gap_with(base, _BROKEN)
        share = np.log(last / np.maximum(gap, first)) / np.log(last / first)
        held = np.clip(np.minimum(self.held, share), 0.0, None)
        new = (held == 0) & (gap < base.edge_gap)
        time = self._older(base, before, length).time
        return Contacted(np.where(held > 0, time, 0.0), np.where(new, 1.0, held))

    def heat(
        self, base: Traction, ageing: Any, before: npt.NDArray, gap: npt.NDArray, length: float
    ) -> npt.NDArray:
        """Return the heat [dg] at the nodes in a step from the gaps `before` to these."""
        older = self._older(base, before, length)
        growth = 0.5 * (self.factor(ageing) + older.factor(ageing)) - 1
        return growth * (base.energy(np.maximum(gap, 1.0)) - base.energy(np.maximum(before, 1.0)))

    def _older(self, base: Traction, gap: npt.NDArray, length: float) -> Contacted:
        ages = (gap < base.edge_gap) & (self.held > 0)
        return replace(self, time=self.time + np.where(ages, length, 0.0))


@lru_cache(maxsize=64)
def _gap_with(base: Traction, share: float) -> float:
    """Return the gap [h0] at which a law at rest has this share of its work left."""

    def left(gap: float) -> float:
        return float(-base.energy(gap)) - share

    if left(_FARTHEST) > 0:
        return _FARTHEST * share / _BROKEN
    return float(brentq(left, base.edge_gap, _FARTHEST))  # type: ignore[arg-type]
