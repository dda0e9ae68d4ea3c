"""A problem written in a file: TOML in SI with units in the text, and Prony series in CSV.

docs/input.md describes both formats. Every error names the file, the table and the key.
"""

import difflib
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from viscotack.files.text import read_rows
from viscotack.files.toml import read_toml
from viscotack.geometry import Sphere
from viscotack.materials import Material
from viscotack.materials.passport_file import read_passport
from viscotack.materials.words import MODELS, units_of
from viscotack.units import parse, positive

from . import Problem
from .profile_file import profile_from_table
from .profile_problem import ProfileProblem
from .protocol_file import protocol_from_table
from .punch_file import punch_parts
from .punch_problem import PunchProblem
from .traction_file import law_from_table

# The tables of a problem, by its indenter.
_TABLES = {
    "sphere": ("material", "interface", "sphere", "protocol"),
    "punch": ("material", "interface", "punch", "layer", "protocol"),
    "profile": ("material", "interface", "profile", "protocol"),
}
_KINDS: dict[str, Any] = {
    "sphere": Problem,
    "punch": PunchProblem,
    "profile": ProfileProblem,
}
# An example for every key, shown when it is missing or wrong.
_EXAMPLES = {
    "model": '"power-law"',
    "rubbery_modulus": '"1.458 MPa"',
    "glassy_modulus": '"3089 MPa"',
    "tau0": '"18.76 ms"',
    "exponent": "0.22",
    "poisson_ratio": "0.5",
    "passport": '"pdms.toml"',
    "temperature": '"20 degC"',
    "branches": '[["5 MPa", "1 ms"], ["4 MPa", "1 s"]]',
    "law": '"lennard-jones"',
    "work_of_adhesion": '"0.1523 J/m^2"',
    "equilibrium_gap": '"1.55 um"',
    "strength": '"100 kPa"',
    "decay": "0.25",
    "file": '"table.csv"',
    "radius": '"5.19 mm"',
    "half_width": '"1 mm"',
    "thickness": '"50 um"',
    "base": '"frictionless"',
    "slope": "0.1",
    "height": '"10 um"',
    "at_radius": '"200 um"',
    "speed": '"100 um/s"',
    "stiffness": '"500 N/m"',
}


def read_case(path: str | os.PathLike[str]) -> Problem | PunchProblem | ProfileProblem:
    """Return the problem that a TOML file states in SI.

    Parameters
    ----------
    path : path
        File with the tables [material], [interface], [sphere] and [protocol], or [punch] and
        [layer], or [profile], in place of [sphere]. Quantities are texts with units, such as
        ``radius = "5.19 mm"``.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If it is not TOML, a table or key is missing, unknown or of the wrong kind, or the problem
        is impossible; with file, table and key.
    """
    path = Path(path)
    tables = read_toml(path)
    indenter = "punch" if tables.keys() & {"punch", "layer"} else "sphere"
    indenter = "profile" if "profile" in tables else indenter
    _refuse_unknown(f"{path}", tables, _TABLES[indenter], "table")
    found = {name: _Table(path, name, tables) for name in _TABLES[indenter]}
    law = law_from_table(found["interface"])
    parts: dict[str, Any] = {
        "material": _material(found["material"]),
        "traction": law,
        "protocol": protocol_from_table(
            found["protocol"], "punch" if indenter == "punch" else "sphere", law.equilibrium_gap
        ),
    }
    if indenter == "punch":
        parts |= punch_parts(found, parts["material"])
    elif indenter == "profile":
        cone = "slope" in tables["profile"]
        try:
            parts["profile"] = profile_from_table(found["profile"], cone=cone)
        except ValueError as error:
            if str(path) in str(error):
                raise
            raise ValueError(f"{path}, [profile] {error}") from None
    else:
        radius = found["sphere"].quantity("radius", "m")
        parts["geometry"] = found["sphere"].make(Sphere, radius=radius)
    for table in found.values():
        table.finish()
    try:
        return _KINDS[indenter](**parts)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def read_prony(path: str | os.PathLike[str]) -> tuple[tuple[tuple[float, float], ...], str]:
    """Return the branches of a Prony series from a CSV file, and the unit of their times.

    Parameters
    ----------
    path : path
        A first row ``modulus_ratio,relaxation_time_s``, then a branch a row: its modulus over the
        rubbery modulus, and its relaxation time. Instead of ``s`` any unit of time (``ms``,
        ``h``); just ``relaxation_time`` means that times are pure numbers. Lines that begin with
        ``#`` are skipped.

    Returns
    -------
    tuple of (float, float), str
        Branches as (modulus ratio, relaxation time in the file's unit), and that unit ("1" for
        pure numbers).

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If the header or a row is not as described; with the line.
    """
    path = Path(path)
    header, rows = read_rows(path)
    if (
        len(header) != 2
        or header[0] != "modulus_ratio"
        or not header[1].startswith("relaxation_time")
    ):
        raise ValueError(
            f"{path}: the first row must be 'modulus_ratio,relaxation_time_s' (or another unit of "
            f"time), got {','.join(header)!r}"
        )
    unit = header[1].removeprefix("relaxation_time").removeprefix("_") or "1"
    if unit != "1":
        try:
            parse(f"1 {unit}", "s")
        except ValueError as error:
            raise ValueError(f"{path}, the name of the second column: {error}") from None
    branches = []
    for line, row in rows:
        try:
            if len(row) != 2:
                raise ValueError(f"a row is a modulus ratio and a time, got {','.join(row)!r}")
            ratio, time = row
            branches.append((positive("modulus_ratio", ratio, "1"), positive("time", time, unit)))
        except ValueError as error:
            raise ValueError(f"{path}, line {line}: {error}") from None
    if not branches:
        raise ValueError(f"{path}: there is no branch below the header")
    return tuple(branches), unit


