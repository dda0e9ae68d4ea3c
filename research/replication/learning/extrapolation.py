"""Beyond the rows: the broadest spectrum and other modulus ratios, against theory and simulation.

Fig. 5.5 of the thesis and the sweep that follows it: mu = 3.24, preload 73 h0. The analytic curve
is no truth: where it is wrong, a model that follows it is wrong with it, so the same cases are
simulated.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from viscotack import AtDepth, Groups, RetardationPowerLaw, pull_off, solve

from ..table import Array, Detachments
from .features import Descriptor, Target, crack_amplification, features, target
from .learners import BOOSTING, FOREST, NETWORK, Learner, trained

Part = dict[str, Any]

_TABOR, _PRELOAD = 3.24, 73.0
_EXPONENTS = [(0.1, n) for n in (0.2, 0.6, 1.6)]
_RATIOS = [(k, 0.6) for k in (0.5, 0.2, 0.1, 0.05, 0.02)]
# Models of Fig. 5.5, and the network beside them.
_MODELS: tuple[tuple[Learner, Descriptor], ...] = (
    (BOOSTING, Descriptor.NONE),
    (FOREST, Descriptor.PUBLISHED),
    (FOREST, Descriptor.OWN_TABOR),
    (NETWORK, Descriptor.NONE),
    (NETWORK, Descriptor.PUBLISHED),
)
_ACCURACY = 5e-3


def extrapolation(rows: Detachments, *, seed: int, quick: bool) -> Part:
    """Return predictions along the rate, with theory and, unless quick, simulations beside them."""
    solids = list(dict.fromkeys(_EXPONENTS + _RATIOS))
    rates = np.logspace(-1.5, 10, 4 if quick else 24)
    points = np.logspace(-1, 9, 0 if quick else 6)
    fitted = {
        (learner, d): trained(
            learner, features(rows, d), target(rows, Target.FORCE), seed=seed, quick=quick
        )
        for learner, d in _MODELS
    }
    cases = []
    for k, n in solids:
        near = (
            (rows.tabor > 0.9 * _TABOR)
            & (rows.preload > 0.7 * _PRELOAD)
            & np.isclose(rows.modulus_ratio, k, rtol=0.01)
            & np.isclose(rows.exponent, n, rtol=0.01)
        )
        theory = crack_amplification(_asked(k, n, rates), Descriptor.PUBLISHED)
        simulated = [_simulated(k, n, rate) for rate in points]
        models = []
        for (learner, d), model in fitted.items():
            curve = 10 ** model.predict(features(_asked(k, n, rates), d))
            at_points = (
                10 ** model.predict(features(_asked(k, n, points), d)) if len(points) else []
            )
            models.append(
                {
                    "model": learner.name,
                    "descriptor": d.value,
                    "force": np.asarray(curve, dtype=float).tolist(),
                    "off_theory": _distance(curve, theory),
                    "off_simulation": _distance(at_points, simulated),
                }
            )
        at_theory = crack_amplification(_asked(k, n, points), Descriptor.PUBLISHED)
        cases.append(
            {
                "modulus_ratio": k,
                "exponent": n,
                "training_rows_like_it": int(near.sum()),
                "rate": rates.tolist(),
                "theory": theory.tolist(),
                "theory_off_simulation": _distance(at_theory, simulated),
                "simulated_rate": points.tolist(),
                "simulated_force": simulated,
                "models": models,
            }
        )
    return {"tabor": _TABOR, "preload": _PRELOAD, "cases": cases}


def _asked(k: float, n: float, rates: Array) -> Detachments:
    one = np.ones(len(rates))
    return Detachments(
        tabor=_TABOR * one,
        modulus_ratio=k * one,
        exponent=n * one,
        preload=_PRELOAD * one,
        rate=rates,
        pull_off_force=one,
        work_to_pull_off=one,
        work_known=one > 0,
    )


def _simulated(k: float, n: float, rate: float) -> float | None:
    solid = RetardationPowerLaw(
        rubbery_modulus=1.0, glassy_modulus=1 / k, exponent=n, tau0=1.0, poisson_ratio=0.0
    )
    problem = Groups(tabor=_TABOR, material=solid, start=AtDepth(_PRELOAD), rate=rate)
    result = solve(problem, accuracy=_ACCURACY, estimate_error=False, throw=False)
    try:
        return float(pull_off(result).force)
    except ValueError:  # stopped before the pull-off
        return None


def _distance(found: Any, aim: Sequence[float | None] | Array) -> float | None:
    """Return the root mean square of the logarithm between two curves, as a relative error."""
    pairs = [(a, b) for a, b in zip(found, aim, strict=True) if b is not None]
    if not pairs:
        return None
    a, b = np.array(pairs, dtype=float).T
    return float(10 ** np.sqrt(np.mean(np.log10(a / b) ** 2)) - 1)
