import ast
import inspect
import subprocess
import sys
from pathlib import Path

import pytest

import viscotack

REPLICATION = Path(__file__).parents[1] / "replication"
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


def taken(path):
    """Return the names of the package that a file outside it uses, as whole dotted paths."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    bound, found = {}, set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                if alias.name.split(".")[0] == "viscotack":
                    found.add(alias.name)
                    bound[alias.asname or "viscotack"] = alias.name if alias.asname else "viscotack"
        elif isinstance(node, ast.ImportFrom) and not node.level:
            for alias in node.names:
                if (node.module or "").split(".")[0] == "viscotack":
                    bound[alias.asname or alias.name] = f"{node.module}.{alias.name}"
                    found.add(f"{node.module}.{alias.name}")
    for node in ast.walk(tree):
        words, at = [], node
        while isinstance(at, ast.Attribute):
            words.insert(0, at.attr)
            at = at.value
        if words and isinstance(at, ast.Name) and at.id in bound:
            found.add(".".join([bound[at.id], *words]))
    return found


def is_public(name):
    """Return whether each step of a dotted path is what the one before says that it has."""
    _, *steps = name.split(".")
    here = viscotack
    for step in steps:
        if step.startswith("_") and not step.endswith("__"):
            return False
        if inspect.ismodule(here):
            # a module that says what it has, has nothing else; others have what they define
            said = getattr(here, "__all__", None)
            if step not in (said if said is not None else vars(here)):
                return False
            thing = getattr(here, step)
            if said is None and getattr(thing, "__module__", here.__name__) != here.__name__:
                return False
            if said is None and inspect.ismodule(thing):
                return False
        here = getattr(here, step, None)
    return True


@pytest.mark.parametrize(
    "path", sorted(REPLICATION.rglob("*.py")), ids=lambda p: str(p.relative_to(REPLICATION))
)
def test_replication_uses_public_names_only(path):
    assert [name for name in sorted(taken(path)) if not is_public(name)] == []


def test_the_check_itself_sees_names_that_are_not_public(tmp_path):
    (tmp_path / "one.py").write_text(
        "import viscotack as vt\n"
        "import viscotack.problem\n"
        "from viscotack import AtDepth, theory\n"
        "from viscotack.campaign import read_plan\n"
        "from viscotack.campaign.plan import Case\n"
        "from viscotack.theory.rate import positive\n"
        "vt.solve, vt.bem.Accuracy, vt.bem.march, vt.campaign._x, theory.rate.np\n"
        "theory.jkr.force\n"
    )
    assert {name for name in taken(tmp_path / "one.py") if not is_public(name)} == {
        "viscotack.bem.march",
        "viscotack.campaign._x",
        "viscotack.campaign.plan.Case",
        "viscotack.problem",
        "viscotack.theory.rate.np",
        "viscotack.theory.rate.positive",
    }
