"""Two hundred kills: `python benchmarks/kills.py --folder FOLDER [--kills 200] [--seed 22]`.

Campaigns of stand-ins, among which some wait in C for ever, with and without the interpreter's
lock, some end their process and some are refused, are run and killed in turn as `SORTS` says: the
process that hands out the cases, one of its workers, all of them at once; by a request to end; at a
random instant between a draft and its name, or in the middle of a merge of parts; a merge of
shards; with a Dask cluster also its workers and its scheduler. After each kill all is read and
verified, and the next run goes on. A campaign that has come to its end is compared with one that
nobody disturbed, and another one begins. What was done is kept in the folder: the next call goes on
there. With --real the cases are the 1,000 of plans/thesis_like.toml.
"""

from __future__ import annotations

import argparse
import ctypes
import json
import os
import random
import shutil
import signal
import subprocess
import sys
from collections import Counter
from contextlib import suppress
from pathlib import Path
from time import monotonic, sleep
from typing import Any

from viscotack import InputError
from viscotack.campaign import (
    CaseSettings,
    Plan,
    Progress,
    Store,
    local,
    measure,
    merge,
    read_plan,
    run,
    shard_of,
    verify,
)
from viscotack.campaign import parts as parts_module
from viscotack.campaign.case import Work
from viscotack.campaign.cases import Case
from viscotack.campaign.columns import KINDS
from viscotack.problem.record import run_id

WORKERS, CASES = 2, 320
# One in so many cases is of each of the sorts that make trouble.
PERIOD = 80
# Seconds beyond the limit of a case, which is as long as cases take on a machine that is busy.
GRACE = 0.5
# So many parts make one: merges are met often.
MERGED = 4
SORTS = (
    "parent",
    "worker",
    "draft",
    "group",
    "worker",
    "merge of parts",
    "dask worker",
    "parent",
    "sigterm",
    "scheduler",
    "merge of shards",
    "worker",
    "draft",
    "dask worker",
    "merge of parts",
    "parent of a cluster",
)
ON_A_CLUSTER = ("dask worker", "scheduler", "parent of a cluster")
AT_AN_INSTANT = ("draft", "merge of parts", "merge of shards")
DASK = [sys.executable, "-m", "dask"]
QUIET: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}


def trouble(problem: Any, settings: CaseSettings) -> dict[str, Any]:
    """Return a row that depends on the problem only, in a while; or do what no case should."""
    kind = int(problem.rate) % PERIOD
    if kind == 7:
        ctypes.CDLL(None).sleep(1000)
    if kind == 27:
        ctypes.PyDLL(None).sleep(1000)  # and lets no other thread do anything
    if kind == 47:
        os._exit(1)
    if kind == 67:
        raise InputError(f"no contact at a rate of {problem.rate:g}")
    sleep(0.03)
    curve = [problem.rate / (i + 1) for i in range(24)]
    return {"status": "detached", "pull_off_force": 1 / problem.rate, "trajectory_force": curve}


def planned(real: bool) -> tuple[Plan, Work]:
    """Return what is run, and what does a case of it."""
    if real:
        return read_plan(Path(__file__).parent / "plans/thesis_like.toml"), measure
    kind = KINDS["sphere"]
    stated = {"tabor": 1.0, "modulus_ratio": 0.1, "exponent": 0.8, "preload": 5.0}
    rows = [stated | {"rate": float(i + 1)} for i in range(CASES)]
    cases = (Case(run_id(kind.problem(row)), row) for row in rows)
    return Plan(kind, cases, CaseSettings(time_limit=2.0)), trouble  # type: ignore[arg-type]


def told(folder: Path) -> Any:
    """Return all that a campaign says, but for wall times."""
    store = Store(folder)
    tables = [table.to_pylist() for table in (store.results(), store.failures())]
    for row in (row for table in tables for row in table):
        row.pop("wall_time_s")
    return *tables, store.cases(), store.settings


# --- who is killed ------------------------------------------------------------------------------


