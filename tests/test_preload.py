"""A start so deep that its depth no longer matters: where the march begins, and what is said."""

import json
from dataclasses import replace

import numpy as np
import pytest

from viscotack.app.cli import main
from viscotack.bem import DEFAULT_ACCURACY, Settings, preload
from viscotack.bem.solver import contact_of
from viscotack.geometry import PowerLawProfile
from viscotack.materials import (
    Elastic,
    Prony,
    RelaxationPowerLaw,
    RetardationPowerLaw,
    StandardSolid,
)
from viscotack.methods import solve
from viscotack.problem import Groups
from viscotack.protocol import AtDepth, AtForce, AtRadius, Dwell
from viscotack.result import load, save
from viscotack.result.observables import pull_off, pull_off_force, summary, work_to_pull_off

pytestmark = pytest.mark.march

COMMON = {"rubbery_modulus": 1.0, "poisson_ratio": 0.0}
ELASTIC = Elastic(**COMMON)
SOLID = StandardSolid(**COMMON, glassy_modulus=10.0, tau0=1.0)
POWER_LAW = RetardationPowerLaw(**COMMON, glassy_modulus=10.0, exponent=0.8, tau0=1.0)
BROAD = RetardationPowerLaw(**COMMON, glassy_modulus=1000.0, exponent=0.3, tau0=1.0)
ENDLESS = RelaxationPowerLaw(**COMMON, glassy_modulus=10.0, exponent=0.2, tau0=1.0)


def case(start=1e6, tabor=1.0, rate=1.0, material=SOLID, **more):
    start = AtDepth(start) if isinstance(start, int | float) else start
    return Groups(tabor=tabor, material=material, start=start, rate=rate, **more)


def pulled(problem, **options):
    return solve(problem, **({"accuracy": 0.02, "until": "pull-off"} | options))


@pytest.mark.parametrize(
    "problem",
    [
        case(1500.0, material=ELASTIC),
        case(1200.0, tabor=0.3, rate=20.0, material=POWER_LAW),
        pytest.param(
            case(1200.0, tabor=3.0, rate=20.0, material=POWER_LAW), marks=pytest.mark.slow
        ),
        pytest.param(case(1200.0, rate=10.0, material=BROAD), marks=pytest.mark.slow),
        case(1100.0, rate=5.0, geometry=PowerLawProfile(0.25, 4.0)),
        case(1200.0, rate=5.0, stiffness=0.2),
    ],
    ids=["elastic", "small mu", "large mu", "broad", "blunt tip", "spring"],
)
def test_a_march_from_where_the_depth_no_longer_matters_ends_like_the_whole_one(problem):
    part, whole = pulled(problem, accuracy=0.01), pulled(problem, accuracy=0.01, whole=True)
    assert part.shallow_start.depth <= part.shallow_start.asked / 2
    assert whole.shallow_start is None
    for name, number in (("force", pull_off_force), ("work", work_to_pull_off)):
        allowed = part.error_estimate[name] + whole.error_estimate[name]
        assert number(part) == pytest.approx(number(whole), rel=allowed)
        assert part.error_estimate[name] > getattr(part.shallow_start, name)
    travel = problem.tabor + 1
    assert part.shallow_start.shift <= max(0.05 * travel, 0.005 * abs(pull_off(part).depth))
    assert pull_off(part).depth == pytest.approx(pull_off(whole).depth, abs=0.1 * travel)
    assert part.energy_residual < 1e-3


def test_the_result_states_where_its_series_begin():
    problem = case(1e6)
    result = pulled(problem, until="detached")
    start = result.shallow_start
    assert start.asked == 1e6
    assert result.problem == problem and result.groups.start == AtDepth(1e6)
    assert result.depth[0] == start.depth < 1000
    assert result.time[0] == 0
    assert result.depth[-1] == pytest.approx(start.depth - result.time[-1])  # rate 1
    assert result.energy.drive[0] == 0
    assert summary(result)["shallow_start"] == vars(start)
    assert result.statistics["steps"] < 500


def test_a_saved_result_keeps_where_it_began(tmp_path):
    result = pulled(case(1e5, material=ELASTIC))
    save(result, tmp_path / "run.npz")
    assert load(tmp_path / "run.npz").shallow_start == result.shallow_start is not None


@pytest.mark.parametrize("start", [AtForce(1e4), AtRadius(300.0)], ids=["force", "radius"])
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
        case(1100.0, material=ELASTIC, moves=(Dwell(1.0, hold="drive"),)),
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
    twice = Prony(**COMMON, branches=((9.0, 1e-6), (9.0, 1e6)))
    begun = preload.shallower(
        case(6e3, material=twice),
        contact_of(case()),
        Settings.for_accuracy(DEFAULT_ACCURACY),
        lambda depth: pulled(case(depth, material=twice), estimate_error=False),
    )
    assert begun is None


def test_the_depth_grows_by_fours_until_the_end_no_longer_changes():
    marched = []

    def light(depth):
        marched.append(pulled(case(depth, rate=100.0), estimate_error=False))
        return marched[-1]

    settings = Settings.for_accuracy(DEFAULT_ACCURACY)
    begun = preload.shallower(case(1e5, rate=100.0), contact_of(case()), settings, light)
    depths, forces = [r.depth[0] for r in marched], [pull_off_force(r) for r in marched]
    assert depths == [10.0 * 4**i for i in range(len(marched))]
    assert begun.light is marched[-1] and begun.start.depth == depths[-1]
    assert abs(forces[1] / forces[0] - 1) > 0.1 > 0.01 > abs(forces[-1] / forces[-2] - 1)
    assert begun.start.force <= 0.3 * DEFAULT_ACCURACY
    assert begun.start.work <= 1.5 * DEFAULT_ACCURACY


def test_a_march_begins_pressed_as_hard_as_the_contact_then_pulls():
    """A cone pulls hard: from where a sphere may begin, a seventh of its work would be missing."""
    cone = case(2000.0, tabor=3.24, material=ELASTIC, geometry=PowerLawProfile(1.0, 1.0))
    result = pulled(cone)
    assert result.force[0] >= pull_off_force(result)
    assert work_to_pull_off(result) == pytest.approx(41.8, rel=0.02)  # converged: 41.80


def test_a_crack_behind_a_soft_spring_comes_up_to_its_speed():
    """From 21 h0 the work would be 1 % short, although 1e-7 of the creep is left."""
    result = pulled(case(1100.0, tabor=3.24, rate=10.0, stiffness=0.05), accuracy=5e-3)
    assert 1 - SOLID.creep(pull_off(result).time) < 1e-6
    assert result.shallow_start.depth > 50
    # from 84.8 and from 339 h0 at an accuracy of 1e-3
    assert work_to_pull_off(result) == pytest.approx(38.257, rel=result.error_estimate["work"])


def words(capsys, *flags):
    with pytest.raises(SystemExit) as caught:
        main(
            [
                *"simulate sphere --material elastic --tabor 1 --accuracy 0.02".split(),
                *"--until pull-off".split(),
                *flags,
            ]
        )
    assert not caught.value.code
    return capsys.readouterr().out


def test_the_text_states_where_the_curve_begins(capsys):
    said = words(capsys, "--preload", "1e5")
    assert "begun at depth" in said and "h0 and not 1e+05 h0" in said
    answer = json.loads(words(capsys, "--preload", "1e5", "--json"))
    assert answer["shallow_start"]["asked"] == 1e5
    assert "begun at depth" not in words(capsys, "--preload", "1100", "--whole")
    assert json.loads(words(capsys, "--preload", "20", "--json"))["shallow_start"] is None
