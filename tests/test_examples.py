"""Examples say what they should, with fast settings; the build of the documentation runs all."""

from pathlib import Path

import numpy as np
import pytest

import viscotack as vt
from modules import module_at

EXAMPLES = Path(__file__).parents[1] / "examples"


def load(name):
    return module_at(EXAMPLES / f"{name}.py")


def test_lens_holds_harder_when_pulled_faster(tmp_path, capsys):
    picture = tmp_path / "lens.png"
    elastic, results = load("pdms_lens").main(
        [1e-6, 1e-3], accuracy=2e-3, picture=picture, short_speeds=()
    )
    slow, *forces = [vt.summary(r)["pull_off_force_N"] * 1e3 for r in (elastic, *results)]
    # in mN; the converged values are 3.927, 3.943 and 6.222
    assert [slow, *forces] == pytest.approx([3.927, 3.943, 6.222], rel=3e-3)
    assert elastic.problem.groups().tabor == pytest.approx(2.05, abs=0.01)
    assert picture.stat().st_size > 10_000
    printed = capsys.readouterr().out
    assert str(picture) in printed and "1000.0" in printed


def test_bead_comes_off(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    load("detach_once")
    assert (tmp_path / "detach_once.png").stat().st_size > 10_000
    printed = capsys.readouterr().out
    assert "pull-off force" in printed and printed.split()[-1] == "mN"
    # above the elastic limit, below the glassy one
    assert 0.2356 < float(printed.split()[-2]) < 2.356


def test_profiles_show_tension_at_the_edge(tmp_path, capsys):
    picture = tmp_path / "fields.png"
    result = load("fields").main(rate=1e4, accuracy=5e-3, picture=picture)
    assert picture.stat().st_size > 10_000 and "Picture" in capsys.readouterr().out
    pressure, radius = result.fields["pressure"][0], result.fields["radius"][0]
    edge = radius[np.nanargmin(pressure)]
    assert edge == pytest.approx(result.contact_radius[0], rel=1e-2)
    assert np.nanmin(pressure) == pytest.approx(-vt.LennardJones(1, 1).strength, rel=0.05)


def test_the_loop_is_largest_at_a_middle_speed(tmp_path, capsys):
    example = load("hysteresis")
    results = example.main(accuracy=2e-2, picture=tmp_path / "loops.png")
    heat = [example.lost_work(result)["heat"] for result in results]
    assert heat[1] > 2 * max(heat[0], heat[2])
    assert (tmp_path / "loops.png").stat().st_size > 10_000
    assert "lost in jumps" in capsys.readouterr().out


def test_a_rested_contact_holds_harder(tmp_path):
    relaxed, forces = load("dwell_time").main(
        [1e-2, 1.0, 100.0], accuracy=2e-2, picture=tmp_path / "dwell.png"
    )
    assert forces[0] < forces[1] < forces[2]
    assert forces[2] == pytest.approx(relaxed, rel=1e-2)


def test_a_heavier_load_is_borne_for_a_shorter_time(tmp_path, capsys):
    times = load("dead_load").main([1.2, 2.0], accuracy=2e-2, picture=tmp_path / "load.png")
    # seconds; the converged values are 5.2 and 0.74
    assert times == pytest.approx([5.2, 0.74], rel=0.05)
    assert "still in contact" in capsys.readouterr().out


@pytest.mark.slow
def test_the_files_of_the_rig_are_those_that_their_script_makes():
    module = load("from_rig/make")
    name, speed = "30_um_s", module.SPEEDS["30_um_s"]
    made = np.stack(module.columns(speed, seed=list(module.SPEEDS).index(name))[:3], axis=1)
    kept = np.loadtxt(EXAMPLES / "from_rig" / f"lens_{name}.csv", delimiter=",", skiprows=1)
    scale = np.array([1.0, 1e3, 1e3])
    assert np.allclose(kept, made * scale, rtol=1e-5, atol=1e-3)


def test_a_probe_on_a_gel_snaps_in_and_lets_go():
    gel = vt.read_case(EXAMPLES / "afm" / "gel.toml")
    found = vt.solve(gel, accuracy=0.02, estimate_error=False)
    force = vt.summary(found)["pull_off_force_N"]
    # between the elastic forces of relaxed and instantaneous moduli: 1.5 to 2 pi R dg, over k
    unit = 1.5 * np.pi * 10e-6 * 30e-6
    assert unit < force < 4 / 3 * unit * 2
