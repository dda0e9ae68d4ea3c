"""Records as text for people: quantities with their intervals, tables, and sentences."""

import re
from collections.abc import Mapping, Sequence
from numbers import Real
from typing import TYPE_CHECKING, Any

from viscotack.units import readable

if TYPE_CHECKING:
    from viscotack.model.problem.outputs import Kind

# Ends of names -> unit.
UNITS = {
    "J_per_m2": "J/m^2",
    "J_m2": "J/m2",
    "N_per_m": "N/m",
    "m_per_s": "m/s",
    "m_s": "m/s",
    "rad_s": "rad/s",
    "per_m": "1/m",
    "Pa": "Pa",
    "Hz": "Hz",
    "kg": "kg",
    "N": "N",
    "J": "J",
    "K": "K",
    "m": "m",
    "s": "s",
}
# A name is that of a quantity, or of what belongs to it: pull_off_force_N_uncertainty, low_N.
_NAME = re.compile(
    r"(?P<quantity>.*?)(?:(?:^|_)(?P<end>interval|low|high)|_(?P<error>standard_error|error))?"
    rf"(?:_(?P<unit>{'|'.join(UNITS)}))?"
    r"(?:_(?P<more>uncertainty|mean|weighted_mean|standard_deviation))?",
    re.DOTALL,
)
_UNIT = re.compile(rf"_({'|'.join(UNITS)})$")
_SPELLED = {
    "pull off": "pull-off",
    "snap in": "snap-in",
    "half space": "half-space",
    "jkr": "JKR",
    "fuller tabor": "Fuller-Tabor parameter",
    "pastewka robbins": "Pastewka-Robbins ratio",
    "tabor": "Tabor number",
}
# What identifies a result rather than answers.
_SILENT = ("problem", "versions", "run_id", "sha256", "statistics")
# Sentences that come first, and those that need no name.
_FIRST = ("status", "words", "sentences")
_UNNAMED = (*_FIRST, "cautions", "warnings", "notes")
_WIDEST, _MOST = 120, 60  # characters and rows of a table
_LONG = 50  # characters of a text beside a name

# Value, interval, low, high and errors of a quantity, each by unit.
_Parts = dict[str, dict[str, Any]]


def spelled(name: str) -> str:
    """Return a name as words.

    Examples
    --------
    >>> spelled("depth_at_pull_off")
    'depth at pull-off'
    """
    words = name.replace("_", " ").strip()
    for plain, right in _SPELLED.items():
        words = words.replace(plain, right)
    return words


def quantity_of(name: str) -> tuple[str, str, str]:
    """Return quantity, unit and statistic of a column; unit "1" without one.

    Examples
    --------
    >>> quantity_of("pull_off_force_N_uncertainty")
    ('pull_off_force', 'N', 'uncertainty')
    """
    found = _NAME.fullmatch(name)
    assert found is not None, "the expression takes every name"
    return found["quantity"], UNITS.get(found["unit"] or "", "1"), found["more"] or ""


def record_words(record: Mapping[str, Any], units: Mapping[str, str] | None = None) -> str:
    """Return a record as text: its verdict, quantities, tables and further sentences.

    `units` are those of dimensionless numbers by name.

    Examples
    --------
    >>> print(record_words({"pull_off_force_N": 4.31e-3, "interval_N": [4e-3, 5e-3], "tabor": 2.0}))
      pull-off force  4.31 mN (4 to 5 mN)
      Tabor number    2
    """
    return "\n".join(_lines(record, units or {}))


def _lines(record: Mapping[str, Any], units: Mapping[str, str]) -> list[str]:
    columns = [x for x in record.values() if isinstance(x, list) and _are_plain(x)]
    if len(columns) == len(record) > 1 and len({len(x) for x in columns}) == 1:
        rows = zip(*columns, strict=True)
        return _table([dict(zip(record, row, strict=True)) for row in rows], units)
    first, plain, tables, last = [], {}, [], []
    for name, value in record.items():
        if name in _SILENT or value is None or isinstance(value, list | str) and not value:
            continue
        if isinstance(value, Mapping) or isinstance(value, list) and isinstance(value[0], Mapping):
            inner = _nested(value, units)
            tables += [f"  {spelled(name)}", *(f"  {line}" for line in inner)]
        elif said := _sentences(name, value):
            (first if name in _FIRST else last).extend(said)
        else:
            plain[name] = value
    found = {label: text for label, text in quantities(plain, units).items() if text}
    width = max(map(len, found), default=0)
    return [*first, *(f"  {n:<{width}}  {text}" for n, text in found.items()), *tables, *last]


