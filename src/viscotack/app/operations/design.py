"""The operations ``design``, ``array`` and ``window``: what to build, and how it holds."""

from math import isfinite, isnan
from pathlib import Path
from typing import Any, ClassVar

from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.units import readable

from .options import csv_file, input_file, option, picture, switch
from .parts.record_words import read
from .predict import OF_METHOD
from .request import Answer, Caller, Request
from .simulate import Accuracy, Limit


class OfDesign(Request):
    """Find radius, preload, number of pads and speeds that hold and release wanted forces.

    Targets are forces, works, loads held for a time and the yield, at all stated speeds and
    temperatures. Surrogates or theories with their intervals are searched for the largest margin
    of the worst target, and simulations of the best designs decide. Several targets have a front
    of designs. Out of reach, the answer states the bound. docs/design.md describes the file and
    the method.

    Example: viscotack design lift_and_let_go.toml --plot design.png
    """

    word: ClassVar = "design"
    outputs: ClassVar = (
        csv_file("Write a row for each design."),
        csv_file("Write a row for each design of the front.", "front"),
        picture("Draw forces by speed, and elasticities,."),
        picture("Draw the front of several targets.", "trade"),
    )
    takes_own: ClassVar = True

    file: Path = input_file(
        "[targets], [bounds] of variables, [interface], and [material] or [[materials]].",
        "DESIGN.toml",
    )
    confirm: int = option("Number of designs that are simulated.", default=3, ge=0, le=3)
    seed: int = option("Seed of the search.", default=0, ge=0, le=2**32 - 1)
    accuracy: Accuracy = DEFAULT_ACCURACY
    time_limit: Limit = 60.0

    def answer(self, caller: Caller) -> Answer:
        """Search and simulate, telling ``share``."""
        from viscotack.design import find_design, read_design
        from viscotack.plot.design import draw_design, draw_front

        stated = caller.read_file(self.file, read_design)
        found = find_design(
            stated.materials,
            stated.traction,
            stated.space,
            stated.targets,
            stated.conditions,
            progress=caller.share,
            **self.values("confirm", "seed", "accuracy", "time_limit"),
        )
        rows = [_design(one) for one in found.candidates]
        front = [
            _choice(one)
            | {f"margin_{name}": x for name, x in one.margins.items()}
            | {f"best_margin_{name}": x for name, x in one.best_margins.items()}
            for one in found.front
        ]
        limit = ("target", "wanted", "reach", "cause", "excludes", "why")
        record = {
            "designs": rows,
            "front": front,
            "limits": [read(each, *limit) for each in found.limits],
            **read(found, "meets", "binding", "elasticities", "predictions", "tier"),
            "cautions": [stated.cautions(one.choice) for one in found.candidates],
        }
        return Answer(
            found,
            data=record,
            words=_design_shown(found, record),
            files={"csv": rows, "front": front},
            pictures={
                "plot": lambda: draw_design(found, stated),
                "trade": lambda: draw_front(found),
            },
        )


# Forces of a design with their units, and its variables as columns.
_FORCES = {"hold": "N", "release": "N", "work": "J", "dead_load": "N"}
_CHOICE = ("material", "radius_m", "preload_N", "pads", "hold_speed_m_per_s")
_CHOICE += ("release_speed_m_per_s", "modulus_Pa", "thickness_m", "exponent", "backing_N_per_m")


def _choice(one: Any) -> dict[str, Any]:
    """Return the variables of a design, and its forces with their intervals, as columns."""
    row = read(one.choice, *_CHOICE)
    for name, unit in _FORCES.items():
        columns = {unit: "value", f"low_{unit}": "low", f"high_{unit}": "high", "method": "method"}
        row |= read(one, **{f"{name}_{x}": f"forces.{name}.{of}" for x, of in columns.items()})
    return row


def _design(one: Any) -> dict[str, Any]:
    """Return the row of a design and its simulation."""
    simulated = {f"simulated_{x}_{unit}": f"run.forces.{x}" for x, unit in _FORCES.items()}
    simulated |= {"simulated_time_s": "run.time", "margin": "margin"}
    simulated |= {"simulated_margin": "run.margin", "yield": "share", "meets": "run.meets"}
    return _choice(one) | read(one, **simulated) | {"why": "" if one.run is None else one.run.why}


