"""The published materials, and materials as tables of a case file."""

from typing import Any

import numpy as np

from viscotack.cards import with_units
from viscotack.model.materials.library import MATERIALS, published
from viscotack.model.materials.passport_words import in_words
from viscotack.model.materials.words import word_of


def material_table(material: Any) -> dict[str, Any]:
    """Return a material as the table [material] of a case file, with all its digits.

    Examples
    --------
    >>> from viscotack import Elastic
    >>> material_table(Elastic(rubbery_modulus=1e6, poisson_ratio=0.5))
    {'model': 'elastic', 'rubbery_modulus': '1000000.0 Pa', 'poisson_ratio': 0.5}
    """
    return {"model": word_of(material), **with_units(material)}


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
