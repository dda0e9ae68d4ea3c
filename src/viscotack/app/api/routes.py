"""Routes of the API and of the page, schemas of the responses, and the rules of access."""

import secrets
from collections.abc import Awaitable, Callable, Sequence
from inspect import cleandoc
from typing import Annotated, Any

from fastapi import APIRouter, FastAPI, Path, Query, Response, UploadFile
from fastapi import Request as HttpRequest
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, RedirectResponse
from pydantic import BaseModel, ConfigDict
from starlette.exceptions import HTTPException
from starlette.middleware.trustedhost import TrustedHostMiddleware

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


_COOKIE = "viscotack"
# The page, and uploads that it shows, load nothing from other servers and send nothing to them.
_HEADERS = {
    # page and server have the same version
    "cache-control": "no-cache",
    "content-security-policy": "default-src 'self'; img-src 'self' data: blob:; style-src 'self' "
    "'unsafe-inline'; frame-ancestors 'none'; form-action 'self'; base-uri 'none'",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
}


def guard(
    app: FastAPI,
    *,
    hosts: Sequence[str] = (),
    token: str = "",
    body: int = 1_000_000,
    uploads: int = 20_000_000,
) -> FastAPI:
    """Add the rules of access to an application.

    Parameters
    ----------
    app : FastAPI
        The application.
    hosts : sequence of str
        Accepted host names, without port; () for any.
    token : str
        Token that a request must contain; "" for none.
    body, uploads : int
        Largest request, and largest request with files [bytes].
    """

    @app.middleware("http")
    async def guarded(
        request: HttpRequest, forward: Callable[[HttpRequest], Awaitable[Response]]
    ) -> Response:
        refused = _stranger(request, token) or _too_long(request, body, uploads)
        response = refused or _entered(request, token) or await forward(request)
        response.headers.update(_HEADERS)
        return response

    if hosts:
        app.add_middleware(TrustedHostMiddleware, allowed_hosts=list(hosts), www_redirect=False)
    return app


def _stranger(request: HttpRequest, token: str) -> Response | None:
    """Return the refusal of a request from elsewhere or without the token."""
    origin = request.headers.get("origin", "")
    if origin and origin.partition("://")[2] != request.headers.get("host", ""):
        # a page of another origin in the browser of the user
        return _refused(403, "pages from elsewhere may not ask this server")
    if token and not _knows(request, token):
        return _refused(
            401,
            "this server wants its token: the header Authorization: Bearer TOKEN, or in a browser "
            "the link that viscotack app has printed",
            headers={"www-authenticate": "Bearer"},
        )
    return None


def _too_long(request: HttpRequest, body: int, uploads: int) -> Response | None:
    """Return the refusal of a request that is too long, or of unknown length."""
    if request.method != "POST":
        return None
    is_upload = request.headers.get("content-type", "").startswith("multipart/form-data")
    most = uploads if is_upload else body
    length = request.headers.get("content-length", "")
    if not length.isdigit():
        return _refused(411, "the request must state its length")
    if int(length) > most:
        return _refused(
            413, f"the request is longer than the {most:,} bytes that this server takes"
        )
    return None


def _knows(request: HttpRequest, token: str) -> bool:
    """Whether a request contains the token, in a header, a cookie or the link."""
    given = (
        request.headers.get("authorization", "").removeprefix("Bearer "),
        request.cookies.get(_COOKIE, ""),
        request.query_params.get("token", ""),
    )
    return any(secrets.compare_digest(x.encode(), token.encode()) for x in given)


def _entered(request: HttpRequest, token: str) -> Response | None:
    """Return the way to the page, with a cookie, for a browser that opened the link with a token.

    The token does not appear in histories and logs.
    """
    if not token or request.url.path != "/" or "token" not in request.query_params:
        return None
    bare = request.url.remove_query_params("token")
    response = RedirectResponse(f"{bare.path}?{bare.query}" if bare.query else bare.path, 303)
    response.set_cookie(_COOKIE, token, httponly=True, samesite="strict")
    return response
