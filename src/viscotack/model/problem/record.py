"""Problems as plain dictionaries for JSON, and their content-based ids."""

import hashlib
import json
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from viscotack.errors import InputError
from viscotack.model.problem.case_file import problem_of, tables_of
from viscotack.model.problem.nouns import known
from viscotack.model.problem.problem import Groups, Problem
from viscotack.model.problem.rough_case import RoughCase
from viscotack.model.tables import Reading


def to_dict(problem: Problem | Groups | RoughCase) -> dict[str, Any]:
    """Convert a problem to the tables of its file, with numbers in SI.

    Values equal to the default are omitted, so that new options do not change the ids of old
    problems. The dictionary contains only dictionaries, lists, texts and numbers: ``json.dumps``
    writes it, and :func:`from_dict` restores an equal object.

    Parameters
    ----------
    problem : Problem, Groups or RoughCase
        Object to convert.

    Returns
    -------
    dict
        Ready for JSON.

    Raises
    ------
    InputError
        If the object is not a problem.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> to_dict(Groups(tabor=2, material=solid, start=AtDepth(20), rate=1))["groups"]
    {'tabor': 2.0, 'preload': 20.0, 'rate': 1.0}
    """
    if not isinstance(problem, Problem | Groups | RoughCase):
        raise InputError(f"expected a Problem or Groups, got {type(problem).__name__}")
    return tables_of(problem)


def from_dict(
    record: Mapping[str, Any],
    also: Iterable[Any] = (),
    *,
    beside: Callable[[str], Path] | None = None,
) -> Any:
    """Restore a problem from a dictionary of :func:`to_dict`, or from the tables of a file.

    Parameters
    ----------
    record : dict
        Tables of a problem. Numbers without a unit are in SI.
    also : iterable of classes
        User-defined laws, materials, shapes and bodies that it may name.
    beside : callable, optional
        Returns the path of a file named in a table; without it tables may not name files.

    Returns
    -------
    Problem, Groups or RoughCase
        Equal to the original object.

    Raises
    ------
    InputError
        If a table or key is missing or unknown, or a value is invalid.

    Examples
    --------
    >>> tables = {
    ...     "groups": {"tabor": 3.24, "preload": 73, "rate": 316.23},
    ...     "material": {"model": "power-law", "modulus_ratio": 0.1, "exponent": 0.8},
    ... }
    >>> from_dict(tables).start
    AtDepth(depth=73.0)
    """
    return problem_of(record, Reading("the problem", known(also), beside, bare=True))


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
        If the object is not a problem.

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
