"""Record NumPy formulas as a graph of ONNX operators during evaluation.

A :class:`Traced` object represents an array of which one example row is known. NumPy passes to it
every operator and function of a formula (NEP 13, NEP 18). Each is applied to the example row and
recorded as the ONNX operator for any number of rows. So every formula exists once, and the export
cannot differ from it. A function without ONNX counterpart raises an error.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.lib.mixins import NDArrayOperatorsMixin

# Old enough for programs with outdated ONNX support: ONNX 1.8.
OPSET, IR_VERSION = 13, 7

_OPERATORS: dict[Any, str] = {
    np.add: "Add",
    np.subtract: "Sub",
    np.multiply: "Mul",
    np.divide: "Div",
    np.power: "Pow",
    np.matmul: "MatMul",
    np.negative: "Neg",
    np.absolute: "Abs",
    np.sign: "Sign",
    np.sqrt: "Sqrt",
    np.exp: "Exp",
    np.log: "Log",
    np.tanh: "Tanh",
    np.maximum: "Max",
    np.minimum: "Min",
    np.less: "Less",
    np.less_equal: "LessOrEqual",
    np.greater: "Greater",
    np.greater_equal: "GreaterOrEqual",
    np.logical_and: "And",
    np.bitwise_and: "And",
}
# Operators missing in ONNX, or missing in double precision; cube roots of positive numbers only.
_MADE_OF: dict[Any, Callable[[Any], Any]] = {
    np.log10: lambda x: np.log(x) / np.log(10.0),
    np.cbrt: lambda x: x ** (1 / 3),
    np.arcsinh: lambda x: np.sign(x) * np.log(np.abs(x) + np.sqrt(x * x + 1.0)),
}
_RUNNING = {np.maximum: "ReduceMax", np.minimum: "ReduceMin"}


@dataclass(eq=False)
class Graph:
    """Nodes and constants, objects of the onnx library, in the order of their first use.

    Examples
    --------
    >>> graph = Graph()
    >>> x = graph.input("x", np.array([3.0]))
    >>> (np.sqrt(x + 1.0) / 2.0).value.tolist()
    [1.0]
    >>> [node.op_type for node in graph.nodes]
    ['Add', 'Sqrt', 'Div']
    """

    nodes: list[Any] = field(default_factory=list)
    constants: list[Any] = field(default_factory=list)
    _known: dict[Any, str] = field(default_factory=dict)

    def input(self, name: str, row: npt.NDArray) -> "Traced":
        """Add an input with any number of rows, given one example row."""
        return Traced(self, name, row)

    def constant(self, value: npt.ArrayLike) -> "Traced":
        """Add a constant array, stored in the file."""
        from onnx import numpy_helper

        array = np.ascontiguousarray(value).reshape(np.shape(value))
        key = (array.dtype.str, array.shape, array.tobytes())
        if key not in self._known:
            self._known[key] = f"constant_{len(self.constants)}"
            self.constants.append(numpy_helper.from_array(array, self._known[key]))
        return Traced(self, self._known[key], array)

    def apply(
        self, operator: str, inputs: Sequence[Any], value: Any, **attributes: Any
    ) -> "Traced":
        """Apply an operator to its inputs; a repeated operation is reused."""
        from onnx import helper

        names = tuple(self.of(x).name for x in inputs)
        key = (operator, names, tuple(attributes.items()))
        if key not in self._known:
            self._known[key] = name = f"{operator.lower()}_{len(self.nodes)}"
            # ONNX Runtime 1.18 fails for nodes without names
            self.nodes.append(helper.make_node(operator, names, [name], name, **attributes))
        return Traced(self, self._known[key], np.asarray(value))

    def named(self, x: "Traced", name: str) -> None:
        """Define an array as the output of a given name."""
        from onnx import helper

        self.nodes.append(helper.make_node("Identity", [x.name], [name], name))

    def of(self, x: Any) -> "Traced":
        """Convert a number or an array to a part of the graph."""
        return x if isinstance(x, Traced) else self.constant(x)


class Traced(NDArrayOperatorsMixin):
    """An array of the graph: its name, and its value for the example row."""

    def __init__(self, graph: Graph, name: str, value: npt.NDArray) -> None:
        self.graph, self.name, self.value = graph, name, value

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape, for one row."""
        return self.value.shape

    @property
    def ndim(self) -> int:
        """Number of dimensions."""
        return self.value.ndim

    def __len__(self) -> int:
        return len(self.value)

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        if any(_foreign(type(x)) for x in inputs):
            return NotImplemented
        if method == "accumulate" and ufunc in _RUNNING and options == {"axis": 1}:
            return _running(ufunc, inputs[0])
        if method != "__call__" or options or ufunc not in {*_OPERATORS, *_MADE_OF}:
            raise TypeError(f"np.{ufunc.__name__} ({method}) has no ONNX counterpart here")
        if ufunc in _MADE_OF:
            return _MADE_OF[ufunc](*inputs)
        plain = [x.value if isinstance(x, Traced) else x for x in inputs]
        # ONNX does not mix types: convert integers to floats
        kind = np.result_type(*plain)
        alike = [astype(self.graph, x, kind) for x in inputs]
        return self.graph.apply(_OPERATORS[ufunc], alike, ufunc(*plain))

    def __array_function__(self, function: Any, types: Any, args: Any, options: Any) -> Any:
        if any(map(_foreign, types)):
            return NotImplemented
        if function not in _FUNCTIONS:
            raise TypeError(f"np.{function.__name__} has no ONNX counterpart here")
        return _FUNCTIONS[function](self.graph, *args, **options)

    def __getitem__(self, key: Any) -> "Traced":
        """Return a slice; at most one index may be a list or an array."""
        keys = list(key) if isinstance(key, tuple) else [key]
        if any(k is Ellipsis for k in keys):
            i = next(i for i, k in enumerate(keys) if k is Ellipsis)
            keys[i : i + 1] = [slice(None)] * (self.ndim - len(keys) + 1)
        x, axis, apply = self, 0, self.graph.apply
        for k in keys:
            if k is None:
                x = apply("Unsqueeze", [x, np.array([axis])], np.expand_dims(x.value, axis))
                axis += 1
            elif isinstance(k, slice):
                if k != slice(None):
                    limits = [np.array([i]) for i in (*k.indices(x.shape[axis])[:2], axis)]
                    value = x.value[(slice(None),) * axis + (k,)]
                    x = apply("Slice", [x, *limits], value)
                axis += 1
            else:
                index = self.graph.of(k if isinstance(k, Traced) else np.array(k))
                value = np.take(x.value, index.value, axis=axis)
                x = apply("Gather", [x, index], value, axis=axis)
                axis += index.ndim
        return x

    def mean(self, *, axis: int) -> "Traced":
        """Return the mean along an axis."""
        value = self.value.mean(axis=axis)
        return self.graph.apply("ReduceMean", [self], value, axes=(axis,), keepdims=0)

    def std(self, *, axis: int) -> "Traced":
        """Return the standard deviation along the first axis."""
        assert axis == 0
        away: Any = self - self.mean(axis=0)
        return np.sqrt((away * away).mean(axis=0))