def _nested(value: Any, units: Mapping[str, str]) -> list[str]:
    """Return a table, or rows, as lines."""
    if isinstance(value, Mapping):
        if not all(isinstance(x, Mapping) for x in value.values()):
            return _lines(value, units)
        value = [{"": name} | dict(x) for name, x in value.items()]
    if any(isinstance(x, list) and not _are_plain(x) for row in value for x in row.values()):
        return [line for row in value for line in _lines(row, units)]
    return _table(value, units)


def _table(rows: Sequence[Mapping[str, Any]], units: Mapping[str, str]) -> list[str]:
    """Return rows as an aligned table, turned where it would be too wide, and their sentences."""
    flat = [_flat(row) for row in rows]
    said = dict.fromkeys(x for row in flat for n in row for x in _sentences(n, row[n], _WIDEST))
    short = [
        {n: x for n, x in row.items() if not _sentences(n, x, _WIDEST)} for row in flat[:_MOST]
    ]
    names, cells = cells_of(short, units)
    columns = [list(column) for column in zip(names, *cells, strict=True)]
    if sum(max(map(len, each)) + 2 for each in columns) > _WIDEST and len(cells) < len(names):
        columns = [list(row) for row in zip(*columns, strict=True)]
    lines = zip(*map(_aligned, columns), strict=True)
    more = [f"  and {len(rows) - _MOST} more"] if len(rows) > _MOST else []
    return [*(f"  {'  '.join(line)}".rstrip() for line in lines), *more, *(f"  {x}" for x in said)]


def cells_of(
    rows: Sequence[Mapping[str, Any]], units: Mapping[str, str] | None = None
) -> tuple[list[str], list[list[str]]]:
    """Return the labels of the columns of rows that are known, and the text of each row."""
    texts = [quantities(row, units or {}) for row in rows]
    names = list(dict.fromkeys(name for row in texts for name, text in row.items() if text))
    return names, [[row.get(name, "") for name in names] for row in texts]


def _aligned(column: list[str]) -> list[str]:
    width = max(map(len, column))
    of_numbers = all(not text or text[0] in "-0123456789" for text in column[1:])
    return [text.rjust(width) if of_numbers else text.ljust(width) for text in column]


