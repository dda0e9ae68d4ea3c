"""Checkpoints: runs on a grid in a file, from which they continue after an interruption.

A file is a NumPy archive with the arrays of several parts of a simulation, named ``part.array``,
and one text in JSON per part. It stores every number in full, so that a run that continues has the
same digits as one that was not interrupted.
"""

from __future__ import annotations

import json
import re
import zlib
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from time import perf_counter
from typing import Any
from zipfile import BadZipFile

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.files.archive import read_arrays
from viscotack.files.whole import writing_whole
from viscotack.result import Event
from viscotack.simulate.body import Rates
from viscotack.simulate.grid.body import Fixed, Frame, GridMemory, GridRun, GridState
from viscotack.simulate.grid.descent import Found
from viscotack.simulate.grid.plane import Plane, on_host
from viscotack.simulate.history import EnergyTerms, Lowest, Snapshot
from viscotack.simulate.machine import Leg
from viscotack.simulate.steps import MarchState

# Wall time after which a run is written again [s]; a kill loses this and the step under way.
EVERY = 30.0
# Most bytes of a file: 8192 x 8192 pixels and 50 modes.
_LARGEST = 6e10
_NAME = re.compile(r"key|(start|main)\.[a-z_]{1,20}")

Arrays = dict[str, npt.NDArray[Any]]


@dataclass(eq=False)
class Checkpoint:
    """Parts of a simulation in a file.

    Attributes
    ----------
    path : Path
        The file.
    key : str
        Identifier of problem and settings.
    every : float
        Wall time between two writes [s].
    parts : dict
        Arrays of each part.
    """

    path: Path
    key: str
    every: float = EVERY
    parts: dict[str, Arrays] = field(default_factory=dict)
    written: float = field(default_factory=perf_counter)

    @classmethod
    def opened(cls, path: Path, key: str, every: float = EVERY) -> Checkpoint:
        """Return the checkpoint in a file, an empty one if the file does not exist.

        Raises
        ------
        InputError
            If the file is no checkpoint, is damaged, or belongs to another problem.
        """
        found = cls(path, key, every)
        if not path.exists():
            return found
        try:
            with open(path, "rb") as file:
                arrays = read_arrays(file, lambda name: bool(_NAME.fullmatch(name)), _LARGEST)
            stored = str(arrays.pop("key"))
        except (ValueError, OSError, KeyError, EOFError, zlib.error, BadZipFile) as error:
            raise InputError(f"{path} is not a checkpoint: {error}; name another file") from None
        if stored != key:
            raise InputError(
                f"{path} is the checkpoint of another problem, accuracy, number of maps or "
                "version; remove it or name another file"
            )
        for name, array in arrays.items():
            part, _, own = name.partition(".")
            found.parts.setdefault(part, {})[own] = array
        return found

    def part(self, name: str, read: Callable[[Arrays], Any]) -> Any:
        """Return a part as the function reads it, None if there is none."""
        if name not in self.parts:
            return None
        try:
            return read(self.parts[name])
        except (KeyError, TypeError, ValueError, IndexError) as error:
            raise InputError(f"{self.path} is a damaged checkpoint: {error}; remove it") from None

    @property
    def due(self) -> bool:
        """Whether it is time to write again."""
        return perf_counter() - self.written >= self.every

    def keep(self, name: str, arrays: Arrays) -> None:
        """Write the file with new arrays of a part, whole or not at all."""
        self.parts[name] = arrays
        flat = {f"{part}.{own}": a for part, held in self.parts.items() for own, a in held.items()}
        with writing_whole(self.path) as file:
            np.savez(file, key=np.array(self.key), **flat)  # type: ignore[arg-type]
        self.written = perf_counter()


# Attributes that are stored: fields of the surface, and numbers.
_FIELDS_OF_FOUND = ("moved", "gap", "tension", "held")
_OF_FOUND = ("energy", "depth", "iterations", "stable", "released")
_FIELDS_OF_STATE = ("gap", "relaxed", "nodal", "moved")
_OF_SNAPSHOT = ("time", "depth", "edge", "force", "elastic", "interface")
_OF_BOOKS = ("work", "jumps", "transfer", "interface")
_OF_FRAME = ("time", "depth", "force")
_OF_HISTORY = ("outcome", "pressed", "reason", "left", "nodes")


def found_arrays(found: Found) -> Arrays:
    """Return a relaxed state as arrays."""
    about = {name: getattr(found, name) for name in _OF_FOUND}
    fields = {name: on_host(getattr(found, name)) for name in _FIELDS_OF_FOUND}
    return fields | {"about": _text(about)}


