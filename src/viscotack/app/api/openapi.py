"""The description of the API, with the schema of problems that the cards write."""

from typing import Any

from fastapi import FastAPI

from viscotack.problem.schema import schema

from .models import STATED_SCHEMA, TABLES_SCHEMA

_PROBLEMS = "#/$defs/"


def described(app: FastAPI) -> None:
    """Make an application describe what a problem is as well; once, when it is first asked."""
    plain = app.openapi

    def openapi() -> dict[str, Any]:
        if app.openapi_schema is None:
            found = plain()
            defined = _moved(schema()["$defs"])
            found["components"]["schemas"] |= defined | {
                "Tables": TABLES_SCHEMA,
                "Stated": STATED_SCHEMA,
            }
            app.openapi_schema = found
        return app.openapi_schema

    app.openapi = openapi


def _moved(value: Any) -> Any:
    """Return a schema whose references lead to where OpenAPI keeps them."""
    if isinstance(value, dict):
        return {key: _moved(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [_moved(entry) for entry in value]
    if isinstance(value, str) and value.startswith(_PROBLEMS):
        return f"#/components/schemas/{value.removeprefix(_PROBLEMS)}"
    return value
