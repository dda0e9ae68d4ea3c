"""Headings and units of laboratory tables, in the words and languages of instruments.

An unknown heading is ignored; a missing unit must be given by the caller. Hertz and radians per
second, and tensile (E) and shear (G) moduli, are never confused silently.
"""

import math
import re
import tomllib
import unicodedata
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from viscotack.errors import InputError
from viscotack.units import parse

from .numbers import is_number

_TEXT = Path(__file__).with_name("words.toml").read_text(encoding="utf-8")
WORDS: dict[str, dict[str, str]] = tomllib.loads(_TEXT)


_GREEK = "ωδητσγɣ"
# words of temperature inside headings
_TEMPERATURE = re.compile(
    r"temperatu(re|ra|ur|r)?|температур\w?|温度|溫度|온도|teplota|temp$|^temp"
)
_OF_SAMPLE, _OF_ROOM, _OF_RIG = (
    tuple(WORDS["temperatures"][name].split()) for name in ("sample", "room", "rig")
)
# differences, rates and constants in a unit of temperature are no temperatures of a test
_NO_TEMPERATURE = re.compile(
    r"δ|delta|diff|devia|abweich|std|error|uncert|toler|rate$|^rate|glass|^tg|^dt|^tt(g|0|r)|ramp|^ref|ref(eren[cz]e?)?$"
)
_LOGARITHM = re.compile(
    r"(?P<base>log_?10|log|lg|ln)\s*(?:\((?P<inside>.+?)\)|(?:[\s_]|(?=[EGfω]))(?P<bare>.+?))"
    r"\s*(?P<unit>[\[(][^()\[\]]*[\])])?",
    re.IGNORECASE,
)
_KIND_OF_SYMBOL = {"e": "E", "d": "E", "g": "G", "j": "G"}
# lower-case symbols denote permittivities; a tensile modulus has a capital E
_DIELECTRIC = {"e'", "e''", "ep", "epp"}
_QUOTES = str.maketrans({"’": "'", "‘": "'", "´": "'", "`": "'", "′": "'", "″": "''", '"': "''"})
_BRACKET = re.compile(r"(.*\S)\s*[\[(]([^\[\]()]*)[\])]")
_COMMA = re.compile(r"(.*\S)\s*,\s*(\S+)")
_SLASH = re.compile(r"(.*\S)\s*/\s*(\S+)")
_IN = re.compile(r"(.*\S)\s+(?:in|en)\s+(m?Pa s|rad s\S*|\S+)")
_WORD = re.compile(r"[^\W\d_]+")
# qualifiers in brackets that define another quantity, not a unit
_SORTS = {"cmd", "raw", "set", "std", "avg", "max", "min", "step"}
_LONGEST_UNIT = 3  # letters; a longer bracketed word that is not a unit is a description

POSSIBLE = 0.0, 3000.0  # K: possible temperatures of a test
# factor and offset to kelvin
_KELVIN = {
    **dict.fromkeys(("°C", "ºC", "˚C", "oC", "C", "degC", "deg C", "Celsius", "℃"), (1.0, 273.15)),
    **dict.fromkeys(("°F", "F", "degF", "Fahrenheit"), (5 / 9, 273.15 - 32 * 5 / 9)),
    "K": (1.0, 0.0),
}
_NO_UNIT = {"", "-", "[-]", "1", "–"}
_DEGREES = {"°", "º", "˚", "deg", "degree", "degrees", "grad"}
# units as they are written in names of variables; pint reads "pa" as 1e-12 years
_LOWER = {
    "hz": "Hz", "khz": "kHz", "pa": "Pa", "kpa": "kPa", "mpa": "MPa", "gpa": "GPa",
    "1/pa": "1/Pa", "rads": "rad/s", "c": "C", "degc": "degC", "k": "K", "pct": "%",
}  # fmt: skip
_PASCAL_SECOND = re.compile(r"Pa[-.·⋅ ]?s(ec)?")
STANDARD_GRAVITY = 9.80665  # m/s2: texture analysers give forces in grams
# factors of units that the unit library does not read, or reads as others
_FACTORS = {
    **dict.fromkeys(((unit, "1") for unit in _NO_UNIT), 1.0),
    ("%", "1"): 0.01,
    **dict.fromkeys(((unit, "rad") for unit in _DEGREES), math.pi / 180),
    **dict.fromkeys(((unit, "N") for unit in ("kg", "kgf")), STANDARD_GRAVITY),
    **dict.fromkeys(
        ((unit, "N") for unit in ("g", "gf", "gram", "grams")), 1e-3 * STANDARD_GRAVITY
    ),
    **dict.fromkeys(((unit, "s") for unit in ("sec", "secs", "sek", "seconds", "Sec")), 1.0),
}
_PER_SECOND = {"1/s", "s^-1", "s-1", "s⁻¹", "/s"}
# dimensions of columns
_TARGETS = ("Pa", "1/Pa", "s", "Hz", "rad/s", "Pa*s", "N", "N*m", "m", "1")


