"""Do tests notice? `python benchmarks/mutants.py --seed 22 --count 40 --log FILE`.

Mutants of the campaign are drawn with a seed, each is put in a copy of the repository, and the
campaign's tests are run on it. cosmic-ray (`pip install -e ".[mutants]"`) says which mutants there
are. Places are drawn first, and then one mutation of each: what can be mutated in many ways, such
as an arithmetic operator, is no likelier than a comparison. Annotations are no places. A mutant is
killed when a test fails, also one that would never end. With a log the run goes on where it was.
"""

from __future__ import annotations

import argparse
import ast
import difflib
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

ROOT = Path(__file__).parents[1]
PACKAGE = Path("src/viscotack/campaign")
COPIED = ("src", "tests", "benchmarks", "docs", "examples", "pyproject.toml")
# Seconds after which a test is taken for hung, and all tests of a mutant are; undisturbed the
# longest takes a third of it.
LIMIT_OF_A_TEST, LIMIT = 90.0, 600.0
# What a process of the tests may have [bytes]: mutants of limits fill memory and disk.
MOST_MEMORY, MOST_FILE = 12 << 30, 1 << 30
# Processes of a mutant are known by this name in their environment, and ended after it.
MARK = "VISCOTACK_MUTANT"

# What judges a module: the tests that a change there must fail, the nearest first.
JUDGES = {
    "case": ("case", "run", "supervisor"),
    "cases": ("store", "plan", "sharing", "run", "trust"),
    "cluster": ("crew", "cluster", "run"),
    "columns": ("plan", "inputs"),
    "crew": ("crew", "run", "supervisor"),
    "design": ("plan", "inputs"),
    "exporting": ("store", "commands", "trust"),
    "identity": ("case", "sharing", "supervisor"),
    "inputs": ("inputs", "plan"),
    "listed": ("plan", "sharing"),
    "memory": ("supervisor", "case"),
    "ordering": ("store", "sharing", "trust"),
    "own": ("trust",),
    "parts": ("store", "trust", "run"),
    "plan": ("plan", "inputs", "commands"),
    "provenance": ("trust", "store"),
    "running": ("run", "trust", "supervisor"),
    "sharing": ("sharing",),
    "standing": ("run", "store", "commands"),
    "store": ("store", "trust", "sharing", "run", "commands"),
    "supervisor": ("supervisor", "run"),
    "verifying": ("trust", "sharing"),
    "worker": ("supervisor", "run"),
}
# Those that read what version 0.1 wrote.
OLDER = {"parts.py", "provenance.py", "store.py"}


@dataclass(frozen=True)
class Mutant:
    """A mutation at a place of a module; lines and columns as parsers count them."""

    module: str
    operator: str
    occurrence: int
    begin: tuple[int, int]
    end: tuple[int, int]

    def applied(self, source: str) -> str:
        """Return the module with it."""
        from cosmic_ray.mutating import mutate_code
        from cosmic_ray.plugins import get_operator

        changed = mutate_code(source, get_operator(self.operator)(), self.occurrence)
        assert changed is not None and changed != source
        return changed


def mutants(path: Path) -> Iterator[Mutant]:
    """Yield all mutants of a module."""
    from cosmic_ray.ast import ast_nodes, get_ast
    from cosmic_ray.plugins import get_operator, operator_names

    source = path.read_text()
    annotated = list(annotations(source))
    nodes = list(ast_nodes(get_ast(source)))
    for name in operator_names():
        operator: Any = get_operator(name)
        if operator.arguments():
            continue
        found = (place for node in nodes for place in operator().mutation_positions(node))
        for occurrence, (begin, end) in enumerate(found):
            if not any(first <= begin and end <= last for first, last in annotated):
                yield Mutant(path.name, name, occurrence, begin, end)


def annotations(source: str) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
    """Yield where annotations begin and end: what they say, nothing does."""
    for node in ast.walk(ast.parse(source)):
        for name in ("annotation", "returns"):
            found = getattr(node, name, None)
            if isinstance(found, ast.expr):
                assert found.end_lineno is not None and found.end_col_offset is not None
                begin = (found.lineno, found.col_offset)
                yield begin, (found.end_lineno, found.end_col_offset)


def drawn(folder: Path, seed: int, count: int) -> list[Mutant]:
    """Return so many mutants at different places of a package."""
    places: dict[tuple[str, tuple[int, int]], list[Mutant]] = {}
    for path in sorted(folder.glob("*.py")):
        for mutant in mutants(path):
            places.setdefault((mutant.module, mutant.begin), []).append(mutant)
    chance = random.Random(seed)
    return [chance.choice(places[place]) for place in chance.sample(sorted(places), count)]


def tests_for(module: str) -> list[str]:
    """Return what judges a module, its own examples first."""
    # the last is of all modules: what they state is frozen
    judges = dict.fromkeys((*JUDGES[module.removesuffix(".py")], "case"))
    suites = (f"tests/test_campaign_{suite}.py" for suite in judges)
    of_older_versions = ["tests/test_saved_by_0_1.py"] if module in OLDER else []
    return [f"{PACKAGE}/{module}", *suites, *of_older_versions]


