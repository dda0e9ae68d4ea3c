r"""Criterion for the end of a retraction: no later tension maximum can exceed the last one.

The force of a fast pull from a deep start may have two peaks: one while the bulk is still glassy
and the contact almost whole, and one after the bulk has relaxed, when the crack runs. In a relaxed
solid a JKR contact whose energy does not change with the radius pulls off when the Hertz force at
its radius equals the pull-off force. The energy of a crack that accelerates rises as the contact
shrinks, and the tension then exceeds the Hertz force, by half in computed cases. In a retraction
the edge only recedes, so no later peak is expected to exceed F once the Hertz force at the edge is
below half of F. The factor of a half is a heuristic.
"""

from __future__ import annotations

from math import inf

from viscotack.simulate.state import MarchState, Run

# Fraction of the largest tension so far that the relaxed contact must be able to carry.
_SAFE = 0.5


def over(run: Run, at: MarchState) -> bool:
    """Return whether the largest tension of the leg has been passed."""
    if not at.past:
        return False
    left = run.body.contact.relaxed_pull_off(at.seen.edge)
    if left < inf and not run.body.weights.size:
        return True  # an elastic contact has one peak, except for shapes without a bound
    return left < _SAFE * -at.lowest.force
