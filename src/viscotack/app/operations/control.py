"""The operations ``control``, ``export contact`` and ``schema``, for other programs."""

import json
from math import inf, isinf
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from viscotack.errors import InputError
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY

from .options import Output, binary_file, case, csv_file, main_file, number, option, picture, switch
from .parts.record_words import read, rows_of
from .request import Answer, Caller, Content, Request, write_file
from .simulate import Accuracy, Limit

if TYPE_CHECKING:
    from viscotack.design.control import ForceTable

# Part of the progress that the table takes, where a release follows.
_TABLE = 0.7
# Depths of a written grid of forces.
_DEPTHS = 201


class Control(Request):
    """Tabulate the force by depth and speed for a controller, and release at a wanted force.

    Simulates the retraction at as many speeds as the interpolation needs, and writes the table as
    C or as an FMU. With --wanted a controller that reads force and drive moves the drive of a
    simulated rig, behind its spring, so that the contact detaches at this force.

    Example: viscotack control lens.toml --slowest "1 um/s" --fastest "1 mm/s" --c contact.h
    --wanted "5 mN" --stiffness "300 N/m"
    """

    word: ClassVar = "control"
    outputs: ClassVar = (
        Output("c", "Write force and controller as a header of C99.", endings=(".h",)),
        binary_file("fmu", "Write an FMU 3.0, by the C compiler of this machine.", ".fmu"),
        csv_file("Write a row for each speed: pull-off force and travels."),
        csv_file("Write the force at each speed and 201 even depths, for lookup tables.", "forces"),
        csv_file("Write a row for each tick of the release.", "ticks"),
        picture("Draw forces by depth and the release."),
    )
    takes_own: ClassVar = True

    problem: Any = case("The contact in SI, on a rigid machine; its speed does not matter.")
    slowest: float = number("Slowest speed of the contact.", "m/s", above=0, default=...)
    fastest: float = number("Fastest speed of the contact.", "m/s", above=0, default=...)
    tolerance: float = number(
        "Largest miss over the pull-off force.", above=0, most=0.2, default=0.01
    )
    name: str = option("Name of the model, and prefix of the functions in C.", default="contact")
    wanted: float | None = number("Pull-off force of the release.", "N", above=0)
    stiffness: float | None = number("Stiffness of the rig; rigid if left out.", "N/m", above=0)
    period: float = number("Time between two ticks of the controller.", "s", above=0, default=1e-3)
    accuracy: Accuracy = DEFAULT_ACCURACY
    time_limit: Limit = 120.0

    def check(self) -> None:
        """Refuse options that exclude each other."""
        if self.wanted is None and self.stiffness is not None:
            raise InputError("the stiffness is that of the rig of a release; give wanted too")

    def answer(self, caller: Caller) -> Answer:
        """Tabulate, telling ``share``; release on the simulated rig if a force is wanted."""
        from viscotack.design.control import Release, c_header, fmu, force_table, let_go
        from viscotack.files.whole import write_whole
        from viscotack.plot.design import draw_control

        if self.wanted is None and "ticks" in caller.wants:
            raise InputError("ticks is of a release; give wanted")
        stated = self.stated(caller)
        problem: Any = stated.problem
        part = 1.0 if self.wanted is None else _TABLE
        table = force_table(
            problem,
            self.slowest,
            self.fastest,
            progress=lambda share: caller.share(part * share),
            **self.values("tolerance", "accuracy", "time_limit"),
        )
        release = released = None
        if self.wanted is not None:
            limits = self.stiffness or inf, self.period
            release = Release(table, self.wanted, *limits)
            released = let_go(problem, release, **self.values("accuracy", "time_limit"))
        rows, end = _rows(table), None
        files: dict[str, Content] = {
            "c": lambda to: write_whole(to, c_header(table, self.name).encode()),
            "fmu": lambda to: write_whole(to, fmu(table, self.name)),
            "csv": rows,
            "forces": lambda to: write_file(_forces(table), to),
        }
        if release is not None and released is not None:
            names = ("time_s", "drive_m", "depth_m", "force_N", "drive_speed_m_per_s")
            files["ticks"] = read(released, *names)
            end = read(released, "wanted_N") | {"contact_speed_m_per_s": release.speed}
            end |= read(released, "pull_off_force_N", "miss") | {"time_s": released.time[-1]}
        return Answer(
            table if released is None else (table, released),
            data={**read(table, "start_depth_m", "error"), "speeds": rows, "release": end},
            files=files,
            pictures={"plot": lambda: draw_control(table, released)},
            notes=stated.notes,
        )


def _rows(table: "ForceTable") -> list[dict[str, float]]:
    """Return a row for each speed."""
    names = ("travel_to_pull_off_m", "travel_to_half_m", "travel_to_end_m")
    travels = dict(zip(names, table.travel.T, strict=True))
    return rows_of(
        {"speed_m_per_s": table.speed, "pull_off_force_N": table.pull_off_force} | travels
    )


def _forces(table: "ForceTable") -> list[dict[str, float]]:
    """Return a row for each speed and depth of a rectangular grid, the deepest first."""
    depths = table.start_depth - np.linspace(0.0, float(table.travel.max()), _DEPTHS)
    return [
        {"speed_m_per_s": speed, "depth_m": depth, "force_N": table.force_at(depth, speed)}
        for speed in table.speed.tolist()
        for depth in depths.tolist()
    ]


class ExportContact(Request):
    """Write the contact of a sphere for other simulators: force by the history of its depth.

    A header of C99 with the contact radius and the memory of the bulk as its state. Every step is
    passive. Without -o it goes to standard output.

    Example: viscotack export contact glass_lens.toml -o lens.h
    """

    word: ClassVar = "export contact"
    outputs: ClassVar = (main_file("Write the header.", ".h", usual="-"),)
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
            **read(found, "range", "force_band", "work_band"),
            "fastest_edge_m_s": None if isinf(found.fastest) else found.fastest,
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


class Schema(Request):
    """Print the JSON schema of a problem: every number with its unit, symbol and range.

    It describes the object `problem` of --json, which results and campaigns keep as well.

    Example: viscotack schema > problem.schema.json
    """

    word: ClassVar = "schema"
    takes_own: ClassVar = True

    words: bool = switch("Tables in Markdown for people, in place of the schema.")

    def answer(self, caller: Caller) -> Answer:
        """Read the cards of all nouns."""
        from viscotack.model.problem.schema import schema, words

        found = schema(caller.also)
        return Answer(
            found,
            data=found,
            words=words(caller.also) if self.words else json.dumps(found, indent=2),
        )
