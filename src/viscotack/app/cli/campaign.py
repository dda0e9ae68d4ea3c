"""The commands ``viscotack campaign inputs | plan | run | status | verify | merge | export``."""

import json
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from time import perf_counter
from typing import Annotated, Any

import numpy as np
import typer
from typer import Argument, Option

from viscotack.errors import InputError
from viscotack.files.text import harmless
from viscotack.files.whole import is_standard_output

from .commands import AsJson, With, application, wrong_input
from .writing import Writing, check_files

campaign = typer.Typer(
    help="Run many problems: a plan, a folder that survives every stop, a table.",
    no_args_is_help=True,
    rich_markup_mode=None,
)
application.add_typer(campaign, name="campaign")

PlanFile = Annotated[
    Path,
    Argument(
        metavar="PLAN",
        help="A plan in TOML, or a CSV file with the columns tabor, modulus_ratio, exponent, "
        "preload and rate, as for simulate sphere; docs/campaigns.md describes both.",
        show_default=False,
    ),
]
Folder = Annotated[
    Path, Argument(metavar="DIR", help="The folder of a campaign.", show_default=False)
]
AtTemperature = Annotated[
    str | None,
    Option(
        "--temperature",
        metavar="T",
        help='Of the material of the base problem, from a passport, "0 degC".',
    ),
]
# Exit status of a run that has nothing left to do, and cases without a result.
_SOME_FAILED = 4
# Seconds between two lines of progress where nobody watches a bar.
_LINES = 10.0


def _paths(own: list[Path] | None) -> tuple[str, ...] | None:
    """Return the files of the user's own as a plan keeps them."""
    return None if own is None else tuple(str(file.resolve()) for file in own)


@campaign.command("inputs")
def inputs_command(
    case_file: Annotated[
        Path, Argument(metavar="CASE.toml", help="A problem in SI.", show_default=False)
    ],
    own: With = None,
    as_json: AsJson = False,
) -> None:
    """Say which numbers of a problem a plan may set, by which names, and what they are now.

    Example: viscotack campaign inputs pad.toml
    """
    with _words_for_what_is_missing():
        from viscotack.campaign import inputs_of
        from viscotack.problem.case_file import read_case
        from viscotack.problem.nouns import own_nouns

        found = inputs_of(read_case(case_file, also=own_nouns(_paths(own) or ())))
    if as_json:
        answer = {
            entry.path: {"value": entry.value, "unit": entry.unit, "words": entry.card.words}
            for entry in found.values()
        }
        typer.echo(json.dumps(answer, indent=2))
        return
    for entry in found.values():
        value = "" if entry.value is None else f"{entry.value:.6g}"
        typer.echo(harmless(f"{entry.path:<30}{value:>14} {entry.unit:<10} {entry.card.words}"))


@campaign.command("plan")
def plan_command(
    plan_file: PlanFile,
    csv_file: Annotated[
        Path | None,
        Option("--csv", metavar="FILE", help="Write the cases as a table; - is standard output."),
    ] = None,
    temperature: AtTemperature = None,
    own: With = None,
    as_json: AsJson = False,
) -> None:
    """Say what a plan stands for, without running it.

    Example: viscotack campaign plan study.toml --csv cases.csv
    """
    with _words_for_what_is_missing():
        from viscotack.campaign import export, read_plan
        from viscotack.campaign.store import table_of_cases

        check_files({"--csv": csv_file}, as_json=as_json, reads=(plan_file,))
        plan = read_plan(plan_file, own=_paths(own), temperature=temperature)
        write = Writing()
        if csv_file is not None:
            table = table_of_cases(plan.cases).drop_columns("name")
            write("wrote", csv_file, lambda file: export(table, file))
    ranges = {
        name: [float(np.nanmin(values)), float(np.nanmax(values))]
        for name, values in plan.cases.columns.items()
    }
    answer: dict[str, Any] = {
        "kind": plan.kind.name,
        "cases": len(plan.cases),
        "rejected": plan.rejected,
        "refusal": plan.refusal,
        "repeated": plan.repeated,
        "accuracy": plan.settings.accuracy,
        "until": plan.settings.until,
        "time_limit_s": plan.settings.time_limit,
        "memory_limit_bytes": plan.settings.memory_limit,
        "ranges": ranges,
    }
    words = harmless(_plan_words(plan, ranges))
    write.answer(json.dumps(answer, indent=2) if as_json else words)
    write.end()


