"""Campaigns put to the test: `python benchmarks/campaign.py [speed overhead million ...]`.

speed: 1,000 cases like those of the thesis on two cores. overhead: stand-ins for cases that take no
time, up to 1e5; million: a million of them, with status, export and verify. cluster: the 1,000 on a
Dask cluster of two processes, one of which is killed half way, compared with the first table, wall
times aside. flips: 2,000 bits turned. disk: a full disk. Kills are in kills.py.
"""

from __future__ import annotations

import argparse
import os
import random
import resource
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter, sleep
from typing import Any

import numpy as np

from viscotack import InputError
from viscotack.campaign import CaseSettings, Plan, Progress, Store, read_plan, run, verify

PLAN = Path(__file__).parent / "plans/thesis_like.toml"
WORKERS = 2
PUBLISHED_SIZE = 8505


def stand_in(problem: Any, settings: CaseSettings) -> dict[str, Any]:
    """Return a row as long as that of a solved case, at once."""
    curve = np.linspace(problem.rate, -1.0, 24).tolist()
    row: dict[str, Any] = {"status": "detached", "outcome": "detached", "versions": "none"}
    row |= {f"number_{i}": float(i) for i in range(24)}
    return row | {f"trajectory_{name}": curve for name in ("depth", "force", "contact_radius")}


def table(folder: Path) -> Any:
    """Return the results without what differs between two runs."""
    return Store(folder).results().drop(["wall_time_s"])


def same(folder: Path, reference: Path) -> str:
    """Return whether two campaigns hold the same table, in words."""
    ours, theirs = table(folder), table(reference)
    names = ours.column("name").to_pylist()
    assert len(set(names)) == len(names), "a case is stored twice"
    if ours.equals(theirs):
        return f"the same {len(names)} rows as undisturbed"
    raise AssertionError(f"{folder} and {reference} differ: {len(names)}, {theirs.num_rows} rows")


def speed(root: Path) -> Path:
    """Run the plan on two cores; return its folder."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    plan, folder = read_plan(PLAN), root / "undisturbed"
    end = run(plan, folder, workers=WORKERS, store_every=2.0)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    busy = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    factor = PUBLISHED_SIZE / len(plan.cases) / 60
    print(
        f"cases                       {end.done} done, {end.failed} failed, {end.elapsed_s:.1f} s"
    )
    print(f"workers busy                {100 * end.worker_use:.1f} % of the time")
    print(f"processor time a case       {busy / len(plan.cases):.3f} s")
    print(f"{PUBLISHED_SIZE} cases, extrapolated  {end.elapsed_s * factor:.1f} min")
    print(f"  on two cores of their own {busy / WORKERS * factor:.1f} min of processor time")
    print(f"memory of a worker          {end.peak_memory / 1e6:.0f} MB at most")
    failures = Store(folder).failures()
    reasons = failures.select(["failure", "reason"]).to_pylist() if failures.num_rows else []
    for reason, count in Counter(": ".join(row.values()) for row in reasons).most_common():
        print(f"  {count} failed, {reason}")
    size = sum(path.stat().st_size for path in folder.rglob("*.parquet"))
    print(f"stored                      {size / len(plan.cases) / 1e3:.2f} kB a case")
    return folder


def many(cases: int) -> Plan:
    """Return a plan of so many cases."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "many.toml"
        path.write_text(
            f"[[fill]]\ncases = {cases}\ntabor = {{ log = [0.01, 10] }}\nmodulus_ratio = 0.1\n"
            "exponent = { linear = [0.2, 2] }\npreload = { log = [0.1, 100] }\n"
            "rate = { log = [0.1, 1e8] }\n"
        )
        return read_plan(path)


def overhead(root: Path) -> None:
    """Run cases that take no time: all that is left is what a case costs beside its solution."""
    for count in (1_000, 10_000, 100_000):
        began = perf_counter()
        plan, folder = many(count), root / f"many-{count}"
        planned = perf_counter()
        end = run(plan, folder, workers=WORKERS, work=stand_in)
        ended = perf_counter()
        again = run(plan, folder, workers=WORKERS, work=stand_in)
        reopened = perf_counter()
        assert end.done == again.done == count
        files = sum(1 for _ in folder.rglob("*.parquet"))
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        print(
            f"{count:7d} cases: {1e3 * (ended - began) / count:.3f} ms a case "
            f"(plan {planned - began:.1f} s, run {ended - planned:.1f} s), "
            f"opened again in {reopened - ended:.1f} s, {files} files, this process {peak:.0f} MB"
        )


