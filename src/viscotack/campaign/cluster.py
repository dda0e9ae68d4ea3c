"""Executors on a Dask cluster."""

from dataclasses import dataclass, field
from time import monotonic
from typing import Any

from viscotack.errors import NotInstalled, install_command

# Seconds to wait for the scheduler, and for a worker when there is none.
_CONNECT, _WORKER = 30.0, 120.0
# Seconds for which a count of the workers serves: they come and go.
_LISTED = 1.0


@dataclass
class Dask:
    """Executors on the workers of a Dask cluster, ``run(plan, folder, executor=dask, ...)``.

    A context manager: the connection is closed at the end of the block.

    Attributes
    ----------
    address : str
        Of the scheduler, ``"tcp://host:8786"``; ``"tls://host:8786"`` with the certificates that
        the configuration of Dask names.
    """

    address: str
    _client: Any = None
    _threads: int = 0
    _counted: float = 0.0
    _seen: float = field(default_factory=monotonic)

    def __enter__(self) -> "Dask":
        return self

    def __exit__(self, *_: object) -> None:
        if self._client is not None:
            self._client.close(timeout=_CONNECT)

    def __call__(self) -> Any:
        """Connect to the scheduler, anew if it was lost, and return an executor.

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
            raise NotInstalled(
                f"a cluster needs Dask distributed; install it with: {install_command('cluster')}"
            ) from None
        self.__exit__()
        try:
            self._client = Client(self.address, timeout=_CONNECT, set_as_default=False)
        except (OSError, ValueError, TypeError, RuntimeError) as error:
            raise ConnectionError(
                f"no scheduler answers at {self.address!r}: {error}; start one with 'dask "
                "scheduler' and give the address it prints, such as tcp://host:8786. What is "
                "stored is safe"
            ) from None
        self._seen = monotonic()
        return self._client.get_executor(pure=False, retries=0)

    def threads(self) -> int:
        """Return the number of threads of all workers, for :func:`viscotack.campaign.run`.

        Raises
        ------
        ConnectionError
            If there have been none for two minutes.
        """
        now = monotonic()
        if now - self._counted > _LISTED:
            self._counted = now
            try:
                self._threads = sum(self._client.nthreads().values())
            except (OSError, TimeoutError, RuntimeError, ValueError):
                self._threads = 0  # the scheduler is away, and what it had is cancelled
        if self._threads:
            self._seen = now
        elif now - self._seen > _WORKER:
            raise ConnectionError(
                f"the scheduler {self.address} has no workers; start some with "
                f"'dask worker {self.address} --nthreads 1'. What is stored is safe"
            )
        return self._threads
