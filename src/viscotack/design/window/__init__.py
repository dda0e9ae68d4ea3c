"""A rigid object between two contacts: which opens first, by speed and preload.

In transfer printing a soft stamp picks an object (ink) from a donor and prints it on a receiver.
The object has two contacts that carry the same force, and the one that opens decides. The
derivation is in docs/pick_and_print.md.
"""

from viscotack.simulate.in_series import SeriesOpening

from .picking import (
    Cell,
    Chance,
    CriticalSpeed,
    Window,
    WindowScatter,
    aged,
    opening_chance,
    which_opens,
    window,
)
from .simulated import SeriesResult, simulate_in_series

__all__ = [
    "Cell",
    "Chance",
    "CriticalSpeed",
    "SeriesOpening",
    "SeriesResult",
    "Window",
    "WindowScatter",
    "aged",
    "opening_chance",
    "simulate_in_series",
    "which_opens",
    "window",
]
