"""Rendering of the report of a study as a single HTML file.

Its words and their order stand in ``page.html``, its looks in ``page.css``.
"""

import io
from base64 import b64encode
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from viscotack.errors import InputError, install_command
from viscotack.identify import RateForecast
from viscotack.lab.tack.repeats import SpeedTable, jkr_work, speed_table
from viscotack.model.geometry import Layer
from viscotack.model.materials.passport_file import in_words
from viscotack.version import __version__

from ...request import write_file
from ..record_words import cells_of, quantities, read
from ..records import conditions, cycle_row, forecast_rows, rates_record, repeat_rows, series_record

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ...identify import Identified

_FOLDER = Path(__file__).parent
_MOST_CURVES = 12  # of the picture of curves
_MOST_ROWS = 13  # of the table of the forecast


def page(found: "Identified", forecast: RateForecast) -> str:
    """Return the page of a study and its forecast.

    Parameters
    ----------
    found : Identified
        The files of a study, evaluated and fitted.
    forecast : RateForecast
        Of the same fit.
    """
    try:
        from jinja2 import Environment, FileSystemLoader, StrictUndefined
    except ImportError as error:
        raise InputError(
            f"a report needs Jinja2; install it with: {install_command('lab')}"
        ) from error
    from viscotack.plot.interface import draw_fitted_curves, draw_posterior, draw_rate_series
    from viscotack.plot.tack import draw_tests

    shelf = Environment(
        loader=FileSystemLoader(_FOLDER), autoescape=True, undefined=StrictUndefined
    )
    fit, repeats = found.fit, speed_table(found.survey.cycles)
    record, ahead = rates_record(fit), forecast_rows(forecast)
    shown = np.unique(np.linspace(0, len(ahead) - 1, _MOST_ROWS).round().astype(int))
    return shelf.get_template("page.html").render(
        style=(_FOLDER / "page.css").read_text(),
        version=__version__,
        title=found.asked.title or "Pull-off of a sphere at several speeds",
        notes=found.asked.notes,
        words=fit.words,
        cautions=forecast.words,
        facts=_facts(found, record, repeats),
        solutions=_table(
            {"work_of_adhesion_J_m2": one["work_of_adhesion"], "range h₀_m": one["equilibrium_gap"]}
            for one in record["solutions"][len(record["solutions"]) < 2 :]
        ),
        repeats=_table(repeat_rows(repeats, found.fit.given.radius)),
        tables=_tables(found, repeats, forecast),
        tests=_table(_tests(found)),
        refused=found.survey.reasons,
        decisions=dict.fromkeys(x for cycle in found.survey.cycles for x in cycle.source.notes),
        series=_table(
            one | {"difference": f"{one['pull_off_force_N'] / one['fitted_N'] - 1:+.2%}"}
            for one in record["series"]
        ),
        shares=_table(record["growth"]["shares"]) if record["growth"] else None,
        forecast=_table(ahead[i] for i in shown),
        conditions=_said(read(forecast, "preload_N", "temperature_K", "dwell_s")),
        level=f"{fit.level:.0%}",
        theory=f"{100 * fit.given.theory_error:.3g} %",
        layer=isinstance(found.fit.given.body, Layer),
        material=in_words(fit.passport),
        curves=_drawing(draw_tests(found.survey.cycles, _MOST_CURVES)),
        fitted=_drawing(draw_fitted_curves(fit, found.survey.cycles)),
        speeds=_drawing(draw_rate_series(fit, forecast)),
        posterior=_drawing(draw_posterior(forecast.posterior, fit)),
    )


def _facts(found: "Identified", record: dict[str, Any], repeats: SpeedTable) -> dict[str, str]:
    """Return the numbers of a study and its fit as text; the sentences have the intervals."""
    given, fit, slowest = found.fit.given, found.fit, repeats.speeds[0]
    loads = [one.preload or 0.0 for one in fit.series]
    facts = {
        "sphere_radius_m": given.radius,
        "material": fit.passport.name or str(found.asked.material),
        "temperature_K": fit.passport.temperature,
        "preload_N": [min(loads), max(loads)] if given.preload is None else given.preload,
        **(record["layer"] or {}),
        f"JKR work 2F/(3πR) at {conditions(None, slowest.speed)}_J_m2": jkr_work(
            slowest.force, given.radius
        ),
    }
    for head, of in {"": record, "growth_": record["growth"] or {}}.items():
        facts |= {f"{head}{name}": x for name, x in of.items() if isinstance(x, float)}
    series = series_record(repeats)
    facts["scatter of single tests"] = series["scatter"]
    facts["exponent of force by speed"] = series["exponent"]
    facts["exponent of force by speed_standard_error"] = series["exponent_standard_error"]
    return _said(facts)


def _tests(found: "Identified") -> list[dict[str, Any]]:
    """Return file, true speed, pull-off and work of each cycle, as rows."""
    measured = ("speed_m_s", "pull_off_force_N", "work_of_separation_J", "preload_N")
    names = [f"{name}{more}" for name in measured for more in ("", "_uncertainty")]
    rows = []
    for one in found.survey.evaluations:
        file = one.record.source
        about = {"file": Path(file.path).name, "SHA-256": file.sha256[:12]}
        for row in map(cycle_row, one.cycles):
            rows.append(about | {name: row[name] for name in ("cycle", *names, "dwell_time_s")})
    return rows


def _tables(
    found: "Identified", repeats: SpeedTable, forecast: RateForecast
) -> list[tuple[str, str]]:
    """Return names of tables, and their CSV text as a data link."""
    radius, links = found.fit.given.radius, []
    cycles = [{"file": x.source.path, **cycle_row(x, radius)} for x in found.survey.cycles]
    tables = {"cycles": cycles, "repeats": repeat_rows(repeats, radius)}
    for name, rows in (tables | {"forecast": forecast_rows(forecast)}).items():
        stream = io.BytesIO()
        write_file(rows, stream)
        content = b64encode(stream.getvalue()).decode()
        links.append((name, f"data:text/csv;base64,{content}"))
    return links


def _table(rows: Iterable[dict[str, Any]]) -> Any:
    """Return heads and cells of rows; None without a row."""
    heads, cells = cells_of(list(rows))
    return (heads, [[_spelled(cell) for cell in row] for row in cells]) if cells else None


def _said(record: dict[str, Any]) -> dict[str, str]:
    """Return labels and text of known quantities."""
    return {name: _spelled(text) for name, text in quantities(record, {}).items() if text}


def _spelled(text: str) -> str:
    """Return a quantity as a page spells it."""
    return text.replace(" u", " µ").replace("/m2", "/m²").replace("+-", "±").replace("deg", "°")


def _drawing(figure: "Figure") -> Any:
    """Return a figure as SVG to stand within a page."""
    import matplotlib
    from markupsafe import Markup

    stream = io.StringIO()
    # ids that are the same each time
    with matplotlib.rc_context({"svg.hashsalt": "viscotack", "svg.fonttype": "path"}):
        figure.savefig(stream, format="svg", metadata={"Date": None})
    text = stream.getvalue()
    return Markup(text[text.index("<svg") :])  # noqa: S704, our own drawing
