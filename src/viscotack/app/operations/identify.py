"""The operations ``identify ...``: fit the interface to measured curves."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, get_args

from pydantic import Field

from viscotack.errors import InputError

from .parts.layer import BONDED, THICKNESS, body_of
from .parts.rig import Rig, refusals
from .parts.solid import Solid, solid_of
from .request import Answer, Caller, Named, Number, Option, Output, picture
from .simulate import HowLong

if TYPE_CHECKING:
    from viscotack.files.whole import Target
    from viscotack.identify.computed import Computed
    from viscotack.identify.study import Study

Model = Literal["jkr", "dmt", "maugis", "carpick"]
Radius = Annotated[float, Number('Sphere radius, "5.19 mm".', unit="m", example='"5.19 mm"')]
Level = Annotated[float, Number("Confidence level of the intervals.")]


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
    cycle: Annotated[
        int, Option("Number of the cycle in the files, from 1."), Field(ge=1, le=10**6)
    ] = 1
    model: Annotated[tuple[Model, ...], Option("Models to compare; default: all four.")] = ()
    against: Annotated[
        Literal["radius", "depth"] | None,
        Option("Abscissa: contact radius or depth; default: the radius if the file contains it."),
    ] = None
    contact_modulus: Annotated[
        float | None,
        Number(
            'Known E0* of the relaxed solid, "1.94 MPa"; default: that of --material if its '
            "uncertainty is known, else fitted.",
            unit="Pa",
        ),
    ] = None
    contact_modulus_uncertainty: Annotated[
        float | None, Number("Its standard uncertainty; needed with it.", unit="Pa")
    ] = None
    material: Annotated[
        Any,
        Named(
            "Passport or published name of the solid, to check that the test was slow; default: "
            "not checked.",
            metavar="PASSPORT",
        ),
    ] = None
    level: Level = 0.9

    def answer(self, caller: Caller) -> Answer:
        """Fit the elastic models to one cycle."""
        from viscotack.identify import fitted_force, identify_slow, slow_test
        from viscotack.plot.interface import draw_slow_test

        from .parts.json_data import drawn
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
        return Answer(
            fit,
            record=lambda: slow_record(fit),
            words=lambda: _slow_shown(slow_record(fit)),
            pictures={"plot": lambda: draw_slow_test(fit)},
            drawn=lambda: {
                "measured": {"at": drawn(test.at), "force": drawn(test.force)},
                "fitted": {"at": drawn(test.at), "force": drawn(fitted_force(fit.best, test))},
            },
            notes=refusals(found),
        )


class IdentifyRates(Rig):
    """Identify work of adhesion and range of attraction from pull-offs at several speeds.

    The steady-crack contact model is fitted to the true speed and pull-off force of every cycle;
    forces of tests for which it does not hold are simulated.
    The intervals include the uncertainty of the material in the passport. The answer states which
    parameters the data do not determine, and at which speeds the model does not fit. With --growth
    an interface that grows with speed is fitted. A sample of known thickness is given by
    --thickness, with --bonded if it does not slide; its tests need a stiff machine, and neither
    --curves nor --growth.

    Example: viscotack identify rates lens_*.csv --material pdms-10-1 --radius "5.19 mm"
    -o study.toml
    """

    word: ClassVar = "identify rates"
    outputs: ClassVar = (
        Output(
            "output",
            "Write the study, for `viscotack forecast` and `viscotack report`.",
            flags=("-o", "--output"),
            metavar="STUDY",
            endings=(".toml",),
        ),
        picture(),
        picture("Draw the posterior of the interface.", "corner"),
    )

    material: Solid
    radius: Radius
    thickness: Annotated[float | None, THICKNESS] = None
    bonded: Annotated[float | None, BONDED] = None
    preload: Annotated[
        float | None,
        Number(
            'Preload of the relaxed contact, "1.5 mN"; default: the force at the start of '
            "retraction.",
            unit="N",
        ),
    ] = None
    work_of_adhesion: Annotated[
        float | None,
        Number(
            'Work of adhesion known from a slow test, "152 mJ/m2"; default: fitted.', unit="J/m^2"
        ),
    ] = None
    work_of_adhesion_uncertainty: Annotated[
        float | None, Number("Its standard uncertainty; needed with it.", unit="J/m^2")
    ] = None
    temperature: Annotated[
        float | None,
        Number(
            'Temperature of all tests, "25 degC"; default: that in each file, else that of the '
            "passport.",
            unit="K",
        ),
    ] = None
    temperature_uncertainty: Annotated[
        float | None,
        Number(
            'Standard uncertainty of this temperature, "0.5 K"; default: 2 K. It changes the times '
            "of the material by the shift of the passport.",
            unit="K",
        ),
    ] = None
    curves: Annotated[
        bool,
        Option("Fit whole curves by their travel between forces; one speed is then sufficient."),
    ] = False
    growth: Annotated[
        bool,
        Option(
            "Fit an interface that grows with the opening speed: amount, exponent, significance. "
            "Takes 1 to 2 minutes."
        ),
    ] = False
    history: Annotated[
        bool,
        Option(
            "Compute the forces with approach and dwell of each test, mostly by simulation; "
            "default: contacts relaxed under the preload."
        ),
    ] = False
    scatter: Annotated[
        float,
        Number(
            'Relative scatter of the force between tests, "3 %", if there are no repeated tests.'
        ),
    ] = 0.0
    level: Level = 0.9
    time_limit: HowLong = None
    title: Annotated[str, Option("Title of the report.")] = ""
    notes: Annotated[str, Option("Notes for the report.")] = ""

    def check(self) -> None:
        """Refuse options that exclude each other."""
        body_of(self.thickness, self.bonded)

    def study(self, caller: Caller) -> "Study":
        """Convert the options to a study for :func:`viscotack.identify.study.answer`."""
        from viscotack.identify.study import Study

        return Study(
            files=tuple(caller.file(each) for each in self.files),
            material=solid_of(self.material, caller),
            radius=self.radius,
            body=body_of(self.thickness, self.bonded),
            preload=self.preload,
            temperature=self.temperature,
            temperature_uncertainty=self.temperature_uncertainty,
            work_of_adhesion=self.known("work_of_adhesion"),
            curves=self.curves,
            growth=self.growth,
            history=self.history,
            scatter=self.scatter,
            level=self.level,
            reading=self.reading,
            evaluation=self.evaluation,
            title=self.title,
            notes=self.notes,
        )

    def answer(self, caller: Caller) -> Answer:
        """Fit the interface to the rate series."""
        from viscotack.clock import limited
        from viscotack.identify import posterior
        from viscotack.identify.study import answer
        from viscotack.plot.interface import draw_posterior, draw_rate_series

        from .parts.records import rates_record

        with limited(self.time_limit):
            found = answer(self.study(caller))
        fit = found.fit
        return Answer(
            found,
            record=lambda: rates_record(fit),
            words=lambda: {n: x for n, x in rates_record(fit).items() if n not in _SAID},
            files={"output": self._written(found.computed, caller)},
            pictures={
                "plot": lambda: draw_rate_series(fit),
                "corner": lambda: draw_posterior(
                    posterior(fit.objective, fit.best, others=fit.solutions[1:]), fit
                ),
            },
            notes=refusals(found.survey),
        )

    def _written(self, computed: "Computed", caller: Caller) -> Callable[["Target"], None]:
        """Return a function that writes the study, and beside it the forces for a forecast."""
        from viscotack.files.whole import is_standard_output, write_whole
        from viscotack.identify.computed import SUFFIX

        from .study import study_text

        def write(target: "Target") -> None:
            if not isinstance(target, str | os.PathLike) or is_standard_output(target):
                write_whole(target, study_text(self, caller.folder).encode())
                return
            file = Path(target)
            write_whole(file, study_text(self, file.parent).encode())
            computed.write(file.with_suffix(SUFFIX))

        return write


# What the sentences of a fitted series say.
_SAID = ("work_of_adhesion_J_m2", "equilibrium_gap_m", "intervals", "solutions", "describes_tests")


def _slow_shown(record: dict[str, Any]) -> dict[str, Any]:
    """Return what the text says of a record: the interval is in the sentences."""
    fits = [{n: x for n, x in fit.items() if n != "intervals"} for fit in record["fits"]]
    shown = {name: record[name] for name in ("words", "against", "points", "evidence")}
    return shown | {"fits": fits}
