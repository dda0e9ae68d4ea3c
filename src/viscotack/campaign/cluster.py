"""Dask cluster: each of its threads supervises one worker process.

A case is sent to one Dask worker only, after that worker has reported its program versions. Limits
are therefore enforced as on one machine, a case can only crash its own process, and the cases lost
with a machine are known.
"""

import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from queue import Empty, SimpleQueue
from time import monotonic
from typing import Any

from viscotack.errors import InputError, NotInstalled, install_command
from viscotack.files.bounded import LARGEST_TEXT, read_bytes
from viscotack.pool import NoWorker

from .case import Answer, CaseSettings, Lost, Work
from .identity import difference, identity

# Seconds to wait for the scheduler; for the first worker; for one that is there to say what it is,
# for which it imports much; for another one when all have left.
_CONNECT, _FIRST, _ANSWER, _AGAIN = 8.0, 12.0, 60.0, 120.0
# Seconds for which a list of the workers serves: they come and go.
_LISTED = 1.0
# Cases that a thread of a cluster has beside the one it is at, for the way takes a while.
_AHEAD = 1
# Seconds in which an answer that is ready comes over the wire.
_FETCH = 3.0
_GONE = (
    "the connection to the scheduler was lost; what is stored is safe: run again when it is back"
)
_THREAD = threading.local()
# Asks a worker who it is. In words: over a function that it cannot import it would break down and
# leave without saying why.
_WHO = "__import__('importlib').import_module('viscotack.campaign.identity').identity()"


@dataclass(frozen=True)
class Security:
    """TLS certificates for an encrypted and authenticated connection; used by :func:`run`.

    Attributes
    ----------
    ca, cert, key : path
        Files in PEM: the authority that both ends trust, and the certificate and key of this end.
    """

    ca: Path
    cert: Path
    key: Path


class Gone(ConnectionError):
    """The connection to the scheduler was lost."""


@dataclass
class _Machine:
    """State of a worker of the cluster."""

    threads: int
    probe: Any
    fit: bool = False
    unfit: str = ""
    flying: set[int] = field(default_factory=set)


class DaskCrew:
    """The workers of a Dask cluster.

    Parameters
    ----------
    client : distributed.Client
        The connection.
    packed : bytes
        Work and settings, pickled.
    settings : CaseSettings
        Of which workers need the limits.
    """

    def __init__(self, client: Any, packed: bytes, settings: CaseSettings) -> None:
        self._client, self._packed, self._settings = client, packed, settings
        self._machines: dict[str, _Machine] = {}
        self._flying: dict[int, tuple[Any, str]] = {}
        self._landed: SimpleQueue[tuple[str, Any, Any]] = SimpleQueue()
        self._lost: list[tuple[int, Lost]] = []
        self._listed, self._seen, self._ever = -_LISTED, monotonic(), False

    def room(self) -> int:
        """Return how many more cases the workers that are fit may be given."""
        self._list()
        return sum(max(0, self._free(machine)) for machine in self._machines.values())

    def hand(self, number: int, problem: str) -> None:
        """Submit a case to the least-loaded worker."""
        address, machine = max(self._machines.items(), key=lambda item: self._free(item[1]))
        future = self._client.submit(
            do_case,
            self._packed,
            self._settings,
            problem,
            identity(),
            workers=[address],
            allow_other_workers=False,
            pure=False,
            retries=0,
        )
        machine.flying.add(number)
        self._flying[number] = future, address
        future.add_done_callback(lambda done: self._landed.put(("case", number, done)))

    def collect(self, seconds: float) -> list[tuple[int, Answer | Lost]]:
        """Return the answers that arrived, and the cases lost with their machines."""
        self._list()
        found: list[tuple[int, Answer | Lost]] = list(self._lost)
        self._lost.clear()
        with suppress(Empty):
            if not found:
                found += self._came(*self._landed.get(timeout=seconds))
            while True:
                found += self._came(*self._landed.get_nowait())
        return found

    def workers(self) -> int:
        """Return the number of cases that the cluster runs in parallel; at least one."""
        return max(1, sum(m.threads for m in self._machines.values() if m.fit))

    def _free(self, machine: _Machine) -> int:
        return machine.threads + _AHEAD - len(machine.flying) if machine.fit else -1

    def _came(self, kind: str, what: Any, future: Any) -> Iterator[tuple[int, Answer | Lost]]:
        if kind == "probe":
            self._probed(what, future)
            return
        held = self._flying.get(what)
        if held is None or held[0] is not future:
            return  # given up before
        address = self._flying.pop(what)[1]
        machine = self._machines.get(address)
        if machine is not None:
            machine.flying.discard(what)
        answer = _fetched(future)
        if isinstance(answer, Exception):
            self._dismiss(address, f"{type(answer).__name__}: {answer}")
            yield what, Lost(f"its worker {address} cannot do it: {answer}", blame=False)
        elif answer is None:
            if self._client.status != "running" or self._client.scheduler is None:
                raise Gone(_GONE)
            future.cancel()
            yield what, Lost(f"its worker {address} left with its answer", blame=False)
        elif isinstance(answer, str):
            self._dismiss(address, answer)
            yield what, Lost(f"its worker {address} is of another program: {answer}", blame=False)
        else:
            yield what, answer

    def _dismiss(self, address: str, why: str) -> None:
        """Give a machine nothing any more."""
        if machine := self._machines.get(address):
            machine.fit, machine.unfit = False, why

    def _probed(self, address: str, future: Any) -> None:
        machine = self._machines.get(address)
        if machine is None or machine.probe is not future or future.cancelled():
            return
        found = _fetched(future)
        if found is None:
            del self._machines[address]  # if it is still there it is queried again
        elif isinstance(found, Exception):
            self._dismiss(address, f"it cannot begin: {type(found).__name__}: {found}")
        elif words := difference(found, identity()):
            self._dismiss(address, f"it is of another program: {words}")
        else:
            machine.fit = self._ever = True

    def _list(self) -> None:
        """See which workers there are; ask the new ones who they are."""
        now = monotonic()
        if now - self._listed < _LISTED:
            return
        self._listed = now
        try:
            there = self._client.nthreads()
        except (OSError, TimeoutError, RuntimeError, ValueError):
            raise Gone(_GONE) from None
        for address in [a for a in self._machines if a not in there]:
            machine = self._machines.pop(address)
            for number in machine.flying:
                future, _ = self._flying.pop(number)
                future.cancel()
                self._lost.append((number, Lost(f"its worker {address} has left", blame=False)))
        for address, threads in there.items():
            if address not in self._machines:
                probe = self._client.submit(
                    eval, _WHO, workers=[address], allow_other_workers=False, pure=False
                )
                self._machines[address] = _Machine(threads, probe)
                probe.add_done_callback(
                    lambda done, address=address: self._landed.put(("probe", address, done))
                )
        if any(machine.fit for machine in self._machines.values()):
            self._seen = now
        elif now - self._seen > self._patience():
            raise NoWorker(self._no_worker())

    def _patience(self) -> float:
        """Return how long to go on without a worker that is fit [s]."""
        if self._ever:
            return _AGAIN
        is_asked = any(not machine.unfit for machine in self._machines.values())
        return _ANSWER if is_asked else _FIRST

    def _no_worker(self) -> str:
        """Return words for why there is no worker."""
        scheduler = self._client.scheduler.address
        if not self._machines:
            left = "all its workers have left" if self._ever else "it has no workers"
            return (
                f"the scheduler {scheduler} answers, but {left}; start some with "
                f"'dask worker {scheduler} --nthreads 1'"
            )
        whys = [
            f"{address}: {machine.unfit or 'busy with others, or it does not answer'}"
            for address, machine in self._machines.items()
        ]
        more = f" and {len(whys) - 3} more" if len(whys) > 3 else ""
        return (
            f"no worker of {scheduler} can run a case: {'; '.join(whys[:3])}{more}; "
            "workers need the same versions of viscotack and its dependencies"
        )


