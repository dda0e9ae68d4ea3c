"""The operation ``identify curves``: work of adhesion and modulus of every curve of a folder."""

from typing import Any, ClassVar, Literal

from viscotack.errors import InputError

from .identify import Level, Radius
from .options import csv_file, number, option, picture
from .parts.rig import Rig, refusals
from .request import Answer, Caller


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
        "Elastic contact: jkr for soft and large spheres, dmt for stiff and small ones.",
        default="jkr",
    )
    contact_modulus: float | None = number(
        'Known E0* of the relaxed solid, "1.94 MPa"; default: fitted.', "Pa"
    )
    contact_modulus_uncertainty: float | None = number(
        "Its standard uncertainty; needed with it.", "Pa"
    )
    level: Level = 0.9

    def answer(self, caller: Caller) -> Answer:
        """Fit the curves one by one."""
        from viscotack.identify import fit_curves, group_curves
        from viscotack.plot.interface import draw_curves

        from .parts.tables import rows_as_csv

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
        return Answer(
            groups,
            data=lambda: {
                "model": self.model,
                "level": self.level,
                "curves": rows,
                "repeats": means,
                "refused": refused,
            },
            words=lambda: {"model": self.model, "repeats": means},
            files={"csv": rows_as_csv(rows), "repeats": rows_as_csv(means)},
            pictures={"plot": lambda: draw_curves(groups)},
            notes=(*refusals(survey), *(f"refused: {why}" for why in refused)),
        )


def _curve(fit: Any) -> dict[str, Any]:
    cycle = fit.cycle
    return {
        "file": cycle.source.path,
        "cycle": cycle.number,
        "speed_m_s": cycle.speed.value,
        "pull_off_force_N": cycle.pull_off_force.value,
        "work_of_adhesion_J_m2": fit.work_of_adhesion.value,
        "work_of_adhesion_J_m2_uncertainty": fit.work_of_adhesion.uncertainty,
        "contact_modulus_Pa": fit.contact_modulus.value,
        "contact_modulus_Pa_uncertainty": fit.contact_modulus.uncertainty,
        "scatter_N": fit.scatter,
        "temperature_K": cycle.temperature,
    }


def _group(group: Any) -> dict[str, Any]:
    row: dict[str, Any] = {"speed_m_s": group.speed, "curves": len(group.curves)}
    units = {"work_of_adhesion": "J_m2", "contact_modulus": "Pa", "pull_off_force": "N"}
    for name, unit in units.items():
        mean = getattr(group, name)
        row |= {
            f"{name}_{unit}_mean": mean.value,
            f"{name}_{unit}_standard_deviation": mean.deviation,
            f"{name}_low_{unit}": mean.low,
            f"{name}_high_{unit}": mean.high,
        }
    return row | {"temperature_K": group.temperature}
