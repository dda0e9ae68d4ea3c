"""From a laboratory's file to a pull-off force, by the command line."""

import json

import numpy as np
import pytest

from command_line import exit_status, refused
from melts import CHAMBER, LAW
from stated import case_text
from viscotack.model.materials import StandardSolid
from viscotack.model.materials.library import published
from viscotack.model.materials.passport_file import read_passport, write_passport

FIT = (
    'material fit dma.csv --poisson-ratio 0.5 --reference-temperature "20 degC" '
    '--glass-transition "-115 degC" '
)


@pytest.fixture
def lab(tmp_path, monkeypatch):
    """Stand in a folder with a DMA of the thesis's silicone: 1 Hz, -130 to 20 C, 2 % noise."""
    monkeypatch.chdir(tmp_path)
    pdms = published("pdms-10-1")
    celsius = np.arange(-130, 21, 10.0)
    omega = 2 * np.pi * 10 ** np.asarray(pdms.shift.log10_shift(celsius + 273.15))
    random = np.random.default_rng(5)
    rows = ["f,T,E',E''", "Hz,C,MPa,MPa"]
    for T, E in zip(celsius, pdms.material.complex_modulus(omega) / 1e6, strict=True):
        storage, loss = (part * (1 + 0.02 * random.normal()) for part in (E.real, E.imag))
        rows.append(f"1,{T},{storage:.5g},{loss:.5g}")
    (tmp_path / "dma.csv").write_text("\n".join(rows) + "\n")
    return tmp_path


def printed(line, capsys):
    assert exit_status(line) == 0, capsys.readouterr().err
    return capsys.readouterr()


def test_from_file_to_pull_off_in_two_commands(lab, capsys):
    out, err = printed(FIT + "-o pdms.toml --plot fit.png", capsys)
    assert "power-law: 4 constants on 32 numbers" in out
    assert "wrote pdms.toml" in err and (lab / "fit.png").stat().st_size > 20_000
    line = 'simulate sphere --material pdms.toml --preload-force "1.5 mN" --speed "100 um/s"'
    scales = ' --radius "5.19 mm" --work-of-adhesion "0.1523 J/m^2" --equilibrium-gap "1.55 um"'
    out, _ = printed(f"{line}{scales} --until pull-off --accuracy 1e-2 --json", capsys)
    fitted = json.loads(out)
    write_passport(published("pdms-10-1"), "true.toml")
    out, _ = printed(
        f"{line}{scales} --until pull-off --accuracy 1e-2 --json".replace("pdms", "true"), capsys
    )
    true = json.loads(out)
    assert fitted["pull_off_force"] == pytest.approx(true["pull_off_force"], rel=0.01)
    assert fitted["pull_off_force_N"] == pytest.approx(4.6e-3, rel=0.03)


def sweeps(folder):
    """Write sweeps of a standard solid, one file a temperature."""
    solid = StandardSolid(rubbery_modulus=1e6, glassy_modulus=1e7, tau0=0.3, poisson_ratio=0.5)
    random = np.random.default_rng(1)
    omega = 2 * np.pi * np.geomspace(0.05, 50, 12)
    for T in CHAMBER[:5]:
        E = solid.complex_modulus(omega * 10 ** LAW.log10_shift(T)) / 1e6
        E = E.real * np.exp(0.01 * random.normal(size=12)) + 1j * E.imag
        rows = [
            f"{w:.8g},{T - 273.16:.2f},{e.real:.8g},{e.imag:.8g}"
            for w, e in zip(omega, E, strict=True)
        ]
        text = "\n".join(["w,T,E',E''", "rad/s,C,MPa,MPa", *rows, ""])
        (folder / f"rubber_{T - 273.15:.0f}.txt").write_text(text)


def test_sweeps_in_several_files_give_a_force_at_another_temperature(lab, capsys):
    sweeps(lab)
    protocol = 'preload_depth = "3 um"\nspeed = "1 um/s"'
    text = case_text('passport = "rubber.toml"', radius="5 mm", protocol=protocol)
    (lab / "case.toml").write_text(text.replace("50 mJ", "150 mJ"))
    files = " ".join(f"rubber_{celsius}.txt" for celsius in (-40, -30, -20, -10, 0))
    line = f"material fit {files} --poisson-ratio 0.5 --model sls --shift-by both "
    assert "--reference-temperature" in refused(line, capsys)
    line += '--reference-temperature "-30 degC" '
    refusal = refused(line + '--leave-out "15 degC"', capsys)
    assert "rubber_-40.txt and 4 more: no test within 1 K" in " ".join(refusal.split())
    out, _ = printed(line + '--leave-out "-10 degC" -o rubber.toml', capsys)
    assert "nearest law: WLF" in out and "-10.0" not in out
    passport = read_passport("rubber.toml")
    assert np.allclose(passport.shift.values, LAW.log10_shift(CHAMBER[[0, 1, 2, 4]]), atol=0.1)

    pull = "simulate sphere case.toml --until pull-off --accuracy 2e-2 --json --temperature "
    forces = []
    for celsius in (-30, 0):
        out, err = printed(f'{pull} "{celsius} degC"', capsys)
        forces.append(json.loads(out)["pull_off_force"])
        assert ("the material times are uncertain by" in err) == (celsius == 0)
    # faster relaxation holds less
    assert forces[1] < 0.9 * forces[0]
    assert "superposition is not extrapolated" in refused(f'{pull} "20 degC"', capsys)
