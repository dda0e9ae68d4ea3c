"""The contents of the two wheels: viscotack is small, viscotack-data has the data sets."""

import io
import subprocess
import sys
import tomllib
import venv
from fnmatch import fnmatch
from pathlib import Path
from shutil import copy, copytree, ignore_patterns
from zipfile import ZIP_DEFLATED, ZipFile

import pytest

from viscotack import __version__, datasets
from viscotack.datasets import files

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src" / "viscotack"
DATA = ROOT / "data" / "viscotack_data"
LOAD = "from viscotack import datasets; print(datasets.load('punch_faces').num_rows)"


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


def test_the_wheel_is_below_3_3_mb():
    packed = io.BytesIO()
    with ZipFile(packed, "w", ZIP_DEFLATED) as wheel:
        for name, path in contents(PACKAGE).items():
            wheel.write(path, name)
    # 3.15 MB, half of it four surrogates; its metadata has below 50 kB
    assert packed.tell() < 3.3e6 - 5e4


def test_the_wheel_has_no_data_sets_no_training_and_no_benchmarks():
    names = contents(PACKAGE)
    assert not [name for name in names if name.endswith((".parquet", ".csv"))]
    rooms = {part for name in names for part in Path(name).parts[:-1]}
    assert not rooms & {"research", "tests"}


def test_the_data_have_the_version_of_the_package():
    version = project(ROOT)["project"]["version"]
    assert version == __version__ == project(ROOT / "data")["project"]["version"]
    assert f"viscotack-data=={version}" in project(ROOT)["project"]["optional-dependencies"]["data"]


def test_the_package_has_the_checksum_of_every_data_set():
    digests = (PACKAGE / "datasets" / "SHA256SUMS").read_text().split()
    found = dict(zip(digests[1::2], digests[::2], strict=True))
    assert set(found) == {f"{name}.parquet" for name in datasets.NAMES}
    for name, digest in found.items():
        assert files.checksum((DATA / name).read_bytes()) == digest


def test_data_sets_are_found_in_an_installed_distribution(tmp_path, monkeypatch):
    monkeypatch.setattr(files, "_CHECKOUT", tmp_path / "no checkout")
    monkeypatch.syspath_prepend(DATA.parent)
    assert datasets.path("broad") == DATA / "broad.parquet"
    assert datasets.plan_path("broad") == DATA / "plans" / "broad.toml"


def test_without_data_sets_the_error_has_the_command_that_installs_them(tmp_path, monkeypatch):
    monkeypatch.setattr(files, "_CHECKOUT", tmp_path / "no checkout")
    monkeypatch.setattr(files, "find_spec", lambda name: None)
    wanted = rf"viscotack-data=={__version__}.*pip install .*\[data\]'"
    with pytest.raises(ModuleNotFoundError, match=wanted):
        datasets.load("thesis")


@pytest.mark.outside
def test_wheels_are_installed_together_and_apart(tmp_path):
    """Needs an index of packages for the build: setuptools."""

    def pip(*arguments):
        subprocess.run([sys.executable, "-m", "pip", *map(str, arguments)], check=True)

    # a copy: builds leave files beside the sources, which later builds would pack
    source = tmp_path / "source"
    for name in ("src", "data"):
        copytree(ROOT / name, source / name, ignore=ignore_patterns("__pycache__", "*.egg-info"))
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        copy(ROOT / name, source)
    pip("wheel", "--no-deps", "--wheel-dir", tmp_path, source, source / "data")
    (package,) = tmp_path.glob("viscotack-*.whl")
    (data,) = tmp_path.glob("viscotack_data-*.whl")
    assert package.stat().st_size < 3.3e6 < data.stat().st_size

    def loaded(*wheels):
        """Load a set in an environment with these wheels and the libraries of this one."""
        place = tmp_path / "-".join(wheel.name.partition("-")[0] for wheel in wheels)
        venv.create(place, with_pip=False)
        site = next(place.glob("lib/python*/site-packages"))
        pip("install", "--no-deps", "--quiet", "--target", site, *wheels)
        libraries = site / "libraries.pth"
        libraries.write_text("\n".join(path for path in sys.path if "site-packages" in path))
        return subprocess.run(
            [place / "bin" / "python", "-I", "-c", LOAD],
            cwd=tmp_path,
            capture_output=True,
            text=True,
        )

    assert loaded(package, data).stdout == "174\n"
    assert "pip install 'viscotack[data]'" in loaded(package).stderr