_VERDICTS = {
    True: "the targets are met, by simulation",
    False: "the targets are not met",
    None: "not confirmed by simulation",
}


def _design_shown(found: Any, record: dict[str, Any]) -> dict[str, Any]:
    """Return what the text says of a record: the front has a table of its own."""
    words = [_VERDICTS[found.meets], *(each.words for each in found.excluded)]
    if found.meets is False and not found.excluded and found.best.run is None:
        words.append(
            "each target alone is within reach, but no design between the bounds meets all"
        )
    return {
        "words": words,
        "designs": record["designs"],
        "binding": found.binding,
        "designs_of_the_front": len(found.front) or None,
        "d ln P/d ln x": {f"of {name}": dict(each) for name, each in found.elasticities.items()},
        "cautions": [*record["cautions"], OF_METHOD],
    }


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

    file: Path = input_file("[pad], [array] and [pull]; perhaps [backing], [hold].", "ARRAY.toml")
    accuracy: Accuracy = DEFAULT_ACCURACY
    time_limit: Limit = 60.0

    def answer(self, caller: Caller) -> Answer:
        """Pull the array, and hold its load, telling ``share``."""
        from viscotack.design import read_array
        from viscotack.design.arrays import array_yield, holding, preload_after, pull_array
        from viscotack.plot.design import draw_array

        stated = caller.read_file(self.file, read_array)
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
        order = {pad: place + 1 for place, pad in enumerate(found.order)}
        pads = [
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
        record = {
            "count": len(array.positions),
            **read(found, "pull_off_force_N", "interval_N"),
            **read(found, work_of_separation_J="work", lost_in_jumps_J="lost"),
            "jumps": [{"travel_m": x, "pads": count} for x, count in found.jumps],
            **read(found, "load_sharing", "method", "why"),
        }
        if held is not None:
            record |= read(held, load_N="force", holds="holds", payload_kg="payload")
            record |= read(held, lasting_payload_kg="lasting", time_to_detachment_s="time")
            record |= read(held, "release_time_s", why_time="why")
        if part is not None:
            record |= {"yield": part.share, "yield_interval": part.interval}
        if left is not None:
            record["preload_after_hold_N"] = left
        return Answer(
            found,
            data=record | {"pads": pads},
            words=_array_shown(found, held, record),
            files={"csv": {"travel_m": -found.drive, "force_N": found.force}, "pads": pads},
            pictures={"plot": lambda: draw_array(array, found, load=load)},
        )


def _array_shown(found: Any, held: Any, record: dict[str, Any]) -> dict[str, Any]:
    """Return what the text says of a record; the load is in a sentence."""
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
    said = ("holds", "load_N", "time_to_detachment_s", "why_time")
    return {"words": words} | {n: x for n, x in record.items() if n not in said}


class OfWindow(Request):
    """Determine where a stamp picks an object from a donor and prints it on a receiver.

    The object has a contact with the stamp and one with donor or receiver, which carry the same
    force. Which opens first follows from two steady cracks in series, with intervals;
    docs/pick_and_print.md describes the file and the theory. With [scatter] the answer has the
    probabilities to pick and to print, with temperatures or dwells a map for each.

    Example: viscotack window stamp.toml --plot window.png
    """

    word: ClassVar = "window"
    outputs: ClassVar = (
        csv_file("Write a row for each speed and preload."),
        csv_file("Write a row for each critical speed.", "critical"),
        picture("Draw the map of speed and preload."),
    )
    takes_own: ClassVar = True

    file: Path = input_file(
        "[stamp], [donor] and [receiver], and [pull] with speeds and preloads.", "WINDOW.toml"
    )
    simulate: bool = switch(
        "Simulate both contacts in one march where steady cracks do not decide (seconds)."
    )
    accuracy: Accuracy = DEFAULT_ACCURACY
    time_limit: Limit = 60.0

    def answer(self, caller: Caller) -> Answer:
        """Evaluate every speed and preload of each map, telling ``share``."""
        from viscotack.design import read_window
        from viscotack.design.window import window
        from viscotack.plot.design import draw_window

        stated = caller.read_file(self.file, read_window)
        maps, cells, critical = [], [], []
        for number, each in enumerate(stated):

            def tell(share: float, done: int = number) -> None:
                caller.share((done + share) / len(stated))

            of_map = ("donor", "receiver", "speeds", "preloads", "stiffness", "scatter")
            how = read(each, *of_map) | self.values("simulate", "accuracy", "time_limit")
            found = window(each.stamp, **how, progress=tell)
            maps.append(found)
            at = _place(each)
            cells += [at | _cell(x, scattered=each.scatter is not None) for x in found.cells]
            critical += [at | read(x, **_CRITICAL) for x in found.critical_speeds]
        columns = [*_place(stated[0]), *_CRITICAL]
        return Answer(
            tuple(maps) if len(maps) > 1 else maps[0],
            data={"cells": cells, "critical_speeds": critical},
            words=_window_shown(cells, critical),
            files={"csv": cells, "critical": {n: [row[n] for row in critical] for n in columns}},
            pictures={"plot": lambda: draw_window(*maps, titles=[_title(x) for x in stated])},
        )


def _place(stated: Any) -> dict[str, float]:
    """Return temperature and dwell of a map as columns."""
    both = {"temperature_K": stated.temperature, "dwell_s": stated.dwell}
    return {name: value for name, value in both.items() if value is not None}


def _title(stated: Any) -> str:
    """Return temperature and dwell of a map in words."""
    T, dwell = stated.temperature, stated.dwell
    words = [] if T is None else [f"at {T - 273.15:.4g} degC"]
    return ", ".join(words + ([] if dwell is None else [f"after {readable(dwell, 's')}"]))


_CRITICAL = {"base": "base", "preload_N": "preload", "critical_speed_m_per_s": "speed"}
_CRITICAL |= {"low_m_per_s": "interval.0", "high_m_per_s": "interval.1"}
_CRITICAL |= {"opens_below": "below", "opens_above": "above", "method": "method"}


def _cell(cell: Any, *, scattered: bool) -> dict[str, Any]:
    """Return the row of a speed and a preload."""
    row = read(cell, "speed_m_per_s", "preload_N", "word")
    for base in ("donor", "receiver"):
        one = getattr(cell, base)
        opened = None if one is None or one.opened is None else (base, "stamp")[one.opened]
        row[f"{base}_opens"] = opened
        row |= {f"{base}_{name}": x for name, x in read(one, "tension_N", "held", "method").items()}
    row["why"] = cell.why
    if scattered:
        for name in ("pick", "print"):
            ends = {"probability": "value", "low": "low", "high": "high"}
            row |= read(cell, **{f"{name}_{x}": f"{name}.{end}" for x, end in ends.items()})
        row["transfer_probability"] = cell.transfer
    return row


def _window_shown(cells: list[dict[str, Any]], critical: list[dict[str, Any]]) -> dict[str, Any]:
    """Return what the text says: the map of words, best yields, and critical speeds."""
    maps: dict[Any, dict[str, Any]] = {}
    best: dict[Any, dict[str, Any]] = {}
    for cell in cells:
        at = {name: cell.get(name) for name in ("temperature_K", "dwell_s", "preload_N")}
        place, speed = tuple(at.values()), cell["speed_m_per_s"]
        maps.setdefault(place, dict(at))[readable(speed, "m/s", digits=3)] = cell["word"]
        for name in ("pick", "print", "transfer"):
            chance = cell.get(f"{name}_probability")
            known = best.get((*place, name), {"probability": -1.0})
            if chance is not None and chance > known["probability"]:
                row = {"of": name, "probability": chance, "speed_m_per_s": speed}
                best[(*place, name)] = at | row
    undecided = {cell["why"]: None for cell in cells if cell["word"] == "undecided"}
    return {
        "map": list(maps.values()),
        "best": list(best.values()),
        "critical_speeds": critical,
        "undecided": list(undecided),
    }
