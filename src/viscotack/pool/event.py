"""Events of a task in a pool: progress, then one event that ends it."""

from dataclasses import dataclass
from typing import Any, Literal

Kind = Literal[
    "told", "answer", "refused", "failed", "time limit", "memory limit", "stopped", "lost"
]


@dataclass(frozen=True)
class Event:
    """What has become of a task.

    Attributes
    ----------
    kind : str
        "told", progress of a task that runs on; "answer"; "refused", it has raised an InputError;
        "failed", it has raised another exception; "time limit" and "memory limit", it exceeded one;
        "stopped", the caller did not want it any more; "lost", its process has died.
    what : object
        The news of "told", the answer of "answer"; of all others the reason in words, of "lost" how
        the process ended.
    seconds : float
        Time of the task [s].
    memory : float
        Largest resident memory seen of its process [bytes]; 0 where the system does not tell.
    """

    kind: Kind
    what: Any
    seconds: float
    memory: float


class NoWorker(RuntimeError):
    """There is no worker that could take a task."""
