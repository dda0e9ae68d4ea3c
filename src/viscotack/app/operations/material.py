"""The operations ``material ...``: fit a material, list, show, convert and export materials."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from viscotack.app.operations.options import (
    input_file,
    main_file,
    named,
    number,
    option,
    picture,
    quoted,
    switch,
    text,
    two_of,
)
from viscotack.errors import InputError
from viscotack.units import parse, readable

from .parts.files import Dma, Shifting
from .parts.solid import APassport, passport_of
from .request import Answer, Caller, Request

if TYPE_CHECKING:
    from viscotack.lab import FitReport
    from viscotack.model.materials.conversion import PronyForm
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
        main_file("Write the passport.", ".toml"),
        picture(),
    )

    files: tuple[Path, ...] = input_file(
        "Files of the instrument; several files are sweeps of one material.", "FILE..."
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
        from viscotack.model.materials.passport_file import passport_text, shift_lines
        from viscotack.plot.material import draw_fit

        from .parts.records import fit_record
        from .parts.solid import material_table

        report, shift = self._fitted(caller)
        passport = self._passport(report, shift)
        words = "\n".join([report.words(), *shift_lines(passport)])
        return Answer(
            (report, passport),
            data=fit_record(report, passport),
            words=words,
            files={"output": passport_text(passport)},
            pictures={"plot": lambda: draw_fit(report, passport)},
            drawn=lambda: {
                "table": material_table(report.material),
                "passport": passport_text(passport),
            },
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

        name, made_by = self.name or self.files[0].stem, f"viscotack {__version__}"
        how = {"shift": shift, "reference": self.source, "made_by": made_by}
        passport = issued(report, name=name, **how)
        # bare names: a path is valid on this machine only
        names = ", ".join(file.name for file in self.files)
        return replace(passport, origin=replace(passport.origin, file=names))


class ListMaterials(Request):
    """List the published materials, each with its source and as a table of a case file.

    Example: viscotack material list
    """

    word: ClassVar = "material list"

    def answer(self, caller: Caller) -> Answer:
        """Read the library."""
        from .parts.solid import library

        found = library()
        lines = []
        for one in found:
            low, high = one["measured_Hz"]
            known = readable(low, "Hz", digits=2, to=high)
            lines += [f"{one['name']:<18}{one['title']}", f"{'':<18}{known}; {one['source']}"]
        return Answer(found, data={"materials": found}, words="\n".join(lines))


# Programs whose input is written, and read.
Written = Literal["abaqus", "ansys", "comsol"]
Code = Literal["abaqus", "ansys"]


def _band(value: Any) -> tuple[float, float]:
    """Return two angular frequencies [rad/s]: a hertz is 2 pi radians a second."""
    low, high = two_of(value)

    def angular(one: Any) -> float:
        if isinstance(one, str) and "rad" not in one:
            # the unit library takes hertz for 1/s: the factor is set here, where it is seen
            return 2 * np.pi * parse(one, "1/s")
        return parse(one, "rad/s")

    return angular(low), angular(high)


class _Converted(Request):
    """A material at a temperature, or as a Prony series, in the units of another program."""

    temperature: float | None = number('At this temperature, "0 degC" or "273 K".', "K")
    frequencies: tuple[float, float] | None = text(
        'Range of the Prony series, "1 mHz,1 MHz"; default: the measured range.',
        metavar="LOW,HIGH",
        to=_band,
    )
    tolerance: float = number("Largest relative error of the series.", default=3e-4)
    pressure_unit: str | None = option("Unit of moduli in the other program, MPa.", example="MPa")
    time_unit: str | None = option("Unit of times in the other program, s.", example="s")


class ShowMaterial(Request):
    """Show a material passport or a published material.

    Example: viscotack material show pdms-10-1
    """

    word: ClassVar = "material show"
    takes_own: ClassVar = True

    passport: APassport

    def answer(self, caller: Caller) -> Answer:
        """Read the passport."""
        return _answer(passport_of(self.passport, caller))


class ConvertMaterial(_Converted):
    """Convert a passport: to another temperature, to a Prony series, from another program.

    Without -o the passport goes to standard output.

    Example: viscotack material convert pdms-10-1 --temperature "0 degC" -o cold.toml

    From Abaqus: viscotack material convert card.inp --from abaqus --pressure-unit MPa --time-unit s
    -o pad.toml
    """

    word: ClassVar = "material convert"
    outputs: ClassVar = (main_file("Write the passport.", ".toml", usual="-"),)
    takes_own: ClassVar = True

    source: Any = named(
        "A passport or published material; with --from another program's input.",
        metavar="PASSPORT|FILE",
        argument=True,
        default=...,
    )
    prony: bool = switch("Convert to a Prony series with a stated error.")
    code: Code | None = option("Program whose input file is read.", flags=("--from",))

    def check(self) -> None:
        """Check that options of other programs' input, and of a series, are given for these."""
        from viscotack.model.materials.library import MATERIALS
        from viscotack.model.materials.passport import Passport

        units = self.values("pressure_unit", "time_unit")
        given = [name for name, unit in units.items() if unit is not None]
        if self.code is None:
            if given:
                raise InputError(f"{quoted(given)} cannot be used without `code`")
        elif isinstance(self.source, Passport) or self.source in MATERIALS:
            raise InputError("`code` takes a file of another program, not a material of ours")
        elif len(given) == 1:
            raise InputError("give both `pressure_unit` and `time_unit`")
        if self.frequencies is not None and not self.prony:
            raise InputError("frequencies go with prony", field="frequencies")

    def answer(self, caller: Caller) -> Answer:
        """Read the material and convert it."""
        from viscotack.model.materials.passport_file import passport_text

        if self.code is None:
            passport = passport_of(self.source, caller)
        else:
            passport = self._imported(caller)
        if self.temperature is not None:
            passport = passport.moved_to(self.temperature)
        if self.prony:
            passport, _ = passport.as_prony(self.frequencies, self.tolerance)
        return replace(_answer(passport, caller), files={"output": passport_text(passport)})

    def _imported(self, caller: Caller) -> "Passport":
        from viscotack.files.text import read_text
        from viscotack.model.materials.exchange import Units, imported
        from viscotack.model.materials.passport import Origin, Passport
        from viscotack.version import __version__

        file, code = caller.file(self.source), str(self.code)
        pressure, time = self.pressure_unit, self.time_unit
        units = Units(pressure, time) if pressure and time else None
        text = read_text(file)
        try:
            solid = imported(text, code, units=units)
        except ValueError as error:
            raise InputError(f"{file}: {error}") from None
        origin = Origin(file=file.name, format=code, made_by=f"viscotack {__version__}")
        return Passport(name=file.stem, material=solid, origin=origin)


