"""The operation ``window``: pick and print by speed and preload."""

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from viscotack.cards import card_of
from viscotack.problem.accuracy import DEFAULT_ACCURACY, TimeLimit
from viscotack.units import readable

from .declare.answer import Answer, Caller, csv_file, picture
from .declare.cards import FileOfNames, Placed, Switch, number_of
from .declare.options import Operation
from .simulate import Accuracy


@dataclass(frozen=True, kw_only=True)
class OfWindow(Operation):
    """Determine where a stamp picks an object from a donor and prints it on a receiver.

    The object has a contact with the stamp and one with donor or receiver, which carry the same
    force. Which opens first follows from two steady cracks in series, with intervals;
    docs/pick_and_print.md describes the file and the theory.

    Example: viscotack window stamp.toml --plot window.png
    """

    word: ClassVar = "window"
    outputs: ClassVar = (
        csv_file("Write a row for each speed and preload; - is standard output."),
        csv_file("Write a row for each critical speed; - is standard output.", "critical"),
        picture("Draw the map of speed and preload to a .png, .pdf or .svg file."),
    )
    takes_own: ClassVar = True

    file: Annotated[
        Placed,
        FileOfNames(
            "The contacts [stamp], [donor] and [receiver], and [pull] with speeds and preloads.",
            metavar="WINDOW.toml",
            argument=True,
        ),
    ]
    simulate: Annotated[
        bool,
        Switch("Simulate both contacts in one march where steady cracks do not decide (seconds)."),
    ] = False
    accuracy: Accuracy = DEFAULT_ACCURACY
    time_limit: Annotated[float, number_of(card_of(TimeLimit), metavar="TIME")] = 60.0

    def answer(self, caller: Caller) -> Answer:
        """Evaluate every speed and preload, telling ``share``."""
        from viscotack.pictures.window import draw_window
        from viscotack.series import read_window, window

        from .parts.tables import rows_as_csv

        stated = read_window(self.file.path, also=caller.also, beside=self.file.inside.file)
        found = window(
            stated.stamp,
            donor=stated.donor,
            receiver=stated.receiver,
            speeds=stated.speeds,
            preloads=stated.preloads,
            stiffness=stated.stiffness,
            simulate=self.simulate,
            accuracy=self.accuracy,
            time_limit=self.time_limit,
            progress=lambda share: caller.tell({"share": share}),
        )
        cells = [_cell(each) for each in found.cells]
        critical = [_critical(each) for each in found.critical_speeds]
        return Answer(
            found,
            record=lambda: {"cells": cells, "critical_speeds": critical},
            words=lambda: _words(found),
            files={
                "csv": rows_as_csv(cells, list(_CELL)),
                "critical": rows_as_csv(critical, list(_CRITICAL)),
            },
            pictures={"plot": lambda: draw_window(found)},
        )


_OF_BASE = ("opens", "tension_N", "held", "method")
_CELL = (
    "speed_m_per_s",
    "preload_N",
    "word",
    *(f"{base}_{name}" for base in ("donor", "receiver") for name in _OF_BASE),
    "why",
)
_CRITICAL = (
    "base",
    "preload_N",
    "critical_speed_m_per_s",
    "low_m_per_s",
    "high_m_per_s",
    "opens_below",
    "opens_above",
    "method",
)


def _cell(cell: Any) -> dict[str, Any]:
    """Return the row of a speed and a preload."""
    row = dict.fromkeys(_CELL)
    row |= {"speed_m_per_s": cell.speed, "preload_N": cell.preload, "word": cell.word}
    for base in ("donor", "receiver"):
        one = getattr(cell, base)
        if one is not None:
            opens = None if one.opened is None else (base, "stamp")[one.opened]
            values = opens, one.tension, one.held, one.method
            row |= {f"{base}_{name}": x for name, x in zip(_OF_BASE, values, strict=True)}
    return row | {"why": cell.why}


def _critical(one: Any) -> dict[str, Any]:
    """Return the row of a critical speed."""
    low, high = one.interval
    values = one.base, one.preload, one.speed, low, high, one.below, one.above, one.method
    return dict(zip(_CRITICAL, values, strict=True))


def _words(found: Any) -> str:
    """Return the map as rows of words, and the critical speeds."""
    width = max(len(cell.word) for cell in found.cells) + 2
    speeds = [readable(v, "m/s", digits=3) for v in found.speeds]
    width = max(width, *(len(each) + 2 for each in speeds))
    loads = [readable(F, "N", digits=3) for F in found.preloads]
    first = max(len("preload"), *map(len, loads))
    lines = [f"{'preload':>{first}}" + "".join(f"{each:>{width}}" for each in speeds)]
    for j, load in enumerate(loads):
        words = (found.at(i, j).word for i in range(len(speeds)))
        lines.append(f"{load:>{first}}" + "".join(f"{word:>{width}}" for word in words))
    for one in found.critical_speeds:
        low, high = (
            None if end is None else readable(end, "m/s", digits=3) for end in one.interval
        )
        between = f"{low or 'below the map'} to {high or 'above the map'}"
        lines.append(
            f"{one.base} at {readable(one.preload, 'N', digits=3)}: the {one.below} opens below "
            f"{readable(one.speed, 'm/s', digits=3)} ({between}), the {one.above} above"
        )
    reasons = dict.fromkeys(cell.why for cell in found.cells if cell.word == "undecided")
    return "\n".join([*lines, *(f"undecided: {why}" for why in reasons)])
