"""Round trips of a noun through records, case files, command-line options and campaign plans."""

import inspect
import json
import math
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from viscotack.campaign import read_plan
from viscotack.cards import Pairs, cards
from viscotack.errors import InputError
from viscotack.files.toml import toml_value
from viscotack.files.whole import write_whole
from viscotack.operations.declare.questions import SPHERE, stated
from viscotack.problem.case_file import read_case
from viscotack.problem.nouns import known, own_nouns
from viscotack.problem.record import from_dict, to_dict

from .findings import Finding, holds

_TABLES: Mapping[str, Mapping[str, Any]] = {
    "material": {"model": "elastic", "rubbery_modulus": "1 MPa", "poisson_ratio": 0.5},
    "interface": {
        "law": "lennard-jones",
        "work_of_adhesion": "50 mJ/m^2",
        "equilibrium_gap": "1 um",
    },
    "sphere": {"radius": "1 mm"},
    "protocol": {"preload_depth": "1 um", "speed": "10 um/s"},
}


def classes_of(noun: Any) -> tuple[type, ...]:
    """Return the class of a noun for ``also=`` if it is user-defined, else ()."""
    kind, nouns = type(noun), known()
    families = (nouns.laws, nouns.materials, nouns.shapes, nouns.bodies)
    return () if any(kind in family.values() for family in families) else (kind,)


def numbers_of(noun: Any) -> dict[str, Any]:
    """Return the numbers of a noun as text with units, as in a case file."""
    found: dict[str, Any] = {}
    for name, field in cards(type(noun)).items():
        value, unit = getattr(noun, name), field.card.unit
        if value is not None:
            found[name] = value if unit == "1" else f"{value!r} {unit}"
    for name, field in cards(type(noun), Pairs).items():
        first, second = field.card.units
        found[name] = [
            [x if first == "1" else f"{x!r} {first}", y if second == "1" else f"{y!r} {second}"]
            for x, y in getattr(noun, name)
        ]
    return found


def case_text(**tables: Mapping[str, Any]) -> str:
    """Return the text of a case file of a sphere with some of its tables replaced."""
    lines: list[str] = []
    for name, values in (dict(_TABLES) | tables).items():
        if values:
            lines += [f"[{name}]", *(f"{key} = {toml_value(v)}" for key, v in values.items()), ""]
    return "\n".join(lines)


def through_case_file(
    noun: Any, part: str, tables: Mapping[str, Mapping[str, Any]]
) -> Iterator[Finding]:
    """Write a noun to a case file and its problem to JSON, read them back and compare."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "case.toml"
        write_whole(path, case_text(**tables).encode())
        problem = read_case(path, also=classes_of(noun))
    back = getattr(problem, part)
    # a power-law profile is given by a height, which rounds its coefficient
    name = "case file: reading returns the noun"
    yield holds(name, back == noun or _near(back, noun), repr(noun), repr(back))
    again = from_dict(json.loads(json.dumps(to_dict(problem))), also=classes_of(noun))
    yield holds(
        "JSON: from_dict(to_dict(problem)) is the problem", again == problem, problem, again
    )


def _near(one: Any, other: Any) -> bool:
    if type(one) is not type(other) or not cards(type(one)) or cards(type(one), Pairs):
        return False
    names = cards(type(one))
    return all(math.isclose(getattr(one, n), getattr(other, n), rel_tol=1e-12) for n in names)


def through_flags(noun: Any, part: str, flags: Mapping[str, Any]) -> Finding:
    """Give a reduced noun by command-line options, parse them and compare."""
    given = {"tabor": 1.0, "preload": 1.0, "rate": 1.0, "material": "elastic"} | dict(flags)
    try:
        back = getattr(stated(SPHERE, given, also=classes_of(noun)), part)
    except InputError as error:
        own = bool(classes_of(noun))
        return holds(f"option: --{part}", not own, "the noun by its name", f"rejected: {error}")
    return holds("option: parsing returns the noun", back == noun, noun, back)


def through_campaign(noun: Any, tables: Mapping[str, Mapping[str, Any]]) -> Iterator[Finding]:
    """Check that a plan can vary a problem that contains the noun."""
    files = []
    for kind in classes_of(noun):
        source = Path(inspect.getsourcefile(kind) or "")
        try:
            names = {getattr(thing, "__name__", "") for thing in own_nouns([source])}
        except (InputError, OSError):
            names = set()
        if kind.__name__ not in names:
            return  # a plan needs a class that is defined in a file
        files.append(str(source))
    with tempfile.TemporaryDirectory() as folder:
        write_whole(Path(folder) / "case.toml", case_text(**tables).encode())
        plan = Path(folder) / "plan.toml"
        own = f"with = {toml_value(files)}\n" if files else ""
        text = f'problem = "case.toml"\n{own}[[grid]]\nprotocol.speed = [1e-5, 2e-5]\n'
        write_whole(plan, text.encode())
        cases = len(read_plan(plan, own=files).cases)
    yield holds("campaign: a plan has a row for each value", cases == 2, "2 rows", cases)
