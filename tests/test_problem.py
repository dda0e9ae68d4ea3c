import math

import pytest

import viscotack as vt
from stated import lens, numbers
from viscotack.model.problem import accuracy, plane
from viscotack.model.problem.inputs import changed, check_paths

E, NU = 1.458e6, 0.5
MATERIALS = [
    vt.Elastic(rubbery_modulus=E, poisson_ratio=NU),
    vt.StandardSolid(rubbery_modulus=E, glassy_modulus=10 * E, tau0=0.02, poisson_ratio=NU),
    vt.Prony(rubbery_modulus=E, branches=((5 * E, 1e-3), (4 * E, 0.25)), poisson_ratio=0.4),
    vt.RetardationPowerLaw(
        rubbery_modulus=E, glassy_modulus=3.089e9, exponent=0.2207, tau0=0.01876, poisson_ratio=NU
    ),
    vt.RelaxationPowerLaw(
        rubbery_modulus=E, glassy_modulus=3.089e9, exponent=0.6, tau0=0.01876, poisson_ratio=0.3
    ),
]
STARTS = [vt.AtDepth(2e-6), vt.AtForce(1.5e-3), vt.AtRadius(0.3e-3)]


TIP = vt.PowerLawProfile(7.0, 1.5)


def start_value(start):
    return next(iter(vars(start).values()))


def test_tabor_number_of_the_lens_is_the_published_one():
    # 2.05 for 1.55 um, 102.9 for 30.8 nm: section 4.6, to the digits printed there
    assert lens().tabor == pytest.approx(2.05, abs=0.005)
    fine = lens(traction=vt.LennardJones(work_of_adhesion=0.1523, equilibrium_gap=30.8e-9))
    assert fine.tabor == pytest.approx(102.9, abs=0.5)


def test_groups_of_the_lens_follow_their_definitions():
    groups, R, w, h0 = lens().groups(), 5.19e-3, 0.1523, 1.55e-6
    contact = E / (1 - NU**2)
    assert groups.tabor**3 == pytest.approx(R * w**2 / (contact**2 * h0**3), rel=1e-12)
    assert groups.modulus_ratio == pytest.approx(1.458 / 3089, rel=1e-12)
    assert groups.rate == pytest.approx(100e-6 * 0.01876 / h0, rel=1e-12)
    assert groups.start == vt.AtForce(1.5e-3 / (1.5 * math.pi * R * w))
    depth = lens(protocol=vt.Retraction(start=vt.AtDepth(3.1e-6), speed=1e-4)).groups().start
    assert start_value(depth) == pytest.approx(2.0, rel=1e-12)
    radius = lens(protocol=vt.Retraction(start=vt.AtRadius(2e-4), speed=1e-4)).groups().start
    scale = (math.pi * R**2 * w / contact) ** (1 / 3)
    assert start_value(radius) == pytest.approx(2e-4 / scale, rel=1e-12)


def test_scales_follow_their_definitions():
    s, R, w, h0 = lens().scales(), 5.19e-3, 0.1523, 1.55e-6
    beta = (R**2 * w / (E / (1 - NU**2))) ** (1 / 3)
    assert s.force == pytest.approx(1.5 * math.pi * R * w, rel=1e-13)
    assert s.length == h0
    assert s.radius == pytest.approx(math.pi ** (1 / 3) * beta, rel=1e-13)
    assert s.work == pytest.approx(1.5 * math.pi * R * w * h0, rel=1e-13)
    assert s.time == 0.01876
    assert s.edge_speed == pytest.approx(beta / 0.01876, rel=1e-13)
    assert s.stress == pytest.approx(w / h0, rel=1e-13)


GAP, WORK = "equilibrium_gap", "work_of_adhesion"


