"""Options for the files of a tack tester or microscope."""

from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from viscotack.errors import InputError

from ..options import input_file, number, option, switch, text
from ..request import Caller
from .dma import OfFiles

if TYPE_CHECKING:
    from viscotack.lab.tack import Survey

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
