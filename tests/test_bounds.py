"""What a simulation refuses: how many of what, how large, and numbers beyond the physical."""

import tracemalloc
from dataclasses import replace

import pytest

from command_line import exit_status
from effort import calls
from punches import resized
from viscotack.bem.jumps import _MOST_MESHES
from viscotack.bem.mesh import MOST_NODES, Grading
from viscotack.errors import InputError
from viscotack.geometry import Bonded, FlatPunch, Layer
from viscotack.materials import Prony, StandardSolid
from viscotack.methods import solve
from viscotack.problem import Groups
from viscotack.protocol import (
    Apart,
    Approach,
    AtDepth,
    AtForce,
    Dwell,
    LoadTo,
    MoveTo,
    Retract,
)
from viscotack.protocol.words import history_from_file
from viscotack.result import Outcome
from viscotack.traction import Exponential, Tabulated

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
WORDS = "simulate sphere --tabor 3 --modulus-ratio 0.1 --exponent 0.8 --preload 5".split()


def refused(capsys, *arguments):
    assert exit_status([*WORDS, *arguments]) == 2
    return capsys.readouterr().err


# --- how many


def test_tables_have_a_bound(tmp_path, capsys):
    table = tmp_path / "table.csv"
    rows = "\n".join(f"{1 + i},{i}" for i in range(10_002))
    table.write_text(f"time_s,displacement_um\n{rows}\n")
    with pytest.raises(InputError, match="at most 10,001 rows .* got 10,002; remove rows"):
        history_from_file(table, 1e-6)
    table.write_text(f"gap_um,traction_kPa\n{rows}\n")
    words = refused(capsys, "--rate", "1", "--law", f"table:{table}")
    assert "table.csv: at most 10,000 rows" in words
    gap = [0.5 + 1e-4 * i for i in range(10_001)]
    with pytest.raises(InputError, match="at most 10,000 gaps, got 10,001; remove rows"):
        Tabulated.of_points(gap, [0.0] * len(gap))
    with pytest.raises(InputError, match="at most 10,000 gaps, got 10,001; remove rows"):
        Tabulated(1.0, 1.0, tuple((x, 0.0) for x in gap))
    with pytest.raises(InputError, match="at most 10,000 branches, got 10,001; ten per decade"):
        branches = [(1.0, 1.0 + i) for i in range(10_001)]
        Prony(rubbery_modulus=1.0, branches=branches, poisson_ratio=0.0)


def test_a_mesh_of_too_many_nodes_is_refused_before_there_is_a_matrix():
    tracemalloc.start()
    for punch in (
        resized(PUNCH, size=2000.0, thickness=1.0, base=Bonded(poisson_ratio=0.5)),
        resized(PUNCH, size=1e9, thickness=1.0, base=Bonded(poisson_ratio=0.5)),
    ):
        with pytest.raises(InputError, match="nodes, and a simulation takes up to 4000: ask for"):
            solve(punch)
    with pytest.raises(InputError, match="the mesh would have .* nodes"):
        solve(replace(SPHERE, tabor=19.0), accuracy=1e-6)
    endless = Grading(1e-300, 1.0, 0.1, 0.1, 10.0, 1e-300, 1.0)
    with pytest.raises(InputError, match=f"takes up to {MOST_NODES}"):
        endless.nodes(1.0, 1.0)
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
        (replace(SPHERE, rate=1e300), "the rate of the retraction must lie between 1e-100 and"),
        (replace(SPHERE, rate=1e-300), "1e-100 and 1e.100 h0/tau0 .* got 1e-300 h0/tau0"),
        (replace(PUNCH, rate=1e300), "the rate of the retraction .* got 1e.300 h0/tau0"),
        (replace(SPHERE, stiffness=1e300), "the stiffness of the machine .* got 1e.300 1.5 pi R"),
        (replace(SPHERE, stiffness=1e-300), "stiffness of the machine must lie between 1e-09"),
        (replace(SPHERE, start=AtDepth(1e300)), "the depth of the start .* got 1e.300 h0"),
        (replace(SPHERE, start=AtForce(-1e300)), "the force of the start .* got -1e.300 1.5 pi"),
        (replace(SPHERE, start=Apart(1e300)), "the gap of the start .* got 1e.300 h0"),
        (replace(SPHERE, start=AtDepth(1e30)), "the start, depth 1e.30, presses to"),
        (replace(PUNCH, start=AtDepth(1e30)), "depth of about 1e.30 h0, .* takes up to 1e.07"),
        (replace(SPHERE, moves=(Dwell(1e300),)), "the duration of move 1 .* got 1e.300 tau0"),
        (replace(SPHERE, moves=(Dwell(1.0), MoveTo(1e300, 1.0))), "the depth of move 2 .* got"),
        (replace(SPHERE, moves=(MoveTo(1e30, 1.0),)), "move 1, .* presses to a depth of about"),
        (replace(SPHERE, moves=(LoadTo(1e30, 1.0),)), "move 1, .* presses to a depth of about"),
        (
            replace(SPHERE, moves=(Retract(1e-300, AtDepth(0.0)),)),
            "the speed of move 1 .* got 1e-300 h0/tau0",
        ),
        (
            replace(SPHERE, moves=(Retract(1.0, AtDepth(-1e300)),)),
            "the depth of the end of move 1 must lie between -1e.100 and 1e.100 h0",
        ),
        (replace(SPHERE, moves=(Dwell(1e18),)), "the retraction begins with steps of .* 1e.18"),
        (
            replace(SPHERE, moves=(Approach(1e-30, AtDepth(3.0)), Dwell(1.0))),
            "move 2 begins with steps of 1e-06 time units when about .* have passed",
        ),
        (replace(SPHERE, traction=Exponential(1.0, 1.0, 1e-300)), "over the range of the law"),
        (resized(PUNCH, size=1e300), "size must lie between 1e-09 and 1e.09 .* got 1e.300"),
        (resized(PUNCH, thickness=1e-300), "thickness must lie between .* got 1e-300"),
        (resized(PUNCH, size=1e-8, thickness=1e8), "thickness over size must .* got 1e.16"),
    ],
)
def test_a_number_that_no_simulation_takes_is_named(problem, said):
    def refused_by_name():
        with pytest.raises(InputError, match=said):
            solve(problem)

    assert calls(refused_by_name) < 100_000  # a simulation makes millions


@pytest.mark.parametrize(
    ("tabor", "said"),
    [
        ("1e-300", "--tabor must be at least 1e-06 for a simulation, got 1e-300"),
        ("1e-6", "--preload 5 at --tabor 1e-06 gives"),
    ],
)
def test_a_tiny_tabor_number_is_not_taken_for_a_large_preload(tabor, said, capsys):
    flags = [tabor if word == "3" else word for word in WORDS]
    assert exit_status([*flags, "--rate", "1"]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.march
@pytest.mark.parametrize(
    ("large", "limit"),
    [
        ({"rate": 1e99}, {"rate": 1e15}),
        ({"rate": 1e-99}, {"rate": 1e-9}),
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
