"""Connections whose request has no complete head in time are closed."""

from typing import Any

from uvicorn.protocols.http.h11_impl import H11Protocol

# Longest time in which the head of a request must arrive [s], and most simultaneous connections.
PATIENCE, MOST_CONNECTIONS = 10.0, 1000


class Prompt(H11Protocol):
    """HTTP/1.1 that closes a connection while it waits for a head longer than `PATIENCE`.

    uvicorn closes idle connections between requests, but waits for a head that arrives byte by
    byte. The body is bounded by :class:`viscotack.app.api.guard.Rules`.
    """

    def connection_made(self, transport: Any) -> None:
        """Begin to look at the connection."""
        super().connection_made(transport)
        self._wait()

    def connection_lost(self, exc: Exception | None) -> None:
        """Look no longer."""
        self._look.cancel()
        super().connection_lost(exc)

    def _wait(self) -> None:
        self._look = self.loop.call_later(PATIENCE, self._close_late, self.cycle)

    def _close_late(self, before: Any) -> None:
        """Close the connection if no request has begun since it was looked at last."""
        waits = self.cycle is None or self.cycle.response_complete
        if waits and self.cycle is before:
            self.transport.close()
        else:
            self._wait()
