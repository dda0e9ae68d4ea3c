"""Do tests notice? `python benchmarks/mutants.py --rooms bem,theory --seed 33 --log FILE`.

Mutants are drawn with a seed, an equal share from each room. Each is put in a copy of the
repository, and the tests nearest to its module (`judges.py`) are run on it until one fails: the
doctests of the module first, tests marked slow last. cosmic-ray (`pip install -e ".[mutants]"`)
enumerates the mutations. Places are drawn first, and then one mutation of each, so that an
arithmetic operator, which can be mutated in many ways, is no likelier than a comparison.
Annotations are excluded.

A mutant is killed if a test that passes without it fails or hangs with it. It survives if no test
fails before the budget of processor time is spent. With a log, a run that was stopped continues
where it was. `--again LOG` judges the mutants of a log with the tests of today: a mutant is found
by the name of its module, wherever that stands now, the function around it and the text of the
line.
"""

from __future__ import annotations

import argparse
import ast
import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from time import perf_counter
from typing import Any

from judges import Judges

ROOT = Path(__file__).parents[1]
PACKAGE = Path("src/viscotack")
ROOMS = ("bem", "methods", "theory", "materials", "problem", "result", "pool", "campaign")
NOT_COPIED = (".git", ".venv", "out", "build", "dist", "__pycache__")
# Test files that judge a module.
NEAREST = 12
# Wall time after which a test, and a whole run, are taken to hang [s]. They end tests that wait;
# those that compute have limits of processor time (`budget.py`), which a busy machine spares.
LONGEST_WAIT, LONGEST_RUN = 600.0, 3600.0
# Memory of a process and size of a file [bytes]: mutants of limits fill memory and disk.
MOST_MEMORY, MOST_FILE = 12 << 30, 1 << 30
# Processes of a run carry this name in their environment, and are ended after it.
MARK = "VISCOTACK_MUTANT"


@dataclass(frozen=True)
class Mutant:
    """Lines of a module that are replaced by others.

    They are the occurrence with number `nth` of `before` in the function or class `scope`.
    """

    module: str
    scope: str
    nth: int
    operator: str
    before: tuple[str, ...]
    after: tuple[str, ...]

    @classmethod
    def between(cls, module: str, operator: str, source: str, changed: str) -> Mutant:
        """Compare the text of a module without and with a mutation."""
        old, new = source.splitlines(), changed.splitlines()
        least = min(len(old), len(new))
        first = next((i for i in range(least) if old[i] != new[i]), least)
        same = (i for i in range(least - first) if old[-1 - i] != new[-1 - i])
        last = next(same, least - first)
        before, after = tuple(old[first : len(old) - last]), tuple(new[first : len(new) - last])
        scope = scope_of(source, first)
        nth = in_scope(source, before, scope).index(first)
        return cls(module, scope, nth, operator, before, after)

    @classmethod
    def of(cls, record: dict[str, Any]) -> Mutant:
        """Read a mutant from a line of a log."""
        known = {field.name: record[field.name] for field in fields(cls)}
        return cls(**known | {key: tuple(known[key]) for key in ("before", "after")})

    def found(self, package: Path) -> tuple[Path, int] | None:
        """Find module and first line, counted from 0, of the lines in the code of today."""
        same_name = package.rglob(Path(self.module).name)
        for path in sorted(same_name, key=lambda path: path != package / self.module):
            source = path.read_text()
            inside = in_scope(source, self.before, self.scope)
            if self.nth < len(inside):
                return path, inside[self.nth]
            if len(everywhere := occurrences(source, self.before)) == 1:
                return path, everywhere[0]
        return None

    def applied(self, source: str, first: int) -> str:
        """Apply the mutant to the text of its module."""
        lines = source.splitlines()
        lines[first : first + len(self.before)] = self.after
        return "\n".join(lines) + "\n"


def occurrences(source: str, block: tuple[str, ...]) -> list[int]:
    """Find the first lines, counted from 0, of all occurrences of a block of lines."""
    lines = tuple(source.splitlines())
    return [i for i in range(len(lines)) if lines[i : i + len(block)] == block]


def in_scope(source: str, block: tuple[str, ...], scope: str) -> list[int]:
    """Find the first lines of the occurrences of a block in one function or class."""
    return [first for first in occurrences(source, block) if scope_of(source, first) == scope]


