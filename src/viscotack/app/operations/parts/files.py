"""Options for measured files: of a DMA or another test of a material, and of a rig."""

from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from viscotack.errors import InputError
from viscotack.units import parse

from ..options import file_name, input_file, number, option, quoted, switch, text, two_of
from ..request import Caller, Request

if TYPE_CHECKING:
    from viscotack.lab.tack import Survey


class OfFiles(Request):
    """Options that describe files of any instrument."""

    section: ClassVar = "What the files do not say"

    format: str | None = option("Format of the files, if it is not detected.")
    time_unit: str | None = option("Unit such as s, if not in the file.", example="s")
    decimal: str | None = option("Decimal mark, if 1,234 is ambiguous.", metavar=",|.")
    where: str | None = option(
        "Rows to read, by content of a column.", metavar="COLUMN=VALUE", example="Sample=A"
    )
    temperature_in_name: bool = switch(
        "Read the temperature from the name of each file, as in foam_-25C.csv."
    )


class Dma(OfFiles):
    """Options that describe the files of a DMA or another test of a material."""

    test: Literal["dma", "relaxation", "creep"] | None = option(
        "Kind of test; default: by the columns."
    )
    kind: str | None = option(
        "Tensile or shear modulus, if not in the file.", metavar="E|G", example="E"
    )
    temperature: float | None = number(
        "Temperature of the test, if not in the file.", "K", example="20 degC"
    )
    frequency_unit: str | None = option("Hz or rad/s, if not in the file.", example="Hz")
    modulus_unit: str | None = option("Unit such as MPa, if not in the file.", example="MPa")
    temperature_unit: str | None = option("degC, K or degF, if not in the file.", example="degC")
    step_start: float = number(
        "Time of the step, in the time of the whole test.", "s", example="300 s", default=0.0
    )
    columns: str | None = option(
        "Columns by heading or number, with units that the file does not state.",
        metavar="NAMES",
        example="frequency=1 [Hz]; storage=G' sample 2 [Pa]; loss=3 [Pa]",
    )
    table: str | None = option("Number or sheet of one of several tables.", example="2")

    def measured(self, files: tuple[Path, ...]) -> Any:
        """Read the files: sweeps of one material, or tests over time."""
        from viscotack.lab import read

        return read(files, **self.values(*Dma.model_fields))


_MOVES = ("none", "auto", "free")


def _moving(value: Any) -> str | float:
    """Return a word of the vertical shift, or a coefficient of volume expansion [1/K]."""
    if value in _MOVES:
        return value
    try:
        return parse(value, "1/K")
    except InputError:
        raise InputError(
            f"must be {', '.join(_MOVES)} or the coefficient of volume expansion, "
            f'"6e-4 1/K", got {value!r:.60}'
        ) from None


def _constants(value: Any) -> tuple[float, float]:
    """Return the constants of WLF."""
    c1, c2 = two_of(value)
    return parse(c1, "1"), parse(c2, "K")


class ShiftLaw(Request):
    """Options for a known shift of tests at several temperatures; temperatures in K."""

    section: ClassVar = "Shift with temperature"

    reference_temperature: float | None = number(
        'Temperature of the master curve, "20 degC"; needed for any shift.', "K"
    )
    glass_transition: float | None = number(
        'Shift by WLF with c1 = 17.44 and c2 = 51.6 K at this temperature, "-115 degC".', "K"
    )
    wlf: tuple[float, float] | None = text(
        'Shift by WLF with these constants, "8.86,101.6 K", at the reference temperature.',
        metavar="C1,C2",
        to=_constants,
    )
    shift_file: Path | None = file_name("Shift by this table of log_aT.")

    def check(self) -> None:
        """Check that at most one shift is given, with its reference temperature."""
        named = self.named
        if len(named) > 1:
            raise InputError(f"give one shift, got {quoted(named)}")
        if named and self.reference_temperature is None:
            raise InputError(f"`{named[0]}` needs `reference_temperature`")

    @property
    def named(self) -> list[str]:
        """Names of the given shifts."""
        laws = ("glass_transition", "wlf", "shift_file")
        return [name for name in laws if getattr(self, name) is not None]

    def law(self, caller: Caller) -> Any:
        """Return the given shift law or table; None without one."""
        from viscotack.model.materials.shift import WLF

        if self.glass_transition is not None:
            return WLF.from_glass_transition(self.glass_transition)
        if self.wlf is not None:
            assert self.reference_temperature is not None, "checked above"
            c1, c2 = self.wlf
            return WLF(reference_temperature=self.reference_temperature, c1=c1, c2=c2)
        if self.shift_file is not None:
            from viscotack.lab import read_shifts

            return read_shifts(caller.file(self.shift_file))
        return None

    def referred(self, caller: Caller) -> Any:
        """Return the given shift law with the reference temperature; None without one."""
        law = self.law(caller)
        return None if law is None else law.at_reference(self.reference_temperature)


