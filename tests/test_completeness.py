"""Every public formula is called on the ladder: no law without a rung."""

import ast
import importlib
import inspect
import pkgutil
from pathlib import Path

import pytest

from test_docstrings import PUBLIC, SECTION

LADDER = Path(__file__).parent / "ladder"


def public_modules(package_name):
    """Return a package's modules, or the module itself, without the private ones."""
    package = importlib.import_module(package_name)
    if not hasattr(package, "__path__"):
        return [package]
    names = [info.name for info in pkgutil.iter_modules(package.__path__)]
    return [
        importlib.import_module(f"{package_name}.{name}")
        for name in names
        if not name.startswith("_")
    ]


def own(module, kind):
    """Return the public functions or classes that a module defines itself."""
    return {
        name: thing
        for name, thing in vars(module).items()
        if kind(thing) and thing.__module__ == module.__name__ and not name.startswith("_")
    }


def methods(cls):
    """Return the names of the public methods that a class defines itself."""
    return {
        name
        for name, thing in vars(cls).items()
        if inspect.isfunction(getattr(thing, "__func__", thing)) and not name.startswith("_")
    }


def imported(tree):
    """Return what the names at the top of a test file stand for."""
    found = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("viscotack"):
            for alias in node.names:
                found[alias.asname or alias.name] = find(node.module, alias.name)
        elif isinstance(node, ast.Import):
            for alias in node.names:
                if alias.name.startswith("viscotack") and alias.asname:
                    found[alias.asname] = importlib.import_module(alias.name)
    return found


def find(module_name, name):
    module = importlib.import_module(module_name)
    if hasattr(module, name):
        return getattr(module, name)
    return importlib.import_module(f"{module_name}.{name}")


def ladder():
    """Return the package's functions that the ladder calls, and per file classes and methods."""
    functions, per_file = set(), []
    for path in sorted(LADDER.glob("test_*.py")):
        tree = ast.parse(path.read_text())
        names = imported(tree)
        used, called = set(), set()
        for node in ast.walk(tree):
            if isinstance(node, ast.Name) and inspect.isclass(names.get(node.id)):
                used.add(names[node.id])
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                thing = getattr(names.get(node.value.id), node.attr, None)
                if inspect.isclass(thing):
                    used.add(thing)
            if not isinstance(node, ast.Call):
                continue
            match node.func:
                case ast.Name(id=name):
                    functions.add(names.get(name))
                case ast.Attribute(value=ast.Name(id=owner), attr=name) if owner in names:
                    functions.add(getattr(names[owner], name, None))
                    called.add(name)
                case ast.Attribute(attr=name):
                    called.add(name)
        per_file.append((used, called))
    return functions, per_file


def test_the_ladder_calls_every_function_of_the_theories():
    functions, _ = ladder()
    laws = {
        f"{module.__name__}.{name}": function
        for wing in public_modules("viscotack.theory")
        for module in public_modules(wing.__name__)
        for name, function in own(module, inspect.isfunction).items()
    }
    assert "viscotack.theory.elastic.jkr.force" in laws
    missing = [name for name, function in laws.items() if function not in functions]
    assert not missing, f"no rung calls {missing}"


@pytest.mark.parametrize(
    "home",
    [
        "viscotack.materials",
        "viscotack.traction",
        "viscotack.theory.crack",
        "viscotack.theory.punch",
    ],
)
def test_the_ladder_calls_every_method_of_materials_tractions_cracks_and_pads(home):
    pytest.importorskip(home, reason=f"{home} is not written yet")
    _, per_file = ladder()
    missing = [
        f"{cls.__name__}.{name}"
        for module in public_modules(home)
        for cls in own(module, inspect.isclass).values()
        # a typing.Protocol only describes the classes that are checked themselves
        if not getattr(cls, "_is_protocol", False)
        for name in sorted(methods(cls))
        if not any(cls in used and name in called for used, called in per_file)
    ]
    assert not missing, f"no rung calls {missing}"


# Public functions whose docstring has no such section; the numbers may only fall. Those left have
# no parameters, or raise nothing for a value out of range.
WITHOUT = {"Raises": 27, "Parameters": 1}


@pytest.mark.parametrize("section", WITHOUT)
def test_no_more_public_functions_lack_a_section_of_their_docstring(section):
    functions = {p: f for p, f in PUBLIC.items() if inspect.isfunction(f)}
    lack = [
        p for p, f in functions.items() if section not in SECTION.findall(inspect.getdoc(f) or "")
    ]
    assert len(lack) <= WITHOUT[section], f"document them, or lower the number: {lack}"
