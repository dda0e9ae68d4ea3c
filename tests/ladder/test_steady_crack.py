"""The steady crack: balances, limits, other theories, another formulation."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import wofz

import viscotack as vt
from solids import creep_power_law, fractional_zener, standard_solid
from viscotack.model.traction import Dugdale, Exponential, LennardJones, Tabulated
from viscotack.theory import SteadyCrack
from viscotack.theory.crack import steady
from viscotack.theory.crack.steady import NeighbourCrack

REDUCED = LennardJones(1.0, 1.0)
TABLE = Tabulated.of_points([0.8, 1.0, 1.2, 1.5, 2.5, 4.0], [-4, 0, 1, 0.8, 0.1, 0]).reduced()
LAWS = [REDUCED, Exponential(1.0, 1.0, 0.25), Exponential(1.0, 1.0, 0.02), TABLE, Dugdale(1.0, 1.0)]


def standard(k=0.1):
    return standard_solid(1.2e6, 1.2e6 / k, 0.02, 0.5)


def lagged(mesh, length):
    """Return the matrix from openings e at the nodes to the delayed d, for piecewise linear e."""
    step = mesh.dx / length
    late = -np.expm1(-step) / step
    decay = np.tril(np.exp(-np.maximum(mesh.x[:, None] - mesh.x, 0.0) / length))
    matrix = np.zeros_like(decay)
    matrix[:, 1:] += decay[:, 1:] * (1 - late)
    matrix[:, :-1] += decay[:, 1:] * (late - np.exp(-step))
    matrix[:, 0] += decay[:, 0]
    return matrix


def spectrum(rng, most=20):
    """A Prony solid of random branches over up to nine decades."""
    number = int(rng.integers(1, most + 1))
    branches = zip(
        10 ** rng.uniform(-1.5, 1.5, number), 10 ** rng.uniform(-7, 2, number), strict=True
    )
    return vt.Prony(rubbery_modulus=1.0, poisson_ratio=0.5, branches=tuple(branches))


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_an_elastic_crack_takes_the_work_of_adhesion(law):
    length = float(steady._balance.effective_range(law)) ** 2
    mesh = steady._mesh.mesh(length, 3e5 * length, refined=2.0)
    found = steady._balance.elastic(steady._balance.softened(law), mesh)
    # the far field, which nothing on the mesh was divided by
    assert found.amplification == pytest.approx(1, abs=1e-4)


@pytest.mark.parametrize("law", [REDUCED, TABLE], ids=["lennard-jones", "table"])
def test_what_the_crack_takes_is_the_work_of_adhesion_and_the_heat(law):
    crack = steady.SteadyCrack(standard(), law)
    fastest = 1e4 if law is REDUCED else 100.0
    for speed in (0.01, 1.0, fastest):
        opening, closing = crack.at(speed), crack.at(-speed)
        assert opening.amplification == pytest.approx(1 + opening.heat, rel=1e-3)
        assert closing.amplification == pytest.approx(1 - closing.heat, rel=1e-3)
        assert opening.heat > 0
        assert closing.heat > 0


def test_the_heat_is_what_the_modes_dissipate_one_by_one():
    # w_j int d_j' (-S)(e - d_j) dx, a form that cannot be negative; S of the analytic far part
    k, length, speed = 0.1, 1.0, 3.0
    crack = steady.SteadyCrack(standard(k), REDUCED)
    found, mesh = crack._branch(1).at(np.log(speed)), crack._grid
    amplitude = found.u[-1]
    lagging = lagged(mesh, speed) @ found.u[:-1]
    z = mesh.x + 1j * length
    far = np.sqrt(z) + 1j * np.sqrt(np.pi * speed) / 2 * wofz(np.sqrt(z / speed))
    of_far = -0.5 * np.imag(np.diff(np.sqrt(z) - far)) / mesh.dx
    stress = mesh.kernel @ (found.u[:-1] - lagging) + amplitude * of_far
    heat = (k - 1) * np.sum(stress * np.diff(lagging + amplitude * far.real))
    assert heat == pytest.approx(crack.at(speed).heat, rel=1e-4)


def test_a_crack_that_closes_is_the_same_with_the_memory_of_the_openings():
    # the modes of the openings and not of the tractions, the way round that is less stable
    k, mesh, law = 0.1, steady._mesh.mesh(1.0, 3e5, refined=0.6), steady._balance.pinned(REDUCED)
    u = steady._balance.elastic(REDUCED, mesh).u
    for length in np.geomspace(0.1, 10, 101):
        mirrored = mesh._replace(x=-mesh.x[::-1], dx=mesh.dx[::-1])
        lagging = lagged(mirrored, length)[::-1, ::-1]
        z = mesh.x + 1j * mesh.width
        far = np.sqrt(z) + np.sqrt(np.pi * length) / 2 * wofz(1j * np.sqrt(z / length))
        opening = np.column_stack(
            [k * np.eye(mesh.x.size) + (1 - k) * lagging, k * mesh.far + (1 - k) * far.real]
        )
        u = steady._balance.solved(steady._balance.System(mesh, law, opening), u).u
    found = np.pi * u[-1] ** 2 / 16
    assert found == pytest.approx(
        steady.SteadyCrack(standard(k), REDUCED).amplification(-10), rel=1e-3
    )


def test_finer_meshes_change_less_than_the_stated_error():
    law = Exponential(1.0, 1.0, 0.25)
    crack = steady.SteadyCrack(standard(0.1), law)
    length = float(steady._balance.effective_range(law)) ** 2
    mesh = steady._mesh.mesh(length, 3e5 * length, refined=2.0)
    start = steady._balance.elastic(law, mesh)
    for sign in (1, -1):
        fine = steady._branch.Branch(
            mesh, steady._balance.pinned(law), crack.modes, start, crack.slow_coefficient, sign
        )
        for speed in (0.1, 2.0):
            found = fine.at(np.log(speed)).amplification / start.amplification
            assert crack.amplification(sign * speed) == pytest.approx(
                found, rel=crack.error(sign * speed)
            )


def test_dugdales_crack_is_greenwoods():
    # which has no fall
    crack = steady.SteadyCrack(standard(0.1), Dugdale(1.0, 1.0, fall=1e-3))
    speed = np.array([0.1, 1.0, 10.0, 100.0])
    found = steady.compared(crack, speed)
    assert np.all(np.abs(found.off("greenwood")) < crack.error(speed))
    assert np.max(found.error) < 0.02


def check_limits(solid, law):
    crack = steady.SteadyCrack(solid, law)
    slow = 1e-4 / crack.slow_coefficient
    opening, closing = crack.amplification([slow, -slow])
    assert (opening - 1) / 1e-4 == pytest.approx(1, rel=0.02)
    assert (1 - closing) / 1e-4 == pytest.approx(1, rel=0.02)
    k = 1 / crack.largest
    assert k == pytest.approx(solid.modulus_ratio, rel=1e-3)
    # a spectrum has its fastest mode last
    fast = 1e7 / min(crack.modes.times)
    assert crack.amplification(fast) == pytest.approx(1 / k, rel=1e-3)
    assert crack.amplification(-fast) == pytest.approx(k, rel=2e-3)
    speed = np.geomspace(slow, fast, 200)
    for gamma in (crack.amplification(speed), 1 / crack.amplification(-speed)):
        assert np.all(np.diff(gamma) > 0)


def test_slow_and_fast_limits_of_random_spectra():
    rng = np.random.default_rng(18)
    for law in (REDUCED, Exponential(1.0, 1.0, 0.3)):
        check_limits(spectrum(rng, most=4), law)


def test_speed_and_amplification_are_inverse():
    crack = steady.SteadyCrack(standard(0.05), REDUCED)
    speed = np.array([-300.0, -2.0, -1e-3, 1e-4, 0.3, 40.0, 5e3])
    assert crack.speed(crack.amplification(speed)) == pytest.approx(speed, rel=2e-4)
    assert crack.speed(1.0) == 0
    with pytest.raises(vt.InputError, match="between 0.05 and 20"):
        crack.speed(21.0)


def test_an_elastic_solid_takes_the_work_of_adhesion_at_any_speed():
    crack = steady.SteadyCrack(vt.Elastic(rubbery_modulus=1e6, poisson_ratio=0.3), REDUCED)
    assert crack.amplification([-5.0, 0.0, 1e6]).tolist() == [1, 1, 1]
    assert crack.at(3.0).heat == pytest.approx(0, abs=1e-12)


def test_units_of_length_and_speed_follow_the_solid_and_the_law():
    law = LennardJones(work_of_adhesion=0.05, equilibrium_gap=2e-9)
    crack = steady.SteadyCrack(standard(), law)
    assert crack.length_unit == pytest.approx(1.6e6 * 4e-18 / 0.05)
    assert crack.speed_unit == pytest.approx(crack.length_unit / 0.02)
    assert crack.amplification(1.0) == steady.SteadyCrack(standard(), REDUCED).amplification(1.0)
    assert crack.slow_coefficient > 0


def test_a_short_range_is_a_long_one_at_another_scale():
    # an exponential law of decay d has gaps in d h0, and so lengths in d^2
    long, short = (steady.SteadyCrack(standard(), Exponential(1.0, 1.0, d)) for d in (0.3, 0.1))
    found = long.amplification([9.0, -9.0])
    assert found == pytest.approx(short.amplification([1.0, -1.0]), rel=1e-6)


def test_a_power_law_is_found_at_all_speeds_with_a_stated_error():
    solid = creep_power_law(1e6, 1e8, 0.6, 1.0, 0.5)
    crack = steady.SteadyCrack(solid, REDUCED)
    speed = np.geomspace(1e-3, 1e9, 13)
    gamma = crack.amplification(speed)
    assert np.all(np.diff(gamma) > 0)
    assert gamma[-1] > 90
    assert np.all(crack.error(speed) < 2e-3)


@pytest.mark.parametrize(
    ("ratio", "order"), [(1e-2, 0.6), pytest.param(1e-6, 0.9, marks=pytest.mark.slow)]
)
def test_a_fractional_solid_has_cracks_down_to_a_modulus_ratio_of_a_millionth(ratio, order):
    solid = fractional_zener(1.0, 1 / ratio, order, 1.0, 0.0)
    crack = steady.SteadyCrack(solid, LennardJones(work_of_adhesion=1.0, equilibrium_gap=1.0))
    gamma = np.array([1.01, 2.0, 30.0])
    assert crack.amplification(crack.speed(gamma)) == pytest.approx(gamma, rel=1e-3)


# Cracks of a solid beside a known one: what its own cracks say, at no cost.
LAW = vt.LennardJones(work_of_adhesion=0.1, equilibrium_gap=1e-9).reduced()
SOLID = creep_power_law(1e6, 3e7, 0.5, 1e-2, 0.5)
ARMS = vt.Prony(
    rubbery_modulus=1e6, branches=[(3e6, 1e-4), (1e6, 1e-2), (3e5, 1.0)], poisson_ratio=0.5
)
SPEEDS = np.geomspace(0.1, 1e3, 13)


@pytest.mark.parametrize(
    "known, changes",
    [
        (SOLID, {"rubbery_modulus": 1.2e6}),
        (SOLID, {"exponent": 0.55, "tau0": 2e-2}),
        (ARMS, {"branches": [(2.8e6, 1e-4), (1.2e6, 1e-2), (2.5e5, 1.0)]}),
    ],
)
def test_a_neighbour_has_the_energies_of_its_own_cracks(known, changes):
    other = replace(known, **changes)
    own = SteadyCrack(other, LAW).amplification(SPEEDS)
    crack = NeighbourCrack(SteadyCrack(known, LAW), other)
    assert crack.amplification(SPEEDS) == pytest.approx(own, rel=0.015)
    # and it is the change that is seen: the known one is further off
    assert np.max(np.abs(SteadyCrack(known, LAW).amplification(SPEEDS) / own - 1)) > 0.015


def test_the_neighbour_in_the_same_place_is_the_known_one():
    known = SteadyCrack(SOLID, LAW)
    crack = NeighbourCrack(known, SOLID)
    assert crack.amplification(SPEEDS) == pytest.approx(known.amplification(SPEEDS), rel=2e-4)
    gamma = np.array([1.001, 2.0, 15.0, 29.9])
    assert crack.amplification(crack.speed(gamma)) == pytest.approx(gamma, rel=1e-6)


def test_times_only_scale_the_speed():
    known = SteadyCrack(SOLID, LAW)
    slower = NeighbourCrack(known, replace(SOLID, tau0=5.0))
    assert slower.amplification(SPEEDS) == pytest.approx(known.amplification(SPEEDS), rel=2e-4)
