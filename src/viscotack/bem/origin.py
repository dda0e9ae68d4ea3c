"""How a state came about from the one before it, kept only where derivatives are wanted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy.typing as npt

from viscotack.bem.frame import Passage, Way
from viscotack.bem.interface import Faces
from viscotack.bem.memory import Step


@dataclass(eq=False)
class ByStep:
    """A step in the frame of the solid, and the interface after it.

    The state `before` is dropped once it is used.
    """

    before: Any
    step: Step
    faces: Faces


@dataclass(eq=False)
class ByTravel:
    """A step in the frame of the crack.

    Attributes
    ----------
    before : State or None
        The state before the step; dropped once it is used.
    length : float
        Length of the step.
    way, passage : Way, Passage
        Path of the edge, and the step on the nodes of its end.
    moves : ndarray, shape (N,)
        Displacement of the profile at each node, relative to that of the edge.
    modes : ndarray, shape (M, N)
        Displacement of every mode before the step, on the nodes of its end.
    """

    before: Any
    length: float
    way: Way
    passage: Passage
    moves: npt.NDArray
    modes: npt.NDArray


@dataclass(eq=False)
class ByNodes:
    """The same instant balanced on other nodes, or any change of an elastic solid."""

    before: Any


Origin = ByStep | ByTravel | ByNodes
