"""The numbers of a problem, each named by its path in the file: inputs of plans and derivatives.

``sphere.radius`` is the number radius of the table [sphere]; the numbers of the table [groups] are
named by their keys alone, ``tabor``. What a number is, what it is measured
in and where it ends is said by its card; what the machine does has the unit of the geometry's
outputs, a force in N or a stress in Pa.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

from viscotack.cards import Pairs, Quantity, cards, unusual
from viscotack.errors import InputError
from viscotack.model.geometry import Bonded, Layer, PowerLawProfile
from viscotack.model.problem.case_file import STARTS, ProfilePoint
from viscotack.model.problem.problem import Groups, Problem
from viscotack.model.problem.rough_case import RoughCase
from viscotack.model.protocol import Apart

# A tip z = A r^q by the height that it has at a radius: the unit of A depends on q.
_HEIGHT, _AT_RADIUS = "profile.height", "profile.at_radius"
_EXPONENT, _COEFFICIENT = "profile.exponent", "profile.coefficient"
_TIP = {f"profile.{key}": cards(ProfilePoint)[key].card for key in ("height", "at_radius")}
_NU, _NU_OF_BASE = "material.poisson_ratio", "layer.poisson_ratio"

Steps = tuple[str | int, ...]


@dataclass(frozen=True)
class Input:
    """A number of a problem; returned by :func:`inputs_of`.

    Attributes
    ----------
    path : str
        Table and key in the file, ``sphere.radius``; with an index ``protocol.moves.0.duration``.
    value : float or None
        Current value; None if not set.
    unit : str
        Unit of the value.
    card : Quantity
        Description and range.
    steps : tuple
        Attributes and indices that lead to it in the problem.
    pure : bool
        Whether the number is dimensionless because its problem is; its unit is then no SI unit.
    """

    path: str
    value: float | None
    unit: str
    card: Quantity
    steps: Steps = ()
    pure: bool = False


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
    >>> inputs_of(case)["preload"].unit
    'h0'
    """
    in_groups = isinstance(problem, Groups)
    own = set(problem.units.values())
    found: dict[str, Input] = {}
    for steps, value, unit, card in _numbers(problem, problem.units, ()):
        # the parts of a dimensionless problem have the cards of those in SI
        unit = "1" if in_groups and unit not in own else unit
        path = _path(problem, steps)
        found[path] = Input(path, value, unit, card, steps, in_groups)
    if isinstance(problem, RoughCase):
        return {path: entry for path, entry in found.items() if path not in problem.unused}
    if isinstance(problem, Problem) and isinstance(problem.geometry, PowerLawProfile):
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


def changed(problem: Any, values: Mapping[str, float]) -> Any:
    """Return a problem with numbers at these paths in place of its own.

    A bonded layer keeps the Poisson ratio of its material. For a tip with a height at a radius the
    coefficient is recomputed, and a reduced tip with another exponent is reduced again.

    Raises
    ------
    InputError
        If a path is not a number of the problem, or a value is out of range.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> case = Groups(tabor=2, material=solid, start=AtDepth(20), rate=1)
    >>> changed(case, {"tabor": 3.0}).tabor
    3.0
    """
    known = inputs_of(problem)
    values = {path: float(value) for path, value in values.items()}
    shape = problem.geometry if isinstance(problem, Problem) else None
    if isinstance(shape, PowerLawProfile) and {_HEIGHT, _AT_RADIUS} <= values.keys():
        height, radius = (card.checked(path, values.pop(path)) for path, card in _TIP.items())
        exponent = values.get(_EXPONENT, shape.exponent)
        values[_COEFFICIENT] = height / radius**exponent
    if isinstance(problem, Groups) and _EXPONENT in values and _COEFFICIENT not in values:
        q = cards(PowerLawProfile)["exponent"].card.checked(_EXPONENT, values[_EXPONENT])
        values[_COEFFICIENT] = 1 / q
    body = getattr(problem, "body", None)
    if _NU in values and isinstance(body, Layer) and isinstance(body.base, Bonded):
        values = {_NU_OF_BASE: values[_NU]} | values
    return _replaced(problem, {_known(path, known).steps: x for path, x in values.items()})


