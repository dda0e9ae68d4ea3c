"""From a laboratory's file to a pull-off force, by the command line."""

import json

import numpy as np

from command_line import exit_status, refused
from melts import CHAMBER, LAW
from stated import case_text
from viscotack.model.materials import StandardSolid
from viscotack.model.materials.passport_file import read_passport


def printed(line, capsys):
    assert exit_status(line) == 0, capsys.readouterr().err
    return capsys.readouterr()


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


def test_sweeps_in_several_files_give_a_force_at_another_temperature(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    sweeps(tmp_path)
    protocol = 'preload_depth = "3 um"\nspeed = "1 um/s"'
    text = case_text('passport = "rubber.toml"', radius="5 mm", protocol=protocol)
    (tmp_path / "case.toml").write_text(text.replace("50 mJ", "150 mJ"))
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
