"""Options for a material: a published name, a passport, a table, or numbers."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

from viscotack.errors import InputError
from viscotack.materials.passport import Passport

from ..declare.cards import Named, Number, Spelled
from ..declare.options import Part
from ..declare.questions import SPHERE, material_from

if TYPE_CHECKING:
    from viscotack.materials.material import Material

# How a text begins that states a solid itself.
TABLE = "[material]"


def published() -> Iterable[str]:
    """Return the names of the published materials."""
    from viscotack.materials.library import MATERIALS

    return MATERIALS


_WORDS = "A material passport, or the name of a published material such as pdms-10-1"
Known = Annotated[
    str | Passport,
    Named(
        f"{_WORDS}.", metavar="PASSPORT", argument=True, published=published, objects=(Passport,)
    ),
]
Solid = Annotated[
    str | Passport,
    Named(
        f"{_WORDS}; or the text of a table {TABLE}.",
        metavar="PASSPORT",
        published=published,
        text=TABLE,
        objects=(Passport,),
    ),
]


def passport_of(given: str | Passport, also: tuple[Any, ...] = ()) -> Passport:
    """Return the passport of a published name or a file, or the one that Python gave."""
    from viscotack.materials import library

    return given if isinstance(given, Passport) else library.passport_of(given, also=also)


def solid_of(words: str | Passport, also: tuple[Any, ...] = ()) -> "Passport | Material":
    """Return the passport of a name or a file, or the solid of the text of a table."""
    if isinstance(words, Passport) or not words.lstrip().startswith(TABLE):
        return passport_of(words, also)
    from viscotack.files.toml import parse_toml

    from ..declare.state import State
    from .examples import FIRST

    table = parse_toml(words, "the material").get("material")
    if not isinstance(table, dict):
        raise InputError(f"the text of a solid must be the table {TABLE}, got {words!r:.60}")
    # by way of a case that has it: what a table may say is known in one place
    return State(FIRST | {"material": table}, also).problem.material


def material_words(words: str) -> Any:
    """Return the card of a material by its word, as the flags of a problem state it."""
    return Spelled(
        words, metavar="MATERIAL", before=("prony:",), endings=(".toml",), objects=(Passport,)
    )


_NUMBERS = {question.name: question.words for question in SPHERE.questions}


@dataclass(frozen=True, kw_only=True)
class Reduced(Part):
    """Options for a dimensionless material: a model with its numbers, or a file."""

    material: Annotated[
        str | Passport | None,
        material_words(
            "power-law (also when left out; theory steady-crack without --exponent takes sls), "
            "sls, prony:FILE or a passport FILE.toml, as for simulate sphere."
        ),
    ] = None
    modulus_ratio: Annotated[
        float | None, Number(_NUMBERS["modulus-ratio"], above=0, metavar="K")
    ] = None
    exponent: Annotated[float | None, Number(_NUMBERS["exponent"], above=0, metavar="N")] = None

    @property
    def given(self) -> dict[str, Any]:
        """Given options by name."""
        said = {
            "material": self.material,
            "modulus-ratio": self.modulus_ratio,
            "exponent": self.exponent,
        }
        return {flag: value for flag, value in said.items() if value is not None}

    def stated(self, usual: str = "power-law") -> "tuple[Material, str]":
        """Return the solid, and the unit of its times if a file states one, else "1".

        `usual` is the word of the material where none is said.
        """
        return material_from({"material": usual, **self.given})
