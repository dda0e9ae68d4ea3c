"""The operation ``test read``: evaluate the files of a tack tester or microscope."""

from pathlib import Path
from typing import Any, ClassVar

from viscotack.errors import InputError

from .options import binary_file, csv_file, number, picture
from .parts.files import Rig, ShiftLaw, refusals
from .parts.tables import drawn
from .request import Answer, Caller, write_file

_MOST = 1500  # points of a curve on the page
# An apparent work [J/m2] a hundred times that of any two surfaces without chemical bonds.
_LARGEST_WORK = 10.0


class ReadTests(Rig, ShiftLaw):
    """Read tack tests or force curves: pull-off, work, depth and true speed of every cycle.

    Approach, dwell and retraction are detected in the signal. Zero, tilt and drift of the force are
    corrected, and each number has a standard uncertainty. An unreliable curve is rejected with the
    reason; the others are evaluated. Repeated tests are averaged by temperature and speed. With a
    shift of times with temperature, the force is also given by the speed a_T v at the reference
    temperature. Exit status 2 if no cycle can be evaluated.

    Example: viscotack test read probe_Interval_*.csv --compliance "2 um/N" --plot tests.png
    --xlsx tests.xlsx
    """

    word: ClassVar = "test read"
    outputs: ClassVar = (
        csv_file("Write a row for each cycle."),
        csv_file("Write a row for each temperature and speed.", "repeats"),
        csv_file("Write depth and force of every retraction as two columns.", "curves"),
        binary_file("xlsx", "Write all tables as a workbook.", ".xlsx"),
        picture(),
    )

    radius: float | None = number(
        'Sphere radius, "5.19 mm"; adds the JKR work of adhesion, 2F/(3 pi R).', "m"
    )

    def check(self) -> None:
        """Refuse a reference temperature without a shift."""
        super().check()
        if self.reference_temperature is not None and not self.named:
            raise InputError(
                "needs a shift: wlf, `glass_transition` or `shift_file`",
                field="reference_temperature",
            )

    def answer(self, caller: Caller) -> Answer:
        """Read the files and evaluate their cycles."""
        from viscotack.lab.tack.repeats import speed_table
        from viscotack.plot.tack import draw_tests

        from .parts.records import (
            curve_rows,
            cycle_row,
            repeat_rows,
            tests_record,
        )
        from .parts.tables import heading, write_workbook

        found = self.survey(caller)
        law = self.referred(caller)
        table = speed_table(found.cycles, law)
        rows = [
            {"file": one.record.source.path, **cycle_row(cycle, self.radius, law)}
            for one in found.evaluations
            for cycle in one.cycles
        ]
        repeats = repeat_rows(table, self.radius)
        refused = [{"file": path, "reason": why} for path, why in found.reasons]
        tables = {"cycles": rows, "repeats": repeats, "refused": refused}
        sheets = {
            title: {heading(name): [row[name] for row in of] for name in of[0]}
            for title, of in tables.items()
            if of
        }
        record = tests_record(found, table, self.radius, law)
        return Answer(
            found,
            data=record,
            words=_shown(record),
            files={
                "csv": rows,
                "repeats": repeats,
                "curves": lambda target: write_file(curve_rows(found.cycles), target),
                "xlsx": lambda target: write_workbook(sheets, target),
            },
            pictures={"plot": lambda: draw_tests(found.cycles, shift=law)},
            drawn=lambda: {
                "curves": [_retraction(cycle) for cycle in found.cycles],
                "refused": refused,
            },
            notes=(*refusals(found), *_named_temperatures(found)),
        )


def _retraction(cycle: Any) -> dict[str, Any]:
    """Return the numbers of a cycle, and its retraction as it is drawn."""
    from .parts.records import cycle_row

    back = cycle.retraction
    every = max((back.stop - back.start) // _MOST, 1)
    return {
        **cycle_row(cycle),
        "file": Path(cycle.source.path).name,
        "depth": drawn(cycle.depth[back][::every]),
        "force": drawn(cycle.force[back][::every]),
    }


# Of a cycle in the text; all numbers are in the tables.
_CYCLE = ("cycle", "temperature_K", "speed_m_s", "pull_off_force_N", "work_of_separation_J")
_CYCLE += tuple(f"{name}_uncertainty" for name in _CYCLE[2:])
_CYCLE += ("preload_N", "dwell_time_s", "notes", "cautions")


def _named_temperatures(found: Any) -> tuple[str, ...]:
    """Return a note if temperatures in file names were not read and differ."""
    from viscotack.lab.formats.tables import kelvins_in_name

    files = {one.source.path for one in found.cycles if one.temperature is None}
    named = {kelvin for file in files for kelvin in kelvins_in_name(file)}
    if len(named) < 2:
        return ()
    return (
        f"the names of files contain temperatures from {min(named) - 273.15:.4g} to "
        f"{max(named) - 273.15:.4g} C, and tests are not separated by them; add "
        "`temperature_in_name`",
    )


def _shown(record: dict[str, Any]) -> dict[str, Any]:
    """Return what the text says of a record."""
    cycles = [
        {"file": test["file"]} | {name: cycle[name] for name in _CYCLE}
        for test in record["tests"]
        for cycle in test["cycles"]
    ]
    several = len(record["exponents"]) > 1
    hidden = ("tests", "unread", *(() if several else ("exponents",)))
    bad = len(record["unread"]) + sum(len(test["refused"]) for test in record["tests"])
    works = [row.get("jkr_work_of_adhesion_J_m2", 0.0) for row in record["repeats"]]
    beyond = "the JKR work is beyond surface energies: losses of the solid, fibrils or cavities"
    return {
        "words": [f"{len(cycles)} {'cycle' if len(cycles) == 1 else 'cycles'}, {bad} refused"],
        "cycles": cycles,
        **{n: x for n, x in record.items() if n not in hidden},
        "cautions": [beyond] if max(works) > _LARGEST_WORK else [],
    }
