"""Tables of inputs: every combination of given values, or points that fill a region evenly.

A range is written as values with a scale, ``{ log = [0.01, 10] }`` or ``{ linear = [0.2, 2] }``.
With more than two values, equal shares of the points lie between neighbours: the values are then
equally spaced quantiles, and any distribution can be stated.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from math import prod
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError

# A Sobol sequence is drawn in blocks of this power of two, its balance asks for one.
_BLOCK = 10
# Values of a range are rounded to these digits: cases are named by their numbers, and the last
# digit of an exponential is not the same on every machine.
_DIGITS = 9
# Cases that a plan may have: they are made before the first is run.
_MOST = 10_000_000


def grid(values: Mapping[str, Any]) -> Iterator[dict[str, float]]:
    """Return every combination of the values of the inputs.

    Parameters
    ----------
    values : mapping of str to number, list, or range with a count
        A number, a list of numbers, or ``{"log": [1, 100], "count": 5}`` (or ``"linear"``).

    Examples
    --------
    >>> list(grid({"tabor": 1.0, "rate": {"log": [1, 100], "count": 3}}))
    [{'tabor': 1.0, 'rate': 1.0}, {'tabor': 1.0, 'rate': 10.0}, {'tabor': 1.0, 'rate': 100.0}]
    """
    lists = [_steps(name, given) for name, given in values.items()]
    check_number(prod(map(len, lists)))
    for combination in product(*lists):
        yield dict(zip(values, combination, strict=True))


def fill(values: Mapping[str, Any], *, cases: Any, seed: Any = 0) -> Iterator[dict[str, float]]:
    """Return points of a Sobol sequence, without end, that fill the ranges of the inputs evenly.

    The first points do not depend on their number.

    Parameters
    ----------
    values : mapping of str to number or range
        ``{"log": [0.01, 10]}``, ``{"linear": [...]}``, a fixed number, or
        ``{"choose": [0.1, 0.3], "weights": [5, 1]}``; the weights may be left out.
    cases : int
        How many points are wanted.
    seed : int
        Of the scrambling.
    """
    for name, number, least in (("cases", cases, 1), ("seed", seed, 0)):
        if not isinstance(number, int) or isinstance(number, bool) or number < least:
            raise InputError(f"{name} must be a whole number of at least {least}, got {number!r}")
    check_number(cases)
    makers = {name: _mapping(name, given) for name, given in values.items()}
    free = [name for name in makers if isinstance(values[name], Mapping)]
    if not free:
        raise InputError("a fill needs at least one range; give a grid for a single case")
    # Takes a while to import, and a worker that imports this module never draws a point.
    from scipy.stats import qmc

    # The name that every supported version of scipy knows; the checker knows the newest only.
    generator: dict[str, Any] = {"seed": seed}
    sequence = qmc.Sobol(len(free), **generator)
    while True:
        for point in sequence.random(2**_BLOCK).tolist():
            places = dict(zip(free, point, strict=True))
            yield {name: make(places.get(name, 0.0)) for name, make in makers.items()}


def check_number(cases: int) -> None:
    """Refuse more cases than a plan may have."""
    if cases > _MOST:
        raise InputError(
            f"a plan has at most {_MOST} cases, got {cases:.3g}; split it into several plans with "
            "separate folders"
        )


def _steps(name: str, given: Any) -> list[float]:
    if isinstance(given, Mapping):
        count = given.get("count")
        if not isinstance(count, int) or count < 1 or "choose" in given:
            raise InputError(f"{name}: a range of a grid needs its count, got {dict(given)}")
        check_number(count)
        make = _mapping(name, {k: v for k, v in given.items() if k != "count"})
        places = np.linspace(0.0, 1.0, count) if count > 1 else [0.0]
        return [make(place) for place in places]
    return _numbers(name, given if isinstance(given, list) else [given])


def _mapping(name: str, given: Any) -> Any:
    """Return the function that maps [0, 1) to values of the input."""
    if isinstance(given, int | float):
        (fixed,) = _numbers(name, [given])
        return lambda _: fixed
    scales = [key for key in ("log", "linear", "choose") if key in given]
    allowed = {*scales, "weights"} if scales == ["choose"] else set(scales)
    if len(scales) != 1 or given.keys() - allowed:
        raise InputError(
            f"{name} must be a number, {{ log = [low, high] }}, {{ linear = [low, high] }} or "
            f"{{ choose = [...], weights = [...] }}, got {given}"
        )
    values = np.array(_numbers(name, given[scales[0]]))
    if scales == ["choose"]:
        return _choice(name, values, given.get("weights", [1] * len(values)))
    if len(values) < 2 or np.any(np.diff(values) < 0):
        raise InputError(f"{name}: a range is two or more rising values, got {values.tolist()}")
    logarithmic = scales == ["log"]
    if logarithmic and values[0] <= 0:
        raise InputError(f"{name}: a log range must be positive, got {values.tolist()}")
    ends, places = np.log(values) if logarithmic else values, np.linspace(0, 1, len(values))

    def value(place: float) -> float:
        found = np.interp(place, places, ends)
        return float(f"{np.exp(found) if logarithmic else found:.{_DIGITS}g}")

    return value


def _choice(name: str, values: npt.NDArray, weights: Sequence[float]) -> Any:
    shares = np.cumsum(_numbers(f"{name}, weights", weights))
    if len(shares) != len(values) or shares[-1] <= 0 or np.any(np.diff(shares, prepend=0) < 0):
        raise InputError(
            f"{name}: needs a weight, not negative, for each of its {len(values)} choices, "
            f"got {list(weights)}"
        )
    return lambda place: float(values[np.searchsorted(shares, place * shares[-1], side="right")])


def _numbers(name: str, given: Any) -> list[float]:
    good = isinstance(given, list | tuple) and given
    if not good or any(isinstance(v, bool) or not isinstance(v, int | float) for v in given):
        raise InputError(f"{name} must be a number or a list of numbers, got {given!r}")
    if not np.all(np.isfinite(given)):
        raise InputError(f"{name} must be finite, got {given!r}")
    return [float(v) for v in given]
