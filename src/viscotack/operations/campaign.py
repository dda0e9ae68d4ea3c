"""The operations ``campaign ...``: many problems, a plan, a folder that survives every stop."""

from collections import Counter
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np

from viscotack.errors import InputError

from .declare.answer import Answer, Caller, Output, csv_file
from .declare.cards import Choice, File, Folder, Number, Switch, Text, Whole
from .declare.options import Operation, Part
from .declare.statement import INDENTERS, Stated, Statement

if TYPE_CHECKING:
    from viscotack.campaign import Plan, Progress

_COLUMNS = "a CSV file with the columns tabor, modulus_ratio, exponent, preload and rate, as for"
_OF_FOLDERS = {"http": "a campaign lives in a folder of the machine that runs it"}
_OF_PLANS = {"http": "a plan names other files, and Python files that are executed"}
# Exit status of a run that was ended, and of one that has nothing left to do but failed cases.
_STOPPED, _SOME_FAILED = 1, 4

AtTemperature = Annotated[
    float | None,
    Number(
        'Of the material of the base problem, from a passport, "0 degC".', unit="K", metavar="T"
    ),
]
AFolder = Annotated[Path, Folder("The folder of a campaign.", metavar="DIR", argument=True)]


@dataclass(frozen=True, kw_only=True)
class Inputs(Operation):
    """Say which numbers of a problem a plan may set, by which names, and what they are now.

    Example: viscotack campaign inputs pad.toml
    """

    word: ClassVar = "campaign inputs"
    takes_own: ClassVar = True

    problem: Annotated[
        Statement,
        Stated("A problem in SI.", indenters=INDENTERS, spelling="case"),
    ]

    def answer(self, caller: Caller) -> Answer:
        """List the numbers of the problem by their paths."""
        from viscotack.campaign import inputs_of

        found = inputs_of(self.problem.problem)
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


@dataclass(frozen=True, kw_only=True)
class DescribePlan(Operation):
    """Say what a plan stands for, without running it.

    Example: viscotack campaign plan study.toml --csv cases.csv
    """

    word: ClassVar = "campaign plan"
    outputs: ClassVar = (csv_file("Write the cases as a table; - is standard output."),)
    takes_own: ClassVar = True
    refused: ClassVar = _OF_PLANS

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
        from viscotack.campaign.store import table_of_cases

        plan = read_plan(self.plan, own=caller.own, temperature=self.temperature)

        def write(target: Any) -> None:
            export(table_of_cases(plan.cases).drop_columns("name"), target)

        return Answer(
            plan,
            record=lambda: _plan_record(plan),
            words=lambda: _plan_words(plan),
            files={"csv": write},
        )


def _ranges(plan: "Plan") -> dict[str, list[float]]:
    return {
        name: [float(np.nanmin(values)), float(np.nanmax(values))]
        for name, values in plan.cases.columns.items()
    }


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
            f"{len(plan.cases)} cases of kind {plan.kind.name}; {plan.rejected} points are no "
            f"contacts and are left out, {plan.repeated} are stated more than once and run once",
            *([f"  left out, for one: {plan.refusal}"] if plan.rejected else []),
            *(
                f"  {name:<24}{low:>12.5g} to {high:.5g}"
                for name, (low, high) in _ranges(plan).items()
            ),
            f"  to {limits.until}, accuracy {limits.accuracy:g}; at most {limits.time_limit:g} s "
            f"and {limits.memory_limit / 1e6:g} MB a case",
        ]
    )


@dataclass(frozen=True, kw_only=True)
class Settings(Part):
    """What is said in place of the settings of a plan; the fields of `CaseSettings` hold ranges."""

    table: ClassVar = "settings"

    accuracy: Annotated[
        float | None,
        Number(
            "Accuracy wanted of the pull-off force, in place of the plan's.", metavar="RELATIVE"
        ),
    ] = None
    until: Annotated[
        str | None,
        Choice(
            "How far to pull, in place of the plan's; pull-off if nobody says.",
            metavar="pull-off|detached",
            choices=("pull-off", "detached"),
        ),
    ] = None
    time_limit: Annotated[
        float | None,
        Number(
            'Longest time of a case, "10 min", in place of the plan\'s.', unit="s", metavar="TIME"
        ),
    ] = None
    memory_limit: Annotated[
        float | None,
        Number(
            'Most memory of a case beside its worker, "400 MB", in place of the plan\'s.',
            unit="byte",
            metavar="MEMORY",
        ),
    ] = None


