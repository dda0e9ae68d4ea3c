"""The ladder of the flat punch on an elastic layer: identities, and limits with exponents."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import jv

from dimensionless import last_slope
from viscotack.theory import greenwood, punch
from viscotack.theory.punch import Bonded, Frictionless, Pad, crossover

# A 2 mm pad of soft rubber, strong enough for b0 << b1.
LAYER = dict(contact_modulus=1.3e6, work_of_adhesion=0.08)
PAD = dict(LAYER, half_width=1e-3)
FREE = Frictionless()
STRONG = Pad(**PAD, strength=9e4, base=FREE)
BASES = [FREE, Bonded(poisson_ratio=0.0), Bonded(poisson_ratio=0.45)]
bases = pytest.mark.parametrize("base", BASES, ids=["free", "nu=0", "nu=0.45"])


def without_energy(case):
    return {name: value for name, value in case.items() if name != "work_of_adhesion"}


# Closed forms ---------------------------------------------------------------------------------
@bases
def test_thin_layer_comes_off_where_its_elastic_energy_pays(base):
    # the energy under the punch, over a length, is a E* delta^2 / (c b); half its slope by a is w
    b = np.array([1e-6, 1e-5])
    depth = punch.thin_layer_depth_at_pull_off(b, **LAYER, base=base)
    stress = punch.thin_layer_pull_off_stress(b, **LAYER, base=base)
    stiffness = LAYER["contact_modulus"] / (base.foundation * b)
    np.testing.assert_allclose(stiffness * depth**2 / 2, LAYER["work_of_adhesion"], rtol=1e-14)
    np.testing.assert_allclose(stress, -stiffness * depth, rtol=1e-14)


@pytest.mark.parametrize("nu", [0.0, 0.2, 0.3, 0.45])
def test_bonded_layer_is_stiffer_by_the_factor_of_appendix_one(nu):
    base = Bonded(poisson_ratio=nu)
    zeta = (1 - nu) ** 2 / (1 - 2 * nu)
    assert punch.stiffening(base) == pytest.approx(zeta, rel=1e-15, abs=0)
    # from the first terms of the transfer function
    t = 1e-4
    assert 2 * base.transfer(t) / t == pytest.approx(1 / zeta, rel=1e-6, abs=0)
    assert 2 * FREE.transfer(t) / t == pytest.approx(FREE.foundation, rel=1e-6, abs=0)
    ratio = punch.thin_layer_pull_off_stress(1e-5, **LAYER, base=base)
    ratio /= punch.thin_layer_pull_off_stress(1e-5, **LAYER, base=FREE)
    assert ratio == pytest.approx(np.sqrt(zeta), rel=1e-15, abs=0)


def test_fracture_length_is_twice_the_cohesive_zone():
    case = dict(LAYER, strength=9e4)
    zone = greenwood.cohesive_zone_length(**case)
    assert punch.fracture_length(**case) == pytest.approx(2 * zone, rel=1e-15, abs=0)
    # where a punch on a half-plane reaches its strength
    a0 = STRONG.fracture_length
    assert a0 == punch.fracture_length(**case)
    assert punch.half_plane_pull_off_stress(a0, **LAYER) == pytest.approx(9e4, rel=1e-15, abs=0)


@bases
def test_envelope_follows_the_regime_it_names(base):
    pad = replace(STRONG, base=base)
    b0, _, b1 = punch.regime_thicknesses(pad, modulus_ratio=1.0)
    b = np.array([b0 / 3, b0 * 1.5, b1 / 1.5, b1 * 3])
    words = punch.regime(b, pad)
    assert words.tolist() == ["cohesive", "thin layer", "thin layer", "half-plane"]
    expected = [
        9e4,
        *punch.thin_layer_pull_off_stress(b[1:3], **LAYER, base=base),
        punch.half_plane_pull_off_stress(PAD["half_width"], **LAYER),
    ]
    found = punch.pull_off_stress(b, pad)
    np.testing.assert_allclose(found, expected, rtol=1e-14)


def test_thin_layer_law_warns_of_a_layer_near_incompressible_and_refuses_one():
    with pytest.warns(UserWarning, match="0.45"):
        punch.thin_layer_pull_off_stress(1e-5, **LAYER, base=Bonded(poisson_ratio=0.47))
    with pytest.raises(ValueError, match="only by sideways flow"):
        punch.thin_layer_pull_off_stress(1e-5, **LAYER, base=Bonded(poisson_ratio=0.5))
    with pytest.raises(ValueError, match="at most 0.49"):
        crossover.pull_off_stress(1e-5, **PAD, base=Bonded(poisson_ratio=0.5))
    with pytest.raises(ValueError, match="between 0 and 0.5"):
        Bonded(poisson_ratio=0.6)


# The exact curve ------------------------------------------------------------------------------
@bases
def test_energy_released_is_the_slope_of_the_stiffness(base):
    # the stiffness from the force, the energy from the stress intensity at the edges:
    # G = (1/4) delta^2 d(E* S)/da at a fixed depth
    case = without_energy(PAD)
    depth, step = -2e-6, 1e-3
    for b in PAD["half_width"] * np.array([0.05, 0.11, 0.4, 1.0, 4 / np.pi, 3.0, 20.0]):
        a = PAD["half_width"] * np.exp(step * np.array([-2.0, -1, 1, 2]))
        S = crossover.stiffness(b, **case | dict(half_width=a), base=base)
        change = S @ np.array([1.0, -8, 8, -1]) / (12 * step) / PAD["half_width"]
        found = crossover.energy_release_rate(depth, thickness=b, **case, base=base)
        # difference quotient of fourth order, beside round-off over the step
        assert found == pytest.approx(depth**2 * change / 4, rel=2e-9, abs=0)


@bases
def test_pull_off_is_where_the_energy_released_pays_for_the_interface(base):
    b = np.geomspace(1e-6, 1.0, 25)
    depth = crossover.depth_at_pull_off(b, **PAD, base=base)
    stress = crossover.pull_off_stress(b, **PAD, base=base)
    case = without_energy(PAD)
    G = crossover.energy_release_rate(depth, thickness=b, **case, base=base)
    np.testing.assert_allclose(G, 0.08, rtol=1e-12)
    S = crossover.stiffness(b, **case, base=base)
    np.testing.assert_allclose(2e-3 * stress, -S * depth, rtol=1e-12)
    # half force times depth, over the area
    work = crossover.work_of_separation(b, half_width=1e-3, work_of_adhesion=0.08, base=base)
    np.testing.assert_allclose(work, -stress * depth / 2, rtol=1e-12)
    assert np.all(np.diff(stress) < 0)


@bases
@pytest.mark.parametrize("ratio", [0.3, 2.5])
def test_stiffness_equals_the_plain_twin(base, ratio):
    # Galerkin in T_2n / sqrt(1 - t^2) with the Fourier integral of the kernel taken literally,
    # its tail 1/(pi u^2) beyond the last point added
    panels, last, orders = 300, 600.0, 2 * np.arange(14)
    nodes, weights = np.polynomial.legendre.leggauss(16)
    width = last / panels
    u = (np.arange(panels)[:, None] * width + width / 2 * (nodes + 1)).ravel()
    weight = np.tile(width / 2 * weights, panels)
    J = np.array([(-1.0) ** (n // 2) * jv(n, u) for n in orders])
    system = 2 * np.pi * ((J * (weight * base.transfer(u / ratio) / u)) @ J.T + 1 / (np.pi * last))
    S = np.pi * np.linalg.solve(system, np.pi * (orders == 0))[0]
    case = dict(half_width=ratio * 1e-3, contact_modulus=1.0)
    found = crossover.stiffness(1e-3, **case, base=base)
    assert found == pytest.approx(S, rel=3e-5, abs=0)


def test_thin_layer_tends_to_its_closed_form_in_proportion_to_its_thickness():
    b = 1e-3 * np.array([0.1, 1e-2, 1e-3])
    exact = crossover.pull_off_stress(b, **PAD, base=FREE)
    excess = exact / punch.thin_layer_pull_off_stress(b, **LAYER, base=FREE) - 1
    assert last_slope(b, excess) == pytest.approx(1, abs=1e-3)
    np.testing.assert_allclose(excess / (b / 1e-3), 0.177131575829, rtol=1e-8)
    depth = crossover.depth_at_pull_off(b, **PAD, base=FREE)
    np.testing.assert_allclose(
        depth, punch.thin_layer_depth_at_pull_off(b, **LAYER, base=FREE), rtol=1e-12
    )


@bases
def test_thick_layer_tends_to_the_half_plane_with_the_square_of_its_thickness(base):
    b = 1e-3 * np.array([1e2, 1e3, 1e4])
    exact = crossover.pull_off_stress(b, **PAD, base=base)
    excess = exact / punch.half_plane_pull_off_stress(1e-3, **LAYER) - 1
    assert last_slope(b, excess) == pytest.approx(-2, abs=2e-3)
    # 1/S grows with (2/pi) ln(b/a)
    case = without_energy(PAD) | dict(contact_modulus=1.0)
    compliance = 1 / crossover.stiffness(b, **case, base=base)
    np.testing.assert_allclose(np.diff(compliance), 2 / np.pi * np.log(10), rtol=1e-4)


@bases
def test_thickness_is_the_inverse_of_the_stress(base):
    b = np.geomspace(1e-6, 3e-2, 23)
    stress = crossover.pull_off_stress(b, **PAD, base=base)
    found = crossover.thickness(stress, **PAD, base=base)
    # a thick layer hardly matters
    excess = stress / punch.half_plane_pull_off_stress(1e-3, **LAYER) - 1
    assert np.all(np.abs(found / b - 1) * np.minimum(excess, 1) < 1e-11)
