r"""Criterion for the end of a retraction: no later tension maximum can exceed the last one.

The force of a fast pull from a deep start may have two peaks: one while the bulk is still glassy
and the contact almost whole, and one after the bulk has relaxed, when the crack runs. In a relaxed
solid a JKR contact pulls off when the Hertz force at its radius equals the pull-off force, for any
work of separation of the crack. A contact that can still pull off with a force F must have a radius
at which the Hertz force is at least F. In a retraction the edge only recedes. Once it is inside
this radius, no later peak can exceed F.

The work of separation grows with the crack speed, so the criterion uses half of F for safety.
`benchmarks/peaks.py` compares runs that end by this rule with complete runs.
"""

from __future__ import annotations

from math import inf

from viscotack.bem.place import Place, Run

# Fraction of the largest tension so far that the relaxed contact must be able to carry.
_SAFE = 0.5


def over(run: Run, at: Place) -> bool:
    """Return whether the largest tension of the leg has been passed."""
    if not at.past:
        return False
    left = run.body.contact.relaxed_pull_off(at.seen.edge)
    if left < inf and not run.body.weights.size:
        return True  # an elastic contact has one peak, except for shapes without a bound
    return left < _SAFE * -at.lowest.force
