"""Words for what was not learned: another test, or an input out of its range."""

from __future__ import annotations

from typing import Any

from viscotack.problem import Groups, PunchGroups


def other_test(groups: Groups | PunchGroups, starts: Any, unit: str) -> str:
    """Return in words what is other than a relaxed contact that is pulled at once, or nothing.

    Parameters
    ----------
    groups : Groups or PunchGroups
        Of the test.
    starts : type or union of types
        Of the starts that were learned.
    unit : str
        Of a stiffness, with what stands before it.
    """
    found = ""
    if not isinstance(groups.start, starts):
        found = f"the test begins {groups.start!r}"
    elif groups.moves:
        found = f"the machine moves before the retraction: {groups.moves[0]!r}"
    elif groups.stiffness is not None:
        found = f"the machine has a stiffness of {groups.stiffness:.4g} {unit}"
    if not found:
        return ""
    return (
        f"{found}; what was learned is for a relaxed contact that a rigid machine pulls off at a "
        "constant speed"
    )


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
