"""The operation ``export contact``: a contact with memory for other simulators."""

from math import isinf
from typing import Any, ClassVar

from .options import case, main_file, option
from .request import Answer, Caller, Request


class ExportContact(Request):
    """Write the contact of a sphere for other simulators: force by the history of its depth.

    A header of C99 with the contact radius and the memory of the bulk as its state. Every step is
    passive. Without -o it goes to standard output.

    Example: viscotack export contact glass_lens.toml -o lens.h
    """

    word: ClassVar = "export contact"
    outputs: ClassVar = (
        main_file("Write the header to this file; - is standard output.", ".h", usual="-"),
    )
    takes_own: ClassVar = True

    problem: Any = case("A sphere on a half-space in SI; its protocol does not matter.")
    name: str = option("Type of the contact, and prefix of the functions.", default="contact")

    def answer(self, caller: Caller) -> Answer:
        """Reduce the contact and write it."""
        from viscotack.design.control import reduced_contact, reduced_header

        stated = self.stated(caller)
        problem: Any = stated.problem
        found = reduced_contact(problem)
        text = reduced_header(found, self.name)
        record = {
            "contact": found.of,
            "range": found.range,
            "fastest_edge_m_s": None if isinf(found.fastest) else found.fastest,
            "force_band": list(found.force_band),
            "work_band": list(found.work_band),
            "cells": found.node.size - 1,
            "modes": found.modulus.size,
        }
        shown = record | {"largest_stiffness_at_1_mm_N_per_m": found.stiffness(1e-3)}
        return Answer(
            found,
            data=record | {"text": text},
            words=shown if "output" in caller.wants else text.rstrip("\n"),
            files={"output": text},
            notes=stated.notes,
        )
