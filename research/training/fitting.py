"""Networks fitted to rows: gradients by JAX, quasi-Newton steps by SciPy, the same on every run."""

import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import minimize
from threadpoolctl import threadpool_limits

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.prediction.surrogate import contact
from viscotack.prediction.surrogate.network import Networks

# How many steps the curvature is remembered for.
_MEMORY = 40
# Rounding of a corner in the penalty of a quantile, in units of the scale.
_CORNER = 0.05


@dataclass(frozen=True)
class Fit:
    """How a network is fitted: widths of its hidden layers, and steps of the quasi-Newton method.

    The mean squared error counts in units of `scale`, beside `penalty` times the sum of the squared
    weights.
    """

    hidden: tuple[int, ...] = (40, 40, 40)
    steps: int = 10_000
    penalty: float = 1e-8
    scale: float = 0.3


@dataclass(frozen=True, eq=False)
class Task:
    """What a network is to learn, a row each; arrays, so that it can be sent to a process."""

    inputs: Array
    target: Array
    weight: Array  # of the squared errors
    # Limits between which the single target lies, see ``contact.between``.
    between: tuple[Array, Array] | None = None
    # What networks fitted before say; the output is multiplied by the gain and added to it.
    before: Array | None = None
    gain: float = 1.0
    # The part of the targets that is to lie below the output, in place of squared errors.
    quantile: float | None = None
    # The single output is the mean of those of the network times these, shape (n, outputs).
    factors: Array | None = None


def fit(task: Task, how: Fit, *, seed: int) -> Networks:
    """Return one network that has learned a task, from weights to begin with by a seed."""
    jax = _jax()
    jnp = jax.numpy
    outputs = (task.target if task.factors is None else task.factors).shape[1]
    sizes = (task.inputs.shape[1], *how.hidden, outputs)
    shapes = [s for a, b in zip(sizes[:-1], sizes[1:], strict=True) for s in ((a, b), (b,))]
    ends = np.cumsum([int(np.prod(shape)) for shape in shapes])[:-1]
    x, target, weight = (jnp.asarray(a) for a in (task.inputs, task.target, task.weight))
    before = None if task.before is None else jnp.asarray(task.before)
    factors = None if task.factors is None else jnp.asarray(task.factors)
    total = float(task.weight.sum())

    def parts(v: Any) -> list[Any]:
        return [a.reshape(shape) for a, shape in zip(jnp.split(v, ends), shapes, strict=True)]

    def answer(layers: list[Any]) -> Any:
        h = x
        for weights, bias in zip(layers[:-2:2], layers[1:-2:2], strict=True):
            h = jnp.tanh(h @ weights + bias)
        out = task.gain * (h @ layers[-2] + layers[-1])
        if factors is not None:
            out = jnp.mean(out * factors, axis=1, keepdims=True)
        if task.before is not None:
            out = out + before
        if task.between is None:
            return out
        low, high = (jnp.asarray(a)[:, None] for a in task.between)
        # contact.between, in the words of JAX
        way = jnp.maximum(high - low, contact.LEAST_WAY)
        return low + way * jax.nn.sigmoid(contact.STEEP * out)

    def loss(v: Any) -> Any:
        layers = parts(v)
        off = (target - answer(layers)) / how.scale
        if task.quantile is None:
            each = off**2
        else:
            # what is above counts so many times what is below; rounded at the corner
            each = task.quantile * off + _CORNER * jax.nn.softplus(-off / _CORNER)
        error = jnp.sum(weight * each) / total
        return error + how.penalty * sum(jnp.sum(w**2) for w in layers[::2])

    value_and_slope = jax.jit(jax.value_and_grad(loss))

    def evaluate(v: Array) -> tuple[float, Array]:
        value, slope = value_and_slope(v)
        return float(value), np.asarray(slope, dtype=float)

    limits = {
        "maxiter": how.steps,
        "maxfun": 2 * how.steps,
        "maxcor": _MEMORY,
        "ftol": 0,
        "gtol": 0,
    }
    # sums of several threads come in another order, and steps go another way
    with threadpool_limits(1):
        found = minimize(evaluate, _first(sizes, seed), jac=True, method="L-BFGS-B", options=limits)
    if not np.isfinite(found.fun):
        raise InputError(
            "what is to be learned is not finite everywhere; look for gaps in the rows"
        )
    layers = [np.asarray(a)[None] for a in parts(found.x)]
    layers[-2:] = [task.gain * a for a in layers[-2:]]
    return Networks(tuple(layers[::2]), tuple(bias[:, None] for bias in layers[1::2]))


def _first(sizes: tuple[int, ...], seed: int) -> Array:
    """Return random weights to begin with, of the size that keeps signals of order one."""
    random = np.random.default_rng(seed)
    values = []
    for a, b in zip(sizes[:-1], sizes[1:], strict=True):
        values += [random.normal(size=a * b) / np.sqrt(a), random.uniform(-0.5, 0.5, size=b)]
    return np.concatenate(values)


def _jax() -> Any:
    # One thread: sums in one order, and one process a network. XLA reads it when it is imported.
    os.environ.setdefault("NPROC", "1")
    import jax

    jax.config.update("jax_enable_x64", True)
    jax.config.update("jax_platforms", "cpu")
    return jax
