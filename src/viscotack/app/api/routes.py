"""Routes of the API and of the page, and the static files of the page."""

import asyncio
from importlib.resources import files as files_of
from inspect import cleandoc
from typing import Annotated, Any

from fastapi import APIRouter, FastAPI, Path, Query, Response, UploadFile
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException

from viscotack.app.engine import page_tasks
from viscotack.app.engine.jobs import Engine, Job, TooMany, Unknown
from viscotack.app.engine.lane import Defect
from viscotack.app.operations import operations
from viscotack.app.operations.request import Request, described, refusal, summary
from viscotack.errors import InputError

from .models import (
    Answer,
    AskedQuick,
    AskedState,
    AskedTheory,
    AskedVerdict,
    JobAnswer,
    Refusal,
    SentFiles,
)

# Longest time that a request for the state of a job waits for changes [s].
_LONGEST_WAIT = 10.0
_KINDS = {
    "html": "text/html; charset=utf-8",
    "css": "text/css; charset=utf-8",
    "js": "text/javascript; charset=utf-8",
    "svg": "image/svg+xml",
    "toml": "text/plain; charset=utf-8",
}
_REFUSED: dict[int | str, dict[str, Any]] = {
    status: {"model": Refusal, "description": words}
    for status, words in (
        (400, "The request cannot be read."),
        (401, "The token is missing or wrong."),
        (403, "The request comes from elsewhere."),
        (413, "The request is too long."),
        (422, "The question has no answer; the words say why."),
    )
}
_NO_JOB: dict[int | str, dict[str, Any]] = {404: {"model": Refusal, "description": "No such job."}}
_FULL: dict[int | str, dict[str, Any]] = {
    429: {"model": Refusal, "description": "There are as many jobs as there may be."}
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

    async def job(asked: Any, outputs: Outputs = (), files: Sent = "") -> JobAnswer:
        _check_rows(asked, engine.limits.cases)
        return _told(engine.start(asked, outputs, files))

    name, word = kind.word.replace(" ", "_"), kind.word.replace(" ", "/")
    for prefix, route, more in (
        ("", answer, {}),
        ("jobs/", job, {"status_code": 202, "responses": _FULL}),
    ):
        route.__annotations__["asked"] = kind
        router.post(
            f"/api/{prefix}{word}",
            tags=[prefix.removesuffix("/") or "operations"],
            operation_id=f"{prefix.replace('/', '_')}{name}",
            summary=summary(kind),
            description=cleandoc(kind.__doc__ or ""),
            **more,
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
    @router.get("/api/jobs/{id}", responses=_NO_JOB, tags=["jobs"])
    async def job(
        id: Id,
        points_from: Annotated[int, Query(ge=0, le=10**9, description="First point.")] = 0,
        rows_from: Annotated[int, Query(ge=0, le=10**9, description="First row.")] = 0,
        wait: Annotated[
            float, Query(ge=0, le=_LONGEST_WAIT, description="Wait for news so long [s].")
        ] = 0.0,
    ) -> JobAnswer:
        """Ask how far a job is, and for its answer when it is done."""
        found = engine.job(id)
        known = len(found.points) > points_from or len(found.rows) > rows_from
        if wait and not found.over and not known:
            try:
                await asyncio.wait_for(found.news.wait(), wait)
            except TimeoutError:
                pass  # return the unchanged state
        return _told(found, points_from, rows_from)

    @router.delete("/api/jobs/{id}", responses=_NO_JOB, tags=["jobs"])
    async def cancel(id: Id) -> JobAnswer:
        """End a job, and forget it; its curve, rows and answer are not sent again."""
        job = await engine.cancel(id)
        return _told(job, len(job.points), len(job.rows), whole=False)


def _told(job: Job, points_from: int = 0, rows_from: int = 0, *, whole: bool = True) -> JobAnswer:
    return JobAnswer.model_validate(
        {
            "id": job.id,
            "kind": job.kind,
            "state": job.state,
            "share": min(job.share, 1.0),
            "points": job.points[points_from:],
            "points_from": points_from,
            "rows": job.rows[rows_from:],
            "rows_from": rows_from,
            "error": job.error,
            "answer": job.answer if whole else None,
        }
    )


def refusals(app: FastAPI) -> None:
    """Install handlers that return all errors as ``{"error": message}``."""

    async def refused(request: Any, error: Exception) -> JSONResponse:
        status = next((s for kind, s in _STATUS.items() if isinstance(error, kind)), 422)
        return JSONResponse({"error": str(error)}, status)

    async def malformed(request: Any, error: Exception) -> JSONResponse:
        assert isinstance(error, RequestValidationError)
        errors = error.errors()
        kind = request.scope["route"].endpoint.__annotations__.get("asked")
        inside = [each for each in errors if each["loc"][0] == "body"]
        if any(each["type"] in ("json_invalid", "model_attributes_type") for each in inside):
            return JSONResponse({"error": "the request must be a JSON object"}, 422)
        if inside and isinstance(kind, type) and issubclass(kind, Request):
            return JSONResponse({"error": str(refusal(kind, inside))}, 422)
        first = errors[0]
        place = ".".join(str(part) for part in first["loc"])
        return JSONResponse({"error": f"{place}: {first['msg']}"}, 422)

    async def failed(request: Any, error: Exception) -> JSONResponse:
        return JSONResponse({"error": f"this is a defect of viscotack: {error}"}, 500)

    async def plain(request: Any, error: Exception) -> JSONResponse:
        assert isinstance(error, HTTPException)
        return JSONResponse({"error": str(error.detail)}, error.status_code, error.headers)

    app.add_exception_handler(InputError, refused)
    app.add_exception_handler(Defect, failed)
    app.add_exception_handler(RequestValidationError, malformed)
    app.add_exception_handler(HTTPException, plain)


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
        """Say what can be asked, read from the cards: choices, fields, units, ranges, examples."""
        return Answer(**await engine.page(page_tasks.ask_forms, {}))

    @router.post("/api/state", tags=["page"])
    async def state(asked: AskedState) -> Answer:
        """Return the tables of a case file."""
        return Answer(**await engine.page(page_tasks.ask_state, asked.model_dump()))

    @router.post("/api/quick", tags=["page"])
    async def quick(asked: AskedQuick) -> Answer:
        """Evaluate theory and surrogate for a state (milliseconds): curves, numbers, intervals."""
        return Answer(**await engine.page(page_tasks.ask_quick, asked.model_dump()))

    @router.post("/api/moduli", tags=["page"])
    async def moduli(asked: AskedVerdict) -> Answer:
        """Return storage and loss modulus of a state's material over the frequency."""
        return Answer(**await engine.page(page_tasks.ask_moduli, asked.model_dump()))

    @router.post("/api/verdict", tags=["page"])
    async def verdict(asked: AskedVerdict) -> Answer:
        """Return the advisor's words on a state."""
        return Answer(**await engine.page(page_tasks.ask_verdict, asked.model_dump()))

    @router.post("/api/theory", tags=["page"])
    async def theory(asked: AskedTheory) -> Answer:
        """Return the curves of the theories that may take seconds."""
        return Answer(**await engine.page(page_tasks.ask_theory, asked.model_dump()))

    @router.get("/", include_in_schema=False)
    async def page() -> Response:
        return _file("index.html")

    @router.get("/api/docs", include_in_schema=False)
    async def docs() -> Response:
        return _file("docs.html")

    @router.get("/page/{name}", include_in_schema=False)
    async def part(name: str) -> Response:
        return _file(name)


# What the page is made of: the requested names are looked up here, and not in a folder.
_PARTS = {
    part.name: part
    for part in files_of("viscotack.app.page").iterdir()
    if part.name.rpartition(".")[2] in _KINDS
}


def _file(name: str) -> Response:
    if name not in _PARTS:
        return Response("there is no such file", 404, media_type="text/plain")
    kind = _KINDS[name.rpartition(".")[2]]
    # never cached, so that the page and the server have the same version
    return Response(
        _PARTS[name].read_bytes(), media_type=kind, headers={"cache-control": "no-cache"}
    )
