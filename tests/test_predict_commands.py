"""viscotack predict: one contact, one file, a table of thousands."""

from pathlib import Path

import pytest

import viscotack as vt
from command_line import answered, exit_status, refused, rows_of
from stated import LENS

SPHERE = "sphere --tabor 3.24 --modulus-ratio 0.1 --exponent 0.8 --preload 73".split()
RATE = ["--rate", "316.23"]
PUNCH = (
    "punch --size 64.85 --thickness 3.24 --cohesion 0.05 --modulus-ratio 0.1 --preload 1".split()
)
PAD = Path(__file__).parents[1] / "examples" / "from_toml" / "pad.toml"


@pytest.fixture
def lens(tmp_path):
    path = tmp_path / "lens.toml"
    path.write_text(LENS)
    return path


def call(*arguments):
    """Return the exit status of a command."""
    return exit_status(["predict", *arguments])


def answer(capsys, *arguments):
    return answered(["predict", *arguments], capsys)


def wrong(capsys, *arguments):
    return refused(["predict", *arguments], capsys)


def test_a_number_of_a_file_is_replaced_with_its_unit(lens, capsys):
    by_path = answer(capsys, lens, "--set", "sphere.radius=6 mm")
    assert by_path["problem"]["sphere"]["radius"] == 6e-3
    assert answer(capsys, lens, "--set", "radius=6 mm") == by_path
    for said in ("sphere.radius=6", "sphere.radius=6 kg", "sphere.radios=6 mm"):
        assert "--set: " in wrong(capsys, lens, "--set", said)
    twice = ("--set", "radius=6 mm", "--set", "radius=7 mm")
    assert "name each number once" in wrong(capsys, lens, *twice)


def test_compare_simulates_and_prints_the_error_of_the_prediction(capsys):
    words = [*SPHERE, *RATE, "--compare"]
    found = answer(capsys, *words)
    simulated = vt.summary(vt.solve(vt.from_dict(found["problem"]), until="pull-off"))
    true = simulated["pull_off_force"]
    assert found["simulation"]["pull_off_force"] == true
    off = found["difference"]["pull_off_force"]
    assert off == pytest.approx(found["pull_off_force"] / true - 1, rel=1e-12, abs=1e-15)
    low, high = found["interval"]
    assert found["interval_held"]["pull_off_force"] is (low <= true <= high)
    assert abs(off) < 0.01
    assert call(*words) == 0
    out = capsys.readouterr().out
    assert f"{off:+.2%}" in out and "wall time" in out


def test_the_curve_is_written_and_drawn(lens, tmp_path, capsys):
    curve, picture = tmp_path / "curve.csv", tmp_path / "curve.png"
    found = answer(capsys, lens, "--curve", curve, "--plot", picture, "--compare")
    rows = rows_of(curve)
    names = ["depth", "force", "contact_radius", "depth_m", "force_N", "contact_radius_m"]
    assert list(rows[0]) == names and len(rows) == 24
    assert float(rows[-1]["force_N"]) == pytest.approx(-found["pull_off_force_N"], rel=1e-9, abs=0)
    assert float(rows[-1]["depth_m"]) == pytest.approx(
        found["depth_at_pull_off_m"], rel=1e-9, abs=0
    )
    assert picture.stat().st_size > 1000
    words = wrong(capsys, *SPHERE, "--rate", "1e13", "--curve", tmp_path / "none.csv")
    assert "The tier 'surrogate' gives no curve" in words and not (tmp_path / "none.csv").exists()


def test_a_table_keeps_its_rows_their_order_and_its_other_columns(tmp_path, capsys):
    cases, answers = tmp_path / "cases.csv", tmp_path / "answers.csv"
    rows = [
        ("b", "3.24", "0.1", "0.8", "73", "316.23"),
        ("a", "3.24", "0.1", "0.8", "600", "1"),
        ("c", "3.24", "7", "0.8", "73", "10"),
        ("d", "3.24", "soft", "0.8", "73", "10"),
        ("e", "3.24", "0.1", "0.8", "73.00", "1"),
    ]
    names = ("name", "tabor", "modulus_ratio", "exponent", "preload", "rate")
    cases.write_text("\n".join(map(",".join, (names, *rows))) + "\n")
    found = answer(capsys, cases, "--csv", answers)
    counts = {"rows": 5, "inside": 2, "unanswered": 2}
    assert {name: found[name] for name in counts} == counts
    assert found["methods"]["surrogate"] == 2 and sum(found["methods"].values()) == 3
    written = rows_of(answers)
    assert [tuple(row[name] for name in names) for row in written] == rows
    assert [row["inside"] for row in written] == ["true", "false", "false", "false", "true"]
    one = answer(capsys, *SPHERE, *RATE)
    columns = ("pull_off_force", "pull_off_force_low", "pull_off_force_high", "work_to_pull_off")
    assert [float(written[0][name]) for name in columns] == pytest.approx(
        [one["pull_off_force"], *one["interval"], one["work_to_pull_off"]], rel=1e-9, abs=0
    )
    assert written[1]["work_to_pull_off"] == "" and float(written[1]["pull_off_force"]) > 1
    assert written[2]["pull_off_force"] == "" and "got 7" in written[2]["why"]
    assert written[3]["why"] == "modulus_ratio is 'soft', not a number"
    assert call(cases, "--csv", answers, "--force") == 0
    out = capsys.readouterr().out
    assert "unanswered  2" in out


