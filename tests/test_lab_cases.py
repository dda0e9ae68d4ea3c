"""Small files in the manner of instruments, which were once misread or refused, and their kinds."""

import re
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import tack_files
from viscotack.errors import InputError
from viscotack.lab import FrequencySweeps, RelaxationTest, fit, master_curve, read, read_dma
from viscotack.lab.tack import evaluate
from viscotack.lab.tack import read as read_tests
from viscotack.model.surfaces import read_map

CASES = Path(__file__).parent / "data" / "lab_cases"
HERTZ = np.array([0.1, 1.0, 10.0, 100.0])
OMEGA = 2 * np.pi * HERTZ
STORAGE, LOSS = np.array([94e3, 152e3, 252e3, 441e3]), np.array([33e3, 56e3, 100e3, 160e3])


def write(path, columns, separator=",", decimal="."):
    """Write a table from its headings and columns; return the path."""
    lines = [separator.join(columns)]
    for row in zip(*columns.values(), strict=True):
        cells = [x if isinstance(x, str) else f"{x:.8g}".replace(".", decimal) for x in row]
        lines.append(separator.join(cells))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def sweep(path, **more):
    """Write a sweep with further columns; return the path."""
    return write(path, {"f [Hz]": HERTZ, "G' [Pa]": STORAGE, "G'' [Pa]": LOSS} | more)


def assert_the_sweep(found, rtol=1e-5):
    assert_allclose(found.angular_frequency, OMEGA, rtol=rtol)
    assert_allclose(found.storage, STORAGE, rtol=rtol)
    assert_allclose(found.loss, LOSS, rtol=rtol)


@pytest.mark.parametrize(
    ("name", "celsius"),
    [("sample_temperature", (0, 20, 40)), ("oven_temperature_close", (20, 25, 30))],
)
def test_any_heading_of_a_temperature_separates_the_sweeps(name, celsius):
    found = read_dma(CASES / f"{name}.csv")
    assert_allclose(np.unique(found.temperature), np.add(celsius, 273.15))
    assert set(found.sweep) == {0, 1, 2}
    assert found.storage[found.temperature == 293.15][0] == pytest.approx(93731.6)


@pytest.mark.parametrize(
    "heading",
    ["Ts/K", "Probentemperatur [K]", "温度 (K)", "sample_temp_k", "Messstelle 3 [K]"],
)  # fmt: skip
def test_a_column_in_a_unit_of_temperature_is_one(heading, tmp_path):
    found = read_dma(sweep(tmp_path / "a.csv", **{heading: np.full(4, 310.0)}))
    assert_allclose(found.temperature, 310)


@pytest.mark.parametrize("heading", ["ΔT [K]", "Tg [°C]", "Heating rate [K/min]"])
def test_differences_and_constants_are_no_temperatures(heading, tmp_path):
    found = read_dma(sweep(tmp_path / "a.csv", **{heading: np.full(4, 5.0)}))
    assert np.all(np.isnan(found.temperature))


@pytest.mark.parametrize(
    ("headings", "kelvin"),
    [
        (("T [K]", "Sample temperature [K]"), 310.0),
        (("Sample temp. (K)", "Oven temperature (K)"), 300.0),
        (("Temperature (set) [K]", "Temperature (actual) [K]"), 310.0),
        (("Upper plate temperature [K]", "Lower plate temperature [K]"), None),
    ],
)
def test_of_two_temperatures_that_of_the_sample_is_read(headings, kelvin, tmp_path):
    columns = dict(zip(headings, (np.full(4, 300.0), np.full(4, 310.0)), strict=True))
    path = sweep(tmp_path / "a.csv", **columns)
    if kelvin is None:
        with pytest.raises(InputError, match="`columns`"):
            read_dma(path)
    else:
        assert_allclose(read_dma(path).temperature, kelvin)
    assert_allclose(read_dma(path, columns="temperature=5").temperature, 310)


