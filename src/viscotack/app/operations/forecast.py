"""The operations ``forecast`` and ``report``: forecasts of pull-off forces from a study."""

from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np

from viscotack.errors import InputError
from viscotack.units import parse

from .identify import Identified, IdentifyEdge, IdentifyRates, Series
from .options import File, csv_file, main_file, number, picture, text
from .parts.record_words import read
from .parts.records import forecast_rows, interface_record
from .parts.rig import refusals
from .request import Answer, Caller, Request
from .simulate import HowLong

_MOST = 50  # speeds between two ends


StudyFile = Annotated[
    Path,
    File(
        "Study written by `viscotack identify rates ... -o study.toml`.",
        metavar="STUDY",
        argument=True,
    ),
]


def speeds_of(value: Any) -> tuple[float, ...]:
    """Return the speeds [m/s] of an option: one, or a range."""
    if isinstance(value, list | tuple):
        return tuple(parse(one, "m/s") for one in value)
    first, dots, last = value.partition("..") if isinstance(value, str) else (value, "", "")
    if not dots:
        return (parse(first, "m/s"),)
    low, high = parse(first, "m/s"), parse(last, "m/s")
    if not 0 < low < high:
        raise InputError(f"{value}: a range needs two positive speeds, the smaller one first")
    count = min(_MOST, 1 + round(8 * (np.log10(high) - np.log10(low))))
    return tuple(np.geomspace(low, high, max(count, 2)).tolist())


class Wish(Request):
    """A forecast from a study at some speeds and conditions."""

    study: StudyFile

    speed: tuple[Any, ...] = text(
        'Retraction speed, "30 um/s", or a range, "1 um/s..1 mm/s"; can be repeated. Default: '
        "the range of the series.",
        metavar="SPEED|FROM..TO",
        to=speeds_of,
        default=(),
    )
    preload: float | None = number("Preload; default: that of the series.", "N")
    temperature: float | None = number(
        'Temperature, "40 degC"; default: that of the series. The passport provides the shift '
        "of the times.",
        "K",
    )
    dwell: float | None = number(
        "Dwell time under the preload; default: full relaxation. Needs --approach-speed.", "s"
    )
    approach_speed: float | None = number("Approach speed; needs --dwell.", "m/s")
    time_limit: HowLong = None

    def refuse_for(self, study: Series) -> None:
        """Refuse conditions that the fit of a study will not know."""
        for name in ("temperature", "dwell", "approach_speed"):
            if isinstance(study, IdentifyEdge) and getattr(self, name) is not None:
                raise InputError(
                    f"leave out `{name}`: an edge law knows relaxed contacts at the "
                    "temperature of its tests only",
                    field=name,
                )

    def of_fit(self, fit: Any) -> Any:
        """Compute the forecast from a fitted rate series."""
        from viscotack.identify import EdgeFit, forecast_edge, forecast_rates

        if self.speed:
            speed = np.concatenate([np.array(some) for some in self.speed])
        else:
            measured = [one.speed for one in fit.series]
            speed = np.geomspace(min(measured), max(measured), 25)
        if isinstance(fit, EdgeFit):
            return forecast_edge(fit, speed, preload=self.preload)
        conditions = self.values("preload", "temperature", "dwell", "approach_speed")
        return forecast_rates(fit, speed, **conditions)


class Forecast(Wish):
    """Forecast pull-off forces with a band, from a measured rate series.

    The interface, or the edge law of `identify edge`, is fitted to the files of the study. The
    band combines its posterior with the uncertainties of material and theory; it is narrow near
    measured speeds. It is that of the mean of many tests; where repeated tests show their scatter,
    the band of a single test follows.

    Example: viscotack forecast study.toml --speed "1 um/s..10 mm/s" --plot forecast.png
    """

    word: ClassVar = "forecast"
    outputs: ClassVar = (
        csv_file("Write a row for each speed."),
        picture(),
    )

    def answer(self, caller: Caller) -> Answer:
        """Fit the series of the study and forecast from it."""
        from viscotack.plot.interface import draw_rate_series

        found, forecast = _forecast(self, caller, IdentifyRates, IdentifyEdge)
        rows = forecast_rows(forecast)
        return Answer(
            (found, forecast),
            data=_record(found.fit, forecast, rows),
            files={"csv": rows},
            pictures={"plot": lambda: draw_rate_series(found.fit, forecast)},
            notes=refusals(found.survey),
        )


class Report(Wish):
    """Write a report as a web page: curves, interface, forecast, method and references.

    The page is a single file and suited to printing.

    Example: viscotack report study.toml -o report.html
    """

    word: ClassVar = "report"
    outputs: ClassVar = (main_file("The page, FILE.html.", ".html", ".htm", needed=True),)

    def answer(self, caller: Caller) -> Answer:
        """Fit, forecast and render the page."""
        from .parts.report import page

        found, forecast = _forecast(self, caller, IdentifyRates)
        return Answer(
            (found, forecast),
            data=_record(found.fit, forecast, forecast_rows(forecast)),
            words={"words": [*found.fit.words, *forecast.words]},
            files={"output": page(found, forecast)},
            notes=refusals(found.survey),
        )


def _forecast(
    asked: Forecast | Report, caller: Caller, *kinds: type[Series]
) -> tuple[Identified, Any]:
    """Fit the interface to the files of a study; return it and the forecast."""
    from viscotack.clock import limited

    with limited(asked.time_limit):
        found = fitted(asked.study, caller, kinds, asked)
        return found, asked.of_fit(found.fit)


def fitted(
    study: Path,
    caller: Caller,
    kinds: tuple[type[Series], ...] = (IdentifyRates,),
    wish: Wish | None = None,
) -> Identified:
    """Make the fit of a study, one of the kinds, with the forces of the file beside it."""
    from viscotack.identify.computed import SUFFIX

    from .study import read_study

    path = caller.file(study)
    asked = read_study(path, *(kind.word for kind in kinds)).request
    assert isinstance(asked, IdentifyRates | IdentifyEdge), "no other has these words"
    if wish is not None:
        wish.refuse_for(asked)
    return asked.identified(caller.within(path), path.with_suffix(SUFFIX))


def _record(fit: Any, forecast: Any, rows: list[dict[str, float]]) -> dict[str, Any]:
    return {
        **interface_record(fit),
        **read(fit, "describes_tests"),
        **read(forecast, "level", "preload_N", "temperature_K", "dwell_s"),
        "forecast": rows,
        "words": [*fit.words, *forecast.words],
    }
