"""How accurate an answer is wanted, and how soon: what a simulation is asked beside its problem."""

from typing import Annotated

from viscotack.cards import Quantity

# The accuracy at which the numbers of a simulation's settings are stated.
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
        "longest wall time of a run and of the coarser one beside it",
        above=0,
        example="90 s",
    ),
]
