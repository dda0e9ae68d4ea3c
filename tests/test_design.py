"""Tests of designs: search, forces, margins, limits, targets, conditions, yield and front."""

from dataclasses import replace
from math import exp, inf, log, pi
from pathlib import Path
from statistics import NormalDist

import numpy as np
import pytest

import viscotack as vt
from command_line import exit_status, rows_of
from picture_units import in_si
from solids import creep_power_law
from viscotack.app.operations import ask
from viscotack.design import Bounds, Candidate, Choice, Conditions, read_design
from viscotack.design.arrays import grid
from viscotack.design.fast import SURROGATES, THEORIES, FastTier, Force, Pad, held_load
from viscotack.design.finding import simulate
from viscotack.design.margins import Judge, allowances, share_of, solid_limits
from viscotack.design.searching import nondominated
from viscotack.errors import InputError
from viscotack.plot.design import draw_design
from viscotack.theory import lennard_jones

RUBBER = creep_power_law(1.5e6, 15e6, 0.6, 0.1, 0.5)
LAW = vt.LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-7)
SPACE = vt.DesignSpace(
    Bounds(1e-3, 4e-3),
    Bounds(4e-3),
    hold_speed=Bounds(1e-4, 1e-3),
    release_speed=Bounds(1e-6, 1e-5),
    pads=Bounds(2),
)
TARGETS = vt.Targets(hold=5e-3, release=2.5e-3)
SHORT = replace(LAW, equilibrium_gap=5e-8)
CHOICE = Choice("rubber", 1e-3, 4e-3, 2, 1e-3, 1e-6)
HOW = {"confirm": 0, "seed": 3}


@pytest.fixture(scope="module")
def fast():
    return FastTier({"rubber": RUBBER}, LAW, SURROGATES)


@pytest.fixture(scope="module")
def found():
    return vt.find_design({"rubber": RUBBER}, LAW, SPACE, TARGETS, **HOW)


@pytest.fixture(scope="module")
def run(found):
    return simulate(found.best, found.fast, Judge(TARGETS), accuracy=0.01)


def grid_of_margins(fast, near):
    """Return the largest margin of the worst target by radius, finest near one, at the best speeds.

    It has a kink where both targets bind.
    """
    best = -inf
    for radius in [*np.geomspace(1e-3, 4e-3, 9), *near * np.linspace(0.991, 1.009, 7)]:
        one = Judge(TARGETS).judged(Choice("rubber", float(radius), 4e-3, 2, 1e-3, 1e-6), fast)
        best = max(best, one.margin if not isinstance(one, str) else -inf)
    return best


def test_the_search_finds_the_margin_of_a_fine_grid(fast, found):
    assert found.best.margin == pytest.approx(
        grid_of_margins(fast, found.best.choice.radius), abs=3e-3
    )
    assert found.best.choice.hold_speed == pytest.approx(1e-3, rel=0.03)
    assert found.best.choice.release_speed == pytest.approx(1e-6, rel=0.03)


def test_hold_and_release_bind_together_with_both_speeds(found):
    assert set(found.binding) == {"hold", "release", "hold_speed at most", "release_speed at least"}
    margins = found.best.margins
    assert margins["hold"] == pytest.approx(margins["release"], abs=5e-3)


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
        (vt.Targets(release=1e-4), "release", "solid", (4.7e-4, 6.3e-4)),
        # below 1/k, but beyond what the speeds between the bounds reach
        (vt.Targets(hold=12e-3, release=2e-3), "ratio", "speeds", (2, 6)),
    ],
)
def test_targets_out_of_reach_are_refused_with_the_bound(targets, target, cause, reach):
    space = replace(SPACE, hold_speed=Bounds(1e-3), release_speed=Bounds(1e-6))
    found = vt.find_design({"rubber": RUBBER}, LAW, space, targets, seed=1)
    assert found.meets is False
    assert found.best.run is None
    limit = next(x for x in found.excluded if x.target == target)
    assert limit.cause == cause
    # two pads of 1 to 4 mm
    assert reach[0] < limit.reach < reach[1]


