"""Constants shared by materials: their cards, and checks of numbers and arrays."""

from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from viscotack.cards import Quantity, card_of
from viscotack.errors import InputError

RubberyModulus = Annotated[
    float,
    Quantity("Pa", "E0", "long-time (relaxed) Young's modulus", above=0, example="1.458 MPa"),
]
GlassyModulus = Annotated[
    float,
    Quantity(
        "Pa", "Einf", "short-time (instantaneous) Young's modulus", above=0, example="3089 MPa"
    ),
]
RetardationTime = Annotated[
    float, Quantity("s", "tau0", "retardation time", above=0, example="18.76 ms")
]
RelaxationTime = Annotated[
    float, Quantity("s", "tau0", "relaxation time", above=0, example="18.76 ms")
]
PoissonRatio = Annotated[
    float,
    Quantity(
        "1",
        "nu",
        "Poisson ratio, the same at all times",
        least=0,
        most=0.5,
        example="0.5",
        advice="0.5 is incompressible",
    ),
]
Exponent = Annotated[
    float,
    Quantity(
        "1",
        "n",
        "exponent of the modified power law",
        above=0,
        most=3,
        example="0.22",
        advice="describe a spectrum that narrow by StandardSolid",
    ),
]
FractionalOrder = Annotated[
    float,
    Quantity(
        "1",
        "a",
        "order of the springpot, 0 a spring and 1 a dashpot",
        least=0.02,
        most=0.95,
        example="0.6",
        advice="describe an order near 1 by StandardSolid, one near 0 by Elastic",
    ),
]
ModulusRatio = Annotated[
    float,
    Quantity("1", "k", "rubbery over glassy modulus", above=0, most=1, example="0.1"),
]


def poisson_ratio(value: Any) -> float:
    """Validate a Poisson ratio and return it as a float."""
    return card_of(PoissonRatio).checked("poisson_ratio", value)


POSSIBLE = 100.0, 1000.0  # K: temperatures of tests on polymers


def temperatures(name: str, values: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Return temperatures [K] as an array of floats; raise an error outside 100 to 1,000 K."""
    array = np.asarray(values, dtype=float)
    low, high = POSSIBLE
    wrong = array[~((array >= low) & (array <= high))]  # true for nan as well
    if wrong.size:
        raise InputError(
            f"{name} must lie between {low:g} and {high:g} K, got {wrong[0]:g} K; "
            "give Celsius + 273.15"
        )
    return array


def nonnegative(name: str, values: npt.ArrayLike, unit: str) -> npt.NDArray[np.float64]:
    """Return times or frequencies in [0, inf] as an array of floats; raise an error otherwise."""
    array = np.asarray(values, dtype=float)
    wrong = array[~(array >= 0)]  # true for nan as well
    if wrong.size:
        raise InputError(f"{name} must not be negative or nan, got {wrong[0]} {unit}")
    return array


def like_input(values: Any) -> Any:
    """Return a Python number for zero-dimensional values, the array itself otherwise."""
    return values.item() if values.ndim == 0 else values


def store(instance: Any, **checked: Any) -> None:
    """Set the validated fields of a frozen dataclass; only for its __post_init__."""
    for name, value in checked.items():
        object.__setattr__(instance, name, value)
