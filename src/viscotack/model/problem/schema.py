"""JSON schema of the tables of a problem, and tables of its numbers for people, from the cards."""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import MISSING, fields
from typing import Any, get_args, get_type_hints

from viscotack.cards import Pairs, Quantity, card_of, cards
from viscotack.model.geometry import (
    Bonded,
    Cone,
    Frictionless,
    HalfSpace,
    Layer,
    MeasuredProfile,
    PowerLawProfile,
    Sphere,
)
from viscotack.model.materials import Prony
from viscotack.model.materials.constants import ModulusRatio
from viscotack.model.problem import plane, revolution
from viscotack.model.problem.case_file import (
    STARTS,
    STRENGTH,
    GroupsTable,
    LayerTable,
    PassportTable,
    ProfilePoint,
    ProtocolTable,
)
from viscotack.model.problem.nouns import Nouns, known
from viscotack.model.problem.problem import Groups
from viscotack.model.problem.rough_case import KINDS, StatedSurface
from viscotack.model.protocol import Apart, AtDepth, AtForce, AtRadius, Retraction
from viscotack.model.traction import LennardJones, Tabulated, has_rest

_TYPES = {bool: "boolean", int: "integer", str: "string"}
# Alternatives of a table: the keys that each needs.
_WAYS = {
    Prony: (("branches",), ("file",)),
    Tabulated: (("file",), ("work_of_adhesion", "equilibrium_gap", "points")),
    MeasuredProfile: (("file",), ("points",)),
    PowerLawProfile: (
        ("exponent", "height", "at_radius"),
        ("slope",),
        ("file",),
        ("coefficient", "exponent"),
    ),
    StatedSurface: (("kind",), ("file",)),
}
# Keys that a dimensionless problem leaves out.
_IMPLIED = {"rubbery_modulus", "poisson_ratio", "tau0", "coefficient", "base"}
_IMPLIED |= {"work_of_adhesion", "equilibrium_gap"}
# A history has the moves.
_ALONE = {"history": {"properties": {"moves": {"maxItems": 0}}}}
_MOVES = (
    "approach 20 um/s to force {0}",
    "dwell 1 s",
    "hold force 60 s",
    "retract 10 um/s to depth -5 um",
    "move to 2 um in 1 s",
    "load to {0} in 1 s",
)


def schema(also: Iterable[Any] = ()) -> dict[str, Any]:
    """Return the JSON schema of the tables of a problem, in SI or dimensionless.

    `$defs` has each table: its keys with units and ranges; those that are `required`; and in
    `oneOf` alternatives that need other keys. The tables of a dimensionless problem begin with
    "reduced-". Relations between numbers are left to the reader.

    Parameters
    ----------
    also : iterable of classes
        User-defined laws, materials, shapes and bodies to include.

    Examples
    --------
    >>> found = schema()["$defs"]["sphere"]["properties"]["radius"]
    >>> found["unit"], found["exclusiveMinimum"]
    ('m', 0)
    """
    nouns, tables = known(also), dict[str, Any]()
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A problem of viscotack",
        "type": "object",
        "if": {"required": ["groups"]},
        "then": _problem(nouns, tables, pure=True),
        "else": _problem(nouns, tables, pure=False),
        "$defs": tables,
    }


def _problem(nouns: Nouns, tables: dict[str, Any], *, pure: bool) -> dict[str, Any]:
    """Return the schema of a problem, and add those of its tables."""

    def refer(found: Mapping[str, Any]) -> dict[str, Any]:
        names = {word: f"{'reduced-' * pure}{word}" for word in found}
        tables.update({names[word]: table for word, table in found.items()})
        return {word: {"$ref": f"#/$defs/{name}"} for word, name in names.items()}

    test = "groups" if pure else "protocol"
    families = {"material": _materials(nouns, pure), "interface": _laws(nouns, pure)}
    named = {name: {"anyOf": [*refer(found).values()]} for name, found in families.items()}
    shapes, bodies = refer(_shapes(nouns, pure)), refer(_bodies(nouns, pure))
    tests = refer({test: _test(pure, flat=False), f"{test}-of-a-punch": _test(pure, flat=True)})
    one: list[Any] = [{"required": [word]} for word in shapes]
    flat = [{"required": [w]} for w, kind in nouns.shapes.items() if kind.symmetry == "plane"]
    return {
        "properties": {**named, **shapes, **bodies, test: True},
        "maxProperties": 5,  # one body
        "required": ["material", test] if pure else ["material", "interface", test],
        "additionalProperties": False,
        # without dimensions a sphere on a half-space is implied
        "oneOf": [*one, {"not": {"anyOf": [*one, {"required": [Layer.word]}]}}] if pure else one,
        "if": {"anyOf": flat},
        "then": {
            "properties": {test: tests[f"{test}-of-a-punch"]},
            "anyOf": [{"required": [word]} for word in bodies],
        },
        "else": {"properties": {test: tests[test]}},
    }


