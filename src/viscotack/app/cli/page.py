"""The command ``viscotack app``: serve the page and the API on this machine."""

import json
import os
import secrets
import socket
import webbrowser
from pathlib import Path
from typing import Annotated, Any
from urllib.parse import urlencode

import typer
from typer import Argument, Option

from viscotack.errors import InputError

from .commands import With, application, wrong_input

_LOCAL = ("127.0.0.1", "localhost", "::1")
_NAMES = ("127.0.0.1", "localhost", "[::1]")
# A token in an option would be visible in the list of processes; one in the environment is not.
_TOKEN = "VISCOTACK_TOKEN"
# Simultaneous connections and requests.
_MOST_REQUESTS = 200


@application.command("app")
def app_command(
    case: Annotated[
        Path | None,
        Argument(metavar="CASE.toml", help="Case to show first.", show_default=False),
    ] = None,
    host: Annotated[
        str,
        Option(metavar="ADDRESS", help="Address of the server; a public one needs a token."),
    ] = "127.0.0.1",
    port: Annotated[int, Option(metavar="N", min=0, max=65535, help="Port; 0: any free.")] = 8642,
    workers: Annotated[
        int, Option(metavar="N", min=1, max=256, help="Number of parallel simulations.")
    ] = 2,
    browser: Annotated[
        bool, Option("--browser/--no-browser", help="Open the page in the browser.")
    ] = True,
    own: With = None,
) -> None:
    """Open the web page: theory, surrogate and simulation for interactive input.

    The same server provides an HTTP API, described by /api/docs and /openapi.json. By default it
    accepts requests from this machine only. With another --host every request needs a token: the
    environment variable VISCOTACK_TOKEN, or a generated one that is printed.

    Example: viscotack app examples/from_toml/lens.toml
    """
    with wrong_input():
        from viscotack.app.api import application as served
        from viscotack.app.engine.jobs import Engine, Limits
        from viscotack.model.problem.nouns import own_nouns

        files = [str(Path(path).resolve()) for path in own or ()]
        also = own_nouns(files)
        query = "" if case is None else _query(case, also)
        token, names = _token(host), _NAMES if host in _LOCAL else ()
        engine = Engine(Limits(workers=workers), own=files)
        behind = served(engine, hosts=names, token=token)
        listening = _listening(host, port)
    place = f"[{host}]" if ":" in host else host
    link = f"http://{place}:{listening.getsockname()[1]}/"
    more = "&".join(part for part in (f"token={token}" if token else "", query) if part)
    link += f"?{more}" if more else ""
    typer.echo(f"viscotack app: {link}\nCtrl-C ends it.", err=True)
    if browser:
        webbrowser.open(link)
    import uvicorn

    config = uvicorn.Config(
        behind,
        limit_concurrency=_MOST_REQUESTS,
        log_level="warning",
        timeout_graceful_shutdown=2,
    )
    uvicorn.Server(config).run(sockets=[listening])


def _token(host: str) -> str:
    """Return the required token; "" on this machine unless one is set."""
    given = os.environ.get(_TOKEN, "")
    if given and (len(given) < 16 or not given.isascii() or not given.isprintable()):
        raise InputError(f"{_TOKEN} must have 16 characters or more, without accents or spaces")
    return given if given or host in _LOCAL else secrets.token_urlsafe(24)


def _listening(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        listening = socket.create_server((host, port), family=family)
    except OSError as error:
        raise InputError(
            f"cannot listen at {host}, port {port}: {error.strerror or error}; give another "
            "--port, or 0 for any free one"
        ) from None
    # asyncio sets this only on sockets that name their protocol, and these do not: without it the
    # body of an answer waits 40 ms for the confirmation of its head
    listening.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return listening


def _query(case: Path, also: tuple[Any, ...]) -> str:
    """Return the query of a link to a case file, including a material in a separate file."""
    from viscotack.app.operations.parts.solid import material_table
    from viscotack.files.toml import read_toml
    from viscotack.model.problem.case_file import case_of_tables, read_case

    problem, tables = read_case(case, also=also), read_toml(case)
    if tables["material"].keys() & {"passport", "file"}:
        tables["material"] = material_table(problem.material)
    case_of_tables(tables, where=str(case), also=also)  # rejects cases that refer to other files
    return urlencode({"state": json.dumps({"case": tables})})
