"""The operation ``export contact``: a contact with memory for other simulators."""

from typing import TYPE_CHECKING, Any, ClassVar

from viscotack.units import readable

from .request import Answer, Caller, Output, Request, contact, option

if TYPE_CHECKING:
    from viscotack.design.control import ReducedContact


class ExportContact(Request):
    """Write the contact of a sphere for other simulators: force by the history of its depth.

    A header of C99 with the contact radius and the memory of the bulk as its state. Every step is
    passive. Without -o it goes to standard output.

    Example: viscotack export contact glass_lens.toml -o lens.h
    """

    word: ClassVar = "export contact"
    outputs: ClassVar = (
        Output(
            "output",
            "Write the header to this file; - is standard output.",
            flags=("-o", "--output"),
            usual="-",
            endings=(".h",),
        ),
    )
    takes_own: ClassVar = True

    problem: Any = contact(
        "A sphere on a half-space in SI; its protocol does not matter.",
        indenters=("sphere",),
        spelling="case",
        default=...,
    )
    name: str = option(
        "Type of the contact, and prefix of the functions in C.", metavar="NAME", default="contact"
    )

    def answer(self, caller: Caller) -> Answer:
        """Reduce the contact and write it."""
        from viscotack.design.control import reduced_contact, reduced_header

        from .parts.tables import as_text

        stated = self.stated(caller)
        problem: Any = stated.problem
        contact = reduced_contact(problem)
        text = reduced_header(contact, self.name)
        return Answer(
            contact,
            data=lambda: _record(contact, text),
            words=lambda: _words(contact) if "output" in caller.wants else text.rstrip("\n"),
            files={"output": as_text(lambda: text)},
            notes=stated.notes,
        )


def _record(contact: "ReducedContact", text: str) -> dict[str, Any]:
    """Return the numbers of the answer."""
    return {
        "contact": contact.of,
        "range": contact.range,
        "cells": contact.node.size - 1,
        "modes": contact.modulus.size,
        "text": text,
    }


def _words(contact: "ReducedContact") -> str:
    """Return the answer as lines."""
    return "\n".join(
        [
            contact.of,
            f"range: {contact.range}",
            f"state: {contact.node.size - 1} cells of {contact.modulus.size} modes",
            "stiffness at a contact radius of 1 mm: at most "
            f"{readable(contact.stiffness(1e-3), 'N/m')}",
        ]
    )
