"""Files without dimensions, and numbers of a file replaced on the command line."""

import json

import pytest

import viscotack as vt
from command_line import answered
from solids import creep_power_law

GROUPS = """
[groups]
tabor = 3.24
preload = 73
rate = 316.23
moves = ["approach 5 to depth 80", "dwell 2"]
stiffness = 4
[material]
model = "power-law"
modulus_ratio = 0.1
exponent = 0.8
"""
PUNCH = """
[groups]
cohesion = 0.05
preload_force = 1
rate = 10
[material]
model = "sls"
modulus_ratio = 0.1
[interface]
law = "gent-schultz"
base = "exponential"
decay = 0.5
reference_speed = 10
exponent = 0.4
[punch]
half_width = 64.85
[layer]
thickness = 3.24
base = "bonded"
poisson_ratio = 0.45
"""


def read(folder, text):
    path = folder / "groups.toml"
    path.write_text(text)
    return vt.read_case(path)


def test_a_sphere_in_groups(tmp_path):
    solid = creep_power_law(1, 10, 0.8, 1, 0)
    moves = (vt.Approach(5.0, vt.AtDepth(80.0)), vt.Dwell(2.0))
    expected = vt.Groups(3.24, solid, vt.AtDepth(73.0), 316.23, moves=moves, stiffness=4.0)
    assert read(tmp_path, GROUPS) == expected


def test_a_punch_in_groups_and_back(tmp_path):
    found = read(tmp_path, PUNCH)
    law = vt.GentSchultz(1, 1, reference_speed=10, exponent=0.4, base=vt.Exponential(1, 1, 0.5))
    assert found.traction == law and found.start == vt.AtForce(1.0)
    assert found.body == vt.Layer(3.24, vt.Bonded(poisson_ratio=0.45))
    assert vt.from_dict(json.loads(json.dumps(vt.to_dict(found)))) == found


@pytest.mark.parametrize(
    ("old", "new", "field"),
    [
        ("tabor = 3.24", 'tabor = "3 mm"', "tabor"),
        ("tabor = 3.24", "tabour = 3", "tabour"),
        ("preload = 73", "", "preload"),
        ('"dwell 2"', '"dwell 2 s"', "dwell"),
        ("exponent = 0.8", 'exponent = 0.8\n[protocol]\nspeed = "1 um/s"', "protocol"),
    ],
)
def test_a_wrong_file_is_refused_with_its_key(old, new, field, tmp_path):
    assert old in GROUPS
    with pytest.raises(vt.InputError, match=field):
        read(tmp_path, GROUPS.replace(old, new))


SHORT = "[groups]\ntabor = 1\npreload = 5\nrate = 10\n"
SOLID = '[material]\nmodel = "elastic"\n'
FLAGS = ["--tabor", "1", "--preload", "5", "--rate", "10"]


@pytest.mark.parametrize(
    ("lines", "flags"),
    [
        ('[material]\npassport = "pdms-10-1"\n', ["sphere", "--material", "pdms-10-1"]),
        (
            f'{SOLID}[interface]\nlaw = "table"\nfile = "law.csv"\n',
            ["sphere", "--material", "elastic", "--law", "table:law.csv"],
        ),
        (
            f'{SOLID}[profile]\nfile = "tip.csv"\n',
            ["profile", "--material", "elastic", "--points", "tip.csv"],
        ),
    ],
)
def test_a_file_without_dimensions_states_what_the_flags_state(
    lines, flags, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "law.csv").write_text("gap_nm,traction_kPa\n1,-9\n2,0\n3,9\n5,4\n8,0\n")
    (tmp_path / "tip.csv").write_text("radius_1,height_1\n0,0\n1,0.6\n2,2\n5,12\n9,40\n")
    end = ["--until", "pull-off", "--accuracy", "0.02"]
    found = answered(["simulate", *flags, *FLAGS, *end], capsys)
    assert read(tmp_path, SHORT + lines) == vt.from_dict(found["problem"])


@pytest.mark.parametrize(
    ("lines", "field"),
    [
        ('[material]\npassport = "pdms-10-1"\ntemperature = "0 degC"\n', "temperature"),
        (f'{SOLID}[surface]\nkind = "sphere"\n', "surface"),
    ],
)
def test_what_has_no_meaning_without_dimensions_is_refused(lines, field, tmp_path):
    with pytest.raises(vt.InputError, match=field):
        read(tmp_path, SHORT + lines)
