"""Names of the materials and of their constants in files, such as ``model = "power-law"``."""

from collections.abc import Mapping
from typing import Any

from viscotack.errors import InputError
from viscotack.model.materials.branched_solids import Elastic, Prony, StandardSolid
from viscotack.model.materials.fractional import FractionalZener
from viscotack.model.materials.material import Material
from viscotack.model.materials.power_law import RelaxationPowerLaw, RetardationPowerLaw

# Word in a file -> class.
MODELS: Mapping[str, Any] = {
    kind.word: kind
    for kind in (
        Elastic,
        StandardSolid,
        Prony,
        RetardationPowerLaw,
        RelaxationPowerLaw,
        FractionalZener,
    )
}


def word_of(material: Material) -> str:
    """Return the word of a material's model in files.

    Examples
    --------
    >>> word_of(Elastic(rubbery_modulus=1e6, poisson_ratio=0.5))
    'elastic'
    """
    word = getattr(material, "word", None)
    if word is None:
        raise InputError(
            f"{type(material).__name__} has no word in files; define "
            f'word: ClassVar[str] = "..." in the class, different from {", ".join(MODELS)}'
        )
    return word
