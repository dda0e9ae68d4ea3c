"""Rendering of the report of a study as a single HTML file.

Its words and their order stand in ``page.html``, its looks in ``page.css``.
"""

import io
from base64 import b64encode
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from viscotack.errors import InputError, install_command
from viscotack.identify import RateForecast
from viscotack.lab.tack import Cycle, Measured
from viscotack.lab.tack.speed_table import SpeedTable, jkr_work, speed_table
from viscotack.model.geometry import Layer
from viscotack.model.materials.passport_words import in_words
from viscotack.units import readable, readable_interval
from viscotack.version import __version__

from ..records import conditions, cycle_row, forecast_rows, repeat_rows
from ..tables import Writer, rows_as_csv

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
    return shelf.get_template("page.html").render(
        style=(_FOLDER / "page.css").read_text(),
        version=__version__,
        title=found.asked.title or "Pull-off of a sphere at several speeds",
        notes=found.asked.notes,
        words=fit.words,
        cautions=forecast.words,
        facts=[*_facts(found), *_as_reported(found, repeats)],
        solutions=_solutions(found),
        repeats=_repeats(repeats, found.fit.given.radius),
        far=[f"{Path(x.source.path).name} cycle {x.number}" for y in repeats.speeds for x in y.far],
        tables=_tables(found, repeats, forecast),
        tests=_tests(found),
        refused=found.survey.reasons,
        decisions=_decisions(found),
        series=_series(found),
        shares=_shares(found),
        forecast=_forecast(forecast),
        level=f"{fit.level:.0%}",
        theory=f"{100 * fit.theory:.3g} %",
        layer=isinstance(found.fit.given.body, Layer),
        material=in_words(fit.passport),
        curves=_drawing(draw_tests(found.survey.cycles, _MOST_CURVES)),
        fitted=_drawing(draw_fitted_curves(fit, found.survey.cycles)),
        speeds=_drawing(draw_rate_series(fit, forecast)),
        posterior=_drawing(draw_posterior(forecast.posterior, fit)),
    )


def _facts(found: "Identified") -> list[tuple[str, str]]:
    given, fit = found.fit.given, found.fit
    temperature = fit.passport.temperature
    loads = [one.preload or 0.0 for one in fit.series]
    preload = f"{_text(min(loads), 'N', to=max(loads))}, where retractions begin"
    if given.preload is not None:
        preload = _text(given.preload, "N")
    return [
        ("sphere radius", _text(given.radius, "m")),
        ("material", fit.passport.name or str(found.asked.material)),
        *_layer(found),
        ("temperature", "not stated" if temperature is None else f"{temperature - 273.15:.4g} °C"),
        ("preload", preload),
        ("work of adhesion", _interval(found, "work_of_adhesion", "J/m2")),
        ("range of attraction h₀", _interval(found, "equilibrium_gap", "m")),
        *_growth(found),
        ("Tabor number", f"{fit.tabor:.3g}"),
        ("residuals over their uncertainty", f"{fit.scatter:.2g}"),
        ("scatter from speed to speed beyond that", f"{fit.between_speeds:.2g}"),
    ]


def _as_reported(found: "Identified", repeats: SpeedTable) -> list[tuple[str, str]]:
    """Return scatter of single tests, power law of force by speed, and comparison with JKR."""
    rows = []
    if repeats.scatter is not None:
        rows.append(
            ("scatter of single tests, pooled over speeds", f"{100 * repeats.scatter:.2g} %")
        )
    if repeats.exponent is not None:
        exponent = _measured(repeats.exponent, "1")
        rows.append(("exponent of a power law of force by speed", exponent))
    slowest = repeats.speeds[0]
    work = jkr_work(slowest.force, found.fit.given.radius)
    over = work / found.fit.work_of_adhesion
    at = _text(slowest.speed, "m/s", digits=3)
    comparison = f"{_text(work, 'J/m2', digits=3)}, {over:.3g} times the work of adhesion above"
    return [*rows, (f"JKR work of adhesion 2F/(3πR) at {at}", comparison)]


def _solutions(found: "Identified") -> list[tuple[str, ...]]:
    """Return the separate interfaces that fit the forces; empty if there is one."""
    several = found.fit.solutions
    if len(several) < 2:
        return []
    return [
        (
            _text(one.values["work_of_adhesion"], "J/m2", digits=3),
            _text(one.values["equilibrium_gap"], "m", digits=3),
            f"{np.exp((several[0].misfit - one.misfit) / 2):.2g}",
        )
        for one in several
    ]


def _repeats(repeats: SpeedTable, radius: float) -> list[tuple[str, ...]]:
    return [
        (
            _spelled(conditions(one.temperature, one.speed)),
            str(len(one.cycles)),
            *_mean(one.force, one.force_deviation, "N"),
            *_mean(one.work, one.work_deviation, "J"),
            _text(jkr_work(one.force, radius), "J/m2", digits=3),
        )
        for one in repeats.speeds
    ]


def _mean(value: float, deviation: float | None, unit: str) -> tuple[str, str]:
    """Return a mean and a standard deviation; a dash for that of a single test."""
    return _text(value, unit), "–" if deviation is None else _text(
        deviation, unit, digits=2, like=value
    )


