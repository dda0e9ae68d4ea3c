"""Result of a simulation, and its files.

All numbers of a :class:`Result` are dimensionless, whatever the units of the problem: force in
1.5 pi R Delta-gamma_0, positive in compression; depth in h_0, positive into the solid; contact
radius in (pi R^2 Delta-gamma_0/E_0*)^(1/3); time in the material's time unit; edge speed in
(R^2 Delta-gamma_0/E_0*)^(1/3) per time unit; work and energy in 1.5 pi R Delta-gamma_0 h_0;
pressure in Delta-gamma_0/h_0. ``result.problem.scales()`` gives the factors to SI.

For a punch, forces are mean stresses in sigma_0, positive in compression, contact radii are
half lengths of the contact in a_0, and energies are in sigma_0 h_0 per unit area. Tables
and summaries (:mod:`viscotack.model.problem.outputs`) give stress, ligament, crack speed and work
of separation.
"""

import io
import json
import os
import re
import zipfile
import zlib
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from enum import StrEnum
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError
from viscotack.files.archive import read_arrays
from viscotack.files.frame import frame
from viscotack.files.text import write_table
from viscotack.files.whole import Target, write_whole
from viscotack.model.problem import Case, Groups, Problem, PunchScales, Scales
from viscotack.model.problem.case_file import from_dict, to_dict
from viscotack.model.tables import UnknownNoun

_FORMAT, _FORMAT_VERSION = "viscotack result", 1
# Errors of NumPy, zlib and json for truncated, changed or foreign files.
_UNREADABLE = (
    ValueError,
    LookupError,
    TypeError,
    AttributeError,
    EOFError,
    OSError,
    RuntimeError,
    zipfile.BadZipFile,
    zlib.error,
)
_SERIES = ("time", "depth", "force", "contact_radius", "edge_speed")
# Series that not every result has, and the type of their numbers.
_OPTIONAL = {"move": int, "inner_radius": float, "rings": int}
# Other fields that a file has as they are.
_PLAIN = (
    *("status", "statistics", "accuracy", "method", "error_estimate", "hysteresis_errors"),
    *("energy_residual", "versions"),
)


class Outcome(StrEnum):
    """Ending of a run, at the beginning of the status text; see :func:`viscotack.solve`."""

    DETACHED = "detached"
    """The surfaces have separated."""
    IN_CONTACT = "still in contact"
    """The run ended as requested while the surfaces touch, for example just past the pull-off."""
    NEVER = "never in contact"
    """The surfaces did not touch in the whole test."""
    JUMPED = "jumped"
    """The equilibrium ended in a jump out of contact: "jumped at depth ..."."""
    STOPPED = "stopped"
    """The solver could not continue: "stopped because ...; cure". The series are incomplete."""

    @classmethod
    def of(cls, status: str) -> "Outcome":
        """Return the outcome at the beginning of a status sentence."""
        return next(each for each in cls if status.startswith(each))


@dataclass(frozen=True)
class Event:
    """A sudden event in a run, usually a jump; see :func:`viscotack.solve`.

    Attributes
    ----------
    kind : str
        Description such as "jump out of contact". A kind that begins with "jump" interrupts the
        curve: the motion of the step that ends at its time adds no work.
    time, depth, force : float
        State of the event; the force is the one just before.
    energy : float
        Energy dissipated in the event, not negative except for round-off.
    """

    kind: str
    time: float
    depth: float
    force: float
    energy: float


@dataclass(frozen=True)
class ShallowStart:
    """Replacement of a very deep start, whose depth has no effect, by a shallower one.

    Attributes
    ----------
    asked : float
        Depth of the requested start [h_0]; for one by force or radius the JKR depth.
    depth : float
        Depth at which the series begin, at rest and at time 0 [h_0].
    force, work : float
        Bounds on the relative change of force and work at pull-off by the deeper start; included in
        the error estimate.
    shift : float
        Bound on the change of the depth at pull-off [h_0].
    """

    asked: float
    depth: float
    force: float
    work: float
    shift: float


