"""Options for a material: a published name, a passport, a table, or numbers."""

from typing import TYPE_CHECKING, Annotated, Any

from viscotack.errors import InputError

from ..flags import FLAGS, named_as_flags, table_of_solid
from ..options import Named, named, number, quoted
from ..request import Caller, Request

if TYPE_CHECKING:
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
