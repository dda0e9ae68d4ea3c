"""Text form of moves and starts: "approach 10 um/s to 1.5 mN", "dwell 60 s"."""

import os
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from viscotack.cards import cards, plausible
from viscotack.errors import InputError, placed
from viscotack.files.quantities import read_quantities
from viscotack.model.protocol import (
    HOLDS,
    MOST_MOVES,
    Apart,
    Approach,
    AtDepth,
    AtForce,
    AtRadius,
    Dwell,
    LoadTo,
    Move,
    MoveTo,
    Retract,
    Start,
)
from viscotack.units import parse

# Units expected for a sphere in SI, a punch in SI, and dimensionless numbers.
SPHERE_UNITS = {"depth": "m", "force": "N", "radius": "m", "speed": "m/s", "time": "s"}
PUNCH_UNITS = SPHERE_UNITS | {"force": "Pa"}
PURE_NUMBERS = dict.fromkeys(SPHERE_UNITS, "1")

_STARTS = {kind.word: kind for kind in (Apart, AtDepth, AtForce, AtRadius)}
# First word of a move -> its class and its text, by which it is read, written and explained.
_MOVES: Mapping[str, tuple[Any, str]] = {
    "approach": (Approach, "approach {speed} to {to}"),
    "retract": (Retract, "retract {speed} to {to}"),
    "move": (MoveTo, "move to {depth} in {duration}"),
    "load": (LoadTo, "load to {force} in {duration}"),
    "dwell": (Dwell, "dwell {duration}"),
    "hold": (Dwell, "hold {hold} {duration}"),
}
_EXPLAINED = {
    "speed": "SPEED",
    "to": "depth|force|radius VALUE",
    "depth": "DEPTH",
    "force": "FORCE",
    "duration": "TIME",
    "hold": "|".join(HOLDS),
}


def move_from_words(words: str | Mapping[str, Any], units: Mapping[str, str]) -> Move:
    """Parse a move from text.

    Parameters
    ----------
    words : str or mapping
        One of "approach SPEED to WHERE", "retract SPEED to WHERE", "move to DEPTH in TIME",
        "load to FORCE in TIME", "dwell TIME" and "hold drive|depth|force TIME". WHERE is a depth, a
        force or a radius and begins with that word, which may be omitted if the unit identifies it.
        A mapping is joined in its order: {"approach": "10 um/s", "to": "1 mN"}.
    units : mapping
        Units of depth, force, radius, speed and time: :data:`SPHERE_UNITS`,
        :data:`PUNCH_UNITS`, or :data:`PURE_NUMBERS`.

    Raises
    ------
    ValueError
        If the text is not a move, or a quantity is invalid or has the wrong unit.

    Examples
    --------
    >>> move_from_words("approach 10 um/s to 1.5 mN", SPHERE_UNITS)
    Approach(speed=1e-05, to=AtForce(force=0.0015))
    >>> move_from_words("retract 10 to depth -2", PURE_NUMBERS)
    Retract(speed=10.0, to=AtDepth(depth=-2.0))
    """
    if isinstance(words, Mapping):
        words = " ".join(f"{key.replace('_', ' ')} {value}" for key, value in words.items())
    words = " ".join(str(words).split())
    word = words.partition(" ")[0]
    if word not in _MOVES:
        shapes = ", or ".join(text.format(**_EXPLAINED) for _, text in _MOVES.values())
        raise InputError(f"{words!r} is not a move; write {shapes}")
    kind, text = _MOVES[word]
    parts = {name: rf"(?P<{name}>.+?)" for name in _EXPLAINED}
    parts["hold"] = rf"(?P<hold>{'|'.join(HOLDS)})"
    found = re.fullmatch(text.format(**parts), words)
    if found is None:
        raise InputError(f"cannot parse {words!r}; write {text.format(**_EXPLAINED)}")
    numbers, fields = cards(kind), dict[str, Any](found.groupdict())
    with placed(f"{words!r}:"):
        for name, given in found.groupdict().items():
            if name in numbers:
                card = numbers[name].card
                # "dwell for 60 s", "move to depth 1 um in 2 s"
                bare = given.removeprefix("for ").removeprefix(f"{name} ")
                value = plausible(name, parse(bare, units[card.measure]), units[card.measure])
                fields[name] = card.checked(name, value, units[card.measure])
            elif name == "to":
                fields[name] = _where(given, units)
        return kind(**fields)