def tack_test(path, time=None, **more):
    test = tack_files.made(noise=2e-6)
    columns = {"Time [s]": test.time} if time is None else time(test)
    columns |= {"Depth [um]": 1e6 * test.drive, "Force [mN]": 1e3 * test.force}
    columns |= {
        name: np.full(test.time.size, value) if isinstance(value, float) else value
        for name, value in more.items()
    }
    return write(path, columns)


@pytest.mark.parametrize(
    ("heading", "cells"),
    [
        ("Position", ["left"] * 4 + ["right"] * 4),
        ("Position", [1.0] * 4 + [2.0] * 4),
        ("What we did", ["a"] * 4 + ["b"] * 4),
    ],
)
def test_a_column_that_tells_states_apart_is_asked_for(heading, cells, tmp_path):
    twice = {
        "f [Hz]": np.tile(HERTZ, 2),
        "G' [Pa]": np.concatenate((STORAGE, 1.05 * STORAGE)),
        "G'' [Pa]": np.tile(LOSS, 2),
    }
    path = write(tmp_path / "a.csv", twice | {heading: cells})
    with pytest.raises(InputError, match=f'"{heading}".*`where`'):
        read_dma(path)
    first = cells[0] if isinstance(cells[0], str) else f"{cells[0]:g}"
    assert_the_sweep(read_dma(path, where=f"{heading}={first}"))
    with pytest.raises(InputError, match="`where`"):
        read_dma(path, where=f"{heading}=other")
    with pytest.raises(InputError, match="`where`"):
        read_dma(path, where="Nothing=1")


@pytest.mark.parametrize(
    ("heading", "cells"),
    [("Status", ["M-", "Dy", "M-", ""]), ("Point", [1.0, 2.0, 3.0, 4.0]), ("Sample", ["A"] * 4),
     ("Segment", ["up", "up", "down", "down"])],
)  # fmt: skip
def test_other_columns_of_text_are_passed_over(heading, cells, tmp_path):
    assert_the_sweep(read_dma(sweep(tmp_path / "a.csv", **{heading: cells})))


def pooled(factor, noise=0.0, kelvin=(293.15, 293.15), order=slice(None)):
    """Return two sweeps over ten frequencies, of which the second is stiffer."""
    omega = np.geomspace(1, 100, 10)
    scatter = np.exp(noise * np.random.default_rng(1).standard_normal((2, 10)))
    size = (scatter * np.array([[1.0], [factor]]) * 1e5 * omega**0.3).ravel()
    columns = (np.repeat(kelvin, 10), np.tile(omega, 2), size, 0.3 * size, np.repeat([0, 1], 10))
    T, omega, storage, loss, number = (column[order] for column in columns)
    return FrequencySweeps(T, omega, storage, loss, "G", number)


@pytest.mark.parametrize("kelvin", [(293.15, 293.2), (np.nan, np.nan)])
def test_sweeps_of_one_temperature_that_contradict_each_other_are_not_pooled(kelvin):
    reference = None
    for factor in (1.2, 1 / 1.2):
        for pool in (
            lambda sweeps: master_curve(sweeps, reference_temperature=reference),
            lambda sweeps: fit(sweeps, poisson_ratio=0.5, model="sls"),
        ):
            with pytest.raises(InputError, match="`where`"):
                pool(pooled(factor, kelvin=kelvin))
    # the same in one sweep, sorted by frequency
    mixed = pooled(1.2, kelvin=kelvin, order=np.arange(20).reshape(2, 10).T.ravel())
    one = FrequencySweeps(
        mixed.temperature, mixed.angular_frequency, mixed.storage, mixed.loss, "G", np.zeros(20)
    )
    with pytest.raises(InputError, match="`where`"):
        master_curve(one, reference_temperature=reference)


@pytest.mark.parametrize(
    "sweeps",
    [pooled(1.05), pooled(1.2, noise=0.4), pooled(1.2, kelvin=(293.15, 294.0))],
    ids=["repeat", "noise", "other temperature"],
)
def test_repeats_within_their_scatter_are_pooled(sweeps):
    assert len(master_curve(sweeps, reference_temperature=None)) == 20


