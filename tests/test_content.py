"""Tables are found by their content: each test has a small file in the layout of a public one."""

import re

import numpy as np
import pytest

from viscotack import lab
from viscotack.errors import InputError
from viscotack.lab import tack

OMEGA = [1.0, 10.0, 100.0]
STORAGE = [1000.0, 2000.0, 3000.0]
LOSS = [100.0, 150.0, 210.0]
HERTZ = [omega / (2 * np.pi) for omega in OMEGA]


def table(names, factor=(1.0, 1.0, 1.0), separator=","):
    """Return the sweep as text below a line of headings; frequency, storage and loss in SI."""
    rows = zip(OMEGA, STORAGE, LOSS, strict=True)
    lines = [
        separator.join(repr(float(x / f)) for x, f in zip(row, factor, strict=True)) for row in rows
    ]
    return "\n".join([names, *lines, ""])


def assert_the_sweep(found, kind="G"):
    assert found.kind == kind
    np.testing.assert_allclose(found.angular_frequency, OMEGA, rtol=1e-12)
    np.testing.assert_allclose(found.storage, STORAGE, rtol=1e-12)
    np.testing.assert_allclose(found.loss, LOSS, rtol=1e-12)


@pytest.mark.parametrize(
    ("names", "factor", "separator"),
    [
        ("frequency_hz,storage_modulus_pa,loss_modulus_pa", (2 * np.pi, 1, 1), ","),
        ("omega_rad_per_s,G_storage_mpa,G_loss_kpa", (1, 1e6, 1e3), ","),
        ("Ang. Freq. (rad/s),Stor. Mod. (MPa),Loss Mod. (MPa)", (1, 1e6, 1e6), ","),
        (
            "# Frequency (Hz)\tG' Storage Modulus (MPa)\tG'' Loss Modulus (MPa)",
            (2 * np.pi, 1e6, 1e6),
            "\t",
        ),
        ('f in Hz;G\' in Pa;"G"" in Pa"', (2 * np.pi, 1, 1), ";"),
        ("# w\tG'\tG''\n# rad/s\tkPa\tPa", (1, 1e3, 1), "\t"),
    ],
)
def test_headings_of_public_files_are_read(file, names, factor, separator):
    assert_the_sweep(lab.read(file(table(names, factor, separator)), kind="G"))


@pytest.mark.parametrize(
    ("code", "names"),
    [
        ("gb18030", "角频率 (rad/s),储能模量 (Pa),损耗模量 (Pa)"),
        ("latin-1", "Kreisfrequenz [rad/s],Speichermodul [Pa],Verlustmodul [Pa],Übergang [°C]"),
    ],
)
def test_other_code_pages_are_decoded(file, code, names):
    text = table(names)
    if code == "latin-1":
        text = text.replace("0\n", "0,25\n")
    found = lab.read(file(text.encode(code)), kind="G")
    assert_the_sweep(found)
    assert f"text in {code}" in found.source.notes


def waves():
    """Rows of a rheometer with raw waves: a point, then samples of its period."""
    rows = [
        ["Point No.", "Period Time", "Frequency", "Storage Modulus", "Loss Modulus",
         "Shear Strain", "Shear Strain"],
        ["", "Waveform", "", "", "", "", "Waveform"],
        ["", "[s]", "[Hz]", "[Pa]", "[Pa]", "[%]", "[%]"],
    ]  # fmt: skip
    for i, (f, storage, loss) in enumerate(zip(HERTZ, STORAGE, LOSS, strict=True), start=1):
        rows.append([i, 0.0, f, storage, loss, 1.0, 0.1])
        rows += [["", 0.1 * k, "", "", "", "", 0.1 * k] for k in range(1, 6)]
    return rows


def test_raw_waves_between_the_points_of_a_workbook_are_not_used(file):
    found = lab.read(file({"Sheet1": [["0.01%strain"], *waves()]}, "waves.xlsx"))
    assert_the_sweep(found)
    assert "15 samples of raw waves between the points are not used" in found.source.notes


def creep(stress, strain):
    """Rows of a creep step, or of what follows it."""
    names = ["Point No.", "Time", "Shear Stress", "Shear Strain"]
    rows = [[i, float(i), stress, strain(i)] for i in range(1, 9)]
    return [names, ["", "", "", ""], ["", "[s]", "[Pa]", "[%]"], *rows]