class Shifting(ShiftLaw):
    """Options for the shift of a DMA, relaxation or creep tests; temperatures in K."""

    shift_by: Literal["both", "storage", "loss", "tan"] | None = option(
        "Quantity that must superpose where shifts are fitted to the overlap. Default without "
        "--vertical: both, or storage if it is clearly more causal."
    )
    vertical: str | float | None = text(
        "Vertical shift: none (the default), auto (as far as the data determine it), free, or by "
        'density and temperature with a volume expansion of "6e-4 1/K".',
        metavar="WORD|EXPANSION",
        to=_moving,
    )
    leave_out: tuple[float, ...] = number(
        'Exclude the sweep at this temperature, "-30 degC". Can be repeated.', "K", default=()
    )

    def check(self) -> None:
        """Check that one shift is given with its parameters."""
        super().check()
        if self.named and (self.shift_by is not None or self.vertical is not None):
            raise InputError(
                f"`shift_by` and vertical are for shifts found from overlap; with "
                f"{self.named[0]} leave them out"
            )

    def at_one_temperature(self, measured: Any, caller: Caller) -> Any:
        """Return what was measured at one temperature, the shift of times, and doubts about it."""
        from viscotack.lab import MasterCurve, at_one_temperature

        curve, shift, doubts = at_one_temperature(
            measured,
            shift=self.law(caller),
            by=self.shift_by,
            **self.values("reference_temperature", "vertical", "leave_out"),
        )
        glass = self.glass_transition
        known = curve.temperature if isinstance(curve, MasterCurve) else None
        if glass is not None and known is not None and (known < glass).any():
            doubts += (
                f"{np.sum(known < glass)} points lie below the glass transition, down to "
                f"{np.nanmin(known) - 273.15:.4g} C, where a glass need not follow WLF: the "
                "highest frequencies and the glassy modulus rest on them",
            )
        return curve, shift, doubts


_SIGNS = {"+": 1, "-": -1, "1": 1, "-1": -1}


def _sign(words: str) -> Any:
    """Declare a sign, + or -."""

    def number_of(value: Any) -> int:
        if isinstance(value, bool) or str(value) not in _SIGNS:
            raise InputError(f"must be + or -, got {value!r:.60}")
        return _SIGNS[str(value)]

    return text(words, metavar="+|-", to=number_of, default=0)


class Rig(OfFiles):
    """A request with files of a rig, and what describes them and the rig itself."""

    files: tuple[Path, ...] = input_file(
        "Files of the rig: text with units, a testXpert workbook, .nid, .jpk-force or .ibw; a "
        "folder means all files in it. ..._Interval_7.csv are intervals of one test.",
        "FILE...",
    )
    force_unit: str | None = option("Unit such as mN, if not in the file.")
    length_unit: str | None = option("Unit such as um, if not in the file.")
    force_column: str | None = option("Heading or number of the force column, if not detected.")
    position_column: str | None = option(
        "Heading or number of the gap, depth or travel column, if there are several."
    )
    time_column: str | None = option("Heading or number of the time column, if not detected.")
    nominal_speed: float | None = number(
        'Nominal speed, "10 um/s", if a file has no time; it is not checked.', "m/s"
    )
    spring_constant: float | None = number("Of a cantilever, if its file lacks it.", "N/m")
    sensitivity: float | None = number(
        'Deflection by signal of a cantilever, "50 nm/nA", if its file lacks it.', "m/A"
    )
    compliance: float | None = number(
        'Compliance of the rig, "2 um/N", measured on a stiff sample; corrects the depth. '
        "Automatic for a cantilever with a stiffness in its file.",
        "m/N",
    )
    compliance_uncertainty: float = number(
        "Its standard uncertainty; `identify rates` takes 10 % by default.", "m/N", default=0.0
    )
    into: int = _sign("Whether larger positions are deeper, if the file does not show it.")
    compression: int = _sign("Sign of compression; rejected if the signal contradicts it.")
    retraction_only: bool = switch(
        "Accept curves without approach; the force zero is then taken after pull-off."
    )

    def survey(self, caller: Caller) -> "Survey":
        """Read and evaluate the files; InputError if no cycle can be evaluated."""
        from viscotack.lab import TackOptions
        from viscotack.lab.tack import survey

        files = tuple(caller.file(each) for each in self.files)
        of_file = {each.name for each in fields(TackOptions)}
        reading = {name: value for name, value in self if name in of_file}
        TackOptions(**reading)  # refuses a wrong one by its name, not as the fault of each file
        names = ("compliance", "compliance_uncertainty", "into", "compression", "retraction_only")
        found = survey(files, reading=reading, evaluation=self.values(*names))
        if not found.cycles:
            reasons = "\n  ".join(f"{path}: {why}" for path, why in found.reasons)
            raise InputError(f"no cycle of a tack test could be read:\n  {reasons}")
        return found


def refusals(found: "Survey") -> tuple[str, ...]:
    """Return a line for each file and cycle that was refused, and for each caution."""
    refused = (f"refused: {path}: {why}" for path, why in found.reasons)
    return (*refused, *(f"caution: {path}: {said}" for path, said in found.cautions))
