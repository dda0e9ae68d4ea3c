"""The release: current metadata, archives with the same bytes, a folder to install from."""

import re
import subprocess
import sys
import venv
from importlib.util import find_spec
from pathlib import Path

import pytest

from release.metadata import ROOT

RUN = ["--tabor", "3.24", "--modulus-ratio", "0.1", "--exponent", "0.8", "--preload", "73"]


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    """Return a release folder of the last commit."""
    if find_spec("build") is None:
        pytest.fail("nothing to build with: pip install 'viscotack[release]'")
    out = tmp_path_factory.mktemp("release") / "out"
    subprocess.run([sys.executable, "-m", "release", "--out", out], cwd=ROOT, check=True)
    return out


@pytest.fixture(scope="session")
def environment(tmp_path_factory):
    """Return the Python of a fresh environment that has all libraries of this one but viscotack."""
    place = tmp_path_factory.mktemp("environment")
    venv.create(place / "venv", with_pip=True)
    libraries = place / "libraries"
    libraries.mkdir()
    left_out = re.compile(r"viscotack|__editable__|pip\b|pip-|.*\.pth$|__pycache__")
    for home in dict.fromkeys(path for path in sys.path if path.endswith("site-packages")):
        for path in Path(home).iterdir():
            link = libraries / path.name
            if not (left_out.match(path.name) or link.exists()):
                link.symlink_to(path)
    site = next((place / "venv").glob("lib/python*/site-packages"))
    (site / "libraries.pth").write_text(f"{libraries}\n")
    return place / "venv/bin/python"


def out_of(command, folder, **settings):
    """Run a command without the variables of this environment; return what it printed."""
    bare = {"PATH": "/usr/bin:/bin", **settings}
    done = subprocess.run(command, cwd=folder, env=bare, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.outside
def test_the_package_is_installed_from_the_folder(folder, environment, tmp_path):
    """As docs/install.md states, with the libraries of this environment instead of an index."""
    install = ["-m", "pip", "install", "--quiet", "--no-index", "--find-links", folder]
    out_of([environment, *install, "viscotack[app,campaign,data,lab]"], tmp_path)
    said = out_of([environment, "-c", "import viscotack; print(viscotack.__file__)"], tmp_path)
    assert said.startswith(str(environment.parents[1]))
    command = [environment.parent / "viscotack", "predict", "sphere", *RUN, "--rate", "316.23"]
    assert "7.33" in out_of(command, tmp_path)
    sets = "from viscotack import datasets; print(datasets.load('punch_faces').num_rows)"
    assert out_of([environment, "-c", sets], tmp_path) == "174\n"
