"""The names of the materials and of their constants in files: ``model = "power-law"``."""

from collections.abc import Mapping
from typing import Any

from viscotack.materials.material import Material
from viscotack.materials.power_law import RelaxationPowerLaw, RetardationPowerLaw
from viscotack.materials.solids import Elastic, Prony, StandardSolid

_POWER_LAW = {"glassy_modulus": "Pa", "exponent": "1", "tau0": "s"}

# Word in a file -> class, and the SI unit of each constant beside the two that all have.
MODELS: Mapping[str, tuple[Any, Mapping[str, str]]] = {
    "elastic": (Elastic, {}),
    "sls": (StandardSolid, {"glassy_modulus": "Pa", "tau0": "s"}),
    "prony": (Prony, {}),
    "power-law": (RetardationPowerLaw, _POWER_LAW),
    "relaxation-power-law": (RelaxationPowerLaw, _POWER_LAW),
}
_ALL = {"rubbery_modulus": "Pa", "poisson_ratio": "1"}


def units_of(model: str) -> dict[str, str]:
    """Return the SI unit of each plain constant of a model, by its name."""
    return _ALL | dict(MODELS[model][1])


def word_of(material: Material) -> str:
    """Return the word of a material's model in files.

    Examples
    --------
    >>> word_of(Elastic(rubbery_modulus=1e6, poisson_ratio=0.5))
    'elastic'
    """
    for word, (kind, _) in MODELS.items():
        if isinstance(material, kind):
            return word
    raise ValueError(f"{type(material).__name__} has no word in files; those known are {[*MODELS]}")
