"""Remeshing around an edge that has left its fine nodes, and the length of its cohesive zone.

Module :mod:`.jumps` records the lost energy and decides whether remeshing triggered a jump.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from viscotack.simulate.body import Body, State
from viscotack.simulate.contacts.contact import Contact
from viscotack.simulate.equilibrium import Balance
from viscotack.simulate.state import MarchState


def around_edge(body: Body, at: MarchState, edge: float | None = None) -> MarchState | Balance:
    """Return the solver state remeshed around its edge, or the unstable balance on failure.

    If the cohesive zone has grown, the nodes are coarser and the fine zone is longer by the same
    factor. `edge` overrides the present edge as the centre of the fine nodes.
    """
    edge = at.seen.edge if edge is None else edge
    mesh = at.mesh.around(edge, opening(at.state, body.contact), at.seen.inner)
    state = body.remeshed(at.state, mesh.nodes(), at.hold())
    return state if isinstance(state, Balance) else replace(at, state=state, mesh=mesh)


def lost(before: MarchState, after: MarchState) -> tuple[float, float]:
    """Return work at the indenter between two states of one instant, and the energy lost.

    A spring or a dead load moves the indenter; a rigid machine does not.
    """
    now, then = before.seen, after.seen
    work = 0.5 * (now.force + then.force) * (then.depth - now.depth)
    return work, work + now.stored - then.stored


def opening(state: State, contact: Contact) -> float:
    """Return the distance over which the gap opens by the range of the law, or the zone."""
    gap, x = state.gap - contact.law.edge_gap - contact.span, state.surface.position
    beyond = int(np.argmax((gap > 0) & (x > state.seen.edge)))
    if beyond == 0:
        return contact.zone
    g, r = gap[beyond - 1 : beyond + 1], x[beyond - 1 : beyond + 1]
    return float(r[1] - g[1] * (r[1] - r[0]) / (g[1] - g[0])) - state.seen.edge
