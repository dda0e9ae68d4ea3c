r"""Laboratory data: frequency sweeps, master curves, relaxation and creep tests.

Every array is in SI, finite and read-only. `kind` is the kind of modulus: ``"E"`` from tension,
compression or bending, ``"G"`` from shear or torsion. Conversion between them always needs a
Poisson ratio.

Convention of shift factors: log10 a_T is positive where the solid is slower than at the
reference temperature, that is below it. A point at omega and T is shifted to omega a_T; its moduli
are multiplied by 10^log10_vertical to give those at the reference temperature.
"""

from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.model.materials.checks import temperatures
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


class _Moduli:
    """What sweeps and master curves have in common: storage and loss modulus."""

    storage: Array
    loss: Array

    def __len__(self) -> int:
        return self.storage.size

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

    def in_tension(self, poisson_ratio: float) -> Self:
        """Convert to the tensile modulus E = 2 (1 + nu) G; a tensile modulus is unchanged.

        Parameters
        ----------
        poisson_ratio : float
            nu, in [0, 0.5], the same at every frequency.
        """
        return in_tension(self, poisson_ratio, "storage", "loss")


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

    temperature: Array
    angular_frequency: Array
    storage: Array
    loss: Array
    kind: str
    sweep: Integers
    source: Source = Source()

    def __post_init__(self):
        check_kind(self.kind)
        store_columns(
            self,
            temperature=("K", True),
            angular_frequency=("rad/s", False),
            storage=("Pa", False),
            loss=("Pa", False),
        )
        store_whole(self, "sweep", self.sweep, self.storage.size)

    @property
    def ids(self) -> tuple[int, ...]:
        """Sweep numbers, ascending."""
        return tuple(int(number) for number in np.unique(self.sweep))

    def at(self, sweep: int) -> "FrequencySweeps":
        """Return one sweep, in ascending order of frequency."""
        found = np.flatnonzero(self.sweep == sweep)
        if not found.size:
            raise InputError(f"no sweep {sweep}; available: {list(self.ids)}")
        return self.chosen(found[np.argsort(self.angular_frequency[found], kind="stable")])


@dataclass(frozen=True, eq=False)
class ShiftTable:
    """Shift factors, one per temperature.

    Parameters
    ----------
    temperature : array_like, shape (M,)
        Temperatures [K], positive; sorted in ascending order.
    log10_shift : array_like, shape (M,)
        log10 a_T, positive where the solid is slower than at the reference, where it is zero.
    uncertainty : array_like, shape (M,), or None
        Standard deviation of log10_shift, not negative; None if unknown.
    log10_vertical : array_like, shape (M,), or None
        log10 of the factor that converts a modulus to the reference temperature; None for 1.

    Examples
    --------
    >>> table = ShiftTable([293.15, 253.15], [0, 3.1], None)
    >>> table.temperature.tolist()
    [253.15, 293.15]
    """

    temperature: Array
    log10_shift: Array
    uncertainty: Array | None
    log10_vertical: Array | None = None

    def __post_init__(self):
        temperature = temperatures("temperature", array("temperature", self.temperature, "K"))
        order = np.argsort(temperature, kind="stable")
        if np.any(np.diff(temperature[order]) == 0):
            raise InputError("a table of shift factors must have one row per temperature")
        for name in ("temperature", "log10_shift", "uncertainty", "log10_vertical"):
            values = getattr(self, name)
            if values is None:
                continue
            values = array(name, values, "-", temperature.size)[order]
            if not np.all(np.isfinite(values)):
                raise InputError(f"{name} must be finite")
            if name == "uncertainty" and np.any(values < 0):
                raise InputError(f"uncertainty must not be negative, got {values.min():g}")
            store(self, name, values)

    def __len__(self) -> int:
        return self.temperature.size

    def at_reference(self, temperature: float) -> TabulatedShift:
        """Return a tabulated law with zero shift at a temperature [K]; needs two or more rows."""
        columns = (self.temperature, self.log10_shift, self.uncertainty, self.log10_vertical)
        return TabulatedShift(
            temperature, *(() if values is None else tuple(values.tolist()) for values in columns)
        )


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
    shifts : ShiftTable or None
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

    reference_temperature: float | None
    angular_frequency: Array
    storage: Array
    loss: Array
    kind: str
    shifts: ShiftTable | None = None
    source: Source = Source()
    temperature: Array | None = None
    sweep: Integers | None = None

    def __post_init__(self):
        check_kind(self.kind)
        store_temperature(self, "reference_temperature")
        store_columns(
            self, angular_frequency=("rad/s", False), storage=("Pa", False), loss=("Pa", False)
        )
        if self.temperature is not None:
            store_columns(self, storage=("Pa", False), temperature=("K", True))
        if self.sweep is not None:
            store_whole(self, "sweep", self.sweep, self.storage.size)
        sort_along(self, self.angular_frequency)


