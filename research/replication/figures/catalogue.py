"""Which figures and tables there are, and what each says of itself."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from textwrap import fill
from types import ModuleType

from viscotack import InputError

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
# Made in less than a second from theory, without models and simulations.
THEORY = ("2.1", "2.2a", "2.2b", "3.3", "4.2", "4.8", "A.3")
# Parts of the docstring that are said of a figure.
_PARTS = ("Claims:", "Needs:", "Costs:")


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
        word = self.name.replace("table-", "").replace(".", "_").replace("-", "_")
        kind = "table" if self.name.startswith("table-") else "figure"
        kind = "study" if self.name in BESIDE else kind
        return import_module(f".{kind}_{word}", __package__)

    @property
    def title(self) -> str:
        """What it shows, a sentence."""
        return (self.module.__doc__ or "").strip().splitlines()[0]

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

    def part(self, head: str) -> str:
        """Return a paragraph of its docstring, "Claims:", "Needs:" or "Costs:", without its head.

        Examples
        --------
        >>> Figure("2.1").part("Needs:")
        'nothing.'
        """
        for paragraph in (self.module.__doc__ or "").split("\n\n"):
            line = " ".join(paragraph.split())
            if line.startswith(head):
                return line.removeprefix(head).strip()
        raise InputError(f"the docstring of figure {self.name} does not say {head!r}")

    def words(self) -> str:
        """Return what it is, claims, needs and has cost, for a list."""
        seconds = cost(self.name)
        spent = "no numbers are kept" if seconds is None else f"{seconds:.0f} s of processor time"
        lines = [f"figure {self.name}: {self.title}"]
        lines += [
            fill(f"{head} {self.part(head)}", 98, initial_indent="  ", subsequent_indent="    ")
            for head in _PARTS[:2]
        ]
        return "\n".join([*lines, f"  Costs: {self.part('Costs:')} Kept: {spent}."])


def figures() -> tuple[Figure, ...]:
    """Return all of them, in order."""
    return tuple(Figure(name) for name in THESIS + BESIDE)
