"""The operations ``forecast`` and ``report``: forecasts of pull-off forces from a study."""

from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar

import numpy as np

from viscotack.errors import InputError
from viscotack.units import parse, readable

from .declare.answer import Answer, Caller, Output, csv_file, picture
from .declare.cards import FileOfNames, Number, Place, Placed, Text
from .declare.options import Operation, Part
from .declare.study import read_study
from .identify import IdentifyRates
from .parts.records import forecast_rows
from .parts.rig import refusals
from .simulate import HowLong

_MOST = 50  # speeds between two ends


StudyFile = Annotated[
    Placed,
    FileOfNames(
        "Study written by `viscotack identify rates ... -o study.toml`.",
        metavar="STUDY",
        argument=True,
    ),
]


@dataclass(frozen=True)
class Speeds(Text):
    """Option: a speed or a range of speeds; the value is a tuple of speeds [m/s]."""

    def read(self, value: Any, place: Place) -> tuple[float, ...]:
        """Return the speeds."""
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

    def written(self, value: Any) -> Any:
        """Return a speed with its unit; a range is written as its speeds."""
        return [f"{float(one)!r} m/s" for one in value]


@dataclass(frozen=True, kw_only=True)
class Wish(Part):
    """Speeds and conditions of a forecast."""

    table: ClassVar = "forecast"

    speed: Annotated[
        tuple[tuple[float, ...], ...],
        Speeds(
            'Retraction speed, "30 um/s", or a range, "1 um/s..1 mm/s"; can be repeated. Default: '
            "the range of the series.",
            metavar="SPEED|FROM..TO",
        ),
    ] = ()
    preload: Annotated[
        float | None,
        Number("Preload; default: that of the series.", unit="N", metavar="FORCE"),
    ] = None
    temperature: Annotated[
        float | None,
        Number(
            'Temperature, "40 degC"; default: that of the series. The passport provides the shift '
            "of the times.",
            unit="K",
            metavar="T",
        ),
    ] = None
    dwell: Annotated[
        float | None,
        Number(
            "Dwell time under the preload; default: full relaxation. Needs --approach-speed.",
            unit="s",
            metavar="TIME",
        ),
    ] = None
    approach_speed: Annotated[
        float | None, Number("Approach speed; needs --dwell.", unit="m/s", metavar="SPEED")
    ] = None

    def of(self, fit: Any) -> Any:
        """Compute the forecast from a fitted rate series."""
        from viscotack.identify import forecast_rates

        if self.speed:
            speed = np.concatenate([np.array(some) for some in self.speed])
        else:
            measured = [one.speed for one in fit.series]
            speed = np.geomspace(min(measured), max(measured), 25)
        return forecast_rates(
            fit,
            speed,
            preload=self.preload,
            temperature=self.temperature,
            dwell=self.dwell,
            approach_speed=self.approach_speed,
        )


@dataclass(frozen=True, kw_only=True)
class Forecast(Operation):
    """Forecast pull-off forces with a band, from a measured rate series.

    The interface is fitted to the files of the study. The band combines its posterior with the
    uncertainties of material and theory; it is narrow near measured speeds. It is that of the mean
    of many tests; where repeated tests show their scatter, the band of a single test follows.

    Example: viscotack forecast study.toml --speed "1 um/s..10 mm/s" --plot forecast.png
    """

    word: ClassVar = "forecast"
    outputs: ClassVar = (
        csv_file("Write a row for each speed; - is standard output."),
        picture(),
    )

    study: StudyFile
    wish: Wish = field(default_factory=Wish)
    time_limit: HowLong = None

    def answer(self, caller: Caller) -> Answer:
        """Fit the series of the study and forecast from it."""
        from viscotack.pictures.identify import draw_rate_series

        from .parts.tables import rows_as_csv

        found, forecast = _forecast(self, caller)
        rows = forecast_rows(forecast)
        return Answer(
            (found, forecast),
            record=lambda: _record(found.fit, forecast, rows),
            words=lambda: _words(found.fit, forecast, rows),
            files={"csv": rows_as_csv(rows)},
            pictures={"plot": lambda: draw_rate_series(found.fit, forecast)},
            notes=refusals(found.survey),
        )


@dataclass(frozen=True, kw_only=True)
class Report(Operation):
    """Write a report as a web page: curves, interface, forecast, method and references.

    The page is a single file and suited to printing.

    Example: viscotack report study.toml -o report.html
    """

    word: ClassVar = "report"
    outputs: ClassVar = (
        Output(
            "output",
            "The page, FILE.html.",
            flags=("-o", "--output"),
            needed=True,
            endings=(".html", ".htm"),
        ),
    )

    study: StudyFile
    wish: Wish = field(default_factory=Wish)
    time_limit: HowLong = None

    def answer(self, caller: Caller) -> Answer:
        """Fit, forecast and render the page."""
        from .parts.report import page
        from .parts.tables import as_text

        found, forecast = _forecast(self, caller)
        return Answer(
            (found, forecast),
            record=lambda: _record(found.fit, forecast, forecast_rows(forecast)),
            words=lambda: "\n".join([*found.fit.words, *forecast.words]),
            files={"output": as_text(lambda: page(found, forecast))},
            notes=refusals(found.survey),
        )


def _forecast(asked: Forecast | Report, caller: Caller) -> tuple[Any, Any]:
    """Fit the interface to the files of a study; return it and the forecast."""
    from viscotack.clock import limited

    with limited(asked.time_limit):
        found = fitted(asked.study, caller)
        return found, asked.wish.of(found.fit)


def fitted(study: Placed, caller: Caller) -> Any:
    """Fit the interface to the files of a study, with the forces of the file beside it."""
    from viscotack.identify.computed import SUFFIX
    from viscotack.identify.study import answer

    return answer(_asked(study).study(caller.also), study.path.with_suffix(SUFFIX))


def _asked(study: Placed) -> IdentifyRates:
    """Read a study, which must contain the operation `identify rates`."""
    word, place = IdentifyRates.word, study.place

    # the operation is checked before the options are read
    def known(found: str) -> type[Operation]:
        if found != word:
            raise InputError(f"its operation is {found}; a forecast needs a study of {word}")
        return IdentifyRates

    asked = read_study(study.path, known=known, also=place.also, place=place).operation
    assert isinstance(asked, IdentifyRates), "no other is known"
    return asked


def _record(fit: Any, forecast: Any, rows: list[dict[str, float]]) -> dict[str, Any]:
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


def _words(fit: Any, forecast: Any, rows: list[dict[str, float]]) -> str:
    lines = []
    for v, force, *ends in (row.values() for row in rows):
        pairs = zip(ends[::2], ends[1::2], strict=True)
        bands = "; ".join(f"{readable(low, 'N', to=high)}" for low, high in pairs)
        lines.append(f"  {readable(v, 'm/s')}: {readable(force, 'N')} ({bands})")
    single = "" if forecast.low_of_one is None else ", and of a single test"
    head = f"Pull-off forces, {forecast.level:.0%} band of their mean{single}"
    return "\n".join([head, *lines, *fit.words, *forecast.words])
