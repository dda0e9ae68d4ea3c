"""Which kind of model learns the pull-off force best, from the same rows.

`python -m benchmarks.surrogate_candidates [--rows 8000]`: each candidate learns some rows of
`broad`, `thesis` and `chosen` drawn at random and is judged by the rows that the shipped surrogate
did not learn from. A quarter of an hour on one core; docs/surrogate.md shows the table.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from time import perf_counter

import numpy as np

from training.fitting import Fit, Task, fit
from training.rows import LEARNED, Rows, read
from training.train_sphere import kept_apart
from viscotack.surrogate import physics
from viscotack.surrogate.contact import LEAST_WAY, between
from viscotack.surrogate.network import Networks
from viscotack.surrogate.store import shipped
from viscotack.theory import persson_brener, rate

from .cases import power_law

_HOW = Fit(hidden=(32, 32, 32), steps=3000)
# A Gaussian process of more rows needs more memory and patience than the others together.
_GAUSSIAN_ROWS, _GAUSSIAN_SCALES = 4000, 1000
Predictor = Callable[[Rows], np.ndarray]


def boosting(rows: Rows) -> Predictor:
    """Return gradient boosting on the logarithms of the inputs."""
    from sklearn.ensemble import HistGradientBoostingRegressor

    model = HistGradientBoostingRegressor(max_iter=2000, learning_rate=0.05, random_state=0)
    model.fit(physics.scaled(rows.groups), np.log10(rows.force))
    return lambda new: model.predict(physics.scaled(new.groups))


def gaussian_process(rows: Rows) -> Predictor:
    """Return a Gaussian process of the share between the limits."""
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import ConstantKernel, Matern, WhiteKernel

    some = rows.chosen(np.random.default_rng(0).permutation(len(rows))[:_GAUSSIAN_ROWS])
    low, high = _way(some.groups)
    share = (np.log10(some.force) - low) / (high - low)
    kernel = ConstantKernel() * Matern(np.ones(5), nu=2.5) + WhiteKernel(1e-4, (1e-9, 1e-1))
    first = slice(None, _GAUSSIAN_SCALES)
    x = physics.scaled(some.groups)
    found = GaussianProcessRegressor(kernel, normalize_y=True).fit(x[first], share[first])
    whole = GaussianProcessRegressor(found.kernel_, optimizer=None, normalize_y=True).fit(x, share)

    def predict(new: Rows) -> np.ndarray:
        low, high = _way(new.groups)
        return low + (high - low) * whole.predict(physics.scaled(new.groups))

    return predict


def plain_network(rows: Rows) -> Predictor:
    """Return a network of the logarithm itself."""
    target = np.log10(rows.force)[:, None]
    centre, spread = target.mean(), target.std()
    network = _fit(physics.scaled(rows.groups), (target - centre) / spread, None)
    return lambda new: centre + spread * network(physics.scaled(new.groups))[0, :, 0]


def network_between(rows: Rows) -> Predictor:
    """Return a network of the share between slow and fast limit."""
    return between_limits(rows, _HOW)


def between_limits(rows: Rows, how: Fit) -> Predictor:
    """Return a network of that share, fitted in a given way."""
    target = np.log10(rows.force)[:, None]
    task = Task(physics.scaled(rows.groups), target, np.ones_like(target), _way(rows.groups))
    network = fit(task, how, seed=0)
    return lambda new: _between(new, network(physics.scaled(new.groups)))


def network_with_crack(rows: Rows) -> Predictor:
    """Return the same, told what Persson and Brener say of the crack."""
    told = np.column_stack([physics.scaled(rows.groups), _crack(rows)])
    network = _fit(told, np.log10(rows.force)[:, None], _way(rows.groups))
    return lambda new: _between(
        new, network(np.column_stack([physics.scaled(new.groups), _crack(new)]))
    )


def without_chosen(rows: Rows) -> Predictor:
    """Return the same form, without the rows of `chosen`."""
    others = rows.chosen(rows.origin != LEARNED.index("chosen"))
    return network_between(others)


CANDIDATES = {
    "gradient boosting (scikit-learn)": boosting,
    "Gaussian process, Matern 5/2, of the share between the limits, 4,000 rows": gaussian_process,
    "network of the logarithm itself": plain_network,
    "network of the share between the limits, as shipped": network_between,
    "the same, told what Persson and Brener say": network_with_crack,
    "as shipped, without the rows of `chosen`": without_chosen,
}


def _fit(inputs: np.ndarray, target: np.ndarray, between: tuple | None) -> Networks:
    how = _HOW if between else Fit(hidden=_HOW.hidden, steps=_HOW.steps, scale=1.0)
    return fit(Task(inputs, target, np.ones_like(target), between), how, seed=0)


def _way(groups: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    tests = shipped().tests(groups)
    return tests.slow, np.maximum(tests.fast.mean(axis=0), tests.slow + LEAST_WAY)


def _between(new: Rows, said: np.ndarray) -> np.ndarray:
    return between(*_way(new.groups), said[0, :, 0])


def _crack(rows: Rows) -> np.ndarray:
    # at the speed that Eq. 4.24 gives to the rate, with each row's own Tabor number
    tabor, k, n, _, speed = rows.groups.T
    fitted = rate.FITTED_TABOR
    reduced = rate.rate_as_published(speed * fitted / tabor)
    speeds = np.atleast_1d(rate.crack_speed(reduced, tabor=fitted)).tolist()
    said = [
        persson_brener.amplification(v, material=power_law(*solid))
        for v, *solid in zip(speeds, k.tolist(), n.tolist(), strict=True)
    ]
    return np.log10(said)


def main() -> None:
    """Run and print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=int, default=8000)
    chosen = parser.parse_args()
    rows = read(*LEARNED)
    kept = kept_apart(len(rows))
    learned, test = rows.chosen(~kept), rows.chosen(kept)
    some = learned.chosen(np.random.default_rng(1).permutation(len(learned))[: chosen.rows])
    true = np.log10(test.force)
    print(f"{len(some)} rows learned from, {len(test)} judged by; errors of log10 of the force")
    print(
        "| candidate | MSE | median | 95 % below | largest | seconds |\n|---|---|---|---|---|---|"
    )
    for words, candidate in CANDIDATES.items():
        began = perf_counter()
        error = np.abs(candidate(some)(test) - true)
        print(
            f"| {words} | {np.mean(error**2):.1e} | {np.median(error):.1e} | "
            f"{np.quantile(error, 0.95):.1e} | {error.max():.1e} | {perf_counter() - began:.0f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
