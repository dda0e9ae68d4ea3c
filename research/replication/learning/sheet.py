"""A table to read: what the numbers of the study become."""

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Sheet:
    """A table.

    Attributes
    ----------
    name : str
        Of its file, without the ending.
    title, note : str
        What it shows, and what to know when reading it.
    columns : tuple of str
        Heads.
    rows : tuple of tuples
        Words, numbers, or None where there is nothing.
    """

    name: str
    title: str
    note: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Any, ...], ...]
