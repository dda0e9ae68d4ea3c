"""The published materials, and materials as tables of a case file."""

from typing import Any

import numpy as np

from viscotack.cards import Pairs, cards
from viscotack.materials.library import MATERIALS, published
from viscotack.materials.passport_words import in_words
from viscotack.materials.words import word_of
from viscotack.units import readable


def material_table(material: Any) -> dict[str, Any]:
    """Return a material as the table [material] of a case file, with all its digits.

    Examples
    --------
    >>> from viscotack import Elastic
    >>> material_table(Elastic(rubbery_modulus=1e6, poisson_ratio=0.5))
    {'model': 'elastic', 'rubbery_modulus': '1000000.0 Pa', 'poisson_ratio': 0.5}
    """
    kind = type(material)
    table: dict[str, Any] = {"model": word_of(material)}
    for name, field in cards(kind).items():
        table[name] = _said(getattr(material, name), field.card.unit)
    for name, field in cards(kind, Pairs).items():
        first, second = field.card.units
        table[name] = [[_said(a, first), _said(b, second)] for a, b in getattr(material, name)]
    return table


def _said(value: float, unit: str) -> Any:
    return float(value) if unit == "1" else f"{float(value)!r} {unit}"


def library_table() -> str:
    """Return the published materials as a table in Markdown, for the documentation."""
    lines = [
        "| name | material | rubbery and glassy Young's modulus | measured | source |",
        "|---|---|---|---|---|",
    ]
    for name in MATERIALS:
        passport = published(name)
        solid, low, high = passport.material, *(w / (2 * np.pi) for w in passport.frequencies or ())
        moduli = readable(solid.rubbery_modulus, "Pa", digits=3)
        if solid.modulus_ratio < 1:
            moduli += f", {readable(solid.glassy_modulus, 'Pa', digits=3)}"
        known = readable(low, "Hz", digits=2, to=high)
        if passport.temperature is not None:
            known += f" at {passport.temperature - 273.15:.3g} C"
        origin = passport.origin
        source = origin.reference + (f", doi:{origin.doi}" if origin.doi else "")
        lines.append(f"| `{name}` | {passport.name} | {moduli} | {known} | {source} |")
    return "\n".join(lines)


def library() -> list[dict[str, Any]]:
    """Return the published materials, each as the table [material] of a case file."""
    found = []
    for name in MATERIALS:
        passport = published(name)
        table = material_table(passport.material)
        found.append(
            {
                "name": name,
                "title": passport.name,
                "table": table,
                "measured_Hz": [w / (2 * np.pi) for w in passport.frequencies or ()],
                "source": passport.origin.reference,
                "doi": passport.origin.doi,
                "words": in_words(passport),
            }
        )
    return found
