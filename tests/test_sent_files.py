"""Files that are sent with a request name other files: only those that were sent beside them."""

import pytest

from stated import case_text
from viscotack import InputError
from viscotack.app.engine.operating import Sent
from viscotack.operations import operation
from viscotack.operations.declare.answer import Caller
from viscotack.operations.declare.options import take

CASE = case_text('model = "prony"\nfile = "{file}"')
STUDY = """
operation = "identify rates"
files = ["{file}"]
material = "pdms-10-1"
radius = "5 mm"
"""
ASKED = {
    "simulate": ("problem", CASE),
    "predict": ("problem", CASE),
    "sweep": ("problem", CASE),
    "campaign inputs": ("problem", CASE),
    "forecast": ("study", STUDY),
    "report": ("study", STUDY),
    "theory punch": ("case", CASE),
}
# Operations that read such a file when they answer.
LATE = ("forecast", "report", "theory punch")


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "secret.csv").write_text("a secret of the server\n")
    (tmp_path / "sent").mkdir()
    return tmp_path / "sent"


def taken(word, folder, file):
    """Return an operation whose file was sent, with all that lies beside it."""
    name, text = ASKED[word]
    (folder / "asked.toml").write_text(text.format(file=file))
    cases = {"cases": [{"protocol.speed": 1e-5}]} if word == "sweep" else {}
    sent = Sent(folder, frozenset(path.name for path in folder.iterdir()))
    return take(operation(word), {name: "asked.toml", **cases}, sent)


@pytest.mark.parametrize("word", ASKED)
@pytest.mark.parametrize("beside", [True, False])
def test_what_is_sent_names_no_file_of_the_server(word, beside, folder):
    secret = folder.parent / "secret.csv"
    with pytest.raises(InputError) as error:
        taken(word, folder, "../secret.csv" if beside else secret).answer(Caller())
    assert "was sent with the request" in str(error.value)
    assert "a secret" not in str(error.value)


@pytest.mark.parametrize("word", ASKED)
def test_what_is_sent_names_files_that_were_sent_with_it(word, folder):
    (folder / "branches.csv").write_text("modulus_ratio,relaxation_time_s\n5.0,0.001\n")
    question = taken(word, folder, "branches.csv")
    if word in LATE:
        # it is read, and is no pad, or no curve of a rig
        with pytest.raises(InputError, match=r"asked.toml states a sphere|branches.csv: "):
            question.answer(Caller())
