"""Whatever a user can ask, each operation declared once.

Every module of this folder declares operations: frozen dataclasses with a ``word``, options with
cards, and one method to a typed answer. The command line, HTTP, the page, study files and Python
read those declarations; a module more is an operation more for all of them.
"""

import os
from collections.abc import Mapping
from functools import lru_cache
from importlib import import_module
from pkgutil import iter_modules
from typing import Any

from viscotack.errors import InputError

from .declare.answer import Answer, Caller
from .declare.options import Here, Operation, answered, respelled, take

# Folders with operations of the user's own: modules as those in here.
FOLDERS = "VISCOTACK_OPERATIONS"
__path__ += [folder for folder in os.environ.get(FOLDERS, "").split(os.pathsep) if folder]


@lru_cache(maxsize=1)
def operations() -> Mapping[str, type[Operation]]:
    """Return all operations by their words, in the order of their modules and in that of each."""
    found: dict[str, type[Operation]] = {}
    for module in iter_modules(__path__):
        if not module.ispkg:
            declared = vars(import_module(f"{__name__}.{module.name}")).values()
            for kind in declared:
                if isinstance(kind, type) and issubclass(kind, Operation) and "word" in vars(kind):
                    found[kind.word] = kind
    return dict(sorted(found.items()))


def operation(word: str) -> type[Operation]:
    """Return an operation by its word; InputError where there is none."""
    if word not in operations():
        raise InputError(f"there is no operation {word!r:.60}; there are {', '.join(operations())}")
    return operations()[word]


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


__all__ = ["Answer", "Caller", "Operation", "ask", "operation", "operations"]
