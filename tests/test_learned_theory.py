"""Large Tabor numbers: what was learned from the theory of a crack at the edge, and its band."""

from dataclasses import replace

import numpy as np
import pytest

import viscotack as vt
from solids import creep_power_law
from viscotack.model.problem.rows import KINDS
from viscotack.prediction.surrogate import short_range, store
from viscotack.prediction.surrogate.physics import INPUTS
from viscotack.prediction.tiers import AT_ONCE
from viscotack.theory import lennard_jones

CASE = {"tabor": 300.0, "modulus_ratio": 0.05, "exponent": 0.6, "preload": 3000.0, "rate": 3000.0}


def shipped():
    return store.shipped("short range")


def answered(rows):
    """Return which rows are in the range, and have an answer of the theory."""
    tests = shipped().tests(rows)
    return tests.inside().all(axis=1) & tests.holds(shipped().evaluate(tests))


def problem(**changed):
    return KINDS["sphere"].problem(CASE | changed)


def drawn(count, seed=0):
    low, high = np.log(short_range.LOW), np.log(short_range.HIGH)
    rows = np.exp(np.random.default_rng(seed).uniform(low, high, (count, 5)))
    rows[:, 3:] *= rows[:, :1]
    return rows


def test_no_force_leaves_the_slowest_and_the_fastest():
    rows = drawn(2000)
    force = shipped().evaluate(rows).pull_off_force
    mu, k = rows[:, 0], rows[:, 1]
    assert np.all(force >= lennard_jones.pull_off_ratio(mu) * (1 - 1e-9))
    assert np.all(force <= lennard_jones.pull_off_ratio(mu * np.cbrt(k)) / k * (1 + 1e-9))


def test_it_is_silent_where_the_theory_is():
    # a start of a light touch, pulled so fast that the edge goes no zone
    row = np.array([[20.0, 1e-3, 0.6, 3.0, 1e7]])
    assert shipped().inside(row).all() and not answered(row)[0]
    with pytest.raises(vt.OutOfRange, match="zones? "):
        vt.crack_contact(problem(**dict(zip(INPUTS, row[0].tolist(), strict=True))))
    for column, value in ((0, 9.0), (1, 0.8), (2, 2.2), (3, 1.0), (4, 1e-9)):
        out = np.array([list(CASE.values())])
        assert answered(out)[0]
        out[0, column] = value
        assert not answered(out)[0]


def test_a_cone_is_answered_where_simulations_were_compared():
    # from modulus ratios of 0.03 on
    cone = replace(problem(tabor=30.0, rate=30.0, modulus_ratio=0.01), geometry=vt.Cone(1.0))
    with pytest.raises(vt.OutOfRange, match="modulus_ratio is 0.01"):
        vt.predict(cone)


def test_many_cases_of_a_solid_are_answered_at_once_as_alone():
    from viscotack.simulate.crack_contact.by_crack import crack_contacts

    cases = [problem(rate=rate) for rate in (30.0, 3000.0)] + [problem(tabor=1.5)]
    together = crack_contacts([case.groups() for case in cases])
    for case, found in zip(cases[:2], together, strict=False):
        alone = vt.crack_contact(case).pull_off_force
        assert found.pull_off_force == pytest.approx(alone, rel=1e-5, abs=0)
    assert isinstance(together[2], vt.OutOfRange)
    with pytest.raises(vt.InputError, match="same material"):
        crack_contacts([cases[0].groups(), problem(exponent=1.0).groups()])
    assert crack_contacts([]) == []


@pytest.mark.parametrize("changed", [{}, {"tabor": 30.0, "rate": 30.0, "preload": 100.0}])
def test_force_work_and_curve_agree_with_the_theory(changed):
    from viscotack.simulate.crack_contact.by_crack import unloading

    case = problem(**changed)
    said, theory = vt.predict(case), vt.crack_contact(case)
    assert said.method == "learned crack contact" and said.inside
    assert said.interval[0] <= theory.pull_off_force <= said.interval[1]
    assert said.pull_off_force == pytest.approx(theory.pull_off_force, rel=0.05, abs=0)
    low, high = said.work_interval
    assert low <= theory.work_to_pull_off <= high and high / low < 1.15
    points, _ = unloading(theory)
    depth = theory.depth_at_pull_off + points[0]
    off = np.interp(depth[8:], said.curve.depth[::-1], said.curve.force[::-1]) - points[1, 8:]
    assert np.max(np.abs(off)) < said.curve_band
    assert said.curve.force[-1] == pytest.approx(-said.pull_off_force)
    start = said.curve.force[0], said.curve.contact_radius[0]
    assert start == pytest.approx((theory.force[0], theory.contact_radius[0]))


def test_works_on_which_the_networks_differ_are_withheld():
    # a work jumps where the pull is as fast as the bulk relaxes
    rates = np.geomspace(3.0, 3e4, 60)
    rows = np.array([[700.0, 2e-4, 1.5, 3600.0, 700.0 * rate] for rate in rates])
    tests = shipped().tests(rows)
    said = shipped().evaluate(tests)
    kept = tests.holds(said) & tests.inside().all(axis=1)
    withheld = kept & ~tests.agree(said)
    assert 0 < withheld.sum() < kept.sum()
    row = dict(zip(INPUTS, rows[np.flatnonzero(withheld)[0]].tolist(), strict=True))
    answer = vt.predict(problem(**row), budget=AT_ONCE)
    assert answer.work_to_pull_off is None and answer.curve is None


def test_force_and_work_are_continuous_at_a_tabor_number_of_ten():
    solid = creep_power_law(1.0, 20.0, 0.6, 1.0, 0.0)

    def said(tabor):
        start = vt.AtDepth(200.0)
        return vt.predict(vt.Groups(tabor=tabor, material=solid, start=start, rate=300.0))

    below, above = said(10 * (1 - 1e-7)), said(10 * (1 + 1e-7))
    assert (below.method, above.method) == ("surrogate", "learned crack contact")
    assert above.pull_off_force == pytest.approx(below.pull_off_force, rel=1e-6)
    assert above.work_to_pull_off == pytest.approx(below.work_to_pull_off, rel=1e-5)
    assert above.curve.depth == pytest.approx(
        below.curve.depth, abs=0.05 * np.ptp(below.curve.depth)
    )
    # where the surrogate ends, and where the factor between both fades
    for seam in (19.999, 20.001):
        assert said(seam).pull_off_force == pytest.approx(said(20.0).pull_off_force, rel=1e-3)
