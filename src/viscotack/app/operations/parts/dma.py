"""Options for the files of a DMA, relaxation or creep test."""

from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ..options import number, option, switch
from ..request import Request

if TYPE_CHECKING:
    from viscotack.lab import CreepTest, FrequencySweeps, RelaxationTest

    Measured = (
        FrequencySweeps
        | RelaxationTest
        | CreepTest
        | tuple[RelaxationTest, ...]
        | tuple[CreepTest, ...]
    )


class OfFiles(Request):
    """Options that describe files of any instrument."""

    format: str | None = option("Format of the files, if it is not detected.")
    time_unit: str | None = option("Unit such as s, if not in the file.", example="s")
    decimal: str | None = option("Decimal mark, if 1,234 is ambiguous.", metavar=",|.")
    where: str | None = option(
        "Rows to read, by heading and content of a column.",
        metavar="COLUMN=VALUE",
        example="Sample=A",
    )
    temperature_in_name: bool = switch(
        "Read the temperature from the name of each file, as in foam_-25C.csv; default: from a "
        "column or a line above the columns with a unit."
    )


class Dma(OfFiles):
    """Options that describe the files of a DMA or another test of a material."""

    test: Literal["dma", "relaxation", "creep"] | None = option(
        "Kind of test; default: by the columns."
    )
    kind: str | None = option(
        "Tensile or shear modulus, if the file does not state it.", metavar="E|G", example="E"
    )
    temperature: float | None = number(
        "Temperature of the test, if the file does not state it.", "K", example="20 degC"
    )
    frequency_unit: str | None = option("Hz or rad/s, if the file does not state it.", example="Hz")
    modulus_unit: str | None = option(
        "Unit such as MPa, if the file does not state it.", example="MPa"
    )
    temperature_unit: str | None = option(
        "degC, K or degF, if columns or header lines do not state it.", example="degC"
    )
    step_start: float = number(
        "Time of the step, if the file counts time from the start of the whole test.",
        "s",
        example="300 s",
        default=0.0,
    )
    columns: str | None = option(
        "Columns by heading or number, with units that the file does not state.",
        metavar="NAMES",
        example="frequency=1 [Hz]; storage=G' sample 2 [Pa]; loss=3 [Pa]",
    )
    table: str | None = option(
        "Number or sheet of one of several tables in a file.", metavar="TABLE", example="2"
    )

    def measured(self, files: tuple[Path, ...]) -> "Measured":
        """Read the files: sweeps of one material, or tests over time."""
        from viscotack.lab import read

        return read(files, **self.values(*Dma.model_fields))
