"""Tables of rig tests: a folder of files, statistics by speed, workbook, comparison with JKR."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from command_line import answered, exit_status, refused, rows_of
from viscotack.lab.tack import Measured, survey
from viscotack.lab.tack.repeats import speed_table

RIG = Path(__file__).parents[1] / "examples" / "from_rig"


@pytest.fixture(scope="module")
def cycle():
    (one,) = survey([RIG / "lens_30_um_s.csv"]).cycles
    return one


def repeated(cycle, speed, forces):
    """Return copies of a cycle with a speed and pull-off forces."""
    one = replace(cycle, speed=Measured(speed, 0.0))
    return [replace(one, pull_off_force=Measured(force, 0.01 * force)) for force in forces]


def test_repeats_have_means_deviations_and_the_exponent_of_a_power_law(cycle):
    speeds = np.array([1e-6, 1e-5, 1e-4, 1e-3])
    rows = [repeated(cycle, v, 4e-3 * (v / 1e-6) ** 0.2 * np.array([0.98, 1.02])) for v in speeds]
    single = repeated(cycle, 1e-2, [4e-3 * 1e4**0.2])
    found = speed_table([*single, *rows[2], *rows[0], *rows[3], *rows[1]])
    assert [one.speed for one in found.speeds] == pytest.approx([*speeds, 1e-2])
    first, last = found.speeds[0], found.speeds[-1]
    assert first.force == pytest.approx(4e-3)
    assert first.force_deviation == pytest.approx(4e-3 * 0.02 * np.sqrt(2))
    assert last.force_deviation is None and last.work_deviation is None
    assert found.exponent is not None and found.freedom == 4
    assert found.exponent.value == pytest.approx(0.2, abs=1e-3)
    assert found.exponent.uncertainty < 1e-3
    assert speed_table([*rows[0], *single]).exponent is None
    assert speed_table(single).scatter is None


def test_the_standard_error_of_the_exponent_is_that_of_a_straight_line(cycle):
    speeds, forces = np.array([1e-6, 1e-5, 1e-4, 1e-3]), np.array([4e-3, 6.4e-3, 9e-3, 16e-3])
    found = speed_table([repeated(cycle, v, [P])[0] for v, P in zip(speeds, forces, strict=True)])
    line, spread = np.polyfit(np.log(speeds), np.log(forces), 1, cov=True)
    assert found.exponent is not None
    assert found.exponent.value == pytest.approx(line[0])
    assert found.exponent.uncertainty == pytest.approx(np.sqrt(spread[0, 0]))


def test_compliance_and_signs_are_said_by_flags(capsys):
    command, depths = ["test", "read", RIG / "lens_1000_um_s.csv"], []
    for more in ([], ["--compliance", "200 um/N"]):
        (test,) = answered([*command, *more], capsys)["tests"]
        (cycle,) = test["cycles"]
        depths.append(cycle["depth_at_pull_off_m"])
    assert depths[1] - depths[0] == pytest.approx(200e-6 * cycle["pull_off_force_N"], rel=0.1)
    for flag, wrong in (("--into", "up"), ("--compression", "-")):
        assert flag in refused([*command, flag, wrong], capsys)


def test_a_folder_of_files_becomes_a_workbook_and_tables(tmp_path, capsys):
    openpyxl = pytest.importorskip("openpyxl")
    folder = tmp_path / "rig"
    (folder / "inside").mkdir(parents=True)
    for name in ("1", "30", "1000"):
        shutil.copy(RIG / f"lens_{name}_um_s.csv", folder)
    shutil.copy(RIG / "lens_1_um_s.csv", folder / "repeated.csv")
    (folder / "notes.txt").write_text("nothing measured\n")
    (folder / ".hidden").write_text("nothing measured\n")
    book, table = tmp_path / "tests.xlsx", tmp_path / "repeats.csv"
    curves = tmp_path / "curves.csv"
    words = ["--radius", "5.19 mm", "--xlsx", book, "--repeats", table, "--curves", curves]
    assert exit_status(["test", "read", folder, *words]) == 0
    said = capsys.readouterr().out
    assert "4 cycles, 1 refused" in said
    assert "172.12 mJ/m2" in said
    rows = rows_of(table)
    assert [row["tests"] for row in rows] == ["2", "1", "1"]
    assert float(rows[0]["jkr_work_of_adhesion_J_m2"]) == pytest.approx(0.1721, rel=1e-3)
    columns = rows_of(curves)
    heads = list(columns[0])
    assert len(heads) == 8 and heads[0] == "depth [m] 1: lens_1_um_s.csv cycle 1, 1 um/s"
    fastest = [float(row[heads[-1]]) for row in columns if row[heads[-1]]]
    # the pull-off is that of a parabola, within the noise of a point
    assert min(fastest) == pytest.approx(-10.9e-3, rel=5e-3)
    sheets = openpyxl.load_workbook(book)
    assert sheets.sheetnames == ["cycles", "repeats", "refused"]
    assert sheets["cycles"].max_row == 5 and sheets["refused"].max_row == 2
    heading, *forces = (cell.value for cell in sheets["repeats"]["C"])
    assert heading == "pull-off force mean [N]"
    assert forces == pytest.approx([float(row["pull_off_force_N_mean"]) for row in rows])
    assert exit_status(["test", "read", folder, "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert len(answer["repeats"]) == 3 and "jkr_work_of_adhesion_J_m2" not in answer["repeats"][0]
    assert answer["exponent"] == pytest.approx(0.138, abs=1e-3)
    assert exit_status(["test", "read", tmp_path / "rig" / "inside"]) == 2
    assert "contains no file" in capsys.readouterr().err
