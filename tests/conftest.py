"""Options and fixtures of the tests."""

from pathlib import Path

import pytest
from hypothesis import settings

# The same examples in every run, however slow the machine is: the fuzzer draws others.
settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.load_profile("repeatable")


@pytest.fixture
def small(tmp_path, monkeypatch, request):
    """Stand in a folder with the file that the module of the test has as SMALL."""
    monkeypatch.chdir(tmp_path)
    Path("small.toml").write_text(request.module.SMALL)
    return Path("small.toml")


@pytest.fixture
def file(tmp_path):
    """Return a function that writes a file of text, bytes or sheets, and returns its path."""

    def write(content, name="film.csv"):
        path = tmp_path / name
        if isinstance(content, dict):
            book = pytest.importorskip("openpyxl").Workbook()
            book.remove(book.active)
            for title, rows in content.items():
                sheet = book.create_sheet(title)
                for row in rows:
                    sheet.append(row)
            book.save(path)
        else:
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write
