"""Fine nodes for an edge that has left its own: how long the crack there has become, and the move.

What a move costs, and whether it was a jump, is for :mod:`.jumps` to say.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from viscotack.bem.body import Body, State
from viscotack.bem.contacts.contact import Contact
from viscotack.bem.equilibrium import Balance
from viscotack.bem.place import Place


def around_edge(body: Body, at: Place, edge: float | None = None) -> Place | Balance:
    """Return the march on nodes around its edge, or the balance that is none where it fails there.

    Where the crack has grown the nodes are coarser, and the fine zone is that much longer. The
    edge given is where it will be instead.
    """
    edge = at.seen.edge if edge is None else edge
    mesh = at.mesh.around(edge, opening(at.state, body.contact), at.seen.inner)
    state = body.remeshed(at.state, mesh.nodes(), at.hold())
    return state if isinstance(state, Balance) else replace(at, state=state, mesh=mesh)


def lost(before: Place, after: Place) -> tuple[float, float]:
    """Return the work at the indenter between two states of one instant, and what it lacks.

    A spring or a dead load moves the indenter; a rigid machine does not.
    """
    now, then = before.seen, after.seen
    work = 0.5 * (now.force + then.force) * (then.depth - now.depth)
    return work, work + now.stored - then.stored


def opening(state: State, contact: Contact) -> float:
    """Return the distance from the edge over which the gap opens by a range; or the zone."""
    gap, x = state.gap - contact.law.edge_gap - contact.span, state.surface.position
    beyond = int(np.argmax((gap > 0) & (x > state.seen.edge)))
    if beyond == 0:
        return contact.zone
    g, r = gap[beyond - 1 : beyond + 1], x[beyond - 1 : beyond + 1]
    return float(r[1] - g[1] * (r[1] - r[0]) / (g[1] - g[0])) - state.seen.edge
