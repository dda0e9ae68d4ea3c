"""The engine of page and API: tasks, limits and running jobs.

It belongs to one event loop. All computations run in the processes of :mod:`.crew`.
"""

import asyncio
import json
import re
import secrets
import zlib
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic
from typing import Any

from .crew import Crew, Defect, Refused

# Largest number of finished jobs that are kept, and for how long [s].
_KEPT, _KEPT_FOR = 64, 900.0


@dataclass(frozen=True)
class Limits:
    """Limits of a server.

    Attributes
    ----------
    jobs : int
        Largest number of waiting and running jobs of all users.
    workers : int
        Number of jobs that run in parallel.
    job_time : float
        Time limit of a job [s].
    ask_time : float
        Time limit of a direct request [s].
    cases : int
        Largest number of cases of a sweep.
    body : int
        Largest request [bytes]; with files twenty times as large.
    """

    jobs: int = 120
    workers: int = 2
    job_time: float = 600.0
    ask_time: float = 60.0
    cases: int = 1000
    body: int = 1_000_000

    @property
    def uploads(self) -> int:
        """Longest request with files [bytes]."""
        return 20 * self.body


class TooMany(Refused):
    """The queue of jobs is full."""


class Unknown(Refused):
    """No job has this id."""


# Task -> its lane; each lane has processes of its own, so that no simulation holds up a slider.
_LANES = {
    "quick": ("quick", "state", "forms", "moduli"),
    "ask": ("operation", "verdict", "theory"),
    "work": ("job",),
}
_LANE_OF = {task: lane for lane, tasks in _LANES.items() for task in tasks}


@dataclass(frozen=True)
class Upload:
    """Files of a request, and the folder that they lie in."""

    folder: TemporaryDirectory[str]
    paths: tuple[str, ...]


@dataclass(eq=False)
class Job:
    """A long-running operation, and its progress.

    Attributes
    ----------
    id : str
        Identifier; known only to the client that started the job.
    kind : str
        Word of the operation.
    state : str
        "queued", "running", "done", "refused", "failed" or "cancelled".
    share : float
        Of the work that is done.
    points, rows : list
        Of the curve that grows, and of the table.
    error : str
        Why it has no answer.
    upload : Upload, optional
        Files that were sent with it.
    """

    id: str
    kind: str
    state: str = "queued"
    share: float = 0.0
    points: list[Any] = field(default_factory=list)
    rows: list[Any] = field(default_factory=list)
    error: str = ""
    upload: Upload | None = None
    ended: float | None = None
    news: asyncio.Event = field(default_factory=asyncio.Event)
    task: asyncio.Task[None] | None = None
    _answer: bytes = b""

    @property
    def over(self) -> bool:
        """Whether nothing more will come of it."""
        return self.ended is not None

    @property
    def answer(self) -> dict[str, Any] | None:
        """What came out, None while there is nothing."""
        return json.loads(zlib.decompress(self._answer)) if self._answer else None

    def tell(self, told: dict[str, Any]) -> None:
        """Store a progress message of the task."""
        self.share = max(self.share, told.get("share", 0.0))
        self.points += told.get("points", [])
        self.rows += told.get("rows", [])
        self.changed()

    def changed(self) -> None:
        """Wake those who wait for news."""
        news, self.news = self.news, asyncio.Event()
        news.set()

    def close(self, state: str, *, answer: Any = None, error: str = "") -> None:
        """Store the outcome, and delete the files sent with the request."""
        if self.upload is not None:
            self.upload.folder.cleanup()
        self.state, self.error, self.ended = state, error, monotonic()
        if answer is not None:
            self.share = 1.0
            self._answer = zlib.compress(json.dumps(answer).encode(), 1)
        self.changed()


