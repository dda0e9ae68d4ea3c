"""Networks of one shape as one object: members of an ensemble, or a sum."""

import numpy as np

from viscotack.arrays import Array
from viscotack.prediction.surrogate.network import Networks


def together(networks: list[Networks]) -> Networks:
    """Stack networks of the same shape with normalised outputs into one object.

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


def added(one: Networks, other: Networks) -> Networks:
    """Return networks whose output is the sum of two networks' outputs.

    Examples
    --------
    >>> one = Networks((np.ones((1, 1, 1)),) * 2, (np.zeros((1, 1, 1)),) * 2)
    >>> x = np.array([[0.3]])
    >>> float((added(one, one)(x) - 2 * one(x))[0, 0, 0])
    0.0
    """
    weights: list[Array] = []
    for i, (a, b) in enumerate(zip(one.weights, other.weights, strict=True)):
        if i == 0:
            weights.append(np.concatenate([a, b], axis=2))
        elif i == len(one.weights) - 1:
            weights.append(np.concatenate([a, b], axis=1))
        else:
            beside = np.zeros((len(a), a.shape[1] + b.shape[1], a.shape[2] + b.shape[2]))
            beside[:, : a.shape[1], : a.shape[2]] = a
            beside[:, a.shape[1] :, a.shape[2] :] = b
            weights.append(beside)
    biases = [
        np.concatenate([a, b], axis=2)
        for a, b in zip(one.biases[:-1], other.biases[:-1], strict=True)
    ]
    return Networks(tuple(weights), (*biases, one.biases[-1] + other.biases[-1]))
