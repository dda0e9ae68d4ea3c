"""The operation ``material fit``: fit a material model to measured data."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from viscotack.errors import InputError

from .options import file_name, main_file, number, option, picture, quoted
from .parts.dma import Dma
from .parts.shifting import Shifting
from .request import Answer, Caller

if TYPE_CHECKING:
    from viscotack.lab import FitReport
    from viscotack.model.materials.passport import Passport

Model = Literal["best", "power-law", "relaxation-power-law", "sls", "fractional-zener", "prony"]


class FitMaterial(Dma, Shifting):
    """Fit a material to a DMA, relaxation or creep test, and issue its passport.

    Sweeps at several temperatures become a master curve first.

    Example: viscotack material fit dma.csv --poisson-ratio 0.5 --reference-temperature "20 degC"
    --glass-transition "-115 degC" -o pdms.toml --plot fit.png
    """

    word: ClassVar = "material fit"
    outputs: ClassVar = (
        main_file("Write the passport to this file; - is standard output.", ".toml"),
        picture(),
    )

    files: tuple[Path, ...] = file_name(
        "Files of the instrument; several files are sweeps of one material.",
        metavar="FILE...",
        argument=True,
        default=...,
    )
    poisson_ratio: float = number(
        "0.5 for rubber, about 0.35 for a glass.", example="0.5", default=...
    )
    model: Model = option(
        "Model; best: fit all and select by an information criterion.", default="best"
    )
    arms: int | None = option("Number of relaxation times of a Prony series; default: by the data.")
    glassy_modulus: float | None = number(
        'Known modulus that is not fitted, "3 GPa"; not for a Prony series.', "Pa"
    )
    rubbery_modulus: float | None = number("Known modulus, as above.", "Pa")
    loss: bool = option("Whether to fit the loss modulus as well.", default=True)
    level: float = number("Confidence level of the intervals.", default=0.9)
    name: str | None = option("Name of the material; default: the file name.")
    source: str = option("Who measured it, for the passport.", default="")

    def answer(self, caller: Caller) -> Answer:
        """Read the files, build the master curve and fit the model."""
        from viscotack.model.materials.passport_file import write_passport
        from viscotack.model.materials.passport_words import shift_lines
        from viscotack.plot.material import draw_fit

        from .parts.records import fit_record

        report, shift = self._fitted(caller)
        passport = self._passport(report, shift)
        words = "\n".join([report.words(), *shift_lines(passport)])
        return Answer(
            (report, passport),
            data=lambda: fit_record(report, passport),
            words=lambda: words,
            files={"output": lambda target: write_passport(passport, target)},
            pictures={"plot": lambda: draw_fit(report, passport)},
            drawn=lambda: _drawn(report, passport),
            notes=tuple(f"  Read: {note}" for note in report.observed.source.notes),
        )

    def _fitted(self, caller: Caller) -> "tuple[FitReport, Any]":
        """Return the fit and the shift law."""
        from viscotack.lab import FrequencySweeps, RelaxationTest, allow_for_shifts, fit

        measured = self.measured(tuple(caller.file(each) for each in self.files))
        if not isinstance(measured, FrequencySweeps):
            first = measured[0] if isinstance(measured, tuple) else measured
            found = "relaxation" if isinstance(first, RelaxationTest) else "creep"
            given = [n for n in ("frequency_unit", "shift_by") if getattr(self, n) is not None]
            if given:
                raise InputError(
                    f"{quoted(given)} cannot be used for a test of {found}; leave it out",
                    field=given[0],
                )
        data, shift, cautions = self.at_one_temperature(measured, caller)
        known = self.values("glassy_modulus", "rubbery_modulus")
        report = fit(
            data,
            known={name: value for name, value in known.items() if value is not None},
            **self.values("poisson_ratio", "model", "arms", "loss", "level"),
        )
        report = allow_for_shifts(report, data, shift)
        return replace(report, cautions=(*cautions, *report.cautions)), shift

    def _passport(self, report: "FitReport", shift: Any) -> "Passport":
        from viscotack.lab import issued
        from viscotack.version import __version__

        passport = issued(
            report,
            name=self.name or self.files[0].stem,
            shift=shift,
            reference=self.source,
            made_by=f"viscotack {__version__}",
        )
        # bare names: a path is valid on this machine only
        names = ", ".join(file.name for file in self.files)
        return replace(passport, origin=replace(passport.origin, file=names))


def _drawn(report: "FitReport", passport: "Passport") -> dict[str, Any]:
    """Return the material for the case of the page, and its passport."""
    from viscotack.model.materials.passport_file import passport_text

    from .parts.library import material_table

    return {"table": material_table(report.material), "passport": passport_text(passport)}
