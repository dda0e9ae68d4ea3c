"""Rig tests at several temperatures: reading, tables, shifted speeds, identification."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from command_line import exit_status, rows_of
from viscotack.errors import InputError
from viscotack.identify import pull_offs
from viscotack.lab.formats.tables import stated_temperature
from viscotack.lab.tack import Measured, survey
from viscotack.lab.tack.repeats import speed_table
from viscotack.model.materials.shift import WLF

RIG = Path(__file__).parents[1] / "examples" / "from_rig"
LINES = (RIG / "lens_30_um_s.csv").read_text().splitlines()


def with_column(path, heading, cells):
    """Write the example test with one column more; return the path."""
    head, *rows = LINES
    pairs = zip(rows, cells, strict=True)
    path.write_text("\n".join([f"{head},{heading}", *(f"{row},{x}" for row, x in pairs), ""]))
    return path


def only(path, **reading):
    (cycle,) = survey([path], reading=reading).cycles
    return cycle


def test_the_temperature_of_a_test_is_that_of_column_header_or_name(tmp_path):
    count = len(LINES) - 1
    steady = 35 + 0.2 * np.sin(np.arange(count))
    by_column = only(with_column(tmp_path / "a.csv", "Temperature [°C]", steady))
    assert by_column.temperature == pytest.approx(308.15, abs=0.02)
    fahrenheit = only(with_column(tmp_path / "f.csv", "T [°F]", np.full(count, 95.0)))
    assert fahrenheit.temperature == pytest.approx(308.15)
    header = tmp_path / "b.csv"
    header.write_text("\n".join(["Temperature (°C),35.0", *LINES, ""]))
    assert only(header).temperature == pytest.approx(308.15)
    named = tmp_path / "lens_35C_2.csv"
    named.write_text("\n".join([*LINES, ""]))
    assert only(named).temperature is None
    assert only(named, temperature_in_name=True).temperature == pytest.approx(308.15)
    # the rest of the evaluation does not depend on it
    assert by_column.pull_off_force == only(named).pull_off_force


@pytest.mark.parametrize("line, kelvins", [
    ("# Temperature: 35 °C", 308.15), ("Temperatur;25,5 °C", 298.65), ("Temp [C];25,0", 298.15),
    ('"Temperature","-10.0","°C"', 263.15), ("Test temperature 77 °F", 298.15),
    ("Temperature,25.0", None), ("Glass transition temperature: -70 °C", None),
    ("Temperature: 20 °C to 30 °C", None), ("Speed,25 um/s", None),
])  # fmt: skip
def test_a_line_above_the_columns_states_the_temperature_with_its_unit(line, kelvins):
    for row in ([line], line.split("\t")):
        assert stated_temperature([row]) == (kelvins and pytest.approx(kelvins))


def test_a_temperature_that_cannot_be_read_or_changes_is_noted(tmp_path):
    count = len(LINES) - 1
    ramp = only(with_column(tmp_path / "a.csv", "Temperature [°C]", np.linspace(20, 40, count)))
    assert "the temperature changes from 20 C to 40 C during the cycle" in ramp.source.notes
    unknown = only(with_column(tmp_path / "b.csv", "Temperature", np.full(count, 35.0)))
    assert unknown.temperature is None
    assert any(note.startswith("temperature not read") for note in unknown.source.notes)
    off = only(with_column(tmp_path / "c.csv", "Temperature [K]", np.full(count, -1e4)))
    assert off.temperature is None
    found = survey([tmp_path / "a.csv"], reading={"temperature_in_name": True})
    assert "`temperature_in_name`" in found.unread[0].reason


SHIFT = WLF(reference_temperature=293.15, c1=5.0, c2=150.0)
SLOW = 10.0 ** float(SHIFT.log10_shift(283.15))  # a_T


@pytest.fixture(scope="module")
def cycle():
    (one,) = survey([RIG / "lens_30_um_s.csv"]).cycles
    return one


def at(cycle, temperature, speed, force):
    """Return a copy of a cycle at a temperature and speed, with a pull-off force."""
    speed, force = Measured(speed, 0.0), Measured(force, 0.01 * force)
    return replace(cycle, temperature=temperature, speed=speed, pull_off_force=force)


def power_law(cycle, temperature, exponent=0.2):
    """Return tests at three speeds, with forces that follow a power law of a_T v."""
    factor = 10.0 ** float(SHIFT.log10_shift(temperature))
    rows = [(v, 4e-3 * (factor * v / 1e-6) ** exponent) for v in (1e-6, 1e-5, 1e-4)]
    return [at(cycle, temperature, v, force) for v, force in rows]


def test_repeats_are_grouped_by_temperature_and_speed(cycle):
    cold = [at(cycle, 283.0 + x, 1e-5, 6e-3) for x in (0.0, 0.4)]
    warm = [at(cycle, 303.15, 1e-5, 4e-3), at(cycle, 303.15, 1e-4, 5e-3)]
    unknown = at(cycle, None, 1e-5, 5e-3)
    found = speed_table([*warm, cold[0], unknown, cold[1]])
    assert [one.temperature for one in found.speeds] == [None, pytest.approx(283.2), 303.15, 303.15]
    assert [len(one.cycles) for one in found.speeds] == [1, 2, 1, 1]
    assert [len(same) for same in found.series] == [1, 1, 2]
    assert found.speeds[1].force == pytest.approx(6e-3) and found.freedom == 1
    assert [one.temperature for one in pull_offs([*warm, *cold])] == [
        pytest.approx(283.2),
        303.15,
        303.15,
    ]


def test_shifted_speeds_make_one_curve_of_tests_at_several_temperatures(cycle):
    cycles = [*power_law(cycle, 283.15), *power_law(cycle, 313.15)]
    apart, found = speed_table(cycles), speed_table(cycles, SHIFT)
    assert apart.master is None and apart.exponent is None
    assert [one.value for _, one in apart.exponents] == pytest.approx([0.2, 0.2], abs=1e-6)
    assert found.speeds[0].shifted_speed == pytest.approx(SLOW * 1e-6)
    # colder is slower: the same force as at a higher speed
    assert SLOW > 2
    assert found.master is not None
    assert found.master.value == pytest.approx(0.2, abs=1e-6)
    assert found.master.uncertainty < 1e-6
    with pytest.raises(InputError, match="temperature of .* is unknown"):
        speed_table([*cycles, at(cycle, None, 1e-5, 5e-3)], SHIFT)


def test_a_folder_at_several_temperatures_becomes_tables_and_a_picture(tmp_path, capsys):
    folder = tmp_path / "rig"
    folder.mkdir()
    for name in ("1", "30", "1000"):
        for kelvin in ("10C", "40C"):
            shutil.copy(RIG / f"lens_{name}_um_s.csv", folder / f"lens_{name}_{kelvin}.csv")
    repeats, table = tmp_path / "repeats.csv", tmp_path / "cycles.csv"
    assert exit_status(["test", "read", folder, "--repeats", repeats]) == 0
    both = capsys.readouterr()
    assert "temperatures from 10 to 40 C" in both.err and "--temperature-in-name" in both.err
    assert len(rows_of(repeats)) == 3
    shift = ["--wlf", "5,150 K", "--reference-temperature", "20 degC"]
    named = ["test", "read", folder, "--temperature-in-name"]
    picture = tmp_path / "tests.png"
    outputs = ["--repeats", repeats, "--csv", table, "--plot", picture, "--force"]
    assert exit_status([*named, *shift, *outputs]) == 0
    both = capsys.readouterr()
    assert "--temperature-in-name" not in both.err
    # the exponents at both temperatures, and that of the master curve
    assert both.out.count("0.138 +- ") == 2 and both.out.count("0.120 +- ") == 1
    rows = rows_of(repeats)
    assert [float(row["temperature_K"]) for row in rows] == pytest.approx(
        3 * [283.15] + 3 * [313.15]
    )
    assert float(rows[0]["shifted_speed_m_s"]) == pytest.approx(SLOW * 1e-6, rel=0.01)
    cycles = rows_of(table)
    assert float(cycles[0]["shifted_speed_m_s"]) / float(cycles[0]["speed_m_s"]) == pytest.approx(
        10.0 ** float(SHIFT.log10_shift(float(cycles[0]["temperature_K"])))
    )
    assert picture.stat().st_size > 10_000
    assert exit_status([*named, "--reference-temperature", "20 degC"]) == 2
    assert "needs a shift" in capsys.readouterr().err
