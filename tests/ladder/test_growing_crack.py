"""Cracks and contacts whose interface grows with the opening speed: limits, heat, simulation."""

from functools import lru_cache
from math import exp

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import viscotack as vt
from dimensionless import ELASTIC, SOLID
from viscotack.model.traction.growing import reference_speed
from viscotack.theory import SteadyCrack
from viscotack.theory.crack.contact import (
    GrowingCracks,
    profile_of,
    recede,
)
from viscotack.theory.crack.steady import _balance, _grown, _mesh, cracks

REST = vt.LennardJones(1.0, 1.0)
POWER = vt.GentSchultz(1, 1, 1.0, 0.5)


def test_without_growth_the_crack_is_that_of_the_law_at_rest():
    grown, rest = SteadyCrack(SOLID, vt.GentSchultz(1, 1, 1e8, 1.0)), SteadyCrack(SOLID, REST)
    speed = np.array([0.1, 10.0])
    np.testing.assert_allclose(grown.amplification(speed), rest.amplification(speed), rtol=2e-4)
    np.testing.assert_array_equal(grown.amplification(-speed), rest.amplification(-speed))


def test_a_little_growth_adds_the_heat_of_the_crack_at_rest():
    # first order: the tensions beyond those at rest do work along the crack of the law at rest
    rest = SteadyCrack(ELASTIC, REST).at(0.0)
    slope, x = np.diff(rest.gap) / np.diff(rest.position), rest.gap
    energy = np.where(x > 1, REST.energy(x), -1.0)
    for law in (vt.GentSchultz(1, 1, 1.0, 0.4), vt.Eyring(1, 1, 0.01, 0.1)):
        speed = 1e-4
        heat = float(np.sum(law.growth(speed * slope) * np.diff(energy)))
        found = SteadyCrack(ELASTIC, law).amplification(speed)
        assert found - 1 == pytest.approx(heat, rel=0.02, abs=0)


@pytest.mark.parametrize("speed", [0.01, 1.0, 30.0])
def test_in_an_elastic_solid_the_energy_is_work_of_adhesion_and_heat_of_the_interface(speed):
    crack = SteadyCrack(ELASTIC, POWER)
    found = crack.at(speed)
    assert found.amplification == pytest.approx(1 + found.interface_heat, rel=2e-3, abs=0)
    assert found.amplification == pytest.approx(crack.amplification(speed), rel=2e-3, abs=0)
    # between the computed cracks as well
    assert crack.interface_work(speed) == pytest.approx(1 + found.interface_heat, rel=2e-5, abs=0)


def test_a_finer_mesh_confirms_the_amplification():
    usual = SteadyCrack(SOLID, POWER)
    grid = _mesh.mesh(1.0, 3e4 / usual.modes.instantaneous, refined=2.0)

    def opening(log_speed):
        return _mesh.opening_matrix(grid, _mesh.lengths_of(grid, usual.modes, exp(log_speed)))

    law, start = _balance.pinned(REST), _balance.elastic(REST, grid)
    fine = _grown.Grown(grid, law, usual.modes, opening, POWER, start)
    speed = np.array([0.1, 3.0])
    np.testing.assert_allclose(usual.amplification(speed), fine.gamma(np.log(speed)), rtol=3e-3)


def test_speeds_and_amplifications_are_inverse_and_do_not_depend_on_units():
    crack = SteadyCrack(SOLID, POWER)
    gamma = np.array([1.01, 2.0, 20.0])
    np.testing.assert_allclose(crack.amplification(crack.speed(gamma)), gamma, rtol=1e-6)
    solid = vt.StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=0.02, poisson_ratio=0.5)
    law = vt.GentSchultz(0.1, 1e-7, 1e-7 / 0.02, 0.5)
    assert SteadyCrack(solid, law).amplification(2.0) == pytest.approx(
        crack.amplification(2.0), rel=1e-9
    )
    with pytest.raises(vt.OutOfRange, match="supports laws of the gap only"):
        cracks.compared(crack, 1.0)


def test_a_receding_contact_solves_its_ordinary_differential_equation():
    # the plain twin: JKR with an energy that hangs on the speed of the edge, an elastic solid
    crack, tabor, rate, start = SteadyCrack(ELASTIC, POWER), 50.0, 0.02, 3.0
    depth = start**2 - np.sqrt(2 * np.pi * start)
    gamma = np.geomspace(1 + 1e-6, 200, 4000)
    speeds = np.log(np.asarray(crack.speed(gamma)))

    def speed_of(time, a):
        lifted = depth - rate * time - a**2
        energy = max(min(lifted, 0.0) ** 2 / (2 * np.pi * a), 1 + 2e-6)
        return -float(np.exp(np.interp(np.log(energy), np.log(gamma), speeds))) / tabor**2

    done = solve_ivp(
        lambda t, y: [speed_of(t, y[0])],
        (0, 4000.0),
        [start],
        method="LSODA",
        rtol=1e-8,
        max_step=5.0,
        events=_vanished,
    )
    a, t = done.y[0], done.t
    force = 2 * (a * (depth - rate * t) - a**3 / 3)
    found = recede(
        crack,
        profile_of(vt.Sphere(1.0)),
        radius=np.array([start]),
        rate=np.array([rate]),
        tabor=np.array([tabor]),
    )
    assert float(found.force.min()) == pytest.approx(float(force.min()), rel=2e-3, abs=0)


