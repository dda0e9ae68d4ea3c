"""A lens on a film through every door, and refused by each tier that has not learned it."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

import viscotack as vt
from command_line import exit_status
from front_ends import Http, Question, by_command, by_form, by_http, by_python, by_study
from viscotack.campaign import Store, read_plan, run
from viscotack.operations import ask
from viscotack.theory import disc, film
from viscotack.theory.elastic import indenter

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


def test_it_is_saved_and_loaded(problem, tmp_path):
    result = vt.solve(problem, until="pull-off", accuracy=1e-2, estimate_error=False)
    vt.save(result, tmp_path / "run.npz")
    again = vt.load(tmp_path / "run.npz")
    assert again.problem == problem and vt.pull_off_force(again) == vt.pull_off_force(result)
    stiff = vt.solve(
        replace(problem, body=vt.HalfSpace()), until="pull-off", accuracy=1e-2, estimate_error=False
    )
    assert abs(vt.pull_off_force(stiff) / vt.pull_off_force(result) - 1) > 0.02


@pytest.mark.parametrize("send", [by_http, by_form])
def test_every_door_gives_the_same_answer(send, problem):
    question = Question("simulate", {"problem": "case.toml", "until": "pull-off", "accuracy": 0.01})
    http = Http()
    try:
        found = by_python(question)
        assert found.record["thickness"] == problem.groups().body.thickness
        assert found == by_command(question) == by_study(question) == send(question, http)
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


def test_a_poisson_ratio_without_a_thickness_is_refused(capsys):
    flags = "simulate sphere --tabor 1 --material elastic --preload 1 --bonded 0.3".split()
    assert exit_status(flags) == 2
    assert "give its --thickness as well" in capsys.readouterr().err


def test_a_campaign_varies_the_thickness(problem, tmp_path):
    Path("plan.toml").write_text(
        'problem = "case.toml"\n[settings]\naccuracy = 2e-2\n'
        '[[grid]]\nbody.thickness = ["30 um", "60 um"]\n'
    )
    assert run(read_plan("plan.toml"), tmp_path / "study", workers=1).failed == 0
    rows = Store(tmp_path / "study").results().to_pylist()
    assert rows[0]["pull_off_force_N"] != rows[1]["pull_off_force_N"]


@pytest.mark.parametrize("tier", [vt.predict, vt.crack_contact])
def test_tiers_that_have_not_learned_layers_refuse_in_words(problem, tier):
    with pytest.raises(vt.InputError, match="layer|Bonded"):
        tier(problem)


def test_a_film_is_not_pressed_beyond_half_its_thickness(problem):
    deep = vt.Retraction(vt.AtDepth(40e-6), 1e-5)
    with pytest.raises(vt.InputError, match="over 0.5 thicknesses of the layer"):
        replace(problem, protocol=deep)
    replace(problem, protocol=deep, body=vt.Layer(300e-6, problem.body.base))
    with pytest.raises(vt.InputError, match="over 0.5 thicknesses"):
        replace(problem, protocol=vt.Retraction(vt.AtForce(10.0), 1e-5))


def test_a_worn_tip_on_a_layer_has_limits_in_words():
    # flat in the middle: its depth there has no logarithm
    worn = vt.MeasuredProfile(((0.0, 0.0), (1e-4, 0.0), (2e-4, 1e-6), (3e-4, 3e-6)))
    parts = {"material": vt.Elastic(rubbery_modulus=1e8, poisson_ratio=0.3), "geometry": worn}
    parts |= {"traction": vt.LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-7)}
    layer = vt.Layer(1e-3, vt.Bonded(poisson_ratio=0.3))
    test = vt.Retraction(vt.AtDepth(1e-6), 1e-6)
    assert vt.Problem(**parts, body=layer, protocol=test).groups().in_plane_strain is False
    with pytest.raises(vt.InputError, match="too wide for a shape with details"):
        indenter.bare_depth(2e-4, shape=worn, body=vt.Layer(1e-6))


def test_a_disc_is_pressed_by_the_stiffness_of_its_layer():
    parts = {"material": vt.Elastic(rubbery_modulus=1e6, poisson_ratio=0.5)}
    parts |= {"traction": vt.LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-8)}
    parts |= {"geometry": vt.Disc(1e-3)}
    thin = vt.Layer(1e-5, vt.Bonded(poisson_ratio=0.5))
    vt.Problem(**parts, body=thin, protocol=vt.Retraction(vt.AtForce(1.5), 1e-8))
    with pytest.raises(vt.InputError, match="deeper than half the thickness of the layer"):
        vt.Problem(**parts, body=vt.Layer(1e-4), protocol=vt.Retraction(vt.AtDepth(4e-4), 1e-8))


def test_flags_state_a_disc_on_a_layer_and_a_measured_profile(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    test = "--tabor 1 --material elastic --accuracy 0.02 --json".split()
    layer = "--preload 0.5 --thickness 0.5 --bonded 0.3".split()
    assert exit_status(["simulate", "disc", *test, *layer]) == 0
    found = json.loads(capsys.readouterr().out)
    solid = vt.Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    body = vt.Layer(0.5, vt.Bonded(poisson_ratio=0.3))
    case = {"tabor": 1.0, "material": solid, "rate": 1.0}
    stamp = vt.Groups(**case, start=vt.AtDepth(0.5), body=body, geometry=vt.Disc(1.0))
    assert found["pull_off_force"] == vt.solve(stamp, accuracy=0.02).pull_off_force
    rows = [(r / 10, max(r / 10 - 0.3, 0.0) ** 2) for r in range(41)]
    text = "\n".join(f"{r},{z}" for r, z in rows)
    Path("worn.csv").write_text(f"radius_1,height_1\n{text}\n")
    flags = ["simulate", "profile", *test, "--preload", "1"]
    assert exit_status([*flags, "--points", "worn.csv"]) == 0
    found = json.loads(capsys.readouterr().out)
    worn = vt.MeasuredProfile(tuple(rows))
    worn = worn.reduced(1.0, 1 / worn.equivalent_radius(1.0))
    worn = vt.Groups(**case, start=vt.AtDepth(1.0), geometry=worn)
    assert found["pull_off_force"] == vt.solve(worn, accuracy=0.02).pull_off_force
    assert exit_status([*flags, "--points", "worn.csv", "--profile-exponent", "2"]) == 2
    assert "not both" in capsys.readouterr().err
    http = Http()
    try:
        given = {"indenter": "profile", "tabor": 1.0, "material": "elastic", "preload": 1.0}
        question = Question("advise", {"problem": given | {"points": "worn.csv"}})
        record = by_python(question).record
        assert record["slow_force"] > 0
        assert by_study(question).record == by_http(question, http).record == record
        elsewhere = Question("advise", {"problem": given | {"points": "/etc/hostname"}})
        assert "must name a file FILE.csv" in by_http(elsewhere, http).refused
    finally:
        http.close()


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