def check_paths(problem: Any, paths: Iterable[str]) -> None:
    """Raise InputError for paths that are not numbers of a problem, or that contradict others."""
    paths, known = set(paths), inputs_of(problem)
    for path in paths:
        _known(path, known)
    if _HEIGHT in known and len(missing := {_HEIGHT, _AT_RADIUS} - paths) == 1:
        raise InputError(f"{_HEIGHT} and {_AT_RADIUS} go together; add {missing.pop()}")
    if _HEIGHT in paths and _COEFFICIENT in paths:
        raise InputError(f"{_COEFFICIENT} and {_HEIGHT} define the same; remove one")
    # the unit of the coefficient of a tip in SI depends on its exponent
    if isinstance(problem, Problem) and _EXPONENT in paths and not {_HEIGHT, _COEFFICIENT} & paths:
        raise InputError(
            f"{_COEFFICIENT} is measured in m^(1 - exponent), and is another shape with every "
            f"exponent: give {_HEIGHT} and {_AT_RADIUS} beside {_EXPONENT}"
        )


def _known(path: str, known: Mapping[str, Input]) -> Input:
    if path not in known:
        table = path.partition(".")[0]
        near = [name for name in known if name.partition(".")[0] == table] or known
        raise InputError(f"the problem has no number {path!r}; it has {', '.join(near)}")
    return known[path]


def _numbers(
    thing: Any, units: Mapping[str, str], steps: Steps
) -> Iterator[tuple[Steps, float | None, str, Quantity]]:
    """Yield the numbers of a noun and of the nouns in it: steps, value, unit and card."""
    known, pairs = cards(type(thing)), cards(type(thing), Pairs)
    for field in fields(thing):
        value, here = getattr(thing, field.name), (*steps, field.name)
        if field.name in known:
            card = known[field.name].card
            if steps[-1:] == ("base",) and field.name in ("work_of_adhesion", "equilibrium_gap"):
                continue  # those of a law at rest are 1
            yield here, value, units.get(card.measure, card.unit), card
        elif field.name in pairs:
            card = pairs[field.name].card
            for i, pair in enumerate(value):
                for j, unit in enumerate(card.units):
                    of_pair = Quantity(unit, card.symbol, card.words, above=0)
                    yield (*here, i, j), pair[j], unit, of_pair
        elif is_dataclass(value):
            yield from _numbers(value, units, here)
        elif isinstance(value, tuple):
            for i, entry in enumerate(value):
                if is_dataclass(entry):
                    yield from _numbers(entry, units, (*here, i))


def _path(problem: Any, steps: Steps) -> str:
    """Return table and key of a number, by its attributes."""
    first, *rest = steps
    tables = {"traction": "interface", "material": "material", "surface": "surface"}
    if first in tables:
        return ".".join(map(str, (tables[str(first)], *(s for s in rest if s != "base"))))
    if first in ("geometry", "body"):
        word = getattr(problem, str(first)).word
        return ".".join(map(str, (word, *(s for s in rest if s != "base"))))
    in_groups = isinstance(problem, Groups)
    keys = list(steps if in_groups else rest)
    if keys[0] == "start":
        start = problem.start if in_groups else problem.protocol.start
        starts = STARTS["1" if in_groups else problem.units["force"]]
        keys = [{kind: key for key, kind in starts.items()}.get(type(start), Apart.word)]
    return ".".join(map(str, keys if in_groups else ("protocol", *keys)))


def _replaced(thing: Any, values: Mapping[Steps, float]) -> Any:
    """Return a noun, a tuple or a number with numbers at these steps replaced."""
    if () in values:
        return values[()]
    inner: dict[str | int, dict[Steps, float]] = {}
    for (first, *rest), value in values.items():
        inner.setdefault(first, {})[tuple(rest)] = value
    if isinstance(thing, tuple):
        return tuple(_replaced(x, inner[i]) if i in inner else x for i, x in enumerate(thing))
    new = {str(name): _replaced(getattr(thing, str(name)), each) for name, each in inner.items()}
    return replace(thing, **new)