def test_samples_of_tack_tests_are_not_pooled_but_chosen(tmp_path):
    test = tack_files.made(noise=2e-6)
    table = {"Time [s]": test.time, "Depth [um]": 1e6 * test.drive, "Force [mN]": 1e3 * test.force}
    twice = {name: np.tile(column, 2) for name, column in table.items()}
    path = write(tmp_path / "a.csv", twice | {"Sample": ["A"] * 1260 + ["B"] * 1260})
    with pytest.raises(InputError, match='"Sample".*`where`'):
        read_tests(path)
    (found,) = read_tests(path, where="Sample=B")
    assert_allclose(found.force, test.force, rtol=1e-6)
    # the parts of one test are no samples
    parts = ["approach"] * 500 + ["dwell"] * 60 + ["retraction"] * 700
    (found,) = read_tests(write(tmp_path / "b.csv", table | {"Segment": parts}))
    assert len(found) == 1260


def test_a_unit_that_the_file_states_wins():
    path = CASES / "z_sensor_um.csv"
    chosen = {"position_column": "Z sensor [um]"}
    for more in ({}, {"length_unit": "µm"}):
        (cycle,) = evaluate(*read_tests(path, **chosen, **more)).cycles
        assert cycle.speed.value == pytest.approx(10e-6, rel=1e-3)
        assert cycle.pull_off_force.value == pytest.approx(5.01e-3, abs=0.01e-3)
        assert cycle.work_of_separation.value == pytest.approx(32.8e-9, abs=0.1e-9)
    with pytest.raises(InputError, match="`length_unit`"):
        read_tests(path, **chosen, length_unit="mm")
    with pytest.raises(InputError, match="`force_unit`"):
        read_tests(path, **chosen, force_unit="N")


COMPLIANCE = 1 / (STORAGE + 1j * LOSS)
FORMS = {
    "log": {"log ω": np.log10(OMEGA), "logG'/Pa": np.log10(STORAGE), "lg(G''/Pa)": np.log10(LOSS)},
    "ln": {
        "ln(f [Hz])": np.log(HERTZ),
        "ln(G' [kPa])": np.log(STORAGE / 1e3),
        "ln(G'' [kPa])": np.log(LOSS / 1e3),
    },
    "dynamic viscosity": {
        "ω in rad/s": OMEGA,
        "η' in Pa s": LOSS / OMEGA,
        "η'' in mPas": 1e3 * STORAGE / OMEGA,
    },
    "complex viscosity": {
        "Frequency (Hz)": HERTZ,
        "Complex viscosity (Pa.s)": np.hypot(STORAGE, LOSS) / OMEGA,
        "Tan(delta)": LOSS / STORAGE,
    },
    "size and angle": {
        "Frequency (Hz)": HERTZ,
        "|G*| (Pa)": np.hypot(STORAGE, LOSS),
        "delta (°)": np.degrees(np.arctan2(LOSS, STORAGE)),
    },
    "size and angle in radians": {
        "Frequency (Hz)": HERTZ,
        "|G*| (Pa)": np.hypot(STORAGE, LOSS),
        "δ (rad)": np.arctan2(LOSS, STORAGE),
    },
    "storage and tangent": {"f [Hz]": HERTZ, "G' [Pa]": STORAGE, "tan delta": LOSS / STORAGE},
    "compliance": {
        "f [Hz]": HERTZ,
        "J' [1/MPa]": 1e6 * COMPLIANCE.real,
        "J'' [1/MPa]": -1e6 * COMPLIANCE.imag,
    },
}


@pytest.mark.parametrize("form", FORMS)
def test_other_forms_of_the_modulus_are_converted(form, tmp_path):
    found = read_dma(write(tmp_path / "a.csv", FORMS[form], separator=";"))
    assert found.kind == "G"
    assert_the_sweep(found, rtol=2e-6)