class _Table:
    """One table of a file: hands out its keys, and knows which were never asked for."""

    def __init__(self, path: Path, name: str, tables: dict[str, Any]) -> None:
        self.path, self.name = path, f"{path}, [{name}]"
        if not isinstance(tables.get(name), dict):
            raise ValueError(f"{path}: the table [{name}] is missing; see docs/input.md")
        self.values = tables[name]
        self.known: set[str] = set()

    def get(self, key: str) -> Any:
        self.known.add(key)
        if key not in self.values:
            example = _EXAMPLES.get(key, '"..."')
            close = difflib.get_close_matches(
                key, self.values.keys() - self.known, n=1, cutoff=0.75
            )
            hint = f" (is {close[0]} meant?)" if close else ""
            raise ValueError(
                f"{self.name} {key} is missing{hint}; write for example {key} = {example}"
            )
        return self.values[key]

    def quantity(self, key: str, unit: str) -> float:
        value = self.get(key)
        example = _EXAMPLES.get(key, f'"1 {unit}"')
        if unit != "1" and not isinstance(value, str):
            raise ValueError(
                f"{self.name} {key} must be text with a unit, got {value!r}; "
                f"write for example {key} = {example}"
            )
        try:
            return parse(value, unit)
        except ValueError as error:
            raise ValueError(f"{self.name} {key}: {error}; for example {key} = {example}") from None

    def word(self, key: str, allowed: Iterable[str]) -> str:
        value, allowed = self.get(key), list(allowed)
        if value not in allowed:
            raise ValueError(
                f"{self.name} {key} must be one of {', '.join(allowed)}, got {value!r}"
            )
        return value

    def make(self, kind: Any, *value: Any, **values: Any) -> Any:
        try:
            return kind(*value, **values)
        except ValueError as error:
            raise ValueError(f"{self.name} {error}") from None

    def finish(self) -> None:
        _refuse_unknown(self.name, self.values, self.known, "key")


def _refuse_unknown(where: str, given: Iterable[str], known: Iterable[str], what: str) -> None:
    known = sorted(known)
    for name in given:
        if name not in known:
            close = difflib.get_close_matches(name, known, n=1)
            hint = f"did you mean {close[0]}?" if close else f"expected {', '.join(known)}"
            raise ValueError(f"{where}: unknown {what} {name!r}; {hint}")


def _material(table: _Table) -> Material:
    if "passport" in table.values:
        return _from_passport(table)
    model = table.word("model", MODELS)
    values: dict[str, Any] = {
        key: table.quantity(key, unit) for key, unit in units_of(model).items()
    }
    if model == "prony":
        values["branches"] = _branches(table, values["rubbery_modulus"])
    return table.make(MODELS[model][0], **values)


def _from_passport(table: _Table) -> Material:
    """Return the material of a passport beside the file, at the temperature asked for."""
    passport = read_passport(table.path.parent / str(table.get("passport")))
    if "temperature" not in table.values:
        return passport.material
    return table.make(passport.at_temperature, table.quantity("temperature", "K"))


def _branches(table: _Table, rubbery_modulus: float) -> tuple[tuple[float, float], ...]:
    if "file" in table.values:
        ratios, unit = read_prony(table.path.parent / str(table.get("file")))
        if unit == "1":
            raise ValueError(
                f"{table.name} file: its times have no unit; name the column relaxation_time_s"
            )
        second = parse(f"1 {unit}", "s")
        return tuple((ratio * rubbery_modulus, time * second) for ratio, time in ratios)
    pairs = table.get("branches")
    try:
        return tuple(_branch(pair) for pair in pairs)
    except (TypeError, ValueError) as error:
        raise ValueError(
            f"{table.name} branches: {error}; write for example "
            f'branches = {_EXAMPLES["branches"]}, or file = "prony.csv"'
        ) from None


def _branch(pair: Any) -> tuple[float, float]:
    if not isinstance(pair, list) or len(pair) != 2:
        raise ValueError(f"a branch is a modulus and a relaxation time, got {pair!r}")
    return parse(str(pair[0]), "Pa"), parse(str(pair[1]), "s")
