"""Processes that compute for the server, each warmed up and used by one task at a time.

The server itself computes nothing, so that slow or crashing tasks do not affect it. A task that is
cancelled or too slow ends with its process.
"""

import asyncio
import sys
import traceback
from collections.abc import Callable
from concurrent.futures.process import BrokenProcessPool
from typing import Any

from viscotack.errors import TOO_LARGE, InputError
from viscotack.system import FRESH, Processes, begin_worker

if sys.platform == "win32":
    from multiprocessing.connection import PipeConnection as Connection
else:
    from multiprocessing.connection import Connection

# Interval between two looks at a task [s], and memory that a process may take [bytes].
_LOOK, _MOST_MEMORY = 0.05, 4 * 2**30


class Defect(RuntimeError):
    """A task failed because of a defect."""


# In a process: where news goes, and the user-defined classes.
_line: Connection | None = None
_also: tuple[Any, ...] = ()


def _begin(line: Connection, own: tuple[str, ...], nice: int, warm: Callable[[], None]) -> None:
    """Prepare a process."""
    global _line, _also
    from viscotack.model.problem.nouns import own_nouns

    _line, _also = line, own_nouns(own)
    warm()
    begin_worker(_MOST_MEMORY, nice)


def _tell(news: dict[str, Any]) -> None:
    if _line is not None:
        _line.send(news)


def _done(function: Callable[..., Any], given: tuple[Any, ...]) -> Any:
    """Run a task in a process; what it cannot compute is an InputError, all else a Defect."""
    try:
        return function(*given, tell=_tell, also=_also)
    except InputError:
        raise
    except ArithmeticError:
        raise InputError(TOO_LARGE) from None
    except MemoryError:
        raise InputError("the memory limit of this server was exceeded") from None
    except Exception as error:
        traceback.print_exc()
        raise Defect(f"{type(error).__name__}: {error}") from None


class Lane:
    """A number of processes for tasks of one kind.

    Parameters
    ----------
    workers : int
        Largest number of processes.
    warm : callable
        What a process does before its first task.
    own : tuple of str
        Python files with user-defined classes.
    nice : int
        Added to the nice level of the processes.
    """

    def __init__(
        self, workers: int, warm: Callable[[], None], own: tuple[str, ...], nice: int = 0
    ) -> None:
        self._given = own, nice, warm
        self._free = asyncio.Semaphore(workers)
        self._idle: list[tuple[Processes, Connection]] = []
        self._all: list[Processes] = []

    def begin(self) -> None:
        """Start a process."""
        self._idle.append(self._started())

    def end(self) -> None:
        """End all processes, with their tasks."""
        for pool in self._all:
            pool.kill()
        self._all.clear()
        self._idle.clear()

    def _started(self) -> tuple[Processes, Connection]:
        ours, theirs = FRESH.Pipe(duplex=False)
        pool = Processes(1, _begin, (theirs, *self._given))
        pool.submit(int)  # starts the process
        self._all.append(pool)
        return pool, ours

    async def run(
        self,
        function: Callable[..., Any],
        *given: Any,
        seconds: float,
        told: Callable[[dict[str, Any]], None] = lambda news: None,
        begun: Callable[[], None] = lambda: None,
    ) -> Any:
        """Return what a function computes in a process; cancellation ends the task.

        Parameters
        ----------
        function, *given : callable and its arguments
            It also has `tell`, for progress, and `also`, the user-defined classes.
        seconds : float
            Time limit [s], waiting for a process not counted.
        told, begun : callable
            Called with the progress of the task, and when a process starts it.

        Raises
        ------
        InputError
            If the question has no answer, or not in that time.
        Defect
            If the task failed because of a defect.
        """
        async with self._free:
            pool, line = self._idle.pop() if self._idle else self._started()
            kept = False
            try:
                await asyncio.wrap_future(pool.submit(int))  # it is warm
                begun()
                future = asyncio.wrap_future(pool.submit(_done, function, given))
                until = asyncio.get_running_loop().time() + seconds
                while not future.done():
                    await asyncio.wait([future], timeout=_LOOK)
                    while line.poll():
                        told(line.recv())
                    if asyncio.get_running_loop().time() > until and not future.done():
                        raise InputError(
                            f"exceeded the time limit of {seconds:g} s of this server; request "
                            "less accuracy or a smaller problem, or run viscotack on your own "
                            "machine"
                        )
                kept = True
                return future.result()
            except (BrokenProcessPool, EOFError) as error:
                kept = False
                raise Defect(f"its process ended: {error}") from None
            finally:
                if kept:
                    self._idle.append((pool, line))
                else:
                    self._all.remove(pool)
                    await asyncio.to_thread(pool.kill)
