"""A disc: Kendall, the strength of its interface, and what simulations have between them."""

import numpy as np
import pytest

import viscotack as vt
from viscotack.simulate.settings import Settings
from viscotack.simulate.solver import contact_of
from viscotack.theory import disc, profiles
from viscotack.theory.elastic import indenter

ELASTIC = vt.Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
RELAXING = vt.StandardSolid(rubbery_modulus=1.0, glassy_modulus=10.0, tau0=1.0, poisson_ratio=0.0)
SOLID = {"contact_modulus": 1e6, "work_of_adhesion": 0.05}
# Kendall's force in 1.5 pi R dg0, R = a sqrt(a E0*/dg0).
KENDALL = np.sqrt(8 * np.pi) / (1.5 * np.pi)
DUGDALE = vt.Dugdale(1.0, 1.0)
ROUNDED = vt.Disc(1.0, edge_width=0.1, edge_height=0.2)


def groups(tabor=4.0, **others):
    parts = {"material": ELASTIC, "start": vt.AtDepth(0.0), "rate": 1.0, "geometry": vt.Disc(1.0)}
    return vt.Groups(tabor=tabor, **parts | others)


def pulled(case, accuracy=1e-2):
    """Return the pull-off force over Kendall's."""
    found = vt.solve(case, until="pull-off", accuracy=accuracy, estimate_error=False)
    return found.pull_off_force / KENDALL


# --- 1 identity -----------------------------------------------------------------------------------
def test_the_most_a_disc_bears_is_the_smaller_limit():
    a = disc.crossover_radius(**SOLID, strength=50e3)
    kendall = disc.pull_off_force(contact_radius=a, **SOLID)
    assert kendall == pytest.approx(disc.strength_limit(contact_radius=a, strength=50e3))
    assert kendall == -profiles.punch_pull_off(contact_radius=a, **SOLID).force
    for radius in (0.1 * a, 10 * a):
        both = disc.pull_off_force(contact_radius=radius, **SOLID, strength=50e3)
        uniform = disc.strength_limit(contact_radius=radius, strength=50e3)
        kendall = disc.pull_off_force(contact_radius=radius, **SOLID)
        assert both == min(uniform, kendall)


def test_the_groups_of_a_disc_have_its_radius_for_their_length():
    solid = vt.Elastic(rubbery_modulus=0.75e6, poisson_ratio=0.5)
    law = vt.LennardJones(0.05, 1e-6)
    stamp = vt.Disc(1e-3, edge_width=50e-6, edge_height=20e-6)
    problem = vt.Problem(solid, law, stamp, vt.Retraction(vt.AtForce(0.0), 1e-5))
    E = solid.contact_modulus
    made = problem.groups()
    assert made.tabor == pytest.approx(np.sqrt(1e-3 * 0.05 / E) / 1e-6, rel=1e-12)
    assert isinstance(made.geometry, vt.Disc)
    assert made.geometry.radius == 1 and made.geometry.edge_width == pytest.approx(0.05)
    kendall = disc.pull_off_force(contact_radius=1e-3, contact_modulus=E, work_of_adhesion=0.05)
    assert kendall / problem.scales().force == pytest.approx(KENDALL, rel=1e-12)
    back = made.in_si(
        radius=problem.radius,
        contact_modulus=E,
        equilibrium_gap=1e-6,
        time_unit=1.0,
        poisson_ratio=0.5,
    )
    assert isinstance(back.geometry, vt.Disc)
    assert back.geometry.edge_height == pytest.approx(20e-6, rel=1e-9)
    assert back.geometry.radius == pytest.approx(1e-3, rel=1e-9)


def test_a_disc_answers_with_its_stiffness():
    # P = 2 E* a depth: P/(1.5 pi R dg0) = 2 depth/(1.5 pi mu) with R dg0 = E* a^2 eta
    contact = contact_of(groups(8.0, traction=DUGDALE))
    settings = Settings.for_accuracy(1e-3)
    forces = [contact.relaxed(vt.AtDepth(depth), settings).force for depth in (20.0, 60.0)]
    assert np.diff(forces)[0] == pytest.approx(2 * 40.0 / (1.5 * np.pi * 8.0), rel=2e-3)


# --- 2 limit --------------------------------------------------------------------------------------
def test_a_small_disc_comes_off_at_the_strength_of_its_interface():
    # pi a^2 sigma0 over 1.5 pi R dg0 is mu/1.5 for sigma0 = dg0/h0
    tabor = 0.05
    found = pulled(groups(tabor, traction=DUGDALE)) * KENDALL
    assert found == pytest.approx(tabor / 1.5, rel=1e-6)


def test_a_disc_with_a_short_range_pulls_off_like_kendall():
    # the zone at the edge is of the order of 1/mu^2
    found = [pulled(groups(tabor, traction=DUGDALE)) for tabor in (4.0, 8.0)]
    assert found == pytest.approx([0.9728, 0.9927], abs=3e-3)
    assert (4 * found[1] - found[0]) / 3 == pytest.approx(1.0, abs=5e-3)


def test_a_rounded_edge_pulls_like_its_own_jkr_contact():
    a = np.linspace(0.85, 1.0, 3001)
    force = indenter.force(a, shape=ROUNDED, contact_modulus=1.0, work_of_adhesion=1.0)
    theory = -np.min(force) / np.sqrt(8 * np.pi)
    found = [pulled(groups(tabor, geometry=ROUNDED)) for tabor in (8.0, 16.0)]
    assert 0.85 < theory < 0.86
    assert (4 * found[1] - found[0]) / 3 == pytest.approx(theory, rel=5e-3)


# --- the simulation -------------------------------------------------------------------------------
def test_a_relaxing_solid_holds_a_disc_harder_and_accounts_for_its_energy():
    result = vt.solve(groups(material=RELAXING, rate=2.0), accuracy=1e-2)
    assert 1.1 < result.pull_off_force / KENDALL < 2.0
    assert result.energy_residual is not None and result.energy_residual < 1e-3
    start = result.contact_radius[0] * np.pi ** (1 / 3)
    assert start == pytest.approx(1.0, abs=1e-9) and np.all(result.contact_radius[:5] > 0)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: vt.Disc(1e-3, edge_width=1e-5), "has a width, up to the radius, and a height"),
        (lambda: vt.solve(groups(start=vt.AtRadius(0.5))), "start it at a depth or a force"),
        (lambda: vt.crack_contact(groups()), "rise ever more steeply"),
        (lambda: vt.solve(groups(300.0)), "Tabor number"),
    ],
)
def test_what_a_disc_is_not_is_refused(make, words):
    with pytest.raises(vt.InputError, match=words):
        make()