def child(folder: Path, *, real: bool, scheduler: str | None, sort: str, instant: int) -> None:
    """Run or merge, and say what was stored, until somebody kills this process."""
    local.GRACE, parts_module._MERGED = GRACE, MERGED
    if sort in AT_AN_INSTANT:
        die_at(instant, within_merge=sort == "merge of parts")
    if sort == "merge of shards":
        merge(sorted(folder.glob("shard-*")), folder / "merged")
        return

    def say(now: Progress) -> None:
        print(now.done, now.failed, flush=True)

    options: dict[str, Any] = {"workers": WORKERS, "scheduler": scheduler, "store_every": 0.1}
    plan, work = planned(real)
    run(plan, folder, work=work, report=say, **options)


def die_at(instant: int, *, within_merge: bool) -> None:
    """Let this process be killed before one of its changes to files, that of this number."""
    left, merging = [instant], [not within_merge]
    for name in ("fsync", "link", "replace", "unlink"):
        change = getattr(os, name)

        def changed(*arguments: Any, change: Any = change, **options: Any) -> Any:
            left[0] -= merging[0]
            if left[0] < 0:
                os.kill(os.getpid(), signal.SIGKILL)
            return change(*arguments, **options)

        setattr(os, name, changed)
    if within_merge:
        merge_parts = parts_module.Parts._merge

        def merged(parts: Any) -> None:
            merging[0] = True
            merge_parts(parts)
            merging[0] = False

        parts_module.Parts._merge = merged  # type: ignore[method-assign]


class Dask:
    """A scheduler and two workers, each a process of its own, over TCP."""

    def __init__(self, folder: Path) -> None:
        self._folder, file = folder, folder / "scheduler.json"
        file.unlink(missing_ok=True)
        words = ["scheduler", "--port", "0", "--no-dashboard", "--scheduler-file", str(file)]
        self.scheduler = subprocess.Popen([*DASK, *words], **QUIET)
        while not file.exists() or not file.read_text().endswith("}"):  # not whole at once
            sleep(0.05)
        self.address = json.loads(file.read_text())["address"]
        self.workers = [self._worker() for _ in range(WORKERS)]

    def _worker(self) -> subprocess.Popen[bytes]:
        words = ["worker", self.address, "--nthreads", "1", "--no-nanny", "--no-dashboard"]
        place = ["--local-directory", str(self._folder)]
        return subprocess.Popen([*DASK, *words, *place], cwd=self._folder, **QUIET)

    def kill_worker(self, chance: random.Random) -> None:
        """Kill one of the workers; another one comes."""
        number = chance.randrange(WORKERS)
        self.workers[number].kill()
        self.workers[number].wait()
        self.workers[number] = self._worker()

    def end(self) -> None:
        """Kill all of it."""
        for process in (self.scheduler, *self.workers):
            process.kill()
            process.wait()


# --- who kills ----------------------------------------------------------------------------------


