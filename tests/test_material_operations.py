"""Materials as operations: every door takes what the command line takes."""

import json

import numpy as np
import pytest

from command_line import exit_status
from viscotack.app.engine.operating import run_request
from viscotack.app.operations import ask, operation
from viscotack.app.operations.request import request_of
from viscotack.model.materials import StandardSolid, read_passport, write_passport
from viscotack.model.materials.library import published

OPTIONS = {
    "poisson_ratio": 0.45,
    "model": "sls",
    "rubbery_modulus": "1 MPa",
    "loss": False,
    "level": 0.8,
    "name": "a rubber",
    "source": "nobody",
    "kind": "E",
    "temperature_unit": "degC",
    "modulus_unit": "MPa",
    "reference_temperature": "-30 degC",
    "shift_by": "storage",
    "vertical": "6e-4 1/K",
    "leave_out": ["-20 degC"],
}


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    """Make a folder with a DMA at three temperatures that does not say its units."""
    folder = tmp_path_factory.mktemp("lab")
    solid = StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=0.3, poisson_ratio=0.45)
    rows = ["f,T,storage modulus,loss modulus", "Hz,,,"]
    for celsius, shift in ((-40, 1.0), (-30, 0.0), (-20, -0.8)):
        for f in np.geomspace(0.05, 50, 8):
            E = solid.complex_modulus(2 * np.pi * f * 10**shift) / 1e6
            rows.append(f"{f:.8g},{celsius},{E.real:.8g},{E.imag:.8g}")
    (folder / "dma.csv").write_text("\n".join(rows) + "\n")
    (folder / "shifts.csv").write_text("T,log_aT\nC,\n-40,1\n-30,0\n-20,-0.8\n")
    write_passport(published("pdms-10-1"), folder / "pdms.toml")
    return folder


def flags(options):
    """Return options as the command line spells them."""
    for name, value in options.items():
        if value is False:
            yield f"--no-{name}"
            continue
        for each in value if isinstance(value, list) else [value]:
            yield from (f"--{name.replace('_', '-')}", each)


def asked(word, folder, given, outputs=()):
    """Return what a worker process answers to a request with all files of a folder."""
    request = request_of(operation(word), given)
    return run_request(request, outputs, str(folder), tell=lambda told: None, also=())


def test_a_fit_is_the_same_through_every_door_with_any_option(lab, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(lab)
    assert exit_status(["material", "fit", "dma.csv", *flags(OPTIONS), "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["evidence"]["level"] == 0.8 and len(printed["shift"]["values"]) == 2
    given = OPTIONS | {"files": ["dma.csv"]}
    assert json.loads(json.dumps(ask("material fit", **given).record())) == printed
    answer = asked("material fit", lab, given, ["drawn", "output"])
    beside = answer.pop("beside")
    assert answer == printed
    assert beside["files"]["output"] == beside["drawn"]["passport"]


def test_a_passport_is_converted_and_never_over_itself(lab, tmp_path, capsys):
    file = tmp_path / "pdms.toml"
    write_passport(published("pdms-10-1"), file)
    command = ["material", "convert", file, "--temperature", "0 degC"]
    assert exit_status([*command, "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert exit_status([*command, "-o", file, "--force"]) == 2
    assert exit_status([*command, "-o", tmp_path / "cold.toml"]) == 0
    moved = read_passport(tmp_path / "cold.toml")
    assert moved.temperature == 273.15 == printed["temperature"]
    assert printed["material"]["tau0"] == moved.material.tau0