def _materials(nouns: Nouns, pure: bool) -> dict[str, Any]:
    found = {word: _table((kind,), pure, model=word) for word, kind in nouns.materials.items()}
    found["passport"] = _table((PassportTable,), False)
    if pure:
        del found["passport"]["properties"]["temperature"]
    return found


def _laws(nouns: Nouns, pure: bool) -> dict[str, Any]:
    """Return the tables of laws; one that grows or ages has a table for each law at rest."""
    resting = {word: kind for word, kind in nouns.laws.items() if not has_rest(kind)}
    found = {word: _table((kind,), pure, law=word) for word, kind in resting.items()}
    for word, kind in ((word, nouns.laws[word]) for word in nouns.laws if word not in resting):
        for rest, base in resting.items():
            found[f"{word}-on-{rest}"] = _table((base, kind), pure, law=word, base=rest)
        usual = found[word] = found.pop(f"{word}-on-{LennardJones.word}")
        usual["required"].remove("base")
    return found


def _shapes(nouns: Nouns, pure: bool) -> dict[str, Any]:
    found = {}
    for word, kind in nouns.shapes.items():
        ways = (Cone,) if pure else (ProfilePoint, Cone)
        kinds = (*ways, kind) if kind is PowerLawProfile else (kind,)
        found[word] = _table(kinds, pure) | {"symmetry": kind.symmetry}
    if pure:
        return found | {Sphere.word: found[Sphere.word] | {"required": []}}
    surface, kinds = _table((StatedSurface,), pure), {"enum": [*KINDS]}
    many = {"type": "array", "items": kinds, "minItems": 1}
    surface["properties"]["kind"] = {"anyOf": [kinds, many]}
    return found | {"surface": surface}


def _bodies(nouns: Nouns, pure: bool) -> dict[str, Any]:
    layer, bases = _table((LayerTable,), pure), [Frictionless.word, Bonded.word]
    layer["properties"]["base"] = {"enum": bases, "description": "how the layer is held"}
    layer["required"] += [] if pure else ["base"]
    others = {word: kind for word, kind in nouns.bodies.items() if kind not in (HalfSpace, Layer)}
    return {Layer.word: layer} | {word: _table((kind,), pure) for word, kind in others.items()}


def _test(pure: bool, *, flat: bool) -> dict[str, Any]:
    """Return the table [groups] or [protocol] of a punch, or of an indenter of revolution."""
    units = (plane if flat else revolution).SI
    starts = [*STARTS["1" if pure else units["force"]]]
    if flat and pure:
        # the contact of a punch is as wide as the punch
        starts.remove("preload_radius")
    table = _table((GroupsTable if pure else ProtocolTable,), pure, units=units)
    keys = table["properties"]
    unknown = {key for key in keys if key.startswith("preload_")} - {*starts}
    if pure:
        ways = ["rate", "moves"]
        keys["moves"] = {"type": "array", "items": {"type": "string"}}
        table["required"] = ["cohesion" if flat else "tabor"]
        unknown |= {"tabor" if flat else "cohesion"}
    else:
        starts, ways = [*starts, "start", "history"], ["speed", "moves", "history"]
        moves = [x.format("2 kPa" if flat else "0.5 mN") for x in _MOVES]
        words = "apart|depth|force" if flat else "apart|depth|force|radius"
        text = {"type": "string", "pattern": rf"^\s*({words}) "}
        keys["start"] = _number(cards(Apart)["gap"].card, "m") | text
        keys["start"]["examples"] = ["apart 20 um"]
        keys["cycles"]["minimum"] = 1
        keys["moves"] |= {"items": {"type": ["string", "object"]}, "examples": [moves]}
    table["properties"] = {key: value for key, value in keys.items() if key not in unknown}
    return table | {
        "oneOf": [{"required": [key]} | _ALONE.get(key, {}) for key in starts],
        "anyOf": [{"required": [key]} for key in ways],
    }


