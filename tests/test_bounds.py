"""What a simulation refuses: how many of what, how large, and numbers beyond the physical."""

import tracemalloc
from dataclasses import replace

import pytest

from effort import calls
from punches import resized
from viscotack.errors import InputError
from viscotack.model.geometry import Bonded, FlatPunch, Layer
from viscotack.model.materials import StandardSolid
from viscotack.model.problem import Groups
from viscotack.model.protocol import AtDepth, Dwell, MoveTo
from viscotack.result import Outcome
from viscotack.simulate import solve
from viscotack.simulate.jumps import _MOST_MESHES
from viscotack.simulate.mesh import MOST_NODES

SOLID = StandardSolid(rubbery_modulus=1.0, glassy_modulus=10.0, tau0=1.0, poisson_ratio=0.0)
SPHERE = Groups(tabor=1.0, material=SOLID, start=AtDepth(1.0), rate=10.0)
PUNCH = Groups(
    tabor=None,
    cohesion=0.05,
    geometry=FlatPunch(20.0),
    body=Layer(3.0),
    material=SOLID,
    start=AtDepth(1.0),
    rate=10.0,
)


# --- how many


def test_a_mesh_of_too_many_nodes_is_refused_before_there_is_a_matrix():
    tracemalloc.start()
    with pytest.raises(InputError, match="nodes, and a simulation takes up to 4000: ask for"):
        solve(resized(PUNCH, size=2000.0, thickness=1.0, base=Bonded(poisson_ratio=0.5)))
    with pytest.raises(InputError, match="the mesh would have .* nodes"):
        solve(replace(SPHERE, tabor=19.0), accuracy=1e-6)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < MOST_NODES**2  # bytes: a matrix has eight times as many


@pytest.mark.march
def test_a_wide_punch_on_a_thin_bonded_layer_is_solved():
    glued = resized(PUNCH, size=60.0, thickness=0.5, base=Bonded(poisson_ratio=0.5))
    result = solve(glued, accuracy=0.02, estimate_error=False)
    # the last of it may go in a jump
    assert result.outcome in (Outcome.DETACHED, Outcome.JUMPED)
    # all of it reaches the strength at once, and the edge is where the mesh has it
    assert -result.force.min() == pytest.approx(1.0, abs=0.02)
    assert result.statistics["meshes"] < _MOST_MESHES


# --- numbers beyond the physical


@pytest.mark.parametrize(
    ("problem", "said"),
    [
        (replace(SPHERE, rate=1e300), "the rate of the retraction"),
        (replace(SPHERE, stiffness=1e-300), "the stiffness of the machine"),
        (replace(PUNCH, start=AtDepth(1e30)), "depth of about 1e.30 h0"),
        (replace(SPHERE, moves=(Dwell(1.0), MoveTo(1e300, 1.0))), "the depth of move 2"),
        (replace(SPHERE, moves=(Dwell(1e18),)), "the retraction begins with steps of"),
        (resized(PUNCH, size=1e-8, thickness=1e8), "thickness over size"),
    ],
)
def test_a_number_that_no_simulation_takes_is_named(problem, said):
    def refused_by_name():
        with pytest.raises(InputError, match=said):
            solve(problem)

    assert calls(refused_by_name) < 100_000  # a simulation makes millions


@pytest.mark.march
@pytest.mark.parametrize(
    ("large", "limit"),
    [
        ({"rate": 1e99}, {"rate": 1e15}),
        ({"stiffness": 1e99}, {"stiffness": 1e9}),
        ({"moves": (Dwell(1e8),)}, {"moves": (Dwell(1e4),)}),
    ],
)
def test_within_the_bounds_the_limits_answer(large, limit):
    one, other = (
        solve(replace(SPHERE, **changes), until="pull-off", estimate_error=False)
        for changes in (large, limit)
    )
    assert one.force.min() == pytest.approx(other.force.min(), rel=2e-3)
