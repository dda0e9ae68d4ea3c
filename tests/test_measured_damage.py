"""Damaged files: an error that names the file, or right numbers, never anything else.

What no reader can see is a digit changed into another digit in a number that stands in the file
once; so the bytes that are put in here are not digits where the numbers themselves are compared.
"""

import json
import re

import numpy as np
import pytest

import lab_files
from viscotack import lab
from viscotack.errors import InputError
from viscotack.lab import FORMATS, read_creep, read_dma, read_relaxation, read_shifts

TEXTS = {**lab_files.TEXTS, "reptate": lab_files.reptate()}
every_text = pytest.mark.parametrize("name", TEXTS)


def read(path, content):
    """Return the sweeps of a damaged file, or None; anything but a refusal is a failure."""
    path.write_bytes(content)
    try:
        return read_dma(path)
    except InputError as error:
        assert str(path) in str(error)
        return None


def points(sweeps):
    """Return what identifies each point: frequency and storage, to eleven digits."""
    columns = zip(sweeps.angular_frequency, sweeps.storage, strict=True)
    return [tuple(f"{x:.10e}" for x in row) for row in columns]


def assert_right(sweeps, whole):
    """Every point is one of the whole file's, at its temperature or at an unknown one."""
    known = dict(zip(points(whole), zip(whole.temperature, whole.loss, strict=True), strict=True))
    found = zip(points(sweeps), sweeps.temperature, sweeps.loss, strict=True)
    for point, temperature, loss in found:
        assert point in known
        assert np.isnan(temperature) or temperature == pytest.approx(known[point][0], rel=1e-12)
        # where the loss modulus is lost it is found from tan(delta), which has four digits
        assert loss == pytest.approx(known[point][1], rel=1e-3)


QUICK, LONG = 25, pytest.param(1500, marks=pytest.mark.slow)


@every_text
@pytest.mark.parametrize("cuts", [QUICK, LONG])
def test_a_file_cut_anywhere_gives_right_points_or_an_error(name, cuts, tmp_path):
    path = tmp_path / "film.osc"
    content = TEXTS[name]
    whole = read(path, content)
    found = 0
    within_the_last_row = np.arange(len(content) - 12, len(content))
    for length in (*np.linspace(0, len(content) - 13, cuts, dtype=int), *within_the_last_row):
        sweeps = read(path, content[:length])
        if sweeps is not None:
            assert_right(sweeps, whole)
            found += 1
    assert found < cuts + 12


def decoded(content):
    encoding = "utf-16" if content[:2] in (b"\xff\xfe", b"\xfe\xff") else "latin-1"
    text = content.decode(encoding)
    return text.replace("\r\n", "\n").split("\n"), encoding


# a row of JSON has no columns
@pytest.mark.parametrize("name", [name for name in TEXTS if name != "trios-json"])
@pytest.mark.parametrize("which", ["everywhere", "rows only", "one row"])
def test_a_lost_column_gives_right_points_or_an_error(name, which, tmp_path):
    path = tmp_path / "film.osc"
    whole = read(path, TEXTS[name])
    lines, encoding = decoded(TEXTS[name])
    separator = max("\t;,", key=TEXTS[name].decode("latin-1").count)
    width = max(line.count(separator) for line in lines) + 1
    numeric = [i for i, line in enumerate(lines) if any(c.isdigit() for c in line)
               and line.count(separator) >= 2]  # fmt: skip
    chosen = {"everywhere": range(len(lines)), "rows only": numeric, "one row": numeric[-1:]}[which]
    refused = 0
    for column in range(width):
        changed = [
            separator.join(c for j, c in enumerate(line.split(separator)) if j != column)
            if i in chosen and line.count(separator) >= 2
            else line
            for i, line in enumerate(lines)
        ]
        sweeps = read(path, "\n".join(changed).encode(encoding))
        refused += sweeps is None
        if sweeps is not None:
            assert_right(sweeps, whole)
    # with all variables each number stands in the file twice, and one column is not missed
    assert refused > 0 or (name, which) == ("trios all variables", "everywhere")


