"""A body of a user's own, in one file: through every door, and refused by each tier but one."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import viscotack as vt
from dimensionless import SOLID
from viscotack.model.problem.nouns import own_nouns
from viscotack.prediction.tier import SIMULATION
from viscotack.prediction.tiers import TIERS

OWN = Path(__file__).resolve().parents[1] / "examples" / "own"
FILE, CASE = OWN / "foundation.py", OWN / "foundation.toml"
(FOUNDATION,) = own_nouns([FILE])
BODIES = {
    "half-space": vt.HalfSpace(),
    "layer": vt.Layer(3.0),
    "bonded layer": vt.Layer(3.0, vt.Bonded(poisson_ratio=0.3)),
    "foundation": FOUNDATION(3.0),
}
# Each kind of shape of revolution, reduced.
_TIP = vt.MeasuredProfile.sampled(lambda r: max(r * r - 0.25, 0.0) / 2, np.linspace(0.0, 6.0, 61))
SHAPES = [
    vt.Sphere(1.0),
    vt.Cone(1.0),
    vt.PowerLawProfile(1 / 3, 3.0),
    vt.WavySphere(1.0, 0.1, 1.0),
    _TIP.reduced(1.0, 1 / _TIP.equivalent_radius(1.0)),
    vt.Disc(1.0),
    vt.Disc(1.0, edge_width=0.1, edge_height=0.2),
]
CHEAP = [tier for tier in TIERS if tier.name != SIMULATION]


@pytest.fixture(scope="module")
def problem():
    return vt.read_case(CASE, also=(FOUNDATION,))


@pytest.fixture(scope="module")
def result(problem):
    return vt.solve(problem, until="pull-off", accuracy=1e-2, estimate_error=False)


def test_it_is_simulated_and_named(problem, result):
    stiff = vt.solve(replace(problem, body=vt.HalfSpace()), accuracy=1e-2, estimate_error=False)
    force = vt.pull_off_force(result)
    assert abs(force / vt.pull_off_force(stiff) - 1) > 0.02
    assert vt.run_id(problem) != vt.run_id(replace(problem, body=FOUNDATION(60e-6)))
    assert vt.summary(result)["thickness"] == problem.groups().body.thickness


@pytest.mark.parametrize("tier", CHEAP, ids=lambda tier: tier.name)
def test_a_tier_rejects_every_shape_on_every_body_outside_its_lists(tier):
    rejected = 0
    for shape in SHAPES:
        for body in BODIES.values():
            case = vt.Groups(8.0, SOLID, vt.AtDepth(40.0), 30.0, geometry=shape, body=body)
            kinds = type(shape), type(getattr(body, "base", body))
            if any(kinds[0] in v.shapes and kinds[1] in v.bodies for v in tier.verified):
                continue
            with pytest.raises(vt.OutOfRange, match="the (shape|body) is"):
                tier.answer(case)
            rejected += 1
    assert rejected >= len(SHAPES) * len(BODIES) - 3


@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
def test_beyond_the_simulation_only_verified_contacts_are_answered(body):
    solid = vt.Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    for shape in SHAPES:
        case = vt.Groups(300.0, solid, vt.AtDepth(600.0), 1.0, geometry=shape, body=body)
        if body == vt.HalfSpace() and type(shape) in (vt.Sphere, vt.Cone, vt.PowerLawProfile):
            assert vt.solve(case, estimate_error=False).method == "crack contact"
            continue
        with pytest.raises(vt.InputError, match="Tabor number"):
            vt.solve(case)


def test_small_strain_is_judged_on_the_body(problem):
    # a sphere sinks into springs as far as its gap; on a half-space half as far at a radius
    R = problem.geometry.radius
    deep = vt.Retraction(vt.AtDepth(0.2 * R), 1e-5)
    vt.Problem(problem.material, problem.traction, problem.geometry, deep)
    with pytest.raises(vt.InputError, match="exceeds small strain"):
        replace(problem, protocol=deep)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (dict(tabor=3.0), "no Tabor number"),
        (dict(body=vt.HalfSpace()), "needs a layer"),
        (dict(start=vt.AtRadius(1.0)), "cannot start at a contact radius"),
    ],
)
def test_groups_that_do_not_go_together_are_refused(wrong, words):
    solid = vt.Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    parts = dict(
        tabor=None,
        cohesion=0.5,
        geometry=vt.FlatPunch(8.0),
        body=vt.Layer(0.3),
        material=solid,
        start=vt.AtDepth(1.0),
        rate=1.0,
    )
    vt.Groups(**parts)
    with pytest.raises(vt.InputError, match=words):
        vt.Groups(**parts | wrong)
