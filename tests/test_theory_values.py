"""Rates, bounds and empirical laws: verified values, row by row."""

import numpy as np
import pytest

from reference_data import reference
from viscotack.theory import bounds, lennard_jones, persson_brener, rate
from viscotack.theory.crack import law as crack_law

# scales in which those of Eq. 4.16 are 1: pi w = E* = R = 1
UNIT = dict(radius=1.0, contact_modulus=1.0, work_of_adhesion=1 / np.pi)


@pytest.mark.parametrize("row", reference("43", "4/(3k)"))
def test_glassy_estimates_give_the_verified_value(row):
    inputs = row["inputs"]
    if row["equation"] == "43":
        # in 1.5 pi R w h0 = 1.5 h0, with mu pi^(2/3) h0 = 1
        work = bounds.glassy_work_estimate(inputs["a_po_hat"], **UNIT)
        found = work / 1.5 * inputs["mu"] * np.pi ** (2 / 3)
    else:
        rigid = UNIT | dict(equilibrium_gap=1e6, modulus_ratio=inputs["k"])
        found = bounds.glassy_force(**rigid) / 1.5
    assert found == pytest.approx(row["value"], rel=1e-9, abs=0)


@pytest.mark.parametrize(
    "row", reference("glassy exact (derived)", "glassy finite preload (derived)")
)
def test_the_fast_limit_of_jkr_gives_the_verified_value(row):
    inputs, note = row["inputs"], row["note"]
    k = dict(modulus_ratio=inputs["k"])
    if "a_po_hat" in note:
        found = bounds.smallest_full_radius(**UNIT, **k)
    elif "work" in note:
        # a gap so short that the rest, of the order ln(mu)/mu^1.5, is round-off
        work = bounds.glassy_work(**UNIT, equilibrium_gap=1e-12, **k)
        found = work / 1.5
    else:
        found = bounds.glassy_force_at_radius(inputs["a0_hat"], **UNIT, **k)
    assert found == pytest.approx(row["value"], rel=1e-9, abs=0)


@pytest.mark.parametrize("row", reference("4.24", "4.28", "0.3 a^2.7=1.5/k"))
def test_the_fits_give_the_verified_value(row):
    inputs = row["inputs"]
    if row["equation"] == "4.24":
        found = rate.crack_speed(inputs["r_PB"], tabor=3.24)
    elif row["equation"] == "4.28":
        found = crack_law.gent_schultz(
            inputs["v_um_s"], reference_speed=inputs["v0"], exponent=inputs["xi"]
        )
    else:
        found = bounds.threshold_contact_radius(1.5 / inputs["k"], **UNIT)
    assert found == pytest.approx(row["value"], rel=1e-12, abs=0)


@pytest.mark.parametrize("row", reference("4.24 note"))
def test_the_hidden_group_of_the_printed_rate_gives_the_verified_value(row):
    # h0/l0 = Q sqrt(h0/R): R = E* = w = 1 and h0 = 1/mu
    mu = row["inputs"]["mu"]
    h0 = lennard_jones.tabor_number(
        radius=1.0, contact_modulus=1.0, work_of_adhesion=1.0, equilibrium_gap=mu
    )
    l0 = persson_brener.crack_tip_length(
        contact_modulus=1.0,
        work_of_adhesion=1.0,
        strength=16 / (9 * np.sqrt(3)) / (1 / mu),
        strength_ratio=np.pi / 9,
    )
    assert h0 == pytest.approx(1 / mu, rel=1e-12, abs=0)
    # a speed of h0 per time unit
    found = rate.rate_in_tip_lengths(1 / mu, time_unit=1.0, tip_length=l0) / np.sqrt(1 / mu)
    assert found == pytest.approx(row["value"], rel=1e-12, abs=0)
