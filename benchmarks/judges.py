"""Which test files judge a module, nearest first: derived from what tests and modules import.

No module is listed by name, so modules may move. A name is followed through the packages that
export it to the module that defines it. The distance of a test file from a module is the number of
imports between them. Of files at the same distance, those that share more rare words with the
module come first.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from math import log, sqrt
from pathlib import Path

# Folders of Python files, and the folder that their imports start from.
FOLDERS = {"src": "src", "tests": "tests", "replication": ".", "training": "."}
# It exports everything: an import of it alone says nothing about what a file uses.
FACE = "viscotack"
_PROGRAM = re.compile(r"from (viscotack[\w.]*) import (\w+)")


@dataclass(frozen=True)
class File:
    """What a Python file imports, the dotted names in it, and its words."""

    path: Path
    imported: dict[str, str]
    dotted: set[str]
    words: set[str]

    @classmethod
    def read(cls, name: str, path: Path) -> File:
        """Read a file with a dotted name."""
        source = path.read_text()
        nodes = list(ast.walk(ast.parse(source)))
        room = name if path.name == "__init__.py" else name.rpartition(".")[0]
        words = set(re.findall(r"[a-z]{3,}", f"{path.stem} {source}".lower()))
        return cls(path, dict(imported(nodes, room)), set(map(dotted, nodes)), words)


class Judges:
    """Test files of a checkout, ordered by how near they are to a module."""

    def __init__(self, root: Path):
        self.root = root
        self._files: dict[str, File] = {}
        for folder, top in FOLDERS.items():
            for path in sorted((root / folder).rglob("*.py")):
                parts = path.relative_to(root / top).with_suffix("").parts
                name = ".".join(parts).removesuffix(".__init__")
                self._files[name] = File.read(name, path)
        tests = {name: x for name, x in self._files.items() if x.path.stem.startswith("test_")}
        links = {name: set(self._used(name)) for name in self._files} | {FACE: set()}
        self._distances = {test: distances(links, test) for test in tests}
        counts = Counter(word for test in tests.values() for word in test.words)
        self._weights = {word: log(len(tests) / count) for word, count in counts.items()}

    def of(self, path: Path) -> list[Path]:
        """Return the test files that reach a module, nearest first, relative to the root."""
        module = next(name for name, file in self._files.items() if file.path == path)
        reached = [
            (found[module], -self._likeness(test, module), self._files[test].path)
            for test, found in self._distances.items()
            if module in found
        ]
        return [test.relative_to(self.root) for *_, test in sorted(reached)]

    def _used(self, name: str) -> Iterator[str]:
        """Yield the modules that define what a file uses."""
        imported = self._files[name].imported
        yield from map(self._owner, imported.values())
        for chain in self._files[name].dotted:
            root, _, attributes = chain.partition(".")
            if attributes and root in imported:
                yield self._owner(f"{imported[root]}.{attributes}")

    def _owner(self, target: str) -> str:
        """Return the module that defines a dotted name, "" if it is not of the checkout."""
        module, names = target, []
        while module not in self._files:
            module, _, last = module.rpartition(".")
            names.insert(0, last)
            if not module:
                return ""
        file = self._files[module]
        exported = file.imported.get(names[0]) if names else None
        if exported is None or file.path.name != "__init__.py" or target.startswith(exported):
            return module
        return self._owner(".".join([exported, *names[1:]]))

    def _likeness(self, test: str, module: str) -> float:
        """Return the weight of the words a test file shares with a module, over its own."""
        mine = self._files[test].words
        shared = sum(self._weights[word] for word in mine & self._files[module].words)
        return shared / sqrt(sum(self._weights[word] for word in mine) or 1.0)


def imported(nodes: list[ast.AST], room: str) -> Iterator[tuple[str, str]]:
    """Yield the names that a file of a package imports and the dotted names they stand for."""
    for node in nodes:
        if isinstance(node, ast.Import):
            for alias in node.names:
                first = alias.name.partition(".")[0]
                yield alias.asname or first, alias.name if alias.asname else first
        elif isinstance(node, ast.ImportFrom):
            parts = room.split(".")
            base = parts[: len(parts) + 1 - node.level] if node.level else []
            origin = [*base, *([node.module] if node.module else [])]
            for alias in node.names:
                yield alias.asname or alias.name, ".".join([*origin, alias.name])
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            # programs of other processes stand in strings
            for module, name in _PROGRAM.findall(node.value):
                yield name, f"{module}.{name}"


def dotted(node: ast.AST) -> str:
    """Return the dotted name that a node is, or ""."""
    names: list[str] = []
    while isinstance(node, ast.Attribute):
        names.insert(0, node.attr)
        node = node.value
    return ".".join([node.id, *names]) if isinstance(node, ast.Name) else ""


def distances(links: dict[str, set[str]], start: str) -> dict[str, int]:
    """Count the links from a start to all that it reaches."""
    found, front, length = {start: 0}, {start}, 0
    while front:
        length += 1
        front = {x for name in front for x in links[name] if x in links} - found.keys()
        found |= dict.fromkeys(front, length)
    return found
