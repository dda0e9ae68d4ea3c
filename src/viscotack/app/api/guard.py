"""Access control: host, origin, token, size, time and number of requests are bounded."""

import asyncio
import json
import re
import secrets
from collections.abc import Awaitable, Callable, Iterable, MutableMapping
from dataclasses import dataclass
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qs, parse_qsl, urlencode, urlsplit

Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
Application = Callable[[Message, Receive, Send], Awaitable[None]]

_COOKIE = "viscotack"
_BUSY = "this server answers as many requests as it may; ask again later"
_HOST = re.compile(r"(\[[^\]]*\]|[^:\[\]]*)(?::\d*)?")
# The page, and uploads that it shows, load nothing from other servers and send nothing to them.
_HEADERS = {
    "content-security-policy": "default-src 'self'; img-src 'self' data: blob:; style-src 'self' "
    "'unsafe-inline'; frame-ancestors 'none'; form-action 'self'; base-uri 'none'",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
}


@dataclass(frozen=True)
class Rules:
    """Rules of access and size limits.

    Attributes
    ----------
    hosts : tuple of str
        Accepted host names, without port; () for any.
    token : str
        Token that a request must contain; "" for none.
    body, uploads : int
        Largest request, and largest request with files [bytes].
    together : int
        Largest size of all requests that are being answered [bytes].
    requests : int
        Largest number of simultaneous requests.
    patience : float
        Longest time within which a request must arrive [s].
    """

    hosts: tuple[str, ...] = ()
    token: str = ""
    body: int = 1_000_000
    uploads: int = 20_000_000
    together: int = 100_000_000
    requests: int = 200
    patience: float = 60.0


class Rejected(Exception):
    """A request exceeds a limit while it arrives."""


class Guard:
    """ASGI application that enforces the rules.

    Attributes
    ----------
    rules : Rules
        Rules of access and limits.
    held : int
        Size of all requests that are being answered [bytes].
    """

    def __init__(self, application: Application, rules: Rules) -> None:
        self._application, self.rules = application, rules
        self._requests = self.held = 0

    async def __call__(self, scope: Message, receive: Receive, send: Send) -> None:
        """Forward a request, or reject it with a reason."""
        if scope["type"] != "http":
            await self._application(scope, receive, send)
            return
        headers = {k.decode("latin-1"): v.decode("latin-1") for k, v in scope["headers"]}
        refusal = self._refusal(scope, headers)
        if refusal is not None:
            await _refuse(send, *refusal)
            return
        entered = self._entered(scope)
        if entered:
            await _redirect(send, _without_token(scope), entered)
            return
        limit = self._limit(headers)
        if int(_digits(headers.get("content-length", "0"))) > limit:
            await _refuse(send, 413, _too_large(limit))
            return
        if self._requests >= self.rules.requests:
            await _refuse(send, 503, _BUSY)
            return
        self._requests += 1
        arriving = _Arriving(self, receive, limit)
        try:
            await self._forward(scope, arriving, send)
        finally:
            self._requests -= 1
            self.held -= arriving.taken

    async def _forward(self, scope: Message, arriving: "_Arriving", send: Send) -> None:
        began = False

        async def guarded(message: Message) -> None:
            nonlocal began
            if arriving.rejected is not None and not began:
                return  # the application may answer with an error of its own
            if message["type"] == "http.response.start":
                began = True
                message["headers"] = [*message["headers"], *_pairs(_HEADERS)]
            await send(message)

        try:
            await self._application(scope, arriving.receive, guarded)
        except Exception:
            if arriving.rejected is None:
                raise
        if arriving.rejected is not None and not began:
            await _refuse(send, *arriving.rejected)

    def _limit(self, headers: MutableMapping[str, str]) -> int:
        is_upload = headers.get("content-type", "").startswith("multipart/form-data")
        return self.rules.uploads if is_upload else self.rules.body

    def _refusal(self, scope: Message, headers: MutableMapping[str, str]) -> tuple[int, str] | None:
        """Return status and reason for a rejected request, None for an accepted one."""
        host = headers.get("host", "")
        if self.rules.hosts and _bare(host) not in self.rules.hosts:
            return 403, f"this server is called {' or '.join(self.rules.hosts)}, not {host!r}"
        origin = headers.get("origin", "")
        if origin and _place(origin) != host:
            # a page of another origin in the browser of the user
            return 403, "pages from elsewhere may not ask this server"
        if not self.rules.token or self._knows(scope, headers):
            return None
        return 401, (
            "this server wants its token: the header Authorization: Bearer TOKEN, or in a browser "
            "the link that viscotack app has printed"
        )

    def _knows(self, scope: Message, headers: MutableMapping[str, str]) -> bool:
        """Whether a request contains the token, in a header, a cookie or the link."""
        given = [headers.get("authorization", "").removeprefix("Bearer ")]
        try:
            morsel = SimpleCookie(headers.get("cookie", "")).get(_COOKIE)
        except CookieError:
            morsel = None
        given += [] if morsel is None else [morsel.value]
        given += parse_qs(scope["query_string"].decode("latin-1")).get("token", [])
        return any(secrets.compare_digest(x.encode(), self.rules.token.encode()) for x in given)

    def _entered(self, scope: Message) -> str:
        """Return the cookie for a browser that opened the link with the token, else ""."""
        query = parse_qs(scope["query_string"].decode("latin-1"))
        if not self.rules.token or scope["path"] != "/" or "token" not in query:
            return ""
        return f"{_COOKIE}={self.rules.token}; Path=/; HttpOnly; SameSite=Strict"


