"""Damaged files: an error that names the file, or right numbers, never anything else.

What no reader can see is a digit changed into another digit in a number that stands in the file
once; so the bytes that are put in here are not digits where the numbers themselves are compared.
"""

import re

import numpy as np
import pytest

import lab_files
from viscotack.errors import InputError
from viscotack.lab import read_dma

TEXTS = {**lab_files.TEXTS, "reptate": lab_files.REPTATE}
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


QUICK, LONG = 15, pytest.param(120, marks=pytest.mark.slow)


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
    assert refused > 0 or (name, which) == ("trios_all_variables", "everywhere")


@pytest.mark.parametrize("name", lab_files.TEXTS)
def test_a_removed_unit_gives_right_points_or_an_error(name, tmp_path):
    path = tmp_path / "film.txt"
    whole = read(path, TEXTS[name])
    lines, encoding = decoded(TEXTS[name])
    text = "\n".join(lines)
    places = [m.span() for m in re.finditer(r"(MPa|Pa|Hz|rad/s|°C)(?![A-Za-z])", text)][:8]
    read_as_before = 0
    for start, end in places:
        sweeps = read(path, (text[:start] + text[end:]).encode(encoding))
        if sweeps is not None:
            # a unit of another step, or of a column that is not needed
            assert_right(sweeps, whole)
            read_as_before += 1
    assert places and read_as_before < len(places)
