r"""Whether a later maximum of the tension may exceed the one that is behind.

The force of a fast pull from a deep start may have two peaks: one while the bulk is still glassy
and the contact almost whole, and one after the bulk has relaxed, when the crack runs. In a relaxed
solid a JKR contact pulls off where the force that would press it without adhesion equals the
pull-off force, whatever work the crack takes. A contact that is still to pull off with F must have
an edge at which that force is F or more. The edge only recedes in a retraction, so that no later
peak exceeds one of F that is behind once the edge is inside this radius.

The work that the crack takes grows with its speed, so half of F is asked for. `benchmarks/peaks.py`
compares runs that end by this rule with whole ones.
"""

from __future__ import annotations

from math import inf

from viscotack.bem.place import Place, Run

# Part of the largest tension so far that the relaxed contact must still be able to bear.
_SAFE = 0.5


def over(run: Run, at: Place) -> bool:
    """Return whether the largest tension of the leg is behind."""
    if not at.past:
        return False
    left = run.body.contact.relaxed_pull_off(at.seen.edge)
    if left < inf and not run.body.weights.size:
        return True  # an elastic contact has one peak, but for shapes without a bound
    return left < _SAFE * -at.lowest.force
