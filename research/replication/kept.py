"""Kept numbers: what was computed, as JSON that a person can read, five digits each.

Arrays become lists, and lists of numbers arrays again; nan is null. Nothing is pickled, so that a
file is data whoever wrote it.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np

from viscotack import InputError

Numbers = dict[str, Any]
FOLDER = Path(__file__).resolve().parent / "kept"
DIGITS = 5
# Below this part of the largest number of an array a difference says nothing.
_SMALL = 1e-6


def path_of(name: str) -> Path:
    """Return the file of a figure's numbers."""
    return FOLDER / f"{name.replace('.', '_')}.json"


def keep(name: str, numbers: Numbers, *, seconds: float) -> Path:
    """Write the numbers of a figure, with the processor time [s] that they took."""
    path = path_of(name)
    content = {"figure": name, "processor_seconds": round(seconds, 1), "numbers": _plain(numbers)}
    text = json.dumps(content, separators=(",", ":"), allow_nan=False)
    # a line for each quantity: changes can be read
    text = text.replace('"numbers":{', '"numbers":{\n').replace('],"', '],\n"')
    path.write_text(text.replace('},"', '},\n"') + "\n", encoding="utf-8", newline="")
    return path


def kept(name: str) -> Numbers:
    """Return the kept numbers of a figure."""
    return _arrays(_content(name)["numbers"])


def cost(name: str) -> float:
    """Return the processor time [s] that the kept numbers took; None where none are kept."""
    return _content(name)["processor_seconds"]


def rounded(numbers: Numbers) -> Numbers:
    """Return numbers as they come back when they have been kept."""
    return _arrays(_plain(numbers))


def difference(one: Any, other: Any) -> float:
    """Return the largest relative difference between two sets of numbers, inf where not alike.

    Of an array it is the largest one over the numbers that are not next to nothing beside its
    largest; words must be the same.

    Examples
    --------
    >>> difference({"a": [1.0, 2.0]}, {"a": [1.0, 2.02]})
    0.01
    """
    if isinstance(one, dict) and isinstance(other, dict):
        if set(one) != set(other):
            return np.inf
        return max((difference(one[key], other[key]) for key in one), default=0.0)
    if isinstance(one, str | bool) or isinstance(other, str | bool) or one is None or other is None:
        return 0.0 if one == other else np.inf
    if isinstance(one, list) and isinstance(other, list) and not all(map(_is_number, one)):
        if len(one) != len(other):
            return np.inf
        return max((difference(x, y) for x, y in zip(one, other, strict=True)), default=0.0)
    a, b = np.asarray(one, dtype=float), np.asarray(other, dtype=float)
    if a.shape != b.shape:
        return np.inf
    known = np.isfinite(a)
    if np.any(known != np.isfinite(b)):
        return np.inf
    a, b = a[known], b[known]
    if not a.size:
        return 0.0
    scale = np.maximum(np.abs(a), _SMALL * np.max(np.abs(a)))
    return float(np.round(np.max(np.abs(a - b) / np.where(scale > 0, scale, 1.0)), 12))


def without_errors(numbers: Any) -> Any:
    """Return numbers without estimates of their error, which change more than what they are of.

    Examples
    --------
    >>> without_errors({"force": [1.0], "force_error": [1e-3]})
    {'force': [1.0]}
    """
    if isinstance(numbers, dict):
        return {k: without_errors(x) for k, x in numbers.items() if "error" not in k}
    if isinstance(numbers, list):
        return [without_errors(x) for x in numbers]
    return numbers


def _content(name: str) -> Any:
    path = path_of(name)
    if not path.exists():
        raise InputError(
            f"no numbers of {name} are kept; make them with "
            f"python -m research.replication figure {name} --afresh --keep"
        )
    return json.loads(path.read_text(encoding="utf-8"))


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(key): _plain(part) for key, part in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    if isinstance(value, list | tuple):
        return [_plain(part) for part in value]
    if isinstance(value, float):
        return float(f"{value:.{DIGITS}g}") if np.isfinite(value) else None
    return value


def _arrays(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _arrays(part) for key, part in value.items()}
    if isinstance(value, list) and value and all(_is_number(part) for part in value):
        return np.array([np.nan if part is None else part for part in value], dtype=float)
    if isinstance(value, list):
        parts = [_arrays(part) for part in value]
        alike = parts and all(isinstance(part, np.ndarray) for part in parts)
        return np.array(parts) if alike and len({part.shape for part in parts}) == 1 else parts
    return value


def _is_number(value: Any) -> bool:
    return value is None or (isinstance(value, int | float) and not isinstance(value, bool))
