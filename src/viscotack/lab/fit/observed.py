"""Measured numbers prepared for a fit: tensile, in logarithms, with weights.

A frequency sweep has two numbers per point (storage and loss), a relaxation or creep test has one.
In logarithms an error of 2 % has the same weight at the glassy and the rubbery end.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.sweeps import (
    CreepTest,
    FrequencySweeps,
    MasterCurve,
    RelaxationTest,
    Source,
    refuse_unlike,
)
from viscotack.model.materials import Material

Data = MasterCurve | FrequencySweeps | RelaxationTest | CreepTest

# Quantity -> names of its parts, in the order of the rows.
PARTS = {
    "complex modulus": ("storage", "loss"),
    "storage modulus": ("storage",),
    "loss modulus": ("loss",),
    "relaxation": ("relaxation",),
    "creep": ("creep",),
}


# Largest range of one modulus: the best rheometers and DMA together cover 15 decades, from 1 mPa
# to the modulus of diamond. Computed values may underflow the smallest floating-point number.
_MOST_DECADES = 20


@dataclass(frozen=True, eq=False)
class Observed:
    """Measured numbers, converted to tension, for comparison with a material.

    Attributes
    ----------
    quantity : str
        "complex modulus", one part of it, "relaxation" or "creep".
    at : ndarray, shape (N,)
        Angular frequencies [rad/s], or times [s], ascending.
    values : ndarray, shape (P, N)
        One row per part of the quantity: moduli [Pa] or a compliance [1/Pa]; positive.
    noise : ndarray, shape (P,)
        Scatter of each part relative to the best one, at least 1; divides the residuals.
    poisson_ratio : float
        Constant Poisson ratio.
    kind : str
        "E" or "G": measured kind of modulus, before conversion to tension.
    temperature : float or None
        Temperature of the curve [K].
    temperatures : (float, float) or None
        Lowest and highest measured temperature [K].
    source : Source
        Origin of the numbers.
    sweep : ndarray of int, shape (N,), or None
        Sweep in which each point was measured, if known.
    points : int
        Number of measured points if `at` contains means of them, else 0.
    """

    quantity: str
    at: Array
    values: Array
    noise: Array
    poisson_ratio: float
    kind: str
    temperature: float | None
    temperatures: tuple[float, float] | None
    source: Source
    sweep: npt.NDArray[np.int64] | None = None
    points: int = 0

    @property
    def parts(self) -> tuple[str, ...]:
        """Names of the rows of `values`."""
        return PARTS[self.quantity]

    @property
    def in_frequency(self) -> bool:
        """Whether `at` contains frequencies; otherwise times."""
        return self.quantity.endswith(" modulus")

    @property
    def logs(self) -> Array:
        """Natural logarithms of all numbers, part by part, shape (P N,)."""
        return np.log(self.values).ravel()

    @property
    def frequencies(self) -> tuple[float, float]:
        """Lowest and highest angular frequency [rad/s]; for a test over time, 1/time."""
        low, high = float(self.at[0]), float(self.at[-1])
        return (low, high) if self.in_frequency else (1 / high, 1 / low)

    @property
    def moduli(self) -> tuple[float, float]:
        """Smallest and largest measured modulus [Pa]: storage, relaxation or inverse creep."""
        first = self.values[0] if self.quantity != "creep" else 1 / self.values[0]
        return float(np.min(first)), float(np.max(first))

    def predicted(self, material: Material, at: npt.ArrayLike | None = None) -> Array:
        """Predict `values` from a material, at `at` or other places, shape (P, N)."""
        x = self.at if at is None else np.asarray(at, dtype=float)
        if self.in_frequency:
            modulus = np.asarray(material.complex_modulus(x))
            both = {"storage": np.real(modulus), "loss": np.imag(modulus)}
            return np.array([both[part] for part in self.parts])
        answer = material.relaxation if self.quantity == "relaxation" else material.creep
        return np.asarray(answer(x))[None, :]

    def residuals(self, material: Material) -> Array:
        """Return ln(measured) - ln(material), shape (P, N)."""
        with np.errstate(divide="ignore"):  # a loss that underflows gives an infinite residual
            return np.log(self.values) - np.log(self.predicted(material))

    def weighed(self, residuals: Array) -> Array:
        """Return residuals over the noise of their part, shape (P, N)."""
        return residuals / self.noise[:, None]


def only(data: Observed, part: str) -> Observed:
    """Select one part of the complex modulus, "storage" or "loss"."""
    if not data.in_frequency:
        raise InputError(f"a test of {data.quantity} has no loss modulus to omit")
    row = data.values[[data.parts.index(part)]]
    return replace(data, quantity=f"{part} modulus", values=row, noise=np.ones(1))


def observed(data: Any, *, poisson_ratio: float) -> Observed:
    """Prepare a master curve, one sweep, or a test over time for a fit.

    Parameters
    ----------
    data : MasterCurve, FrequencySweeps, RelaxationTest or CreepTest
        Sweeps at several temperatures are rejected; make a master curve first.
    poisson_ratio : float
        Poisson ratio, in [0, 0.5]; also required for a tensile test, because the material stores
        it.

    Raises
    ------
    ValueError
        If the data are of another type, have several temperatures or fewer than 3 points, or span
        more than 20 decades.

    Examples
    --------
    >>> curve = MasterCurve(293.15, [1, 10, 100], [1e6, 2e6, 4e6], [1e5, 3e5, 5e5], "G")
    >>> observed(curve, poisson_ratio=0.5).values[0].tolist()
    [3000000.0, 6000000.0, 12000000.0]
    """
    if not isinstance(data, Data):
        raise InputError(f"a fit needs sweeps, a master curve or a test, got {type(data).__name__}")
    if len(data) < 3:
        raise InputError(f"a fit needs at least 3 points, got {len(data)}")
    seen: Any = ()
    if isinstance(data, MasterCurve):
        temperature = data.reference_temperature
        seen = data.temperature if data.shifts is None else data.shifts.temperature
    elif isinstance(data, FrequencySweeps):
        refuse_unlike(data)
        seen = data.temperature[np.isfinite(data.temperature)]
        # chambers hold the temperature within about 1 K
        if seen.size and np.ptp(seen) > 3:
            raise InputError("the sweeps have several temperatures; fit their master curve")
        temperature = float(np.mean(seen)) if seen.size else None
    else:
        temperature = data.temperature
    seen = np.array([] if seen is None else seen, dtype=float)
    seen = seen[np.isfinite(seen)]
    tension = data.in_tension(poisson_ratio)
    values = np.array([getattr(tension, name) for name in tension.measured])
    steps = {"modulus": "relaxation", "compliance": "creep"}
    quantity = steps.get(tension.measured[0], "complex modulus")
    at, sweep = getattr(tension, tension.along), getattr(tension, "sweep", None)
    for part, row in zip(PARTS[quantity], values, strict=True):
        decades = float(np.ptp(np.log10(row)))
        if decades > _MOST_DECADES:
            below = f"{decades:.0f} decades: remove those below the limit of the instrument"
            raise InputError(f"the numbers of {part} span {below}")
    order = np.argsort(at, kind="stable")
    return Observed(
        quantity=quantity,
        at=at[order],
        values=values[:, order],
        noise=np.ones(values.shape[0]),
        poisson_ratio=float(poisson_ratio),
        kind=data.kind,
        temperature=temperature,
        temperatures=(float(seen.min()), float(seen.max())) if seen.size else None,
        source=data.source,
        sweep=None if sweep is None else sweep[order],
    )


_MOST = 500  # largest number of points fitted without averaging
_FINEST = 40  # intervals per decade


def thinned(data: Observed) -> Observed:
    """Reduce measured numbers to at most about 500 means, with a note; fewer are unchanged.

    Points in one interval of the logarithmic axis (and in one sweep) are averaged in logarithms,
    both place and number, so that the mean of a straight piece of a double-logarithmic curve lies
    on the curve. Intervals have 1/40 decade, or the length that gives 500 of them; the curvature of
    a standard solid causes an error below 1e-4 in 1/40 decade. All means have equal weights,
    because a recorder with constant sampling rate has most of its points in the last decade, which
    would otherwise dominate.
    """
    if data.at.size <= _MOST:
        return data
    sweep = data.sweep if data.sweep is not None else np.zeros(data.at.size, dtype=np.int64)
    order = np.lexsort((data.at, sweep))
    decades, turned = np.log10(data.at[order]), np.diff(sweep[order]) != 0
    finest = _FINEST
    while True:
        fresh = (np.diff(np.floor(finest * decades)) != 0) | turned
        groups = np.concatenate(([0], np.cumsum(fresh)))
        if groups[-1] < _MOST or finest <= 1:
            break
        finest = max(1, int(0.8 * finest))
    count = np.bincount(groups)

    def mean(values: Array) -> Array:
        return np.exp(np.bincount(groups, weights=np.log(values)[order]) / count)

    at = mean(data.at)
    ascending = np.argsort(at, kind="stable")
    first = sweep[order][np.concatenate(([True], fresh))]
    note = (
        f"{data.at.size} points were averaged to {at.size}, in {finest} intervals per decade, with "
        "equal weights"
    )
    return replace(
        data,
        at=at[ascending],
        values=np.array([mean(row) for row in data.values])[:, ascending],
        sweep=None if data.sweep is None else first[ascending],
        source=data.source.noted(note),
        points=data.at.size,
    )
