"""The grid beside contacts of revolution, limits and symmetries that need no reference."""

from dataclasses import replace

import numpy as np
import pytest

import viscotack as vt
from viscotack.model.surfaces import HeightMap, bumps, self_affine, sphere
from viscotack.simulate.grid import run
from viscotack.simulate.rough import RoughProblem, pull

RADIUS, GAP = 5e-3, 1.5e-6
ALONG = np.sqrt(RADIUS * GAP)
PLATEAUS = {"rubbery_modulus": 1.5e6, "poisson_ratio": 0.5}
ELASTIC = vt.Elastic(**PLATEAUS)
VISCOUS = vt.StandardSolid(**PLATEAUS, glassy_modulus=15e6, tau0=0.1)
POWER = vt.RetardationPowerLaw(**PLATEAUS, glassy_modulus=150e6, exponent=0.5, tau0=0.1)
SOFT = vt.LennardJones(work_of_adhesion=0.15, equilibrium_gap=GAP)


def law(tabor, material=ELASTIC):
    """Return a law with which the sphere has this Tabor number."""
    work = np.sqrt(tabor**3 * material.contact_modulus**2 * GAP**3 / RADIUS)
    return vt.LennardJones(work_of_adhesion=work, equilibrium_gap=GAP)


def both(tabor, material, test, body):
    """Pull a sphere on the grid and as a contact of revolution; forces in 1.5 pi R dg."""
    traction = law(tabor, material)
    unit = 1.5 * np.pi * RADIUS * traction.work_of_adhesion
    common = {"material": material, "traction": traction, "protocol": test(unit), "body": body}
    surface = sphere(64, 12 * ALONG / 64, radius=RADIUS)
    found = pull(RoughProblem(surface=surface, **common), estimate_error=False)
    exact = vt.solve(vt.Problem(geometry=vt.Sphere(RADIUS), **common), estimate_error=False)
    return found, exact, unit


def retracted(F):
    return vt.Retraction(start=vt.AtForce(0.3 * F), speed=30e-6)


def pressed(F):
    """Return an approach, a dwell and a retraction behind a spring."""
    moves = vt.Approach(speed=10e-6, to=vt.AtForce(0.5 * F)), vt.Dwell(duration=0.3)
    stiffness = 0.3 * F / GAP
    return vt.Retraction(start=vt.Apart(10e-6), moves=moves, speed=100e-6, stiffness=stiffness)


GLUED = vt.Layer(thickness=2 * ALONG, base=vt.Bonded(poisson_ratio=0.5))
CASES = {
    "elastic": (0.5, ELASTIC, retracted, vt.HalfSpace()),
    "power law": (0.7, POWER, retracted, vt.HalfSpace()),
    "glued layer": (1.0, VISCOUS, retracted, GLUED),
    "sliding layer": (1.0, VISCOUS, retracted, vt.Layer(thickness=2 * ALONG)),
    "spring, approach and dwell": (1.0, VISCOUS, pressed, vt.HalfSpace()),
}


@pytest.mark.parametrize(
    "name", [pytest.param(x, marks=[pytest.mark.slow] * ("dwell" in x)) for x in CASES]
)
def test_a_sphere_pulls_off_as_one_of_revolution(name):
    found, exact, unit = both(*CASES[name])
    assert found.pull_off_force / unit == pytest.approx(vt.pull_off_force(exact), rel=2e-3)
    assert found.work_of_separation / (unit * GAP) == pytest.approx(
        vt.work_of_separation(exact), rel=4e-3
    )
    assert found.energy_residual < 1e-3
    assert len(found.events) == len(exact.events)


@pytest.mark.slow
def test_a_dead_load_falls_after_the_same_time():
    def test(F):
        moves = (vt.LoadTo(force=-1.3 * F, duration=0.05), vt.Dwell(duration=10.0, hold="force"))
        return vt.Retraction(start=vt.AtForce(0.3 * F), moves=moves, speed=None)

    found, exact, _ = both(1.0, VISCOUS, test, vt.HalfSpace())
    held = exact.events[-1].time * exact.problem.scales().time  # type: ignore[union-attr]
    assert found.events[-1].time == pytest.approx(held, rel=1e-2)
    assert found.events[-1].kind == "jump out of contact"


@pytest.mark.parametrize("load", [0.5, -0.5])
@pytest.mark.parametrize("refined", [True, False])
def test_a_test_starts_at_its_load_with_what_lies_beyond_the_map(monkeypatch, refined, load):
    traction = law(1.0)
    start = vt.AtForce(load * 1.5 * np.pi * RADIUS * traction.work_of_adhesion)
    surface = sphere(72, 8 * ALONG / 72, radius=RADIUS)
    problem = rough(surface, traction=traction, protocol=vt.Retraction(start=start, speed=1e-5))
    monkeypatch.setattr(run, "_COARSEST", 36 if refined else 72)
    contact = problem.contact
    found = run.relaxed(contact, problem.units.scaled(start))
    assert contact.force_under(found.tension, found.depth) == pytest.approx(load, rel=1e-7)


