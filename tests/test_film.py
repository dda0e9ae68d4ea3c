"""A lens on a film through every door, and refused by each tier that has not learned it."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

import viscotack as vt
from command_line import exit_status
from front_ends import Http, Question, by_command, by_http, by_python, by_study
from viscotack.app.operations import ask
from viscotack.theory import disc, film

CASE = """
[material]
model = "sls"
rubbery_modulus = "1 MPa"
glassy_modulus = "10 MPa"
tau0 = "1 s"
poisson_ratio = 0.49
[interface]
law = "lennard-jones"
work_of_adhesion = "50 mJ/m^2"
equilibrium_gap = "1 um"
[sphere]
radius = "2 mm"
[layer]
thickness = "60 um"
base = "bonded"
[protocol]
preload_depth = "1 um"
speed = "10 um/s"
"""


@pytest.fixture
def problem(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("case.toml").write_text(CASE)
    return vt.read_case("case.toml")


def test_a_case_file_states_it(problem):
    assert problem.body == vt.Layer(60e-6, vt.Bonded(poisson_ratio=0.49))
    unit = problem.scales().radius / 3.141592653589793 ** (1 / 3)
    assert problem.groups().body.thickness == pytest.approx(60e-6 / unit)


def test_every_door_gives_the_same_answer(problem):
    question = Question("simulate", {"problem": "case.toml", "until": "pull-off", "accuracy": 0.01})
    http = Http()
    try:
        found = by_python(question)
        assert found.record["thickness"] == problem.groups().body.thickness
        assert found == by_command(question) == by_study(question) == by_http(question, http)
    finally:
        http.close()


def test_flags_state_a_layer(capsys):
    flags = (
        "simulate sphere --tabor 1 --material elastic --preload 1 --accuracy 0.01 --json".split()
    )
    assert exit_status([*flags, "--thickness", "0.5", "--bonded", "0.3"]) == 0
    found = json.loads(capsys.readouterr().out)
    groups = vt.Groups(
        1.0,
        vt.Elastic(rubbery_modulus=1.0, poisson_ratio=0.0),
        vt.AtDepth(1.0),
        1.0,
        body=vt.Layer(0.5, vt.Bonded(poisson_ratio=0.3)),
    )
    assert found["thickness"] == 0.5
    result = vt.solve(groups, accuracy=0.01)
    assert found["pull_off_force"] == pytest.approx(vt.pull_off_force(result), rel=1e-12)


def test_a_film_is_not_pressed_beyond_half_its_thickness(problem):
    deep = vt.Retraction(vt.AtDepth(40e-6), 1e-5)
    with pytest.raises(vt.InputError, match="over 0.5 thicknesses of the layer"):
        replace(problem, protocol=deep)
    replace(problem, protocol=deep, body=vt.Layer(300e-6, problem.body.base))
    with pytest.raises(vt.InputError, match="over 0.5 thicknesses"):
        replace(problem, protocol=vt.Retraction(vt.AtForce(10.0), 1e-5))


def test_a_disc_is_pressed_by_the_stiffness_of_its_layer():
    parts = {"material": vt.Elastic(rubbery_modulus=1e6, poisson_ratio=0.5)}
    parts |= {"traction": vt.LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-8)}
    parts |= {"geometry": vt.Disc(1e-3)}
    thin = vt.Layer(1e-5, vt.Bonded(poisson_ratio=0.5))
    vt.Problem(**parts, body=thin, protocol=vt.Retraction(vt.AtForce(1.5), 1e-8))
    with pytest.raises(vt.InputError, match="deeper than half the thickness of the layer"):
        vt.Problem(**parts, body=vt.Layer(1e-4), protocol=vt.Retraction(vt.AtDepth(4e-4), 1e-8))


@pytest.mark.slow
def test_theories_of_a_film_are_asked_in_si():
    lens = {"radius": "5 mm", "contact_modulus": "2 MPa", "work_of_adhesion": "50 mJ/m^2"}
    record = ask("theory jkr", **lens, thickness="50 um", bonded=0.5).record()
    solid = {"contact_modulus": 2e6, "work_of_adhesion": 0.05}
    layer = vt.Layer(50e-6, vt.Bonded(poisson_ratio=0.5))
    end = film.pull_off(shape=vt.Sphere(5e-3), body=layer, **solid)
    assert record["pull_off_force_N"] == -end.force
    assert record["over_half_space"] == pytest.approx(-end.force / (1.5e-3 * 0.25 * 3.14159265))
    work = film.work_to_pull_off(shape=vt.Sphere(5e-3), body=layer, **solid)
    assert record["work_to_pull_off_J"] == work
    answer = ask("theory disc", **lens, thickness="100 um", strength="20 kPa")
    assert "kN/m" in answer.words() or "MN/m" in answer.words()
    limit = disc.strength_limit(contact_radius=5e-3, strength=20e3)
    assert answer.record()["pull_off_force_N"] == limit
    assert answer.record()["over_half_space"] > 1
    with pytest.raises(vt.InputError, match="give its thickness as well"):
        ask("theory disc", **lens, bonded=0.3)
