"""Files that would take all memory or all time are refused before they are read."""

import io
import os
import subprocess
import sys
import tracemalloc
import zipfile
from hashlib import sha256

import numpy as np
import pytest

import tack_files
from viscotack import load as load_result
from viscotack.campaign import apart as campaign_apart
from viscotack.campaign.apart import check_apart
from viscotack.campaign.parts import parquet, table_of
from viscotack.errors import InputError
from viscotack.files.archive import read_arrays
from viscotack.files.bounded import read_bytes
from viscotack.files.text import read_rows, read_text
from viscotack.files.toml import parse_toml, read_toml
from viscotack.lab.lab_file import load
from viscotack.lab.tack import survey
from viscotack.lab.workbook_layout import sheets
from viscotack.operations import ask
from viscotack.pool.apart import Apart

BOOK = {
    "[Content_Types].xml": (
        '<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/'
        'content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-'
        'package.relationships+xml"/><Default Extension="xml" ContentType="application/xml"/>'
        '<Override PartName="/xl/workbook.xml" ContentType="application/vnd.openxmlformats-'
        'officedocument.spreadsheetml.sheet.main+xml"/><Override PartName="/xl/worksheets/'
        'sheet1.xml" ContentType="application/vnd.openxmlformats-officedocument.spreadsheetml.'
        'worksheet+xml"/></Types>'
    ),
    "_rels/.rels": (
        '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
        '<Relationship Id="rId1" Type="http://schemas.openxmlformats.org/officeDocument/2006/'
        'relationships/officeDocument" Target="xl/workbook.xml"/></Relationships>'
    ),
    "xl/workbook.xml": (
        '<workbook xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main" xmlns:r='
        '"http://schemas.openxmlformats.org/officeDocument/2006/relationships"><sheets>'
        '<sheet name="a" sheetId="1" r:id="rId1"/></sheets></workbook>'
    ),
    "xl/_rels/workbook.xml.rels": (
        '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
        '<Relationship Id="rId1" Type="http://schemas.openxmlformats.org/officeDocument/2006/'
        'relationships/worksheet" Target="worksheets/sheet1.xml"/></Relationships>'
    ),
}
HEAD = '<worksheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main">'


def cell(place, inside="<v>1</v>", kind=""):
    """Return a row with a cell."""
    row = "".join(letter for letter in place if letter.isdigit())
    return f'<row r="{row}"><c r="{place}"{kind}>{inside}</c></row>'


def workbook(path, rows, dimension=""):
    """Write a workbook with one sheet."""
    packed = io.BytesIO()
    stated = f'<dimension ref="{dimension}"/>' if dimension else ""
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in BOOK.items():
            archive.writestr(name, content)
        sheet = f"{HEAD}{stated}<sheetData>{rows}</sheetData></worksheet>"
        archive.writestr("xl/worksheets/sheet1.xml", sheet)
    path.write_bytes(packed.getvalue())
    return load(path)


BOMBS = {
    "a wide row": cell("XFD1"),
    "a far row": cell("A1048576"),
    "many rows times many columns": cell("SF1") + cell("A150000"),
    "cells without places": "<row>" + "<c><v>1</v></c>" * 501 + "</row>",
}


@pytest.mark.parametrize("name", BOMBS)
def test_a_sheet_of_too_many_cells_is_refused_before_it_fills_the_memory(name, tmp_path):
    file = workbook(tmp_path / "bomb.xlsx", BOMBS[name])
    tracemalloc.start()
    try:
        with pytest.raises(InputError, match=file.path):
            sheets(file)
        most = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert most < 100e6


@pytest.mark.parametrize("dimension", ["", "A1", "A1:XFD1048576"])
def test_a_sheet_is_read_whatever_dimension_it_states(dimension, tmp_path):
    rows = cell("A1", "<is><t>xxx</t></is>", ' t="inlineStr"') + cell("C3", "<f>1+1</f><v>2</v>")
    file = workbook(tmp_path / "a.xlsx", rows, dimension)
    assert sheets(file) == {"a": [["xxx", "", ""], ["", "", ""], ["", "", "2.0"]]}


def test_a_name_that_stands_twice_behind_a_long_array_is_refused_in_time(monkeypatch):
    # reading the array anew for each of its lines took minutes
    from viscotack.files import toml

    read, whole = [], toml._is_toml
    monkeypatch.setattr(toml, "_is_toml", lambda lines: read.append(lines) or whole(lines))
    lines = [f"  {'1, ' * 100}" for _ in range(1900)]
    text = "\n".join(["x = [", *lines, "]", "y = 1", "y = 2"])
    with pytest.raises(InputError, match="line 1904, `y = 2`: cannot overwrite a value"):
        parse_toml(text, "bomb.toml")
    assert sum(sum(map(len, some)) for some in read) < 5e6


READERS = [read_text, read_toml, load, load_result, lambda path: read_bytes(path, 10)]


