"""A solid that an operation is given: published, in a passport, or as the text of a table."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Annotated, Any

from viscotack.errors import InputError

from ..declare.cards import Named, Spelled

if TYPE_CHECKING:
    from viscotack.materials.material import Material
    from viscotack.materials.passport import Passport

# How a text begins that states a solid itself.
TABLE = "[material]"


def published() -> Iterable[str]:
    """Return the names of the published materials."""
    from viscotack.materials.library import MATERIALS

    return MATERIALS


_WORDS = "A material passport, or the name of a published material such as pdms-10-1"
Known = Annotated[str, Named(f"{_WORDS}.", metavar="PASSPORT", argument=True, published=published)]
Solid = Annotated[
    str,
    Named(
        f"{_WORDS}; or the text of a table {TABLE}.",
        metavar="PASSPORT",
        published=published,
        text=TABLE,
    ),
]


def solid_of(words: str, also: tuple[Any, ...] = ()) -> "Passport | Material":
    """Return the passport of a name or a file, or the solid of the text of a table."""
    if not words.lstrip().startswith(TABLE):
        from viscotack.materials.library import passport_of

        return passport_of(words, also=also)
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
    return Spelled(words, metavar="MATERIAL", before=("prony:",), endings=(".toml",))
