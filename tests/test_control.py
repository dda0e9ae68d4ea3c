"""Tests of force tables, the controller of a release, its simulated rig, C and FMU."""

import ctypes
import subprocess
import zipfile
from dataclasses import replace
from math import isnan, nan
from pathlib import Path

import numpy as np
import pytest

import viscotack as vt
from command_line import answered

PAD = vt.Problem(
    vt.StandardSolid(rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.5),
    vt.LennardJones(0.15, 1e-6),
    vt.Sphere(2e-3),
    vt.Retraction(vt.AtForce(1e-3), 1e-4),
)
COARSE = {"tolerance": 0.05, "accuracy": 0.01}
LENS = Path(__file__).parents[1] / "examples" / "from_toml" / "lens.toml"
SMALL = {"slowest": "100 um/s", "fastest": "200 um/s", "tolerance": 0.2, "accuracy": 0.02}


@pytest.fixture(scope="module")
def table():
    return vt.control.force_table(PAD, 2e-5, 2e-4, **COARSE)


def at(speed, **more):
    """Return the pad with the protocol of a speed."""
    return replace(PAD, protocol=replace(PAD.protocol, speed=speed, **more))


def test_the_table_has_the_forces_of_simulations_between_its_speeds(table):
    speed, unit = 3.3e-5, PAD.scales()
    result = vt.solve(at(speed), accuracy=0.01, estimate_error=False)
    peak = vt.pull_off_force(result) * unit.force
    assert table.pull_off_force_at(speed) == pytest.approx(peak, rel=table.error)
    before = result.depth >= vt.pull_off(result).depth
    depths, forces = result.depth[before] * unit.length, result.force[before] * unit.force
    ours = [table.force_at(depth, speed) for depth in depths[1:]]
    # the travels are off by up to the error too, where the force is steep
    travel = table.travel[:, 0].max() * table.error
    steepest = max(abs(table.slope_at(depth, speed)) for depth in depths[1:])
    allowed = table.error * peak + travel * steepest
    assert np.abs(np.array(ours) - forces[1:]).max() < allowed


def test_beyond_the_end_nothing_pulls_and_outside_nothing_is_known(table):
    start, end = table.start_depth, table.travel.max()
    assert table.force_at(start - 1.01 * end, 1e-4) == 0.0
    for depth, speed in ((start * 1.001, 1e-4), (0.0, 1.9e-5), (0.0, 2.1e-4), (nan, 1e-4)):
        assert isnan(table.force_at(depth, speed))
    assert isnan(table.pull_off_force_at(1e-6))


def test_the_slope_is_the_derivative_of_the_force(table):
    for depth in table.start_depth - np.array([0.11, 0.52, 0.83]) * table.travel[0, 0]:
        step = 1e-6 * table.start_depth
        rise = table.force_at(depth + step, 5e-5) - table.force_at(depth - step, 5e-5)
        assert table.slope_at(depth, 5e-5) == pytest.approx(rise / (2 * step), rel=1e-6)


def test_the_speed_for_a_force_has_this_force(table):
    low, high = table.pull_off_force.min(), table.pull_off_force.max()
    for wanted in np.linspace(low, high, 7):
        assert table.pull_off_force_at(table.speed_for(wanted)) == pytest.approx(wanted, rel=1e-9)
    with pytest.raises(vt.OutOfRange):
        table.speed_for(2 * high)


def test_the_controller_lets_go_at_the_wanted_force_where_a_constant_drive_misses(table):
    wanted, spring = 5e-3, 150.0
    release = vt.control.Release(table, wanted, spring, 1e-3)
    found = vt.control.let_go(PAD, release, accuracy=0.01)
    assert abs(found.miss) < 0.02 + table.error
    how = {"accuracy": 0.01, "until": "pull-off", "estimate_error": False}
    open_loop = vt.solve(at(release.speed, stiffness=spring), **how)
    assert vt.pull_off_force(open_loop) * PAD.scales().force < 0.9 * wanted
    # until the pull-off the contact keeps its speed, though the drive goes many times as fast
    peak = int(found.force.argmin())
    speeds = -np.diff(found.depth[2:peak]) / release.period
    assert np.median(speeds) == pytest.approx(release.speed, rel=0.02)
    assert -found.drive_speed[:peak].min() > 5 * release.speed


def test_past_the_pull_off_the_drive_goes_on_at_the_speed(table):
    release = vt.control.Release(table, 4e-3, 100.0, 1e-3, fastest=1.0)
    for force in (-4e-3, -3.95e-3):  # a loss of tension of 1.25 % may be noise
        release.drive_speed(0.0, force)
        assert not release.past
    assert release.drive_speed(-1e-6, -3.9e-3) == -release.speed and release.past
    release.fastest = 0.5 * release.speed
    assert release.drive_speed(-1e-6, -3.9e-3) == -0.5 * release.speed


PUNCH = replace(
    at(1e-4),
    geometry=vt.FlatPunch(half_width=1e-4),
    body=vt.Layer(thickness=50e-6),
    protocol=vt.Retraction(start=vt.AtDepth(1e-6), speed=1e-4),
)


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda t: vt.control.force_table(PUNCH, 1e-5, 1e-4), "mean stress"),
        (lambda t: vt.control.force_table(at(1e-4, stiffness=9.0), 1e-5, 1e-4), "controller"),
        (lambda t: vt.control.force_table(PAD, 1e-4, 1e-5), "slowest"),
        (lambda t: vt.control.Release(t, 4e-3, 0.0, 1e-3), "stiffness"),
    ],
)
def test_what_cannot_be_is_refused(table, make, words):
    with pytest.raises(vt.InputError, match=words):
        make(table)