def _flat(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return a row with the entries of the tables in it."""
    found: dict[str, Any] = {}
    for name, value in row.items():
        if name not in _SILENT:
            found |= _flat(value) if isinstance(value, Mapping) else {name: value}
    return found


def quantities(record: Mapping[str, Any], units: Mapping[str, str]) -> dict[str, str]:
    """Return label and text of each quantity, with its interval, error and value in SI."""
    groups: dict[str, _Parts] = {}
    for name, value in record.items():
        found = _NAME.fullmatch(name)
        assert found is not None, "the expression takes every name"
        quantity, end, error, unit, more = found.groups()
        part = end or error or ("uncertainty" if more == "uncertainty" else "value")
        label = quantity if more in (None, "uncertainty") else f"{quantity}_{more}"
        groups.setdefault(label, {}).setdefault(part, {})[UNITS.get(unit or "", "1")] = value
    for name, parts in list(groups.items()):
        if "value" not in parts:
            hosts = (
                other
                for other, of in groups.items()
                if other.startswith(name) and other != name and _are_numbers(of.get("value"))
                if all(of["value"].keys() & each for each in parts.values())
            )
            host = next(hosts, None)
            if host is not None:
                groups[host] = parts | groups[host]
                del groups[name]
    return {
        spelled(name if "value" in parts or "low" in parts and name else f"{name}_{[*parts][0]}"): (
            _said(parts, units.get(name, ""))
        )
        for name, parts in groups.items()
    }


def _said(parts: _Parts, pure_unit: str) -> str:
    """Return a quantity as text; "" for an unknown one."""
    values = parts.get("value") or parts.get("low") or next(iter(parts.values()))
    unit = next((u for u in values if u != "1"), "1")
    if "value" not in parts and "low" not in parts:
        return _text(values[unit], unit)
    spread = parts.get("uncertainty", parts.get("standard_error", {})).get(unit)
    text = _text(values[unit], unit, spread) if "value" in parts else ""
    product = f" x {pure_unit}" if pure_unit[:1] in ("1", "(") else f" {pure_unit}".rstrip()
    if text and unit == "1" and _are_numbers(values):
        text += product
    ends = parts.get("interval", {}).get(unit)
    if "low" in parts:
        ends = [parts["low"].get(unit), parts.get("high", {}).get(unit)]
    if ends is not None and (between := _text(list(ends), unit)):
        text = f"{text} ({between})" if text else between
    if text and (error := parts.get("error", {}).get("1")) is not None:
        text += f" +- {100 * error:.2g} %"
    pure = values.get("1") if unit != "1" else None
    return f"{text}  = {_text(pure, '1')}{product}" if text and pure is not None else text


def _text(value: Any, unit: str, uncertainty: float | None = None) -> str:
    if value is None or value == "" or isinstance(value, Mapping):
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list | tuple):
        if len(value) == 2 and all(isinstance(x, Real) for x in value):
            return readable(value[0], unit, digits=5, to=value[1])
        known = [_text(x, unit) for x in value]
        if len(value) == 2 and unit != "1":
            return f"from {known[0]}" if known[0] else f"to {known[1]}" if known[1] else ""
        return ", ".join(filter(None, known))
    if isinstance(value, int | str):
        return str(value)
    if unit == "K":
        return f"{value - 273.15:.5g} degC"
    if unit == "kg":
        value, unit = 1e3 * value, "g"
    return readable(value, unit, digits=5, uncertainty=uncertainty)


def _sentences(name: str, value: Any, longest: int = _LONG) -> list[str]:
    """Return the sentences of an entry, each once; none of another entry."""
    texts = [value] if isinstance(value, str) else value if isinstance(value, list | tuple) else []
    texts = [x for text in texts for x in (text if isinstance(text, list) else [text])]
    if not all(isinstance(x, str) for x in texts):
        return []
    if name in _UNNAMED:
        return list(dict.fromkeys(texts))
    is_long = any(len(x) > longest for x in texts)
    return [f"{spelled(name)}: {text}" for text in dict.fromkeys(texts)] if is_long else []


def _are_numbers(values: Any) -> bool:
    return bool(values) and all(
        isinstance(x, Real | None) and not isinstance(x, bool) for x in values.values()
    )


def _are_plain(values: list[Any]) -> bool:
    return not any(isinstance(x, list | Mapping) for x in values)


def units_of(kind: "Kind") -> dict[str, str]:
    """Return the units of the dimensionless numbers of a kind of problem by name."""
    outputs = {**kind.cycles, **kind.observables}
    found: dict[str, str] = {name: output.unit.text for name, output in outputs.items()}
    depths = f"zero_{kind.name_of('force')}_depth", "error_of_the_depth"
    return found | {name: found["depth_at_pull_off"] for name in depths}


def read(one: Any, *names: str, **paths: str) -> dict[str, Any]:
    """Return attributes of an object by name, a unit at the end of a name left out.

    A keyword has a path of attributes, keys and places; beyond None everything is None.

    Examples
    --------
    >>> from viscotack import Sphere
    >>> read(Sphere(5e-3), "radius_m", size="radius")
    {'radius_m': 0.005, 'size': 0.005}
    """
    found = {}
    for name, path in ({name: _UNIT.sub("", name) for name in names} | paths).items():
        value = one
        for part in path.split("."):
            if isinstance(value, Mapping | list | tuple):
                value = value.get(part) if isinstance(value, Mapping) else value[int(part)]
            elif value is not None:
                value = getattr(value, part)
        found[name] = value
    return found


def estimates(one: Any, *names: str) -> dict[str, Any]:
    """Return estimates, attributes as of `read`, each with its standard uncertainty."""
    found = {}
    for name, each in read(one, *names).items():
        found |= {name: each.value, f"{name}_uncertainty": each.uncertainty}
    return found


def rows_of(columns: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return columns of equal length, lists or arrays, as rows."""
    lists = (x.tolist() if hasattr(x, "tolist") else list(x) for x in columns.values())
    return [dict(zip(columns, row, strict=True)) for row in zip(*lists, strict=True)]
