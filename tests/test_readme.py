"""What the README and the pages say is run: their Python, their commands, their links."""

import itertools
import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

from docs import sessions

ROOT = Path(__file__).parents[1]
PAGES = [
    ROOT / "README.md",
    *(ROOT / f"{word}.md" for word in ("CONTRIBUTING", "CODE_OF_CONDUCT", "SECURITY")),
    *sorted((ROOT / "docs").glob("*.md")),
    *sorted((ROOT / "research").rglob("*.md")),
]


# A cluster is not at hand everywhere. A server runs until it is told to end: it and the client of
# docs/api.md are run by tests/test_app_command.py.
NOT_AT_HAND = ("tcp://", "tls://", "viscotack app")
ASKS_A_SERVER = ROOT / "docs/api.md"
OWN = ROOT / "docs/own.md"
# From rig files to a report takes half a minute, in the README and in docs/tack_tests.md alike.
STUDY = sessions.SLOW


# Their examples take more than four seconds.
LONG = (
    *("campaigns", "control", "design", "first_hour", "punch", "rough_surfaces", "tack_tests"),
    *("traction-laws", "uncertainty"),
)


def in_time(page, given=None):
    """Return a parameter, slow where the examples of the page are."""
    return pytest.param(given or page, marks=[pytest.mark.slow] * (page.stem in LONG))


def name(page):
    """Return the path of a page from the root."""
    return str(page.relative_to(ROOT))


def blocks(page, language):
    """Return the fenced blocks of a page in a language."""
    return re.findall(rf"```{language}\n(.*?)```", page.read_text(), re.DOTALL)


def commands(page):
    """Return the lines of a page that are typed into a terminal."""
    lines = "".join(blocks(page, "console")).splitlines()
    return [line.removeprefix("$ ") for line in lines if line.strip()]


def save_files_of(page, folder):
    """Save the blocks whose first line names a file, as the page asks."""
    found = re.findall(
        r"```(?:python|toml)\n# (\w+\.(?:py|toml))\n(.*?)```", page.read_text(), re.S
    )
    for file, text in found:
        (folder / file).write_text(text)
    return [file for file, _ in found]


def of_the_package(page):
    """Return the `viscotack` commands of a page that can be run here."""
    return [
        line
        for line in commands(page)
        if line.startswith("viscotack") and not any(word in line for word in NOT_AT_HAND)
    ]


def short():
    """Return the commands that take seconds, page by page."""
    found = {
        name(page): [line for line in of_the_package(page) if not line.startswith(STUDY)]
        for page in PAGES
    }
    return {name: lines for name, lines in found.items() if lines}


def studies():
    """Return the different studies of the pages, each a tuple of commands."""
    found = {tuple(x for x in of_the_package(page) if x.startswith(STUDY)) for page in PAGES}
    return sorted(found - {()})


@pytest.fixture
def anywhere(tmp_path, monkeypatch):
    """Stand in a folder that looks like the checkout, and may be written to."""
    sessions.stage(tmp_path)
    save_files_of(OWN, tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)


def test_the_readme_has_one_short_example(anywhere, capsys):
    (example,) = blocks(ROOT / "README.md", "python")
    assert len([line for line in example.splitlines() if line.strip()]) <= 8
    exec(compile(example, "README.md", "exec"), {})
    stated = re.search(r"# ([\d.]+) mN", example)
    assert stated and capsys.readouterr().out == f"pull-off force {stated[1]} mN\n"


@pytest.mark.parametrize(
    "page", [in_time(page) for page in PAGES[1:] if page != ASKS_A_SERVER], ids=name
)
def test_python_of_the_pages_runs(page, anywhere):
    for example in blocks(page, "python"):
        exec(compile(example, page.name, "exec"), {})


def run(lines):
    """Type commands one after another, simulations of them coarsely."""
    from viscotack.app.cli import application

    for line in lines:
        arguments = shlex.split(line)[1:]
        if arguments[0] == "simulate" and "-h" not in arguments and "--help" not in arguments:
            arguments += ["--until", "pull-off", "--accuracy", "2e-2"]
        done = CliRunner().invoke(application(), arguments)
        assert done.exit_code == 0, f"{line}\n{done.output}"


def compare(lines, shown):
    """Type commands one after another, and compare the output of those with one below them."""
    for line in lines:
        if line not in shown:
            run([line])
        elif wrong := sessions.difference(shown[line], sessions.printed(line)):
            pytest.fail(f"{line}\n  {wrong}\nrun: python docs/sessions.py --write")


@pytest.mark.parametrize("page", [in_time(ROOT / page, page) for page in short()])
def test_commands_of_the_pages_run_and_print_what_is_shown(page, anywhere):
    shown = sessions.sessions((ROOT / page).read_text())
    compare(short()[page], {session.command: session for session in shown})


@pytest.mark.slow
def test_studies_of_the_pages_run_and_print_what_is_shown(anywhere):
    shown = (x for page in sessions.PAGES for x in sessions.sessions(page.read_text()))
    assert studies()
    compare(itertools.chain(*studies()), {session.command: session for session in shown})