COLUMNS = [{"name": "Time", "unit": "s"}, {"name": "G(t)", "unit": "Pa"}]
LISTS = {"Results": [{"DataSet": [{"Data": {"columns": COLUMNS, "values": [[1, 2.5], [2, 1]]}}]}]}
CHINESE = "角频率 (rad/s),储能模量 (kPa),损耗模量 (Pa)\n1,9,300\n10,11,350\n"
WAVES = (
    "Interval and data points:\t1\t2\nInterval data:\tPoint No.\tPeriod Time\tFrequency\t"
    "Storage Modulus\tLoss Modulus\n\t\tWaveform\t\t\t\n\t\t[s]\t[Hz]\t[Pa]\t[Pa]\n"
    "\t1\t0\t1\t9\t3\n\t\t0.1\t\t\t\n\t\t0.2\t\t\t\n\t2\t0\t2\t10\t3\n\t\t0.1\t\t\t\n"
)
OTHERS = {
    "relaxation.csv": b"t,E_relax,T\ns,MPa,C\n1,900,20\n10,500,20\n",
    "step.gt": b"T=20;gamma=0.1;\nt sxy\n0.1 5e5\n1 3e5\n",
    "step.creep": b"T=20;stress=10;\nt strain\ns -\n0.1 5e-5\n1 3e-4\n",
    "factors.ttsf": b"Mw=1;chem=PI;\nT aT bT\n-40 1000 1.1\n20 1 1\n",
    "shifts.csv": b"T,log_aT\nC,-\n20,0\n-40,5\n",
    "creep.csv": b"t;D(t)\ns;1/Pa\n1,5;3e-6\n10,5;6e-6\n",
    "held.csv": b"time_s,stress_Pa,strain_%,G_x\n0,5,0,1\n1,9,2,1\n2,9.1,3,1\n3,9,4,1\n",
    "polar.csv": lab_files.polar(),
    "sweep.osc": lab_files.reptate_osc(),
    "lists.json": json.dumps(LISTS).encode(),
    "waves.csv": WAVES.encode("utf-16"),
    "china.csv": CHINESE.encode("gb18030"),
    "rheowin.csv": b"SegIndex,f in Hz,G' in Pa,G'' in Pa\n1|1,1,9,3\n1|2,2,10,3\n2|1,1,9,3\n",
    "beside.csv": b"t,J,,t,J\ns,1/Pa,,s,1/Pa\n1,2,,1,3\n2,3,,2,4\n3,4,,,\n",
    "names.csv": b"omega_rad_s,G_storage_mpa,G_loss_kpa\n1,9,300\n10,11,350\n",
} | {f"{name.replace(' ', '_')}.txt": text for name, text in TEXTS.items()}  # fmt: skip


def mutated(content, rng):
    """Return a file with bytes, cells, rows, units or the encoding changed."""
    content = bytearray(content)
    for _ in range(rng.integers(1, 4)):
        if len(content) < 4:
            break
        start = int(rng.integers(0, len(content)))
        end = min(start + int(rng.integers(1, 30)), len(content))
        how = rng.integers(10)
        if how == 0:
            content[start:end] = rng.integers(0, 256, end - start, dtype=np.uint8).tobytes()
        elif how == 1:
            del content[start:end]
        elif how == 2:
            content[start:start] = content[start:end]
        elif how == 3:
            del content[start:]
        elif how == 4:
            lines = bytes(content).split(b"\n")
            one, other = rng.integers(len(lines), size=2)
            lines[one], lines[other] = lines[other], lines[one]
            content = bytearray(b"\n".join(lines))
        elif how == 5:
            lines = bytes(content).split(b"\n")
            content = bytearray(b"\n".join(rng.permutation(np.array(lines, dtype=object))))
        elif how == 6:
            cells = re.split(rb"([,;\t])", bytes(content))
            cells[rng.integers(len(cells))] = rng.choice([b"", b"1", b"abc", b"[Pa]", b"\xb0C"])
            content = bytearray(b"".join(cells))
        elif how == 7:
            unit, other = rng.permutation([b"Pa", b"MPa", b"Hz", b"rad/s", b"s", b"", b"C"])[:2]
            content = bytearray(bytes(content).replace(unit, other, 1) if unit else content)
        elif how == 8:
            text = bytes(content).decode("latin-1")
            code = rng.choice(["utf-8", "utf-16", "utf-16-le", "gb18030", "cp1251", "cp932"])
            content = bytearray(text.encode(code, "replace"))
        else:
            mark = rng.choice(list(b",;\t .-+eE0\"'{}[]:=/"))
            content[start] = mark
    return bytes(content)


@pytest.mark.parametrize("tries", [60, pytest.param(2000, marks=pytest.mark.slow)])
def test_every_reader_reads_or_refuses_a_mutated_file(tries, tmp_path):
    rng = np.random.default_rng(3)
    names, answered = list(OTHERS), 0
    readers = (lab.read, read_dma, read_relaxation, read_creep, read_shifts)
    for _ in range(tries):
        path = tmp_path / names[rng.integers(len(names))]
        path.write_bytes(mutated(OTHERS[path.name], rng))
        format = rng.choice([None] * len(FORMATS) + [*FORMATS])
        for reader in readers:
            try:
                test = reader(path, format=format)
            except InputError as error:
                assert str(path) in str(error)
                continue
            answered += 1
            columns = (column for column in vars(test).values() if isinstance(column, np.ndarray))
            assert not any(np.any(np.isinf(column)) for column in columns)
    assert 0.1 * tries < answered < 2 * tries


@pytest.mark.parametrize("name", lab_files.TEXTS)
def test_a_removed_unit_gives_right_points_or_an_error(name, tmp_path):
    path = tmp_path / "film.txt"
    whole = read(path, TEXTS[name])
    lines, encoding = decoded(TEXTS[name])
    text = "\n".join(lines)
    places = [m.span() for m in re.finditer(r"(MPa|Pa|Hz|rad/s|°C)(?![A-Za-z])", text)][:20]
    read_as_before = 0
    for start, end in places:
        sweeps = read(path, (text[:start] + text[end:]).encode(encoding))
        if sweeps is not None:
            # a unit of another step, or of a column that is not needed
            assert_right(sweeps, whole)
            read_as_before += 1
    assert places and read_as_before < len(places)
