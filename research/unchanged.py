"""Hold the answers of the package at hand against those of the commit that recorded them.

``python benchmarks/unchanged.py`` runs the cases of `unchanged/cases.json`, each a command line or
a record of a problem, compares with `unchanged/answers.json` and says what changed; the exit status
is 1 where something did that should not. About a minute.

- Dimensionless cases must answer to the last bit: every number, the words, the exit status, and the
  bytes of the table where one is written.
- Cases in SI, texts with units, must answer within a tenth of the error that they state themselves;
  inputs that are repeated within 1e-12; words, events and exit status as they were.
- Cases that have been mended since are listed in `MENDED` with the reason; their outcome must be as
  it was, and force and work within the error that is stated for them. The sentences of a `..._note`
  may name another module.
- The names of problems by content (`run_id`) must be kept: finished campaigns go by them.

Another processor, NumPy or SciPy changes the last bits, and adaptive steps then some more. Where
they are not those of the record, ``--against CHECKOUT`` makes it anew from a checkout of the old
commit, a folder with src/. ``--record FILE`` writes the answers of the package at hand.

The cases were drawn at random, once: shapes, bodies, materials, laws, starts, moves and springs in
all combinations, of which those remain that take less than half a second of processor time. Cones
and power-law tips without dimensions have no command, so that they are records of problems. In SI
those were left out, 22 of 79, whose answer changes by more than that tenth when all quantities
change by 5e-16 or 7e-16 of themselves: most have two like minima of the force, or a flat one.
"""

import os

for _threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_threads, "1")

import argparse  # noqa: E402
import contextlib  # noqa: E402
import hashlib  # noqa: E402
import io  # noqa: E402
import json  # noqa: E402
import shutil  # noqa: E402
import subprocess  # noqa: E402
import sys  # noqa: E402
import tempfile  # noqa: E402
from collections.abc import Iterator, Mapping  # noqa: E402
from pathlib import Path  # noqa: E402
from typing import Any  # noqa: E402

import numpy  # noqa: E402
import scipy  # noqa: E402
from threadpoolctl import threadpool_info  # noqa: E402

import viscotack  # noqa: E402
from viscotack.__main__ import main as command_line  # noqa: E402

try:
    from viscotack.app.cli import main as command_line
except ImportError:  # what an old commit calls it
    from viscotack.cli import main as command_line

HERE = Path(__file__).parent / "unchanged"
ANSWERS = HERE / "answers.json"
# Differs between two runs of one package, or names it; or is said since, and of no case here.
LEFT_OUT = ("wall_time_s", "versions", "problem", "run_id", "shallow_start")
MEASURED = (
    "pull_off_",
    "work_",
    "contact_radius_",
    "ligament_",
    "crack_speed_",
    "effective_surface_energy",
    "depth_at_pull_off",
)
WORDS = ("outcome", "events")
SHARE, INPUTS = 0.1, 1e-12
# What a case may have been mended by since the record, and which: reason -> names.
MENDED: dict[str, tuple[str, ...]] = {
    "the error of a force on a plateau counts no cubic through its corner": ("punch 040",),
}
LISTED = 12

Answer = dict[str, Any]


def platform() -> dict[str, str]:
    """Return what the last bits of an answer depend on."""
    cores = {p.get("architecture", "") for p in threadpool_info() if p["user_api"] == "blas"}
    return {
        "processor": ", ".join(sorted(cores)),
        "numpy": numpy.__version__,
        "scipy": scipy.__version__,
    }


def cases() -> list[dict[str, Any]]:
    return json.loads((HERE / "cases.json").read_text(encoding="utf-8"))


