"""The verification ladder of the forms of a material: relaxation, retardation, temperature."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import viscotack as vt
from solids import creep_power_law
from viscotack.model.materials.conversion import (
    PronyForm,
    prony_form,
    relaxation_form,
    relaxation_series,
    retardation_series,
    slowed,
)
from viscotack.model.materials.library import published
from viscotack.model.materials.passport import Evidence, Passport

E0 = 1.2e6
PDMS = published("pdms-10-1").material


# ---- rung 1: identities ------------------------------------------------------------------------
BRANCHES = st.lists(
    st.tuples(st.floats(3, 10), st.floats(-12, 4)),
    min_size=1,
    max_size=40,
    unique_by=lambda pair: round(pair[1], 1),
)


@given(BRANCHES)
@settings(max_examples=60, deadline=None)
def test_the_two_forms_are_one_solid_to_round_off(pairs):
    solid = vt.Prony(
        rubbery_modulus=E0, branches=[(10**E, 10**t) for E, t in pairs], poisson_ratio=0.45
    )
    elements = retardation_series(solid)
    back = relaxation_series(
        elements, glassy_modulus=solid.glassy_modulus, poisson_ratio=solid.poisson_ratio
    )
    # 1/E(w) in the retardation form
    omega = np.geomspace(1e-5, 1e13, 200)
    C, tau = np.array(elements).T
    creep = 1 / solid.glassy_modulus + (1 / (1 + 1j * omega[:, None] * tau)) @ C
    assert np.max(np.abs(creep * solid.complex_modulus(omega) - 1)) < 1e-13
    assert np.max(np.abs(back.complex_modulus(omega) / solid.complex_modulus(omega) - 1)) < 1e-14
    assert len(back.branches) == len(solid.branches)


@pytest.mark.parametrize("kind", [vt.RetardationPowerLaw, vt.RelaxationPowerLaw])
@pytest.mark.parametrize(("n", "tolerance"), [(0.2, 1e-6), (1.6, 1e-2)])
def test_the_error_of_a_prony_form_is_below_its_stated_bound(kind, n, tolerance):
    solid = kind(rubbery_modulus=E0, glassy_modulus=3e9, exponent=n, tau0=1e-3, poisson_ratio=0.5)
    form = prony_form(solid, frequencies=(1.0, 1e7), tolerance=tolerance)
    assert isinstance(form, PronyForm)
    # on a grid of its own
    omega = np.geomspace(1.0, 1e7, 1237)
    error = np.max(np.abs(form.material.complex_modulus(omega) / solid.complex_modulus(omega) - 1))
    assert error < 1.02 * form.error < 1.03 * tolerance
    assert form.material.rubbery_modulus == E0


def test_a_slower_solid_is_the_same_at_lower_frequencies():
    a, omega = 37.0, np.geomspace(1e-3, 1e6, 30)
    for solid in (PDMS, relaxation_form(slowed(_standard(), 2.0)), _standard()):
        np.testing.assert_allclose(
            slowed(solid, a).complex_modulus(omega), solid.complex_modulus(a * omega), rtol=1e-12
        )


def test_temperature_multiplies_times_by_the_shift_factor():
    passport = published("pdms-10-1")
    cold = passport.at_temperature(223.15)
    a = 10 ** float(passport.shift.log10_shift(223.15))
    assert passport.shift_factor(223.15) == pytest.approx(a, rel=1e-12, abs=0)
    assert cold.tau0 == pytest.approx(a * PDMS.tau0, rel=1e-12, abs=0)
    # there and back
    moved = passport.moved_to(223.15)
    assert moved.material == cold
    assert moved.at_temperature(293.15).tau0 == pytest.approx(PDMS.tau0, rel=1e-12, abs=0)
    assert moved.frequencies[0] == pytest.approx(passport.frequencies[0] / a, rel=1e-12, abs=0)


# ---- rung 4: the simulation is the judge -------------------------------------------------------
def test_a_prony_form_holds_as_hard_as_its_power_law():
    n, k, rate = 0.2207, 1.458 / 3089, 1e3
    solid = creep_power_law(1.0, 1 / k, n, 1.0, 0.0)
    series = prony_form(solid, frequencies=(1e-3, 1e3 * rate)).material
    # the same mesh and steps: what differs is the material
    force = [
        vt.pull_off_force(
            vt.solve(
                vt.Groups(tabor=3.24, material=material, start=vt.AtDepth(30), rate=rate),
                until="pull-off",
                accuracy=1e-2,
                estimate_error=False,
            )
        )
        for material in (solid, series)
    ]
    assert force[1] == pytest.approx(force[0], rel=1e-4, abs=0)


def _standard():
    return vt.StandardSolid(rubbery_modulus=E0, glassy_modulus=9e6, tau0=0.3, poisson_ratio=0.4)


def test_only_the_passport_of_a_liquid_is_refused_where_contacts_relax():
    solid = published("pdms-10-1")
    solid.refuse_liquid("no contact relaxes")
    said = "this is a liquid: at the slowest point it flows. It has no rubbery plateau"
    evidence = Evidence(numbers=40, constants=4, level=0.9, undetermined=(said,))
    melt = Passport(name="melt", material=solid.material, evidence=evidence)
    with pytest.raises(vt.InputError, match="melt has no rubbery plateau .*: no contact relaxes"):
        melt.refuse_liquid("no contact relaxes")


def test_a_prony_form_has_a_tolerance_between_0_and_1_and_ascending_frequencies():
    for wrong in (0.0, 1.0):
        with pytest.raises(vt.InputError, match="must lie between 0 and 1"):
            prony_form(PDMS, frequencies=(1.0, 10.0), tolerance=wrong)
    with pytest.raises(vt.InputError, match="must ascend, got 2 and 2 rad/s"):
        prony_form(PDMS, frequencies=(2.0, 2.0))
    solid = vt.StandardSolid(rubbery_modulus=E0, glassy_modulus=3 * E0, tau0=1.0, poisson_ratio=0.3)
    form = prony_form(solid, frequencies=(1.0, 2.0))
    assert form == PronyForm(material=relaxation_form(solid), error=0.0, frequencies=(1.0, 2.0))
    stiff = creep_power_law(E0, E0, 0.5, 1.0, 0.3)
    with pytest.raises(vt.InputError, match="does not relax"):
        prony_form(stiff, frequencies=(1.0, 2.0))
    with pytest.raises(vt.InputError, match="above the tolerance 1e-16"):
        prony_form(PDMS, frequencies=(1.0, 2.0), tolerance=1e-16)
