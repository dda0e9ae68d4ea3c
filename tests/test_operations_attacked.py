"""Operations that are asked for what they must not do, and for what has no meaning."""

import os
import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner

from viscotack.app.cli import application
from viscotack.app.engine.operating import run_operation
from viscotack.errors import InputError
from viscotack.operations import operation
from viscotack.operations.declare.options import Here, take
from viscotack.operations.declare.state import State
from viscotack.operations.declare.study import read_study, study_text
from viscotack.operations.parts.examples import EXAMPLES

ROOT = Path(__file__).parents[1]
LENS = {path.name: path for path in (ROOT / "examples/from_rig").glob("lens_*_um_s.csv")}
PAD = EXAMPLES["A flat punch on a soft layer"]
RATES = {"files": sorted(LENS), "material": "pdms-10-1", "radius": "5.19 mm"}


@pytest.fixture
def sent(tmp_path):
    """Ask as a request over HTTP does, with files that were sent."""
    folder = tmp_path / "sent"
    folder.mkdir()

    def asked(word, given, files=None, outputs=()):
        for name, content in (files or {}).items():
            Path(folder, name).write_text(content)
        paths = [str(path) for path in folder.iterdir()]
        told = {"operation": word, "given": given, "files": paths, "outputs": list(outputs)}
        return run_operation(told, lambda news: None, ())

    return asked


@pytest.mark.parametrize(
    ("table", "named"),
    [
        ("material", {"passport": "../secret.toml"}),
        ("interface", {"law": "table", "file": "../secret.toml"}),
    ],
)
def test_a_case_of_a_punch_that_was_sent_reads_no_file_beside_those_sent(
    sent, tmp_path, table, named
):
    (tmp_path / "secret.toml").write_text("the first line")
    case = State(PAD | {table: named}).toml
    with pytest.raises(InputError, match="was sent with the request") as refused:
        sent("theory punch", {"case": "case.toml"}, {"case.toml": case})
    assert "first line" not in str(refused.value)


@pytest.mark.parametrize("word", ["forecast", "report"])
def test_a_study_that_forecasts_from_itself_is_refused(sent, word):
    study = f'operation = "{word}"\nstudy = "study.toml"\n'
    with pytest.raises(InputError, match="a forecast needs a study of identify rates"):
        sent(word, {"study": "study.toml"}, {"study.toml": study})


def test_a_study_that_was_asked_for_over_http_names_files_as_they_were_sent(sent):
    files = {name: path.read_text() for name, path in LENS.items()}
    study = sent("identify rates", RATES, files, ["output"])["beside"]["files"]["output"]
    assert 'files = ["lens_1000_um_s.csv", "lens_1_um_s.csv", "lens_30_um_s.csv"]' in study


@pytest.mark.parametrize("sign", [{"a": 1}, [["+"]], ["+"], True, 0, "plus"])
def test_a_sign_that_is_none_is_refused(sign):
    with pytest.raises(InputError, match=r"--into must be \+ or -"):
        take(operation("identify rates"), RATES | {"into": sign}, Here())


@pytest.mark.parametrize("number", [2.9999999, 1.5, 123456.7, float("inf"), float("nan"), True])
def test_a_fraction_is_no_whole_number(number):
    with pytest.raises(InputError, match="expected a whole number"):
        take(operation("identify slow"), RATES | {"material": None, "cycle": number}, Here())


@pytest.mark.parametrize("number", [1e6, 1_000_000, "1000000"])
def test_a_whole_number_may_be_a_large_float(number):
    given = {"files": ["a.csv"], "radius": "1 mm", "cycle": number}
    assert take(operation("identify slow"), given, Here()).cycle == 1_000_000


@pytest.mark.parametrize(
    "more",
    [
        {"work_of_adhesion": [0.1, 0.01, 5]},
        {"work_of_adhesion": [0.1, 0.01], "work_of_adhesion_uncertainty": 0.02},
        {"work_of_adhesion": 0.1, "work_of_adhesion_uncertainty": [0.1, 0.02]},
    ],
)
def test_a_known_number_has_one_uncertainty(more):
    with pytest.raises(InputError, match="a list has the value and its uncertainty"):
        take(operation("identify rates"), RATES | more, Here())


def test_a_range_of_speeds_may_be_wider_than_a_float_is():
    given = {"study": "study.toml", "speed": "1e-300 m/s..1e300 m/s"}
    (speeds,) = take(operation("forecast"), given, Here()).wish.speed
    assert len(speeds) == 50


LAB = 'operation = "test read"\nfiles = ["../lens_1_um_s.csv"]\n'


@pytest.fixture
def lab(tmp_path):
    """A folder with measured curves and a case, and one beside them with studies."""
    for path in (LENS["lens_1_um_s.csv"], ROOT / "examples/from_toml/lens.toml"):
        shutil.copy(path, tmp_path)
    (tmp_path / "studies").mkdir()
    return tmp_path


def study(lab, text):
    """Return status and words of a study in the folder of studies."""
    file = lab / "studies/study.toml"
    file.write_text(text)
    done = CliRunner().invoke(application(), ["study", str(file)])
    return done.exit_code, done.output


@pytest.mark.parametrize(
    ("text", "name"),
    [
        (f'{LAB}[write]\ncsv = "../lens_1_um_s.csv"\n', "lens_1_um_s.csv"),
        (f'{LAB}[write]\ncsv = "study.toml"\n', "studies/study.toml"),
        (
            'operation = "simulate"\nproblem = "../lens.toml"\naccuracy = 0.02\n'
            'until = "pull-off"\n[write]\ncsv = "../lens.toml"\n',
            "lens.toml",
        ),
    ],
)
def test_a_study_never_writes_over_what_it_reads(lab, text, name):
    status, _ = study(lab, text)
    assert status == 2
    assert not (lab / name).read_text().startswith(("file,", "time,"))


LONG = "[material]\nmodel = 'prony'\n" + "# a branch\n" * 100


@pytest.mark.parametrize("material", [LONG, "none.toml", "C:\\x.toml", "a 'b' \"c\".toml"])
def test_a_study_in_another_folder_has_the_same_material(material, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "studies").mkdir()
    rates = take(operation("identify rates"), RATES | {"material": material}, Here())
    text = study_text(rates, "studies")
    Path("studies/study.toml").write_text(text)
    again = read_study("studies/study.toml", known=operation).operation
    assert study_text(again, "studies") == text
    assert os.path.normpath(again.material) == os.path.normpath(material)


@pytest.mark.parametrize("tables", list(EXAMPLES.values()), ids=list(EXAMPLES))
def test_a_problem_of_tables_is_written_as_a_study(tables, tmp_path):
    simulate = take(operation("simulate"), {"problem": tables}, Here())
    (tmp_path / "study.toml").write_text(study_text(simulate, tmp_path))
    again = read_study(tmp_path / "study.toml", known=operation).operation
    assert again.problem.problem == simulate.problem.problem
    assert study_text(again, tmp_path) == study_text(simulate, tmp_path)
