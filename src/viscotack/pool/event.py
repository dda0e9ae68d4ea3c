"""Events of a task in a pool: any number of progress events, then one final event."""

from dataclasses import dataclass
from typing import Any, Literal

Kind = Literal[
    "told", "answer", "refused", "failed", "time limit", "memory limit", "stopped", "lost"
]


@dataclass(frozen=True)
class Event:
    """Progress or final outcome of a task.

    Attributes
    ----------
    kind : str
        "told": progress report; "answer": the task returned; "refused": it raised an InputError;
        "failed": it raised another exception; "time limit", "memory limit": it exceeded a limit;
        "stopped": the caller cancelled it; "lost": its process died.
    what : object
        Progress data ("told"), return value ("answer"), or the reason as text (all others; for
        "lost" how the process ended).
    seconds : float
        Time of the task [s].
    memory : float
        Largest resident memory observed of its process [bytes]; 0 if the system does not report it.
    """

    kind: Kind
    what: Any
    seconds: float
    memory: float


class NoWorker(RuntimeError):
    """No worker process can be started."""
