"""Do sweeps superpose, and do their moduli belong together? Asked before anything counts by less.

A shift can always be found; whether the shifted sweeps are one curve is another question. Here
every point counts alike: no outlier is set aside, no modulus weighs less than the other.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import Chebyshev

from viscotack.arrays import Array
from viscotack.errors import InputError

from .kramers_kronig import causal_misfit
from .master_curves import shifted_by
from .overlap import Curve
from .shifting import BEST, FEWEST, curve, steps_between, temperature_levels
from .sweeps import FrequencySweeps, MasterCurve, ShiftTable

_NAMES = ("storage", "loss")
_APART = 0.1  # decades and more: shifts that contradict each other
_SIGMAS = 3.0
_POINTS = 3  # of each sweep in the overlap, from which on they can be compared


@dataclass(frozen=True)
class Neighbours:
    """Two sweeps next to each other in temperature, as they were shifted.

    Attributes
    ----------
    temperatures : (float, float)
        [K], colder first.
    deviation : tuple of float
        Root mean square of ln(modulus) about one smooth curve through both, where they overlap:
        of storage and of loss, each point counting alike; nan where too few points overlap.
    own : tuple of float
        The same about a smooth curve for each sweep.
    shift, asked : float
        log10 a_T from the hotter to the colder as used, and as both moduli ask for it; nan where
        they do not fix it.
    doubt : float
        Standard deviation of the latter.
    """

    temperatures: tuple[float, float]
    deviation: tuple[float, ...]
    own: tuple[float, ...]
    shift: float
    asked: float
    doubt: float


@dataclass(frozen=True)
class Superposition:
    """Whether shifted sweeps are one curve.

    Attributes
    ----------
    neighbours : tuple of Neighbours
        Each two sweeps next to each other in temperature.
    tolerance : float
        Relative deviation beyond which two sweeps are no one curve.
    """

    neighbours: tuple[Neighbours, ...]
    tolerance: float

    @property
    def holds(self) -> bool:
        """Whether nothing contradicts superposition."""
        return not self.words()

    def words(self) -> tuple[str, ...]:
        """Return what contradicts superposition, in sentences; none where nothing does."""
        return (*self._misfits(), *self._contradictions())

    def _misfits(self) -> list[str]:
        found = []
        for i, name in enumerate(_NAMES):
            off = [
                (each.deviation[i], each)
                for each in self.neighbours
                # two rough sweeps may lie on one curve
                if each.deviation[i] > max(np.log1p(self.tolerance), 2 * each.own[i])
            ]
            if not off:
                continue
            worst, where = max(off, key=lambda pair: pair[0])
            found.append(
                f"sweeps do not superpose in {name}: {_between(where)} differ by "
                f"{100 * np.expm1(worst):.2g} % where they overlap"
                f"{f', and so do {len(off) - 1} more pairs' * (len(off) > 1)}. No shift makes them "
                "one curve: a glass, two processes or a sweep that is off (--leave-out)"
            )
        return found

    def _contradictions(self) -> list[str]:
        off = [
            each
            for each in self.neighbours
            if abs(each.shift - each.asked) > max(_APART, _SIGMAS * each.doubt)
        ]
        if not off:
            return []
        worst = max(off, key=lambda each: abs(each.shift - each.asked))
        return [
            f"storage and loss together ask for other shifts: {_between(worst)} are shifted by "
            f"{worst.shift:.2f} decades, and both moduli ask for {worst.asked:.2f} "
            f"+- {worst.doubt:.2f}{f'; so do {len(off) - 1} more steps' * (len(off) > 1)}"
        ]


def superposition(
    sweeps: FrequencySweeps, shifts: ShiftTable, *, tolerance: float = 0.1
) -> Superposition:
    """Compare sweeps where they overlap, once shifted.

    Parameters
    ----------
    sweeps : FrequencySweeps
        As measured, at two or more temperatures.
    shifts : ShiftTable
        The shifts that were used, in whatever way they were found; between its rows they are
        interpolated.
    tolerance : float
        Relative deviation from one curve beyond which they do not superpose, in (0, 1).

    Raises
    ------
    ValueError
        If the table does not reach all temperatures of the sweeps.
    """
    if not 0 < tolerance < 1:
        raise InputError(f"tolerance must lie between 0 and 1, got {tolerance!r}")
    levels = temperature_levels(sweeps)
    temperature = np.array([float(np.mean(level.temperature)) for level in levels])
    along, up, _ = shifted_by(shifts, temperature, temperature, float(shifts.temperature[0]))
    shapely = [i for i, level in enumerate(levels) if len(level) >= FEWEST]
    curves = [curve(levels[i]) for i in shapely]
    asked = _asked(temperature[shapely], curves)
    found = []
    for (a, b), (i, j), (other, doubt) in zip(
        pairwise(curves), pairwise(shapely), asked, strict=True
    ):
        step = float(along[j] - along[i])
        moved = Curve(b.x + step, tuple(y + up[j] - up[i] for y in b.y))
        deviation, own = _deviations(a, moved)
        between = float(temperature[i]), float(temperature[j])
        found.append(Neighbours(between, deviation, own, step, other, doubt))
    return Superposition(tuple(found), tolerance)


def contradiction(master: MasterCurve, *, tolerance: float = 0.1) -> str:
    """Return in a sentence that storage and loss belong to no causal solid; empty if they do.

    Both moduli of every point count alike in the nearest pair that obeys Kramers and Kronig.
    """
    off = causal_misfit(master)
    if off is None or max(off) <= tolerance:
        return ""
    return (
        "storage and loss modulus contradict each other (Kramers-Kronig): with all points counting "
        f"alike the nearest causal solid is {100 * np.expm1(off[0]):.2g} % off in storage and "
        f"{100 * np.expm1(off[1]):.2g} % in loss. A shift, a sweep or a calibration is wrong"
    )


def _asked(temperature: Array, curves: list[Curve]) -> list[tuple[float, float]]:
    """Return the step that both moduli ask for and its standard deviation, of each two curves."""
    try:
        steps = steps_between(temperature, curves, *BEST)
    except ValueError:
        return [(np.nan, np.nan)] * (len(curves) - 1)
    return [(step.shift, float(np.hypot(np.sqrt(step.variance), step.common))) for step in steps]


def _deviations(a: Curve, b: Curve) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return the root mean square of ln about a common curve and about two, of each modulus."""
    low, high = max(a.x[0], b.x[0]) - 1e-9, min(a.x[-1], b.x[-1]) + 1e-9
    one, other = (c.chosen((c.x >= low) & (c.x <= high)) for c in (a, b))
    if min(one.x.size, other.x.size) < _POINTS:
        return (np.nan, np.nan), (np.nan, np.nan)
    x = np.concatenate((one.x, other.x))
    common, own = [], []
    for ya, yb in zip(one.y, other.y, strict=True):
        common.append(_scatter(x, np.concatenate((ya, yb))))
        own.append(float(np.hypot(_scatter(one.x, ya), _scatter(other.x, yb)) / np.sqrt(2)))
    return tuple(common), tuple(own)


def _scatter(x: Array, y: Array) -> float:
    """Return the scatter of ln about the polynomial that leaves least of it."""
    left = []
    # a chamber that is measured twice repeats its frequencies
    for degree in range(max(min(5, np.unique(np.round(x, 3)).size - 2), 0) + 1):
        residual = y - Chebyshev.fit(x, y, degree)(x)
        left.append(float(np.sum(residual**2)) / (x.size - degree - 1))
    return float(np.log(10) * np.sqrt(min(left)))


def _between(each: Neighbours) -> str:
    colder, hotter = each.temperatures
    return f"those at {colder - 273.15:.4g} and {hotter - 273.15:.4g} C"