@dataclass(frozen=True)
class Heading:
    """Meaning of a heading: quantity, kind of modulus if stated, unit, and base of logarithms."""

    quantity: str
    kind: str | None
    unit: str
    base: float | None = field(default=None, repr=False)


def recognise(text: str, unit: str = "") -> Heading | None:
    """Return the meaning of a heading, or None for an unknown one.

    `unit` is the one below the heading: any column in degrees is one of temperatures.

    Examples
    --------
    >>> recognise("E' [MPa]")
    Heading(quantity='storage', kind='E', unit='MPa')
    >>> recognise("Kreisfrequenz")
    Heading(quantity='angular_frequency', kind=None, unit='')
    >>> recognise("Sample temperature (°C)").quantity, recognise("log10(G') [Pa]").base
    ('temperature', 10.0)
    >>> recognise("Normal force (N)") is None
    True
    """
    heading = _recognised(text)
    if heading is None and _is_degree(bare(unit)) and not _NO_TEMPERATURE.search(plain(text)):
        return Heading("temperature", None, "")
    # "GP in 1/s" of HAAKE RheoWin is gamma with a point, not a modulus
    if heading and heading.kind and bare(heading.unit or unit) in _PER_SECOND:
        return Heading("shear_rate", None, heading.unit)
    return heading


def _recognised(text: str) -> Heading | None:
    text = unquoted(text)
    whole = _named(text)
    if whole is not None:
        return Heading(*whole, "")
    for pattern in (_BRACKET, _SLASH, _IN):
        if match := pattern.fullmatch(text):
            name, rest = _named(match[1]), _named(match[2])
            if name is None:
                continue
            # "Storage modulus (E')": the bracket contains the symbol, not a unit
            if rest is not None and rest[0] == name[0]:
                return Heading(name[0], name[1] or rest[1], "")
            # "Stress (step)" and "G*/sin(delta)" are other quantities
            own = Heading(*name, match[2].strip())
            return own if _may_be_unit(match[2]) else _temperature(text)
    return _with_suffix(text) or _logarithm(text) or _temperature(text)


def _logarithm(text: str) -> Heading | None:
    """Return the meaning of the heading of logarithms, such as ``log10(G' [Pa])``."""
    match = _LOGARITHM.fullmatch(text)
    heading = recognise(match["inside"] or match["bare"]) if match else None
    # "Log time" is a time of recording
    if match is None or heading is None or (match["bare"] and heading.quantity == "time"):
        return None
    base = math.e if match["base"].casefold() == "ln" else 10.0
    return replace(heading, unit=heading.unit or bare(match["unit"] or ""), base=base)


def _temperature(text: str) -> Heading | None:
    """Return the heading of any temperature, such as ``T_sample``, ``Ofentemperatur [°C]``."""
    name, unit, mark = _without_degree(text)
    beside = _beside_temperature(name)
    known = beside is not None and beside in (*_OF_SAMPLE, *_OF_ROOM, *_OF_RIG, "s")
    # "A/C" is a ratio
    stated = unit and (mark is not _SLASH or len(unit) > 1 or beside is not None)
    if _NO_TEMPERATURE.search(plain(name)) or not (stated or (known and not unit)):
        return None
    return Heading("temperature", None, unit)


def _without_degree(text: str) -> tuple[str, str, re.Pattern[str] | None]:
    """Split a heading into its words, its unit of temperature, if any, and how that stands."""
    for pattern in (_BRACKET, _IN, _SLASH):
        match = pattern.fullmatch(text.strip())
        if match and _is_degree(match[2].strip()):
            return re.sub(r"[\[\]()]", " ", match[1]), match[2].strip(), pattern
    return re.sub(r"[\[\]()]", " ", text), "", None


def _beside_temperature(name: str) -> str | None:
    """Return what a heading says beside the word for temperature; None without that word."""
    match = re.fullmatch(r"T([_ .].+|s)", name.strip())
    if match:
        return plain(match[1])
    word = plain(name)
    return _TEMPERATURE.sub("", word) if _TEMPERATURE.search(word) else None