def test_a_viscosity_or_a_compliance_is_no_modulus(tmp_path):
    for unit in ("Pa s", "1/Pa"):
        names = (f"G' [{unit}]", f"G'' [{unit}]")
        columns = {"f [Hz]": HERTZ} | dict.fromkeys(names, STORAGE)
        with pytest.raises(InputError, match="G' "):
            read_dma(write(tmp_path / "a.csv", columns))


def test_clock_times_are_seconds(tmp_path):
    found = read(CASES / "clock_time.csv")
    assert isinstance(found, RelaxationTest)
    assert_allclose(found.time, np.arange(1, 386, 24))
    assert found.modulus[0] == 174743
    times = ["00:01", "01:30", "02:00", "03:00"]
    short = {"t [mm:ss]": times, "G(t) [kPa]": [4.0, 3.0, 2.0, 1.0]}
    assert_allclose(read(write(tmp_path / "a.csv", short)).time, [1, 90, 120, 180])
    day = {"Time": [f"09:{time}" for time in times], "G(t) [kPa]": [4.0, 3.0, 2.0, 1.0]}
    path = write(tmp_path / "b.csv", day)
    with pytest.raises(InputError, match="`step_start`"):
        read(path)
    assert_allclose(read(path, step_start=32400.0).time, [1, 90, 120, 180])


def test_minus_9999_is_a_gap(tmp_path):
    T = np.array([293.15, -9999, 293.15, 293.15])
    found = read_dma(sweep(tmp_path / "a.csv", **{"T [K]": T}))
    assert_allclose(found.angular_frequency, OMEGA[[0, 2, 3]])
    never = read_dma(sweep(tmp_path / "b.csv", **{"T [°C]": np.full(4, -9999.0)}))
    assert np.all(np.isnan(never.temperature))
    test = tack_files.made()
    force = np.where(np.arange(1260) % 90 == 50, -9999, 1e3 * test.force)
    (found,) = read_tests(tack_test(tmp_path / "c.csv", **{"Force [mN]": force}))
    assert len(found) == 1246 and found.force.min() > -0.01
    # a position may pass through it
    nanometres = {"Depth [um]": np.linspace(-20000, 0, 1260).round(), "Time [s]": test.time}
    nanometres["Depth [um]"][630] = -9999
    (found,) = read_tests(tack_test(tmp_path / "d.csv", **nanometres))
    assert len(found) == 1260


def test_two_columns_of_frequency_agree_within_their_digits(tmp_path):
    found = read_dma(CASES / "two_digits.csv")
    assert found.angular_frequency[1] == pytest.approx(2 * np.pi * 0.18)
    assert found.angular_frequency[-1] == pytest.approx(2 * np.pi * 100)
    rows = {"f [Hz]": ["0.18"], "omega [rad/s]": ["1.3"], "G' [Pa]": ["3"], "G'' [Pa]": ["1"]}
    with pytest.raises(InputError, match="omega"):
        read_dma(write(tmp_path / "a.csv", rows))


def test_a_tan_delta_averaged_by_the_instrument_is_noted(tmp_path):
    found = read_dma(CASES / "mean_tan_delta.csv")
    assert any("tan(δ)" in note for note in found.source.notes)
    assert (found.storage[0], found.loss[0]) == (93731.6, 33318.3)
    tangent = LOSS / STORAGE
    assert_the_sweep(read_dma(sweep(tmp_path / "a.csv", **{"tan delta": 1.09 * tangent})))
    tangent[2] *= 1.2
    with pytest.raises(InputError, match="tan delta"):
        read_dma(sweep(tmp_path / "b.csv", **{"tan delta": tangent}))


