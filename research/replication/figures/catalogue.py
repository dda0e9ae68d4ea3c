"""Which figures and tables there are, rows of figures.toml, and what each says of itself."""

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pathlib import Path
from textwrap import fill
from typing import Any

import matplotlib.figure

from viscotack import InputError

from ..kept import Numbers, cost


@dataclass(frozen=True)
class Figure:
    """A figure or a table: a row of figures.toml, which says what its fields are."""

    name: str
    module: str
    title: str
    claims: str
    seen: str
    needs: str = ""
    size: tuple[float, float] = (6.0, 4.2)
    note: str = ""
    functions: str = ""
    theory: bool = False
    archive: bool = False

    def _function(self, kind: str) -> Any:
        word = self.functions or self.name.replace(".", "_").replace("-", "_")
        return getattr(import_module(f".{self.module}", __package__), f"{kind}_{word}")

    def numbers(self, bench: Any) -> Numbers:
        """Return its numbers, made from nothing; functions that are shared are told its name."""
        return self._function("numbers")(bench, *([self.name] if self.functions else []))

    def draw(self, numbers: Numbers, figure: matplotlib.figure.Figure) -> None:
        """Draw its numbers."""
        self._function("draw")(numbers, figure)

    def words(self) -> str:
        """Return what it is, claims, needs and has cost."""
        said = {"Claims": self.claims, "Seen": self.seen, "Needs": self.needs}
        parts = [f"figure {self.name}: {self.title}"]
        parts += [fill(f"{what}: {words}", 100) for what, words in said.items() if words]
        return "\n\n".join([*parts, f"Kept: {cost(self.name):.0f} s of processor time."])


@cache
def figures() -> dict[str, Figure]:
    """Return all of them by name, in order."""
    rows = tomllib.loads(Path(__file__).with_name("figures.toml").read_text(encoding="utf-8"))
    return {name: Figure(name, **row) for name, row in rows.items()}


def named(name: str) -> Figure:
    """Return a figure by its number in the thesis (4.6, table-5.1), or its word."""
    if name not in figures():
        raise InputError(f"there is no figure {name!r}; there are {', '.join(figures())}")
    return figures()[name]
