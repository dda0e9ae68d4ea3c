"""The learned answer to a flat punch on a sliding layer: stress, work, curve, how sure they are.

A rigid machine retracts the punch at a constant speed from a relaxed start; the layer is a standard
solid and the traction that of Lennard-Jones. What is learned and what is not:
:mod:`viscotack.surrogate.punch_physics`. Answers are those of a sphere's surrogate, their forces
mean stresses: evaluated with NumPy alone.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError

from . import physics, sealed
from . import punch_physics as punch
from .answers import Answers, Intervals, answered
from .line import OUTPUTS, Curves, curves
from .model import Scaled
from .network import Networks, from_arrays
from .punch_physics import Array
from .trust import CONFIDENCES, INPUTS, OF, Trust, error_inputs

SHIPPED = Path(__file__).with_name("punch.npz")
# How many inputs and outputs each of the networks has.
_SHAPES = {
    "start": (len(punch.START), 1),
    "slow": (len(punch.SLOW), 1),
    "fast": (len(punch.FAST), 1),
    "stress": (len(punch.INPUTS), 1),
    "work": (len(punch.INPUTS) + 2, 1),
    "give": (len(punch.INPUTS) + 2, 1),
    "line": (len(punch.INPUTS) + 3, OUTPUTS),
    "trust": (INPUTS, len(OF)),
}
_SCALED, _NETWORKS = ("start", "work", "give", "line"), ("slow", "fast", "stress")
# Steps in which the depth of a start by force is sought, and depths in each.
_LOOKS, _DEPTHS = 3, 24
_FORM, _MOST = "viscotack punch 1", 5e6


@dataclass(frozen=True, eq=False)
class PunchSurrogate:
    """Networks of a punch on a layer.

    Inputs are rows in the order of ``punch_physics.INPUTS``: half width and thickness [a0], modulus
    ratio, depth of the start [h0] and rate [h0/tau0].

    Attributes
    ----------
    start : Scaled
        log10 of the mean stress of the start over depth and compliance.
    slow, fast, stress : Networks
        Of the limits, and of the share of the way between them; as many of each.
    work, give, line : Scaled
        log10 of the work over the stress; log10 of the travel to zero stress over the depth of the
        start; the shapes of a curve.
    trust : Trust
        How wide the intervals are.
    """

    start: Scaled
    slow: Networks
    fast: Networks
    stress: Networks
    work: Scaled
    give: Scaled
    line: Scaled
    trust: Trust

    def limits(self, size: float, thickness: float) -> Mapping[str, tuple[float, float]]:
        """Return least and largest of each input that was learned from, for this punch and layer.

        How deep a start may be depends on both: its mean stress was spread evenly.

        Examples
        --------
        >>> low, high = shipped().limits(64.85, 3.24)["preload"]
        >>> f"{low:.2g} to {high:.2g} h0"
        '0.0074 to 49 h0'
        """
        ends = np.array([punch.LOW, punch.HIGH])
        row = np.array([[size, thickness, 1.0, 1.0, 1.0]])
        ends[:, punch.PRELOAD] *= punch.compliance(row)[0] if min(size, thickness) > 0 else np.nan
        return {n: (float(a), float(b)) for n, a, b in zip(punch.INPUTS, *ends, strict=True)}

    def inside(self, groups: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Return which inputs lie in the range learned from, shape (n, 5)."""
        with np.errstate(invalid="ignore", divide="ignore"):
            rows = punch.stressed(np.asarray(groups, dtype=float))
            # the ends themselves, whichever way they were rounded
            return (rows >= punch.LOW * (1 - 1e-9)) & (rows <= punch.HIGH * (1 + 1e-9))

    def relaxed(self, groups: Array) -> Array:
        """Return the mean stress of the relaxed starts [sigma0], compression positive, (n,)."""
        said = self.start(punch.scaled(groups)[:, punch.START])[..., 0].mean(axis=0)
        return punch.stressed(groups)[:, punch.PRELOAD] * 10**said

    def slow_limit(self, groups: Array) -> Array:
        """Return log10 of the slow limit of the stress, shape (m, n)."""
        said = self.slow(punch.scaled(groups)[:, punch.SLOW])[..., 0]
        return physics.between(punch.least(groups), np.zeros(len(groups)), said)

    def way(self, groups: Array) -> tuple[Array, Array]:
        """Return log10 of the slow and of the fast limit of the stress, shape (m, n) each."""
        slow, said = self.slow_limit(groups), self.fast(punch.scaled(groups)[:, punch.FAST])[..., 0]
        fast = physics.between(punch.least_fast(groups), np.zeros(len(groups)), said)
        return slow, np.maximum(slow, fast)

    def evaluate(self, groups: npt.ArrayLike) -> Answers:
        """Return stress and work of rows of groups; they are not checked to lie inside."""
        rows = np.asarray(groups, dtype=float)
        inputs = punch.scaled(rows)
        slow, fast = self.way(rows)
        stresses = physics.between(slow, fast, self.stress(inputs)[..., 0])
        stress, least = stresses.mean(axis=0), slow.mean(axis=0)
        works = stress + self.work(told(rows, least, stress))[..., 0]
        return answered(stresses, works, least, fast.mean(axis=0))

    def curves(self, groups: npt.ArrayLike, answers: Answers) -> Curves:
        """Return the unloading curves that belong to the answers of the same rows.

        Depths are in h0, mean stresses in sigma0 and compression positive, the edge in a0.
        """
        rows = np.asarray(groups, dtype=float)
        slow = self.slow_limit(rows).mean(axis=0)
        stress = np.log10(answers.pull_off_force)
        known = told(rows, slow, stress)
        pressed, depth = self.relaxed(rows), rows[:, punch.PRELOAD]
        size = rows[:, punch.SIZE]
        to_zero = depth * 10 ** self.give(known)[..., 0].mean(axis=0)
        found = curves(
            self.line(with_work(known, answers.work_to_pull_off))[0],
            give=to_zero * size / pressed,
            preload=depth,
            force=pressed,
            radius=size,
            pull_off=answers.pull_off_force,
            work=answers.work_to_pull_off / punch.STRENGTH,
        )
        # no contact is wider than its punch
        edge = np.minimum(found.contact_radius, size[:, None])
        return replace(found, contact_radius=edge)

    def intervals(
        self, groups: npt.ArrayLike, answers: Answers, *, confidence: float = 0.9
    ) -> Intervals:
        """Return intervals that held so many of the cases that were kept apart.

        Raises
        ------
        ValueError
            If the confidence is not one of those that were measured.
        """
        inputs = error_inputs(punch.scaled(np.asarray(groups, dtype=float)), answers)
        return self.trust.intervals(inputs, answers, confidence)

    def start_depth(self, size: float, thickness: float, force: float) -> float:
        """Return the depth [h0] of the relaxed start with a mean stress [sigma0].

        Raises
        ------
        ValueError
            If no start in the range learned from has it.
        """
        low, high = self.limits(size, thickness)["preload"]
        for look in range(_LOOKS):
            depths = np.geomspace(low, high, _DEPTHS)
            rows = np.ones((_DEPTHS, len(punch.INPUTS)))
            rows[:, punch.SIZE], rows[:, punch.THICKNESS] = size, thickness
            rows[:, punch.PRELOAD] = depths
            found = self.relaxed(rows)
            if look == 0 and not found[0] <= force <= found[-1]:
                raise InputError(
                    f"preload_force is {force:.4g} sigma0, and {found[0]:.4g} to {found[-1]:.4g} "
                    "sigma0 was learned from for this size and thickness"
                )
            i = int(np.clip(np.searchsorted(found, force), 1, _DEPTHS - 1))
            low, high = depths[i - 1], depths[i]
        part = (force - found[i - 1]) / (found[i] - found[i - 1])
        return float(low + np.clip(part, 0.0, 1.0) * (high - low))


