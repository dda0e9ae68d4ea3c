"""The search for the constants of a law: where to begin, how to descend, how far one may go."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq, least_squares

from viscotack.errors import InputError
from viscotack.materials import RelaxationPowerLaw, RetardationPowerLaw, StandardSolid
from viscotack.materials.interconversion import reciprocal

from .observed import Observed

Array = npt.NDArray[np.float64]

KINDS = {
    "power-law": RetardationPowerLaw,
    "relaxation-power-law": RelaxationPowerLaw,
    "sls": StandardSolid,
}
_FAR = np.log(1e4)  # how far from the measured moduli a plateau is looked for
_COARSE = 1e-3
_EXPONENTS = (0.08, 0.15, 0.25, 0.4, 0.6, 0.9, 1.3, 1.9, 2.7)


@dataclass(frozen=True, eq=False)
class Search:
    """The free constants of a model in logarithms, their bounds, and the data."""

    data: Observed
    kind: Any
    names: tuple[str, ...]
    known: dict[str, float]
    low: Array
    high: Array

    @classmethod
    def of(cls, data: Observed, model: str, known: Mapping[str, float]) -> "Search":
        """Return the search for a model's constants, without those that are known."""
        kind = KINDS[model]
        names = ("rubbery_modulus", "glassy_modulus", "exponent", "tau0")
        names = tuple(n for n in names if n in kind.__dataclass_fields__)
        for name in known:
            if name not in names:
                raise InputError(
                    f"{name} is no constant of the model {model}; it has {', '.join(names)}"
                )
        softest, stiffest = data.moduli
        middle = np.log(softest * stiffest) / 2
        slow, fast = data.frequencies
        bounds = {
            "rubbery_modulus": (np.log(softest) - _FAR, middle),
            "glassy_modulus": (middle, np.log(stiffest) + _FAR),
            "exponent": (np.log(0.02), np.log(3.0) - 1e-9),
            "tau0": (-np.log(fast) - 2 * _FAR, -np.log(slow) + 2 * _FAR),
        }
        free = [name for name in names if name not in known]
        if not free:
            raise InputError("every constant is given: nothing is left to fit")
        low, high = np.array([bounds[name] for name in free]).T
        search = cls(data, kind, names, {k: float(v) for k, v in known.items()}, low, high)
        search.solid((low + high) / 2)  # refuses what is impossible, in the words of the material
        return search

    @property
    def free(self) -> list[str]:
        """Names of the constants to be found."""
        return [name for name in self.names if name not in self.known]

    def solid(self, x: Array) -> Any:
        """Return the solid whose free constants have the natural logarithms x."""
        values = self.known | dict(zip(self.free, np.exp(x).tolist(), strict=True))
        return self.kind(**values, poisson_ratio=self.data.poisson_ratio)

    def misfit(self, x: Array) -> Array:
        """Return the residuals over their noise, shape (P N,)."""
        with np.errstate(divide="ignore"):
            logs = np.log(quick(self.data, self.solid(x), self.data.at))
        # a loss of zero, far outside: finite, so that the search can leave
        return np.clip(self.data.weighed(np.log(self.data.values) - logs).ravel(), -50, 50)

    def at_bound(self, x: Array) -> npt.NDArray[np.bool_]:
        """Return which constants ran into the bounds of the search."""
        return (x - self.low < 1e-3) | (self.high - x < 1e-3)

    def polished(self, x: Array, fixed: int | None = None) -> Any:
        """Return the nearest minimum; with one constant held, that over the others."""
        x = np.clip(x, self.low + 1e-9, self.high - 1e-9)
        # what is known to 1e-6 needs a wide step for its slopes
        options: Any = {} if self.data.in_frequency else {"diff_step": _COARSE}
        if fixed is None:
            return least_squares(
                self.misfit, x, bounds=(self.low, self.high), xtol=1e-10, **options
            )
        others = np.arange(x.size) != fixed
        if not np.any(others):
            return None

        def misfit(part: Array) -> Array:
            whole = x.copy()
            whole[others] = part
            return self.misfit(whole)

        bounds = self.low[others], self.high[others]
        # the profile is wanted to a few digits
        return least_squares(misfit, x[others], bounds=bounds, xtol=1e-4, ftol=1e-5, **options)

    def minimum(self) -> Any:
        """Return the best of the minima that the most promising places lead to."""
        found = [self.polished(x) for x in self.places(3)]
        return min(found, key=lambda result: result.cost)

    def places(self, count: int) -> list[Array]:
        """Return the best places of a search over spectrum, time and ratio of the moduli.

        The response of a reduced solid over a wide range serves all times by a shift along the
        axis, and all moduli by one of the logarithms.
        """
        data = self.data
        softest, stiffest = data.moduli
        slow, fast = data.frequencies
        sign = -1 if data.quantity == "creep" else 1
        exponents = [self.known["exponent"]] if "exponent" in self.known else list(_EXPONENTS)
        if "exponent" not in self.names:
            exponents = [1.0]
        shifts = np.linspace(-3, 3 + np.log10(fast / slow), 40) - np.log10(fast)
        if "tau0" in self.known:
            shifts = np.log10([self.known["tau0"]])
        table_at = np.geomspace(data.at[0] * 1e-9, data.at[-1] * 1e9, 240)
        ranked = []
        for k in softest / stiffest * np.array([0.9, 0.2, 0.01]):
            for n in exponents:
                constants = {"glassy_modulus": 1 / k, "tau0": 1.0}
                if "exponent" in self.names:
                    constants["exponent"] = n
                twin = self.kind(rubbery_modulus=1.0, poisson_ratio=0.0, **constants)
                # seen at omega tau0 or time/tau0
                with np.errstate(divide="ignore"):
                    table = np.log(quick(data, twin, table_at))
                for shift in shifts:
                    way = shift if data.in_frequency else -shift
                    x = np.log(data.at) + way * np.log(10)
                    logs = np.array([np.interp(x, np.log(table_at), row) for row in table])
                    off = np.log(data.values) - np.clip(logs, -80, 80)
                    modulus = sign * float(np.median(off))
                    cost = float(np.sum(np.abs(data.weighed(off - sign * modulus))))
                    place = {
                        "rubbery_modulus": modulus,
                        "glassy_modulus": modulus - np.log(k),
                        "exponent": np.log(n),
                        "tau0": shift * np.log(10),
                    }
                    ranked.append((cost, [place[name] for name in self.free]))
        ranked.sort(key=lambda entry: entry[0])
        return [np.array(place) for _, place in ranked[:count]]

    def profile_end(self, x: Array, i: int, side: int, deviation: float, allowed: float) -> float:
        """Return where the profile of constant i reaches the allowed sum of squares, or inf."""
        end = self.high[i] if side > 0 else self.low[i]
        start = {"x": x}

        def excess(value: float) -> float:
            moved = start["x"].copy()
            moved[i] = value
            found = self.polished(moved, fixed=i)
            if found is not None:
                moved[np.arange(x.size) != i] = found.x
                start["x"] = moved
            return float(np.sum(self.misfit(moved) ** 2)) - allowed

        near, step = float(x[i]), float(np.clip(deviation, 1e-4, 1.0))
        while True:
            far = near + side * step
            if side * (end - far) <= 0:
                far = end
            if excess(far) > 0:
                if excess(near) >= 0:  # a fit without residuals: there is no way to go
                    return near
                root: Any = brentq(excess, near, far, xtol=1e-4 + 1e-3 * step)
                return float(root)
            if far == end:
                return side * np.inf
            near, step = far, 1.6 * step


def quick(data: Observed, solid: Any, at: Array) -> Array:
    """Return what a solid predicts; where the exact way is long, by its modes, to 1e-6.

    The relaxation of the retardation form, and the creep of the relaxation form, need hundreds of
    nodes interconverted at each step of a search; as few modes as the window needs take a
    millisecond or a few.
    """
    long = {"relaxation": RetardationPowerLaw, "creep": RelaxationPowerLaw}
    if not isinstance(solid, long.get(data.quantity, ())):
        return data.predicted(solid, at)
    # the smallest E0 C(t) that was seen, not that of a glass far from the window
    seen = solid.rubbery_modulus / data.moduli[1]
    least = min(max(solid.modulus_ratio, 0.1 * seen), 1.0)
    modes = solid.retardation_modes(
        shortest=float(at[0]) / 30, longest=float(at[-1]) * 30, tolerance=1e-6 * least
    )
    if data.quantity == "creep":
        return np.asarray(modes.creep(at))[None, :] / solid.rubbery_modulus
    E, tau = reciprocal(modes.instantaneous, np.array(modes.weights), np.array(modes.times))
    return solid.rubbery_modulus * (1 + np.exp(-at[:, None] / tau) @ E)[None, :]
