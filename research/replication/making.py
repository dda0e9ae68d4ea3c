"""The numbers of a figure, kept or made, and its picture."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from .bench import Bench, Hands, Numbers
from .figures.catalogue import named
from .figures.style import saved
from .kept import keep, kept, rounded


def _nothing(words: str) -> None:
    """Say nothing."""


@dataclass
class Maker:
    """Makes each figure's numbers once, or takes those that are kept.

    Attributes
    ----------
    hands : Hands
        Who does the work.
    afresh : bool
        Whether to make numbers that are kept already.
    store : bool
        Whether to keep what was made, in place of what was kept.
    archive : path or None
        The authors' archive; what needs it is taken as it is kept where there is none.
    say : callable
        Is told what is being made.
    """

    hands: Hands
    afresh: bool = False
    store: bool = False
    archive: Path | None = None
    say: Callable[[str], None] = _nothing
    made: dict[str, Numbers] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)

    def of(self, name: str) -> Numbers:
        """Return the numbers of a figure as they are kept, to so many digits."""
        if name not in self.made:
            lacking = self.afresh and named(name).archive and self.archive is None
            if lacking:
                self.say(f"figure {name} needs the authors' archive (--archive): as it is kept")
            self.made[name] = self._made(name) if self.afresh and not lacking else kept(name)
        return self.made[name]

    def _made(self, name: str) -> Numbers:
        self.say(f"figure {name} ...")
        of_others, began = sum(self.seconds.values()), self.hands.seconds
        found = rounded(named(name).numbers(Bench(self.hands.each, self.of, self.archive)))
        # what it took from other figures is counted there
        of_others = sum(self.seconds.values()) - of_others
        self.seconds[name] = self.hands.seconds - began - of_others
        if self.store:
            keep(name, found, seconds=self.seconds[name])
        return found


def picture(
    name: str, numbers: Numbers, folder: Path, *, ending: str = "png", dpi: int = 150
) -> Path:
    """Draw a figure into a folder and return the file."""
    figure = named(name)
    path = folder / f"{name.replace('.', '_')}.{ending}"
    return saved(figure.draw, numbers, path, size=figure.size, note=figure.note, dpi=dpi)