def scope_of(source: str, line: int) -> str:
    """Name the function or class around a line, counted from 0; "" for the module."""
    around = [
        (node.lineno, node.name)
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef)
        and min([node.lineno, *(x.lineno for x in node.decorator_list)]) <= line + 1
        and line + 1 <= (node.end_lineno or 0)
    ]
    return ".".join(name for _, name in sorted(around))


# Drawing. -----------------------------------------------------------------------------------------


def drawn(package: Path, rooms: list[str], seed: int, count: int) -> list[Mutant]:
    """Draw mutants at different places, an equal share from each room."""
    found = []
    for index, room in enumerate(rooms):
        chance = random.Random(f"{seed} {room}")
        places: dict[tuple[str, tuple[int, int]], list[tuple[str, int]]] = {}
        for path in sorted((package / room).rglob("*.py")):
            for begin, operator, occurrence in mutations(path.read_text()):
                name = path.relative_to(package).as_posix()
                places.setdefault((name, begin), []).append((operator, occurrence))
        share = count // len(rooms) + (index < count % len(rooms))
        for place in chance.sample(sorted(places), share):
            found.append(mutated(package, place[0], *chance.choice(places[place])))
    return found


def mutations(source: str) -> Iterator[tuple[tuple[int, int], str, int]]:
    """Yield place, operator and occurrence of all mutations of a module."""
    from cosmic_ray.ast import ast_nodes, get_ast
    from cosmic_ray.plugins import get_operator, operator_names

    annotated = list(annotations(source))
    nodes = list(ast_nodes(get_ast(source)))
    for name in operator_names():
        operator: Any = get_operator(name)
        if operator.arguments():
            continue
        found = (place for node in nodes for place in operator().mutation_positions(node))
        for occurrence, (begin, end) in enumerate(found):
            if not any(first <= begin and end <= last for first, last in annotated):
                yield begin, name, occurrence


def annotations(source: str) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
    """Yield first and last place of annotations, which change nothing."""
    for node in ast.walk(ast.parse(source)):
        for name in ("annotation", "returns"):
            found = getattr(node, name, None)
            if isinstance(found, ast.expr):
                assert found.end_lineno is not None and found.end_col_offset is not None
                begin = (found.lineno, found.col_offset)
                yield begin, (found.end_lineno, found.end_col_offset)


def mutated(package: Path, module: str, operator: str, occurrence: int) -> Mutant:
    """Make the mutant of one mutation of a module."""
    from cosmic_ray.mutating import mutate_code
    from cosmic_ray.plugins import get_operator

    source = (package / module).read_text()
    changed = mutate_code(source, get_operator(operator)(), occurrence)
    assert changed is not None and changed != source
    return Mutant.between(module, operator.removeprefix("core/"), source, changed)


# Judging. -----------------------------------------------------------------------------------------


@dataclass
class Bench:
    """A copy of the repository in which mutants are judged.

    Tests that fail there without a mutant are collected in `broken` and left out.
    """

    copy: Path
    budget: float
    broken: list[str]

    def judged(self, mutant: Mutant) -> dict[str, Any]:
        """Judge a mutant: the verdict, the test that killed it and the wall time [s]."""
        began = perf_counter()
        place = mutant.found(self.copy / PACKAGE)
        verdict, by = ("gone", "") if place is None else self._verdict(mutant, *place)
        facts = {"verdict": verdict, "by": by, "seconds": round(perf_counter() - began, 1)}
        return asdict(mutant) | facts

    def _verdict(self, mutant: Mutant, path: Path, first: int) -> tuple[str, str]:
        nearest = Judges(self.copy).of(path)[:NEAREST]
        tests = [str(test) for test in (path.relative_to(self.copy), *nearest)]
        source = path.read_text()
        while True:
            path.write_text(mutant.applied(source, first))
            try:
                failed, words = self._run(tests)
            finally:
                path.write_text(source)
            if not failed:
                return "survived", words
            if not self._run([failed])[0]:
                return "killed", words
            assert failed not in self.broken, f"a file of tests fails without a mutant: {words}"
            self.broken.append(failed)

    def _run(self, tests: list[str]) -> tuple[str, str]:
        """Run tests until one fails: its name, or "", and the last words of pytest."""
        command = [sys.executable, "-m", "pytest", "-x", "-v", "-p", "no:cacheprovider"]
        command += ["-p", "budget", f"--budget={self.budget:g}", "--tb=line", "-m", "not outside"]
        command += ["-o", f"faulthandler_timeout={LONGEST_WAIT:g}"]
        command += ["-o", "faulthandler_exit_on_timeout=true"]
        command += [f"--deselect={test}" for test in self.broken]
        mark = f"{os.getpid()}-{perf_counter()}"
        paths = os.pathsep.join(str(self.copy / part) for part in ("src", "benchmarks"))
        environment = os.environ | {"PYTHONPATH": paths, "PYTHONUNBUFFERED": "1", MARK: mark}
        environment |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
        # a file: the end of a pipe would wait for all processes that a test has left
        with tempfile.TemporaryFile("w+") as output:
            process = subprocess.Popen(
                [*command, *tests],
                cwd=self.copy,
                env=environment,
                stdout=output,
                stderr=subprocess.STDOUT,
                preexec_fn=limited,
                start_new_session=True,
            )
            with suppress(subprocess.TimeoutExpired):
                process.wait(LONGEST_RUN)
            end_all(mark, process.pid)
            code = process.wait()
            output.seek(0)
            return outcome(output.read(), code)