def test_a_simulation_decides():
    space = replace(SPACE, radius=Bounds(2e-3), hold_speed=Bounds(1e-3), release_speed=None)
    answers = []
    # the simulated force of 7.39 mN lies inside the interval of the fast tier
    for hold in (7.3e-3, 7.5e-3):
        targets = vt.Targets(hold=hold)
        answers.append(vt.find_design({"rubber": RUBBER}, LAW, space, targets, accuracy=0.01))
    assert [one.best.margin < 0 < one.best.best_margins["hold"] for one in answers] == [True, True]
    assert [one.meets for one in answers] == [True, False]


@pytest.fixture(scope="module")
def short():
    return FastTier({"rubber": RUBBER}, SHORT, THEORIES)


def test_the_worst_speed_and_temperature_count(fast):
    wide = Conditions(hold_window=4, release_window=5, shifts={"rubber": (0.5, 1.5)})
    assert wide.speeds("hold", "rubber", 1e-3) == pytest.approx((0.5e-3, 6e-3))
    assert wide.speeds("release", "rubber", 1e-6) == pytest.approx((0.1e-6, 1.5e-6))
    choice = replace(CHOICE, radius=2e-3)
    found = Judge(TARGETS, wide).judged(choice, fast)
    pad = Pad("rubber", 2e-3, 2e-3, 0.5e-3)
    assert found.forces["hold"].value == pytest.approx(2 * fast.force(pad).value, rel=1e-12)
    slow = fast.force(replace(pad, speed=1.5e-6))
    assert found.forces["release"].value == pytest.approx(2 * slow.value, rel=1e-12)
    alone = Judge(TARGETS).judged(choice, fast)
    assert all(found.margins[name] < alone.margins[name] for name in found.margins)


def test_held_loads_lie_between_the_elastic_and_the_instantaneous_force(short):
    problem = short.problem(Pad("rubber", 1e-3, 2e-3, 1.0))
    elastic = 1.5 * pi * 1e-3 * 0.05 * lennard_jones.pull_off_ratio(problem.groups().tabor)
    loads = [held_load(problem, t) for t in (1e-12, 1e-1, 1.0, 1e2, 1e12)]
    assert np.all(np.diff(loads) < 0)
    assert loads[-1] == pytest.approx(float(elastic), rel=1e-3)
    assert loads[0] < elastic / RUBBER.modulus_ratio
    # one standard deviation is a hundredth, and nine of ten lie in the interval
    held = short.held(Pad("rubber", 1e-3, 2e-3, 1.0), 1.0)
    ends = np.array([held.low, held.high]) / loads[2]
    assert ends == pytest.approx(
        1 + 0.01 * NormalDist().inv_cdf(0.95) * np.array([-1, 1]), abs=1e-5
    )
    with pytest.raises(vt.OutOfRange, match="cohesive zone"):
        held_load(replace(problem, traction=replace(LAW, equilibrium_gap=1e-5)), 1.0)


def test_margins_take_the_ends_of_intervals_that_are_worse_for_their_target():
    class Known:
        def force(self, pad):
            value = 1.0 if pad.speed == CHOICE.hold_speed else 0.25
            return Force(value, 0.9 * value, 1.2 * value, "known")

    found = Judge(vt.Targets(hold=1.0, release=1.0, ratio=2.0)).judged(CHOICE, Known())
    worst = {"hold": log(1.8), "release": -log(0.6), "ratio": log(1.8 / 0.6)}
    best = {"hold": log(2.4), "release": -log(0.45), "ratio": log(2.4 / 0.45)}
    assert found.margins == pytest.approx({**worst, "ratio": worst["ratio"] - log(2)})
    assert found.best_margins == pytest.approx({**best, "ratio": best["ratio"] - log(2)})
    # the interval of a poor theory may reach 0
    ratio = Judge(vt.Targets(ratio=2.0)).margins(CHOICE, {"hold": 0.0, "release": 1.0})
    assert ratio["ratio"] == -inf


