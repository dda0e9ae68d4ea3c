"""Tests of the operation ``design``: its file, command, table, picture and words."""

import csv
from pathlib import Path

import pytest
from typer.testing import CliRunner

from picture_units import in_si
from viscotack.app.cli import application
from viscotack.app.operations import ask
from viscotack.design import read_design
from viscotack.errors import InputError
from viscotack.plot.design import draw_design

SMALL = """
[targets]
hold = "5 mN"
release = "2.5 mN"
[bounds]
radius = "1 mm..4 mm"
preload = "4 mN"
hold_speed = "1 mm/s"
release_speed = "1 um/s"
pads = 2
[material]
model = "power-law"
rubbery_modulus = "1.5 MPa"
glassy_modulus = "15 MPa"
exponent = 0.6
tau0 = "0.1 s"
poisson_ratio = 0.5
[interface]
law = "lennard-jones"
work_of_adhesion = "50 mJ/m^2"
equilibrium_gap = "100 nm"
"""


@pytest.mark.parametrize(
    "old, new, field",
    [
        ('hold = "5 mN"\nrelease = "2.5 mN"', "", "target"),
        ('hold = "5 mN"', 'hold = "-5 mN"', "hold"),
        ('"1 mm..4 mm"', '"1 mm..4 s"', "radius"),
        ("pads = 2", 'pads = "1..2.5"', "pads"),
        ("pads = 2", 'pads = 2\narea = "1 mm^2"', "pads"),
        ("[interface]", "[protocol]", "protocol"),
    ],
)
def test_a_wrong_file_is_refused_with_the_place(small, old, new, field):
    small.write_text(SMALL.replace(old, new))
    with pytest.raises(InputError, match=field):
        read_design(small)


def test_the_command_writes_a_table_and_a_picture(small):
    line = ["design", "small.toml", "--confirm", "1", "--accuracy", "0.01"]
    done = CliRunner().invoke(application(), [*line, "--csv", "d.csv", "--plot", "d.svg"])
    assert done.exit_code == 0, done.output
    row = next(csv.DictReader(Path("d.csv").read_text().splitlines()))
    assert row["meets"] == "True"
    assert float(row["simulated_hold_N"]) == pytest.approx(float(row["hold_N"]), rel=0.05)
    assert Path("d.svg").stat().st_size > 5000


def test_a_target_out_of_reach_is_drawn_with_the_best_design(small):
    small.write_text(SMALL.replace('hold = "5 mN"', 'hold = "60 mN"'))
    answer = ask("design", file="small.toml")
    assert answer.found.meets is False
    axes = draw_design(answer.found, read_design(small)).axes
    at = [line.get_xdata()[0] for line in axes[0].lines if line.get_linestyle() == ":"]
    best = answer.found.best.choice
    assert in_si(axes[0].xaxis, at) == pytest.approx([best.hold_speed, best.release_speed])
    (wanted,) = (x.get_ydata()[0] for x in axes[0].lines if x.get_label() == "hold, at least")
    assert in_si(axes[0].yaxis, wanted) == pytest.approx(60e-3)