class _StepTest:
    """What relaxation and creep tests have in common: a number over the time since the step."""

    # name and unit of the number, and the power of the modulus that it is
    measured: ClassVar[tuple[str, str, int]]
    time: Array
    kind: str

    def __post_init__(self):
        name, unit, _ = self.measured
        check_kind(self.kind)
        store_temperature(self, "temperature")
        store_columns(self, time=("s", False), **{name: (unit, False)})
        sort_along(self, self.time)

    def __len__(self) -> int:
        return self.time.size

    def in_tension(self, poisson_ratio: float) -> Self:
        """Convert a shear to a tensile modulus, 2 (1 + nu) G, or compliance, J/(2 (1 + nu))."""
        name, _, power = self.measured
        return in_tension(self, poisson_ratio, name, power=power)


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

    measured: ClassVar = ("modulus", "Pa", 1)

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

    measured: ClassVar = ("compliance", "1/Pa", -1)

    time: Array
    compliance: Array
    kind: str
    stress: float | None = None
    temperature: float | None = None
    source: Source = Source()


# ---- validated, read-only columns ----------------------------------------------------------------


def check_kind(kind: Any) -> None:
    """Raise an error unless the kind of modulus is "E" (tensile) or "G" (shear)."""
    if kind not in KINDS:
        raise InputError(f"kind must be 'E' (tensile) or 'G' (shear), got {kind!r}")


def store_temperature(instance: Any, name: str) -> None:
    """Store one temperature [K] as a float, or None where it is unknown."""
    value = getattr(instance, name)
    if value is None:
        return
    number = float(value)
    if not 0 < number < np.inf:
        raise InputError(f"{name} must be positive [K], got {value!r}; give Celsius + 273.15")
    object.__setattr__(instance, name, number)


def array(name: str, values: npt.ArrayLike, unit: str, length: int | None = None) -> Array:
    """Return a copy as a one-dimensional array of floats, of a given length."""
    row = np.array(values, dtype=float)
    if row.ndim != 1 or not row.size:
        raise InputError(f"{name} must be a row of numbers [{unit}], got shape {row.shape}")
    if length is not None and row.size != length:
        raise InputError(f"{name} has {row.size} values where the others have {length}")
    return row


def store_columns(instance: Any, **units: tuple[str, bool]) -> None:
    """Store positive read-only arrays of one length; some columns may contain nan (unknown)."""
    length = None
    for name, (unit, may_miss) in units.items():
        row = array(name, getattr(instance, name), unit, length)
        length = row.size
        wrong = row[~((row > 0) & (row < np.inf) | (may_miss & np.isnan(row)))]
        if wrong.size:
            cure = "; give Celsius + 273.15" if unit == "K" else ""
            raise InputError(f"{name} must be positive and finite [{unit}], got {wrong[0]:g}{cure}")
        store(instance, name, row)


def store_whole(instance: Any, name: str, values: npt.ArrayLike, length: int) -> None:
    """Store a row of whole numbers as a read-only array."""
    row = array(name, values, "-", length)
    broken = row[row != np.round(row)]
    if broken.size:
        raise InputError(f"{name} must be whole numbers, got {broken[0]:g}")
    store(instance, name, row.astype(np.int64))


def store(instance: Any, name: str, row: npt.NDArray[Any]) -> None:
    """Store a read-only array."""
    row.flags.writeable = False
    object.__setattr__(instance, name, row)


def sort_along(instance: Any, along: Array) -> None:
    """Sort all columns of a curve in ascending order of one of them."""
    order = np.argsort(along, kind="stable")
    for name, values in vars(instance).items():
        if isinstance(values, np.ndarray):
            store(instance, name, values[order])


def in_tension(instance: Any, poisson_ratio: float, *names: str, power: int = 1) -> Any:
    """Convert shear to tensile moduli; a note records the Poisson ratio used."""
    nu = checked_poisson_ratio(poisson_ratio)
    if instance.kind == "E":
        return instance
    factor = (2 * (1 + nu)) ** power
    return replace(
        instance,
        kind="E",
        source=instance.source.noted(f"shear converted to tension with Poisson ratio {nu:g}"),
        **{name: factor * getattr(instance, name) for name in names},
    )
