import json
import shlex
import subprocess
import sys

import numpy as np
import pytest

import viscotack as vt
from command_line import exit_status, refused
from solids import creep_power_law
from synthetic import jkr_detachment
from viscotack.app import cli

SPHERE = ["simulate", "sphere"]
ISSUE = "--tabor 3.24 --modulus-ratio 0.1 --exponent 0.8 --preload 73 --rate 316.23".split()


@pytest.fixture
def fake(monkeypatch):
    """Replace the simulation by a ready result; returns what it was asked for."""
    asked = {"result": jkr_detachment()}

    def solve(problem, **options):
        asked.update(options, problem=problem)
        return vt.Result(
            **{
                **{f: getattr(asked["result"], f) for f in asked["result"].__dataclass_fields__},
                "problem": problem,
            }
        )

    monkeypatch.setattr(vt.simulate, "solve", solve)
    return asked


def test_the_five_numbers_are_the_power_law(fake, capsys):
    assert exit_status([*SPHERE, *ISSUE]) == 0
    expected = vt.Groups(
        tabor=3.24,
        material=creep_power_law(1, 10, 0.8, 1, 0),
        start=vt.AtDepth(73),
        rate=316.23,
    )
    assert fake["problem"] == expected
    assert fake["accuracy"] == 2e-3
    assert fake["until"] == "detached"
    assert fake["throw"] is False
    out = capsys.readouterr().out
    assert "jumped at depth" in out
    assert "pull-off force" in out and "1.5 pi R dg0" in out


@pytest.mark.parametrize(
    ("flags", "start"),
    [
        (["--preload", "-1.5"], vt.AtDepth(-1.5)),
        (["--preload-force", "2.5"], vt.AtForce(2.5)),
        (["--preload-radius", "3.61"], vt.AtRadius(3.61)),
    ],
)
def test_a_start_is_by_depth_force_or_radius(flags, start, fake):
    exit_status([*SPHERE, "--material", "elastic", "--tabor", "2", *flags])
    assert fake["problem"].start == start
    assert fake["problem"].material == vt.Elastic(rubbery_modulus=1, poisson_ratio=0)


LENS = {
    "--radius": "5.19 mm",
    "--contact-modulus": "1.944 MPa",
    "--modulus-ratio": "0.1",
    "--exponent": "0.8",
    "--tau0": "18.76 ms",
    "--work-of-adhesion": "0.1523 J/m2",
    "--equilibrium-gap": "1.55 um",
    "--preload-force": "1.5 mN",
    "--speed": "100 um/s",
}


def lens(**changes):
    chosen = LENS | {f"--{k.replace('_', '-')}": v for k, v in changes.items()}
    return [*SPHERE, *(x for pair in chosen.items() if pair[1] is not None for x in pair)]


def test_flags_with_units_state_a_problem_in_si(fake, capsys):
    assert exit_status([*lens(), "--json"]) == 0
    problem = fake["problem"]
    assert isinstance(problem, vt.Problem)
    assert problem.geometry.radius == 5.19e-3
    solid = problem.material
    assert (solid.exponent, solid.tau0, solid.poisson_ratio) == (0.8, 0.01876, 0.5)
    assert solid.rubbery_modulus == pytest.approx(1.458e6, rel=1e-12)
    assert solid.glassy_modulus == pytest.approx(1.458e7, rel=1e-12)
    assert problem.protocol == vt.Retraction(start=vt.AtForce(1.5e-3), speed=1e-4)
    assert problem.traction == vt.LennardJones(0.1523, 1.55e-6)
    answer = json.loads(capsys.readouterr().out)
    assert answer["pull_off_force_N"] == pytest.approx(3.7248e-3, rel=1e-4)
    exit_status(lens(contact_modulus=None, rubbery_modulus="1.458 MPa"))
    assert fake["problem"] == problem
    exit_status(lens(equilibrium_gap=None, strength=f"{problem.traction.strength!r} Pa"))
    assert fake["problem"].traction.equilibrium_gap == pytest.approx(1.55e-6, rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "flag"),
    [
        ({"radius": "5.19"}, "--radius"),
        ({"speed": "100 um"}, "--speed"),
        ({"speed": None}, "--speed"),
        ({"radius": None}, "--radius"),
        ({"tabor": "3"}, "--tabor"),
        ({"rubbery_modulus": "1 MPa"}, "--contact-modulus"),
        ({"preload": "1 um"}, "--preload"),
        ({"preload_force": None}, "--preload-force"),
        ({"modulus_ratio": "10"}, "--modulus-ratio"),
        ({"material": "pdms-10-1"}, "modulus-ratio"),
        ({"strength": "1 MPa"}, "strength"),
        ({"tau0": "1 m"}, "--tau0"),
        ({"half_width": "1 mm"}, "--half-width"),
    ],
)
def test_a_wrong_flag_in_si_is_named(changes, flag, fake, capsys):
    assert flag in refused(lens(**changes), capsys)


