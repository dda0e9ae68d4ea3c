"""The operations ``campaign ...``: run many problems by a plan, resumable, stored in a folder."""

from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import Field

from viscotack.errors import InputError
from viscotack.files.bounded import note_read

from .flags import INDENTERS
from .request import Answer, Caller, Contact, File, Number, Option, Output, Request

if TYPE_CHECKING:
    from viscotack.campaign import Plan, Progress

_COLUMNS = "a CSV file with the columns tabor, modulus_ratio, exponent, preload and rate, as for"
_OF_FOLDERS = "a campaign is stored in a folder of the machine that runs it"
_OF_PLANS = "a plan names other files, and Python files that are executed"
# Exit status of an interrupted run, and of a complete run with failed cases.
_STOPPED, _SOME_FAILED = 1, 4

AtTemperature = Annotated[
    float | None,
    Number(
        'Temperature of the base problem\'s material (a passport), "0 degC".', unit="K", metavar="T"
    ),
]
AFolder = Annotated[Path, File("The folder of a campaign.", metavar="DIR", argument=True)]


class Inputs(Request):
    """List the numbers of a problem that a plan can set, with their names and current values.

    Example: viscotack campaign inputs pad.toml
    """

    word: ClassVar = "campaign inputs"
    takes_own: ClassVar = True

    problem: Annotated[
        Any,
        Contact(
            "A problem in SI, or a rough surface.",
            indenters=INDENTERS,
            spelling="case",
            rough=True,
        ),
    ]

    def answer(self, caller: Caller) -> Answer:
        """List the numbers of the problem by path."""
        from viscotack.campaign import inputs_of

        found = inputs_of(self.stated(caller).problem)
        return Answer(
            found,
            record=lambda: {
                entry.path: {"value": entry.value, "unit": entry.unit, "words": entry.card.words}
                for entry in found.values()
            },
            words=lambda: "\n".join(_input_words(entry) for entry in found.values()),
        )


def _input_words(entry: Any) -> str:
    value = "" if entry.value is None else f"{entry.value:.6g}"
    return f"{entry.path:<30}{value:>14} {entry.unit:<10} {entry.card.words}"


class DescribePlan(Request):
    """Describe the cases and settings of a plan without running it.

    Example: viscotack campaign plan study.toml --csv cases.csv
    """

    word: ClassVar = "campaign plan"
    outputs: ClassVar = (
        Output("csv", "Write the cases as a table; - is standard output.", endings=(".csv",)),
    )
    takes_own: ClassVar = True
    local: ClassVar = _OF_PLANS

    plan: Annotated[
        Path,
        File(
            f"A plan in TOML, or {_COLUMNS} simulate sphere; docs/campaigns.md describes both.",
            metavar="PLAN",
            argument=True,
        ),
    ]
    temperature: AtTemperature = None

    def answer(self, caller: Caller) -> Answer:
        """Read the plan and count its cases."""
        from viscotack.campaign import export, read_plan

        plan = read_plan(caller.file(self.plan), own=caller.own, temperature=self.temperature)

        def write(target: Any) -> None:
            export([case.inputs for case in plan.cases], target)

        return Answer(
            plan,
            record=lambda: _plan_record(plan),
            words=lambda: _plan_words(plan),
            files={"csv": write},
        )


def _ranges(plan: "Plan") -> dict[str, list[float]]:
    found: dict[str, list[float]] = {}
    for case in plan.cases:
        for name, value in case.inputs.items():
            low, high = found.get(name, (value, value))
            found[name] = [min(low, value), max(high, value)]
    return found


def _plan_record(plan: "Plan") -> dict[str, Any]:
    return {
        "kind": plan.kind.name,
        "cases": len(plan.cases),
        "rejected": plan.rejected,
        "refusal": plan.refusal,
        "repeated": plan.repeated,
        "accuracy": plan.settings.accuracy,
        "until": plan.settings.until,
        "time_limit_s": plan.settings.time_limit,
        "memory_limit_bytes": plan.settings.memory_limit,
        "ranges": _ranges(plan),
    }


def _plan_words(plan: "Plan") -> str:
    limits = plan.settings
    return "\n".join(
        [
            f"{len(plan.cases)} cases of kind {plan.kind.name}; {plan.rejected} points without a "
            f"contact are skipped, {plan.repeated} repeated cases are run once",
            *([f"  first skipped point: {plan.refusal}"] if plan.rejected else []),
            *(
                f"  {name:<24}{low:>12.5g} to {high:.5g}"
                for name, (low, high) in _ranges(plan).items()
            ),
            f"  to {limits.until}, accuracy {limits.accuracy:g}; limits per case: "
            f"{limits.time_limit:g} s, {limits.memory_limit / 1e6:g} MB",
        ]
    )


