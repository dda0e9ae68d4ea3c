"""Abaqus: ``*VISCOELASTIC, TIME=PRONY``, ratios to the instantaneous modulus.

Time domain viscoelasticity of the Abaqus Analysis User's Guide: g(t) = 1 - sum g_i (1 -
exp(-t/tau_i)), data lines g_i, k_i, tau_i; ``*ELASTIC`` states the modulus, long-term or
instantaneous.
"""

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
    """Format the material as input lines, with the exact long-term modulus."""
    material, glassy = card.material, card.material.glassy_modulus
    E0, nu = card.elastic(material.rubbery_modulus)
    lines = head("**", units, notes)
    lines += ["*MATERIAL, NAME=VISCOTACK", "*ELASTIC, MODULI=LONG TERM"]
    lines += [f"{E0 / units.pascal!r}, {nu!r}"]
    lines += ["*VISCOELASTIC, TIME=PRONY"]
    for E, t in material.branches:
        bulk = E / glassy if card.bulk_modulus is None else 0.0
        lines.append(f"{E / glassy!r}, {bulk!r}, {t / units.second!r}")
    return "\n".join([*lines, *_shifted(card)]) + "\n"


def _shifted(card: Card) -> list[str]:
    """Format the shift law: log10 A = -c1 (T - T0)/(c2 + T - T0), or Arrhenius."""
    match card.shift:
        case None:
            return []
        case WLF(reference_temperature=T, c1=c1, c2=c2):
            return ["** temperatures in kelvin", "*TRS, DEFINITION=WLF", f"{T!r}, {c1!r}, {c2!r}"]
        case Arrhenius(reference_temperature=T, activation_energy=energy):
            return [
                "** temperatures in kelvin, energy in J/mol; the model needs *PHYSICAL CONSTANTS,",
                "** ABSOLUTE ZERO=0., UNIVERSAL GAS CONSTANT=8.31446",
                "*TRS, DEFINITION=ARRHENIUS",
                f"{T!r}, {energy!r}",
            ]
        case _:
            return ["** *TRS does not support a shift table: fit a WLF or Arrhenius law"]


def read(text: str, units: Units | None) -> Prony:
    """Read the series of the first ``*VISCOELASTIC`` with its ``*ELASTIC``."""
    unit = units_of(text, units)
    keyword, instantaneous = "", False
    elastic: tuple[float, float] | None = None
    rows: list[tuple[int, float, float, float]] = []
    for line, raw in enumerate(text.splitlines(), 1):
        words = raw.strip()
        if not words or words.startswith("**"):
            continue
        if words.startswith("*"):
            command = words.upper().replace(" ", "")
            if command.startswith("*MATERIAL"):
                if rows:
                    break
                elastic = None  # it belonged to another material
            keyword = command.split(",")[0]
            if keyword == "*ELASTIC":
                instantaneous = "MODULI=INSTANTANEOUS" in command
            if keyword == "*VISCOELASTIC" and "TIME=PRONY" not in command:
                raise InputError(f"line {line}: expected TIME=PRONY, got {words!r}")
            continue
        if keyword not in ("*ELASTIC", "*VISCOELASTIC"):
            continue
        values = [number(w, line, "a value") if w.strip() else 0.0 for w in words.split(",")]
        if keyword == "*ELASTIC" and elastic is None and len(values) >= 2:
            elastic = (values[0], values[1])
        elif keyword == "*VISCOELASTIC":
            if len(values) < 3:
                raise InputError(f"line {line}: expected g_i, k_i, tau_i, got {words!r}")
            rows.append((line, values[0], values[1], values[2]))
    if elastic is None:
        raise InputError("there is no *ELASTIC with Young's modulus and Poisson ratio")
    modulus, nu = as_told(text, *elastic)
    for line, g, k, _ in rows:
        if nu != 0.5 and abs(g - k) > 1e-6 * max(g, k):
            other_bulk(line, g, k)
    ratios = [(g, time * unit.second) for _, g, _, time in rows]
    return from_ratios(modulus * unit.pascal, ratios, nu, instantaneous=instantaneous)