@pytest.mark.parametrize(
    "known, material, start, shape, law",
    [
        (GAP, MATERIALS[0], STARTS[0], None, vt.LennardJones(0.15, 1.5e-6)),
        (WORK, MATERIALS[2], STARTS[1], None, vt.LennardJones(0.15, 1.5e-6)),
        (WORK, MATERIALS[4], STARTS[2], None, vt.LennardJones(0.15, 1.5e-6)),
        (GAP, MATERIALS[1], vt.AtDepth(2e-6), None, vt.GentSchultz(0.15, 1.5e-6, 7e-6, 0.4)),
        (WORK, MATERIALS[1], vt.AtForce(1e-7), vt.Cone(0.2), vt.LennardJones(0.15, 1e-7)),
        (GAP, MATERIALS[1], vt.Apart(1e-6), vt.Cone(0.2), vt.LennardJones(0.15, 1e-7)),
        (WORK, MATERIALS[1], vt.AtRadius(1e-6), TIP, vt.LennardJones(0.15, 1e-7)),
        (GAP, MATERIALS[1], vt.AtDepth(1e-8), TIP, vt.LennardJones(0.15, 1e-7)),
    ],
)
def test_groups_with_their_scales_are_the_problem_again(known, material, start, shape, law):
    test = vt.Retraction(start, 37e-6, moves=(vt.Dwell(3.0, hold="depth"),), stiffness=3.0)
    old = vt.Problem(material, law, shape or vt.Sphere(5.19e-3), test)
    new = old.groups().in_si(
        radius=old.radius,
        contact_modulus=old.material.contact_modulus,
        time_unit=old.material.time_unit,
        poisson_ratio=old.material.poisson_ratio,
        **{known: getattr(old.traction, known)},
    )
    assert numbers(new) == pytest.approx(numbers(old), rel=1e-11)
    assert type(new.material) is type(old.material)
    assert type(new.protocol.start) is type(start)


def test_exactly_one_of_gap_and_work_of_adhesion_is_required():
    groups = lens().groups()
    scales = dict(radius=5e-3, contact_modulus=2e6, time_unit=0.1, poisson_ratio=0.5)
    with pytest.raises(ValueError, match="exactly one of equilibrium_gap"):
        groups.in_si(**scales)
    with pytest.raises(ValueError, match="exactly one of equilibrium_gap"):
        groups.in_si(**scales, equilibrium_gap=1e-6, work_of_adhesion=0.1)
    with pytest.raises(ValueError, match="radius must be positive"):
        groups.in_si(**(scales | {"radius": -1}), equilibrium_gap=1e-6)
    with pytest.raises(ValueError, match="poisson_ratio must lie between 0 and 0.5"):
        groups.in_si(**(scales | {"poisson_ratio": 1.5}), equilibrium_gap=1e-6)


def test_groups_refuse_what_is_not_reduced():
    with pytest.raises(ValueError, match=r"use material.reduced\(\)"):
        vt.Groups(tabor=2, material=MATERIALS[1], start=vt.AtDepth(1), rate=1)
    with pytest.raises(ValueError, match=r"use traction.reduced\(\)"):
        vt.Groups(
            tabor=2,
            material=MATERIALS[1].reduced(),
            start=vt.AtDepth(1),
            rate=1,
            traction=vt.LennardJones(0.1, 1e-6),
        )


def test_a_case_is_named_by_its_content():
    assert vt.run_id(lens()) == vt.run_id(lens(geometry=vt.Sphere(radius=5.19e-3)))
    assert vt.run_id(lens(protocol=vt.Retraction(vt.AtDepth(0), 1))) == vt.run_id(
        lens(protocol=vt.Retraction(vt.AtDepth(-0.0), 1.0))
    )
    names = {
        vt.run_id(lens()),
        vt.run_id(lens().groups()),
        vt.run_id(lens(geometry=vt.Sphere(5.2e-3))),
    }
    assert len(names) == 3
    assert all(len(name) == 16 for name in names)


def test_a_range_ends_at_its_ends_within_rounding():
    for value, reached in ((2.0, True), (2.0 * (1 - 0.9e-9), True), (2.0 * (1 - 1.1e-9), False)):
        assert accuracy.at_least(value, 2.0) is reached
    for value, reached in ((2.0, True), (2.0 * (1 + 0.9e-9), True), (2.0 * (1 + 1.1e-9), False)):
        assert accuracy.at_most(value, 2.0) is reached
    both = {"a": (1.0, 2.0), "b": (1.0, 2.0)}
    assert accuracy.outside({"a": 1.0, "b": 2.0}, both) == ""
    said = "a is 0.5, verified from 1 to 2; b is 3, verified from 1 to 2"
    assert accuracy.outside({"a": 0.5, "b": 3.0}, both) == said


