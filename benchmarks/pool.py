"""Cost of a task beside its work: `python benchmarks/pool.py [--repeats 5]`.

Prints the time of a trivial question through the page's engine (one after the other, then all at
once) and of a campaign of 200 cases that take no time, with two workers; medians of the repeats.
With PYTHONPATH set to the `src` of another checkout the same is measured there.
"""

import argparse
import asyncio
import statistics
import tempfile
from pathlib import Path
from time import perf_counter
from typing import Any

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
        ask = {"task": "state", "asked": {"query": "", "text": "", "tables": {}}}
        for _ in range(20):
            await answered(engine, ask)
        began = perf_counter()
        for _ in range(QUESTIONS):
            await answered(engine, ask)
        single = perf_counter() - began
        await asyncio.gather(*(answered(engine, ask) for _ in range(4)))
        began = perf_counter()
        await asyncio.gather(*(answered(engine, ask) for _ in range(QUESTIONS)))
        return single / QUESTIONS, (perf_counter() - began) / QUESTIONS
    finally:
        await engine.end()


async def answered(engine: Engine, asked: dict[str, Any]) -> None:
    """Wait for an answer; that there is none takes as long."""
    try:
        await engine.ask(**asked)
    except ValueError:
        pass


def campaign() -> float:
    """Time of a campaign of stand-ins [s], workers' start included."""
    with tempfile.TemporaryDirectory() as name:
        path = Path(name, "plan.toml")
        path.write_text(
            "[[grid]]\ntabor = 1.0\nmodulus_ratio = 0.1\nexponent = 0.8\npreload = 5.0\n"
            f"rate = {[float(i + 1) for i in range(CASES)]}\n"
        )
        plan, began = read_plan(path), perf_counter()
        assert run(plan, Path(name, "c"), workers=2, work=stand_in).done == CASES
        return perf_counter() - began


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=5)
    repeats = parser.parse_args().repeats
    both = [asyncio.run(questions()) for _ in range(repeats)]
    runs = [campaign() for _ in range(repeats)]
    for words, values in (
        ("question, one after the other [ms]", [1e3 * one for one, _ in both]),
        ("question, all at once [ms]", [1e3 * many for _, many in both]),
        (f"campaign of {CASES} stand-ins [s]", runs),
    ):
        print(f"{words:36} {statistics.median(values):.3f}  ({min(values):.3f} at least)")


if __name__ == "__main__":  # the workers read this file too
    main()