def told(groups: Array, slow: Array, stress: Array) -> Array:
    """Return what networks are told that know the slow limit and the stress, shape (n, 7).

    Parameters
    ----------
    groups : ndarray, shape (n, 5)
    slow, stress : ndarray, shape (n,)
        log10 of the slow limit of the stress and of the stress itself.
    """
    return np.column_stack([punch.scaled(groups), 2 * slow, 2 * (stress - slow)])


def with_work(known: Array, work: Array) -> Array:
    """Return what networks are told that know the work [dg0] as well, shape (n, 8)."""
    return np.column_stack([known, np.log10(work)])


def save(made: PunchSurrogate, path: str | os.PathLike[str], facts: Mapping[str, Any]) -> None:
    """Write a surrogate, and beside its arrays what is to be known of it."""
    arrays: dict[str, Any] = made.trust.reach.arrays("trust.")
    arrays["trust.levels"] = made.trust.levels
    for name in (*_SCALED, *_NETWORKS):
        arrays |= getattr(made, name).arrays(f"{name}.")
    sealed.write(path, arrays, _FORM, facts)


def load(path: str | os.PathLike[str]) -> tuple[PunchSurrogate, dict[str, Any]]:
    """Return the surrogate of a file, and what it says of it.

    Raises
    ------
    ValueError
        If the file is not one that :func:`save` wrote, or is damaged.
    """
    with sealed.opened(path, _FORM, "the file of a surrogate of punches", _MOST) as (arrays, words):
        _check(arrays)
        parts: dict[str, Any] = {name: Scaled.of(arrays, f"{name}.") for name in _SCALED}
        parts |= {name: from_arrays(arrays, f"{name}.") for name in _NETWORKS}
        trust = Trust(from_arrays(arrays, "trust."), arrays["trust.levels"])
        return PunchSurrogate(**parts, trust=trust), words


@cache
def shipped() -> PunchSurrogate:
    """Return the surrogate that comes with the package, read once."""
    return load(SHIPPED)[0]


def _check(arrays: Mapping[str, npt.NDArray[Any]]) -> None:
    """Refuse arrays that do not fit to one another, or are not finite numbers."""
    for name, array in arrays.items():
        if array.dtype.kind != "f" or not np.all(np.isfinite(array)):
            raise InputError(f"{name} must be finite numbers")
    for name, (inputs, outputs) in _SHAPES.items():
        networks = from_arrays(arrays, f"{name}.")
        widths = [inputs, *(w.shape[-1] for w in networks.weights)]
        count = {len(w) for w in (*networks.weights, *networks.biases)}
        fits = all(
            w.shape[1:] == (a, b) and c.shape[1:] == (1, b)
            for w, c, a, b in zip(
                networks.weights, networks.biases, widths[:-1], widths[1:], strict=True
            )
        )
        if len(count) != 1 or not fits or widths[-1] != outputs:
            raise InputError(f"layers of {name} do not lead from {inputs} inputs to {outputs}")
    for name in _SCALED:
        for part in ("centre", "spread"):
            if arrays[f"{name}.{part}"].shape != (_SHAPES[name][1],):
                raise InputError(f"{name}.{part} must have {_SHAPES[name][1]} numbers")
    if arrays["trust.levels"].shape != (len(OF), len(CONFIDENCES)):
        raise InputError(f"trust.levels must have the shape {(len(OF), len(CONFIDENCES))}")
    if len({len(arrays[f"{name}.weight.0"]) for name in _NETWORKS}) != 1:
        raise InputError("each network of the stress must have limits of its own")
