"""Small networks side by side, evaluated with NumPy."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
# Rows at a time: their hidden layers stay in the cache of the processor.
_ROWS = 2000


@dataclass(frozen=True, eq=False)
class Networks:
    """Networks of one shape: layers of hyperbolic tangents and a linear one at the end.

    Attributes
    ----------
    weights : tuple of ndarray, shape (m, inputs, outputs)
        Of each layer, for m networks.
    biases : tuple of ndarray, shape (m, 1, outputs)
        Likewise.

    Examples
    --------
    >>> one = Networks((np.full((1, 2, 1), 0.5),), (np.ones((1, 1, 1)),))
    >>> one(np.array([[1.0, 3.0]])).tolist()
    [[[3.0]]]
    """

    weights: tuple[Array, ...]
    biases: tuple[Array, ...]

    def __call__(self, inputs: Array) -> Array:
        """Return what each of the networks says of each row.

        Parameters
        ----------
        inputs : ndarray, shape (n, inputs)

        Returns
        -------
        ndarray, shape (m, n, outputs)
        """
        if len(inputs) <= _ROWS:
            return self._some(inputs)
        starts = range(0, len(inputs), _ROWS)
        return np.concatenate([self._some(inputs[i : i + _ROWS]) for i in starts], axis=1)

    def _some(self, x: Array) -> Array:
        for weight, bias in zip(self.weights[:-1], self.biases[:-1], strict=True):
            x = np.tanh(x @ weight + bias)
        return x @ self.weights[-1] + self.biases[-1]

    def arrays(self, before: str = "") -> dict[str, Array]:
        """Return weights and biases by names for a file, with something before each name."""
        named = [("weight", self.weights), ("bias", self.biases)]
        return {f"{before}{name}.{i}": a for name, some in named for i, a in enumerate(some)}

    @property
    def parameters(self) -> int:
        """Number of weights and biases of all networks together."""
        return sum(a.size for a in (*self.weights, *self.biases))


def from_arrays(arrays: Mapping[str, Array], before: str = "") -> Networks:
    """Return the networks whose :meth:`Networks.arrays` a file has.

    Examples
    --------
    >>> one = Networks((np.ones((1, 2, 1)),), (np.ones((1, 1, 1)),))
    >>> from_arrays(one.arrays("a."), "a.").biases[0].tolist()
    [[[1.0]]]
    """
    layers = range(sum(key.startswith(f"{before}weight.") for key in arrays))
    weights, biases = (
        tuple(arrays[f"{before}{name}.{i}"] for i in layers) for name in ("weight", "bias")
    )
    return Networks(weights, biases)


def together(networks: list[Networks]) -> Networks:
    """Return networks of the same shape as one object.

    Examples
    --------
    >>> one = Networks((np.ones((1, 2, 1)),), (np.ones((1, 1, 1)),))
    >>> together([one, one]).weights[0].shape
    (2, 2, 1)
    """
    return Networks(
        tuple(np.concatenate(layer) for layer in zip(*(n.weights for n in networks), strict=True)),
        tuple(np.concatenate(layer) for layer in zip(*(n.biases for n in networks), strict=True)),
    )
