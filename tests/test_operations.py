"""Operations: declared once, and answered alike by every door."""

import contextlib
import json
import os
import re
import shlex
import shutil
from pathlib import Path

import numpy as np
import pytest

import tack_files
from front_ends import (
    OF_THE_SHELL,
    Client,
    Question,
    by_command,
    by_python,
    by_study,
    run,
    served,
    through_all,
)
from solids import standard_solid
from stated import PUNCH, SPHERE
from viscotack.app.api import application
from viscotack.app.engine.jobs import Engine
from viscotack.app.operations import ask, operation, operations
from viscotack.app.operations.flags import FLAGS
from viscotack.app.operations.options import Contact
from viscotack.app.operations.request import Caller, request_of
from viscotack.app.operations.statement import statement
from viscotack.app.operations.study import read_study, study_text
from viscotack.errors import InputError
from viscotack.model.materials import Passport, write_passport

ROOT = Path(__file__).parents[1]
FILES = [
    *(ROOT / "examples").glob("from_*/*.csv"),
    *(ROOT / "examples").glob("from_toml/*.toml"),
    *(ROOT / "examples").glob("window/*.toml"),
    *(ROOT / "examples").glob("array/*.toml"),
    *(ROOT / "examples").glob("rough/*.toml"),
    *(ROOT / "examples").glob("design/*.toml"),
    ROOT / "examples/own/plan.toml",
]
LENS = ["lens_1_um_s.csv", "lens_30_um_s.csv", "lens_1000_um_s.csv"]
SWEEP = {"cases": [{"protocol.speed": 1e-4}], "problem": "lens.toml", "accuracy": 0.02}
RATES = {"files": LENS, "material": "pdms-10-1", "radius": "5.19 mm"}
RUBBER = standard_solid(1.458e6, 4.374e6, 1e-3, 0.5)
# Any option of a fit, to sweeps that do not state their units.
FIT = {
    "files": ["sweeps.csv"],
    "poisson_ratio": 0.45,
    "model": "sls",
    "rubbery_modulus": "1 MPa",
    "loss": False,
    "level": 0.8,
    "name": "a rubber",
    "source": "nobody",
    "kind": "E",
    "temperature_unit": "degC",
    "modulus_unit": "MPa",
    "reference_temperature": "-30 degC",
    "shift_by": "storage",
    "vertical": "6e-4 1/K",
    "leave_out": ["-20 degC"],
}
JKR = {"radius": "1 mm", "contact_modulus": "1 MPa", "work_of_adhesion": "50 mJ/m^2"}
CRACK = {"modulus_ratio": 0.1, "exponent": 0.6, "speed": [1.0, 10.0]}
# Examples that are smaller here, by their lines.
SMALLER = {
    "kinetic_stamp.toml": {
        "speeds": '["1 um/s", "10 um/s"]',
        "preloads": '["1 mN"]',
        "stiffness": "",
    },
    "lift_and_let_go.toml": {
        "preload": '"10 mN"',
        "hold_speed": '"1 mm/s"',
        "release_speed": '"1 um/s"',
        "pads": "12",
    },
}
# Questions of each operation.
ASKED = {
    "advise": [{"problem": SPHERE}, {"problem": "lens.toml"}],
    "campaign inputs": [{"problem": "lens.toml"}],
    "campaign plan": [{"plan": "plan.toml"}],
    "identify slow": [{"files": ["lens_slow.csv"], "radius": "5.19 mm", "model": ["jkr"]}],
    "material convert": [{"source": "pdms-10-1", "temperature": "0 degC"}],
    "material export": [{"passport": "pdms-10-1", "to": "abaqus", "bulk_modulus": "2 GPa"}],
    "material list": [{}],
    "material show": [{"passport": "pdms-10-1"}],
    "predict": [{"problem": SPHERE}, {"problem": PUNCH}, {"problem": "lens.toml"}],
    "schema": [{}],
    "test read": [{"files": ["lens_1_um_s.csv"]}, {"files": LENS}],
    "theory crack-contact": [{"problem": SPHERE | {"tabor": 1e4, "preload": 2e5, "rate": 1e3}}],
    "theory greenwood": [CRACK],
    "theory disc": [JKR | {"strength": "50 kPa"}, JKR | {"thickness": "60 um", "bonded": 0.49}],
    "theory jkr": [JKR],
    "theory maugis": [JKR | {"strength": "0.1 MPa"}],
    "theory persson-brener": [CRACK],
    "theory punch": [{"problem": "pad.toml", "stress": "60 kPa"}],
    "theory steady-crack": [CRACK | {"law": "exponential:0.25"}],
}
# The same of those that take seconds.
NOT_DRAWN = {
    "identify rates": RATES | {"material": "rubber.toml"},
    "material fit": FIT,
    "simulate": {"problem": SPHERE | {"preload": 1.0}, "accuracy": 0.02, "until": "pull-off"},
    "sweep": SWEEP,
    "array": {"file": "wafer_pad.toml", "accuracy": 0.01},
    "control": {"problem": "lens.toml", "slowest": "100 um/s", "fastest": "150 um/s"},
    "design": {"file": "lift_and_let_go.toml", "confirm": 0},
    "identify curves": {"files": LENS, "radius": "5.19 mm"},
    "identify edge": {
        "files": [*LENS, "lens_slow.csv"],
        "radius": "5.19 mm",
        "contact_modulus": "2 MPa",
    },
    "export contact": {"problem": "glass_lens.toml"},
    "rough": {"file": "bumps.toml", "accuracy": 0.02},
    "uncertainty": {"problem": "lens.toml", "scatter": ["sphere.radius 2 %"], "samples": 16},
    "window": {"file": "kinetic_stamp.toml"},
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Work in a folder with the files of the examples."""
    for file in FILES:
        shutil.copy(file, tmp_path)
    for name, changes in SMALLER.items():
        text = (tmp_path / name).read_text()
        for key, value in changes.items():
            text = re.sub(rf"(?m)^{key} = .*$", value and f"{key} = {value}", text)
        (tmp_path / name).write_text(text)
    write_passport(Passport(name="rubber", material=RUBBER), tmp_path / "rubber.toml")
    rows = ["f,T,storage modulus,loss modulus", "Hz,,,"]
    for celsius, slower in ((-40, 10.0), (-30, 1.0), (-20, 0.16)):
        for hertz in np.geomspace(0.05, 50, 8):
            # around the relaxation of the rubber, which is at 300 Hz
            E = RUBBER.complex_modulus(2 * np.pi * 300 * slower * hertz) / 1e6
            rows.append(f"{hertz:.8g},{celsius},{E.real:.8g},{E.imag:.8g}")
    (tmp_path / "sweeps.csv").write_text("\n".join(rows) + "\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(scope="module")
def http():
    with served(Client(application(Engine()))) as client:
        yield client


def agree(question, found):
    """Compare what doors tell: records to the last digit, refusals to the letter."""
    first = found["Python"]
    for door, other in found.items():
        if other.refused.strip() and any(words in other.refused for words in OF_THE_SHELL):
            assert first.refused, f"{door} refuses {question}: {other.refused}"
            continue
        if "was sent with the request" in other.refused:
            # a file that is not there: HTTP looks for it among those that were sent, and at once
            assert first.refused, f"{door} refuses {question}: {other.refused}"
            continue
        assert other.record == first.record, f"{door}: {question}: {other} and {first}"
        assert other.refused == first.refused, f"{door}: {question}: {other} and {first}"
        if door == "HTTP":
            assert other.field == first.field, f"{question}: {other}"


@pytest.mark.parametrize("word", list(ASKED))
def test_all_doors_answer_alike(word, folder, http):
    for given in ASKED[word]:
        question = Question(word, given)
        found = through_all(question, http)
        # the plan names Python files, which nobody permitted to execute
        assert bool(found["Python"].refused) is (word == "campaign plan")
        agree(question, found)


@pytest.mark.parametrize(
    ("word", "wrong"),
    [
        ("theory jkr", {"radius": "-1 mm"}),
        ("theory jkr", {"radius": "5 kg"}),
        ("theory jkr", {"radious": "1"}),
        ("theory steady-crack", {"exponent": "foo"}),
        ("predict", {"problem": SPHERE | {"tabor": -1.0}}),
        ("predict", {"problem": "nothing.toml"}),
        ("test read", {"files": ["nothing.csv"]}),
        ("material show", {"passport": "../../etc/passwd"}),
        # its approach has no jump-in
        (
            "identify approach",
            {"files": ["lens_slow.csv"], "radius": "5.19 mm", "contact_modulus": "1.9 MPa"},
        ),
    ],
)
def test_all_doors_refuse_alike(word, wrong, folder, http):
    question = Question(word, ASKED.get(word, [{}])[0] | wrong)
    found = through_all(question, http)
    assert found["Python"].refused
    agree(question, found)


@pytest.mark.parametrize(
    "word",
    [
        pytest.param(word, marks=[pytest.mark.slow] * (word not in ("simulate", "material fit")))
        for word in NOT_DRAWN
    ],
)
def test_all_doors_answer_what_takes_seconds_alike(word, folder, http):
    question = Question(word, NOT_DRAWN[word])
    found = through_all(question, http)
    assert not found["Python"].refused
    agree(question, found)


@pytest.mark.parametrize("page", ["operations.md", "api.md"])
def test_requests_of_the_pages_are_answered(page, folder, http):
    shutil.copytree(ROOT / "examples", folder / "examples")
    (case,) = re.findall(r"```json\n(.*?)```", (ROOT / "docs/api.md").read_text("utf-8"), re.S)
    (folder / "case.json").write_text(case)
    text = (ROOT / "docs" / page).read_text("utf-8")
    lines = [x for x in re.findall(r"^\$ curl (.*)$", text, re.M) if "/jobs/" not in x]
    assert len(lines) > 2
    id = ""
    for line in lines:
        words = shlex.split(line)
        (url,) = (word for word in words if word.startswith("localhost"))
        path = url.removeprefix("localhost:8642").replace("files=ID", f"files={id}")
        if "-F" in words:
            id = http.send([words[words.index("-F") + 1].removeprefix("files=@")])["files"]
            continue
        body = words[words.index("-d") + 1]
        body = Path(body[1:]).read_text("utf-8") if body.startswith("@") else body
        response = http("POST", path, json=json.loads(body))
        assert response.status_code == 200, response.text


def test_python_has_the_outputs_of_an_answer_as_columns_figures_and_files(tmp_path):
    answer = ask("identify curves", files=[ROOT / "examples/from_rig" / LENS[0]], radius="5.19 mm")
    rows = answer.record()["curves"]
    assert answer.columns()["work_of_adhesion_J_m2"] == [x["work_of_adhesion_J_m2"] for x in rows]
    assert len(answer.plot().axes) > 0
    answer.write("plot", tmp_path / "curves.svg")
    assert (tmp_path / "curves.svg").read_text().startswith("<?xml")
    for output in (answer.columns, answer.plot):
        with pytest.raises(InputError):
            output("film")


def test_the_stiffness_that_a_file_names_is_taken_by_every_door(folder, monkeypatch):
    def stiffness_of(tests, *, stiffness, **options):
        raise InputError(f"a rig of {stiffness:g} N/m")

    monkeypatch.setattr("viscotack.identify.rate_series.RateSeries", stiffness_of)
    (folder / "curve.jpk-force").write_bytes(tack_files.BINARIES["curve.jpk-force"].read_bytes())
    question = Question("identify rates", RATES | {"files": ["curve.jpk-force"]})
    found = {
        "Python": by_python(question),
        "line": by_command(question),
        "study": by_study(question),
    }
    agree(question, found)
    assert found["Python"].refused == f"a rig of {tack_files.STIFFNESS:g} N/m"


def test_a_request_is_written_as_a_study_and_read_again(folder):
    given = RATES | {"temperature": "20 degC", "scatter": "3 %", "title": "one", "curves": True}
    asked = request_of(operation("identify rates"), given)
    (folder / "sub").mkdir()
    study = folder / "sub/asked.toml"
    study.write_text(study_text(asked, Path("sub")))
    again = read_study(study).request
    names = [os.path.normpath(Path("sub", each)) for each in again.files]
    assert names == LENS
    assert again.model_copy(update={"files": asked.files}) == asked


@pytest.mark.parametrize(
    ("asked", "output", "target"),
    [
        ('operation = "test read"\nfiles = ["lens_1_um_s.csv"]', "csv", "./lens_1_um_s.csv"),
        ('operation = "material convert"\nsource = "rubber.toml"', "output", "rubber.toml"),
        ('operation = "material convert"\nsource = "rubber.toml"', "output", "asked.toml"),
    ],
)
def test_force_replaces_files_but_none_that_was_read(asked, output, target, folder):
    study, written = folder / "asked.toml", folder / f"other{Path(target).suffix}"
    written.write_text("before")
    study.write_text(f'{asked}\n[write]\n{output} = "{written.name}"\n')
    assert run(["study", study])[0] == 2 and written.read_text() == "before"
    assert run(["study", study, "--force"])[0] == 0 and written.read_text() != "before"
    study.write_text(f'{asked}\n[write]\n{output} = "{target}"\n')
    before = (folder / target).read_bytes()
    status, _, said = run(["study", study, "--force"])
    assert status == 2 and "is an input" in said and (folder / target).read_bytes() == before


GARBAGE = [{}, {"a": 1}, True, "x", -1, 1e308, float("nan"), "1e400", b"x", object(), [None], "\0"]


@pytest.mark.parametrize("word", operations())
def test_an_option_of_a_wrong_kind_is_refused_and_nothing_else(word):
    kind = operation(word)
    for name in kind.model_fields:
        for value in GARBAGE:
            with contextlib.suppress(InputError):
                request_of(kind, {name: value})


@pytest.mark.parametrize("name", list(FLAGS))
def test_a_flag_of_a_wrong_kind_is_refused_and_nothing_else(name):
    for value in GARBAGE:
        with contextlib.suppress(InputError, OSError):
            statement({**SPHERE, name: value}, Contact(""), Caller())


def test_a_measured_profile_has_no_exponent(tmp_path):
    file = tmp_path / "profile.csv"
    file.write_text("radius_1,height_1\n0,0\n1,0.05\n2,0.2\n3,0.45\n")
    given = {**SPHERE, "indenter": "profile", "points": str(file)}
    option = Contact("", indenters=("profile",))
    assert statement(given, option, Caller()).problem is not None
    with pytest.raises(InputError) as refused:
        statement({**given, "profile_exponent": 2.0}, option, Caller())
    assert refused.value.field == "profile_exponent"


def test_an_unknown_law_is_refused_as_the_law():
    with pytest.raises(InputError) as refused:
        statement({**SPHERE, "law": "nolaw"}, Contact(""), Caller())
    assert refused.value.field == "law"