def test_paths_of_numbers_are_checked_with_what_there_is():
    case = lens(geometry=vt.PowerLawProfile(exponent=3.0, coefficient=1e4))
    check_paths(case, ["material.tau0", "profile.height", "profile.at_radius"])
    for paths, said in (
        (["profile.height"], "go together; add profile.at_radius"),
        (["profile.at_radius"], "go together; add profile.height"),
        (["profile.height", "profile.at_radius", "profile.coefficient"], "remove one"),
        (["profile.exponent"], "is another shape with every exponent"),
        (["material.tau"], "no number 'material.tau'; it has material.rubbery_modulus,"),
    ):
        with pytest.raises(ValueError, match=said):
            check_paths(case, paths)
    check_paths(case, ["profile.exponent", "profile.height", "profile.at_radius"])
    series = lens(material=MATERIALS[2])
    check_paths(series, ["material.branches.1.0"])
    with pytest.raises(ValueError, match="no number 'material.branches.2.0'"):
        check_paths(series, ["material.branches.2.0"])


def test_a_tip_is_made_by_its_height_at_a_radius_and_reduced_again_in_groups():
    case = lens(geometry=vt.PowerLawProfile(exponent=3.0, coefficient=1e4))
    tip = {"profile.height": 1e-5, "profile.at_radius": 2e-4}
    found = changed(case, tip).geometry
    assert found.coefficient == pytest.approx(1e-5 / 2e-4**3, rel=1e-14)
    found = changed(case, tip | {"profile.exponent": 2.5}).geometry
    assert found.coefficient == pytest.approx(1e-5 / 2e-4**2.5, rel=1e-14)
    found = changed(case.groups(), {"profile.exponent": 4.0}).geometry
    assert (found.exponent, found.coefficient) == (4.0, 0.25)


def test_the_ratio_of_a_bonded_layer_is_that_of_its_material():
    bonded = vt.Layer(1e-3, vt.Bonded(poisson_ratio=0.4))
    case = lens(material=MATERIALS[2], body=bonded)
    assert changed(case, {"material.poisson_ratio": 0.3}).body.base.poisson_ratio == 0.3
    with pytest.raises(vt.InputError, match="the Poisson ratio of its material"):
        changed(case, {"material.poisson_ratio": 0.3, "layer.poisson_ratio": 0.2})


def test_scales_of_a_punch_follow_their_definitions():
    law = vt.LennardJones(work_of_adhesion=0.15, equilibrium_gap=1.5e-6)
    case = lens(
        material=MATERIALS[1],
        traction=law,
        geometry=vt.FlatPunch(1e-3),
        body=vt.Layer(5e-5),
        protocol=vt.Retraction(start=vt.AtDepth(1e-6), speed=1e-4),
    )
    E_star, strength = E / 0.75, law.strength
    a0 = math.pi * E_star * 0.15 / (2 * strength**2)
    found = {"stress": strength, "length": 1.5e-6, "width": a0, "half_width": 1e-3}
    found |= {"work": 0.15, "time": 0.02, "crack_speed": 1.5e-6 / 0.02}
    assert vars(case.scales()) == pytest.approx(found, rel=1e-13)
    groups = case.groups()
    assert groups.cohesion == pytest.approx(strength / E_star, rel=1e-13)
    assert groups.geometry.half_width == pytest.approx(1e-3 / a0, rel=1e-13)
    assert groups.fracture_length == pytest.approx(a0 / 1.5e-6, rel=1e-12)
    for known in ({"equilibrium_gap": 1.5e-6}, {"work_of_adhesion": 0.15}):
        units = plane.si_units(groups, E_star, None, **known)
        sizes = {"length": 1.5e-6, "height": 1.5e-6, "contact_radius": a0, "along": a0}
        sizes |= {"work": 0.15, "force": strength}
        assert vars(units) == pytest.approx(sizes, rel=1e-12)
    with pytest.raises(ValueError, match="a punch has no radius, got 0 m"):
        plane.si_units(groups, E_star, 0.0, work_of_adhesion=0.15)
