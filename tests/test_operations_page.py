"""The examples of docs/operations.md and docs/api.md give one answer through every interface."""

import json
import re
import shlex
import shutil
from pathlib import Path

import pytest

from front_ends import Http

ROOT = Path(__file__).parents[1]
PAGE, API = (ROOT / "docs" / name for name in ("operations.md", "api.md"))


@pytest.fixture
def anywhere(tmp_path, monkeypatch):
    """Work in a folder with the examples and the files that the pages name."""
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    shutil.copy(ROOT / "examples/from_toml/lens.toml", tmp_path)
    case = re.search(r"```json\n(.*?)```", API.read_text(encoding="utf-8"), re.S)
    assert case is not None
    (tmp_path / "case.json").write_text(case[1])
    monkeypatch.chdir(tmp_path)
    return tmp_path


def curls(page):
    """Return the requests of a page that need no job: path, JSON or None, fields of a form."""
    found = []
    for line in re.findall(r"^\$ curl (.*)$", page.read_text(encoding="utf-8"), re.M):
        words = shlex.split(line)
        (url,) = (word for word in words if word.startswith("localhost"))
        after = list(zip(words, words[1:], strict=False))
        body = [word for flag, word in after if flag == "-d"]
        fields = [word.split("=", 1) for flag, word in after if flag == "-F"]
        if "/jobs/" not in url:
            found.append((url.removeprefix("localhost:8642"), *body, fields))
    return found


def post(http, path, *body):
    """Send what curl would send."""
    *said, fields = body
    if said:
        text = Path(said[0][1:]).read_text() if said[0].startswith("@") else said[0]
        return http(path, json=json.loads(text))
    data, files = {}, []
    for name, value in fields:
        if value.startswith("@"):
            files.append((name, (Path(value[1:]).name, Path(value[1:]).read_bytes())))
        else:
            data.setdefault(name, []).append(value)
    return http(path, data=data, files=files)


@pytest.mark.parametrize("page", [PAGE, API], ids=lambda page: page.stem)
def test_requests_of_the_pages_are_answered(page, anywhere):
    http = Http()
    requests = curls(page)
    assert requests
    for path, *body in requests:
        response = post(http, path, *body)
        assert response.status_code == 200, response.text
    http.close()
