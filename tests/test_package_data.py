"""The contents of the two wheels: viscotack is small, viscotack-data has the data sets."""

import tomllib
from fnmatch import fnmatch
from pathlib import Path

import pytest

from viscotack import __version__, datasets
from viscotack.datasets import files

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src" / "viscotack"
DATA = ROOT / "data" / "viscotack_data"


def project(folder):
    return tomllib.loads((folder / "pyproject.toml").read_text())


def patterns(folder, package):
    return project(folder)["tool"]["setuptools"]["package-data"][package]


def contents(package):
    """Return the files of a package by their names in it."""
    found = (path for path in package.rglob("*") if path.is_file() and path.suffix != ".pyc")
    return {path.relative_to(package).as_posix(): path for path in found}


@pytest.mark.parametrize(("folder", "package"), [(ROOT, PACKAGE), (ROOT / "data", DATA)])
def test_every_file_of_a_package_is_installed(folder, package):
    wanted = patterns(folder, package.name)
    names = [name for name in contents(package) if not name.endswith(".py")]
    assert len(names) > 15
    missing = [name for name in names if not any(fnmatch(name, pattern) for pattern in wanted)]
    assert not missing
    idle = [pattern for pattern in wanted if not any(fnmatch(name, pattern) for name in names)]
    assert not idle


def test_the_package_has_the_checksum_of_every_data_set():
    digests = (PACKAGE / "datasets" / "SHA256SUMS").read_text().split()
    found = dict(zip(digests[1::2], digests[::2], strict=True))
    assert set(found) == {f"{name}.parquet" for name in datasets.NAMES}
    for name, digest in found.items():
        assert files.checksum((DATA / name).read_bytes()) == digest


def test_without_data_sets_the_error_has_the_command_that_installs_them(tmp_path, monkeypatch):
    monkeypatch.setattr(files, "_CHECKOUT", tmp_path / "no checkout")
    monkeypatch.setattr(files, "find_spec", lambda name: None)
    wanted = rf"viscotack-data=={__version__}.*pip install .*\[data\]'"
    with pytest.raises(ModuleNotFoundError, match=wanted):
        datasets.load("thesis")
