"""Files and words from strangers are refused as input."""

import pytest

from viscotack import InputError, parse
from viscotack.files.text import cell


@pytest.mark.parametrize(
    "words",
    [
        "5.19 9^9^9^9 mm",
        "5 9⁻²²²² mm",
        "2 " + "m*" * 100 + "m",
    ],
)
def test_numbers_in_the_text_of_a_unit_are_no_powers(words):
    with pytest.raises(InputError, match="exponents|unknown unit"):
        parse(words, "m")


# --- archives -----------------------------------------------------------------------------------


# --- what is printed and exported ---------------------------------------------------------------


@pytest.mark.parametrize("text", ["=1+1", "+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)", "\t=1"])
def test_a_cell_is_no_formula(text):
    assert cell(text) == f"'{text}"
