"""The operation ``material list``: list the library of published materials."""

from typing import Any, ClassVar

from viscotack.units import readable

from .request import Answer, Caller, Request


class ListMaterials(Request):
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
            data=lambda: {"materials": found},
            words=lambda: "\n".join(_line(one) for one in found),
        )


def _line(one: dict[str, Any]) -> str:
    """Return name, measured range and source of a material as lines of text."""
    low, high = one["measured_Hz"]
    known = readable(low, "Hz", digits=2, to=high)
    return f"{one['name']:<18}{one['title']}\n{'':<18}{known}; {one['source']}"
