"""The interface from a rate series on a layer: truth found, validity stated, the rest refused."""

from dataclasses import replace

import numpy as np
import pytest

import viscotack as vt
from rate_tests import RUBBER, holds, measured
from viscotack.identify import RateSeries, forecast_rates, identify_rates
from viscotack.identify.forward import Forward
from viscotack.theory.crack.contact.recession import MOST_ZONE

RADIUS, WORK, GAP, PRELOAD = 5e-3, 0.15, 100e-9, 20e-3
BETA = (RADIUS**2 * WORK / RUBBER.contact_modulus) ** (1 / 3)
SPEEDS = np.geomspace(1e-6, 3e-4, 4)
CASE = {"material": RUBBER, "radius": RADIUS, "preload": PRELOAD}


def layer(thickness):
    return vt.Layer(thickness * BETA, vt.Bonded(poisson_ratio=0.5))


def forces(body, gap=GAP, speeds=SPEEDS):
    return Forward(RUBBER, RADIUS, body=body).pulled(WORK, gap, speeds, PRELOAD).force


def fitted(values, relative, speeds=SPEEDS, **more):
    return identify_rates(RateSeries(measured(values, relative, speeds), **CASE | more))


def test_a_very_thick_layer_gives_the_half_space():
    assert forces(layer(1e3)) == pytest.approx(forces(vt.HalfSpace()), rel=1e-3)


def test_forces_without_noise_give_back_the_interface_on_a_layer():
    body = layer(1.0)
    speeds = SPEEDS[[0, 1, 3]]
    true = forces(body, speeds=speeds)
    # a half-space would explain them by another interface
    assert true[0] > 1.2 * forces(vt.HalfSpace())[0]
    fit = fitted(true, 1e-3, speeds, body=body, theory=0.0)
    assert len(fit.series) == len(speeds)
    assert fit.work_of_adhesion == pytest.approx(WORK, rel=0.01)
    assert fit.equilibrium_gap == pytest.approx(GAP, rel=0.05)
    forecast = forecast_rates(fit, [3e-6])
    expected = forces(body, speeds=forecast.speed)
    assert forecast.force == pytest.approx(expected, rel=0.01)
    assert holds(forecast, expected)


@pytest.mark.slow
def test_the_interval_of_a_simulated_series_on_a_layer_holds_the_truth():
    gap = BETA**2 / RADIUS / 8.0  # Tabor number 8
    body, load, speeds = layer(1.0), 5 * PRELOAD, np.geomspace(1e-5, 1e-3, 3)
    found = []
    for speed in speeds:
        problem = vt.Problem(
            material=RUBBER,
            traction=vt.LennardJones(work_of_adhesion=WORK, equilibrium_gap=gap),
            geometry=vt.Sphere(radius=RADIUS),
            body=body,
            protocol=vt.Retraction(start=vt.AtForce(load), speed=float(speed)),
        )
        run = vt.solve(problem, until="pull-off", accuracy=5e-3, estimate_error=False)
        found.append(run.pull_off_force * 1.5 * np.pi * RADIUS * WORK)
    fit = fitted(found, 0.01, speeds, body=body, preload=load)
    assert len(fit.series) == len(speeds)
    for name, value in (("work_of_adhesion", WORK), ("equilibrium_gap", gap)):
        ends = fit.intervals[name]
        assert ends.low < value < ends.high < 2 * ends.low
    assert fit.work_of_adhesion == pytest.approx(WORK, rel=0.05)


@pytest.mark.slow
def test_speeds_at_which_the_forces_reach_through_a_layer_are_left_out():
    gap, body, load = 2.3 * GAP, layer(0.3), 5 * PRELOAD
    pulled = Forward(RUBBER, RADIUS, body=body).pulled(WORK, gap, SPEEDS, load)
    through = pulled.through > MOST_ZONE
    assert 0 < through.sum() <= len(SPEEDS) - 2
    case = {"preload": load, "theory": 0.0}
    fit = fitted(pulled.force, 1e-3, body=body, **case)
    assert [one.speed for one in fit.series] == SPEEDS[~through].tolist()
    assert [one.speed for one, _ in fit.excluded] == SPEEDS[through].tolist()
    # ranges that reach through are not searched
    most = max(one.high for one in fit.objective.parameters if one.name == "equilibrium_gap")
    assert most < 1.5 * gap
    fast = float(SPEEDS[-1])
    with pytest.raises(vt.OutOfRange, match="thin"):
        forecast_rates(fit, [fast])


@pytest.mark.parametrize(
    "more",
    [{"stiffness": 1e4}, {"curves": True}, {"growth": True}],
    ids=["machine", "curves", "growth"],
)
def test_what_is_not_known_on_a_layer_is_refused(more):
    travelled = [
        replace(one, travels=(one.force,) * 4) for one in measured(forces(layer(1.0)), 0.01, SPEEDS)
    ]
    series = RateSeries(travelled, body=layer(1.0), **CASE, **more)
    with pytest.raises(vt.InputError, match="layer"):
        identify_rates(series)
