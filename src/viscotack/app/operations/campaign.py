"""The operations ``campaign ...``: run many problems by a plan, resumable, stored in a folder."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from viscotack.errors import InputError

from .options import binary_file, case, csv_file, file_name, input_file, number, option, switch
from .parts.record_words import read
from .request import Answer, Caller, Request

if TYPE_CHECKING:
    from viscotack.campaign import Plan, Progress, Store

_PLAN = "A plan in TOML, or a table whose columns are flags of simulate sphere"
_OF_FOLDERS = "a campaign is stored in a folder of the machine that runs it"
_OF_PLANS = "a plan names other files, and Python files that are executed"
# Exit status of an interrupted run, and of a complete run with failed cases.
_STOPPED, _SOME_FAILED = 1, 4


class Inputs(Request):
    """List the numbers of a problem that a plan can set, with their names and current values.

    Example: viscotack campaign inputs pad.toml
    """

    word: ClassVar = "campaign inputs"
    takes_own: ClassVar = True

    problem: Any = case("A problem in SI, or a rough surface.", rough=True)

    def answer(self, caller: Caller) -> Answer:
        """List the numbers of the problem by path."""
        from viscotack.campaign import inputs_of

        found = inputs_of(self.stated(caller).problem)
        paths = {"value": "value", "unit": "unit"}
        record = {each.path: read(each, **paths, words="card.words") for each in found.values()}
        rows = [read(x, name="path", **paths, meaning="card.words") for x in found.values()]
        return Answer(found, data=record, words={"numbers": rows})


class DescribePlan(Request):
    """Describe the cases and settings of a plan without running it.

    Example: viscotack campaign plan study.toml --csv cases.csv
    """

    word: ClassVar = "campaign plan"
    outputs: ClassVar = (csv_file("Write the cases as a table."),)
    takes_own: ClassVar = True
    local: ClassVar = _OF_PLANS

    plan: Path = input_file(f"{_PLAN}; docs/campaigns.md describes both.", "PLAN")

    def answer(self, caller: Caller) -> Answer:
        """Read the plan and count its cases."""
        from viscotack.campaign import export, read_plan

        plan = read_plan(caller.file(self.plan), own=caller.own)
        rows, limits = [case.inputs for case in plan.cases], plan.settings
        columns = {name: [row[name] for row in rows if name in row] for name in plan.kind.inputs}
        ranges = {name: [min(x), max(x)] for name, x in columns.items() if x}
        record = {"kind": plan.kind.name, "cases": len(rows)}
        record |= read(plan, "rejected", "refusal", "repeated")
        record |= read(limits, "accuracy", "until", "time_limit_s")
        record |= {"memory_limit_bytes": limits.memory_limit, "ranges": ranges}
        return Answer(plan, data=record, files={"csv": lambda target: export(rows, target)})


class Settings(Request):
    """Options that replace the settings of a plan; `CaseSettings` checks their ranges."""

    accuracy: float | None = number("Relative error of the pull-off force.")
    until: Literal["pull-off", "detached"] | None = option("End of each case.")
    time_limit: float | None = number('Longest wall time of a case, "10 min".', "s")
    memory_limit: float | None = number('Most memory of a case, "400 MB".', "byte")


class Run(Settings):
    """Run the cases of a plan that have no result in the folder yet.

    An interrupted run resumes when called again. The first ctrl-C lets running cases finish, a
    second one stops immediately. Accuracy, end and limits replace those of the plan. Exit status
    0: all cases have a result; 1: interrupted; 4: all cases were run and some failed; viscotack
    campaign status lists the reasons.

    Example: viscotack campaign run cases.csv --out study --workers 2
    """

    word: ClassVar = "campaign run"
    takes_own: ClassVar = True
    local: ClassVar = _OF_FOLDERS

    plan: Path | None = file_name(
        f"{_PLAN}. Without it the plan in DIR is resumed.", metavar="PLAN", argument=True
    )
    out: Path = file_name("Folder of the campaign; created if missing.", metavar="DIR", default=...)
    workers: int = option("Processes on this machine, one thread each.", default=1, ge=1)
    scheduler: str | None = option('A Dask scheduler with workers, "tcp://host:8786".')
    shard: str | None = option(
        "Part of the plan, for a job array; campaign merge combines them.", metavar="K/N"
    )
    retry: bool = switch("Also repeat the cases that failed before.")

    def answer(self, caller: Caller) -> Answer:
        """Run the missing cases and report progress."""
        from viscotack.campaign import CannotRun, Dask, run

        out, plan = caller.file(self.out), self._plan(caller)

        def report(now: "Progress") -> None:
            ended = now.done + now.failed
            words = f"{now.done} of {now.cases} stored, {now.failed} failed"
            if now.rate:
                minutes, seconds = divmod(round((now.cases - ended) / now.rate), 60)
                words += f", {now.rate:.1f} cases/s, about {minutes} min {seconds:02d} s left"
            words += "; finishing the running cases" if now.stopped else ""
            caller.tell({"share": ended / now.cases, "words": words, "urgent": now.stopped})

        how: dict[str, Any] = {"own": caller.own, "retry": self.retry, "report": report}
        try:
            if self.scheduler is None:
                end = run(plan, out, workers=self.workers, **how)
            else:
                with Dask(self.scheduler) as dask:
                    end = run(plan, out, workers=dask.threads, executor=dask, **how)
        except (KeyboardInterrupt, CannotRun) as error:
            why = str(error) or "interrupted"
            return Answer(
                error,
                data={"stopped": True, "reason": why},
                words="",
                notes=(f"viscotack: {why}; the stored rows in {out} are safe",),
                status=_STOPPED,
            )
        status = _STOPPED if end.stopped else _SOME_FAILED if end.failed else 0
        return replace(_standing(out, end), status=status)

    def _plan(self, caller: Caller) -> "Plan | None":
        """Return the plan or its shard; None for the plan in the folder."""
        from viscotack.campaign import read_plan, shard_of

        changed = self.values(*Settings.model_fields)
        if self.plan is None:
            for name, value in (changed | {"shard": self.shard}).items():
                if value is not None:
                    raise InputError(f"`{name}` needs the plan; give its file", field=name)
            return None
        plan = read_plan(caller.file(self.plan), own=caller.own, **changed)
        return plan if self.shard is None else shard_of(plan, self.shard)


class Status(Request):
    """Show the progress of a campaign and the reasons of failures, also while it runs.

    Example: viscotack campaign status study
    """

    word: ClassVar = "campaign status"
    local: ClassVar = _OF_FOLDERS

    folder: Path = input_file("The folder of a campaign.", "DIR")

    def answer(self, caller: Caller) -> Answer:
        """Count the stored results and failures."""
        from viscotack.campaign import Store

        store = Store(folder := caller.file(self.folder))
        failures = [
            {"failure": kind, "reason": reason, "cases": count}
            for (kind, reason), count in store.reasons().most_common()
        ]
        return _standing(folder, store, failures=failures)


class Merge(Request):
    """Merge several campaigns, such as the shards of one plan, into one.

    Kind, accuracy and version of viscotack must be the same.

    Example: viscotack campaign merge shard-1 shard-2 --out study
    """

    word: ClassVar = "campaign merge"
    local: ClassVar = _OF_FOLDERS

    folders: tuple[Path, ...] = input_file("Folders of campaigns.", "DIR...")
    out: Path = file_name("Folder of the merged campaign.", metavar="DIR", default=...)

    def answer(self, caller: Caller) -> Answer:
        """Merge the campaigns."""
        from viscotack.campaign import merge

        out = caller.file(self.out)
        return _standing(out, merge([caller.file(each) for each in self.folders], out))


class Export(Request):
    """Export the results as a table: inputs, pull-off force, work, error estimate and others.

    Rows are in the order of the plan. Failed cases are not included.

    Example: viscotack campaign export study --csv study.csv
    """

    word: ClassVar = "campaign export"
    outputs: ClassVar = (
        csv_file(),
        binary_file("parquet", "Write a Parquet file.", ".parquet"),
        csv_file("Write the failures.", "failures"),
    )
    local: ClassVar = _OF_FOLDERS

    folder: Path = input_file("The folder of a campaign.", "DIR")
    trajectories: bool = switch("Write the points of each curve to CSV too.")

    def answer(self, caller: Caller) -> Answer:
        """Open the folder; tables are created while they are written."""
        from viscotack.campaign import Store, export

        if not caller.wants:
            raise InputError("no output; give csv, parquet or failures FILE")
        store = Store(folder := caller.file(self.folder))
        results = store.results()
        files = {
            "csv": lambda target: export(results, target, trajectories=self.trajectories),
            "failures": lambda target: export(store.failures(), target),
            "parquet": lambda target: export(results, target),
        }
        return replace(_standing(folder, store), files=files)


def _standing(folder: Path, of: "Progress | Store", **more: Any) -> Answer:
    """Build the answer with the progress of a run, or of a stored campaign."""
    from viscotack.campaign import Progress

    now = of if isinstance(of, Progress) else Progress(*of.counts())
    left = now.cases - now.done - now.failed
    record = {"cases": now.cases, "done": now.done, "failed": now.failed, "left": left}
    if now.elapsed_s:
        more |= {"elapsed_s": now.elapsed_s, "cases_per_second": now.rate, "stopped": now.stopped}
    words = [f"{now.done} of {now.cases} cases done, {now.failed} failed, {left} left"]
    if left:
        words.append(f"  resume with: viscotack campaign run --out {folder}")
    return Answer(now, data=record | more, words={"words": words} | more)
