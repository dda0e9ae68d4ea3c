"""Words for an input out of the range of a surrogate."""

from __future__ import annotations


def out_of_range(
    name: str, value: float, limits: tuple[float, float], unit: str, si: tuple[float, str] | None
) -> str:
    """Return that an input is out of its range, with its value and the range.

    Parameters
    ----------
    name : str
    value : float
    limits : tuple of float
        Least and largest that was learned from.
    unit : str
        Of these numbers, empty where they have none.
    si : tuple, or None
        What one unit is in SI, and that unit; None where it is not known.

    Examples
    --------
    >>> out_of_range("rate", 1e17, (0.01, 1e10), "h0/tau0", (1e-9, "m/s"))
    'rate is 1e+17 h0/tau0 (1e+08 m/s), and 0.01 to 1e+10 h0/tau0 was learned from'
    """
    least, most = limits
    own = "" if si is None else f" ({value * si[0]:.3g} {si[1]})"
    return (
        f"{name} is {value:.4g} {unit}".rstrip()
        + f"{own}, and {least:.4g} to {most:.4g} {unit}".rstrip()
        + " was learned from"
    )