def test_creep_beside_its_recovery_in_a_workbook_is_read(file):
    step = creep(5.0, lambda i: 2.0 * i)
    rest = [[*row] for row in creep(0.0, lambda i: 16.0 - i)]
    rows = [left + [None] + right for left, right in zip(step, rest, strict=True)]
    rows.append([None] * 5 + [9, 9.0, 0.0, 7.5])
    found = lab.read(file({"Data": [["Interval 1"], *rows]}, "creep.xlsx"))
    assert found.stress == 5.0
    np.testing.assert_allclose(found.time, np.arange(1.0, 9.0))
    np.testing.assert_allclose(found.compliance, 0.02 * np.arange(1.0, 9.0) / 5.0, rtol=1e-12)


def test_the_time_of_the_whole_test_is_not_taken_for_the_time_since_the_step(file):
    first = creep(0.0, lambda i: 0.01 * i)
    second = creep(5.0, lambda i: 2.0 * i)
    for row in second[3:]:
        row[1] += 8.5
    path = file({"Data": [*first, [], *second]}, "creep.xlsx")
    with pytest.raises(InputError, match=r'begins at 9.5 s.*`step_start` to "8 s"'):
        lab.read(path)
    with pytest.raises(InputError, match="`step_start`"):
        lab.read(path, table="2")
    found = lab.read(path, step_start=8.5)
    np.testing.assert_allclose(found.time, np.arange(1.0, 9.0))


def test_the_sheet_with_a_test_is_read_and_another_by_its_name(file):
    def rows(storage):
        lines = [["w", "G'", "G''"], ["rad/s", "Pa", "Pa"]]
        return [*lines, *([omega, storage, 10.0] for omega in OMEGA)]

    flow = [["Shear rate", "Viscosity"], ["1/s", "Pa*s"], [1, 2], [2, 2]]
    path = file({"Flow": flow, "One": rows(100.0), "Two": rows(200.0)}, "book.xlsx")
    assert set(lab.read(path).storage) == {100.0}
    assert any("sheet 'One' is read" in note for note in lab.read(path).source.notes)
    for choice in ("Two", "3"):
        assert set(lab.read(path, table=choice).storage) == {200.0}
    with pytest.raises(InputError, match="no `table` '4'.*3: Two, row 3"):
        lab.read(path, table="4")


def test_sheets_of_sweeps_at_temperatures_of_their_own_are_one_test(file):
    def rows(celsius):
        lines = [["w", "G'", "G''", "T"], ["rad/s", "Pa", "Pa", "°C"]]
        return [*lines, *([omega, 100.0 + celsius, 10.0, celsius] for omega in OMEGA)]

    details = [["Sample", "Gel A"], ["Geometry", "PP25"]]
    sheets = {"Details": details, "FS -10 °C": rows(-10), "FS 25 °C": rows(25)}
    found = lab.read(file(sheets, "book.xlsx"))
    assert set(found.storage) == {90.0, 125.0} and found.sweep.size == 2 * len(OMEGA)
    assert "2 sheets of sweeps are read: 'FS -10 °C', 'FS 25 °C'" in found.source.notes
    # two samples at one temperature are not one test
    found = lab.read(file({"A": rows(25), "B": rows(25.2)}, "book.xlsx"))
    assert set(found.storage) == {125.0}
    assert any(
        note.startswith("2 sheets hold sweeps, and only 'A' is read") for note in found.source.notes
    )


def test_segments_of_rheowin_are_tables(file):
    rows = [f"1|{i},{f},{s},{l}" for i, (f, s, l) in enumerate(zip(HERTZ, STORAGE, LOSS), 1)]  # noqa: B905, E741
    rows += [f"2|{i},1,{900 + i},90" for i in range(1, 5)]
    found = lab.read(file("\n".join(["SegIndex,f in Hz,G' in Pa,G'' in Pa", *rows, ""])))
    assert_the_sweep(found)
    assert any("one temperature and one frequency" in note for note in found.source.notes)


def test_a_column_and_its_unit_are_chosen_by_heading_or_number(file):
    names = "rate of the drive,sample left,sample right"
    path = file(table(names, (1, 1e3, 1)))
    columns = "angular frequency=1 [rad/s]; storage=sample left [kPa]; loss=3 [Pa]"
    assert_the_sweep(lab.read(path, kind="G", columns=columns))
    path = file(table("# no headings at all", (1, 1e3, 1)))
    columns = "angular_frequency=1 [rad/s]; storage=2 [kPa]; loss=3 [Pa]"
    assert_the_sweep(lab.read(path, kind="G", columns=columns))
    # a row of numbers that has the number of a column is no heading
    counted = lab.read(file("1,10,2\n2,11,3\n"), kind="G", columns=columns)
    assert counted.storage.tolist() == [1e4, 1.1e4]
    rows = [[w, s, l] for w, s, l in zip(OMEGA, STORAGE, LOSS)]  # noqa: B905, E741
    columns = "angular_frequency=1 [rad/s]; storage=2 [Pa]; loss=3 [Pa]"
    assert_the_sweep(lab.read(file({"Data": rows}, "film.xlsx"), kind="G", columns=columns))


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ("hardness=1", "`columns` must be like"),
        ("storage=G1 [Pa]", "no column 'G1'"),
        ("storage=G' [kPa]", 'the file states Pa for "G\'", but `columns` kPa'),
        ("storage=2; loss=2", '"G\'" is chosen as storage and as loss'),
    ],
)
def test_a_wrong_choice_of_columns_is_refused(file, columns, words):
    path = file("w,G',G''\nrad/s,Pa,Pa\n1,10,1\n10,11,1\n")
    with pytest.raises(InputError, match=re.escape(words)):
        lab.read(path, format="csv", columns=columns)


