"""The numbers of a problem, each named by its path in the record: inputs of plans and derivatives.

What a number is, what it is measured in and where it ends is said by its card; what the machine
does has the unit of the geometry's outputs, a force in N or a stress in Pa.
"""

import copy
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

from viscotack.cards import Pairs, Quantity, cards, unusual
from viscotack.errors import InputError
from viscotack.geometry import Bonded, PowerLawProfile
from viscotack.problem.problem import Groups, Problem
from viscotack.problem.record import from_dict, to_dict
from viscotack.problem.rough_case import RoughCase

# A tip z = A r^q by the height that it has at a radius: the unit of A depends on q.
_HEIGHT, _AT_RADIUS = "geometry.height", "geometry.at_radius"
_EXPONENT, _COEFFICIENT = "geometry.exponent", "geometry.coefficient"
_TIP = {
    _HEIGHT: Quantity("m", "z", "height of the profile there", above=0, example="10 um"),
    _AT_RADIUS: Quantity("m", "r", "radius at which it has its height", above=0, example="0.2 mm"),
}
_NU, _NU_OF_BASE = "material.poisson_ratio", "body.base.poisson_ratio"


@dataclass(frozen=True)
class Input:
    """A number of a problem; returned by :func:`inputs_of`.

    Attributes
    ----------
    path : str
        Path in the record, ``protocol.moves.0.duration``.
    value : float or None
        Current value; None if not set.
    unit : str
        Unit of the value.
    card : Quantity
        Description and range.
    """

    path: str
    value: float | None
    unit: str
    card: Quantity


def inputs_of(problem: Any) -> dict[str, Input]:
    """Return the numbers of a problem by path.

    Parameters
    ----------
    problem : Problem, Groups or RoughCase
        The problem.

    Returns
    -------
    dict of str to Input
        Path of a number, such as ``protocol.speed`` -> its value, unit and card.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, RetardationPowerLaw
    >>> material = RetardationPowerLaw(
    ...     rubbery_modulus=1.5e6, glassy_modulus=15e6, exponent=0.8, tau0=0.1, poisson_ratio=0.5
    ... )
    >>> case = Groups(tabor=3.24, material=material.reduced(), start=AtDepth(73), rate=316.23)
    >>> inputs_of(case)["start.depth"].unit
    'h0'
    """
    found = {entry.path: entry for entry in _numbers(problem, problem.units, "")}
    if isinstance(problem, RoughCase):
        return {path: entry for path, entry in found.items() if path not in problem.unused}
    if not isinstance(problem, Problem):
        # the parts of a dimensionless problem have the cards of those in SI
        own = set(problem.units.values())
        found = {
            path: entry if entry.unit in own else replace(entry, unit="1")
            for path, entry in found.items()
        }
    elif isinstance(problem.geometry, PowerLawProfile):
        found |= {path: Input(path, None, card.unit, card) for path, card in _TIP.items()}
    return found


def improbable(problem: Any) -> tuple[str, ...]:
    """Return a warning for each number in SI of an improbable magnitude, such as a radius of 2 m.

    Examples
    --------
    >>> from viscotack import AtDepth, Elastic, LennardJones, Problem, Retraction, Sphere
    >>> lens = Problem(
    ...     material=Elastic(rubbery_modulus=1e6, poisson_ratio=0.5),
    ...     traction=LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-6),
    ...     geometry=Sphere(1e-3),
    ...     protocol=Retraction(start=AtDepth(1e-6), speed=100.0),
    ... )
    >>> improbable(lens)
    ('protocol.speed of 100 m/s is improbable; check its unit',)
    """
    if not isinstance(problem, Problem | RoughCase):
        return ()
    numbers = inputs_of(problem).values()
    return tuple(words for one in numbers if (words := unusual(one.path, one.value, one.unit)))


def _numbers(thing: Any, units: Mapping[str, str], prefix: str) -> Iterator[Input]:
    known, pairs = cards(type(thing)), cards(type(thing), Pairs)
    for field in fields(thing):
        value, path = getattr(thing, field.name), f"{prefix}{field.name}"
        if field.name in known:
            card = known[field.name].card
            yield Input(path, value, units.get(card.measure, card.unit), card)
        elif field.name in pairs:
            card = pairs[field.name].card
            for i, pair in enumerate(value):
                for j, unit in enumerate(card.units):
                    of_pair = Quantity(unit, card.symbol, card.words, above=0)
                    yield Input(f"{path}.{i}.{j}", pair[j], unit, of_pair)
        else:
            yield from _parts(value, units, path)