@dataclass(frozen=True, eq=False)
class Energies:
    """Energies over a run, in units of 1.5 pi R Delta-gamma_0 h_0 (for a punch sigma_0 h_0).

    Stored by :func:`viscotack.solve` in the `energy` of a result.

    Drive work = change of spring, elastic and interface energy + heat + interface heat + jumps +
    transfer.

    Attributes
    ----------
    drive : ndarray, shape (n,)
        Cumulative work of the drive.
    elastic, interface, spring : ndarray, shape (n,)
        Energy stored in the solid, across the gap (negative in contact, 0 far apart), and in the
        machine.
    heat : ndarray, shape (n,)
        Cumulative dissipation in the solid, summed over its modes.
    jumps, transfer : ndarray, shape (n,)
        Cumulative loss in jumps, and in transfers between meshes.
    mode_time, mode_heat : ndarray, shape (m,)
        Retardation time of each mode [time unit], and its total dissipation.
    interface_heat : ndarray, shape (n,)
        Cumulative dissipation in an interface whose tension grows with the opening speed.
    mode_weight : ndarray, shape (m,)
        Compliance of each mode over that of the relaxed solid. The instantaneous response has the
        remainder to 1.
    """

    drive: npt.NDArray[np.float64]
    elastic: npt.NDArray[np.float64]
    interface: npt.NDArray[np.float64]
    spring: npt.NDArray[np.float64]
    heat: npt.NDArray[np.float64]
    jumps: npt.NDArray[np.float64]
    transfer: npt.NDArray[np.float64]
    mode_time: npt.NDArray[np.float64]
    mode_heat: npt.NDArray[np.float64]
    interface_heat: npt.NDArray[np.float64]
    mode_weight: npt.NDArray[np.float64]

    def __post_init__(self) -> None:
        for name, values in vars(self).items():
            object.__setattr__(self, name, _frozen(values))


@dataclass(frozen=True)
class Sensitivities:
    """Elasticities of the pull-off by the inputs of a problem, from ``solve(sensitivities=True)``.

    They are slopes through simulations with each input changed by 2 %.

    Attributes
    ----------
    inputs : mapping
        Value of each input, by name: ``material.tau0``, ``protocol.preload_force``; in the unit of
        the problem.
    elasticities : mapping
        For each output y, its elasticity by each input x, (x/|y|) dy/dx: for positive outputs
        d ln y/d ln x.
    errors : mapping
        Errors of the elasticities, estimated from their differences to those of coarser
        simulations.
    refused : mapping
        Inputs, outputs, and outputs by an input that have no meaningful elasticity, and the reason.
    """

    inputs: Mapping[str, float]
    elasticities: Mapping[str, Mapping[str, float]]
    errors: Mapping[str, Mapping[str, float]]
    refused: Mapping[str, str]


