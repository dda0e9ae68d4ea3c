"""Traction law from the table [interface] of a case file, or from an option."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from viscotack.cards import Field, cards
from viscotack.errors import InputError
from viscotack.files.quantities import read_quantities
from viscotack.problem.case_table import OWN, Table
from viscotack.traction import LAWS, LennardJones, Tabulated, Traction, has_rest
from viscotack.units import finite, positive


def law_from_table(table: Table, laws: Mapping[str, Any] = LAWS) -> Traction:
    """Return the law of the table [interface]; its range is equilibrium_gap or strength.

    A law that grows or ages has its law at rest in the table ``base``.
    """
    kind: Any = laws[table.word("law", laws, OWN)]
    if not has_rest(kind):
        return _of_gap(table, kind)
    rest = [word for word, law in laws.items() if not has_rest(law)]
    base = laws[table.word("base", rest, OWN) if "base" in table.values else LennardJones.word]
    growth = _constants(kind)
    table.require(growth)
    constants = {field.name: table.number(field) for field in growth}
    return table.make(kind.of, _of_gap(table, base), **constants)


def _of_gap(table: Table, kind: Any) -> Traction:
    if kind is Tabulated:
        return _tabulated(table.beside("file", '"table.csv"'))
    scales = cards(kind)
    table.require(
        field
        for name, field in scales.items()
        if field.needed and not (name == "equilibrium_gap" and "strength" in table.values)
    )
    constants = {
        field.name: table.number(field)
        for field in _constants(kind)
        if field.needed or field.name in table.values
    }
    work = table.number(scales["work_of_adhesion"])
    if "strength" not in table.values:
        gap = table.number(scales["equilibrium_gap"])
    elif "equilibrium_gap" in table.values:
        raise InputError(
            f"{table.name} strength and equilibrium_gap determine each other; give only one"
        )
    else:
        strength = table.quantity("strength", "Pa", '"100 kPa"')
        strength = table.make(positive, "strength", strength, "Pa")
        gap = table.make(kind, 1.0, 1.0, **constants).strength * work / strength
    return table.make(kind, work_of_adhesion=work, equilibrium_gap=gap, **constants)


def law_from_words(words: str, laws: Mapping[str, Any] = LAWS) -> Traction:
    """Return the reduced law stated by an option: its name and, after a colon, its constants.

    Examples
    --------
    >>> law_from_words("exponential:0.25")
    Exponential(work_of_adhesion=1.0, equilibrium_gap=1.0, decay=0.25)
    >>> law_from_words("dugdale").strength
    1.0

    For a law that grows with the opening speed or ages in contact, the law at rest follows after a
    second colon:

    >>> law_from_words("gent-schultz:10,0.4:exponential:0.25").base.decay
    0.25
    """
    name, _, rest = words.partition(":")
    if name not in laws:
        raise InputError(f"the law must be one of {', '.join(laws)}, got {words!r}{OWN}")
    kind: Any = laws[name]
    if kind is Tabulated:
        if not rest:
            raise InputError("the law table needs a file: table:FILE.csv")
        return _tabulated(rest).reduced()
    base = None
    if has_rest(kind):
        rest, _, base = rest.partition(":")
    constants = [constant.name for constant in _constants(kind)]
    needed = [constant.name for constant in _constants(kind) if constant.needed]
    given = rest.split(",") if rest else []
    if not len(needed) <= len(given) <= len(constants):
        wanted = ",".join(constant.upper() for constant in constants)
        more = "" if base is None else "[:LAW AT REST]"
        raise InputError(f"write {name}{':' if wanted else ''}{wanted}{more}, got {words!r}")
    values: dict[str, Any] = {
        constant: finite(constant, text, "1")
        for constant, text in zip(constants, given, strict=False)
    }
    if base:
        values["base"] = law_from_words(base, laws)
    return kind(1.0, 1.0, **values)


def _constants(kind: Any) -> list[Field]:
    """Return the cards of a law except work and gap; all are dimensionless."""
    return [
        field
        for name, field in cards(kind).items()
        if name not in ("work_of_adhesion", "equilibrium_gap")
    ]


def _tabulated(path: str | Path) -> Tabulated:
    columns = read_quantities(path, {"gap": "m", "traction": "Pa"})
    try:
        return Tabulated.of_points(columns["gap"], columns["traction"])
    except ValueError as error:
        raise InputError(f"{path}: {error}") from None
