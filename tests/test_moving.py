"""Measured forces of a lab move a surrogate, in every way of asking it."""

import warnings

import numpy as np
import pytest

from viscotack import OutOfRange, predict, predict_table
from viscotack.model.problem.kinds import KINDS
from viscotack.prediction.surrogate import physics
from viscotack.prediction.surrogate.moving import moved
from viscotack.prediction.surrogate.store import shipped

SOLID = [1.0, 0.05, 0.6]


def rows_of(rates, depth=20.0):
    return np.array([[*SOLID, depth, rate] for rate in rates])


def columns_of(rows, force):
    names = [*physics.INPUTS, "pull_off_force"]
    return dict(zip(names, [*np.asarray(rows).T, force], strict=True))


def learned(rows):
    return shipped().evaluate(rows).pull_off_force


@pytest.fixture(scope="module")
def lab():
    """Six points, 1.2 times the learned force, with some scatter."""
    rows = rows_of(np.geomspace(1.0, 1e3, 6))
    scatter = [1, 1.02, 0.98, 1.01, 1.03, 0.99]
    return moved(shipped(), columns_of(rows, 1.2 * learned(rows) * scatter), error=0.02)


def test_ten_points_halve_the_error_of_a_lab_whose_solid_and_adhesion_differ():
    rates = np.geomspace(0.3, 1e6, 10)
    random = np.random.default_rng(2)

    def truth(rows):
        return 1.15 * learned(rows * [0.9, 1.2, 1.0, 1.0, 4.0])

    measured = truth(rows_of(rates)) * np.exp(0.03 * random.normal(size=10))
    found = moved(shipped(), columns_of(rows_of(rates), measured), error=0.03)
    other = rows_of(np.geomspace(0.5, 5e5, 40), depth=40.0)
    before = np.log(learned(other) / truth(other))
    said = found.evaluate(other)
    after = np.log(said.pull_off_force / truth(other))
    assert np.sqrt(np.mean(after**2)) < 0.5 * np.sqrt(np.mean(before**2))
    held = found.intervals(other, said).pull_off_force
    assert np.mean((held[:, 0] <= truth(other)) & (truth(other) <= held[:, 1])) > 0.8


def test_points_that_agree_change_nothing():
    rates, other = np.geomspace(1.0, 1e3, 6), rows_of([30.0])
    same = moved(shipped(), columns_of(rows_of(rates), learned(rows_of(rates))), error=0.01)
    said = same.evaluate(other)
    assert said.pull_off_force == pytest.approx(learned(other), rel=2e-3)
    before = shipped().intervals(other, said).pull_off_force
    assert np.ptp(same.intervals(other, said).pull_off_force) > np.ptp(before)


def test_intervals_are_wider_far_from_the_points():
    rows = rows_of(np.geomspace(1.0, 1e3, 6))
    force = learned(rows) * [1, 1.2, 0.8, 1.1, 1.3, 0.9]
    found = moved(shipped(), columns_of(rows, force), error=0.01)
    far = np.array([[0.02, 0.5, 1.9, 0.01, 0.02]])
    near, away = (
        np.ptp(np.log(found.intervals(some, found.evaluate(some)).pull_off_force))
        for some in (rows[2:3], far)
    )
    assert away > 1.5 * near


def test_force_work_and_curve_agree_in_a_moved_surrogate(lab):
    inputs = dict(zip(physics.INPUTS, [*SOLID, 20.0, 30.0], strict=True))
    problem = KINDS["sphere"].problem(inputs)
    plain, found = predict(problem), predict(problem, model=lab)
    factor = found.pull_off_force / plain.pull_off_force
    assert factor == pytest.approx(1.2, abs=0.02)
    assert found.work_to_pull_off == pytest.approx(factor * plain.work_to_pull_off)
    assert found.curve.force[-1] == pytest.approx(-found.pull_off_force)
    assert found.curve.depth == pytest.approx(plain.curve.depth)
    # what is compressed is no question of adhesion
    assert found.curve.force[0] == plain.curve.force[0] > 0
    assert (found.method, found.band) == ("surrogate, moved", "not measured")
    assert found.confidence is None
    # the table answers the same, and leaves out what the model does not cover
    table = predict_table(
        {n: [x, x] for n, x in inputs.items()} | {"rate": [30.0, 1e12]}, model=lab
    )
    assert table["pull_off_force"][0] == found.pull_off_force
    assert table["pull_off_force_high"][0] == found.interval[1]
    assert (table["method"][0], table["band"][0]) == ("surrogate, moved", "not measured")
    assert np.isnan(table["pull_off_force"][1]) and "rate" in table["why"][1]
    with pytest.raises(OutOfRange, match="rate"):
        predict(KINDS["sphere"].problem(inputs | {"rate": 1e12}), model=lab)
    with pytest.raises(OutOfRange, match="no joint intervals"):
        predict(problem, model=lab, joint=True)


def test_a_point_twenty_times_off_is_warned_about():
    rows = rows_of(np.geomspace(1.0, 1e3, 6))
    force = 1.2 * learned(rows)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        moved(shipped(), columns_of(rows, force), error=0.03)
    for factor in (20.0, 1 / 20.0):
        odd = force * np.where(np.arange(6) == 3, factor, 1.0)
        with pytest.warns(UserWarning, match="point 3") as caught:
            moved(shipped(), columns_of(rows, odd), error=0.03)
        assert len(caught) == 1
    # points that are all off in the same way, and a single one
    for some in (slice(None), slice(1)):
        with pytest.warns(UserWarning, match="24 times"):
            moved(shipped(), columns_of(rows[some], 20 * force[some]), error=0.03)


def test_a_punch_is_moved_too():
    rows = np.array([[64.85, 3.24, 0.1, 1.0, rate] for rate in (1.0, 10.0, 100.0)])
    punch = shipped("punch")
    stress = 1.1 * punch.evaluate(rows).pull_off_force
    given = dict(zip([*punch.contact.inputs, "pull_off_stress"], [*rows.T, stress], strict=True))
    found = moved(punch, given, error=0.01)
    case = dict(zip(punch.contact.inputs, rows[1].tolist(), strict=True)) | {"cohesion": 0.05}
    answer = predict(KINDS["punch"].problem(case), model=found)
    assert answer.pull_off_stress == pytest.approx(stress[1], rel=5e-3)
    with pytest.raises(ValueError, match="model is of 'punch', the columns are of 'sphere'"):
        predict_table({n: [1.0] for n in physics.INPUTS}, model=found)
