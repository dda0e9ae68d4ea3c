"""A sphere on a layer: JKR by two independent ways, its limits, and simulations that tend to it."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import viscotack as vt
from dimensionless import ELASTIC, SOLID
from viscotack.model.geometry import Bonded, Cone, Frictionless, Layer, Sphere
from viscotack.theory.elastic import indenter, on_body, on_layer

pytestmark = pytest.mark.march

BASES = [Frictionless(), *(Bonded(poisson_ratio=nu) for nu in (0.0, 0.3, 0.5))]
SQUEEZED = Bonded(poisson_ratio=0.5)
UNITS = {"contact_modulus": 1.0, "work_of_adhesion": 1.0}
RADII = np.geomspace(0.05, 5.0, 6)


def pull_off(layer):
    """Find the pull-off force of JKR [pi R dg]."""

    def force(x):
        return indenter.force(np.exp(x), shape=Sphere(1.0), body=layer, **UNITS)

    x = np.linspace(-4.0, 1.0, 101)
    least = int(np.argmin([force(each) for each in x]))
    found = minimize_scalar(force, bracket=(x[least - 1], x[least], x[least + 1]))
    return -found.fun / np.pi


def on(layer, tabor, accuracy=2e-3, **more):
    given = dict(material=ELASTIC, start=vt.AtForce(1.0), rate=1.0) | more
    groups = vt.Groups(tabor, body=layer, **given)
    result = vt.solve(groups, until="pull-off", accuracy=accuracy, estimate_error=False)
    assert abs(result.energy_residual) < 1e-3
    return vt.pull_off_force(result)


# --- JKR on a layer -------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("base", "shape"), [*((base, Sphere(1.0)) for base in BASES), (BASES[2], Cone(1.0))], ids=repr
)
def test_the_integral_equation_and_the_influence_matrix_agree(base, shape):
    of = RADII, shape, Layer(0.4, base)
    assert on_body.bare_depth(*of) == pytest.approx(on_layer.bare_depth(*of), rel=5e-4)
    assert on_body.drawn(*of, 1.0) == pytest.approx(on_layer.drawn(*of, 1.0), rel=5e-4)
    force, size = on_layer.force(*of, 1.0), on_layer.force(*of, 0.0)
    assert np.max(np.abs(on_body.force(*of, 1.0) - force) / (size + abs(force))) < 5e-4


@pytest.mark.parametrize("base", BASES, ids=repr)
def test_the_pull_off_at_a_radius_is_that_of_the_work_of_adhesion_which_has_it(base):
    layer = Layer(0.4, base)
    radius = np.linspace(0.5, 1.5, 4001)
    force = on_layer.force(radius, Sphere(1.0), layer, 1.0)
    least = int(np.argmin(force))
    found = on_layer.relaxed_pull_off(radius[least], Sphere(1.0), layer)
    assert found == pytest.approx(-force[least], rel=1e-3)


@pytest.mark.parametrize("base", BASES, ids=repr)
def test_the_gap_around_a_contact_is_that_of_the_influence_matrix(base):
    layer, r = Layer(0.4, base), np.linspace(1.3, 6.0, 60)
    depth = float(indenter.depth(1.2, shape=Sphere(1.0), body=layer, **UNITS))
    found = on_layer.gap(r, 1.2, depth, Sphere(1.0), layer)
    assert found == pytest.approx(on_body.gap(r, 1.2, depth, Sphere(1.0), layer), abs=2e-4)


# --- simulations ----------------------------------------------------------------------------------
@pytest.mark.parametrize("solid", [ELASTIC, SOLID], ids=["elastic", "relaxing"])
def test_a_simulation_on_a_thick_layer_is_that_on_a_half_space(solid):
    test = dict(material=solid, rate=10.0, start=vt.AtForce(1.0))
    thick = on(Layer(3e4, SQUEEZED), 1.0, **test)
    assert thick == pytest.approx(on(vt.HalfSpace(), 1.0, **test), rel=1e-4)


@pytest.mark.slow
def test_simulations_tend_to_jkr_on_the_layer_as_the_tabor_number_grows():
    layer = Layer(0.5, SQUEEZED)
    coarse, fine = on(layer, 8.0), on(layer, 16.0)
    limit = fine + (fine - coarse) / 3  # of second order in the Tabor number
    assert 1.5 * limit == pytest.approx(pull_off(layer), rel=1e-2)


@pytest.mark.parametrize("base", [BASES[0], SQUEEZED], ids=repr)
def test_a_thin_layer_at_a_moderate_tabor_number_conserves_its_energy(base):
    force = on(Layer(0.05, base), 4.0, accuracy=1e-2)
    assert 0.9 < force < 1.5 * 2


@pytest.mark.parametrize(
    "start", [vt.AtDepth(3.0), vt.AtForce(0.5), vt.AtRadius(1.1), vt.Apart(10.0)]
)
def test_every_start_is_found_on_a_layer(start):
    more = {"moves": (vt.Approach(1.0, vt.AtDepth(3.0)),)} if isinstance(start, vt.Apart) else {}
    groups = vt.Groups(2.0, SOLID, start, 3.0, body=Layer(0.5, BASES[2]), **more)
    result = vt.solve(groups, accuracy=1e-2, estimate_error=False)
    assert abs(result.energy_residual) < 2e-3 and vt.pull_off_force(result) > 1.0
    found = {"AtDepth": result.depth, "AtForce": result.force, "AtRadius": result.contact_radius}
    if type(start).__name__ in found:
        (wanted,) = vars(start).values()
        assert found[type(start).__name__][0] == pytest.approx(wanted, rel=1e-4)


def test_a_layer_responds_at_lower_rates_and_saturates_sooner():
    rates = (0.3, 30.0)
    rise = {}
    for body in (vt.HalfSpace(), Layer(0.2, BASES[2])):
        slow, fast = (on(body, 1.0, 1e-2, material=SOLID, rate=rate) for rate in rates)
        rise[body.word] = fast / slow
    assert rise["layer"] < rise["half-space"]


# --- shapes with details --------------------------------------------------------------------------
WAVES = vt.WavySphere(1.0, 0.2, 0.2)
WORN = vt.MeasuredProfile.sampled(lambda r: max(r * r - 0.25, 0.0) / 2, np.linspace(0, 4, 41))
WORN = WORN.reduced(1.0, 1 / WORN.equivalent_radius(1.0))


@pytest.mark.parametrize("shape", [vt.WavySphere(1.0, 0.1, 1.0), WORN], ids=["waves", "worn"])
def test_a_shape_with_details_is_pulled_off_a_thin_layer(shape):
    # a bound of 1,000 contact radii must not ask for JKR beyond 100 thicknesses
    layer = Layer(0.3, BASES[2])
    groups = vt.Groups(0.5, ELASTIC, vt.AtDepth(0.2), 1.0, geometry=shape, body=layer)
    result = vt.solve(groups, until="pull-off", accuracy=5e-3, estimate_error=False)
    assert vt.pull_off_force(result) > 0.5 and abs(result.energy_residual) < 1e-3


def test_a_contact_too_wide_for_the_layer_or_the_profile_is_rejected_in_words():
    layer = Layer(0.01, BASES[2])
    for shape, words in ((WAVES, "wider than 100 thicknesses"), (WORN, "100 thicknesses")):
        groups = vt.Groups(3.0, ELASTIC, vt.AtForce(40.0), 1.0, geometry=shape, body=layer)
        with pytest.raises(vt.InputError, match=words):
            vt.solve(groups)
    groups = vt.Groups(3.0, ELASTIC, vt.AtForce(900.0), 1.0, geometry=WORN)
    with pytest.raises(vt.InputError, match="larger than the profile is known"):
        vt.solve(groups)