def recognise_tack(text: str, unit: str = "") -> Heading | None:
    """Return the meaning of a heading of a tack test, or None for an unknown one.

    Both heading and unit identify a column, because instruments use the same heading for volts.

    Examples
    --------
    >>> recognise_tack("Normal Force [N]"), recognise_tack("Standardweg").quantity
    (Heading(quantity='force', kind=None, unit='N'), 'travel')
    >>> recognise_tack("force_mN").unit, recognise_tack("Load (V)"), recognise_tack("Load", "V")
    ('mN', None, None)
    """
    text = unquoted(text)
    parts = [(text, "")]
    matches = (pattern.fullmatch(text) for pattern in (_BRACKET, _COMMA, _IN))
    parts += [(match[1], bare(match[2])) for match in matches if match]
    parts += [(text[: at.start()], text[at.end() :]) for at in re.finditer("_", text)]
    for name, own in parts:
        quantity = _BY_TACK_WORD.get(plain(name))
        if quantity is not None and measures(own, quantity):
            # a suffix such as "force_" has no unit
            return Heading(quantity, None, own) if measures(own or unit, quantity) else None
    found = recognise(text, unit)
    return found if found is not None and found.quantity == "temperature" else None


def measures(unit: str, quantity: str) -> bool:
    """Return whether a unit suits a quantity; an empty unit suits all."""
    if no_unit(unit) or (quantity == "time" and is_clock_unit(unit)):
        return True
    return _converts(unit, UNITS[quantity])


def nearness_to_sample(text: str) -> int:
    """Return 3 for a temperature of the sample, 2 for one without a word, 1 of the rig, 0 set.

    Examples
    --------
    >>> [nearness_to_sample(text) for text in ("T_sample", "T [K]", "Ofentemperatur", "T set (K)")]
    [3, 2, 1, 0]
    """
    name = re.sub(r"_(deg)?[CKck]$", "", _without_degree(text)[0])
    beside = _beside_temperature(name) or ""
    if beside == "s" or any(beside.startswith(w) or beside.endswith(w) for w in _OF_SAMPLE):
        return 3
    named = _named(name.strip())
    if named is not None and named[0] == "temperature":
        return 2
    return 0 if any(beside.startswith(w) or beside.endswith(w) for w in _OF_ROOM) else 1


def _is_degree(unit: str) -> bool:
    return unit in _KELVIN and unit != "F"


def _with_suffix(text: str) -> Heading | None:
    """Return the meaning of a heading with a unit suffix, such as ``time_s`` or ``omega_rad_s``."""
    for place in re.finditer("_", text):
        name, unit = _named(text[: place.start()]), text[place.end() :]
        unit = unit.replace("_per_", "/").replace("_", "/")
        unit = _LOWER.get(unit, unit)
        if not unit or not is_unit(unit):
            continue
        if name is not None:
            return Heading(*name, unit)
        if _is_degree(unit) and (len(unit) > 1 or _beside_temperature(text[: place.start()])):
            return Heading("temperature", None, unit)
    return None


def _may_be_unit(text: str) -> bool:
    """Return whether text is a unit or resembles a misspelt one."""
    text = text.strip()
    if is_unit(text):
        return True
    if text.casefold() in _SORTS or any(mark in text for mark in "(*"):
        return False
    return not (_WORD.fullmatch(text.split()[0]) and len(text.split()[0]) > _LONGEST_UNIT)


def unit_within(text: str) -> str:
    """Return the unit in a heading whose name has no meaning; empty without one.

    Examples
    --------
    >>> unit_within("Sample 3 [kPa]"), unit_within("Sample 3 [left]")
    ('kPa', '')
    """
    found = (pattern.fullmatch(text) for pattern in (_BRACKET, _IN))
    return next((m[2].strip() for m in found if m and is_unit(m[2])), "")


@lru_cache(maxsize=1000)
def is_unit(text: str) -> bool:
    """Return whether text is a unit of some rheometer column.

    Examples
    --------
    >>> is_unit("°C"), is_unit("1/MPa"), is_unit("step")
    (True, True, False)
    """
    unit = bare(text)
    if unit in {*_KELVIN, *_DEGREES, *_PER_SECOND, "rpm"} or is_clock_unit(unit):
        return True
    return any(_converts(unit, target) for target in _TARGETS)


def kind_of_geometry(text: str) -> str | None:
    """Return "E" for words on tension, "G" for words on shear, None for neither or both.

    Examples
    --------
    >>> kind_of_geometry("Geometry name: Dual cantilever"), kind_of_geometry("Torque")
    ('E', 'G')
    """
    word = plain(text)
    known = WORDS["geometries"].items()
    kinds = [kind for kind, words in known if any(each in word for each in words.split())]
    return kinds[0] if len(kinds) == 1 else None


