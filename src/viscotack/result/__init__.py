"""Results of simulations: series, events, observables, cycles, and files."""

from .result import (
    Energies,
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
