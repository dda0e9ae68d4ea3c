"""The HTTP API and the page that uses it."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

from viscotack.app.engine.jobs import Engine
from viscotack.errors import InputError, install_command

if TYPE_CHECKING:
    from fastapi import FastAPI

    from .guard import Guard


def application(engine: Engine | None = None) -> "FastAPI":
    """Create the FastAPI application of page and API, without its guard.

    Parameters
    ----------
    engine : Engine, optional
        Runs the tasks; default: an engine with default limits.

    Raises
    ------
    ValueError
        If the libraries of the extra ``app`` are missing.
    """
    FastAPI = _fastapi()
    from viscotack.version import __version__

    from .openapi import described
    from .refusals import words_for
    from .routes import routes

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
    words_for(app)
    app.include_router(routes(engine))
    described(app)
    return app


def guarded(
    engine: Engine | None = None, *, hosts: tuple[str, ...] = (), token: str = ""
) -> "Guard":
    """Create the application with its guard, as run by a server.

    Parameters
    ----------
    engine : Engine, optional
        Runs the tasks.
    hosts : tuple of str
        Accepted host names; () for any.
    token : str
        Token that every request must contain; "" for none.
    """
    engine = Engine() if engine is None else engine
    app = application(engine)
    from .guard import Guard, Rules

    limits = engine.limits
    return Guard(app, Rules(hosts=hosts, token=token, body=limits.body, uploads=limits.uploads))


def _fastapi() -> type["FastAPI"]:
    try:
        import python_multipart  # noqa: F401  # files are sent with it
        from fastapi import FastAPI
    except ImportError as error:
        raise InputError(
            f"the page and the API need {error.name}; install it with: {install_command('app')}"
        ) from None
    return FastAPI
