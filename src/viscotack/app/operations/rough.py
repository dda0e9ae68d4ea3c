"""The operation ``rough``: a rough surface pulled off a soft body."""

import os
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from viscotack.cards import card_of
from viscotack.errors import InputError
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY, TimeLimit
from viscotack.units import readable

from .request import Answer, Caller, File, Option, Output, Request, csv_file, number_of, picture
from .simulate import Accuracy

# Frames of a film, by default.
_FRAMES = 60
# The bandwidth of memory limits the transforms with more threads.
_MOST_THREADS = 8


class OfRough(Request):
    """Press a rough surface against a soft body and pull it off, by simulation on a grid.

    The surface is a map of heights from a file or generated. Force, contact area, energies and maps
    of gap and pressure follow with error estimates. With --theory superposition each asperity is
    pulled off by itself. docs/rough_surfaces.md describes the file and the theory.

    Example: viscotack rough rough_rubber.toml --plot rough.png
    """

    word: ClassVar = "rough"
    outputs: ClassVar = (
        csv_file("Write force, contact area and energies by time; - is standard output."),
        Output(
            "maps", "Write maps of gap and pressure to a .npz file.", "binary", endings=(".npz",)
        ),
        picture("Draw the force curve and the contact to a .png, .pdf or .svg file."),
        Output(
            "film", "Write the detachment as a film to a .gif file.", "binary", endings=(".gif",)
        ),
        Output(
            "movie",
            "Write the detachment as a film to an .mp4 file, by the program ffmpeg.",
            "binary",
            endings=(".mp4",),
        ),
    )
    takes_own: ClassVar = True

    file: Annotated[
        Path,
        File(
            "The tables [surface], [material], [interface] and [protocol]; perhaps [layer].",
            metavar="ROUGH.toml",
            argument=True,
        ),
    ]
    accuracy: Accuracy = DEFAULT_ACCURACY
    theory: Annotated[
        Literal["superposition"] | None,
        Option(
            "Answer by a theory instead of a simulation: the asperities by themselves.",
        ),
    ] = None
    moments: Annotated[
        int | None,
        Option(
            "Up to how many instants have maps of gap and pressure; 60 for a film, else that of "
            "the largest tension.",
        ),
        Field(ge=2, le=1000),
    ] = None
    anyway: Annotated[
        bool,
        Option(
            "Answer although a zone at an edge has less than one pixel, or asperities "
            "are neighbours."
        ),
    ] = False
    device: Annotated[
        Literal["cpu", "cuda"],
        Option("Where to compute: cuda is a GPU, by CuPy, for maps from about 512 x 512 pixels."),
    ] = "cpu"
    time_limit: Annotated[float, number_of(card_of(TimeLimit), metavar="TIME")] = 600.0
    checkpoint: Annotated[
        Path | None,
        File(
            "Keep the run in this file every half a minute; continue from there if it exists.",
            metavar="RUN.npz",
        ),
    ] = None

    def answer(self, caller: Caller) -> Answer:
        """Simulate the test, telling ``share``."""
        if self.theory is not None:
            return self._superposed(caller)
        from viscotack.plot.rough import check_ffmpeg, draw_rough, film_of_pull
        from viscotack.result import Outcome
        from viscotack.simulate.rough import pull, read_rough, stickiness

        from .parts.tables import rows_as_csv

        if "movie" in caller.wants:
            check_ffmpeg()
        file = caller.file(self.file)
        problem = read_rough(file, also=caller.also, beside=caller.within(file).file)
        moments = self.moments or (_FRAMES if caller.wants & {"film", "movie"} else 0)
        found = pull(
            problem,
            accuracy=self.accuracy,
            maps=moments,
            time_limit=self.time_limit,
            force_coarse=self.anyway,
            checkpoint=self.checkpoint,
            device=self.device,
            threads=min(os.cpu_count() or 1, _MOST_THREADS),
            progress=lambda share: caller.tell({"share": share}),
        )
        spread, measures = problem.roughness, stickiness(problem)
        about = {
            "rms_height_m": spread.rms_height,
            "rms_slope": spread.rms_slope,
            "rms_curvature_per_m": spread.rms_curvature,
            "pixels_per_zone": problem.zone.pixels,
            **measures.record,
        }
        return Answer(
            found,
            record=lambda: found.summary | about,
            words=lambda: _words(found, about),
            files={
                "csv": rows_as_csv(found.rows()),
                "maps": found.save_maps,
                "film": lambda target: film_of_pull(found, target),
                "movie": lambda target: film_of_pull(found, target, ".mp4"),
            },
            pictures={"plot": lambda: draw_rough(found)},
            notes=(*problem.surface.notes, *found.warnings),
            status=1 if found.outcome is Outcome.STOPPED else 0,
        )

    def _superposed(self, caller: Caller) -> Answer:
        """Answer by superposition of asperities."""
        from viscotack.plot.rough import draw_superposition
        from viscotack.simulate.rough import read_rough, superposed

        from .parts.tables import rows_as_csv

        if unknown := sorted(caller.wants & {"maps", "film", "movie"}):
            raise InputError(
                f"--{unknown[0]} needs the simulation; superposition has no fields, leave out "
                "theory"
            )
        if self.checkpoint is not None or self.moments is not None:
            raise InputError("checkpoint and moments belong to the simulation, not to theory")
        file = caller.file(self.file)
        problem = read_rough(file, also=caller.also, beside=caller.within(file).file)
        found = superposed(
            problem,
            accuracy=self.accuracy,
            force_outside=self.anyway,
            progress=lambda share: caller.tell({"share": share}),
        )
        return Answer(
            found,
            record=lambda: found.summary,
            words=lambda: (
                f"superposition of {len(found.asperities.radii)} asperities, {found.touching} of "
                f"them in contact, by {found.method}\n"
                f"pull-off force: {readable(found.pull_off_force, 'N')}"
                + (f" +- {100 * found.band:.2g} %" if found.inside else "")
                + f", a stress of {readable(found.pull_off_stress, 'Pa')}\n"
                f"work of separation: {readable(found.work_of_separation, 'J')}\n"
                f"share of the surface around contacts: {found.share:.2g}"
            ),
            files={"csv": rows_as_csv(found.rows())},
            pictures={"plot": lambda: draw_superposition(problem, found)},
            notes=(*problem.surface.notes, *((found.why,) if found.why else ())),
        )


