"""Retractions whose force may have two maxima of about the same height.

One maximum occurs before the solid under the contact has relaxed, the other after it, when the edge
is a crack. The pull-off force is the larger, so it has a kink where they are equal; tiers that
describe only one of them fail there.
"""

from __future__ import annotations

# Smallest and largest Tabor number, modulus ratio, depth [h0], and rate times retardation time over
# the depth, for which 90 % intervals of the surrogate of solids included only 67 to 79 % of the
# simulated forces.
_BETWEEN = ((0.05, 5.0), (1e-4, 1e-2), (20.0, 500.0), (0.5, 2.0))


def two_peaks(tabor: float, modulus_ratio: float, depth: float, rate: float) -> str:
    """Return a sentence if the force may have two maxima, or an empty string.

    Parameters
    ----------
    tabor, modulus_ratio : float
    depth : float
        Depth of the start [h0].
    rate : float
        Retraction speed times the retardation time [h0].
    """
    if not depth > 0:
        return ""
    values = (tabor, modulus_ratio, depth, rate / depth)
    if not all(low <= x <= high for x, (low, high) in zip(values, _BETWEEN, strict=True)):
        return ""
    return (
        "the force may have two maxima of about the same height, one before the solid under the "
        f"contact has relaxed and one after: {rate / depth:.2g} preload depths are retracted in "
        "the retardation time"
    )
