"""Problems, predictions and results as tables with a picture in a notebook.

Numbers are those of the command line, in SI where the problem is.
"""

import base64
import io
from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields, is_dataclass
from html import escape
from typing import TYPE_CHECKING, Any

from viscotack.cards import Pairs, cards
from viscotack.model.geometry import FlatPunch
from viscotack.model.problem import Problem, plane, revolution
from viscotack.prediction.prediction import Prediction, prediction_summary
from viscotack.result import Result
from viscotack.result.observables import summary
from viscotack.units import readable, readable_interval

from .prediction import draw_prediction
from .simulation import draw_force

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def html_of_problem(problem: Problem) -> str:
    """Return the numbers of a problem as a table.

    Examples
    --------
    >>> from viscotack.app.operations.parts.solid import FIRST
    >>> from viscotack.model.problem.case_file import case_of_tables
    >>> "<td>sphere radius</td><td>R</td><td>5.19 mm</td>" in html_of_problem(case_of_tables(FIRST))
    True
    """
    units = (plane if isinstance(problem.geometry, FlatPunch) else revolution).SI
    parts = (problem.geometry, problem.body, problem.material, problem.traction, problem.protocol)
    rows = [row for part in parts for row in _parts(part, units)]
    return _table(("part", "quantity", "symbol", "value"), rows)


def _parts(part: Any, units: Mapping[str, str]) -> list[tuple[str, ...]]:
    """Return the rows of a noun and of the nouns in it."""
    noun, rows = type(part).__name__, []
    for name, field in cards(type(part)).items():
        card, value = field.card, getattr(part, name)
        if value is not None:
            unit = units[card.measure] if card.measure else card.unit
            rows.append((noun, card.words, card.symbol, readable(value, unit)))
    for name, field in cards(type(part), Pairs).items():
        for pair in getattr(part, name):
            both = ", ".join(map(readable, pair, field.card.units))
            rows.append((noun, field.card.words, field.card.symbol, both))
    rows = rows or [(noun, "", "", "")]
    for each in fields(part):
        value = getattr(part, each.name)
        for inner in value if isinstance(value, tuple) else (value,):
            if is_dataclass(inner):
                rows += _parts(inner, units)
    return rows


def html_of_prediction(found: Prediction) -> str:
    """Return a prediction as a table with its intervals, its tier, and its curve if it has one."""
    record, kind = prediction_summary(found), found.problem.outputs
    intervals = {
        next(iter(kind.observables)): "interval",
        "work_to_pull_off": "work_interval",
        "depth_at_pull_off": "depth_interval",
    }
    rows = []
    for name, words, tail, said in _observed(record, kind):
        held = record.get(f"{intervals.get(name)}{tail}")
        rows.append((words, said(record[name + tail]), said(*held) if held else ""))
    share = "band" if found.confidence is None else f"{100 * found.confidence:.4g} % of cases"
    told = (f"by the {found.method}: {found.why}", *found.cautions)
    words = "".join(f"<p>{escape(each)}</p>" for each in told)
    drawn = "" if found.curve is None else _picture(lambda: draw_prediction(found))
    return _table(("quantity", "value", share), rows) + words + drawn


def html_of_result(result: Result) -> str:
    """Return the summary of a simulation as a table, with its numerical errors and its curve."""
    record = summary(result)
    errors = record["error_estimate"] or {}
    of = {next(iter(result.problem.outputs.observables)): "force", "work_to_pull_off": "work"}
    rows = []
    for name, words, tail, said in _observed(record, result.problem.outputs):
        error = errors.get(of.get(name))
        rows.append((words, said(record[name + tail]), f"{error:.2g}" if error else ""))
    words = f"<p>{escape(str(record['status']))}</p>"
    table = _table(("quantity", "value", "numerical error (relative)"), rows)
    return table + words + _picture(lambda: draw_force(result))


def _observed(record: dict[str, Any], kind: Any) -> Iterable[tuple[str, str, str, Any]]:
    """Iterate over the numbers of a record.

    Yields the name, its words, the end of its names in SI (empty without), and a function that
    writes one number, or an interval, with the unit.
    """
    for name, observable in kind.observables.items():
        unit = observable.unit
        if record.get(name) is None:
            continue
        tail = f"_{unit.tail}" if f"{name}_{unit.tail}" in record else ""
        of, end = (unit.si, "") if tail else ("1", f" x {unit.text}")

        def said(low: float, high: float | None = None, of: str = of, end: str = end) -> str:
            return (readable(low, of) if high is None else readable_interval(low, high, of)) + end

        yield name, observable.words, tail, said


def _table(heads: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    def row(cells: tuple[str, ...], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{escape(cell)}</{tag}>" for cell in cells) + "</tr>"

    return f"<table>{row(heads, 'th')}{''.join(row(cells, 'td') for cells in rows)}</table>"


def _picture(draw: Callable[[], "Figure"]) -> str:
    stream = io.BytesIO()
    draw().savefig(stream, format="svg")
    content = base64.b64encode(stream.getvalue()).decode()
    return f'<img alt="force against depth" src="data:image/svg+xml;base64,{content}">'
