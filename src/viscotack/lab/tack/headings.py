"""Headings of tack tests in the words of rigs: force, travel, time and contact radius.

Both heading and unit identify a column, because instruments use the same heading for volts.
Texture analysers give forces in grams.
"""

import re
from dataclasses import dataclass

from viscotack.errors import InputError
from viscotack.lab.quantities import BRACKET, IN, bare, is_clock_unit, no_unit, plain, scale

# quantity -> words, lower case, without spaces, marks and accents
_WORDS = {
    "force": "force load normalforce kraft normalkraft standardkraft standardforce prufkraft last "
    "axialforce fn forcenormale effort charge fuerza carga verticalforce contactforce tipforce",
    "gap": "gap spalt spaltbreite messspalt measuringgap separation tipsampleseparation entrefer "
    "plategap h",
    "depth": "depth indentation indentationdepth penetration penetrationdepth eindringtiefe "
    "profondeur profundidad",
    "travel": "travel extension displacement distance position crosshead crossheadtravel "
    "crossheadposition traverse traversenweg weg standardweg standardtravel verschiebung "
    "compressiveextension height zposition zheight deplacement desplazamiento stroke hub",
    "time": "time zeit testtime testzeit prufzeit elapsedtime totaltime temps tiempo t",
    "contact_radius": "contactradius kontaktradius rayondecontact",
    "contact_diameter": "contactdiameter kontaktdurchmesser",
    "contact_area": "contactarea kontaktflache airedecontact",
}  # fmt: skip
_BY_WORD = {word: name for name, words in _WORDS.items() for word in words.split()}
POSITIONS = ("gap", "depth", "travel")
SIZES = ("contact_radius", "contact_diameter", "contact_area")
_SI = {
    "force": "N",
    "gap": "m",
    "depth": "m",
    "travel": "m",
    "time": "s",
    "contact_radius": "m",
    "contact_diameter": "m",
    "contact_area": "m^2",
}
STANDARD_GRAVITY = 9.80665  # m/s2: to convert grams to newtons
_GRAMS = {"g": 1e-3, "gf": 1e-3, "kg": 1.0, "kgf": 1.0, "gram": 1e-3, "grams": 1e-3}
_SECONDS = {"sec": "s", "secs": "s", "sek": "s", "seconds": "s", "Sec": "s"}
_COMMA = re.compile(r"(.*\S)\s*,\s*(\S+)")


@dataclass(frozen=True)
class Heading:
    """Meaning of a heading: the quantity, and the unit if the heading contains it."""

    quantity: str
    unit: str


def recognise(text: str) -> Heading | None:
    """Return the meaning of a heading, or None for an unknown one.

    Examples
    --------
    >>> recognise("Normal Force [N]"), recognise("Standardweg")
    (Heading(quantity='force', unit='N'), Heading(quantity='travel', unit=''))
    >>> recognise("force_mN"), recognise("Load (V)") is None, recognise("Tensile strain") is None
    (Heading(quantity='force', unit='mN'), True, True)
    """
    text = text.strip().strip('"').strip()
    if (whole := _BY_WORD.get(plain(text))) is not None:
        return Heading(whole, "")
    for pattern in (BRACKET, _COMMA, IN):
        match = pattern.fullmatch(text)
        name = _BY_WORD.get(plain(match[1])) if match else None
        if match and name:
            return Heading(name, bare(match[2])) if measures(match[2], name) else None
    for place in re.finditer("_", text):
        name, unit = _BY_WORD.get(plain(text[: place.start()])), text[place.end() :]
        if name is not None and not no_unit(unit) and measures(unit, name):
            return Heading(name, unit)
    return None


def factor(unit: str, quantity: str) -> float:
    """Return the conversion factor from a unit to SI; grams are converted to newtons.

    Examples
    --------
    >>> factor("mm", "gap"), round(factor("g", "force"), 6)
    (0.001, 0.009807)
    """
    own = bare(unit)
    if quantity == "time" and is_clock_unit(own):
        return 1.0
    if quantity == "force" and own in _GRAMS:
        return _GRAMS[own] * STANDARD_GRAVITY
    return scale(_SECONDS.get(own, own), _SI[quantity])


def measures(unit: str, quantity: str) -> bool:
    """Return whether a unit suits a quantity; an empty unit suits all."""
    if no_unit(unit):
        return True
    try:
        factor(unit, quantity)
    except InputError:
        return False
    return True
