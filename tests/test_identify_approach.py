"""The range of attraction from the approach: limits, synthetic approaches, refusals."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import viscotack as vt
from viscotack.app.operations import ask
from viscotack.identify import attraction, identify_approach
from viscotack.identify.approach import work_of_jump_in
from viscotack.lab.tack import TackRecord, evaluate, survey
from viscotack.theory import jkr

RADIUS, MODULUS, WORK, STIFFNESS = 7.5e-6, 1.96e6, 57.5e-3, 3.01
SOLID = {"radius": RADIUS, "contact_modulus": MODULUS}
SPHERE = SOLID | {"work_of_adhesion": WORK}
STEP, SPEED = 3e-9, 20e-9


def law(gap, work=WORK):
    return vt.LennardJones(work_of_adhesion=work, equilibrium_gap=gap)


def sampled(drive, force, noise, seed):
    """Return a test whose force is known by the drive on the way in and out, at equal steps."""
    turn = int(drive.argmax())
    ends = drive[0] - 1e-6, drive[-1] - 1e-6
    place = STEP * np.random.default_rng(seed).random()
    down = np.arange(ends[0] + place, drive[turn], STEP)
    up = np.arange(drive[turn], ends[1], -STEP)
    way = np.concatenate([down, np.full(60, drive[turn]), up])
    # a jump takes no travel of the drive
    rising = np.maximum.accumulate(drive[: turn + 1])
    falling = np.minimum.accumulate(drive[turn:])[::-1]
    pressed = np.interp(down, rising, force[: turn + 1], left=0.0)
    pulled = np.interp(up, falling, force[turn:][::-1], left=0.0)
    clean = np.concatenate([pressed, np.full(60, force[turn]), pulled])
    noisy = clean + noise * np.random.default_rng(seed + 1000).standard_normal(clean.size)
    time = STEP / SPEED * np.arange(way.size)
    record = TackRecord(time, noisy, way, into=1, compliance=1 / STIFFNESS)
    (cycle,) = evaluate(record).cycles
    return cycle


@cache
def by_theory(gap, noise=0.5e-9, seed=0):
    """Return a test whose attraction is computed here, and whose contact is that of JKR."""
    before = attraction(law(gap), **SOLID, stiffness=STIFFNESS)
    far = np.geomspace(before.travel[-1], 1e-6, 50)[1:]
    travel = np.append(before.travel, far)[::-1]
    radii = np.linspace(1e-7, 4e-6, 4000)
    force = jkr.force(radii, **SPHERE)
    drive = jkr.depth(radii, **SPHERE) + force / STIFFNESS
    stable = int(drive.argmin())
    inside = drive >= 0
    inside[: stable + 1] = False
    in_contact = (drive[inside], force[inside])
    way = [-travel, in_contact[0], drive[stable:][::-1], [drive[stable] - 1e-12, -1.2e-6]]
    pulls = [-before.at(travel), in_contact[1], force[stable:][::-1], [0.0, 0.0]]
    return sampled(np.concatenate(way), np.concatenate(pulls), noise, seed)


def by_solver(gap, noise, seed=0):
    """Return a test that the solver simulates, from far apart through the contact and out."""
    problem = vt.Problem(
        material=vt.Elastic(rubbery_modulus=0.75 * MODULUS, poisson_ratio=0.5),
        traction=law(gap),
        geometry=vt.Sphere(radius=RADIUS),
        protocol=vt.Retraction(
            start=vt.Apart(gap=60 * gap),
            moves=(vt.Approach(speed=SPEED, to=vt.AtForce(1e-6)),),
            speed=SPEED,
            stiffness=STIFFNESS,
        ),
    )
    result = vt.solve(problem, estimate_error=False)
    scales = problem.scales()
    force = result.force * scales.force
    return sampled(result.depth * scales.length + force / STIFFNESS, force, noise, seed)


def test_a_rigid_solid_jumps_where_the_spring_yields():
    soft = 0.01
    found = attraction(law(0.2e-9), radius=RADIUS, contact_modulus=1e13, stiffness=soft)
    height = (16 * np.pi * WORK * 0.2e-9**2 * RADIUS / (3 * soft)) ** (1 / 3)
    assert found.force[0] == pytest.approx(soft * height / 2, rel=0.01)
    # farther away the force of a sphere and a half-space, over the height of the sphere
    travel = 2 * height
    gap = height + travel
    for _ in range(50):
        hamaker = 16 * np.pi * WORK * 0.2e-9**2
        pull = hamaker * RADIUS / (6 * gap**2)
        gap = height + travel + soft * height / 2 / soft - pull / soft
    assert found.at(np.array([travel]))[0] == pytest.approx(pull, rel=0.02)


def test_a_soft_solid_jumps_by_its_own_scale():
    small, large = (attraction(law(gap), **SOLID).force[0] for gap in (0.05e-9, 0.1e-9))
    assert np.log2(large / small) == pytest.approx(6 / 7, abs=0.01)


def test_the_jump_is_that_of_the_solver():
    gap = 30.8e-9
    problem = vt.Problem(
        vt.Elastic(rubbery_modulus=0.75 * MODULUS, poisson_ratio=0.5),
        law(gap),
        vt.Sphere(RADIUS),
        vt.Retraction(
            vt.Apart(20 * gap), None, moves=(vt.Approach(speed=1e-7, to=vt.AtForce(1e-7)),)
        ),
    )
    result = vt.solve(problem, estimate_error=False)
    simulated = -result.force[int(np.diff(result.force).argmin())] * problem.scales().force
    # the last step before the jump falls a little short of it
    assert attraction(law(gap), **SOLID).force[0] == pytest.approx(simulated, rel=0.02)


def test_the_tension_after_the_jump_in_has_its_work():
    rigid = 4 / 3 * np.pi * RADIUS * WORK
    assert work_of_jump_in(rigid, **SOLID) == pytest.approx(WORK, rel=1e-6)
    cycle = by_theory(0.2e-9)
    fit = identify_approach(cycle, **SOLID)
    # the drive has moved on by a part of a step at the first sample after the jump
    assert fit.works[0] == pytest.approx(WORK, rel=0.02)
    assert fit.works[1] == pytest.approx(WORK, rel=0.02)


def test_a_simulated_range_lies_in_its_interval():
    gap = 101e-9
    fit = identify_approach(by_solver(gap, 5e-9), **SOLID)
    assert fit.equilibrium_gap.low < gap < fit.equilibrium_gap.high
    assert fit.likely == pytest.approx(gap, rel=0.2)
    assert fit.equilibrium_gap.high < 1.5 * gap


@pytest.mark.slow
def test_the_bound_holds_as_often_as_it_says():
    gap = 0.2e-9
    fits = [identify_approach(by_theory(gap, seed=seed), **SOLID) for seed in range(6)]
    bounds = np.array([fit.bound for fit in fits])
    # 90 % of them, within three standard deviations of the binomial
    assert np.mean(bounds > gap) > 0.9 - 3 * (0.09 / 6) ** 0.5
    assert np.median(bounds) < 0.8e-9
    # without attraction above the noise there is a bound only
    assert any(fit.equilibrium_gap is None for fit in fits)
    # less noise narrows the bound
    assert identify_approach(by_theory(gap, 0.05e-9), **SOLID).bound < np.median(bounds)


@pytest.mark.slow
def test_the_interval_holds_as_often_as_it_says():
    gap = 1e-9
    fits = [identify_approach(by_theory(gap, seed=seed), **SOLID) for seed in range(6)]
    held = [fit.equilibrium_gap.low < gap < fit.equilibrium_gap.high for fit in fits]
    assert np.mean(held) > 0.9 - 3 * (0.09 / 6) ** 0.5


def test_a_stiffer_solid_at_once_lowers_the_lower_end_only():
    cycle = by_theory(1e-9, noise=0.2e-9)
    elastic = identify_approach(cycle, **SOLID)
    other = identify_approach(cycle, **SOLID, instantaneous=100 * MODULUS)
    assert other.bound == elastic.bound
    assert other.equilibrium_gap.low < elastic.equilibrium_gap.low


def test_what_no_range_explains_is_refused():
    cycle = by_theory(0.2e-9)
    curved = np.linspace(-1, 1, cycle.force.size)
    wavy = replace(cycle, force=cycle.force + 40e-9 * np.sin(30 * curved))
    with pytest.raises(vt.OutOfRange, match="baseline"):
        identify_approach(wavy, **SOLID)
    with pytest.raises(vt.OutOfRange, match="without a jump"):
        attraction(law(5e-9), radius=1e-8, contact_modulus=1e9, stiffness=1e3)
    with pytest.raises(vt.InputError, match="level"):
        identify_approach(cycle, **SOLID, level=1.2)


@pytest.fixture
def file(tmp_path):
    """Write a test in the layout of a MEMS indenter, with wrong units above its columns."""
    cycle = by_theory(0.2e-9)
    drive = cycle.depth + cycle.compliance * cycle.force
    above = ["Quasi static measurement routine", "Tip", "09.09.2022", ""]
    rows = [
        "\t".join(
            f"{x:.6f}".replace(".", ",") for x in (1e6 * z, 1e9 * F / STIFFNESS, t, 0, 22, 50)
        )
        for z, F, t in zip(drive, cycle.force, cycle.time, strict=True)
    ]
    heads = "Piezo position[nm]\tMEMS displ.[nm]\tTime[ms]\tCap [pf]\tTemp [°C]\tRh [%]"
    path = Path(tmp_path, "EM-PDMS, 20nms")
    path.write_bytes("\n".join([*above, heads, "eoh", *rows, ""]).encode("latin-1"))
    return path, cycle


def test_files_of_a_mems_indenter_are_read(file):
    path, cycle = file
    (read,) = survey([path], reading={"spring_constant": STIFFNESS}).cycles
    assert read.pull_off_force.value == pytest.approx(cycle.pull_off_force.value, rel=1e-3)
    assert read.speed.value == pytest.approx(SPEED, rel=0.01)
    (refused,) = survey([path]).reasons
    assert "`spring_constant`" in str(refused)


def test_the_operation_bounds_the_range(file):
    path, cycle = file
    given = {"files": [str(path)], "radius": "7.5 um", "spring_constant": "3.01 N/m"}
    (record,) = ask("identify approach", **given, contact_modulus="1.96 MPa").record()["approaches"]
    assert record["bound_m"] == pytest.approx(identify_approach(cycle, **SOLID).bound, rel=0.1)
    with pytest.raises(vt.InputError, match="contact_modulus"):
        ask("identify approach", **given)


def test_a_rate_series_knows_the_bound_of_its_approaches(file, monkeypatch):
    path, cycle = file
    known = []

    def series(tests, **options):
        known.append(options["range_bound"])
        raise vt.InputError("enough")

    monkeypatch.setattr("viscotack.identify.rate_series.RateSeries", series)
    rubber = '[material]\nmodel = "elastic"\nrubbery_modulus = "1.47 MPa"\npoisson_ratio = 0.5\n'
    given = {"files": [str(path)], "radius": "7.5 um", "spring_constant": "3.01 N/m"}
    with pytest.raises(vt.InputError, match="enough"):
        ask("identify rates", **given, material=rubber)
    assert known == [pytest.approx(identify_approach(cycle, **SOLID).bound, rel=0.1)]
