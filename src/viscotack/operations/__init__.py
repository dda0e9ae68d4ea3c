"""Operations: every task of a user, each declared once for all front ends.

Every module of this folder declares operations: frozen dataclasses with a name (``word``), options
with cards, and a method that returns a typed answer. The front ends (command line, HTTP, page,
study files and Python) are generated from these declarations, so a new module adds its operations
to all of them.
"""

import ast
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from importlib import import_module
from pathlib import Path
from typing import Any

from viscotack.errors import InputError

from .declare.answer import Answer, Caller
from .declare.options import Here, Operation, answered, respelled, take


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
    """List all operations by name, sorted, without importing them.

    The command line imports only the requested operation, because importing all of them takes ten
    times as long as importing NumPy.

    Returns
    -------
    mapping of str to Declared
        Name of the operation -> its help text and module.

    Examples
    --------
    >>> declared()["predict"].module
    'predict'
    """
    modules = Path(__file__).parent.glob("*.py")
    found = {each.word: each for module in modules for each in _declared_in(module)}
    return dict(sorted(found.items()))


def _declared_in(source: Path) -> Iterator[Declared]:
    """Yield the operations that a module declares; it is parsed, not imported."""
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
                    source.stem,
                    {} if helps is None else ast.literal_eval(helps),
                )


def _kinds(module: str) -> Iterator[type[Operation]]:
    """Yield the operations of a module, which is imported."""
    for kind in vars(import_module(f"{__name__}.{module}")).values():
        if isinstance(kind, type) and issubclass(kind, Operation) and "word" in vars(kind):
            yield kind


def operations() -> Mapping[str, type[Operation]]:
    """Import and return all operations by name, sorted.

    Returns
    -------
    mapping of str to class
        Name of the operation, such as "identify rates" -> its class.

    Examples
    --------
    >>> "predict" in operations()
    True
    """
    return {word: operation(word) for word in declared()}


def operation(word: str) -> type[Operation]:
    """Import and return the class of an operation.

    Parameters
    ----------
    word : str
        Name of the operation, such as "identify rates".

    Returns
    -------
    class
        A subclass of `Operation`.

    Raises
    ------
    ValueError
        If no operation has this name.

    Examples
    --------
    >>> operation("predict").__name__
    'Predict'
    """
    if word not in declared():
        raise InputError(f"unknown operation {word!r:.60}; known are {', '.join(declared())}")
    return next(kind for kind in _kinds(declared()[word].module) if kind.word == word)


def ask(word: str, /, **given: Any) -> Answer:
    """Run an operation; the answer is the same as on the command line and over HTTP.

    Parameters
    ----------
    word : str
        Name of the operation, such as "identify rates".
    **given
        Options by name: numbers in SI, or text with units as on the command line; file names; a
        problem as an object, a case file or its tables; a passport as an object or a file.
        `also` is a sequence of user-defined classes.

    Returns
    -------
    Answer
        `found` contains the objects, `record()` returns plain data, `words()` returns text.

    Raises
    ------
    ValueError
        If an option is unknown, missing or invalid, or the operation has no answer.

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
