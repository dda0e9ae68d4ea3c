"""The state of the page: the same case as tables, link, file and Python."""

import json
from urllib.parse import parse_qs

import pytest

from viscotack.app.engine.overview import quick
from viscotack.app.engine.state import State, state_of_toml
from viscotack.app.operations.parts.examples import EXAMPLES, FIRST
from viscotack.model.problem.case_file import read_case
from viscotack.prediction.closed_forms import closed_forms
from viscotack.theory import lennard_jones

examples = pytest.mark.parametrize("tables", EXAMPLES.values(), ids=EXAMPLES)


@examples
def test_link_file_and_python_state_the_same_problem(tables, tmp_path):
    state = State(tables)
    assert json.loads(parse_qs(state.query)["state"][0])["case"] == state.tables
    assert state_of_toml(state.toml).tables == state.tables
    file = tmp_path / "case.toml"
    file.write_text(state.toml)
    problem = read_case(file)
    assert state.problem == problem
    names = {}
    exec(state.python().partition("result =")[0], names)  # noqa: S102  # written by ourselves
    assert names["problem"] == problem


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
