"""The operation ``identify dwell``: growth of the work of adhesion with contact time."""

from typing import Any, ClassVar

from .identify import Level, Radius
from .options import picture
from .parts.record_words import read
from .parts.rig import Rig, refusals
from .parts.solid import Solid, solid_of
from .request import Answer, Caller


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
        return Answer(
            fit,
            data=lambda: _record(fit),
            pictures={"plot": lambda: draw_dwells(fit)},
            notes=refusals(found),
        )


def _record(fit: Any) -> dict[str, Any]:
    """Return the numbers of the answer."""
    tails = {"work_of_adhesion": "_J_m2", "reference_time": "_s"}
    return {
        **read(fit, "times_s", "forces_N", "work_of_adhesion_J_m2", "growth_per_decade"),
        "growth_interval": fit.interval,
        **read(fit, "level", "scatter", "law", "words"),
        "interface": {f"{name}{tails.get(name, '')}": x for name, x in fit.parameters.items()},
        "reference_time_interval_s": fit.reference_time,
    }