def test_a_workbook_of_cases_becomes_a_workbook_of_answers(tmp_path, capsys):
    openpyxl = pytest.importorskip("openpyxl")
    columns = ["name", "tabor", "modulus_ratio", "exponent", "preload", "rate"]
    rows = [
        ['soft, "first"', 3.24, 0.1, 0.8, 73, 316.23],
        [None] * 6,
        ["beyond", 3.24, 7, 0.8, 73, 10],
        ["=1+1", 1, 0.1, 0.6, "deep", 1000],
    ]
    cases, answers = tmp_path / "cases.xlsx", tmp_path / "answers.xlsx"
    book = openpyxl.Workbook()
    for row in [columns, *rows]:
        book.active.append(row)
    book.active.cell(1, 9).value = ""  # an empty column that was formatted
    book.active.cell(5, 1).data_type = "s"
    book.save(cases)
    found = answer(capsys, cases, "--xlsx", answers)
    assert (found["rows"], found["unanswered"]) == (4, 2)
    told = list(openpyxl.load_workbook(answers)["predictions"].iter_rows(values_only=True))
    # an empty row keeps its place, so that answers may be pasted beside the cases
    assert list(told[0][:6]) == columns and [list(row[:6]) for row in told[1:]] == rows
    assert told[2][-1] == "empty row"
    assert told[1][told[0].index("pull_off_force")] == pytest.approx(7.3, abs=0.1)


MODULI = ("sphere", "--radius", "5 mm", "--rubbery-modulus", "1 MPa", "--contact-modulus", "2 MPa")


def test_what_is_wrong_is_said_before_anything_is_written(lens, tmp_path, capsys):
    cases, other = tmp_path / "cases.csv", tmp_path / "other.csv"
    cases.write_text("tabor,modulus_ratio,exponent,preload,rate\n1,0.1,0.8,5,10\n")
    other.write_text("tabor,rate\n1,10\n")
    ragged = tmp_path / "ragged.csv"
    ragged.write_text("tabor,modulus_ratio,exponent,preload,rate\n1,0.1,0.8,5\n")
    again = tmp_path / "again.csv"
    again.write_text("tabor,modulus_ratio,exponent,preload,rate,why\n1,0.1,0.8,5,10,x\n")
    out = ["--csv", tmp_path / "out.csv"]
    for words, arguments in (
        ("'tabor'", [lens, cases, *out]),
        ("--compare", [cases, *out, "--compare"]),
        ("tabor, modulus_ratio, exponent, rate", [other, *out]),
        ("line 2: 4 values for 5 columns", [ragged, *out]),
        ("the columns why", [again, *out]),
        ("leave out --rate", [lens, *RATE]),
        ("--size", [*SPHERE, *RATE, "--size", "1"]),
        ("confidence", [*SPHERE, *RATE, "--confidence", "90"]),
        ("--temperature", [*SPHERE, *RATE, "--temperature", "20 degC"]),
        ("--material", [*SPHERE, *RATE, "--material", "fractional-zener"]),
        ("--material", [*SPHERE, *RATE, "--material", "prony"]),
        ("published", [*SPHERE, *RATE, "--material", "pdms-10"]),
        ("--contact-modulus", [*MODULI, "--material", "sls"]),
    ):
        assert words in wrong(capsys, *arguments), words
    assert not (tmp_path / "out.csv").exists()


def test_a_punch_by_flags_by_file_and_beside_its_simulation(tmp_path, capsys):
    curve, picture = tmp_path / "curve.csv", tmp_path / "pad.svg"
    found = answer(capsys, *PUNCH, "--rate", "10", "--compare", "--curve", curve, "--plot", picture)
    assert found["method"] == "surrogate of punches" and found["inside"]
    assert found["pull_off_stress"] == pytest.approx(0.9957, rel=5e-3)
    simulated = found["simulation"]["pull_off_stress"]
    assert found["difference"]["pull_off_stress"] == found["pull_off_stress"] / simulated - 1
    assert set(found["interval_held"]) == {"pull_off_stress", "work_to_pull_off"}
    rows = rows_of(curve)
    assert list(rows[0]) == ["depth", "stress", "ligament"] and rows[0]["ligament"] == "1.0"
    # tension is positive, as `simulate --csv` has it
    assert float(rows[-1]["stress"]) == pytest.approx(found["pull_off_stress"])
    assert float(rows[0]["stress"]) < 0 and picture.exists()
    pad = answer(capsys, PAD, "--curve", curve, "--force")
    strength = vt.read_case(PAD).traction.strength
    assert pad["pull_off_stress_Pa"] == pytest.approx(pad["pull_off_stress"] * strength)
    assert list(rows_of(curve)[0])[3:] == ["depth_m", "stress_Pa", "ligament_m"]
    assert call(PAD) == 0
    assert f"{pad['pull_off_stress_Pa'] / 1e3:.5g} kPa" in capsys.readouterr().out