class Settings(Request):
    """Options that replace the settings of a plan; `CaseSettings` checks their ranges."""

    accuracy: Annotated[
        float | None,
        Number("Relative error of the pull-off force; replaces the plan's.", metavar="RELATIVE"),
    ] = None
    until: Annotated[
        Literal["pull-off", "detached"] | None,
        Option(
            "End of each case; replaces the plan's. Default: pull-off.",
            metavar="pull-off|detached",
        ),
    ] = None
    time_limit: Annotated[
        float | None,
        Number(
            'Longest wall time of a case, "10 min"; replaces the plan\'s.', unit="s", metavar="TIME"
        ),
    ] = None
    memory_limit: Annotated[
        float | None,
        Number(
            'Memory limit per case, "400 MB"; replaces the plan\'s.',
            unit="byte",
            metavar="MEMORY",
        ),
    ] = None


class Run(Settings):
    """Run the cases of a plan that have no result in the folder yet.

    An interrupted run resumes when called again. The first ctrl-C lets running cases finish, a
    second one stops immediately. Exit status 0: all cases have a result; 1: interrupted; 4: all
    cases were run and some failed; viscotack campaign status lists the reasons.

    Example: viscotack campaign run cases.csv --out study --workers 2
    """

    word: ClassVar = "campaign run"
    takes_own: ClassVar = True
    local: ClassVar = _OF_FOLDERS

    plan: Annotated[
        Path | None,
        File(
            f"A plan in TOML, or {_COLUMNS} simulate sphere. Without it the plan in DIR is "
            "resumed.",
            metavar="[PLAN]",
            argument=True,
        ),
    ] = None
    out: Annotated[
        Path,
        File(
            "Folder of the campaign; created if missing. Cases with a result are not repeated.",
            metavar="DIR",
        ),
    ]
    workers: Annotated[
        int, Option("Processes on this machine, one thread each.", metavar="N"), Field(ge=1)
    ] = 1
    scheduler: Annotated[
        str | None,
        Option(
            'A Dask scheduler, "tcp://host:8786", whose workers run the cases.',
            metavar="ADDRESS",
        ),
    ] = None
    tls_ca: Annotated[
        Path | None,
        File(
            "CA certificate (PEM) for a scheduler at tls://host:8786.",
            metavar="FILE",
        ),
    ] = None
    tls_cert: Annotated[Path | None, File("Client certificate (PEM).", metavar="FILE")] = None
    tls_key: Annotated[Path | None, File("Key of the client certificate.", metavar="FILE")] = None
    shard: Annotated[
        str | None,
        Option(
            "Run only part K of N of the plan, for job arrays of a batch system; viscotack "
            "campaign merge combines the folders.",
            metavar="K/N",
        ),
    ] = None
    temperature: AtTemperature = None
    retry: Annotated[bool, Option("Also repeat the cases that failed before.")] = False

    def check(self) -> None:
        """Refuse options that exclude each other."""
        if self.plan is None and self.shard is not None:
            raise InputError("shard needs the plan; give its file")

    def answer(self, caller: Caller) -> Answer:
        """Run the missing cases and report progress."""
        from viscotack.campaign import AllCrashed, Dask, NoWorker, run

        out = _folder(self.out, caller)
        plan, options = self._plan(caller), {"own": caller.own, "retry": self.retry}
        options["report"] = lambda now: caller.tell(_told(now))
        try:
            if self.scheduler is None:
                end = run(plan, out, workers=self.workers, **options)
            else:
                with Dask(self.scheduler, self._tls(caller)) as dask:
                    end = run(plan, out, workers=dask.threads, executor=dask, **options)
        except (KeyboardInterrupt, AllCrashed, NoWorker) as error:
            return _ended(out, error)
        status = _STOPPED if end.stopped else _SOME_FAILED if end.failed else 0
        return replace(_standing(out, end), status=status)

    def _tls(self, caller: Caller) -> tuple[Path, Path, Path] | None:
        files = self.tls_ca, self.tls_cert, self.tls_key
        if any(files) and not all(files):
            raise InputError("TLS needs three files: `tls_ca`, `tls_cert` and `tls_key`")
        ca, cert, key = (None if each is None else caller.file(each) for each in files)
        return (ca, cert, key) if ca and cert and key else None

    def _plan(self, caller: Caller) -> "Plan | None":
        """Return the plan or its shard; None for the plan in the folder."""
        from viscotack.campaign import read_plan, shard_of

        changed = {name: getattr(self, name) for name in (*Settings.model_fields, "temperature")}
        if self.plan is None:
            if any(value is not None for value in changed.values()):
                raise InputError(
                    "the settings are stored in the folder; give the plan to change limits"
                )
            return None
        plan = read_plan(caller.file(self.plan), own=caller.own, **changed)
        return plan if self.shard is None else shard_of(plan, self.shard)


class Status(Request):
    """Show the progress of a campaign and the reasons of failures, also while it runs.

    Example: viscotack campaign status study
    """

    word: ClassVar = "campaign status"
    local: ClassVar = _OF_FOLDERS

    folder: AFolder

    def answer(self, caller: Caller) -> Answer:
        """Count the stored results and failures."""
        from viscotack.campaign import Store

        folder = _folder(self.folder, caller)
        store = Store(folder)
        return _standing(folder, _progress(store), store.reasons())


