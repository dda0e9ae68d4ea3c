"""What a fit compares: the logarithms of measured numbers beside those of a material.

A frequency sweep gives two numbers a point (storage and loss), a relaxation or creep test one.
In logarithms an error of 2 % weighs the same on the glassy and on the rubbery side.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.materials import Material

from .sweeps import CreepTest, FrequencySweeps, MasterCurve, RelaxationTest, Source

Data = MasterCurve | FrequencySweeps | RelaxationTest | CreepTest

# Quantity -> the names of its parts, in the order in which they stand.
PARTS = {
    "complex modulus": ("storage", "loss"),
    "storage modulus": ("storage",),
    "loss modulus": ("loss",),
    "relaxation": ("relaxation",),
    "creep": ("creep",),
}


# Decades of one modulus: the best rheometers and DMA together, from 1 mPa to the modulus of diamond
# are 15. What an equation wrote down may run out below the smallest floating-point number.
_MOST_DECADES = 20


@dataclass(frozen=True, eq=False)
class Observed:
    """Measured numbers in tension, ready to be compared.

    Attributes
    ----------
    quantity : str
        "complex modulus", one part of it, "relaxation" or "creep".
    at : ndarray, shape (N,)
        Angular frequencies [rad/s], or times [s], ascending.
    values : ndarray, shape (P, N)
        One row a part of the quantity: moduli [Pa] or a compliance [1/Pa]; positive.
    noise : ndarray, shape (P,)
        Scatter of each part beside that of the best one, at least 1: residuals are divided by it.
    poisson_ratio : float
        Taken to be constant.
    kind : str
        "E" or "G": what was measured, before it was turned into tension.
    temperature : float or None
        Temperature at which the numbers hold [K].
    temperatures : (float, float) or None
        Lowest and highest temperature at which they were measured [K].
    source : Source
        Where they come from.
    sweep : ndarray of int, shape (N,), or None
        Number of the sweep that each point was measured in, where that is known.
    points : int
        How many points were measured, where `at` are means of them; else 0.
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
        """Whether `at` are frequencies; times otherwise."""
        return self.quantity.endswith(" modulus")

    @property
    def logs(self) -> Array:
        """Natural logarithms of all numbers, part by part, shape (P N,)."""
        return np.log(self.values).ravel()

    @property
    def frequencies(self) -> tuple[float, float]:
        """Lowest and highest angular frequency [rad/s]; of a test over time, 1/time."""
        low, high = float(self.at[0]), float(self.at[-1])
        return (low, high) if self.in_frequency else (1 / high, 1 / low)

    @property
    def moduli(self) -> tuple[float, float]:
        """Smallest and largest modulus seen [Pa]: storage, relaxation or inverse creep."""
        first = self.values[0] if self.quantity != "creep" else 1 / self.values[0]
        return float(np.min(first)), float(np.max(first))

    def predicted(self, material: Material, at: npt.ArrayLike | None = None) -> Array:
        """Return what a material says in place of `values`, or at other places, shape (P, N)."""
        x = self.at if at is None else np.asarray(at, dtype=float)
        if self.in_frequency:
            modulus = np.asarray(material.complex_modulus(x))
            both = {"storage": np.real(modulus), "loss": np.imag(modulus)}
            return np.array([both[part] for part in self.parts])
        answer = material.relaxation if self.quantity == "relaxation" else material.creep
        return np.asarray(answer(x))[None, :]

    def residuals(self, material: Material) -> Array:
        """Return ln(measured) - ln(material), shape (P, N)."""
        with np.errstate(divide="ignore"):  # a loss that underflows: infinitely bad, not an error
            return np.log(self.values) - np.log(self.predicted(material))

    def weighed(self, residuals: Array) -> Array:
        """Return residuals over the noise of their part, shape (P, N)."""
        return residuals / self.noise[:, None]