def jpk_text(height="measuredHeight", units="N m s", rows=60):
    """A text export of JPK: a header, an approach, a shorter header and a retraction."""
    lines = ["# TEXT EXPORT", "# springConstant: 46.0", ""]
    for segment, first in (("extend", 0), ("retract", rows)):
        lines += [f"# segment: {segment}", f"# columns: vDeflection {height} seriesTime"]
        lines += [f"# units: {units}", "#"]
        for i in range(rows):
            depth = (i if segment == "extend" else rows - 1 - i) * 1e-8
            lines.append(f"{1e-9 * i:.6e} {1e-5 - depth:.6e} {0.01 * (first + i):g}")
        lines.append("")
    return "\n".join(lines)


def test_text_of_jpk_is_read_with_its_cantilever(file):
    (record,) = tack.read(file(jpk_text(), "curve.txt"))
    assert record.source.format == "jpk-text" and len(record) == 120
    assert record.into == -1 and record.compliance == 1 / 46.0
    np.testing.assert_allclose(record.position[59:62], [9.41e-6, 9.41e-6, 9.42e-6], rtol=1e-12)
    assert record.time[-1] == 1.19 and record.force[1] == 1e-9


def test_columns_of_a_rig_are_chosen_by_number(file):
    rows = "\n".join(f"{t},{abs(t - 20) / 10 + 1},{max(20 - t, 0)}" for t in range(41)) + "\n"
    path = file(rows)
    with pytest.raises(InputError, match="`time_column`"):
        tack.read(path)
    columns = {"time_column": "1", "position_column": "2", "force_column": "3"}
    units = {"time_unit": "s", "length_unit": "mm", "force_unit": "mN"}
    (record,) = tack.read(path, **columns, **units)
    assert record.time[-1] == 40 and record.position[0] == 3e-3 and record.force[0] == 0.02


CHIARO = """Date\t12/05/2025\tTime\t11:20:38\tStatus\tOK
Piezo position (nm) (Measured)\t-10.3
k (N/m)\t0.019
Device:\tChiaro
Software version: V3.5.0
Max load (µN)\t0.050
Piezo speed  (µm/s)\t7.000

Time (s)\tLoad (uN)\tIndentation (nm)\tCantilever (nm)\tPiezo (nm)\tAuxiliary
"""


def test_the_drive_of_chiaro_is_the_piezo_and_not_the_indentation(file):
    pytest.importorskip("afmformats", reason="pip install viscotack[afm]")
    rows = [f"{i / 10}\t{i / 1e4}\t0\t{i}\t{100 * i}\t0" for i in range(40)]
    (record,) = tack.read(file((CHIARO + "\n".join(rows) + "\n").encode("latin-1"), "chiaro.txt"))
    assert record.source.format == "afmformats"
    np.testing.assert_allclose(np.ptp(record.position), 3.9e-6)
    assert record.compliance == pytest.approx(1 / 0.019)


def test_text_of_nt_mdt_needs_the_cantilever_of_the_caller(file):
    pytest.importorskip("afmformats", reason="pip install viscotack[afm]")
    rows = "".join(f"{-8000 + 8 * i},5\t{1 + i / 10:.1f}\t{1 + i / 9:.4f}\n" for i in range(60))
    path = file(rows.replace(".", ","), "nova.txt")
    with pytest.raises(InputError, match="sensitivity and spring constant.*`sensitivity`"):
        tack.read(path, format="afmformats")
    cantilever = {"spring_constant": 0.1, "sensitivity": 50.0, "nominal_speed": 1e-6}
    (record,) = tack.read(path, format="afmformats", **cantilever)
    assert record.compliance == 10.0
    # nA, by the sensitivity [m/A] and the spring constant [N/m]
    assert np.ptp(record.force[:60]) == pytest.approx(5.9e-9 * 50.0 * 0.1, rel=0.02)
