"""Campaigns and pools work without the names of POSIX, as far as this system can show it.

The names are taken away in the process and its workers by tests/without_posix. It is no Windows:
what its own kernel does is not run here.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
PLAN = """
[settings]
accuracy = 0.02
[[grid]]
tabor = 1.0
modulus_ratio = 0.1
exponent = [0.4, 0.8]
preload = 5.0
rate = {{ log = [1.0, 100.0], count = {} }}
"""


def environment():
    """Return the environment of a Python without the names of POSIX."""
    paths = [str(HERE / "without_posix"), *filter(None, [os.environ.get("PYTHONPATH")])]
    return os.environ | {"PYTHONPATH": os.pathsep.join(paths)}


def bare(program, folder):
    """Run a program, or a command of viscotack, without the names of POSIX."""
    return subprocess.run(
        [sys.executable, *program],
        cwd=folder,
        env=environment(),
        capture_output=True,
        text=True,
        timeout=300,
    )


@pytest.mark.slow
def test_a_campaign_runs_and_goes_on(tmp_path):
    (tmp_path / "plan.toml").write_text(PLAN.format(3), encoding="utf-8")
    command = ["-m", "viscotack", "campaign", "run", "plan.toml", "--out", "c", "--workers", "2"]
    told = bare(command, tmp_path)
    assert told.returncode == 0, told.stderr
    told = bare(["-m", "viscotack", "campaign", "status", "c", "--json"], tmp_path)
    assert told.returncode == 0, told.stderr
    assert json.loads(told.stdout)["done"] == 6
    told = bare(["-m", "viscotack", "campaign", "verify", "c"], tmp_path)
    assert told.returncode == 0, told.stderr


def test_tasks_report_and_are_interrupted(tmp_path):
    tests = "progress or is_interrupted_and_its_process_is_kept"
    options = ["-q", "-p", "no:cacheprovider", "--rootdir", str(HERE.parent), "-k", tests]
    told = bare(["-m", "pytest", *options, str(HERE / "test_pool.py")], tmp_path)
    assert told.returncode == 0 and "4 passed" in told.stdout, told.stdout
