"""Tests of the operation ``window``: its file, command, tables and picture."""

from math import log, sqrt
from pathlib import Path
from statistics import NormalDist

import numpy as np
import pytest

import viscotack as vt
from command_line import exit_status, rows_of
from picture_units import in_si
from test_window import ELASTIC, contact, with_work
from viscotack.app.operations import ask
from viscotack.design import read_window
from viscotack.design.window import aged, opening_chance
from viscotack.errors import InputError
from viscotack.model.materials import Passport, write_passport
from viscotack.model.materials.shift import WLF
from viscotack.plot.design import draw_window

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
    assert exit_status("window small.toml --csv map.csv --critical c.csv --plot map.svg") == 0
    rows = rows_of("map.csv")
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


# Tests of the yield of a window under scatter of works and preload, and of temperatures.
@pytest.mark.parametrize("first, second", [(0.1, 0.0), (0.0, 0.1), (0.1, 0.2)])
def test_the_chance_of_two_elastic_contacts_is_that_of_the_ratio_of_their_works(first, second):
    stamp = contact(ELASTIC, work=0.2)
    base = with_work(stamp, 0.21)
    # the pull-off of an elastic sphere does not depend on its preload
    found = opening_chance(stamp, base, works=(first, second), preload=0.1)
    # the gap is kept, so that only the range of the forces differs a little
    expected = NormalDist().cdf(log(1.05) / sqrt(first**2 + second**2))
    assert found.value == pytest.approx(expected, abs=0.015)
    # both contacts are uncertain by 0.5 % of their table, which may add up
    deviate, spread = NormalDist().inv_cdf, sqrt(first**2 + second**2)
    off = [spread * (deviate(x) - deviate(found.value)) for x in (found.low, found.high)]
    assert off == pytest.approx([-0.01, 0.01], rel=0.03)


FEW = SMALL.replace('"1 um/s..100 um/s"', '"10 um/s"')


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_file_with_scatter_has_columns_of_probabilities(folder):
    Path("small.toml").write_text(FEW + "\n[scatter]\ndonor = 0.2\nstamp = 0.2\n")
    assert exit_status("window small.toml --csv map.csv") == 0
    row = rows_of("map.csv")[0]
    expected = NormalDist().cdf(log(50 / 20) / (0.2 * sqrt(2)))
    assert float(row["pick_probability"]) == pytest.approx(expected, abs=5e-3)
    chance = {name: float(row[f"print_{name}"]) for name in ("low", "probability", "high")}
    assert 0.9 < chance["low"] < chance["probability"] < chance["high"]
    both = float(row["pick_probability"]) * chance["probability"]
    assert float(row["transfer_probability"]) == pytest.approx(both)


WARM = "".join(
    [
        PULL.replace("stiffness", 'temperatures = ["0 degC", "15 degC"]\nstiffness').replace(
            '["1 mN", "100 uN"]', '"1 mN"'
        ),
        CONTACT.format(name="donor", work="200 mJ/m^2"),
        CONTACT.format(name="stamp", work="50 mJ/m^2"),
    ]
)
ELASTIC_STAMP = (
    '[stamp.material]\nmodel = "elastic"\nrubbery_modulus = "2 MPa"\npoisson_ratio = 0.5'
)


@pytest.mark.slow
def test_a_critical_speed_moves_by_the_shift_factor(folder):
    solid = vt.StandardSolid(rubbery_modulus=2e6, glassy_modulus=20e6, tau0=1e-2, poisson_ratio=0.5)
    shift = WLF(reference_temperature=293.15, c1=5.0, c2=150.0)
    passport = Passport(name="rubber", material=solid, temperature=293.15, shift=shift)
    write_passport(passport, folder / "rubber.toml")
    text = WARM.replace(ELASTIC_STAMP, '[stamp.material]\npassport = "rubber.toml"')
    Path("warm.toml").write_text(
        text.replace('"1 um/s..100 um/s"', '["1 um/s", "10 mm/s"]').replace(
            'stiffness = "1 kN/m"\n', ""
        )
    )
    answer = vt.ask("window", file="warm.toml")
    cold, warm = (x["critical_speed_m_per_s"] for x in answer.record()["critical_speeds"])
    ratio = passport.shift_factor(273.15) / passport.shift_factor(288.15)
    assert warm / cold == pytest.approx(ratio, rel=0.02)


def test_temperatures_without_a_shift_are_refused(folder):
    Path("warm.toml").write_text(
        WARM.replace(
            ELASTIC_STAMP,
            '[stamp.material]\nmodel = "sls"\nrubbery_modulus = "2 MPa"\n'
            'glassy_modulus = "20 MPa"\ntau0 = "1 s"\npoisson_ratio = 0.5',
        )
    )
    with pytest.raises(vt.InputError, match="need the shift of the times"):
        read_window("warm.toml")


AGEING = SMALL.replace(
    '[stamp.interface]\nlaw = "lennard-jones"',
    '[stamp.interface]\nlaw = "saturating-ageing"\nreference_time = "10 s"\nlargest_growth = 4.0',
).replace("stiffness", 'dwells = ["1 ms", "10 s", "1000 s"]\nstiffness')


def test_a_stamp_that_ages_prints_after_a_short_dwell_and_holds_after_a_long_one(folder):
    Path("aged.toml").write_text(AGEING.replace('"1 um/s..100 um/s"', '"10 um/s"'))
    stated = read_window("aged.toml")
    works = [each.stamp.traction.work_of_adhesion for each in stated]
    assert works == pytest.approx([0.05002, 0.05 * (5 - 4 * np.exp(-1)), 0.25], rel=1e-4)
    record = vt.ask("window", file="aged.toml").record()
    words = {cell["dwell_s"]: cell["word"] for cell in record["cells"]}
    assert words == {1e-3: "pick and print", 10.0: "pick", 1000.0: "pick"}


@pytest.mark.slow
def test_an_aged_contact_pulls_off_as_the_simulation_with_its_dwell():
    law = vt.SaturatingAgeing(0.15, 2e-6, reference_time=10.0, largest_growth=1.0)
    history = (vt.Approach(1e-4, vt.AtForce(2e-3)), vt.Dwell(10.0))
    test = vt.Retraction(start=vt.Apart(3e-5), speed=1e-4, moves=history)
    problem = vt.Problem(ELASTIC, law, vt.Sphere(5e-3), test)
    forces = [
        vt.pull_off_force(vt.solve(each, accuracy=0.01, estimate_error=False)) * each.scales().force
        for each in (problem, aged(problem, 10.0))
    ]
    assert forces[0] == pytest.approx(forces[1], rel=0.05)