class ExportMaterial(_Converted):
    """Export a material as input of another program, in its convention and units.

    Without units: Pa and s. Without -o it goes to standard output.

    Example: viscotack material export pdms-10-1 --to abaqus --pressure-unit MPa
    --frequencies "1 mHz,1 GHz" --bulk-modulus "2 GPa" -o pdms.inp
    """

    word: ClassVar = "material export"
    outputs: ClassVar = (
        main_file(
            "Write the input of the program.",
            *(".inp", ".txt", ".csv", ".dat", ".mac"),
            usual="-",
        ),
    )
    takes_own: ClassVar = True

    passport: APassport
    to: Written = option("The program to write for.", default=...)
    bulk_modulus: float | None = number(
        'Bulk modulus for programs that do not allow incompressible solids, "2 GPa".', "Pa"
    )

    def answer(self, caller: Caller) -> Answer:
        """Make the series and write it as the program has it."""
        from viscotack.model.materials.exchange import Units, exported

        from .parts.record_words import read

        passport = passport_of(self.passport, caller)
        if self.temperature is not None:
            passport = passport.moved_to(self.temperature)
        _, form = passport.as_prony(self.frequencies, self.tolerance)
        shift = passport.shift
        if shift is not None and passport.temperature is not None:
            shift = shift.at_reference(passport.temperature)
        text = exported(
            form.material,
            self.to,
            units=Units(self.pressure_unit or "Pa", self.time_unit or "s"),
            notes=_notes(passport, form),
            bulk_modulus=self.bulk_modulus,
            shift=shift if passport.temperature is not None else None,
        )
        record = {"name": passport.name, "program": self.to, "text": text}
        record |= read(form, "error", angular_frequencies_rad_s="frequencies")
        words = "" if "output" in caller.wants else text.rstrip("\n")
        return Answer(text, data=record, words=words, files={"output": text})


def _answer(passport: "Passport", caller: Caller | None = None) -> Answer:
    """Return a passport, in words where it is not written."""
    from viscotack.model.materials.passport_file import in_words

    from .parts.records import passport_record

    written = caller is not None and "output" in caller.wants
    return Answer(
        passport,
        data=passport_record(passport),
        words="" if written else in_words(passport),
    )


def _notes(passport: "Passport", form: "PronyForm") -> tuple[str, ...]:
    from viscotack.version import __version__

    low, high = (w / (2 * np.pi) for w in form.frequencies)
    at = "" if passport.temperature is None else f", at {passport.temperature - 273.15:.4g} C"
    source = passport.origin.reference or passport.origin.file
    return (
        f"{' '.join(passport.name.split())}{at}; written by viscotack {__version__}",
        *([f"source: {' '.join(source.split())}"] if source else []),
        f"Prony series with {len(form.material.branches)} branches, constant Poisson ratio; "
        f"largest error {form.error:.1e} of the complex modulus from "
        f"{readable(low, 'Hz', digits=3, to=high)}",
    )
