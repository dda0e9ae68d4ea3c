"""Compute a dataset again: ``python -m research.datasets NAME --out DIR [--workers N]``."""

import argparse
import sys
from pathlib import Path

from viscotack.campaign import Progress
from viscotack.datasets import NAMES

from .making import make


def _say(progress: Progress) -> None:
    print(f"{progress.done} of {progress.cases}, {progress.failed} failed", file=sys.stderr)


def main() -> None:
    """Run the campaigns and print the path of the file."""
    parser = argparse.ArgumentParser(prog="python -m research.datasets", description=__doc__)
    parser.add_argument("name", choices=NAMES, help="dataset")
    parser.add_argument(
        "--out", type=Path, required=True, help="folder of the campaigns; run again to continue"
    )
    parser.add_argument("--workers", type=int, default=1, help="processes")
    parser.add_argument("--cases", type=int, help="compute only the first cases of the plan")
    given = parser.parse_args()
    print(make(given.name, given.out, workers=given.workers, cases=given.cases, report=_say))


if __name__ == "__main__":
    main()