@pytest.mark.parametrize("start", [vt.AtForce(-1e-3), vt.AtForce(1e-3), vt.AtDepth(3e-6)])
def test_a_start_refined_from_larger_pixels_is_that_of_a_slow_approach(monkeypatch, start):
    problem = rough(protocol=vt.Retraction(start=start, speed=1e-5))
    contact, begin = problem.contact, problem.units.scaled(start)
    slow = run.relaxed(contact, begin)
    monkeypatch.setattr(run, "_COARSEST", 16)
    shapes, approached = [], run._approached
    monkeypatch.setattr(
        run, "_approached", lambda *a: shapes.append(a[0].plane.shape) or approached(*a)
    )
    found = run.relaxed(contact, begin)
    assert shapes == [(16, 16)]
    assert found.depth == pytest.approx(slow.depth, rel=1e-6)
    np.testing.assert_allclose(found.gap, slow.gap, atol=1e-4)


def flat(pixels=8, body=None):
    # narrow: a wide one in tension is not stable and opens in waves
    plane = HeightMap(np.zeros((pixels, pixels)), 2e-6, periodic=True)
    given = {
        "surface": plane,
        "material": ELASTIC,
        "traction": SOFT,
        "body": body or vt.HalfSpace(),
    }
    return RoughProblem(**given, protocol=vt.Retraction(start=vt.AtDepth(0.0), speed=1e-6))


def test_a_flat_map_on_a_half_space_has_the_strength_of_the_law():
    found = pull(flat())
    # the mean plane is held, so that nothing jumps and the curve is the law's
    assert len(found.force) < 150  # rounding that lets the mean drift makes steps ever shorter
    assert found.pull_off_stress == pytest.approx(SOFT.strength, rel=1e-3)
    assert found.work_of_separation / found.nominal_area == pytest.approx(0.15, rel=2e-3)
    assert found.area.max() == found.nominal_area


def test_a_flat_map_on_a_layer_jumps_off_at_the_strength():
    layer = vt.Layer(thickness=1e-3)
    found = pull(flat(body=layer))
    assert found.pull_off_stress == pytest.approx(SOFT.strength, rel=5e-3)
    assert found.events[-1].kind.startswith("jump")
    # elongation of the layer at the strength, of E* = E/(1 - nu^2)
    drawn = SOFT.strength * layer.thickness / ELASTIC.contact_modulus
    at = found.depth[found.at_pull_off]
    assert -at == pytest.approx(drawn + SOFT.edge_gap - GAP, rel=5e-3)


@pytest.mark.parametrize(
    "body", [vt.HalfSpace(), vt.Layer(thickness=40e-6, base=vt.Bonded(poisson_ratio=0.5))]
)
def test_a_wide_flat_map_whose_waves_open_first_is_refused(body):
    # on a half-space waves longer than pi E*/fall, 75 um of this law, are not held
    for pixels in (64, 128):
        with pytest.raises(vt.InputError, match="opens under tension in waves"):
            flat(pixels, body)
    # whatever is uneven decides, and the map pulls off
    nearly = self_affine(32, 5e-6, hurst=0.8, rms_height=1e-8, seed=1, shortest=4e-5)
    test = vt.Retraction(start=vt.AtDepth(0.0), speed=1e-6)
    found = pull(rough(nearly, protocol=test), estimate_error=False)
    assert found.has_separated
    assert found.pull_off_stress == pytest.approx(SOFT.strength, rel=5e-3)


def rough(surface=None, **more):
    surface = surface or self_affine(32, 1e-5, hurst=0.8, rms_height=1.5e-6, seed=3, shortest=8e-5)
    test = vt.Retraction(start=vt.AtForce(0.02 * SOFT.strength * surface.area), speed=20e-6)
    given = {"material": VISCOUS, "traction": SOFT, "protocol": test} | more
    return RoughProblem(surface=surface, **given)


def test_shifted_turned_and_repeated_maps_answer_alike():
    problem = rough()
    first = pull(problem, estimate_error=False)
    heights = problem.surface.heights
    same, wide = np.roll(heights.T[::-1], (5, 11), (0, 1)), np.tile(heights, (1, 2))
    moved, twice = (
        pull(rough(replace(problem.surface, heights=each)), estimate_error=False)
        for each in (same, wide)
    )
    assert moved.pull_off_force == pytest.approx(first.pull_off_force, rel=1e-6)
    assert twice.pull_off_force == pytest.approx(2 * first.pull_off_force, rel=1e-3)


