"""The state of the page: the same case as tables, link, file, command line and Python."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

import viscotack as vt
from viscotack.app.engine.forms import forms
from viscotack.app.engine.overview import quick
from viscotack.errors import InputError
from viscotack.forecast import advise, predict
from viscotack.forecast.closed_forms import closed_forms
from viscotack.forecast.tiers import AT_ONCE
from viscotack.operations.declare.options import Here
from viscotack.operations.declare.state import State, state_of_query, state_of_toml
from viscotack.operations.declare.statement import Stated
from viscotack.operations.parts.examples import EXAMPLES, FIRST
from viscotack.operations.parts.library import material_table
from viscotack.problem.case_file import case_of_tables, read_case
from viscotack.problem.record import to_dict
from viscotack.theory import lennard_jones

examples = pytest.mark.parametrize("tables", EXAMPLES.values(), ids=EXAMPLES)


@examples
def test_link_file_and_python_state_the_same_problem(tables, tmp_path):
    state = State(tables)
    assert state_of_query(state.query).tables == state.tables
    assert state_of_toml(state.toml).tables == state.tables
    file = tmp_path / "case.toml"
    file.write_text(state.toml)
    problem = read_case(file)
    assert state.problem == problem
    names = {}
    exec(state.python().partition("result =")[0], names)  # noqa: S102  # written by ourselves
    assert names["problem"] == problem


def test_a_series_of_branches_goes_through_a_link():
    series = {
        "model": "prony",
        "rubbery_modulus": "1 MPa",
        "poisson_ratio": 0.5,
        "branches": [["5 MPa", "1 ms"], ["4 MPa", "1 s"]],
    }
    state = State(FIRST | {"material": series})
    assert state_of_query(state.query).problem == state.problem
    assert state_of_toml(state.toml).problem == state.problem


def test_a_profile_stated_by_its_slope_is_a_cone_in_every_form():
    text = Path("examples/from_toml/cone.toml").read_text()
    state = state_of_toml(text)
    assert state.tables["cone"] == {"slope": 0.05} and "profile" not in state.tables
    assert state.problem == read_case("examples/from_toml/cone.toml")


def test_the_command_line_says_the_accuracy_and_how_far():
    lines = State(FIRST).command(accuracy=0.005, until="pull-off")
    assert "simulate case case.toml --accuracy 0.005 --until pull-off" in lines
    assert "accuracy=0.005, until='pull-off'" in State(FIRST).python(
        accuracy=0.005, until="pull-off"
    )
    # two lines that every shell reads, for the case file that is saved beside them
    commands = "viscotack simulate case case.toml\nviscotack predict case.toml\n"
    assert State(FIRST).command() == commands


@pytest.mark.parametrize(
    ("tables", "said"),
    [
        ([], "must be tables"),
        ({"material": 3}, "must be tables"),
        ({"material": {"model": None}}, "must be text, a number or a list"),
        ({"material": {"exponent": True}}, "must be text, a number or a list"),
        ({"material": {"exponent": float("nan")}}, "must be finite"),
        ({"material": {str(i): 1 for i in range(300)}}, "more than 200 keys"),
        ({"material": {"branches": [[[[1]]]]}}, "must be text, a number or a list"),
    ],
)
def test_what_is_no_case_is_refused(tables, said):
    with pytest.raises(InputError, match=said):
        State(tables)


def test_a_request_states_a_problem_by_tables_or_by_a_record():
    problem = case_of_tables(FIRST)
    read = Stated("").read
    assert read(FIRST, Here()).problem == read(to_dict(problem), Here()).problem == problem
    with pytest.raises(InputError, match="got a Sphere"):
        read({"type": "Sphere", "radius": 1.0}, Here())


def test_a_material_written_as_a_table_is_the_material():
    prony = vt.Prony(rubbery_modulus=1e6, branches=((5e6, 1e-3), (4e6, 1.0)), poisson_ratio=0.3)
    for solid in (case_of_tables(FIRST).material, prony):
        assert case_of_tables(FIRST | {"material": material_table(solid)}).material == solid


def test_every_noun_that_can_be_typed_has_a_form_whose_examples_make_it():
    asked = forms()
    assert json.loads(json.dumps(asked)) == asked

    def values(fields):
        return {
            f["key"]: json.loads(f["example"]) if f["kind"] == "pairs" else f["example"]
            for f in fields
            if not f["optional"]
        }

    for choice in asked["material"]:
        solid = {"model": choice["word"]} | values(choice["fields"])
        assert State(FIRST | {"material": solid}).problem.material.word == choice["word"]
    for choice in asked["interface"]:
        law = {"law": choice["word"]} | values(choice["fields"])
        assert State(FIRST | {"interface": law}).problem.traction.word == choice["word"]
    rest = {name: table for name, table in FIRST.items() if name != "sphere"}
    for choice in asked["shape"]:
        tables = rest | {choice["word"]: values(choice["fields"])}
        if choice["symmetry"] == "plane":
            tables["layer"] = values(asked["layer"]["fields"]) | {"base": "bonded"}
            tables["protocol"] = {"preload_depth": "1 um", "speed": "10 um/s"}
            tables["material"] = rest["material"] | {"poisson_ratio": 0.4}
        assert State(tables).problem.geometry.symmetry == choice["symmetry"]
    for starts in (asked["protocol"][name]["starts"] for name in ("revolution", "plane")):
        assert all(start["title"] and start["example"] for start in starts)


def test_quick_answers_are_those_of_predict_and_advise():
    problem = State(FIRST).problem
    found, scales = quick(State(FIRST)), problem.scales()
    answer = predict(problem)
    learned = next(
        x for x in found["numbers"] if (x["name"], x["method"]) == ("pull_off_force", "surrogate")
    )
    assert learned["value"] == pytest.approx(answer.pull_off_force * scales.force, rel=1e-12)
    # the page has one headline, that of every other interface
    assert [x["method"] for x in found["numbers"]] == ["surrogate", "surrogate"]
    assert advise(problem).pull_off_force == answer.pull_off_force
    tiers = {tier.tier: tier for tier in advise(problem).estimates}
    edge = found["curves"]["edge"]
    assert (edge["applies"], edge["why"]) == (tiers["unloading"].applies, tiers["unloading"].why)
    # the slow limit is JKR's, from the start that was asked for
    elastic = found["curves"]["elastic"]
    assert elastic["force"][0] == pytest.approx(1.5e-3, rel=1e-6)
    assert found["start"]["force"] == pytest.approx(1.5e-3, rel=1e-9)
    assert min(elastic["force"]) == pytest.approx(-scales.force, rel=1e-3)
    speeds = found["speeds"]
    here = min(range(41), key=lambda i: abs(speeds["speed"][i] / speeds["here"] - 1))
    assert speeds["force"][here] == pytest.approx(learned["value"], rel=0.05)
    assert json.loads(json.dumps(found, allow_nan=False)) == found


@pytest.mark.parametrize(("work", "is_crack"), [(0.15, False), (0.01, True)])
def test_an_elastic_pad_comes_off_as_a_crack_or_at_its_strength(work, is_crack):
    tables = EXAMPLES["A flat punch on a soft layer"]
    strength = State(tables).problem.traction.strength
    law = {
        "law": "lennard-jones",
        "work_of_adhesion": f"{work} J/m^2",
        "strength": f"{strength!r} Pa",
    }
    state = State(tables | {"interface": law})
    problem, elastic = state.problem, quick(state)["curves"]["elastic"]
    from viscotack.theory.punch import crossover

    case = {
        "half_width": 1e-3,
        "contact_modulus": problem.material.contact_modulus,
        "work_of_adhesion": work,
        "base": problem.body.base,
    }
    crack = crossover.pull_off_stress(50e-6, **case)
    assert (crack < strength) is is_crack
    assert -elastic["force"][-1] == pytest.approx(min(crack, strength), 1e-6)
    assert elastic["force"][0] == pytest.approx(2e3)


def test_beyond_the_surrogate_of_power_laws_the_other_speeds_are_answered_at_once():
    # a Tabor number of 158, and speeds beyond the learned crack, where only theories answer
    interface = FIRST["interface"] | {"equilibrium_gap": "20 nm"}
    state = State(
        FIRST | {"interface": interface, "protocol": {"preload_depth": "6 um", "speed": "3 m/s"}}
    )
    found, problem = quick(state), state.problem
    speeds, (learned, *_) = found["speeds"], found["numbers"]
    assert learned["method"] == "learned crack contact"
    assert 3 < len(speeds["speed"]) < 17
    for speed, force in zip(speeds["speed"][::3], speeds["force"][::3], strict=True):
        other = replace(problem, protocol=replace(problem.protocol, speed=speed))
        answer = predict(other, budget=AT_ONCE)
        assert force == pytest.approx(answer.pull_off_force * problem.scales().force, rel=1e-4)


def test_the_surrogate_says_at_once_where_it_has_no_answer():
    elastic = FIRST["material"] | {"model": "elastic"}
    for gone in ("glassy_modulus", "exponent", "tau0"):
        del elastic[gone]
    rigid = FIRST | {"material": elastic}
    with pytest.raises(vt.OutOfRange, match="is 1, outside the training range of 0.0001 to 0.7"):
        predict(State(rigid).problem, budget=AT_ONCE)
    assert any("surrogate" in note for note in quick(State(rigid))["notes"])
    rubber = FIRST | {"material": EXAMPLES["A flat punch on a soft layer"]["material"]}
    for known in (FIRST, rubber):
        said = predict(State(known).problem, budget=AT_ONCE)
        assert said.pull_off_force == predict(State(known).problem).pull_off_force
        assert said.inside and said.band == "measured"


def test_the_curve_of_a_moving_edge_ends_at_the_force_that_advice_has():
    problem = State(FIRST).problem
    found = closed_forms(problem.groups())
    curve = found.curve
    (tier,) = (x for x in found.estimates if x.tier == "unloading")
    slow = float(lennard_jones.pull_off_ratio(problem.groups().tabor))
    assert slow * curve.pull_off_force == pytest.approx(tier.pull_off_force, rel=1e-12)
    assert curve.depth[0] * problem.scales().length == pytest.approx(8.12e-6, rel=0.01)
    elastic = FIRST["material"] | {"model": "elastic"}
    for gone in ("glassy_modulus", "exponent", "tau0"):
        del elastic[gone]
    groups = State(FIRST | {"material": elastic}).problem.groups()
    assert closed_forms(groups).curve is None