def found_of(plane: Plane, arrays: Arrays) -> Found:
    """Reconstruct the relaxed state from the output of :func:`found_arrays`."""
    fields = {name: plane.field(arrays[name]) for name in _FIELDS_OF_FOUND}
    return Found(**fields, **_values(arrays["about"]))


def run_arrays(run: GridRun, at: MarchState, counted: tuple[int, int, int]) -> Arrays:
    """Return a run and its present place as arrays.

    `counted` are the iterations, rejected steps and events up to this place.
    """
    state: GridState = at.state  # type: ignore[assignment]
    history = run.history
    iterations, rejected, events = counted
    frames = [*run.frames.strongest, *run.frames.kept]
    about = {
        "known": state.rates.known,
        "leg": asdict(at.leg),
        "number": at.number,
        "began": asdict(at.began),
        "dt": at.dt,
        "lowest": asdict(at.lowest),
        "every": run.frames.every,
        "events": [asdict(event) for event in history.events[:events]],
        "history": {name: getattr(history, name) for name in _OF_HISTORY}
        | {"iterations": iterations, "rejected": rejected}
        | ({"outcome": "", "reason": ""} if history.outcome == "time" else {}),
    }
    found = {
        "about": _text(about),
        "snapshots": _table(history.snapshots, _OF_SNAPSHOT),
        "books": _table(history.books, _OF_BOOKS),
        "heat": np.array([books.heat for books in history.books]),
        "legs": np.array(history.legs),
        "touching": np.array(run.touching),
        "frames": _table(frames, _OF_FRAME),
        "gaps": np.array([frame.gap for frame in frames]),
        "pressures": np.array([frame.pressure for frame in frames]),
        "force": on_host(state.memory.force),
        "products": np.array([state.memory.present, state.memory.own]),
        "rate": on_host(state.rates.relaxed),
    }
    found |= {name: on_host(getattr(state, name)) for name in _FIELDS_OF_STATE}
    return found if state.moving is None else found | {"moving": on_host(state.moving)}


def continued(run: GridRun, arrays: Arrays) -> MarchState:
    """Fill the history of a new run from the output of :func:`run_arrays`; return the place."""
    about, history = _values(arrays["about"]), run.history
    contact: Any = run.body.contact
    if arrays["gap"].shape != contact.rigid_gap.shape:
        raise ValueError("its map has other pixels")
    history.snapshots += [Snapshot(*row) for row in arrays["snapshots"].tolist()]
    history.books += [
        EnergyTerms(work, heat, jumps, transfer, interface)
        for (work, jumps, transfer, interface), heat in zip(
            arrays["books"].tolist(), arrays["heat"], strict=True
        )
    ]
    history.legs += arrays["legs"].tolist()
    history.events += [Event(**event) for event in about["events"]]
    for name, value in about["history"].items():
        setattr(history, name, value)
    run.touching.extend((close, parts) for close, parts in arrays["touching"].tolist())
    frames = [
        Frame(time, depth, force, gap, pressure)
        for (time, depth, force), gap, pressure in zip(
            arrays["frames"].tolist(), arrays["gaps"], arrays["pressures"], strict=True
        )
    ]
    run.frames.strongest[:], run.frames.kept[:] = frames[:1], frames[1:]
    run.frames.every[:] = about["every"]
    field = contact.plane.field
    fields: dict[str, Any] = {name: field(arrays[name]) for name in _FIELDS_OF_STATE}
    state: Any = GridState(
        history.snapshots[-1],
        contact,
        memory=GridMemory(field(arrays["force"]), *arrays["products"]),
        rates=Rates(field(arrays["rate"]), 0.0, np.zeros(1), about["known"]),
        moving=field(arrays["moving"]) if "moving" in arrays else None,
        **fields,
    )
    fixed: Any = Fixed()
    return MarchState(
        state,
        history.books[-1],
        fixed,
        Leg(**about["leg"]),
        about["number"],
        Snapshot(**about["began"] | {"inner": ()}),
        about["dt"],
        Lowest(**about["lowest"]),
    )


def _text(values: Any) -> npt.NDArray[Any]:
    return np.array(json.dumps(values))


def _values(array: npt.NDArray[Any]) -> Any:
    return json.loads(str(array))


def _table(rows: Any, names: tuple[str, ...]) -> npt.NDArray[Any]:
    """Return attributes of objects as an array, shape (rows, names)."""
    return np.array([[getattr(row, name) for name in names] for row in rows])
