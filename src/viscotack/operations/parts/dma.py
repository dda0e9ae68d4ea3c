"""Options for the files of a DMA, relaxation or creep test."""

from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from ..declare.cards import Choice, Number, Switch, Text
from ..declare.options import Part

if TYPE_CHECKING:
    from viscotack.lab import CreepTest, FrequencySweeps, RelaxationTest

    Measured = (
        FrequencySweeps
        | RelaxationTest
        | CreepTest
        | tuple[RelaxationTest, ...]
        | tuple[CreepTest, ...]
    )

Where = Annotated[
    str | None,
    Text(
        "Rows to read, by heading and content of a column.",
        metavar="COLUMN=VALUE",
        example="Sample=A",
    ),
]


@dataclass(frozen=True, kw_only=True)
class Dma(Part):
    """Options that describe the files of a DMA or another test of a material."""

    table: ClassVar = "read"

    test: Annotated[
        str | None,
        Choice("Kind of test; default: by the columns.", choices=("dma", "relaxation", "creep")),
    ] = None
    format: Annotated[
        str | None, Text("Format of the file, if it is not detected.", metavar="NAME")
    ] = None
    kind: Annotated[
        str | None,
        Text(
            "Tensile or shear modulus, if the file does not state it.", metavar="E|G", example="E"
        ),
    ] = None
    temperature: Annotated[
        float | None,
        Number(
            "Temperature of the test, if the file does not state it.",
            unit="K",
            metavar="T",
            example="20 degC",
        ),
    ] = None
    frequency_unit: Annotated[
        str | None, Text("Hz or rad/s, if the file does not state it.", example="Hz")
    ] = None
    modulus_unit: Annotated[
        str | None, Text("Unit such as MPa, if the file does not state it.", example="MPa")
    ] = None
    time_unit: Annotated[
        str | None, Text("Unit such as s, if the file does not state it.", example="s")
    ] = None
    temperature_unit: Annotated[
        str | None,
        Text(
            "degC, K or degF, if columns or header lines do not state it.",
            example="degC",
        ),
    ] = None
    temperature_in_name: Annotated[
        bool, Switch("Read the temperature from the name of each file, as in foam_-25C.csv.")
    ] = False
    decimal: Annotated[str | None, Text("Decimal mark, if 1,234 is ambiguous.", metavar=",|.")] = (
        None
    )
    step_start: Annotated[
        float,
        Number(
            "Time of the step, if the file counts time from the start of the whole test.",
            unit="s",
            metavar="TIME",
            example="300 s",
        ),
    ] = 0.0
    columns: Annotated[
        str | None,
        Text(
            "Columns by heading or number, with units that the file does not state.",
            metavar="NAMES",
            example="frequency=1 [Hz]; storage=G' sample 2 [Pa]; loss=3 [Pa]",
        ),
    ] = None
    where: Where = None
    table: Annotated[
        str | None,
        Text("Number or sheet of one of several tables in a file.", metavar="TABLE", example="2"),
    ] = None

    def measured(self, files: tuple[Path, ...]) -> "Measured":
        """Read the files: sweeps of one material, or tests over time."""
        from viscotack.lab import read, read_creeps, read_dma, read_relaxations

        said: dict[str, Any] = {f.name: getattr(self, f.name) for f in fields(self)}
        test = said.pop("test")
        readers = {"dma": read_dma, "relaxation": read_relaxations, "creep": read_creeps}
        return readers.get(test, read)(files, **said)