@dataclass(frozen=True, kw_only=True)
class Run(Operation):
    """Run the cases of a plan that are not in the folder yet.

    It may be stopped at any time and goes on when called again; ctrl-C finishes the cases in
    flight, a second one does not. Exit status 0: all cases have a result; 1: stopped before; 4:
    nothing is left to be done, and some cases failed, for which viscotack campaign status says why.

    Example: viscotack campaign run cases.csv --out study --workers 2
    """

    word: ClassVar = "campaign run"
    takes_own: ClassVar = True
    refused: ClassVar = _OF_FOLDERS

    plan: Annotated[
        Path | None,
        File(
            f"A plan in TOML, or {_COLUMNS} simulate sphere. Leave it out to go on with what is in "
            "DIR.",
            metavar="[PLAN]",
            argument=True,
        ),
    ] = None
    out: Annotated[
        Path | None,
        Folder(
            "Folder that keeps the campaign; made if missing. What is in it is not run again.",
            metavar="DIR",
        ),
    ] = None
    workers: Annotated[
        int, Whole("Processes on this machine, one thread each.", metavar="N", least=1)
    ] = 1
    scheduler: Annotated[
        str | None,
        Text(
            'A Dask scheduler, "tcp://host:8786": its workers do the cases instead.',
            metavar="ADDRESS",
        ),
    ] = None
    tls_ca: Annotated[
        Path | None,
        File(
            "For a scheduler at tls://host:8786: the authority that both ends trust, in PEM.",
            metavar="FILE",
        ),
    ] = None
    tls_cert: Annotated[Path | None, File("The certificate of this end.", metavar="FILE")] = None
    tls_key: Annotated[Path | None, File("The key of that certificate.", metavar="FILE")] = None
    shard: Annotated[
        str | None,
        Text(
            "Only the K-th of N parts of the plan, for the job arrays of a batch system; viscotack "
            "campaign merge makes one folder of all.",
            metavar="K/N",
        ),
    ] = None
    settings: Settings = field(default_factory=Settings)
    temperature: AtTemperature = None
    retry: Annotated[bool, Switch("Run the cases that failed for a lasting reason once more.")] = (
        False
    )

    def __post_init__(self) -> None:
        if self.out is None:
            raise InputError("--out is missing: the folder that keeps the campaign")
        if self.plan is None and self.shard is not None:
            raise InputError("--shard is of a plan: give the plan")

    def answer(self, caller: Caller) -> Answer:
        """Run what is missing; says on the way how far it is."""
        from viscotack.campaign import AllCrashed, NoWorker, run
        from viscotack.campaign.cluster import security_of

        assert self.out is not None
        security = security_of(self.tls_ca, self.tls_cert, self.tls_key)
        plan = self._plan(caller)
        try:
            end = run(
                plan,
                self.out,
                own=caller.own,
                workers=self.workers,
                scheduler=self.scheduler,
                security=security,
                retry=self.retry,
                report=lambda now: caller.tell(_told(now)),
            )
        except (KeyboardInterrupt, AllCrashed, NoWorker) as error:
            return _ended(self.out, error)
        status = _STOPPED if end.stopped else _SOME_FAILED if end.failed else 0
        return replace(_standing(self.out, end), status=status)

    def _plan(self, caller: Caller) -> "Plan | None":
        """Return the plan, of which only a shard may be wanted; None for that of the folder."""
        from viscotack.campaign import read_plan, shard_of

        changed = asdict(self.settings) | {"temperature": self.temperature}
        if self.plan is None:
            if any(value is not None for value in changed.values()):
                raise InputError("settings are those of the folder; give the plan to change limits")
            return None
        plan = read_plan(self.plan, own=caller.own, **changed)
        return plan if self.shard is None else shard_of(plan, self.shard)


@dataclass(frozen=True, kw_only=True)
class Status(Operation):
    """Say how far a campaign is, and why cases failed; also while it runs.

    Example: viscotack campaign status study
    """

    word: ClassVar = "campaign status"
    refused: ClassVar = _OF_FOLDERS

    folder: AFolder

    def answer(self, caller: Caller) -> Answer:
        """Count what is stored."""
        from viscotack.campaign import Store

        store = Store(self.folder)
        return _standing(self.folder, _progress(store), store.reasons())


@dataclass(frozen=True, kw_only=True)
class Verify(Operation):
    """Say whether what is stored is what was written: every file, every row, each once.

    Exit status 0: it is; 1: it is not, and what is wrong is named. Nothing is changed.

    Example: viscotack campaign verify study
    """

    word: ClassVar = "campaign verify"
    refused: ClassVar = _OF_FOLDERS

    folder: AFolder

    def answer(self, caller: Caller) -> Answer:
        """Read all files and compare them with their hashes."""
        from viscotack.campaign import Store, verify

        verdict = verify(Store(self.folder))
        return Answer(
            verdict,
            record=lambda: asdict(verdict),
            words=lambda: _verdict_words(verdict),
            status=int(bool(verdict.wrong)),
        )


