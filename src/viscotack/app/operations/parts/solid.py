"""Options for a material and a layer; published materials, and example cases, as tables."""

import tomllib
from importlib.resources import files
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from viscotack.app.operations.flags import BONDED, FLAGS, named_as_flags, table_of_solid
from viscotack.app.operations.options import Named, named, number, quoted
from viscotack.app.operations.request import Caller, Request
from viscotack.cards import with_units
from viscotack.errors import InputError
from viscotack.model.materials.library import MATERIALS, published
from viscotack.model.materials.material import word_of
from viscotack.model.materials.passport_file import in_words

if TYPE_CHECKING:
    from viscotack.model.geometry import HalfSpace, Layer
    from viscotack.model.materials.material import Material
    from viscotack.model.materials.passport import Passport

# How a text begins that states a solid itself.
TABLE = "[material]"
_WORDS = "A material passport, or the name of a published material such as pdms-10-1"
APassport = Annotated[Any, Named(f"{_WORDS}.", argument=True)]
Solid = Annotated[Any, Named(f"{_WORDS}; or the text of a table {TABLE}.")]


def passport_of(given: "str | Passport", caller: Caller) -> "Passport":
    """Return the passport of a published name or a file, or the one that Python gave."""
    from viscotack.model.materials import library
    from viscotack.model.materials.passport import Passport

    if isinstance(given, Passport) or given in library.MATERIALS:
        return given if isinstance(given, Passport) else library.published(given)
    return library.passport_of(str(caller.file(given)), also=caller.also)


def solid_of(given: "str | Passport", caller: Caller) -> "Passport | Material":
    """Return the passport of a name or a file, or the solid of the text of a table."""
    if not isinstance(given, str) or not given.lstrip().startswith(TABLE):
        return passport_of(given, caller)
    from viscotack.files.toml import parse_toml
    from viscotack.model.problem.case_file import material_of
    from viscotack.model.problem.nouns import known
    from viscotack.model.tables import Reading

    table = parse_toml(given, "the material").get("material")
    if not isinstance(table, dict):
        raise InputError(f"the text of a solid must be the table {TABLE}, got {given!r:.60}")
    return material_of(table, Reading("the material", known(caller.also)))


class Reduced(Request):
    """A request for a dimensionless material: a model with its numbers, or a file."""

    material: Any = named(
        "power-law (also when left out; theory steady-crack without --exponent takes sls), "
        "sls, prony:FILE or a passport FILE.toml, as for simulate sphere.",
        metavar="MATERIAL",
    )
    modulus_ratio: float | None = number(FLAGS["modulus_ratio"].words, above=0)
    exponent: float | None = number(FLAGS["exponent"].words, above=0)

    @property
    def given(self) -> dict[str, Any]:
        """Given options of the material by name."""
        said = self.values(*Reduced.model_fields)
        return {name: value for name, value in said.items() if value is not None}

    def solid(self, caller: Caller, usual: str = "power-law") -> "Material":
        """Return the solid; `usual` is the word of the material where none is said."""
        from viscotack.model.materials.passport import Passport
        from viscotack.model.problem.case_file import material_of
        from viscotack.model.problem.nouns import known
        from viscotack.model.tables import Reading

        nouns, words = known(caller.also), self.material or usual
        numbers = {name: x for name, x in self.given.items() if name != "material"}
        if isinstance(words, Passport):
            if numbers:
                raise InputError(
                    f"{words.name} defines the whole material; leave out {quoted(numbers)}"
                )
            return words.material.reduced()
        with named_as_flags("sphere", in_si=False):
            table = table_of_solid(words, numbers, nouns)
            return material_of(table, Reading("the options", nouns, caller.file, pure=True))


class OnLayer(Request):
    """A contact on a half-space, or on a layer of a thickness."""

    thickness: float | None = number(
        'Thickness of a layer on a rigid base, "60 um"; a half-space when left out.', "m", above=0
    )
    bonded: float | None = number(BONDED, least=0, most=0.5)

    def check(self) -> None:
        """Refuse a base without a layer."""
        super().check()
        if self.bonded is not None and self.thickness is None:
            raise InputError("bonded needs a layer; give its thickness as well", field="bonded")

    @property
    def body(self) -> "HalfSpace | Layer":
        """The half-space or the layer."""
        from viscotack.model.geometry import Bonded, Frictionless, HalfSpace, Layer

        if self.thickness is None:
            return HalfSpace()
        nu = self.bonded
        return Layer(self.thickness, Frictionless() if nu is None else Bonded(poisson_ratio=nu))


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


# Title -> tables of a case file.
EXAMPLES: dict[str, dict[str, dict[str, Any]]] = tomllib.loads(
    files("viscotack.app.page").joinpath("examples.toml").read_text("utf-8")
)
FIRST = next(iter(EXAMPLES.values()))
