"""Who does the cases: processes of this machine, or a Dask cluster, behind one small submit.

A crew takes one case at a time and returns a future. What to run next, what to store and what
to try again is decided in :mod:`viscotack.campaign.running`.
"""

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from time import monotonic
from typing import Any, Protocol

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
# Seconds to wait for the scheduler of a cluster.
_PATIENCE = 20
# Seconds for which a count of its workers serves: they come and go.
_COUNT = 2.0


class Lost(Exception):
    """The worker of a case has died; `certain` where the case is known to be the cause."""

    def __init__(self, reason: str, *, certain: bool) -> None:
        super().__init__(reason)
        self.certain = certain


class Gone(ConnectionError):
    """The cluster's scheduler cannot be reached any more."""


class Crew(Protocol):
    """Workers that take cases."""

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Return a future of function(*arguments), done by one of the workers."""
        ...

    def outcome(self, future: Future[Any]) -> Any:
        """Return what a finished future holds; raise Lost where its worker died."""
        ...

    def workers(self) -> int:
        """Return how many cases are done at once."""
        ...

    def renew(self) -> None:
        """Replace what has died."""
        ...


class LocalCrew:
    """Processes of this machine, one thread of linear algebra each."""

    def __init__(self, workers: int) -> None:
        self._workers = workers
        self._others = set(multiprocessing.active_children())
        self._pool = self._start()

    def _start(self) -> ProcessPoolExecutor:
        # Fresh interpreters: a fork would copy the threads and locks of this one.
        context = multiprocessing.get_context("spawn")
        return ProcessPoolExecutor(self._workers, mp_context=context, initializer=_prepare)

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Return a future of function(*arguments)."""
        try:
            return self._pool.submit(function, *arguments)
        except BrokenProcessPool as error:
            future: Future[Any] = Future()
            future.set_exception(error)
            return future

    def outcome(self, future: Future[Any]) -> Any:
        """Return what a finished future holds; raise Lost where its worker died."""
        try:
            return future.result()
        except BrokenProcessPool:
            reason = "its worker process died: killed, out of memory or crashed"
            raise Lost(reason, certain=False) from None

    def workers(self) -> int:
        """Return the number of processes."""
        return self._workers

    def renew(self) -> None:
        """Start a new pool after a death."""
        self._pool.shutdown(wait=True)
        self._pool = self._start()

    def dismiss(self, *, at_once: bool) -> None:
        """End the processes, when they have done their cases or at once."""
        if at_once:
            for child in set(multiprocessing.active_children()) - self._others:
                child.kill()
        self._pool.shutdown(wait=True, cancel_futures=True)


@contextmanager
def local(workers: int) -> Iterator[LocalCrew]:
    """Hold a crew of processes for the block; when it ends by an error they are ended at once."""
    before = {name: os.environ.get(name) for name in _THREADS}
    # Read by the linear algebra of each worker when it starts.
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    crew = LocalCrew(workers)
    at_once = True
    try:
        yield crew
        at_once = False
    finally:
        crew.dismiss(at_once=at_once)
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _prepare() -> None:
    """Make a fresh worker deaf to ctrl-C, which is for its parent, and mortal with its parent."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()

    def follow() -> None:
        if parent is not None:
            parent.join()
            os._exit(1)

    threading.Thread(target=follow, daemon=True).start()


class DaskCrew:
    """The workers of a Dask cluster."""

    def __init__(self, client: Any) -> None:
        self._client, self._executor = client, client.get_executor(pure=False)
        self._count, self._counted = 0, -_COUNT

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Return a future of function(*arguments)."""
        return self._executor.submit(function, *arguments)

    def outcome(self, future: Future[Any]) -> Any:
        """Return what a finished future holds; raise Lost where several workers died of it."""
        from distributed import KilledWorker

        if future.cancelled():
            raise Gone(
                f"the connection to the scheduler {self._client.scheduler.address} was lost; "
                "what is stored is safe: run again when it is back"
            )
        try:
            return future.result()
        except KilledWorker as error:
            # Dask has tried it on several workers, and all have died.
            raise Lost(f"the workers that took it died: {error}", certain=True) from None

    def workers(self) -> int:
        """Return the number of cases that the cluster does at once; at least one."""
        if monotonic() - self._counted > _COUNT:
            self._count, self._counted = sum(self._client.nthreads().values()), monotonic()
        return max(1, self._count)

    def renew(self) -> None:
        """Do nothing: the cluster replaces its workers itself."""


@contextmanager
def cluster(address: str) -> Iterator[DaskCrew]:
    """Hold the connection to a Dask scheduler for the block.

    Raises
    ------
    ModuleNotFoundError
        If Dask distributed is not installed.
    ConnectionError
        If no scheduler answers at the address.
    """
    try:
        from distributed import Client
    except ImportError:
        raise ModuleNotFoundError(
            "a cluster needs Dask distributed; install it with pip install 'viscotack[cluster]'"
        ) from None
    try:
        client = Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ConnectionError(
            f"no scheduler answers at {address!r}: {error}; start one with 'dask scheduler' and "
            "give the address it prints, such as tcp://host:8786"
        ) from None
    try:
        yield DaskCrew(client)
    finally:
        with suppress(OSError, TimeoutError):
            client.close(timeout=_PATIENCE)
