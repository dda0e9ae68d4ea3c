"""Cases that are listed one by one: the rows of a CSV file, read when they are needed."""

import csv
import re
from collections.abc import Iterator, Mapping
from itertools import chain
from pathlib import Path
from typing import Any

from viscotack.errors import InputError
from viscotack.files.text import read_text
from viscotack.problem.older import upgraded_path

# Of a text as read_text returns it; as a file in memory it would be four times as large.
_LINE = re.compile(r"[^\n]*\n|[^\n]+")


def read_words(
    path: Path, text: str | None = None
) -> tuple[list[str], Iterator[tuple[int, list[str]]]]:
    """Return the names in the first row of a CSV file, and the other rows with their lines.

    Rows are read when they are needed, of the text of the file where it was read before; one that
    is wrong is refused then.
    """
    rows = _filled(path, read_text(path) if text is None else text)
    names = [name.strip() for name in next(rows, (0, []))[1]]
    first = next(rows, None)
    if first is None or len(set(names)) != len(names):
        raise InputError(
            f"{path}: needs a first row of different column names and a case a row below it"
        )

    def checked() -> Iterator[tuple[int, list[str]]]:
        for line, row in chain([first], rows):
            if len(row) != len(names):
                raise InputError(f"{path}, line {line}: {len(row)} values for {len(names)} columns")
            yield line, row

    return names, checked()


def _filled(path: Path, text: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the rows of a text in CSV that are not empty, with their lines; the first as it is."""
    reader = csv.reader(found[0] for found in _LINE.finditer(text))
    try:
        yield 1, next(reader, [])
        for row in reader:
            if any(x.strip() for x in row):
                yield reader.line_num, row
    except csv.Error as error:
        raise InputError(f"{path}, line {reader.line_num}: {error}") from None


class Listed:
    """The rows of a CSV file of numbers with line numbers; read again at each iteration."""

    def __init__(self, path: Path, text: str) -> None:
        self.path, self._text = path, text
        self.names = list(renamed(dict.fromkeys(read_words(path, text)[0])))

    def __iter__(self) -> Iterator[tuple[int, dict[str, float]]]:
        for line, row in read_words(self.path, self._text)[1]:
            try:
                yield line, {n: float(v) for n, v in zip(self.names, row, strict=True)}
            except ValueError as error:
                raise InputError(f"{self.path}, line {line}: {error}; inputs are numbers") from None


def renamed(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return values by the paths that numbers have now; one that is stated twice is refused."""
    found: dict[str, Any] = {}
    for name, value in values.items():
        new = upgraded_path(name)
        if new in found:
            raise InputError(f"{new} is given twice, also as {name}; remove one")
        found[new] = value
    return found
