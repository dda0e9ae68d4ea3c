"""A law, a material, a shape and an observable of a user's own: one file each, and all is known."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import viscotack as vt
from command_line import answered, exit_status, refused
from viscotack.campaign import Store, read_plan, run
from viscotack.model.problem.nouns import known, own_nouns

OWN = Path(__file__).resolve().parents[1] / "examples" / "own"
FILES = {"law": "morse.py", "material": "cole_cole.py", "shape": "rounded_cone.py"}
MORSE, ZENER, SHAPE, RADIUS = own_nouns(OWN / file for file in FILES.values())

CASE = """
[material]
model = "cole-cole"
rubbery_modulus = "1.5 MPa"
glassy_modulus = "15 MPa"
tau0 = "0.1 s"
order = 0.6
poisson_ratio = 0.5

[interface]
law = "morse"
work_of_adhesion = "0.15 J/m^2"
equilibrium_gap = "0.5 um"
steepness = 3

[rounded-cone]
slope = 0.2
rounding = "20 um"

[protocol]
preload_force = "20 uN"
speed = "10 um/s"
"""


@pytest.fixture
def case_file(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    return path


@pytest.fixture
def problem(case_file):
    return vt.read_case(case_file, also=(MORSE, ZENER, SHAPE))


# What loads the three files in a command.
WITH = [word for file in FILES.values() for word in ("--with", OWN / file)]


def test_they_are_simulated_saved_and_loaded(problem, tmp_path):
    result = vt.solve(problem, until="pull-off", accuracy=1e-2, estimate_error=False)
    assert vt.pull_off_force(result) > 0
    vt.save(result, tmp_path / "run.npz")
    with pytest.raises(ValueError, match="'rounded-cone'.*--with FILE.py"):
        vt.load(tmp_path / "run.npz")
    again = vt.load(tmp_path / "run.npz", also=(MORSE, ZENER, SHAPE))
    assert again.problem == problem
    np.testing.assert_array_equal(again.force, result.force)
    assert vt.run_id(again.problem) == vt.run_id(problem)
    found = vt.summary(again, also=(RADIUS,))
    assert found["largest_contact_radius"] == np.nanmax(result.contact_radius)
    assert found["largest_contact_radius_m"] == pytest.approx(
        found["largest_contact_radius"] * problem.scales().radius
    )
    assert found["rounding"] == problem.groups().geometry.rounding


def test_the_command_line_loads_own_parts(case_file, tmp_path, capsys):
    run = tmp_path / "run.npz"
    how = ["--until", "pull-off", "--accuracy", 1e-2, "--save", run]
    answer = answered(["simulate", "case", case_file, *how, *WITH], capsys)
    assert answer["problem"]["interface"]["law"] == "morse"
    assert answer["largest_contact_radius_m"] > 0
    assert exit_status(["show", run, *WITH]) == 0
    assert "largest contact radius" in capsys.readouterr().out
    assert "--with FILE.py" in refused(["show", run], capsys)


def test_a_campaign_keeps_their_numbers_and_goes_on(case_file, tmp_path):
    plan = tmp_path / "plan.toml"
    files_of_own = [OWN / file for file in FILES.values()]
    files = ", ".join(f'"{file}"' for file in files_of_own)
    plan.write_text(
        f"""problem = "{case_file.name}"
with = [{files}]
[settings]
accuracy = 1e-2
[[grid]]
interface.steepness = {{linear = [2.0, 3.0], count = 2}}
rounded-cone.rounding = 20e-6
"""
    )
    done = run(read_plan(plan, own=files_of_own), tmp_path / "study", workers=1)
    assert (done.done, done.failed) == (2, 0)
    rows = list(Store(tmp_path / "study").results())
    assert all(row["largest_contact_radius_m"] > 0 for row in rows)
    assert [row["interface.steepness"] for row in rows] == [2.0, 3.0]
    assert run(None, tmp_path / "study", workers=1, own=files_of_own).done == 2


@pytest.mark.slow
def test_a_theory_predicts_with_own_parts(capsys):
    sphere = "predict sphere --modulus-ratio 0.1 --tabor 30 --preload 200 --rate 100".split()
    own, other = (
        answered([*sphere, "--material", f"{word}:0.6", *WITH], capsys)["pull_off_force"]
        for word in ("cole-cole", "fractional-zener")
    )
    assert own == pytest.approx(other, rel=1e-5)


def test_an_incomplete_noun_is_refused_before_anything_is_solved():
    for missing in ("symmetry", "flank"):
        members = {k: v for k, v in vars(SHAPE).items() if k not in (missing, "__dict__")}
        poor = type("Poor", (), members | {"word": "poor"})
        with pytest.raises(ValueError, match=f"'Poor' is not .*: as a shape it lacks {missing};"):
            known((poor,))
    bare = type("Bare", (MORSE,), {"word": "bare", "__annotations__": {"extra": float}})
    with pytest.raises(ValueError, match="Bare.extra has no card and so no unit"):
        known((dataclass(frozen=True)(bare),))
