"""Where the force of a retraction may have two maxima of about the same height.

One comes before the solid under the contact has relaxed, the other after it, when the edge runs as
a crack. The pull-off force is the larger, so that it has a kink where they are equal; tiers that
follow one of them alone do not hold there.
"""

from __future__ import annotations

# Least and largest Tabor number, modulus ratio, depth [h0], and rate times retardation time over
# the depth: there 90 % intervals of the surrogate of solids held 67 to 79 % of simulated forces.
_BETWEEN = ((0.05, 5.0), (1e-4, 1e-2), (20.0, 500.0), (0.5, 2.0))


def two_peaks(tabor: float, modulus_ratio: float, depth: float, rate: float) -> str:
    """Return in words that the force may have two maxima, or an empty string.

    Parameters
    ----------
    tabor, modulus_ratio : float
    depth : float
        Of the start [h0].
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
        f"contact has relaxed and one after: the rate is {rate / depth:.2g} times the preload in "
        "the retardation time"
    )
