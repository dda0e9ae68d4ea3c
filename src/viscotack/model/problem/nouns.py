"""Known classes of laws, materials, shapes and bodies, including user-defined ones.

There is no registry: a class is recognised by its attributes, and `word` is its name in
files and options.
"""

import importlib.util
import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields, is_dataclass
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import Any

from viscotack.cards import check_carded
from viscotack.errors import InputError
from viscotack.files.text import read_bytes
from viscotack.model.geometry import BODIES, SHAPES, Body, Shape
from viscotack.model.materials import MODELS, Material
from viscotack.model.traction import LAWS, Traction

_PROTOCOLS = {"laws": Traction, "materials": Material, "shapes": Shape, "bodies": Body}
# What a class of each kind must have: fields, methods and properties.
MEMBERS = {
    room: tuple(
        name
        for name in (*vars(protocol).get("__annotations__", {}), *vars(protocol))
        if not name.startswith("_") and name != "word"
    )
    for room, protocol in _PROTOCOLS.items()
}
_SINGULAR = {"laws": "law", "materials": "material", "shapes": "shape", "bodies": "body"}


@dataclass(frozen=True)
class Nouns:
    """The known classes.

    Attributes
    ----------
    laws, materials, shapes, bodies : mapping
        Word in files and options -> class.
    observables : tuple
        User-defined numbers of results.
    """

    laws: Mapping[str, Any]
    materials: Mapping[str, Any]
    shapes: Mapping[str, Any]
    bodies: Mapping[str, Any]
    observables: tuple[Any, ...] = ()


def known(also: Iterable[Any] = ()) -> Nouns:
    """Return the known classes, including user-defined classes and observables.

    Raises
    ------
    ValueError
        If one is not a law, material, shape, body or observable, or its name or word is already
        used.
    """
    also = tuple(also)
    nouns = {"laws": LAWS, "materials": MODELS, "shapes": SHAPES, "bodies": BODIES}
    own = {room: dict(classes) for room, classes in nouns.items()}
    observables = []
    for noun in also:
        if hasattr(noun, "function") and not isinstance(noun, type):
            if noun.name in {other.name for other in observables}:
                raise InputError(f"two observables have the name {noun.name}; rename one")
            observables.append(noun)
            continue
        room = room_of(noun)
        check_carded(noun)
        if any(noun.word in classes for classes in own.values()):
            raise InputError(
                f"{noun.__name__} has the word {noun.word!r}, which is already used; choose another"
            )
        own[room][noun.word] = noun
    return Nouns(**own, observables=tuple(observables))


def own_nouns(paths: Iterable[str | Path]) -> tuple[Any, ...]:
    """Return the laws, materials, shapes, bodies and observables defined in Python files.

    The files are executed.

    Raises
    ------
    FileNotFoundError
        If a file does not exist.
    ValueError
        If a file is not valid Python, or defines none of these.
    """
    found: list[Any] = []
    for path in dict.fromkeys(Path(path).resolve() for path in paths):
        found += _defined(path, sha256(read_bytes(path)).hexdigest())
    return tuple(found)


@lru_cache(maxsize=32)
def _defined(path: Path, content: str) -> tuple[Any, ...]:
    name = f"viscotack_own_{content[:16]}"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise InputError(f"{path} is not a Python file; give one that ends in .py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        del sys.modules[name]
        raise InputError(f"{path} cannot be read: {type(error).__name__}: {error}") from error
    found = tuple(
        thing
        for thing in vars(module).values()
        if is_dataclass(thing)
        and (
            thing.__module__ == name and hasattr(thing, "word")
            if isinstance(thing, type)
            else hasattr(thing, "function") and hasattr(thing, "words")
        )
    )
    if not found:
        raise InputError(
            f"{path} defines no law, material, shape, body or observable; docs/own.md shows an "
            "example"
        )
    return found


def room_of(noun: Any) -> str:
    """Return the kind of a class, a key of `MEMBERS`; InputError names missing members."""
    name = getattr(noun, "__name__", noun)
    wrong = f"{name!r} is not a law, material, shape or body"
    if not (isinstance(noun, type) and is_dataclass(noun)):
        raise InputError(f"{wrong}, which are frozen dataclasses; nor is it an Observable")
    if not isinstance(getattr(noun, "word", None), str):
        raise InputError(f'{wrong}: it has no word; write word: ClassVar[str] = "a-name"')
    own = {*dir(noun), *(field.name for field in fields(noun))}
    missing = {room: [name for name in names if name not in own] for room, names in MEMBERS.items()}
    room = min(MEMBERS, key=lambda each: len(missing[each]) / len(MEMBERS[each]))
    if missing[room]:
        raise InputError(
            f"{wrong}: as a {_SINGULAR[room]} it lacks {', '.join(missing[room])}; "
            "docs/own.md describes each"
        )
    return room
