"""Compare the answers of the package with those recorded: 250 problems, by the command line.

``python -m research.unchanged`` runs the cases of ``unchanged/cases.jsonl`` in a minute, and lists
those whose exit status, outcome or numbers (relative 1e-12) differ from the record; the exit
status is then 1. ``--record`` writes the record anew: do it on a commit whose answers are right.
The cases were drawn at random, once, from shapes, bodies, solids, laws, starts, moves and springs.

Another processor or version of NumPy changes last digits, and adaptive steps then some more: the
record is of OpenBLAS with the kernels SkylakeX, NumPy 2.4 and SciPy 1.17. Elsewhere, record the
old commit first. The last digit of an input in SI may turn one of two equal minima into the other.
"""

import os

for _threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_threads, "1")

import argparse  # noqa: E402
import contextlib  # noqa: E402
import io  # noqa: E402
import json  # noqa: E402
import math  # noqa: E402
import shutil  # noqa: E402
import sys  # noqa: E402
import tempfile  # noqa: E402
from collections.abc import Iterator  # noqa: E402
from pathlib import Path  # noqa: E402
from typing import Any  # noqa: E402

from viscotack.__main__ import main as viscotack  # noqa: E402

FOLDER = Path(__file__).with_suffix("")
RECORD = FOLDER / "cases.jsonl"
TOLERANCE, LISTED = 1e-12, 20
# Differ between two runs of one package, or name it.
LEFT_OUT = ("wall_time_s", "versions", "problem")

Case = dict[str, Any]


def answer(case: Case) -> Case:
    """Return exit status, outcome and numbers of a case; files are in the working folder."""
    Path("case.toml").write_text(case.get("toml", ""), encoding="utf-8")
    printed, status = io.StringIO(), 0
    with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(io.StringIO()):
        try:
            viscotack([*case["arguments"], "--json"])
        except SystemExit as end:
            status = int(end.code or 0)
    found = json.loads(printed.getvalue() or "{}")
    return {
        "exit": status,
        "outcome": found.get("outcome"),
        "numbers": dict(numbers(found)),
    }


def numbers(found: Any, path: str = "") -> Iterator[tuple[str, float]]:
    """Yield the numbers of a record with their paths."""
    if isinstance(found, dict | list):
        pairs = found.items() if isinstance(found, dict) else enumerate(found)
        for key, value in pairs:
            if key in LEFT_OUT:
                continue
            yield from numbers(value, f"{path}.{key}" if path else str(key))
    elif isinstance(found, int | float) and not isinstance(found, bool):
        yield path, found


def changes(old: Case, new: Case) -> list[str]:
    """Return what differs; numbers that were not recorded do not count."""
    found = [f"{x}: {old[x]}, now {new[x]}" for x in ("exit", "outcome") if old[x] != new[x]]
    for name, value in old["numbers"].items():
        now = new["numbers"].get(name)
        if now is None or not math.isclose(value, now, rel_tol=TOLERANCE, abs_tol=1e-300):
            found.append(f"{name}: {value!r}, now {now!r}")
    return found


def main() -> int:
    """Compare, or record."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--record", action="store_true", help="write the record anew")
    recording = parser.parse_args().record
    cases = [json.loads(line) for line in RECORD.read_text(encoding="utf-8").splitlines()]
    changed: dict[str, list[str]] = {}
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        for file in FOLDER.iterdir():
            shutil.copy(file, folder)
        for case in cases:
            now = answer(case)
            if recording:
                case |= now
            elif found := changes(case, now):
                changed[case["name"]] = found
    if recording:
        RECORD.write_text("".join(json.dumps(case) + "\n" for case in cases), encoding="utf-8")
        print(f"recorded {len(cases)} cases in {RECORD}")
        return 0
    for name, found in list(changed.items())[:LISTED]:
        print(f"  {name}: {'; '.join(found[:3])}")
    print(f"{len(changed)} of {len(cases)} cases changed")
    return int(bool(changed))


if __name__ == "__main__":
    sys.exit(main())