def _words(found: Any, about: dict[str, Any]) -> str:
    """Return the answer as lines."""
    errors = found.error_estimate or {}

    def within(name: str) -> str:
        return f" +- {100 * errors[name]:.2g} %" if name in errors else ""

    from viscotack.simulate.rough import LONGEST_RANGE

    at, bearing = found.at_pull_off, about["bearing_area_stress_Pa"]
    share = 100 * found.area[at] / found.nominal_area
    lines = [
        f"surface: rms height {readable(about['rms_height_m'], 'm')}, rms slope "
        f"{about['rms_slope']:.3g}, {about['pixels_per_zone']:.2g} pixels in a zone at an edge",
        f"energy of full contact over the work of adhesion: "
        f"{about['full_contact_energy_over_work']:.3g} slow, "
        f"{about['full_contact_energy_over_work_fast']:.3g} fast; Fuller-Tabor parameter "
        f"{about['fuller_tabor']:.3g}; Pastewka-Robbins ratio {about['pastewka_robbins']:.3g}"
        + (
            "" if (about["range_over_gap_at_patches"] or 0) < LONGEST_RANGE else " (range too long)"
        ),
        f"pull-off force: {readable(found.pull_off_force, 'N')}{within('force')}, a stress of "
        f"{readable(found.pull_off_stress, 'Pa')}"
        + (f" ({readable(bearing, 'Pa')} by the bearing area)" if bearing is not None else ""),
        f"there: depth {readable(float(found.depth[at]), 'm')}, {share:.3g} % of the map in "
        f"contact in {int(found.patches[at])} patches",
    ]
    if found.has_separated:
        lines.append(
            f"work of separation: {readable(found.work_of_separation, 'J')}{within('work')}"
        )
    lines += [
        f"lost: {readable(float(found.heat[-1]), 'J')} as heat in the solid, "
        f"{readable(float(found.jumps[-1]), 'J')} in {len(found.events)} jumps",
        f"energy balance: {found.energy_residual:.1g}; {found.status}",
    ]
    return "\n".join(lines)