def _verdict_words(verdict: Any) -> str:
    end = "something is wrong" if verdict.wrong else "all as it was written"
    return "\n".join(
        [
            *(f"wrong: {words}" for words in verdict.wrong),
            *(f"not of this campaign, and not read: {words}" for words in verdict.strange),
            f"{verdict.rows} rows in {verdict.files} files: {end}",
        ]
    )


@dataclass(frozen=True, kw_only=True)
class Merge(Operation):
    """Make one campaign of several, such as the shards of one plan.

    Each is verified before; they must be of one kind, accuracy and version of viscotack.

    Example: viscotack campaign merge shard-1 shard-2 --out study
    """

    word: ClassVar = "campaign merge"
    refused: ClassVar = _OF_FOLDERS

    folders: Annotated[
        tuple[Path, ...], Folder("Folders of campaigns.", metavar="DIR...", argument=True)
    ]
    out: Annotated[Path | None, Folder("Folder that is to hold all of them.", metavar="DIR")] = None

    def __post_init__(self) -> None:
        if self.out is None:
            raise InputError("--out is missing: the folder that is to hold all of them")

    def answer(self, caller: Caller) -> Answer:
        """Verify and merge."""
        from viscotack.campaign import merge

        assert self.out is not None
        return _standing(self.out, _progress(merge(self.folders, self.out)))


@dataclass(frozen=True, kw_only=True)
class Export(Operation):
    """Write the results as a table: inputs, pull-off force, work, error estimate and the rest.

    Rows come in the order of the plan. A case that failed is not among them.

    Example: viscotack campaign export study --csv study.csv
    """

    word: ClassVar = "campaign export"
    outputs: ClassVar = (
        Output("csv", "Write a table; - is standard output.", ending=".csv"),
        Output("parquet", "Write a Parquet file.", "binary", ending=".parquet"),
        Output("mat", "Write a MATLAB file.", "binary", ending=".mat"),
        Output("failures", "Write the failures, as a .csv table."),
    )
    refused: ClassVar = _OF_FOLDERS

    folder: AFolder
    trajectories: Annotated[
        bool,
        Switch("Write the 24 points of each curve to the CSV file as well; the others have them."),
    ] = False

    def answer(self, caller: Caller) -> Answer:
        """Open the folder; tables are made as they are written."""
        from viscotack.campaign import Store, export

        if not caller.wants:
            raise InputError("say what to write: --csv, --parquet, --mat or --failures FILE")
        store = Store(self.folder)

        def results(target: Any, trajectories: bool = True) -> None:
            with store.ordered_results() as table:
                export(table, target, trajectories=trajectories)

        def failures(target: Any) -> None:
            with store.ordered_failures() as table:
                export(table, target)

        files = {
            "csv": lambda target: results(target, self.trajectories),
            "parquet": results,
            "mat": results,
            "failures": failures,
        }
        return replace(_standing(self.folder, _progress(store)), files=files)


def _progress(store: Any) -> "Progress":
    """Return how many cases of a folder have a result or have failed."""
    from viscotack.campaign import Progress

    standing = store.standing(store.cases())
    return Progress(len(standing.done), int(standing.done.sum()), int(standing.failed.sum()))


def _standing(
    folder: Path, now: "Progress", reasons: Counter[tuple[str, str]] | None = None
) -> Answer:
    """Return the answer how far a campaign is."""
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
            "peak_memory_bytes": now.peak_memory,
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
            f"{100 * now.worker_use:.0f} % of the time, {now.peak_memory / 1e6:.0f} MB at most each"
        )
    for why in record.get("failures", ()):
        lines.append(f"  {why['cases']:6d} {why['failure']}: {why['reason']}")
    if left:
        lines.append(f"  go on with: viscotack campaign run --out {folder}")
    return "\n".join(lines)


def _ended(folder: Path, error: BaseException) -> Answer:
    """Return the answer of a run that did not come to an end of its own."""
    why = str(error) or "ended at once"
    return Answer(
        error,
        record=lambda: {"stopped": True, "reason": why},
        words=lambda: "",
        notes=(f"viscotack: {why}; what is stored in {folder} is safe",),
        status=_STOPPED,
    )


def _told(now: "Progress") -> dict[str, Any]:
    """Return what a run tells of itself."""
    share = (now.done + now.failed) / now.cases
    return {"share": share, "words": _progress_words(now), "urgent": now.stopped}


def _progress_words(now: "Progress") -> str:
    text = f"{now.done} of {now.cases} stored, {now.failed} failed, {now.rate:.1f} cases/s"
    if now.remaining_s is not None:
        minutes, seconds = divmod(round(now.remaining_s), 60)
        text += f", about {minutes} min {seconds:02d} s left"
    return text + ("; finishing the cases in flight" if now.stopped else "")
