"""COMSOL: the table of branches of a generalised Maxwell solid, on the long-term modulus.

The branches load from a text file with three columns: number, shear modulus G_m, relaxation time
tau_m. Young's modulus and Poisson ratio of the linear elastic material are the long-term ones and
stand in comments here, as that file has no place for them.
"""

import re

from viscotack.errors import InputError
from viscotack.materials.branched_solids import Prony
from viscotack.materials.exchange.units import (
    Card,
    Units,
    head,
    number,
    series,
    shear_factor,
    told_incompressible,
    units_of,
)

_MODULUS = re.compile(r"long-term Young's modulus\s+(\S+)")
_POISSON = re.compile(r"Poisson ratio\s+(\S+)")


def written(card: Card, units: Units, notes: tuple[str, ...]) -> str:
    """Return the table of branches, with the elastic constants in comments."""
    material = card.material
    E0, nu = card.elastic(material.rubbery_modulus)
    lines = head("%", units, notes)
    lines += [
        f"% linear elastic material: long-term Young's modulus {E0 / units.pascal!r}",
        f"% linear elastic material: Poisson ratio {nu!r}",
        "% by default only the deviatoric part relaxes: let the volumetric part relax in the same "
        "ratios, unless the solid is nearly incompressible",
        "% branch, shear modulus, relaxation time",
    ]
    factor = shear_factor(material.poisson_ratio)
    for i, (E, time) in enumerate(material.branches, 1):
        lines.append(f"{i} {E * factor / units.pascal!r} {time / units.second!r}")
    return "\n".join(lines) + "\n"


def read(
    text: str,
    units: Units | None,
    *,
    rubbery_modulus: float | None = None,
    poisson_ratio: float | None = None,
) -> Prony:
    """Return the series of a table of branches; elastic constants from comments if not given."""
    unit = units_of(text, units)
    found = _MODULUS.search(text), _POISSON.search(text)
    modulus = rubbery_modulus
    if modulus is None and found[0] is not None:
        modulus = number(found[0][1], _line(text, found[0]), "Young's modulus") * unit.pascal
    nu = poisson_ratio
    if nu is None and found[1] is not None:
        nu = number(found[1][1], _line(text, found[1]), "the Poisson ratio")
    if modulus is None or nu is None:
        raise InputError(
            "a table of branches does not say the long-term Young's modulus and the Poisson "
            "ratio; give both"
        )
    if told_incompressible(text) and poisson_ratio is None and rubbery_modulus is None:
        modulus, nu = 3 * modulus * shear_factor(nu), 0.5
    branches = []
    for line, raw in enumerate(text.splitlines(), 1):
        words = raw.split("%")[0].replace(",", " ").split()
        if not words:
            continue
        if len(words) != 3:
            raise InputError(
                f"line {line}: expected branch, shear modulus and relaxation time, got {raw!r}"
            )
        G = number(words[1], line, "the shear modulus") * unit.pascal
        time = number(words[2], line, "the relaxation time") * unit.second
        branches.append((G / shear_factor(nu), time))
    return series(modulus, branches, nu)


def _line(text: str, found: re.Match) -> int:
    return text.count("\n", 0, found.start()) + 1
