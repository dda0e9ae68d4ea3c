"""Any law: the march takes its lengths from it, and not from Lennard-Jones."""

import numpy as np
import pytest

from dimensionless import ELASTIC, SOLID, sphere
from viscotack.model.protocol import AtDepth
from viscotack.model.traction import Dugdale, Exponential, LennardJones, Tabulated, effective_range
from viscotack.result.observables import pull_off_force, work_to_pull_off
from viscotack.simulate import solve
from viscotack.simulate.surface import AtNodes, OnPanels

# strong and short, with a corner in its stiffness where it ends
TABLE = Tabulated.of_points(
    [0.95, 0.98, 1.0, 1.05, 1.1, 1.2], [-20.0, -8.0, 0.0, 10.0, 6.0, 0.0]
).reduced()
GAPS = np.array([0.99, 1.0, 1.0002, 1.0004, 1.3, 1.95, 2.02, 2.0201, 2.5, 4.0])
PANELS = np.array([0.1, 0.2, 0.2, 0.3, 0.1, 0.4, 0.2, 0.1, 0.5])
LAWS = {
    "lennard-jones": LennardJones(1.0, 1.0),
    "step": Dugdale(1.0, 1.0, rise=0.01, fall=0.05),
    "table": TABLE,
    "exponential": Exponential(1.0, 1.0, decay=0.3),
}


def pulled(law, tabor, material=ELASTIC, rate=1.0, accuracy=0.005, **options):
    """Return the answer for a sphere that starts and moves in the lengths of its contact."""
    length = tabor + effective_range(law)
    groups = sphere(
        AtDepth(3 * length), tabor=tabor, material=material, rate=rate * length, traction=law
    )
    return solve(groups, until="pull-off", accuracy=accuracy, **options)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
@pytest.mark.parametrize("rule", [AtNodes(np.ones(10)), OnPanels(PANELS)])
def test_forces_and_tangent_are_derivatives_of_the_interface_energy(law, rule):
    h, unit = 1e-6, np.eye(len(GAPS))

    def derivative(function):
        return np.array([(function(GAPS + h * e) - function(GAPS - h * e)) / (2 * h) for e in unit])

    forces = derivative(lambda gap: rule.at(law, gap).energy)
    size = np.max(np.abs(forces))
    np.testing.assert_allclose(rule.at(law, GAPS).tension, forces, rtol=1e-6, atol=1e-6 * size)
    band = rule.at(law, GAPS).tangent()
    tangent = np.diag(band.diagonal)
    if band.beside is not None:
        tangent = tangent + np.diag(band.beside, -1) + np.diag(band.beside, 1)
    slopes = derivative(lambda gap: rule.at(law, gap).tension)
    np.testing.assert_allclose(tangent, slopes, rtol=1e-4, atol=1e-4 * np.max(np.abs(slopes)))


@pytest.mark.march
def test_of_a_law_with_a_scale_of_its_own_only_that_scale_matters():
    # an exponential law knows its decay and nothing else, wherever its equilibrium is
    answers = []
    for decay in (0.25, 1e-3):
        law = Exponential(1.0, 1.0, decay)
        result = pulled(law, 1.5 * effective_range(law), SOLID)
        work = work_to_pull_off(result) / effective_range(law)
        answers.append((pull_off_force(result), work, result.error_estimate["force"]))
    assert answers[1] == pytest.approx(answers[0], rel=1e-6)


@pytest.mark.march
def test_a_short_strong_law_pulls_off_near_jkr():
    # converged, at an accuracy of 5e-4
    result = pulled(Exponential(1.0, 1.0, 0.1), 3.0, estimate_error=False)
    assert pull_off_force(result) == pytest.approx(1.0019, rel=1e-3)


@pytest.mark.march
def test_a_table_that_ends_with_a_corner_is_between_jkr_and_derjaguin():
    weak, strong = (
        pull_off_force(pulled(TABLE, part * effective_range(TABLE), estimate_error=False))
        for part in (0.05, 8)
    )
    assert 1 < strong < 1.02
    assert 1.31 < weak < 4 / 3
