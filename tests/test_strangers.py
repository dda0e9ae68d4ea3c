"""Files and words from strangers are refused as input."""

import io
import json
import zipfile
import zlib

import numpy as np
import pytest

import synthetic
from command_line import exit_status
from viscotack import InputError, load, parse, save
from viscotack.campaign import read_plan
from viscotack.campaign.exporting import export
from viscotack.campaign.parts import table_of
from viscotack.files.text import cell, harmless, read_rows
from viscotack.files.toml import parse_toml
from viscotack.surrogate import store
from viscotack.surrogate.store import load as load_surrogate


@pytest.mark.parametrize(
    "words",
    [
        "5.19 9^9^9^9 mm",
        "5 9**9**9 mm",
        "1 mm2^9^9^9^9",
        "5 9²²²²²²²²² mm",
        "5 9⁻²²²² mm",
        "1 9 ^ 9 ^ 9 mm",
        "2 " + "m*" * 100 + "m",
        "1 mm" + "9" * 1000,
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


def test_a_unit_that_would_never_end_is_refused_wherever_it_is_read(tmp_path):
    plan = tmp_path / "plan.toml"
    plan.write_text('[settings]\ntime_limit = "5 9^9^9^9 s"\n[[grid]]\ntabor = 1\n')
    with pytest.raises(InputError, match="time_limit: .*exponents in a unit must be plain numbers"):
        read_plan(plan)


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


def test_a_cell_as_long_as_a_book_is_refused(tmp_path):
    path = tmp_path / "cases.csv"
    path.write_text(f'tabor,rate\n"{"1" * 200_000}",2\n')
    with pytest.raises(InputError, match=r"cases.csv, line 2: field larger than field limit"):
        list(read_rows(path))
    header = "tabor,modulus_ratio,exponent,preload,rate\n"
    path.write_text(f'{header}1,0.1,0.8,5,10\n"{"1" * 200_000}",2,1,1,1\n')
    with pytest.raises(InputError, match=r"cases.csv, line 3: field larger than field limit"):
        read_plan(path)


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
        ({"fields/": np.ones(3)}, "unexpected array"),
        ({"time": b"no array"}, "damaged"),
        ({"header": np.array("[" * 100_000)}, "damaged"),
        ({"header": np.array('{"format": 1}')}, "not that of a viscotack result"),
        ({"time": np.array([{}], dtype=object)}, "damaged"),
    ],
)
def test_a_result_that_is_none_is_refused(tmp_path, arrays, words):
    with pytest.raises(InputError, match=words):
        load(changed(tmp_path, **arrays))


def surrogate_with(tmp_path, **arrays):
    """Return the shipped surrogate with some of its arrays replaced, and the right checksum."""
    with np.load(store.SHIPPED) as file:
        content = {name: file[name] for name in file.files} | arrays
    words = json.loads(content.pop("words.json").tobytes())
    content = {name: array for name, array in content.items() if array is not None}
    words["sha256"] = store.checksum(content)
    content["words.json"] = np.frombuffer(json.dumps(words).encode(), dtype=np.uint8)
    return archive(tmp_path / "surrogate.npz", **content)


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        ({"force.weight.0": np.full((3, 5, 72), np.nan)}, "must be finite"),
        ({"force.weight.0": np.ones((3, 6, 72))}, r"layer 0 of force must have .*\(3, 5, 72\)"),
        ({"force.bias.0": np.ones((3, 1, 73))}, "layer 0 of force"),
        ({"work.centre": np.ones(7)}, r"work.centre must have the shape \(1,\)"),
        ({"trust.levels": np.ones((3, 6))}, r"trust.levels must have the shape \(4, 7\)"),
        ({"trust.levels": None}, "not the file of a surrogate"),
        ({"fast.bias.0": None}, "not the file of a surrogate"),
        ({"give.spread": None}, "give has only a centre"),
        ({"give.spread": np.ones(1, dtype=int)}, "give.spread must be finite numbers"),
    ],
)
def test_a_surrogate_that_does_not_fit_together_is_refused(tmp_path, arrays, words):
    with pytest.raises(InputError, match=words):
        load_surrogate(surrogate_with(tmp_path, **arrays))


def test_a_surrogate_with_the_arrays_that_are_shipped_is_read(tmp_path):
    assert load_surrogate(surrogate_with(tmp_path)).limits["tabor"] == (0.01, 10.0)


def test_a_damaged_stream_is_no_defect(tmp_path):
    path = changed(tmp_path)
    content = bytearray(path.read_bytes())
    for place in range(200, len(content), max(1, len(content) // 60)):
        content[place] ^= 0xFF
    path.write_bytes(content)
    with pytest.raises(InputError, match="not a readable result"):
        load(path)
    assert zlib


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


def test_a_number_in_a_cell_stays_one():
    assert [cell(text) for text in ("-1.5", "+3", "1e-3", "", "word")] == [
        *("-1.5", "+3", "1e-3", "", "word")
    ]


def test_an_export_has_no_formulas_and_no_escapes(tmp_path):
    rows = [{"name": "a", "=evil": 1.0, "reason": "=HYPERLINK(1)"}, {"name": "b", "reason": EVIL}]
    export(table_of(rows), tmp_path / "t.csv")
    text = (tmp_path / "t.csv").read_text()
    assert text.splitlines()[0] == "name,'=evil,reason" and "'=HYPERLINK(1)" in text
    assert "\x1b" not in text