def outcome(output: str, code: int) -> tuple[str, str]:
    """Read the name of the test that failed or hung, or "", and the line on it."""
    lines = output.splitlines()
    # 5: a module without a test, which fails only where it cannot be imported
    if code in (0, 5):
        return "", lines[-1].strip("= ")
    summary = next((line for line in lines if line.startswith(("FAILED ", "ERROR "))), "")
    for line in lines:
        if ended := re.fullmatch(r"(.+::.+) (?:FAILED|ERROR) +\[ *\d+%\]", line):
            return ended[1], summary
    if summary:  # a file that cannot be imported
        return summary.split()[1], summary
    # a line of a test that has ended ends with the share of tests that have, as in [ 12%]
    running = [line for line in lines if "::" in line and not re.search(r"\[ *\d+%\]$", line)]
    name = running[-1].strip() if running else "unknown"
    return name, f"HUNG {name}"


def limited() -> None:
    """Limit memory and size of files of this process."""
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


def show(record: dict[str, Any]) -> None:
    """Print a verdict and the lines of its mutant."""
    word = record["verdict"]
    word = word if word == "killed" else word.upper()
    print(f"{word:8} {record['module']}, {record['scope'] or 'module'}: {record['operator']}")
    print(f"         {record['seconds']:.0f} s  {record['by']}")
    for sign, lines in (("-", record["before"]), ("+", record["after"])):
        for line in lines:
            print(f"         {sign}{line}", flush=True)


def records(log: Path | None) -> list[dict[str, Any]]:
    """Read the verdicts in a log, none if it does not exist."""
    if log is None or not log.exists():
        return []
    return [json.loads(line) for line in log.read_text().splitlines()]


def main() -> None:
    """Draw, judge and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--seed", type=int, help="draw with this seed")
    source.add_argument("--again", type=Path, help="judge the mutants of this log once more")
    parser.add_argument("--rooms", default=",".join(ROOMS), help="rooms to draw from")
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--budget", type=float, default=100.0, help="processor time a mutant [s]")
    parser.add_argument("--log", type=Path, help="file of the verdicts, a line each")
    parser.add_argument("--list", action="store_true", help="draw and show only")
    chosen = parser.parse_args()
    if chosen.again:
        wanted = [Mutant.of(record) for record in records(chosen.again)]
    else:
        rooms = chosen.rooms.split(",")
        if unknown := [room for room in rooms if not (ROOT / PACKAGE / room).is_dir()]:
            parser.error(f"no room {', '.join(unknown)} in {PACKAGE}")
        wanted = drawn(ROOT / PACKAGE, rooms, chosen.seed, chosen.count)
    if chosen.list:
        for mutant in wanted:
            show(asdict(mutant) | {"verdict": "drawn", "by": "", "seconds": 0.0})
        return
    known = records(chosen.log)
    judged_before = [Mutant.of(record) for record in known]
    assert set(judged_before) <= set(wanted), "the log has other mutants; give another --log"
    with tempfile.TemporaryDirectory(prefix="mutants-") as name:
        copy = Path(name) / "copy"
        shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(*NOT_COPIED))
        bench = Bench(copy, chosen.budget, [])
        for mutant in wanted:
            if mutant in judged_before:
                continue
            known.append(bench.judged(mutant))
            show(known[-1])
            if chosen.log:
                chosen.log.parent.mkdir(parents=True, exist_ok=True)
                with chosen.log.open("a") as log:
                    log.write(json.dumps(known[-1]) + "\n")
    killed = sum(record["verdict"] == "killed" for record in known)
    print(f"{killed} of {len(known)} mutants killed")


if __name__ == "__main__":
    main()
