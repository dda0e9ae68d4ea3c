"""Validation of arguments shared by the theories, and the scales of an adhesive sphere."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError

# Type of arguments and results: a number or an array.
Values = npt.ArrayLike
Number = float | npt.NDArray[np.float64]

UNITS = {
    "radius": " m",
    "contact_radius": " m",
    "cohesive_radius": " m",
    "position": " m",
    "depth": " m",
    "equilibrium_gap": " m",
    "contact_modulus": " Pa",
    "strength": " Pa",
    "work_of_adhesion": " J/m^2",
    "force": " N",
    "half_width": " m",
    "thickness": " m",
    "tip_length": " m",
    "ligament": " m",
    "stress": " Pa",
    "pull_off_stress": " Pa",
}
# Widest gap of a table, in decades; a wider one leaves the solid undetermined in between.
WIDEST_GAP = 1.0
# Tolerance for limits that are computed by one formula and passed to another.
ROUND_OFF = 16 * np.finfo(float).eps


def positive(**quantities: Values) -> Any:
    """Return the quantities as float arrays; raise an error unless all are positive and finite."""
    found = []
    for name, value in quantities.items():
        x = np.asarray(value, dtype=float)
        bad = ~(np.isfinite(x) & (x > 0))
        if np.any(bad):
            raise InputError(
                f"{name} must be positive and finite, got {x[bad].flat[0]}{UNITS.get(name, '')}"
            )
        found.append(x)
    return found[0] if len(found) == 1 else found


def at_least(lower: Values, hint: str, **quantity: Values) -> Any:
    """Return the quantity as a finite float array; raise an error if it is below the limit."""
    ((name, value),) = quantity.items()
    x, low = np.asarray(value, dtype=float), np.asarray(lower, dtype=float)
    bad = ~(np.isfinite(x) & (x >= low - ROUND_OFF * np.abs(low)))
    if np.any(bad):
        unit = UNITS.get(name, "")
        given = np.broadcast_to(x, bad.shape)[bad].flat[0]
        limit = np.broadcast_to(low, bad.shape)[bad].flat[0]
        raise InputError(
            f"{name} must be finite and at least {limit:.6g}{unit}, got {given}{unit}; {hint}"
        )
    return np.maximum(x, low)


def ratio(modulus_ratio: Values) -> Any:
    """Return the modulus ratio as a float array; raise an error unless it is in (0, 1]."""
    k = positive(modulus_ratio=modulus_ratio)
    if np.any(k > 1):
        raise InputError(
            f"modulus_ratio (rubbery over glassy modulus) must lie in (0, 1], got {np.max(k)}"
        )
    return k


def ascending(places: npt.NDArray[np.float64], name: str, unit: str, remedy: str) -> None:
    """Raise an error if table rows do not ascend, or have a gap of more than a decade."""
    for before, now in zip(places[:-1].tolist(), places[1:].tolist(), strict=True):
        if now <= before:
            raise InputError(
                f"{name} must ascend, got {before:g} {unit} before {now:g} {unit}; {remedy}"
            )
    gaps = np.diff(np.log10(places))
    i = int(np.argmax(gaps))
    if gaps[i] > WIDEST_GAP * (1 + 1e-9):
        raise InputError(
            f"the table has a gap of {gaps[i]:.2g} decades between {places[i]:g} {unit} and "
            f"{places[i + 1]:g} {unit}; at most {WIDEST_GAP:g} decade may lie between two rows"
        )


def plain(x: Any) -> Any:
    """Return a float for a scalar result and the array otherwise."""
    return float(x) if np.ndim(x) == 0 else x


def contact_scales(
    radius: Values, contact_modulus: Values, work_of_adhesion: Values
) -> tuple[Any, Any, Any]:
    r"""Return the scales of contact radius [m], depth [m] and force [N] of Eq. 4.16.

    .. math:: (\pi R^2 \Delta\gamma_0 / E^*)^{1/3}, \quad
              (\pi^2 \Delta\gamma_0^2 R / E^{*2})^{1/3}, \quad \pi R \Delta\gamma_0
    """
    R, E, w = positive(
        radius=radius, contact_modulus=contact_modulus, work_of_adhesion=work_of_adhesion
    )
    ratio = np.cbrt(np.pi * w / (E * R))
    return R * ratio, R * ratio**2, np.pi * R * w
