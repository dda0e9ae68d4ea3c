"""Command `python -m release.static_page FOLDER`, from the root of a checkout."""

import argparse
import sys
from pathlib import Path

from . import write


def main() -> int:
    """Write the page and print its size."""
    parser = argparse.ArgumentParser(prog="python -m release.static_page", description=__doc__)
    parser.add_argument("folder", type=Path, help="output folder")
    folder = parser.parse_args().folder
    write(folder)
    size = sum(path.stat().st_size for path in folder.iterdir())
    print(f"{folder}: {size / 1e6:.1f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
