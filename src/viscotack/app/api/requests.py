"""Parsing of requests for operations: a JSON object, or a form with files."""

import json
from typing import Any

from fastapi import Request
from starlette.datastructures import UploadFile

from viscotack.app.engine.crew import Refused
from viscotack.app.engine.jobs import harmless_name
from viscotack.operations import Operation
from viscotack.operations.declare.options import Option, options

# Most files, and other fields, of one request.
_MOST_FILES, _MOST_FIELDS = 60, 1000
_ATTACHED, _OUTPUTS = "attached", "outputs"
# Fields whose text is JSON.
_AS_JSON = ("problem", "rows")

Files = list[tuple[str, bytes]]


async def received(request: Request, kind: type[Operation]) -> tuple[dict[str, Any], Files]:
    """Return the options in a request, and its files.

    Raises
    ------
    Refused
        If it is neither a JSON object nor a form.
    """
    form = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    given, files = await (_form if form == "multipart/form-data" else _object)(request, kind)
    outputs = given.pop(_OUTPUTS, [])
    outputs = outputs if isinstance(outputs, list) else [outputs]
    if not all(isinstance(name, str) for name in outputs):
        raise Refused("outputs must be a list of names")
    return {"operation": kind.word, "given": given, "outputs": outputs}, files


async def _object(request: Request, kind: type[Operation]) -> tuple[dict[str, Any], Files]:
    try:
        given = json.loads(await request.body() or b"{}")
    except (ValueError, RecursionError):
        raise Refused("the request must be a JSON object, or multipart/form-data") from None
    if not isinstance(given, dict):
        raise Refused(f"the request must be a JSON object, got a {type(given).__name__}")
    return given, []


async def _form(request: Request, kind: type[Operation]) -> tuple[dict[str, Any], Files]:
    known = {option.name: option for option in options(kind)}
    given: dict[str, Any] = {}
    files: Files = []
    async with request.form(max_files=_MOST_FILES, max_fields=_MOST_FIELDS) as form:
        for name, value in form.multi_items():
            if isinstance(value, str):
                said: Any = _value(known.get(name), value)
            else:
                said = _named(value)
                files.append((said, await value.read()))
            if name != _ATTACHED:
                given.setdefault(name, []).append(said)
    return {name: _single(known.get(name), values) for name, values in given.items()}, files


def _named(file: UploadFile) -> str:
    return harmless_name(file.filename or "file")


def _value(option: Option | None, text: str) -> Any:
    """Return the value of a form field; problems and rows are parsed as JSON."""
    if option is None or option.card.form not in _AS_JSON:
        return text
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        raise Refused(f"{option.name} must be JSON, got {text!r:.60}") from None


def _single(option: Option | None, values: list[Any]) -> Any:
    """Return the value of an option that is not repeated."""
    if len(values) > 1 or (option is not None and option.many):
        return values
    return values[0]