def _plan_words(plan: Any, ranges: dict[str, list[float]]) -> str:
    limits = plan.settings
    return "\n".join(
        [
            f"{len(plan.cases)} cases of kind {plan.kind.name}; {plan.rejected} points are no "
            f"contacts and are left out, {plan.repeated} are stated more than once and run once",
            *([f"  left out, for one: {plan.refusal}"] if plan.rejected else []),
            *(f"  {name:<24}{low:>12.5g} to {high:.5g}" for name, (low, high) in ranges.items()),
            f"  to {limits.until}, accuracy {limits.accuracy:g}; at most {limits.time_limit:g} s "
            f"and {limits.memory_limit / 1e6:g} MB a case",
        ]
    )


@campaign.command("run")
def run_command(
    plan_file: Annotated[
        Path | None,
        Argument(
            metavar="[PLAN]",
            help="A plan in TOML, or a CSV file with the columns tabor, modulus_ratio, exponent, "
            "preload and rate, as for simulate sphere. Leave it out to go on with what is in DIR.",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        Option(
            "--out",
            metavar="DIR",
            help="Folder that keeps the campaign; made if missing. What is in it is not run again.",
        ),
    ] = None,
    workers: Annotated[
        int, Option(metavar="N", help="Processes on this machine, one thread each.", min=1)
    ] = 1,
    scheduler: Annotated[
        str | None,
        Option(
            metavar="ADDRESS",
            help='A Dask scheduler, "tcp://host:8786": its workers do the cases instead.',
        ),
    ] = None,
    tls_ca: Annotated[
        Path | None,
        Option(
            "--tls-ca",
            metavar="FILE",
            help="For a scheduler at tls://host:8786: the authority that both ends trust, in PEM.",
        ),
    ] = None,
    tls_cert: Annotated[
        Path | None, Option("--tls-cert", metavar="FILE", help="The certificate of this end.")
    ] = None,
    tls_key: Annotated[
        Path | None, Option("--tls-key", metavar="FILE", help="The key of that certificate.")
    ] = None,
    shard: Annotated[
        str | None,
        Option(
            metavar="K/N",
            help="Only the K-th of N parts of the plan, for the job arrays of a batch system; "
            "viscotack campaign merge makes one folder of all.",
        ),
    ] = None,
    accuracy: Annotated[
        float | None,
        Option(
            metavar="RELATIVE",
            help="Accuracy wanted of the pull-off force, in place of the plan's.",
        ),
    ] = None,
    until: Annotated[
        str | None,
        Option(
            metavar="pull-off|detached",
            help="How far to pull, in place of the plan's; pull-off if nobody says.",
        ),
    ] = None,
    time_limit: Annotated[
        str | None,
        Option(metavar="TIME", help='Longest time of a case, "10 min", in place of the plan\'s.'),
    ] = None,
    memory_limit: Annotated[
        str | None,
        Option(
            metavar="MEMORY",
            help='Most memory of a case beside its worker, "400 MB", in place of the plan\'s.',
        ),
    ] = None,
    temperature: AtTemperature = None,
    retry: Annotated[
        bool, Option("--retry", help="Run the cases that failed for a lasting reason once more.")
    ] = False,
    own: With = None,
    as_json: AsJson = False,
) -> None:
    """Run the cases of a plan that are not in the folder yet.

    It may be stopped at any time and goes on when called again; ctrl-C finishes the cases in
    flight, a second one does not. Exit status 0: all cases have a result; 1: stopped before; 4:
    nothing is left to be done, and some cases failed, for which viscotack campaign status says why.

    Example: viscotack campaign run cases.csv --out study --workers 2
    """
    changed = {
        "accuracy": accuracy,
        "until": until,
        "time_limit": time_limit,
        "memory_limit": memory_limit,
        "own": _paths(own),
        "temperature": temperature,
    }
    with _words_for_what_is_missing():
        from viscotack.campaign import AllCrashed, NoWorker, read_plan, run, shard_of
        from viscotack.campaign.cluster import security_of

        if out is None:
            raise InputError("--out is missing: the folder that keeps the campaign")
        if plan_file is None and any(value is not None for value in changed.values()):
            raise InputError("settings are those of the folder; give the plan to change limits")
        if plan_file is None and shard is not None:
            raise InputError("--shard is of a plan: give the plan")
        security = security_of(tls_ca, tls_cert, tls_key)
        plan = None if plan_file is None else read_plan(plan_file, **changed)
        if plan is not None and shard is not None:
            plan = shard_of(plan, shard)
        end, trouble = None, ""
        try:
            with _shown() as report:
                end = run(
                    plan,
                    out,
                    workers=workers,
                    scheduler=scheduler,
                    security=security,
                    retry=retry,
                    report=report,
                )
        except (KeyboardInterrupt, AllCrashed, NoWorker) as error:
            trouble = str(error) or "ended at once"
    if end is None:
        words = harmless(f"viscotack: {trouble}; what is stored in {out} is safe")
        typer.echo(words, err=True)
        raise typer.Exit(1)
    _tell(out, end, as_json)
    if end.stopped:
        raise typer.Exit(1)
    if end.failed:
        raise typer.Exit(_SOME_FAILED)


@campaign.command("status")
def status_command(folder: Folder, as_json: AsJson = False) -> None:
    """Say how far a campaign is, and why cases failed; also while it runs.

    Example: viscotack campaign status study
    """
    with _words_for_what_is_missing():
        from viscotack.campaign import Progress, Store

        store = Store(folder)
        standing = store.standing(store.plan().cases)
        reasons = store.reasons()
    done, failed = int(standing.done.sum()), int(standing.failed.sum())
    _tell(folder, Progress(len(standing.done), done, failed), as_json, reasons)


@campaign.command("verify")
def verify_command(folder: Folder, as_json: AsJson = False) -> None:
    """Say whether what is stored is what was written: every file, every row, each once.

    Exit status 0: it is; 1: it is not, and what is wrong is named. Nothing is changed.

    Example: viscotack campaign verify study
    """
    with _words_for_what_is_missing():
        from viscotack.campaign import Store, verify

        verdict = verify(Store(folder))
    if as_json:
        typer.echo(json.dumps(asdict(verdict), indent=2))
    else:
        for words in verdict.wrong:
            typer.echo(harmless(f"wrong: {words}"))
        for words in verdict.strange:
            typer.echo(harmless(f"not of this campaign, and not read: {words}"))
        end = "something is wrong" if verdict.wrong else "all as it was written"
        typer.echo(f"{verdict.rows} rows in {verdict.files} files: {end}")
    if verdict.wrong:
        raise typer.Exit(1)


@campaign.command("merge")
def merge_command(
    folders: Annotated[
        list[Path], Argument(metavar="DIR...", help="Folders of campaigns.", show_default=False)
    ],
    out: Annotated[
        Path | None, Option("--out", metavar="DIR", help="Folder that is to hold all of them.")
    ] = None,
) -> None:
    """Make one campaign of several, such as the shards of one plan.

    Each is verified before; they must be of one kind, accuracy and version of viscotack.

    Example: viscotack campaign merge shard-1 shard-2 --out study
    """
    with _words_for_what_is_missing():
        from viscotack.campaign import Progress, merge

        if out is None:
            raise InputError("--out is missing: the folder that is to hold all of them")
        store = merge(folders, out)
        standing = store.standing(store.plan().cases)
    done, failed = int(standing.done.sum()), int(standing.failed.sum())
    _tell(out, Progress(len(standing.done), done, failed), as_json=False)


@campaign.command("export")
def export_command(
    folder: Folder,
    csv_file: Annotated[
        Path | None,
        Option("--csv", metavar="FILE", help="Write a table; - is standard output."),
    ] = None,
    parquet_file: Annotated[
        Path | None, Option("--parquet", metavar="FILE", help="Write a Parquet file.")
    ] = None,
    mat_file: Annotated[
        Path | None, Option("--mat", metavar="FILE", help="Write a MATLAB file.")
    ] = None,
    failures_file: Annotated[
        Path | None,
        Option("--failures", metavar="FILE", help="Write the failures, as a .csv table."),
    ] = None,
    trajectories: Annotated[
        bool,
        Option(
            "--trajectories",
            help="Write the 24 points of each curve to the CSV file as well; the others have them.",
        ),
    ] = False,
) -> None:
    """Write the results as a table: inputs, pull-off force, work, error estimate and the rest.

    Rows come in the order of the plan. A case that failed is not among them.

    Example: viscotack campaign export study --csv study.csv
    """
    wanted = {
        "--csv": csv_file,
        "--parquet": parquet_file,
        "--mat": mat_file,
        "--failures": failures_file,
    }
    with _words_for_what_is_missing():
        from viscotack.campaign import Store, export

        if not any(wanted.values()):
            raise InputError("say what to write: --csv, --parquet, --mat or --failures FILE")
        check_files(wanted)
        for flag, ending in (("--csv", ".csv"), ("--parquet", ".parquet"), ("--mat", ".mat")):
            file = wanted[flag]
            if file is not None and file.suffix != ending and not is_standard_output(file):
                raise InputError(f"{file}: the ending must be {ending}")
        store, write = Store(folder), Writing()
        with store.ordered_results() as table:
            done = f"wrote {table.rows} cases to"
            write(done, csv_file, lambda file: export(table, file, trajectories=trajectories))
            for file in (parquet_file, mat_file):
                write(done, file, lambda file: export(table, file))
        if failures_file is not None:
            with store.ordered_failures() as failures:
                write("wrote", failures_file, lambda file: export(failures, file))
    write.end()


def _tell(
    folder: Path, end: Any, as_json: bool, reasons: Counter[tuple[str, str]] | None = None
) -> None:
    """Print how far a campaign is, as one object or as words."""
    left = end.cases - end.done - end.failed
    answer: dict[str, Any] = {
        "cases": end.cases,
        "done": end.done,
        "failed": end.failed,
        "left": left,
    }
    if end.elapsed_s:
        answer |= {
            "elapsed_s": end.elapsed_s,
            "cases_per_second": end.rate,
            "worker_use": end.worker_use,
            "peak_memory_bytes": end.peak_memory,
            "stopped": end.stopped,
        }
    if reasons is not None:
        answer["failures"] = [
            {"failure": kind, "reason": reason, "cases": count}
            for (kind, reason), count in reasons.most_common()
        ]
    if as_json:
        typer.echo(json.dumps(answer, indent=2))
        return
    typer.echo(f"{end.done} of {end.cases} cases done, {end.failed} failed, {left} left")
    if end.elapsed_s:
        typer.echo(
            f"  {end.elapsed_s:.1f} s, {end.rate:.2f} cases/s; the workers were busy "
            f"{100 * end.worker_use:.0f} % of the time, {end.peak_memory / 1e6:.0f} MB at most each"
        )
    for why in answer.get("failures", []):
        typer.echo(harmless(f"  {why['cases']:6d} {why['failure']}: {why['reason']}"))
    if left:
        typer.echo(f"  go on with: viscotack campaign run --out {folder}")


@contextmanager
def _shown() -> Iterator[Callable[[Any], None]]:
    """Show progress on standard error: a bar where somebody looks, else a line now and then."""
    if not sys.stderr.isatty():
        last = perf_counter()

        def line(now: Any) -> None:
            nonlocal last
            if perf_counter() - last > _LINES or now.stopped:
                last = perf_counter()
                typer.echo(_progress_words(now), err=True)

        yield line
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    looks = (BarColumn(), TextColumn("{task.description}"))
    with Progress(*looks, console=Console(stderr=True)) as bar:
        task = bar.add_task("starting", total=None)

        def move(now: Any) -> None:
            bar.update(
                task,
                total=now.cases,
                completed=now.done + now.failed,
                description=_progress_words(now),
            )

        yield move


def _progress_words(now: Any) -> str:
    text = f"{now.done} of {now.cases} stored, {now.failed} failed, {now.rate:.1f} cases/s"
    if now.remaining_s is not None:
        minutes, seconds = divmod(round(now.remaining_s), 60)
        text += f", about {minutes} min {seconds:02d} s left"
    return text + ("; finishing the cases in flight" if now.stopped else "")


@contextmanager
def _words_for_what_is_missing() -> Iterator[None]:
    """Tell of wrong input and of a missing extra in a paragraph, with exit status 2."""
    with wrong_input():
        try:
            yield
        except ModuleNotFoundError as error:
            raise InputError(str(error)) from None