class Harassed:
    """The folder of all campaigns, what was done there, and a cluster while one is needed."""

    def __init__(self, folder: Path, seed: int, *, real: bool) -> None:
        self.folder, self.seed, self.real, self.dask = folder, seed, real, None
        self.plan, self.work = planned(real)
        folder.mkdir(parents=True, exist_ok=True)
        self.log, self.reference = folder / "log.jsonl", folder / "undisturbed"
        lines = self.log.read_text().splitlines() if self.log.exists() else []
        self.known: list[dict[str, Any]] = [json.loads(line) for line in lines]
        local.GRACE = GRACE
        if not self.known:
            run(self.plan, self.reference, workers=WORKERS, work=self.work)
            self._share()
        self.whole = told(self.reference)

    def _share(self) -> None:
        """Make two shards of the reference; their rows are stored, not run."""
        place = self.folder / "shards"
        stored = {row["name"]: row for row in Store(self.reference).results().to_pylist()}
        failed = {row["name"]: row for row in Store(self.reference).failures().to_pylist()}
        for number in (1, 2):
            part = shard_of(self.plan, f"{number}/2")
            (place / f"shard-{number}").mkdir(parents=True)
            store = Store.create(place / f"shard-{number}", part)
            names = [case.name for case in part.cases]
            store.add(*([rows[n] for n in names if n in rows] for rows in (stored, failed)))
            store.note_run()

    def kill(self, number: int) -> dict[str, Any]:
        """Kill once; return what was met."""
        chance, sort = random.Random(f"{self.seed}-{number}"), SORTS[number % len(SORTS)]
        if sort == "merge of shards":
            return {"sort": sort, **self._kill_merge(chance)}
        campaign = max([k.get("campaign", 0) for k in self.known], default=0)
        before = [k for k in self.known if k.get("campaign") == campaign]
        if before and before[-1]["left"] == 0:
            campaign, before = campaign + 1, []
        place = self.folder / f"campaign-{campaign}"
        reported = max([k["reported"] for k in before], default=0)
        scheduler = self._cluster() if sort in ON_A_CLUSTER else None
        started = self._started(place, sort, scheduler, instant=chance.randrange(60))
        reported, met = self._strike(started, sort, chance, reported)
        left = self._checked(place, reported)
        if left == 0:
            self._compare(place)
        facts = {"campaign": campaign, "met": met, "reported": reported, "left": left}
        return {"sort": sort, **facts}

    def _cluster(self) -> str:
        if self.dask is None:
            self.dask = Dask(self.folder)
        return self.dask.address

    def _started(
        self, place: Path, sort: str, scheduler: str | None, instant: int
    ) -> subprocess.Popen[str]:
        words = ["child", "--folder", str(place), "--sort", sort, "--instant", str(instant)]
        words += ["--scheduler", scheduler] if scheduler else []
        words += ["--real"] if self.real else []
        return subprocess.Popen(
            [sys.executable, __file__, *words],
            stdout=subprocess.PIPE,
            stderr=(self.folder / "errors.txt").open("a"),
            text=True,
            start_new_session=True,
        )

    def _strike(
        self, started: subprocess.Popen[str], sort: str, chance: random.Random, reported: int
    ) -> tuple[int, bool]:
        """Kill; return how many cases were reported as stored by then, and whether it lived."""
        assert started.stdout is not None
        lines = (sum(map(int, line.split())) for line in started.stdout)
        # one in five in the start, the others in the middle of things
        if chance.random() > 0.2:
            reported = max(reported, next((n for n in lines if n > reported), 0))
        sleep(chance.uniform(0.0, 0.8))
        met = started.poll() is None
        if sort in ("worker", "dask worker"):
            self._strike_worker(started, sort, chance)
            sleep(chance.uniform(0.0, 0.8))
            started.kill()
        elif sort == "scheduler":
            assert self.dask is not None
            self.dask.end()
            self.dask = None
        elif sort in AT_AN_INSTANT:
            pass  # it kills itself
        elif sort in ("group", "sigterm"):
            number = signal.SIGKILL if sort == "group" else signal.SIGTERM
            with suppress(ProcessLookupError):
                os.killpg(started.pid, number)
        else:
            started.kill()
        reported = max([reported, *lines])
        code = started.wait()
        return reported, code == -signal.SIGKILL if sort in AT_AN_INSTANT else met

    def _strike_worker(
        self, started: subprocess.Popen[str], sort: str, chance: random.Random
    ) -> None:
        if sort == "dask worker":
            assert self.dask is not None
            self.dask.kill_worker(chance)
            return
        with suppress(OSError):
            path = Path(f"/proc/{started.pid}/task/{started.pid}/children")
            if workers := path.read_text().split():
                os.kill(int(chance.choice(workers)), signal.SIGKILL)

    def _checked(self, place: Path, reported: int) -> int:
        """Read all of a campaign; return how many cases are left."""
        if not (place / "provenance.json").exists():
            assert not reported
            return len(self.plan.cases)
        store = Store(place)
        assert not verify(store).wrong, verify(store).wrong
        standing = store.standing(store.cases())
        done, failed = int(standing.done.sum()), int(standing.failed.sum())
        results = store.results()
        assert results.num_rows == done, "a case is stored twice"
        assert done + failed >= reported, f"{reported} were reported, fewer are stored"
        theirs = {row["name"]: row for row in self.whole[0]}
        for row in results.to_pylist():
            row.pop("wall_time_s")
            assert row == theirs[row["name"]], f"{place}: {row} is not as undisturbed"
        return len(self.plan.cases) - done - failed

    def _compare(self, place: Path) -> None:
        """Demand that a campaign that has come to its end is as undisturbed."""
        if told(place) != self.whole:
            # on a machine that is busy enough a case may have met its limit: it is tried once more
            run(self.plan, place, workers=WORKERS, work=self.work, retry=True)
        assert told(place) == self.whole, f"{place} is not as undisturbed"

    def _kill_merge(self, chance: random.Random) -> dict[str, Any]:
        """Kill a merge of shards at one of its changes to files; then let it go on."""
        place = self.folder / "shards"
        shutil.rmtree(place / "merged", ignore_errors=True)
        started = self._started(place, "merge of shards", None, instant=chance.randrange(45))
        code = started.wait()
        met = code == -signal.SIGKILL
        if not met:
            assert code == 0
        else:
            merge(sorted(place.glob("shard-*")), place / "merged")
        assert told(place / "merged") == self.whole, "merged shards are another campaign"
        return {"met": met}

    def note(self, facts: dict[str, Any]) -> None:
        """Keep what was met."""
        self.known.append(facts)
        with self.log.open("a") as log:
            log.write(json.dumps(facts) + "\n")

    def finish(self) -> None:
        """Let the last campaign come to its end; say how many there were."""
        last = max(k.get("campaign", 0) for k in self.known)
        for number in range(last + 1):
            place = self.folder / f"campaign-{number}"
            end = run(self.plan, place, workers=WORKERS, work=self.work)
            assert end.done + end.failed == end.cases
            self._compare(place)
        if self.dask is not None:
            self.dask.end()
        met = Counter(k["sort"] for k in self.known if k["met"])
        print(f"{len(self.known)} kills, {met.total()} of them met a run:", end=" ")
        print(", ".join(f"{count} {sort}" for sort, count in sorted(met.items())))
        print(
            f"{last + 1} campaigns of {len(self.plan.cases)} cases: nothing lost that was "
            "reported, nothing twice, in the end each the same as undisturbed, wall times aside"
        )


