"""The operation ``next-test``: which test narrows a forecast or the interface most."""

from itertools import product
from typing import Any, ClassVar

from viscotack.errors import InputError

from .forecast import StudyFile, fitted, speeds_of
from .options import csv_file, number, option, picture, text
from .parts.record_words import read
from .parts.rig import refusals
from .request import Answer, Caller, Request
from .simulate import HowLong


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

    study: StudyFile
    speed: tuple[Any, ...] = text(
        'Speeds of the tests, "30 um/s" or a range "1 um/s..1 mm/s"; can be repeated.',
        metavar="SPEED|FROM..TO",
        to=speeds_of,
        default=...,
    )
    preload: tuple[float, ...] = number(
        "Preload of a test; can be repeated. Default: that of the series.",
        "N",
        above=0,
        default=(),
    )
    radius: tuple[float, ...] = number(
        "Sphere radius of a test; can be repeated. Default: that of the series.",
        "m",
        above=0,
        default=(),
    )
    dwell: tuple[float, ...] = number(
        "Dwell time under the preload; can be repeated. Default: full relaxation. Needs "
        "--approach-speed.",
        "s",
        default=(),
    )
    approach_speed: float | None = number("Approach speed; needs --dwell.", "m/s", above=0)
    forecast_speed: tuple[Any, ...] = text(
        "Speed of the wanted forecast, or a range; can be repeated. Default: the interface "
        "is wanted.",
        metavar="SPEED|FROM..TO",
        to=speeds_of,
        default=(),
    )
    forecast_preload: float | None = number("Preload of the wanted forecast.", "N", above=0)
    forecast_radius: float | None = number("Sphere radius of the wanted forecast.", "m", above=0)
    noise: float | None = number(
        'Relative standard deviation of the force of one test, "3 %"; default: that of the series.',
        above=0,
    )
    repeats: int = option("Repetitions of each test.", default=1, ge=1, le=1000)
    count: int = option("Length of the best sequence.", default=3, ge=1, le=20)
    time_limit: HowLong = None

    def answer(self, caller: Caller) -> Answer:
        """Fit the series of the study and rank the tests."""
        from viscotack.clock import limited
        from viscotack.identify import Trial, next_tests
        from viscotack.identify.ranked_tests import INTERFACE
        from viscotack.plot.interface import draw_next_tests

        candidates = [
            Trial(v, load, radius, dwell, self.approach_speed)
            for v, load, radius, dwell in product(
                [v for some in self.speed for v in some],
                self.preload or (None,),
                self.radius or (None,),
                self.dwell or (None,),
            )
        ]
        wanted = [
            Trial(v, self.forecast_preload, self.forecast_radius)
            for some in self.forecast_speed
            for v in some
        ]
        if not wanted and (self.forecast_preload or self.forecast_radius):
            raise InputError("the wanted forecast needs its speed, `forecast_speed`")
        with limited(self.time_limit):
            study = fitted(self.study, caller)
            found = next_tests(
                study.fit,
                candidates,
                wanted=wanted or INTERFACE,
                **self.values("noise", "repeats", "count"),
            )
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
