"""The cycles of a test as a table that a person reads."""

from typing import Any

from viscotack.result import Result
from viscotack.units import prefixed

# Columns that the words leave out.
_LEFT_OUT = ("begin", "end", "hysteresis_error", "time_to_detachment")


def table_of_cycles(result: Result, rows: list[dict[str, Any]]) -> list[str]:
    """Return a line for each cycle, in SI where the problem is; none where nothing is to be added.

    A test that is only pulled, or begins in contact and is pressed and pulled once, has said it all
    by its pull-off.
    """
    if len(rows) < 2 and all(row["snap_in_depth"] is None for row in rows):
        return []
    columns, units, factors = _columns(result), {}, []
    for words, (name, unit) in columns.items():
        factor, unit = prefixed(max(abs(row[name] or 0.0) for row in rows), unit)
        factors.append(factor)
        units.setdefault(unit, []).append(words)
    lines = [_line("cycle", list(columns)) + "  loop"]
    for row in rows:
        values = zip((row[name] for name, _ in columns.values()), factors, strict=True)
        cells = ["-" if v is None else f"{v / factor:.4g}" for v, factor in values]
        lines.append(f"{_line(row['cycle'], cells)}  {row['loop']}")
    return [*lines, "  " + "; ".join(f"{', '.join(w)} in {u}" for u, w in units.items())]


def _columns(result: Result) -> dict[str, tuple[str, str]]:
    """Return the columns of the table: heading -> key of a row, and unit."""
    found = {}
    for name, output in result.problem.outputs.cycles.items():
        unit = output.unit
        if name not in _LEFT_OUT:
            in_si = (f"{name}_{unit.tail}", unit.si)
            found[output.words] = (name, unit.text) if result.scales is None else in_si
    return found


def _line(first: Any, cells: list[str]) -> str:
    return f"  {first:>5}" + "".join(f"{cell:>12}" for cell in cells)
