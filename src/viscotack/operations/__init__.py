"""Whatever a user can ask, each operation declared once.

Every module of this folder declares operations: frozen dataclasses with a ``word``, options with
cards, and one method to a typed answer. The command line, HTTP, the page, study files and Python
read those declarations; a module more is an operation more for all of them.
"""

import ast
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from importlib import import_module
from pathlib import Path
from pkgutil import ModuleInfo, iter_modules
from typing import Any

from viscotack.errors import InputError

from .declare.answer import Answer, Caller
from .declare.options import Here, Operation, answered, respelled, take

# Folders with operations of the user's own: modules as those in here.
FOLDERS = "VISCOTACK_OPERATIONS"
__path__ += [folder for folder in os.environ.get(FOLDERS, "").split(os.pathsep) if folder]


@dataclass(frozen=True)
class Declared:
    """An operation whose module is not imported yet.

    Attributes
    ----------
    word, help : str
        Its word and docstring.
    module : str
        The module of this folder that declares it.
    helps : mapping
        Help of each command, where the operation has several.
    """

    word: str
    help: str
    module: str
    helps: Mapping[str, str] = field(default_factory=dict)


@lru_cache(maxsize=1)
def declared() -> Mapping[str, Declared]:
    """All operations by their words, sorted; those of this package without importing them.

    The command line lists them and imports the one that is asked for: to import all takes ten
    times as long as to import NumPy.
    """
    modules = (module for module in iter_modules(__path__) if not module.ispkg)
    found = {each.word: each for module in modules for each in _declared_in(module)}
    return dict(sorted(found.items()))


def _declared_in(module: ModuleInfo) -> Iterator[Declared]:
    """Yield the operations of a module: by its text here, by import in a folder of the user."""
    source = Path(__file__).with_name(f"{module.name}.py")
    if not source.is_file():
        for kind in _kinds(module.name):
            yield Declared(kind.word, kind.__doc__ or "", module.name, kind.helps)
        return
    for node in ast.parse(source.read_bytes()).body:
        if isinstance(node, ast.ClassDef):
            values = {
                each.target.id: each.value
                for each in node.body
                if isinstance(each, ast.AnnAssign) and isinstance(each.target, ast.Name)
            }
            if word := values.get("word"):
                helps = values.get("helps")
                yield Declared(
                    ast.literal_eval(word),
                    ast.get_docstring(node, clean=False) or "",
                    module.name,
                    {} if helps is None else ast.literal_eval(helps),
                )


def _kinds(module: str) -> Iterator[type[Operation]]:
    """Yield the operations of a module, which is imported."""
    for kind in vars(import_module(f"{__name__}.{module}")).values():
        if isinstance(kind, type) and issubclass(kind, Operation) and "word" in vars(kind):
            yield kind


def operations() -> Mapping[str, type[Operation]]:
    """Import all operations; by their words, sorted."""
    return {word: operation(word) for word in declared()}


def operation(word: str) -> type[Operation]:
    """Import the operation of a word.

    Raises
    ------
    InputError
        If there is none.
    """
    if word not in declared():
        raise InputError(f"there is no operation {word!r:.60}; there are {', '.join(declared())}")
    return next(kind for kind in _kinds(declared()[word].module) if kind.word == word)


def ask(word: str, /, **given: Any) -> Answer:
    """Return the answer to an operation, as every door gives it.

    Parameters
    ----------
    word : str
        Of the operation: "identify rates".
    **given
        Its options by name: numbers in SI, or texts with units as on the command line; names of
        files; a problem as an object, a case file or its tables; a passport as an object or a file.
        `also` has classes of your own.

    Returns
    -------
    Answer
        `found` has the objects, `record()` plain data, `words()` lines to read.

    Raises
    ------
    ValueError
        If an option is unknown, missing or impossible, or the question has no answer.

    Examples
    --------
    >>> found = ask("theory maugis", tabor=1.0)
    >>> f"{found.record()['pull_off_force']:.4f}"
    '1.0548'
    """
    kind, also = operation(word), tuple(given.pop("also", ()))
    try:
        return answered(take(kind, given, Here(also=also)), Caller(also=also))
    except InputError as error:
        raise respelled(error, kind) from None


__all__ = ["Answer", "Caller", "Operation", "ask", "declared", "operation", "operations"]
