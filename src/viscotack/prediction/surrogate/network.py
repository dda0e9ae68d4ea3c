"""Ensembles of small neural networks, evaluated with NumPy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from viscotack.arrays import Array

# Rows per block, so that the hidden layers stay in the processor's cache.
_ROWS = 500


@dataclass(frozen=True, eq=False)
class Networks:
    """Networks of one shape: tanh layers and a linear output layer.

    Attributes
    ----------
    weights : tuple of ndarray, shape (m, inputs, outputs)
        Weights of each layer, for m networks.
    biases : tuple of ndarray, shape (m, 1, outputs)
        Biases of each layer, for m networks.
    centre, spread : ndarray, shape (outputs,), or None
        Scale of the normalised outputs: output = centre + spread * normalised output.

    Examples
    --------
    >>> one = Networks((np.full((1, 2, 1), 0.5),), (np.ones((1, 1, 1)),))
    >>> one(np.array([[1.0, 3.0]])).tolist()
    [[[3.0]]]
    """

    weights: tuple[Array, ...]
    biases: tuple[Array, ...]
    centre: Array | None = None
    spread: Array | None = None

    def __call__(self, inputs: Array) -> Array:
        """Evaluate all networks for all rows.

        Parameters
        ----------
        inputs : ndarray, shape (n, inputs)

        Returns
        -------
        ndarray, shape (m, n, outputs)
        """
        if self.centre is None or self.spread is None:
            return self.plain(inputs)
        return self.centre + self.spread * self.plain(inputs)

    def plain(self, inputs: Array) -> Array:
        """Return normalised outputs, shape (m, n, outputs)."""
        if len(inputs) <= _ROWS:
            return self._some(inputs)
        starts = range(0, len(inputs), _ROWS)
        return np.concatenate([self._some(inputs[i : i + _ROWS]) for i in starts], axis=1)

    def _some(self, x: Array) -> Array:
        first, *others = (block.by_layers(x) for block in self.blocks)
        for said in others:
            first = first + said
        return first

    @cached_property
    def blocks(self) -> tuple[Networks, ...]:
        """Independent sub-networks whose sum this is: hidden layers without cross weights."""
        middle = self.weights[1:-1]
        width = middle[0].shape[1] if middle else 0
        if not middle or any(w.shape[1:] != (width, width) for w in middle):
            return (self,)
        cuts = [
            i
            for i in range(1, width)
            if not any(w[:, :i, i:].any() or w[:, i:, :i].any() for w in middle)
        ]
        places = [slice(i, j) for i, j in zip([0, *cuts], [*cuts, width], strict=True)]
        return tuple(self._block(place, i == 0) for i, place in enumerate(places))

    def _block(self, of: slice, with_bias: bool) -> Networks:
        """Return the sub-network of some hidden nodes; one sub-network has the output bias."""
        weights = (
            self.weights[0][:, :, of],
            *(w[:, of, of] for w in self.weights[1:-1]),
            self.weights[-1][:, of],
        )
        last = self.biases[-1] if with_bias else np.zeros_like(self.biases[-1])
        biases = (*(b[:, :, of] for b in self.biases[:-1]), last)
        return Networks(tuple(map(np.ascontiguousarray, weights)), biases)

    def by_layers(self, x: Array) -> Array:
        """Evaluate normalised outputs layer by layer."""
        for weight, bias in zip(self.weights[:-1], self.biases[:-1], strict=True):
            x = np.tanh(x @ weight + bias)
        return x @ self.weights[-1] + self.biases[-1]

    def arrays(self, before: str = "") -> dict[str, Array]:
        """Return weights and biases by names for a file, with a prefix."""
        named = [("weight", self.weights), ("bias", self.biases)]
        found = {f"{before}{name}.{i}": a for name, some in named for i, a in enumerate(some)}
        scale = {f"{before}centre": self.centre, f"{before}spread": self.spread}
        return found | {name: a for name, a in scale.items() if a is not None}


def from_arrays(arrays: Mapping[str, Array], before: str = "") -> Networks:
    """Reconstruct networks from the output of :meth:`Networks.arrays`.

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
    return Networks(weights, biases, *(arrays.get(f"{before}{x}") for x in ("centre", "spread")))
