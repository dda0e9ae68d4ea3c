"""Cracks of a solid beside a known one: what its own cracks say, at no cost."""

from dataclasses import replace

import numpy as np
import pytest

import viscotack as vt
from viscotack.theory import SteadyCrack
from viscotack.theory.crack.steady import NeighbourCrack

LAW = vt.LennardJones(work_of_adhesion=0.1, equilibrium_gap=1e-9).reduced()
SOLID = vt.RetardationPowerLaw(
    rubbery_modulus=1e6, glassy_modulus=3e7, exponent=0.5, tau0=1e-2, poisson_ratio=0.5
)
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
