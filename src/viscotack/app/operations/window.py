"""The operation ``window``: pick and print by speed and preload."""

from pathlib import Path
from typing import Any, ClassVar

from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.units import readable

from .options import csv_file, file_name, picture, switch
from .parts.record_words import read
from .request import Answer, Caller, Request
from .simulate import Accuracy, Limit


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

    file: Path = file_name(
        "The contacts [stamp], [donor] and [receiver], and [pull] with speeds and preloads.",
        metavar="WINDOW.toml",
        argument=True,
        default=...,
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

        file = caller.file(self.file)
        stated = read_window(file, also=caller.also, beside=caller.within(file).file)
        maps = []
        for number, each in enumerate(stated):

            def tell(share: float, done: int = number) -> None:
                caller.tell({"share": (done + share) / len(stated)})

            maps.append(
                window(
                    each.stamp,
                    **{name: getattr(each, name) for name in _OF_MAP},
                    progress=tell,
                    **self.values("simulate", "accuracy", "time_limit"),
                )
            )
        scattered = stated[0].scatter is not None
        pairs = list(zip(map(_place, stated), maps, strict=True))
        more = _yields if scattered else lambda cell: {}
        cells = [at | _cell(x) | more(x) for at, found in pairs for x in found.cells]
        critical = [at | _critical(x) for at, found in pairs for x in found.critical_speeds]
        first = _place(stated[0])
        columns = [*first, *_CELL, *(_YIELD if scattered else ())]
        return Answer(
            tuple(maps) if len(maps) > 1 else maps[0],
            data={"cells": cells, "critical_speeds": critical},
            words=_shown(cells, critical),
            files={
                "csv": {name: [row[name] for row in cells] for name in columns},
                "critical": {n: [row[n] for row in critical] for n in [*first, *_CRITICAL]},
            },
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


def _yields(cell: Any) -> dict[str, Any]:
    """Return the columns of a cell with its yield."""
    values = [
        None if chance is None else getattr(chance, end)
        for chance in (cell.pick, cell.print)
        for end in ("value", "low", "high")
    ]
    return dict(zip(_YIELD, [*values, cell.transfer], strict=True))


# Of a map of the file, as keywords.
_OF_MAP = ("donor", "receiver", "speeds", "preloads", "stiffness", "scatter")
_YIELD = ("pick_probability", "pick_low", "pick_high", "print_probability", "print_low")
_YIELD += ("print_high", "transfer_probability")
_OF_BASE = ("opens", "tension_N", "held", "method")
_CELL = ("speed_m_per_s", "preload_N", "word")
_CELL += tuple(f"{base}_{name}" for base in ("donor", "receiver") for name in _OF_BASE) + ("why",)
_CRITICAL = ("base", "preload_N", "critical_speed_m_per_s", "low_m_per_s", "high_m_per_s")
_CRITICAL += ("opens_below", "opens_above", "method")


def _cell(cell: Any) -> dict[str, Any]:
    """Return the row of a speed and a preload."""
    row = dict.fromkeys(_CELL) | read(cell, "speed_m_per_s", "preload_N", "word", "why")
    for base in ("donor", "receiver"):
        one = getattr(cell, base)
        if one is not None:
            found = read(one, *_OF_BASE[1:])
            found["opens"] = None if one.opened is None else (base, "stamp")[one.opened]
            row |= {f"{base}_{name}": x for name, x in found.items()}
    return row


def _critical(one: Any) -> dict[str, Any]:
    """Return the row of a critical speed."""
    values = one.base, one.preload, one.speed, *one.interval, one.below, one.above, one.method
    return dict(zip(_CRITICAL, values, strict=True))


def _shown(cells: list[dict[str, Any]], critical: list[dict[str, Any]]) -> dict[str, Any]:
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
