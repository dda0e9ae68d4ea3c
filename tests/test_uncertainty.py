"""Tests of bands from tolerances and of Sobol indices: limits, brute force, doors, refusals."""

from dataclasses import replace
from pathlib import Path
from statistics import NormalDist

import numpy as np
import pytest

import viscotack as vt
from command_line import exit_status
from viscotack.prediction.uncertainty import TIER

LENS = Path(__file__).parents[1] / "examples" / "from_toml" / "lens.toml"
CASE = vt.read_case(LENS)
RADIUS, WORK, SPEED = "sphere.radius", "interface.work_of_adhesion", "protocol.speed"


@pytest.fixture(scope="module")
def lens():
    return vt.uncertainty(CASE, {RADIUS: 0.05, WORK: 0.1, SPEED: 0.3}, samples=64)


def test_an_elastic_sphere_has_the_indices_of_a_product():
    """JKR: P = 1.5 pi R dg0, so that ln P is a sum, of variance s_R^2 + s_w^2."""
    sR, sw = 0.03, 0.1
    found = vt.uncertainty(elastic(), {RADIUS: sR, WORK: sw}, samples=12)
    # the tier says how far it may be from a simulation, which is part of the variance
    rest = 1 - found.total[TIER]
    assert rest > 0.9
    assert found.first[RADIUS] == pytest.approx(rest * sR**2 / (sR**2 + sw**2), abs=0.003)
    assert found.first[WORK] == pytest.approx(rest * sw**2 / (sR**2 + sw**2), abs=0.003)
    # of a normal cut at three deviations
    assert found.deviation == pytest.approx(np.hypot(sR, sw) / np.sqrt(rest), rel=0.02)
    assert found.median == pytest.approx(1.5 * np.pi * 5e-3 * 0.1, rel=0.01)


def test_without_scatter_the_band_is_that_of_the_tier():
    problem = replace(elastic(), traction=vt.LennardJones(0.1, 2e-7))
    found = vt.uncertainty(problem, {RADIUS: 1e-5}, samples=8, confidence=0.5)
    low, high = vt.predict(problem).interval
    share = NormalDist().inv_cdf(0.75) / NormalDist().inv_cdf(0.95)
    assert np.log(found.interval[1] / found.interval[0]) == pytest.approx(
        share * np.log(high / low), rel=0.03
    )


def elastic(work=0.1, modulus=1e6):
    return vt.Problem(
        material=vt.Elastic(rubbery_modulus=modulus, poisson_ratio=0.5),
        traction=vt.LennardJones(work_of_adhesion=work, equilibrium_gap=10e-9),
        geometry=vt.Sphere(radius=5e-3),
        protocol=vt.Retraction(start=vt.AtForce(force=1e-3), speed=1e-5),
    )


def test_sampled_interfaces_and_solids_have_the_indices_of_their_scatter():
    """JKR: the force is proportional to the work, and the modulus has no share."""
    works = 0.1 * np.exp(0.1 * np.random.default_rng(3).standard_normal(4))
    sampled = {
        "traction": [elastic(work=float(w)).traction for w in works],
        "material": [elastic(modulus=1e6 * x).material for x in (0.8, 1.25)],
    }
    found = vt.uncertainty(elastic(), {}, sampled=sampled, samples=12)
    assert list(found.first) == ["traction", "material", TIER]
    assert found.first["traction"] == pytest.approx(1, abs=0.02)
    assert found.total["material"] < 1e-6
    assert found.deviation == pytest.approx(np.std(np.log(works)), rel=0.03)


def test_an_error_of_all_times_is_that_of_the_only_time():
    one, other = (
        vt.uncertainty(CASE, **given, samples=12)
        for given in ({"deviations": {"material.tau0": 0.3}}, {"times": {"temperature": 0.3}})
    )
    assert one.deviation == pytest.approx(other.deviation, rel=1e-9)
    assert one.first["material.tau0"] == pytest.approx(other.first["temperature"], rel=1e-9)


def test_the_temperature_of_a_passport_is_an_input(monkeypatch):
    answer = vt.ask(
        "uncertainty",
        problem=str(LENS),
        passport="pdms-10-1",
        temperature="0 degC",
        temperature_uncertainty="2 K",
        samples=16,
    )
    (first, tier) = answer.record()["inputs"]
    assert (first["input"], tier["input"]) == ("temperature", TIER)
    # WLF at 0 degC: 0.06 per K of ln(a_T)
    assert first["deviation"] == pytest.approx(2 * 0.06, rel=0.5)
    assert answer.record()["deviation"] > 0


def test_the_band_is_that_of_direct_predictions(lens):
    rng, forces = np.random.default_rng(8), []
    for z in np.clip(rng.standard_normal((200, 3)), -3, 3):
        R, w, v = np.exp(z * [0.05, 0.1, 0.3])
        case = replace(
            CASE,
            geometry=vt.Sphere(radius=CASE.geometry.radius * R),
            traction=replace(CASE.traction, work_of_adhesion=CASE.traction.work_of_adhesion * w),
            protocol=replace(CASE.protocol, speed=CASE.protocol.speed * v),
        )
        found = vt.predict(case, budget=0.01)
        forces.append(found.pull_off_force * case.scales().force)
    assert np.std(np.log(forces)) == pytest.approx(lens.deviation, rel=0.1)
    forces = np.array(forces)
    inside = np.mean((lens.interval[0] < forces) & (forces < lens.interval[1]))
    assert 0.85 < inside < 0.95
    assert lens.interpolation_error < 1e-3


@pytest.mark.parametrize(
    "deviations, more, words",
    [
        ({}, {}, "deviation"),
        ({RADIUS: 2.0}, {}, "0.5"),
        ({RADIUS: 0.1}, {"samples": 5}, "at least 6 samples"),
        ({"geometry.radios": 0.1}, {}, "radios"),
        ({"protocol.stiffness": 0.1}, {}, "not stated"),
    ],
)
def test_what_cannot_be_is_refused(deviations, more, words):
    with pytest.raises(vt.InputError, match=words):
        vt.uncertainty(CASE, deviations, **more)


def test_the_command_draws_and_tells_the_largest_first(tmp_path, capsys):
    flags = ["--scatter", f"{RADIUS} 1 %", "--scatter", f"{WORK} 20 %", "--samples", "16"]
    files = ["--plot", tmp_path / "shares.png", "--csv", tmp_path / "shares.csv"]
    assert exit_status(["uncertainty", LENS, *flags, *files]) == 0
    first = [line.split()[0] for line in capsys.readouterr().out.splitlines()]
    assert [name for name in first if name in (WORK, RADIUS, TIER)] == [WORK, RADIUS, TIER]
    assert (tmp_path / "shares.png").stat().st_size > 5000
    assert len((tmp_path / "shares.csv").read_text().splitlines()) == 4