def _without_token(scope: Message) -> str:
    """Return the link without the token, to which the browser is redirected."""
    pairs = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
    query = urlencode([(name, value) for name, value in pairs if name != "token"])
    return scope["path"] + (f"?{query}" if query else "")


class _Arriving:
    """A request that arrives within the limits of size and time, or is rejected."""

    def __init__(self, guard: Guard, receive: Receive, limit: int) -> None:
        self._guard, self._receive, self._limit = guard, receive, limit
        self._until = asyncio.get_running_loop().time() + guard.rules.patience
        self._complete, self.taken = False, 0
        self.rejected: tuple[int, str] | None = None

    async def receive(self) -> Message:
        if self._complete:  # only the end of the connection may follow, at any time
            return await self._receive()
        try:
            async with asyncio.timeout_at(self._until):
                message = await self._receive()
        except TimeoutError:
            words = f"the request did not arrive within {self._guard.rules.patience:g} s"
            raise self._reject(408, words) from None
        count = len(message.get("body", b""))
        self.taken += count
        self._guard.held += count
        if self.taken > self._limit:
            raise self._reject(413, _too_large(self._limit))
        if self._guard.held > self._guard.rules.together:
            raise self._reject(503, _BUSY)
        self._complete = not message.get("more_body")
        return message

    def _reject(self, status: int, words: str) -> Rejected:
        self.rejected = status, words
        return Rejected(words)


def _place(origin: str) -> str | None:
    """Return host and port of an origin, None if it has another form."""
    try:
        return urlsplit(origin).netloc
    except ValueError:
        return None


def _bare(host: str) -> str:
    """Return the name of a host without its port; all of it if it has another form."""
    found = _HOST.fullmatch(host)
    return host if found is None else found[1]


def _digits(text: str) -> str:
    return text if text.isascii() and text.isdigit() and len(text) < 20 else "0"


def _too_large(limit: int) -> str:
    return f"the request is longer than the {limit:,} bytes that this server takes"


def _pairs(headers: MutableMapping[str, str]) -> Iterable[tuple[bytes, bytes]]:
    return [(name.encode(), value.encode()) for name, value in headers.items()]


async def _refuse(send: Send, status: int, words: str) -> None:
    content = json.dumps({"error": words}).encode()
    headers = {"content-type": "application/json", "content-length": str(len(content))}
    if status == 401:
        headers["www-authenticate"] = "Bearer"
    await _respond(send, status, headers, content)


async def _redirect(send: Send, path: str, cookie: str) -> None:
    # without the token, so that it does not appear in histories and logs
    await _respond(send, 303, {"location": path, "set-cookie": cookie, "content-length": "0"}, b"")


async def _respond(
    send: Send, status: int, headers: MutableMapping[str, str], content: bytes
) -> None:
    pairs = [*_pairs(headers), *_pairs(_HEADERS)]
    await send({"type": "http.response.start", "status": status, "headers": pairs})
    await send({"type": "http.response.body", "body": content})
