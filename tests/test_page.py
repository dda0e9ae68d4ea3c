"""The page without a browser: its parts fit each other, and the fields and answers it is given."""

import re

import pytest

from viscotack.app.engine.overview import quick
from viscotack.app.engine.page_tasks import ask_verdict
from viscotack.app.engine.state import State
from viscotack.app.operations.parts.examples import EXAMPLES, FIRST
from viscotack.errors import InputError, OutOfRange
from viscotack.model.problem.case_file import case_of_tables
from viscotack.prediction import predict

examples = pytest.mark.parametrize("tables", EXAMPLES.values(), ids=EXAMPLES)


def verdict(tables):
    return ask_verdict({"tables": tables}, tell=print, also=())


@examples
def test_the_answer_of_the_page_is_that_of_predict(tables):
    problem = case_of_tables(tables)
    at_once, soon = quick(State(tables))["numbers"], verdict(tables)
    assert not at_once or at_once == soon["numbers"]  # what comes first does not change later
    try:
        found = predict(problem)
    except OutOfRange as error:
        assert soon["numbers"] == [] and soon["refused"].lower() == f"{error}.".lower()
        return
    scales = problem.scales()
    scale = scales.stress if "punch" in tables else scales.force
    number, *_ = soon["numbers"]
    assert soon["refused"] == "" and (number["method"], number["why"]) == (found.method, found.why)
    assert number["value"] == pytest.approx(found.pull_off_force * scale, rel=1e-12)
    assert number["interval"] == pytest.approx([x * scale for x in found.interval], rel=1e-12)


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
            quick(State(FIRST | {table: FIRST[table] | {key: value}}))
        where, words = named.search(str(error.value)).groups()
        assert (where, re.split(r"[ :]", words)[0]) == (table, key)
