"""The same answers in several threads, and in any order of questions."""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest

import viscotack as vt
from viscotack.theory.crack.steady import SteadyCrack, cracks

SOLID = vt.StandardSolid(rubbery_modulus=1.0, glassy_modulus=4.0, tau0=1.0, poisson_ratio=0.5)
REST = vt.LennardJones(1.0, 1.0)
LAWS = [REST, vt.GentSchultz(1.0, 1.0, 1.0, 0.3)]
SPEEDS = (0.003, 0.3)

LIMITS = """
import scipy.linalg
from concurrent.futures import ThreadPoolExecutor
from threadpoolctl import threadpool_info
from viscotack.threads import one_blas_thread

def most():
    return sorted({p["num_threads"] for p in threadpool_info() if p["user_api"] == "blas"})

blocks, counts = [one_blas_thread(), one_blas_thread()], [most()]
threads = [ThreadPoolExecutor(1), ThreadPoolExecutor(1)]
for thread, block in zip(threads, blocks):
    thread.submit(block.__enter__).result()
counts.append(most())
for thread, block in zip(threads, blocks):
    thread.submit(block.__exit__, None, None, None).result()
    counts.append(most())
print(*counts)
"""


def forget():
    for cached in (cracks._branch_of, cracks._grown_of, cracks._elastic_of):
        cached.cache_clear()


def asked(law, speed):
    crack = SteadyCrack(SOLID, law)
    gamma = crack.amplification(speed)
    return gamma, crack.error(speed), crack.speed(gamma), crack.at(speed).heat


@pytest.fixture(scope="module", params=LAWS, ids=["rest", "growing"])
def alone(request):
    """Return a law, and each answer with nothing asked before."""
    found = []
    for speed in SPEEDS:
        forget()
        found.append(asked(request.param, speed))
    return request.param, found


def test_a_steady_crack_does_not_depend_on_the_speeds_that_were_asked_before(alone):
    law, expected = alone
    forget()
    SteadyCrack(SOLID, law).amplification(10.0)
    assert [asked(law, speed) for speed in SPEEDS] == expected


def test_the_blas_limit_holds_until_the_last_thread_is_done():
    # in a fresh process, where BLAS has two threads
    done = subprocess.run(
        [sys.executable, "-c", LIMITS],
        env=os.environ | {"OPENBLAS_NUM_THREADS": "2", "OMP_NUM_THREADS": "2"},
        capture_output=True,
        text=True,
    )
    assert done.stdout == "[2] [1] [1] [2]\n", done.stderr


def test_simulations_and_predictions_in_threads_are_those_of_one_thread():
    solid = vt.RetardationPowerLaw(
        rubbery_modulus=1.0, glassy_modulus=10.0, exponent=0.8, tau0=1.0, poisson_ratio=0.0
    )
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
