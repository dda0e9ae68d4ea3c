"""The advisor, and the commands that answer at once."""

import json
from dataclasses import replace

import numpy as np
import pytest

import viscotack as vt
from command_line import exit_status
from solids import creep_power_law
from stated import lens
from viscotack.model.traction import effective_range
from viscotack.theory import tabulated_modulus


def groups(rate, *, tabor=3.24, modulus_ratio=0.1, exponent=0.8, start=None):
    material = creep_power_law(1.0, 1 / modulus_ratio, exponent, 1.0, 0.0)
    return vt.Groups(tabor=tabor, material=material, start=start or vt.AtDepth(73.0), rate=rate)


def estimate(advice, tier):
    return next(e for e in advice.estimates if e.tier == tier)


@pytest.mark.parametrize(
    ("rate", "regime", "use"),
    [
        (1e-4, "quasi-static", "surrogate"),
        (1.0, "rate-dependent", "surrogate"),
        (316.23, "rate-dependent", "surrogate"),
        (1e6, "glassy", "surrogate"),
    ],
)
def test_the_regime_follows_the_rate(rate, regime, use):
    advice = vt.advise(groups(rate))
    assert (advice.rate_regime, advice.use, advice.adhesion) == (regime, use, "jkr")
    assert estimate(advice, "simulation").applies
    # of a sphere of the radius R/k and the modulus E/k
    assert advice.glassy_tabor == pytest.approx((0.1**-1 * 0.1**2) ** (1 / 3) * 3.24)


def assert_as_good_as_stated(case, advice):
    """Compare what is said to apply with a simulation, which is good to half a per cent."""
    force = vt.pull_off_force(vt.solve(case, accuracy=5e-3, until="pull-off", estimate_error=False))
    found = [e for e in advice.estimates if e.applies and e.pull_off_force is not None]
    assert found
    for e in found:
        assert e.pull_off_force == pytest.approx(force, rel=e.error + 5e-3, abs=0), e.tier


@pytest.mark.parametrize(
    ("rate", "tabor", "exponent"),
    [(1e-3, 3.24, 0.8), (1.0, 1.0, 0.8), (1e6, 5.0, 1.6)],
)
def test_what_is_said_to_apply_is_as_good_as_it_is_said_to_be(rate, tabor, exponent):
    case = groups(rate, tabor=tabor, exponent=exponent)
    assert_as_good_as_stated(case, vt.advise(case))


def test_the_speed_of_the_edge_is_that_of_a_simulation():
    case = groups(1e3).in_si(
        radius=5e-3, contact_modulus=2e6, work_of_adhesion=0.15, time_unit=0.1, poisson_ratio=0.5
    )
    result = vt.solve(case, accuracy=5e-3, until="pull-off", estimate_error=False)
    speed = vt.crack_speed_at_pull_off(result) * case.scales().edge_speed
    assert vt.advise(case).crack_speed_at_pull_off_m_per_s == pytest.approx(speed, rel=0.25, abs=0)


def test_a_start_too_light_for_the_rate_has_no_state_at_pull_off():
    light = estimate(vt.advise(groups(1e4, start=vt.AtRadius(1.7))), "detachment")
    assert not light.applies and light.pull_off_force is None
    long = estimate(vt.advise(groups(1e4, tabor=0.5, start=vt.AtRadius(6.0))), "detachment")
    assert not long.applies and long.pull_off_force is not None


def test_adhesion_regime_follows_the_tabor_number():
    found = [
        vt.advise(groups(1.0, tabor=mu, start=vt.AtForce(1.0))).adhesion for mu in (0.05, 1, 9)
    ]
    assert found == ["dmt", "transition", "jkr"]


@pytest.mark.parametrize(
    ("rate", "exponent", "radius", "preload"),
    [
        (100.0, 0.8, 1.5, "raises"),
        (100.0, 0.8, 2.4, "lowers"),
        (1e4, 1.6, 6.0, "same"),
    ],
)
def test_pressing_harder_does_what_is_said(rate, exponent, radius, preload):
    cases = [groups(rate, exponent=exponent, start=vt.AtRadius(x)) for x in (radius, 2 * radius)]
    light, heavy = (
        vt.pull_off_force(vt.solve(c, accuracy=5e-3, until="pull-off", estimate_error=False))
        for c in cases
    )
    advice = vt.advise(cases[0])
    assert advice.preload == preload and advice.preload_change is not None
    low, high = advice.preload_change
    # each of the two simulations is good to half a per cent
    assert low - 0.01 <= heavy / light - 1 <= high + 0.01


