"""Uncertainty of a passport's material: solids sampled from it, and its times by a temperature."""

from contextlib import suppress
from dataclasses import fields, replace
from math import inf, log
from statistics import NormalDist
from typing import Any

import numpy as np

from viscotack.errors import InputError
from viscotack.model.materials.passport import Passport

# Number of solids sampled from the intervals of a passport without sampled solids.
_DRAWN = 24


def allowed(passport: Passport) -> tuple[Any, ...]:
    """Return solids sampled from the uncertainty of a passport's material.

    These are the solids stored in the passport. For a passport without them, each constant is
    sampled independently from its interval, which overestimates the uncertainty. Empty if unknown.
    """
    if passport.allowed or passport.evidence is None:
        return passport.allowed
    known = {field.name for field in fields(passport.material)}
    quantile = NormalDist().inv_cdf((1 + passport.evidence.level) / 2)
    widths = {
        name: _width(getattr(passport.material, name), low, high) / quantile
        for name, low, high in passport.evidence.intervals
        if name in known
    }
    widths = {name: width for name, width in widths.items() if width > 0}
    if not widths:
        return ()
    rng = np.random.default_rng(20)
    solids = []
    while len(solids) < _DRAWN:
        drawn = {
            name: getattr(passport.material, name) * float(np.exp(width * rng.standard_normal()))
            for name, width in widths.items()
        }
        try:
            solids.append(replace(passport.material, **drawn))
        except InputError:  # glassy softer than rubbery modulus, or an exponent out of range
            continue
    return tuple(solids)


def _width(value: float, low: float, high: float) -> float:
    """Return the half-width of an interval of ln(value), from its bounded sides."""
    sides = [log(value / low)] if low > 0 else []
    sides += [log(high / value)] if high < inf else []
    return float(np.mean(sides)) if sides else 0.0


def known_of(
    passport: Passport, temperature_uncertainty: float | None = None
) -> tuple[tuple[Any, ...], dict[str, float]]:
    """Return sampled solids, and the deviation of ln of the times by the temperature [K].

    Raises
    ------
    InputError
        If the passport knows neither, or no shift for the uncertainty of a temperature.
    """
    solids, times = allowed(passport), dict[str, float]()
    if temperature_uncertainty is not None:
        times["temperature"] = shift_error(passport, temperature_uncertainty)
        if not times["temperature"]:
            raise InputError(
                f"{passport.name}: the temperature dependence of its times is unknown; omit "
                "`temperature_uncertainty`"
            )
    if not solids and not times:
        raise InputError(
            f"{passport.name}: the uncertainty of this material is unknown (no sampled solids "
            "and no intervals); omit passport, or state scatter of its constants"
        )
    return solids, times


def shift_error(passport: Passport, uncertainty: float, temperature: float | None = None) -> float:
    """Return the relative standard error of the times of a solid by its temperature.

    Parameters
    ----------
    passport : Passport
        Solid with its shift law.
    uncertainty : float
        Standard uncertainty of the temperature of the tests [K].
    temperature : float, optional
        This temperature [K]; by default that of the passport.

    Returns
    -------
    float
        In ln of the times; 0 without a shift law.
    """
    law, middle = passport.shift, passport.temperature if temperature is None else temperature
    if law is None or middle is None or not uncertainty:
        return 0.0
    found = {middle: float(law.log10_shift(middle))}
    for beside in (middle - uncertainty, middle + uncertainty):
        # a table may end here, or a law have its pole
        with suppress(InputError):
            found[beside] = float(law.log10_shift(beside))
    span = max(found) - min(found)
    decades = found[min(found)] - found[max(found)]
    return abs(decades) / span * uncertainty * log(10.0) if span else 0.0
