"""The same answers in several threads, and in any order of questions."""

from concurrent.futures import ThreadPoolExecutor

import pytest

import viscotack as vt
from solids import creep_power_law
from viscotack.theory.crack.steady import SteadyCrack, cracks

SOLID = vt.StandardSolid(rubbery_modulus=1.0, glassy_modulus=4.0, tau0=1.0, poisson_ratio=0.5)
ELASTIC = vt.Elastic(rubbery_modulus=1.0, poisson_ratio=0.5)
CRACKS = [(SOLID, vt.LennardJones(1.0, 1.0)), (ELASTIC, vt.GentSchultz(1.0, 1.0, 1.0, 0.3))]
SPEEDS = (0.003, 0.3)


def forget():
    for cached in (cracks._branch_of, cracks._grown_of, cracks._elastic_of):
        cached.cache_clear()


def asked(solid, law, speed):
    crack = SteadyCrack(solid, law)
    gamma = crack.amplification(speed)
    return gamma, crack.error(speed), crack.speed(gamma), crack.at(speed).heat


@pytest.fixture(scope="module", params=CRACKS, ids=["rest", "growing"])
def alone(request):
    """Return a solid and a law, and each answer with nothing asked before."""
    found = []
    for speed in SPEEDS:
        forget()
        found.append(asked(*request.param, speed))
    return request.param, found


def test_a_steady_crack_does_not_depend_on_the_speeds_that_were_asked_before(alone):
    crack, expected = alone
    forget()
    SteadyCrack(*crack).amplification(10.0)
    assert [asked(*crack, speed) for speed in SPEEDS] == expected


def test_simulations_and_predictions_in_threads_are_those_of_one_thread():
    solid = creep_power_law(1.0, 10.0, 0.8, 1.0, 0.0)
    cases = [
        vt.Groups(tabor=1.0, material=solid, start=vt.AtDepth(20.0), rate=rate)
        for rate in (10.0, 100.0)
    ]

    def ask(case):
        result = vt.solve(case, accuracy=0.02, until="pull-off", estimate_error=False)
        told = vt.summary(result)
        del told["wall_time_s"], told["statistics"]
        return result.force.tolist(), told, vt.predict(case).pull_off_force

    expected = [ask(case) for case in cases]
    with ThreadPoolExecutor(4) as threads:
        assert list(threads.map(ask, cases + cases)) == expected + expected
