"""The interface from a rate series: the truth found, its intervals honest, limits said."""

import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import viscotack as vt
from command_line import exit_status
from viscotack.errors import InputError, OutOfRange
from viscotack.identify import (
    PullOff,
    forecast_rates,
    identify_rates,
    pull_offs,
)
from viscotack.identify.forward import Forward
from viscotack.identify.travel import travels
from viscotack.lab.tack import Measured, survey
from viscotack.materials.library import published

RADIUS, WORK, PRELOAD = 5.19e-3, 0.1523, 1.5e-3
PDMS = published("pdms-10-1").material
SPEEDS = np.geomspace(1e-6, 1e-3, 6)
CASE = {"material": PDMS, "radius": RADIUS, "preload": PRELOAD}
# A solid of a moderate contrast is fitted in half the time.
RUBBER = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=1e-2, poisson_ratio=0.5)
RIG = Path(__file__).parents[1] / "examples" / "from_rig"


@cache
def answer(speed, gap, material=PDMS):
    problem = vt.Problem(
        material=material,
        traction=vt.LennardJones(work_of_adhesion=WORK, equilibrium_gap=gap),
        geometry=vt.Sphere(radius=RADIUS),
        protocol=vt.Retraction(start=vt.AtForce(PRELOAD), speed=speed),
    )
    return vt.crack_contact(problem)


def forces(gap, speeds=SPEEDS, material=PDMS):
    unit = 1.5 * np.pi * RADIUS * WORK
    return np.array([answer(speed, gap, material).pull_off_force for speed in speeds]) * unit


def series(values, relative=0.03, speeds=SPEEDS):
    pairs = zip(speeds, values, strict=True)
    return [PullOff(float(v), Measured(float(P), relative * float(P))) for v, P in pairs]


@pytest.mark.parametrize(
    ("material", "gap", "tabor"),
    [
        pytest.param(PDMS, 30.8e-9, 103.2, marks=pytest.mark.slow, id="pdms, short"),
        pytest.param(PDMS, 200e-9, 15.9, marks=pytest.mark.slow, id="pdms"),
        pytest.param(RUBBER, 200e-9, 20.4, id="rubber"),
    ],
)
def test_forces_without_noise_give_back_the_interface_they_came_from(material, gap, tabor):
    true = forces(gap, material=material)
    fit = identify_rates(series(true, 1e-3), theory=0.0, **CASE | {"material": material})
    assert fit.forces == pytest.approx(true, rel=1e-3)
    assert fit.work_of_adhesion == pytest.approx(WORK, rel=5e-3)
    assert fit.equilibrium_gap == pytest.approx(gap, rel=0.02)
    # (R w^2/E0*^2)^(1/3)/h0
    assert fit.tabor == pytest.approx(tabor, rel=0.02)


def test_a_slow_test_beside_the_series_narrows_the_range():
    rng, case = np.random.default_rng(4), CASE | {"material": RUBBER}
    true = forces(200e-9, material=RUBBER)
    noisy = series(true * (1 + 0.03 * rng.standard_normal(6)))
    alone = identify_rates(noisy, **case)
    known = identify_rates(noisy, work_of_adhesion=(WORK, 0.02 * WORK), **case)
    widths = [
        fit.intervals["equilibrium_gap"].high / fit.intervals["equilibrium_gap"].low
        for fit in (alone, known)
    ]
    assert widths[1] < 0.8 * widths[0]
    assert known.work_of_adhesion == pytest.approx(WORK, rel=0.04)


@pytest.mark.slow
def test_intervals_cover_the_true_value_at_their_stated_probability():
    true, inside = forces(200e-9), []
    for seed in range(30):
        rng = np.random.default_rng(seed)
        fit = identify_rates(series(true * (1 + 0.03 * rng.standard_normal(6))), theory=0.0, **CASE)
        for name, value in (("work_of_adhesion", WORK), ("equilibrium_gap", 200e-9)):
            ends = fit.intervals[name]
            inside.append(ends.low < value < ends.high)
    assert 0.8 < np.mean(inside) < 0.97


@pytest.mark.slow
def test_speeds_at_which_the_theory_does_not_hold_are_left_out_and_said_to_be():
    solid = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=3e8, tau0=1e-2, poisson_ratio=0.5)
    speeds = np.array([1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1.0])
    # a Tabor number of 400, too large to simulate
    force = Forward(solid, RADIUS).pulled(WORK, 10e-9, speeds, PRELOAD).force
    # at 1 m/s the edge has no way to become a steady crack, and another force
    force[-1] *= 1.5
    case = CASE | {"material": solid, "gaps": (2e-9, 2e-8)}
    fit = identify_rates(series(force, 0.01, speeds), **case)
    assert [one.speed for one in fit.series] == speeds[:-1].tolist()
    assert "excluded, because the theory does not hold there: 1 m/s" in " ".join(fit.words)
    assert fit.equilibrium_gap == pytest.approx(10e-9, rel=0.02)
    with pytest.raises(OutOfRange, match="too few of the speeds; at 2 m/s"):
        fast = np.array([1.0, 2.0])
        identify_rates(series(force[-2:], 0.01, fast), **case)


