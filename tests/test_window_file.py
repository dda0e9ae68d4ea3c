"""Tests of the operation ``window``: its file, command, tables and picture."""

import csv
from pathlib import Path

import pytest
from typer.testing import CliRunner

from picture_units import in_si
from viscotack.app.cli import application
from viscotack.app.operations import ask
from viscotack.design import read_window
from viscotack.errors import InputError
from viscotack.plot.window import draw_window

EXAMPLE = Path(__file__).parents[1] / "examples" / "window" / "kinetic_stamp.toml"
CONTACT = """
[{name}.material]
model = "elastic"
rubbery_modulus = "2 MPa"
poisson_ratio = 0.5
[{name}.interface]
law = "lennard-jones"
work_of_adhesion = "{work}"
equilibrium_gap = "100 nm"
[{name}.sphere]
radius = "1 mm"
"""
PULL = """
[pull]
speeds = "1 um/s..100 um/s"
preloads = ["1 mN", "100 uN"]
stiffness = "1 kN/m"
"""
SMALL = "".join(
    [
        PULL,
        CONTACT.format(name="stamp", work="50 mJ/m^2"),
        CONTACT.format(name="donor", work="20 mJ/m^2"),
        CONTACT.format(name="receiver", work="80 mJ/m^2"),
    ]
)


@pytest.mark.slow
def test_the_example_picks_fast_and_prints_slowly(tmp_path):
    text = EXAMPLE.read_text()
    for wide, few in (
        ('"1 um/s..10 mm/s"', '["1 um/s", "10 mm/s"]'),
        ('["200 uN", "1 mN", "5 mN"]', '"1 mN"'),
    ):
        assert wide in text
        text = text.replace(wide, few)
    (tmp_path / "stamp.toml").write_text(text)
    record = ask("window", file=str(tmp_path / "stamp.toml")).record()
    assert [cell["word"] for cell in record["cells"]] == ["print", "pick"]
    (donor,) = (x for x in record["critical_speeds"] if x["base"] == "donor")
    # docs/pick_and_print.md
    assert donor["critical_speed_m_per_s"] == pytest.approx(15.3e-6, rel=0.02)


@pytest.mark.parametrize(
    "old, new, field",
    [
        ("[stamp.sphere]", "[stamp.spere]", "spere"),
        ('stiffness = "1 kN/m"', 'peel_angle = "90"', "peel"),
        ('"1 um/s..100 um/s"', '"100 um/s..1 um/s"', "range"),
        ('["1 mN", "100 uN"]', '"1 mm"', "preloads"),
    ],
)
def test_a_wrong_file_is_refused_with_the_place(small, old, new, field):
    small.write_text(SMALL.replace(old, new))
    with pytest.raises(InputError, match=field):
        read_window(small)


def test_the_command_writes_tables_and_a_picture(small):
    line = ["window", "small.toml", "--csv", "map.csv", "--critical", "c.csv", "--plot", "map.svg"]
    done = CliRunner().invoke(application(), line)
    assert done.exit_code == 0, done.output
    rows = list(csv.DictReader(Path("map.csv").read_text().splitlines()))
    assert len(rows) == 14
    assert {row["donor_opens"] for row in rows} == {"donor"}
    assert {row["receiver_opens"] for row in rows} == {"stamp"}
    assert Path("c.csv").read_text().startswith("base,preload_N,critical_speed_m_per_s")
    assert Path("map.svg").stat().st_size > 5000


def test_a_map_of_one_speed_and_tensile_preloads_is_drawn(small):
    small.write_text(SMALL.replace('["1 mN", "100 uN"]', '["-10 uN", "1 mN"]'))
    found = ask("window", file="small.toml").found
    axes = draw_window(found).axes[0]
    assert axes.get_yscale() == "linear"
    low, high = (in_si(axes.xaxis, x) for x in axes.get_xlim())
    assert low < found.speeds[0] <= found.speeds[-1] < high < 10 * found.speeds[-1]
    low, high = (in_si(axes.yaxis, y) for y in axes.get_ylim())
    assert low < -1e-5 < 1e-3 < high < 1e-2
