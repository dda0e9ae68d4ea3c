"""Rough surfaces in files: through all front ends, outputs, and what is refused."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from command_line import exit_status, rows_of
from viscotack.app.operations import ask
from viscotack.campaign import CaseSettings, measure, read_plan
from viscotack.errors import InputError
from viscotack.model import surfaces
from viscotack.result import Event
from viscotack.simulate.rough import pull, read_rough, read_rough_case
from viscotack.simulate.rough.result import FieldMap, RoughResult

EXAMPLES = Path(__file__).parents[1] / "examples" / "rough"
SMALL = """
[surface]
file = "map.csv"
pixel = "10 um"
height_unit = "1 um"
level = true
[material]
model = "elastic"
rubbery_modulus = "0.75 MPa"
poisson_ratio = 0.5
[interface]
law = "lennard-jones"
work_of_adhesion = "100 mJ/m^2"
equilibrium_gap = "1.5 um"
[protocol]
preload_depth = "1 um"
speed = "20 um/s"
"""
MAP = 'file = "map.csv"\npixel = "10 um"\nheight_unit = "1 um"\nlevel = true'
BUMPS = """
kind = "bumps"
pixels = 16
pixel = "10 um"
radius = "200 um"
spacing = "80 um"
height = "5 um"
"""
LAYER = '[layer]\nthickness = "1 mm"\nbase = "frictionless"\n[material]'


@pytest.fixture
def small(tmp_path, monkeypatch):
    """Return a file with a map of 16 x 16 heights beside it, in a folder to work in."""
    monkeypatch.chdir(tmp_path)
    x = np.linspace(-1, 1, 16)
    heights = 2 - 2 * np.add.outer(x**2, x**2) + 3 * x
    lines = ["# micrometres", *(",".join(f"{h:.6f}" for h in row) for row in heights)]
    Path("map.csv").write_text("\n".join(lines))
    path = Path("small.toml")
    path.write_text(SMALL)
    return path


def test_the_command_writes_a_table_maps_a_picture_and_a_film(small):
    files = "--csv f.csv --maps m.npz --plot a.svg --film a.gif"
    assert exit_status(f"rough small.toml {files} --moments 3") == 0
    rows = rows_of("f.csv")
    assert float(rows[-1]["contact_area_m2"]) == 0
    with np.load("m.npz") as maps:
        assert maps["map_gap_m"].shape[1:] == (16, 16)
        assert 2 <= len(maps["map_gap_m"]) <= 3
        force = -json.loads(str(maps["summary"]))["pull_off_force_N"]
        assert maps["force_N"].min() == pytest.approx(force)
    assert Path("a.svg").stat().st_size > 5000
    assert Path("a.gif").read_bytes()[:6] == b"GIF89a"


def test_the_examples_are_read_and_bumps_pull_off():
    assert read_rough(EXAMPLES / "rough_rubber.toml").zone.pixels > 1.5
    record = ask("rough", file=str(EXAMPLES / "bumps.toml"), accuracy=0.01).record()
    assert record["status"].startswith("detached")
    assert record["patches_at_pull_off"] <= 9


@pytest.mark.parametrize(
    ("old", "new", "field"),
    [
        ('file = "map.csv"', 'kind = "cones"', "kind"),
        ('pixel = "10 um"', "", "pixel"),
        ("level = true", "periodic = true\nlevel = true", "periodic"),
        ('preload_depth = "1 um"', 'preload_radius = "1 um"', "radius"),
        ("[material]", LAYER, "thick"),
    ],
)
def test_a_wrong_file_is_refused_with_the_place(small, old, new, field):
    small.write_text(SMALL.replace(old, new))
    with pytest.raises(InputError, match=field):
        read_rough(small)


def test_a_map_that_is_too_coarse_is_refused_unless_forced(small):
    small.write_text(SMALL.replace('pixel = "10 um"', 'pixel = "60 um"'))
    with pytest.raises(InputError, match="2 are needed"):
        ask("rough", file="small.toml")
    assert "pixels" in ask("rough", file="small.toml", anyway=True, accuracy=0.02).notes[0]


def test_maps_are_read_with_their_digits(tmp_path):
    surface = surfaces.self_affine(16, 1e-6, hurst=0.5, rms_height=1e-7, seed=1)
    np.save(tmp_path / "map.npy", surface.heights)
    again = surfaces.read_map(tmp_path / "map.npy", pixel=1e-6, periodic=True)
    assert np.array_equal(again.heights, surface.heights)


@pytest.mark.parametrize(
    ("name", "content", "place"),
    [
        ("a.csv", b"1,2\n3\n", "line 2"),
        ("a.txt", b"# h\n1 2 # x\n3 4\n", "line 2"),
        ("a.txt", 20_000 * b"1 2\n", "lines"),
        ("a.csv", b"# of two\n\n1,2\n3,4\n5,b\n", "line 5"),
        ("a.csv", b"1 2\n3 4\n", "pixels"),
        ("a.npy", b"no array", "array"),
    ],
)
def test_a_damaged_map_is_refused(tmp_path, name, content, place):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(InputError, match=f"{name}: .*{place}"):
        surfaces.read_map(path, pixel=1e-6)


def test_statistics_of_a_spectrum_are_those_asked_for():
    found = surfaces.self_affine(256, 1e-6, hurst=0.7, rms_height=2e-7, seed=5, shortest=8e-6)
    spread = surfaces.roughness(found)
    assert spread.rms_height == pytest.approx(2e-7, rel=1e-12)
    inside = (spread.wave_number > 1e5) & (spread.wave_number < 7e5)
    q, C = spread.wave_number[inside], spread.spectrum[inside]
    slope = np.polyfit(np.log(q), np.log(C), 1)[0]
    assert slope == pytest.approx(-2 * 1.7, abs=0.15)
    # only a periodic map continues from its last row to its first
    for periodic, apart in ((True, (0.5, 2)), (False, (5, np.inf))):
        h = surfaces.self_affine(
            64, 1e-6, hurst=0.7, rms_height=2e-7, seed=5, shortest=8e-6, periodic=periodic
        ).heights
        assert apart[0] < np.std(h[-1] - h[0]) / np.std(h[1] - h[0]) < apart[1]


def test_waves_and_white_noise_have_the_statistics_of_their_formulas():
    x, q = np.arange(64), 2 * np.pi * np.array([2, 5]) / 64
    waves = np.add.outer(3 * np.cos(q[0] * x), np.cos(q[1] * x))
    found = surfaces.roughness(surfaces.HeightMap(waves, 1.0, periodic=True))
    steps = 2 * np.sin(q / 2)  # of differences, for q
    assert found.rms_slope == pytest.approx(np.hypot(*(steps * [3, 1])) / np.sqrt(2))
    assert found.rms_curvature == pytest.approx(np.hypot(*(steps**2 * [3, 1])) / np.sqrt(8))
    noise, pixel = np.random.default_rng(0).normal(size=(128, 128)), 1e-3
    for periodic in (True, False):  # every wave has the variance times the area of a pixel
        found = surfaces.roughness(surfaces.HeightMap(noise, pixel, periodic))
        assert np.mean(found.spectrum[20:]) == pytest.approx(pixel**2, rel=0.05)


def test_levelling_removes_tilt_and_curvature():
    cap = surfaces.sphere(32, 1e-6, radius=1e-3)
    x = np.arange(32)
    ramp = surfaces.HeightMap(1e-7 * (np.add.outer(x, 2 * x) + 0.02 * np.outer(x, x)), 1e-6)
    flat = (cap + ramp).levelled(curvature=True)
    assert np.abs(flat.heights).max() < 1e-18
    assert surfaces.roughness(cap).rms_curvature == pytest.approx(1e3, rel=1e-6)


# Campaigns and sweeps of rough surfaces: inputs, plans, rows, and what is refused.
PLAN = """
problem = "bumps.toml"
settings = {accuracy = 0.02}
[[grid]]
surface.scatter = ["0 um", "1 um"]
protocol.speed = ["10 um/s", 1e-4]
"""


def test_a_plan_sets_numbers_of_the_surface_and_of_the_test(small):
    Path("plan.toml").write_text(PLAN)
    Path("bumps.toml").write_text(SMALL.replace(MAP, BUMPS))
    plan = read_plan("plan.toml")
    assert plan.kind.columns == ("protocol.speed", "surface.scatter")
    assert len(plan.cases) == 4 and plan.rejected == 0
    last = list(plan.cases)[-1]
    case = plan.kind.problem(last.inputs)
    assert case.surface.scatter == 1e-6 and case.protocol.speed == 1e-4
    row = measure(case, plan.settings)
    found = pull(read_rough("bumps.toml"), accuracy=0.02)
    assert row["pull_off_force_N"] != found.pull_off_force
    same = measure(read_rough_case("bumps.toml"), plan.settings)
    assert same["pull_off_force_N"] == found.pull_off_force
    assert same["work_of_separation_J"] == found.work_of_separation
    assert same["hysteresis_J"] == found.hysteresis and same["status"] == found.status
    assert {"contact_share_at_pull_off", "pastewka_robbins", "steps", "versions"} <= same.keys()


def test_a_pull_counts_its_work_from_zero_force_without_jumps():
    nothing: Any = np.zeros(4)
    series = dict.fromkeys(("work", "elastic", "heat", "jumps", "patches"), nothing)
    found = RoughResult(
        time=np.arange(4.0),
        depth=np.array([2.0, 0.0, -1.0, -3.0]),
        drive=nothing,
        force=np.array([1.0, -3.0, -2.0, 0.0]),
        area=np.array([4.0, 2.0, 1.0, 0.0]),
        interface=np.array([-9.0, -5.0, -2.0, -0.1]),
        last_leg=0,
        status="detached",
        events=(Event("jump out of contact", 3.0, -3.0, 0.0, 1.0),),
        energy_residual=0.0,
        strongest=FieldMap(1.0, 0.0, -3.0, nothing, nothing),
        nominal_area=8.0,
        pixel=1.0,
        **series,
    )
    # a triangle from depth 1.5, a trapezium, and the attraction that is left
    assert found.work_of_separation == pytest.approx(1.5 * 3 / 2 + (3 + 2) / 2 + 0.1)
    assert found.summary["contact_share_at_pull_off"] == 0.25


def test_a_map_that_has_changed_since_is_refused(small):
    case = read_rough_case(small)
    assert len(case.surface.sha256) == 64
    np.savetxt("map.csv", np.zeros((16, 16)), delimiter=",")
    with pytest.raises(InputError, match=r"map\.csv has changed since it was planned"):
        measure(case, CaseSettings())