def run_tests(copy: Path, tests: list[str]) -> tuple[bool, str]:
    """Return whether all tests pass, and the first words on one that does not."""
    command = [sys.executable, "-m", "pytest", "-x", "-v", "-p", "no:cacheprovider", "--tb=line"]
    command += ["-o", f"faulthandler_timeout={LIMIT_OF_A_TEST:g}"]
    command += ["-o", "faulthandler_exit_on_timeout=true"]
    mark = f"{os.getpid()}-{perf_counter()}"
    environment = os.environ | {"PYTHONPATH": str(copy / "src"), MARK: mark}
    environment |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
    process = subprocess.Popen(
        [*command, "-m", "not slow and not outside", *tests],
        cwd=copy,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        preexec_fn=limited,
        start_new_session=True,
    )
    try:
        words = process.communicate(timeout=LIMIT)[0]
    except subprocess.TimeoutExpired:
        words = f"FAILED by hanging for {LIMIT:g} s"
    end_all(mark, process.pid)
    process.wait()
    lines = words.splitlines()
    failed = [line for line in lines if line.startswith(("FAILED", "ERROR"))]
    hung = [line for line in lines if line.startswith("tests/") and "PASSED" not in line]
    return process.returncode == 0, next(iter(failed + hung), "\n".join(lines[-1:]))


def limited() -> None:
    """Let this process take no more than there is."""
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, resource.RLIM_INFINITY))
    resource.setrlimit(resource.RLIMIT_FSIZE, (MOST_FILE, resource.RLIM_INFINITY))


def end_all(mark: str, group: int) -> None:
    """End all processes of one run of the tests, whatever a mutant has made of them."""
    with suppress(ProcessLookupError):
        os.killpg(group, signal.SIGKILL)
    wanted = f"{MARK}={mark}".encode()
    for path in Path("/proc").glob("[0-9]*/environ"):
        with suppress(OSError):
            if wanted in path.read_bytes().split(b"\0"):
                os.kill(int(path.parent.name), signal.SIGKILL)


def judged(copy: Path, mutant: Mutant) -> dict[str, Any]:
    """Return what becomes of a mutant."""
    path = copy / PACKAGE / mutant.module
    source = path.read_text()
    changed = mutant.applied(source)
    began = perf_counter()
    path.write_text(changed)
    try:
        survived, words = run_tests(copy, tests_for(mutant.module))
    finally:
        path.write_text(source)
    before, after = source.splitlines(), changed.splitlines()
    lines = difflib.unified_diff(before, after, lineterm="", n=0)
    said = [line for line in lines if line[:1] in "+-" and line[:3] not in ("+++", "---")]
    facts = {"survived": survived, "by": words, "diff": said}
    return asdict(mutant) | facts | {"seconds": round(perf_counter() - began, 1)}


def main() -> None:
    """Draw, judge and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--log", type=Path, help="what was judged is kept there, a line each")
    parser.add_argument("--list", action="store_true", help="draw and show only")
    chosen = parser.parse_args()
    found = drawn(ROOT / PACKAGE, chosen.seed, chosen.count)
    if chosen.list:
        for mutant in found:
            print(f"{mutant.module}:{mutant.begin[0]}: {mutant.operator.removeprefix('core/')}")
        return
    known: list[dict[str, Any]] = []
    if chosen.log and chosen.log.exists():
        known = [json.loads(line) for line in chosen.log.read_text().splitlines()]
    asked = [(one.module, list(one.begin), one.operator) for one in found]
    judged_before = [(one["module"], one["begin"], one["operator"]) for one in known]
    assert asked[: len(known)] == judged_before, "the log is of other mutants; give another --log"
    with tempfile.TemporaryDirectory(prefix="mutants-") as name:
        copy = Path(name)
        for part in COPIED:
            whole = shutil.copytree if (ROOT / part).is_dir() else shutil.copy
            whole(ROOT / part, copy / part)
        if chosen.log:
            chosen.log.parent.mkdir(parents=True, exist_ok=True)
        if not known:
            passed, words = run_tests(copy, tests_for("running.py"))
            assert passed, f"the tests fail without any mutant: {words}"
        for mutant in found[len(known) :]:
            known.append(judged(copy, mutant))
            if chosen.log:
                with chosen.log.open("a") as log:
                    log.write(json.dumps(known[-1]) + "\n")
            last = known[-1]
            word = "SURVIVED" if last["survived"] else "killed"
            where = f"{last['module']}:{last['begin'][0]}"
            print(f"{word:8} {where:18} {last['seconds']:5.0f} s  {last['by']}", flush=True)
            for line in last["diff"]:
                print(f"         {line}", flush=True)
    killed = sum(not one["survived"] for one in known)
    print(f"{killed} of {len(known)} mutants killed")


if __name__ == "__main__":
    main()
