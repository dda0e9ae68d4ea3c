"""Imports flow one way: a module knows the floors below its own and no cycle."""

import ast
import importlib
import inspect
import re
from functools import cache
from pathlib import Path

import pytest

import viscotack

PACKAGE = Path(viscotack.__file__).parent

# The rooms, lowest first: a module imports only from its own room and from rooms before it.
ROOMS = (
    "version",
    "arrays",
    "threads",
    "clock",
    "errors",
    "system",
    "units",
    "cards",
    "files",
    "materials",
    "traction",
    "geometry",
    "surfaces",
    "protocol",
    "theory",
    "problem",
    "result",
    "bem",
    "methods",
    "rough",
    "pool",
    "lab",
    "campaign",
    "datasets",
    "surrogate",
    "forecast",
    "series",
    "pads",
    "control",
    "identify",
    "design",
    "pictures",
    "operations",
    "app",
    "check",
    "__main__",
    # the package's face, which names what all of them have
    "__init__",
)
# The same inside the theories: what all of them share, then the wings.
WINGS = ("_checks", "_roots", "_scales", "elastic", "crack", "sphere", "punch")
# Properties that call the functions of the same name, which take what has the properties.
SHORT = {("result.result", "result.observables")}
# A string, or a quoted one in it, that names a module; what comes after `-m`; no words that tell
# users what there is.
NAMED = re.compile(r"""(?:^|['"]|-m )(viscotack(?:\.[A-Za-z_]\w*)+)(?=\.?$|['"\s])""")


def modules(package):
    """List the modules of a package: name, relative to the package, and path."""
    found = {}
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package).with_suffix("").parts
        found[".".join(parts).removesuffix(".__init__")] = path
    return found


def imports(name, path, known):
    """List the modules that a module imports: in functions, for types and by strings too.

    What is neither a module nor a name in one is of the package's face.
    """
    tree, found = ast.parse(path.read_text()), set()
    parts = name.split(".") if path.stem == "__init__" else name.split(".")[:-1]
    parts = [] if name == "__init__" else parts

    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            targets = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            above = parts[: len(parts) + 1 - node.level]
            base = ["viscotack", *above] if node.level else []
            origin = ".".join([*base, *([node.module] if node.module else [])])
            targets = [f"{origin}.{alias.name}" for alias in node.names]
        else:
            continue
        for target in targets:
            if target.split(".")[0] == "viscotack":
                found.add(module_of(target, known) or "__init__")
    for text in strings(tree):
        found |= {module_of(words, known) for words in NAMED.findall(text)}
    return found - {name, None}


def module_of(target, known):
    """Find the module that a dotted name is, or that has it."""
    inside = target.removeprefix("viscotack.")
    # `from .a import b`: b is a module or a name in the module a
    candidates = (inside, inside.rpartition(".")[0])
    return next((x for x in candidates if target != "viscotack" and x in known), None)


def strings(tree):
    """List the strings of a module but docstrings, and the programs that `-m` and one name."""
    docs = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    texts = [
        node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docs
    ]
    pairs = [f"{a} {b}" for a, b in zip(texts[:-1], texts[1:], strict=True)]
    program = re.compile(r"-m viscotack(?![.\w])")
    return [program.sub("-m viscotack.__main__", text) for text in (*texts, *pairs)]


@cache
def graph(package):
    known = modules(package)
    return {name: imports(name, path, known) for name, path in known.items()}


def kept(links):
    """Drop the links of names that moved, and of properties that are functions elsewhere."""
    return {
        name: {target for target in targets if (name, target) not in SHORT}
        for name, targets in links.items()
    }


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
    assert upward(kept(graph(PACKAGE))) == []
    assert SHORT <= {(name, x) for name, targets in graph(PACKAGE).items() for x in targets}


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
    assert twins == {"twins", "twins.plain_sphere", "twins.plain_punch"}
    assert set().union(*(solver[name] for name in twins)) & solver.keys() <= twins


def test_the_contact_with_a_crack_for_its_edge_shares_nothing_with_the_simulation():
    links = graph(PACKAGE)
    for name in ("by_crack", "crack_band", "crack_problem"):
        rooms = {target.split(".")[0] for target in links[f"methods.{name}"]}
        assert "bem" not in rooms, name
    simulation = {name: targets for name, targets in kept(links).items() if name.startswith("bem")}
    known = set().union(*simulation.values())
    assert not [x for x in known if x.startswith(("theory.crack", "methods"))]


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
    assert cycles(kept(graph(PACKAGE))) == []


def test_no_module_imports_the_export_of_surrogates():
    links = {
        name: {target for target in targets if target.startswith("surrogate.onnx")}
        for name, targets in graph(PACKAGE).items()
        if not name.startswith("surrogate.onnx")
    }
    assert {name: found for name, found in links.items() if found} == {}


def test_the_package_imports_no_folder_of_the_checkout():
    outside = {path.name for path in PACKAGE.parents[1].iterdir() if path.is_dir()} - {"src"}
    assert {"training", "benchmarks", "replication"} <= outside
    for name, path in modules(PACKAGE).items():
        nodes = list(ast.walk(ast.parse(path.read_text())))
        found = [alias.name for n in nodes if isinstance(n, ast.Import) for alias in n.names]
        found += [n.module or "" for n in nodes if isinstance(n, ast.ImportFrom) and not n.level]
        assert not {target.partition(".")[0] for target in found} & outside, name


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


@pytest.mark.parametrize(
    "text",
    [
        "import viscotack\n",
        "from viscotack import __version__\n",
        "from .. import __version__\n",
        "def f():\n    from viscotack import solve\n",
    ],
)
def test_the_check_itself_sees_an_import_of_the_face(tmp_path, text):
    (tmp_path / "result").mkdir()
    (tmp_path / "__init__.py").write_text("from .result import cycles\n__version__ = '1'\n")
    (tmp_path / "result/__init__.py").write_text("")
    (tmp_path / "result/cycles.py").write_text(f"import numpy\n{text}")
    links = graph(tmp_path)
    assert upward(links) == ["result.cycles imports __init__, a later room"]
    assert cycles(links) == ["__init__", "result.cycles"]


@pytest.mark.parametrize(
    ("text", "room"),
    [
        ("if TYPE_CHECKING:\n    from ..app import page\n", "app.page"),
        ("import_module('viscotack.app.page')\n", "app.page"),
        ("import_module(f'viscotack.app.{name}')\n", "app"),
        ("run([sys.executable, '-m', 'viscotack.app.page'])\n", "app.page"),
        ("run([sys.executable, '-m', 'viscotack', 'simulate'])\n", "__main__"),
        ("run('python -m viscotack simulate', shell=True)\n", "__main__"),
    ],
)
def test_the_check_itself_sees_what_is_imported_for_types_and_by_a_string(tmp_path, text, room):
    for name in ("result", "app"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "__init__.py").write_text("")
    (tmp_path / "__main__.py").write_text("from .app import page\n")
    (tmp_path / "app/page.py").write_text('"""Shows results, as ``viscotack.pictures`` do."""\n')
    (tmp_path / "result/run.py").write_text(text)
    assert upward(graph(tmp_path)) == [f"result.run imports {room}, a later room"]


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
