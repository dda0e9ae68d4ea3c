"""Reliability farm: ``python benchmarks/farm.py --hours 1 [--out out/farm] [--only PART]``.

Repeats rounds of drawn kills (`kills.py`), of kills while the clock of `time.time` jumps by up to
ten days every two seconds, exit statuses under load (`exits.py`),
mutated files (`fuzz.files`), relations between answers (`fuzz`), and the tests of campaigns on full
disks and with damaged files, each round with another seed, until the hours are over. A round that
has begun is ended. Every part has a log in the folder, and ``farm.jsonl`` a line with its seed,
exit status and time. Then the counts are printed; it ends with 1 if a part failed. ``--short``
draws less: a round takes some minutes.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path
from time import monotonic

_TESTS = ("tests/test_campaign_store.py", "tests/test_campaign_kills.py")


def parts(folder: Path, seed: int, *, short: bool) -> dict[str, list[str]]:
    """Return the arguments of Python for the parts of a round."""
    kills, verify, others, files, minutes = (
        ("10", "10", "0", "20", "0.5") if short else ("50", "50", "5", "300", "10")
    )
    killed = ["benchmarks/kills.py", "--kills", kills, "--seed", str(seed), "--folder"]
    return {
        "kills": [*killed, str(folder / f"kills-{seed}")],
        "clock": [*killed, str(folder / f"clock-{seed}")],
        "exits": ["benchmarks/exits.py", "--verify", verify, "--others", others],
        "files": ["-m", "fuzz.files", "--seed", str(seed), "--files", files],
        "relations": ["-m", "fuzz", "--seed", str(seed), "--minutes", minutes],
        "damage": ["-m", "pytest", "-q", "-p", "no:cacheprovider", *_TESTS],
    }


# Imported by every Python of the part `clock` at its start; libfaketime breaks `time.sleep`.
_CLOCK = """import time
_true = time.time
def _jumped():
    days = 86_400 * ((_true() // 2) * 7 % 21 - 10)
    return _true() + days
time.time = _jumped
"""


def jumping(folder: Path) -> dict[str, str]:
    """Return an environment in which the time of day jumps."""
    folder.mkdir(exist_ok=True)
    (folder / "sitecustomize.py").write_text(_CLOCK, encoding="utf-8")
    paths = os.pathsep.join([str(folder.resolve()), os.environ.get("PYTHONPATH", "")])
    return os.environ | {"PYTHONPATH": paths.rstrip(os.pathsep)}


def main() -> int:
    """Return 1 if a part failed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--hours", type=float, default=1.0)
    parser.add_argument("--out", type=Path, default=Path("out/farm"))
    parser.add_argument("--seed", type=int, default=1, help="of the first round")
    parser.add_argument("--only", action="append", help="a part; can be repeated")
    parser.add_argument("--short", action="store_true")
    asked = parser.parse_args()
    asked.out.mkdir(parents=True, exist_ok=True)
    began, seed, counts = monotonic(), asked.seed, Counter[str]()
    while seed == asked.seed or monotonic() - began < 3600 * asked.hours:
        for name, words in parts(asked.out, seed, short=asked.short).items():
            if asked.only and name not in asked.only:
                continue
            start = monotonic()
            environment = jumping(asked.out / "clock") if name == "clock" else None
            with (asked.out / f"{name}-{seed}.log").open("w", encoding="utf-8") as log:
                status = subprocess.run(
                    [sys.executable, *words], stdout=log, stderr=log, env=environment
                ).returncode
            counts[f"{name} {'failed' if status else 'passed'}"] += 1
            row = {"part": name, "seed": seed, "status": status, "seconds": monotonic() - start}
            with (asked.out / "farm.jsonl").open("a", encoding="utf-8") as file:
                print(json.dumps(row), file=file)
            print(
                f"{monotonic() - began:6.0f} s  round {seed}, {name}: status {status}", flush=True
            )
        seed += 1
    for what, count in sorted(counts.items()):
        print(f"{count:5d} {what}")
    return int(any(what.endswith("failed") for what in counts))


if __name__ == "__main__":
    sys.exit(main())
