"""Files without dimensions, and numbers of a file replaced on the command line."""

import json

import pytest
from typer.testing import CliRunner

import viscotack as vt
from viscotack.app.cli import application

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
    solid = vt.RetardationPowerLaw(
        rubbery_modulus=1, glassy_modulus=10, exponent=0.8, tau0=1, poisson_ratio=0
    )
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
        ("tabor = 3.24", "tabor = -1", "tabor"),
        ("tabor = 3.24", "tabour = 3", "tabour"),
        ("modulus_ratio = 0.1", "modulus_ratio = 10", "modulus_ratio"),
        ("modulus_ratio = 0.1", "", "glassy_modulus"),
        ("preload = 73", "", "preload"),
        ("preload = 73", "preload = 73\napart = 9", "apart"),
        ('"dwell 2"', '"dwell 2 s"', "dwell"),
        ("exponent = 0.8", 'exponent = 0.8\n[protocol]\nspeed = "1 um/s"', "protocol"),
        ("exponent = 0.8", "exponent = true", "exponent"),
    ],
)
def test_a_wrong_file_is_refused_with_its_key(old, new, field, tmp_path):
    assert old in GROUPS
    with pytest.raises(vt.InputError, match=field):
        read(tmp_path, GROUPS.replace(old, new))


def predicted(path, *replaced):
    flags = [word for one in replaced for word in ("--set", one)]
    return CliRunner().invoke(application(), ["predict", str(path), *flags, "--json"])


def test_numbers_of_a_file_are_replaced(tmp_path):
    text = GROUPS.replace('moves = ["approach 5 to depth 80", "dwell 2"]\nstiffness = 4\n', "")
    path = tmp_path / "a.toml"
    path.write_text(text)
    other = tmp_path / "b.toml"
    other.write_text(text.replace("3.24", "2.5").replace("316.23", "100"))
    one = json.loads(predicted(path, "tabor=2.5", "rate = 100").stdout)
    two = json.loads(predicted(other).stdout)
    assert one["pull_off_force"] == two["pull_off_force"]
    for wrong, name in (("tabour=2", "tabor"), ("tabor=2 mm", "tabor"), ("tabor=-1", "tabor")):
        done = predicted(path, wrong)
        assert done.exit_code == 2 and name in done.output
