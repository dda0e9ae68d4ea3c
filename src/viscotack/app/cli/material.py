"""The commands ``viscotack material fit | show | convert | export``: from a test to a material."""

import json
from dataclasses import asdict, replace
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from typer import Argument, Option

from viscotack.errors import InputError
from viscotack.files.whole import write_whole
from viscotack.materials.conversion import PronyForm, prony_form
from viscotack.materials.exchange import Units, exported, imported
from viscotack.materials.library import MATERIALS, passport_of
from viscotack.materials.passport import Origin, Passport
from viscotack.materials.passport_file import write_passport
from viscotack.materials.passport_words import in_words, shift_lines
from viscotack.materials.words import word_of
from viscotack.problem.nouns import own_nouns
from viscotack.units import parse
from viscotack.version import __version__

from .commands import AsJson, PlotFile, With, application, wrong_input
from .superposing import Shifting, stepped, swept
from .writing import Writing, check_files

material = typer.Typer(
    help="From a laboratory's file to a material, and on to other programs.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
application.add_typer(material, name="material")


class Test(StrEnum):
    """What a file holds."""

    DMA = "dma"
    RELAXATION = "relaxation"
    CREEP = "creep"


class ShiftBy(StrEnum):
    """What must superpose."""

    BOTH = "both"
    STORAGE = "storage"
    LOSS = "loss"
    TAN = "tan"


class Model(StrEnum):
    """What to fit."""

    BEST = "best"
    POWER_LAW = "power-law"
    RELAXATION_POWER_LAW = "relaxation-power-law"
    SLS = "sls"
    FRACTIONAL_ZENER = "fractional-zener"
    FRACTIONAL_MAXWELL = "fractional-maxwell"
    FRACTIONAL_KELVIN_VOIGT = "fractional-kelvin-voigt"
    PRONY = "prony"


class Code(StrEnum):
    """Programs whose input is written and read."""

    ABAQUS = "abaqus"
    ANSYS = "ansys"
    COMSOL = "comsol"
    RADIOSS = "radioss"
    TAMAAS = "tamaas"
    RHEOJAX = "rheojax"
    PYVISCO = "pyvisco"
    REPTATE = "reptate"


_HELP_PASSPORT = (
    f"A material passport, or the name of a published material: {', '.join(MATERIALS)}."
)
Known = Annotated[str, Argument(metavar="PASSPORT", help=_HELP_PASSPORT, show_default=False)]
Output = Annotated[
    Path | None,
    Option("-o", "--output", metavar="FILE", help="Write to this file; - is standard output."),
]
Temperature = Annotated[
    str | None,
    Option("--temperature", metavar="T", help='At this temperature, "0 degC" or "273 K".'),
]
Pressure = Annotated[
    str | None, Option("--pressure-unit", metavar="UNIT", help="Unit of moduli there, MPa.")
]
Time = Annotated[str | None, Option("--time-unit", metavar="UNIT", help="Unit of times there, s.")]


@material.command("fit")
def fit_command(
    files: Annotated[
        list[Path],
        Argument(
            metavar="FILE...",
            help="What the instrument wrote; several files are sweeps of one material.",
            show_default=False,
        ),
    ],
    poisson_ratio: Annotated[
        float,
        Option("--poisson-ratio", metavar="NU", help="0.5 for rubber, about 0.35 for a glass."),
    ],
    output: Output = None,
    plot_file: PlotFile = None,
    test: Annotated[
        Test | None, Option(help="What the file holds; else its columns say.", show_default=False)
    ] = None,
    model: Annotated[
        Model, Option(help="What to fit; best: all, and an information criterion chooses.")
    ] = Model.BEST,
    arms: Annotated[
        int | None,
        Option(metavar="N", help="Relaxation times of a Prony series; else the data decide."),
    ] = None,
    reference: Annotated[
        str | None,
        Option(
            "--reference-temperature",
            metavar="T",
            help='Temperature of the master curve, "20 degC"; needed for sweeps at several.',
        ),
    ] = None,
    glass_transition: Annotated[
        str | None,
        Option(
            "--glass-transition",
            metavar="T",
            help='Shift by WLF with c1 = 17.44 and c2 = 51.6 K at this temperature, "-115 degC". '
            "Without any shift it is found from the overlap of the sweeps.",
        ),
    ] = None,
    wlf: Annotated[
        str | None,
        Option(
            metavar="C1,C2",
            help='Shift by WLF with these constants, "8.86,101.6 K", at the reference temperature.',
        ),
    ] = None,  # fmt: skip
    shift_file: Annotated[
        Path | None, Option("--shift-file", metavar="FILE", help="Shift by this table of log_aT.")
    ] = None,
    shift_by: Annotated[
        ShiftBy | None,
        Option(
            "--shift-by",
            help="What must superpose, where shifts are found from overlap; left out with "
            "--vertical: the most that the data carry.",
        ),
    ] = None,
    vertical: Annotated[
        str | None,
        Option(
            metavar="WORD|EXPANSION",
            help="How far moduli move with temperature: auto, as far as the data fix it; none; "
            'free; or by density and temperature, with a volume expansion of "6e-4 1/K".',
        ),
    ] = None,
    leave_out: Annotated[
        list[str] | None,
        Option(
            "--leave-out",
            metavar="T",
            help='Leave out the sweep at this temperature, "-30 degC". Give it once for each.',
        ),
    ] = None,
    format: Annotated[
        str | None,
        Option("--format", metavar="NAME", help="Of the file, where it is not found out."),
    ] = None,
    kind: Annotated[
        str | None, Option(metavar="E|G", help="Tensile or shear, where the file does not say.")
    ] = None,
    measured_at: Annotated[
        str | None,
        Option("--temperature", metavar="T", help="Of the test, where the file does not say."),
    ] = None,
    frequency_unit: Annotated[
        str | None, Option("--frequency-unit", help="Hz or rad/s, where the file does not say.")
    ] = None,
    modulus_unit: Annotated[
        str | None, Option("--modulus-unit", help="Such as MPa, where the file does not say.")
    ] = None,
    time_unit: Annotated[
        str | None, Option("--time-unit", help="Such as s, where the file does not say.")
    ] = None,
    temperature_unit: Annotated[
        str | None,
        Option(
            "--temperature-unit",
            help="degC, K or degF, where a column or the numbers above columns have none.",
        ),
    ] = None,
    temperature_in_name: Annotated[
        bool,
        Option(
            "--temperature-in-name",
            help="The temperature stands in the name of each file, as in foam_-25C.csv.",
        ),
    ] = False,
    decimal: Annotated[
        str | None,
        Option("--decimal", metavar=",|.", help="Decimal mark, where 1,234 leaves it open."),
    ] = None,
    glassy_modulus: Annotated[
        str | None,
        Option(
            "--glassy-modulus",
            metavar="PRESSURE",
            help='Known from elsewhere and not fitted, "3 GPa"; not for a Prony series.',
        ),
    ] = None,
    rubbery_modulus: Annotated[
        str | None, Option("--rubbery-modulus", metavar="PRESSURE", help="In the same way.")
    ] = None,
    loss: Annotated[
        bool, Option("--loss/--no-loss", help="Whether the loss modulus counts.")
    ] = True,
    name: Annotated[
        str | None, Option(metavar="WORDS", help="Name of the material; else that of the file.")
    ] = None,
    reference_words: Annotated[
        str, Option("--source", metavar="WORDS", help="Who measured it, for the passport.")
    ] = "",
    level: Annotated[float, Option(help="Confidence level of the intervals.")] = 0.9,
    as_json: AsJson = False,
) -> None:
    """Fit a material to a DMA, relaxation or creep test, and issue its passport.

    Sweeps at several temperatures become a master curve first.

    Example: viscotack material fit dma.csv --poisson-ratio 0.5 --reference-temperature "20 degC"
    --glass-transition "-115 degC" -o pdms.toml --plot fit.png
    """
    with wrong_input():
        written = {"--plot": plot_file, "--output": output}
        check_files(written, as_json=as_json, reads=(*files, shift_file))
        from viscotack.lab import FrequencySweeps, RelaxationTest, allow_for_shifts, fit
        from viscotack.lab.fit_passport import issued
        from viscotack.pictures.lab import draw_fit

        given = {
            "format": format,
            "kind": kind,
            "temperature": _kelvin(measured_at),
            "frequency_unit": frequency_unit,
            "modulus_unit": modulus_unit,
            "time_unit": time_unit,
            "temperature_unit": temperature_unit,
            "temperature_in_name": temperature_in_name,
            "decimal": decimal,
        }
        shifting = Shifting(
            reference=_kelvin(reference),
            glass_transition=glass_transition,
            wlf=wlf,
            shift_file=shift_file,
            by=None if shift_by is None else str(shift_by),
            vertical=vertical,
            leave_out=tuple(leave_out or ()),
        )
        of_sweeps = {"frequency-unit": frequency_unit, "shift-by": shift_by}
        if test in (Test.RELAXATION, Test.CREEP):
            _refuse(f"for --test {test}", of_sweeps)
        measured = _measured(files, test, given)
        if isinstance(measured, FrequencySweeps):
            data, shift, cautions = swept(measured, shifting)
        else:
            first = measured[0] if isinstance(measured, tuple) else measured
            found = Test.RELAXATION if isinstance(first, RelaxationTest) else Test.CREEP
            _refuse(f"for a {found} test, which the file holds", of_sweeps)
            data, shift, cautions = stepped(measured, shifting)
        known = {"glassy_modulus": glassy_modulus, "rubbery_modulus": rubbery_modulus}
        report = fit(
            data,
            poisson_ratio=poisson_ratio,
            model=str(model),
            arms=arms,
            known={k: parse(v, "Pa") for k, v in known.items() if v is not None},
            loss=loss,
            level=level,
        )
        report = allow_for_shifts(report, data, shift)
        report = replace(report, cautions=(*cautions, *report.cautions))
        passport = None
        if output is not None or not hasattr(report.material, "no_contact"):
            passport = issued(
                report,
                name=name or files[0].stem,
                shift=shift,
                reference=reference_words,
                made_by=f"viscotack {__version__}",
            )
            passport = _by_file_name(passport, files)
    write = Writing()
    if passport is not None:
        write("wrote", output, lambda target: write_passport(passport, target))
    write.picture(plot_file, lambda: draw_fit(report, passport))
    if as_json:
        more = {"criterion": dict(report.compared), "median_error": report.median_error}
        write.answer(_law_json(report, **more) if passport is None else _json(passport, **more))
    else:
        notes = report.observed.source.notes
        typer.echo("\n".join(f"  Read: {note}" for note in notes), err=True)
        shifted = [] if passport is None else shift_lines(passport)
        write.answer("\n".join([report.words(), *shifted]))
    write.end()


@material.command("show")
def show_command(passport_file: Known, as_json: AsJson = False, own: With = None) -> None:
    """Show a material passport in words, or a published material.

    Example: viscotack material show pdms-10-1
    """
    with wrong_input():
        passport = passport_of(passport_file, also=own_nouns(own or ()))
    if as_json:
        typer.echo(_json(passport))
    else:
        typer.echo(in_words(passport))


@material.command("convert")
def convert_command(
    source: Annotated[
        str,
        Argument(
            metavar="PASSPORT|FILE",
            help=f"{_HELP_PASSPORT} Or, with --from, another program's input.",
            show_default=False,
        ),
    ],
    output: Output = None,
    temperature: Temperature = None,
    prony: Annotated[
        bool, Option("--prony", help="As a Prony series; of a power law with a stated error.")
    ] = False,
    frequencies: Annotated[
        str | None,
        Option(
            metavar="LOW,HIGH",
            help='Where the series must hold, "1 mHz,1 MHz"; else the measured range.',
        ),
    ] = None,  # fmt: skip
    tolerance: Annotated[float, Option(help="Relative error allowed to the series.")] = 3e-4,
    code: Annotated[
        Code | None, Option("--from", help="The file is input of this program.")
    ] = None,
    pressure_unit: Pressure = None,
    time_unit: Time = None,
    rubbery_modulus: Annotated[
        str | None,
        Option(
            "--rubbery-modulus",
            metavar="PRESSURE",
            help="Long-term Young's modulus, where that input does not hold it.",
        ),
    ] = None,  # fmt: skip
    poisson_ratio: Annotated[
        float | None, Option("--poisson-ratio", metavar="NU", help="In the same way.")
    ] = None,
    own: With = None,
) -> None:
    """Convert a passport: to another temperature, to a Prony series, from another program.

    Without -o the passport goes to standard output.

    Examples: viscotack material convert pdms-10-1 --temperature "0 degC" -o cold.toml, or:
    viscotack material convert card.inp --from abaqus --pressure-unit MPa --time-unit s -o pad.toml
    """
    with wrong_input():
        check_files({"--output": output}, reads=() if code is None else (Path(source),))
        also = {"rubbery-modulus": rubbery_modulus, "poisson-ratio": poisson_ratio}
        if code is None:
            _refuse(
                "without --from", also | {"pressure-unit": pressure_unit, "time-unit": time_unit}
            )
            passport = passport_of(source, also=own_nouns(own or ()))
        else:
            passport = _imported(source, code, pressure_unit, time_unit, also)
        if temperature is not None:
            passport = passport.moved_to(parse(temperature, "K"))
        if prony:
            form = _series(passport, frequencies, tolerance)
            note = f"Prony series of the {word_of(passport.material)}, error {form.error:.1e}"
            origin = replace(passport.origin, notes=(*passport.origin.notes, note))
            passport = replace(
                passport, material=form.material, frequencies=form.frequencies, origin=origin
            )
        elif frequencies is not None:
            raise InputError("--frequencies go with --prony")
    write = Writing()
    write("wrote", output or Path("-"), lambda target: write_passport(passport, target))
    write.end()


@material.command("export")
def export_command(
    passport_file: Known,
    code: Annotated[Code, Option("--to", help="The program to write for.", show_default=False)],
    output: Output = None,
    temperature: Temperature = None,
    frequencies: Annotated[
        str | None,
        Option(
            metavar="LOW,HIGH",
            help='Where the series of a power law must hold, "1 mHz,1 MHz"; '
            "else the measured range.",
        ),
    ] = None,  # fmt: skip
    tolerance: Annotated[
        float, Option(help="Relative error allowed to the series of a power law.")
    ] = 3e-4,
    pressure_unit: Pressure = None,
    time_unit: Time = None,
    bulk_modulus: Annotated[
        str | None,
        Option(
            "--bulk-modulus",
            metavar="PRESSURE",
            help='Of an incompressible solid, for a program that forbids that, "2 GPa".',
        ),
    ] = None,
    own: With = None,
) -> None:
    """Write a material as input of another program, in its convention and in stated units.

    Without units: Pa and s. Without -o it goes to standard output.

    Example: viscotack material export pdms-10-1 --to abaqus --pressure-unit MPa
    --frequencies "1 mHz,1 GHz" --bulk-modulus "2 GPa" -o pdms.inp
    """
    with wrong_input():
        check_files({"--output": output}, reads=(Path(passport_file),))
        passport = passport_of(passport_file, also=own_nouns(own or ()))
        if temperature is not None:
            passport = passport.moved_to(parse(temperature, "K"))
        form = _series(passport, frequencies, tolerance)
        text = exported(
            form.material,
            str(code),
            units=Units(pressure_unit or "Pa", time_unit or "s"),
            notes=_notes(passport, form),
            bulk_modulus=None if bulk_modulus is None else parse(bulk_modulus, "Pa"),
            shift=_seen_from(passport),
        )
    write = Writing()
    write("wrote", output or Path("-"), lambda target: write_whole(target, text.encode()))
    write.end()


def _measured(files: list[Path], test: Test | None, given: dict[str, Any]) -> Any:
    """Return what the files hold: sweeps of one material, or tests over time."""
    from viscotack.lab import read, read_creeps, read_dma, read_relaxations

    if test is None:
        return read(files, **given)
    if test is Test.DMA:
        return read_dma(files, **given)
    given = {key: value for key, value in given.items() if key != "frequency_unit"}
    return (read_relaxations if test is Test.RELAXATION else read_creeps)(files, **given)


def _imported(
    file: str, code: Code, pressure: str | None, time: str | None, also: dict[str, Any]
) -> Passport:
    if (pressure is None) != (time is None):
        raise InputError("give both --pressure-unit and --time-unit")
    constants: dict[str, float] = {}
    if also["rubbery-modulus"] is not None:
        constants["rubbery_modulus"] = parse(also["rubbery-modulus"], "Pa")
    if also["poisson-ratio"] is not None:
        constants["poisson_ratio"] = also["poisson-ratio"]
    if constants and code in (Code.ABAQUS, Code.ANSYS, Code.TAMAAS):
        raise InputError(f"input of {code} holds modulus and Poisson ratio; leave them out")
    units = Units(pressure, time) if pressure and time else None
    try:
        text = Path(file).read_text(encoding="utf-8")
        solid = imported(text, str(code), units=units, **constants)
    except (ValueError, UnicodeDecodeError) as error:
        raise InputError(f"{file}: {error}") from None
    origin = Origin(file=Path(file).name, format=str(code), made_by=f"viscotack {__version__}")
    return Passport(name=Path(file).stem, material=solid, origin=origin)


def _series(passport: Passport, frequencies: str | None, tolerance: float) -> PronyForm:
    """Return the Prony series of a passport's material."""
    if frequencies is not None:
        low, high = (parse(word, "rad/s") for word in _in_radians(frequencies))
        bounds = low, high
    elif passport.frequencies is not None:
        bounds = passport.frequencies
    elif word_of(passport.material) in ("prony", "sls"):
        unit = passport.material.time_unit
        bounds = 1e-3 / unit, 1e3 / unit
    else:
        raise InputError(
            f"{passport.name} does not say where it was measured; say where the series must hold, "
            '--frequencies "1 mHz,1 MHz"'
        )
    return prony_form(passport.material, frequencies=bounds, tolerance=tolerance)


def _in_radians(text: str) -> list[str]:
    """Return two angular frequencies in words: a hertz is 2 pi radians a second."""
    found = []
    for word in _two(text, "--frequencies"):
        if "rad" in word:
            found.append(word)
        else:
            # the unit library takes hertz for 1/s: the factor is set here, where it is seen
            found.append(f"{2 * np.pi * parse(word, '1/s')!r} rad/s")
    return found


def _two(text: str, flag: str) -> list[str]:
    words = [word.strip() for word in text.split(",")]
    if len(words) != 2:
        raise InputError(f"{flag} needs two values with a comma between them, got {text!r}")
    return words


def _seen_from(passport: Passport) -> Any:
    """Return the shift of a passport, zero at the temperature of its material."""
    if passport.shift is None or passport.temperature is None:
        return None
    return passport.shift.at_reference(passport.temperature)


def _notes(passport: Passport, form: PronyForm) -> tuple[str, ...]:
    low, high = (w / (2 * np.pi) for w in form.frequencies)
    at = "" if passport.temperature is None else f", at {passport.temperature - 273.15:.4g} C"
    source = passport.origin.reference or passport.origin.file
    return (
        f"{' '.join(passport.name.split())}{at}; written by viscotack {__version__}",
        *([f"source: {' '.join(source.split())}"] if source else []),
        f"Prony series with {len(form.material.branches)} branches, constant Poisson ratio; "
        f"largest error {form.error:.1e} of the complex modulus from {low:.3g} to {high:.3g} Hz",
    )


def _by_file_name(passport: Passport, files: list[Path]) -> Passport:
    """Return the passport with the bare names of the files: a path says nothing elsewhere."""
    names = ", ".join(file.name for file in files)
    return replace(passport, origin=replace(passport.origin, file=names))


def _kelvin(text: str | None) -> float | None:
    return None if text is None else parse(text, "K")


def _refuse(why: str, flags: dict[str, Any]) -> None:
    given = [f"--{name}" for name, value in flags.items() if value is not None]
    if given:
        raise InputError(f"{' and '.join(given)} cannot be used {why}; leave it out")


def _json(passport: Passport, **more: Any) -> str:
    solid = passport.material
    answer = asdict(passport) | {"material": {"model": word_of(solid)} | asdict(solid)}
    answer["modulus_ratio"] = solid.modulus_ratio
    return json.dumps(_finite(answer | more), indent=2, allow_nan=False)


def _law_json(report: Any, **more: Any) -> str:
    """Return a fitted law that has no passport."""
    solid = report.material
    answer = {
        "material": {"model": solid.word} | asdict(solid),
        "evidence": {
            "level": report.level,
            "intervals": [(each.name, each.low, each.high) for each in report.intervals],
            "undetermined": report.undetermined,
            "cautions": report.cautions,
        },
    }
    return json.dumps(_finite(answer | more), indent=2, allow_nan=False)


def _finite(value: Any) -> Any:
    """Return a record without infinities, which JSON has not: null stands for no bound."""
    if isinstance(value, dict):
        return {key: _finite(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(entry) for entry in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value
