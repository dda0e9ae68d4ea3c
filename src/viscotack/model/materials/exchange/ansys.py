"""Ansys: ``TB,PRONY``, ratios to the instantaneous modulus that ``MP,EX`` states.

G(t) = G_0 (alpha_inf + sum alpha_i exp(-t/tau_i)), with G_0 from EX and NUXY; SHEAR and BULK
series are separate. ``TBDATA`` has a start position and up to six numbers: three pairs.
"""

from scipy.constants import gas_constant

from viscotack.errors import InputError
from viscotack.model.materials.branched_solids import Prony
from viscotack.model.materials.exchange.units import (
    Card,
    Units,
    as_told,
    from_ratios,
    head,
    number,
    other_bulk,
    units_of,
)
from viscotack.model.materials.shift import WLF, Arrhenius


def written(card: Card, units: Units, notes: tuple[str, ...]) -> str:
    """Format the material as APDL commands for material number 1."""
    material, glassy = card.material, card.material.glassy_modulus
    modulus, nu = card.elastic(glassy)
    lines = head("!", units, notes)
    lines += [f"MP,EX,1,{modulus / units.pascal!r}", f"MP,NUXY,1,{nu!r}"]
    for part in ("SHEAR", "BULK") if card.bulk_modulus is None else ("SHEAR",):
        lines.append(f"TB,PRONY,1,1,{len(material.branches)},{part}")
        for first in range(0, len(material.branches), 3):
            pairs = material.branches[first : first + 3]
            values = ",".join(f"{E / glassy!r},{t / units.second!r}" for E, t in pairs)
            lines.append(f"TBDATA,{2 * first + 1},{values}")
    return "\n".join([*lines, *_shifted(card)]) + "\n"


def _shifted(card: Card) -> list[str]:
    """Format the shift law: log10 A = c1 (T - T0)/(c2 + T - T0), A = 1/a_T, or TN (Arrhenius)."""
    match card.shift:
        case None:
            return []
        case WLF(reference_temperature=T, c1=c1, c2=c2):
            return [
                "! temperatures in kelvin: TOFFST,0",
                "TB,SHIFT,1,1,3,WLF",
                f"TBDATA,1,{T!r},{c1!r},{c2!r}",
            ]
        case Arrhenius(reference_temperature=T, activation_energy=energy):
            return [
                "! temperatures in kelvin: TOFFST,0; ln A = H/R (1/T0 - 1/T)",
                "TB,SHIFT,1,1,2,TN",
                f"TBDATA,1,{T!r},{energy / gas_constant!r}",
            ]
        case _:
            return ["! TB,SHIFT does not support a shift table: fit a WLF or Arrhenius law"]


def read(text: str, units: Units | None) -> Prony:
    """Read the series of ``TB,PRONY`` with ``MP,EX`` and ``MP,NUXY`` (or PRXY)."""
    unit = units_of(text, units)
    constants: dict[str, float] = {}
    tables: dict[str, dict[int, float]] = {}
    lines: dict[str, int] = {}
    counts: dict[str, int | None] = {}
    part = ""
    for line, raw in enumerate(text.splitlines(), 1):
        words = [w.strip() for w in raw.split("!")[0].strip().split(",")]
        command = words[0].upper()
        if command == "MP" and len(words) >= 4:
            constants[words[1].upper()] = number(words[3], line, words[1])
        elif command == "TB":
            part = ""
            if len(words) > 1 and words[1].upper() == "PRONY":
                part = words[5].upper() if len(words) > 5 and words[5] else "SHEAR"
                tables[part], lines[part] = {}, line
                stated = words[4] if len(words) > 4 and words[4] else ""
                counts[part] = int(number(stated, line, "the number of pairs")) if stated else None
        elif command == "TBDATA" and part:
            first = words[1] if len(words) > 1 else ""
            place = int(number(first, line, "the place of TBDATA")) if first else 1
            if not first and tables[part]:
                raise InputError(
                    f"line {line}: TBDATA must begin with the position of its first number"
                )
            for offset, word in enumerate(words[2:]):
                if word:
                    tables[part][place + offset] = number(word, line, "a value")
    nu = constants.get("NUXY", constants.get("PRXY"))
    if "EX" not in constants or nu is None:
        raise InputError("MP,EX and MP,NUXY (instantaneous modulus, Poisson ratio) are missing")
    modulus, nu = as_told(text, constants["EX"], nu)
    if "SHEAR" not in tables:
        raise InputError("there is no TB,PRONY with SHEAR in the text")
    for part, table in tables.items():
        if counts[part] is not None and len(table) != 2 * (counts[part] or 0):
            raise InputError(
                f"line {lines[part]}: TB states {counts[part]} pairs, but {len(table)} numbers "
                "follow"
            )
    shear = _pairs(tables["SHEAR"], lines["SHEAR"])
    if nu != 0.5:
        bulk = _pairs(tables.get("BULK", {}), lines.get("BULK", lines["SHEAR"]))
        sums = sum(a for a, _ in shear), sum(a for a, _ in bulk)
        same = len(shear) == len(bulk) and all(
            abs(a - c) <= 1e-6 * a and abs(b - d) <= 1e-6 * b
            for (a, b), (c, d) in zip(shear, bulk, strict=True)
        )
        if not same:
            other_bulk(lines["SHEAR"], *sums)
    ratios = [(a, time * unit.second) for a, time in shear]
    return from_ratios(modulus * unit.pascal, ratios, nu, instantaneous=True)


def _pairs(table: dict[int, float], line: int) -> list[tuple[float, float]]:
    if sorted(table) != list(range(1, len(table) + 1)) or len(table) % 2:
        raise InputError(
            f"line {line}: the numbers of TBDATA must be complete pairs from position 1"
        )
    return [(table[i], table[i + 1]) for i in range(1, len(table), 2)]
