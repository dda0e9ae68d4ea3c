"""Readers of laboratory files: formats, units, words, and what is refused."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import lab_files
from lab_files import assert_the_film, notes
from reference_data import DMA
from viscotack.errors import InputError
from viscotack.lab import read, read_dma, read_shifts
from viscotack.lab.sweeps import grouped


def table(*rows, names="f, E', E'', T", units="Hz, MPa, MPa, C"):
    return "\n".join([names, units, *rows]) + "\n"


@pytest.mark.parametrize("name", lab_files.TEXTS)
def test_every_text_format_gives_the_same_numbers(file, name):
    sweeps = read_dma(file(lab_files.TEXTS[name]))
    assert_the_film(sweeps)
    assert sweeps.source.format == name.partition("_")[0]
    assert f"detected format: {sweeps.source.format}" in sweeps.source.notes
    assert len(sweeps.source.sha256) == 64


@pytest.mark.parametrize(("name", "headings"), [("film.osc", True), ("film.tts", False)])
def test_reptate_is_read_in_its_own_units(file, name, headings):
    lines = lab_files.REPTATE.splitlines(keepends=True)
    sweeps = read_dma(file(b"".join(lines if headings else [lines[0], *lines[3:]]), name))
    assert sweeps.kind == "G"
    assert sweeps.source.format == "reptate"
    assert_allclose(sweeps.temperature, 253.15)
    assert_allclose(sweeps.storage, lab_files.PASCAL[0][8:])
    assert_allclose(sweeps.angular_frequency, lab_files.OMEGA[8:])


@pytest.mark.parametrize("name", ["csv_wide", "csv_wide_within"])
def test_sweeps_side_by_side_in_a_workbook_are_apart(name, tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    for line in lab_files.TEXTS[name].decode().splitlines():
        cells = line.split(",")
        book.active.append([float(x) if x[:1].isdigit() else x for x in cells])
    book.save(tmp_path / "film.xlsx")
    assert_the_film(read_dma(tmp_path / "film.xlsx"))


def test_the_published_sweeps_are_the_same_as_text_and_as_workbook():
    pytest.importorskip("xlrd")
    text = read_dma(DMA / "freq_user_raw.csv")
    book = read_dma(DMA / "freq_Eplexor_raw.xls")
    assert (text.source.format, book.source.format) == ("csv", "workbook")
    assert len(text) == len(book) == 210
    assert text.kind == book.kind == "E"
    assert set(text.sweep) == set(range(21))
    assert np.array_equal(text.sweep, book.sweep)
    # the text has ten digits
    assert_allclose(text.storage, book.storage, rtol=1e-9)
    assert_allclose(text.loss, book.loss, rtol=1e-9)
    assert_allclose(text.temperature, book.temperature, rtol=1e-12)
    assert_allclose(text.storage[0], 8097.175545e6, rtol=1e-12)
    assert_allclose(text.angular_frequency[0], 0.2 * np.pi, rtol=1e-12)


def test_the_published_master_curves_are_read():
    master = read_dma(DMA / "freq_user_master.csv")
    assert len(master) == 206
    assert set(master.sweep) == {0}
    assert np.all(np.isnan(master.temperature))
    relaxation = read(DMA / "time_user_master.csv")
    assert len(relaxation) == 481
    assert relaxation.kind == "E"
    assert relaxation.modulus[0] == pytest.approx(1714.266e6, rel=1e-12)
    shifts = read_shifts(DMA / "freq_user_master__shift_factors.csv")
    assert len(shifts) == 21
    assert shifts.temperature[0] == pytest.approx(223.15, rel=1e-12)
    assert [shifts.values[i] for i in (0, 6, -1)] == [12.75, 0.0, -11.7]
    assert shifts.uncertainty == ()


PER_SECOND = table("1, 3, 0.4, 20", units="1/s, MPa, MPa, C")
NO_KIND = "Frequency\tStorage modulus\tLoss modulus\nHz\tPa\tPa\n1\t3e6\t4e5\n"
TWO_KINDS = table("1, 3, 0.4, 1, 0.1", names="f, E', E'', G', G''", units="Hz" + ", MPa" * 4)
THOUSANDS = "f\tE'\tE''\tT\nHz\tMPa\tMPa\tC\n1\t1,234\t{loss}\t20\n"


@pytest.mark.parametrize(
    ("content", "asked", "said", "column", "value"),
    [
        (PER_SECOND, "line 3.*`frequency", {"frequency_unit": "rad/s"}, "angular_frequency", 1),
        (PER_SECOND, "`frequency_unit`", {"frequency_unit": "Hz"}, "angular_frequency", 2 * np.pi),
        (table("1, 3, 0.4, 20", units="Hz, -, -, C"), "E'. and .E''. .*`modulus_unit`",
         {"modulus_unit": "MPa"}, "storage", 3e6),
        (NO_KIND, "`kind`", {"kind": "G"}, "storage", 3e6),
        (TWO_KINDS, "`kind`", {"kind": "E"}, "storage", 3e6),
        (TWO_KINDS, "`kind`", {"kind": "G"}, "storage", 1e6),
        (THOUSANDS.format(loss="1"), "`decimal`", {"decimal": ","}, "storage", 1.234e6),
    ],
)  # fmt: skip
def test_what_a_file_leaves_open_is_refused_until_it_is_said(
    file, content, asked, said, column, value
):
    path = file(content)
    with pytest.raises(InputError, match=asked):
        read_dma(path)
    assert getattr(read_dma(path, **said), column)[0] == value


def test_some_words_and_marks_need_no_flag(file):
    # 0,5 can only be a decimal comma
    assert read_dma(file(THOUSANDS.format(loss="0,5"))).storage[0] == 1.234e6
    with pytest.raises(InputError, match="`kind` must be E"):
        read_dma(file(NO_KIND), kind="shear")


def test_moduli_whose_units_cannot_both_be_right_are_refused(file):
    with pytest.raises(ValueError, match=r"line 3: .*units"):
        read_dma(file(table("1, 3, 0.4, 20", units="Hz, MPa, Pa, C")))


def test_shear_becomes_tension_with_a_poisson_ratio(file):
    shear = read_dma(file(lab_files.REPTATE, "film.osc"))
    tension = shear.in_tension(0.45)
    assert tension.kind == "E"
    assert_allclose(tension.loss, 2.9 * shear.loss)
    assert "Poisson ratio 0.45" in notes(tension)
    assert tension.in_tension(0.3) is tension
    with pytest.raises(ValueError, match="between 0 and 0.5"):
        shear.in_tension(0.6)


@pytest.mark.parametrize("cell", ["abc", "1_000", "1.2.3", "inf", "٣"])
def test_what_is_no_number_is_refused_with_its_line(file, cell):
    with pytest.raises(ValueError, match=r"line 4: column .E'.: expected a number"):
        read_dma(file(table("1, 3, 0.4, 20", f"10, {cell}, 0.4, 20")))


def test_points_without_a_number_or_not_positive_are_left_out_with_a_note(file):
    sweeps = read_dma(
        file(
            table("1, 3, 0.4, 20", "2, ---, 0.4, 20", "3, 3, -0.1, 20", "4, 3, , 20", "5, 3, 1, 20")
        )
    )
    assert_allclose(sweeps.angular_frequency, 2 * np.pi * np.array([1, 5]))
    assert "a number is missing: line 4, 6" in notes(sweeps)
    assert "a value is not positive: line 5" in notes(sweeps)


@pytest.mark.parametrize(("name", "unit"), [("tan delta", "-"), ("|E*|", "MPa")])
def test_a_number_that_contradicts_its_row_is_found(file, name, unit):
    value = 0.1333 if unit == "-" else 3.0265
    names, units = f"f, E', E'', {name}", f"Hz, MPa, MPa, {unit}"
    path = file(table(f"1, 3, 0.4, {value}", f"2, 3.00, 0.40, {value}", names=names, units=units))
    assert len(read_dma(path)) == 2
    path = file(table(f"1, 3, 0.4, {value}", f"2, 8.00, 0.40, {value}", names=names, units=units))
    with pytest.raises(ValueError, match=r"line 4: "):
        read_dma(path)


@pytest.mark.parametrize("name", ["trios_text", "rheocompass", "rheocompass_csv"])
def test_a_lost_row_is_found_where_the_file_counts_them(file, name):
    encoding = "utf-16" if name == "rheocompass" else "utf-8"
    lines = lab_files.TEXTS[name].decode(encoding).split("\r\n")
    kept = [line for line in lines if "100\t" not in line and ",100," not in line]
    assert len(kept) == len(lines) - 3
    with pytest.raises(ValueError, match="4 points but has 3"):
        read_dma(file("\r\n".join(kept).encode(encoding)))


def test_unsorted_rows_give_the_same_sweeps(file):
    head, *rest = lab_files.TEXTS["csv"].decode().splitlines()[1:]
    lines = ["f,E',E'',T", head, *np.random.default_rng(0).permutation(rest)]
    sweeps = read_dma(file("\n".join(lines) + "\n"))
    assert set(sweeps.sweep) == {0, 1, 2}
    order = np.lexsort((sweeps.angular_frequency, sweeps.temperature))
    assert_allclose(sweeps.storage[order], lab_files.PASCAL[0])


def test_sweeps_up_and_down_at_one_temperature_are_two():
    up_and_down = np.array([1.0, 10, 100, 10, 1])
    numbers, how = grouped(np.full(5, 300.0), up_and_down)
    assert numbers.tolist() == [0, 0, 0, 1, 1]
    assert "reversal" in how


def test_a_ramp_at_one_frequency_is_one_sweep(file):
    rows = [f"1, {1000 / (i + 1)}, 10, {10 * i - 130}" for i in range(16)]
    sweeps = read_dma(file(table(*rows)))
    assert len(sweeps) == 16
    assert set(sweeps.sweep) == {0}


def test_an_amplitude_sweep_is_not_taken_for_a_frequency_sweep(file):
    amplitude = [f"1, {3 - i / 10}, 0.4, 20" for i in range(5)]
    with pytest.raises(
        ValueError, match="line 3: all points have one temperature and one frequency"
    ):
        read_dma(file(table(*amplitude)))
    names = "Angular frequency,Step time,Temperature,Storage modulus,Loss modulus,Tan(delta)"
    extra = ["[step]", "Amplitude sweep - 1", names, "rad/s,s,°C,MPa,MPa,"]
    extra += [f"6.28,{60 * i},20,{3 - i / 10},0.4,{0.4 / (3 - i / 10):.4f}" for i in range(4)]
    begin, steps = lab_files.TEXTS["trios_csv"].decode("latin-1").split("\n\n", 1)
    text = "\n".join([begin, "", *extra, "", steps])
    sweeps = read_dma(file(text.encode("latin-1")))
    assert_the_film(sweeps)
    assert "an amplitude or time sweep?" in notes(sweeps)


def test_the_temperature_is_required_where_the_file_has_none(file):
    path = file(table("1, 3, 0.4", names="f, E', E''", units="Hz, MPa, MPa"))
    assert np.isnan(read_dma(path).temperature[0])
    assert read_dma(path, temperature=293.15).temperature[0] == 293.15
    with pytest.raises(ValueError, match=r"`temperature` must be above 0 K"):
        read_dma(path, temperature=-20)
    with pytest.raises(ValueError, match="the file states its temperatures"):
        read_dma(file(lab_files.TEXTS["csv"]), temperature=293.15)


def test_a_relaxation_test_is_read(file):
    text = "t, G_relax, T\ns, kPa, C\n0, 900, 20\n10, 500, 20.4\n1, 700, 19.6\n"
    test = read(file(text))
    assert test.kind == "G"
    assert test.time.tolist() == [1, 10]
    assert test.modulus.tolist() == [7e5, 5e5]
    assert test.temperature == pytest.approx(293.15)
    assert "not positive: line 3" in notes(test)
    assert_allclose(test.in_tension(0.5).modulus, [2.1e6, 1.5e6])


def test_a_modulus_is_found_as_stress_over_strain_in_the_time_of_the_step(file):
    names = ("Interval data:", "Point No.", "Time", "Interval Time", "Shear Strain", "Shear Stress")
    rows = [
        ("Interval and data points:", "1", "3"),
        names,
        (),
        ("", "", "[s]", "[s]", "[%]", "[Pa]"),
        ("", "1", "100", "1", "2.0", "3000"),
        ("", "2", "110", "11", "2.0", "2000"),
        ("", "3", "200", "101", "2.0", "1500"),
    ]
    text = "\n".join("\t".join(row) for row in rows) + "\n"
    test = read(file(text.encode("utf-16")))
    assert test.source.format == "rheocompass"
    assert test.kind == "G"
    assert test.time.tolist() == [1, 11, 101]
    assert_allclose(test.modulus, [150e3, 100e3, 75e3])
    assert test.strain == pytest.approx(0.02)
    assert "modulus from stress over strain" in notes(test)
    with pytest.raises(ValueError, match="a creep test needs a constant stress"):
        read(file(text.encode("utf-16")), test="creep")


def test_shift_factors_of_reptate_are_read(file):
    shifts = read_shifts(
        file("Mw=1;chem=PI;\nT aT bT\n[°C] [-] [-]\n-40 1000 1.1\n20 1 1\n", "a.ttsf")
    )
    assert_allclose(shifts.values, [3, 0], atol=1e-15)
    assert_allclose(shifts.vertical, [np.log10(1.1), 0], atol=1e-15)


def test_a_creep_test_is_read_and_becomes_tensile(file):
    test = read(file("t\tJ(t)\ns\t1/MPa\n1\t3\n10\t6\n"))
    assert_allclose(test.in_tension(0.5).compliance, [1e-6, 2e-6])


STEPS = "t, G_relax, T\ns, Pa, C\n"


def test_steps_at_several_temperatures_are_several_tests(file):
    path = file(STEPS + "10,300,40\n1,500,40.2\n1,900,20\n10,700,19.9\n")
    for tests in (read(path), read(path, test="relaxation")):
        cold, hot = tests
        assert (cold.time.tolist(), cold.modulus.tolist()) == ([1, 10], [900, 700])
        assert (hot.time.tolist(), hot.modulus.tolist()) == ([1, 10], [500, 300])
        assert cold.temperature == pytest.approx(293.1)
        assert hot.temperature == pytest.approx(313.25)
    creep = read(file("t, J, T\ns, 1/MPa, C\n1,3,20\n10,6,20\n1,4,30\n10,8,30\n"), kind="G")
    assert [test.compliance[0] for test in creep] == [3e-6, 4e-6]


def test_a_drift_of_the_chamber_is_one_test(file):
    drifting = STEPS + "1,900,20\n10,700,22\n100,500,24\n"
    assert read(file(drifting)).temperature == pytest.approx(295.15)
    one = read(file(drifting), test="relaxation")
    assert one.time.tolist() == [1, 10, 100]
    for rows in ("1,900,20\n10,700,40\n100,500,60\n", "100,500,60\n10,700,40\n1,900,20\n"):
        # the time of a test begins again at each temperature; here it runs on
        with pytest.raises(ValueError, match="the temperature varies by 40 K"):
            read(file(STEPS + rows))
