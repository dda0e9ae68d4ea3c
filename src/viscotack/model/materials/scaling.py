"""Change the units of modulus and time of a material, by the units of its cards."""

import re
from dataclasses import replace
from typing import Any

from viscotack.cards import Pairs, cards, check_carded
from viscotack.errors import InputError

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
