"""A start so deep that its depth no longer matters: where the march begins, and what is said."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import viscotack as vt
from viscotack.model.problem.accuracy import DEFAULT_ACCURACY
from viscotack.simulate import Settings, preload
from viscotack.simulate.solver import contact_of

pytestmark = pytest.mark.march

COMMON = {"rubbery_modulus": 1.0, "poisson_ratio": 0.0}
ELASTIC = vt.Elastic(**COMMON)
SOLID = vt.StandardSolid(**COMMON, glassy_modulus=10.0, tau0=1.0)
ENDLESS = vt.RelaxationPowerLaw(**COMMON, glassy_modulus=10.0, exponent=0.2, tau0=1.0)


def case(start=1e6, tabor=1.0, rate=1.0, material=SOLID, **more):
    start = vt.AtDepth(start) if isinstance(start, int | float) else start
    return vt.Groups(tabor=tabor, material=material, start=start, rate=rate, **more)


def pulled(problem, **options):
    return vt.solve(problem, **({"accuracy": 0.02, "until": "pull-off"} | options))


@pytest.mark.parametrize("start", [vt.AtForce(1e4), vt.AtRadius(300.0)], ids=["force", "radius"])
def test_deep_starts_by_force_and_radius_begin_where_one_by_depth_does(start):
    result = pulled(case(start))
    assert result.shallow_start.asked == pytest.approx(contact_of(case(start)).deepest(start))
    same = pulled(case(result.shallow_start.asked))
    np.testing.assert_array_equal(result.force, same.force)


@pytest.mark.parametrize(
    "problem",
    [
        case(900.0, material=ELASTIC),
        case(1500.0, rate=1e6),
        case(2000.0, rate=0.01, material=ENDLESS),
        case(1100.0, material=ELASTIC, moves=(vt.Dwell(1.0, hold="drive"),)),
    ],
    ids=["not deep", "over before it creeps", "endless memory", "with moves"],
)
def test_a_start_that_matters_is_marched_from(problem):
    result = pulled(problem, estimate_error=False)
    assert result.shallow_start is None
    assert result.depth[0] == problem.start.depth


def test_a_depth_that_matters_and_cannot_be_marched_is_refused():
    few = replace(Settings.for_accuracy(0.02), most_steps=200)
    words = r"a march from a depth of 2e\+06 h0 would take about .* the force still changes by .*"
    with pytest.raises(ValueError, match=words + "retract more slowly"):
        pulled(case(2e6, rate=1e8, material=ENDLESS), settings=few)


def test_time_that_is_left_to_creep_decides_where_two_depths_agree():
    """Between two processes far apart in time nothing changes, and the second still comes."""
    twice = vt.Prony(**COMMON, branches=((9.0, 1e-6), (9.0, 1e6)))
    begun = preload.shallower(
        case(6e3, material=twice),
        contact_of(case()),
        Settings.for_accuracy(DEFAULT_ACCURACY),
        lambda posed: pulled(posed, estimate_error=False),
    )
    assert begun is None


def test_the_depth_grows_by_fours_until_the_end_no_longer_changes():
    marched = []

    def light(posed):
        marched.append(pulled(posed, estimate_error=False))
        return marched[-1]

    settings = Settings.for_accuracy(DEFAULT_ACCURACY)
    begun = preload.shallower(case(1e5, rate=100.0), contact_of(case()), settings, light)
    depths, forces = [r.depth[0] for r in marched], [vt.pull_off_force(r) for r in marched]
    assert depths == [10.0 * 4**i for i in range(len(marched))]
    assert begun.light is marched[-1] and begun.start.depth == depths[-1]
    assert abs(forces[1] / forces[0] - 1) > 0.1 > 0.01 > abs(forces[-1] / forces[-2] - 1)
    assert begun.start.force <= 0.3 * DEFAULT_ACCURACY
    assert begun.start.work <= 1.5 * DEFAULT_ACCURACY


def test_what_is_left_of_the_creep_bounds_what_the_depth_still_does():
    last = SimpleNamespace(left=0.2, values={"force": 1.0, "work": 2.0})

    def effects(left):
        return preload._effects(last, SimpleNamespace(left=left, values=values), 0.1)

    values = {"force": 1.0 / 0.9, "work": 2.0 / 0.2}  # changed by 0.1 and 0.8 of themselves
    # 1.5 times the change, as what is left to what has crept in between; at most 5 times that rest
    assert effects(0.05) == pytest.approx({"force": 0.05, "work": 0.25})
    # creep is not the only slow process: a tenth of the change at least
    assert effects(1e-9) == pytest.approx({"force": 0.01, "work": 0.08})
    assert effects(0.2) == pytest.approx({"force": 1.0, "work": 1.0})


def test_a_march_begins_pressed_as_hard_as_the_contact_then_pulls():
    """A cone pulls hard: from where a sphere may begin, a seventh of its work would be missing."""
    cone = case(2000.0, tabor=3.24, material=ELASTIC, geometry=vt.PowerLawProfile(1.0, 1.0))
    result = pulled(cone, estimate_error=False)
    assert result.force[0] >= vt.pull_off_force(result)
    assert vt.work_to_pull_off(result) == pytest.approx(41.8, rel=0.02)  # converged: 41.80


def test_a_crack_behind_a_soft_spring_comes_up_to_its_speed():
    """From 21 h0 the work would be 1 % short, although 1e-7 of the creep is left."""
    result = pulled(case(1100.0, tabor=3.24, rate=10.0, stiffness=0.05), accuracy=5e-3)
    assert 1 - SOLID.creep(vt.pull_off(result).time) < 1e-6
    assert result.shallow_start.depth > 50
    # from 84.8 and from 339 h0 at an accuracy of 1e-3
    assert vt.work_to_pull_off(result) == pytest.approx(38.257, rel=result.error_estimate["work"])
