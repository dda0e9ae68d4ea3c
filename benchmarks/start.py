"""Processor time that commands take to start, beside an import of NumPy.

`python benchmarks/start.py [--runs 9] [--source CHECKOUT/src]`: every command runs in a process of
its own, all of them once a round, so that a busy machine slows them alike; the least processor time
of the rounds is printed, and its ratio to that of `import numpy`. `python -X importtime -m
viscotack --help` lists the modules.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

_PROBLEM = "sphere --tabor 1 --modulus-ratio 0.1 --exponent 0.6 --preload 1 --rate 10"
_COMMANDS = (
    "--help",
    "theory --help",
    "predict --help",
    "simulate sphere --help",
    f"predict {_PROBLEM}",
    f"simulate {_PROBLEM} --until pull-off",
)
PROGRAMS = {
    "import numpy": ["-c", "import numpy"],
    "import viscotack": ["-c", "import viscotack"],
    **{f"viscotack {words}": ["-m", "viscotack", *words.split()] for words in _COMMANDS},
}


def processor_time(arguments: list[str], environment: dict[str, str]) -> float:
    """User and system time [s] of one process of Python."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [sys.executable, *arguments]
    subprocess.run(command, env=environment, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=9, help="rounds")
    parser.add_argument("--source", default="", help="folder of another version of the package")
    parser.add_argument("--record", action="store_true", help="record the ratios for the docs")
    given = parser.parse_args()
    environment = os.environ | ({"PYTHONPATH": given.source} if given.source else {})
    rounds = [
        {name: processor_time(words, environment) for name, words in PROGRAMS.items()}
        for _ in range(given.runs)
    ]
    least = {name: min(each[name] for each in rounds) for name in PROGRAMS}
    if given.record:
        rows = [
            f"| `{name.replace(_PROBLEM, 'sphere ...')}` | {time / least['import numpy']:.1f} |"
            for name, time in least.items()
            if name != "import numpy"
        ]
        head = ["| program | beside an import of NumPy |", "|---|---:|"]
        print(json.dumps({"table": head + rows}, indent=1))
    print("| program | processor time | beside numpy |\n|---|---:|---:|")
    for name, time in least.items():
        print(f"| `{name}` | {time:.3f} s | {time / least['import numpy']:.1f} |")


if __name__ == "__main__":
    main()