@pytest.mark.parametrize("separator", [",", "\t"])
def test_a_table_on_its_side_is_read(separator, tmp_path):
    lines = [["f [Hz]", *HERTZ], ["G'", *STORAGE], ["G''", *LOSS], ["T [°C]", 20, 20, 20, 20]]
    path = tmp_path / "a.csv"
    text = "\n".join(separator.join(map(str, line)) for line in lines)
    path.write_text(f"Sample,A\n{text}\n", encoding="utf-8")
    found = read_dma(path, modulus_unit="Pa")
    assert_the_sweep(found)
    assert_allclose(found.temperature, 293.15)
    test = tack_files.made()
    lines = [["Time [s]", *test.time], ["Gap [m]", *-test.drive], ["Force [N]", *test.force]]
    path.write_text("".join(separator.join(map(str, line)) + "\n" for line in lines))
    assert_allclose(read_tests(path)[0].force, test.force)


def test_a_straight_tilt_is_taken_off():
    (found,) = read_tests(CASES / "tilted_zero.csv")
    (cycle,) = evaluate(found).cycles
    assert cycle.pull_off_force.value == pytest.approx(5.01e-3, abs=0.01e-3)
    assert cycle.work_of_separation.value == pytest.approx(34.05e-9, abs=0.05e-9)


def test_the_header_of_gwyddion_is_used(tmp_path):
    path = CASES / "gwyddion_um.txt"
    found = read_map(path)
    assert found.pixel == pytest.approx(2e-6)
    assert np.std(found.heights) == pytest.approx(2e-9, rel=1e-3)
    assert read_map(path, pixel=2e-6, unit=1e-6).notes == ()
    with pytest.raises(InputError, match="pixel"):
        read_map(path, pixel=1e-3)
    with pytest.raises(InputError, match="height_unit"):
        read_map(path, unit=1e-9)
    german = path.read_text(encoding="utf-8").replace(".", ",").replace("Width", "Breite")
    (tmp_path / "a.txt").write_text(german, encoding="utf-8")
    assert_allclose(read_map(tmp_path / "a.txt").heights, found.heights)
    (tmp_path / "a.txt").write_text(german.replace("Height: 24", "Height: 20"), encoding="utf-8")
    with pytest.raises(InputError, match="square"):
        read_map(tmp_path / "a.txt")
    # a size of zero is none
    empty = re.sub(r"(Breite|Height): [0-9,]+", r"\1: 0", german)
    (tmp_path / "a.txt").write_text(empty, encoding="utf-8")
    with pytest.raises(InputError, match="pixel is missing"):
        read_map(tmp_path / "a.txt")


@pytest.mark.parametrize("separator", [" ", "\t", ";", ", ", ","])
def test_maps_have_decimal_commas_or_points(separator, tmp_path):
    heights = np.arange(64.0).reshape(8, 8) / 8
    for decimal in ".," if "," not in separator else ".":
        lines = (separator.join(f"{x:.3f}".replace(".", decimal) for x in row) for row in heights)
        path = tmp_path / "a.txt"
        path.write_text("\n".join(lines) + "\n")
        assert_allclose(read_map(path, pixel=1e-6, unit=1e-9).heights, 1e-9 * heights)


@pytest.mark.parametrize(
    ("pixel", "unit", "doubted"),
    [(1e-6, 1e-9, False), (1e-3, 1e-6, False), (1.0, 1e-9, True), (1e-6, 1.0, True)],
)
def test_lengths_that_suggest_a_wrong_unit_are_noted(pixel, unit, doubted, tmp_path):
    path = tmp_path / "a.txt"
    np.savetxt(path, np.random.default_rng(1).standard_normal((8, 8)))
    assert bool(read_map(path, pixel=pixel, unit=unit).notes) == doubted


def test_pixels_that_are_nearly_square_are_taken_with_a_note(tmp_path):
    pytest.importorskip("SurfaceTopography")
    found = read_map(CASES / "near_square.sdf")
    assert found.pixel == pytest.approx(2.0005e-6, rel=1e-6)
    assert np.std(found.heights) == pytest.approx(2e-9, rel=1e-3)
    assert found.notes
    wide = (CASES / "near_square.sdf").read_text().replace("2.001E-6", "2.100E-6")
    (tmp_path / "a.sdf").write_text(wide)
    with pytest.raises(InputError, match="square"):
        read_map(tmp_path / "a.sdf")
