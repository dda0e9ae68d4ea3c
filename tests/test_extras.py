"""Extras: the commands in messages name existing extras and fit the installation."""

import json
import re
import tomllib
from importlib import metadata
from pathlib import Path

from viscotack.errors import install_command

ROOT = Path(__file__).parents[1]


class Installed:
    """A distribution that was installed from `origin` (PEP 610), or from an index for None."""

    def __init__(self, origin):
        self.origin = origin

    def read_text(self, name):
        return self.origin and json.dumps(self.origin)


def test_an_installed_wheel_gets_an_extra_by_the_name_of_the_package(monkeypatch):
    monkeypatch.setattr(metadata, "distribution", lambda name: Installed(None))
    assert install_command("lab") == "python -m pip install 'viscotack[lab]'"
    wheel = {"url": "file:///dist/viscotack.whl", "archive_info": {}}
    monkeypatch.setattr(metadata, "distribution", lambda name: Installed(wheel))
    assert install_command("app") == "python -m pip install 'viscotack[app]'"


def test_an_editable_checkout_gets_an_extra_in_place(monkeypatch, tmp_path):
    folder = tmp_path / "my checkout"
    folder.mkdir()
    origin = {"url": folder.as_uri(), "dir_info": {"editable": True}}
    monkeypatch.setattr(metadata, "distribution", lambda name: Installed(origin))
    assert install_command("lab") == f"python -m pip install -e '{folder}[lab]'"
    monkeypatch.chdir(folder)
    assert install_command("lab") == "python -m pip install -e '.[lab]'"


def test_every_extra_in_messages_and_pages_exists():

    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = set(project["optional-dependencies"])
    pages = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *ROOT.glob("docs/*.md")]
    text = "".join(p.read_text() for p in [*pages, *ROOT.glob("src/**/*.py")])
    named = re.findall(r"install_command\(['\"](\w+)|(?:viscotack|-e \"\.)\[([\w,]+)\]", text)
    found = {extra for pair in named for extra in "".join(pair).split(",")}
    least = {"app", "lab", "campaign", "cluster", "onnx", "afm", "data", "surfaces"}
    assert least <= found <= extras
