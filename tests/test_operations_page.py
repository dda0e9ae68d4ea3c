"""The requests of docs/operations.md and docs/api.md are answered."""

import json
import re
import shlex
import shutil
from pathlib import Path

import pytest

from front_ends import Http

ROOT = Path(__file__).parents[1]


@pytest.fixture
def anywhere(tmp_path, monkeypatch):
    """Work in a folder with the examples and the files that the pages name."""
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    shutil.copy(ROOT / "examples/from_toml/lens.toml", tmp_path)
    case = re.search(r"```json\n(.*?)```", (ROOT / "docs/api.md").read_text("utf-8"), re.S)
    assert case is not None
    (tmp_path / "case.json").write_text(case[1])
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("page", ["operations.md", "api.md"])
def test_requests_of_the_pages_are_answered(page, anywhere):
    text = (ROOT / "docs" / page).read_text("utf-8")
    lines = [x for x in re.findall(r"^\$ curl (.*)$", text, re.M) if "/jobs/" not in x]
    http, id = Http(), ""
    try:
        for line in lines:
            words = shlex.split(line)
            (url,) = (word for word in words if word.startswith("localhost"))
            path = url.removeprefix("localhost:8642").replace("files=ID", f"files={id}")
            if "-F" in words:
                file = Path(words[words.index("-F") + 1].removeprefix("files=@"))
                id = http(path, files={"files": (file.name, file.read_bytes())}).json()["files"]
                continue
            body = words[words.index("-d") + 1]
            body = Path(body[1:]).read_text("utf-8") if body.startswith("@") else body
            response = http(path, json=json.loads(body))
            assert response.status_code == 200, response.text
    finally:
        http.close()
    assert len(lines) > 2
