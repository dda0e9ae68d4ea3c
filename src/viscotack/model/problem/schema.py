"""JSON schema of the tables of a problem, and tables of its numbers for people, from the cards."""

from collections.abc import Iterable, Mapping
from typing import Any

from viscotack.cards import Pairs, Quantity, card_of, cards
from viscotack.model.geometry import Bonded, Cone, HalfSpace, Layer, PowerLawProfile
from viscotack.model.materials.constants import ModulusRatio
from viscotack.model.problem.case_file import (
    STRENGTH,
    GroupsTable,
    LayerTable,
    PassportTable,
    ProfilePoint,
    ProtocolTable,
)
from viscotack.model.problem.nouns import known
from viscotack.model.problem.problem import Groups
from viscotack.model.problem.rough_case import StatedSurface
from viscotack.model.protocol import Apart, AtDepth, AtForce, AtRadius, Retraction
from viscotack.model.tables import adapter
from viscotack.model.traction import has_rest

_TEXT: dict[str, Any] = {"type": "string"}


def schema(also: Iterable[Any] = ()) -> dict[str, Any]:
    """Return the JSON schema of the tables of a problem, in SI or dimensionless.

    It has the keys of each table with their units and ranges. Which of them must be given depends
    on others (a strength or a gap, a file or numbers, [groups] or [protocol]); the reader says so.

    Parameters
    ----------
    also : iterable of classes
        User-defined laws, materials, shapes and bodies to include.

    Examples
    --------
    >>> found = schema()["$defs"]["sphere"]["properties"]["radius"]
    >>> found["unit"], found["anyOf"][0]["exclusiveMinimum"]
    ('m', 0)
    """
    nouns = known(also)
    file = {"file": _TEXT}
    points = {PowerLawProfile.word: (PowerLawProfile, ProfilePoint, Cone)}
    tables = {
        **{
            word: _keys(*points.get(word, (kind,)), more=file if "profile" in word else {})
            for word, kind in nouns.shapes.items()
        },
        **{w: _keys(kind) for w, kind in nouns.bodies.items() if kind is not HalfSpace},
        Layer.word: _keys(LayerTable),
        "surface": _keys(StatedSurface),
        "protocol": _keys(ProtocolTable),
        "groups": _keys(GroupsTable),
    }
    tables["surface"]["kind"] = {"anyOf": [_TEXT, tables["surface"]["kind"]]}
    solids = {
        word: _keys(
            kind,
            more={"model": {"const": word}, "modulus_ratio": _json(card_of(ModulusRatio))} | file,
        )
        for word, kind in nouns.materials.items()
    }
    solids["passport"] = _keys(PassportTable)
    resting = [law for law in nouns.laws.values() if not has_rest(law)]
    laws = {
        word: _keys(
            *(resting if has_rest(kind) else ()),
            kind,
            more={"law": {"const": word}, "base": _TEXT, "strength": _json(STRENGTH)} | file,
        )
        for word, kind in nouns.laws.items()
    }
    return {
        "title": "A problem of viscotack",
        "type": "object",
        "properties": {
            "material": {"anyOf": [_reference(word) for word in solids]},
            "interface": {"anyOf": [_reference(word) for word in laws]},
            **{word: _reference(word) for word in tables},
        },
        "required": ["material"],
        "additionalProperties": False,
        "$defs": {
            word: {"type": "object", "properties": keys, "additionalProperties": False}
            for word, keys in {**tables, **solids, **laws}.items()
        },
    }


def _reference(word: str) -> dict[str, str]:
    return {"$ref": f"#/$defs/{word}"}


def _json(card: Quantity) -> dict[str, Any]:
    return card.__get_pydantic_json_schema__(None, None)


def _keys(*kinds: Any, more: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Return the keys of a table that states one of these classes, with their schemas."""
    from pydantic.json_schema import GenerateJsonSchema

    class Tables(GenerateJsonSchema):
        """A noun inside a noun is stated by its word."""

        def handle_invalid_for_json_schema(self, schema: Any, error_info: str) -> dict[str, Any]:
            return _TEXT

    found: dict[str, Any] = {}
    for kind in kinds:
        found |= adapter(kind).json_schema(schema_generator=Tables)["properties"]
    return found | dict(more or {})


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
