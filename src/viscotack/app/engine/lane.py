"""Processes that compute for the server, each warmed up and used by one task at a time.

The server itself computes nothing, so that slow or crashing tasks do not affect it. A task that is
cancelled or too slow ends with its process.
"""

import asyncio
import base64
import io
import os
import sys
import traceback
from collections.abc import Callable
from concurrent.futures.process import BrokenProcessPool
from contextlib import chdir
from typing import Any

from viscotack.app.operations.options import Output
from viscotack.app.operations.request import Answer, Caller, Request, answered, plain
from viscotack.errors import TOO_LARGE, InputError
from viscotack.system import FRESH, Processes, begin_worker

if sys.platform == "win32":
    from multiprocessing.connection import PipeConnection as Connection
else:
    from multiprocessing.connection import Connection

# Interval between two looks at a task [s], and memory that a process may take [bytes].
_LOOK, _MOST_MEMORY = 0.05, 4 * 2**30
# Outputs besides files that may be requested of every answer.
_WORDS, _DRAWN = "words", "drawn"


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
                if future.cancelled():  # its process was ended before it had begun
                    raise BrokenProcessPool("it was killed")
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


def warm() -> None:
    """Run slow initialisations once."""
    from viscotack.app.operations.parts.solid import FIRST
    from viscotack.model.problem.accuracy import LOOSEST_ACCURACY
    from viscotack.model.problem.case_file import case_of_tables
    from viscotack.simulate import solve

    problem = case_of_tables(FIRST)
    solve(problem, accuracy=LOOSEST_ACCURACY, until="pull-off", estimate_error=False)


def run_request(
    asked: Request,
    outputs: tuple[str, ...],
    folder: str,
    *,
    tell: Callable[[dict[str, Any]], None],
    also: tuple[Any, ...],
) -> dict[str, Any]:
    """Answer a request; return the record of the answer, with other outputs in ``beside``.

    `outputs` are names of files, "words" or "drawn"; `folder` has the files that were sent.
    """
    known = {_WORDS, _DRAWN, *(output.name for output in asked.outputs)}
    if unknown := [name for name in outputs if name not in known]:
        raise InputError(
            f"outputs must be among {', '.join(sorted(known))}, got {unknown[0]!r:.60}"
        )
    wanted = frozenset(outputs) | {output.name for output in asked.outputs if output.needed}
    caller = Caller(lambda told: tell(plain(dict(told))), wanted, also, sent=True)
    beside: dict[str, Any] = {}
    try:
        # so that files have their names in answers, and not the place where they lie
        with chdir(folder):
            answer = answered(asked, caller)
            files = {
                output.name: _content(answer, output)
                for output in asked.outputs
                if output.name in wanted & {*answer.files, *answer.pictures}
            }
            beside |= {"files": files} if files else {}
            if _WORDS in wanted:
                beside |= {"words": str(answer), "notes": list(answer.notes)}
            if _DRAWN in wanted and answer.drawn is not None:
                beside["drawn"] = plain(answer.drawn())
            return answer.record() | ({"beside": beside} if beside else {})
    except InputError as error:
        # surfaces know their file by its whole path
        error.args = (str(error).replace(f"{os.path.realpath(folder)}{os.sep}", ""),)
        raise
    except FileNotFoundError as error:
        raise InputError(f"there is no file {error.filename}") from None
    except OSError as error:
        raise InputError(str(error)) from None


def _content(answer: Answer, output: Output) -> str:
    """Return a file as text: a picture as SVG, a binary file in base 64."""
    stream = io.BytesIO()
    if output.name in answer.pictures:
        answer.plot(output.name).savefig(stream, format="svg")
    else:
        answer.write(output.name, stream)
    content = stream.getvalue()
    binary = output.kind == "binary"
    return base64.b64encode(content).decode() if binary else content.decode("utf-8")
