"""Runs on a grid that are interrupted and continue from a checkpoint, to the same digits."""

import os
import signal
import subprocess
import sys
from typing import Any

import numpy as np
import pytest

import viscotack as vt
from solids import standard_solid
from viscotack.model.surfaces import self_affine
from viscotack.simulate.rough import RoughProblem, pull

# A stopped script: it says how far it is, and does not end by itself before it is killed.
SCRIPT = """
import sys
from test_rough_checkpoint import problem
from viscotack.simulate.rough import pull

def told(share):
    print(share, flush=True)
    if share > float(sys.argv[2]):
        sys.stdin.read()

pull(problem(), accuracy=0.02, maps=6, checkpoint=sys.argv[1], every=0.0, progress=told)
"""


HOW: Any = {"accuracy": 0.02, "maps": 6}


def problem(pixels=24, height=2.5e-6, *, apart=True, body=None, **kind):
    """Return a rough map, with an approach, a dwell, a spring and jumps if it starts apart."""
    surface = self_affine(pixels, 1e-5, hurst=0.8, rms_height=height, seed=3, shortest=8e-5, **kind)
    law = vt.LennardJones(work_of_adhesion=0.15, equilibrium_gap=1.5e-6)
    full = law.strength * surface.area
    history = vt.Retraction(vt.AtForce(0.02 * full), 2e-5)
    if apart:
        moves = vt.Approach(2e-5, vt.AtForce(0.02 * full)), vt.Dwell(0.1)
        history = vt.Retraction(vt.Apart(6e-6), 2e-5, moves, 2 * full / 1.5e-6)
    solid = standard_solid(1.5e6, 15e6, 0.1, 0.5)
    return RoughProblem(surface, solid, law, history, body or vt.HalfSpace())


@pytest.fixture(scope="module")
def whole():
    """Return the uninterrupted answer."""
    return pull(problem(), **HOW)


def assert_same(found, whole):
    """Compare all digits of two answers."""
    assert found.rows() == whole.rows()
    assert found.summary == whole.summary
    assert found.error_estimate == whole.error_estimate
    assert found.events == whole.events
    maps = zip((found.strongest, *found.maps), (whole.strongest, *whole.maps), strict=True)
    for one, other in maps:
        assert np.array_equal(one.gap, other.gap)
        assert np.array_equal(one.pressure, other.pressure)


def test_maps_are_kept_of_the_strongest_pull_and_at_even_steps_from_the_start(whole):
    assert whole.strongest.force == whole.force.min()
    places = np.searchsorted(whole.time, [each.time for each in whole.maps])
    assert 3 <= len(places) <= 6 and places[0] == 0 and np.ptp(np.diff(places)) == 0


@pytest.mark.parametrize("share", [0.3, pytest.param(0.8, marks=pytest.mark.slow)])
def test_a_killed_run_continues_to_the_same_digits(tmp_path, whole, share):
    # in the retraction of the run, and after it
    path = tmp_path / "run.npz"
    child = subprocess.Popen(
        [sys.executable, "-c", SCRIPT, str(path), str(share)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},
        text=True,
    )
    assert child.stdin is not None and child.stdout is not None
    for line in child.stdout:
        if float(line) > share:
            break
    child.send_signal(signal.SIGKILL)
    child.communicate()
    begun = []
    found = pull(problem(), **HOW, checkpoint=path, every=1e9, progress=begun.append)
    assert begun[0] >= share  # no step was lost
    assert_same(found, whole)
    again = []
    assert_same(pull(problem(), **HOW, checkpoint=path, progress=again.append), whole)
    assert min(again) > 0.65  # the finished run is in the file; those for its errors are not
