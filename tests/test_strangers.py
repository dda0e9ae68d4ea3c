"""Files and words from strangers are refused as input."""

import io
import zipfile

import numpy as np
import pytest

import synthetic
from command_line import exit_status
from viscotack import InputError, load, parse, save
from viscotack.files.text import cell, harmless
from viscotack.files.toml import parse_toml


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


@pytest.mark.parametrize(
    ("words", "unit", "value"),
    [
        ("152.3 mJ/m2", "J/m^2", 0.1523),
        ("1 J/m^2", "J/m^2", 1.0),
        ("2 kg m^-1 s^-2", "Pa", 2.0),
        ("3 m²", "m^2", 3.0),
        ("4 1/s", "1/s", 4.0),
        ("4 s^-1", "1/s", 4.0),
        ("4 s⁻¹", "1/s", 4.0),
        ("5 (mm)^2", "m^2", 5e-6),
        ("6 N/(m s^2)", "N/m/s^2", 6.0),
    ],
)
def test_units_are_written_as_before(words, unit, value):
    assert parse(words, unit) == pytest.approx(value)


TOML = {
    "brackets": ("a = " + "[" * 100_000, "too many nested brackets"),
    "tables": ("a = " + "{b=" * 50_000, "too many nested brackets"),
    "digits": ("a = " + "9" * 5_000, "invalid number"),
    "long": ("a = 1 #" + "x" * 1_500_001, "more than the limit of 1,500,000"),
    "word": ("x" * 1_000_000, "not a TOML file, line 1"),
}


@pytest.mark.parametrize(("text", "words"), TOML.values(), ids=TOML)
def test_a_toml_file_that_is_deep_or_long_is_refused(text, words):
    with pytest.raises(InputError, match=words) as caught:
        parse_toml(text, "case.toml")
    assert str(caught.value).startswith("case.toml") and len(str(caught.value)) < 400


# --- archives -----------------------------------------------------------------------------------


def archive(path, **arrays):
    """Write an archive of whatever arrays; bytes are taken as they are."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        for name, array in arrays.items():
            content = io.BytesIO()
            if not isinstance(array, bytes):
                np.save(content, array)
                array = content.getvalue()
            file.writestr(f"{name}.npy", array)
    return path


def declared(shape, kind="<f8"):
    """Return an array that says what it has, and has nothing."""
    content = io.BytesIO()
    header = {"descr": kind, "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(content, header)
    return content.getvalue()


def changed(tmp_path, **arrays):
    """Return a saved result with some of its arrays replaced."""
    save(synthetic.jkr_result(), tmp_path / "good.npz")
    with np.load(tmp_path / "good.npz") as file:
        content = {name: file[name] for name in file.files} | arrays
    return archive(tmp_path / "changed.npz", **content)


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        ({"fields/gap": declared((10**12,))}, "damaged"),
        ({"malware": np.ones(3)}, r"unexpected array: \['malware'\]"),
        ({"time": np.array([{}], dtype=object)}, "damaged"),
    ],
)
def test_a_result_that_is_none_is_refused(tmp_path, arrays, words):
    with pytest.raises(InputError, match=words):
        load(changed(tmp_path, **arrays))


# --- what is printed and exported ---------------------------------------------------------------

EVIL = "\x1b]0;owned\x07\x1b[2Jno contact\u202e gpj.exe"


def test_marks_that_a_terminal_obeys_are_shown_and_not_sent(capsys):
    told = harmless(EVIL)
    assert told.isprintable() and "no contact" in told
    assert harmless("a line\n\tand µm² → ΔΓ") == "a line\n\tand µm² → ΔΓ"
    assert exit_status(["show", f"/nowhere/{EVIL}.npz"]) == 2
    err = capsys.readouterr().err
    assert "no contact" in err and "\x1b" not in err and "\x07" not in err and "\u202e" not in err


@pytest.mark.parametrize("text", ["=1+1", "+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)", "\t=1"])
def test_a_cell_is_no_formula(text):
    assert cell(text) == f"'{text}"
