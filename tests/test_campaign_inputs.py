"""Plans over any number of a problem: bodies, tips, laws, and what the machine does."""

import numpy as np

from viscotack import (
    AtForce,
    Bonded,
    FlatPunch,
    Layer,
    LennardJones,
    Problem,
    Retraction,
    StandardSolid,
    read_case,
)
from viscotack.campaign import (
    read_plan,
    space_filling,
)

RUBBER = StandardSolid(rubbery_modulus=1.5e6, glassy_modulus=15e6, tau0=0.02, poisson_ratio=0.45)
LAW = LennardJones(work_of_adhesion=0.15, equilibrium_gap=1.5e-6)
PAD = Problem(
    material=RUBBER,
    traction=LAW,
    geometry=FlatPunch(half_width=1e-3),
    body=Layer(thickness=5e-5, base=Bonded(poisson_ratio=0.45)),
    protocol=Retraction(start=AtForce(2e3), speed=1e-4),
)
PAD_FILE = """
[material]
model = "sls"
rubbery_modulus = "1.5 MPa"
glassy_modulus = "15 MPa"
tau0 = "20 ms"
poisson_ratio = 0.45
[interface]
law = "lennard-jones"
work_of_adhesion = "0.15 J/m^2"
equilibrium_gap = "1.5 um"
[punch]
half_width = "1 mm"
[layer]
thickness = "50 um"
base = "bonded"
[protocol]
preload_stress = "2 kPa"
speed = "100 um/s"
"""
OVER_PAD = {
    "punch.half_width": {"log": ["0.1 mm", "10 mm"]},
    "layer.thickness": {"log": ["10 um", 1e-4]},
    "material.poisson_ratio": {"linear": [0.2, 0.49]},
    "protocol.preload_stress": {"linear": ["1 kPa", "3 kPa"]},
}


def problems(plan):
    return [plan.kind.problem(case.inputs) for case in plan.cases]


def shares(values, low, high):
    """Return in which of so many parts of a logarithmic range each value lies, in order."""
    places = np.log(np.array(values) / low) / np.log(high / low)
    return np.sort(np.floor(places * len(values))).tolist()


def test_a_fill_over_a_punch_and_its_layer_has_units_and_covers_them_evenly():
    plan = space_filling(PAD, OVER_PAD, cases=32)
    found = problems(plan)
    assert shares([p.geometry.half_width for p in found], 1e-4, 1e-2) == list(range(32))
    assert shares([p.body.thickness for p in found], 1e-5, 1e-4) == list(range(32))
    stresses = [p.protocol.start.force for p in found]
    assert 1e3 <= min(stresses) < 1.1e3 and 2.9e3 < max(stresses) <= 3e3
    # a bonded layer is of one piece with its material
    assert {p.body.base.poisson_ratio == p.material.poisson_ratio for p in found} == {True}
    assert len({p.material.poisson_ratio for p in found}) == 32


def test_a_file_and_python_state_the_same_cases(tmp_path):
    (tmp_path / "pad.toml").write_text(PAD_FILE)
    lines = [f"{path} = {str(given).replace(':', ' =')}" for path, given in OVER_PAD.items()]
    text = "\n".join(lines).replace("'log'", "log").replace("'linear'", "linear")
    text = f'problem = "pad.toml"\n[[fill]]\ncases = 20\n{text}\n'
    (tmp_path / "plan.toml").write_text(text)
    assert read_case(tmp_path / "pad.toml") == PAD
    ours = space_filling(PAD, OVER_PAD, cases=20)
    assert read_plan(tmp_path / "plan.toml").cases == ours.cases and len(ours.cases) == 20
    assert ours.base == read_plan(tmp_path / "plan.toml").base
