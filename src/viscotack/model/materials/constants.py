"""Cards of the constants shared by materials: name, unit, symbol, range, example."""

from typing import Annotated, Any

from viscotack.cards import Quantity, card_of

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
