"""JSON schema of a problem, and tables of its parameters; both are generated from the cards."""

from collections.abc import Iterable, Mapping
from dataclasses import MISSING
from typing import Any

from viscotack.cards import Field, Pairs, Quantity, cards
from viscotack.geometry import Bonded
from viscotack.problem import plane
from viscotack.problem.nouns import known
from viscotack.problem.problem import Groups
from viscotack.problem.protocol_table import GroupsTable, ProtocolTable
from viscotack.problem.rough_case import StatedSurface
from viscotack.problem.tables import adapter
from viscotack.protocol import Apart, AtDepth, AtForce, AtRadius, Retraction


def schema(also: Iterable[Any] = ()) -> dict[str, Any]:
    """Return the JSON schema of the tables of a problem, in SI or dimensionless.

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
    shapes = {**nouns.shapes, "surface": StatedSurface}
    bodies = {word: kind for word, kind in nouns.bodies.items() if word != "half-space"}
    tests = {"protocol": ProtocolTable, "groups": GroupsTable}
    defined = {word: _object(kind) for word, kind in {**shapes, **bodies, **tests}.items()}
    families = {"material": ("model", nouns.materials), "interface": ("law", nouns.laws)}
    for key, kinds in families.values():
        defined |= {word: _object(kind, key) for word, kind in kinds.items()}
    properties: dict[str, Any] = {
        name: {"anyOf": [{"$ref": f"#/$defs/{word}"} for word in kinds]}
        for name, (_, kinds) in families.items()
    }
    properties |= {word: {"$ref": f"#/$defs/{word}"} for word in (*shapes, *bodies, *tests)}
    return {
        "title": "A problem of viscotack",
        "type": "object",
        "properties": properties,
        "required": ["material"],
        "additionalProperties": False,
        "$defs": defined,
    }


def _object(kind: Any, key: str = "") -> dict[str, Any]:
    """Return the schema of a table: the fields of a class, with its word under a key."""
    from pydantic.json_schema import GenerateJsonSchema

    class Tables(GenerateJsonSchema):
        """A noun inside a noun is stated by its word."""

        def handle_invalid_for_json_schema(self, schema: Any, error_info: str) -> dict[str, Any]:
            return {"type": "string"}

    found = adapter(kind).json_schema(schema_generator=Tables)
    found.pop("$defs", None)
    base = found["properties"].get("base")
    if base is not None:
        found["properties"]["base"] = {"type": "string"}
    if key:
        found["properties"] = {key: {"const": kind.word}} | found["properties"]
        found["required"] = [key, *found.get("required", [])]
    return found


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
    lines: list[str] = []
    for title, kinds in rooms.items():
        rows: dict[tuple[str, ...], list[str]] = {}
        for kind in kinds:
            for field in (*cards(kind).values(), *cards(kind, Pairs).values()):
                rows.setdefault(_row(field), []).append(f"`{kind.__name__}`")
        if title == "Dimensionless":
            sizes = (Field(name, card, MISSING) for name, card in plane.SIZES.items())
            rows |= {_row(field): ["a punch"] for field in sizes}
        lines += [
            f"### {title}",
            "",
            "| word | symbol | unit | meaning | of |",
            "|---|---|---|---|---|",
        ]
        every = len(kinds) if len(kinds) > 1 else 0
        classes = {row: "all" if len(of) == every else ", ".join(of) for row, of in rows.items()}
        lines += [f"| {' | '.join(row)} | {of} |" for row, of in classes.items()]
        lines.append("")
    if nouns.observables:
        lines += ["### Observables", "", "| name | measures | meaning |", "|---|---|---|"]
        lines += [f"| `{x.name}` | {x.measure} | {x.words} |" for x in nouns.observables]
        lines.append("")
    return "\n".join(lines)


def _row(field: Field) -> tuple[str, ...]:
    """Return word, symbol, unit and meaning of a field."""
    card = field.card
    unit = card.unit if isinstance(card, Quantity) else ", ".join(card.units)
    limits = f"; must {card.range}" if getattr(card, "bounded", False) else ""
    return f"`{field.name}`", card.symbol, unit, f"{card.words}{limits}"
