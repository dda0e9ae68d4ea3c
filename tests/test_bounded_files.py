"""Files that would take all memory or all time are refused before they are read."""

import io
import tracemalloc
import zipfile

import openpyxl
import pytest

from viscotack.errors import InputError
from viscotack.files.text import read_text
from viscotack.files.toml import read_toml
from viscotack.lab.formats.file import load
from viscotack.lab.formats.workbook import sheets
from viscotack.model.surfaces import bumps, self_affine, sphere

HEAD = '<worksheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main">'


def cell(place, inside="<v>1</v>", kind=""):
    """Return a row with a cell."""
    row = "".join(letter for letter in place if letter.isdigit())
    return f'<row r="{row}"><c r="{place}"{kind}>{inside}</c></row>'


def workbook(path, rows, dimension=""):
    """Write a workbook whose only sheet has rows as they are."""
    book, blank = openpyxl.Workbook(), io.BytesIO()
    book.active.title = "a"
    book.save(blank)
    stated = f'<dimension ref="{dimension}"/>' if dimension else ""
    sheet = f"{HEAD}{stated}<sheetData>{rows}</sheetData></worksheet>"
    with zipfile.ZipFile(blank) as source, zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as out:
        for name in source.namelist():
            out.writestr(name, sheet if name.endswith("sheet1.xml") else source.read(name))
    return load(path)


BOMBS = {"a wide row": cell("XFD1"), "many rows times many columns": cell("SF1") + cell("A150000")}


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


def test_more_than_is_taken_is_not_read(tmp_path):
    long = tmp_path / "long.toml"
    with long.open("wb") as file:
        file.truncate(3_000_000_000)  # a hole: nothing on the disk
    for read, most in ((read_text, "100 MB"), (read_toml, "6 MB"), (load, "50 MB")):
        with pytest.raises(InputError, match=f"larger than {most}"):
            read(long)


@pytest.mark.parametrize(
    ("make", "more"),
    [
        (sphere, {"pixels": 100_000, "radius": 1e-3}),
        (self_affine, {"pixels": 8192, "hurst": 0.8, "rms_height": 1e-7, "seed": 1}),
        (bumps, {"pixels": 100_000, "radius": 1e-5, "spacing": 1e-5, "height": 1e-6}),
        (bumps, {"pixels": 64, "radius": 1e-5, "spacing": 1e-10, "height": 1e-6}),
    ],
)
def test_a_map_of_too_many_pixels_or_bumps_is_refused_before_it_is_made(make, more):
    tracemalloc.start()
    try:
        with pytest.raises(InputError):
            make(pixel=1e-6, **more)
        assert tracemalloc.get_traced_memory()[1] < 1e6
    finally:
        tracemalloc.stop()
