"""The operations ``forecast``, ``report`` and ``next-test``, from the study of a rate series."""

from itertools import product
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from viscotack.errors import InputError
from viscotack.units import parse

from .identify import Identified, IdentifyEdge, IdentifyRates, Series
from .options import csv_file, input_file, main_file, number, option, picture, text
from .parts.files import refusals
from .parts.record_words import read
from .parts.records import forecast_rows, interface_record
from .request import Answer, Caller, Request
from .simulate import HowLong

_MOST = 50  # speeds between two ends


_STUDY = "Study that `viscotack identify rates` writes."


def _speeds(words: str, default: Any = ()) -> Any:
    """Declare speeds: each one, or a range."""
    return text(words, metavar="SPEED|FROM..TO", to=_speeds_of, default=default)


def _speeds_of(value: Any) -> tuple[float, ...]:
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

    study: Path = input_file(_STUDY, "STUDY")
    speed: tuple[Any, ...] = _speeds(
        'Speed, "30 um/s", or range, "1 um/s..1 mm/s"; repeatable. Default: that of the series.'
    )
    preload: float | None = number("Preload; default: that of the series.", "N")
    temperature: float | None = number('Temperature, "40 degC"; default: that of the series.', "K")
    dwell: float | None = number(
        "Dwell under the preload; default: full relaxation. Needs --approach-speed.", "s"
    )
    approach_speed: float | None = number("Approach speed; needs --dwell.", "m/s")
    time_limit: HowLong = None

    def refuse_for(self, study: Series) -> None:
        """Refuse conditions that the fit of a study will not know."""
        for name in ("temperature", "dwell", "approach_speed"):
            if isinstance(study, IdentifyEdge) and getattr(self, name) is not None:
                why = "an edge law knows relaxed contacts at the temperature of its tests only"
                raise InputError(f"leave out `{name}`: {why}", field=name)

    def forecast(self, caller: Caller, *kinds: type[Series]) -> tuple[Identified, Any]:
        """Fit the interface to the files of the study; return it and the forecast."""
        from viscotack.clock import limited

        with limited(self.time_limit):
            found = fitted(self.study, caller, kinds, self)
            return found, self._of_fit(found.fit)

    def _of_fit(self, fit: Any) -> Any:
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
    outputs: ClassVar = (csv_file("Write a row for each speed."), picture())

    def answer(self, caller: Caller) -> Answer:
        """Fit the series of the study and forecast from it."""
        from viscotack.plot.interface import draw_rate_series

        found, forecast = self.forecast(caller, IdentifyRates, IdentifyEdge)
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

        found, forecast = self.forecast(caller, IdentifyRates)
        return Answer(
            (found, forecast),
            data=_record(found.fit, forecast, forecast_rows(forecast)),
            words={"words": [*found.fit.words, *forecast.words]},
            files={"output": page(found, forecast)},
            notes=refusals(found.survey),
        )


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


class NextTest(Request):
    """Rank tests by how much each narrows a forecast or the interface.

    Candidates are all combinations of --speed, --preload, --radius and --dwell. The posterior of
    the study gives the variance that each would leave, with the noise of the rig, before any is
    made. The wanted answer is the force at --forecast-speed; without it, work of adhesion and
    range. The answer also lists the best sequence of tests.

    Example: viscotack next-test study.toml --speed "0.1 um/s..10 mm/s" --preload "0.5 mN"
    --preload "5 mN" --forecast-speed "50 mm/s" --plot next.png
    """

    word: ClassVar = "next-test"
    outputs: ClassVar = (
        csv_file("Write a row for each test."),
        picture("Draw what each test leaves of the uncertainty."),
    )

    study: Path = input_file(_STUDY, "STUDY")
    speed: tuple[Any, ...] = _speeds(
        'Speed of a test, "30 um/s", or a range "1 um/s..1 mm/s"; can be repeated.', default=...
    )
    preload: tuple[float, ...] = number(
        "Preload of a test; repeatable. Default: that of the series.", "N", above=0, default=()
    )
    radius: tuple[float, ...] = number(
        "Sphere of a test; repeatable. Default: that of the series.", "m", above=0, default=()
    )
    dwell: tuple[float, ...] = number(
        "Dwell; repeatable. Default: full relaxation. Needs --approach-speed.", "s", default=()
    )
    approach_speed: float | None = number("Approach speed; needs --dwell.", "m/s", above=0)
    forecast_speed: tuple[Any, ...] = _speeds(
        "Speed of the wanted forecast, or a range; repeatable. Default: the interface is wanted."
    )
    forecast_preload: float | None = number("Preload of the wanted forecast.", "N", above=0)
    forecast_radius: float | None = number("Sphere radius of the wanted forecast.", "m", above=0)
    noise: float | None = number(
        'Relative standard deviation of a force, "3 %"; default: that of the series.', above=0
    )
    repeats: int = option("Repetitions of each test.", default=1, ge=1, le=1000)
    count: int = option("Length of the best sequence.", default=3, ge=1, le=20)
    time_limit: HowLong = None

    def answer(self, caller: Caller) -> Answer:
        """Fit the series of the study and rank the tests."""
        from viscotack.clock import limited
        from viscotack.identify import Trial, next_tests
        from viscotack.plot.interface import draw_next_tests

        speeds, wanted_speeds = (
            [v for some in given for v in some] for given in (self.speed, self.forecast_speed)
        )
        others = (x or (None,) for x in (self.preload, self.radius, self.dwell))
        candidates = [
            Trial(v, load, radius, dwell, self.approach_speed)
            for v, load, radius, dwell in product(speeds, *others)
        ]
        wanted = [Trial(v, self.forecast_preload, self.forecast_radius) for v in wanted_speeds]
        if not wanted and (self.forecast_preload or self.forecast_radius):
            raise InputError("the wanted forecast needs its speed, `forecast_speed`")
        with limited(self.time_limit):
            study = fitted(self.study, caller)
            how = self.values("noise", "repeats", "count")
            found = next_tests(study.fit, candidates, wanted=wanted, **how)
        rows = [_row(each) for each in found.ranked]
        record = {
            "now": found.now,
            "noise": found.noise,
            "tests": rows,
            "sequence": [_row(each) for each in found.sequence],
            "refused": [read(each, *_TRIAL) | {"why": why} for each, why in found.refused],
            "words": [*study.fit.words, *found.words],
        }
        return Answer(
            found,
            data=record,
            words=record | {"tests": rows[:_SHOWN]},
            files={"csv": rows},
            pictures={"plot": lambda: draw_next_tests(found)},
            notes=refusals(study.survey),
        )


# What a trial is, as columns.
_TRIAL = ("speed_m_per_s", "preload_N", "radius_m", "dwell_s", "approach_speed_m_per_s")
_SHOWN = 8  # tests in the text


def _row(one: Any) -> dict[str, Any]:
    """Return the row of a ranked test."""
    forecast = {"force_N": one.force, "force_deviation": one.uncertain, "left": one.left}
    return read(one.trial, *_TRIAL) | forecast