def answers() -> dict[str, Answer]:
    """Return the answers of the package at hand to all cases, by name."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        for file in (*HERE.glob("*.csv"), *HERE.glob("*.toml")):
            shutil.copy(file, folder)
        return {case["name"]: answer(case) for case in cases()}


def answer(case: Mapping[str, Any]) -> Answer:
    """Return the exit status of a case, its numbers and words, and what its table is.

    Files are read from the working folder, and written there.
    """
    table = Path("curve.csv")
    table.unlink(missing_ok=True)
    status, found = _solved(case, table) if "record" in case else _called(case, table)
    answered: Answer = {"exit": status, "run_id": found.get("run_id"), "values": dict(_flat(found))}
    if table.exists():
        text = table.read_bytes()
        answered["columns"] = text.partition(b"\n")[0].decode()
        answered["table"] = hashlib.sha256(text).hexdigest()[:32]
    return answered


def _called(case: Mapping[str, Any], table: Path) -> tuple[int, dict[str, Any]]:
    arguments = [*case["arguments"], "--json"]
    if case["table"]:
        arguments += ["--csv", str(table)]
    if "toml" in case:
        Path("case.toml").write_text(case["toml"], encoding="utf-8")
    said, status = io.StringIO(), 0
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(io.StringIO()):
        try:
            command_line(arguments)
        except SystemExit as end:
            status = int(end.code or 0)
    return status, json.loads(said.getvalue() or "{}")


def _solved(case: Mapping[str, Any], table: Path) -> tuple[int, dict[str, Any]]:
    """Do what the command line does, for a problem that it cannot state."""
    try:
        problem = viscotack.from_dict(case["record"])
    except ValueError as error:
        return 2, {"status": str(error)}
    result = viscotack.solve(problem, **case["options"], throw=False)
    if case["table"]:
        viscotack.write_csv(result, table)
    stopped = result.outcome == viscotack.Outcome.STOPPED
    return int(stopped), json.loads(json.dumps(viscotack.summary(result)))


def _flat(found: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield numbers and words with their paths; events as their kinds and a hash."""
    for name, value in found.items():
        if name in LEFT_OUT:
            continue
        if name == "events":
            yield "events", "; ".join(event["kind"] for event in value)
            yield "events_hash", hashlib.sha256(json.dumps(value).encode()).hexdigest()[:16]
        elif isinstance(value, dict):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield prefix + name, value


def write(path: Path, found: Mapping[str, Answer]) -> None:
    """Write answers; the names of the numbers stand once for all cases that have the same."""
    kinds = sorted({tuple(a["values"]) for a in found.values()})
    lines = [
        json.dumps({name: a | {"values": [kinds.index(tuple(a["values"])), *a["values"].values()]}})
        for name, a in found.items()
    ]
    head = {"platform": platform(), "version": viscotack.__version__, "kinds": kinds}
    body = ",\n".join(line[1:-1] for line in lines)
    path.write_text(f'{json.dumps(head)[:-1]},\n"answers": {{\n{body}\n}}}}\n', encoding="utf-8")


def read(path: Path) -> tuple[dict[str, str], dict[str, Answer]]:
    """Return the platform of a record and its answers, by the names that numbers have now."""
    from viscotack.problem.older import OUTPUTS, upgraded_output  # an old commit may lack it

    text = path.read_text(encoding="utf-8")
    for name in OUTPUTS:
        text = text.replace(f'"{name}"', f'"{upgraded_output(name)}"')
    record = json.loads(text)
    for found in record["answers"].values():
        kind, *values = found["values"]
        found["values"] = dict(zip(record["kinds"][kind], values, strict=True))
    return record["platform"], record["answers"]


def identical(old: Any, new: Any) -> bool:
    """Return whether numbers agree to the last bit, and words to the letter."""
    return json.dumps(old, sort_keys=True) == json.dumps(new, sort_keys=True)


def stated_error(name: str, values: Mapping[str, Any], accuracy: float) -> float:
    """Return the relative error that an answer states for one of its numbers."""
    work = values.get("error_estimate.work") or accuracy
    force = values.get("error_estimate.force") or accuracy
    if name.startswith("work_"):
        return work
    return force if name.startswith(("pull_off_force", "pull_off_stress")) else max(work, force)


def difference(old: float | None, new: float | None) -> float:
    """Return the relative difference; infinite where one of two is not there."""
    if old is None or new is None:
        return 0.0 if old is new else float("inf")
    return abs(new - old) / max(abs(old), abs(new)) if old != new else 0.0


def complaints(old: Answer, new: Answer, accuracy: float) -> list[str]:
    """Return what of a case in SI is not as it was, within a tenth of its stated error."""
    was, now = old["values"], new["values"]
    if was.keys() != now.keys() or old["exit"] != new["exit"]:
        return [f"exit {old['exit']} and {len(was)} keys, now {new['exit']} and {len(now)}"]
    found = [
        f"{name}: {was[name]}, now {now[name]}" for name in WORDS if was.get(name) != now.get(name)
    ]
    if old.get("columns") != new.get("columns"):
        found.append(f"columns {old.get('columns')}, now {new.get('columns')}")
    for name in was:
        if name.endswith("_note") or not isinstance(was[name], int | float | None):
            continue
        held = name.startswith(MEASURED)
        if not held and ("." in name or name == "energy_residual"):
            continue
        allowed = SHARE * stated_error(name, was, accuracy) if held else INPUTS
        if difference(was[name], now[name]) > allowed:
            found.append(f"{name}: {was[name]!r}, now {now[name]!r}")
    return found


