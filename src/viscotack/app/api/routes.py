"""Routes of the API and of the page.

Schemas of the responses of the API.
"""

from inspect import cleandoc
from typing import Annotated, Any

from fastapi import APIRouter, FastAPI, Path, Query, UploadFile
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import BaseModel, ConfigDict
from starlette.exceptions import HTTPException

from viscotack.app.engine import page
from viscotack.app.engine.jobs import Engine, Job, TooMany, Unknown
from viscotack.app.engine.lane import Defect
from viscotack.app.operations import operations
from viscotack.app.operations.request import Request, described, refusal, summary
from viscotack.errors import InputError


class SentFiles(BaseModel):
    """Files that were sent, for the query of requests that name them."""

    files: str


class Refusal(BaseModel):
    """Error response: the problem, the value, and a remedy; `field` is the option, if it is one."""

    error: str
    field: str = ""


class Answer(BaseModel):
    """Response; its keys are those of the ``--json`` output of the command line."""

    model_config = ConfigDict(extra="allow")


# Longest time that a request for the state of a job waits for changes [s].
_LONGEST_WAIT = 10.0
_REFUSED: dict[int | str, dict[str, Any]] = {
    "4XX": {"model": Refusal, "description": "There is no answer; the words say why."}
}
Id = Annotated[str, Path(max_length=64)]
Outputs = Annotated[
    tuple[str, ...],
    Query(description="More than the record of the answer: words, drawn, or names of files."),
]
Sent = Annotated[str, Query(max_length=64, description="Files that were sent to /api/files.")]
_STATUS = {Unknown: 404, TooMany: 429}


def routes(engine: Engine) -> APIRouter:
    """Create the routes of an engine."""
    router = APIRouter(responses=_REFUSED)
    _jobs(router, engine)
    for kind in operations().values():
        if not kind.local:
            _operation(router, engine, kind)
    _page(router, engine)
    return router


def _operation(router: APIRouter, engine: Engine, kind: type[Request]) -> None:
    """Add the routes of an operation: direct answer, and job."""

    async def answer(asked: Any, outputs: Outputs = (), files: Sent = "") -> Answer:
        return Answer(**await engine.ask(asked, outputs, files))

    async def job(asked: Any, outputs: Outputs = (), files: Sent = "") -> Job:
        _check_rows(asked, engine.limits.cases)
        return engine.start(asked, outputs, files)

    name, word = kind.word.replace(" ", "_"), kind.word.replace(" ", "/")
    for prefix, route, status in (("", answer, 200), ("jobs/", job, 202)):
        route.__annotations__["asked"] = kind
        router.post(
            f"/api/{prefix}{word}",
            tags=[prefix.removesuffix("/") or "operations"],
            operation_id=f"{prefix.replace('/', '_')}{name}",
            summary=summary(kind),
            description=cleandoc(kind.__doc__ or ""),
            status_code=status,
        )(route)


def _check_rows(asked: Request, most: int) -> None:
    """Reject more cases than the limit per request."""
    count = max((len(x) for _, x in asked if isinstance(x, tuple)), default=0)
    if count > most:
        raise InputError(
            f"{count} cases exceed the limit of {most} per request; use viscotack campaign, which "
            "has no limit"
        )


def _jobs(router: APIRouter, engine: Engine) -> None:
    @router.get("/api/jobs/{id}", tags=["jobs"])
    async def job(
        id: Id,
        points_from: Annotated[int, Query(ge=0, le=10**9, description="First point.")] = 0,
        wait: Annotated[
            float, Query(ge=0, le=_LONGEST_WAIT, description="Wait for news so long [s].")
        ] = 0.0,
    ) -> Job:
        """Ask how far a job is, and for its answer when it is done."""
        found = engine.job(id)
        await found.news(points_from, wait)
        return found.since(points_from)

    @router.delete("/api/jobs/{id}", tags=["jobs"])
    async def cancel(id: Id) -> Job:
        """End a job, and forget it; its curve and answer are not sent again."""
        job = await engine.cancel(id)
        return job.since(len(job.points), whole=False)


def refusals(app: FastAPI) -> None:
    """Install handlers that return all errors as a `Refusal`."""

    async def refused(request: Any, error: Exception) -> JSONResponse:
        status = next((s for kind, s in _STATUS.items() if isinstance(error, kind)), 422)
        return _refused(status, str(error), getattr(error, "field", ""))

    async def malformed(request: Any, error: Exception) -> JSONResponse:
        assert isinstance(error, RequestValidationError)
        errors = error.errors()
        kind = request.scope["route"].endpoint.__annotations__.get("asked")
        inside = [each for each in errors if each["loc"][0] == "body"]
        if any(each["type"] in ("json_invalid", "model_attributes_type") for each in inside):
            return _refused(422, "the request must be a JSON object")
        if inside and isinstance(kind, type) and issubclass(kind, Request):
            return await refused(request, refusal(kind, inside))
        first = errors[0]
        place = ".".join(str(part) for part in first["loc"])
        return _refused(422, f"{place}: {first['msg']}")

    async def failed(request: Any, error: Exception) -> JSONResponse:
        return _refused(500, f"this is a defect of viscotack: {error}")

    async def plain(request: Any, error: Exception) -> JSONResponse:
        assert isinstance(error, HTTPException)
        return _refused(error.status_code, str(error.detail), headers=error.headers)

    app.add_exception_handler(InputError, refused)
    app.add_exception_handler(Defect, failed)
    app.add_exception_handler(RequestValidationError, malformed)
    app.add_exception_handler(HTTPException, plain)


def _refused(status: int, words: str, field: str = "", headers: Any = None) -> JSONResponse:
    return JSONResponse({"error": words, "field": field}, status, headers)


def _page(router: APIRouter, engine: Engine) -> None:
    @router.post("/api/files", tags=["operations"])
    async def send(files: list[UploadFile]) -> SentFiles:
        """Send files; requests name them, with the id in the query: ``?files=ID``."""
        return SentFiles(files=engine.keep([(x.filename or "file", await x.read()) for x in files]))

    @router.get("/api/operations", tags=["operations"])
    async def known() -> Answer:
        """List the operations: their options with words, units, choices and defaults."""
        return Answer(**{"operations": [described(kind) for kind in operations().values()]})

    @router.get("/api/forms", tags=["page"])
    async def forms() -> Answer:
        """Return the input forms, the published materials and example cases."""
        return Answer(**await engine.ask(page.Forms(), lane="page"))

    for kind in page.REQUESTS:
        _of_page(router, engine, kind)


def _of_page(router: APIRouter, engine: Engine, kind: type[Request]) -> None:
    async def route(asked: Any) -> Answer:
        return Answer(**await engine.ask(asked, lane="page"))

    route.__annotations__["asked"] = kind
    router.post(f"/api/{kind.word}", tags=["page"], summary=kind.word, description=kind.__doc__)(
        route
    )
