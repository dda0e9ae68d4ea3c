"""OpenAPI description, including the schema of problems generated from the cards."""

from typing import Any

from fastapi import FastAPI

from viscotack.operations.parts.examples import FIRST
from viscotack.problem.schema import schema

from .models import STATED_SCHEMA

_PROBLEMS = "#/$defs/"


def described(app: FastAPI) -> None:
    """Add the schema of problems to the OpenAPI description; computed at the first request."""
    plain = app.openapi

    def openapi() -> dict[str, Any]:
        if app.openapi_schema is None:
            found = plain()
            tables = _moved(schema())
            defined = tables.pop("$defs")
            found["components"]["schemas"] |= defined | {
                "Tables": tables | {"examples": [FIRST]},
                "Stated": STATED_SCHEMA,
            }
            app.openapi_schema = found
        return app.openapi_schema

    app.openapi = openapi


def _moved(value: Any) -> Any:
    """Return a schema with its references moved to the place defined by OpenAPI."""
    if isinstance(value, dict):
        return {key: _moved(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [_moved(entry) for entry in value]
    if isinstance(value, str) and value.startswith(_PROBLEMS):
        return f"#/components/schemas/{value.removeprefix(_PROBLEMS)}"
    return value
