"""Tables of cases from files, and back into files with their predictions."""

import csv
import io
from collections import Counter
from collections.abc import Callable, Mapping
from functools import partial
from itertools import islice
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt
import typer

from viscotack.campaign.listed import read_words
from viscotack.errors import InputError
from viscotack.files.text import cell
from viscotack.files.whole import Target, is_standard_output, write_whole, writing_whole
from viscotack.forecast.table import answers_of, kind_of, predict_table

from .writing import Writing

# Rows that are held at once.
_BLOCK = 50_000
# Seconds between two lines of progress, while theories answer.
_LINES = 10.0


def predict_file(path: Path, out: Path | None, confidence: float, write: Writing) -> dict[str, Any]:
    """Predict the cases of a CSV file, write them with their answers, return what there was.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If nobody says where to write, or it is the file itself, or columns or rows are not those of
        a table of spheres or punches.
    """
    if out is None:
        raise InputError(f"say where the answers to {path} are to go: --csv answers.csv")
    header, rows = read_words(path)
    if not is_standard_output(out) and out.exists() and out.samefile(path):
        raise InputError(f"--csv {out} is the table of cases itself; give it another name")
    kind = kind_of(header)
    names = [name for name in header if name in {*kind.columns, *kind.choices}]
    try:
        kind.check(set(names))
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    if there := [name for name in answers_of(kind) if name in header]:
        raise InputError(
            f"{path} has the columns {', '.join(there)} already, which the answers are to have; "
            "rename or leave them out"
        )
    counts: Counter[str] = Counter()

    def answered(file: Target) -> None:
        tell = _teller()
        with writing_whole(file) as stream:
            while block := list(islice(rows, _BLOCK)):
                begin = counts["rows"]
                given = {n: [row[i].strip() for _, row in block] for i, n in enumerate(header)}
                found = _answers(path, given, names, confidence, partial(tell, begin))
                stream.write(_text({**given, **found}, header=not begin))
                counts.update(
                    {
                        "rows": len(block),
                        "inside": int(found["inside"].sum()),
                        "unanswered": int(np.sum(found["method"] == "")),
                    }
                )
                methods.update(found["method"][found["method"] != ""].astype(str).tolist())

    methods: Counter[str] = Counter()
    write("wrote", out, answered)
    return {
        "rows": counts["rows"],
        "inside": counts["inside"],
        "methods": dict(sorted(methods.items())),
        "unanswered": counts["unanswered"],
        "confidence": confidence,
        "file": str(out),
    }


def _answers(
    path: Path,
    given: Mapping[str, list[str]],
    names: list[str],
    confidence: float,
    report: Callable[[int, int], None],
) -> dict[str, npt.NDArray[Any]]:
    """Return the answers to some rows; of a word that is no number, a reason."""
    try:
        numbers = {name: _numbers(given[name]) for name in names}
        found = predict_table(numbers, confidence=confidence, report=report)
    except ValueError as error:
        raise InputError(f"{path}: {error}") from None
    for i in np.flatnonzero(found["method"] == "").tolist():
        wrong = [n for n in names if not _is_number(given[n][i])]
        if wrong:
            found["why"][i] = f"{wrong[0]} is {given[wrong[0]][i]!r}, not a number"
    return found


def _teller() -> Callable[[int, int, int], None]:
    """Return what says on standard error, now and then, how many rows have an answer."""
    last = perf_counter()

    def tell(before: int, done: int, count: int) -> None:
        nonlocal last
        if perf_counter() - last > _LINES:
            last = perf_counter()
            typer.echo(f"{before + done} of {before + count} rows answered", err=True)

    return tell


def write_table(table: Mapping[str, Any], path: Target) -> None:
    """Write columns as CSV, whole or not at all; an unknown number is an empty cell."""
    write_whole(path, _text(table, header=True))


def _text(table: Mapping[str, Any], *, header: bool) -> bytes:
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    if header:
        rows.writerow(map(cell, table))
    rows.writerows(zip(*(_cells(values) for values in table.values()), strict=True))
    return text.getvalue().encode()


def _cells(values: Any) -> list[Any]:
    if not isinstance(values, np.ndarray) or values.dtype.kind not in "fb":
        return [cell(value) if isinstance(value, str) else value for value in values]
    if values.dtype.kind == "b":
        return ["true" if value else "false" for value in values.tolist()]
    return ["" if value != value else value for value in values.tolist()]


def _numbers(words: list[str]) -> npt.NDArray[np.float64]:
    """Return words as numbers; nan where they are none."""
    try:
        return np.array(words, dtype=float)
    except ValueError:
        return np.array([float(word) if _is_number(word) else np.nan for word in words])


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