TAPS = [
    *"simulate sphere --tabor 1 --material sls --modulus-ratio 0.1 --accuracy 1e-2".split(),
    *["--apart", "10"],
    *2 * ["--move", "approach 5 to depth 2", "--move", "retract 5 to depth -15"],
]


def test_each_cycle_is_printed_as_text_json_and_a_table(capsys, tmp_path):
    files = ["--cycles", tmp_path / "c.csv", "--save", tmp_path / "c.npz"]
    assert exit_status([*TAPS, *files, "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    rows = answer["cycles"]
    table = np.genfromtxt(tmp_path / "c.csv", delimiter=",", names=True)
    assert [row["cycle"] for row in rows] == [1, 2]
    assert table.dtype.names == tuple(rows[0])
    for name in ("snap_in_depth", "peak_force", "pull_off_force", "hysteresis"):
        np.testing.assert_array_equal(table[name], [row[name] for row in rows])
    assert np.isnan(table["time_to_detachment"]).all()
    assert exit_status(["show", tmp_path / "c.npz", "--json", "--csv", tmp_path / "a.csv"]) == 0
    assert json.loads(capsys.readouterr().out) == answer
    table = np.genfromtxt(tmp_path / "a.csv", delimiter=",", names=True)
    np.testing.assert_array_equal(table["force"], vt.load(tmp_path / "c.npz").force)
    assert exit_status(["show", tmp_path / "c.npz"]) == 0
    assert f"{rows[1]['pull_off_force']:.5g}" in capsys.readouterr().out
    assert exit_status(["show", tmp_path / "c.npz", "--cycles", "-"]) == 0
    assert capsys.readouterr().out == (tmp_path / "c.csv").read_text()


def test_a_true_simulation_from_a_terminal():
    """Elastic pull-off at mu = 1: 1.1137, an independent solver's value to 1e-4."""
    flags = "--material elastic --tabor 1 --preload 5 --until pull-off --json".split()
    command = [sys.executable, "-m", "viscotack", *SPHERE, *flags]
    done = subprocess.run(command, stdout=subprocess.PIPE, check=True, timeout=100)
    answer = json.loads(done.stdout)
    assert answer["pull_off_force"] == pytest.approx(1.1137, rel=2e-3)
    assert answer["status"].startswith("still in contact")
    assert answer["wall_time_s"] > 0


RIG = "test read examples/from_rig/lens_1_um_s.csv"


@pytest.mark.parametrize(
    ("command", "flag"),
    [
        (f"{RIG} --force-unit nonsense", "--force-unit"),
        (f"{RIG} --length-unit N", "--length-unit"),
        ("uncertainty examples/from_toml/lens.toml --scatter ''", "--scatter"),
        ("uncertainty examples/from_toml/lens.toml --scatter traction.range", "--scatter"),
        (
            "material fit none.csv --poisson-ratio 0.5 --glass-transition '-300 degC' "
            "--reference-temperature '20 degC'",
            "--glass-transition",
        ),
        ("predict sphere --tabor 1e308 --material elastic --preload 5", "--tabor"),
        ("simulate sphere --tabor 1 --material elastic --preload 5 --thickness 1e308", "--thick"),
    ],
)
def test_a_refused_value_names_its_option(command, flag, capsys):
    assert exit_status(shlex.split(command)) == 2
    assert flag in capsys.readouterr().err


def test_an_interrupt_while_modules_load_has_the_status_of_ctrl_c(monkeypatch):
    def load():
        raise KeyboardInterrupt

    monkeypatch.setattr(cli, "command", load)
    assert exit_status(["predict"]) == 130
