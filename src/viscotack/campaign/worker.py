"""A worker: a process that does one case after another for a supervisor, and ends with it.

It talks over a socket in messages of :class:`Line`. The first one says what the work is, every
other one is a problem; an answer goes back for each. A thread beside the work says once a second
that the process lives. Nothing is raised in the work from outside: a case ends by itself, by the
clock of the march, or its process is killed.
"""

import os
import pickle
import runpy
import select
import signal
import socket
import struct
import sys
import threading
import types
from contextlib import suppress
from time import monotonic
from typing import Any

# Seconds between two signs of life.
BEAT = 1.0
# Seconds after which a worker that is given nothing ends: on a cluster nobody may come again.
_IDLE = 600.0
_LENGTH = struct.Struct("!Q")


class Line:
    """One end of a socket, for whole messages of pickled objects.

    The receiving side never waits for the rest of a message, for a process that is stopped in the
    middle of one would hold it for ever.
    """

    def __init__(self, end: socket.socket) -> None:
        self._end, self._came, self._lock = end, bytearray(), threading.Lock()

    def fileno(self) -> int:
        """Return the number that the system waits on."""
        return self._end.fileno()

    def close(self) -> None:
        """Close this end."""
        self._end.close()

    def send(self, thing: Any, patience: float | None = None) -> None:
        """Send an object; OSError if the other end has gone or does not take it in time [s]."""
        content = pickle.dumps(thing)
        with self._lock:
            if patience is not None:
                self._end.settimeout(patience)
            try:
                self._end.sendall(_LENGTH.pack(len(content)) + content)
            finally:
                if patience is not None:
                    self._end.settimeout(None)

    def receive(self) -> list[Any]:
        """Return the messages that have come whole; EOFError when the other end has gone."""
        try:
            while chunk := self._end.recv(1 << 16, socket.MSG_DONTWAIT):
                self._came += chunk
            gone = True
        except BlockingIOError:
            gone = False
        except ConnectionError:
            gone = True
        found = []
        while len(self._came) >= _LENGTH.size:
            (length,) = _LENGTH.unpack_from(self._came)
            if len(self._came) < _LENGTH.size + length:
                break
            found.append(pickle.loads(self._came[_LENGTH.size : _LENGTH.size + length]))
            del self._came[: _LENGTH.size + length]
        if gone and not found:
            raise EOFError
        return found


def serve(handle: int) -> None:
    """Do the cases that come over a socket; return when it is closed.

    Parameters
    ----------
    handle : int
        Of the socket, inherited.
    """
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)  # meant for the parent, which lets cases end
    signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT, signal.SIGTERM))
    with suppress(ConnectionError):  # the parent has gone, and needs no answer
        _serve(Line(socket.socket(fileno=handle)))


def _serve(line: Line) -> None:
    threading.Thread(target=_beat, args=(line,), daemon=True).start()
    try:
        from .case import attempt
        from .identity import identity

        first = _next(line)
        if first is None:
            return
        packed, main = first
        _become(main)
        work, settings = pickle.loads(packed)
    except BaseException as error:
        line.send(("unfit", f"{type(error).__name__}: {error}"))
        return
    line.send(("ready", identity()))
    while (problem := _next(line)) is not None:
        line.send(("answer", attempt(work, problem, settings)))


def _next(line: Line) -> Any:
    """Return the next message; None when none will come, or none has come for long.

    They come one at a time: the next case is sent when the answer to the last one has been read.
    """
    while select.select([line], [], [], _IDLE)[0]:
        try:
            for message in line.receive():
                return message
        except EOFError:
            return None
    return None


def _beat(line: Line) -> None:
    """Say that this process lives, until nobody listens."""
    pause = threading.Event()
    while not pause.wait(BEAT):
        try:
            line.send(("alive", monotonic()))
        except OSError:
            os._exit(1)  # the parent has gone


def _become(main: str | None) -> None:
    """Read the program of the parent, where the work is defined in it, as multiprocessing does."""
    if main is not None:
        module = types.ModuleType("__mp_main__")
        module.__dict__.update(runpy.run_path(main, run_name="__mp_main__"))
        sys.modules["__main__"] = sys.modules["__mp_main__"] = module
