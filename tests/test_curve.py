import numpy as np
import pytest

import synthetic
import viscotack as vt
from dimensionless import ELASTIC, punch
from viscotack.campaign import CaseSettings, measure
from viscotack.result.curve import KEY_SHARES, curve

QUICK = CaseSettings(accuracy=0.02, until="pull-off")


def exact_force(depth):
    """Return the JKR force at depths on the branch in contact."""
    a = np.linspace(0.6, 3.0, 200_001)
    return np.interp(depth, synthetic.jkr_depth(a), synthetic.jkr_force(a))


def test_key_points_and_trajectory_lie_on_the_curve():
    result = synthetic.jkr_result(steps=400, end=0.7)
    row = curve(result, vt.pull_off(result))
    start, travel = result.depth[0], row["travel_to_pull_off"]
    assert travel == pytest.approx(start - synthetic.PULL_OFF_DEPTH, rel=1e-4)
    assert KEY_SHARES == {"25": 0.25, "50": 0.5, "75": 0.75, "87_5": 0.875}
    for name, share in (("25", 0.25), ("50", 0.5), ("75", 0.75), ("87_5", 0.875)):
        exact = exact_force(start - share * travel)
        assert row[f"force_at_{name}"] == pytest.approx(exact, rel=1e-4, abs=1e-4)
    depth, force = (np.array(row[f"trajectory_{name}"]) for name in ("depth", "force"))
    radius = np.array(row["trajectory_contact_radius"])
    assert len(depth) == 24 and depth[0] == start and force[0] == result.force[0]
    assert force == pytest.approx(exact_force(depth), abs=1e-3)
    assert synthetic.jkr_depth(radius) == pytest.approx(depth, rel=1e-3, abs=1e-2)
    assert force[-1] == -vt.pull_off_force(result) == force.min()
    assert np.diff(depth[:9], 2).min() > 0 and np.diff(depth[8:], 2).min() > 0, "ends are gathered"
    assert force[8] == pytest.approx(0, abs=1e-12) and np.all(force[:8] > 0), "tension has 16"


@pytest.mark.parametrize("deeper_first", [True, False])
def test_the_curve_of_a_history_is_that_of_its_last_opening(deeper_first):
    depths = (4.0, 2.0) if deeper_first else (2.0, 4.0)
    first, last = (vt.Approach(20.0, vt.AtDepth(depth)) for depth in depths)
    groups = vt.Groups(
        tabor=0.5,
        material=vt.Elastic(rubbery_modulus=1.0, poisson_ratio=0.0),
        start=vt.Apart(15.0),
        moves=(first, vt.Retract(1.0, vt.AtDepth(-14.0)), last),
        rate=1.0,
    )
    row = measure(groups, QUICK)
    assert row["trajectory_depth"][0] == pytest.approx(depths[1])
    assert row["travel_to_pull_off"] == pytest.approx(depths[1] - row["depth_at_pull_off"])
    assert np.all(np.diff(row["trajectory_depth"]) < 0)


def test_the_curve_of_a_punch_counts_tension_positive():
    row = measure(punch(vt.AtDepth(1.0), rate=1.0, material=ELASTIC), QUICK)
    stress = np.array(row["trajectory_stress"])
    assert stress[-1] == row["pull_off_stress"] == stress.max() > 0
    share = (row["trajectory_depth"][0] - np.array(row["trajectory_depth"])) / (
        row["travel_to_pull_off"]
    )
    assert row["stress_at_50"] == pytest.approx(np.interp(0.5, share, stress), rel=0.02)


def test_the_curve_of_a_problem_in_si_has_each_column_in_si_too():
    lens = vt.Problem(
        material=vt.Elastic(rubbery_modulus=1e6, poisson_ratio=0.5),
        traction=vt.LennardJones(work_of_adhesion=0.05, equilibrium_gap=2e-6),
        geometry=vt.Sphere(1e-3),
        protocol=vt.Retraction(start=vt.AtDepth(2e-6), speed=1e-5),
    )
    row, scales = measure(lens, QUICK), lens.scales()
    names = [name for name in row if name.startswith(("travel", "force_at", "trajectory"))]
    plain = [name for name in names if not name.endswith(("_m", "_N"))]
    assert len(names) == 2 * len(plain) == 16
    for name in plain:
        tail, unit = ("N", scales.force) if "force" in name else ("m", scales.length)
        unit = scales.radius if "radius" in name else unit
        assert row[f"{name}_{tail}"] == pytest.approx(np.multiply(row[name], unit))
    assert row["trajectory_force_N"][-1] == -row["pull_off_force_N"]
