"""Operations that are asked for what they must not do, and for what has no meaning."""

from pathlib import Path

import pytest

from viscotack.app.engine.operating import run_operation
from viscotack.errors import InputError
from viscotack.operations import ask, operation
from viscotack.operations.declare.options import Here, take
from viscotack.operations.declare.state import State
from viscotack.operations.parts.examples import EXAMPLES

ROOT = Path(__file__).parents[1]
LENS = {path.name: path for path in (ROOT / "examples/from_rig").glob("lens_*_um_s.csv")}
PAD = EXAMPLES["A flat punch on a soft layer"]
RATES = {"files": sorted(LENS), "material": "pdms-10-1", "radius": "5.19 mm"}
SPHERE = {
    "indenter": "sphere",
    "tabor": 3.24,
    "modulus_ratio": 0.1,
    "exponent": 0.8,
    "preload": 73.0,
    "rate": 316.23,
}


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
    with pytest.raises(InputError, match="a forecast starts from a study of identify rates"):
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


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"move": 5}, "dwell"),
        ({"move": [{"a": 1}]}, "--move must be words"),
        ({"rate": True}, "--rate must be a number"),
        ({"tabor": [3.24]}, "--tabor must be a number"),
        ({"tabor": {"a": 1}}, "--tabor must be a number"),
        ({"temperature": {"a": 1}}, "--temperature must be words"),
    ],
)
def test_an_answer_of_another_kind_than_its_question_is_refused(more, words):
    with pytest.raises(InputError, match=words.replace("--", "(--)?")):
        ask("advise", problem=SPHERE | more)


def test_a_single_move_needs_no_list():
    one, several = (
        take(operation("advise"), {"problem": SPHERE | {"move": move}}, Here()).problem.problem
        for move in ("dwell 1", ["dwell 1"])
    )
    assert one == several
