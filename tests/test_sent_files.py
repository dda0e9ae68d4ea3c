"""Files that are sent with a request name other files: only those that were sent beside them."""

import pytest

from stated import case_text
from viscotack import InputError
from viscotack.app.engine.lane import run_request
from viscotack.app.operations import operation
from viscotack.app.operations.request import Caller, request_of

CASE = case_text('model = "prony"\nfile = "{file}"')
STUDY = """
operation = "identify rates"
files = ["{file}"]
material = "pdms-10-1"
radius = "5 mm"
"""
ASKED = {
    "predict": ("problem", CASE),
    "campaign inputs": ("problem", CASE),
    "forecast": ("study", STUDY),
    "theory punch": ("problem", CASE),
}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "secret.csv").write_text("a secret of the server\n")
    (tmp_path / "sent").mkdir()
    return tmp_path / "sent"


def answer(word, folder, file):
    """Answer a request whose file was sent, with all that lies beside it."""
    name, text = ASKED[word]
    (folder / "asked.toml").write_text(text.format(file=file))
    asked = request_of(operation(word), {name: "asked.toml"})
    return asked.answer(Caller(folder=folder, sent=True))


@pytest.mark.parametrize("word", ASKED)
@pytest.mark.parametrize("beside", [True, False])
def test_what_is_sent_names_no_file_of_the_server(word, beside, folder):
    secret = folder.parent / "secret.csv"
    with pytest.raises(InputError) as error:
        answer(word, folder, "../secret.csv" if beside else secret)
    assert "was sent with the request" in str(error.value)
    assert "a secret" not in str(error.value)


@pytest.mark.parametrize("word", ASKED)
def test_what_is_sent_names_files_that_were_sent_with_it(word, folder):
    (folder / "branches.csv").write_text("modulus_ratio,relaxation_time_s\n5.0,0.001\n")
    if word in ("predict", "campaign inputs"):
        answer(word, folder, "branches.csv")
        return
    # it is read, and is no pad, or no curve of a rig
    with pytest.raises(InputError, match=r"needs a flat punch|branches.csv: "):
        answer(word, folder, "branches.csv")


def test_a_refusal_names_a_sent_map_of_heights_and_not_where_it_lies(folder):
    (folder / "heights.csv").write_text("1,2\n3,x\n")
    case = case_text(shape='[surface]\nfile = "heights.csv"\npixel = "1 um"')
    (folder / "asked.toml").write_text(case)
    asked = request_of(operation("rough"), {"file": "asked.toml"})
    with pytest.raises(InputError, match=r"heights\.csv") as error:
        run_request(asked, (), str(folder), tell=lambda told: None, also=())
    assert str(folder) not in str(error.value)