def test_a_design_is_possible_if_intervals_of_twice_the_width_leave_it_open():
    # from -0.30 to -0.09 the doubled interval ends at 0.015, from -0.30 to -0.11 at -0.015
    possible = [Candidate(CHOICE, {}, {"a": -0.3}, {"a": x}).is_possible for x in (-0.09, -0.11)]
    assert possible == [True, False]


def test_a_simulated_load_falls_after_the_time(fast):
    targets = vt.Targets(dead_load=1e-3, holding_time=10.0)
    one = Judge(targets).judged(CHOICE, fast)
    load = one.forces["dead_load"].value
    run = simulate(one, fast, Judge(targets), accuracy=0.02)
    assert run.forces["dead_load"] == pytest.approx(load, rel=0.02)
    assert run.time == pytest.approx(10.0, rel=0.3)


def test_other_tips_layers_and_backings_have_the_limits_of_the_sphere(short):
    pad = Pad("rubber", 1e-3, 2e-3, 1e-4)
    sphere = short.force(pad)
    # another tier: the theory beside the one that learned from it and from simulations
    assert short.force(replace(pad, exponent=2.0)).value == pytest.approx(sphere.value, rel=0.01)
    assert short.force(replace(pad, exponent=4.0)).value > 1.05 * sphere.value
    assert short.force(replace(pad, backing=1e9)).value == pytest.approx(sphere.value, rel=0.01)
    thick = short.force(replace(pad, thickness=0.1))
    assert thick.value == pytest.approx(sphere.value, rel=0.02)
    assert thick.low < sphere.value < thick.high
    assert "rigid backing" in short.force(replace(pad, thickness=0.1, backing=1e3))


def test_the_yield_of_one_tolerance_is_that_of_a_normal():
    slopes, deviations = {"hold": {"radius": 0.8}}, {"radius": 0.1}
    found = share_of({"hold": 0.1}, slopes, deviations)
    assert found == pytest.approx(NormalDist().cdf(0.1 / 0.08), abs=2e-3)
    need = allowances(("hold",), slopes, deviations, 0.95)
    assert share_of(need, slopes, deviations) == pytest.approx(0.95, abs=2e-3)
    # two targets against each other share the rejects
    both = {"hold": {"radius": 0.8}, "release": {"radius": 0.8}}
    need = allowances(("hold", "release"), both, deviations, 0.9)
    assert share_of(need, both, deviations) == pytest.approx(0.9, abs=3e-3)
    assert share_of({"hold": 0.1}, {"hold": {"radius": None}}, deviations) is None


def test_a_front_has_no_design_that_another_one_beats():
    values = np.random.default_rng(2).normal(size=(200, 3))
    kept = nondominated(values)
    for i, row in enumerate(values):
        beaten = np.any(np.all(values >= row, axis=1) & np.any(values > row, axis=1))
        assert kept[i] == (not beaten)


FILE = """
[targets]
hold = "5 mN"
dead_load = "1 mN"
holding_time = "60 s"
[bounds]
radius = "1 mm..4 mm"
preload = "4 mN"
[conditions]
hold_speed = "1 mm/s..10 mm/s"
temperature = "0 degC..20 degC"
[scatter]
radius = "3 %"
work_of_adhesion = 0.1
yield = "95 %"
[material]
passport = "pdms-10-1"
[interface]
law = "lennard-jones"
work_of_adhesion = "50 mJ/m^2"
equilibrium_gap = "20 nm"
"""


