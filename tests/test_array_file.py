"""Tests of the operation ``array``: its file, command, tables, picture, payload and yield."""

from dataclasses import replace
from math import inf, isnan, pi, sqrt
from pathlib import Path

import numpy as np
import pytest

import viscotack as vt
from command_line import exit_status, rows_of
from picture_units import in_si
from viscotack.design import read_array
from viscotack.design.arrays import Hold, PadArray, grid, holding, pull_array
from viscotack.design.fast import held_load
from viscotack.plot.design import draw_array
from viscotack.theory import jkr

SMALL = """
[array]
rows = 1
columns = 3
spacing = "4 mm"
heights = ["0 um", "-1 um", "1 um"]
[backing]
stiffness = "2 kN/m"
tilt = "0.01 degree"
[pull]
speed = "10 um/s"
preload = "6 mN"
[hold]
mass = "0.3 g"
safety_factor = 2
[pad.material]
model = "elastic"
rubbery_modulus = "1.5 MPa"
poisson_ratio = 0.5
[pad.interface]
law = "lennard-jones"
work_of_adhesion = "150 mJ/m^2"
equilibrium_gap = "10 nm"
[pad.sphere]
radius = "5 mm"
"""


@pytest.mark.parametrize(("mass", "holds", "share"), [("0.3 g", True, 1.0), ("1 g", False, 0.0)])
def test_the_yield_is_the_share_of_drawn_arrays_that_hold_the_mass(small, mass, holds, share):
    drawn = 'heights = ["0 um", "-1 um", "1 um"]\nwork_scatter = 0.05\ndraws = 20\nseed = 1'
    text = SMALL.replace('heights = ["0 um", "-1 um", "1 um"]', drawn)
    small.write_text(text.replace('mass = "0.3 g"', f'mass = "{mass}"'))
    record = vt.ask("array", file="small.toml").record()
    assert (record["holds"], record["yield"]) == (holds, share)


@pytest.mark.parametrize(
    "old, new, field",
    [
        ("rows = 1", "rows = 1000000", "rows"),
        ("rows = 1", 'rows = "1"', "rows must be a whole"),
        ("rows = 1", "rows = 1\nseed = true", "seed must be a whole"),
        ("rows = 1", "rows = 1\ncolums = 9", "colums"),
        ('["0 um", "-1 um", "1 um"]', '["0 um"]', "heights"),
        ('tilt = "0.01 degree"', 'tilt = "20 degree"', "tilt"),
        ('stiffness = "2 kN/m"', 'base_tau0 = "1 s"', "base"),
        ('preload = "6 mN"', "", "preload"),
        ("safety_factor = 2", "safety_factor = 0.5", "safety"),
    ],
)
def test_a_wrong_file_is_refused_with_the_place(small, old, new, field):
    small.write_text(SMALL.replace(old, new))
    with pytest.raises(vt.InputError, match=field):
        read_array(small)


def test_the_command_writes_tables_and_a_picture(small):
    assert exit_status("array small.toml --csv f.csv --pads p.csv --plot a.svg") == 0
    rows = rows_of("p.csv")
    assert [row["order"] for row in rows] == ["3", "1", "2"]
    curve = rows_of("f.csv")
    force = [float(row["force_N"]) for row in curve]
    assert force[0] == pytest.approx(6e-3, rel=1e-6)
    assert force[-1] == 0
    assert Path("a.svg").stat().st_size > 5000


def test_a_pad_without_contact_is_drawn_and_counted(small):
    small.write_text(SMALL.replace('"-1 um"', '"-1 mm"'))
    answer = vt.ask("array", file="small.toml")
    axes = draw_array(read_array(small).array, answer.found).axes
    # force positive in compression
    (line,) = (line for line in axes[0].lines if len(line.get_xdata()) > 2)
    assert in_si(axes[0].xaxis, line.get_xdata()) == pytest.approx(-answer.found.drive)
    assert in_si(axes[0].yaxis, line.get_ydata()) == pytest.approx(answer.found.force)


def test_payload_is_the_force_over_gravity_acceleration_and_safety(small):
    stated = read_array(small)
    how = {"speed": stated.speed, "preload": stated.preload}
    pulled = pull_array(stated.array, **how)
    light, fast = Hold(1e-5), Hold(1e-5, acceleration=9.80665, safety_factor=3.0)
    one, other = (holding(stated.array, pulled, each, **how) for each in (light, fast))
    assert one.payload == pytest.approx(pulled.interval[0] / 9.80665, rel=1e-9)
    assert other.payload == pytest.approx(one.payload / 6, rel=1e-9)
    assert one.release_time == pytest.approx(np.max(pulled.released) / stated.speed)
    # an elastic pad holds less than its pull-off force for ever, without acceleration
    assert one.time == inf
    assert one.lasting == pytest.approx(one.payload, rel=1e-9)
    assert other.lasting == pytest.approx(one.payload / 3, rel=1e-9)
    assert holding(stated.array, pulled, Hold(1.0), **how).holds is False


def test_a_weight_above_the_pull_off_force_is_held_up_to_the_instantaneous_strength():
    E, R, w = 2e6 / 0.75, 3e-3, 0.1
    solid = vt.StandardSolid(rubbery_modulus=2e6, glassy_modulus=4e7, tau0=0.04, poisson_ratio=0.5)
    rest = vt.Retraction(vt.AtForce(3e-3), 1e-6)
    pad = vt.Problem(solid, vt.LennardJones(w, 1e-7), vt.Sphere(R), rest)
    array, how = PadArray(pad, grid(1, 1, 0.02)), {"speed": 1e-6, "preload": 3e-3}
    pulled = pull_array(array, **how)

    def time(load, of=array, sharing=1.0):
        found = replace(pulled, load_sharing=sharing)
        return holding(of, found, Hold(load / 9.80665), **how).time

    P = pulled.pull_off_force
    # a crack contact that is loaded in 1 s holds 6.39 and 3.92 s longer, and creeps meanwhile
    assert [time(1.01 * P), time(1.2 * P)] == pytest.approx([6.39 + 0.32, 3.92 + 0.31], rel=0.005)
    assert held_load(pad, time(3 * P)) == pytest.approx(3 * P, rel=0.005)
    assert time(0.6 * P, sharing=0.5) == pytest.approx(time(1.2 * P))  # of the weakest pads
    # the relaxed contact with the modulus of the first instant, 20 times that at rest
    a3 = jkr.contact_radius_at_force(3e-3, radius=R, contact_modulus=E, work_of_adhesion=w) ** 3
    strength = sqrt(8 * pi * E * a3 * 20 * w) - 4 * E * a3 / (3 * R)
    assert held_load(pad, 1e-9) == pytest.approx(strength, rel=0.01)
    assert time(0.95 * strength) > 0 and time(1.1 * strength) == 0
    # elastic pads under a growing interface creep above their force at rest
    elastic = vt.Elastic(rubbery_modulus=2e6, poisson_ratio=0.5)
    growing = vt.GentSchultz(w, 1e-7, reference_speed=1e-6, exponent=0.4)
    array = replace(array, pad=replace(pad, material=elastic, traction=growing))
    assert time(1e-3, array) == inf
    assert isnan(time(2e-3, array))