def only(data: Observed, part: str) -> Observed:
    """Return the measured numbers of one part of the complex modulus, "storage" or "loss"."""
    if not data.in_frequency:
        raise InputError(f"there is no loss modulus to leave out of a test of {data.quantity}")
    row = data.values[[data.parts.index(part)]]
    return replace(data, quantity=f"{part} modulus", values=row, noise=np.ones(1))


def observed(data: Any, *, poisson_ratio: float) -> Observed:
    """Return a master curve, one sweep, or a test over time as what a fit compares.

    Parameters
    ----------
    data : MasterCurve, FrequencySweeps, RelaxationTest or CreepTest
        Sweeps at more than one temperature are refused: make a master curve of them first.
    poisson_ratio : float
        Poisson ratio, in [0, 0.5]; needed even of a tensile test, as the material states it.

    Raises
    ------
    ValueError
        If the data is of another kind, has several temperatures or too few points, or falls over
        more than 20 decades.

    Examples
    --------
    >>> curve = MasterCurve(293.15, [1, 10, 100], [1e6, 2e6, 4e6], [1e5, 3e5, 5e5], "G")
    >>> observed(curve, poisson_ratio=0.5).values[0].tolist()
    [3000000.0, 6000000.0, 12000000.0]
    """
    if not isinstance(data, Data):
        raise InputError(
            "a fit needs a MasterCurve, a FrequencySweeps at one temperature, a RelaxationTest or "
            f"a CreepTest, got {type(data).__name__}"
        )
    if len(data) < 3:
        raise InputError(f"a fit needs at least 3 points, got {len(data)}")
    tension = data.in_tension(poisson_ratio)
    temperature, temperatures = _temperatures(data)
    if isinstance(tension, MasterCurve | FrequencySweeps):
        quantity, at = "complex modulus", tension.angular_frequency
        values = np.array([tension.storage, tension.loss])
    elif isinstance(tension, RelaxationTest):
        quantity, at, values = "relaxation", tension.time, tension.modulus[None, :]
    else:
        quantity, at, values = "creep", tension.time, tension.compliance[None, :]
    for part, row in zip(PARTS[quantity], values, strict=True):
        _refuse_unmeasurable(part, row)
    order = np.argsort(at, kind="stable")
    sweep = getattr(tension, "sweep", None)
    return Observed(
        quantity=quantity,
        at=at[order],
        values=values[:, order],
        noise=np.ones(values.shape[0]),
        poisson_ratio=float(poisson_ratio),
        kind=data.kind,
        temperature=temperature,
        temperatures=temperatures,
        source=data.source,
        sweep=None if sweep is None else np.asarray(sweep)[order],
    )


def _refuse_unmeasurable(part: str, values: Array) -> None:
    low, high = float(np.min(values)), float(np.max(values))
    decades = np.log10(high) - np.log10(low)
    if decades > _MOST_DECADES:
        unit = "1/Pa" if part == "creep" else "Pa"
        raise InputError(
            f"the numbers of {part} run over {decades:.0f} decades, from {low:.2g} to {high:.2g} "
            f"{unit}, and no instrument tells more than {_MOST_DECADES}; leave out those below its "
            "limit"
        )


def _temperatures(data: Data) -> tuple[float | None, tuple[float, float] | None]:
    """Return the temperature at which the numbers hold, and the range they were measured in."""
    if isinstance(data, MasterCurve):
        seen = data.shifts.temperature if data.shifts is not None else data.temperature
        reference = data.reference_temperature
    elif isinstance(data, FrequencySweeps):
        seen = data.temperature[np.isfinite(data.temperature)]
        # a chamber holds its temperature to about a kelvin
        if seen.size and np.ptp(seen) > 3:
            raise InputError(
                f"the sweeps are from {seen.min():.1f} K to {seen.max():.1f} K; "
                "make a master curve of them first (viscotack.lab.master_curve)"
            )
        reference = float(np.mean(seen)) if seen.size else None
    else:
        return data.temperature, None
    if seen is None or not np.any(np.isfinite(seen)):
        return reference, None
    return reference, (float(np.nanmin(seen)), float(np.nanmax(seen)))
