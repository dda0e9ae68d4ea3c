import csv
import errno
import io
import os
import shutil
import socket
import stat
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

from command_line import exit_status
from synthetic import jkr_detachment, jkr_result
from viscotack import methods
from viscotack.campaign import read_plan
from viscotack.errors import InputError
from viscotack.files.quantities import read_quantities
from viscotack.files.text import read_rows, read_text
from viscotack.files.toml import read_toml
from viscotack.files.whole import (
    NotWritten,
    check_target,
    is_standard_output,
    same_file,
    write_whole,
)
from viscotack.materials.library import published
from viscotack.materials.passport_file import read_passport, write_passport
from viscotack.problem.case_file import read_prony
from viscotack.result import load, save, write_csv

ELASTIC = "simulate sphere --material elastic --tabor 3.24 --preload 20".split()
PROC = pytest.mark.skipif(not os.path.isdir("/proc/self"), reason="needs the folder /proc")


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
    monkeypatch.setattr(methods, "solve", lambda problem, **options: jkr_detachment())


def call(*arguments):
    """Return the exit status of a command."""
    return exit_status(arguments)


def refused(capsys, *arguments):
    """Return the one line that refuses a command before its work."""
    assert call(*arguments) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.count("\n") == 1
    return err


# --- whole or not at all ---


def test_a_file_is_replaced_whole_and_leaves_no_draft(tmp_path):
    path = tmp_path / "a.csv"
    write_whole(path, b"old and longer")
    write_whole(str(path), b"new")
    assert path.read_bytes() == b"new" and names(tmp_path) == ["a.csv"]


