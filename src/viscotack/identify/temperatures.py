r"""Tests at several temperatures as one rate series at the temperature of the material.

At a temperature T all times of the solid are :math:`a_T` times those at the reference temperature.
A linear solid therefore reaches the same force at the speed :math:`a_T v`, after an approach at
:math:`a_T` times the speed and a dwell of :math:`1/a_T` times the duration, if the interface does
not depend on temperature.
"""

from collections.abc import Sequence
from dataclasses import replace

from viscotack.errors import InputError
from viscotack.model.materials import Passport

from .pull_off import History, PullOff

DIFFERENT = 3.0  # K: larger differences are not due to the control of a chamber


def shifted(tests: Sequence[PullOff], passport: Passport, growth: bool = False) -> list[PullOff]:
    """Return pull-offs with speeds at the temperature of a material, slowest first.

    Parameters
    ----------
    tests : sequence of PullOff
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
    known = [one.temperature for one in tests if one.temperature is not None]
    if not known:
        return list(tests)
    if len(known) < len(tests):
        raise InputError(
            f"the temperature of {len(tests) - len(known)} of {len(tests)} tests is unknown; "
            "write it into the files or file names, or set --temperature for all"
        )
    if why := unshiftable(passport, growth):
        low, high = min(known), max(known)
        if high - low > DIFFERENT:
            raise InputError(
                f"tests were made at {celsius(low, high)}, and {why}; give tests at one temperature"
            )
        if growth and apart(tests, passport):
            raise InputError(
                f"tests were made at {celsius(low, high)}, and the material is at "
                f"{celsius(passport.temperature)}; set --temperature to move the material"
            )
        return list(tests)
    try:
        factors = [passport.shift_factor(temperature) for temperature in known]
    except InputError as error:
        raise InputError(
            f"{error}; to take all tests at one temperature, set --temperature"
        ) from None
    found = [_at(one, factor) for one, factor in zip(tests, factors, strict=True)]
    return sorted(found, key=lambda one: one.speed)


def unshiftable(passport: Passport, growth: bool) -> str:
    """Return why speeds cannot be shifted to the temperature of a material, or ""."""
    if growth:
        return "the temperature dependence of a speed-dependent interface is unknown"
    if passport.temperature is None or passport.shift is None:
        return "the material has no shift of times with temperature"
    return ""


def apart(tests: Sequence[PullOff], passport: Passport) -> bool:
    """Whether the middle of the temperatures of tests differs from that of a material."""
    known = [one.temperature for one in tests if one.temperature is not None]
    reference = passport.temperature
    if reference is None or not known:
        return False
    return abs((min(known) + max(known)) / 2 - reference) > DIFFERENT


def _at(one: PullOff, factor: float) -> PullOff:
    """Return a pull-off with the speed that is equivalent at the reference temperature."""
    more, history = factor / one.shift, one.history
    if history is not None:
        history = History(more * history.approach_speed, history.peak, history.dwell / more)
    return replace(one, speed=more * one.speed, shift=factor, history=history)


def assumed_temperature(passport: Passport, known: Sequence[float | None]) -> list[str]:
    """Return a remark on the temperature that is assumed where files state none.

    `known` are the temperatures of the tests [K]; without tests, or where one is None, that of the
    passport is assumed.
    """
    if (known and None not in known) or passport.temperature is None:
        return []
    at = celsius(passport.temperature)
    return [f"no temperature of the tests is stated: {at} of the material is assumed"]


def celsius(low: float | None, high: float | None = None) -> str:
    """Return a temperature [K], or a range, in degrees Celsius."""
    both = [f"{kelvin - 273.15:.3g}" for kelvin in (low, high) if kelvin is not None]
    return f"{' to '.join(dict.fromkeys(both))} C"
