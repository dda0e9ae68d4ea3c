"""Docstrings, comments and messages are plain technical English: idioms of a list are rejected."""

import ast
import io
import re
import tokenize
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src/viscotack"
# Rooms left out of the check.
OPEN: set[str] = set()
ROOMS = sorted({path.stem for path in PACKAGE.iterdir() if path.suffix in ("", ".py")} - OPEN)
# Idiom -> what to write instead.
TICS = {
    r"Return what\b": "the noun: what is returned",
    r"\b(is|are|was|be) told\b": "reported, given",
    r"\bnobody\b": "no process, no user",
    r"\bone's own\b|\bof your own\b|\bof the user's own\b": "user-defined",
    r"\banew\b": "again",
    r"\bdoors?\b": "front end",
    r"\bonce more\b": "again",
    r"\bso many\b": "a number",
    r"\b(goes?|going) on\b": "continue",
    r"\bstands? (for|on)\b": "represents, depends on",
    r"\bat once\b": "at a time, in parallel, immediately",
    r"\blet(s|ting)? go\b": "release, detach",
    r"\b(comes?|came) off\b": "detach",
    r"\b(is|are|be) asked for\b": "needed, requested",
    r"\bwhoever\b": "the user",
    r"\bstands? twice\b": "duplicate",
    r"\bsays\b": "states, contains, determines",
}
# Pages that still have idioms.
OPEN_PAGES = {
    "app", "design", "gallery", "materials", "performance", "predict", "punch", "replication",
    "rough_surfaces", "solver", "steady_crack", "surrogate", "tack_tests", "theory", "verification",
}  # fmt: skip
PAGES = [
    *(ROOT / f"{name}.md" for name in ("README", "CONTRIBUTING", "SECURITY", "CODE_OF_CONDUCT")),
    *(path for path in sorted(ROOT.glob("docs/*.md")) if path.stem not in OPEN_PAGES),
]


def texts(path):
    """Comments and string literals of a file, with their lines."""
    source = path.read_text(encoding="utf-8")
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.lineno, node.value


def tics_in(path):
    """Idioms in a file, each with its place and a proposal."""
    return [
        f"{path.name}:{line}: {found[0]!r}; write {better}"
        for line, text in texts(path)
        for tic, better in TICS.items()
        if (found := re.search(tic, " ".join(text.split())))
    ]


@pytest.mark.parametrize("room", ROOMS)
def test_text_is_free_of_idioms(room):
    home = PACKAGE / room
    paths = sorted(home.rglob("*.py")) if home.is_dir() else [home.with_suffix(".py")]
    assert [tic for path in paths for tic in tics_in(path)] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_pages_are_free_of_idioms(page):
    text = " ".join(page.read_text(encoding="utf-8").split())
    # "of your own" is plain to a reader who is addressed
    found = {tic: re.search(tic, text) for tic in TICS if "own" not in tic}
    assert {tic: match[0] for tic, match in found.items() if match} == {}


def test_the_check_finds_idioms_in_comments_and_strings(tmp_path):
    file = tmp_path / "one.py"
    file.write_text('"""Return what a step leads to."""\n# nobody reads it\nx = "fine"\n')
    assert [tic.split(": ")[1] for tic in tics_in(file)] == [
        "'nobody'; write no process, no user",
        "'Return what'; write the noun",
    ]