def _table(
    kinds: Sequence[Any], pure: bool, units: Mapping[str, str] = revolution.SI, **words: str
) -> dict[str, Any]:
    """Return the schema of a table that has the fields of some classes, and words by key.

    `units` are those of what the machine controls, by the measures of cards.
    """
    keys: dict[str, Any] = {key: {"const": word} for key, word in words.items()}
    needed = [*words]
    for kind in kinds:
        hints = get_type_hints(kind)
        for x in (x for x in fields(kind) if x.init and x.name not in keys):
            types = [_TYPES[t] for t in (hints[x.name], *get_args(hints[x.name])) if t in _TYPES]
            keys[x.name] = {"type": types[0] if types else "array"}
            needed += [x.name] if x.default is MISSING else []
        for name, field in cards(kind).items():
            unit = units.get(field.card.measure, field.card.unit)
            keys[name] = _number(field.card, "1" if pure else unit)
        keys |= {name: _pairs(field.card) for name, field in cards(kind, Pairs).items()}
    if ways := next((_WAYS[kind] for kind in kinds if kind in _WAYS), ()):
        keys["file"] = {"type": "string", "description": "a file beside this one"}
    elif "glassy_modulus" in keys:
        keys["modulus_ratio"] = _number(card_of(ModulusRatio), "1")
        ways = (("glassy_modulus",), ("modulus_ratio",))
    elif "equilibrium_gap" in keys and not pure:
        keys["strength"], ways = _number(STRENGTH, "Pa"), (("equilibrium_gap",), ("strength",))
    implied = _IMPLIED - words.keys() if pure else set[str]()
    ways = [way for way in ways if keys.keys() >= {*way}]
    free = implied.union(*ways)
    summary = (kinds[-1].__doc__ or "").strip().partition("\n")[0]
    found = {
        "description": summary.removeprefix("Describe "),
        "type": "object",
        "properties": keys,
        "required": [key for key in needed if key not in free],
        "additionalProperties": False,
    }
    one = [
        {
            "required": [key for key in way if key not in implied],
            "properties": {key: False for other in ways for key in other if key not in way},
        }
        for way in ways
    ]
    return found | ({"oneOf": one} if one else {})


def _number(card: Quantity, unit: str) -> dict[str, Any]:
    """Return the schema of a number in a unit; text with another unit is one as well."""
    found: dict[str, Any] = {"type": "number", "description": card.words, "unit": unit}
    bounds = {"exclusiveMinimum": card.above, "minimum": card.least, "maximum": card.most}
    found |= {"symbol": card.symbol} | {key: x for key, x in bounds.items() if x is not None}
    example = card.example_in(unit)
    if unit == cards(PowerLawProfile)["coefficient"].card.unit:
        return found | {"examples": [float(example.split()[0])]}
    if card.above == 0:
        found["pattern"] = r"^\s*\+?[0.]*[1-9]"
    elif card.least == 0:
        found["pattern"] = r"^\s*\+?[0-9.]"
    examples = [float(example) if unit == "1" else example]
    return found | {"type": ["number", "string"], "examples": examples}


def _pairs(card: Pairs) -> dict[str, Any]:
    """Return the schema of a list of pairs of numbers."""
    number = {"type": ["number", "string"]}
    return {
        "type": "array",
        "items": {"type": "array", "items": number, "minItems": 2, "maxItems": 2},
        "minItems": card.fewest,
        "maxItems": card.most,
        "description": card.words,
        "units": list(card.units),
        "symbol": card.symbol,
        "examples": [json.loads(card.example or "[]")],
    }


def words(also: Iterable[Any] = ()) -> str:
    """Return Markdown tables of the parameters: word, symbol, unit and meaning."""
    nouns = known(also)
    rooms: Mapping[str, Any] = {
        "Materials": nouns.materials.values(),
        "Traction laws": nouns.laws.values(),
        "Shapes and bodies": (*nouns.shapes.values(), *nouns.bodies.values(), Bonded),
        "The test": (AtDepth, AtForce, AtRadius, Apart, Retraction),
        "Dimensionless": (Groups,),
    }
    heading = ["| word | symbol | unit | meaning | of |", "|---|---|---|---|---|"]
    lines: list[str] = []
    for title, kinds in rooms.items():
        rows: dict[str, list[str]] = {}
        for kind in kinds:
            for name, field in (cards(kind) | cards(kind, Pairs)).items():
                card = field.card
                unit = card.unit if isinstance(card, Quantity) else ", ".join(card.units)
                limits = f"; must {card.range}" if getattr(card, "range", "") else ""
                row = f"| `{name}` | {card.symbol} | {unit} | {card.words}{limits} |"
                rows.setdefault(row, []).append(f"`{kind.__name__}`")
        lines += [f"### {title}", "", *heading]
        for row, of in rows.items():
            lines.append(f"{row} {'all' if len(of) == len(kinds) > 1 else ', '.join(of)} |")
        lines.append("")
    if nouns.observables:
        lines += ["### Observables", "", "| name | measures | meaning |", "|---|---|---|"]
        lines += [f"| `{x.name}` | {x.measure} | {x.words} |" for x in nouns.observables]
        lines.append("")
    return "\n".join(lines)
