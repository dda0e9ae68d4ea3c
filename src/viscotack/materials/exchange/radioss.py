"""Radioss: ``/VISC/PRONY``, moduli and decay constants beside an elastic material.

Fixed columns: M (10 characters), a gap (10), K_v (20), Itab (10), Ishape (10); then one line per
branch of G_i, Beta_i, K_i, Beta_ki (20 each), with beta = 1/(relaxation time). The elastic /MAT of
the same number states the long-term moduli; the exported file repeats them in a comment.
"""

from viscotack.errors import InputError
from viscotack.materials.branched_solids import Prony
from viscotack.materials.exchange.units import (
    Card,
    Units,
    as_told,
    bulk_factor,
    head,
    number,
    other_bulk,
    series,
    shear_factor,
    units_of,
)

_ELASTIC = "long-term Young's modulus and Poisson ratio of the material law:"


def written(card: Card, units: Units, notes: tuple[str, ...]) -> str:
    """Format the block for material number 1; the units of /BEGIN must be the stated ones."""
    material = card.material
    nu = material.poisson_ratio
    E0, stated = card.elastic(material.rubbery_modulus)
    lines = head("#", units, notes)
    lines += [f"# {_ELASTIC} {E0 / units.pascal!r} {stated!r}"]
    lines += ["/VISC/PRONY/1", "#        M                           K_v      Itab    Ishape"]
    lines += [f"{len(material.branches):10d}{'':10}{0.0:20.12E}{0:10d}{0:10d}"]
    lines += [f"#{'G_i':>19}{'Beta_i':>20}{'K_i':>20}{'Beta_ki':>20}"]
    for E, time in material.branches:
        beta = units.second / time
        moduli = E * shear_factor(nu) / units.pascal, E * bulk_factor(nu) / units.pascal
        row = (moduli[0], beta, moduli[1], beta if moduli[1] else 0.0)
        lines.append("".join(f"{value:20.12E}" for value in row))
    return "\n".join(lines) + "\n"


def read(
    text: str,
    units: Units | None,
    *,
    rubbery_modulus: float | None = None,
    poisson_ratio: float | None = None,
) -> Prony:
    """Read the first /VISC/PRONY; elastic constants come from its comment if not given."""
    unit = units_of(text, units)
    modulus, nu = rubbery_modulus, poisson_ratio
    rows: list[tuple[int, str]] = []
    inside = False
    for line, raw in enumerate(text.splitlines(), 1):
        if _ELASTIC in raw:
            words = raw.split(_ELASTIC)[1].split()
            if len(words) == 2:
                stated = number(words[0], line, "Young's modulus") * unit.pascal
                modulus = stated if modulus is None else modulus
                nu = number(words[1], line, "the Poisson ratio") if nu is None else nu
        if raw.startswith("/"):
            if rows:
                break
            inside = raw.upper().startswith("/VISC/PRONY")
        elif inside and raw.strip() and not raw.startswith("#"):
            rows.append((line, raw))
    if modulus is None or nu is None:
        raise InputError(
            "/VISC/PRONY lacks the long-term Young's modulus and the Poisson ratio of its "
            "/MAT; give both (rubbery_modulus, poisson_ratio)"
        )
    given = rubbery_modulus is not None or poisson_ratio is not None
    modulus, nu = as_told(text, modulus, nu, given=given)
    if not rows:
        raise InputError("there is no /VISC/PRONY in the text")
    line, first = rows[0]
    count = int(number(first[:10].strip() or "0", line, "M"))
    if count != len(rows) - 1:
        raise InputError(f"line {line}: M states {count} branches, but {len(rows) - 1} follow")
    branches = []
    for line, raw in rows[1:]:
        fields = [raw[i : i + 20].strip() for i in range(0, 80, 20)]
        G, beta, K, beta_k = (number(w or "0", line, "a value") for w in fields)
        if beta <= 0:
            raise InputError(f"line {line}: the decay constant Beta_i must be positive, got {beta}")
        E = G * unit.pascal / shear_factor(nu)
        bulk = E * bulk_factor(nu) / unit.pascal
        if nu != 0.5 and (abs(K - bulk) > 1e-6 * bulk or abs(beta_k - beta) > 1e-6 * beta):
            other_bulk(line, G, K)
        branches.append((E, unit.second / beta))
    return series(modulus, branches, nu)
