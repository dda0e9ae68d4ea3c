"""Flags of the commands that read the files of a rig: stated once, for all of them."""

from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import typer
from typer import Argument, Option
from typer.core import TyperCommand

from viscotack.errors import InputError
from viscotack.units import parse

_RIG = "viscotack.rig"
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


class Rig(NamedTuple):
    """What flags say of files and of the rig that wrote them.

    Attributes
    ----------
    reading, evaluation : dict
        Keywords of :func:`viscotack.lab.tack.read` and :func:`viscotack.lab.tack.evaluate`.
    """

    reading: dict[str, Any]
    evaluation: dict[str, Any]


class ReadingRigs(TyperCommand):
    """A command that has the flags of a rig beside its own; :func:`rig_of` has what was given."""

    def __init__(self, *args: Any, params: Any = None, **kwargs: Any) -> None:
        super().__init__(*args, params=[*(params or []), *_options()], **kwargs)


def rig_of(context: typer.Context) -> Rig:
    """Return what the flags of a command say of files and rig."""
    given = context.meta[_RIG]
    lengths = {
        name: None if given[name] is None else parse(given[name], unit)
        for name, unit in (
            ("nominal_speed", "m/s"),
            ("compliance", "m/N"),
            ("compliance_uncertainty", "m/N"),
        )
    }
    as_they_are = (
        *("format", "force_unit", "length_unit", "time_unit"),
        *("force_column", "position_column", "decimal"),
    )
    reading = {name: given[name] for name in as_they_are}
    evaluation = {
        "compliance": lengths["compliance"],
        "compliance_uncertainty": lengths["compliance_uncertainty"] or 0.0,
        "into": _sign("--into", given["into"]),
        "compression": _sign("--compression", given["compression"]),
        "retraction_only": given["retraction_only"],
    }
    return Rig(reading | {"nominal_speed": lengths["nominal_speed"]}, evaluation)


def _sign(flag: str, word: str | None) -> int:
    if word not in _SIGNS:
        raise InputError(f"{flag} must be + or -, got {word!r}")
    return _SIGNS[word]


def _asked(
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
) -> None:
    """Do nothing: only the options of this command are used."""


@lru_cache(maxsize=1)
def _options() -> tuple[Any, ...]:
    """Return the options, made by the library of the command line; the context keeps them."""
    only = typer.Typer(add_completion=False)
    only.command()(_asked)
    made = tuple(one for one in typer.main.get_command(only).params if one.name != "help")
    for option in made:
        option.expose_value, option.callback = False, _kept
    return made


def _kept(context: Any, option: Any, value: Any) -> Any:
    context.meta.setdefault(_RIG, {})[option.name] = value
    return value