@pytest.mark.parametrize("read", READERS)
def test_devices_and_pipes_are_not_read(read, tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for path in ("/dev/zero", pipe):
        with pytest.raises(InputError, match="is no regular file: it is a device, a pipe"):
            read(path)


def test_more_than_is_taken_is_not_read(tmp_path):
    long = tmp_path / "long.toml"
    with long.open("wb") as file:
        file.truncate(3_000_000_000)  # a hole: nothing on the disk
    for read, most in ((read_text, "100 MB"), (read_toml, "6 MB"), (load, "50 MB")):
        with pytest.raises(InputError, match=f"larger than {most}"):
            read(long)


@pytest.mark.parametrize("read", [read_text, load])
def test_a_line_without_end_is_refused(read, tmp_path):
    file = tmp_path / "wide.csv"
    file.write_text("f,E\n1,2\n" + "1," * 600_000 + "1\n")
    with pytest.raises(InputError, match=r"wide.csv, line 3: a line of more than"):
        read(file)
    file.write_text("f,E\n1,2\n" + "1," * 40_000 + "1\n" + "3,4\n" * 100_000)
    assert read(file)


@pytest.mark.parametrize("cell", [",", ";", "\t", "\n"])
def test_a_text_of_too_many_cells_is_refused_before_it_is_split(cell, tmp_path):
    file = tmp_path / "long.csv"
    file.write_text("f,E\n" + (cell * 50_000 + "\n") * 101)
    with pytest.raises(InputError, match=r"cells, more than the limit of 5,000,000"):
        load(file)


def test_a_table_of_too_many_rows_is_refused_before_it_is_split(tmp_path):
    file = tmp_path / "long.csv"
    file.write_text("time_s,modulus_Pa\n" + "1\n" * 200_001)
    with pytest.raises(InputError, match=r"has 200,002 lines, more than the limit of 200,000"):
        read_rows(file)


def test_a_sweep_of_too_many_rows_is_refused_while_they_are_read(tmp_path):
    file = tmp_path / "long.csv"
    # the last row is damaged, and is not read
    file.write_text("rate\n" + "1\n" * 100_001 + "x\n")
    with pytest.raises(InputError, match=r"has more than 100,000 rows; run a campaign"):
        ask("sweep", problem={"indenter": "sphere"}, cases=file)


def test_files_beside_a_bomb_are_evaluated(tmp_path):
    test = tack_files.made()
    for name in ("a.jpk-force", "c.jpk-force"):
        (tmp_path / name).write_bytes(tack_files.jpk(test))
    with zipfile.ZipFile(tmp_path / "b.jpk-force", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("segments/0/segment-header.properties", "a=1")
        for number in range(210):
            archive.writestr(f"segments/0/{number}", bytes(1_000_000))
    found = survey([tmp_path])
    assert [one.record.source.path[-11:] for one in found.evaluations] == [
        "a.jpk-force",
        "c.jpk-force",
    ]
    ((path, reason),) = found.reasons
    assert path.endswith("b.jpk-force") and "200 MB" in reason


def test_zeros_that_unpack_to_gigabytes_are_not_unpacked(tmp_path):
    packed = io.BytesIO()
    np.savez_compressed(packed, header=np.zeros(20_000_000))
    with pytest.raises(
        InputError, match=r"it has 160 MB when unpacked, more than the limit of 5\d MB"
    ):
        read_arrays(packed, lambda name: True)
    # noise does not compress, and is read
    packed = io.BytesIO()
    np.savez_compressed(packed, header=np.random.default_rng(1).random(6_500_000))
    assert read_arrays(packed, lambda name: True)["header"].size == 6_500_000


def test_a_damaged_header_of_an_array_is_refused():
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        header = b"{'descr': '<f8', 'shape': (1,"
        size = len(header).to_bytes(2, "little")
        archive.writestr("header.npy", b"\x93NUMPY\x01\x00" + size + header + bytes(8))
    with pytest.raises(InputError, match=r"the header of header.npy is damaged: EOF in multi-line"):
        read_arrays(packed, lambda name: True)


def forged(folder, content):
    """Write a Parquet file; return it with the hash that a forged ledger has."""
    file = folder / "cases.parquet"
    file.write_bytes(content)
    return file, sha256(content).hexdigest()


def test_a_table_that_unpacks_to_gigabytes_is_not_read_in_this_process(tmp_path):
    import pyarrow as pa
    from pyarrow.parquet import write_table

    # the file states 200 values, and takes 2 GB for them
    words = pa.DictionaryArray.from_arrays(np.zeros(200, np.int32), pa.array(["x" * 10_000_000]))
    packed = io.BytesIO()
    write_table(pa.table({"name": words}), packed, compression="zstd", store_schema=False)
    assert len(packed.getvalue()) < 1000
    file = forged(tmp_path, packed.getvalue())
    with pytest.raises(InputError, match=r"cases.parquet is damaged: .* 150 MB of memory; move"):
        check_apart(*file)


def test_statistics_that_contradict_the_schema_are_refused_without_abort(tmp_path):
    import pyarrow as pa

    content = bytes(parquet(lambda: [pa.table({"tabor": [1.0, 2.0]})]))
    # in the footer, tabor becomes a column without missing values; the statistics count these
    optional, name = b"\x25\x02", b"\x18\x05tabor"
    assert content.count(optional + name) == 1
    file = forged(tmp_path, content.replace(optional + name, b"\x25\x00" + name))
    program = "import sys, viscotack.files.parquet as p; p.check_parquet(*sys.argv[1:])"
    command = [sys.executable, "-c", program, *map(str, file)]
    told = subprocess.run(command, capture_output=True, text=True)
    assert told.returncode == 1 and "InputError" in told.stderr, told.stderr
    with pytest.raises(InputError, match="cases.parquet is damaged: "):
        check_apart(*file)


def test_a_file_is_read_apart_once(tmp_path, monkeypatch):
    files = [(tmp_path / name, "") for name in "abc"]
    for number, (path, _) in enumerate(files):
        content = bytes(parquet(lambda n=number: [table_of([{"name": str(n)}])]))
        path.write_bytes(content)
        files[number] = path, sha256(content).hexdigest()
    calls = []
    monkeypatch.setattr(campaign_apart, "_SAFE", {files[2][1]})
    monkeypatch.setattr(Apart, "call", lambda self, check, path, *_, **__: calls.append(path))
    for file in files * 2:
        check_apart(*file, lambda: files)
    assert calls == [files[0][0], files[1][0]]
