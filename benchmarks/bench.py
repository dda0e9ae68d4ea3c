"""All benchmarks, one after the other, as `make bench` runs them: some 30 minutes on two cores."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
PARTS = [
    ("Speed beside the published algorithm", ["speed.py"]),
    ("Accuracy of the default setting", ["accuracy.py"]),
    ("Random cases over the whole range", ["robust.py", "--count", "512", "--until", "detached"]),
    (
        "Random problems with every law",
        ["trust.py", "--count", "60", "--noise", "20", "--finer", "20", "--limit", "20"],
    ),
    ("Cost of a layer beside the half-space", ["layers.py"]),
    ("The flat punch on a layer", ["punch.py"]),
    ("Tests with a history, and other traction laws", ["histories.py"]),
    ("From the rate to the state at pull-off", ["rate_law.py"]),
    ("Tabor numbers of 100", ["large_tabor.py"]),
    ("Beside the version before", ["history.py"]),
    ("What has risen", ["history.py", "--check"]),
    ("Campaigns: speed, overhead, kills, a cluster, a full disk", ["campaign.py"]),
]


def main() -> None:
    """Run every part; stop at the first that fails."""
    for title, (script, *options) in PARTS:
        print(f"\n{title}\n{'-' * len(title)}", flush=True)
        subprocess.run([sys.executable, str(HERE / script), *options], check=True)


if __name__ == "__main__":
    main()
