"""The simulated punch on a layer on the ladder: identities, limits, orders, twin and theory."""

import dataclasses

import numpy as np
import pytest
from scipy.optimize import brentq
from threadpoolctl import threadpool_limits

import viscotack as vt
from dimensionless import ELASTIC, punch, resized, slope
from research.twins import plain_punch
from viscotack.simulate import Settings
from viscotack.simulate.contacts.punch import PunchContact
from viscotack.theory import punch as theory
from viscotack.theory.punch import crossover, curve

pytestmark = pytest.mark.march

LAW = vt.LennardJones(1.0, 1.0)
THESIS = punch(vt.AtDepth(1.0), rate=1.0)


def run(groups=THESIS, *, settings=None, accuracy=2e-3, until="pull-off", **changes):
    return vt.solve(
        resized(groups, **changes),
        accuracy=accuracy,
        settings=settings,
        until=until,
        estimate_error=False,
    )


# --- identities -----------------------------------------------------------------------------
def test_energy_audit_of_a_punch_closes_with_every_term_at_work():
    result = run(until="detached", thickness=32.42, rate=10.0)
    energy = result.energy
    assert energy is not None
    stored = energy.elastic + energy.interface
    balance = energy.drive - (stored - stored[0]) - energy.heat
    balance -= energy.jumps + energy.transfer
    assert np.max(np.abs(balance)) < 1e-3 * np.max(np.abs(energy.drive))
    assert result.energy_residual is not None and result.energy_residual < 1e-3
    assert energy.heat[-1] > 1 and energy.jumps[-1] > 0


def test_work_of_a_punch_is_its_curve_in_units_of_the_work_of_adhesion():
    # w = (sigma_0 h_0/dg0) x integral of the mean tension over the depth, as the theory has it
    result = run(until="detached", rate=10.0)
    of_curve = curve.work_of_separation(result.depth, -result.force) * LAW.strength
    # the far tail is added: the energy of the interface at a gap of 10 h0, 4/3/100
    left = 4 / 3 / 10**2
    assert vt.work_of_separation(result) == pytest.approx(of_curve + left, rel=3e-3, abs=0)
    assert vt.work_to_pull_off(result) < vt.work_of_separation(result)


def test_cohesion_changes_crack_speeds_and_nothing_else():
    # a0/h0 = (9 sqrt(3) pi/32)/Sigma0, Eq. 3.5
    soft, stiff = run(cohesion=0.05), run(cohesion=0.2)
    np.testing.assert_array_equal(soft.force, stiff.force)
    assert vt.crack_speed_at_pull_off(soft) == pytest.approx(4 * vt.crack_speed_at_pull_off(stiff))
    of_edge = -np.gradient(soft.contact_radius, soft.time)
    i = int(np.argmin(soft.force))
    h0_per_a0 = 32 * 0.05 / (9 * 3**0.5 * np.pi)
    assert vt.crack_speed_at_pull_off(soft) == pytest.approx(of_edge[i] / h0_per_a0, rel=0.2)


def test_surface_energy_is_equation_3_30_of_the_thesis():
    # with alpha_LJ = 9 sqrt(3)/16 and the thickness in h0
    result = run()
    in_h0 = THESIS.body.thickness * THESIS.fracture_length
    s, a = vt.pull_off_stress(result), vt.ligament_at_pull_off(result)
    printed = s**2 * THESIS.cohesion * in_h0 / (2 * 9 * 3**0.5 / 16) / a**2
    assert vt.effective_surface_energy(result) == pytest.approx(printed, rel=1e-12)


# --- limits ---------------------------------------------------------------------------------
@pytest.mark.parametrize("base", [vt.Frictionless(), vt.Bonded(poisson_ratio=0.3)], ids=repr)
def test_a_thin_layer_tends_to_a_foundation_linearly_in_its_thickness(base):
    # appendix I: every point for itself, h - 1 + delta = p b/(zeta E*), pressure of the law
    depth, b = 1.5, 0.5
    give = np.pi / (2 * LAW.strength**2) * b * base.foundation

    def balance(gap):
        return gap - 1 + depth + give * LAW.traction(gap)

    pressure = -LAW.traction(brentq(balance, 0.7, 1.1)) / LAW.strength
    sizes, errors = np.array([20.0, 40.0, 80.0]), []
    for size in sizes:
        contact = PunchContact(float(size), vt.Layer(b, base), LAW)
        force = contact.relaxed(vt.AtDepth(depth), Settings.for_accuracy(5e-4)).force
        errors.append(force / float(pressure) - 1)
    assert slope(b / sizes, errors) == pytest.approx(1, abs=0.05), errors
    assert abs(errors[-1]) < 5e-3


def test_a_very_thin_layer_comes_off_at_the_strength():
    result = run(thickness=0.1, rate=10.0)
    assert vt.pull_off_stress(result) == pytest.approx(1, rel=1e-3, abs=0)
    assert vt.ligament_at_pull_off(result) == pytest.approx(1, rel=1e-2, abs=0)
    assert vt.crack_speed_at_pull_off(result) == 0  # all at once: no crack has moved


@pytest.mark.parametrize("thickness", [3.24, 32.42])
def test_a_viscoelastic_punch_lies_between_the_two_elastic_ones(thickness):
    slow = vt.pull_off_stress(run(material=ELASTIC, thickness=thickness))
    glassy = dict(size=6.485, thickness=thickness / 10, cohesion=0.005, material=ELASTIC)
    fast = vt.pull_off_stress(run(**glassy))
    stresses = [
        vt.pull_off_stress(run(thickness=thickness, rate=rate)) for rate in (0.1, 10.0, 100.0)
    ]
    assert slow < stresses[0] < stresses[1] < stresses[2] < fast * (1 + 2e-3)


