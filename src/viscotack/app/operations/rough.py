"""The operation ``rough``: a rough surface pulled off a soft body."""

import os
from pathlib import Path
from typing import Any, ClassVar, Literal

from viscotack.model.problem.accuracy import DEFAULT_ACCURACY

from .options import binary_file, csv_file, file_name, input_file, option, picture, switch
from .request import Answer, Caller, Request
from .simulate import Accuracy, Limit

# Frames of a film, by default.
_FRAMES = 60
# The bandwidth of memory limits the transforms with more threads.
_MOST_THREADS = 8


class OfRough(Request):
    """Press a rough surface against a soft body and pull it off, by simulation on a grid.

    The surface is a map of heights from a file or generated. Force, contact area, energies and maps
    of gap and pressure follow with error estimates. docs/rough_surfaces.md describes the file.

    Example: viscotack rough rough_rubber.toml --plot rough.png
    """

    word: ClassVar = "rough"
    outputs: ClassVar = (
        csv_file("Write force, contact area and energies by time."),
        binary_file("maps", "Write maps of gap and pressure to a .npz file.", ".npz"),
        picture("Draw the force curve and the contact."),
        binary_file("film", "Write the detachment as a film to a .gif file.", ".gif"),
    )
    takes_own: ClassVar = True

    file: Path = input_file(
        "[surface], [material], [interface] and [protocol]; perhaps [layer].", "ROUGH.toml"
    )
    accuracy: Accuracy = DEFAULT_ACCURACY
    moments: int | None = option(
        "Most instants with maps; 60 for a film, else that of the largest tension.", ge=2, le=1000
    )
    anyway: bool = switch("Answer although a zone at an edge has less than one pixel.")
    device: Literal["cpu", "cuda"] = option(
        "Where to compute: cuda is a GPU, by CuPy, for maps from about 512 x 512 pixels.",
        default="cpu",
    )
    time_limit: Limit = 600.0
    checkpoint: Path | None = file_name(
        "Keep the run in this file every half a minute; continue from there if it exists.",
        metavar="RUN.npz",
    )

    def answer(self, caller: Caller) -> Answer:
        """Simulate the test, telling ``share``."""
        from viscotack.plot.rough import draw_rough, film_of_pull
        from viscotack.result import Outcome
        from viscotack.simulate.rough import pull, read_rough, stickiness

        problem = caller.read_file(self.file, read_rough)
        found = pull(
            problem,
            maps=self.moments or (_FRAMES if "film" in caller.wants else 0),
            force_coarse=self.anyway,
            threads=min(os.cpu_count() or 1, _MOST_THREADS),
            progress=caller.share,
            **self.values("accuracy", "time_limit", "checkpoint", "device"),
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
            data=found.summary | about,
            words=_shown(found, about),
            files={
                "csv": found.rows(),
                "maps": found.save_maps,
                "film": lambda target: film_of_pull(found, target),
            },
            pictures={"plot": lambda: draw_rough(found)},
            notes=(*problem.surface.notes, *found.warnings),
            status=1 if found.outcome is Outcome.STOPPED else 0,
        )


def _shown(found: Any, about: dict[str, Any]) -> dict[str, Any]:
    """Return what the text says of a record; its warnings are notes."""
    from viscotack.simulate.rough import LONGEST_RANGE

    cautions = ["the range is too long for the ratio of Pastewka and Robbins"]
    short = (about["range_over_gap_at_patches"] or 0) < LONGEST_RANGE
    return found.summary | about | {"warnings": [], "cautions": [] if short else cautions}
