"""Relations between answers that need no reference value, on random problems.

Each relates an answer to one that follows from it: units, rest and what comes after change nothing;
energies balance; limits and the surrogate bound a force. Hypothesis draws the same
few problems in every run, and four times as many in those marked slow.
"""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import viscotack as vt
from dimensionless import ELASTIC
from solids import creep_power_law, standard_solid

ACCURACY = 0.01


def related(few, **drawn):
    """Turn a check of random arguments into a test of a few examples, and of many if slow."""

    def decorate(check):
        @pytest.mark.parametrize("count", [few, pytest.param(4 * few, marks=pytest.mark.slow)])
        def test(count):
            settings(max_examples=count)(given(**drawn)(check))()

        test.__doc__ = check.__doc__
        return test

    return decorate


def decades(low, high):
    """Numbers that are even in their logarithm, with few digits."""
    return st.floats(np.log10(low), np.log10(high)).map(lambda x: float(f"{10**x:.4g}"))


@st.composite
def standard_solids(draw):
    return standard_solid(1.0, draw(decades(1.5, 100)), 1.0, 0.0)


@st.composite
def series(draw):
    """Prony series of arms a decade or more apart, the slowest of 1."""
    count = draw(st.integers(1, 4))
    times = np.cumprod([1.0, *(draw(decades(0.02, 0.1)) for _ in range(count - 1))])
    arms = tuple((draw(decades(0.05, 10)), float(time)) for time in times)
    return vt.Prony(rubbery_modulus=1.0, branches=arms, poisson_ratio=0.0)


@st.composite
def power_laws(draw):
    return creep_power_law(
        1.0, draw(decades(2, 100)), draw(st.floats(0.3, 1.6).map(lambda x: round(x, 3))), 1.0, 0.0
    )


RELAXING = st.one_of(standard_solids(), series())
LAWS = st.one_of(
    st.just(vt.LennardJones(1.0, 1.0)),
    decades(0.1, 0.5).map(lambda decay: vt.Exponential(1.0, 1.0, decay=decay)),
)


@st.composite
def contacts(draw, material=RELAXING, tabor=(0.1, 1.5)):
    """Spheres that are pressed and pulled off, each a tenth of a second of processor time."""
    mu = draw(decades(*tabor))
    return vt.Groups(
        tabor=mu,
        material=draw(material),
        traction=draw(LAWS),
        start=vt.AtDepth(draw(decades(0.3, 3)) * (mu + 0.5)),
        rate=draw(decades(0.1, 100)) * (mu + 1),
    )


def solved(problem, **options):
    return vt.solve(problem, accuracy=ACCURACY, estimate_error=False, **options)


def pulled(problem):
    """Return pull-off force, and work and depth there."""
    result = solved(problem, until="pull-off")
    return np.array(
        [vt.pull_off_force(result), vt.work_to_pull_off(result), vt.depth_at_pull_off(result)]
    )


def agree(one, other, tolerance):
    """Compare force, work and depth; works and depths may be near 0."""
    assert other == pytest.approx(one, rel=tolerance, abs=tolerance)


@related(
    3, case=contacts(), modulus=decades(1e4, 1e9), time=decades(1e-3, 1e3), gap=decades(1e-9, 1e-7)
)
def test_units_scale_out(case, modulus, time, gap):
    problem = case.in_si(
        contact_modulus=modulus,
        time_unit=time,
        poisson_ratio=0.3,
        radius=1e8 * gap,
        equilibrium_gap=gap,
    )
    result = solved(problem, until="pull-off")
    agree(
        pulled(case),
        [vt.pull_off_force(result), vt.work_to_pull_off(result), vt.depth_at_pull_off(result)],
        1e-6,
    )
    said = vt.summary(result)
    assert said["pull_off_force_N"] == pytest.approx(
        said["pull_off_force"] * 1.5 * np.pi * problem.radius * problem.traction.work_of_adhesion,
        rel=1e-12,
    )


