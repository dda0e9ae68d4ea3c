"""Traction laws: identities of each, and contacts that are known exactly.

Derivatives, peak and units of every law are judged by `viscotack.testing` in tests/test_testing.py.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.interpolate import PchipInterpolator
from threadpoolctl import threadpool_limits

import viscotack as vt
from dimensionless import ELASTIC, sphere
from reference_data import VALUES
from viscotack.model.traction import softening
from viscotack.simulate import Settings
from viscotack.simulate.contacts.sphere import SphereContact
from viscotack.theory import maugis

WORK, RANGE = 0.1523, 1.55e-6
DUGDALE = vt.Dugdale(WORK, RANGE, rise=0.05, fall=0.3)
EXPONENTIAL = vt.Exponential(WORK, RANGE, decay=0.3)
TABLE = vt.Tabulated.of_points(
    np.array([1.2, 1.5, 1.8, 2.1, 3.0, 4.5, 8.0]) * 1e-6,
    [-300e3, -10e3, 60e3, 75e3, 30e3, 4e3, 0.0],
)
LENNARD_JONES = vt.LennardJones(WORK, RANGE)
ALL = [LENNARD_JONES, DUGDALE, EXPONENTIAL, TABLE]
laws = pytest.mark.parametrize("law", ALL[1:], ids=["D", "E", "T"])


@laws
def test_separating_from_the_equilibrium_gap_costs_the_work_of_adhesion(law):
    h0, w = law.equilibrium_gap, law.work_of_adhesion
    corners = h0 * np.array([1.05, 1.5, 1.85, 2.2, 3.0, 6.0, 30.0])
    pieces = [
        quad(lambda h: float(law.traction(h)), a, b, epsabs=0, epsrel=1e-10)[0]
        for a, b in zip(np.append(h0, corners[:-1]), corners, strict=True)
    ]
    assert sum(pieces) == pytest.approx(w, rel=1e-9, abs=0)
    assert float(law.energy(h0)) == pytest.approx(-w, rel=1e-9, abs=0)
    assert abs(float(law.traction(h0))) < 1e-9 * law.strength
    assert abs(float(law.energy(1e3 * h0))) < 1e-12 * w
    assert abs(float(law.energy_beyond(1e3 * h0))) < 1e-12 * w * h0


def test_the_law_of_lennard_and_jones_has_the_verified_values():
    law = LENNARD_JONES.reduced()
    rows = [row for row in VALUES if row["equation"].startswith("32 ")]
    assert len(rows) > 5
    for row in rows:
        gap = row["inputs"]["h/h0"]
        assert float(law.traction(gap)) == pytest.approx(row["value"], rel=1e-13, abs=1e-13)
    (row,) = (row for row in VALUES if row["equation"] == "2.1/3.17")
    assert law.edge_gap == pytest.approx(row["value"], rel=1e-14)
    assert law.energy(np.array([1.0, 1e9])) == pytest.approx([-1.0, 0.0], abs=1e-14)


@pytest.mark.parametrize("wrong", [-0.05, np.nan, "0.05 J/m2"])
def test_an_impossible_law_is_refused(wrong):
    with pytest.raises(ValueError, match="work_of_adhesion must be"):
        vt.LennardJones(work_of_adhesion=wrong, equilibrium_gap=1e-6)
    with pytest.raises(ValueError, match="equilibrium_gap must be"):
        vt.LennardJones(work_of_adhesion=0.05, equilibrium_gap=wrong)


def test_dugdale_tends_to_a_constant_tension_as_its_widths_vanish():
    # what is lost of a tension of 1 at the two corners, in the mean: r/3 + f/6 of the range
    u = 1 + np.linspace(0, 2, 400_001)
    lost = []
    for width in (0.4, 0.2, 0.1):
        law = vt.Dugdale(1.0, 1.0, rise=width / 2, fall=width)
        lost.append(np.mean(np.abs(law.traction(u) - (u < 2))) * 2)
    assert np.diff(np.log(lost)) == pytest.approx(-np.log(2), abs=1e-3)


def test_exponential_decays_by_e_in_a_decay_length():
    far = RANGE * np.array([8.0, 8.3])
    beyond = far - RANGE
    fading = EXPONENTIAL.traction(far) / beyond
    assert fading[1] / fading[0] == pytest.approx(np.exp(-1), rel=1e-9, abs=0)


def test_a_table_of_a_smooth_law_is_that_law():
    smooth = vt.Exponential(0.1, 1e-6, decay=0.3)
    tail = float(smooth.energy(8e-6)) / -0.1
    assert tail < 1e-8
    error = []
    for number in (50, 100, 200):
        gap = np.linspace(0.7e-6, 8e-6, number)
        traction = np.append(smooth.traction(gap[:-1]), 0.0)
        law = vt.Tabulated.of_points(gap, traction)
        h = np.linspace(0.75e-6, 7e-6, 1000)
        error.append(np.max(np.abs(law.energy(h) - smooth.energy(h))) / 0.1)
    # a monotone curve is flat at its highest point: second order there, in the energy third
    assert np.all(np.diff(np.log2(error)) < -2)
    assert error[-1] < 1e-3


@pytest.mark.parametrize("length", [1.0, 1e-2, 1e-3, 1e-4])
def test_a_table_may_be_as_short_as_it_likes_before_a_firm_wall(length):
    # the wall, which goes on to gap 0, is worth up to 1e11 times the work of adhesion
    opening = np.array([-0.4, -0.2, 0.0, 0.2, 0.5, 1.0, 1.5])
    traction = 1e5 * np.array([-1e3, -10.0, 0.0, 1.0, 0.8, 0.3, 0.0])
    law = vt.Tabulated.of_points(RANGE * (1 + length * opening), traction).reduced()
    assert law.energy(1.0) == pytest.approx(-1, rel=1e-12, abs=0)
    of_points = PchipInterpolator(opening, traction)
    strength = 1e5 / float(of_points.integrate(0.0, 1.5))
    assert law.strength * length == pytest.approx(strength, rel=1e-9, abs=0)


def test_beyond_its_end_a_table_has_nothing_however_steeply_it_ends():
    law = vt.Tabulated.of_points([0.8, 1.0, 1.5, 2.0, 2.5], [-100.0, 0.0, 1.0, 0.8, 0.0])
    end = law.points[-1][0] * law.equilibrium_gap
    assert law.stiffness(0.999 * end) < -0.5
    beyond = np.array([1.0, 1.001, 5.0, 1e4]) * end
    for function in (law.traction, law.stiffness, law.energy, law.energy_beyond):
        np.testing.assert_array_equal(function(beyond), 0.0)


@pytest.mark.parametrize(
    ("gap", "traction", "words"),
    [
        ([1, 2, 2, 3], [-1, 0, 1, 0], "gaps must be positive and ascend"),
        ([1, 2, 3, 4], [1, 2, 1, 0], "must begin with repulsion"),
        ([1, 2, 3, 4], [-1, 0, 1, 0.5], "must be zero at the last gap, got 0.5; add a row"),
        ([1, 2, 3, 4, 5], [-1, 1, -1, 1, 0], "must change its sign once"),
        ([1, 2, 3], [-1, 1, 0], "at least four gaps"),
    ],
)
def test_a_table_that_is_no_law_is_refused(gap, traction, words):
    with pytest.raises(ValueError, match=words):
        vt.Tabulated.of_points(gap, traction)


@pytest.mark.parametrize(("wider", "stronger"), [(1.0, 2.0), (1.1, 1 / 1.1)])
def test_points_of_another_work_or_equilibrium_gap_than_1_are_refused(wider, stronger):
    points = tuple((wider * gap, stronger * traction) for gap, traction in TABLE.points)
    with pytest.raises(ValueError, match="zero traction at gap 1 and work 1"):
        vt.Tabulated(WORK, RANGE, points)


@pytest.mark.parametrize(
    ("kind", "wrong", "words"),
    [
        (vt.Dugdale, dict(rise=0.0), r"rise must lie in \(0, 0.5\]"),
        (vt.Dugdale, dict(fall=1.5), r"fall must lie in \(0, 1\]"),
        (vt.Exponential, dict(decay=-1), "decay must be positive"),
    ],
)
def test_an_impossible_shape_is_refused(kind, wrong, words):
    with pytest.raises(ValueError, match=words):
        kind(WORK, RANGE, **wrong)


# --- contacts -------------------------------------------------------------------------------
def maugis_branch(parameter):
    """Return Tabor number, force, depth and radius of Maugis in the units of a result, held."""
    tabor = parameter / (9 / (2 * np.pi)) ** (1 / 3)
    # R = E* = w = 1: then beta is 1, h0 is 1/mu, and the strength mu
    case = dict(radius=1.0, contact_modulus=1.0, work_of_adhesion=1.0, strength=tabor)
    assert maugis.maugis_parameter(**case) == pytest.approx(parameter, rel=1e-12, abs=0)
    curve = maugis.curve(1 + np.geomspace(1e-9, 1e7, 40_000), **case)
    last = int(np.argmin(curve.force)) + 1
    force, depth, radius = (
        np.asarray(x)[:last][::-1] for x in (curve.force, curve.depth, curve.contact_radius)
    )
    return tabor, force / (1.5 * np.pi), depth * tabor, radius / np.pi ** (1 / 3)


def near_dugdale(parameter):
    """Return the law whose wall gives way by little at this parameter."""
    return vt.Dugdale(1.0, 1.0, rise=1e-4 * min(1.0, parameter / 0.5) ** 2)


@pytest.mark.parametrize(
    ("parameter", "finer"), [(0.5, 3.0), pytest.param(5.0, 3.0, marks=pytest.mark.slow)]
)
def test_relaxed_contacts_of_dugdale_are_those_of_maugis(parameter, finer):
    # what MUST be reached: 0.3 % in force and radius
    tabor, force, depth, radius = maugis_branch(parameter)
    settings = Settings.for_accuracy(1e-3)
    settings = replace(settings, nodes_per_zone=finer * settings.nodes_per_zone)
    contact = SphereContact(tabor, near_dugdale(parameter))
    for share in (1.0, 0.0, -0.5, -0.9):
        wanted = share * abs(force[0])
        at = float(np.interp(wanted, force, depth))
        with threadpool_limits(limits=1, user_api="blas"):
            found = contact.relaxed(vt.AtDepth(at), settings)
        assert found.force == pytest.approx(wanted, rel=0, abs=3e-3 * abs(force[0]))
        exact = float(np.interp(wanted, force, radius))
        assert found.edge / contact.edge_unit == pytest.approx(exact, rel=3e-3, abs=0)


@pytest.mark.parametrize("parameter", [0.05, 0.5, 2.0])
def test_dugdale_pull_off_is_that_of_maugis(parameter):
    tabor, force, depth, _ = maugis_branch(parameter)
    result = vt.solve(
        sphere(
            vt.AtDepth(float(np.interp(0.8, force, depth))),
            tabor=tabor,
            material=ELASTIC,
            rate=1.0,
            traction=near_dugdale(parameter),
        ),
        until="pull-off",
        estimate_error=False,
    )
    assert vt.pull_off(result).force == pytest.approx(-force[0], rel=3e-3, abs=0)
    assert result.energy_residual < 1e-3


@laws
def test_a_stiff_sphere_pulls_off_as_bradley_has_it_whatever_the_law(law):
    # 2 pi R dg, 4/3 of the unit; the surface still gives way by a few times mu^(3/2) = 1e-3
    groups = vt.Groups(0.01, ELASTIC, vt.AtDepth(0.02), 1.0, traction=law.reduced())
    result = vt.solve(groups, until="pull-off", accuracy=5e-3, estimate_error=False)
    assert vt.pull_off(result).force == pytest.approx(4 / 3, rel=5e-3, abs=0)


@laws
def test_a_soft_sphere_pulls_off_as_jkr_has_it_whatever_the_law(law):
    # Lennard-Jones is 3 % above at mu = 3.24; the excess falls with the Tabor number
    excess = []
    for tabor in (2.0, 6.0):
        groups = sphere(
            vt.AtDepth(tabor), tabor=tabor, material=ELASTIC, rate=1.0, traction=law.reduced()
        )
        result = vt.solve(groups, until="pull-off", accuracy=5e-3, estimate_error=False)
        excess.append(vt.pull_off(result).force - 1)
    assert 0 < excess[1] < 0.5 * excess[0] < 0.05


def test_nodes_are_as_fine_as_the_law_is_steep():
    assert softening(DUGDALE) == pytest.approx(2 / DUGDALE.fall, rel=5e-3, abs=0)
    # however short the law and however sharp its step, which equal samples would miss
    assert softening(replace(DUGDALE, fall=1e-5)) == pytest.approx(2e5, rel=1e-2)
    assert softening(replace(EXPONENTIAL, decay=1e-5)) == pytest.approx(1.0, rel=1e-4)
    # of x exp(-x) it is exp(-2) at x = 2, and the strength exp(-1)
    assert softening(EXPONENTIAL) == pytest.approx(1.0, rel=1e-4, abs=0)
    spacings = [
        SphereContact(1.0, law.reduced()).grading(Settings.for_accuracy(2e-3), 1.0).spacing
        for law in (LENNARD_JONES, DUGDALE)
    ]
    assert spacings[1] < 0.25 * spacings[0]
