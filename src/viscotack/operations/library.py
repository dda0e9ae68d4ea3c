"""The operation ``material list``: list the library of published materials."""

from dataclasses import dataclass
from typing import ClassVar

from .declare.answer import Answer, Caller
from .declare.options import Operation


@dataclass(frozen=True, kw_only=True)
class ListMaterials(Operation):
    """List the published materials, each with its source and as a table of a case file.

    Example: viscotack material list
    """

    word: ClassVar = "material list"

    def answer(self, caller: Caller) -> Answer:
        """Read the library."""
        from .parts.library import library

        found = library()
        return Answer(
            found,
            record=lambda: {"materials": found},
            words=lambda: "\n".join(f"{one['name']:<16}{one['title']}" for one in found),
        )
