"""The commands ``viscotack test ...``: from the files of a rig to what they say."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer
from typer import Argument, Option

from viscotack.app.records import cycle_row, tests_record
from viscotack.errors import InputError
from viscotack.files.whole import write_whole
from viscotack.units import parse

from .commands import AsJson, PlotFile, application, wrong_input
from .writing import Writing, check_files, rows_as_csv

tests = typer.Typer(
    help="From the files of a tack tester or a microscope to pull-off forces and speeds.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
application.add_typer(tests, name="test")

_SIGNS = {"+": 1, "-": -1, None: 0}

TestFiles = Annotated[
    list[Path],
    Argument(
        metavar="FILE...",
        help="What the rig wrote: CSV or other text with units, a testXpert workbook, a Nanosurf "
        ".nid, a JPK .jpk-force or an Asylum .ibw. Files named ..._Interval_7.csv are intervals "
        "of one test.",
        show_default=False,
    ),
]
Format = Annotated[
    str | None,
    Option("--format", metavar="NAME", help="Of the files, where it is not found out."),
]
ForceUnit = Annotated[
    str | None,
    Option("--force-unit", help="Such as mN or g, where a file does not say."),
]
LengthUnit = Annotated[
    str | None, Option("--length-unit", help="Such as um, where a file does not say.")
]
TimeUnit = Annotated[
    str | None, Option("--time-unit", help="Such as s, where a file does not say.")
]
ForceColumn = Annotated[
    str | None,
    Option("--force-column", metavar="NAME", help="Heading of the force, where it is not found."),
]
PositionColumn = Annotated[
    str | None,
    Option(
        "--position-column",
        metavar="NAME",
        help="Heading of the gap, depth or travel, where there are several.",
    ),
]
Decimal = Annotated[
    str | None,
    Option("--decimal", metavar=",|.", help="Decimal mark, where 1,234 leaves it open."),
]
NominalSpeed = Annotated[
    str | None,
    Option(
        "--nominal-speed",
        metavar="SPEED",
        help='The speed that was set, "10 um/s", where a file has no time; it is not checked.',
    ),
]
Compliance = Annotated[
    str | None,
    Option(
        "--compliance",
        metavar="LENGTH/FORCE",
        help='How far the rig itself yields, "2 um/N": measured on a stiff sample. Taken off the '
        "depth. A cantilever named by its file does so without being asked.",
    ),
]
ComplianceUncertainty = Annotated[
    str | None,
    Option(
        "--compliance-uncertainty",
        metavar="LENGTH/FORCE",
        help="Standard uncertainty of it; it goes into depths and works.",
    ),
]
Into = Annotated[
    str | None,
    Option(
        "--into",
        metavar="+|-",
        help="Whether larger positions are deeper, where neither heading nor signal says.",
    ),
]
Compression = Annotated[
    str | None,
    Option(
        "--compression",
        metavar="+|-",
        help="Sign of a compression in the files; refused where the signal says otherwise.",
    ),
]
RetractionOnly = Annotated[
    bool,
    Option(
        "--retraction-only",
        help="Take curves without an approach from outside: zero of force from after the pull-off.",
    ),
]


@tests.command("read")
def read_command(
    files: TestFiles,
    table: Annotated[
        Path | None,
        Option("--csv", metavar="FILE", help="Write a row for each cycle; - is standard output."),
    ] = None,
    plot_file: PlotFile = None,
    format: Format = None,
    force_unit: ForceUnit = None,
    length_unit: LengthUnit = None,
    time_unit: TimeUnit = None,
    force_column: ForceColumn = None,
    position_column: PositionColumn = None,
    decimal: Decimal = None,
    nominal_speed: NominalSpeed = None,
    compliance: Compliance = None,
    compliance_uncertainty: ComplianceUncertainty = None,
    into: Into = None,
    compression: Compression = None,
    retraction_only: RetractionOnly = False,
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
        reading = reading_of(
            format,
            (force_unit, length_unit, time_unit),
            (force_column, position_column),
            decimal,
            nominal_speed,
        )
        evaluation = evaluation_of(
            (compliance, compliance_uncertainty), (into, compression), retraction_only
        )
        from viscotack.lab.tack import survey
        from viscotack.pictures.tack import draw_tests

        found = survey(files, reading=reading, evaluation=evaluation)
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


def reading_of(
    format: str | None,
    units: tuple[str | None, str | None, str | None],
    columns: tuple[str | None, str | None],
    decimal: str | None,
    nominal_speed: str | None,
) -> dict[str, Any]:
    """Return what flags say about the files, as keywords of the reader."""
    return {
        "format": format,
        "force_unit": units[0],
        "length_unit": units[1],
        "time_unit": units[2],
        "force_column": columns[0],
        "position_column": columns[1],
        "decimal": decimal,
        "nominal_speed": None if nominal_speed is None else parse(nominal_speed, "m/s"),
    }


def evaluation_of(
    compliance: tuple[str | None, str | None],
    signs: tuple[str | None, str | None],
    retraction_only: bool,
) -> dict[str, Any]:
    """Return what flags say about the rig, as keywords of the evaluation."""
    value, uncertainty = (None if x is None else parse(x, "m/N") for x in compliance)
    return {
        "compliance": value,
        "compliance_uncertainty": uncertainty or 0.0,
        "into": _sign("--into", signs[0]),
        "compression": _sign("--compression", signs[1]),
        "retraction_only": retraction_only,
    }


def _sign(flag: str, word: str | None) -> int:
    if word not in _SIGNS:
        raise InputError(f"{flag} must be + or -, got {word!r}")
    return _SIGNS[word]


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
