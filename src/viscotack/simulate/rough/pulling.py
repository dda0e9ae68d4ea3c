"""Simulation of a pull on a rough surface."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
import scipy
from scipy.fft import set_workers

from viscotack.clock import TimeUp, limited
from viscotack.errors import InputError
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.model.traction import Tabulated
from viscotack.result import Event, Outcome
from viscotack.simulate.bounds import check_clock
from viscotack.simulate.estimate import COARSER
from viscotack.simulate.grid.body import Frame, GridRun
from viscotack.simulate.grid.checkpoint import EVERY, Checkpoint, found_arrays, found_of
from viscotack.simulate.grid.descent import Found
from viscotack.simulate.grid.map_contact import MapContact
from viscotack.simulate.grid.plane import Device, Plane, memory
from viscotack.simulate.grid.run import march_on_grid, relaxed
from viscotack.simulate.machine import legs_of, longest_time, reached, spring_travel
from viscotack.simulate.settings import Settings
from viscotack.simulate.solver import modes_of_run, part_of
from viscotack.simulate.verdict import status_of
from viscotack.version import __version__

from .problem import COARSE, COARSEST, FINE, RoughProblem
from .result import FieldMap, RoughResult

# The error of pixels, from runs on every second pixel of rows and columns: on two sets of pixels,
# because edges are caught by chance.
_FIRST_PIXELS = ((0, 0), (1, 1))
# Factor on the larger difference for viscoelastic and for elastic solids, whose edges only pixels
# hold. The difference to pixels half as large is about a sixth of it.
_FACTOR = 0.5, 0.75
# Smallest error as a fraction of the accuracy.
_FLOOR = 0.4
# Error of the force times the square of the number of pixels of a patch of contact at the largest
# tension: what pixels do not know of the summits between them, if no run on larger ones sees it.
_FEW = 2.8
# Bytes per pixel, and per pixel and mode of the solid, of periodic and of other maps.
_BYTES = {True: (400, 25), False: (850, 28)}
# Share of the main run in the total work.
_MAIN = 0.65


def pull(
    problem: RoughProblem,
    *,
    accuracy: float = DEFAULT_ACCURACY,
    estimate_error: bool = True,
    maps: int = 0,
    time_limit: float | None = None,
    force_coarse: bool = False,
    checkpoint: str | os.PathLike[str] | None = None,
    every: float = EVERY,
    threads: int = 1,
    device: Device = "cpu",
    progress: Callable[[float], None] | None = None,
) -> RoughResult:
    """Press a rough surface against a soft body and pull it off, by simulation on its pixels.

    Parameters
    ----------
    problem : RoughProblem
        Surface, solid, interface and test.
    accuracy : float
        Relative error of the pull-off force that steps and modes of the solid are made for; the
        error of the pixels is that of the map.
    estimate_error : bool
        Whether errors are estimated, from two runs with coarser steps on pixels twice as large,
        which take about half as long.
    maps : int
        Up to how many maps of gap and pressure are kept, besides that of the largest tension.
    time_limit : float, optional
        Wall time after which the simulation stops [s]; what was found so far is returned.
    force_coarse : bool
        Whether to answer although a zone at an edge has less than one pixel.
    checkpoint : path, optional
        File (.npz) in which the run is kept, and from which it continues, to the same digits, after
        a kill or the time limit. The finished run stays there too.
    every : float
        Wall time between two writes of this file [s]; a kill loses this and the step under way.
    threads : int
        Threads of the Fourier transforms, which do not change the digits; several pay from about
        256 x 256 pixels on.
    device : "cpu" or "cuda"
        Where the fields are: "cuda" is a GPU, which needs CuPy (extra ``gpu``) and pays from about
        512 x 512 pixels on. Laws by a table are for the CPU.
    progress : callable, optional
        Called with the completed share of the work, 0 to 1.

    Returns
    -------
    RoughResult
        Curves, errors and maps in SI.

    Raises
    ------
    ValueError
        If the pixels are too coarse, the start is not possible, the time limit is met before the
        test begins, or the checkpoint is of another problem.

    Examples
    --------
    >>> from viscotack import AtDepth, Elastic, LennardJones, Retraction
    >>> from viscotack.model.surfaces import sphere
    >>> glass = sphere(96, 20e-6, radius=5e-3)
    >>> problem = RoughProblem(
    ...     surface=glass,
    ...     material=Elastic(rubbery_modulus=0.4e6, poisson_ratio=0.5),
    ...     traction=LennardJones(work_of_adhesion=0.15, equilibrium_gap=4e-6),
    ...     protocol=Retraction(start=AtDepth(4e-6), speed=1e-6),
    ... )
    >>> found = pull(problem, estimate_error=False)
    >>> f"{found.pull_off_force * 1e3:.1f} mN"
    '3.8 mN'
    """
    began = perf_counter()
    warnings, pixels, zone = (), problem.zone.pixels, problem.zone.length
    if pixels < COARSE:
        longer = problem.traction.equilibrium_gap * np.sqrt(FINE / pixels)
        words = (
            f"the zone at an edge is {zone:.3g} m long and has {pixels:.2g} pixels of "
            f"{problem.surface.pixel:.3g} m; {FINE:g} are needed, as with pixels of "
            f"{zone / FINE:.3g} m, or an equilibrium gap of {longer:.3g} m"
        )
        if pixels < COARSEST and not force_coarse:
            raise InputError(words)
        warnings = (words,)
    contact = problem.contact.on(device)
    if device != "cpu" and isinstance(problem.traction, Tabulated):
        raise InputError(
            "a law by a table is computed on the CPU; leave out device", field="device"
        )
    settings = Settings.for_accuracy(accuracy)
    share = _MAIN if estimate_error else 1.0
    kept = None
    if checkpoint is not None:
        kept = Checkpoint.opened(Path(checkpoint), _key(problem, settings, maps), every)

    # the modes follow from the start, which needs memory itself
    check_memory(contact.plane, 0)
    with limited(time_limit), set_workers(threads):
        try:
            start = None if kept is None else kept.part("start", partial(found_of, contact.plane))
            if start is None:
                start = relaxed(contact, problem.units.scaled(problem.protocol.start))
                if kept is not None:
                    kept.keep("start", found_arrays(start))
        except TimeUp as limit:
            raise InputError(f"{limit} before the relaxed start was found") from None
        except ArithmeticError as reason:
            raise InputError(f"the relaxed start was not found: {reason}") from None
        run = _run(problem, contact, start, settings, maps, kept, part_of(progress, 0.0, share))
        result = _result(problem, run, warnings)
        if estimate_error and result.outcome is not Outcome.STOPPED:
            errors = _errors(problem, result, settings, contact, part_of(progress, share, 1.0))
            result = replace(result, error_estimate=errors)
    statistics = dict(result.statistics) | {"wall_time_s": perf_counter() - began}
    return replace(result, statistics=statistics)


def _run(
    problem: RoughProblem,
    contact: MapContact,
    start: Found,
    settings: Settings,
    maps: int,
    kept: Checkpoint | None,
    progress: Callable[[float], None] | None,
) -> GridRun:
    """Simulate the test."""
    test = problem.units.scaled(problem.protocol)
    material = problem.material.reduced()
    moves, stiffness = test.moves, test.stiffness
    legs = legs_of(moves, test.speed, stiffness, contact, settings)  # type: ignore[arg-type]
    began: Any = _Start(start.depth, contact.force_under(start.tension, start.depth))
    depths = reached(began, moves, contact)  # type: ignore[arg-type]
    check_clock(legs, moves, depths, contact)  # type: ignore[arg-type]
    spring = spring_travel(began, depths, moves, stiffness, material.modulus_ratio, contact)  # type: ignore[arg-type]
    longest = longest_time(depths, moves, test.speed, contact, spring)  # type: ignore[arg-type]
    modes = modes_of_run(material, legs, longest, settings)
    check_memory(contact.plane, len(modes.weights))
    return march_on_grid(
        contact,
        start,
        modes,
        legs,
        settings,
        stiffness=stiffness,
        frames=maps,
        checkpoint=kept,
        progress=progress,
    )


def check_memory(plane: Plane, modes: int) -> None:
    """Refuse a map that the memory of its device does not hold."""
    least, of_mode = _BYTES[plane.periodic]
    needed = plane.shape[0] * plane.shape[1] * (least + of_mode * modes)
    if needed > (held := memory(plane.device)):
        raise InputError(
            f"{plane.shape[0]} x {plane.shape[1]} pixels with {modes} modes of the solid need "
            f"{needed / 1e9:.3g} GB of memory, and there are {held / 1e9:.3g} GB; cut the map, "
            "make it coarser (HeightMap.coarser) or ask for less accuracy"
        )


def _key(problem: RoughProblem, settings: Settings, maps: int) -> str:
    """Return an identifier of what the digits of a run depend on."""
    surface = problem.surface
    parts = repr([problem.material, problem.traction, problem.protocol, problem.body])
    about = [parts, surface.pixel, surface.periodic, surface.beyond, surface.heights.shape]
    versions = [__version__, np.__version__, scipy.__version__]
    text = json.dumps([about, asdict(settings), maps, versions], sort_keys=True)
    return hashlib.sha256(text.encode() + surface.heights.tobytes()).hexdigest()


class _Start(NamedTuple):
    """Depth [h0] and force [output unit] of a relaxed start."""

    depth: float
    force: float


def _result(problem: RoughProblem, run: GridRun, warnings: tuple[str, ...]) -> RoughResult:
    """Return the result of a run in SI."""
    history, law = run.history, problem.traction
    pixel = run.body.contact.plane.pixel * problem.length  # type: ignore[union-attr]
    h0, force_unit, time = law.equilibrium_gap, problem.force, problem.time
    energy = force_unit * h0
    force, depth = history.seen("force"), history.seen("depth")
    energies = {name: energy * series for name, series in history.energies().items()}
    residual = float(np.max(np.abs(history.imbalances())))
    touching = np.array(run.touching)
    legs = np.array(history.legs)
    last = int(np.argmax(legs == len(run.legs) - 1)) if legs[-1] == len(run.legs) - 1 else 0

    def shown(frame: Frame) -> FieldMap:
        return FieldMap(
            frame.time * time,
            frame.depth * h0,
            frame.force * force_unit,
            frame.gap * np.float32(h0),
            frame.pressure * np.float32(law.work_of_adhesion / h0),
        )

    return RoughResult(
        time=time * history.seen("time"),
        depth=h0 * depth,
        drive=h0 * (depth if history.stiffness is None else depth + force / history.stiffness),
        force=force_unit * force,
        area=touching[:, 0] * pixel**2,
        patches=touching[:, 1],
        work=energies["drive"],
        elastic=energies["elastic"],
        interface=energies["interface"],
        heat=energies["heat"],
        jumps=energies["jumps"],
        last_leg=last,
        status=status_of(history, residual, problem.contact.law),
        events=tuple(
            Event(e.kind, e.time * time, e.depth * h0, e.force * force_unit, e.energy * energy)
            for e in history.events
        ),
        energy_residual=residual,
        strongest=shown(run.frames.strongest[0]),
        nominal_area=problem.surface.area,
        pixel=pixel,
        warnings=warnings,
        maps=tuple(shown(frame) for frame in run.frames.kept),
        statistics=history.statistics
        | {"pixels": problem.surface.heights.size, "modes": len(run.body.weights)},
    )


def _errors(
    problem: RoughProblem,
    result: RoughResult,
    settings: Settings,
    contact: MapContact,
    progress: Callable[[float], None] | None,
) -> dict[str, float] | None:
    """Return the relative errors by name; None where a run on larger pixels has no answer."""
    found, most = _measures(result), dict[str, float]()
    for many, (row, column) in enumerate(_FIRST_PIXELS, 1):
        larger = contact.every_second(row, column)
        try:
            start = relaxed(larger, problem.units.scaled(problem.protocol.start))
        except (ArithmeticError, TimeUp):
            return None
        run = _run(problem, larger, start, settings.coarser(COARSER), 0, None, None)
        other = _result(problem, run, ())
        if other.outcome is Outcome.STOPPED:
            return None
        for name, value in _measures(other).items():
            if found.get(name):
                most[name] = max(most.get(name, 0.0), abs(value / found[name] - 1))
        if progress is not None:
            progress(many / len(_FIRST_PIXELS))
    at, factor = result.at_pull_off, _FACTOR[problem.material.modulus_ratio == 1]
    touching = result.area[at] / result.pixel**2 / max(result.patches[at], 1)
    least = np.hypot(_FLOOR * settings.accuracy, _FEW / max(touching, 1.0) ** 2)
    return {name: float(np.hypot(factor * share, least)) for name, share in most.items()}


def _measures(result: RoughResult) -> dict[str, float]:
    """Return the numbers of a result whose errors are stated."""
    found = {"force": result.pull_off_force, "area": float(result.area.max())}
    return found | ({"work": result.work_of_separation} if result.has_separated else {})
