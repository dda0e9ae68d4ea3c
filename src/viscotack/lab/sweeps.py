r"""Laboratory data: frequency sweeps, master curves, relaxation and creep tests.

Every array is in SI, finite and read-only. `kind` is the kind of modulus: ``"E"`` from tension,
compression or bending, ``"G"`` from shear or torsion. Conversion between them always needs a
Poisson ratio.

Convention of shift factors: log10 a_T is positive where the solid is slower than at the
reference temperature, that is below it. A point at omega and T is shifted to omega a_T; its moduli
are multiplied by 10^log10_vertical to give those at the reference temperature.

Points are assigned to sweeps by temperature or by the reversal of the frequency; sweeps of one
temperature that contradict each other are refused, not pooled. Several files are joined as one
material.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any, ClassVar, Self

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.materials.constants import poisson_ratio as checked_poisson_ratio
from viscotack.model.materials.shift import TabulatedShift

KINDS = {"E": "tension", "G": "shear"}

Integers = npt.NDArray[np.int64]
Complex = npt.NDArray[np.complex128]


@dataclass(frozen=True)
class Source:
    """Origin of numbers.

    Parameters
    ----------
    path : str
        File name as given by the caller; empty for numbers created in memory.
    sha256 : str
        Hash of the file's bytes, in hexadecimal.
    format : str
        Format of the file, one of the names in ``viscotack.lab.FORMATS``; ``"memory"``
        for numbers created in memory.
    notes : tuple of str
        Decisions while reading: detected units, rejected points, changed order.

    Examples
    --------
    >>> Source().format
    'memory'
    """

    path: str = ""
    sha256: str = ""
    format: str = "memory"
    notes: tuple[str, ...] = ()

    def noted(self, *notes: str) -> "Source":
        """Return the source with additional notes."""
        return replace(self, notes=(*self.notes, *notes))


_UNITS = {
    "angular_frequency": "rad/s", "time": "s", "storage": "Pa", "loss": "Pa", "modulus": "Pa",
    "compliance": "1/Pa", "temperature": "K", "reference_temperature": "K", "sweep": "-",
}  # fmt: skip


class _Measured:
    """What all measurements have in common: a modulus, or its inverse, in tension or in shear."""

    measured: ClassVar[tuple[str, ...]]  # names of the numbers
    along: ClassVar[str]  # their axis
    sorts: ClassVar[bool] = True  # in ascending order of the axis
    single: ClassVar[str] = ""  # name of a temperature of the whole measurement
    power: ClassVar[int] = 1  # of the modulus that they are
    kind: str
    source: Source

    def __post_init__(self):
        if self.kind not in KINDS:
            raise InputError(f"kind must be 'E' (tensile) or 'G' (shear), got {self.kind!r}")
        axis = array(self.along, getattr(self, self.along), _UNITS[self.along])
        order = np.argsort(axis, kind="stable") if self.sorts else np.arange(axis.size)
        for name, unit in _UNITS.items():
            value, single = getattr(self, name, None), name == self.single
            if value is None:
                continue
            row = array(name, [value] if single else value, unit, 1 if single else axis.size)
            if name == "sweep":
                right, must = row == np.round(row), "whole numbers"
            else:
                unknown = np.isnan(row) & (name == "temperature" and not single)
                right, must = (row > 0) & (row < np.inf) | unknown, f"positive and finite [{unit}]"
            if not right.all():
                cure = "; give Celsius + 273.15" if unit == "K" else ""
                raise InputError(f"{name} must be {must}, got {row[~right][0]:g}{cure}")
            if single:
                object.__setattr__(self, name, float(row[0]))
            else:
                store(self, name, (row.astype(np.int64) if name == "sweep" else row)[order])

    def __len__(self) -> int:
        return getattr(self, self.measured[0]).size

    def in_tension(self, poisson_ratio: float) -> Self:
        """Convert shear to tension by E = 2 (1 + nu) G; a tensile modulus is unchanged.

        Parameters
        ----------
        poisson_ratio : float
            nu, in [0, 0.5], the same at every frequency. A note records it.
        """
        nu = checked_poisson_ratio(poisson_ratio)
        if self.kind == "E":
            return self
        factor = (2 * (1 + nu)) ** self.power
        this: Any = self
        return replace(
            this,
            kind="E",
            source=self.source.noted(f"shear converted to tension with Poisson ratio {nu:g}"),
            **{name: factor * getattr(self, name) for name in self.measured},
        )


class _Moduli(_Measured):
    """What sweeps and master curves have in common: storage and loss modulus."""

    measured: ClassVar = ("storage", "loss")
    along: ClassVar = "angular_frequency"
    storage: Array
    loss: Array

    @property
    def complex_modulus(self) -> Complex:
        """Storage + i loss [Pa], shape (N,)."""
        return self.storage + 1j * self.loss

    def chosen(self, points: npt.ArrayLike) -> Self:
        """Select points, by indices or by a mask of shape (N,)."""
        columns = {
            name: values[np.asarray(points)]
            for name, values in vars(self).items()
            if isinstance(values, np.ndarray)
        }
        this: Any = self
        return replace(this, **columns)


@dataclass(frozen=True, eq=False)
class FrequencySweeps(_Moduli):
    """Storage and loss modulus over frequency, at one or more temperatures.

    Parameters
    ----------
    temperature : array_like, shape (N,)
        Temperature of each point [K], positive; nan if unknown.
    angular_frequency : array_like, shape (N,)
        2 pi f [rad/s], positive.
    storage, loss : array_like, shape (N,)
        Real and imaginary part of the complex modulus [Pa], positive.
    kind : {"E", "G"}
        Tensile or shear modulus.
    sweep : array_like of int, shape (N,)
        Sweep number of each point.
    source : Source
        Origin of the points.

    Raises
    ------
    ValueError
        If lengths differ, there are no points, or a number is not positive and finite.

    Examples
    --------
    >>> shear = FrequencySweeps([293.15, 293.15], [1, 10], [1e6, 2e6], [1e5, 3e5], "G", [0, 0])
    >>> shear.in_tension(0.5).storage.tolist()
    [3000000.0, 6000000.0]
    """

    sorts: ClassVar = False

    temperature: Array
    angular_frequency: Array
    storage: Array
    loss: Array
    kind: str
    sweep: Integers
    source: Source = Source()


@dataclass(frozen=True, eq=False)
class MasterCurve(_Moduli):
    """Storage and loss modulus at one temperature, from shifted sweeps.

    Parameters
    ----------
    reference_temperature : float or None
        Temperature of the curve [K]; None if unknown.
    angular_frequency : array_like, shape (N,)
        Shifted angular frequency omega a_T [rad/s], positive.
    storage, loss : array_like, shape (N,)
        Moduli at the reference temperature [Pa], positive.
    kind : {"E", "G"}
        Tensile or shear modulus.
    shifts : TabulatedShift or None
        Shift factors used.
    source : Source
        Origin of the points.
    temperature : array_like, shape (N,), or None
        Temperature at which each point was measured [K].
    sweep : array_like of int, shape (N,), or None
        Sweep in which each point was measured.

    Examples
    --------
    >>> curve = MasterCurve(293.15, [100, 1], [2e6, 1e6], [3e5, 1e5], "E")
    >>> curve.angular_frequency.tolist()
    [1.0, 100.0]
    """

    single: ClassVar = "reference_temperature"

    reference_temperature: float | None
    angular_frequency: Array
    storage: Array
    loss: Array
    kind: str
    shifts: TabulatedShift | None = None
    source: Source = Source()
    temperature: Array | None = None
    sweep: Integers | None = None


class _StepTest(_Measured):
    """What relaxation and creep tests have in common: a number over the time since the step."""

    along: ClassVar = "time"
    single: ClassVar = "temperature"
    time: Array


@dataclass(frozen=True, eq=False)
class RelaxationTest(_StepTest):
    """Modulus over time after a step of strain.

    Parameters
    ----------
    time : array_like, shape (N,)
        Time since the step [s], positive; sorted in ascending order.
    modulus : array_like, shape (N,)
        Stress over strain [Pa], positive.
    kind : {"E", "G"}
        Tensile or shear modulus.
    strain : float or None
        Height of the step [-].
    temperature : float or None
        Temperature of the test, or of a master curve [K].
    source : Source
        Origin of the points.

    Examples
    --------
    >>> RelaxationTest([1, 10], [2e6, 1e6], "G").in_tension(0.5).modulus.tolist()
    [6000000.0, 3000000.0]
    """

    measured: ClassVar = ("modulus",)

    time: Array
    modulus: Array
    kind: str
    strain: float | None = None
    temperature: float | None = None
    source: Source = Source()


@dataclass(frozen=True, eq=False)
class CreepTest(_StepTest):
    """Compliance over time after a step of stress.

    Parameters
    ----------
    time : array_like, shape (N,)
        Time since the step [s], positive; sorted in ascending order.
    compliance : array_like, shape (N,)
        Strain over stress [1/Pa], positive.
    kind : {"E", "G"}
        Tensile compliance (often called D) for ``"E"``, shear compliance (J) for ``"G"``.
    stress : float or None
        Height of the step [Pa].
    temperature : float or None
        Temperature of the test, or of a master curve [K].
    source : Source
        Origin of the points.

    Examples
    --------
    >>> CreepTest([1, 10], [3e-6, 6e-6], "G").in_tension(0.5).compliance.tolist()
    [1e-06, 2e-06]
    """

    measured: ClassVar = ("compliance",)
    power: ClassVar = -1

    time: Array
    compliance: Array
    kind: str
    stress: float | None = None
    temperature: float | None = None
    source: Source = Source()


# ---- text of temperatures; validated, read-only columns ------------------------------------------


def celsius(kelvin: float) -> str:
    """Return a temperature [K] in Celsius, as text for people."""
    return f"{kelvin - 273.15:.4g} C"


def array(name: str, values: npt.ArrayLike, unit: str, length: int | None = None) -> Array:
    """Return a copy as a one-dimensional array of floats, of a given length."""
    row = np.array(values, dtype=float)
    if row.ndim != 1 or not row.size:
        raise InputError(f"{name} must be a row of numbers [{unit}], got shape {row.shape}")
    if length is not None and row.size != length:
        raise InputError(f"{name} has {row.size} values where the others have {length}")
    return row


def store(instance: Any, name: str, row: npt.NDArray[Any]) -> None:
    """Store a read-only array."""
    row.flags.writeable = False
    object.__setattr__(instance, name, row)


# ---- sweeps by temperature, and of several files -------------------------------------------------

# K: least difference between two sweeps; chambers hold the temperature within a few tenths
GAP = 1.0
# K: sweeps closer than this must agree; a ramp may pass through neighbouring temperatures
_ONE_TEMPERATURE = 0.3
_UNLIKE = 0.1  # relative difference of sweeps of one state that is refused, if beyond their scatter
_COMPARED = 3  # points that sweeps need to be compared


def grouped(temperature: Array, angular_frequency: Array) -> tuple[npt.NDArray[np.int64], str]:
    """Assign each point to a frequency sweep; return the sweep numbers and a note.

    Parameters
    ----------
    temperature, angular_frequency : ndarray, shape (N,)
        Of the points, in the order of the file; temperatures may be nan (unknown).

    Returns
    -------
    numbers : ndarray of int, shape (N,)
        Sweep of each point, counted from 0.
    how : str
        Note on the method; empty for a single sweep.

    Notes
    -----
    Points within 1 K are one sweep if no frequency occurs twice among them, in any order.
    Otherwise a sweep ends where the frequency reverses direction. One frequency at many
    temperatures is one sweep.

    Examples
    --------
    >>> numbers, how = grouped(np.array([300.0, 290.1, 300.2, 290.0]), np.array([1.0, 1, 10, 10]))
    >>> numbers.tolist(), how
    ([0, 1, 0, 1], '2 sweeps separated by temperature')
    """
    one = np.zeros(temperature.size, dtype=np.int64)
    if np.ptp(angular_frequency) <= 1e-3 * angular_frequency[0]:
        return one, ""
    clusters = np.empty(temperature.size, dtype=np.int64)
    for number, points in enumerate(levels(temperature)):
        clusters[points] = number
    pairs = np.stack((clusters, np.round(1000 * np.log(angular_frequency))))
    # each frequency once at each temperature
    if not np.isnan(temperature).any() and np.unique(pairs, axis=1).shape[1] == clusters.size:
        how = "temperature"
    else:
        how, direction = "frequency reversal", 0.0
        clusters = np.zeros(temperature.size, dtype=np.int64)
        for i, step in enumerate(np.sign(np.diff(angular_frequency)), start=1):
            reverses = step * direction < 0
            clusters[i] = clusters[i - 1] + reverses
            direction = 0.0 if reverses else step or direction
    # numbered in the order of the file
    _, first, numbers = np.unique(clusters, return_index=True, return_inverse=True)
    numbers = np.argsort(np.argsort(first))[numbers]
    count = first.size
    return numbers, f"{count} sweeps separated by {how}" if count > 1 else ""


def levels(temperature: Array) -> list[npt.NDArray[np.int64]]:
    """Return the indices of the points of each temperature, from cold to hot."""
    order = np.argsort(temperature, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(temperature[order]) > GAP) + 1)


def refuse_unlike(sweeps: FrequencySweeps) -> None:
    """Raise an error if sweeps at one temperature differ by more than their scatter.

    They are then of several samples, positions or states, which are no one material.
    """
    parts = _passes(sweeps)
    for (T, x, y), (other, u, v) in combinations(parts, 2):
        if abs(T - other) > _ONE_TEMPERATURE or np.isnan(T) != np.isnan(other):
            continue
        inside = (x >= u[0] - 1e-9) & (x <= u[-1] + 1e-9)
        if inside.sum() < _COMPARED:
            continue
        off = y[inside] - np.interp(x[inside], u, v)
        apart, scatter = abs(float(np.median(off))), float(np.std(off))
        if apart > max(np.log1p(_UNLIKE), 3 * scatter / np.sqrt(off.size)):
            where = "unknown temperature" if np.isnan(T) else celsius(T)
            raise InputError(
                f"{sweeps.source.path or 'the sweeps'}: sweeps at {where} differ by "
                f"{100 * np.expm1(apart):.2g} %: several samples, states or unstated "
                "temperatures; choose one by `where` or `table`"
            )


def _passes(sweeps: FrequencySweeps) -> list[tuple[float, Array, Array]]:
    """Return temperature, log10 of frequency and ln of the modulus of each run of frequencies.

    A sweep in which a frequency occurs repeatedly has several runs; a ramp of the temperature none.
    """
    found = []
    size = np.log(np.hypot(sweeps.storage, sweeps.loss))
    keys = np.round(1000 * np.log(sweeps.angular_frequency)).astype(np.int64)
    for number in np.unique(sweeps.sweep):
        own = np.flatnonzero(sweeps.sweep == number)
        temperature = sweeps.temperature[own]
        if np.ptp(temperature) > GAP:
            continue
        order = own[np.argsort(keys[own], kind="stable")]
        begins = np.flatnonzero(np.diff(keys[order], prepend=keys[order[0]] - 1))
        turn = np.arange(order.size) - np.repeat(begins, np.diff(begins, append=order.size))
        for each in range(int(turn.max()) + 1):
            points = order[turn == each]
            if points.size >= _COMPARED:
                x = np.log10(sweeps.angular_frequency[points])
                found.append((float(np.mean(temperature)), x, size[points]))
    return found


def joined(parts: Sequence[FrequencySweeps]) -> FrequencySweeps:
    """Join the sweeps of several files into one set, with consecutive sweep numbers.

    Raises
    ------
    ValueError
        If some files are tensile and others shear, or two files are identical.

    Notes
    -----
    The source names all files; its hash is the hash of the files' hashes in this order, and each
    of these is noted.
    """
    if len(parts) == 1:
        return parts[0]
    if len({part.kind for part in parts}) > 1:
        raise InputError("some files are tensile (E), others shear (G); set `kind` to one")
    return numbered_on(parts, joined_source([part.source for part in parts]))


def numbered_on(parts: Sequence[FrequencySweeps], source: Source) -> FrequencySweeps:
    """Join sweeps of one kind into one set, with consecutive sweep numbers."""
    numbers, count = [], 0
    for part in parts:
        own, renumbered = np.unique(part.sweep, return_inverse=True)
        numbers.append(renumbered + count)
        count += own.size
    names = ("temperature", "angular_frequency", "storage", "loss")
    return FrequencySweeps(
        **{name: np.concatenate([getattr(part, name) for part in parts]) for name in names},
        kind=parts[0].kind,
        sweep=np.concatenate(numbers),
        source=source,
    )


def joined_source(sources: Sequence[Source]) -> Source:
    """Join several files into one source of one material, with the notes of each."""
    hashes = [source.sha256 for source in sources]
    for i, digest in enumerate(hashes):
        if digest and digest in hashes[:i]:
            twin = sources[hashes.index(digest)].path
            raise InputError(f"{sources[i].path} is the same file as {twin}; omit one of them")
    notes = [f"{len(sources)} files joined as one material"]
    notes += [f"{source.path}: sha256 {source.sha256}" for source in sources]
    notes += [f"{source.path}: {note}" for source in sources for note in source.notes]
    return Source(
        path=", ".join(source.path for source in sources),
        sha256=hashlib.sha256("".join(hashes).encode()).hexdigest(),
        format=", ".join(dict.fromkeys(source.format for source in sources)),
        notes=tuple(notes),
    )
