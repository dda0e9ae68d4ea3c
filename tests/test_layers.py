"""Imports flow one way: a module knows the floors below its own and no cycle."""

import ast
from pathlib import Path

import viscotack

PACKAGE = Path(viscotack.__file__).parent

FLOOR = {
    "units": 1,
    "traction": 1,
    "geometry": 1,
    "protocol": 1,
    "trajectory": 1,
    "materials": 2,
    "layer": 1,
    "quantity_table": 1,
    "protocol_words": 1,
    "problem": 3,
    "theory": 4,
    "profile_problem": 4,
    "punch_problem": 4,
    "problems": 4,
    "record": 4,
    "case_file": 4,
    "outputs": 4,
    "punch_file": 4,
    "profile_file": 4,
    "protocol_file": 4,
    "traction_file": 4,
    "dead_load": 5,
    "result": 4,
    "bem": 5,
    "measured": 5,
    "datasets": 6,
    "observables": 5,
    "plot": 5,
    "campaign": 6,
    "surrogate": 7,
    "advice": 8,
    "prediction": 8,
    "forecast_theory": 8,
    "forecast": 8,
    "forecast_table": 8,
    "forecast_plot": 8,
    "identify": 8,
    "design": 9,
    "report": 9,
    "cli": 10,
    "app": 10,
    "__main__": 11,
}


def modules(package):
    """Return the name, relative to the package, and the path of every module below its door."""
    found = {}
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package).with_suffix("").parts
        if parts != ("__init__",):
            found[".".join(parts).removesuffix(".__init__")] = path
    return found


def imports(name, path, known):
    """Return the modules of the package that a module imports, anywhere in its text."""
    parts = name.split(".") if path.stem == "__init__" else name.split(".")[:-1]
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            targets = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            if node.level:
                base = ["viscotack", *parts[: len(parts) + 1 - node.level]]
            else:
                base = []
            origin = ".".join([*base, *([node.module] if node.module else [])])
            targets = [f"{origin}.{alias.name}" for alias in node.names]
        else:
            continue
        for target in targets:
            inside = target.removeprefix("viscotack.")
            # `from .a import b`: b is a module or a name in the module a
            for candidate in (inside, inside.rpartition(".")[0]):
                if target.startswith("viscotack.") and candidate in known:
                    found.add(candidate)
                    break
    return found - {name}


def graph(package):
    known = modules(package)
    return {name: imports(name, path, known) for name, path in known.items()}


def upward(links):
    """Return the imports that lead to a higher floor."""

    def floor(name):
        # a module without a floor has a test of its own
        return FLOOR.get(name.split(".")[0], 0)

    return [
        f"{name} (floor {floor(name)}) imports {target} (floor {floor(target)})"
        for name, targets in links.items()
        for target in sorted(targets)
        if floor(target) > floor(name)
    ]


def cycles(links):
    """Return the modules left when those that import nothing unknown are taken away in turn."""
    rest = {name: set(targets) for name, targets in links.items()}
    while free := [name for name, targets in rest.items() if not targets & rest.keys()]:
        for name in free:
            del rest[name]
    return sorted(rest)


def private_names(path):
    """Return what a module takes from another although it begins with an underscore."""
    tree = ast.parse(path.read_text())
    doors = {
        alias.asname or alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        and (node.level or (node.module or "").startswith("viscotack"))
        for alias in node.names
    }
    taken = {
        f"{node.value.id}.{node.attr}"
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name)
        if node.value.id in doors and node.attr.startswith("_") and not node.attr.endswith("__")
    }
    # `from . import _crack` takes a module of the same folder, `from ._crack import _x` a name
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level and node.module:
            names = [alias.name for alias in node.names]
            taken |= {name for name in names if name.startswith("_") and not name.endswith("__")}
    return taken


def test_no_module_takes_a_private_name_of_another():
    taken = {name: private_names(path) for name, path in modules(PACKAGE).items()}
    assert {name: found for name, found in taken.items() if found} == {}


def test_every_module_has_a_floor():
    homeless = {name.split(".")[0] for name in modules(PACKAGE)} - FLOOR.keys()
    assert not homeless, f"give {sorted(homeless)} a floor, here and in the layout"


def test_no_module_imports_from_a_higher_floor():
    assert upward(graph(PACKAGE)) == []


def test_no_modules_import_each_other_in_a_circle():
    assert cycles(graph(PACKAGE)) == []


def test_what_answers_at_once_knows_nothing_of_how_it_was_made_or_is_handed_on():
    rooms = ("surrogate.training", "surrogate.onnx")
    links = {
        name: {target for target in targets if target.startswith(rooms)}
        for name, targets in graph(PACKAGE).items()
        # the door by which it is trained
        if not name.startswith((*rooms, "surrogate.__main__"))
    }
    assert {name: found for name, found in links.items() if found} == {}


def test_the_check_itself_sees_an_upward_import_and_a_circle(tmp_path):
    (tmp_path / "theory").mkdir()
    (tmp_path / "theory/__init__.py").write_text("from . import jkr\n")
    (tmp_path / "theory/jkr.py").write_text("from ..bem import solve\nfrom . import maugis\n")
    (tmp_path / "theory/maugis.py").write_text("def f():\n    from .jkr import force\n")
    (tmp_path / "bem.py").write_text("import viscotack.units\nfrom viscotack import theory\n")
    (tmp_path / "units.py").write_text("import numpy\n")
    links = graph(tmp_path)
    assert links["bem"] == {"units", "theory"}
    assert upward(links) == ["theory.jkr (floor 4) imports bem (floor 5)"]
    assert "theory.maugis" in cycles(links)
    assert "units" not in cycles(links)
