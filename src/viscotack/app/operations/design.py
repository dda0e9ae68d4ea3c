"""The operation ``design``: what to build for wanted forces."""

from pathlib import Path
from typing import Any, ClassVar

from viscotack.model.problem.accuracy import DEFAULT_ACCURACY

from .options import csv_file, file_name, option, picture
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

    file: Path = file_name(
        "The [targets], [bounds] of variables, the [interface], and [material] or [[materials]].",
        metavar="DESIGN.toml",
        argument=True,
        default=...,
    )
    confirm: int = option("Number of designs that are simulated.", default=3, ge=0, le=3)
    seed: int = option("Seed of the search.", default=0, ge=0, le=2**32 - 1)
    accuracy: Accuracy = DEFAULT_ACCURACY
    time_limit: Limit = 60.0

    def answer(self, caller: Caller) -> Answer:
        """Search and simulate, telling ``share``."""
        from viscotack.design import find_design, read_design
        from viscotack.plot.design import draw_design, draw_front

        file = caller.file(self.file)
        stated = read_design(file, also=caller.also, beside=caller.within(file).file)
        found = find_design(
            stated.materials,
            stated.traction,
            stated.space,
            stated.targets,
            stated.conditions,
            progress=caller.share,
            **self.values("confirm", "seed", "accuracy", "time_limit"),
        )
        rows = [_row(one) for one in found.candidates]
        front = [_front_row(one) for one in found.front]
        warned = [stated.cautions(one.choice) for one in found.candidates]
        return Answer(
            found,
            data=_record(found, rows, front) | {"cautions": warned},
            words=_shown(found, rows, warned),
            files={"csv": rows, "front": front},
            pictures={
                "plot": lambda: draw_design(found, stated),
                "trade": lambda: draw_front(found),
            },
        )


# Forces of a design with their units.
_FORCES = {"hold": "N", "release": "N", "work": "J", "dead_load": "N"}


# Variables of a design as columns.
_CHOICE = ("material", "radius_m", "preload_N", "pads", "hold_speed_m_per_s")
_CHOICE += ("release_speed_m_per_s", "modulus_Pa", "thickness_m", "exponent", "backing_N_per_m")


def _forces_row(one: Any) -> dict[str, Any]:
    """Return the forces of a design with their intervals as columns."""
    row: dict[str, Any] = {}
    for name, unit in _FORCES.items():
        force = one.forces.get(name)
        values = (None,) * 3 if force is None else (force.value, force.low, force.high)
        columns = (unit, f"low_{unit}", f"high_{unit}")
        row |= {f"{name}_{x}": value for x, value in zip(columns, values, strict=True)}
        row[f"{name}_method"] = None if force is None else force.method
    return row


def _row(one: Any) -> dict[str, Any]:
    """Return the row of a design."""
    run = one.run
    row = read(one.choice, *_CHOICE) | _forces_row(one)
    for name, unit in _FORCES.items():
        row[f"simulated_{name}_{unit}"] = None if run is None else run.forces.get(name)
    row["simulated_time_s"] = None if run is None else run.time
    row["margin"] = one.margin
    row["simulated_margin"] = None if run is None else run.margin
    row["yield"] = one.share
    row["meets"] = None if run is None else run.meets
    return row | {"why": "" if run is None else run.why}


def _front_row(one: Any) -> dict[str, Any]:
    """Return the row of a design of the front, with the margins at both ends of the intervals."""
    low = {f"margin_{name}": x for name, x in one.margins.items()}
    high = {f"best_margin_{name}": x for name, x in one.best_margins.items()}
    return read(one.choice, *_CHOICE) | _forces_row(one) | low | high


def _record(found: Any, rows: list[dict[str, Any]], front: list[dict[str, Any]]) -> dict[str, Any]:
    """Return the numbers of the answer."""
    return {
        "designs": rows,
        "front": front,
        "limits": [
            read(each, "target", "wanted", "reach", "cause", "excludes", "why")
            for each in found.limits
        ],
        **read(found, "meets", "binding", "elasticities", "predictions", "tier"),
    }


_VERDICTS = {
    True: "the targets are met, by simulation",
    False: "the targets are not met",
    None: "not confirmed by simulation",
}


def _shown(found: Any, rows: list[dict[str, Any]], warned: list[list[str]]) -> dict[str, Any]:
    """Return what the text says of a record: the front has a table of its own."""
    words = [_VERDICTS[found.meets], *(each.words for each in found.excluded)]
    if found.meets is False and not found.excluded and found.best.run is None:
        words.append(
            "each target alone is within reach, but no design between the bounds meets all"
        )
    return {
        "words": words,
        "designs": rows,
        "binding": found.binding,
        "designs_of_the_front": len(found.front) or None,
        "d ln P/d ln x": {f"of {name}": dict(each) for name, each in found.elasticities.items()},
        "cautions": [*warned, OF_METHOD],
    }
