"""The HTTP API and the page that uses it."""

import mimetypes
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from viscotack.app.engine.jobs import Engine
from viscotack.errors import InputError, install_command

if TYPE_CHECKING:
    from fastapi import FastAPI


def application(
    engine: Engine | None = None, *, hosts: tuple[str, ...] = (), token: str = ""
) -> "FastAPI":
    """Create the FastAPI application of page and API.

    Parameters
    ----------
    engine : Engine, optional
        Runs the tasks; default: an engine with default limits.
    hosts : tuple of str
        Accepted host names; () for any.
    token : str
        Token that every request must contain; "" for none.

    Raises
    ------
    ValueError
        If the libraries of the extra ``app`` are missing.
    """
    try:
        import python_multipart  # noqa: F401  # files are sent with it
        import uvicorn  # noqa: F401  # serves it
        from fastapi import FastAPI
        from fastapi.responses import FileResponse
        from fastapi.staticfiles import StaticFiles
    except ImportError as error:
        raise InputError(
            f"the page and the API need {error.name}; install it with: {install_command('app')}"
        ) from None
    from viscotack.version import __version__

    from .routes import guard, refusals, routes

    engine = Engine() if engine is None else engine

    @asynccontextmanager
    async def alive(app: "FastAPI") -> AsyncIterator[None]:
        try:
            await engine.begin()
            yield
        finally:
            await engine.end()

    app = FastAPI(
        title="viscotack",
        version=__version__,
        summary="How hard must one pull? Detachment of soft, sticky, rate-dependent contacts.",
        # the pages of FastAPI load scripts from other servers; /api/docs is our own
        docs_url=None,
        redoc_url=None,
        lifespan=alive,
    )
    refusals(app)
    app.include_router(routes(engine))
    # some systems have another type for scripts, which browsers refuse
    mimetypes.add_type("text/javascript", ".js")
    folder = Path(str(files("viscotack.app.page")))
    app.add_route("/", lambda request: FileResponse(folder / "index.html"))
    app.add_route("/api/docs", lambda request: FileResponse(folder / "docs.html"))
    app.mount("/page", StaticFiles(directory=folder))
    body = engine.limits.body
    return guard(app, hosts=hosts, token=token, body=body, uploads=20 * body)
