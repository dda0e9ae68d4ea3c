import pytest

from viscotack.app.cli import main
from viscotack.campaign import read_plan
from viscotack.errors import InputError
from viscotack.files.quantities import read_quantities
from viscotack.files.text import read_rows, read_text
from viscotack.files.toml import read_toml
from viscotack.materials.library import published
from viscotack.materials.passport_file import read_passport, write_passport
from viscotack.problem.case_file import read_prony


def call(*arguments):
    """Return the exit status of a command."""
    with pytest.raises(SystemExit) as caught:
        main([str(a) for a in arguments])
    return caught.value.code or 0


def refused(capsys, *arguments):
    """Return the one line that refuses a command before its work."""
    assert call(*arguments) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.count("\n") == 1
    return err


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
        InputError, match=r"a.toml is not .* UTF-8 \(line 2\); .*: iconv -f WINDOWS"
    ):
        read_toml(path)
    path.write_bytes("x = 1\n".encode("utf-16-le"))
    with pytest.raises(InputError, match="zero bytes; if it is UTF-16, .*: iconv -f UTF-16"):
        read_toml(path)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[sphere]\nradius = 1\n# radius\nspeed = 2\nradius = 3\n",
         "a.toml: key 'radius' stands twice in [sphere], lines 2 and 5; leave out one of them"),
        ("kind = 1\n\nkind = 2\n[sphere]\nkind = 3\n", "key 'kind' stands twice, lines 1 and 3"),
        ("[a]\nx = [\n 1,\n]\nx = [\n 2,\n]\n", "key 'x' stands twice in [a], lines 2 and 5"),
        ('[a]\nx = """\nx = 1\n"""\nx = 1\n', "key 'x' stands twice in [a], lines 2 and 5"),
        ("[[a]]\nx = 1\n[[a]]\ny = 1\nx = 2\nx = 3\n", "twice in [a], lines 5 and 6"),
        ("[sphere]\n[punch]\n[sphere]\n", "the table [sphere] stands twice, lines 1 and 3"),
        ("[a]\n[a.b]\nx = 1\n[a]\n", "the table [a] stands twice, lines 1 and 4"),
        ('x = 1\n"x" = 2\n', "key 'x' stands twice, lines 1 and 2"),
        ("a.b = 1\na.b.c = 2\n", "key 'a.b' stands twice, lines 1 and 2"),
        ("x = { a = 1, a = 2 }\n", "line 1, `x = { a = 1, a = 2 }`: duplicate inline table key"),
        ("x = 1\nradius 5 mm\n", "a.toml is not a TOML file, line 2, `radius 5 mm`: expected '='"),
        ("x = 1\n\ny =", "line 3, `y =`: invalid value"),
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
        assert "key 'radius' stands twice in [sphere], lines 2 and 3" in words


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
