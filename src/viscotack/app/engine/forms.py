"""Input forms of the page, generated from the cards, so that new nouns appear automatically.

The forms are plain data from which the page creates its fields.
"""

from collections.abc import Iterable, Mapping
from dataclasses import asdict
from typing import Any

from viscotack.cards import Pairs, Quantity, cards
from viscotack.model.geometry import Bonded, Frictionless, Layer, MeasuredProfile, PowerLawProfile
from viscotack.model.problem import plane, revolution
from viscotack.model.problem.case_file import ProfilePoint
from viscotack.model.problem.law_table import STRENGTH
from viscotack.model.problem.nouns import Nouns, known
from viscotack.model.problem.protocol_table import STARTS
from viscotack.model.protocol import Apart, AtDepth, AtForce, AtRadius, Retraction
from viscotack.model.traction import Tabulated

# What a field begins with that has no example in its unit.
_SUGGESTED = {"Pa": "2 kPa", "Pa/m": "1 GPa/m", "1": "0.5"}
# Ways to begin, the usual one first.
_TITLES = {AtForce: "pressed by a load", AtDepth: "to a depth", AtRadius: "to a contact radius"}


def forms(also: Iterable[Any] = ()) -> dict[str, Any]:
    """Return the fields of all tables of a case file.

    Parameters
    ----------
    also : iterable of classes
        User-defined laws, materials and shapes.

    Returns
    -------
    dict
        ``material``, ``interface``, ``shape``: a list of choices, each with its word, title, words
        and fields; ``layer``; ``protocol`` with its starts, by symmetry.

    Examples
    --------
    >>> [choice["word"] for choice in forms()["shape"]]
    ['sphere', 'cone', 'profile', 'wavy-sphere', 'disc', 'punch']
    """
    nouns = known(also)
    return {
        "material": [_choice(word, kind) for word, kind in nouns.materials.items()],
        "interface": _laws(nouns),
        # a table of heights is a file's, and cannot be typed
        "shape": [
            _shape(w, kind) for w, kind in nouns.shapes.items() if kind is not MeasuredProfile
        ],
        "layer": {
            "fields": _fields(Layer),
            "bases": [{"word": base.word} for base in (Frictionless, Bonded)],
        },
        "protocol": {"revolution": _protocol(revolution.SI), "plane": _protocol(plane.SI)},
    }


def _choice(word: str, kind: Any, extra: Iterable[dict[str, Any]] = ()) -> dict[str, Any]:
    return {
        "word": word,
        "words": _first(kind),
        "fields": [*_fields(kind), *extra],
    }


def _laws(nouns: Nouns) -> list[dict[str, Any]]:
    """Return the laws that numbers state; one that is a file's table cannot be typed."""
    found = []
    for word, kind in nouns.laws.items():
        if kind is Tabulated:
            continue
        choice = _choice(word, kind)
        for field in choice["fields"]:
            if field["key"] == "equilibrium_gap":
                field["or"] = _asked("strength", STRENGTH)
        found.append(choice)
    return found


def _shape(word: str, kind: Any) -> dict[str, Any]:
    choice = _choice(word, kind) | {"symmetry": kind.symmetry}
    if kind is PowerLawProfile:
        choice["fields"] = _fields(ProfilePoint)
    return choice


def _protocol(units: Mapping[str, str]) -> dict[str, Any]:
    """Return the fields of the protocol, in the units of a geometry."""
    test, known = cards(Retraction), {x: key for key, x in STARTS[units["force"]].items()}
    starts = []
    for kind in (x for x in _TITLES if x in known):
        (field,) = cards(kind).values()
        asked = _asked(known[kind], field.card, units[field.card.measure])
        starts.append(asked | {"title": _TITLES[kind]})
    (gap,) = cards(Apart).values()
    apart = _asked("start", gap.card) | {"title": "apart", "prefix": "apart "}
    return {
        "starts": [*starts, apart],
        "speed": _asked("speed", test["speed"].card),
        "stiffness": _asked("stiffness", test["stiffness"].card, units["stiffness"], optional=True),
        "moves": [
            "approach 10 um/s to force 1.5 mN",
            "dwell 60 s",
            "hold force 60 s",
            "retract 10 um/s to depth -5 um",
            "move to 2 um in 1 s",
            "load to 1 mN in 1 s",
        ],
    }


def _fields(kind: Any) -> list[dict[str, Any]]:
    found = (*cards(kind).values(), *cards(kind, Pairs).values())
    return [_asked(field.name, field.card, optional=not field.needed) for field in found]


def _asked(
    key: str, card: Quantity | Pairs, unit: str = "", *, optional: bool = False
) -> dict[str, Any]:
    """Return a field as plain data: what its card says, and an example in its unit."""
    said = asdict(card) | {"key": key, "optional": optional}
    if isinstance(card, Pairs):
        return said | {"kind": "pairs"}
    unit = unit or card.unit
    example = card.example if unit == card.unit else ""
    return said | {
        "kind": "number",
        "unit": unit,
        "range": card.range,
        "example": example or _SUGGESTED.get(unit, "1"),
    }


def _first(kind: Any) -> str:
    """Return the first sentence of a class's docstring."""
    return (kind.__doc__ or "").strip().partition("\n")[0].removeprefix("Describe ")