def _tables(
    found: "Identified", repeats: SpeedTable, forecast: RateForecast
) -> list[tuple[str, str]]:
    """Return names of tables, and their CSV text as a data link."""
    radius = found.fit.given.radius
    cycles = [{"file": x.source.path, **cycle_row(x, radius)} for x in found.survey.cycles]
    tables = {
        "cycles": cycles,
        "repeats": repeat_rows(repeats, radius),
        "forecast": forecast_rows(forecast),
    }
    return [(name, _link(rows_as_csv(rows))) for name, rows in tables.items()]


def _link(write: Writer) -> str:
    stream = io.BytesIO()
    write(stream)
    return f"data:text/csv;base64,{b64encode(stream.getvalue()).decode()}"


def _layer(found: "Identified") -> list[tuple[str, str]]:
    """Return thickness and base of the sample; empty for a half-space."""
    body = found.fit.given.body
    if not isinstance(body, Layer):
        return []
    nu = body.poisson_ratio
    base = "sliding on its base" if nu is None else f"bonded, Poisson ratio {nu:.3g}"
    return [("layer", f"{_text(body.thickness, 'm')} thick, {base}")]


def _growth(found: "Identified") -> list[tuple[str, str]]:
    """Return the growth of the interface with speed; empty if it was not fitted."""
    grown = found.fit.growth
    if grown is None:
        return []
    opening = _text(grown.opening_speed, "m/s", digits=3)
    return [
        (
            f"strength over that at rest where the gap opens with {opening}",
            _interval(found, "strengthening", "1"),
        ),
        ("exponent of growth", _interval(found, "exponent", "1")),
        ("chance of as much without growth", f"{grown.chance:.2g}"),
    ]


def _shares(found: "Identified") -> list[tuple[str, ...]]:
    """Return the shares of bulk and interface in the energy at the edge, by speed."""
    grown = found.fit.growth
    return [
        (
            _text(one.speed, "m/s"),
            _text(one.edge_speed, "m/s", digits=3),
            f"{one.energy:.3g}",
            f"{one.bulk:.3g}",
            f"{one.interface:.3g}",
        )
        for one in (() if grown is None else grown.shares)
    ]


def _interval(found: "Identified", name: str, unit: str) -> str:
    fit = found.fit
    ends = fit.intervals[name]
    if ends.told:
        both = _spelled(readable_interval(ends.low, ends.high, unit))
    else:
        low = _text(ends.low, unit, digits=3) if ends.closed_below else "no lower end"
        high = _text(ends.high, unit, digits=3) if ends.closed_above else "no upper end"
        both = f"{low} to {high}"
    return f"{_text(fit.best.values[name], unit)} ({both}, {fit.level:.0%})"


def _tests(found: "Identified") -> list[tuple[str, ...]]:
    return [
        (Path(one.record.source.path).name, one.record.source.sha256[:12], *_cycle(cycle))
        for one in found.survey.evaluations
        for cycle in one.cycles
    ]


def _cycle(cycle: Cycle) -> tuple[str, ...]:
    return (
        str(cycle.number),
        _measured(cycle.speed, "m/s"),
        _measured(cycle.pull_off_force, "N"),
        _measured(cycle.work_of_separation, "J"),
        _measured(cycle.preload, "N"),
        _text(cycle.dwell_time, "s", digits=3),
    )


def _decisions(found: "Identified") -> list[str]:
    """Return the notes on the evaluation of the files, without repetitions."""
    notes = (note for cycle in found.survey.cycles for note in cycle.source.notes)
    return list(dict.fromkeys(notes))


def _series(found: "Identified") -> list[tuple[str, ...]]:
    fit = found.fit
    return [
        (
            _spelled(one.conditions()),
            _measured(one.force, "N"),
            _text(force, "N"),
            f"{100 * (one.force.value / force - 1):+.2f} %",
        )
        for one, force in zip(fit.series, fit.forces, strict=True)
    ]


def _forecast(forecast: RateForecast) -> dict[str, Any]:
    count = forecast.speed.size
    shown = np.unique(np.linspace(0, count - 1, min(count, _MOST_ROWS)).round().astype(int))
    columns = zip(
        *(x[shown] for x in (forecast.speed, forecast.force, forecast.low, forecast.high)),
        strict=True,
    )
    temperature = forecast.temperature
    return {
        "rows": [(_text(v, "m/s"), *(_text(P, "N") for P in forces)) for v, *forces in columns],
        "preload": _text(forecast.preload, "N"),
        "temperature": "" if temperature is None else f"{temperature - 273.15:.4g} °C",
        "dwell": "until all has relaxed" if forecast.dwell is None else _text(forecast.dwell, "s"),
        "level": f"{forecast.level:.0%}",
    }


def _measured(one: Measured, unit: str) -> str:
    return _text(one.value, unit, uncertainty=one.uncertainty).replace("+-", "±")


def _text(value: float, unit: str, **more: Any) -> str:
    """Return a quantity as a page spells it."""
    return _spelled(readable(value, unit, **more))


def _spelled(text: str) -> str:
    return text.replace(" u", " µ").replace("/m2", "/m²")


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