class Engine:
    """Runs tasks and jobs within limits.

    Parameters
    ----------
    limits : Limits
        How much.
    own : iterable of str
        Python files with user-defined classes, chosen by the operator of the server.
    """

    def __init__(self, limits: Limits | None = None, own: Iterable[str] = ()) -> None:
        self.limits = Limits() if limits is None else limits
        self._own = tuple(own)
        self._jobs: dict[str, Job] = {}
        self._crews: dict[str, Crew] = {}

    async def begin(self) -> None:
        """Start a process of each lane; Refused where the user's own files are wrong."""
        self._crews = {
            "quick": Crew(2, "quick", self._own),
            "ask": Crew(2, "verdict", self._own, nice=4),
            "work": Crew(self.limits.workers, "job", self._own, nice=2),
        }
        for crew in self._crews.values():
            crew.begin()
        # errors in user-defined files are reported by the first request
        await self.ask("forms", {})

    async def end(self) -> None:
        """End all jobs and all processes."""
        await asyncio.gather(*(self._stop(job) for job in self._jobs.values()))
        for crew in self._crews.values():
            crew.end()

    async def ask(self, task: str, asked: dict[str, Any], **more: Any) -> dict[str, Any]:
        """Return the answer of a question that is no job; keywords as of :meth:`Crew.ask`."""
        crew = self._crews[_LANE_OF[task]]
        return await crew.ask(task, asked, seconds=self.limits.ask_time, **more)

    def held(self, files: Iterable[tuple[str, bytes]]) -> Upload:
        """Return files that were sent, in a folder of their own; to be cleaned up."""
        folder = TemporaryDirectory(prefix="viscotack-")
        paths: list[str] = []
        try:
            for name, content in files:
                path = Path(folder.name, harmless_name(name))
                if str(path) in paths:
                    raise Refused(f"two files are called {path.name}; rename one")
                path.write_bytes(content)
                paths.append(str(path))
        except BaseException:
            folder.cleanup()
            raise
        return Upload(folder, tuple(paths))

    def start(self, asked: dict[str, Any], upload: Upload | None = None) -> Job:
        """Return a job that has been put in the queue; TooMany where it is full.

        Parameters
        ----------
        asked : dict
            Word of the ``operation``, its options as ``given``, and ``files`` that were sent.
        upload : Upload, optional
            Where the files lie; cleaned up when the job has ended.
        """
        self._forget()
        waiting = sum(not job.over for job in self._jobs.values())
        if waiting >= self.limits.jobs:
            raise TooMany(
                f"{waiting} jobs are waiting or running, the limit of this server; cancel one, or "
                "try again later"
            )
        job = Job(secrets.token_urlsafe(16), asked["operation"], upload=upload)
        self._jobs[job.id] = job
        job.task = asyncio.get_running_loop().create_task(self._run(job, asked))
        return job

    def job(self, id: str) -> Job:
        """Return a job by its id; Unknown where there is none."""
        self._forget()
        if id not in self._jobs:
            raise Unknown("there is no such job; it was cancelled or its result has expired")
        return self._jobs[id]

    async def cancel(self, id: str) -> Job:
        """End a job, and forget one that has ended; returns it when its process is free."""
        job = self.job(id)
        if job.over:
            del self._jobs[id]
            return job
        await self._stop(job)
        self._jobs.pop(id, None)
        return job

    def processes(self) -> list[int]:
        """Return the identifiers of all living processes."""
        return [pid for crew in self._crews.values() for pid in crew.processes()]

    async def _run(self, job: Job, asked: dict[str, Any]) -> None:
        def begun() -> None:
            job.state = "running"
            job.changed()

        crew = self._crews["work"]
        options = {"told": job.tell, "begun": begun}
        try:
            answer = await crew.ask("job", asked, seconds=self.limits.job_time, **options)
            job.close("done", answer=answer)
        except Refused as error:
            job.close("refused", error=str(error))
        except Defect as error:
            job.close("failed", error=f"this is a defect of viscotack: {error}")

    async def _stop(self, job: Job) -> None:
        """End a job, and wait until its process is free."""
        if job.task is not None:
            job.task.cancel()
            await asyncio.wait([job.task])
        if not job.over:
            job.close("cancelled", error="it was cancelled")

    def _forget(self) -> None:
        """Forget jobs that ended long ago, and the oldest of many."""
        over = sorted((j for j in self._jobs.values() if j.over), key=lambda j: j.ended or 0.0)
        old = [job for job in over if monotonic() - (job.ended or 0.0) > _KEPT_FOR]
        for job in {*old, *over[: max(len(over) - _KEPT, 0)]}:
            del self._jobs[job.id]


def harmless_name(name: str) -> str:
    """Remove characters from a file name that have a meaning in paths or shells."""
    bare = re.split(r"[/\\]", name)[-1]
    name = re.sub(r"[^\w.+\- ()]", "_", bare).lstrip(".")[-100:]
    # a file system counts bytes, up to 255
    return name.encode()[-255:].decode(errors="ignore") or "file"
