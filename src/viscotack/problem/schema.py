"""JSON schema of a problem, and tables of its parameters; both are generated from the cards.

The schema describes the dictionaries of :func:`viscotack.to_dict`, as stored by results and
campaigns and accepted from other programs.
"""

import types
from collections.abc import Iterable
from dataclasses import MISSING, fields
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from viscotack.cards import Field, Pairs, Quantity, cards
from viscotack.geometry import Body, Bonded, FlatPunch, Shape
from viscotack.materials import Material
from viscotack.problem import plane
from viscotack.problem.nouns import Nouns, known
from viscotack.problem.problem import Groups, Problem
from viscotack.protocol import Apart, AtDepth, AtForce, AtRadius, Retraction
from viscotack.traction import Traction, has_rest

_PROBLEMS = (Problem, Groups)


def schema(also: Iterable[Any] = ()) -> dict[str, Any]:
    """Return the JSON schema of a problem, in SI or dimensionless.

    Parameters
    ----------
    also : iterable of classes
        User-defined laws, materials and shapes to include.

    Examples
    --------
    >>> found = schema()["$defs"]["Sphere"]["properties"]["radius"]
    >>> found["unit"], found["exclusiveMinimum"]
    ('m', 0)
    """
    from pydantic import TypeAdapter

    models = _Models(known(also))
    problems: Any = Union[tuple(models.of(kind) for kind in _PROBLEMS)]  # noqa: UP007
    return TypeAdapter(problems).json_schema() | {"title": "A problem of viscotack"}


def words(also: Iterable[Any] = ()) -> str:
    """Return Markdown tables of the parameters: word, symbol, unit and meaning."""
    nouns = known(also)
    rooms = {
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


class _Models:
    """Pydantic models from which the schema is generated, one for each class of a problem.

    A model has the fields of its class, described by their cards, and a field ``type``.
    """

    def __init__(self, nouns: Nouns) -> None:
        self._nouns = nouns
        self._made: dict[Any, Any] = {}

    def of(self, kind: Any) -> Any:
        """Return the model of a class, which its records name as their type."""
        from pydantic import ConfigDict, Field, create_model

        if kind not in self._made:
            hints = get_type_hints(kind, include_extras=True)
            told: dict[str, Any] = {"type": (Literal[kind.__name__], ...)}
            for field in fields(kind):
                # records omit default values, so the schema needs only their existence
                given = ... if field.default is MISSING else Field(default_factory=dict)
                told[field.name] = (self._told(hints[field.name], has_rest(kind)), given)
            forbid = ConfigDict(extra="forbid")
            self._made[kind] = create_model(kind.__name__, __config__=forbid, **told)
        return self._made[kind]

    def _told(self, hint: Any, at_rest: bool) -> Any:
        """Return the type of a field, with the known classes in place of their protocol.

        The base of a growing law must be a law at rest.
        """
        laws = self._nouns.laws
        kinds = {
            Material: self._nouns.materials,
            Traction: {w: k for w, k in laws.items() if not (at_rest and has_rest(k))},
            Shape: {w: k for w, k in self._nouns.shapes.items() if k is not FlatPunch},
            Body: self._nouns.bodies,
        }
        if hint in kinds:
            return Union[tuple(self.of(kind) for kind in kinds[hint].values())]  # noqa: UP007
        origin, inner = get_origin(hint), get_args(hint)
        if origin is Annotated:
            return Annotated[self._told(inner[0], at_rest), *hint.__metadata__]
        if origin in (Union, types.UnionType):
            return Union[tuple(self._told(part, at_rest) for part in inner)]  # noqa: UP007
        if origin is tuple:
            return list[self._told(inner[0], at_rest)] if inner[-1] is ... else hint
        return self.of(hint) if hasattr(hint, "__dataclass_fields__") else hint
