"""Convert problems to and from plain dictionaries, and compute their content-based ids."""

import hashlib
import json
from collections.abc import Iterable
from dataclasses import MISSING, fields, is_dataclass
from typing import Any

from viscotack.errors import InputError
from viscotack.problem.nouns import Nouns, known


class UnknownNoun(InputError):
    """A record names an unknown law, material or shape."""


def to_dict(thing: Any) -> dict[str, Any]:
    """Convert a problem, or a part of one, to a dictionary with the name of its type.

    Values equal to the default are omitted, so that new options do not change the ids of old
    problems. The dictionary contains only dictionaries, lists, texts and numbers: ``json.dumps``
    writes it, and :func:`from_dict` restores an equal object.

    Parameters
    ----------
    thing : Problem, Groups or a part of one
        Object to convert.

    Returns
    -------
    dict
        Ready for JSON.

    Raises
    ------
    InputError
        If the object is not part of a problem.

    Examples
    --------
    >>> from viscotack.protocol import AtForce
    >>> to_dict(AtForce(force=1.5e-3))
    {'type': 'AtForce', 'force': 0.0015}
    """
    if not is_dataclass(thing) or isinstance(thing, type):
        raise InputError(f"expected a problem or a part of a problem, got {type(thing).__name__}")
    values = {f.name: getattr(thing, f.name) for f in fields(thing)}
    defaults = {f.name: f.default for f in fields(thing)}
    return {"type": type(thing).__name__} | {
        name: _plain(value) for name, value in values.items() if value != defaults[name]
    }


def from_dict(record: Any, also: Iterable[Any] = ()) -> Any:
    """Restore a problem, or a part of one, from a dictionary of :func:`to_dict`.

    Parameters
    ----------
    record : dict
        Record of a problem or a part of one.
    also : iterable of classes
        User-defined laws, materials and shapes that it may name.

    Returns
    -------
    Problem, Groups or a part of one
        Equal to the original object.

    Raises
    ------
    InputError
        If the type is unknown, a field is missing or unknown, or a value is invalid.

    Examples
    --------
    >>> from_dict({"type": "AtForce", "force": 0.0015})
    AtForce(force=0.0015)
    """
    return _made(record, known(also))


def run_id(case: Any) -> str:
    """Return a short id that depends only on the content of a problem.

    Equal problems have equal ids, on all machines.

    Parameters
    ----------
    case : Problem or Groups
        The problem.

    Returns
    -------
    str
        Hexadecimal digits.

    Raises
    ------
    InputError
        If the object is not part of a problem.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> one, same = (Groups(tabor=2, material=solid, start=AtDepth(d), rate=1) for d in (20, 20.0))
    >>> run_id(one) == run_id(same)
    True
    """
    text = json.dumps(to_dict(case), sort_keys=True)
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
            f"unknown type {record['type']!r} in a record: for a user-defined class, give the "
            f"class (also=({record['type']},) in Python, --with FILE.py on the command line); a "
            "newer version may support it"
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
        raise InputError(f"a record of {record['type']} is invalid: {error}") from error


def _value(value: Any, nouns: Nouns) -> Any:
    # Keep lists: the classes convert them to tuples.
    if isinstance(value, list):
        return [_value(entry, nouns) for entry in value]
    return _made(value, nouns) if isinstance(value, dict) else value
