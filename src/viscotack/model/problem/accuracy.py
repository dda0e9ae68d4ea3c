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
Accuracy.__doc__ = """Relative error of the pull-off force asked of a simulation, 1e-6 to 0.02.

A dimensionless float; the default is ``DEFAULT_ACCURACY``, 2e-3. Mesh, steps, reach and
retardation modes follow from it together, see :meth:`viscotack.simulate.Settings.for_accuracy`. The
error estimate of the result is compared with it: ``result.accuracy_met``, and above ten times the
accuracy the status "unresolved". The work to pull-off has up to five times the error of the force.

When to change it: 0.02 for a first look or many cases; 5e-4 beside the default for the error of a
curve, which has no estimate of its own; a smaller value where the stated error is too large. Ten
times smaller takes about three times as many steps, on a finer mesh.
"""

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
