import numpy as np
import pytest

import stated
import viscotack as vt
from viscotack.app.operations.options import Contact
from viscotack.app.operations.request import Caller
from viscotack.app.operations.statement import statement
from viscotack.campaign import CaseSettings, read_plan, space_filling
from viscotack.campaign.plan import grid
from viscotack.model.problem.rows import KINDS
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
    stated_by_flags = statement({"indenter": "sphere", **INPUTS}, Contact(""), Caller())
    assert case.name == vt.run_id(stated_by_flags.problem)
    assert plan.settings == CaseSettings()


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
    rows = list(grid({"a": [1, 2], "b": {"log": [0.1, 10], "count": 3}, "c": 7}))
    assert rows == [{"a": a, "b": b, "c": 7.0} for a in (1.0, 2.0) for b in (0.1, 1.0, 10.0)]


@pytest.mark.parametrize(
    ("start", "exists"), [({"preload": -20.0}, False), ({"preload_radius": 2.0}, True)]
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


RUBBER = vt.StandardSolid(rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.1, poisson_ratio=0.4)
LAW = vt.LennardJones(work_of_adhesion=0.15, equilibrium_gap=1.5e-6)
PAD = vt.Problem(
    material=RUBBER,
    traction=LAW,
    geometry=vt.FlatPunch(half_width=1e-3),
    body=vt.Layer(thickness=5e-5, base=vt.Bonded(poisson_ratio=0.4)),
    protocol=vt.Retraction(start=vt.AtForce(2e3), speed=1e-4),
)
OVER_PAD = {
    "punch.half_width": {"log": ["0.1 mm", "10 mm"]},
    "layer.thickness": {"log": ["10 um", 1e-4]},
    "material.poisson_ratio": {"linear": [0.2, 0.49]},
    "protocol.preload_stress": {"linear": ["1 kPa", "3 kPa"]},
}


def problems(plan):
    return [plan.kind.problem(case.inputs) for case in plan.cases]


def shares(values, low, high):
    """Return in which of so many parts of a logarithmic range each value lies, in order."""
    places = np.log(np.array(values) / low) / np.log(high / low)
    return np.sort(np.floor(places * len(values))).tolist()


def test_a_fill_over_a_punch_and_its_layer_has_units_and_covers_them_evenly():
    plan = space_filling(PAD, OVER_PAD, cases=32)
    found = problems(plan)
    assert shares([p.geometry.half_width for p in found], 1e-4, 1e-2) == list(range(32))
    assert shares([p.body.thickness for p in found], 1e-5, 1e-4) == list(range(32))
    stresses = [p.protocol.start.force for p in found]
    assert 1e3 <= min(stresses) < 1.1e3 and 2.9e3 < max(stresses) <= 3e3
    # a bonded layer is of one piece with its material
    assert {p.body.base.poisson_ratio == p.material.poisson_ratio for p in found} == {True}
    assert len({p.material.poisson_ratio for p in found}) == 32


def test_a_file_and_python_state_the_same_cases(tmp_path):
    (tmp_path / "pad.toml").write_text(stated.PAD)
    lines = [f"{path} = {str(given).replace(':', ' =')}" for path, given in OVER_PAD.items()]
    text = "\n".join(lines).replace("'log'", "log").replace("'linear'", "linear")
    text = f'problem = "pad.toml"\n[[fill]]\ncases = 20\n{text}\n'
    (tmp_path / "plan.toml").write_text(text)
    assert vt.read_case(tmp_path / "pad.toml") == PAD
    ours = space_filling(PAD, OVER_PAD, cases=20)
    assert read_plan(tmp_path / "plan.toml").cases == ours.cases and len(ours.cases) == 20
    assert ours.base == read_plan(tmp_path / "plan.toml").base


def test_a_list_is_a_table_of_the_problem(tmp_path):
    """Headings and cells are those of a sweep, from a file as a spreadsheet writes it."""
    (tmp_path / "pad.toml").write_text(stated.PAD)
    path = written(tmp_path, 'problem = "pad.toml"\n[[list]]\nfile = "a list.csv"\n')
    text = "half_width [mm];Thickness;protocol.speed\n1,5;50 um;1e-4\n;;\n2;0.1 mm;2e-4\n"
    (tmp_path / "a list.csv").write_text(text, encoding="utf-8-sig")
    names = ("punch.half_width", "layer.thickness", "protocol.speed")
    rows = [
        dict(zip(names, row, strict=True)) for row in [(1.5e-3, 5e-5, 1e-4), (2e-3, 1e-4, 2e-4)]
    ]
    assert [case.inputs for case in read_plan(path).cases] == rows
    for heading, cell, field in (
        ("half_width [mm];speed;speed", "1;2;3", "'speed'"),
        ("half_width [mN];speed [um/s]", "1;2", r"half_width \[mN\]"),
        ("half_width [mm];speed [um/s]", "1;nan", "line 2: speed"),
    ):
        (tmp_path / "a list.csv").write_text(f"{heading}\n{cell}\n")
        with pytest.raises(ValueError, match=field):
            read_plan(path)