def test_a_fast_crack_in_a_thick_layer_takes_the_glassy_energy():
    result = run(thickness=32.42, rate=1e3)
    assert vt.effective_surface_energy(result) == pytest.approx(10, rel=5e-2, abs=0)


def test_a_fast_crack_in_a_thin_layer_takes_what_the_strength_allows():
    # Eq. 3.31, with its whole contact: pi/4 b/a0
    result = run(thickness=3.0, rate=1e3)
    whole = vt.effective_surface_energy(result) * vt.ligament_at_pull_off(result) ** 2
    assert whole == pytest.approx(np.pi / 4 * 3.0, rel=1e-2, abs=0)


def test_elastic_punch_tends_to_the_exact_crossover_for_a_short_range():
    # at b = b1 = 4a/pi, 23.5 % above thin layer and half-plane: a parabola in sqrt(a0/a)
    sizes = np.array([32.0, 128.0, 512.0])
    # the largest punch takes thousands of steps between here and two thirds of its force
    ends = [(vt.Retract(speed=1.0, to=vt.AtRadius(0.9 * size)),) for size in sizes]
    body = dict(material=ELASTIC, until="detached", rate=None)
    found = [
        vt.pull_off_stress(run(size=s, thickness=4 / np.pi * s, moves=end, **body)) * s**0.5
        for s, end in zip(sizes.tolist(), ends, strict=True)
    ]
    limit = np.polynomial.polynomial.polyfit(sizes**-0.5, found, 2)[0]
    unit = dict(contact_modulus=1.0, work_of_adhesion=2 / np.pi)
    exact = crossover.pull_off_stress(4 / np.pi, half_width=1.0, **unit, base=vt.Frictionless())
    assert exact / theory.half_plane_pull_off_stress(1.0, **unit) == pytest.approx(1.235, abs=1e-4)
    assert limit == pytest.approx(exact, rel=5e-3, abs=0)


def test_a_punch_can_be_pulled_to_a_ligament_and_held_there():
    # its crack is the slower the longer it is held: the stress relaxes
    half_length = 0.9 * 64.85
    moves = (vt.Retract(speed=1.0, to=vt.AtRadius(half_length)), vt.Dwell(5.0))
    result = run(until="detached", thickness=32.42, rate=None, moves=moves)
    reached = int(np.argmin(np.abs(result.contact_radius - half_length)))
    assert result.contact_radius[reached] == pytest.approx(half_length, rel=2e-3)
    assert result.contact_radius[-1] < half_length
    assert 0 > result.force[-1] > result.force[reached]


# --- orders ---------------------------------------------------------------------------------
def test_the_punch_is_second_order_in_time():
    base = dataclasses.replace(
        Settings.for_accuracy(5e-3),
        imbalance=1e3,
        step_error=1e3,
        force_change=1e3,
        fine_zones=400.0,
    )
    travels = np.array([0.01, 0.005, 0.0025])
    stress = [
        vt.pull_off_stress(
            run(settings=dataclasses.replace(base, travel=t, first_travel=t), size=8.0)
        )
        for t in (*travels, 0.00125)
    ]
    # from a step to one half as long the stress changes by three quarters of its error
    changes = -np.diff(stress)
    assert slope(travels, changes) == pytest.approx(2, abs=0.2), changes


def test_the_punch_is_second_order_in_the_mesh():
    base = dataclasses.replace(Settings.for_accuracy(1e-4), fine_zones=400.0)
    sizes, stress = np.array([2.0, 1.0, 0.5]), []
    for size in (*sizes, 0.25):
        settings = dataclasses.replace(base, nodes_per_zone=6 / size)
        stress.append(vt.pull_off_stress(run(settings=settings, size=4.0, rate=1.0)))
    changes = -np.diff(stress)
    assert slope(sizes, changes) == pytest.approx(2, abs=0.4), changes


# --- the plain twin -------------------------------------------------------------------------


def test_the_plain_twin_tends_to_the_fast_solver_as_its_triangles_multiply():
    # its end triangles reach beyond the punch: too high by a part of order 1/M
    groups = resized(THESIS, size=16.0)
    exact = vt.pull_off_stress(run(groups, accuracy=2e-4))
    counts, errors = np.array([50, 100, 200]), []
    for count in counts.tolist():
        with threadpool_limits(limits=1, user_api="blas"):
            plain = plain_punch(groups, triangles=count, steps=300, last_depth=-6.0)
        errors.append(vt.pull_off(plain).force / exact - 1)
    assert slope(counts, errors) == pytest.approx(-1, abs=0.15), errors
    assert errors[1] == pytest.approx(1 / 100, rel=0.5)
    assert 2 * errors[-1] - errors[-2] == pytest.approx(0, abs=1e-3), errors


def test_two_values_of_an_independent_program():
    # M = 200 with whole end triangles but trapezoidal weights, known to 0.1-0.2 %
    for thickness, rate, expected in ((3.24, 1.0, 0.947), (32.42, 10.0, 0.4465)):
        found = vt.pull_off_stress(run(thickness=thickness, rate=rate))
        assert found == pytest.approx(expected, rel=4e-3, abs=0)
