"""Routes of the API and of the page, and the static files of the page."""

import asyncio
from collections.abc import Mapping
from importlib.resources import files as files_of
from inspect import cleandoc
from typing import Annotated, Any

from fastapi import APIRouter, Path, Query, Request, Response

from viscotack.app.engine.crew import Refused
from viscotack.app.engine.jobs import Engine, Job
from viscotack.operations import Operation, operations
from viscotack.operations.declare.cards import File
from viscotack.operations.declare.description import described, path, request_schema
from viscotack.operations.declare.options import options, spelled, summary

from .models import (
    Answer,
    AskedQuick,
    AskedState,
    AskedTheory,
    AskedVerdict,
    JobAnswer,
    Refusal,
)
from .requests import received

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


def routes(engine: Engine) -> APIRouter:
    """Create the routes of an engine."""
    router = APIRouter(responses=_REFUSED)
    _jobs(router, engine)
    for kind in operations().values():
        if reason := kind.refused.get("http"):
            _refused(router, kind.word, reason)
        else:
            _operation(router, engine, kind)
    _page(router, engine)
    return router


def _operation(router: APIRouter, engine: Engine, kind: type[Operation]) -> None:
    """Add the routes of an operation: direct answer, and job."""
    word = path(kind.word)

    async def answer(request: Request) -> Answer:
        given, files = await received(request, kind)
        upload = engine.held(files)
        with upload.folder:
            return Answer(**await engine.ask("operation", given | {"files": list(upload.paths)}))

    async def job(request: Request) -> JobAnswer:
        given, files = await received(request, kind)
        _check_rows(given["given"], engine.limits.cases)
        upload = engine.held(files)
        try:
            started = engine.start(given | {"files": list(upload.paths)}, upload)
        except BaseException:
            upload.folder.cleanup()
            raise
        return _told(started)

    name, words = word.replace("/", "_"), summary(kind)
    more = {"requestBody": {"required": True, "content": _content(kind)}}
    told = spelled(cleandoc(kind.__doc__ or ""), kind)
    router.post(
        f"/api/{word}",
        tags=["operations"],
        operation_id=name,
        summary=words,
        description=told,
        openapi_extra=more,
    )(answer)
    router.post(
        f"/api/jobs/{word}",
        tags=["jobs"],
        operation_id=f"job_{name}",
        summary=words,
        description=told,
        openapi_extra=more,
        status_code=202,
        responses=_FULL,
    )(job)


def _refused(router: APIRouter, word: str, reason: str) -> None:
    """Add a route that rejects an operation with the reason."""

    async def refuse() -> None:
        raise Refused(f"{word} is not available over HTTP: {reason}")

    for place in ("/api", "/api/jobs"):
        router.post(f"{place}/{path(word)}", include_in_schema=False)(refuse)


def _content(kind: type[Operation]) -> dict[str, Any]:
    """Return the content types of a request for an operation."""
    needs_files = any(isinstance(o.card, File) and o.needed for o in options(kind))
    plain = (
        {} if needs_files else {"application/json": {"schema": request_schema(kind, sent=False)}}
    )
    return plain | {"multipart/form-data": {"schema": request_schema(kind, sent=True)}}


def _check_rows(given: Mapping[str, Any], most: int) -> None:
    """Reject more cases than the limit per request."""
    count = max((len(value) for value in given.values() if isinstance(value, list)), default=0)
    if count > most:
        raise Refused(
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


def _page(router: APIRouter, engine: Engine) -> None:
    @router.get("/api/operations", tags=["operations"])
    async def known() -> Answer:
        """List the operations: their options with words, units, choices and defaults."""
        return Answer(**{"operations": [described(kind) for kind in operations().values()]})

    @router.get("/api/forms", tags=["page"])
    async def forms() -> Answer:
        """Say what can be asked, read from the cards: choices, fields, units, ranges, examples."""
        return Answer(**await engine.ask("forms", {}))

    @router.post("/api/state", tags=["page"])
    async def state(asked: AskedState) -> Answer:
        """Return a state as tables, file and link, from one of the three."""
        return Answer(**await engine.ask("state", asked.model_dump()))

    @router.post("/api/quick", tags=["page"])
    async def quick(asked: AskedQuick) -> Answer:
        """Evaluate theory and surrogate for a state (milliseconds): curves, numbers, intervals."""
        return Answer(**await engine.ask("quick", asked.model_dump()))

    @router.post("/api/moduli", tags=["page"])
    async def moduli(asked: AskedQuick) -> Answer:
        """Return storage and loss modulus of a state's material over the frequency."""
        return Answer(**await engine.ask("moduli", asked.model_dump()))

    @router.post("/api/verdict", tags=["page"])
    async def verdict(asked: AskedVerdict) -> Answer:
        """Return the advisor's words on a state."""
        return Answer(**await engine.ask("verdict", asked.model_dump()))

    @router.post("/api/theory", tags=["page"])
    async def theory(asked: AskedTheory) -> Answer:
        """Return the curves of the theories that may take seconds."""
        return Answer(**await engine.ask("theory", asked.model_dump()))

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
