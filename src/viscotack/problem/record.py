"""A problem as plain words and numbers, for files, and its name by content."""

import hashlib
import json
from collections.abc import Iterable
from dataclasses import MISSING, fields, is_dataclass
from typing import Any

from viscotack.errors import InputError
from viscotack.problem.nouns import Nouns, known
from viscotack.problem.older import naming, upgraded


class UnknownNoun(InputError):
    """A record names a law, a material or a shape that nobody has given."""


def to_dict(thing: Any) -> dict[str, Any]:
    """Return a problem, or a part of one, as a dictionary with the name of its type.

    What is as it would be if left out is left out, so that a new option renames no old problem.
    Only dictionaries, lists, words and numbers are in it: ``json.dumps`` writes it, and
    :func:`from_dict` makes an equal object.

    Examples
    --------
    >>> from viscotack.protocol import AtForce
    >>> to_dict(AtForce(force=1.5e-3))
    {'type': 'AtForce', 'force': 0.0015}
    """
    if not is_dataclass(thing) or isinstance(thing, type):
        raise InputError(f"expected a problem or a part of one, got {type(thing).__name__}")
    values = {f.name: getattr(thing, f.name) for f in fields(thing)}
    defaults = {f.name: f.default for f in fields(thing)}
    return {"type": type(thing).__name__} | {
        name: _plain(value) for name, value in values.items() if value != defaults[name]
    }


def from_dict(record: Any, also: Iterable[Any] = ()) -> Any:
    """Return the problem, or the part of one, that a dictionary of :func:`to_dict` describes.

    Parameters
    ----------
    record : dict
        Of this version, or of an older one.
    also : iterable of classes
        Laws, materials and shapes of the user's own that it may name.

    Raises
    ------
    ValueError
        If the type is unknown, a field is missing or unknown, or a value is impossible.
    """
    return _made(upgraded(record), known(also))


def run_id(case: Any) -> str:
    """Return a short name that depends only on the content of a problem.

    Equal problems have equal names, whatever the version, machine or day.
    """
    text = json.dumps(naming(to_dict(case)), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _plain(value: Any) -> Any:
    if is_dataclass(value):
        return to_dict(value)
    return [_plain(v) for v in value] if isinstance(value, tuple) else value


def _made(record: Any, nouns: Nouns) -> Any:
    if not isinstance(record, dict) or not isinstance(record.get("type"), str):
        raise InputError(f"a record must be a dictionary with a 'type', got {record!r:.80}")
    kind = nouns.types.get(record["type"])
    if kind is None:
        raise UnknownNoun(
            f"unknown type {record['type']!r} in a record: if it is one of your own, give its "
            f"class (also=({record['type']},) in Python, --with FILE.py on the command line); a "
            "newer version may know it"
        )
    given, names = record.keys() - {"type"}, {f.name for f in fields(kind)}
    needed = {f.name for f in fields(kind) if f.default is MISSING}
    if not needed <= given <= names:
        raise InputError(
            f"a record of {record['type']} must have the fields {sorted(needed)} and may have "
            f"{sorted(names - needed)}, got {sorted(given)}"
        )
    values = {name: _value(x, nouns) for name, x in record.items() if name != "type"}
    try:
        return kind(**values)
    except InputError:
        raise
    except (TypeError, ValueError, ArithmeticError, AttributeError) as error:
        raise InputError(f"a record of {record['type']} is impossible: {error}") from error


def _value(value: Any, nouns: Nouns) -> Any:
    # A list stays one: the classes make their own tuples.
    if isinstance(value, list):
        return [_value(entry, nouns) for entry in value]
    return _made(value, nouns) if isinstance(value, dict) else value
