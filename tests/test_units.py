import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from viscotack.errors import InputError
from viscotack.files.text import cell
from viscotack.units import finite, parse, positive, readable


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("5.19 mm", "m", 5.19e-3),
        ("1.55 µm", "m", 1.55e-6),
        ("152.3 mJ/m2", "J/m^2", 0.1523),
        ("0.1523 N/m", "J/m^2", 0.1523),
        ("-.5 mN", "N", -5e-4),
        ("100 um s-1", "m/s", 1e-4),
        ("20 degC", "K", 293.15),
    ],
)
def test_text_with_a_unit_becomes_si(text, unit, value):
    assert parse(text, unit) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "unit", "words"),
    [
        ("5.19", "m", "has no unit; write it behind the number, as in '1 m'"),
        ("5.19 kg", "m", "has the wrong dimension; expected a quantity in m"),
        ("5.19 mmm", "m", "unknown unit 'mmm'"),
        ("5,19 mm", "m", "write it like '5.19 mm', with a decimal point"),
        ("nan m", "m", "not a number and a unit"),
        # numbers in the text of a unit are no powers
        ("5.19 9^9^9^9 mm", "m", "exponents|unknown unit"),
        ("5 9⁻²²²² mm", "m", "exponents|unknown unit"),
        ("2 " + "m*" * 100 + "m", "m", "exponents|unknown unit"),
    ],
)
def test_a_wrong_quantity_is_refused_with_words_that_help(text, unit, words):
    with pytest.raises(InputError, match=words):
        parse(text, unit)


@given(st.integers(1, 10**15 - 1), st.integers(-12, 12))
@settings(deadline=None)
def test_a_quantity_is_the_same_number_in_every_unit(digits, power):
    # as it must be to have one name by content
    assert parse(f"{digits}e{power} ms", "s") == parse(f"{digits}e{power - 3} s", "s")


@pytest.mark.parametrize("value", [0, math.nan, math.inf, "wide"])
def test_a_positive_number_is_asked_for_by_name(value):
    with pytest.raises(ValueError, match="radius must be"):
        positive("radius", value, "m")


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (4.31e-3, "N", "4.31 mN"),
        (1.33e-6, "m/s", "1.33 um/s"),
        (0.05, "J/m^2", "50 mJ/m^2"),
        (-0.005, "m", "-5 mm"),
        # what rounds to a thousand is one of the next prefix
        (9.99996e-4, "N", "1 mN"),
        (3e-15, "N", "0.003 pN"),
        (math.nan, "N", "nan N"),
    ],
)
def test_a_quantity_for_people_has_the_prefix_of_its_size(value, unit, text):
    assert readable(value, unit) == text


def test_a_range_and_an_uncertainty_have_the_prefix_of_the_quantity():
    assert readable(8e-4, "N", to=4.31e-3) == "0.8 to 4.31 mN"
    assert readable(-5e-6, "m", to=1e-6) == "-5 to 1 um"
    assert readable(0.0, "m", to=1e-6) == "0 to 1 um"
    assert readable(1e-6, "m/s", to=3e-3) == "1 um/s to 3 mm/s"
    assert readable(4.31e-3, "N", uncertainty=2e-5) == "4.310 +- 0.020 mN"


@pytest.mark.parametrize(
    ("value", "uncertainty", "text"),
    [
        (1.234e-3, 9.96e-5, "1.23 +- 0.10 mN"),
        (4.314e-3, 0.0127e-3, "4.314 +- 0.013 mN"),
        (2e-3, 3.4e-3, "2.0 +- 3.4 mN"),
        (-1e-7, 2e-5, "0 +- 20 uN"),
    ],
)
def test_an_uncertainty_has_two_digits_and_its_value_the_same_place(value, uncertainty, text):
    assert readable(value, "N", uncertainty=uncertainty) == text


def test_an_uncertainty_below_the_last_digit_is_omitted():
    assert readable(1e-6, "m/s", uncertainty=6e-13) == "1 um/s"
    assert readable(-1.5e-3, "N", uncertainty=0.0) == "-1.5 mN"
    assert readable(1e-6, "m/s", uncertainty=2e-10) == "1.00000 +- 0.00020 um/s"
    assert readable(0.0, "N", uncertainty=1e-3) == "0.0 +- 1.0 mN"


@pytest.mark.parametrize("unit", ["N", "m/s", "J/m^2", "m/N"])
@pytest.mark.parametrize("value", [3.125e-10, 8e-5, 512.0])
def test_what_is_written_for_people_is_read_again(value, unit):
    assert parse(readable(value, unit), unit) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("text", ["\u0665 mm", "5.\u0661 mm", "1_0 mm"])
def test_other_digits_than_0_to_9_are_refused(text):
    with pytest.raises(InputError):
        parse(text, "m")
    with pytest.raises(InputError):
        parse(text.removesuffix(" mm"), "1")
    with pytest.raises(InputError, match="radius"):
        finite("radius", text.removesuffix(" mm"), "m")


def test_a_temperature_is_not_below_absolute_zero():
    assert parse("-273 degC", "K") == pytest.approx(0.15)
    with pytest.raises(InputError, match="-274 degC"):
        parse("-274 degC", "K")


@pytest.mark.parametrize("text", ["=1+1", "+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)", "\t=1"])
def test_a_cell_of_a_table_is_no_formula(text):
    assert cell(text) == f"'{text}"