def orphans() -> set[int]:
    """Return workers whose parent, a run, has gone."""
    found = set()
    for path in Path("/proc").glob("[0-9]*"):
        with suppress(OSError, IndexError):
            parent = int((path / "stat").read_text().rsplit(")", 1)[1].split()[1])
            if b"viscotack.pool.worker" in (path / "cmdline").read_bytes() and parent == 1:
                found.add(int(path.name))
    return found


def main() -> None:
    """Kill, and say what came of it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("child", nargs="?", help=argparse.SUPPRESS)
    parser.add_argument("--folder", type=Path, required=True)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=22)
    parser.add_argument("--real", action="store_true", help="cases that are solved, no stand-ins")
    for name in ("--scheduler", "--sort"):
        parser.add_argument(name, help=argparse.SUPPRESS)
    parser.add_argument("--instant", type=int, default=0, help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.child:
        options = {"scheduler": chosen.scheduler, "sort": chosen.sort, "instant": chosen.instant}
        return child(chosen.folder, real=chosen.real, **options)
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    known, began = orphans(), monotonic()
    harassed = Harassed(chosen.folder, chosen.seed, real=chosen.real)
    try:
        for number in range(len(harassed.known), chosen.kills):
            harassed.note(harassed.kill(number))
            print(f"{number + 1:4d} {monotonic() - began:6.0f} s {harassed.known[-1]}", flush=True)
        harassed.finish()
    finally:
        if harassed.dask is not None:
            harassed.dask.end()
    sleep(1.0)
    assert not orphans() - known, "a worker has outlived its run"


if __name__ == "__main__":
    main()
