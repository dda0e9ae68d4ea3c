"""Compare a second code: ``python -m research.replication.second_code [--keep]``."""

import argparse
import json
from pathlib import Path

from .compare import agreement

KEPT = Path(__file__).with_name("agreement.json")


def main():
    """Print the rows, and keep them if asked for, with eight significant digits."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--keep", action="store_true", help="write agreement.json")
    keep, found = parser.parse_args().keep, agreement()
    for name, rows in found.items():
        print(name)
        for row in rows:
            row |= {key: float(f"{x:.8g}") for key, x in row.items() if isinstance(x, float)}
            print("  " + "  ".join(f"{key} {x}" for key, x in row.items()))
    if keep:
        KEPT.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
