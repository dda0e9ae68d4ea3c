"""The operation ``test read``: evaluate the files of a tack tester or microscope."""

from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar

from viscotack.units import readable

from .declare.answer import Answer, Caller, Output, csv_file, picture
from .declare.cards import Number
from .declare.options import Operation
from .parts.rig import Files, Rig, refusals


@dataclass(frozen=True, kw_only=True)
class ReadTests(Operation):
    """Read tack tests or force curves: pull-off, work, depth and true speed of every cycle.

    Approach, dwell and retraction are detected in the signal. Zero, tilt and drift of the force are
    corrected, and each number has a standard uncertainty. An unreliable curve is rejected with the
    reason; the others are evaluated. Repeated tests are averaged by speed. Exit status 2 if no
    cycle can be evaluated.

    Example: viscotack test read probe_Interval_*.csv --compliance "2 um/N" --plot tests.png
    --xlsx tests.xlsx
    """

    word: ClassVar = "test read"
    outputs: ClassVar = (
        csv_file("Write a row for each cycle; - is standard output."),
        csv_file("Write a row for each speed; - is standard output.", "repeats"),
        csv_file(
            "Write depth and force of every retraction as two columns, slowest first; - is "
            "standard output.",
            "curves",
        ),
        Output(
            "xlsx",
            "Write a workbook FILE.xlsx of cycles, repeats by speed and rejected files, with units "
            "in the headings.",
            "binary",
            ending=".xlsx",
        ),
        picture(),
    )

    files: Files
    radius: Annotated[
        float | None,
        Number(
            'Sphere radius, "5.19 mm"; adds the work of adhesion of an elastic JKR sphere, '
            "2F/(3 pi R).",
            unit="m",
            metavar="LENGTH",
        ),
    ] = None
    rig: Rig = field(default_factory=Rig)

    def answer(self, caller: Caller) -> Answer:
        """Read the files and evaluate their cycles."""
        from viscotack.identify.speed_table import speed_table
        from viscotack.pictures.tack import draw_tests

        from .parts.drawn import retraction
        from .parts.records import (
            curve_rows,
            cycle_row,
            repeat_rows,
            series_record,
            tests_record,
        )
        from .parts.tables import rows_as_csv
        from .parts.workbook import as_workbook

        found = self.rig.survey(self.files)
        table = speed_table(found.cycles)
        rows = [
            {"file": one.record.source.path, **cycle_row(cycle, self.radius)}
            for one in found.evaluations
            for cycle in one.cycles
        ]
        repeats = repeat_rows(table, self.radius)
        refused = [{"file": path, "reason": why} for path, why in found.reasons]
        series = [
            {"quantity": name.replace("_", " "), "value": value}
            for name, value in series_record(table).items()
        ]
        sheets = {"cycles": rows, "repeats": repeats, "series": series, "refused": refused}
        return Answer(
            found,
            record=lambda: tests_record(found, table, self.radius),
            words=lambda: _words(found, table, self.radius),
            files={
                "csv": rows_as_csv(rows),
                "repeats": rows_as_csv(repeats),
                "curves": lambda target: rows_as_csv(curve_rows(found.cycles))(target),
                "xlsx": as_workbook(sheets),
            },
            pictures={"plot": lambda: draw_tests(found.cycles)},
            drawn=lambda: {
                "curves": [retraction(cycle) for cycle in found.cycles],
                "refused": refused,
            },
            notes=refusals(found),
        )


def _words(found: Any, table: Any, radius: float | None) -> str:
    lines = []
    for one in found.evaluations:
        if not one.cycles:
            continue
        lines.append(f"{one.record.source.path} ({one.record.source.format})")
        for cycle in one.cycles:
            force, speed, work = cycle.pull_off_force, cycle.speed, cycle.work_of_separation
            lines.append(
                f"  {cycle.number}: pull-off {_pair(force, 'N')}, work of separation "
                f"{_pair(work, 'J')}, at {_pair(speed, 'm/s')}, preload "
                f"{readable(cycle.preload.value, 'N', digits=3)}, dwell "
                f"{readable(cycle.dwell_time, 's', digits=3)}"
            )
        lines.append(f"     {'; '.join(one.cycles[0].source.notes)}")
    lines += _words_by_speed(table, radius)
    count = len(found.cycles)
    lines.append(f"{count} {'cycle' if count == 1 else 'cycles'}, {len(found.reasons)} refused")
    return "\n".join(lines)


def _words_by_speed(table: Any, radius: float | None) -> list[str]:
    """Describe the repeated tests, the comparison with JKR and the exponent of force by speed."""
    from viscotack.identify.speed_table import jkr_work

    lines = ["Pull-off force by speed"]
    for one in table.speeds:
        line = f"  {readable(one.speed, 'm/s', digits=3)}: {readable(one.force, 'N', digits=3)}"
        if one.force_deviation is not None:
            line += ", standard deviation "
            line += readable(one.force_deviation, "N", digits=2, like=one.force)
            line += f" of {len(one.cycles)} tests"
        if radius is not None:
            work = jkr_work(one.force, radius)
            line += f", JKR work of adhesion {readable(work, 'J/m2', digits=3)}"
        lines.append(line)
        lines += [f"    far from the others: {x.source.path} cycle {x.number}" for x in one.far]
    if table.scatter is not None:
        lines.append(f"  scatter of single tests {100 * table.scatter:.2g} %, pooled over speeds")
    if table.exponent is not None:
        exponent = table.exponent
        lines.append(
            f"  exponent of force by speed {exponent.value:.3g}, standard error "
            f"{exponent.uncertainty:.1g}"
        )
    return lines


def _pair(one: Any, unit: str) -> str:
    return readable(one.value, unit, uncertainty=one.uncertainty)