def test_a_write_that_fails_leaves_the_old_file_and_no_draft(tmp_path, monkeypatch):
    path = tmp_path / "a.csv"
    path.write_bytes(b"old")

    def full(_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(NotWritten, match="^no space left for .*a.csv.*free space and repeat$"):
        write_whole(path, b"new")
    assert path.read_bytes() == b"old" and names(tmp_path) == ["a.csv"]


def test_what_is_not_written_is_an_error_of_the_system_and_of_the_input(tmp_path):
    with pytest.raises(NotWritten) as caught:
        write_whole(tmp_path / "none" / "a.csv", b"")
    error = caught.value
    assert isinstance(error, OSError) and isinstance(error, InputError)
    assert error.errno == errno.ENOENT
    assert (
        str(error) == f"cannot write {tmp_path}/none/a.csv: folder {tmp_path}/none does not exist"
    )


@pytest.mark.parametrize("to", ["real.csv", "lost.csv", "link.csv"])
def test_a_symbolic_link_is_not_followed(to, tmp_path):
    target, link = tmp_path / "real.csv", tmp_path / "link.csv"
    target.write_bytes(b"old")
    link.symlink_to(to)
    for writes in (check_target, lambda path: write_whole(path, b"new")):
        with pytest.raises(NotWritten, match="link.csv"):
            writes(link)
    assert target.read_bytes() == b"old" and names(tmp_path) == ["link.csv", "real.csv"]


def test_a_folder_behind_a_link_is_written_to(tmp_path):
    (tmp_path / "far").mkdir()
    (tmp_path / "near").symlink_to("far")
    write_whole(tmp_path / "near" / "a.csv", b"new")
    assert (tmp_path / "far" / "a.csv").read_bytes() == b"new"


@pytest.mark.parametrize("mode", [0o600, 0o640, 0o666, 0o755])
def test_the_permission_bits_of_a_file_are_kept(mode, tmp_path):
    path = tmp_path / "a.csv"
    path.write_bytes(b"old")
    path.chmod(mode)
    write_whole(path, b"new")
    assert stat.S_IMODE(path.stat().st_mode) == mode and path.read_bytes() == b"new"


def test_a_new_file_has_the_permission_bits_of_any_other(tmp_path):
    (tmp_path / "plain").write_bytes(b"")
    write_whole(tmp_path / "a.csv", b"")
    assert (tmp_path / "a.csv").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_a_write_protected_file_is_left_alone_also_by_root(tmp_path):
    path = tmp_path / "a.csv"
    path.write_bytes(b"old")
    path.chmod(0o444)
    for writes in (check_target, lambda file: write_whole(file, b"new")):
        with pytest.raises(NotWritten, match="a.csv: it is write-protected; give another name"):
            writes(path)
    assert path.read_bytes() == b"old"


def test_a_folder_and_a_socket_are_refused(tmp_path):
    with socket.socket(socket.AF_UNIX) as door:
        door.bind(str(tmp_path / "door"))
        for path, words in ((tmp_path, "it is a folder"), (tmp_path / "door", "it is a socket")):
            for writes in (check_target, lambda file: write_whole(file, b"")):
                with pytest.raises(NotWritten, match=words):
                    writes(path)


def test_a_pipe_is_written_to_and_stays_one(tmp_path):
    path, got = tmp_path / "pipe", []
    os.mkfifo(path)
    check_target(path)
    reader = threading.Thread(target=lambda: got.append(path.read_bytes()), daemon=True)
    reader.start()
    write_whole(path, b"through")
    reader.join(timeout=20)
    assert got == [b"through"] and path.is_fifo() and names(tmp_path) == ["pipe"]


def test_a_device_is_written_to_and_stays_one():
    ours, theirs = os.openpty()
    terminal = os.ttyname(theirs)
    check_target(terminal)
    write_whole(terminal, b"shown")
    assert os.read(ours, 5) == b"shown" and stat.S_ISCHR(os.stat(terminal).st_mode)
    os.close(theirs)
    os.close(ours)


@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_a_file_that_a_stream_of_the_process_goes_to_is_not_replaced(stream, tmp_path):
    code = (
        "import sys; from viscotack.files.whole import write_whole\n"
        f"print('before', file=sys.{stream})\n"
        f"write_whole('/dev/{stream}', b'table\\n'); print('after', file=sys.{stream})\n"
    )
    with open(tmp_path / "out", "wb") as out:
        streams = [out if name == stream else subprocess.PIPE for name in ("stdout", "stderr")]
        command = [sys.executable, "-c", code]
        subprocess.run(command, check=True, stdout=streams[0], stderr=streams[1])
    assert (tmp_path / "out").read_text() == "before\ntable\nafter\n"


def test_a_stream_gets_the_bytes():
    stream = io.BytesIO()
    write_whole(stream, b"a")
    write_whole(stream, b"b")
    assert stream.getvalue() == b"ab"


@PROC
def test_a_folder_that_takes_no_file_is_found_before_the_work_also_by_root():
    # root may write there, as far as the rights tell
    with pytest.raises(
        NotWritten, match="^cannot write /proc/a.csv: cannot create a file in the folder /proc"
    ):
        check_target("/proc/a.csv")
    with pytest.raises(
        NotWritten, match="^cannot write /proc/a.csv: cannot create a file in the folder /proc"
    ):
        write_whole("/proc/a.csv", b"")


@pytest.mark.parametrize("number", [errno.EACCES, errno.EROFS])
def test_a_write_protected_folder_is_found_before_the_work(number, tmp_path, monkeypatch):
    # root, and so perhaps this test, writes into any folder: the system's answer is put in
    def closed(*given, **options):
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(Path, "touch", closed)
    with pytest.raises(NotWritten, match=f"cannot create a file in the folder {tmp_path}"):
        check_target(tmp_path / "a.csv")


def test_looking_at_a_target_changes_nothing(tmp_path):
    path = tmp_path / "a.csv"
    check_target(path)
    assert names(tmp_path) == []
    path.write_bytes(b"old")
    check_target(path)
    assert names(tmp_path) == ["a.csv"] and path.read_bytes() == b"old"


def test_the_longest_name_of_a_file_has_room_for_its_draft(tmp_path):
    path = tmp_path / ("a" * 251 + ".csv")
    write_whole(path, b"new")
    assert names(tmp_path) == [path.name]


def test_the_same_file_is_seen_through_links_and_spellings(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    os.symlink("a", "link")
    assert same_file("a", "./a") and same_file(tmp_path / "a", "a")  # not there yet
    assert same_file("a", "link")
    (tmp_path / "a").write_bytes(b"")
    os.link("a", "hard")
    assert same_file("a", "hard") and same_file("link", "hard")
    assert not same_file("a", "b") and not same_file("/dev/null", "/dev/null")
    assert same_file("-", "-") and not same_file("-", "a")
    assert is_standard_output("-") and not is_standard_output("a")
    assert not is_standard_output("none") and not is_standard_output("/dev/null")


# --- the command line ---


def test_a_table_goes_to_standard_output_and_the_words_beside(saved, capsys):
    assert call("show", saved, "--csv", "-") == 0
    out, err = capsys.readouterr()
    table = np.genfromtxt(io.StringIO(out), delimiter=",", names=True)
    np.testing.assert_array_equal(table["force"], jkr_result().force)
    assert "pull-off force" in err and "wrote" not in err


@pytest.mark.parametrize(
    ("flags", "words"),
    [
        (["--csv", "-", "--json"], "--json and --csv - both go to standard output"),
        (["--plot", "-"], "--plot -: a picture is binary"),
        (["--save", "-"], "--save -: this file is binary"),
        (["--csv", "x", "--save", "x"], "--csv x and --save x are the same file"),
        (["--csv", "x", "--save", "./x"], "--csv x and --save x are the same file"),
        (["--csv", "link"], "link"),
        (["--plot", "x.xyz"], "the file name must end in one of"),
        (["--csv", "none/x"], "cannot write none/x: folder none does not exist"),
        (["--csv", "."], "it is a folder; give a file name"),
        pytest.param(["--save", "/proc/x"], "cannot create a file in the folder /proc", marks=PROC),
    ],
)
def test_files_are_refused_before_the_work(flags, words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    os.symlink("x", "link")
    monkeypatch.setattr(methods, "solve", lambda *given, **options: 1 / 0)
    assert words in refused(capsys, *ELASTIC, *flags)
    assert names(tmp_path) == ["link"]


SOFT = """
[material]
model = "elastic"
rubbery_modulus = "2 MPa"
poisson_ratio = 0.5
[interface]
law = "lennard-jones"
work_of_adhesion = "40 mJ/m^2"
equilibrium_gap = "200 nm"
[protocol]
speed = "10 um/s"
preload_depth = "0 nm"
"""
WORN = f'{SOFT}[measured-profile]\nfile = "worn.csv"\n'
MAP = f'{SOFT}[surface]\nfile = "scan.csv"\npixel = "0.1 um"\n'
CASES = "tabor,modulus_ratio,exponent,preload,rate\n2,0.1,0.8,20,10\n"
PLAN = 'kind = "sphere"\n[[list]]\nfile = "cases.csv"\n'


@pytest.fixture
def lab(tmp_path, monkeypatch, saved):
    """Make a folder with files, some of which name others."""
    monkeypatch.chdir(tmp_path)
    np.savetxt("scan.csv", np.add.outer(np.arange(8.0), np.arange(8.0)) * 1e-9, delimiter=",")
    r = np.linspace(0, 1e3, 30)
    rows = "".join(f"{x:.6g},{x**2 / 2e4:.6g}\n" for x in r)
    Path("worn.csv").write_text(f"radius_um,height_um\n{rows}")
    files = {"worn.toml": WORN, "map.toml": MAP, "plan.toml": PLAN, "cases.csv": CASES}
    for name, text in files.items():
        Path(name).write_text(text)
    write_passport(published("pdms-10-1"), tmp_path / "p.toml")
    (tmp_path / "sub").mkdir()
    return tmp_path


def plain(path):
    return path


def upwards(path):
    return Path("sub", "..", path)


def through_link(path):
    link = path.with_name(f"link{path.suffix}")
    link.symlink_to(path.name)
    return link


def through_hard_link(path):
    link = path.with_name(f"hard{path.suffix}")
    os.link(path, link)
    return link


@pytest.mark.parametrize("spelled", [plain, upwards, Path.resolve, through_link, through_hard_link])
@pytest.mark.parametrize(
    ("command", "kept"),
    [
        ("simulate profile worn.toml --csv", "worn.csv"),
        ("campaign plan plan.toml --csv", "cases.csv"),
        ("material convert p.toml -o", "p.toml"),
    ],
)
def test_a_command_writes_over_nothing_that_it_read(command, kept, spelled, lab, fake):
    before = (lab / kept).read_bytes()
    assert call(*command.split(), lab / f"new{Path(kept).suffix}") == 0
    assert call(*command.split(), spelled(Path(kept)), "--force") == 2
    assert (lab / kept).read_bytes() == before


def test_a_table_goes_into_the_folder_of_the_files_that_it_is_of(tmp_path, monkeypatch):
    example = Path("examples/from_rig/lens_1_um_s.csv").resolve()
    shutil.copy(example, tmp_path)
    monkeypatch.chdir(tmp_path)
    assert call("test", "read", ".", "--csv", "rows.csv") == 0
    assert call("test", "read", ".", "--csv", "lens_1_um_s.csv", "--force") == 2
    assert Path("lens_1_um_s.csv").read_bytes() == example.read_bytes()


def test_a_rough_test_does_not_write_over_its_map(lab):
    before = (lab / "scan.csv").read_bytes()
    assert call("rough", "map.toml", "--csv", "scan.csv", "--force") == 2
    assert (lab / "scan.csv").read_bytes() == before


def test_a_table_that_cannot_be_written_costs_neither_answer_nor_result(fake, tmp_path, capsys):
    files = ["--csv", "/dev/full", "--save", tmp_path / "run.npz", "--plot", tmp_path / "a.svg"]
    assert call(*ELASTIC, *files) == 2
    out, err = capsys.readouterr()
    assert "no space left for /dev/full" in err and "Traceback" not in err
    assert "pull-off force" in out and out.count("\n") > 5
    np.testing.assert_array_equal(load(tmp_path / "run.npz").force, jkr_detachment().force)
    assert names(tmp_path) == ["a.svg", "run.npz"]


def test_a_result_that_cannot_be_saved_costs_neither_answer_nor_table(fake, tmp_path, capsys):
    assert call(*ELASTIC, "--save", "/dev/full", "--csv", tmp_path / "a.csv", "--json") == 2
    out, err = capsys.readouterr()
    assert "no space left for /dev/full" in err and out.startswith("{")
    assert (tmp_path / "a.csv").stat().st_size > 100


@pytest.mark.parametrize("name", ["a.xlsx", "a.npz", "a.png", "a.toml"])
def test_an_ending_of_another_format_is_refused(name, saved, tmp_path, capsys):
    assert f"--csv {tmp_path / name}" in refused(capsys, "show", saved, "--csv", tmp_path / name)
    assert names(tmp_path) == ["run.npz"]


def test_a_file_that_exists_is_replaced_by_force_only(saved, tmp_path, capsys):
    path = tmp_path / "a.csv"
    path.write_bytes(b"")  # nothing is lost
    assert call("show", saved, "--csv", path) == 0
    capsys.readouterr()
    path.write_text("mine")
    assert f"--csv {path} exists" in refused(capsys, "show", saved, "--csv", path)
    assert path.read_text() == "mine"
    assert call("show", saved, "--csv", path, "--force") == 0
    assert path.read_text().startswith("time,")


@pytest.mark.parametrize("target", ["-", pytest.param("/dev/stdout", marks=pytest.mark.slow)])
def test_a_redirected_output_holds_the_table(target, saved, tmp_path):
    """As with ``>``: the file that the shell opened must not be replaced under its hands."""
    command = [sys.executable, "-m", "viscotack", "show", str(saved), "--csv", target]
    with open(tmp_path / "out.csv", "wb") as out:
        done = subprocess.run(command, stdout=out, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 0 and "pull-off force" in done.stderr
    write_csv(jkr_result(), tmp_path / "wanted.csv")
    assert (tmp_path / "out.csv").read_bytes() == (tmp_path / "wanted.csv").read_bytes()


def test_an_output_that_goes_nowhere_takes_both(saved):
    command = [sys.executable, "-m", "viscotack", "show", str(saved), "--json"]
    done = subprocess.run([*command, "--csv", "/dev/null"], stdout=subprocess.DEVNULL)
    assert done.returncode == 0


def test_a_reader_that_has_gone_is_no_error_in_words(saved):
    ours, theirs = os.pipe()
    os.close(ours)
    command = [sys.executable, "-m", "viscotack", "show", str(saved), "--csv", "-"]
    done = subprocess.run(command, stdout=theirs, stderr=subprocess.PIPE, text=True)
    os.close(theirs)
    assert done.returncode == 1
    assert done.stderr.count("pull-off force") == 1 and "rror:" not in done.stderr


def test_materials_go_to_standard_output_and_to_files(tmp_path, capsys):
    assert call("material", "convert", "pdms-10-1") == 0
    without = capsys.readouterr().out
    assert call("material", "convert", "pdms-10-1", "-o", "-") == 0
    assert capsys.readouterr().out == without
    assert call("material", "convert", "pdms-10-1", "-o", tmp_path / "p.toml") == 0
    assert (tmp_path / "p.toml").read_text(encoding="utf-8") == without
    assert capsys.readouterr() == ("", f"wrote {tmp_path}/p.toml\n")
    assert "no space left" in refused(capsys, "material", "convert", "pdms-10-1", "-o", "/dev/full")


def test_tables_of_cases_go_to_standard_output(tmp_path, capsys):
    cases = tmp_path / "cases.csv"
    cases.write_text("tabor,modulus_ratio,exponent,preload,rate\n2,0.1,0.8,20,10\n")
    assert call("campaign", "plan", cases, "--csv", "-") == 0
    out, err = capsys.readouterr()
    assert list(csv.DictReader(out.splitlines()))[0]["tabor"] == "2.0" and "1 cases of" in err
    assert call("predict", cases, "--csv", "-") == 0
    out, err = capsys.readouterr()
    assert list(csv.DictReader(out.splitlines()))[0]["method"] == "surrogate" and "1 rows" in err
    for command in (["campaign", "plan"], ["predict"]):
        assert "--json and --csv -" in refused(capsys, *command, cases, "--csv", "-", "--json")


# --- TOML and other text ---


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_toml_is_read_in_the_encodings_that_editors_write(encoding, tmp_path):
    path = tmp_path / "a.toml"
    path.write_bytes('name = "Grün"\r\n[sphere]\r\nradius = "5 µm"\r\n'.encode(encoding))
    assert read_toml(path) == {"name": "Grün", "sphere": {"radius": "5 µm"}}


def test_another_encoding_says_how_to_convert(tmp_path):
    path = tmp_path / "a.toml"
    path.write_bytes('x = 1\nradius = "5 µm"\n'.encode("cp1252"))
    with pytest.raises(
        InputError, match=r"a.toml is not .* UTF-8 \(line 2\); .* in Notepad by Save as"
    ):
        read_toml(path)
    path.write_bytes("x = 1\n".encode("utf-16-le"))
    with pytest.raises(
        InputError, match="zero bytes; if it is UTF-16, save it as UTF-8, in Notepad"
    ):
        read_toml(path)


def test_a_workbook_where_text_is_read_says_how_to_save_it(tmp_path):
    path = tmp_path / "a.csv"
    path.write_bytes(b"PK\x03\x04" + bytes(40))
    with pytest.raises(InputError, match="is a workbook or an archive, .* as CSV UTF-8"):
        read_toml(path)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[sphere]\nradius = 1\nradius = 3\n", "line 3, `radius = 3`: this key or table is there"),
        ("[a]\n[a.b]\nx = 1\n[a]\n", "line 4, `[a]`: this key or table is there already"),
        ("x = { a = 1, a = 2 }\n", "line 1, `x = { a = 1, a = 2 }`: duplicate inline table key"),
        ("x = 1\nradius 5 mm\n", "a.toml is not a TOML file, line 2, `radius 5 mm`: expected '='"),
        ("x = 1\n\ny =", "line 3, `y =`: invalid value"),
        ('passport = "C:\\Users\\a.toml"\n', "write a path with / or in single quotes"),
        ('x = "' + 70 * "a" + "\n", 'line 1, `x = "' + 55 * "a" + " ...`: illegal character"),
    ],
)  # fmt: skip
def test_an_error_in_toml_names_what_is_wrong_with_its_line(text, words, tmp_path):
    path = tmp_path / "a.toml"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        read_toml(path)
    assert words in str(caught.value) and "\n" not in str(caught.value)


def test_every_file_in_toml_is_read_so(tmp_path, capsys):
    write_passport(published("pdms-10-1"), tmp_path / "p.toml")
    text = (tmp_path / "p.toml").read_text(encoding="utf-8")
    (tmp_path / "p16.toml").write_text(text, encoding="utf-16")
    assert read_passport(tmp_path / "p16.toml") == read_passport(tmp_path / "p.toml")
    plan = 'kind = "sphere"\n[[grid]]\ntabor = 1\nmodulus_ratio = 0.1\nexponent = 0.8\n'
    plan += "preload = 5\nrate = 10\n"
    (tmp_path / "plan.toml").write_text(plan, encoding="utf-8-sig")
    found = read_plan(tmp_path / "plan.toml")
    assert len(found.cases) == 1 and found.source == plan
    (tmp_path / "twice.toml").write_text("[sphere]\nradius = 1\nradius = 2\n")
    for command in (["simulate", "sphere"], ["material", "show"], ["campaign", "plan"]):
        words = refused(capsys, *command, tmp_path / "twice.toml")
        assert "twice.toml" in words and "line 3" in words


def test_rows_know_their_lines(tmp_path):
    path = tmp_path / "a.csv"
    path.write_bytes('# made\r\n\r\n a , b\r\n1,"2,3"\r\n# and\r\n4,5\r\n'.encode("utf-16"))
    assert read_rows(path) == (["a", "b"], [(4, ["1", "2,3"]), (6, ["4", "5"])])
    assert read_text(path).startswith("# made\n\n")
    path.write_text("")
    assert read_rows(path) == ([], [])


def test_tables_of_spreadsheets_are_read_in_their_encodings(tmp_path):
    (tmp_path / "prony.csv").write_text("modulus_ratio,relaxation_time_s\n9,0.1\n", "utf-16")
    assert read_prony(tmp_path / "prony.csv") == (((9.0, 0.1),), "s")
    (tmp_path / "gap.csv").write_text("gap_nm\n5\n", encoding="utf-16")
    assert read_quantities(tmp_path / "gap.csv", {"gap": "m"}) == {"gap": (5e-9,)}
