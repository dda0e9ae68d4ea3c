"""Which figures and tables there are, and what each says of itself."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from types import ModuleType

from viscotack import InputError

from ..bench import Bench, Numbers
from ..kept import cost

# Those of the thesis that hold numbers, in its order. Figures 1.1, 3.1, 3.2, 4.1, 5.1, 5.3,
# 5.4, 5.11 and A.2 are photographs and sketches.
THESIS = (
    *("2.1", "2.2a", "2.2b"),
    *("table-3.1", "3.3", "3.4", "3.5", "3.6", "3.7", "3.8", "3.9", "3.10"),
    *("4.2", "4.3", "4.4", "4.5", "4.6", "4.7", "4.8", "4.9", "4.10"),
    *("5.2", "table-5.1", "table-5.2", "5.5", "5.6", "5.7", "5.8"),
    *("table-5.3", "table-5.4", "5.9", "5.10", "5.12", "5.13"),
    *("A.1", "A.3", "A.4", "A.5", "table-A.1", "A.6", "A.7", "A.8", "A.9"),
)
# Beside them: what the ledger asks for and no figure of the thesis shows.
BESIDE = (
    "histories",
    "alpha",
    "limits",
    "gent-schultz",
    "published-rows",
    "work-bound",
    "printed-algorithm",
    "linear-curve",
)
# What shares a module with another figure of its kind; its numbers are asked for by name.
SHARED = {
    **dict.fromkeys(("table-5.1", "table-5.2", "table-5.3", "table-5.4"), "table_models"),
    **dict.fromkeys(("5.6", "5.7"), "figure_5_6"),
    **dict.fromkeys(("A.4", "A.5"), "figure_A_4"),
}
# Made in less than a second from theory, without models and simulations.
THEORY = ("2.1", "2.2a", "2.2b", "3.3", "4.2", "4.8", "A.3")


@dataclass(frozen=True)
class Figure:
    """A figure or a table.

    Attributes
    ----------
    name : str
        Its number in the thesis: "4.6", "table-5.1"; a word for what stands beside it.
    """

    name: str

    def __post_init__(self) -> None:
        if self.name not in THESIS + BESIDE:
            raise InputError(
                f"there is no figure {self.name!r}; there are {', '.join(THESIS + BESIDE)}"
            )

    @cached_property
    def module(self) -> ModuleType:
        """Where it is made and drawn."""
        if self.name in SHARED:
            return import_module(f".{SHARED[self.name]}", __package__)
        word = self.name.replace("table-", "").replace(".", "_").replace("-", "_")
        kind = "table" if self.name.startswith("table-") else "figure"
        kind = "study" if self.name in BESIDE else kind
        return import_module(f".{kind}_{word}", __package__)

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of its picture [inch]."""
        return getattr(self.module, "SIZE", (6.0, 4.2))

    @property
    def note(self) -> str:
        """What must be said below its picture; nothing for most."""
        return getattr(self.module, "NOTE", "")

    @property
    def needs_archive(self) -> bool:
        """Whether it is made of the whole published table, which is not in the repository."""
        return getattr(self.module, "NEEDS_ARCHIVE", False)

    def numbers(self, bench: Bench) -> Numbers:
        """Return its numbers, made from nothing."""
        make = self.module.numbers
        return make(bench, self.name) if self.name in SHARED else make(bench)

    def words(self) -> str:
        """Return what it is, claims, needs and has cost."""
        said = f"figure {self.name}: {self.module.__doc__}"
        return f"{said}Kept: {cost(self.name):.0f} s of processor time."


def figures() -> tuple[Figure, ...]:
    """Return all of them, in order."""
    return tuple(Figure(name) for name in THESIS + BESIDE)
