"""The engine of page and API: tasks, limits and running jobs.

It belongs to one event loop. All computations run in the processes of :mod:`.lane`.
"""

import asyncio
import secrets
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, Field, PrivateAttr

from viscotack.app.operations.request import Request, harmless_name
from viscotack.errors import InputError

from . import page
from .lane import Defect, Lane, run_request, warm

# Largest number of finished jobs, and of sent files, that are kept.
_KEPT = 64
# Interval between two looks at a job [s].
_LOOK = 0.05


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


class TooMany(InputError):
    """The queue of jobs is full."""


class Unknown(InputError):
    """No job, or no files, have this id."""


class Job(BaseModel):
    """State of a job; its id is known only to the client that started it."""

    id: str
    kind: str
    state: Literal["queued", "running", "done", "refused", "failed", "cancelled"] = "queued"
    share: Annotated[float, Field(ge=0, le=1, description="Done share of the work.")] = 0.0
    points: Annotated[
        list[list[float | None]],
        Field(
            description="Of the growing curve, from `points_from` on: time, depth, force, contact "
            "radius; in SI where the problem is."
        ),
    ] = []
    points_from: int = 0
    error: Annotated[str, Field(description="Why there is no answer; empty else.")] = ""
    field: Annotated[str, Field(description="The option that the error names; empty else.")] = ""
    answer: Annotated[
        dict[str, Any] | None,
        Field(description="The record of the operation, as its command prints it with --json."),
    ] = None

    _task: asyncio.Task[None] | None = PrivateAttr(None)

    def since(self, point: int, *, whole: bool = True) -> Self:
        """Return the state with the points from one on, and perhaps without the answer."""
        answer = self.answer if whole else None
        news = {"points": self.points[point:], "points_from": point, "answer": answer}
        return self.model_copy(update=news)

    @property
    def over(self) -> bool:
        """Whether nothing more will come of it."""
        return self.state not in ("queued", "running")

    def tell(self, told: dict[str, Any]) -> None:
        """Store a progress message of the task."""
        self.share = min(max(self.share, told.get("share", 0.0)), 1.0)
        self.points += told.get("points", [])

    async def news(self, points: int, seconds: float) -> None:
        """Wait for news beyond these points, so long at most."""
        known, until = (self.state, self.share, points), monotonic() + seconds
        while not self.over and monotonic() < until:
            if known != (self.state, self.share, len(self.points)):
                break
            await asyncio.sleep(_LOOK)

    def close(self, state: Any, *, answer: Any = None, error: str = "") -> None:
        """Store the outcome."""
        self.state, self.error, self.answer = state, error, answer
        self.share = self.share if answer is None else 1.0


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
        self._uploads: dict[str, TemporaryDirectory[str]] = {}
        self._nothing = TemporaryDirectory(prefix="viscotack-")
        self._lanes: dict[str, Lane] = {}

    async def begin(self) -> None:
        """Start a process of each lane, so that no simulation holds up a slider."""
        self._lanes = {
            "page": Lane(2, page.warm, self._own),
            "ask": Lane(2, warm, self._own, nice=4),
            "work": Lane(self.limits.workers, warm, self._own, nice=2),
        }
        for lane in self._lanes.values():
            lane.begin()

    async def end(self) -> None:
        """End all jobs and all processes, and delete the files that were sent."""
        await asyncio.gather(*(self._stop(job) for job in self._jobs.values()))
        for lane in self._lanes.values():
            lane.end()
        for folder in (self._nothing, *self._uploads.values()):
            folder.cleanup()

    async def ask(
        self, asked: Request, outputs: Sequence[str] = (), files: str = "", lane: str = "ask"
    ) -> dict[str, Any]:
        """Return the answer of a request."""
        run, given = self._lanes[lane].run, (asked, tuple(outputs), self._folder(files))
        return await run(run_request, *given, seconds=self.limits.ask_time)

    def keep(self, files: Iterable[tuple[str, bytes]]) -> str:
        """Keep files that were sent, and return the name by which requests refer to them."""
        self._forget()
        folder = TemporaryDirectory(prefix="viscotack-")
        for name, content in files:
            path = Path(folder.name, harmless_name(name))
            if path.exists():
                folder.cleanup()
                raise InputError(f"two files are called {path.name}; rename one")
            path.write_bytes(content)
        id = secrets.token_urlsafe(16)
        self._uploads[id] = folder
        return id

    def _folder(self, files: str) -> str:
        """Return the folder of files that were sent, an empty one without."""
        if not files:
            return self._nothing.name
        if files not in self._uploads:
            raise Unknown("there are no such files; they have expired, send them again")
        self._uploads[files] = self._uploads.pop(files)  # the last used is the last
        return self._uploads[files].name

    def start(self, asked: Request, outputs: Sequence[str], files: str) -> Job:
        """Return a job that has been put in the queue; TooMany where it is full."""
        self._forget()
        waiting = sum(not job.over for job in self._jobs.values())
        if waiting >= self.limits.jobs:
            raise TooMany(
                f"{waiting} jobs are waiting or running, the limit of this server; cancel one, or "
                "try again later"
            )
        given = asked, tuple(outputs), self._folder(files)
        job = Job(id=secrets.token_urlsafe(16), kind=asked.word)
        self._jobs[job.id] = job
        job._task = asyncio.get_running_loop().create_task(self._run(job, given))
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

    async def _run(self, job: Job, given: tuple[Request, tuple[str, ...], str]) -> None:
        def begun() -> None:
            job.state = "running"

        lane, how = self._lanes["work"], {"told": job.tell, "begun": begun}
        try:
            answer = await lane.run(run_request, *given, seconds=self.limits.job_time, **how)
            job.close("done", answer=answer)
        except InputError as error:
            job.field = error.field
            job.close("refused", error=str(error))
        except Defect as error:
            job.close("failed", error=f"this is a defect of viscotack: {error}")

    async def _stop(self, job: Job) -> None:
        """End a job, and wait until its process is free."""
        if job._task is not None:
            job._task.cancel()
            await asyncio.wait([job._task])
        if not job.over:
            job.close("cancelled", error="it was cancelled")

    def _forget(self) -> None:
        """Forget the oldest of many jobs and files."""
        over = [job.id for job in self._jobs.values() if job.over]
        for id in over[:-_KEPT]:
            del self._jobs[id]
        if len(over) < len(self._jobs):
            return  # one may still read its files
        for id in [*self._uploads][:-_KEPT]:
            self._uploads.pop(id).cleanup()
