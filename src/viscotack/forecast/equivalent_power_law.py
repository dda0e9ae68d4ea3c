"""Equivalent power law of the solid of a test, and its similarity to the training data."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from viscotack.problem import Groups

if TYPE_CHECKING:
    from viscotack.surrogate.alike import Alike


def like_of(groups: Groups, depth: float) -> Alike:
    """Return the power law equivalent to the solid of a test, for a start at a depth [h0]."""
    from viscotack.surrogate import alike, linear_solids, store

    assert groups.rate is not None, "checked by the caller"
    material, k = groups.material, groups.modulus_ratio
    creep = np.asarray(material.creep(alike.TIMES / groups.rate)) * material.rubbery_modulus
    # rounding may place it outside the range
    creep = np.clip(creep, k, 1.0)
    one = np.ones(1)
    learned = store.shipped("solids")
    return linear_solids.like(learned, groups.tabor * one, k * one, depth * one, creep[None])


def unlike_words(like: Alike) -> list[str]:
    """Return a sentence if the solid is unlike all training data, or an empty list."""
    from viscotack.surrogate import linear_solids, store

    learned = store.shipped("solids")
    if learned.inside(like).all():
        return []
    (far,) = linear_solids.far(like, learned.constants["spread"])
    most = learned.constants["farthest"]
    return [
        "the creep of the solid around h0 over the speed is unlike that of all solids in the "
        f"training data: it deviates from a power law by {like.unlike[0]:.2g} of the difference "
        "between glass and rubber, in logarithms, while the training data deviate by up to "
        f"{most[0]:.2g} (in their directions by {far:.2g}, up to {most[1]:.2g})"
    ]


def alike_words(like: Alike) -> str:
    """Describe the equivalent power law of a solid."""
    from viscotack.surrogate import physics

    return (
        "around the times of the test the solid creeps like a power law by retardation with the "
        f"exponent {like.groups[0, physics.EXPONENT]:.3g}, within {like.unlike[0]:.1g} of the "
        "difference between glass and rubber, in logarithms"
    )
