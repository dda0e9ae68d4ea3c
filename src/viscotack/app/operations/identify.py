"""The operations ``identify ...``: fit the interface to measured curves."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, get_args

from viscotack.errors import InputError

from .options import Number, csv_file, main_file, named, number, option, picture, switch
from .parts.files import Rig, refusals
from .parts.record_words import estimates, read
from .parts.solid import OnLayer, Solid, solid_of
from .request import Answer, Caller, Request
from .simulate import HowLong

if TYPE_CHECKING:
    from viscotack.files.whole import Target

Model = Literal["jkr", "dmt", "maugis", "carpick"]
Radius = Annotated[float, Number('Sphere radius, "5.19 mm".', unit="m", example='"5.19 mm"')]
Level = Annotated[float, Number("Confidence level of the intervals.")]
Uncertainty = Annotated[
    float | None, Number("Its standard uncertainty; needed with it.", unit="Pa")
]


class IdentifySlow(Rig):
    """Identify work of adhesion and Tabor number from one slow retraction of a sphere.

    JKR, DMT, Maugis and Carpick are fitted to force against contact radius (from a camera) or
    against depth, and compared by an information criterion; intervals are profile likelihoods.
    The answer states which parameters the data do not determine, and gives the work by each model
    that they do not distinguish. If the test is not slow, the work is an upper bound, with the
    reason; with --material the test is compared with the force that `viscotack advise` gives for
    it.

    Example: viscotack identify slow lens_1um_s.csv --radius "5.19 mm"
    --contact-modulus "1.94 MPa" --contact-modulus-uncertainty "0.06 MPa" --plot slow.png
    """

    word: ClassVar = "identify slow"
    outputs: ClassVar = (picture(),)

    radius: Radius
    cycle: int = option("Number of the cycle in the files, from 1.", default=1, ge=1, le=10**6)
    model: tuple[Model, ...] = option("Models to compare; default: all four.", default=())
    against: Literal["radius", "depth"] | None = option(
        "Abscissa; default: the contact radius if the file contains it."
    )
    contact_modulus: float | None = number(
        'Known E0* of the relaxed solid, "1.94 MPa"; default: by --material, else fitted.', "Pa"
    )
    contact_modulus_uncertainty: Uncertainty = None
    material: Any = named("The solid, to check that the test was slow.")
    level: Level = 0.9

    def answer(self, caller: Caller) -> Answer:
        """Fit the elastic models to one cycle."""
        from viscotack.identify import identify_slow, slow_test
        from viscotack.plot.interface import draw_slow_test

        from .parts.records import slow_record

        found = self.survey(caller)
        if not 1 <= self.cycle <= len(found.cycles):
            raise InputError(
                f"cycle must be 1 to {len(found.cycles)}, got {self.cycle}", field="cycle"
            )
        test = slow_test(found.cycles[self.cycle - 1], self.radius, self.against)
        fit = identify_slow(
            test,
            models=self.model or get_args(Model),
            contact_modulus=self.known("contact_modulus"),
            material=None if self.material is None else solid_of(self.material, caller),
            level=self.level,
        )
        record = slow_record(fit)
        fits = [{n: x for n, x in one.items() if n != "intervals"} for one in record["fits"]]
        shown = {name: record[name] for name in ("words", "against", "points", "evidence")}
        return Answer(
            fit,
            data=record,
            words=shown | {"fits": fits},  # the intervals are in the sentences
            pictures={"plot": lambda: draw_slow_test(fit)},
            notes=refusals(found),
        )


class Series(Rig):
    """Files of a rig that are one rate series."""

    section: ClassVar = Request.section

    radius: Radius
    preload: float | None = number(
        'Preload, "1.5 mN"; default: the force at the start of retraction.', "N"
    )
    work_of_adhesion: float | None = number(
        'Known from a slow test, "152 mJ/m2"; default: fitted.', "J/m^2"
    )
    work_of_adhesion_uncertainty: float | None = number(
        "Its standard uncertainty; needed with it.", "J/m^2"
    )
    scatter: float = number(
        'Relative scatter of the force, "3 %", if there are no repeated tests.', default=0.0
    )
    level: Level = 0.9

    @property
    def given(self) -> dict[str, Any]:
        """Keywords of :func:`viscotack.identify.rate_series.series_of` for any model."""
        names = ("radius", "preload", "scatter", "level", "compliance", "compliance_uncertainty")
        return self.values(*names) | {"work_of_adhesion": self.known("work_of_adhesion")}


@dataclass(frozen=True, eq=False)
class Identified:
    """Evaluated files of a rig and what was fitted to them.

    Attributes
    ----------
    survey : Survey
        The files.
    fit : RateSeriesFit or EdgeFit
        The fit.
    asked : Series
        The request.
    computed : Computed or None
        Forces computed for the fit.
    """

    survey: Any
    fit: Any
    asked: Any
    computed: Any = None


class IdentifyRates(Series, OnLayer):
    """Identify work of adhesion and range of attraction from pull-offs at several speeds.

    The steady-crack contact model is fitted to the true speed and pull-off force of every cycle;
    forces of tests for which it does not hold are simulated.
    The intervals include the uncertainty of the material in the passport. The answer states which
    parameters the data do not determine, and which tests the model does not fit. Where tests at one
    speed have several dwells, the growth with contact time is fitted too. With --growth
    an interface that grows with speed is fitted. A sample of known thickness is given by
    --thickness, with --bonded if it does not slide; its tests need a stiff machine, and neither
    --curves nor --growth.

    Example: viscotack identify rates lens_*.csv --material pdms-10-1 --radius "5.19 mm"
    -o study.toml
    """

    word: ClassVar = "identify rates"
    outputs: ClassVar = (
        main_file("Write the study, for forecast and report.", ".toml"),
        picture(),
        picture("Draw the posterior of the interface.", "corner"),
    )

    material: Solid
    temperature: float | None = number(
        'Of all tests, "25 degC"; default: that in each file, else of the passport.', "K"
    )
    temperature_uncertainty: float | None = number(
        'Its standard uncertainty, "0.5 K", which shifts the times; default: 2 K.', "K"
    )
    curves: bool = switch("Fit whole curves by their travel between forces; one speed suffices.")
    growth: bool = switch("Fit an interface that grows with the opening speed (minutes).")
    history: bool = switch(
        "Compute the forces with approach and dwell of each test, mostly by simulation; "
        "default: contacts relaxed under the preload."
    )
    time_limit: HowLong = None
    title: str = option("Title of the report.", default="")
    notes: str = option("Notes for the report.", default="")

    def identified(self, caller: Caller, kept: Path | None = None) -> Identified:
        """Read the files and fit the interface.

        Forces that an earlier identification computed are read from the file `kept`, and new ones
        are written to it.
        """
        from viscotack.identify import identify_rates
        from viscotack.identify.computed import Computed
        from viscotack.identify.rate_series import series_of
        from viscotack.model.materials.passport import Passport

        solid = solid_of(self.material, caller)
        if self.temperature is not None:
            if not isinstance(solid, Passport):
                raise InputError(
                    "`temperature` needs a material with a passport, which contains the shift of "
                    "its times; omit it",
                    field="temperature",
                )
            solid = solid.moved_to(self.temperature)
        found = self.survey(caller)
        names = ("temperature", "temperature_uncertainty", "curves", "growth", "history")
        how = self.given | self.values(*names)
        series = series_of(found, solid, body=self.body, bounded=True, **how)
        computed = Computed() if kept is None else Computed.read(kept)
        fit = identify_rates(series, computed=computed)
        if kept is not None:
            computed.write(kept)
        return Identified(found, fit, self, computed)

    def answer(self, caller: Caller) -> Answer:
        """Fit the interface to the rate series."""
        from viscotack.clock import limited

        from .parts.records import rates_record

        with limited(self.time_limit):
            found = self.identified(caller)
        return _answer(found, rates_record, caller)


class IdentifyEdge(Series):
    """Identify the plain edge law from pull-offs at several speeds, without a dynamic test.

    An elastic sphere contact (JKR) whose edge takes the energy w (1 + (v/v0)^n) at its speed v is
    fitted to the true speed and pull-off force of every cycle, in a second. The law does not
    separate the losses of the solid from those of the interface, and holds near the measured
    speeds: a forecast ends ten times beyond them.

    Example: viscotack identify edge tack_*.csv --radius "5 mm" --contact-modulus "2 MPa"
    -o edge.toml
    """

    word: ClassVar = "identify edge"
    outputs: ClassVar = (
        main_file("Write the study, for forecast.", ".toml"),
        picture(),
        picture("Draw the posterior of the law.", "corner"),
    )

    contact_modulus: float = number(
        'E* at rest, "2 MPa"; forecasts with a stiff rig do not depend on it.',
        "Pa",
        above=0,
        example='"2 MPa"',
        default=...,
    )

    def identified(self, caller: Caller, kept: Path | None = None) -> Identified:
        """Read the files and fit the law; no forces are kept."""
        from viscotack.identify import identify_edge
        from viscotack.identify.rate_series import series_of
        from viscotack.model.materials import Elastic

        found = self.survey(caller)
        # of the solid only the contact modulus counts, here with a Poisson ratio of 0.5
        solid = Elastic(rubbery_modulus=0.75 * self.contact_modulus, poisson_ratio=0.5)
        return Identified(found, identify_edge(series_of(found, solid, **self.given)), self)

    def answer(self, caller: Caller) -> Answer:
        """Fit the law to the rate series."""
        from .parts.records import edge_record

        found = self.identified(caller)
        return _answer(found, edge_record, caller)


def _answer(
    found: Identified, record_of: Callable[[Any], dict[str, Any]], caller: Caller
) -> Answer:
    """Return the answer of a fitted series."""
    from viscotack.plot.interface import draw_posterior, draw_rate_series

    fit = found.fit
    return Answer(
        found,
        data=record_of(fit),
        words={n: x for n, x in record_of(fit).items() if n not in _SAID},
        files={"output": _written(found, caller)},
        pictures={
            "plot": lambda: draw_rate_series(fit),
            "corner": lambda: draw_posterior(fit.sampled(), fit),
        },
        notes=refusals(found.survey),
    )


def _written(found: Identified, caller: Caller) -> Callable[["Target"], None]:
    """Return a function that writes the study, and beside it the forces for a forecast."""
    from viscotack.files.whole import is_standard_output, write_whole
    from viscotack.identify.computed import SUFFIX

    from .study import study_text

    def write(target: "Target") -> None:
        if not isinstance(target, str | os.PathLike) or is_standard_output(target):
            write_whole(target, study_text(found.asked, caller.folder).encode())
            return
        file = Path(target)
        write_whole(file, study_text(found.asked, file.parent).encode())
        if found.computed is not None:
            found.computed.write(file.with_suffix(SUFFIX))

    return write


# What the sentences of a fitted series say.
_SAID = ("work_of_adhesion_J_m2", "equilibrium_gap_m", "reference_speed_m_s", "exponent")
_SAID += ("intervals", "solutions", "describes_tests", "criterion", "criterion_of_edge_law")
_SAID += ("ageing",)


class IdentifyApproach(Rig):
    """Bound the range of attraction by the approach, before the jump into contact.

    Every cycle with an approach gives an upper bound of h0 and, where an attraction is seen before
    the jump-in, an interval. The compliance of the rig is that of its spring: it decides where the
    contact jumps. The work of adhesion lies between that of the jump-in and that of the pull-off,
    unless it is given. An interface whose fitted range (`viscotack identify rates`) exceeds the
    bound has a fitted length of the crack's zone, not a range of attraction.

    Example: viscotack identify approach sphere_*.csv --radius "7.5 um" --contact-modulus "1.9 MPa"
    --compliance "332 mm/N"
    """

    word: ClassVar = "identify approach"

    radius: Radius
    contact_modulus: float | None = number(
        'E0* of the relaxed solid, "1.9 MPa"; default: that of --material.', "Pa"
    )
    material: Any = named("The solid, instead of --contact-modulus.")
    work_of_adhesion: float | None = number(
        'Known work, "50 mJ/m2"; default: between jump-in and pull-off.', "J/m^2"
    )
    level: Level = 0.9

    def answer(self, caller: Caller) -> Answer:
        """Bound the range by every approach."""
        from viscotack.identify import identify_approach
        from viscotack.identify.approach import of_every
        from viscotack.model.materials.passport import Passport

        modulus, instantaneous = self.contact_modulus, None
        if (modulus is None) == (self.material is None):
            raise InputError("give either contact_modulus or material", field="contact_modulus")
        if modulus is None:
            solid = Passport.of(solid_of(self.material, caller)).material
            modulus = solid.contact_modulus
            instantaneous = modulus / solid.modulus_ratio
        survey = self.survey(caller)
        case = self.values("radius", "work_of_adhesion", "level")
        case |= {"contact_modulus": modulus, "instantaneous": instantaneous}
        fits, refused = of_every(survey.cycles, lambda cycle: identify_approach(cycle, **case))
        if not fits:
            raise InputError("; ".join(refused), field="files")
        names = ("bound_m", "level", "attraction_N", "noise_N", "jump_in_force_N", "step_m")
        paths = {"equilibrium_gap_m": "likely", "works_of_adhesion_J_m2": "works"}
        rows = [read(fit, *names, "words", **paths, samples_during_jump="during") for fit in fits]
        for row, fit in zip(rows, fits, strict=True):
            found = fit.equilibrium_gap
            row["interval_m"] = None if found is None else [found.low, found.high]
        notes = (*refusals(survey), *(f"refused: {why}" for why in refused))
        return Answer(fits, data={"approaches": rows}, notes=notes)


class IdentifyCurves(Rig):
    """Fit JKR or DMT to every retraction: work of adhesion, contact modulus and their scatter.

    For a folder of force curves, hundreds if need be: each curve gives the work of adhesion and the
    contact modulus with the standard error of its fit, each temperature and speed their means,
    standard deviations and intervals between the curves. A work that grows with speed contains
    losses of the solid and is an upper bound; `viscotack identify slow` examines one curve.

    Example: viscotack identify curves curves --radius "7.5 um" --plot curves.png
    """

    word: ClassVar = "identify curves"
    outputs: ClassVar = (
        csv_file("Write a row for each curve."),
        csv_file("Write a row for each temperature and speed.", "repeats"),
        picture(),
    )

    radius: Radius
    model: Literal["jkr", "dmt"] = option(
        "jkr for soft and large spheres, dmt for stiff and small ones.", default="jkr"
    )
    contact_modulus: float | None = number(
        'Known E0* of the relaxed solid, "1.94 MPa"; default: fitted.', "Pa"
    )
    contact_modulus_uncertainty: Uncertainty = None
    level: Level = 0.9

    def answer(self, caller: Caller) -> Answer:
        """Fit the curves one by one."""
        from viscotack.identify import fit_curves, group_curves
        from viscotack.plot.interface import draw_curves

        survey = self.survey(caller)
        fits, refused = fit_curves(
            survey.cycles,
            contact_modulus=self.known("contact_modulus"),
            **self.values("radius", "model"),
        )
        if not fits:
            raise InputError("; ".join(refused), field="files")
        groups = group_curves(fits, self.level)
        rows, means = [_curve(fit) for fit in fits], [_group(group) for group in groups]
        record = {**self.values("model", "level"), "curves": rows, "repeats": means}
        return Answer(
            groups,
            data=record | {"refused": refused},
            words={"model": self.model, "repeats": means},
            files={"csv": rows, "repeats": means},
            pictures={"plot": lambda: draw_curves(groups)},
            notes=(*refusals(survey), *(f"refused: {why}" for why in refused)),
        )


def _curve(fit: Any) -> dict[str, Any]:
    row = read(fit.cycle, file="source.path", cycle="number", speed_m_s="speed.value")
    row["pull_off_force_N"] = fit.cycle.pull_off_force.value
    row |= estimates(fit, "work_of_adhesion_J_m2", "contact_modulus_Pa")
    return row | {"scatter_N": fit.scatter, "temperature_K": fit.cycle.temperature}


def _group(group: Any) -> dict[str, Any]:
    row: dict[str, Any] = {"speed_m_s": group.speed, "curves": len(group.curves)}
    units = {"work_of_adhesion": "J_m2", "contact_modulus": "Pa", "pull_off_force": "N"}
    for name, unit in units.items():
        ends = {f"{name}_{unit}_mean": "value", f"{name}_{unit}_standard_deviation": "deviation"}
        ends |= {f"{name}_low_{unit}": "low", f"{name}_high_{unit}": "high"}
        row |= read(getattr(group, name), **ends)
    return row | {"temperature_K": group.temperature}


class IdentifyDwell(Rig):
    """Identify the growth of the work of adhesion with contact time, from tests of several dwells.

    All tests are slow pulls of one sphere at one speed, so that the solid is relaxed and the force
    of the pull-off is proportional to the work of adhesion (JKR). The answer states the work, its
    growth in a decade of contact time and, if the data determine it, the law that an interface file
    takes. A solid whose modulus relaxes between the dwells is refused. Tests of several speeds go
    to `viscotack identify rates` or `viscotack identify edge`.

    Example: viscotack identify dwell lens_dwell_*.csv --material pdms-10-1 --radius "5.19 mm"
    --plot dwell.png
    """

    word: ClassVar = "identify dwell"
    outputs: ClassVar = (picture("Draw force by contact time."),)

    material: Solid
    radius: Radius
    level: Level = 0.9

    def answer(self, caller: Caller) -> Answer:
        """Fit the growth to the pull-off forces of all cycles."""
        from viscotack.identify.contact_time import check_relaxed, identify_dwell, tests_by_dwell
        from viscotack.model.materials.passport import Passport
        from viscotack.plot.interface import draw_dwells

        found = self.survey(caller)
        times, forces, uncertainty = tests_by_dwell(found.cycles)
        solid = Passport.of(solid_of(self.material, caller))
        solid.refuse_liquid("its contacts do not relax, so that the growth is not identified")
        check_relaxed(solid.material, times)
        fit = identify_dwell(
            times, forces, radius=self.radius, uncertainty=uncertainty, level=self.level
        )
        tails = {"work_of_adhesion": "_J_m2", "reference_time": "_s"}
        record = {
            **read(fit, "times_s", "forces_N", "work_of_adhesion_J_m2", "growth_per_decade"),
            "growth_interval": fit.interval,
            **read(fit, "level", "scatter", "law", "words"),
            "interface": {f"{name}{tails.get(name, '')}": x for name, x in fit.parameters.items()},
            "reference_time_interval_s": fit.reference_time,
        }
        return Answer(
            fit,
            data=record,
            pictures={"plot": lambda: draw_dwells(fit)},
            notes=refusals(found),
        )
