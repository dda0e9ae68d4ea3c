"""Tests of the search for designs: forces, margins, limits, what binds and what matters."""

from dataclasses import replace
from math import inf, log, pi

import numpy as np
import pytest

import viscotack as vt
from viscotack.design import Bounds, Choice, DesignSpace, Targets, find_design
from viscotack.design.arrays import grid
from viscotack.design.confirming import simulate
from viscotack.design.fast import SURROGATES, FastTier, Force, Pad
from viscotack.design.limits import solid_limits
from viscotack.design.margins import Judge

RUBBER = vt.RetardationPowerLaw(
    rubbery_modulus=1.5e6, glassy_modulus=15e6, exponent=0.6, tau0=0.1, poisson_ratio=0.5
)
LAW = vt.LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-7)
SPACE = DesignSpace(
    Bounds(1e-3, 4e-3),
    Bounds(4e-3),
    hold_speed=Bounds(1e-4, 1e-3),
    release_speed=Bounds(1e-6, 1e-5),
    pads=Bounds(2),
)
TARGETS = Targets(hold=5e-3, release=2.5e-3)
HOW = {"confirm": 0, "seed": 3}


@pytest.fixture(scope="module")
def fast():
    return FastTier({"rubber": RUBBER}, LAW, SURROGATES)


@pytest.fixture(scope="module")
def found():
    return find_design({"rubber": RUBBER}, LAW, SPACE, TARGETS, **HOW)


@pytest.fixture(scope="module")
def run(found):
    return simulate(found.best, found.fast, Judge(TARGETS), accuracy=0.01)


def grid_of_margins(fast):
    """Return the largest margin of the worst target on a fine grid of radii, at the best speeds."""
    best = -inf
    for radius in np.geomspace(1e-3, 4e-3, 100).tolist():
        one = Judge(TARGETS).judged(Choice("rubber", radius, 4e-3, 2, 1e-3, 1e-6), fast)
        best = max(best, one.margin if not isinstance(one, str) else -inf)
    return best


def test_the_search_finds_the_margin_of_a_fine_grid(fast, found):
    assert found.best.margin == pytest.approx(grid_of_margins(fast), abs=3e-3)
    assert found.best.choice.hold_speed == pytest.approx(1e-3, rel=0.03)
    assert found.best.choice.release_speed == pytest.approx(1e-6, rel=0.03)


def test_hold_and_release_bind_together_with_both_speeds(found):
    assert set(found.binding) == {
        "hold",
        "release",
        "hold_speed at most",
        "release_speed at least",
    }
    margins = found.best.margins
    assert margins["hold"] == pytest.approx(margins["release"], abs=5e-3)


def test_margins_count_the_less_favourable_ends(found):
    best = found.best
    hold, release = best.forces["hold"], best.forces["release"]
    assert best.margins["hold"] == pytest.approx(log(hold.low / 5e-3), rel=1e-12)
    assert best.margins["release"] == pytest.approx(log(2.5e-3 / release.high), rel=1e-12)
    assert best.best_margins["hold"] == pytest.approx(log(hold.high / 5e-3), rel=1e-12)
    ratio = Judge(Targets(ratio=2.0)).margins(best.choice, {"hold": 0.0, "release": 1.0})
    assert ratio["ratio"] == -inf


def test_two_pads_on_a_rigid_plate_hold_what_the_array_holds(found, run):
    choice, fast = found.best.choice, found.fast
    one = fast.problem(Pad("rubber", choice.radius, choice.preload / 2, choice.hold_speed))
    array = vt.PadArray(one, grid(1, 2, 0.1))
    pulled = vt.pull_array(array, speed=choice.hold_speed, preload=choice.preload, accuracy=0.01)
    # another tier, with its own interval
    assert pulled.interval[0] < run.forces["hold"] < pulled.interval[1]
    assert found.best.forces["hold"].low < run.forces["hold"] < found.best.forces["hold"].high


def test_elasticities_are_those_of_other_steps_and_of_scale(found):
    choice, slopes = found.best.choice, found.elasticities["hold"]
    pad = Pad("rubber", choice.radius, choice.preload / 2, choice.hold_speed)
    for name, of in (("radius", "radius"), ("preload", "preload"), ("speed", "hold_speed")):
        ends = [found.fast.force(replace(pad, **{name: getattr(pad, name) * f})) for f in (1, 1.1)]
        assert slopes[of] == pytest.approx(log(ends[1].value / ends[0].value) / log(1.1), abs=0.02)
    assert slopes["pads"] == 1 - slopes["preload"]
    # P/(R dg) is a function of groups: lengths by s, forces by s^2 dg/h0, and speeds by s
    law = replace(LAW, work_of_adhesion=0.1, equilibrium_gap=2e-7)
    scaled = FastTier({"rubber": RUBBER}, law, SURROGATES)
    two = Pad("rubber", 2 * pad.radius, 4 * pad.preload, 2 * pad.speed)
    assert scaled.force(two).value == pytest.approx(4 * found.fast.force(pad).value, rel=1e-9)


def test_the_solid_bounds_forces_and_their_ratio(fast):
    limits = {x.target: x for x in solid_limits(fast, SPACE, TARGETS)}
    jkr = 1.5 * pi * 4e-3 * 0.05 * 2
    assert jkr / 0.1 < limits["hold"].reach < 4 / 3 * jkr / 0.1
    assert 0.25 * jkr < limits["release"].reach < 0.25 * 4 / 3 * jkr
    assert 10 < limits["ratio"].reach < 40 / 3
    speeds = np.geomspace(1e-7, 1, 8).tolist()
    forces = [fast.force(Pad("rubber", 4e-3, 2e-3, v)) for v in speeds]
    known = [2 * x.value for x in forces if isinstance(x, Force)]
    assert len(known) > 4
    assert max(known) < limits["hold"].reach
    assert min(known) > limits["release"].reach


@pytest.mark.parametrize(
    "targets, target, cause, reach",
    [
        (Targets(ratio=20.0), "ratio", "solid", (10, 40 / 3)),
        (Targets(hold=0.2, release=0.1), "hold", "solid", (0.0188, 0.0252)),
        (Targets(release=1e-4), "release", "solid", (4.7e-4, 6.3e-4)),
        # below 1/k, but beyond what the speeds between the bounds reach
        (Targets(hold=12e-3, release=2e-3), "ratio", "speeds", (2, 6)),
    ],
)
def test_targets_out_of_reach_are_refused_with_the_bound(targets, target, cause, reach):
    space = replace(SPACE, hold_speed=Bounds(1e-3), release_speed=Bounds(1e-6))
    found = find_design({"rubber": RUBBER}, LAW, space, targets, seed=1)
    assert found.meets is False
    assert found.best.run is None
    limit = next(x for x in found.excluded if x.target == target)
    assert limit.cause == cause
    # two pads of 1 to 4 mm
    low, high = reach if target != "hold" else (10 * 1.885e-3, 40 / 3 * 1.885e-3)
    assert low < limit.reach < high


def test_a_simulation_decides():
    space = replace(SPACE, radius=Bounds(2e-3), hold_speed=Bounds(1e-3), release_speed=None)
    answers = []
    # the simulated force of 7.39 mN lies inside the interval of the fast tier
    for hold in (7.3e-3, 7.5e-3):
        targets = Targets(hold=hold)
        answers.append(find_design({"rubber": RUBBER}, LAW, space, targets, accuracy=0.01))
    assert [one.best.margin < 0 < one.best.best_margins["hold"] for one in answers] == [True, True]
    assert [one.meets for one in answers] == [True, False]
