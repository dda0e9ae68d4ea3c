r"""Convert solids: relaxation and retardation form, Prony series, other units, two bodies as one.

A generalised Maxwell solid (parallel branches, :class:`Prony`) and a chain of Voigt elements
(:func:`retardation_series`) are two forms of the same material:

.. math::

    R(t) = E_0 + \sum_i E_i e^{-t/\tau_i} , \qquad
    C(t) = \frac{1}{E_\infty} + \sum_j C_j (1 - e^{-t/\lambda_j})

Their times differ: each retardation time is longer than its relaxation time. The conversion is
exact, see :mod:`viscotack.model.materials.modes`.

**Two deformable bodies in contact as one on a rigid body.** Two half-spaces under the same pressure
move their surfaces by amounts that add, so that the contact has the sum of their creep functions,

.. math:: \frac{C(t)}{E^*} = (1 - \nu_1^2)\, C_1(t) + (1 - \nu_2^2)\, C_2(t),

and is that of a rigid indenter on one solid with this creep. The same holds for two coats of the
same thickness, base and Poisson ratio on rigid bodies, each being the :class:`viscotack.Layer` of
the problem. It does not hold for other pairs with a coat, whose surfaces move by different
functions of the distance.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from viscotack.cards import Pairs, cards, check_carded
from viscotack.errors import InputError
from viscotack.model.materials.branched_solids import Elastic, Prony, StandardSolid
from viscotack.model.materials.material import Material
from viscotack.model.materials.modes import reciprocal
from viscotack.units import positive

# Relative difference below which two times are the same.
_SAME = 1e-12
_FACTOR = re.compile(r"(Pa|s)(?:\^(-?[0-9.]+))?")


def scaled(material: Any, *, modulus: float, time: float) -> Any:
    """Multiply the moduli and the times of a material by factors.

    Each constant is scaled by the unit of its card, for user-defined materials as well.

    Raises
    ------
    ValueError
        If a constant has no card, or a unit that is not composed of Pa and s.

    Examples
    --------
    >>> from viscotack.model.materials.branched_solids import StandardSolid
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, tau0=2.0, poisson_ratio=0.5
    ... )
    >>> scaled(solid, modulus=1.0, time=10.0).tau0
    20.0
    """
    kind, unit = type(material), {"Pa": modulus, "s": time}
    check_carded(kind)
    changed: dict[str, Any] = {
        name: getattr(material, name) * _factor(field.card.unit, unit)
        for name, field in cards(kind).items()
        if field.card.unit != "1"
    }
    for name, field in cards(kind, Pairs).items():
        first, second = (_factor(u, unit) for u in field.card.units)
        changed[name] = tuple((x * first, y * second) for x, y in getattr(material, name))
    return replace(material, **changed)


def _factor(text: str, unit: dict[str, float]) -> float:
    """Return the scale factor of a unit such as "Pa s^0.5" or "1/Pa"."""
    if text in unit:
        return unit[text]
    above, _, below = text.partition("/")
    factor = 1.0
    for words, sign in ((above, 1.0), (below, -1.0)):
        for word in words.split():
            found = _FACTOR.fullmatch(word)
            if found is None and word != "1":
                raise InputError(f"units of a material must be composed of Pa and s, got {text!r}")
            if found is not None:
                factor *= unit[found[1]] ** (sign * float(found[2] or 1))
    return factor


@dataclass(frozen=True, kw_only=True)
class PronyForm:
    """A Prony series that approximates a solid, and its error.

    Attributes
    ----------
    material : Prony
        The series; its rubbery modulus is exactly that of the solid.
    error : float
        Largest relative error of the complex modulus between the two frequencies, evaluated on a
        grid of 40 points per decade; 0 if the solid is itself a sum of exponentials.
    frequencies : tuple of float
        Angular frequencies [rad/s] between which it is valid. Above the higher one the series is
        too soft, because the spectrum above it is part of the instantaneous compliance.
    """

    material: Prony
    error: float
    frequencies: tuple[float, float]


def retardation_series(material: Prony | StandardSolid) -> tuple[tuple[float, float], ...]:
    """Return the Voigt elements of a solid, exact to round-off.

    Returns
    -------
    tuple of (float, float)
        Compliance C_j [1/Pa] and RETARDATION time lambda_j [s] of each element, by time.

    Examples
    --------
    >>> solid = Prony(
    ...     rubbery_modulus=1e6, branches=[(5e6, 1e-3), (4e6, 1.0)], poisson_ratio=0.5
    ... )
    >>> elements = retardation_series(solid)
    >>> [f"{C:.4g} 1/Pa in {time:.4g} s" for C, time in elements]
    ['9.968e-08 1/Pa in 0.001998 s', '8.003e-07 1/Pa in 5.004 s']
    >>> back = relaxation_series(elements, glassy_modulus=1e7, poisson_ratio=0.5)
    >>> f"{back.branches[1][1]:.14g}"
    '1'
    """
    C, rate = relaxation_form(material).retardation()
    return tuple(zip(C[::-1].tolist(), (1 / rate[::-1]).tolist(), strict=True))


def relaxation_series(
    elements: Iterable[tuple[float, float]], *, glassy_modulus: float, poisson_ratio: float
) -> Prony:
    """Return the Prony series of a spring [Pa] and Voigt elements, exact to round-off.

    The elements are those of :func:`retardation_series`, in any order.
    """
    C, time = np.array(sorted(elements, key=lambda element: element[1])).T
    E, tau = reciprocal(1 / glassy_modulus, C, time)
    return Prony(
        # a sum of positive terms, without cancellation
        rubbery_modulus=1 / (1 / glassy_modulus + float(np.sum(C))),
        branches=tuple(zip(E, tau, strict=True)),
        poisson_ratio=poisson_ratio,
    )


def relaxation_form(material: Prony | StandardSolid) -> Prony:
    """Return a solid of exponentials as a Prony series: itself, or one branch.

    Examples
    --------
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, tau0=2.0, poisson_ratio=0.5
    ... )
    >>> relaxation_form(solid).branches
    ((9000000.0, 0.2),)
    """
    if isinstance(material, Prony):
        return material
    if not isinstance(material, StandardSolid) or material.modulus_ratio == 1:
        raise InputError(
            f"{type(material).__name__} is not a sum of exponentials; use prony_form for an "
            "approximation"
        )
    return Prony(
        rubbery_modulus=material.rubbery_modulus,
        branches=((material.glassy_modulus - material.rubbery_modulus, material.relaxation_time),),
        poisson_ratio=material.poisson_ratio,
    )


def prony_form(
    material: Material, *, frequencies: tuple[float, float], tolerance: float = 3e-4
) -> PronyForm:
    """Approximate the complex modulus of a solid by a Prony series between two frequencies.

    Uses the exact modes of the creep, as few as the tolerance allows, with exact
    interconversion and without fitting. A solid of exponentials is returned unchanged.

    Parameters
    ----------
    material : StandardSolid, Prony, RetardationPowerLaw or RelaxationPowerLaw
        The solid; not an elastic one.
    frequencies : (float, float)
        Lowest and highest angular frequency [rad/s], positive.
    tolerance : float
        Largest relative error of the complex modulus between them, in (0, 1). The default
        changes the simulated pull-off force of a power law by less than 1e-4.

    Raises
    ------
    ValueError
        If the solid is elastic, or the tolerance cannot be reached (below about 1e-10).

    Examples
    --------
    >>> from viscotack.model.materials import RetardationPowerLaw
    >>> solid = RetardationPowerLaw(
    ...     rubbery_modulus=1e6, glassy_modulus=1e8, exponent=0.5, tau0=1e-3, poisson_ratio=0.5
    ... )
    >>> form = prony_form(solid, frequencies=(1.0, 1e6))
    >>> len(form.material.branches), form.error < 3e-4
    (19, True)
    """
    low, high = (positive("a frequency", w, "rad/s") for w in frequencies)
    if not 0 < tolerance < 1:
        raise InputError(f"tolerance is relative and must lie between 0 and 1, got {tolerance:g}")
    if low >= high:
        raise InputError(f"frequencies must ascend, got {low:g} and {high:g} rad/s")
    if isinstance(material, Prony) or isinstance(material, StandardSolid):
        return PronyForm(material=relaxation_form(material), error=0.0, frequencies=(low, high))
    if material.modulus_ratio == 1 or isinstance(material, Elastic):
        raise InputError("an elastic solid does not relax, so it has no Prony series")
    omega = np.geomspace(low, high, 2 + int(40 * np.log10(high / low)))
    exact = material.complex_modulus(omega)
    least = float(np.min(np.abs(material.complex_compliance(omega))) * material.rubbery_modulus)
    # The modulus of a mode varies as omega tau, more slowly than exp(-t/tau): widen the time
    # window.
    error = np.inf
    for finer in (30.0, 10.0, 3.0, 1.0, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4):
        part = min(tolerance * finer, 0.5)
        modes = material.retardation_modes(
            shortest=part / high, longest=1 / (part * low), tolerance=max(part * least, 1e-14)
        )
        E, tau = reciprocal(modes.instantaneous, np.array(modes.weights), np.array(modes.times))
        keep = E > 0  # a mode too weak to move its pole gives no branch
        series = Prony(
            rubbery_modulus=material.rubbery_modulus,
            branches=tuple(zip(material.rubbery_modulus * E[keep], tau[keep], strict=True)),
            poisson_ratio=material.poisson_ratio,
        )
        error = float(np.max(np.abs(np.asarray(series.complex_modulus(omega)) / exact - 1)))
        if error <= tolerance:
            return PronyForm(material=series, error=error, frequencies=(low, high))
    raise InputError(
        f"the closest series has an error of {error:.1e}, above the tolerance {tolerance:g}; "
        "increase the tolerance"
    )


def slowed(material: Any, factor: float) -> Any:
    """Multiply all times of a solid by a factor, as a change of temperature does.

    Parameters
    ----------
    material : Material
        Any solid; its times are the numbers whose cards have a unit of time.
    factor : float
        Shift factor a_T, positive; above 1 for a slower solid.

    Examples
    --------
    >>> solid = StandardSolid(
    ...     rubbery_modulus=1e6, glassy_modulus=1e7, tau0=2.0, poisson_ratio=0.5
    ... )
    >>> slowed(solid, 100.0).tau0
    200.0
    """
    a = positive("factor", factor, "-")
    return scaled(material, modulus=1.0, time=a)


def effective_solid(
    first: Elastic | Prony | StandardSolid, second: Elastic | Prony | StandardSolid
) -> Elastic | Prony:
    """Return the solid of a half-space equivalent to two bodies.

    Parameters
    ----------
    first, second : Elastic, Prony or StandardSolid
        Solids of the two bodies; :func:`prony_form` approximates another one.

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
    merged: list[tuple[float, float]] = []
    for compliance, time in sorted(elements, key=lambda element: element[1]):
        if merged and time <= merged[-1][1] * (1 + _SAME):
            merged[-1] = merged[-1][0] + compliance, merged[-1][1]
        else:
            merged.append((compliance, time))
    return relaxation_series(merged, glassy_modulus=1 / instantaneous, poisson_ratio=nu)
