"""Error responses of the API: one object with the message, for all kinds of errors."""

from collections.abc import Sequence
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException

from viscotack.app.engine.crew import Defect, Refused
from viscotack.app.engine.jobs import TooMany, Unknown

_STATUS: tuple[tuple[type[Exception], int], ...] = (
    (Unknown, 404),
    (TooMany, 429),
    (Refused, 422),
)
_MOST_SAID = 3


def words_for(app: FastAPI) -> None:
    """Install handlers that return all errors as ``{"error": message}``."""

    async def refused(request: Request, error: Exception) -> JSONResponse:
        status = next(status for kind, status in _STATUS if isinstance(error, kind))
        return JSONResponse({"error": str(error)}, status)

    async def malformed(request: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, RequestValidationError)
        return JSONResponse({"error": _said(error.errors())}, 422)

    async def failed(request: Request, error: Exception) -> JSONResponse:
        return JSONResponse({"error": f"this is a defect of viscotack: {error}"}, 500)

    async def plain(request: Request, error: Exception) -> JSONResponse:
        assert isinstance(error, HTTPException)
        return JSONResponse({"error": str(error.detail)}, error.status_code, error.headers)

    for kind, _ in _STATUS:
        app.add_exception_handler(kind, refused)
    app.add_exception_handler(Defect, failed)
    app.add_exception_handler(RequestValidationError, malformed)
    app.add_exception_handler(HTTPException, plain)


def _said(errors: Sequence[Any]) -> str:
    """Summarise the first validation errors of a request."""
    said = []
    for error in errors[:_MOST_SAID]:
        place = ".".join(str(part) for part in error["loc"] if part != "body")
        said.append(f"{place}: {error['msg']}" if place else str(error["msg"]))
    more = len(errors) - _MOST_SAID
    return "; ".join(said) + (f"; and {more} more" if more > 0 else "")
