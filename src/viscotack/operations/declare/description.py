"""Operations as plain data, for the forms of the page, OpenAPI and the reference."""

from inspect import cleandoc
from typing import Any

from .answer import DRAWN, WORDS
from .cards import Card, File, Named, Number
from .options import Operation, Option, options, spelled, summary


def path(word: str) -> str:
    """Return the HTTP path of an operation: ``identify/rates`` for "identify rates"."""
    return word.replace(" ", "/")


def described(kind: type[Operation]) -> dict[str, Any]:
    """Return the name, description, options and outputs of an operation."""
    return {
        "word": kind.word,
        "path": path(kind.word),
        "summary": summary(kind),
        "help": spelled(cleandoc(kind.__doc__ or ""), kind),
        "options": [_option(option, kind) for option in options(kind)],
        "outputs": [
            {"name": output.name, "words": output.words, "kind": output.kind}
            for output in kind.outputs
        ],
        "refused": dict(kind.refused),
    }


def _option(option: Option, kind: type[Operation]) -> dict[str, Any]:
    card = option.card
    default = None if option.needed else option.default
    return {
        "name": option.name,
        "words": spelled(option.words, kind),
        "form": card.form,
        "unit": getattr(card, "unit", ""),
        "example": _example(card),
        "choices": list(getattr(card, "choices", ())),
        "default": default if isinstance(default, str | int | float | bool) else None,
        "needed": option.needed,
        "many": option.many,
        "part": option.table,
    }


def _example(card: Card) -> str:
    """Return the example of a card, or the first quoted text of its description."""
    quoted = card.words.split('"')
    return card.example.strip('"') or (quoted[1] if len(quoted) > 2 else "")


def request_schema(kind: type[Operation], *, sent: bool) -> dict[str, Any]:
    """Return the JSON schema of a request for an operation.

    Parameters
    ----------
    kind : class
        The operation.
    sent : bool
        Whether files are sent with it: as multipart/form-data.
    """
    properties = {option.name: _property(option, sent) for option in options(kind)}
    names = [WORDS, DRAWN, *(output.name for output in kind.outputs)]
    properties["outputs"] = {
        "type": "array",
        "items": {"type": "string", "enum": names},
        "description": "Requested outputs besides the record of the answer.",
    }
    if sent:
        properties["attached"] = {
            "type": "array",
            "items": {"type": "string", "format": "binary"},
            "description": "Files that other options name.",
        }
    return {
        "type": "object",
        "properties": properties,
        "required": [option.name for option in options(kind) if option.needed],
        "additionalProperties": False,
    }


def _property(option: Option, sent: bool) -> dict[str, Any]:
    card = option.card
    found: dict[str, Any] = dict(card.schema)
    if sent and isinstance(card, File | Named):
        found = {"type": "string", "format": "binary"}
    elif sent and isinstance(card, Number):
        found = {"type": "string", "maxLength": 200}
    if option.many:
        found = {"type": "array", "items": found}
    if "$ref" in found:
        return {"allOf": [found], "description": option.words}
    if not option.needed and isinstance(option.default, str | int | float | bool) and not sent:
        found["default"] = option.default
    return found | {"description": option.words}
