"""Cost of a task beside its work: `python benchmarks/pool.py [--repeats 5] [--against CHECKOUT]`.

Measures the time of a trivial question through the engine of the page, one after the other and all
at once, and of a campaign of 200 cases that take no time, with two workers and their start; by the
clock, and in processor time of all processes. With another checkout the same is measured there, in
pairs. Prints medians and, of the pairs, the median ratio.
"""

import argparse
import asyncio
import json
import os
import resource
import subprocess
import sys
import tempfile
from contextlib import suppress
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import viscotack
from viscotack.app.engine.jobs import Engine
from viscotack.campaign import read_plan, run

QUESTIONS, CASES = 300, 200


def stand_in(problem: Any, settings: Any) -> dict[str, Any]:
    """Return a row that takes no time."""
    words = {"status": "detached", "outcome": "detached"}
    return words | {"pull_off_force": 1 / problem.rate, "trajectory_force": [0.0] * 24}


async def questions() -> tuple[float, float]:
    """Time of a question [s], one after the other and all at once."""
    engine = Engine()
    await engine.begin()
    try:
        for _ in range(20):
            await answered(engine)
        began = perf_counter()
        for _ in range(QUESTIONS):
            await answered(engine)
        single = perf_counter() - began
        began = perf_counter()
        await asyncio.gather(*(answered(engine) for _ in range(QUESTIONS)))
        return single / QUESTIONS, (perf_counter() - began) / QUESTIONS
    finally:
        await engine.end()


async def answered(engine: Engine) -> None:
    """Wait for an answer; a refusal is one too."""
    with suppress(ValueError):
        await engine.ask("state", {})


def campaign() -> float:
    """Time of a campaign of stand-ins [s]."""
    with tempfile.TemporaryDirectory() as name:
        path = Path(name, "plan.toml")
        path.write_text(
            "[[grid]]\ntabor = 1.0\nmodulus_ratio = 0.1\nexponent = 0.8\npreload = 5.0\n"
            f"rate = {[float(i + 1) for i in range(CASES)]}\n"
        )
        plan, began = read_plan(path), perf_counter()
        assert run(plan, Path(name, "c"), workers=2, work=stand_in).done == CASES
        return perf_counter() - began


def processor_time() -> float:
    """Processor time of this process and of those that it has ended [s]."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)


def measured() -> dict[str, float]:
    """Measure once."""
    begun = processor_time()
    single, many = asyncio.run(questions())
    between = processor_time()
    clock = campaign()
    return {
        "question, one after the other [ms]": 1e3 * single,
        "question, all at once [ms]": 1e3 * many,
        f"{2 * QUESTIONS} questions, processor [s]": between - begun,
        f"campaign of {CASES} stand-ins [s]": clock,
        "the same, processor [s]": processor_time() - between,
    }


def measured_by(source: str) -> dict[str, float]:
    """Measure once in a process that imports the package from a folder."""
    environment = os.environ | {"PYTHONPATH": source}
    command = [sys.executable, __file__, "--once"]
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--against", type=Path, help="another checkout")
    parser.add_argument("--once", action="store_true", help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.once:
        print(json.dumps(measured()))
        return
    ours, theirs = [], []
    for _ in range(chosen.repeats):
        ours.append(measured_by(str(Path(viscotack.__file__).parents[1])))
        if chosen.against:
            theirs.append(measured_by(str(chosen.against / "src")))
    for name in ours[0]:
        line = f"{name:36} {median(one[name] for one in ours):.3f}"
        if theirs:
            ratio = median(a[name] / b[name] for a, b in zip(ours, theirs, strict=True))
            line += f", there {median(one[name] for one in theirs):.3f}, ratio {ratio:.2f}"
        print(line)


if __name__ == "__main__":  # the workers read this file too
    main()
