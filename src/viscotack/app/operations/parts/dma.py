"""Options for the files of a DMA, relaxation or creep test."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from ..request import Number, Option, Request

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
    Option(
        "Rows to read, by heading and content of a column.",
        metavar="COLUMN=VALUE",
        example="Sample=A",
    ),
]


class Dma(Request):
    """Options that describe the files of a DMA or another test of a material."""

    test: Annotated[
        Literal["dma", "relaxation", "creep"] | None,
        Option("Kind of test; default: by the columns."),
    ] = None
    format: Annotated[str | None, Option("Format of the file, if it is not detected.")] = None
    kind: Annotated[
        str | None,
        Option(
            "Tensile or shear modulus, if the file does not state it.", metavar="E|G", example="E"
        ),
    ] = None
    temperature: Annotated[
        float | None,
        Number(
            "Temperature of the test, if the file does not state it.", unit="K", example="20 degC"
        ),
    ] = None
    frequency_unit: Annotated[
        str | None, Option("Hz or rad/s, if the file does not state it.", example="Hz")
    ] = None
    modulus_unit: Annotated[
        str | None, Option("Unit such as MPa, if the file does not state it.", example="MPa")
    ] = None
    time_unit: Annotated[
        str | None, Option("Unit such as s, if the file does not state it.", example="s")
    ] = None
    temperature_unit: Annotated[
        str | None,
        Option("degC, K or degF, if columns or header lines do not state it.", example="degC"),
    ] = None
    temperature_in_name: Annotated[
        bool, Option("Read the temperature from the name of each file, as in foam_-25C.csv.")
    ] = False
    decimal: Annotated[
        str | None, Option("Decimal mark, if 1,234 is ambiguous.", metavar=",|.")
    ] = None
    step_start: Annotated[
        float,
        Number(
            "Time of the step, if the file counts time from the start of the whole test.",
            unit="s",
            example="300 s",
        ),
    ] = 0.0
    columns: Annotated[
        str | None,
        Option(
            "Columns by heading or number, with units that the file does not state.",
            metavar="NAMES",
            example="frequency=1 [Hz]; storage=G' sample 2 [Pa]; loss=3 [Pa]",
        ),
    ] = None
    where: Where = None
    table: Annotated[
        str | None,
        Option("Number or sheet of one of several tables in a file.", metavar="TABLE", example="2"),
    ] = None

    def measured(self, files: tuple[Path, ...]) -> "Measured":
        """Read the files: sweeps of one material, or tests over time."""
        from viscotack.lab import read

        said: dict[str, Any] = {name: getattr(self, name) for name in Dma.model_fields}
        return read(files, **said)
