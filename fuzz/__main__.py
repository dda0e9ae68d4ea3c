"""The command: draw checks until the time is over, and print what does not hold.

``python -m fuzz --seed 7 --minutes 25`` ends with status 1 where something was found. With ``--log
FILE`` it goes on where an earlier run of the same seed was stopped; the log has a line for each
finding, and one for every twenty checks that says how far it is. ``--only RELATION --draw N --case
TEXT`` repeats one check: a finding is printed as such a command.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import shlex
import signal
import sys
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from .answers import Broken, TooLong, Unjudged
from .cases import Luck, of_text
from .doors import DOORS
from .relations import PHYSICS, Relation
from .shrinking import shrunk

RELATIONS = {relation.name: relation for relation in (*PHYSICS, *DOORS)}
_EVERY = 20
# A check that takes longer than this [s] is not judged: not every tier has a limit of time.
_PATIENCE = 60.0


@dataclass(frozen=True)
class Finding:
    """A relation that does not hold: where it was met, what is wrong, and how to see it again."""

    number: int
    relation: str
    wrong: list[str]
    command: str


@contextlib.contextmanager
def limited(seconds: float) -> Iterator[None]:
    """End what runs longer than this as TooLong, on systems that have an alarm."""

    def ring(*_: Any) -> None:
        raise TooLong(f"the time limit of {seconds:g} s of a check was met")

    if not hasattr(signal, "SIGALRM"):
        yield
        return
    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def judge(relation: Relation, case: Any, draw: int) -> list[str]:
    """Return what is wrong with a case, in words; a defect of the package is wrong as well."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with limited(_PATIENCE):
                return relation.check(case, Luck(draw))
    except Unjudged:
        raise
    except Broken as broken:
        return [str(broken)]
    except Exception as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        return [f"{type(error).__name__} at {Path(place.filename).name}:{place.lineno}: {error}"]


def check(seed: int, number: int, only: list[Relation]) -> tuple[str, list[str], Any, int]:
    """Return the relation of a check, what is wrong, the case and the draw."""
    luck = Luck(seed, number)
    relation = luck.one({one.name: one.share for one in only})
    case, draw = RELATIONS[relation].draw(luck), luck.count(0, 999_999)
    return relation, judge(RELATIONS[relation], case, draw), case, draw


def finding(number: int, name: str, wrong: list[str], case: Any, draw: int) -> Finding:
    """Return a failed check with a case that is as simple as can be found."""

    def fails(simpler: Any) -> bool:
        try:
            again = judge(RELATIONS[name], simpler, draw)
        except Unjudged:
            return False
        # of the same kind: not a defect that a simpler case runs into on its way
        return any(words.split()[0] in {old.split()[0] for old in wrong} for words in again)

    small = shrunk(case, fails)
    try:
        wrong = judge(RELATIONS[name], small, draw) or wrong
    except Unjudged:
        small = case
    return Finding(number, name, wrong, command(name, draw, small))


def command(name: str, draw: int, case: Any) -> str:
    """Return the command line that repeats a check."""
    return f"python -m fuzz --only {name} --draw {draw} --case {shlex.quote(repr(case))}"


def done_before(log: Path | None) -> tuple[int, float, Counter[str], list[Finding]]:
    """Return how far an earlier run came: next number, seconds, counts and findings."""
    number, seconds, counts, found = 0, 0.0, Counter(), []
    if log is not None and log.exists():
        for line in log.read_text(encoding="utf-8").splitlines():
            record = json.loads(line)
            if "next" in record:
                number, seconds = record["next"], record["seconds"]
                counts = Counter(record["counts"])
            else:
                found.append(Finding(**record))
    return number, seconds, counts, [f for f in found if f.number < number]


def run(seed: int, minutes: float, most: int, only: list[Relation], log: Path | None) -> int:
    """Draw and judge checks; return the exit status."""
    number, before, counts, found = done_before(log)
    kept = [asdict(f) for f in found]
    began = time.monotonic()

    def seconds() -> float:
        return before + time.monotonic() - began

    def note(record: dict[str, Any]) -> None:
        if log is not None:
            log.parent.mkdir(parents=True, exist_ok=True)
            with log.open("a", encoding="utf-8") as file:
                file.write(json.dumps(record) + "\n")

    while number < most and seconds() < 60 * minutes:
        try:
            name, wrong, case, draw = check(seed, number, only)
            counts["held" if not wrong else "failed"] += 1
            if wrong:
                one = finding(number, name, wrong, case, draw)
                kept.append(asdict(one))
                note(asdict(one))
                print(f"{number} {name}: {'; '.join(one.wrong)}\n  {one.command}", flush=True)
        except Unjudged as why:
            counts["refused" if str(why).startswith("refused") else "stopped"] += 1
        number += 1
        if number % _EVERY == 0:
            note({"next": number, "seconds": round(seconds(), 1), "counts": dict(counts)})
    said = ", ".join(f"{n} {what}" for what, n in sorted(counts.items()))
    print(f"seed {seed}: {number} checks in {seconds() / 60:.1f} min: {said}", flush=True)
    return 1 if kept else 0


def main(arguments: list[str] | None = None) -> int:
    """Return the exit status of the command: 1 where something was found."""
    parser = argparse.ArgumentParser(prog="python -m fuzz", description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=25.0)
    parser.add_argument("--checks", type=int, default=10**9, help="most checks")
    parser.add_argument("--only", choices=RELATIONS, action="append", help="a relation")
    parser.add_argument("--draw", type=int, help="of the random numbers of a relation")
    parser.add_argument("--case", help="the case of one check, as Python writes it")
    parser.add_argument("--log", type=Path, help="file that keeps findings, and how far it is")
    given = parser.parse_args(arguments)
    if given.case is not None:
        (name,) = given.only
        try:
            wrong = judge(RELATIONS[name], of_text(given.case), given.draw or 0)
        except Unjudged as why:
            print(f"not judged: {why}")
            return 0
        print("\n".join(wrong) or "holds")
        return 1 if wrong else 0
    only = [RELATIONS[name] for name in given.only or RELATIONS]
    return run(given.seed, given.minutes, given.checks, only, given.log)


if __name__ == "__main__":
    sys.exit(main())