def _vanished(time, y):
    return y[0] - 0.3


_vanished.terminal = True


@pytest.mark.parametrize(
    ("solid", "tabor", "depth", "rate", "law", "within"),
    [
        (ELASTIC, 3.24, 10.0, 1.0, vt.GentSchultz(1, 1, 1.0, 0.5), 0.03),
        (SOLID, 10.0, 60.0, 30.0, vt.Eyring(1, 1, 0.1, 0.2), 0.015),
    ],
    ids=["elastic", "bonds"],
)
def test_simulation_and_crack_agree(solid, tabor, depth, rate, law, within):
    groups = vt.Groups(
        tabor=tabor, material=solid, start=vt.AtDepth(depth), rate=rate, traction=law
    )
    answer = vt.crack_contact(groups)
    result = vt.solve(groups, until="pull-off", accuracy=5e-3, estimate_error=False)
    simulated = vt.pull_off_force(result)
    assert answer.pull_off_force == pytest.approx(simulated, rel=within, abs=0)
    assert abs(answer.pull_off_force / simulated - 1) < answer.band
    # growth matters: the law at rest has another force
    plain = _at_rest(solid, tabor, depth, rate)
    assert answer.pull_off_force > 1.5 * plain


@lru_cache(maxsize=4)
def _at_rest(solid, tabor, depth, rate):
    groups = vt.Groups(tabor=tabor, material=solid, start=vt.AtDepth(depth), rate=rate)
    return vt.crack_contact(groups).pull_off_force


def test_solve_hands_a_short_range_over_to_the_crack_with_its_growth():
    law = vt.GentSchultz(1, 1, 1e3, 0.5)
    groups = vt.Groups(
        tabor=500.0, material=ELASTIC, start=vt.AtDepth(2000.0), rate=10.0, traction=law
    )
    result = vt.solve(groups)
    assert result.method == "crack contact"
    assert vt.pull_off_force(result) > 1.2


def test_the_energy_at_a_simulated_edge_is_that_of_the_steady_crack_at_its_speed(tmp_path):
    law = vt.GentSchultz(1, 1, 10.0, 0.5)
    groups = vt.Groups(tabor=10.0, material=SOLID, start=vt.AtDepth(60.0), rate=30.0, traction=law)
    problem = groups.in_si(
        radius=1e-3, contact_modulus=1e6, work_of_adhesion=0.1, time_unit=0.1, poisson_ratio=0.5
    )
    result = vt.solve(problem, until="pull-off", accuracy=1e-2, estimate_error=False, fields=True)
    found = vt.edge_energy(result)
    speed = found.speed / result.scales.edge_speed * groups.tabor**2
    steady = np.asarray(SteadyCrack(SOLID, law).amplification(speed))
    later = found.amplification > 3
    np.testing.assert_allclose(found.amplification[later], steady[later], rtol=0.04)
    np.testing.assert_allclose(found.bulk * found.interface, found.amplification, rtol=1e-12)
    assert np.all(found.interface[later] > 1.3)
    # the simulated slope near the edge at pull-off
    at, si = int(np.argmin(result.force)), result.scales
    near = result.fields["radius"][at] < 1.1 * result.contact_radius[at]
    gap, radius = (result.fields[name][at][near] for name in ("gap", "radius"))
    slope = np.max(np.diff(gap) / np.diff(radius)) * si.length / si.radius
    assert found.strain == pytest.approx(slope, rel=0.1)
    assert any("a linear solid is doubtful" in word for word in found.words)
    fitted = 1 + (found.speed / found.reference_speed) ** found.exponent
    np.testing.assert_allclose(fitted, found.amplification, rtol=0.1)


def test_the_reference_speed_reproduces_the_given_growth():
    growth = np.array([1e-9, 1e-3, 0.3, 20.0])
    for n in (0.05, 0.4, 1.0):
        for G, v0 in zip(growth, reference_speed(growth, 3.0, n), strict=True):
            law = vt.GentSchultz(1, 1, float(v0), n)
            assert float(law.growth(3.0)) == pytest.approx(G, rel=1e-9, abs=0)
    assert np.isinf(reference_speed(0.0, 3.0, 0.4))


@pytest.fixture(scope="module")
def lattice():
    # as small as splines allow
    return GrowingCracks(SOLID, (0.1, 3.0), (1.0, 1.0), [0.3, 0.4, 0.5, 0.6])


@pytest.mark.slow
def test_a_lattice_of_cracks_serves_contacts_with_growth_of_their_own(lattice):
    n = np.array([0.42, 0.57])
    v0 = reference_speed([0.2, 2.5], 1.0, n)
    given = {"radius": np.full(2, 4.0), "rate": np.full(2, 5.0), "tabor": np.full(2, 20.0)}
    together = recede(lattice.edges(v0, n), profile_of(vt.Sphere(1.0)), **given).force.min(axis=0)
    for i in range(2):
        crack = SteadyCrack(SOLID, vt.GentSchultz(1, 1, float(v0[i]), float(n[i])))
        one = {name: values[:1] for name, values in given.items()}
        alone = recede(crack, profile_of(vt.Sphere(1.0)), **one).force.min()
        assert together[i] == pytest.approx(alone, rel=0.01, abs=0)
