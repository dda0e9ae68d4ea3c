"""COMSOL: the table of branches of a generalised Maxwell solid, on the long-term modulus.

COMSOL loads the branches from a text file with three columns: number, shear modulus G_m,
relaxation time tau_m. Young's modulus and Poisson ratio of the linear elastic material are the
long-term ones; the exported file states them in comments.
"""

from viscotack.errors import InputError
from viscotack.model.materials.branched_solids import Prony
from viscotack.model.materials.exchange.units import (
    Card,
    Units,
    as_told,
    head,
    number,
    rows_of,
    series,
    shear_factor,
    stated_number,
    units_of,
)


def written(card: Card, units: Units, notes: tuple[str, ...]) -> str:
    """Format the table of branches, with the elastic constants in comments."""
    material = card.material
    E0, nu = card.elastic(material.rubbery_modulus)
    lines = head("%", units, notes)
    lines += [
        f"% linear elastic material: long-term Young's modulus {E0 / units.pascal!r}",
        f"% linear elastic material: Poisson ratio {nu!r}",
        "% by default only the deviatoric part relaxes: make the volumetric part relax with the "
        "same ratios, unless the solid is nearly incompressible",
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
    """Read a table of branches; elastic constants come from comments if not given."""
    unit = units_of(text, units)
    modulus, nu = rubbery_modulus, poisson_ratio
    if modulus is None:
        stated = stated_number(text, "long-term Young's modulus", "Young's modulus")
        modulus = stated and stated * unit.pascal
    if nu is None:
        nu = stated_number(text, "Poisson ratio", "the Poisson ratio")
    if modulus is None or nu is None:
        raise InputError(
            "a table of branches lacks the long-term Young's modulus and the Poisson "
            "ratio; give both (rubbery_modulus, poisson_ratio)"
        )
    given = rubbery_modulus is not None or poisson_ratio is not None
    modulus, nu = as_told(text, modulus, nu, given=given)
    branches = []
    for line, words, raw in rows_of(text, "%"):
        if len(words) != 3:
            raise InputError(
                f"line {line}: expected branch, shear modulus and relaxation time, got {raw!r}"
            )
        G = number(words[1], line, "the shear modulus") * unit.pascal
        time = number(words[2], line, "the relaxation time") * unit.second
        branches.append((G / shear_factor(nu), time))
    return series(modulus, branches, nu)
