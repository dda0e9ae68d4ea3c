import numpy as np
import pytest

from viscotack.app.operations.flags import stated
from viscotack.app.operations.request import Caller
from viscotack.campaign import CaseSettings, read_plan
from viscotack.campaign.design import grid
from viscotack.model.problem.kinds import KINDS
from viscotack.model.problem.record import run_id
from viscotack.simulate import has_start

INPUTS = {"tabor": 3.24, "modulus_ratio": 0.1, "exponent": 0.8, "preload": 73.0, "rate": 316.23}
HEADER = "tabor,modulus_ratio,exponent,preload,rate\n"


def written(folder, text, name="plan.toml"):
    path = folder / name
    path.write_text(text)
    return path


def columns(cases, name):
    return np.array([case.inputs[name] for case in cases])


def sphere_fill(cases=256, **changes):
    block = {
        "tabor": "{ log = [0.01, 10] }",
        "modulus_ratio": "0.1",
        "exponent": "{ linear = [0.2, 2] }",
        "preload": "{ log = [0.1, 100] }",
        "rate": "{ log = [0.1, 1e8] }",
    } | changes
    lines = "\n".join(f"{name} = {value}" for name, value in block.items())
    return f"[[fill]]\ncases = {cases}\n{lines}\n"


def test_a_row_of_a_csv_file_is_the_problem_that_the_flags_state(tmp_path):
    path = written(tmp_path, HEADER + "3.24,0.1,0.8,73,316.23\n", "cases.csv")
    plan = read_plan(path)
    (case,) = plan.cases
    assert case.inputs == INPUTS
    assert case.name == run_id(stated("sphere", INPUTS, Caller()).problem)
    assert plan.settings == CaseSettings()


def test_a_grid_is_every_combination():
    rows = list(grid({"a": [1, 2], "b": {"log": [0.1, 10], "count": 3}, "c": 7}))
    assert rows == [{"a": a, "b": b, "c": 7.0} for a in (1.0, 2.0) for b in (0.1, 1.0, 10.0)]


def test_a_fill_covers_its_ranges_evenly_and_can_be_extended(tmp_path):
    few = read_plan(written(tmp_path, sphere_fill(128))).cases
    more = read_plan(written(tmp_path, sphere_fill(1500))).cases
    assert more[:128] == few
    for name, low, high in (("tabor", 0.01, 10), ("preload", 0.1, 100), ("rate", 0.1, 1e8)):
        places = np.log(columns(few, name) / low) / np.log(high / low)
        # A Sobol sequence of 2^7 points has one in each of 128 equal parts of every axis.
        assert np.all(np.sort(np.floor(places * 128)) == np.arange(128))


def test_a_plan_has_an_end(tmp_path):
    wide = {"log": [1, 2], "count": 4000}
    for values in ({"x": {"log": [1, 2], "count": 10**15}}, dict.fromkeys("xyz", wide)):
        with pytest.raises(ValueError, match="a plan has at most 10000000 cases, got"):
            next(grid(values))
    path = written(tmp_path, sphere_fill(10**13))
    with pytest.raises(ValueError, match=r"block 1 .*at most 10000000 cases.* got 1e\+13"):
        read_plan(path)
    assert len([*grid(dict.fromkeys("xy", {"log": [1, 2], "count": 30}))]) == 900


@pytest.mark.parametrize(
    ("start", "exists"),
    [
        ({"preload": 0.0}, True),
        ({"preload": -20.0}, False),
        ({"preload_force": -0.5}, True),
        ({"preload_force": -2.0}, False),
        ({"preload_radius": 2.0}, True),
        ({"preload_radius": 0.1}, False),
    ],
)
def test_a_relaxed_contact_is_looked_for(start, exists):
    inputs = {k: v for k, v in INPUTS.items() if k != "preload"} | start
    assert has_start(KINDS["sphere"].problem(inputs)) is exists


def test_a_case_that_is_stated_twice_is_run_once(tmp_path):
    written(tmp_path, HEADER + "1,0.1,0.8,5,10\n1,0.1,0.8,5,20\n", "cases.csv")
    block = "tabor = 1\nmodulus_ratio = 0.1\nexponent = 0.8\npreload = 5\nrate = [10, 30]\n"
    text = f'[[grid]]\n{block}[[list]]\nfile = "cases.csv"\n'
    plan = read_plan(written(tmp_path, text))
    assert columns(plan.cases, "rate").tolist() == [10, 30, 20]
    assert plan.repeated == 1


CASE = "tabor = 1\nmodulus_ratio = 0.1\nexponent = 0.8\npreload = 5\nrate = 10\n"


@pytest.mark.parametrize(
    ("name", "text", "place"),
    [
        ("p.toml", "", "nothing to run"),
        ("p.toml", f"[settings]\naccuracy = 1\n[[grid]]\n{CASE}", "accuracy"),
        ("p.toml", f"[[grid]]\n{CASE}rat = 1\n", "block 1 .*rat"),
        ("p.toml", f"[[fill]]\ncases = 3\n{CASE}", "at least one range"),
        ("p.toml", sphere_fill(3, preload="{ log = [-1, 1] }"), "preload"),
        ("p.toml", sphere_fill(3, preload="{ linear = [-90, -80] }"), "relaxed"),
        ("c.csv", "tabor,rate\n1,2\n", "columns"),
        ("c.csv", HEADER + "1,0.1,0.8,5,10\n1,0.1,0.8,deep,10\n", "line 3: .*'deep'"),
    ],
)
def test_a_wrong_plan_is_refused_with_its_place(tmp_path, name, text, place):
    path = written(tmp_path, text, name)
    with pytest.raises(ValueError, match=place) as caught:
        read_plan(path)
    assert str(caught.value).startswith(str(path))
