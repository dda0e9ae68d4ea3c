"""Messages for inputs outside the range of a surrogate."""

from __future__ import annotations


def out_of_range(
    name: str, value: float, limits: tuple[float, float], unit: str, si: tuple[float, str] | None
) -> str:
    """Describe an input outside its range, with its value and the range.

    Parameters
    ----------
    name : str
    value : float
    limits : tuple of float
        Smallest and largest value of the training range.
    unit : str
        Unit of these numbers; empty if there is none.
    si : tuple, or None
        SI value of one unit, and its SI unit; None if unknown.

    Examples
    --------
    >>> out_of_range("rate", 1e17, (0.01, 1e10), "h0/tau0", (1e-9, "m/s"))
    'rate is 1e+17 h0/tau0 (1e+08 m/s), outside the training range of 0.01 to 1e+10 h0/tau0'
    """
    least, most = limits
    own = "" if si is None else f" ({value * si[0]:.3g} {si[1]})"
    return (
        f"{name} is {value:.4g} {unit}".rstrip()
        + f"{own}, outside the training range of {least:.4g} to {most:.4g} {unit}".rstrip()
    )
