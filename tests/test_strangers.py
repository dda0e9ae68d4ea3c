"""Files and words from strangers are refused as input."""

import io
import zipfile

import numpy as np
import pytest

import synthetic
from command_line import exit_status
from viscotack import InputError, load, parse, save
from viscotack.files.text import cell, harmless


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