def _versions() -> dict[str, str]:
    import scipy

    from viscotack.version import __version__

    return {"viscotack": __version__, "numpy": np.__version__, "scipy": scipy.__version__}


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """A simulated detachment; dimensionless series of equal length, one entry per step.

    Attributes
    ----------
    problem : Problem or Groups
        The solved problem.
    time, depth, force : ndarray
        Time from the start of the retraction, or of its simulated part (`shallow_start`);
        depth and force at each step.
    contact_radius : ndarray
        Outermost place where the gap is that of peak tension; nan without an edge.
    edge_speed : ndarray
        Receding speed of the edge, positive while the contact shrinks; nan without an edge.
        Its unit of length has no pi, see :func:`receding_speed`.
    status : str
        Ending of the run, a sentence that begins with an :class:`Outcome`.
    events : tuple of Event
        Jumps, in order of time.
    statistics : dict
        Cost: steps, newton_iterations, nodes, modes, wall_time_s.
    accuracy : float or None
        Requested relative error of the pull-off force; None if not recorded.
    error_estimate : dict or None
        Relative errors of ``force`` and ``work`` at pull-off, and error of its ``depth`` [h_0]; or
        relative error of the ``time`` to detachment under a load; relative error of ``hysteresis``,
        the largest of all cycles. None without an estimate.
    hysteresis_errors : tuple of float, or None
        Estimated relative error of the hysteresis of each cycle, nan for open loops; the
        largest is ``error_estimate["hysteresis"]``. None without an estimate.
    energy : Energies or None
        Energy balance at every step.
    energy_residual : float or None
        Largest imbalance of the energies over the largest cumulative term.
    fields : dict of ndarray, or None
        On request: time (m,), and radius, pressure, gap (m, n); pressure positive in compression.
    move : ndarray of int, or None
        Index of the move that led to each step, from 0; the final retraction is one more than the
        last move. None if not recorded.
    inner_radius : ndarray, or None
        Of a shape that may have several edges: the inner edge of the outermost part of the contact,
        0 where that is a disc around the axis, nan without a contact. Else None.
    rings : ndarray of int, or None
        Of such a shape: how many parts the contact has, each a ring or a disc at the axis.
    shallow_start : ShallowStart or None
        Actual start of the series, if the requested one was so deep that its depth has no
        effect.
    method : str
        "simulation"; "crack contact" if the range of the forces is too short for a simulation and
        the theory of a contact whose edge is a steady crack is used
        (:func:`viscotack.crack_contact`), with its band as the error of the force.
    sensitivities : Sensitivities or None
        Elasticities of the pull-off by the inputs, on request.
    versions : dict
        Versions of this package, numpy and scipy.
    """

    problem: Case
    time: npt.NDArray[np.float64]
    depth: npt.NDArray[np.float64]
    force: npt.NDArray[np.float64]
    contact_radius: npt.NDArray[np.float64]
    edge_speed: npt.NDArray[np.float64]
    status: str
    events: tuple[Event, ...] = ()
    statistics: Mapping[str, float] = field(default_factory=dict)
    error_estimate: Mapping[str, float] | None = None
    hysteresis_errors: tuple[float, ...] | None = None
    energy: Energies | None = None
    energy_residual: float | None = None
    fields: Mapping[str, npt.NDArray[np.float64]] | None = None
    move: npt.NDArray[np.intp] | None = None
    inner_radius: npt.NDArray[np.float64] | None = None
    rings: npt.NDArray[np.intp] | None = None
    shallow_start: ShallowStart | None = None
    accuracy: float | None = None
    method: str = "simulation"
    sensitivities: Sensitivities | None = None
    versions: Mapping[str, str] = field(default_factory=_versions)

    def __post_init__(self) -> None:
        for name in _SERIES:
            object.__setattr__(self, name, _frozen(getattr(self, name)))
        if self.fields is not None:
            arrays = {k: _frozen(v) for k, v in self.fields.items()}
            object.__setattr__(self, "fields", arrays)
        for name, kind in _OPTIONAL.items():
            if (values := getattr(self, name)) is not None:
                object.__setattr__(self, name, _frozen(values, kind))
        object.__setattr__(self, "events", tuple(self.events))
        if self.hysteresis_errors is not None:
            object.__setattr__(self, "hysteresis_errors", tuple(self.hysteresis_errors))
        self._check()

    def _check(self) -> None:
        if not isinstance(self.problem, Problem | Groups):
            raise InputError(
                f"problem must be a Problem or Groups, got {type(self.problem).__name__}"
            )
        named = {name: getattr(self, name) for name in (*_SERIES, "inner_radius", "rings")}
        lengths = {name: series.shape for name, series in named.items() if series is not None}
        if len(set(lengths.values())) != 1 or self.time.ndim != 1 or self.time.size == 0:
            raise InputError(
                f"the series of a result must be equally long and not empty, got {lengths}"
            )
        for name in ("time", "depth", "force"):
            if not np.all(np.isfinite(getattr(self, name))):
                raise InputError(f"the {name} of a result must be finite, got nan or infinity")
        move = self.move
        if move is not None and (move.shape != self.time.shape or np.any(np.diff(move) < 0)):
            raise InputError("the moves of a result must have one ascending index per step")
        if np.any(np.diff(self.time) < 0):
            raise InputError("the time of a result must not decrease")
        if not any(self.status.startswith(o) for o in Outcome):
            known = ", ".join(repr(str(o)) for o in Outcome)
            raise InputError(f"status must begin with one of {known}, got {self.status!r}")

    def __repr__(self) -> str:
        return f"<Result of the {self.method} in {self.time.size} steps: {self.status}>"

    def _repr_html_(self) -> str:
        """Return what a notebook shows."""
        from viscotack.plot.notebook import html_of_result

        return html_of_result(self)

    def to_frame(self) -> Any:
        """Return the series as a pandas DataFrame with the names of :func:`columns`."""
        return frame(columns(self))

    @cached_property
    def groups(self) -> Groups:
        """The dimensionless problem."""
        return self.problem.groups()

    def posed(self, groups: Any) -> "Result":
        """Return the result with its groups already computed."""
        vars(self)["groups"] = groups
        return self

    @cached_property
    def scales(self) -> Scales | PunchScales | None:
        """SI value of one unit of each number; None for a dimensionless problem."""
        return self.problem.scales()

    @property
    def outcome(self) -> Outcome:
        """Outcome at the beginning of the status sentence."""
        return Outcome.of(self.status)

    @property
    def accuracy_met(self) -> bool | None:
        """Whether the stated error is within the requested accuracy; None if unknown.

        The error is that of the pull-off force, or of the time to detachment under a load.
        """
        stated = self.error_estimate or {}
        error = stated.get("force", stated.get("time"))
        return None if error is None or self.accuracy is None else bool(error <= self.accuracy)

    @property
    def pull_off_force(self) -> float:
        """Largest tension of the last retraction, positive [1.5 pi R Delta-gamma_0].

        For a punch it is `pull_off_stress`. This and the following properties call the functions of
        the same names and raise their errors; :func:`viscotack.summary` has all numbers, also in
        SI.
        """
        from .observables import pull_off_force

        return pull_off_force(self)

    @property
    def pull_off_stress(self) -> float:
        """Largest mean tension of the last retraction of a punch, positive [sigma_0]."""
        from .observables import pull_off_stress

        return pull_off_stress(self)

    @property
    def work_to_pull_off(self) -> float:
        """Work of the drive from zero force to the pull-off [1.5 pi R Delta-gamma_0 h_0].

        For a punch [Delta-gamma_0], per unit area.
        """
        from .observables import work_to_pull_off

        return work_to_pull_off(self)

    @property
    def depth_at_pull_off(self) -> float:
        """Depth at the pull-off [h_0], positive into the solid."""
        from .observables import depth_at_pull_off

        return depth_at_pull_off(self)


