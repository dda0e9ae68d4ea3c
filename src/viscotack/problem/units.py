"""The unit of time of a problem; and from a reduced material to SI, by the units on its cards."""

import re
from dataclasses import replace
from typing import Any

from viscotack.cards import Pairs, cards, check_carded
from viscotack.errors import InputError
from viscotack.materials import Elastic
from viscotack.traction import grows

_FACTOR = re.compile(r"(Pa|s)(?:\^(-?[0-9.]+))?")


def time_unit(material: Any, traction: Any) -> float:
    """Return the unit of dimensionless times [s]: the material's.

    An elastic solid has none; where the traction law grows with the opening speed, the time in
    which a gap opens by h_0 at its reference speed is the only one there is.
    """
    if isinstance(material, Elastic) and grows(traction):
        return traction.own_time
    return material.time_unit


def material_in_si(material: Any, modulus: float, time: float, poisson_ratio: float) -> Any:
    """Return a reduced material with its moduli and times multiplied by these [Pa], [s].

    Every number goes by the unit of its card, those of a user's own material as well.

    Raises
    ------
    ValueError
        If a constant has no card, or a unit that is not made of Pa and s.
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
    return replace(material, **changed, poisson_ratio=poisson_ratio)


def _factor(text: str, unit: dict[str, float]) -> float:
    """Return what one of a unit such as "Pa s^0.5" or "1/Pa" is in other moduli and times."""
    if text in unit:
        return unit[text]
    above, _, below = text.partition("/")
    factor = 1.0
    for words, sign in ((above, 1.0), (below, -1.0)):
        for word in words.split():
            found = _FACTOR.fullmatch(word)
            if found is None and word != "1":
                raise InputError(f"a material is measured in Pa and s, got {text!r}")
            if found is not None:
                factor *= unit[found[1]] ** (sign * float(found[2] or 1))
    return factor
