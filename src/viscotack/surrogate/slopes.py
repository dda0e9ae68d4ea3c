"""Exact derivatives of NumPy formulas by forward differentiation.

A :class:`Sloped` object is an array with its derivatives by some inputs. NumPy passes to it every
operator and function of a formula (NEP 13, NEP 18), and each applies the chain rule to the
derivatives. So every formula exists once. Its parts may be
arrays of the graph of :mod:`viscotack.surrogate.onnx`, so that derivatives are exported as well. A
function without a known derivative raises an error.

At kinks, for example of clipped numbers, the derivative is the one-sided one of NumPy's branch.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

# Derivatives of functions of one variable, from the argument x and the value y.
_OF_ONE: dict[Any, Callable[[Any, Any], Any]] = {
    np.negative: lambda x, y: -1.0,
    np.absolute: lambda x, y: np.sign(x),
    np.sqrt: lambda x, y: 0.5 / y,
    np.cbrt: lambda x, y: 1 / (3 * y * y),
    np.exp: lambda x, y: y,
    np.log: lambda x, y: 1 / x,
    np.log1p: lambda x, y: 1 / (1 + x),
    np.log10: lambda x, y: 1 / (np.log(10.0) * x),
    np.tanh: lambda x, y: 1 - y * y,
    np.arcsinh: lambda x, y: 1 / np.sqrt(x * x + 1),
}
_COMPARED = {np.less, np.less_equal, np.greater, np.greater_equal, np.sign}


class Sloped(NDArrayOperatorsMixin):
    """An array and its derivatives.

    Parameters
    ----------
    value : ndarray
        The array.
    slopes : sequence of ndarray
        Derivatives of the same shape, one per input.

    Examples
    --------
    >>> x = Sloped(np.array([3.0]), [np.array([1.0])])
    >>> y = x * np.sqrt(x + 1)
    >>> float(y.value[0]), float(y.slopes[0][0])
    (6.0, 2.75)
    """

    def __init__(self, value: Any, slopes: Sequence[Any]) -> None:
        self.value, self.slopes = value, tuple(slopes)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the array."""
        return self.value.shape

    @property
    def ndim(self) -> int:
        """Number of its dimensions."""
        return self.value.ndim

    def __len__(self) -> int:
        return len(self.value)

    def __getitem__(self, key: Any) -> Sloped:
        return Sloped(self.value[key], [s[key] for s in self.slopes])

    def mean(self, *, axis: int) -> Sloped:
        """Return the mean along an axis."""
        return Sloped(self.value.mean(axis=axis), [s.mean(axis=axis) for s in self.slopes])

    def std(self, *, axis: int) -> Any:
        """Return the standard deviation along the first axis, without its derivatives."""
        return self.value.std(axis=axis)

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        if method != "__call__" or options:
            raise TypeError(f"np.{ufunc.__name__} ({method}) has no derivative here")
        plain = [x.value if isinstance(x, Sloped) else x for x in inputs]
        value = ufunc(*plain)
        if ufunc in _COMPARED:
            return value
        if ufunc in _OF_ONE:
            rate = _OF_ONE[ufunc](plain[0], value)
            return Sloped(value, [s * rate for s in self.slopes])
        if ufunc not in _OF_TWO:
            raise TypeError(f"np.{ufunc.__name__} has no derivative here")
        count = len(self.slopes)
        known = [x.slopes if isinstance(x, Sloped) else (None,) * count for x in inputs]
        pairs = zip(*known, strict=True)
        return Sloped(value, [_OF_TWO[ufunc](*plain, value, *pair) for pair in pairs])

    def __array_function__(self, function: Any, types: Any, args: Any, options: Any) -> Any:
        if function not in _FUNCTIONS:
            raise TypeError(f"np.{function.__name__} has no derivative here")
        return _FUNCTIONS[function](*args, **options)


def by_logarithms(groups: Any) -> Sloped:
    """Return rows of inputs with their derivatives by the logarithms of each, shape (n, inputs)."""
    count = groups.shape[1]
    return Sloped(groups, [groups * (np.arange(count) == i) for i in range(count)])


def _sum(a: Any, b: Any, sign: float = 1.0) -> Any:
    """Add derivatives, one of which may be None."""
    if b is None:
        return a
    second = b if sign > 0 else -b
    return second if a is None else a + second


def _product(x: Any, z: Any, y: Any, a: Any, b: Any) -> Any:
    return _sum(None if a is None else a * z, None if b is None else x * b)


def _quotient(x: Any, z: Any, y: Any, a: Any, b: Any) -> Any:
    return _sum(None if a is None else a / z, None if b is None else y * b / z, -1.0)


def _power(x: Any, z: Any, y: Any, a: Any, b: Any) -> Any:
    by_base = None if a is None else a * (z * x ** (z - 1))
    return _sum(by_base, None if b is None else b * (y * np.log(x)))


def _matmul(x: Any, z: Any, y: Any, a: Any, b: Any) -> Any:
    return _sum(None if a is None else a @ z, None if b is None else x @ b)


def _larger(x: Any, z: Any, y: Any, a: Any, b: Any) -> Any:
    return np.where(x >= z, _or_zero(a, y), _or_zero(b, y))


def _smaller(x: Any, z: Any, y: Any, a: Any, b: Any) -> Any:
    return np.where(x <= z, _or_zero(a, y), _or_zero(b, y))


def _or_zero(slope: Any, value: Any) -> Any:
    return value * 0.0 if slope is None else slope + value * 0.0


_OF_TWO: dict[Any, Callable[..., Any]] = {
    np.add: lambda x, z, y, a, b: _same(_sum(a, b), y),
    np.subtract: lambda x, z, y, a, b: _same(_sum(a, b, -1.0), y),
    np.multiply: _product,
    np.divide: _quotient,
    np.power: _power,
    np.matmul: _matmul,
    np.maximum: _larger,
    np.minimum: _smaller,
}


def _same(slope: Any, value: Any) -> Any:
    """Broadcast a derivative to the shape of its array."""
    return slope if slope.shape == value.shape else slope + value * 0.0


def _parts(x: Any, count: int) -> tuple[Any, ...]:
    """Return the derivatives of an array that may be constant."""
    return x.slopes if isinstance(x, Sloped) else (x * 0.0,) * count


def _where(condition: Any, yes: Any, no: Any) -> Sloped:
    count = len(next(x for x in (yes, no) if isinstance(x, Sloped)).slopes)
    value = np.where(condition, *(x.value if isinstance(x, Sloped) else x for x in (yes, no)))
    both = zip(_parts(yes, count), _parts(no, count), strict=True)
    return Sloped(value, [np.where(condition, a, b) for a, b in both])


def _clip(x: Any, low: Any, high: Any) -> Any:
    x = x if low is None else np.maximum(x, low)
    return x if high is None else np.minimum(x, high)


def _joined(function: Callable[..., Any]) -> Callable[..., Sloped]:
    def join(several: Sequence[Any], **options: Any) -> Sloped:
        count = len(next(x for x in several if isinstance(x, Sloped)).slopes)
        value = function([x.value if isinstance(x, Sloped) else x for x in several], **options)
        slopes = zip(*(_parts(x, count) for x in several), strict=True)
        return Sloped(value, [function(list(some), **options) for some in slopes])

    return join


_FUNCTIONS: dict[Any, Callable[..., Any]] = {
    np.where: _where,
    np.clip: _clip,
    np.column_stack: _joined(np.column_stack),
    np.concatenate: _joined(np.concatenate),
    np.ndim: lambda x: x.ndim,
}