def test_a_rough_elastic_map_loses_energy_only_in_jumps():
    found = pull(rough(material=ELASTIC), estimate_error=False)
    assert found.heat[-1] == 0
    assert found.events
    assert found.jumps[-1] == pytest.approx(sum(event.energy for event in found.events), rel=0.05)
    balance = found.work - (found.elastic - found.elastic[0])
    balance = balance - (found.interface - found.interface[0]) - found.jumps
    assert np.abs(balance).max() < 1e-3 * np.abs(found.work).max()


@pytest.mark.parametrize(
    ("traction", "accuracy"),
    [(SOFT, 2e-5), (vt.Dugdale(work_of_adhesion=0.15, equilibrium_gap=GAP), 2e-3)],
)
def test_a_map_without_neighbours_opens_smoothly_with_short_steps_or_a_stiff_wall(
    traction, accuracy
):
    kind = {"hurst": 0.8, "rms_height": 1.5e-6, "seed": 3, "shortest": 8e-5, "periodic": False}
    problem = rough(self_affine(32, 1e-5, **kind), traction=traction)
    found = pull(problem, accuracy=accuracy, estimate_error=False)
    assert not found.events
    assert found.statistics["rejected_steps"] < 0.1 * found.statistics["steps"]


def test_faster_pulls_of_a_rough_map_take_more():
    slow, fast = (
        pull(rough(protocol=vt.Retraction(start=vt.AtDepth(2e-6), speed=v)), estimate_error=False)
        for v in (1e-6, 1e-3)
    )
    assert fast.pull_off_force > 1.5 * slow.pull_off_force


def test_a_load_is_the_same_on_larger_pixels():
    contact = rough(self_affine(64, 6e-6, hurst=0.3, rms_height=2e-6, seed=5)).contact
    assert contact.coarser().unit == contact.every_second(1, 0).unit == contact.unit
    assert contact.coarser().travel != contact.travel


@pytest.mark.parametrize("solid", [ELASTIC, VISCOUS])
def test_stated_errors_hold_against_pixels_half_as_large(solid):
    fine = self_affine(64, 6e-6, hurst=0.8, rms_height=2.5e-6, seed=5, shortest=8e-5)
    coarse = replace(fine, heights=fine.heights[::2, ::2], pixel=2 * fine.pixel)
    test = vt.Retraction(start=vt.AtForce(0.05 * SOFT.strength * fine.area), speed=2e-5)
    found = pull(rough(coarse, material=solid, protocol=test))
    better = pull(rough(fine, material=solid, protocol=test), accuracy=5e-4, estimate_error=False)
    for name, value, true in (
        ("force", found.pull_off_force, better.pull_off_force),
        ("work", found.work_of_separation, better.work_of_separation),
        ("area", found.area.max(), better.area.max()),
    ):
        away = abs(value / true - 1)
        assert away < found.error_estimate[name] < 30 * away


def test_four_bumps_of_four_pixels_at_the_sides_have_the_error_of_one():
    pixel, side = 4.35e-6, 4.35e-6 * 64

    def pulled(count, **how):
        one = bumps(count, side / count, radius=63.2e-6, spacing=side / 2, height=6.6e-6)
        rolled = np.roll(one.heights, (count // 4, count // 4), (0, 1))
        problem = RoughProblem(
            surface=replace(one, heights=rolled),
            material=vt.Elastic(rubbery_modulus=0.75 * 4.15e6, poisson_ratio=0.5),
            traction=vt.LennardJones(0.1, 0.483e-6),
            protocol=vt.Retraction(start=vt.AtForce(3.8e-5), speed=1e-6),
        )
        return pull(problem, **how)

    found, fine = pulled(64), pulled(128, estimate_error=False)
    at = found.at_pull_off
    assert (found.patches[at], found.area[at]) == (4, pytest.approx(16 * pixel**2))
    off = abs(found.pull_off_force / fine.pull_off_force - 1)
    assert 0.15 < off < found.error_estimate["force"] < 1.5 * off


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"traction": vt.LogarithmicAgeing.of(SOFT, reference_time=2.0, sensitivity=0.1)}, "ages"),
        ({"protocol": vt.Retraction(start=vt.AtRadius(1e-5), speed=1e-6)}, "no contact radius"),
        ({"surface": self_affine(32, 1e-7, hurst=0.8, rms_height=1e-6, seed=1)}, "rms slope"),
        (
            {"surface": sphere(32, 1e-5, radius=1e-2), "body": vt.Layer(thickness=1e-3)},
            "its side thick",
        ),
    ],
)
def test_what_is_not_computed_is_refused(change, words):
    with pytest.raises(vt.InputError, match=words):
        replace(rough(), **change)


def test_coarse_pixels_are_refused_unless_forced():
    coarse = self_affine(32, 5e-5, hurst=0.8, rms_height=1.5e-6, seed=3, shortest=4e-4)
    with pytest.raises(vt.InputError, match="2 are needed, as with pixels of 1.13e-05 m"):
        pull(rough(coarse))
    found = pull(rough(coarse), force_coarse=True, estimate_error=False)
    assert "pixels" in found.warnings[0]
