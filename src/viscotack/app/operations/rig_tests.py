"""The operation ``test read``: evaluate the files of a tack tester or microscope."""

from typing import Annotated, Any, ClassVar

from viscotack.errors import InputError
from viscotack.units import readable

from .parts.rig import Rig, refusals
from .parts.shifting import ShiftLaw
from .request import Answer, Caller, Number, Output, csv_file, picture

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
        csv_file("Write a row for each cycle; - is standard output."),
        csv_file("Write a row for each temperature and speed; - is standard output.", "repeats"),
        csv_file(
            "Write depth and force of every retraction as two columns, coldest and slowest first; "
            "- is standard output.",
            "curves",
        ),
        Output(
            "xlsx",
            "Write a workbook FILE.xlsx of cycles, repeats by speed and rejected files, with units "
            "in the headings.",
            "binary",
            endings=(".xlsx",),
        ),
        picture(),
    )

    radius: Annotated[
        float | None,
        Number(
            'Sphere radius, "5.19 mm"; adds the work of adhesion of an elastic JKR sphere, '
            "2F/(3 pi R).",
            unit="m",
            metavar="LENGTH",
        ),
    ] = None

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
        from viscotack.lab.tack.speed_table import speed_table
        from viscotack.plot.tack import draw_tests

        from .parts.drawn import retraction
        from .parts.records import (
            curve_rows,
            cycle_row,
            repeat_rows,
            series_rows,
            tests_record,
        )
        from .parts.tables import rows_as_csv
        from .parts.workbook import as_workbook

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
        series = [{"quantity": name, "value": value} for name, value in series_rows(table)]
        sheets = {"cycles": rows, "repeats": repeats, "series": series, "refused": refused}
        return Answer(
            found,
            record=lambda: tests_record(found, table, self.radius, law),
            words=lambda: _words(found, table, self.radius, law),
            files={
                "csv": rows_as_csv(rows),
                "repeats": rows_as_csv(repeats),
                "curves": lambda target: rows_as_csv(curve_rows(found.cycles))(target),
                "xlsx": as_workbook(sheets),
            },
            pictures={"plot": lambda: draw_tests(found.cycles, shift=law)},
            drawn=lambda: {
                "curves": [retraction(cycle) for cycle in found.cycles],
                "refused": refused,
            },
            notes=(*refusals(found), *_unread_names(found)),
        )


def _unread_names(found: Any) -> tuple[str, ...]:
    """Return a note if temperatures in file names were not read and differ."""
    from viscotack.lab.joining import kelvins_in_name

    files = {one.source.path for one in found.cycles if one.temperature is None}
    named = {kelvin for file in files for kelvin in kelvins_in_name(file)}
    if len(named) < 2:
        return ()
    return (
        f"the names of files contain temperatures from {min(named) - 273.15:.4g} to "
        f"{max(named) - 273.15:.4g} C, and tests are not separated by them; add "
        "--temperature-in-name",
    )


def _words(found: Any, table: Any, radius: float | None, law: Any) -> str:
    lines = []
    for one in found.evaluations:
        if not one.cycles:
            continue
        lines.append(f"{one.record.source.path} ({one.record.source.format})")
        for cycle in one.cycles:
            force, speed, work = cycle.pull_off_force, cycle.speed, cycle.work_of_separation
            lines.append(
                f"  {cycle.number}: pull-off {_pair(force, 'N')}, work of separation "
                f"{_pair(work, 'J')}, at {_at(cycle)}{_pair(speed, 'm/s')}, preload "
                f"{readable(cycle.preload.value, 'N', digits=3)}, dwell "
                f"{readable(cycle.dwell_time, 's', digits=3)}"
            )
        lines.append(f"     {'; '.join(one.cycles[0].source.notes)}")
    lines += _words_by_speed(table, radius, law)
    count = len(found.cycles)
    lines.append(f"{count} {'cycle' if count == 1 else 'cycles'}, {len(found.reasons)} refused")
    return "\n".join(lines)


def _words_by_speed(table: Any, radius: float | None, law: Any) -> list[str]:
    """Describe the repeated tests, the comparison with JKR and the exponents of force by speed."""
    from viscotack.lab.tack.speed_table import jkr_work

    from .parts.records import conditions

    several = len(table.series) > 1
    lines = [f"Pull-off force by {'temperature and ' * several}speed"]
    for one in table.speeds:
        at = conditions(one.temperature if several else None, one.speed)
        if one.shifted_speed is not None:
            at += f", a_T v {readable(one.shifted_speed, 'm/s', digits=3)}"
        line = f"  {at}: {readable(one.force, 'N', digits=3)}"
        if one.force_deviation is not None:
            line += ", standard deviation "
            line += readable(one.force_deviation, "N", digits=2, like=one.force)
            line += f" of {len(one.cycles)} tests"
        if radius is not None:
            work = jkr_work(one.force, radius)
            line += f", JKR work of adhesion {readable(work, 'J/m2', digits=3)}"
            if work > _LARGEST_WORK:
                line += " (beyond surface energies: losses of the solid, fibrils or cavities)"
        lines.append(line)
        lines += [f"    far from the others: {x.source.path} cycle {x.number}" for x in one.far]
    if table.scatter is not None:
        lines.append(f"  scatter of single tests {100 * table.scatter:.2g} %, pooled over speeds")
    for one in table.exponents:
        at = one.temperature if several else None
        where = "" if at is None else f" at {at - 273.15:.3g} C"
        lines.append(f"  exponent of force by speed{where} {_exponent(one.exponent)}")
    if table.master is not None:
        where = f"{law.reference_temperature - 273.15:.4g} C"
        lines.append(f"  exponent of force by a_T v at {where} {_exponent(table.master)}")
    return lines


def _exponent(one: Any) -> str:
    return f"{one.value:.3g}, standard error {one.uncertainty:.1g}"


def _at(cycle: Any) -> str:
    return "" if cycle.temperature is None else f"{cycle.temperature - 273.15:.3g} C and "


def _pair(one: Any, unit: str) -> str:
    return readable(one.value, unit, uncertainty=one.uncertainty)
