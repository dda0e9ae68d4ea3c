"""The theories as operations: refusals in each spelling, and study files in other folders."""

import os

import pytest

from command_line import exit_status
from stated import case_text
from viscotack.errors import InputError
from viscotack.materials.library import passport_of
from viscotack.materials.passport_file import write_passport
from viscotack.operations import ask, operation
from viscotack.operations.declare.options import Here, take
from viscotack.operations.declare.study import read_study, study_text

FILES = {
    "branches.csv": "modulus_ratio,relaxation_time_s\n3,0.01\n6,0.001\n",
    "law.csv": "gap_nm,traction_MPa\n0.5,-3\n1,0\n1.2,5\n2,1\n10,0\n",
    "dma.csv": "frequency_Hz,storage_MPa,loss_kPa\n0.1,1.01,30\n1,1.1,200\n10,2,900\n100,4,3000\n",
    "case.toml": case_text(),
}
JKR = {"radius": "1 mm", "contact_modulus": "1 MPa", "work_of_adhesion": "50 mJ/m^2"}
SPHERE = {"indenter": "sphere", "tabor": 200.0, "preload": 10.0, "rate": 1.0}


@pytest.mark.parametrize(
    ("word", "given"),
    [
        ("theory jkr", JKR),
        ("theory maugis", {"tabor": 1}),
        ("theory persson-brener", {"material": "prony:branches.csv", "speed": [1, "2"]}),
        ("theory greenwood", {"modulus_table": "dma.csv", "rubbery_modulus": "1 MPa"}),
        (
            "theory steady-crack",
            {
                "material": "prony:branches.csv",
                "law": "gent-schultz:1,0.5:table:law.csv",
                "speed": [1, "1 um/s", "-3"],
                **JKR,
                "equilibrium_gap": "1 nm",
                "tau0": "1 ms",
            },
        ),
        ("theory crack-contact", {"problem": SPHERE | {"material": "prony:branches.csv"}}),
        ("theory crack-contact", {"problem": "case.toml"}),
        ("theory punch", {"case": "case.toml", "stress": "60 kPa", "map": True}),
    ],
)
def test_a_study_in_another_folder_gives_the_same_result(word, given, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, text in FILES.items():
        (tmp_path / name).write_text(text)
    (tmp_path / "studies").mkdir()
    kind = operation(word)
    given = {name: value for name, value in given.items() if name != "radius" or "jkr" in word}
    asked = take(kind, given, Here())
    path = tmp_path / "studies" / "study.toml"
    path.write_text(study_text(asked, path.parent))
    monkeypatch.chdir(os.sep)
    back = read_study(path, known=operation).operation
    assert study_text(back, tmp_path) == study_text(take(kind, given, Here(tmp_path)), tmp_path)


@pytest.mark.parametrize(
    ("word", "given", "words"),
    [
        ("theory jkr", JKR | {"radius": "-1 mm"}, "radius must be positive, got -1 mm"),
        ("theory maugis", {"tabor": 0}, "tabor must be positive, got 0.0"),
        ("theory maugis", {"tabor": "x"}, "tabor: 'x' is not a number; write it like '5.19'"),
        ("theory punch", {"bonded": 0.7}, "bonded must lie between 0 and 0.5, got 0.7"),
    ],
)
def test_a_number_that_is_none_or_out_of_range_is_refused_under_its_name(
    word, given, words, capsys
):
    with pytest.raises(InputError) as refused:
        ask(word, **given)
    assert str(refused.value).startswith(words)
    flags = [x for name, value in given.items() for x in (f"--{name.replace('_', '-')}", value)]
    assert exit_status([*word.split(), *flags]) == 2
    assert f"viscotack: --{words}" in capsys.readouterr().err


PAD = {"half_width": "1 mm", "work_of_adhesion": "50 mJ/m^2", "strength": "50 kPa"}
STANDARD = {"contact_modulus": "1 MPa", "modulus_ratio": 0.1, "tau0": "1 ms"}
ASKED = {"thickness": "200 um", "speed": "100 um/s"}


@pytest.fixture
def passport(tmp_path):
    """Return a passport, and the file that holds it."""
    found, file = passport_of("pdms-10-1"), tmp_path / "pdms.toml"
    write_passport(found, file)
    return found, file


@pytest.mark.parametrize("name", ["contact_modulus", "modulus_ratio", "tau0"])
def test_what_a_passport_states_is_not_stated_beside_it(name, passport):
    _, file = passport
    given = PAD | ASKED | {"material": str(file)}
    assert ask("theory punch", **given).record()["pull_off_stress_Pa"] > 0
    with pytest.raises(InputError, match=f"defines the whole material; remove {name}$"):
        ask("theory punch", **given, **{name: STANDARD[name]})


@pytest.mark.parametrize(
    ("word", "name", "given"),
    [
        ("theory punch", "material", PAD | ASKED),
        ("theory greenwood", "material", {"speed": [1.0, 10.0]}),
        ("theory steady-crack", "material", {"speed": [1.0]}),
        ("material show", "passport", {}),
        ("material convert", "source", {"temperature": "0 degC"}),
        ("material export", "passport", {"to": "abaqus", "bulk_modulus": "2 GPa"}),
    ],
)
def test_a_passport_is_taken_as_an_object_where_a_file_of_one_is(word, name, given, passport):
    found, file = passport
    by_file = ask(word, **given, **{name: str(file)}).record()
    assert ask(word, **given, **{name: found}).record() == by_file
