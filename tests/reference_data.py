"""What others computed or measured, for the tests to compare with: `tests/data`, and its README."""

import json
from pathlib import Path

import pytest

DATA = Path(__file__).parent / "data"
# dynamic and relaxation tests of a laboratory
DMA = DATA / "dma_published"
# verified values of numbered equations: equation, inputs, value, note
VALUES = json.loads((DATA / "reference.json").read_text(encoding="utf-8"))["values"]


def reference(*equations):
    """Return the verified values of some equations, a case of a test each."""
    missing = set(equations) - {row["equation"] for row in VALUES}
    assert not missing, f"reference.json has no value of {', '.join(sorted(missing))}"
    return [
        pytest.param(row, id=f"{row['equation']}-{row['id']}")
        for row in VALUES
        if row["equation"] in equations
    ]