def _named(text: str) -> tuple[str, str | None] | None:
    text = text.strip()
    if text in WORDS["letters"]:
        return WORDS["letters"][text], "G" if text == "J" else None
    word = plain(text)
    if text.translate(_QUOTES) in _DIELECTRIC:
        return None
    if word in _BY_SYMBOL:
        return _BY_SYMBOL[word]
    if word in _BY_WORD and (len(text) > 1 or text in _GREEK):
        return _BY_WORD[word], None
    # "Tensile storage modulus", "Storage modulus E'", "Shear stress"
    for kind, words in WORDS["kinds"].items():
        for first in words.split():
            if word.startswith(first) and word.removeprefix(first) in _BY_WORD:
                return _BY_WORD[word.removeprefix(first)], kind
    for symbol, (name, kind) in _BY_SYMBOL.items():
        beside = word.removesuffix(symbol), word.removeprefix(symbol)
        if name in map(_BY_WORD.get, beside):
            return name, kind
    return None


def plain(text: str) -> str:
    """Normalise a heading: lower case without spaces, underscores, hyphens, dots and accents."""
    text = text.translate(_QUOTES).replace("ɣ", "γ").replace("γ\u0307", "gammadot")
    text = unicodedata.normalize("NFKD", text).casefold()
    return "".join(c for c in text if not unicodedata.combining(c) and c not in " \t_-.:\u00a0")


def _by_word(*groups: str) -> dict[str, str]:
    """Return the quantity of every word of groups of words.toml."""
    pairs = (pair for group in groups for pair in WORDS[group].items())
    return {plain(word): quantity for quantity, words in pairs for word in words.split()}


_BY_WORD, _BY_TACK_WORD = _by_word("material", "unread"), _by_word("tack")
_BY_SYMBOL = {
    symbol: (quantity, None if "eta" in symbol else _KIND_OF_SYMBOL.get(symbol.strip("|")[0]))
    for symbol, quantity in _by_word("symbols").items()
}
UNITS = {name: unit for unit, names in WORDS["units"].items() for name in names.split()}
# names of quantities by which a caller chooses columns
COLUMNS = {plain(name): name for name in WORDS["material"]}


def unquoted(text: str) -> str:
    """Remove spaces and quotation marks around a text; a single mark may be a double prime."""
    text = text.strip()
    return text[1:-1].strip() if len(text) > 1 and text[0] == text[-1] == '"' else text


def no_unit(unit: str) -> bool:
    """Return whether a cell of the units row denotes a missing unit."""
    return bare(unit) in _NO_UNIT


def bare(unit: str) -> str:
    """Remove spaces and brackets around a unit."""
    unit = unit.strip()
    if len(unit) > 1 and unit[0] + unit[-1] in ("[]", "()"):
        unit = unit[1:-1].strip()
    return unit


def scale(unit: str, target: str) -> float:
    """Return the conversion factor from a unit to a target unit in SI.

    Examples
    --------
    >>> scale("[MPa]", "Pa"), scale("1/MPa", "1/Pa"), scale("%", "1")
    (1000000.0, 1e-06, 0.01)
    """
    unit = bare(unit)
    if (unit, target) in _FACTORS:
        return _FACTORS[unit, target]
    if target == "Pa*s":
        unit = _PASCAL_SECOND.sub("Pa*s", unit)
    return parse(f"1 {unit}", target)


def _converts(unit: str, target: str) -> bool:
    try:
        scale(unit, target)
    except InputError:
        return False
    return True


def same_unit(one: str, other: str) -> bool:
    """Return whether two units are equal, however they are written.

    Examples
    --------
    >>> same_unit("N/mm²", "MPa"), same_unit("°C", "degC"), same_unit("um", "mm")
    (True, True, False)
    """
    one, other = bare(one), bare(other)
    if one == other or ("rad" in one) != ("rad" in other):
        return one == other
    if {one, other} <= _KELVIN.keys():
        return _KELVIN[one] == _KELVIN[other]
    shared = (t for t in _TARGETS if _converts(one, t) and _converts(other, t))
    return any(math.isclose(scale(one, t), scale(other, t)) for t in shared)