def _foreign(kind: type) -> bool:
    """Return whether a type overrides NumPy functions and is not an array of a graph."""
    own = hasattr(kind, "__array_ufunc__") and not issubclass(kind, np.ndarray | np.generic)
    return own and not issubclass(kind, Traced)


def astype(graph: Graph, x: Any, kind: np.dtype) -> Traced:
    """Convert an array of the graph to another type."""
    if not isinstance(x, Traced):
        return graph.constant(np.asarray(x, dtype=kind))
    if x.value.dtype == kind:
        return x
    from onnx import helper

    number = helper.np_dtype_to_tensor_dtype(kind)
    return graph.apply("Cast", [x], x.value.astype(kind), to=number)


def _running(ufunc: Any, x: Traced) -> Traced:
    """Return the running maximum or minimum over the columns."""
    so_far = np.tri(x.shape[1], dtype=bool)
    # replace the later columns by the first one, which is always included
    seen = _where(x.graph, so_far, x[:, None], x[:, None, :1])
    value = ufunc.accumulate(x.value, axis=1)
    return x.graph.apply(_RUNNING[ufunc], [seen], value, axes=(2,), keepdims=0)


def _where(graph: Graph, condition: Any, yes: Any, no: Any) -> Traced:
    parts = [graph.of(x) for x in (condition, yes, no)]
    return graph.apply("Where", parts, np.where(*(p.value for p in parts)))


def _clip(graph: Graph, x: Any, low: Any, high: Any) -> Any:
    x = x if low is None else np.maximum(x, low)
    return x if high is None else np.minimum(x, high)


def _columns(graph: Graph, parts: Sequence[Any]) -> Traced:
    """Stack arrays of one or two dimensions as columns."""
    rows = next(p for p in parts if isinstance(p, Traced))
    count = graph.apply("Shape", [rows], np.array(rows.shape))[:1]
    blocks = []
    for part in parts:
        block = graph.of(part)
        block = block[:, None] if block.ndim == 1 else block
        if not isinstance(part, Traced):
            # constants are the same in each row
            size = graph.apply(
                "Concat", [count, np.array([block.shape[1]])], np.array(block.shape), axis=0
            )
            block = graph.apply("Expand", [block, size], block.value)
        blocks.append(block)
    return graph.apply("Concat", blocks, np.hstack([b.value for b in blocks]), axis=1)


_FUNCTIONS: dict[Any, Callable[..., Any]] = {
    np.where: _where,
    np.clip: _clip,
    np.column_stack: _columns,
    np.hstack: _columns,
    np.ndim: lambda graph, x: x.ndim,
}