def words_of_move(move: Move, units: Mapping[str, str]) -> str:
    """Return the text of a move, with all digits; :func:`move_from_words` reads it.

    Examples
    --------
    >>> words_of_move(Approach(speed=1e-5, to=AtForce(force=0.0015)), SPHERE_UNITS)
    'approach 1e-05 m/s to force 0.0015 N'
    """

    def quantity(value: float, measure: str) -> str:
        unit = units[measure]
        return f"{value!r}" if unit == "1" else f"{value!r} {unit}"

    said: dict[str, Any] = dict(vars(move))
    for name, field in cards(type(move)).items():
        said[name] = quantity(said[name], field.card.measure)
    if "to" in said:
        said["to"] = f"{said['to'].word} {quantity(said['to'].value, said['to'].word)}"
    return dict(_MOVES.values())[type(move)].format(**said)


def start_from_words(words: str, units: Mapping[str, str]) -> Start | Apart:
    """Parse the state at rest at the beginning of a test: "apart 20 um", "force 1.5 mN".

    Examples
    --------
    >>> start_from_words("apart 20 um", SPHERE_UNITS)
    Apart(gap=2e-05)
    """
    kind, _, value = str(words).strip().partition(" ")
    if kind not in _STARTS:
        raise InputError(
            f"{words!r} is not a start; write apart, depth, force or radius and a quantity"
        )
    return _state(kind, value, units)


def history_from_file(
    path: str | os.PathLike[str], equilibrium_gap: float
) -> tuple[Start | Apart, tuple[MoveTo, ...]]:
    """Read the start and the moves of a drive from a table of displacement over time.

    Parameters
    ----------
    path : path
        CSV file with the columns ``time`` and ``displacement``, each with its unit:
        ``time_s,displacement_um``. The displacement is the depth of the drive, positive into the
        solid, zero where the undeformed surfaces are at their equilibrium gap.
    equilibrium_gap : float
        Equilibrium gap h0 of the interface [m].

    Returns
    -------
    AtDepth or Apart, tuple of MoveTo
        First row as a state at rest (apart if it is above the surface), and a move for
        every further row.

    Raises
    ------
    ValueError
        If the file is not such a table, or its times do not ascend.
    """
    columns = read_quantities(path, {"time": "s", "displacement": "m"}, most=MOST_MOVES + 1)
    time, displacement = columns["time"], columns["displacement"]
    if len(time) < 2 or np.any(np.diff(time) <= 0):
        raise InputError(
            f"{path}: a history needs at least two rows with ascending times; give a step a "
            "finite duration"
        )
    first = displacement[0]
    start = AtDepth(first) if first >= 0 else Apart(equilibrium_gap - first)
    return start, tuple(
        MoveTo(depth, after - before)
        for depth, before, after in zip(displacement[1:], time[:-1], time[1:], strict=True)
    )


def _where(words: str, units: Mapping[str, str]) -> Start:
    kind, _, value = words.partition(" ")
    if kind in _STARTS and kind != Apart.word:
        return _state(kind, value, units)
    if units["depth"] == units["force"]:
        raise InputError(
            f"state whether {words} is a depth, a force or a radius, for example 'depth {words}'"
        )
    try:
        force = parse(words, units["force"])
    except ValueError:
        return _state("depth", words, units)
    return AtForce(plausible("force", force, units["force"]))


def _state(kind: str, words: str, units: Mapping[str, str]) -> Any:
    (field,) = cards(_STARTS[kind]).values()
    unit = units[field.card.measure]
    return _STARTS[kind](plausible(kind, parse(words, unit), unit))
