"""Notes on possible but unusual values, which may indicate a wrong unit."""

import numpy as np

from viscotack.arrays import Array

_ROOM = 263.0, 323.0  # K: temperatures of a room or a refrigerator
_COLD = 100.0  # K; few laboratories measure below
_HARD, _SOFT = 3e10, 0.1  # Pa: beyond polymers and bones, below weak gels


def doubtful_temperature(kelvins: Array, in_kelvin: bool) -> list[str]:
    """Return a note if temperatures look as if they were in another unit.

    Examples
    --------
    >>> doubtful_temperature(np.array([566.15, 571.15]), False)
    ['check: temperatures from 293 to 298 C would be room temperatures if in kelvin']
    """
    known = kelvins[np.isfinite(kelvins)]
    if not known.size:
        return []
    low, high = float(known.min()), float(known.max())
    if in_kelvin:
        far = f"check: temperatures from {low:.4g} to {high:.4g} K would be usual if in Celsius"
        return [far] if high < _COLD else []
    low, high = low - 273.15, high - 273.15
    room = (
        f"check: temperatures from {low:.4g} to {high:.4g} C would be room temperatures if in "
        "kelvin"
    )
    return [room] if _ROOM[0] <= low and high <= _ROOM[1] else []


def doubtful_modulus(modulus: Array) -> list[str]:
    """Return a note if a modulus is unusual for polymers, gels and tissues.

    Examples
    --------
    >>> doubtful_modulus(np.array([1e-3, 2e-3]))
    ['check: the modulus stays below 0.002 Pa, less than that of weak gels']
    """
    low, high = float(np.min(modulus)), float(np.max(modulus))
    if high < _SOFT:
        return [f"check: the modulus stays below {high:.2g} Pa, less than that of weak gels"]
    if high > _HARD:
        return [
            f"check: the modulus reaches {high:.2g} Pa, from {low:.2g} Pa, more than that of bone"
        ]
    return []
