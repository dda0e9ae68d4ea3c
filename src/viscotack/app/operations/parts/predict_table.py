"""Tables of cases without dimensions from files, and back into files with their predictions."""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.campaign.listed import EMPTY, read_words
from viscotack.errors import InputError
from viscotack.files.whole import Target, writing_whole
from viscotack.model.problem.kinds import plain_heading
from viscotack.prediction.table import answers_of, kind_of, predict_table
from viscotack.units import is_number

from ..request import Answer, Told
from .tables import Writer, columns_text
from .workbook import write_workbook

# Rows in memory at a time.
_BLOCK = 50_000
_SHEET = 2**20 - 1  # rows of a sheet below its headings


def predict_file(path: Path, confidence: float, tell: Callable[[Told], None]) -> Answer:
    """Return the answer to the cases of a table, which are predicted as they are written.

    The table is a CSV file, or the first sheet of a workbook .xlsx.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If columns or rows are not those of a table of spheres or punches.
    """
    headings, rows = read_words(path, empty=True)
    header = [plain_heading(name) for name in headings]
    kind = kind_of(header)
    names = [name for name in header if name in {*kind.columns, *kind.choices}]
    try:
        kind.check(set(names))
    except InputError as error:
        raise InputError(
            f"{path}: {error}, and the headings {', '.join(headings)}; a table in SI changes a "
            "problem, which stands before it: viscotack predict lens.toml cases.xlsx"
        ) from None
    refuse_answered(path, header, answers_of(kind))
    counts: Counter[str] = Counter()
    methods: Counter[str] = Counter()

    def blocks() -> Iterator[dict[str, Any]]:
        while block := list(islice(rows, _BLOCK)):
            begin = counts["rows"]
            given = {n: [row[i].strip() for _, row in block] for i, n in enumerate(header)}
            found = _answers(path, given, names, confidence, partial(_rows_told, tell, begin))
            empty = np.array([not any(row) for row in zip(*given.values(), strict=True)])
            found["why"][empty] = EMPTY
            counts.update(
                {
                    "rows": len(block),
                    "inside": int(found["inside"].sum()),
                    "unanswered": int(np.sum((found["method"] == "") & ~empty)),
                }
            )
            methods.update(found["method"][found["method"] != ""].astype(str).tolist())
            yield {**dict(zip(headings, given.values(), strict=True)), **found}

    def answered(file: Target) -> None:
        with writing_whole(file) as stream:
            for number, table in enumerate(blocks()):
                stream.write(columns_text(table, header=not number))

    def in_workbook(file: Target) -> None:
        columns: dict[str, list[Any]] = {}
        for table in blocks():
            if counts["rows"] > _SHEET:
                raise InputError(f"{path} has more rows than a sheet can have; write csv")
            for name, values in table.items():
                columns.setdefault(name, []).extend(map(in_sheet, np.asarray(values).tolist()))
        write_workbook({"predictions": columns}, file)

    def record() -> dict[str, Any]:
        return {
            "rows": counts["rows"],
            "inside": counts["inside"],
            "methods": dict(sorted(methods.items())),
            "unanswered": counts["unanswered"],
            "confidence": confidence,
        }

    files: dict[str, Writer] = {"csv": answered, "xlsx": in_workbook}
    return Answer(methods, data=record, files=files)


def refuse_answered(where: Any, headings: Iterable[str], answers: Iterable[str]) -> None:
    """Refuse a table that has columns of answers already."""
    known = set(headings)
    if there := [name for name in answers if name in known]:
        raise InputError(
            f"{where} has the columns {', '.join(there)} already, which the answers are to have; "
            "rename or leave them out"
        )


def in_sheet(value: Any) -> Any:
    """Return an entry of a table as a cell of a workbook; nothing where there is no number."""
    if value == "" or value != value:
        return None
    return float(value) if isinstance(value, str) and is_number(value) else value


def _rows_told(tell: Callable[[Told], None], before: int, done: int, count: int) -> None:
    tell({"words": f"{before + done} of {before + count} rows answered"})


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
        wrong = [n for n in names if not is_number(given[n][i])]
        if wrong:
            found["why"][i] = f"{wrong[0]} is {given[wrong[0]][i]!r}, not a number"
    return found


def _numbers(words: list[str]) -> npt.NDArray[np.float64]:
    """Return words as numbers; nan where they are none."""
    try:
        return np.array(words, dtype=float)
    except ValueError:
        return np.array([float(word) if is_number(word) else np.nan for word in words])
