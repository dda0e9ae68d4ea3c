"""Campaigns and sweeps of rough surfaces: inputs, plans, rows, and what is refused."""

from pathlib import Path

import numpy as np
import pytest

from test_rough_file import BUMPS, MAP, SMALL
from viscotack.campaign import CaseSettings, measure, read_plan
from viscotack.errors import InputError
from viscotack.simulate.rough import pull, read_rough, read_rough_case

PLAN = """
problem = "bumps.toml"
settings = {accuracy = 0.02}
[[grid]]
surface.scatter = ["0 um", "1 um"]
protocol.speed = ["10 um/s", 1e-4]
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Return a folder to work in, with a plan, a rough surface and a measured map."""
    monkeypatch.chdir(tmp_path)
    Path("plan.toml").write_text(PLAN)
    Path("bumps.toml").write_text(SMALL.replace(MAP, BUMPS))
    Path("measured.toml").write_text(SMALL)
    x = np.linspace(-1, 1, 16)
    np.savetxt("map.csv", 2 - 2 * np.add.outer(x**2, x**2), delimiter=",")
    return tmp_path


def test_a_plan_sets_numbers_of_the_surface_and_of_the_test(folder):
    plan = read_plan("plan.toml")
    assert plan.kind.columns == ("protocol.speed", "surface.scatter")
    assert len(plan.cases) == 4 and plan.rejected == 0
    last = list(plan.cases)[-1]
    case = plan.kind.problem(last.inputs)
    assert case.surface.scatter == 1e-6 and case.protocol.speed == 1e-4
    row = measure(case, plan.settings)
    found = pull(read_rough("bumps.toml"), accuracy=0.02)
    assert row["pull_off_force_N"] != found.pull_off_force
    same = measure(read_rough_case("bumps.toml"), plan.settings)
    assert same["pull_off_force_N"] == found.pull_off_force
    assert same["work_of_separation_J"] == found.work_of_separation
    assert same["hysteresis_J"] == found.hysteresis and same["status"] == found.status
    assert {"contact_share_at_pull_off", "pastewka_robbins", "steps", "versions"} <= same.keys()


def test_a_map_that_has_changed_since_is_refused(folder):
    case = read_rough_case("measured.toml")
    assert len(case.surface.sha256) == 64
    np.savetxt("map.csv", np.zeros((16, 16)), delimiter=",")
    with pytest.raises(InputError, match=r"map\.csv has changed since it was planned"):
        measure(case, CaseSettings())
