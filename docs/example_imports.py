"""Import lines of the examples in docstrings.

An example uses names of its module. The reference shows the imports of these names in front of it,
and the tests run it after them, in an empty namespace.
"""

import ast
import builtins
import doctest
from functools import cache
from importlib import import_module
from inspect import ismodule
from pathlib import Path


def imports(text: str, module: str) -> list[str]:
    """Return the import lines of the names that the examples of a docstring use and do not define.

    Parameters
    ----------
    text : str
        The docstring.
    module : str
        Dotted path of its module, whose names the example uses.
    """
    used, bound = set(), set(dir(builtins))
    for example in doctest.DocTestParser().get_examples(text):
        for node in ast.walk(ast.parse(example.source)):
            if isinstance(node, ast.Name):
                (used if isinstance(node.ctx, ast.Load) else bound).add(node.id)
            elif isinstance(node, ast.alias):
                bound.add((node.asname or node.name).split(".")[0])
            elif isinstance(node, ast.FunctionDef | ast.ClassDef):
                bound.add(node.name)
            elif isinstance(node, ast.arg):
                bound.add(node.arg)
    names = vars(import_module(module))
    plain, chosen = [], {}
    for name in sorted(used - bound):
        if name in names:
            home, own = _origin(name, module)
            if own:
                chosen.setdefault(home, []).append(own if own == name else f"{own} as {name}")
            else:
                plain.append(home)
    ours = sorted(chosen, key=lambda home: (home.startswith("viscotack"), home))
    lines = [f"from {home} import {', '.join(sorted(chosen[home]))}" for home in ours]
    return sorted(plain) + [short for line in lines for short in _split(line)]


def _split(line: str, width: int = 88) -> list[str]:
    """Split a `from` line into several, none wider than a block of the reference."""
    home, _, names = line.partition(" import ")
    rows = [[]]
    for name in names.split(", "):
        if rows[-1] and len(", ".join([home, *rows[-1], name])) + 8 > width:
            rows.append([])
        rows[-1].append(name)
    return [f"{home} import {', '.join(row)}" for row in rows]


def _origin(name: str, module: str) -> tuple[str, str]:
    """Return a module and a name in it that is a name of another module, or an import line."""
    thing = vars(import_module(module))[name]
    if home := _public().get(_key(thing)):
        return home
    tree = ast.parse(Path(import_module(module).__file__).read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if not isinstance(node, ast.Import | ast.ImportFrom):
            continue
        for alias in node.names:
            if (alias.asname or alias.name) == name:
                if isinstance(node, ast.Import):
                    return f"import {alias.name}{f' as {name}' if alias.asname else ''}", ""
                if not node.level and not node.module.startswith("viscotack"):
                    return node.module, alias.name
    if ismodule(thing):
        home, _, own = thing.__name__.rpartition(".")
        return home, own
    own = getattr(thing, "__module__", module)
    return (own if vars(import_module(own)).get(name) is thing else module), name


def _key(thing: object) -> object:
    return thing.__name__ if ismodule(thing) else id(thing)


@cache
def _public() -> dict[object, tuple[str, str]]:
    """Return the shortest public path of each name that `viscotack` and its public rooms list."""
    import viscotack

    found: dict[object, tuple[str, str]] = {}
    rooms = [("viscotack", viscotack)]
    for path, room in rooms:
        for name in room.__all__:
            thing = getattr(room, name)
            if not ismodule(thing) and not callable(thing):
                continue
            if getattr(thing, "__module__", "viscotack").startswith("viscotack"):
                found.setdefault(_key(thing), (path, name))
            if ismodule(thing) and hasattr(thing, "__all__"):
                rooms.append((thing.__name__, thing))
    return found