def test_an_interface_beyond_small_strain_is_no_reason_to_refuse_others():
    gel = vt.StandardSolid(rubbery_modulus=5e4, glassy_modulus=5e5, tau0=0.1, poisson_ratio=0.5)
    forward = Forward(gel, 1e-3)
    with pytest.raises(InputError, match="exceeds small strain"):
        forward.problem(3.0, 1e-7, 1e-4)
    both = forward.pulled([3.0, 0.02], 1e-7, 1e-5, 1e-4)
    alone = forward.pulled(0.02, 1e-7, 1e-5, 1e-4)
    assert both.force[1] == pytest.approx(float(alone.force), rel=1e-5)
    # as the contact with a steady crack for its edge has it
    problem = forward.problem(0.02, 1e-7, 1e-4, 1e-5)
    force = vt.crack_contact(problem).pull_off_force * problem.scales().force
    assert both.force[1] == pytest.approx(force, rel=2e-3)


@pytest.mark.slow
def test_a_machine_so_soft_that_forces_hang_on_it_gives_back_the_interface():
    speeds, forward = np.geomspace(1e-5, 1e-1, 5), Forward(RUBBER, RADIUS)
    soft = forward.changed(WORK, 50e-9, speeds, np.full(5, PRELOAD), stiffness=20.0)
    assert soft.ratio.min() < 0.8 and not soft.refused
    force = forward.pulled(WORK, 50e-9, speeds, PRELOAD).force * soft.ratio
    case = CASE | {"material": RUBBER, "stiffness": 20.0}
    fit = identify_rates(series(force, 0.01, speeds), **case)
    assert fit.work_of_adhesion == pytest.approx(WORK, rel=0.01)
    assert fit.equilibrium_gap == pytest.approx(50e-9, rel=0.03)


def test_a_series_without_information_is_refused():
    with pytest.raises(InputError, match="two or more speeds"):
        identify_rates(series([4e-3], speeds=SPEEDS[:1]), **CASE)
    with pytest.raises(InputError, match="none of the searched ranges"):
        identify_rates(series([4e-3, 5e-3], speeds=SPEEDS[:2]), gaps=(5e-5, 5e-4), **CASE)


def test_from_the_files_of_a_rig_to_the_interface(tmp_path, capsys):
    paths = [RIG / f"lens_{v}_um_s.csv" for v in (1, 30, 1000)]
    command = ["identify", "rates", *paths, "--material", "pdms-10-1", "--radius", "5.19 mm"]
    picture = tmp_path / "rates.png"
    assert exit_status([*command, "--preload", "1.5 mN", "--json", "--plot", picture]) == 0
    found = json.loads(capsys.readouterr().out)
    speeds = [row["speed_m_s"] for row in found["series"]]
    assert speeds == pytest.approx([1e-6, 3e-5, 1e-3], rel=0.01)
    assert found["work_of_adhesion_J_m2"] == pytest.approx(WORK, rel=0.08)
    assert found["equilibrium_gap_m"] == pytest.approx(200e-9, rel=0.35)
    assert picture.stat().st_size > 10_000
    assert exit_status([*command, "--work-of-adhesion", "152 mJ/m2"]) == 2


@pytest.mark.slow
def test_whole_curves_narrow_a_series():
    cycles = survey([RIG / f"lens_{v}_um_s.csv" for v in (1, 1000)]).cycles
    series = pull_offs(cycles)
    alone, whole = (identify_rates(series, curves=curves, **CASE) for curves in (False, True))
    # two pull-offs leave two ranges, a hundred times apart, and say so; both are in the interval
    ends = alone.intervals["equilibrium_gap"]
    assert ends.split and ends.low < 1e-9 and ends.high > 200e-9
    # a slower test tells them apart, so its forecast covers both
    slow = [
        float(alone.forward.pulled(*one.values.values(), 1e-7, PRELOAD).force)
        for one in alone.solutions
    ]
    assert max(slow) > 1.2 * min(slow)
    forecast = forecast_rates(alone, 1e-7)
    assert forecast.low[0] < min(slow) and max(slow) < forecast.high[0]
    ends = whole.intervals["equilibrium_gap"]
    assert not ends.split and 150e-9 < ends.low < 200e-9 < ends.high < 260e-9


def test_travels_of_a_cycle_are_those_of_the_curve_it_was_made_from():
    (cycle,) = survey([RIG / "lens_1000_um_s.csv"]).cycles
    read = [one.value for one in travels(cycle)]
    true = Forward(PDMS, RADIUS).pulled(WORK, 200e-9, 1e-3, PRELOAD).travels
    assert read == pytest.approx(true, rel=2e-3)
