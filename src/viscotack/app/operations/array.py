"""The operation ``array``: many pads on one backing."""

from math import isfinite, isnan
from pathlib import Path
from typing import Any, ClassVar

from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.units import readable

from .options import csv_file, file_name, picture
from .parts.record_words import read
from .request import Answer, Caller, Request
from .simulate import Accuracy, Limit


class OfArray(Request):
    """Pull an array of pads off: force, order of detachment, load sharing, payload and yield.

    Each pad follows the force-depth curve of one pad at the speed of the pull; heights, works,
    tilt, curvature and springs of the backing determine which detaches first. docs/arrays.md
    describes the file and the theory.

    Example: viscotack array gripper_finger.toml --plot array.png
    """

    word: ClassVar = "array"
    outputs: ClassVar = (
        csv_file("Write force by travel of the drive."),
        csv_file("Write a row for each pad.", "pads"),
        picture("Draw the force and the order of the pads."),
    )
    takes_own: ClassVar = True

    file: Path = file_name(
        "TOML file with [pad], [array] and [pull]; optional: [backing], [hold].",
        metavar="ARRAY.toml",
        argument=True,
        default=...,
    )
    accuracy: Accuracy = DEFAULT_ACCURACY
    time_limit: Limit = 60.0

    def answer(self, caller: Caller) -> Answer:
        """Pull the array, and hold its load, telling ``share``."""
        from viscotack.design import read_array
        from viscotack.design.arrays import array_yield, holding, preload_after, pull_array
        from viscotack.plot.design import draw_array

        file = caller.file(self.file)
        stated = read_array(file, also=caller.also, beside=caller.within(file).file)
        how = self.values("accuracy", "time_limit")
        how |= {"speed": stated.speed, "preload": stated.preload}
        scatter, load = stated.scatter, stated.hold
        array = stated.array if scatter is None else scatter.of(stated.array)
        found = pull_array(array, **how, progress=caller.share)
        held = None if load is None else holding(array, found, load, **how)
        wait = stated.hold_time
        left = None if wait is None else preload_after(array, wait, **how)
        part = None
        if scatter is not None and load is not None:
            how |= {"draws": stated.draws, "progress": caller.share}
            part = array_yield(stated.array, scatter, load=load.force, **how)
        curve = [
            {"travel_m": -x, "force_N": F} for x, F in zip(found.drive, found.force, strict=True)
        ]
        pads = _pads(array, found)
        record = _record(array, found, held, part)
        record |= {} if left is None else {"preload_after_hold_N": left}
        return Answer(
            found,
            data=record | {"pads": pads},
            words=_shown(found, held, record),
            files={"csv": curve, "pads": pads},
            pictures={"plot": lambda: draw_array(array, found, load=load)},
        )


def _pads(array: Any, found: Any) -> list[dict[str, Any]]:
    """Return a row for each pad."""
    order = {pad: place + 1 for place, pad in enumerate(found.order)}
    return [
        {
            "pad": i + 1,
            "x_m": x,
            "y_m": y,
            "height_m": array.heights[i],
            "work_factor": array.works[i],
            "start_force_N": found.start_force[i],
            "released_at_m": found.released[i] if i in order else None,
            "order": order.get(i),
        }
        for i, (x, y) in enumerate(array.positions)
    ]


def _record(array: Any, found: Any, held: Any, part: Any) -> dict[str, Any]:
    """Return the numbers of the answer."""
    record: dict[str, Any] = {
        "count": len(array.positions),
        **read(found, "pull_off_force_N", "interval_N"),
        "work_of_separation_J": found.work,
        "lost_in_jumps_J": found.lost,
        "jumps": [{"travel_m": x, "pads": count} for x, count in found.jumps],
        **read(found, "load_sharing", "method", "why"),
    }
    if held is not None:
        record |= {
            "load_N": held.force,
            "holds": held.holds,
            "payload_kg": held.payload,
            "lasting_payload_kg": held.lasting,
            "time_to_detachment_s": held.time,
            "release_time_s": held.release_time,
            "why_time": held.why,
        }
    if part is not None:
        record |= {"yield": part.share, "yield_interval": part.interval}
    return record


def _shown(found: Any, held: Any, record: dict[str, Any]) -> dict[str, Any]:
    """Return what the text says of a record."""
    words = []
    if held is not None:
        word = {True: "holds", False: "does not hold", None: "may hold, within the interval"}
        after = f"after {readable(held.time, 's')}" if isfinite(held.time) else "not within a day"
        after = "after an unknown time" if isnan(held.time) else after
        words = [
            f"the array {word[held.holds]}: load of {readable(held.force, 'N')} with acceleration "
            f"and safety factor",
            f"at rest under its weight the load detaches {after} ({held.why})",
        ]
    if (apart := record["count"] - len(found.order)) > 0:
        words.append(f"{apart} of {record['count']} pads do not touch")
    return {"words": words} | {n: x for n, x in record.items() if n not in _SAID}


# What the sentences say.
_SAID = ("holds", "load_N", "time_to_detachment_s", "why_time")
