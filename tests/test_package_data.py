"""What is installed has every file that the package reads."""

import tomllib
from fnmatch import fnmatch
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src" / "viscotack"


def test_every_file_of_the_package_is_installed():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    patterns = project["tool"]["setuptools"]["package-data"]["viscotack"]
    files = {
        path.relative_to(PACKAGE).as_posix()
        for path in PACKAGE.rglob("*")
        if path.is_file() and path.suffix not in (".py", ".pyc")
    }
    assert len(files) > 30
    missing = sorted(f for f in files if not any(fnmatch(f, pattern) for pattern in patterns))
    assert not missing
    idle = [pattern for pattern in patterns if not any(fnmatch(f, pattern) for f in files)]
    assert not idle
