"""The theories as operations: refusals in each spelling, and study files in other folders."""

import pytest

from viscotack.app.operations import ask
from viscotack.errors import InputError
from viscotack.model.materials.library import passport_of
from viscotack.model.materials.passport_file import write_passport

PAD = {
    "indenter": "punch",
    "half_width": "1 mm",
    "work_of_adhesion": "50 mJ/m^2",
    "strength": "50 kPa",
}
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
    assert ask("theory punch", problem=given).record()["pull_off_stress_Pa"] > 0
    with pytest.raises(InputError, match=f"defines the whole material; leave out `{name}`$"):
        ask("theory punch", problem=given | {name: STANDARD[name]})


@pytest.mark.parametrize(
    ("word", "name", "given"),
    [
        ("material show", "passport", {}),
        ("material export", "passport", {"to": "abaqus", "bulk_modulus": "2 GPa"}),
    ],
)
def test_a_passport_is_taken_as_an_object_where_a_file_of_one_is(word, name, given, passport):
    found, file = passport
    by_file = ask(word, **given, **{name: str(file)}).record()
    assert ask(word, **given, **{name: found}).record() == by_file


def test_a_pad_is_not_stated_without_dimensions():
    with pytest.raises(InputError) as caught:
        ask("theory punch", problem={"indenter": "punch", "size": 64.85, "thickness": 3.24})
    assert caught.value.field == "size"