def _fetched(future: Any) -> Any:
    """Return the result or exception of a future; None if it was lost with its worker."""
    from distributed import CancelledError

    try:
        if future.status == "error":
            return future.exception(timeout=_FETCH)
        if future.status == "finished":
            return future.result(timeout=_FETCH)
    except (CancelledError, TimeoutError, OSError, LookupError):
        pass
    return None


def do_case(
    packed: bytes, settings: CaseSettings, problem: str, wanted: dict[str, str]
) -> Answer | Lost | str:
    """Do a case in a process of this thread's own; words where this program is another one.

    Runs in a worker of the cluster.
    """
    if words := difference(identity(), wanted):
        return words
    from .local import LocalCrew

    crew = getattr(_THREAD, "crew", None)
    if crew is None or _THREAD.packed != packed:
        if crew is not None:
            crew.dismiss(at_once=True)
        _THREAD.crew = crew = LocalCrew(packed, settings, 1)
        _THREAD.packed = packed
    try:
        while not crew.room():
            crew.collect(0.25)
        crew.hand(0, problem)
        while not (found := crew.collect(0.25)):
            pass
    except NoWorker as error:
        _THREAD.crew = None
        return str(error)
    return found[0][1]


@contextmanager
def cluster(
    work: Work, settings: CaseSettings, address: str, security: Security | None = None
) -> Iterator[DaskCrew]:
    """Hold the connection to a Dask scheduler for the block.

    Raises
    ------
    ModuleNotFoundError
        If Dask distributed is not installed.
    ConnectionError
        If no scheduler answers at the address.
    """
    check_installed()
    import cloudpickle
    from distributed import Client
    from distributed.security import Security as DaskSecurity

    secured: dict[str, Any] = {}
    if security is not None:
        secured["security"] = DaskSecurity(
            tls_ca_file=str(security.ca),
            tls_client_cert=str(security.cert),
            tls_client_key=str(security.key),
            require_encryption=True,
        )
    try:
        client = Client(address, timeout=_CONNECT, set_as_default=False, **secured)
    except (OSError, ValueError, TypeError, RuntimeError) as error:
        raise ConnectionError(
            f"no scheduler answers at {address!r}: {error}; start one with 'dask scheduler' and "
            "give the address it prints, such as tcp://host:8786"
        ) from None
    try:
        yield DaskCrew(client, cloudpickle.dumps((work, settings)), settings)
    finally:
        with suppress(OSError, TimeoutError, RuntimeError):
            client.close(timeout=_CONNECT)


def check_installed() -> None:
    """Raise NotInstalled unless Dask is there."""
    try:
        import distributed  # noqa: F401
    except ImportError:
        raise NotInstalled(
            f"a cluster needs Dask distributed; install it with: {install_command('cluster')}"
        ) from None


def security_of(ca: Path | None, cert: Path | None, key: Path | None) -> Security | None:
    """Return the certificates of three files; None of none of them."""
    if ca is None and cert is None and key is None:
        return None
    if ca is None or cert is None or key is None:
        raise InputError("TLS needs three files: CA certificate, certificate and key")
    for path in (ca, cert, key):
        read_bytes(path, LARGEST_TEXT)  # there is no such file: said now, and not by a library
    return Security(ca, cert, key)