def worst(old: Mapping[str, Answer], new: Mapping[str, Answer]) -> dict[str, tuple[float, float]]:
    """Return the largest difference of each number, and the error that is stated there."""
    found: dict[str, tuple[float, float]] = {}
    for case in cases():
        was, now = old[case["name"]]["values"], new[case["name"]]["values"]
        for name in was:
            if name.startswith(MEASURED) and isinstance(was[name], float):
                off = difference(was[name], now.get(name))
                if off >= found.get(name, (0.0, 0.0))[0]:
                    found[name] = off, stated_error(name, was, case["accuracy"])
    return found


def compare(old: Mapping[str, Answer], new: Mapping[str, Answer]) -> bool:
    """Print what changed; return whether nothing did that should not."""
    old_names, new_names = ([a.pop("run_id") for a in some.values()] for some in (old, new))
    changed: dict[str, list[str]] = {}
    mended = {name for names in MENDED.values() for name in names}
    for case in cases():
        was, now = old[case["name"]], new[case["name"]]
        if "toml" in case:
            found = complaints(was, now, case["accuracy"])
        elif case["name"] in mended:
            found = mended_wrongly(was, now, case["accuracy"])
        else:
            found = first_changes(was, now)
        if found:
            changed[case["name"]] = found
    in_si = [case["name"] for case in cases() if "toml" in case]
    pure = [name for name in old if name not in in_si and name not in mended]
    kept = sum(a == b for a, b in zip(old_names, new_names, strict=True))
    exact = sum(identical(old[name], new[name]) for name in in_si)
    print(f"dimensionless: {_good(pure, changed)} identical to the last bit")
    for reason, names in MENDED.items():
        same = sum(identical(old[name], new[name]) for name in names)
        print(
            f"mended: {_good(list(names), changed)} within their error, {same} identical: {reason}"
        )
    print(f"SI: {_good(in_si, changed)} within a tenth of their stated error, {exact} identical")
    print(f"names of problems by content: {kept} of {len(old)} kept")
    print("largest relative difference, and the error that is stated there")
    for name, (off, error) in worst(old, new).items():
        print(f"  {name:<38}{off:>10.1e}{error:>10.1e}")
    lines = [f"  {name}: {'; '.join(found[:2])}" for name, found in changed.items()]
    print("\n".join([f"{len(lines)} changed", *lines[:LISTED]]))
    return not changed and kept == len(old)


def _good(names: list[str], changed: Mapping[str, list[str]]) -> str:
    return f"{sum(name not in changed for name in names)} of {len(names)}"


def mended_wrongly(old: Answer, new: Answer, accuracy: float) -> list[str]:
    """Return where a case that was mended ended otherwise, or beyond the error of its numbers."""
    was, now = old["values"], new["values"]
    names = [n for n in ("exit",) if old[n] != new[n]]
    names += [n for n in WORDS if was.get(n) != now.get(n)]
    for name in ("pull_off_force", "pull_off_stress", "work_to_pull_off"):
        if name in was:
            allowed = stated_error(name, was, accuracy)
            names += [name] if difference(was[name], now[name]) > allowed else []
    return [f"{n}: {was.get(n)!r}, now {now.get(n)!r}" for n in names]


def first_changes(old: Answer, new: Answer) -> list[str]:
    """Return what of an answer is not as it was, to the last bit."""
    was, now = (a | a["values"] for a in (old, new))
    names = [n for n in {**was, **now} if n != "values" and not n.endswith("_note")]
    names = [n for n in names if not identical(was.get(n), now.get(n))]
    return [f"{n}: {was.get(n)!r}, now {now.get(n)!r}" for n in names]


def recorded_anew(checkout: Path) -> tuple[dict[str, str], dict[str, Answer]]:
    """Return the answers of a checkout on this processor."""
    if not (checkout / "src" / "viscotack").is_dir():
        raise SystemExit(f"{checkout} has no src/viscotack; give a checkout of the old commit")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "answers.json"
        subprocess.run(
            [sys.executable, __file__, "--record", str(file)],
            env=os.environ | {"PYTHONPATH": str((checkout / "src").resolve())},
            check=True,
            stdout=subprocess.DEVNULL,
        )
        return read(file)


def main() -> int:
    """Record, or compare."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--record", type=Path, metavar="FILE")
    parser.add_argument("--against", type=Path, metavar="CHECKOUT")
    given = parser.parse_args()
    if given.record is not None:
        target = given.record.resolve()
        write(target, answers())
        print(f"recorded {target}")
        return 0
    there, old = read(ANSWERS) if given.against is None else recorded_anew(given.against)
    if there != platform():
        print(
            f"recorded on {there}, this is {platform()}: the last bits differ. Compare on one "
            "machine, with --against CHECKOUT of the old commit"
        )
    print(f"the package is {Path(viscotack.__file__).parent}")
    return 0 if compare(old, answers()) else 1


if __name__ == "__main__":
    sys.exit(main())
