"""Contacts whose edge is a steady crack: limits, twins, published physics, simulation."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from viscotack import (
    Apart,
    Approach,
    AtDepth,
    AtForce,
    AtRadius,
    Cone,
    Dwell,
    Elastic,
    FlatPunch,
    Groups,
    Layer,
    LennardJones,
    LoadTo,
    MoveTo,
    OutOfRange,
    PowerLawProfile,
    Problem,
    Prony,
    Retract,
    Retraction,
    Sphere,
    StandardSolid,
    crack_contact,
    pull_off,
    solve,
    work_to_pull_off,
)
from viscotack.theory import SteadyCrack, profiles
from viscotack.theory.crack.contact import (
    Contact,
    Drive,
    history,
    profile_of,
    radius_at_depth,
    radius_at_force,
    recede,
    series,
)
from viscotack.traction import Tabulated

REDUCED = LennardJones(1.0, 1.0)
ELASTIC = Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)


def standard(k=0.1):
    return StandardSolid(rubbery_modulus=1.0, glassy_modulus=1 / k, tau0=1.0, poisson_ratio=0.0)


class Blunt:
    """The paraboloid as a shape that says no more than its gap and its slope."""

    word, symmetry = "blunt", "revolution"

    def gap(self, position):
        return np.asarray(position) ** 2 / 2

    def flank(self, position):
        return np.asarray(position, dtype=float)

    def reduced(self, along, height):
        return self


def test_an_elastic_sphere_is_that_of_jkr():
    found = crack_contact(Groups(tabor=1e4, material=ELASTIC, start=AtDepth(1e5), rate=1.0))
    assert found.pull_off_force == pytest.approx(1, rel=2e-4)
    assert found.contact_radius_at_pull_off == pytest.approx((9 / 8) ** (1 / 3), rel=2e-2)
    # its end is a flat minimum
    assert found.work_to_pull_off == pytest.approx(0.80182 * np.pi ** (2 / 3) * 1e4, rel=1e-2)


@pytest.mark.parametrize(
    ("shape", "q", "A"), [(Cone(1.0), 1, 1.0), (PowerLawProfile(0.25, 4.0), 4, 0.25)]
)
def test_elastic_tips_are_those_of_the_theory_of_profiles(shape, q, A):
    found = crack_contact(
        Groups(tabor=1e4, material=ELASTIC, start=AtDepth(3e5), rate=1.0, geometry=shape)
    )
    case = dict(coefficient=A, exponent=q, contact_modulus=1.0, work_of_adhesion=1.0)
    expected = -float(profiles.pull_off(**case).force) / (1.5 * np.pi)
    assert found.pull_off_force == pytest.approx(expected, rel=1e-3)


def test_a_fast_retraction_from_a_large_contact_is_glassy():
    # P = 1/k, a = (9/8k)^(1/3), w = 0.8018 k^(-2/3) mu pi^(2/3), by superposition
    mu, k = 1e5, 0.1
    found = crack_contact(
        Groups(tabor=mu, material=standard(k), start=AtDepth(40 * mu), rate=1e9 * mu)
    )
    assert found.pull_off_force == pytest.approx(1 / k, rel=2e-3)
    assert found.contact_radius_at_pull_off == pytest.approx((9 / (8 * k)) ** (1 / 3), rel=2e-2)
    work = 0.801822 * k ** (-2 / 3) * mu * np.pi ** (2 / 3)
    assert found.work_to_pull_off == pytest.approx(work, rel=1e-2)


def test_a_slow_retraction_is_that_of_the_relaxed_solid():
    found = crack_contact(Groups(tabor=100, material=standard(), start=AtDepth(600), rate=1e-4))
    assert found.pull_off_force == pytest.approx(1, rel=0.02)
    assert found.amplification_at_pull_off == pytest.approx(1, rel=0.02)


def test_both_ways_to_a_receding_contact_agree():
    crack, profile = SteadyCrack(standard(), REDUCED), profile_of(Sphere(1.0))
    a0 = radius_at_depth(profile, 20.0)
    for rate in (1.0, 100.0):
        curve = recede(
            crack, profile, radius=np.array([a0]), rate=np.array([rate]), tabor=np.array([10.0])
        )
        contact = Contact(crack, profile, tabor=10.0, largest=1.05 * a0)
        run = contact.run(contact.relaxed(a0), (Drive("drive", -rate, np.inf),))
        assert run.detached
        assert run.force.min() == pytest.approx(curve.force.min(), rel=2e-3)
        times = run.time[np.argmin(run.force)], curve.time[np.argmin(curve.force[:, 0]), 0]
        assert times[0] == pytest.approx(times[1], rel=0.01)


def test_a_shape_of_the_users_own_is_tabulated():
    own, sphere = profile_of(Blunt()), profile_of(Sphere(1.0))
    radii = np.geomspace(1e-3, 100, 30)
    for name in ("depth", "total", "relaxed_depth", "relaxed_force"):
        assert getattr(own, name)(radii) == pytest.approx(getattr(sphere, name)(radii), rel=1e-6)
    assert radius_at_force(own, 3.0) == pytest.approx(radius_at_force(sphere, 3.0), rel=1e-6)


@pytest.mark.parametrize(
    "groups",
    [
        Groups(tabor=10, material=standard(), start=AtDepth(200), rate=300),
        Groups(
            tabor=10,
            material=Prony(
                rubbery_modulus=1.0, poisson_ratio=0.0, branches=((1.0, 0.05), (3.0, 0.5))
            ),
            start=AtDepth(100),
            rate=100,
            geometry=PowerLawProfile(0.25, 4.0),
        ),
    ],
)
def test_the_pull_off_is_that_of_a_simulation(groups):
    found = crack_contact(groups)
    result = solve(groups, until="pull-off", estimate_error=False)
    simulated = pull_off(result)
    assert found.pull_off_force == pytest.approx(simulated.force, rel=0.01)
    assert found.pull_off_force == pytest.approx(simulated.force, rel=found.band)
    assert found.time_at_pull_off == pytest.approx(simulated.time, rel=0.03)
    assert found.contact_radius_at_pull_off == pytest.approx(simulated.contact_radius, rel=0.03)
    assert found.work_to_pull_off == pytest.approx(work_to_pull_off(result), rel=0.06)


def test_a_history_is_that_of_a_simulation():
    groups = Groups(
        tabor=4.0,
        material=standard(0.2),
        start=Apart(20.0),
        moves=(Approach(20.0, AtDepth(50.0)), Dwell(0.5, "force")),
        rate=20.0,
    )
    found, result = crack_contact(groups), solve(groups, estimate_error=False, accuracy=0.01)
    assert found.pull_off_force == pytest.approx(pull_off(result).force, rel=found.band)
    assert found.force.max() == pytest.approx(result.force.max(), rel=0.03)
    loop = np.sum((result.force[1:] + result.force[:-1]) / 2 * np.diff(result.depth))
    assert found.hysteresis == pytest.approx(loop, rel=0.03)


@pytest.mark.parametrize("hold", ["depth", "force"])
def test_after_a_very_long_dwell_the_contact_has_relaxed(hold):
    # a dwell of a million times, then a jump of a few 1e-10 of one: steps were round-off
    press = Approach(1e4, to=AtForce(20.0)), Dwell(1e6, hold=hold)
    dwelt = Groups(tabor=100.0, material=standard(), start=Apart(5.0), moves=press, rate=1e3)
    found = crack_contact(dwelt)
    start = AtForce(20.0)
    if hold == "depth":
        start = AtDepth(float(found.depth[found.move == 1][-1]))
    rested = crack_contact(Groups(tabor=100.0, material=standard(), start=start, rate=1e3))
    assert found.pull_off_force == pytest.approx(rested.pull_off_force, rel=5e-3)
    assert found.status == "detached"


def test_cycles_that_do_not_relax_have_a_bell():
    # Afferrante and Violano: loaded and unloaded at one speed, slow and fast contacts are elastic
    # ones, rubbery and glassy, and JKR's force knows no modulus
    mu = 100.0
    forces = []
    for rate in (1e-7, 1.0, 1e7):
        groups = Groups(
            tabor=mu,
            material=standard(),
            start=Apart(20.0),
            moves=(Approach(rate * mu, AtDepth(10 * mu)),),
            rate=rate * mu,
        )
        forces.append(crack_contact(groups).pull_off_force)
    slow, between, fast = forces
    assert slow == pytest.approx(1, rel=0.05)
    assert fast == pytest.approx(1, rel=0.05)
    assert between > 2


def test_jkr_overestimates_the_work_of_a_contact_that_had_relaxed():
    # Carbone: with the energy of the edge in JKR the bulk is taken for relaxed while it is glassy
    mu = 100.0
    found = crack_contact(Groups(tabor=mu, material=standard(), start=AtDepth(2e3), rate=1e4))
    gamma = found.amplification_at_pull_off
    jkr = 0.801822 * gamma ** (5 / 3) * mu * np.pi ** (2 / 3)
    assert gamma > 5
    assert found.work_to_pull_off < 0.3 * jkr
    # while its force is that of the energy
    assert found.pull_off_force == pytest.approx(gamma, rel=0.02)


def test_a_stiff_spring_is_a_rigid_machine_and_a_soft_one_lets_go_at_the_same_force():
    case = dict(tabor=20.0, material=standard(), start=AtDepth(400), rate=100.0)
    rigid = crack_contact(Groups(**case))
    stiff = crack_contact(Groups(**case, stiffness=1e4))
    assert stiff.pull_off_force == pytest.approx(rigid.pull_off_force, rel=3e-3)
    soft = crack_contact(Groups(**case, stiffness=0.1))
    assert (
        soft.depth_at_pull_off < rigid.depth_at_pull_off
        or soft.time_at_pull_off > rigid.time_at_pull_off
    )


def test_moves_end_where_they_are_told():
    moves = (
        Approach(100.0, AtForce(2.0)),
        Dwell(0.3, "depth"),
        LoadTo(3.0, 0.2),
        Dwell(0.2, "force"),
        MoveTo(30.0, 0.5),
        Retract(50.0, AtRadius(1.2)),
    )
    groups = Groups(tabor=20.0, material=standard(), start=Apart(10.0), moves=moves, rate=None)
    found = crack_contact(groups)
    last = [np.flatnonzero(found.move == i)[-1] for i in range(len(moves))]
    assert found.force[last[0]] == pytest.approx(2.0, rel=1e-4)
    assert found.depth[last[1]] == found.depth[last[0]]
    assert found.force[last[1]] < 2.0
    assert found.force[[last[2], last[3]]] == pytest.approx(3.0, rel=1e-6)
    assert found.depth[last[4]] == pytest.approx(30.0, rel=1e-6)
    assert found.contact_radius[last[5]] == pytest.approx(1.2, rel=1e-4)
    assert found.status == "still in contact"
    assert np.diff(found.time[last]) == pytest.approx(
        [0.3, 0.2, 0.2, 0.5, np.diff(found.time[last])[4]]
    )


def test_a_problem_in_si_is_its_groups():
    solid = StandardSolid(rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.02, poisson_ratio=0.5)
    problem = Problem(
        material=solid,
        traction=LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-9),
        geometry=Sphere(1e-3),
        protocol=Retraction(start=AtForce(2e-3), speed=1e-5),
    )
    found, twin = crack_contact(problem), crack_contact(problem.groups())
    assert found.pull_off_force == pytest.approx(twin.pull_off_force, rel=1e-9)
    assert problem.tabor > 500
    assert found.problem is problem
    assert found.inside
    assert "measured up to a Tabor number of 200, extrapolated beyond" in found.why


def test_what_the_theory_cannot_answer_is_refused_with_the_reason():
    solid = standard()
    with pytest.raises(OutOfRange, match="cohesive zone is too large"):
        crack_contact(Groups(tabor=1.0, material=solid, start=AtDepth(20), rate=10))
    with pytest.raises(OutOfRange, match="preload is too small"):
        crack_contact(Groups(tabor=10, material=solid, start=AtRadius(1.3), rate=1e4))
    with pytest.raises(ValueError, match="no relaxed contact"):
        crack_contact(Groups(tabor=10, material=solid, start=AtDepth(-100), rate=1))
    with pytest.raises(TypeError, match="needs a Problem"):
        crack_contact("case.toml")
    pad = Problem(
        material=solid,
        traction=LennardJones(work_of_adhesion=1e-3, equilibrium_gap=1e-4),
        geometry=FlatPunch(1e-1),
        body=Layer(1e-2),
        protocol=Retraction(start=AtDepth(1e-4), speed=1e-3),
    )
    with pytest.raises(OutOfRange, match="flat punch"):
        crack_contact(pad)


def test_a_history_that_takes_too_many_steps_is_out_of_range(monkeypatch):
    monkeypatch.setattr("viscotack.theory.crack.contact.history._MOST_STEPS", 5)
    press = Approach(100.0, AtDepth(200.0))
    long = Groups(tabor=100, material=ELASTIC, start=AtDepth(100), rate=100, moves=(press,))
    with pytest.raises(OutOfRange, match="more than 5 steps"):
        crack_contact(long)


@pytest.mark.parametrize("speed", [3.0, 1.0])
def test_a_retraction_in_two_moves_takes_the_work_of_one(speed):
    """Of an elastic solid, whatever the speed of the first; the last one begins in tension."""
    rest = Groups(tabor=200.0, material=ELASTIC, start=AtForce(0.0), rate=3.0)
    split = replace(rest, moves=(Retract(speed, AtDepth(40.0)),))
    one, two = crack_contact(rest), crack_contact(split)
    assert two.pull_off_force == pytest.approx(one.pull_off_force, rel=1e-4)
    # its place, at a flat minimum, is known to a step
    assert two.work_to_pull_off == pytest.approx(one.work_to_pull_off, rel=0.02)


def test_a_stop_on_the_way_out_is_no_pull_off_and_ends_no_work():
    """Pulled fast, stopped, and pulled off slowly: the tension is largest at the stop."""
    moves = (Retract(300.0, AtDepth(-200.0)), Dwell(300.0))
    groups = Groups(tabor=100.0, material=standard(), start=AtDepth(300.0), moves=moves, rate=0.3)
    found = crack_contact(groups)
    at_stop = -found.force[found.move == 0][-1]
    slowly = found.force[found.move == 2]
    assert at_stop > 2 * found.pull_off_force
    assert found.pull_off_force == pytest.approx(-slowly.min(), rel=1e-4)
    pulled = (found.move > 0) & (found.depth > found.depth_at_pull_off)
    alone = np.trapezoid(-found.force[pulled], -found.depth[pulled])
    assert found.work_to_pull_off > 1.2 * alone


def test_an_edge_that_moves_at_once_is_refused_in_words_where_the_zone_is_large():
    # steps so long that the extrapolated time is negative: it ended in an IndexError
    law = Tabulated.of_points(
        np.array([1.2, 1.5, 1.8, 2.1, 3.0, 4.5, 8.0]) * 1e-6,
        [-300e3, -10e3, 60e3, 75e3, 30e3, 4e3, 0.0],
    )
    solid = Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    start = AtDepth(0.6546616974638197)
    groups = Groups(0.5165909518906818, solid, start, 6.546616974638198, law.reduced())
    with pytest.raises(OutOfRange, match="cohesive zone is too large"):
        crack_contact(replace(groups, geometry=Cone(1.0)))


@pytest.mark.parametrize(("travel", "rate"), [(-1.0, 0.2), (0.0, 0.2), (0.1, 0.25), (5.0, 0.0)])
def test_the_rate_of_an_edge_is_of_second_order_unless_it_turns(travel, rate):
    # mean rate 0.2 in this step, `travel` in the one before: 0.1 to 0.2 in mean goes on to 0.25,
    # and an edge that slows down does not turn within a step
    step = object.__new__(history._Step)
    step._dt, step._before = 0.1, SimpleNamespace(radius=1.0, travel=travel, step=0.1)
    assert step.rate(1.02) == pytest.approx(rate, rel=1e-9)


@pytest.mark.parametrize(
    ("depth", "ahead", "jump"),
    [
        # the shape lies at 1 - 4 = -3 and the surface ahead of the edge at the radius there
        (1.0, 0.5, -5.5),
        (1.0, 5.0, -6.0),
        # no opening to close
        (9.0, 0.5, 0.0),
    ],
)
def test_an_edge_closes_over_the_jump_from_the_surface_one_zone_ahead(depth, ahead, jump):
    step = object.__new__(history._Step)
    profile = SimpleNamespace(depth=lambda a: a**2)
    step._of = SimpleNamespace(_profile=profile, _ahead=ahead, _s=np.array([0.0, 1.0, 3.0]))
    step._outside = lambda a: (a, np.nan)
    assert step._jump(2.0, depth) == pytest.approx(jump**2 / (4 * np.pi), rel=1e-14)


def bare(kind, **parts):
    """Make a contact or a step of one that has only these parts."""
    made = object.__new__(kind)
    for name, part in parts.items():
        setattr(made, f"_{name}", part)
    return made


@pytest.mark.parametrize("value", [-0.9, -0.1, 0.3, 5.0])
@pytest.mark.parametrize("a", [0.9, 1.3])
@pytest.mark.parametrize("control", ["force", "depth", "drive"])
def test_a_step_gives_depth_and_force_that_belong_to_each_other(value, a, control):
    step = bare(
        history._Step,
        of=SimpleNamespace(_profile=SimpleNamespace(total=lambda a: a**3 / 3), _stiffness=0.7),
        before=SimpleNamespace(radius=1.0, left=0.8), c=0.25, value=value, control=control,
        inside=lambda a: (0.1, 0.1 * a), outside=lambda a: (0.5, 0.5 * a), until=0.5,
    )  # fmt: skip
    depth, force, lag = step.at(a)
    # inner memory up to the edge before, and outer memory beyond it
    creep = 0.1 * min(a, 1.0) + 0.5 * max(a - 1.0, 0.0)
    assert lag == (0.5 if a > 1.0 else 0.1)
    whole = force / 0.8 if force < 0 else force
    assert whole == pytest.approx(2 / 0.25 * (depth * a - a**3 / 3 - creep), rel=1e-12)
    given = {"force": force, "depth": depth, "drive": depth + force / 0.7}[control]
    assert given == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    ("lift", "jump", "drive", "way", "goes_on", "edge"),
    [
        # only one of the energies lets it move
        (1.1, 1.1, -1, 0, None, 0.5),
        (0.9, 0.9, 1, 0, None, 2.0),
        (0.9, 1.1, -1, 0, None, 1.0),
        # equal energies move nothing
        (1.0, 1.0, -1, 0, None, 1.0),
        # both
        (1.1, 0.9, -1, 0, True, 0.5),
        (1.1, 0.9, 1, 0, False, 2.0),
        # it turns with the drive only
        (1.1, 1.1, 1, 1, None, 1.0),
        (1.1, 1.1, -1, -1, None, 0.5),
        (0.9, 0.9, -1, -1, None, 1.0),
        (0.9, 0.9, 1, 1, None, 2.0),
        (1.1, 1.1, -1, 1, None, 0.5),
        (0.9, 0.9, 1, -1, None, 2.0),
    ],
)
def test_an_edge_moves_where_its_energies_and_the_drive_let_it(
    lift, jump, drive, way, goes_on, edge
):
    step = bare(
        history._Step,
        before=SimpleNamespace(radius=1.0, depth=0.0, way=way), dt=0.1,
        at=None, lift=lambda a, depth, lag: lift, jump=lambda a, depth: jump,
        goes_on_opening=lambda rate: goes_on,
        closed=lambda a: 2.0 * a, opened=lambda a: 0.5 * a,
    )  # fmt: skip
    step.at = lambda a: (0.1 * drive, 0.0, 0.0)
    assert step.edge() == edge


@pytest.mark.parametrize(("touches", "edge"), [(True, 7.0), (False, 0.0)])
def test_surfaces_apart_close_from_nothing_where_they_touch(touches, edge):
    step = bare(
        history._Step,
        before=SimpleNamespace(radius=0.0),
        touches=lambda: touches,
        closed=lambda a: 7.0 + a,
    )
    assert step.edge() == edge


def test_an_edge_opens_with_the_lift_over_the_instantaneous_compliance():
    of = SimpleNamespace(_profile=SimpleNamespace(depth=lambda a: a**2))
    step = bare(history._Step, of=of, c=0.5)
    # 1 - 4 - 0.5 = -3.5
    assert step._lift(2.0, 1.0, 0.5) == pytest.approx(7.0**2 / (4 * np.pi), rel=1e-14)
    assert step._lift(2.0, 5.0, 0.5) == 0.0


@pytest.mark.parametrize(
    ("travel", "drive", "opens"),
    [
        (0.0, -1.0, True),
        (0.0, 1.0, False),
        # with the drive
        (-1.0, -9.0, True),
        (1.0, 9.0, False),
        # the flank rises by 4 at a radius of 2: it follows the drive below 3/4 of its rate
        (-0.74, 1.0, False),
        (-0.76, 1.0, True),
        (0.74, -1.0, True),
        (0.76, -1.0, False),
    ],
)
def test_an_edge_that_could_open_and_close_keeps_its_way_unless_it_is_slow(travel, drive, opens):
    of = SimpleNamespace(_profile=SimpleNamespace(depth=lambda a: a**2))
    step = bare(history._Step, of=of, before=SimpleNamespace(travel=travel, radius=2.0))
    assert step._goes_on_opening(drive) is opens


def test_the_tension_left_is_that_of_the_opening_speed_of_the_edge():
    table = SimpleNamespace(one=lambda log_speed: np.exp(-log_speed))
    contact = bare(Contact, at_rest=0.9, tension=table, mu2=4.0)
    assert contact._left(0.0) == contact._left(1.0) == 0.9
    assert contact._left(-0.5) == pytest.approx(0.5, rel=1e-14)
    contact._tension = None
    assert contact._left(-0.5) == 0.9


@pytest.mark.parametrize(("forces", "opened"), [((2.0, 3.0), 0), ((3.0, 2.0), 1), ((2.0, 2.0), -1)])
def test_of_two_elastic_contacts_the_weaker_opens(forces, opened):
    found = series._both_elastic(*(SimpleNamespace(pull_off_force=P) for P in forces))
    assert (found.opened, found.tension, found.energy) == (opened, 2.0, (1.0, 1.0))


@pytest.mark.parametrize(
    ("gone", "last", "opened", "held"),
    [
        # which is gone, else which has receded further
        ([True, False], (0.9, 0.1), 0, 0.1),
        ([False, True], (0.1, 0.9), 1, 0.1),
        ([False, False], (0.5, 0.8), 0, 0.8),
        ([True, True], (0.8, 0.5), 1, 0.8),
        ([False, False], (0.5, 0.5001), -1, np.nan),
        # a thousandth of the larger recession apart, and more of the smaller one
        ([False, False], (np.exp(-0.5), np.exp(-0.50050025)), -1, np.nan),
        # the force alone moves an elastic contact
        ([False, False], (np.nan, 0.5), 1, np.nan),
        ([False, False], (0.5, np.nan), 0, np.nan),
    ],
)
def test_of_two_contacts_the_one_opens_that_recedes_further(gone, last, opened, held):
    def contact(known):
        return SimpleNamespace(
            start=lambda: 4.0 if known else np.nan,
            radius=lambda state: state,
            energy=lambda force, state: -force * state,
        )

    contacts = tuple(contact(a == a) for a in last)
    states = [4.0 * a for a in last]
    found = series._pulled(contacts, gone, (7.0, 9.0), [3.0, 2.0], (-1.0, states))
    assert (found.opened, found.tension, found.time) == (opened, 7.0, 9.0)
    assert found.energy == (21.0, 14.0)
    radii = tuple(a / 4.0 if b == b else np.nan for a, b in zip((3.0, 2.0), last, strict=True))
    assert found.radius == pytest.approx(radii, nan_ok=True)
    assert found.held == pytest.approx(held, nan_ok=True)


@pytest.mark.parametrize(
    ("before", "after", "last", "detached"),
    [
        (0.5, 0.0, True, True),
        (0.5, 0.4, True, False),
        (0.0, 0.0, True, True),
        (0.0, 0.0, False, False),
        (0.5, 0.4, False, False),
        (0.0, 0.4, True, False),
    ],
)
def test_surfaces_are_detached_that_are_apart_at_the_end_of_the_last_drive(
    before, after, last, detached
):
    empty = np.zeros(1)
    start = history._State(0.0, 0.0, 0.0, 0.0, before, empty, empty, empty, empty, 1.0)
    contact = bare(
        Contact,
        tried=lambda *_: (start._replace(time=2.0, radius=after), False),
        longest=lambda drive: 2.0,
        slowest=lambda drive: 1e9,
        note=lambda *_: None,
    )
    end, found = contact._through(start, Drive("drive", 1.0, 2.0), 0, [], last)
    assert (end.time, end.radius, found) == (2.0, after, detached)