def _frozen(values: npt.ArrayLike, dtype: type = float) -> npt.NDArray[Any]:
    array = np.array(values, dtype=dtype)
    array.setflags(write=False)
    return array


def receding_speed(time: npt.ArrayLike, edge: npt.ArrayLike) -> npt.NDArray[np.float64]:
    r"""Return the receding speed of the edge, from its place at uneven times.

    .. math:: v = -da / dt

    Second order in the steps, in the unit of the edge over that of the time. Radii of spheres are
    in (pi R^2 Delta-gamma_0/E_0*)^(1/3) and speeds without the pi: multiply by pi^(1/3).

    Parameters
    ----------
    time : array_like, shape (n,)
        Times, not decreasing; two equal ones mark a jump, where the speed is undefined.
    edge : array_like, shape (n,)
        Contact radii, or halves of the width of a contact; nan without an edge.

    Returns
    -------
    ndarray, shape (n,)
        Speed, positive while the contact shrinks; nan if undefined.
    """
    t, a = np.asarray(time, dtype=float), np.asarray(edge, dtype=float)
    speed = np.full_like(a, np.nan)
    # A piece ends where time does not advance, or the edge appears or vanishes.
    known = np.isfinite(a)
    starts = np.flatnonzero((np.diff(t, prepend=-np.inf) <= 0) | (known != np.roll(known, 1)))
    for piece in np.split(np.arange(t.size), starts):
        if piece.size > 1 and known[piece[0]]:
            order = 2 if piece.size > 2 else 1
            way = a[piece] - a[piece[0]]  # so that an edge at rest has exactly zero speed
            speed[piece] = -np.gradient(way, t[piece], edge_order=order)
    return speed


def columns(result: Result) -> dict[str, npt.NDArray[np.float64]]:
    """Return the series by column name: dimensionless, then in SI with the unit in the name.

    Parameters
    ----------
    result : Result
        Result of a simulation.

    Returns
    -------
    dict of str to ndarray, shape (n,)
        Series by column name.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(tabor=2.0, material=solid, start=AtDepth(10.0), rate=10.0)
    >>> result = solve(test, until="pull-off", accuracy=0.02, estimate_error=False)
    >>> list(columns(result))
    ['time', 'depth', 'force', 'contact_radius', 'edge_speed']
    """
    outputs, groups, scales = result.problem.outputs.series, result.groups, result.scales
    table = {n: getattr(result, o.source) * o.factor(groups) for n, o in outputs.items()}
    if scales is None:
        return table
    return table | {
        f"{n}_{o.unit.tail}": table[n] * getattr(scales, o.unit.scale)
        for n, o in outputs.items()
        if o.unit.scale
    }


def write_csv(result: Result, path: Target) -> None:
    """Write the series as a comma-separated table with a row of column names; see `columns`.

    The target is a file, which is written atomically, or an open binary file such as
    ``sys.stdout.buffer``.

    Parameters
    ----------
    result : Result
        Result of a simulation.
    path : path or binary file
        Output file.

    Raises
    ------
    NotWritten
        If the file cannot be written; an existing file is then unchanged.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(tabor=2.0, material=solid, start=AtDepth(10.0), rate=10.0)
    >>> result = solve(test, until="pull-off", accuracy=0.02, estimate_error=False)
    >>> import io
    >>> file = io.BytesIO()
    >>> write_csv(result, file)
    >>> file.getvalue().decode().split(",")[:3]
    ['time', 'depth', 'force']
    """
    write_table(columns(result), path)