def test_a_file_states_conditions_and_scatter(tmp_path):
    file = tmp_path / "design.toml"
    file.write_text(FILE)
    found = vt.read_design(file)
    conditions = found.conditions
    assert conditions.hold_window == pytest.approx(10.0)
    assert conditions.deviations == {"radius": 0.03, "work_of_adhesion": 0.1}
    assert conditions.share == pytest.approx(0.95)
    low, high = conditions.shifts["pdms-10-1"]
    assert low == pytest.approx(1.0) and high > 2
    # a warmer contact is held for less
    assert conditions.holding_time("pdms-10-1", 60.0) == pytest.approx(60.0)


def test_an_area_has_room_for_whole_pads_or_for_none():
    space = replace(SPACE, pads=Bounds(2, 5), area=3 * (2 * 2e-3) ** 2)
    assert [space.most_pads(radius) for radius in (1e-3, 2e-3, 2.4e-3, 3e-3)] == [5, 3, 2, 0]


def test_a_preload_limit_binds():
    space = replace(SPACE, preload=Bounds(1e-3, 20e-3), hold_speed=Bounds(1e-3), release_speed=None)
    targets = vt.Targets(hold=1e-3, preload=3e-3)
    found = vt.find_design({"rubber": RUBBER}, LAW, space, targets, confirm=0, seed=1)
    assert found.best.choice.preload < 3e-3
    assert found.best.margins["preload"] == pytest.approx(log(3e-3 / found.best.choice.preload))
    assert exp(found.best.margin) > 1 and len(found.front) > 2


# Tests of the operation ``design``: its file, command, table, picture and words.
SMALL = """
[targets]
hold = "5 mN"
release = "2.5 mN"
[bounds]
radius = "1 mm..4 mm"
preload = "4 mN"
hold_speed = "1 mm/s"
release_speed = "1 um/s"
pads = 2
[material]
model = "power-law"
rubbery_modulus = "1.5 MPa"
glassy_modulus = "15 MPa"
exponent = 0.6
tau0 = "0.1 s"
poisson_ratio = 0.5
[interface]
law = "lennard-jones"
work_of_adhesion = "50 mJ/m^2"
equilibrium_gap = "100 nm"
"""


@pytest.mark.parametrize(
    "old, new, field",
    [
        ('hold = "5 mN"\nrelease = "2.5 mN"', "", "target"),
        ('hold = "5 mN"', 'hold = "-5 mN"', "hold"),
        ('"1 mm..4 mm"', '"1 mm..4 s"', "radius"),
        ("pads = 2", 'pads = "1..2.5"', "pads"),
        ("pads = 2", 'pads = 2\narea = "1 mm^2"', "pads"),
        ("[interface]", "[protocol]", "protocol"),
    ],
)
def test_a_wrong_file_is_refused_with_the_place(small, old, new, field):
    small.write_text(SMALL.replace(old, new))
    with pytest.raises(InputError, match=field):
        read_design(small)


def test_the_command_writes_a_table_and_a_picture(small):
    line = "design small.toml --confirm 1 --accuracy 0.01 --csv d.csv --plot d.svg"
    assert exit_status(line) == 0
    row = rows_of("d.csv")[0]
    assert row["meets"] == "True"
    assert float(row["simulated_hold_N"]) == pytest.approx(float(row["hold_N"]), rel=0.05)
    assert Path("d.svg").stat().st_size > 5000


def test_a_target_out_of_reach_is_drawn_with_the_best_design(small):
    small.write_text(SMALL.replace('hold = "5 mN"', 'hold = "60 mN"'))
    answer = ask("design", file="small.toml")
    assert answer.found.meets is False
    axes = draw_design(answer.found, read_design(small)).axes
    at = [line.get_xdata()[0] for line in axes[0].lines if line.get_linestyle() == ":"]
    best = answer.found.best.choice
    assert in_si(axes[0].xaxis, at) == pytest.approx([best.hold_speed, best.release_speed])
    (wanted,) = (x.get_ydata()[0] for x in axes[0].lines if x.get_label() == "hold, at least")
    assert in_si(axes[0].yaxis, wanted) == pytest.approx(60e-3)
