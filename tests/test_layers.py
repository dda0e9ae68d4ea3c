"""Imports flow one way: a module knows the floors below its own and no cycle."""

import ast
import importlib
import inspect
from pathlib import Path

import viscotack

PACKAGE = Path(viscotack.__file__).parent

# The rooms, lowest first: a module imports only from its own room and from rooms before it.
ROOMS = (
    "errors",
    "units",
    "cards",
    "files",
    "materials",
    "traction",
    "geometry",
    "protocol",
    "theory",
    "problem",
    "result",
    "bem",
    "lab",
    "campaign",
    "datasets",
    "surrogate",
    "forecast",
    "identify",
    "pictures",
    "app",
    "check",
    "__main__",
)
# The same inside the theories: what all of them share, then the wings.
WINGS = ("_checks", "_scales", "elastic", "crack", "sphere", "punch")


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


def upward(links, rooms=ROOMS):
    """Return the imports that lead to a later room."""

    def floor(name):
        # a room without a place has a test of its own
        room = name.split(".")[0]
        return rooms.index(room) if room in rooms else -1

    return [
        f"{name} imports {target}, a later room"
        for name, targets in links.items()
        for target in sorted(targets)
        if floor(target) > floor(name)
    ]


def within(links, room):
    """Return the links between the modules of a room, with the names they have there."""
    inside = f"{room}."
    return {
        name.removeprefix(inside): {x.removeprefix(inside) for x in targets if x != room}
        for name, targets in links.items()
        if name.startswith(inside)
    }


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


def test_every_room_has_a_place():
    assert {name.split(".")[0] for name in modules(PACKAGE)} == set(ROOMS)


def test_no_module_imports_from_a_later_room():
    assert upward(graph(PACKAGE)) == []


def test_every_theory_has_a_wing():
    theories = within(graph(PACKAGE), "theory")
    assert {name.split(".")[0] for name in theories} == set(WINGS)


def test_no_theory_imports_from_a_later_wing_or_from_the_door_of_them_all():
    links = graph(PACKAGE)
    assert upward(within(links, "theory"), WINGS) == []
    behind = [name for name, targets in links.items() if "theory" in targets]
    assert [name for name in behind if name.startswith("theory.")] == []


def test_the_twins_of_the_solver_share_nothing_with_it():
    solver = within(graph(PACKAGE), "bem")
    twins = {name for name in solver if name.split(".")[0] == "twins"}
    assert twins == {"twins", "twins.plain", "twins.plain_punch"}
    assert set().union(*(solver[name] for name in twins)) & solver.keys() <= twins


def test_no_public_name_of_a_room_hides_a_module_of_it():
    # `import viscotack.bem.solve as s` once gave a function
    for path in PACKAGE.rglob("__init__.py"):
        room = importlib.import_module(
            ".".join(["viscotack", *path.relative_to(PACKAGE).parent.parts])
        )
        files = {x.stem for x in path.parent.glob("*.py")}
        hidden = {
            name for name in files & set(vars(room)) if not inspect.ismodule(vars(room)[name])
        }
        assert not hidden, f"{room.__name__}: {sorted(hidden)}"


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
    assert upward(links) == ["theory.jkr imports bem, a later room"]
    assert "theory.maugis" in cycles(links)
    assert "units" not in cycles(links)


def test_the_check_itself_sees_an_import_from_a_later_wing(tmp_path):
    for wing in ("elastic", "punch"):
        (tmp_path / "theory" / wing).mkdir(parents=True)
        (tmp_path / "theory" / wing / "__init__.py").write_text("")
    (tmp_path / "theory/__init__.py").write_text("from . import elastic, punch\n")
    (tmp_path / "theory/elastic/jkr.py").write_text("from viscotack.theory.punch import rate\n")
    (tmp_path / "theory/punch/rate.py").write_text(
        "from ..elastic import jkr\nimport viscotack.units\n"
    )
    (tmp_path / "units.py").write_text("")
    links = within(graph(tmp_path), "theory")
    assert links["punch.rate"] == {"elastic.jkr", "units"}
    assert upward(links, WINGS) == ["elastic.jkr imports punch.rate, a later room"]
