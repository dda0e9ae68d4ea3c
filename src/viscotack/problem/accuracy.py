"""Accuracy and time limit of a simulation."""

from typing import Annotated

from viscotack.cards import Quantity

# Accuracy at which the settings of a simulation are defined.
DEFAULT_ACCURACY = 2e-3
LOOSEST_ACCURACY = 0.02

Accuracy = Annotated[
    float,
    Quantity(
        "1",
        "",
        "accuracy wanted of the pull-off force, relative",
        least=1e-6,
        most=LOOSEST_ACCURACY,
        example="2e-3",
    ),
]

TimeLimit = Annotated[
    float,
    Quantity(
        "s",
        "",
        "longest wall time of all simulations for an answer, or for a row of a table",
        above=0,
        example="90 s",
    ),
]
