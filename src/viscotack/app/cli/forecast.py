"""The commands ``viscotack forecast`` and ``viscotack report``: from a study to what to expect."""

import json
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from typer import Argument, Option

from viscotack.errors import InputError
from viscotack.files.whole import write_whole
from viscotack.units import parse

from .commands import AsJson, PlotFile, application, wrong_input
from .writing import Writing, check_files, rows_as_csv

_MOST = 50  # speeds between two ends

StudyFile = Annotated[
    Path,
    Argument(
        metavar="STUDY",
        help="As `viscotack identify rates ... -o study.toml` writes it.",
        show_default=False,
    ),
]
Speeds = Annotated[
    list[str] | None,
    Option(
        "--speed",
        metavar="SPEED|FROM..TO",
        help='Of a retraction, "30 um/s", or a range, "1 um/s..1 mm/s"; may be given again. Else '
        "the range of the series.",
        show_default=False,
    ),
]
Preload = Annotated[
    str | None,
    Option("--preload", metavar="FORCE", help="Of the forecast; else that of the series."),
]
Temperature = Annotated[
    str | None,
    Option(
        "--temperature",
        metavar="T",
        help='Of the forecast, "40 degC"; else that of the series. The passport says how times '
        "change with it.",
    ),
]
DwellTime = Annotated[
    str | None,
    Option(
        "--dwell",
        metavar="TIME",
        help="Under the preload, held; else until all has relaxed. Goes with --approach-speed.",
    ),
]
ApproachSpeed = Annotated[
    str | None, Option("--approach-speed", metavar="SPEED", help="Goes with --dwell.")
]


@application.command("forecast")
def forecast_command(
    study_file: StudyFile,
    speeds: Speeds = None,
    preload: Preload = None,
    temperature: Temperature = None,
    dwell: DwellTime = None,
    approach_speed: ApproachSpeed = None,
    table: Annotated[
        Path | None,
        Option("--csv", metavar="FILE", help="Write a row for each speed; - is standard output."),
    ] = None,
    plot_file: PlotFile = None,
    as_json: AsJson = False,
) -> None:
    """Forecast pull-off forces with a band, from a lab's rate series.

    The interface is found from the files of the study; its posterior, the doubt about the material
    and that of the theory make the band, which is narrow near speeds that were measured.

    Example: viscotack forecast study.toml --speed "1 um/s..10 mm/s" --plot forecast.png
    """
    with wrong_input():
        files = {"--csv": table, "--plot": plot_file}
        check_files(files, as_json=as_json, reads=[study_file])
        from viscotack.identify.study import answer, read_study
        from viscotack.pictures.identify import draw_rate_series

        wish = _wish(speeds, preload, temperature, dwell, approach_speed)
        found = answer(read_study(study_file))
        forecast = _forecast(found.fit, wish)
    write = Writing()
    rows = _rows(forecast)
    write("wrote", table, lambda target: write_whole(target, rows_as_csv(rows)))
    write.picture(plot_file, lambda: draw_rate_series(found.fit, forecast))
    _refusals(found)
    if as_json:
        write.answer(json.dumps(_as_json(found.fit, forecast, rows), indent=2, allow_nan=False))
    else:
        lines = [
            f"  {v:.4g} m/s: {force:.4g} N ({low:.4g} to {high:.4g})"
            for v, force, low, high in (row.values() for row in rows)
        ]
        head = f"Pull-off forces, {forecast.level:.0%} band of their mean"
        write.answer("\n".join([head, *lines, *found.fit.words, *forecast.words]))
    write.end()


@application.command("report")
def report_command(
    study_file: StudyFile,
    output: Annotated[
        Path,
        Option("-o", "--output", metavar="FILE", help="The page, FILE.html.", show_default=False),
    ],
    speeds: Speeds = None,
    preload: Preload = None,
    temperature: Temperature = None,
    dwell: DwellTime = None,
    approach_speed: ApproachSpeed = None,
) -> None:
    """Write one page for the lab: curves, interface, forecast, method, and what to cite.

    The page needs nothing beside it and prints well.

    Example: viscotack report study.toml -o report.html
    """
    with wrong_input():
        check_files({"--output": output}, reads=[study_file])
        from viscotack.app.report import page
        from viscotack.identify.study import answer, read_study

        wish = _wish(speeds, preload, temperature, dwell, approach_speed)
        found = answer(read_study(study_file))
        forecast = _forecast(found.fit, wish)
    write = Writing()
    write("wrote", output, lambda target: write_whole(target, page(found, forecast).encode()))
    _refusals(found)
    write.answer("\n".join([*found.fit.words, *forecast.words]))
    write.end()


def _refusals(found: Any) -> None:
    for path, why in found.survey.reasons:
        typer.echo(f"refused: {path}: {why}", err=True)


def _wish(
    speeds: list[str] | None,
    preload: str | None,
    temperature: str | None,
    dwell: str | None,
    approach: str | None,
) -> dict[str, Any]:
    """Return the flags of a forecast as keywords, in SI."""

    def read(text: str | None, unit: str) -> float | None:
        return None if text is None else parse(text, unit)

    return {
        "speed": None if not speeds else np.concatenate([_between(text) for text in speeds]),
        "preload": read(preload, "N"),
        "temperature": read(temperature, "K"),
        "dwell": read(dwell, "s"),
        "approach_speed": read(approach, "m/s"),
    }


def _between(text: str) -> np.ndarray:
    first, dots, last = text.partition("..")
    if not dots:
        return np.array([parse(text, "m/s")])
    low, high = parse(first, "m/s"), parse(last, "m/s")
    if not 0 < low < high:
        raise InputError(f"--speed {text}: the first of two must be positive and the smaller one")
    count = min(_MOST, 1 + round(8 * np.log10(high / low)))
    return np.geomspace(low, high, max(count, 2))


def _forecast(fit: Any, wish: dict[str, Any]) -> Any:
    from viscotack.identify import forecast_rates

    speed = wish["speed"]
    if speed is None:
        measured = [one.speed for one in fit.series]
        speed = np.geomspace(min(measured), max(measured), 25)
    return forecast_rates(fit, **(wish | {"speed": speed}))


def _rows(forecast: Any) -> list[dict[str, float]]:
    columns = zip(forecast.speed, forecast.force, forecast.low, forecast.high, strict=True)
    names = ("speed_m_s", "pull_off_force_N", "low_N", "high_N")
    return [dict(zip(names, map(float, row), strict=True)) for row in columns]


def _as_json(fit: Any, forecast: Any, rows: list[dict[str, float]]) -> dict[str, Any]:
    return {
        "work_of_adhesion_J_m2": fit.work_of_adhesion,
        "equilibrium_gap_m": fit.equilibrium_gap,
        "level": forecast.level,
        "preload_N": forecast.preload,
        "temperature_K": forecast.temperature,
        "dwell_s": forecast.dwell,
        "forecast": rows,
        "words": [*fit.words, *forecast.words],
    }
