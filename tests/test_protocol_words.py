"""What the machine does, in words: in TOML, in a table, and on the command line."""

import pytest

import viscotack as vt
from stated import LAW, case_text
from viscotack.model.problem.case_file import law_from_words
from viscotack.model.protocol_words import (
    PUNCH_UNITS,
    PURE_NUMBERS,
    SPHERE_UNITS,
    history_from_file,
    move_from_words,
    start_from_words,
)


def case(folder, protocol, law=LAW):
    path = folder / "case.toml"
    path.write_text(case_text(law=law, protocol=protocol))
    return vt.read_case(path)


@pytest.mark.parametrize(
    ("words", "move"),
    [
        ("approach 10 um/s to 1.5 mN", vt.Approach(1e-5, vt.AtForce(1.5e-3))),
        ("approach 10 um/s to radius 0.2 mm", vt.Approach(1e-5, vt.AtRadius(2e-4))),
        ("retract  10 um/s to  force -1 mN", vt.Retract(1e-5, vt.AtForce(-1e-3))),
        ("move to -2 um in 3 s", vt.MoveTo(-2e-6, 3.0)),
        ("load to -1 mN in 1 s", vt.LoadTo(-1e-3, 1.0)),
        ("dwell for 2 min", vt.Dwell(120.0)),
        ("hold force 60 s", vt.Dwell(60.0, "force")),
        ("hold depth for 1 h", vt.Dwell(3600.0, "depth")),
        ({"approach": "10 um/s", "to": "1.5 mN"}, vt.Approach(1e-5, vt.AtForce(1.5e-3))),
        ({"load_to": "-1 mN", "in": "1 s"}, vt.LoadTo(-1e-3, 1.0)),
    ],
)
def test_words_are_moves(words, move):
    assert move_from_words(words, SPHERE_UNITS) == move


def test_numbers_alone_are_dimensionless_and_a_punch_bears_a_stress():
    assert move_from_words("approach 10 to force 2", PURE_NUMBERS) == vt.Approach(10, vt.AtForce(2))
    assert move_from_words("load to 50 kPa in 1 s", PUNCH_UNITS) == vt.LoadTo(5e4, 1.0)
    assert start_from_words("force 1.5 mN", SPHERE_UNITS) == vt.AtForce(1.5e-3)
    assert start_from_words("apart 20", PURE_NUMBERS) == vt.Apart(20)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("go home", "'go home' is not a move"),
        ("approach 10 um/s", "write approach SPEED"),
        ("dwell 60", "'60' has no unit"),
        ("approach 10 um to 1 mN", "'10 um' has the wrong dimension"),
    ],
)
def test_words_that_are_no_move_are_refused_with_the_cure(words, said):
    with pytest.raises(ValueError, match=said):
        move_from_words(words, SPHERE_UNITS)


def test_a_case_states_start_moves_spring_and_retraction(tmp_path):
    protocol = case(
        tmp_path,
        """
start = "apart 20 um"
moves = ["approach 10 um/s to 1.5 mN", {hold = "force", for = "60 s"}]
stiffness = "500 N/m"
speed = "100 um/s"
""",
    ).protocol
    assert protocol.start == vt.Apart(2e-5)
    assert protocol.moves == (vt.Approach(1e-5, vt.AtForce(1.5e-3)), vt.Dwell(60.0, "force"))
    assert (protocol.stiffness, protocol.speed) == (500.0, 1e-4)


@pytest.mark.parametrize(
    ("protocol", "said"),
    [
        ('start = "apart 2 um"\npreload_depth = "1 um"', "got preload_depth and start"),
        ('start = "apart 2 um"', r"\[protocol\] speed"),
        ('start = "apart 2 um"\nmoves = ["dwell 1 s"]\ncycles = 0', "cycles"),
        ('start = "apart 2 um"\nhistory = "h.csv"', "history states the start"),
    ],
)
def test_a_wrong_protocol_is_refused_with_its_key(protocol, said, tmp_path):
    with pytest.raises(ValueError, match=said):
        case(tmp_path, protocol)


def test_a_history_is_a_table_of_time_and_displacement(tmp_path):
    (tmp_path / "h.csv").write_text("time_s,displacement_um\n0,-20\n2,1\n12,1\n12.5,-20\n")
    protocol = case(tmp_path, 'history = "h.csv"').protocol
    assert protocol.start.gap == pytest.approx(21e-6, rel=1e-12, abs=0)
    assert protocol.moves == (vt.MoveTo(1e-6, 2.0), vt.MoveTo(1e-6, 10.0), vt.MoveTo(-20e-6, 0.5))
    start, moves = history_from_file(tmp_path / "h.csv", 0.0)
    assert start == vt.Apart(2e-5) and len(moves) == 3


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("time_s,depth_um\n0,1\n1,2\n", "displacement"),
        ("time_s,displacement_um\n0,1\n0,2\n", "ascending times"),
        ("time_s,displacement_um\n0,1\n1,two\n", "line 3: displacement"),
    ],
)
def test_a_wrong_history_is_refused_with_file_and_line(text, said, tmp_path):
    (tmp_path / "h.csv").write_text(text)
    with pytest.raises(ValueError, match=said):
        history_from_file(tmp_path / "h.csv", 1e-6)


def test_a_law_may_be_a_table(tmp_path):
    rows = "gap_um,traction_kPa\n0.8,-400\n1,0\n1.2,100\n1.5,80\n2.5,10\n4,0\n"
    (tmp_path / "law.csv").write_text(rows)
    interface = 'law = "table"\nfile = "law.csv"'
    law = case(tmp_path, 'preload_depth = "1 um"\nspeed = "1 um/s"', interface).traction
    assert isinstance(law, vt.Tabulated)
    assert law.strength == pytest.approx(1e5, rel=1e-12, abs=0)
    small = law_from_words(f"table:{tmp_path / 'law.csv'}")
    assert small == law.reduced()


def test_a_wrong_law_is_refused_with_its_key(tmp_path):
    text = 'law = "exponential"\nwork_of_adhesion = "1 J/m^2"'
    with pytest.raises(ValueError, match="equilibrium_gap and decay"):
        case(tmp_path, 'preload_depth = "1 um"\nspeed = "1 um/s"', text)
