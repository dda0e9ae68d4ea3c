"""Message-based communication between a process and its workers over a socket."""

import json
import pickle
import select
import socket
import struct
import threading
from typing import Any, Literal

Code = Literal["json", "pickle"]
_LENGTH = struct.Struct("!Q")
# Flag to receive without waiting; Windows has none.
_AT_ONCE = getattr(socket, "MSG_DONTWAIT", 0)


class Line:
    """One end of a socket that sends and receives complete messages.

    The receiver never waits for the rest of a message, because a process that is suspended in the
    middle of one would block it.

    Parameters
    ----------
    end : socket
        One socket of a connected pair.
    code : {"json", "pickle"}
        Format of the messages; the same at both ends.
    strict : bool
        Reject NaN and infinity, which JSON does not define, in messages sent as JSON.
    """

    def __init__(self, end: socket.socket, code: Code = "pickle", *, strict: bool = False) -> None:
        self._end, self._code, self._strict = end, code, strict
        self._came, self._lock = bytearray(), threading.Lock()

    def fileno(self) -> int:
        """File descriptor of the socket."""
        return self._end.fileno()

    def close(self) -> None:
        """Close this end."""
        self._end.close()

    def packed(self, thing: Any) -> bytes:
        """Encode a message; TypeError or ValueError if the format cannot represent it."""
        if self._code == "pickle":
            return pickle.dumps(thing)
        return json.dumps(thing, allow_nan=not self._strict).encode()

    def send(self, content: bytes, patience: float | None = None) -> None:
        """Send an encoded message; OSError if the peer is closed or does not read in time [s]."""
        with self._lock:
            if patience is not None:
                self._end.settimeout(patience)
            try:
                self._end.sendall(_LENGTH.pack(len(content)) + content)
            finally:
                if patience is not None:
                    self._end.settimeout(None)

    def receive(self) -> list[Any]:
        """Return the complete messages that have arrived; EOFError if the peer is closed."""
        gone = False
        try:
            while not gone and (_AT_ONCE or select.select([self._end], [], [], 0)[0]):
                chunk = self._end.recv(1 << 16, _AT_ONCE)
                self._came += chunk
                gone = not chunk
        except BlockingIOError:
            pass
        except ConnectionError:
            gone = True
        found = []
        while len(self._came) >= _LENGTH.size:
            (length,) = _LENGTH.unpack_from(self._came)
            if len(self._came) < _LENGTH.size + length:
                break
            content = bytes(self._came[_LENGTH.size : _LENGTH.size + length])
            found.append(pickle.loads(content) if self._code == "pickle" else json.loads(content))
            del self._came[: _LENGTH.size + length]
        if gone and not found:
            raise EOFError
        return found
