"""Compare a second code: ``python -m research.replication.second_code [--keep]``."""

import argparse
import json
from pathlib import Path

from .compare import agreement

KEPT = Path(__file__).with_name("agreement.json")


def rounded(value):
    """Return a value with eight significant digits."""
    return float(f"{value:.8g}") if isinstance(value, float) else value


def main():
    """Print the rows, and keep them if asked for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--keep", action="store_true", help="write agreement.json")
    asked = parser.parse_args()
    found = {
        name: [{key: rounded(x) for key, x in row.items()} for row in rows]
        for name, rows in agreement().items()
    }
    for name, rows in found.items():
        print(name)
        for row in rows:
            print("  " + "  ".join(f"{key} {x}" for key, x in row.items()))
    if asked.keep:
        KEPT.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
    raise SystemExit(0)