def is_clock_unit(unit: str) -> bool:
    """Return whether a unit is a form of clock times, such as ``hh:mm:ss`` or ``[mm:ss]``.

    Examples
    --------
    >>> is_clock_unit("hh:mm:ss"), is_clock_unit("s")
    (True, False)
    """
    return re.fullmatch(r"(h+:)?m(m|in)?:s+([.,]\w+)?", bare(unit), re.IGNORECASE) is not None


def kelvin(unit: str) -> tuple[float, float]:
    """Return the factor and the offset that convert a temperature to kelvin."""
    if bare(unit) not in _KELVIN:
        raise InputError(f"{bare(unit)!r} is not a unit of temperature; expected C, K or F")
    return _KELVIN[bare(unit)]


def in_kelvin(number: float, unit: str) -> float:
    """Convert a temperature to kelvin; raise an error if no test can have it."""
    factor, offset = kelvin(unit)
    return possible(number * factor + offset)


def possible(kelvins: float) -> float:
    """Return a temperature [K] that a test can have; raise an error for any other."""
    if POSSIBLE[0] < kelvins < POSSIBLE[1]:
        return kelvins
    raise InputError(f"a temperature of {kelvins:g} K is impossible; check its unit")


def radians_per_second(unit: str, *, angular: bool) -> float:
    """Return the conversion factor from a frequency to rad/s.

    Parameters
    ----------
    unit : str
        Such as ``"Hz"`` or ``"rad/s"``.
    angular : bool
        Whether the heading denotes an angular frequency. A frequency in 1/s is ambiguous and is
        rejected; an angular frequency in hertz is contradictory and is rejected too.

    Examples
    --------
    >>> round(radians_per_second("Hz", angular=False), 3), radians_per_second("1/s", angular=True)
    (6.283, 1.0)
    """
    unit = bare(unit)
    if "rad" in unit:
        return scale(unit, "rad/s")
    if unit in _PER_SECOND:
        if angular:
            return 1.0
        raise InputError("1/s may be Hz or rad/s; set `frequency_unit` to one of them")
    # the unit library equates hertz and radians per second: compare names
    if unit.endswith("Hz"):
        if angular:
            raise InputError("an angular frequency is not in Hz; correct heading or unit")
        return 2 * math.pi * scale(unit, "Hz")
    if unit in ("rpm", "1/min", "min^-1"):
        raise InputError(f"{unit!r} is a speed of rotation; expected Hz or rad/s")
    raise InputError(f"{unit!r} is not a unit of frequency; expected Hz or rad/s")


class Vocabulary(NamedTuple):
    """Meaning of the headings of one kind of test, and the quantities that head a table."""

    recognise: Callable[[str, str], Heading | None]
    suffice: Callable[[set[str]], bool]
    usual: str
    columns: str
    choose: Callable[[str, int], str]

    def heads(self, row: Sequence[str], names: Sequence[str] = ()) -> bool:
        """Return whether a row heads a table, or names the columns given by the caller."""
        if names:
            held = {unquoted(cell).casefold() for cell in row}
            # a row of numbers may have the number of a column
            numeric = all(map(is_number, filter(None, held)))
            words = [name for name in names if name.casefold() in held and not numeric]
            numbers = [name for name in names if name not in words]
            return bool(words or self.heads(row)) and are_columns(numbers, row)
        # a label with a colon describes the test, unless two quantities follow
        row = row[1:] if row and row[0].rstrip().endswith(":") else row
        known = (self.recognise(cell, "") for cell in row)
        return self.suffice({heading.quantity for heading in known if heading is not None})


def are_columns(numbers: Sequence[str], row: Sequence[str]) -> bool:
    """Return whether a row has columns of these numbers."""
    return all(name.isdecimal() and 0 < int(name) <= len(row) for name in numbers)


POSITIONS = ("gap", "depth", "travel")
MATERIAL = Vocabulary(
    recognise,
    lambda found: len(found) > 1,
    "\"f, E', E'', T\"",
    '`columns` "frequency=1 [UNIT]; storage=2 [UNIT]; loss=3 [UNIT]"',
    lambda quantity, number: f'choose one, for example `columns` "{quantity}={number}"',
)
TACK = Vocabulary(
    recognise_tack,
    lambda found: "force" in found and bool(found & {*POSITIONS, "time"}),
    '"Time [s], Gap [mm], Normal Force [N]"',
    "`time_column` 1 `time_unit` UNIT `position_column` 2 `length_unit` UNIT `force_column` 3 "
    "`force_unit` UNIT",
    lambda quantity, number: (
        f"choose one, for example `{quantity}_column` {number}"
        if quantity in ("time", "position", "force")
        else "which of them is meant is unknown; leave one out"
    ),
)
