r"""Limits and error of a crack that recedes on a film, from simulations.

Of 56 simulations with Lennard-Jones forces (thickness 0.1 to 3 beta, Tabor
numbers 5 to 16, modulus ratios 0.03 and 0.1, Poisson ratios 0.3 to 0.5 and sliding) the theory
(:mod:`.recession`) applies to 29, and is within 3 % + 7 % times :math:`\ell a/b^2` of each;
:math:`\ell` is the length of the cohesive zone and a the contact radius, both at pull-off. The
number is limited to 0.5: on thinner films the forces reach through the film, and the force is
smaller, down to half.
"""

# Relative error: a constant, and a factor of l a/b^2, which is limited.
ERROR, ERROR_BY_ZONE, MOST_ZONE = 0.03, 0.07, 0.5
# Smallest modulus ratio, as simulated.
LEAST_RATIO = 0.03
# Smallest Tabor number over the cube root of the energy at pull-off; smallest start over the radius
# at pull-off, or travel of the edge in zone lengths.
_LEAST_TABOR, _LEAST_START, _LEAST_ZONES = 2.9, 1.2, 10.0


def outside(effective: float, start: float, through: float, zones: float = 0.0) -> str:
    """Return why the theory of a receding crack does not hold at a pull-off, or "".

    Parameters
    ----------
    effective : float
        Effective Tabor number at the energy of the edge.
    start : float
        Contact radius of the start over that at pull-off.
    through : float
        Length of the cohesive zone times contact radius over the squared thickness of a film; 0 on
        a half-space.
    zones : float
        Travel of the edge until pull-off in lengths of the cohesive zone, if known.
    """
    if effective < _LEAST_TABOR:
        return (
            f"the cohesive zone is too long: effective Tabor number {effective:.3g} at the energy "
            f"of the edge, valid from {_LEAST_TABOR:g}"
        )
    if start < _LEAST_START and zones < _LEAST_ZONES:
        why = f"the start is {start:.3g} times the radius at pull-off, valid from "
        why += f"{_LEAST_START:g} times"
        return why + (f" or {_LEAST_ZONES:g} zone lengths, not {zones:.2g}" if zones else "")
    if through > MOST_ZONE:
        return (
            "the film is too thin for the range of the forces: zone length times contact radius "
            f"is {through:.2g} times the squared thickness, valid up to {MOST_ZONE:g}; the force "
            "is an upper limit"
        )
    return ""
