"""Access control: host, origin, token and size of a request."""

import secrets
from collections.abc import Awaitable, Callable, Sequence

from fastapi import FastAPI, Request, Response
from fastapi.responses import JSONResponse, RedirectResponse
from starlette.middleware.trustedhost import TrustedHostMiddleware

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
        request: Request, forward: Callable[[Request], Awaitable[Response]]
    ) -> Response:
        refused = _refusal(request, token) or _too_long(request, body, uploads)
        response = refused or _entered(request, token) or await forward(request)
        response.headers.update(_HEADERS)
        return response

    if hosts:
        app.add_middleware(TrustedHostMiddleware, allowed_hosts=list(hosts), www_redirect=False)
    return app


def _refusal(request: Request, token: str) -> Response | None:
    """Return the refusal of a request from elsewhere or without the token."""
    origin = request.headers.get("origin", "")
    if origin and origin.partition("://")[2] != request.headers.get("host", ""):
        # a page of another origin in the browser of the user
        return _said(403, "pages from elsewhere may not ask this server")
    if token and not _knows(request, token):
        return _said(
            401,
            "this server wants its token: the header Authorization: Bearer TOKEN, or in a browser "
            "the link that viscotack app has printed",
        )
    return None


def _too_long(request: Request, body: int, uploads: int) -> Response | None:
    """Return the refusal of a request that is too long, or of unknown length."""
    if request.method != "POST":
        return None
    is_upload = request.headers.get("content-type", "").startswith("multipart/form-data")
    most = uploads if is_upload else body
    length = request.headers.get("content-length", "")
    if not length.isdigit():
        return _said(411, "the request must state its length")
    if int(length) > most:
        return _said(413, f"the request is longer than the {most:,} bytes that this server takes")
    return None


def _knows(request: Request, token: str) -> bool:
    """Whether a request contains the token, in a header, a cookie or the link."""
    given = (
        request.headers.get("authorization", "").removeprefix("Bearer "),
        request.cookies.get(_COOKIE, ""),
        request.query_params.get("token", ""),
    )
    return any(secrets.compare_digest(x.encode(), token.encode()) for x in given)


def _entered(request: Request, token: str) -> Response | None:
    """Return the way to the page, with a cookie, for a browser that opened the link with a token.

    The token does not appear in histories and logs.
    """
    if not token or request.url.path != "/" or "token" not in request.query_params:
        return None
    bare = request.url.remove_query_params("token")
    response = RedirectResponse(f"{bare.path}?{bare.query}" if bare.query else bare.path, 303)
    response.set_cookie(_COOKIE, token, httponly=True, samesite="strict")
    return response


def _said(status: int, words: str) -> Response:
    headers = {"www-authenticate": "Bearer"} if status == 401 else None
    return JSONResponse({"error": words, "field": ""}, status, headers)
