"""pyvisco: its table of Prony terms, two header rows, ratios to the instantaneous modulus.

Columns ``tau_i, alpha_i, E_0, E_i`` with the units below, tensile moduli, times in s. The format
has no comments, so notes and the Poisson ratio are not exported.
"""

import csv
import io

from viscotack.errors import InputError
from viscotack.materials.branched_solids import Prony
from viscotack.materials.exchange.units import Card, Units, from_ratios, number

_PRESSURES = ("Pa", "kPa", "MPa", "GPa")
_NAMES = ["tau_i", "alpha_i", "E_0", "E_i"]


def written(card: Card, units: Units, notes: tuple[str, ...]) -> str:
    """Format the table."""
    _check(units)
    glassy = card.material.glassy_modulus
    lines = [",".join(_NAMES), f"s,-,{units.pressure},{units.pressure}"]
    lines += [
        f"{time!r},{E / glassy!r},{glassy / units.pascal!r},{E / units.pascal!r}"
        for E, time in card.material.branches
    ]
    return "\n".join(lines) + "\n"


def read(
    text: str,
    units: Units | None,
    *,
    rubbery_modulus: float | None = None,
    poisson_ratio: float | None = None,
) -> Prony:
    """Read a table; it does not contain the Poisson ratio."""
    if rubbery_modulus is not None:
        raise InputError("a table of pyvisco states its modulus, E_0; omit rubbery_modulus")
    if poisson_ratio is None:
        raise InputError("a table of pyvisco lacks the Poisson ratio; give poisson_ratio")
    rows = [[word.strip() for word in row] for row in csv.reader(io.StringIO(text)) if row]
    if len(rows) < 2 or not {"tau_i", "alpha_i", "E_0"} <= set(rows[0]):
        raise InputError("the first row must name tau_i, alpha_i and E_0")
    place = {name: i for i, name in enumerate(rows[0])}
    if len(rows[1]) != len(rows[0]):
        raise InputError("line 2: the number of units must equal the number of names")
    unit = units or Units(rows[1][place["E_0"]], rows[1][place["tau_i"]])
    _check(unit)
    glassy, ratios = None, []
    for line, row in enumerate(rows[2:], 3):
        if len(row) != len(rows[0]):
            raise InputError(f"line {line}: expected {len(rows[0])} values, got {len(row)}")
        stated = number(row[place["E_0"]], line, "E_0") * unit.pascal
        if glassy is not None and abs(stated - glassy) > 1e-9 * glassy:
            raise InputError(
                f"line {line}: E_0 is {stated:g} Pa here but {glassy:g} Pa in earlier lines"
            )
        glassy = stated
        ratio = number(row[place["alpha_i"]], line, "alpha_i")
        ratios.append((ratio, number(row[place["tau_i"]], line, "tau_i")))
    if glassy is None:
        raise InputError("the text contains no branch of a Prony series")
    return from_ratios(glassy, ratios, poisson_ratio, instantaneous=True)


def _check(units: Units) -> None:
    if units.pressure not in _PRESSURES or units.time != "s":
        raise InputError(
            f"pyvisco uses s and {', '.join(_PRESSURES)}, got {units.time} and "
            f"{units.pressure}; choose from these"
        )
