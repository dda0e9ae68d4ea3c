"""Traction laws as tables, [interface], and as words of an option."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from viscotack.cards import Field, Quantity, cards
from viscotack.errors import InputError
from viscotack.files.quantities import read_quantities
from viscotack.model.tables import OWN, Reading, UnknownNoun, read_as, stated
from viscotack.model.traction import LAWS, LennardJones, Tabulated, Traction, has_rest

STRENGTH = Quantity("Pa", "sigma0", "largest tension of the law", above=0, example="100 kPa")
_SCALES = ("work_of_adhesion", "equilibrium_gap")


def law_from_table(given: Any, reading: Reading) -> Traction:
    """Return the law of the table [interface].

    Its range is equilibrium_gap or strength. A law that grows or ages has the word of its law at
    rest as ``base``, and the constants of both.
    """
    table = reading.given(given, "interface")
    kind = reading.choice(table, "interface", "law", reading.nouns.laws, OWN)
    del table["law"]
    if reading.pure:
        table = dict.fromkeys(_SCALES, 1.0) | table
    if not has_rest(kind):
        law = _of_gap(kind, table, reading)
        return law.reduced() if reading.pure else law
    rest = {word: law for word, law in reading.nouns.laws.items() if not has_rest(law)}
    table = {"base": LennardJones.word} | table
    base = reading.choice(table, "interface", "base", rest, OWN)
    growth = {field.name for field in _constants(kind)}
    own = cards(base).keys() | {"strength", "file", "points"}
    at_rest: Any = _of_gap(
        base, {k: v for k, v in table.items() if k in own and k not in growth}, reading
    )
    scales = {name: 1.0 if reading.pure else getattr(at_rest, name) for name in _SCALES}
    constants = {k: v for k, v in table.items() if k != "base" and (k in growth or k not in own)}
    said = {name: f"{x!r} {reading.unit(cards(kind)[name].card)}" for name, x in scales.items()}
    return read_as(kind, {**said, **constants, "base": at_rest.reduced()}, reading, "interface")


def _of_gap(kind: Any, table: Mapping[str, Any], reading: Reading) -> Traction:
    """Return a law of the gap alone."""
    if kind is Tabulated and "file" in table:
        return _tabulated(reading.file("interface", "file", table["file"]))
    if "strength" not in table:
        return read_as(kind, table, reading, "interface")
    if "equilibrium_gap" in table:
        raise InputError(
            f"{reading.where}, [interface] strength and equilibrium_gap determine each other; "
            "give only one",
            field="interface.strength",
        )
    table = dict(table)
    strength = reading.key("interface", "strength", STRENGTH, table.pop("strength"))
    law: Any = read_as(kind, table | {"equilibrium_gap": "1 m"}, reading, "interface")
    gap = kind(**{**vars(law), "work_of_adhesion": 1.0, "equilibrium_gap": 1.0}).strength
    return kind(**{**vars(law), "equilibrium_gap": gap * law.work_of_adhesion / strength})


def table_of_law(law: Any, *, pure: bool = False) -> dict[str, Any]:
    """Return the table [interface] of a law, with numbers in SI."""
    found = stated(law)
    base = found.pop("base", None)
    table = {"law": law.word}
    if base is not None:
        own = {k: v for k, v in stated(base).items() if k not in _SCALES}
        table |= {"base": base.word, **own}
    table |= found
    return {k: v for k, v in table.items() if not (pure and k in _SCALES)}


def law_from_words(words: str, beside: Callable[[str], Path] = Path) -> Traction:
    """Return the reduced law stated by an option: its name and, after a colon, its constants.

    `beside` returns the path of a file that it names.

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
    return law_from_table(table_of_words(words), Reading("the law", beside=beside, pure=True))


def table_of_words(words: str, laws: Mapping[str, Any] = LAWS) -> dict[str, Any]:
    """Return the table [interface] that the words of an option state.

    Examples
    --------
    >>> table_of_words("gent-schultz:10,0.4:exponential:0.25")["base"]
    'exponential'
    """
    name, _, rest = words.partition(":")
    if name not in laws:
        said = f"the law must be one of {', '.join(laws)}, got {words!r}{OWN}"
        raise UnknownNoun(said, field="law")
    kind: Any = laws[name]
    if kind is Tabulated:
        if not rest:
            raise InputError("the law table needs a file: table:FILE.csv")
        return {"law": name, "file": rest}
    base = ""
    if has_rest(kind):
        rest, _, base = rest.partition(":")
    constants = [constant.name for constant in _constants(kind)]
    needed = [constant.name for constant in _constants(kind) if constant.needed]
    given = rest.split(",") if rest else []
    if not len(needed) <= len(given) <= len(constants):
        wanted = ",".join(constant.upper() for constant in constants)
        more = "[:LAW AT REST]" if has_rest(kind) else ""
        raise InputError(f"write {name}{':' if wanted else ''}{wanted}{more}, got {words!r}")
    of_base = table_of_words(base, laws) if base else {}
    of_base = {"base" if key == "law" else key: value for key, value in of_base.items()}
    return {**of_base, "law": name, **dict(zip(constants, given, strict=False))}


def _constants(kind: Any) -> list[Field]:
    """Return the cards of a law except work and gap."""
    return [field for name, field in cards(kind).items() if name not in _SCALES]


def _tabulated(path: str | Path) -> Tabulated:
    columns = read_quantities(path, {"gap": "m", "traction": "Pa"})
    try:
        return Tabulated.of_points(columns["gap"], columns["traction"])
    except ValueError as error:
        raise InputError(f"{path}: {error}") from None
