"""Operations that are asked for what they must not do, and for what has no meaning."""

import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner

from viscotack.app.cli import application
from viscotack.app.engine.operating import run_operation
from viscotack.errors import InputError
from viscotack.operations.declare.state import State
from viscotack.operations.parts.examples import EXAMPLES

ROOT = Path(__file__).parents[1]
LENS = {path.name: path for path in (ROOT / "examples/from_rig").glob("lens_*_um_s.csv")}
PAD = EXAMPLES["A flat punch on a soft layer"]


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