@related(3, case=contacts(), duration=decades(0.1, 100), share=st.floats(0.2, 0.8))
def test_rest_and_a_retraction_in_two_moves_change_nothing(case, duration, share):
    known, depth = pulled(case), case.start.depth
    resting = replace(case, moves=(vt.Dwell(duration, "depth"),))
    result = solved(resting, until="pull-off")
    waits = result.time <= duration
    assert np.max(np.abs(result.force[waits] - result.force[0])) < 1e-6 * (1 + abs(result.force[0]))
    agree(known, pulled(resting), ACCURACY)
    # up to a place before the force is tensile
    way = vt.Retract(case.rate, vt.AtDepth(depth * (1 - 0.2 * share)))
    agree(known, pulled(replace(case, moves=(way,))), ACCURACY)


@related(3, case=contacts())
def test_the_pull_off_does_not_depend_on_what_comes_after(case):
    result = solved(case)
    whole = [vt.pull_off_force(result), vt.work_to_pull_off(result), vt.depth_at_pull_off(result)]
    agree(pulled(case), whole, 1e-6)
    assert whole[0] == pytest.approx(-np.min(result.force), rel=2 * ACCURACY)


@related(4, case=contacts(), stiffness=st.one_of(st.none(), decades(0.1, 10)))
def test_work_is_stored_lost_or_heat(case, stiffness):
    result = solved(replace(case, stiffness=stiffness))
    e = result.energy
    spring = 0 * result.force if stiffness is None else result.force**2 / (2 * stiffness)
    stored = e.elastic + e.interface + spring
    missing = e.drive - (stored - stored[0]) - e.heat - e.interface_heat - e.jumps - e.transfer
    scale = max(float(np.max(np.abs(each))) for each in (e.drive, stored - stored[0], e.heat))
    assert np.max(np.abs(missing)) < 2e-2 * scale
    assert e.spring == pytest.approx(spring, abs=1e-6 * scale)
    for rising in (e.heat, e.jumps):
        assert rising[0] == 0 and np.all(np.diff(rising) >= -1e-3 * scale)
    assert np.sum(e.mode_heat) == pytest.approx(e.heat[-1], abs=1e-9 * scale)


@related(3, case=contacts(), factor=decades(2, 30))
def test_the_force_rises_with_the_rate_between_its_two_limits(case, factor):
    slow = pulled(replace(case, material=ELASTIC))[0]
    force, faster = pulled(case)[0], pulled(replace(case, rate=case.rate * factor))[0]
    assert slow * (1 - 3 * ACCURACY) <= force <= faster * (1 + 3 * ACCURACY)
    # a glassy sphere of the radius R/k, and the most that any range of forces gives
    assert faster <= 4 / 3 / case.modulus_ratio * (1 + 3 * ACCURACY)


@related(3, case=contacts(tabor=(0.1, 0.8)), depth=decades(1, 3))
def test_a_loop_of_a_viscoelastic_solid_takes_work(case, depth):
    loop = (
        vt.Approach(case.rate, vt.AtDepth(case.start.depth + depth)),
        vt.Retract(case.rate, vt.AtDepth(case.start.depth)),
    )
    result = solved(replace(case, moves=loop, rate=None))
    (cycle,) = vt.cycles(result)
    gross = float(np.abs(np.diff(result.depth)) @ np.abs(result.force[1:] + result.force[:-1]) / 2)
    left = result.energy.elastic + result.energy.interface
    assert cycle.hysteresis >= left[-1] - left[0] - 5 * ACCURACY * gross


@related(3, case=contacts(material=power_laws()))
def test_the_surrogate_holds_the_simulation(case):
    case = replace(case, traction=vt.LennardJones(1.0, 1.0))
    said = vt.predict(case, budget=0.1)
    low, high = (3 * (end - said.pull_off_force) for end in said.interval)
    off = pulled(case)[0] - said.pull_off_force
    assert low - ACCURACY * said.pull_off_force <= off <= high + ACCURACY * said.pull_off_force