class Merge(Request):
    """Merge several campaigns, such as the shards of one plan, into one.

    Kind, accuracy and version of viscotack must be the same.

    Example: viscotack campaign merge shard-1 shard-2 --out study
    """

    word: ClassVar = "campaign merge"
    local: ClassVar = _OF_FOLDERS

    folders: Annotated[
        tuple[Path, ...], File("Folders of campaigns.", metavar="DIR...", argument=True)
    ]
    out: Annotated[Path, File("Folder of the merged campaign.", metavar="DIR")]

    def answer(self, caller: Caller) -> Answer:
        """Merge the campaigns."""
        from viscotack.campaign import merge

        out = _folder(self.out, caller)
        folders = tuple(_folder(each, caller) for each in self.folders)
        return _standing(out, _progress(merge(folders, out)))


class Export(Request):
    """Export the results as a table: inputs, pull-off force, work, error estimate and others.

    Rows are in the order of the plan. Failed cases are not included.

    Example: viscotack campaign export study --csv study.csv
    """

    word: ClassVar = "campaign export"
    outputs: ClassVar = (
        Output("csv", "Write a table; - is standard output.", endings=(".csv",)),
        Output("parquet", "Write a Parquet file.", "binary", endings=(".parquet",)),
        Output("mat", "Write a MATLAB file.", "binary", endings=(".mat",)),
        Output("failures", "Write the failures, as a .csv table.", endings=(".csv",)),
    )
    local: ClassVar = _OF_FOLDERS

    folder: AFolder
    trajectories: Annotated[
        bool,
        Option("Include the 24 points of each curve in the CSV file; other formats have them."),
    ] = False

    def answer(self, caller: Caller) -> Answer:
        """Open the folder; tables are created while they are written."""
        from viscotack.campaign import Store, export

        if not caller.wants:
            raise InputError("no output; give csv, parquet, mat or failures FILE")
        folder = _folder(self.folder, caller)
        store = Store(folder)
        results = store.results()
        files = {
            "csv": lambda target: export(results, target, trajectories=self.trajectories),
            "parquet": lambda target: export(results, target),
            "mat": lambda target: export(results, target),
            "failures": lambda target: export(store.failures(), target),
        }
        return replace(_standing(folder, _progress(store)), files=files)


def _folder(name: Path, caller: Caller) -> Path:
    """Return the folder of a campaign, into which no output may be written."""
    path = caller.file(name)
    note_read(path)
    return path


def _progress(store: Any) -> "Progress":
    """Count the cases of a folder with a result and with a failure."""
    from viscotack.campaign import Progress

    return Progress(*store.counts())


def _standing(
    folder: Path, now: "Progress", reasons: Counter[tuple[str, str]] | None = None
) -> Answer:
    """Build the answer with the progress of a campaign."""
    record: dict[str, Any] = {
        "cases": now.cases,
        "done": now.done,
        "failed": now.failed,
        "left": now.cases - now.done - now.failed,
    }
    if now.elapsed_s:
        record |= {
            "elapsed_s": now.elapsed_s,
            "cases_per_second": now.rate,
            "worker_use": now.worker_use,
            "stopped": now.stopped,
        }
    if reasons is not None:
        record["failures"] = [
            {"failure": kind, "reason": reason, "cases": count}
            for (kind, reason), count in reasons.most_common()
        ]
    return Answer(now, record=lambda: record, words=lambda: _standing_words(folder, now, record))


def _standing_words(folder: Path, now: "Progress", record: dict[str, Any]) -> str:
    left = record["left"]
    lines = [f"{now.done} of {now.cases} cases done, {now.failed} failed, {left} left"]
    if now.elapsed_s:
        lines.append(
            f"  {now.elapsed_s:.1f} s, {now.rate:.2f} cases/s; the workers were busy "
            f"{100 * now.worker_use:.0f} % of the time"
        )
    for why in record.get("failures", ()):
        lines.append(f"  {why['cases']:6d} {why['failure']}: {why['reason']}")
    if left:
        lines.append(f"  resume with: viscotack campaign run --out {folder}")
    return "\n".join(lines)


def _ended(folder: Path, error: BaseException) -> Answer:
    """Build the answer of an interrupted run."""
    why = str(error) or "interrupted"
    return Answer(
        error,
        record=lambda: {"stopped": True, "reason": why},
        words=lambda: "",
        notes=(f"viscotack: {why}; the stored rows in {folder} are safe",),
        status=_STOPPED,
    )


def _told(now: "Progress") -> dict[str, Any]:
    """Progress of a run as data for the caller."""
    share = (now.done + now.failed) / now.cases
    return {"share": share, "words": _progress_words(now), "urgent": now.stopped}


def _progress_words(now: "Progress") -> str:
    text = f"{now.done} of {now.cases} stored, {now.failed} failed, {now.rate:.1f} cases/s"
    if now.remaining_s is not None:
        minutes, seconds = divmod(round(now.remaining_s), 60)
        text += f", about {minutes} min {seconds:02d} s left"
    return text + ("; finishing the running cases" if now.stopped else "")
