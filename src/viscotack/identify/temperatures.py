r"""Tests at several temperatures as one rate series at the temperature of the material.

At a temperature T all times of the solid are :math:`a_T` times those at the reference temperature.
A linear solid therefore reaches the same force at the speed :math:`a_T v`, after an approach at
:math:`a_T` times the speed and a dwell of :math:`1/a_T` times the duration, if the interface does
not depend on temperature.
"""

from collections.abc import Sequence
from dataclasses import replace

from viscotack.errors import InputError
from viscotack.materials import Passport

from .pull_off import History, PullOff

_DIFFERENT = 3.0  # K: larger differences are not due to the control of a chamber


def shifted(
    series: Sequence[PullOff], passport: Passport, growth: bool = False
) -> tuple[list[PullOff], list[str]]:
    """Return pull-offs with speeds at the temperature of a material, slowest first, and remarks.

    Parameters
    ----------
    series : sequence of PullOff
        Tests with their temperatures; tests without one are at that of the material.
    passport : Passport
        The material, with its shift of times.
    growth : bool
        Whether the interface grows with speed; its dependence on temperature is unknown.

    Raises
    ------
    ValueError
        If temperatures differ from the material's and its shift is unknown there, or with growth.
    """
    known = [one.temperature for one in series if one.temperature is not None]
    if not known:
        return list(series), assumed_temperature(passport, known)
    if len(known) < len(series):
        raise InputError(
            f"the temperature of {len(series) - len(known)} of {len(series)} tests is unknown; "
            "write it into the files or file names, or set --temperature for all"
        )
    low, high = min(known), max(known)
    reference = passport.temperature
    if reference is None or passport.shift is None or growth:
        return list(series), _unshifted(low, high, reference, growth)
    try:
        factors = [passport.shift_factor(temperature) for temperature in known]
    except InputError as error:
        raise InputError(
            f"{error}; to take all tests at one temperature, set --temperature"
        ) from None
    found = [_at(one, factor) for one, factor in zip(series, factors, strict=True)]
    remark = (
        f"tests at {_celsius(low, high)} are taken at the speeds a_T v at {_celsius(reference)}, "
        f"with a_T from {min(factors):.3g} to {max(factors):.3g}, and with the same interface at "
        "all temperatures"
    )
    apart = max(abs(low - reference), abs(high - reference)) > _DIFFERENT
    return sorted(found, key=lambda one: one.speed), [remark] if apart else []


def _at(one: PullOff, factor: float) -> PullOff:
    """Return a pull-off with the speed that is equivalent at the reference temperature."""
    history = one.history
    if history is not None:
        history = History(factor * history.approach_speed, history.peak, history.dwell / factor)
    return replace(one, speed=factor * one.speed, shift=factor, history=history)


def _unshifted(low: float, high: float, reference: float | None, growth: bool) -> list[str]:
    """Return a remark on tests that are not shifted; raise an error if they must be."""
    why = "the material has no shift of times with temperature"
    if growth:
        why = "the temperature dependence of a speed-dependent interface is unknown"
    if high - low > _DIFFERENT:
        raise InputError(
            f"tests were made at {_celsius(low, high)}, and {why}; give tests at one temperature"
        )
    if reference is None or abs((low + high) / 2 - reference) <= _DIFFERENT:
        return []
    if growth:
        raise InputError(
            f"tests were made at {_celsius(low, high)}, and the material is at "
            f"{_celsius(reference)}; set --temperature to move the material"
        )
    return [
        f"tests were made at {_celsius(low, high)}, but {why}: it is used as at "
        f"{_celsius(reference)}"
    ]


def assumed_temperature(passport: Passport, known: Sequence[float | None]) -> list[str]:
    """Return a remark on the temperature that is assumed where files state none.

    `known` are the temperatures of the tests [K]; without tests, or where one is None, that of the
    passport is assumed.
    """
    if (known and None not in known) or passport.temperature is None:
        return []
    at = _celsius(passport.temperature)
    return [f"no temperature of the tests is stated: {at} of the material is assumed"]


def _celsius(low: float, high: float | None = None) -> str:
    both = [f"{kelvin - 273.15:.3g}" for kelvin in (low, low if high is None else high)]
    return f"{' to '.join(dict.fromkeys(both))} C"
