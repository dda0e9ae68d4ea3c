"""Cautions on predictions: tests at one rate, frequencies that were not measured, fast edges."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

import viscotack as vt
from command_line import exit_status
from stated import LAW, case_text
from viscotack.model.materials.library import published
from viscotack.model.materials.passport import Evidence, Passport
from viscotack.model.materials.passport_file import write_passport
from viscotack.model.materials.shift import Arrhenius
from viscotack.prediction.cautions import cautions_on
from viscotack.theory import SteadyCrack

RUBBER = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=10e6, tau0=0.01, poisson_ratio=0.5)
# Speed of the machine: the edge stays below 100 um/s.
SLOW = 2e-6


def case_of(passport, speed):
    law = LAW.replace("1 um", "200 nm")
    protocol = f'preload_force = "0.5 mN"\nspeed = "{speed}"'
    return case_text(f'passport = "{passport}"', law=law, protocol=protocol)


def lens(speed=SLOW):
    return vt.Problem(
        material=RUBBER,
        traction=vt.LennardJones(work_of_adhesion=0.05, equilibrium_gap=200e-9),
        geometry=vt.Sphere(radius=1e-3),
        protocol=vt.Retraction(start=vt.AtForce(0.5e-3), speed=speed),
    )


def measured(low, high, **more):
    """Return a passport measured between two frequencies [Hz]."""
    frequencies = (2 * np.pi * low, 2 * np.pi * high)
    return Passport(name="rubber", material=RUBBER, frequencies=frequencies, **more)


def stated(words):
    """Return the frequency [Hz] in the caution on measured frequencies."""
    number, unit = re.search(r"excites the material at about (\S+) (\w+);", words).groups()
    return float(number) * {"mHz": 1e-3, "Hz": 1.0, "kHz": 1e3}[unit]


def test_the_frequency_is_the_speed_of_the_simulated_edge_over_its_zone():
    problem = lens()
    run = vt.solve(problem, until="pull-off", accuracy=0.01, estimate_error=False)
    speed = vt.summary(run)["crack_speed_at_pull_off_m_per_s"]
    # lambda = E0* h0^2/dg; the zone of a slow crack is 0.75 of it
    unit = 1e6 / 0.75 * 200e-9**2 / 0.05
    crack = SteadyCrack(RUBBER, vt.LennardJones(1.0, 1.0))
    energy = float(crack.amplification(speed * 0.01 / unit))
    expected = speed / (0.75 * unit * energy)
    (words,) = cautions_on(problem, passport=measured(1e-6, 1e-5))
    assert stated(words) == pytest.approx(expected, rel=0.15)
    assert "'rubber' was measured from" in words


def test_frequencies_inside_the_measured_range_have_no_caution():
    (words,) = cautions_on(lens(), passport=measured(1e-6, 1e-5))
    here = stated(words)
    assert cautions_on(lens(), passport=measured(here / 1.1, here * 1.1)) == ()
    assert cautions_on(lens(), passport=measured(here * 1.1, here * 10))
    assert cautions_on(lens()) == ()
    assert cautions_on(lens(), passport=replace(measured(1, 2), frequencies=None)) == ()


def test_a_fast_edge_is_faster_than_linear_theory_holds():
    (words,) = cautions_on(lens(1e-3))
    assert "Above 100 um/s" in words and words in vt.advise(lens(1e-3)).sentences
    assert cautions_on(lens(1e-3).groups()) == ()


def test_every_command_has_the_cautions(tmp_path, capsys):
    case = tmp_path / "case.toml"
    case.write_text(case_of("vhb-4910", "10 um/s"))
    found = cautions_on(vt.read_case(case), passport=published("vhb-4910"))
    assert found
    for command in ("predict", "advise"):
        assert exit_status([command, str(case), "--json"]) == 0
        assert json.loads(capsys.readouterr().out)["cautions"] == list(found)


def test_the_uncertainty_of_a_measured_material_is_not_in_the_interval(tmp_path):
    problem = lens()
    evidence = Evidence(
        numbers=20, constants=3, level=0.9, intervals=(("rubbery_modulus", 0.9e6, 1.1e6),)
    )
    known = Passport(name="rubber", material=RUBBER, evidence=evidence)
    assert len(vt.predict(problem, passport=known).cautions) == 1
    assert vt.predict(problem, passport=measured(1e-6, 1e3)).cautions == ()
    write_passport(known, tmp_path / "rubber.toml")
    case = tmp_path / "case.toml"
    case.write_text(case_of("rubber.toml", "2 um/s"))
    wide = vt.ask("uncertainty", problem=case, passport=tmp_path / "rubber.toml", samples=32)
    low, high = vt.predict(problem).interval
    least, most = wide.record()["interval"]
    assert most / least > high / low


def test_a_temperature_moves_the_measured_range(tmp_path):
    shift = Arrhenius(293.15, 1e5)
    own = measured(1.0, 10.0, temperature=293.15, shift=shift)
    write_passport(own, tmp_path / "rubber.toml")
    case = tmp_path / "case.toml"
    case.write_text(case_of("rubber.toml", "2 um/s"))
    cold = vt.ask("predict", problem={"case": str(case), "temperature": "0 degC"}).record()
    a = float(10 ** shift.log10_shift(273.15))
    (words,) = cold["cautions"]
    assert f"to {10e3 / a:.3g} mHz" in words