def _parts(value: Any, units: Mapping[str, str], path: str) -> Iterator[Input]:
    if is_dataclass(value):
        yield from _numbers(value, units, f"{path}.")
    elif isinstance(value, tuple):
        for i, entry in enumerate(value):
            yield from _parts(entry, units, f"{path}.{i}")


def check_paths(problem: Any, paths: Iterable[str]) -> None:
    """Raise InputError for paths that are not numbers of a problem, or that contradict others.

    Raises
    ------
    ValueError
        With the numbers that there are at the place where a path goes wrong.
    """
    record = to_dict(problem)
    paths = set(paths)
    replaced(record, dict.fromkeys(paths, 1.0), inputs_of(problem))
    if _is_tip(record) and len(missing := {_HEIGHT, _AT_RADIUS} - paths) == 1:
        raise InputError(f"{_HEIGHT} and {_AT_RADIUS} go together; add {missing.pop()}")
    if _is_tip(record) and _HEIGHT in paths and _COEFFICIENT in paths:
        raise InputError(f"{_COEFFICIENT} and {_HEIGHT} define the same; remove one")


def check_exponent(problem: Any, paths: Iterable[str]) -> None:
    """Refuse to vary the exponent of a tip in SI beside a coefficient whose unit it changes."""
    paths = set(paths)
    if isinstance(problem, Problem) and _EXPONENT in paths and not {_HEIGHT, _COEFFICIENT} & paths:
        raise InputError(
            f"{_COEFFICIENT} is measured in m^(1 - exponent), and is another shape with every "
            f"exponent: give {_HEIGHT} and {_AT_RADIUS} beside {_EXPONENT}"
        )


def replaced(
    record: Mapping[str, Any], values: Mapping[str, float], known: Mapping[str, Input]
) -> dict[str, Any]:
    """Return a record with numbers at these paths in place of its own.

    A bonded layer keeps the Poisson ratio of its material. For a tip with a height at a radius the
    coefficient is recomputed, and a reduced tip with another exponent is reduced again.
    """
    changed = copy.deepcopy(dict(record))
    values = {path: float(value) for path, value in values.items()}
    for path, value in values.items():
        if path not in _TIP or not _is_tip(record):
            _put(changed, path, value, known)
    shape = changed.get("geometry", {})
    if _is_tip(record) and {_HEIGHT, _AT_RADIUS} <= values.keys():
        height, radius = (card.checked(path, values[path]) for path, card in _TIP.items())
        shape["coefficient"] = height / radius ** shape["exponent"]
    if record["type"] == Groups.__name__ and _EXPONENT in values and _COEFFICIENT not in values:
        shape["coefficient"] = 1 / cards(PowerLawProfile)["exponent"].card.checked(
            _EXPONENT, shape["exponent"]
        )
    base = changed.get("body", {}).get("base", {})
    if _NU in values and _NU_OF_BASE not in values and base.get("type") == Bonded.__name__:
        base["poisson_ratio"] = values[_NU]
    return changed


def made(
    record: Mapping[str, Any],
    known: Mapping[str, Input],
    also: tuple[Any, ...],
    values: Mapping[str, float],
) -> Any:
    """Return the problem of a record with numbers at these paths."""
    return from_dict(replaced(record, values, known), also)


def _is_tip(record: Mapping[str, Any]) -> bool:
    shape = record.get("geometry", {})
    return record["type"] == Problem.__name__ and shape.get("type") == PowerLawProfile.__name__


def _put(record: Any, path: str, value: float, known: Mapping[str, Input]) -> None:
    """Replace the number at a path such as ``material.branches.0.1`` in a record."""
    *way, last = path.split(".")
    at = record
    for step in way:
        at = _entry(at, step, path)
    if not (isinstance(at, dict) and path in known):  # what is left out may be given
        old = _entry(at, last, path)
        if isinstance(old, bool) or not isinstance(old, int | float):
            raise InputError(f"{path} is not a number of the problem but {old!r:.60}")
    at[int(last) if isinstance(at, list) else last] = value


def _entry(at: Any, step: str, path: str) -> Any:
    if isinstance(at, dict) and step in at:
        return at[step]
    if isinstance(at, list) and step.isdigit() and int(step) < len(at):
        return at[int(step)]
    known = [k for k in at if k != "type"] if isinstance(at, dict) else range(len(at or []))
    raise InputError(
        f"the problem has no number {path!r}: at {step!r} there is {', '.join(map(str, known))}"
    )
