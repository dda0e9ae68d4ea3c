"""The table [profile] of a case file: a cone, or a power law by one of its points."""

from typing import Any

from viscotack.geometry import Cone, PowerLawProfile

from .punch_file import Table


def profile_from_table(table: Table, *, cone: bool) -> Cone | PowerLawProfile:
    """Return the indenter that a table states.

    A cone by its slope; else the exponent q and one point of z = A r^q, its height at a radius, so
    that nobody has to type a coefficient in m^(1-q).
    """
    if cone:
        return table.make(Cone, slope=table.quantity("slope", "1"))
    exponent = table.quantity("exponent", "1")
    height, radius = table.quantity("height", "m"), table.quantity("at_radius", "m")
    values: dict[str, Any] = {"exponent": exponent}
    if not (height > 0 and radius > 0):
        raise ValueError(f"height and at_radius must be positive, got {height} m and {radius} m")
    return table.make(PowerLawProfile, coefficient=height / radius**exponent, **values)
