"""Results of simulations: series, events, observables, cycles, and files."""

from .energies import Energies
from .result import (
    Event,
    Outcome,
    Result,
    ShallowStart,
    columns,
    load,
    receding_speed,
    save,
    write_csv,
)

__all__ = [
    "Energies",
    "Event",
    "Outcome",
    "Result",
    "ShallowStart",
    "columns",
    "load",
    "receding_speed",
    "save",
    "write_csv",
]