def million(root: Path, cases: int) -> None:
    """Plan, run, count and export very many stand-ins, each in a process of its own."""
    folder = root / "million"
    for part in ("run", "status", "export", "verify"):
        began = perf_counter()
        command = [sys.executable, __file__, "child", "--folder", str(folder), "--part", part]
        done = subprocess.run([*command, "--cases", str(cases)], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        took = perf_counter() - began
        print(f"{part:8} {cases} cases: {took:.0f} s; {done.stdout.strip()}", flush=True)


def part_of_million(folder: Path, part: str, cases: int) -> None:
    """Do one part, and say how much memory this process had at most."""
    from viscotack.campaign import export

    if part == "run":
        began = perf_counter()
        plan = many(cases)
        planned = perf_counter() - began
        end = run(plan, folder, workers=WORKERS, work=stand_in)
        assert (end.done, end.failed) == (cases, 0)
        files = sum(1 for _ in folder.rglob("*.parquet"))
        print(
            f"plan {planned:.0f} s, {1e3 * end.elapsed_s / cases:.2f} ms a case, {files} files,"
            f" a worker {end.peak_memory / 1e6:.0f} MB",
            end=", ",
        )
    elif part == "status":
        store = Store(folder)
        assert store.standing(store.cases()).done.sum() == cases
        assert not store.reasons()
    elif part == "verify":
        assert not verify(Store(folder)).wrong
    else:
        with Store(folder).ordered_results() as rows:
            assert rows.rows == cases
            for ending in (".csv", ".parquet"):
                export(rows, folder / f"table{ending}")
                print(f"{(folder / f'table{ending}').stat().st_size / 1e6:.0f} MB", end=", ")
                (folder / f"table{ending}").unlink()
    print(f"this process {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB")


@contextmanager
def dask_cluster(root: Path) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """Hold a scheduler and two workers, each a process of its own, over TCP."""
    quiet: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    dask, file = [sys.executable, "-m", "dask"], root / "scheduler.json"
    file.unlink(missing_ok=True)
    options = ["--port", "0", "--no-dashboard", "--scheduler-file", str(file)]
    began = [subprocess.Popen([*dask, "scheduler", *options], **quiet)]
    try:
        while not file.exists():
            sleep(0.1)
        worker = ["worker", "--scheduler-file", str(file), "--nthreads", "1", "--no-dashboard"]
        folder = ["--local-directory", str(root), "--no-nanny"]
        for _ in range(WORKERS):
            began.append(subprocess.Popen([*dask, *worker, *folder], **quiet))
        import json

        yield json.loads(file.read_text())["address"], began[1:]
    finally:
        for process in began:
            process.kill()
            process.wait()


def cluster(root: Path, reference: Path) -> None:
    """Run the plan on a cluster, once in peace and once with a worker killed half way."""
    for title, killing in (("in peace", False), ("one worker killed", True)):
        with dask_cluster(root) as (address, workers):
            folder, plan = root / f"cluster-{killing}", read_plan(PLAN)

            def murder(now: Progress, killing=killing, victim=workers[0]) -> None:
                if killing and now.done > now.cases / 2 and victim.poll() is None:
                    victim.kill()

            end = run(plan, folder, scheduler=address, report=murder)
            assert not killing or workers[0].poll() is not None
            print(
                f"Dask at {address}, {title}: {end.elapsed_s:.1f} s, memory of a worker "
                f"{end.peak_memory / 1e6:.0f} MB; {same(folder, reference)}"
            )


def flips(root: Path, count: int = 2000) -> None:
    """Turn bits of a small campaign, one at a time: each is seen, or changes nothing."""
    folder, chance = root / "flips", random.Random(7)
    run(many(40), folder, workers=WORKERS, work=stand_in, store_every=0.0)
    whole, seen, same_ = told(folder), 0, 0
    files = [*folder.glob("*/*.parquet"), folder / "cases.parquet", folder / "provenance.json"]
    for _ in range(count):
        path = chance.choice(sorted(files))
        content = path.read_bytes()
        turned = bytearray(content)
        turned[chance.randrange(len(turned))] ^= 1 << chance.randrange(8)
        path.write_bytes(turned)
        try:
            assert told(folder) == whole, f"{path} was read as something else"
            same_ += 1
        except InputError:
            seen += 1
        path.write_bytes(content)
    print(f"{count} bits turned: {seen} were seen, {same_} changed nothing, none was other data")


def told(folder: Path) -> Any:
    """Return all that is read of a campaign."""
    store = Store(folder)
    tables = [table.to_pylist() for table in (store.results(), store.failures())]
    return tables, list(store.cases()), store.settings


def disk(root: Path) -> None:
    """Run into a full disk: a small file system in memory, where the system lets us mount one."""
    place = root / "small-disk"
    place.mkdir()
    options = ["-t", "tmpfs", "-o", "size=2m", "viscotack-benchmark", str(place)]
    if subprocess.run(["mount", *options], capture_output=True).returncode:
        print("skipped: this system does not let us mount a small disk")
        return
    try:
        folder, plan = place / "full", many(20_000)
        try:
            run(plan, folder, workers=WORKERS, work=stand_in)
            raise AssertionError("the disk was large enough")
        except OSError as error:
            message = str(error)
        stored = Store(folder).results().num_rows
        subprocess.run(["mount", "-o", "remount,size=200m", str(place)], check=True)
        end = run(plan, folder, workers=WORKERS, work=stand_in)
        assert end.done == 20_000 == Store(folder).results().num_rows
        print(f"full after {stored} cases: {message}\nwith more room the rest was run: {end.done}")
    finally:
        subprocess.run(["umount", str(place)], check=True)


PARTS = ("speed", "overhead", "million", "flips", "cluster", "disk")


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("parts", nargs="*", help=", ".join(PARTS), default=[])
    parser.add_argument("--cases", type=int, default=1_000_000)
    parser.add_argument("--part", help=argparse.SUPPRESS)
    parser.add_argument("--folder", type=Path, help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.parts == ["child"] and chosen.part:
        return part_of_million(chosen.folder, chosen.part, chosen.cases)
    parts = chosen.parts or PARTS
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        solved = {"speed", "cluster"} & set(parts)
        reference = speed(root) if solved else root
        if "overhead" in parts:
            overhead(root)
        if "million" in parts:
            million(root, chosen.cases)
        if "flips" in parts:
            flips(root)
        if "cluster" in parts:
            cluster(root, reference)
        if "disk" in parts:
            disk(root)


if __name__ == "__main__":
    main()
