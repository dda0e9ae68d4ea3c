"""RepTate: Maxwell modes in a text file, in the format of its command "Save Maxwell modes".

Comments, the number of modes, then number, time [s] and shear modulus [Pa] of each. RepTate's modes
are liquid: the rubbery modulus is exported as an additional mode, ten thousand times slower than
the slowest, with a comment.
"""

import re

from viscotack.errors import InputError
from viscotack.materials.branched_solids import Prony
from viscotack.materials.exchange.units import (
    Card,
    Units,
    head,
    number,
    refuse_units,
    rows_of,
    series,
    shear_factor,
    stated_number,
)

_SLOWER = 1e4
_PLATEAU = "the last mode replaces the rubbery modulus, which modes do not have; Poisson ratio"


def written(card: Card, units: Units, notes: tuple[str, ...]) -> str:
    """Format the modes, with the plateau as the last one."""
    refuse_units("RepTate", units)
    material = card.material
    factor = shear_factor(material.poisson_ratio)
    modes = [*material.branches, (material.rubbery_modulus, _SLOWER * material.branches[-1][1])]
    lines = [
        "# Maxwell modes",
        *head("#", units, notes),
        f"# {_PLATEAU} {material.poisson_ratio!r}",
    ]
    lines += ["", "#number of modes", f"{len(modes)}", "", "#   i\ttau_i\tG_i"]
    lines += [f"{i}\t{time!r}\t{E * factor!r}" for i, (E, time) in enumerate(modes, 1)]
    return "\n".join([*lines, "", "#end"]) + "\n"


def read(
    text: str,
    units: Units | None,
    *,
    rubbery_modulus: float | None = None,
    poisson_ratio: float | None = None,
) -> Prony:
    """Read the series; the plateau is the last mode if a comment states so, or is given."""
    if units is not None:
        refuse_units("RepTate", units)
    nu = poisson_ratio
    if nu is None:
        nu = stated_number(text, re.escape(_PLATEAU), "the Poisson ratio")
    if nu is None:
        raise InputError("modes of RepTate lack the Poisson ratio; give poisson_ratio")
    rows: list[tuple[float, float]] = []
    count = None
    for line, words, raw in rows_of(text, "#"):
        if count is None:
            count = int(number(words[0], line, "the number of modes"))
            continue
        if len(words) != 3:
            raise InputError(f"line {line}: expected number, time and modulus, got {raw!r}")
        time = number(words[1], line, "the relaxation time")
        rows.append((number(words[2], line, "the modulus") / shear_factor(nu), time))
    if count != len(rows):
        raise InputError(f"the file states {count} modes, but {len(rows)} follow")
    if rubbery_modulus is None:
        if _PLATEAU not in text or not rows:
            raise InputError(
                "modes of RepTate lack a rubbery modulus; give rubbery_modulus, or fit the data"
            )
        rubbery_modulus = rows.pop()[0]
    return series(rubbery_modulus, rows, nu)
