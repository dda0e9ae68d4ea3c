import ast
import subprocess
import sys
from pathlib import Path

import pytest

import viscotack

HEAVY = ("numpy", "scipy", "pint", "matplotlib", "rich", "typer")


def run(code):
    """Return what a fresh interpreter prints."""
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    return done.stdout.strip()


def test_importing_the_package_imports_nothing_heavy():
    loaded = run(f"import sys, viscotack; print([m for m in {HEAVY} if m in sys.modules])")
    assert loaded == "[]"


def test_simulating_needs_no_library_of_the_command_line():
    late = ("pint", "matplotlib", "rich", "typer")
    names = [name for name in viscotack.__all__ if name != "__version__"]
    code = f"import sys, viscotack; [getattr(viscotack, n) for n in {names}]; "
    assert run(code + f"print([m for m in {late} if m in sys.modules])") == "[]"


@pytest.mark.parametrize("name", viscotack.__all__)
def test_every_public_name_exists(name):
    assert getattr(viscotack, name) is not None
    assert name in dir(viscotack)


def test_the_checker_knows_the_same_names():
    tree = ast.parse(Path(viscotack.__file__).read_text(encoding="utf-8"))
    block = next(node for node in tree.body if isinstance(node, ast.If))
    imported = {
        (node.module or alias.name, alias.asname)
        for node in block.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    homes = {(viscotack._HOMES[name], name) for name in viscotack._HOMES}
    assert imported == homes | {(room, room) for room in viscotack._ROOMS}


def test_every_public_function_and_class_says_what_it_is():
    for name in viscotack._HOMES:
        assert (getattr(viscotack, name).__doc__ or "").strip(), name


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'pull_of'"):
        viscotack.pull_of  # noqa: B018
