"""The commands ``viscotack test ...``: from the files of a rig to what they say."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer
from typer import Option

from viscotack.app.records import cycle_row, tests_record
from viscotack.errors import InputError
from viscotack.files.whole import write_whole

from .commands import AsJson, PlotFile, application, wrong_input
from .rig import ReadingRigs, TestFiles, rig_of
from .writing import Writing, check_files, rows_as_csv

tests = typer.Typer(
    help="From the files of a tack tester or a microscope to pull-off forces and speeds.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
application.add_typer(tests, name="test")


@tests.command("read", cls=ReadingRigs)
def read_command(
    context: typer.Context,
    files: TestFiles,
    table: Annotated[
        Path | None,
        Option("--csv", metavar="FILE", help="Write a row for each cycle; - is standard output."),
    ] = None,
    plot_file: PlotFile = None,
    as_json: AsJson = False,
) -> None:
    """Read tack tests or force curves: pull-off, work, depth and TRUE speed of every cycle.

    Approach, dwell and retraction are found by the signal; zero, tilt and drift of the force are
    taken off; every number has its standard uncertainty. A curve that cannot be trusted is refused
    with the reason, and the others are read. Exit status 2 if no cycle gives numbers.

    Example: viscotack test read probe_Interval_*.csv --compliance "2 um/N" --plot tests.png
    """
    with wrong_input():
        check_files({"--csv": table, "--plot": plot_file}, as_json=as_json, reads=files)
        rig = rig_of(context)
        from viscotack.lab.tack import survey
        from viscotack.pictures.tack import draw_tests

        found = survey(files, reading=rig.reading, evaluation=rig.evaluation)
        if not found.cycles:
            raise InputError(nothing(found))
    write = Writing()
    rows = [
        {"file": one.record.source.path, **cycle_row(cycle)}
        for one in found.evaluations
        for cycle in one.cycles
    ]
    write("wrote", table, lambda target: write_whole(target, rows_as_csv(rows)))
    write.picture(plot_file, lambda: draw_tests(found.cycles))
    for path, why in found.reasons:
        typer.echo(f"refused: {path}: {why}", err=True)
    write.answer(
        json.dumps(tests_record(found), indent=2, allow_nan=False) if as_json else _words(found)
    )
    write.end()


def nothing(found: Any) -> str:
    """Return why no cycle at all was read."""
    reasons = "\n  ".join(f"{path}: {why}" for path, why in found.reasons)
    return f"no cycle of a tack test could be read:\n  {reasons}"


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
                f"{cycle.preload.value:.3g} N, dwell {cycle.dwell_time:.3g} s"
            )
        lines.append(f"     {'; '.join(one.cycles[0].source.notes)}")
    count = len(found.cycles)
    lines.append(f"{count} {'cycle' if count == 1 else 'cycles'}, {len(found.reasons)} refused")
    return "\n".join(lines)


def _pair(one: Any, unit: str) -> str:
    return f"{one.value:.4g} +- {one.uncertainty:.1g} {unit}"
