"""The page docs/operations.md: generated from the declarations; its examples give one answer."""

import json
import re
import shlex
import shutil
import sys
import tomllib
from pathlib import Path

import pytest

from front_ends import Http, run
from viscotack.operations import ask, operations
from viscotack.operations.declare.options import options

ROOT = Path(__file__).parents[1]
sys.path.append(str(ROOT / "benchmarks"))

import operations_page  # noqa: E402

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


def test_the_table_and_the_reference_are_current():
    text = PAGE.read_text(encoding="utf-8")
    assert text == operations_page.page(), "python benchmarks/operations_page.py --write"


def test_the_page_has_every_refusal_operation_and_option():
    table, reference = operations_page.table(), operations_page.reference()
    for word, kind in operations().items():
        rows = [line for line in table.splitlines() if f"[{word}](" in line]
        reason = kind.refused.get("http")
        assert [reason in row for row in rows] == ([True] if reason else [])
        section = reference.partition(f"### {word}\n")[2].partition("\n### ")[0]
        linked = re.findall(r"\[(?:group|common) (\w+)\]", section)
        places = [section, *(x for x in reference.split("\n### ") if x.split("\n")[0] in
                  [f"Group {name}" for name in linked])]  # fmt: skip
        for option in options(kind):
            assert any(f"`{option.name}`" in place for place in places), (word, option.name)
        assert section


def test_links_within_the_page_lead_to_headings():
    text = PAGE.read_text(encoding="utf-8")
    headings = re.findall(r"^#+ (.*)$", text, re.M)
    anchors = {heading.lower().replace(" ", "-") for heading in headings}
    linked = set(re.findall(r"\]\(#([^)]+)\)", text))
    assert linked
    assert linked <= anchors


def test_the_example_has_one_answer_in_all_interfaces(anywhere):
    asked = ask("predict", problem="lens.toml", confidence=0.95)
    asked.files["curve"](anywhere / "python.csv")
    status, out, _ = run(["study", "examples/studies/predict.toml", "--json"])
    assert status == 0
    assert json.loads(out) == json.loads(json.dumps(asked.record()))
    (stated,) = re.findall(r"```toml\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S)
    study = anywhere / "examples/studies/predict.toml"
    assert tomllib.loads(stated) == tomllib.loads(study.read_text(encoding="utf-8"))
    http = Http()
    (_, form) = curls(PAGE)
    sent = post(http, *form).json()
    http.close()
    assert sent["pull_off_force_N"] == json.loads(out)["pull_off_force_N"]
    curve = (anywhere / "python.csv").read_text()
    assert sent["beside"]["files"]["curve"] == study.with_name("curve.csv").read_text() == curve


@pytest.mark.parametrize("page", [PAGE, API], ids=lambda page: page.stem)
def test_requests_of_the_pages_are_answered(page, anywhere):
    http = Http()
    requests = curls(page)
    assert requests
    for path, *body in requests:
        response = post(http, path, *body)
        assert response.status_code == 200, response.text
    http.close()
