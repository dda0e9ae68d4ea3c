"""The commands ``viscotack identify ...``: from measured curves to the interface."""

import json
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer
from typer import Option

from viscotack.app.records import rates_record, slow_record
from viscotack.errors import InputError
from viscotack.files.whole import write_whole
from viscotack.units import parse

from .commands import AsJson, PlotFile, application, wrong_input
from .rig import ReadingRigs, TestFiles, rig_of
from .tack import nothing
from .writing import Writing, check_files

identify = typer.Typer(
    help="From measured curves to the interface: work of adhesion and range of attraction.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
application.add_typer(identify, name="identify")


@identify.callback()
def _identify() -> None:
    """From measured curves to the interface: work of adhesion and range of attraction."""


class Model(StrEnum):
    """Elastic models of a slow test."""

    JKR = "jkr"
    DMT = "dmt"
    MAUGIS = "maugis"
    CARPICK = "carpick"


class Against(StrEnum):
    """What the force is fitted against."""

    RADIUS = "radius"
    DEPTH = "depth"


@identify.command("slow", cls=ReadingRigs)
def slow_command(
    context: typer.Context,
    files: TestFiles,
    radius: Annotated[
        str,
        Option("--radius", metavar="LENGTH", help='Of the sphere, "5.19 mm".', show_default=False),
    ],
    cycle: Annotated[
        int, Option("--cycle", metavar="N", help="Which cycle of the files, from 1 on.")
    ] = 1,
    models: Annotated[
        list[Model] | None,
        Option("--model", help="Models to compare; else all four.", show_default=False),
    ] = None,
    against: Annotated[
        Against | None,
        Option(
            "--against",
            help="Contact radius or depth; else the radius where the file has one.",
            show_default=False,
        ),
    ] = None,
    modulus: Annotated[
        str | None,
        Option(
            "--contact-modulus",
            metavar="PRESSURE",
            help='E0* of the relaxed solid, known from elsewhere, "1.94 MPa"; else it is fitted.',
        ),
    ] = None,
    modulus_uncertainty: Annotated[
        str | None,
        Option(
            "--contact-modulus-uncertainty",
            metavar="PRESSURE",
            help="Standard uncertainty of it; goes with it.",
        ),
    ] = None,
    level: Annotated[float, Option(help="Confidence level of the intervals.")] = 0.9,
    plot_file: PlotFile = None,
    as_json: AsJson = False,
) -> None:
    """Find work of adhesion and Tabor number from one slow retraction of a sphere.

    JKR, DMT, Maugis and Carpick are fitted to force against contact radius (from a camera) or
    against depth, and compared by an information criterion; intervals are profile likelihoods.
    What the data cannot tell is said in words. A test that is not slow reads the range of
    attraction wrong: docs/tack_tests.md shows by how much.

    Example: viscotack identify slow lens_1um_s.csv --radius "5.19 mm"
    --contact-modulus "1.94 MPa" --contact-modulus-uncertainty "0.06 MPa" --plot slow.png
    """
    with wrong_input():
        check_files({"--plot": plot_file}, as_json=as_json, reads=files)
        rig = rig_of(context)
        from viscotack.identify import identify_slow, slow_test
        from viscotack.lab.tack import survey
        from viscotack.pictures.identify import draw_slow_test

        found = survey(files, reading=rig.reading, evaluation=rig.evaluation)
        if not found.cycles:
            raise InputError(nothing(found))
        if not 1 <= cycle <= len(found.cycles):
            raise InputError(f"--cycle must be 1 to {len(found.cycles)}, got {cycle}")
        test = slow_test(
            found.cycles[cycle - 1],
            parse(radius, "m"),
            None if against is None else str(against),
        )
        fit = identify_slow(
            test,
            models=[str(model) for model in models or Model],
            contact_modulus=_pair("--contact-modulus", (modulus, modulus_uncertainty), "Pa"),
            level=level,
        )
    write = Writing()
    write.picture(plot_file, lambda: draw_slow_test(fit))
    for path, why in found.reasons:
        typer.echo(f"refused: {path}: {why}", err=True)
    write.answer(
        json.dumps(slow_record(fit), indent=2, allow_nan=False) if as_json else _words(fit)
    )
    write.end()


@identify.command("rates", cls=ReadingRigs)
def rates_command(
    context: typer.Context,
    files: TestFiles,
    passport: Annotated[
        str,
        Option(
            "--material",
            metavar="PASSPORT",
            help="A material passport, or the name of a published material.",
            show_default=False,
        ),
    ],
    radius: Annotated[
        str,
        Option("--radius", metavar="LENGTH", help='Of the sphere, "5.19 mm".', show_default=False),
    ],
    preload: Annotated[
        str | None,
        Option(
            "--preload",
            metavar="FORCE",
            help='Under which the contact relaxed, "1.5 mN"; else the force where retractions '
            "begin.",
        ),
    ] = None,
    work: Annotated[
        str | None,
        Option(
            "--work-of-adhesion",
            metavar="ENERGY/AREA",
            help='Known from a slow test, "152 mJ/m2"; else it is fitted with nothing known of it.',
        ),
    ] = None,
    work_uncertainty: Annotated[
        str | None,
        Option(
            "--work-of-adhesion-uncertainty",
            metavar="ENERGY/AREA",
            help="Standard uncertainty of it; goes with it.",
        ),
    ] = None,
    temperature: Annotated[
        str | None,
        Option(
            "--temperature",
            metavar="T",
            help='Of the tests, "25 degC"; else that at which the passport holds.',
        ),
    ] = None,
    curves: Annotated[
        bool,
        Option(
            "--curves",
            help="Take whole curves, by their travels between forces; one speed is enough then.",
        ),
    ] = False,
    growth: Annotated[
        bool,
        Option(
            "--growth",
            help="Look for an interface that grows with the opening speed: how much, with which "
            "power, and whether the data need it. Takes 1 to 2 minutes.",
        ),
    ] = False,
    scatter: Annotated[
        str | None,
        Option(
            "--scatter",
            metavar="PART",
            help='Of forces from test to test, "3 %", where repeated tests do not show it.',
        ),
    ] = None,
    level: Annotated[float, Option(help="Confidence level of the intervals.")] = 0.9,
    output: Annotated[
        Path | None,
        Option(
            "-o",
            "--output",
            metavar="STUDY",
            help="Write the study, for `viscotack forecast` and `viscotack report`.",
        ),
    ] = None,
    plot_file: PlotFile = None,
    corner_file: Annotated[
        Path | None,
        Option("--corner", metavar="FILE", help="Draw the posterior of the interface."),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Find work of adhesion and range of attraction from pull-offs at several speeds.

    Every cycle of the files gives its true speed and its pull-off; a contact whose edge is a
    steady viscoelastic crack is fitted to them. Solids that the measurement behind the passport
    allows as well widen the intervals. What the data cannot tell, and where such an interface does
    not give the forces, is said in words. --growth looks for an interface that grows with speed.

    Example: viscotack identify rates lens_*.csv --material pdms-10-1 --radius "5.19 mm"
    -o study.toml
    """
    with wrong_input():
        drawn = {"--plot": plot_file, "--corner": corner_file}
        check_files({"--output": output, **drawn}, as_json=as_json, reads=files)
        rig = rig_of(context)
        from viscotack.identify import posterior
        from viscotack.identify.study import Study, answer, study_text
        from viscotack.pictures.identify import draw_posterior, draw_rate_series

        study = Study(
            files=tuple(files),
            material=passport,
            radius=parse(radius, "m"),
            preload=None if preload is None else parse(preload, "N"),
            temperature=None if temperature is None else parse(temperature, "K"),
            work_of_adhesion=_pair("--work-of-adhesion", (work, work_uncertainty), "J/m^2"),
            curves=curves,
            growth=growth,
            scatter=0.0 if scatter is None else parse(scatter, "1"),
            level=level,
            reading=rig.reading,
            evaluation=rig.evaluation,
        )
        found = answer(study)
    fit, write = found.fit, Writing()
    folder = "." if output is None else output.parent
    text = study_text(study, folder)
    write("wrote", output, lambda target: write_whole(target, text.encode()))
    write.picture(plot_file, lambda: draw_rate_series(fit))
    write.picture(corner_file, lambda: draw_posterior(posterior(fit.objective, fit.best), fit))
    for path, why in found.survey.reasons:
        typer.echo(f"refused: {path}: {why}", err=True)
    if as_json:
        write.answer(json.dumps(rates_record(fit), indent=2, allow_nan=False))
    else:
        rows = [
            f"  {one.speed:.4g} m/s: {one.force.value:.4g} N measured, {force:.4g} N fitted"
            for one, force in zip(fit.series, fit.forces, strict=True)
        ]
        write.answer("\n".join([*rows, *fit.words, f"Tabor number {fit.tabor:.3g}"]))
    write.end()


def _pair(flag: str, words: tuple[str | None, str | None], unit: str) -> tuple[float, float] | None:
    """Return a number known from elsewhere and its uncertainty."""
    value, uncertainty = words
    if (value is None) != (uncertainty is None):
        raise InputError(f"{flag} and {flag}-uncertainty go together; say both or neither")
    if value is None or uncertainty is None:
        return None
    return parse(value, unit), parse(uncertainty, unit)


def _words(fit: Any) -> str:
    lines = [f"Force against {fit.test.against}, {fit.test.force.size} points"]
    for one in fit.fits:
        tabor = "" if one.tabor is None else f", Tabor number {one.tabor:.3g}"
        lines.append(
            f"  {one.model:8} {one.work_of_adhesion:.4g} J/m2, E0* {one.contact_modulus:.4g} Pa"
            f"{tabor}; scatter {one.scatter:.2g} N, criterion {one.criterion:.1f}"
        )
    return "\n".join([*lines, *fit.words, f"Chosen by: {fit.evidence}"])
