"""The operation ``test read``: evaluate the files of a tack tester or microscope."""

from dataclasses import dataclass, field
from typing import Any, ClassVar

from viscotack.units import readable

from .declare.answer import Answer, Caller, csv_file, picture
from .declare.options import Operation
from .parts.rig import Files, Rig, refusals


@dataclass(frozen=True, kw_only=True)
class ReadTests(Operation):
    """Read tack tests or force curves: pull-off, work, depth and true speed of every cycle.

    Approach, dwell and retraction are detected in the signal. Zero, tilt and drift of the force are
    corrected, and each number has a standard uncertainty. An unreliable curve is rejected with the
    reason; the others are evaluated. Exit status 2 if no cycle can be evaluated.

    Example: viscotack test read probe_Interval_*.csv --compliance "2 um/N" --plot tests.png
    """

    word: ClassVar = "test read"
    outputs: ClassVar = (csv_file("Write a row for each cycle; - is standard output."), picture())

    files: Files
    rig: Rig = field(default_factory=Rig)

    def answer(self, caller: Caller) -> Answer:
        """Read the files and evaluate their cycles."""
        from viscotack.pictures.tack import draw_tests

        from .parts.drawn import retraction
        from .parts.records import cycle_row, tests_record
        from .parts.tables import rows_as_csv

        found = self.rig.survey(self.files)
        rows = [
            {"file": one.record.source.path, **cycle_row(cycle)}
            for one in found.evaluations
            for cycle in one.cycles
        ]
        return Answer(
            found,
            record=lambda: tests_record(found),
            words=lambda: _words(found),
            files={"csv": rows_as_csv(rows)},
            pictures={"plot": lambda: draw_tests(found.cycles)},
            drawn=lambda: {
                "curves": [retraction(cycle) for cycle in found.cycles],
                "refused": [{"file": path, "reason": why} for path, why in found.reasons],
            },
            notes=refusals(found),
        )


def _words(found: Any) -> str:
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
    count = len(found.cycles)
    lines.append(f"{count} {'cycle' if count == 1 else 'cycles'}, {len(found.reasons)} refused")
    return "\n".join(lines)


def _pair(one: Any, unit: str) -> str:
    return readable(one.value, unit, uncertainty=one.uncertainty)
