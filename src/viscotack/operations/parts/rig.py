"""The files of a rig, and what they may not say themselves."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from viscotack.errors import InputError

from ..declare.cards import Choice, File, Number, Place, Switch, Text
from ..declare.options import Part

if TYPE_CHECKING:
    from viscotack.lab.tack import Survey

Files = Annotated[
    tuple[Path, ...],
    File(
        "What the rig wrote: CSV or other text with units, a testXpert workbook, a Nanosurf .nid, "
        "a JPK .jpk-force or an Asylum .ibw. Files named ..._Interval_7.csv are intervals of one "
        "test.",
        metavar="FILE...",
        argument=True,
    ),
]
_SIGNS = {"+": 1, "-": -1, "1": 1, "-1": -1}


@dataclass(frozen=True)
class Sign(Choice):
    """Plus or minus; the value is 1 or -1."""

    choices: tuple[str, ...] = ("+", "-")

    def read(self, value: Any, place: Place) -> int:
        """Return the sign as a number."""
        sign = None if isinstance(value, bool) else _SIGNS.get(str(value))
        if sign is None:
            raise InputError(f"must be + or -, got {value!r:.60}")
        return sign

    def written(self, value: Any) -> str:
        """Return the sign."""
        return "+" if value > 0 else "-"


@dataclass(frozen=True, kw_only=True)
class Rig(Part):
    """What may be said of the files of a rig, and of the rig that wrote them."""

    table: ClassVar = "read"

    format: Annotated[str | None, Text("Of the files, where it is not found out.")] = None
    force_unit: Annotated[str | None, Text("Such as mN or g, where a file does not say.")] = None
    length_unit: Annotated[str | None, Text("Such as um, where a file does not say.")] = None
    time_unit: Annotated[str | None, Text("Such as s, where a file does not say.")] = None
    force_column: Annotated[
        str | None, Text("Heading of the force, where it is not found.", metavar="NAME")
    ] = None
    position_column: Annotated[
        str | None,
        Text("Heading of the gap, depth or travel, where there are several.", metavar="NAME"),
    ] = None
    decimal: Annotated[
        str | None, Text("Decimal mark, where 1,234 leaves it open.", metavar=",|.")
    ] = None
    nominal_speed: Annotated[
        float | None,
        Number(
            'The speed that was set, "10 um/s", where a file has no time; it is not checked.',
            unit="m/s",
            metavar="SPEED",
        ),
    ] = None
    compliance: Annotated[
        float | None,
        Number(
            'How far the rig itself yields, "2 um/N": measured on a stiff sample. Taken off the '
            "depth. A cantilever named by its file does so without being asked.",
            unit="m/N",
            metavar="LENGTH/FORCE",
        ),
    ] = None
    compliance_uncertainty: Annotated[
        float,
        Number(
            "Standard uncertainty of it; it goes into depths and works.",
            unit="m/N",
            metavar="LENGTH/FORCE",
        ),
    ] = 0.0
    into: Annotated[
        int,
        Sign(
            "Whether larger positions are deeper, where neither heading nor signal says.",
            metavar="+|-",
        ),
    ] = 0
    compression: Annotated[
        int,
        Sign(
            "Sign of a compression in the files; refused where the signal says otherwise.",
            metavar="+|-",
        ),
    ] = 0
    retraction_only: Annotated[
        bool,
        Switch(
            "Take curves without an approach from outside: zero of force from after the pull-off."
        ),
    ] = False

    @property
    def reading(self) -> dict[str, Any]:
        """Keywords of :func:`viscotack.lab.tack.read`."""
        units = ("force_unit", "length_unit", "time_unit")
        names = ("format", *units, "force_column", "position_column", "decimal", "nominal_speed")
        return {name: getattr(self, name) for name in names}

    @property
    def evaluation(self) -> dict[str, Any]:
        """Keywords of :func:`viscotack.lab.tack.evaluate`."""
        names = ("compliance", "compliance_uncertainty", "into", "compression", "retraction_only")
        return {name: getattr(self, name) for name in names}

    def survey(self, files: tuple[Path, ...]) -> "Survey":
        """Return what files of tests say; InputError where no cycle says anything."""
        from viscotack.lab.tack import survey

        found = survey(files, reading=self.reading, evaluation=self.evaluation)
        if not found.cycles:
            reasons = "\n  ".join(f"{path}: {why}" for path, why in found.reasons)
            raise InputError(f"no cycle of a tack test could be read:\n  {reasons}")
        return found


def refusals(found: "Survey") -> tuple[str, ...]:
    """Return a line for each file and cycle that was refused."""
    return tuple(f"refused: {path}: {why}" for path, why in found.reasons)
