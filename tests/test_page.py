"""The page without a browser: the fields and answers that it is given."""

import re

import pytest

from viscotack.app.engine.page import CaseFile, Quick, Theory, Verdict
from viscotack.app.operations.parts.solid import EXAMPLES, FIRST
from viscotack.app.operations.request import Caller
from viscotack.errors import InputError, OutOfRange
from viscotack.files.toml import toml_value
from viscotack.model.problem.case_file import case_of_tables
from viscotack.prediction.closed_forms import closed_forms
from viscotack.prediction.predict import predict
from viscotack.theory import lennard_jones

examples = pytest.mark.parametrize("tables", EXAMPLES.values(), ids=EXAMPLES)
PUNCH = EXAMPLES["A flat punch on a soft layer"]


def told(kind, tables):
    return kind(problem=tables).answer(Caller(sent=True)).record()


@examples
def test_the_answer_of_the_page_is_that_of_predict(tables):
    problem = case_of_tables(tables)
    at_once, soon = told(Quick, tables)["numbers"], told(Verdict, tables)
    assert not at_once or at_once == soon["numbers"]  # what comes first does not change later
    try:
        found = predict(problem)
    except OutOfRange as error:
        assert soon["numbers"] == [] and str(error).startswith(soon["refused"])
        return
    scales = problem.scales()
    scale = scales.stress if "punch" in tables else scales.force
    number, *_ = soon["numbers"]
    assert soon["refused"] == "" and (number["method"], number["why"]) == (found.method, found.why)
    assert number["value"] == pytest.approx(found.pull_off_force * scale, rel=1e-12)
    assert number["interval"] == pytest.approx([x * scale for x in found.interval], rel=1e-12)


@pytest.mark.parametrize("tables", [FIRST, PUNCH], ids=["sphere", "punch"])
def test_the_force_by_speed_has_that_of_the_case_in_its_middle(tables):
    speeds, (number, *_) = told(Theory, tables)["speeds"], told(Quick, tables)["numbers"]
    middle = speeds["speed"].index(pytest.approx(speeds["here"], rel=1e-6))
    row = [speeds[name][middle] for name in ("force", "low", "high")]
    assert row == pytest.approx([number["value"], *number["interval"]], rel=1e-6)
    assert speeds["force"][0] < row[0] < speeds["force"][-1]


def test_a_case_file_becomes_the_tables_of_the_page():
    cone = EXAMPLES["A shallow cone on silicone rubber"]
    moves = [{"approach": "10 um/s", "to_force": "1 mN"}, "dwell 1 s"]
    said = cone | {"protocol": cone["protocol"] | {"moves": moves}}
    lines = (f"{n}.{k} = {toml_value(y)}\n" for n, x in said.items() for k, y in x.items())
    found = CaseFile(toml="".join(lines)).answer(Caller(sent=True)).record()["tables"]
    assert found == said


def test_a_refusal_names_the_field_that_it_belongs_to():
    named = re.compile(r"\[([\w-]+)\] (.*)")
    for table, key, value in (
        ("sphere", "radius", "-5 mm"),
        ("sphere", "radius", "5 kg"),
        ("sphere", "radius", "5"),
        ("material", "poisson_ratio", 0.7),
        ("material", "glassy_modulus", "1 Pa"),
        ("interface", "equilibrium_gap", "1 km"),
        ("protocol", "speed", "fast"),
        ("protocol", "preload_force", "3 m"),
    ):
        with pytest.raises(InputError) as error:
            told(Quick, FIRST | {table: FIRST[table] | {key: value}})
        where, words = named.search(str(error.value)).groups()
        assert (where, re.split(r"[ :]", words)[0]) == (table, key)


@pytest.mark.parametrize(("work", "is_crack"), [(0.15, False), (0.01, True)])
def test_an_elastic_pad_comes_off_as_a_crack_or_at_its_strength(work, is_crack):
    strength = case_of_tables(PUNCH).traction.strength
    law = {
        "law": "lennard-jones",
        "work_of_adhesion": f"{work} J/m^2",
        "strength": f"{strength!r} Pa",
    }
    tables = PUNCH | {"interface": law}
    problem, elastic = case_of_tables(tables), told(Quick, tables)["curves"]["elastic"]
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
    problem = case_of_tables(FIRST)
    found = closed_forms(problem.groups())
    curve = found.curve
    (tier,) = (x for x in found.estimates if x.tier == "unloading")
    slow = float(lennard_jones.pull_off_ratio(problem.groups().tabor))
    assert slow * curve.pull_off_force == pytest.approx(tier.pull_off_force, rel=1e-12)
    assert curve.depth[0] * problem.scales().length == pytest.approx(8.12e-6, rel=0.01)
    elastic = FIRST["material"] | {"model": "elastic"}
    for gone in ("glassy_modulus", "exponent", "tau0"):
        del elastic[gone]
    assert closed_forms(case_of_tables(FIRST | {"material": elastic}).groups()).curve is None
