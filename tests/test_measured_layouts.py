"""Layouts that instruments and programs export, and the true cause of a refusal."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

import lab_files
from lab_files import assert_the_film, notes
from viscotack.lab import read, read_dma, read_shifts
from viscotack.lab.formats.headings import recognise


@pytest.mark.parametrize(
    ("text", "quantity", "unit"),
    [
        ("modulus_Pa", "modulus", "Pa"),
        ("omega_rad_s", "angular_frequency", "rad/s"),
        ("G_double_prime", "loss", ""),
        ("T [oC]", "temperature", "oC"),
        ("δ (°)", "phase", "°"),
        ("E' [Mpa]", "storage", "Mpa"),
    ],
)
def test_a_unit_behind_the_name_is_read(text, quantity, unit):
    heading = recognise(text)
    assert (heading.quantity, heading.unit) == (quantity, unit)


@pytest.mark.parametrize(
    "text",
    ["G*/sin(delta)", "Stress (step)", "1/temperature", "Shear stress (average)", "e'", "T_ref"],
)  # fmt: skip
def test_a_name_that_holds_another_is_another_quantity(text):
    assert recognise(text) is None


def test_json_in_lists_is_read(file):
    columns = [{"name": "Time", "unit": "s"}, {"name": "Shear Strain", "unit": ""},
               {"name": "Relaxation Modulus", "unit": "kPa"}]  # fmt: skip
    values = [[0.1, 0.02, 30.5], [1, 0.02, 20.25], [10, 0.02, None]]
    data = {"DataSet": [{"Data": {"columns": columns, "values": values}}]}
    text = json.dumps({"Experiment": {"Results": [data]}})
    test = read(file(text, "film.json"), kind="G")
    assert test.source.format == "trios-json"
    assert test.modulus.tolist() == [30500, 20250]
    assert test.strain == 0.02


def test_numbers_without_a_name_above_columns_must_be_identified(file):
    bare = lab_files.TEXTS["csv_wide"].replace(" °C".encode(), b"")
    with pytest.raises(
        ValueError, match=r"'-40' above the columns is a temperature in C or K \(set `temp"
    ):
        read_dma(file(bare))
    assert_the_film(read_dma(file(bare), temperature_unit="degC"))
    named = bare.replace(b"-40", b"dry").replace(b"-30", b"wet")
    with pytest.raises(ValueError, match="'dry' above the columns is no temperature"):
        read_dma(file(named))


@pytest.mark.parametrize("name", ["csv_wide", "csv_wide_within"])
def test_lines_of_sweeps_side_by_side_may_end_with_a_separator(name, file):
    assert_the_film(read_dma(file(lab_files.TEXTS[name].replace(b"\n", b",\n"))))


def test_only_the_first_columns_of_reptate_count(file):
    sweeps = read_dma(file(lab_files.RHEOMETER, "film.osc"))
    assert_allclose(sweeps.storage, lab_files.PASCAL[0][8:], rtol=1e-11)
    assert_allclose(sweeps.loss, lab_files.PASCAL[1][8:], rtol=1e-11)
    assert_allclose(sweeps.temperature, 253.15)
    lines = lab_files.RHEOMETER.decode("latin-1").split("\n")
    lines[4] = "    ".join(lines[4].split()[1:])
    with pytest.raises(ValueError, match=r"line 5: .Temp. is 1.97, .*T=-20"):
        read_dma(file("\n".join(lines).encode("latin-1"), "film.osc"))


def test_steps_of_reptate_stand_in_its_first_line(file):
    relaxation = read(file("T=20;gamma=0.5; \nt sxy\n0.1 5e5\n1 3e5\n", "melt.gt"))
    # the column is a stress, after a step of gamma
    assert relaxation.modulus.tolist() == [1e6, 6e5]
    assert (relaxation.kind, relaxation.temperature, relaxation.strain) == ("G", 293.15, 0.5)
    assert read(file("gamma=0;\n0.1 5e5\n1 3e5\n", "melt.gt")).modulus[0] == 5e5
    creep = read(file("T=20;stress=50;\nt strain\ns -\n0 0\n1 0.001\n2 0.002\n", "melt.creep"))
    assert_allclose(creep.compliance, [2e-5, 4e-5])
    assert creep.stress == 50
    with pytest.raises(ValueError, match="line 1.*stress=100"):
        read(file("T=20;Mw=3;\n1 0.001\n", "melt.creep"))
    with pytest.raises(ValueError, match="recovery after creep"):
        read(file("T=20;stress=50;rec=1;\nt strain stress\n1 0.001\n", "melt.creep"))


def test_rheocompass_may_leave_out_the_empty_cell_and_state_its_temperature(file):
    text = "Project:\tx\nGeometry:\tPlate-Plate\nTemperature:\t25.0 °C\n"
    for number, own in ((1, ""), (2, "Temperature:\t40.0 °C\n")):
        text += f"\nInterval and data points:\t{number}\t2\n{own}"
        text += "Interval data:\tAngular Frequency\tStorage Modulus\tLoss Modulus\n"
        text += "\t[rad/s]\t[Pa]\t[Pa]\n1\t1000\t100\n2\t1100\t150\n"
    sweeps = read_dma(file(text))
    assert sweeps.kind == "G"
    assert_allclose(sweeps.temperature, [298.15, 298.15, 313.15, 313.15])
    assert sweeps.storage.tolist() == [1000, 1100, 1000, 1100]


def test_a_temperature_above_the_table_is_that_of_its_points(file):
    table = "f [Hz],E' [MPa],E'' [MPa]\n1,3,0.4\n2,4,0.5\n"
    assert read_dma(file("Temperature: 25.0 °C\n" + table)).temperature[0] == 298.15
    assert read_dma(file("Name,x\nTemperature,300 K\n" + table)).temperature[0] == 300
    two = "Temperature,300 K\nTemperature,310 K\n" + table
    assert np.all(np.isnan(read_dma(file(two)).temperature))
    assert np.all(np.isnan(read_dma(file("Temperature limit,620 °C\n" + table)).temperature))


@pytest.mark.parametrize("say", ["Temperature: {} °C", "Temperature:,{} °C,", "{} °C,,", "{} °C"])
def test_text_between_tables_states_the_temperature_of_the_next_one(file, say):
    head, rows = "f [Hz],E' [MPa],E'' [MPa]\n", "1,3,0.4\n2,4,0.5\n"
    text = "".join(f"{say.format(x)}\n{head}{rows}" for x in (20, 40))
    text += f"Interval: 3,,\n{head}{rows}"
    sweeps = read_dma(file(text))
    assert_allclose(sweeps.temperature, np.repeat([293.15, 313.15, 313.15], 2))
    assert sweeps.storage.tolist() == 3 * [3e6, 4e6]


def test_tables_of_several_materials_side_by_side_are_refused(file):
    text = "A,,,B,,\n" + ",".join(["f [Hz],E' [MPa],E'' [MPa]"] * 2) + "\n1,3,0.4,1,30,4\n"
    with pytest.raises(ValueError, match="'A' above the columns"):
        read_dma(file(text))


def test_intervals_with_the_same_headings_are_tables_of_their_own(file):
    head = "Angular Frequency\tStorage Modulus\tLoss Modulus\n\t\t\n[rad/s]\t[Pa]\t[Pa]\n"
    text = (
        f"Test:\tgel\nResult:\tFrequency sweep 10C\nInterval:\t1\n{head}1\t30,5\t4,5\n2\t31,5\t5\n"
    )
    text += f"\nTest:\tgel\nResult:\tagain\nInterval:\t2\n{head}1\t20,5\t3\n2\t21\t4\n\t\t\n"
    sweeps = read_dma(file(text.encode("utf-16")), kind="G")
    assert sweeps.sweep.tolist() == [0, 0, 1, 1]
    assert sweeps.storage.tolist() == [30.5, 31.5, 20.5, 21]
    # a byte too many at the end is half a character
    odd = read_dma(file(text.encode("utf-16") + b"\n"), kind="G")
    assert odd.storage.tolist() == sweeps.storage.tolist()


def halves():
    """Return the film's sweeps as one file each, without temperatures."""
    for i, celsius in enumerate(lab_files.CELSIUS):
        rows = [
            f"{f:g},{lab_files.STORAGE[i, j]:.8g},{lab_files.LOSS[i, j]:.8g}"
            for j, f in enumerate(lab_files.HERTZ)
        ]
        yield f"film_3_{celsius:g}C.csv", "\n".join(["f,E',E''", "Hz,MPa,MPa", *rows, ""])


