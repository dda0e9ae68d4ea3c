"""Round-off decides nothing: a march under noise has the outcome and the events of one without."""

from contextlib import ExitStack, contextmanager
from unittest.mock import patch

import numpy as np
import pytest

import viscotack as vt
from dimensionless import ELASTIC, SOLID, power_law, punch, sphere
from viscotack.simulate import equilibrium, growth, surface

pytestmark = pytest.mark.march


def cone(rate, material=SOLID, exponent=1.0):
    profile = vt.PowerLawProfile(1 / exponent, exponent)
    return vt.Groups(2.0, material, vt.AtDepth(5.0), rate, geometry=profile)


def behind_spring(stiffness, make=sphere, load=1.0, rate=1.0, **options):
    return make(vt.AtForce(load), rate=rate / stiffness, stiffness=stiffness, **options)


def hung(load, **options):
    return sphere(vt.AtForce(0.0), vt.LoadTo(-load, 1e-3), vt.Dwell(1e3, hold="force"), **options)


def there_and_back(**options):
    return sphere(vt.Apart(20.0), vt.Approach(1.0, vt.AtDepth(5.0)), rate=1.0, **options)


CASES = {
    "spring-1e-5": behind_spring(1e-5),
    "spring-1e-4-punch": behind_spring(1e-4, punch, 0.1),
    "spring-1e-3-jump-in": sphere(
        vt.Apart(15.0), vt.Approach(2e3, vt.AtForce(1.0)), rate=1e3, tabor=1.0, stiffness=1e-3
    ),
    "dead-load-elastic": hung(1.3, material=ELASTIC),
    "dead-load-borne": hung(0.9),
    "jump-in-and-out": there_and_back(tabor=3.0, material=ELASTIC),
    "small-k": sphere(vt.AtDepth(10.0), rate=1e2, tabor=1.5, material=power_law(1e-3)),
    "cone": cone(5.0),
}


def lasting(result):
    """Return what a test is about, and the least error stated of it over the accuracy.

    The pull-off force, the depth of a contact that holds, or the time for which it bore a load.
    """
    if result.outcome == "still in contact":
        return result.depth[-1], 0.2
    if np.isclose(result.force[-1], result.force[-2], rtol=1e-6, atol=0):
        return vt.time_to_detachment(result), 1.0
    return vt.pull_off_force(result), 0.2


# Processors differ in the last digits of sums of products; this is a hundred times more.
@contextmanager
def noise(size=1e-14):
    """Put noise into every stiffness matrix, factor, residual and energy of the march."""
    random = np.random.default_rng(0)
    factor, at, stiffness = equilibrium.factored, equilibrium.Elastic.at, surface.stiffness

    def noisy(value):
        return value * (1 + size * random.uniform(-1, 1, np.shape(value)))

    def noisy_at(self, gap):
        energy, gradient = at(self, gap)
        return float(noisy(energy)), noisy(gradient)

    def noisy_stiffness(*arguments):
        S = noisy(stiffness(*arguments))
        return (S + S.T) / 2

    def noisy_factor(matrix, curvature):
        noised = curvature._replace(diagonal=noisy(curvature.diagonal))
        return factor(noisy(matrix), noised)

    with ExitStack() as stack:
        for owner, name, function in (
            (equilibrium, "factored", noisy_factor),
            (growth, "factored", noisy_factor),
            (equilibrium.Elastic, "at", noisy_at),
            (surface, "stiffness", noisy_stiffness),
        ):
            stack.enter_context(patch.object(owner, name, function))
        yield


@pytest.mark.parametrize("name", CASES)
def test_noise_changes_neither_outcome_nor_events_nor_force(name):
    how = {"accuracy": 1e-2, "estimate_error": False}
    plain = vt.solve(CASES[name], **how)
    with noise():
        other = vt.solve(CASES[name], **how)
    assert other.outcome == plain.outcome
    assert [e.kind for e in other.events] == [e.kind for e in plain.events]
    (value, share), (found, _) = lasting(plain), lasting(other)
    # runs may take other steps: a tenth of the least error that they state
    assert found == pytest.approx(value, rel=0.1 * share * how["accuracy"], abs=0)
