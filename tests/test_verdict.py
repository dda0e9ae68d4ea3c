"""A run is within what it was asked for, says that it is not, or is stopped."""

from dataclasses import replace

import pytest

import viscotack as vt
from dimensionless import ELASTIC, SOLID
from viscotack.simulate import Settings
from viscotack.simulate.verdict import judged

PRESSED = vt.AtDepth(3.0)


def case(material=ELASTIC, start=PRESSED, **options):
    return vt.Groups(tabor=1.0, material=material, start=start, rate=5.0, **options)


def pulled(problem=None, asked=None, **options):
    """Return an answer at a loose accuracy, as if a better one had been asked for."""
    settings = Settings.for_accuracy(0.02)
    if asked is not None:
        settings = replace(settings, accuracy=asked)
    return vt.solve(problem or case(), until="pull-off", settings=settings, **options)


@pytest.mark.parametrize(("asked", "met"), [(0.02, True), (5e-4, False)])
def test_a_result_says_whether_the_accuracy_was_met(asked, met, tmp_path):
    result = pulled(asked=asked)
    assert result.accuracy == asked and result.accuracy_met is met
    assert (result.error_estimate["force"] <= asked) is met
    assert vt.summary(result)["accuracy_met"] is met
    vt.save(result, tmp_path / "result.npz")
    again = vt.load(tmp_path / "result.npz")
    assert again.accuracy == asked and again.accuracy_met is met


def test_a_force_ten_times_less_accurate_than_asked_is_not_given():
    result = pulled(asked=1e-6, throw=False)
    assert result.outcome == "stopped" and result.error_estimate is not None
    assert "the pull-off force is not resolved: its error is estimated at" in result.status
    assert "beside 0.0001 % requested; ask for a better accuracy" in result.status
    assert vt.summary(result)["pull_off_force"] is None
    with pytest.raises(vt.SimulationError, match="not resolved"):
        pulled(asked=1e-6)


@pytest.mark.parametrize(
    ("problem", "factor", "stopped"),
    [
        (case(), 1.25, True),
        (case(), 0.85, True),
        (case(), 1.15, False),
        (case(SOLID), 0.85, False),
        (case(SOLID), 20.0, True),
        (case(start=vt.AtDepth(-1.6)), 0.85, False),
        (case(start=vt.Apart(8.0), moves=(vt.Approach(5.0, vt.AtDepth(2.0)),)), 3.0, False),
    ],
    ids=[
        "above Derjaguin",
        "below JKR",
        "between",
        "viscoelastic",
        "above all stiffness",
        "begun beyond the minimum",
        "with a history",
    ],
)
def test_a_force_that_theory_rules_out_is_not_given(problem, factor, stopped):
    result = pulled(problem)
    other = judged(replace(result, force=factor * result.force))
    assert (other.outcome == "stopped") is stopped
    assert ("none that theory allows" in other.status) is stopped


def test_a_law_beyond_the_mesh_is_answered_by_theory():
    problem = replace(case(), tabor=3.0, traction=vt.Exponential(1.0, 1.0, 1e-3))
    result = vt.solve(problem)
    assert result.method == "crack contact" and "a Tabor number of 1075" in result.status
