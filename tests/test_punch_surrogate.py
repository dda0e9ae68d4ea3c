"""The learned punch on a layer: its limits, what it is worth, where it ends, and its doors."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

import viscotack as vt
from dimensionless import resized
from solids import standard_solid
from viscotack.prediction.surrogate import punch_physics as physics
from viscotack.prediction.surrogate import store
from viscotack.prediction.tiers import AT_ONCE, SOON

SOLID = {"rubbery_modulus": 1.5e6, "glassy_modulus": 15e6, "poisson_ratio": 0.5}
# A pad of SI units, in the middle of the range.
PAD = vt.Problem(
    material=vt.StandardSolid(**SOLID, tau0=0.1),
    traction=vt.LennardJones(work_of_adhesion=0.15, equilibrium_gap=1.5e-6),
    geometry=vt.FlatPunch(half_width=1e-3),
    body=vt.Layer(thickness=200e-6),
    protocol=vt.Retraction(start=vt.AtDepth(1.5e-6), speed=100e-6),
)


def shipped():
    return store.shipped("punch")


def random_rows(count, seed=1):
    """Return inputs spread over the whole range."""
    low, high = np.log10(physics.LOW), np.log10(physics.HIGH)
    rows = 10 ** (low + np.random.default_rng(seed).random((count, 5)) * (high - low))
    rows[:, physics.PRELOAD] *= physics.compliance(rows)
    return rows


def punch_of(size=64.85, thickness=3.24, ratio=0.1, start=None, rate=10.0, **others):
    """Return a punch without dimensions."""
    solid = standard_solid(1.0, 1 / ratio, 1.0, 0.0)
    parts = {"material": solid, "cohesion": 0.05, "start": start or vt.AtDepth(1.0), "rate": rate}
    punch = vt.Groups(tabor=None, geometry=vt.FlatPunch(size), body=vt.Layer(thickness), **parts)
    return resized(punch, **others)


# by construction
def test_no_stress_leaves_its_limits():
    surrogate, rows = shipped(), random_rows(2000)
    tests = surrogate.tests(rows)
    slow, fast = tests.slow, tests.fast
    stress = surrogate.evaluate(rows).pull_off_force
    # where both limits are one, the way between them has a least length
    assert np.all(np.log10(stress) >= slow.min(axis=0) - 1e-12)
    assert np.all(np.log10(stress) <= fast.max(axis=0) + 1e-4)
    assert np.all(stress <= 10**1e-4)


def test_the_curve_ends_at_the_stress_and_its_area_is_the_work():
    surrogate, rows = shipped(), random_rows(300)
    said = surrogate.evaluate(rows)
    curves = surrogate.curves(rows, said)
    assert curves.force[:, -1] == pytest.approx(-said.pull_off_force, rel=1e-9)
    assert curves.depth[:, 0] == pytest.approx(rows[:, physics.PRELOAD])
    assert curves.force[:, 0] == pytest.approx(surrogate.tests(rows).start[0], rel=1e-9)
    assert np.all(curves.contact_radius <= rows[:, [physics.SIZE]])
    travel = curves.depth[:, 8:9] - curves.depth[:, 8:]
    areas = [
        -PchipInterpolator(x, f).integrate(0, x[-1])
        for x, f in zip(travel, curves.force[:, 8:], strict=True)
    ]
    # sigma0 h0 in dg0; by another rule of integration
    off = np.abs(np.array(areas) * physics.STRENGTH / said.work_to_pull_off - 1)
    assert np.median(off) < 5e-4


def test_si_and_groups_cohesion_and_one_branch_change_nothing():
    one = vt.predict(PAD)
    groups = PAD.groups()
    branch = vt.Prony(
        rubbery_modulus=1.5e6,
        branches=[(13.5e6, 0.1 * PAD.material.modulus_ratio)],
        poisson_ratio=0.5,
    )
    for same in (groups, replace(groups, cohesion=0.3), replace(PAD, material=branch)):
        assert vt.predict(same).pull_off_force == pytest.approx(one.pull_off_force, rel=1e-12)
    said = vt.prediction_summary(one)
    assert said["pull_off_stress_Pa"] == pytest.approx(one.pull_off_force * PAD.traction.strength)
    assert said["work_to_pull_off_J_per_m2"] == pytest.approx(0.15 * one.work_to_pull_off)
    assert said["ligament_at_pull_off_m"] == pytest.approx(1e-3 * said["ligament_at_pull_off"])
    assert said["method"] == "surrogate of punches" and said["inside"]


# limits and order
def test_thin_and_thick_elastic_layers_are_those_of_theory():
    """With a0 beside a and b the strength caps what a crack asks for; far from it both are one."""
    rows = np.array([[200.0, 20.0, 0.1, 1.0, 1.0], [100.0, 1000.0, 0.1, 1.0, 1.0]])
    slow = 10 ** shipped().tests(rows).slow.mean(axis=0)
    thin, thick = np.sqrt(4 / (np.pi * 20.0)) * (1 + 0.177 * 0.1), 1 / np.sqrt(100.0)
    # a finite zone takes 3 to 8 % (docs/punch.md)
    assert slow == pytest.approx([thin, thick], rel=0.09)
    assert np.all(slow < [thin, thick])


def test_a_slow_pull_off_tends_to_that_of_the_relaxed_layer_as_the_rate():
    rows = random_rows(300, seed=4)
    # cracks of wide punches run away at the end, and are slow at no rate of this range
    rows[:, physics.SIZE] = np.clip(rows[:, physics.SIZE], 1.0, 5.0)
    slow = 10 ** shipped().tests(rows).slow.mean(axis=0)
    excess = []
    for rate in (1e-3, 1e-2):
        rows[:, physics.RATE] = rate
        excess.append(shipped().evaluate(rows).pull_off_force / slow - 1)
    assert np.all(np.quantile(excess[0], [0.5, 0.95]) < [2e-3, 5e-3])
    power = np.log10(np.median(excess[1]) / np.median(excess[0]))
    # three of them simulated: 0.92 to 0.97; half a per mille of the stress is what networks err by
    assert power == pytest.approx(0.94, abs=0.2)


def test_a_fast_pull_off_tends_to_that_of_a_layer_that_does_not_relax():
    rows = random_rows(300, seed=5)
    rows[:, physics.RATE] = physics.HIGH[physics.RATE]
    fast = 10 ** shipped().tests(rows).fast.mean(axis=0)
    off = 1 - shipped().evaluate(rows).pull_off_force / fast
    assert np.median(off) < 5e-4 and np.quantile(off, 0.95) < 5e-3


# simulation
@pytest.mark.parametrize(
    "case",
    [
        punch_of(64.85, 3.24, 0.1, vt.AtDepth(1.0), 10.0),
        punch_of(8.0, 40.0, 0.02, vt.AtForce(0.5), 3.0),
    ],
)
def test_a_simulation_lies_in_the_intervals(case):
    found = vt.predict(case, confidence=0.98)
    result = vt.solve(case, accuracy=5e-4, until="pull-off")
    said = vt.summary(result)
    low, high = found.interval
    assert low < said["pull_off_stress"] < high
    assert found.pull_off_force == pytest.approx(said["pull_off_stress"], rel=5e-3)
    low, high = found.work_interval
    assert low < said["work_to_pull_off"] < high
    low, high = vt.predict(case).depth_interval
    assert low < said["depth_at_pull_off"] < high < low + 0.1 * np.ptp(found.curve.depth)
    assert found.curve is not None and found.curve_band is not None
    # the stress at the same travel from zero stress
    depth, force = result.depth, result.force
    zero = np.interp(0.0, -force[: np.argmin(force)], -depth[: np.argmin(force)])
    travel = -depth[: np.argmin(force)] - zero
    curve = found.curve
    known = np.interp(curve.depth[8] - curve.depth[8:], travel, force[: np.argmin(force)])
    assert np.abs(known - curve.force[8:]).max() < 1.5 * found.curve_band


def test_test_rows_are_predicted_within_the_documented_errors():
    pytest.importorskip("pyarrow", reason="datasets are stored in Parquet")
    from research.training.rows import joined
    from research.training.train_punch import LEARNED, parts, read, scored

    rows = joined([one.chosen(parts(len(one))[1]) for one in map(read, LEARNED)])
    found = scored(shipped(), rows)
    assert found["stress"]["median"] < 1e-3 and found["stress"]["95 %"] < 5e-3
    assert found["work"]["median"] < 3e-3
    # levels of stress hold where it has two maxima and under wide punches too, those of curves
    # between stored points too: 98.04 % of these 153 stresses
    for name, most in (("stress", 0.985), ("work", 0.95), ("curve", 0.97), ("travel", 0.95)):
        assert 0.86 < found[name]["cover"] < most, name


# where it ends
def test_what_was_not_learned_is_refused_by_name():
    glued = punch_of(base=vt.Bonded(poisson_ratio=0.4))
    branches = vt.Prony(rubbery_modulus=1.0, branches=[(4.0, 0.1), (5.0, 1.0)], poisson_ratio=0.0)
    for name, case in (
        ("size is 640 a0", punch_of(size=640.0, rate=1e9)),
        ("modulus_ratio is 0.8", punch_of(ratio=0.8)),
        ("preload_force is 50 sigma0", punch_of(start=vt.AtForce(50.0))),
        ("the body is bonded", glued),
        ("the solid has 2 branches", punch_of(material=branches)),
        ("the traction law is dugdale", punch_of(traction=vt.Dugdale(1.0, 1.0))),
        ("the machine moves before", punch_of(moves=(vt.Dwell(1.0),))),
        ("a stiffness of 2", punch_of(stiffness=2.0)),
    ):
        for budget in (AT_ONCE, SOON):
            with pytest.raises(vt.OutOfRange, match=name):
                vt.predict(case, budget=budget)


def test_rows_of_a_table_are_those_of_single_predictions():
    columns = {"size": 64.85, "thickness": 3.24, "cohesion": 0.05, "modulus_ratio": 0.1}
    rates = np.array([10.0, 1e9, 0.1, -1.0, np.nan])
    table = {name: np.full(5, value) for name, value in columns.items()}
    for start, of in (("preload", vt.AtDepth), ("preload_force", vt.AtForce)):
        found = vt.predict_table(table | {start: np.ones(5), "rate": rates})
        assert found["inside"].tolist() == [True, False, True, False, False]
        for i in (0, 2):
            one = vt.predict(punch_of(start=of(1.0), rate=rates[i]))
            row = [found[f"pull_off_stress{end}"][i] for end in ("", "_low", "_high")]
            assert row == pytest.approx([one.pull_off_force, *one.interval], rel=1e-12)
            assert found["method"][i] == one.method and found["band"][i] == one.band
        assert "rate is 1e+09" in found["why"][1] and np.isnan(found["pull_off_stress"][1])
        assert "rate must be positive" in found["why"][3]
    no_cohesion = table | {"cohesion": np.zeros(5), "preload": np.ones(5), "rate": rates}
    assert not vt.predict_table(no_cohesion)["inside"].any()