def test_the_command_writes_all_and_lets_go(tmp_path, capsys):
    flags = [x for name, value in SMALL.items() for x in (f"--{name}", str(value))]
    names = ("contact.h", "speeds.csv", "forces.csv", "ticks.csv", "control.png")
    kinds = ("c", "csv", "forces", "ticks", "plot")
    for kind, name in zip(kinds, names, strict=True):
        flags += [f"--{kind}", str(tmp_path / name)]
    flags += ["--wanted", "4.8 mN", "--stiffness", "300 N/m"]
    release = answered(["control", LENS, *flags], capsys)["release"]
    assert release["pull_off_force_N"] == pytest.approx(4.8e-3, rel=0.03)
    speeds, forces = (
        np.genfromtxt(tmp_path / name, delimiter=",", names=True)
        for name in ("speeds.csv", "forces.csv")
    )
    grid = forces["force_N"].reshape(speeds.size, -1)
    np.testing.assert_allclose(-grid.min(axis=1), speeds["pull_off_force_N"], rtol=1e-3)
    assert np.all(grid[:, 0] > 0) and np.all(grid[np.argmax(speeds["travel_to_end_m"]), -1] == 0)
    sizes = {name: (tmp_path / name).stat().st_size for name in names}
    assert min(sizes.values()) > 200 and sizes["control.png"] > 10_000


# Other readers of the table: a C compiler, a tool for FMUs
def points(table):
    """Draw depths and speeds, some outside the table, and what the table says there."""
    rng = np.random.default_rng(5)
    speed = np.exp(rng.uniform(*np.log(table.speed[[0, -1]]) + [-0.2, 0.2], 400))
    depth = table.start_depth - rng.uniform(-0.05, 1.1, 400) * table.travel.max()
    speed[:9], depth[:9] = table.speed[0], table.start_depth - table.travel[0, 0]
    said = [
        (table.force_at(d, v), table.slope_at(d, v), table.pull_off_force_at(v))
        for d, v in zip(depth, speed, strict=True)
    ]
    return np.c_[depth, speed], np.array(said)


def same(found, table_says):
    """Compare to 1e-9 of the largest; what is not known must be the same."""
    assert found.shape == table_says.shape
    np.testing.assert_array_equal(np.isnan(found), np.isnan(table_says))
    assert np.nanmax(np.abs(found - table_says) / np.nanmax(np.abs(table_says), axis=0)) < 1e-9


@pytest.mark.outside
def test_a_program_in_c_reads_the_same_digits_and_controls_alike(table, tmp_path):
    asked, said = points(table)
    np.savetxt(tmp_path / "in.txt", asked, fmt="%.17g")
    (tmp_path / "contact.h").write_text(vt.control.c_header(table))
    (tmp_path / "main.c").write_text(
        """#include "contact.h"
        #include <stdio.h>
        int main(void) {
          double d, v, f, s;
          int n = 0;
          contact_release it;
          if (!contact_start(&it, 4e-3, 250, 1e-3, 1e-2)) return 1;
          while (scanf("%lf %lf", &d, &v) == 2) {
            contact_force(d, v, &f, &s);
            printf("%.17g %.17g %.17g %.17g\\n", f, s, contact_pull_off_force(v),
                   contact_drive_speed(&it, d, n++ < 200 ? v : -40 * v));
          }
          return contact_start(&it, 1, 250, 1e-3, 1e-2);
        }"""
    )
    strict = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]
    subprocess.run(["cc", *strict, "main.c", "-o", "main", "-lm"], cwd=tmp_path, check=True)
    with open(tmp_path / "in.txt") as given:
        done = subprocess.run(["./main"], cwd=tmp_path, stdin=given, capture_output=True)
    assert done.returncode == 0
    found = np.array([line.split() for line in done.stdout.decode().splitlines()], float)
    same(found[:, :3], said)
    release = vt.control.Release(table, 4e-3, 250.0, 1e-3, 1e-2)
    pulled = np.where(np.arange(len(asked)) < 200, 1.0, -40.0) * asked[:, 1]
    ours = np.array([release.drive_speed(*x) for x in zip(asked[:, 0], pulled, strict=True)])
    np.testing.assert_allclose(found[:, 3], ours, rtol=1e-9)


@pytest.mark.outside
def test_an_fmu_answers_the_same_digits(table, tmp_path):
    asked, said = points(table)
    (tmp_path / "contact.fmu").write_bytes(vt.control.fmu(table))
    with zipfile.ZipFile(tmp_path / "contact.fmu") as archive:
        archive.extractall(tmp_path)
    library = ctypes.CDLL(str(next(tmp_path.glob("binaries/*/contact.*"))))
    make = library.fmi3InstantiateCoSimulation
    make.restype = ctypes.c_void_p
    description = (tmp_path / "modelDescription.xml").read_text()
    token = description.split('instantiationToken="')[1].split('"')[0].encode()
    no = ctypes.c_bool(False)
    rest = (None, no, no, no, no, None, ctypes.c_size_t(0), None, None, None)
    assert make(b"one", b"another", *rest) is None
    one = ctypes.c_void_p(make(b"one", token, *rest))
    inputs, outputs = (ctypes.c_uint32 * 2)(1, 2), (ctypes.c_uint32 * 3)(3, 4, 5)
    found = []
    for pair in asked:
        given, answer = (ctypes.c_double * 2)(*pair), (ctypes.c_double * 3)()
        counts = ctypes.c_size_t(2), ctypes.c_size_t(3)
        assert library.fmi3SetFloat64(one, inputs, counts[0], given, counts[0]) == 0
        assert library.fmi3GetFloat64(one, outputs, counts[1], answer, counts[1]) == 0
        found.append(list(answer))
    assert library.fmi3SetFloat64(one, outputs, counts[0], given, counts[0]) == 3
    library.fmi3FreeInstance(one)
    same(np.array(found), said)
