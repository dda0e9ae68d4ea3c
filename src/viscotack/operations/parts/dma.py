"""The files of a DMA, relaxation or creep test, and what they may not say themselves."""

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


@dataclass(frozen=True, kw_only=True)
class Dma(Part):
    """What may be said of the files of a DMA, or of another test of a solid."""

    table: ClassVar = "read"

    test: Annotated[
        str | None,
        Choice(
            "What the file holds; else its columns say.", choices=("dma", "relaxation", "creep")
        ),
    ] = None
    format: Annotated[
        str | None, Text("Of the file, where it is not found out.", metavar="NAME")
    ] = None
    kind: Annotated[
        str | None,
        Text("Tensile or shear, where the file does not say.", metavar="E|G", example="E"),
    ] = None
    temperature: Annotated[
        float | None,
        Number(
            "Of the test, where the file does not say.",
            unit="K",
            metavar="T",
            example="20 degC",
        ),
    ] = None
    frequency_unit: Annotated[
        str | None, Text("Hz or rad/s, where the file does not say.", example="Hz")
    ] = None
    modulus_unit: Annotated[
        str | None, Text("Such as MPa, where the file does not say.", example="MPa")
    ] = None
    time_unit: Annotated[
        str | None, Text("Such as s, where the file does not say.", example="s")
    ] = None
    temperature_unit: Annotated[
        str | None,
        Text(
            "degC, K or degF, where a column or the numbers above columns have none.",
            example="degC",
        ),
    ] = None
    temperature_in_name: Annotated[
        bool, Switch("The temperature stands in the name of each file, as in foam_-25C.csv.")
    ] = False
    decimal: Annotated[
        str | None, Text("Decimal mark, where 1,234 leaves it open.", metavar=",|.")
    ] = None

    def measured(self, files: tuple[Path, ...]) -> "Measured":
        """Return what files hold: sweeps of one material, or tests over time."""
        from viscotack.lab import read, read_creeps, read_dma, read_relaxations

        said: dict[str, Any] = {f.name: getattr(self, f.name) for f in fields(self)}
        test = said.pop("test")
        if test is None:
            return read(files, **said)
        if test == "dma":
            return read_dma(files, **said)
        del said["frequency_unit"]
        return (read_relaxations if test == "relaxation" else read_creeps)(files, **said)