def save(result: Result, path: Target) -> None:
    """Write a result to a file, atomically; :func:`load` reads it.

    The format is NumPy's .npz of plain arrays with a header in JSON; nothing in it is executed on
    reading. Any file name is allowed; ``.npz`` is the usual ending.

    Parameters
    ----------
    result : Result
        Result to write.
    path : path or binary file
        Output file.

    Raises
    ------
    NotWritten
        If the file cannot be written; an existing file is then unchanged.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(tabor=2.0, material=solid, start=AtDepth(10.0), rate=10.0)
    >>> result = solve(test, until="pull-off", accuracy=0.02, estimate_error=False)
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     save(result, Path(folder, "run.npz"))
    ...     again = load(Path(folder, "run.npz"))
    >>> bool((again.force == result.force).all())
    True
    """
    header = {name: getattr(result, name) for name in _PLAIN} | {
        "format": _FORMAT,
        "format_version": _FORMAT_VERSION,
        "problem": to_dict(result.problem),
        "events": [asdict(event) for event in result.events],
        "shallow_start": result.shallow_start and asdict(result.shallow_start),
        "sensitivities": result.sensitivities and asdict(result.sensitivities),
    }
    arrays = {name: getattr(result, name) for name in (*_SERIES, *_OPTIONAL)}
    arrays |= {f"energy/{k}": v for k, v in vars(result.energy).items()} if result.energy else {}
    arrays |= {f"fields/{k}": v for k, v in (result.fields or {}).items()}
    arrays = {name: array for name, array in arrays.items() if array is not None}
    content = io.BytesIO()
    np.savez_compressed(content, header=np.array(json.dumps(header, default=dict)), **arrays)
    write_whole(path, content.getvalue())


def load(path: str | os.PathLike[str], *, also: Iterable[Any] = ()) -> Result:
    """Read a result written by :func:`save`.

    Parameters
    ----------
    path : path
        The file.
    also : iterable of classes
        User-defined laws, materials and shapes of the problem.

    Returns
    -------
    Result
        With equal problem, arrays, status and versions; ``==`` of results compares identity.

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    ValueError
        If the file is not a saved result, is damaged, or was written by a newer version.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid, solve
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> test = Groups(tabor=2.0, material=solid, start=AtDepth(10.0), rate=10.0)
    >>> result = solve(test, until="pull-off", accuracy=0.02, estimate_error=False)
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     save(result, Path(folder, "run.npz"))
    ...     again = load(Path(folder, "run.npz"))
    >>> bool((again.force == result.force).all())
    True
    """
    names = re.compile("|".join(["header", *_SERIES, *_OPTIONAL, "(energy|fields)/.+"]))
    try:
        with open(path, "rb") as file:
            arrays = read_arrays(file, lambda name: bool(names.fullmatch(name)))
        header = json.loads(str(arrays.pop("header")))
        if header["format"] != _FORMAT:
            raise InputError("its header is not that of a viscotack result")
        if header["format_version"] <= _FORMAT_VERSION:
            return _from_parts(header, arrays, also)
        writer = header["versions"]["viscotack"]
    except FileNotFoundError:
        raise
    except UnknownNoun as error:
        raise UnknownNoun(f"{os.fspath(path)}: {error}") from None
    except _UNREADABLE as error:
        raise InputError(
            f"{os.fspath(path)} is not a readable result of viscotack (damaged, or another kind of "
            f"file): {error}; give a file written by viscotack.save or --save"
        ) from error
    raise InputError(
        f"{os.fspath(path)} was written by viscotack {writer} in a newer format; update viscotack"
    )


def _from_parts(
    header: dict[str, Any], arrays: dict[str, npt.NDArray], also: Iterable[Any]
) -> Result:
    def group(name: str) -> dict[str, npt.NDArray] | None:
        prefix = f"{name}/"
        found = {k.removeprefix(prefix): v for k, v in arrays.items() if k.startswith(prefix)}
        return found or None

    began, slopes, energy = header["shallow_start"], header["sensitivities"], group("energy")
    return Result(
        problem=from_dict(header["problem"], also),
        **{name: arrays[name] for name in _SERIES},
        **{name: arrays.get(name) for name in _OPTIONAL},
        **{name: header[name] for name in _PLAIN},
        events=tuple(Event(**event) for event in header["events"]),
        energy=Energies(**energy) if energy else None,
        fields=group("fields"),
        shallow_start=began and ShallowStart(**began),
        sensitivities=slopes and Sensitivities(**slopes),
    )
