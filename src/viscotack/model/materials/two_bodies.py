r"""Two deformable bodies in contact as one on a rigid body.

Two half-spaces under the same pressure move their surfaces by amounts that add, so that the contact
has the sum of their creep functions,

.. math:: \frac{C(t)}{E^*} = (1 - \nu_1^2)\, C_1(t) + (1 - \nu_2^2)\, C_2(t),

and is that of a rigid indenter on one solid with this creep. The same holds for two coats of the
same thickness, base and Poisson ratio on rigid bodies, each being the :class:`viscotack.Layer` of
the problem. It does not hold for other pairs with a coat, whose surfaces move by different
functions of the distance.
"""

from __future__ import annotations

from viscotack.errors import InputError
from viscotack.model.materials.branched_solids import Elastic, Prony, StandardSolid
from viscotack.model.materials.conversion import relaxation_series, retardation_series

# Relative difference below which two times are the same.
_SAME = 1e-12


def effective_solid(
    first: Elastic | Prony | StandardSolid, second: Elastic | Prony | StandardSolid
) -> Elastic | Prony:
    """Return the solid of a half-space equivalent to two bodies.

    Parameters
    ----------
    first, second : Elastic, Prony or StandardSolid
        Solids of the two bodies; :func:`viscotack.model.materials.conversion.prony_form`
        approximates another one.

    Returns
    -------
    Elastic or Prony
        Its creep compliance times (1 - nu^2) is the sum of both. It has their Poisson ratio if it
        is the same, else 0; only the contact modulus enters a half-space.

    Raises
    ------
    ValueError
        If a solid is not a sum of exponentials.

    Examples
    --------
    A soft sphere on a soft half-space of the same silicone:

    >>> silicone = StandardSolid(
    ...     rubbery_modulus=2e6, glassy_modulus=2e7, tau0=1.0, poisson_ratio=0.5
    ... )
    >>> pair = effective_solid(silicone, silicone)
    >>> f"{pair.rubbery_modulus / 1e6:.3f} MPa, k = {pair.modulus_ratio:.3f}"
    '1.000 MPa, k = 0.100'
    """
    for solid in (first, second):
        if not isinstance(solid, Elastic | Prony | StandardSolid):
            raise InputError(
                "the solids of two bodies must be Elastic, Prony or StandardSolid, got "
                f"{type(solid).__name__}; prony_form approximates it"
            )
    same = first.poisson_ratio == second.poisson_ratio
    nu = first.poisson_ratio if same else 0.0
    instantaneous, elements = 0.0, []
    for solid in (first, second):
        part = (1 - solid.poisson_ratio**2) / (1 - nu**2)
        instantaneous += part / solid.glassy_modulus
        if not isinstance(solid, Elastic):
            elements += [(part * C, time) for C, time in retardation_series(solid)]
    if not elements:
        return Elastic(rubbery_modulus=1 / instantaneous, poisson_ratio=nu)
    return relaxation_series(_merged(elements), glassy_modulus=1 / instantaneous, poisson_ratio=nu)


def _merged(elements: list[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """Return Voigt elements sorted by time, those of the same time as one."""
    found: list[tuple[float, float]] = []
    for compliance, time in sorted(elements, key=lambda element: element[1]):
        if found and time <= found[-1][1] * (1 + _SAME):
            found[-1] = found[-1][0] + compliance, found[-1][1]
        else:
            found.append((compliance, time))
    return tuple(found)
