import errno
import io
import os

import numpy as np
import pytest

from command_line import exit_status, refused
from synthetic import jkr_detachment, jkr_result
from viscotack import simulate
from viscotack.errors import InputError
from viscotack.files.quantities import read_quantities
from viscotack.files.text import read_rows
from viscotack.files.toml import read_toml
from viscotack.files.whole import (
    NotWritten,
    write_whole,
)
from viscotack.result import load, save

ELASTIC = "simulate sphere --material elastic --tabor 3.24 --preload 20".split()


def names(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.fixture
def saved(tmp_path):
    path = tmp_path / "run.npz"
    save(jkr_result(), path)
    return path


@pytest.fixture
def fake(monkeypatch):
    """Replace the simulation by a ready result."""
    monkeypatch.setattr(simulate, "solve", lambda problem, **options: jkr_detachment())


def one_line(capsys, *arguments):
    """Return the one line that refuses a command before its work."""
    words = refused(arguments, capsys)
    assert words.count("\n") == 1
    return words


# --- whole or not at all ---


def test_a_link_is_written_through(tmp_path):
    (tmp_path / "link").symlink_to("a.csv")
    write_whole(tmp_path / "link", b"new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "a.csv").read_bytes() == b"new"


def test_a_write_that_fails_leaves_the_old_file_and_no_draft(tmp_path, monkeypatch):
    path = tmp_path / "a.csv"
    path.write_bytes(b"old")

    def full(_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(NotWritten, match="^no space left for .*a.csv.*free space and repeat$"):
        write_whole(path, b"new")
    assert path.read_bytes() == b"old" and names(tmp_path) == ["a.csv"]


# --- the command line ---


def test_a_table_goes_to_standard_output_and_the_words_beside(saved, capsys):
    assert exit_status(["show", saved, "--csv", "-"]) == 0
    out, err = capsys.readouterr()
    table = np.genfromtxt(io.StringIO(out), delimiter=",", names=True)
    np.testing.assert_array_equal(table["force"], jkr_result().force)
    assert "pull-off force" in err and "wrote" not in err


@pytest.mark.parametrize(
    ("flags", "words"),
    [
        (["--csv", "-", "--json"], "--csv -: standard output"),
        (["--save", "-"], "--save -: standard output"),
        (["--csv", "x", "--save", "./x"], "--csv x and --save x are the same file"),
        (["--plot", "x.xyz"], "the file name must end in one of"),
        (["--csv", "a.xlsx"], "--csv a.xlsx"),
        (["--csv", "none/x"], "cannot write none/x: folder none does not exist"),
    ],
)
def test_files_are_refused_before_the_work(flags, words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(simulate, "solve", lambda *given, **options: 1 / 0)
    assert words in one_line(capsys, *ELASTIC, *flags)
    assert names(tmp_path) == []


def test_a_table_that_cannot_be_written_costs_neither_answer_nor_result(fake, tmp_path, capsys):
    files = ["--csv", "/dev/full", "--save", tmp_path / "run.npz", "--plot", tmp_path / "a.svg"]
    assert exit_status([*ELASTIC, *files]) == 2
    out, err = capsys.readouterr()
    assert "no space left for /dev/full" in err and "Traceback" not in err
    assert "pull-off force" in out and out.count("\n") > 5
    np.testing.assert_array_equal(load(tmp_path / "run.npz").force, jkr_detachment().force)
    assert names(tmp_path) == ["a.svg", "run.npz"]


def test_a_file_that_exists_is_replaced_by_force_only(saved, tmp_path, capsys):
    path = tmp_path / "a.csv"
    path.write_bytes(b"")  # nothing is lost
    assert exit_status(["show", saved, "--csv", path]) == 0
    capsys.readouterr()
    path.write_text("mine")
    assert f"--csv {path} exists" in one_line(capsys, "show", saved, "--csv", path)
    assert path.read_text() == "mine"
    assert exit_status(["show", saved, "--csv", path, "--force"]) == 0
    assert path.read_text().startswith("time,")


# --- TOML and other text ---


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_toml_is_read_in_the_encodings_that_editors_write(encoding, tmp_path):
    path = tmp_path / "a.toml"
    path.write_bytes('name = "Grün"\r\n[sphere]\r\nradius = "5 µm"\r\n'.encode(encoding))
    assert read_toml(path) == {"name": "Grün", "sphere": {"radius": "5 µm"}}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[sphere]\nradius = 1\nradius = 3\n", "line 3, `radius = 3`: this key or table is there"),
        ('passport = "C:\\Users\\a.toml"\n', "write a path with / or in single quotes"),
    ],
)  # fmt: skip
def test_an_error_in_toml_names_what_is_wrong_with_its_line(text, words, tmp_path):
    path = tmp_path / "a.toml"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        read_toml(path)
    assert words in str(caught.value) and "\n" not in str(caught.value)


def test_tables_of_spreadsheets_are_read_in_their_encodings(tmp_path):
    file, units = tmp_path / "prony.csv", {"modulus_ratio": "1", "relaxation_time": ""}
    for text, encoding in (
        ("modulus_ratio,relaxation_time_h\n9,0.1\n", "utf-16"),
        ("\ufeff# soft\n\nmodulus_ratio, relaxation_time\n9, 0.1\n", "utf-8"),
        ("# soft, 1;2\nmodulus_ratio;relaxation_time_s\n9;0,1\n", "utf-8"),
    ):
        file.write_text(text, encoding)
        assert tuple(read_quantities(file, units).values()) == ((9.0,), (0.1,))
    file.write_text("gap_nm\n5\n")
    assert read_quantities(file, {"gap": "m"}) == {"gap": (5e-9,)}


def test_a_mark_begins_a_heading_of_cases_and_a_comment_of_curves(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("#;radius [mm]\n1;5,19\n")
    assert [row for _, row in read_rows(path)] == [["#", "radius [mm]"], ["1", "5.19"]]
    path.write_text("# a, b\ngap_nm;traction_kPa\n1,5;2\n")
    assert read_quantities(path, {"gap": "m", "traction": "Pa"})["gap"] == pytest.approx([1.5e-9])
