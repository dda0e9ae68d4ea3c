"""Work for a few processes that are stopped where a piece takes more processor time than it may."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from threading import local
from typing import Any

# Each is a process of its own, with the kernels of the linear algebra that its environment names.
_SPAWN = multiprocessing.get_context("spawn")


class Worker:
    """A process that does one piece of work after the other, each within so many seconds."""

    def __init__(self, work: Callable[[Any], Any], limit: float) -> None:
        self._made = work, limit
        self._start()

    def _start(self) -> None:
        self._here, there = _SPAWN.Pipe()
        self._process = _SPAWN.Process(target=_serve, args=(there, *self._made), daemon=True)
        self._process.start()
        there.close()

    def ask(self, item: Any) -> Any:
        """Return work(item), or the words why there is none."""
        self._here.send(item)
        try:
            return self._here.recv()
        except EOFError:
            self._process.join()
            code = self._process.exitcode or 0
            self._start()
            if code == -signal.SIGPROF:
                return f"more than {self._made[1]:g} s of processor time"
            return f"its process died with exit code {code}"


def _serve(pipe: Any, work: Callable[[Any], Any], limit: float) -> None:
    while True:
        try:
            item = pipe.recv()
        except EOFError:
            return
        # Not caught: a busy machine does not change it, and neither can compiled code delay it.
        signal.setitimer(signal.ITIMER_PROF, limit)
        done = work(item)
        signal.setitimer(signal.ITIMER_PROF, 0)
        pipe.send(done)


def spread_in_time(
    work: Callable[[Any], Any], items: Iterable[Any], *, limit: float, workers: int, kernels: str
) -> Iterator[tuple[Any, Any]]:
    """Yield items with work(item), or with the words why there is none, as they are done.

    ``kernels`` is the processor that OpenBLAS is to take this one for; "" leaves it the choice.
    """
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ[name] = "1"
    os.environ.pop("OPENBLAS_CORETYPE", None)
    if kernels:
        os.environ["OPENBLAS_CORETYPE"] = kernels
    mine = local()

    def one(item: Any) -> tuple[Any, Any]:
        if not hasattr(mine, "worker"):
            mine.worker = Worker(work, limit)
        return item, mine.worker.ask(item)

    with ThreadPoolExecutor(workers) as pool:
        asked = [pool.submit(one, item) for item in items]
        try:
            for future in as_completed(asked):
                yield future.result()
        finally:
            pool.shutdown(cancel_futures=True)