def test_several_files_are_one_material(file):
    paths = [file(text, name) for name, text in halves()]
    sweeps = read_dma(paths, temperature_in_name=True)
    assert_the_film(sweeps)
    assert set(sweeps.sweep) == {0, 1, 2}
    assert "3 files joined as one material" in notes(sweeps)
    assert all(path.name in sweeps.source.path for path in paths)
    assert len(sweeps.source.sha256) == 64
    other = file("f,G',G''\nHz,MPa,MPa\n1,2,3\n", "g_20C.csv")
    with pytest.raises(ValueError, match="some files are tensile .E., others shear"):
        read_dma([*paths, other])
    with pytest.raises(ValueError, match="is the same file as"):
        read_dma([paths[0], paths[0]])
    with pytest.raises(ValueError, match="no file to read"):
        read_dma([])


def test_a_name_has_one_temperature(file):
    text = next(halves())[1]
    for name, found in (("film.csv", 0), ("film_20C_30C.csv", 2), ("PC20K.5C2.csv", 0)):
        with pytest.raises(ValueError, match=f"`temperature_in_name`.*found {found}"):
            read_dma(file(text, name), temperature_in_name=True)
    with pytest.raises(ValueError, match="'-25C' in the name"):
        read_dma(file(text, "film-25C.csv"), temperature_in_name=True)
    assert read_dma(file(text, "a 293.15 K.csv"), temperature_in_name=True).temperature[0] == 293.15


def test_shifts_of_the_other_sign_are_refused(file):
    rising = file("T [oC],aT\n-40,0.1\n20,1\n60,10\n")
    with pytest.raises(ValueError, match=r"rise with temperature.*give 1/a_T"):
        read_shifts(rising)
    assert len(read_shifts(file("T [oC],aT\n-40,10\n20,1\n60,0.1\n"))) == 3