# A hand-made table: a wall, a peak, a tail that ends.
TABLE = vt.Tabulated.of_points(
    [0.8, 1.0, 1.2, 1.5, 2.5, 4.0], [-4.0, 0.0, 1.0, 0.8, 0.1, 0.0]
).reduced()
LAWS = {
    "exponential 0.25": vt.Exponential(1.0, 1.0, 0.25),
    "exponential 1": vt.Exponential(1.0, 1.0, 1.0),
    "dugdale": vt.Dugdale(1.0, 1.0),
    "table": TABLE,
}


@pytest.mark.parametrize(
    ("law", "effective_tabor", "rate"),
    [
        ("exponential 0.25", 0.3, 0.01),
        ("exponential 1", 5.0, 1e4),
        ("dugdale", 0.3, 0.01),
        ("table", 1.5, 1.0),
    ],
)
def test_every_law_gets_advice_as_good_as_it_is_said_to_be(law, effective_tabor, rate):
    length = effective_range(LAWS[law])
    case = replace(
        groups(
            rate * length,
            tabor=effective_tabor * length,
            start=vt.AtRadius(3.6 if effective_tabor > 1 else 2.0),
        ),
        traction=LAWS[law],
    )
    advice = vt.advise(case)
    assert advice.effective_tabor == pytest.approx(case.effective_tabor, rel=1e-12, abs=0)
    assert_as_good_as_stated(case, advice)


def test_in_si_speed_and_strain_are_judged():
    slow, fast = vt.advise(lens(speed=1e-7)), vt.advise(lens(speed=1e-3))
    assert not slow.beyond_linear and fast.beyond_linear
    assert slow.crack_speed_at_pull_off_m_per_s < 1e-4 < fast.crack_speed_at_pull_off_m_per_s
    assert slow.small_strain and slow.strain == pytest.approx(0.075, rel=0.2, abs=0)
    assert len(fast.statements) > len(slow.statements)
    dimensionless = vt.advise(lens(speed=1e-3).groups())
    assert dimensionless.crack_speed_at_pull_off_m_per_s is None and dimensionless.strain is None
    assert dimensionless.amplification == pytest.approx(fast.amplification, rel=1e-9, abs=0)


# The command line -----------------------------------------------------------------------------
MODULUS = "frequency_Hz,storage_MPa,loss_kPa\n0.1,1.01,30\n1,1.1,200\n10,2,900\n100,4,3000\n"


@pytest.mark.parametrize(
    ("name", "function"),
    [
        ("persson-brener", tabulated_modulus.amplification),
        ("greenwood", tabulated_modulus.greenwood_amplification),
    ],
)
def test_theory_of_the_crack_takes_a_measured_modulus(name, function, tmp_path, capsys):
    file, picture = tmp_path / "dma.csv", tmp_path / "crack.png"
    file.write_text(MODULUS)
    law = ["theory", name, "--modulus-table", file, "--rubbery-modulus", "1 MPa"]
    assert exit_status([*law, "--speed", "2", "--speed", "20", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    frequency = tuple(2 * np.pi * np.array([0.1, 1, 10, 100]))
    loss = (30e3, 200e3, 900e3, 3e6)
    modulus = tabulated_modulus.TabulatedModulus(1e6, frequency, (1.01e6, 1.1e6, 2e6, 4e6), loss)
    low, high = function([2.0, 20.0], modulus=modulus)
    assert found == {
        "speed": [2, 20],
        "amplification_low": pytest.approx(low, rel=1e-12, abs=0),
        "amplification_high": pytest.approx(high, rel=1e-12, abs=0),
    }
    assert exit_status([*law, "--plot", picture]) == 0
    assert picture.stat().st_size > 1000
    file.write_text(
        "T,f,E',E''\nC,Hz,MPa,MPa\n-20,1,4,3\n0,1,2,0.9\n20,1,1.1,0.2\n40,1,1.01,0.03\n"
    )
    assert exit_status(law) == 2
    assert "--modulus-table" in capsys.readouterr().err
