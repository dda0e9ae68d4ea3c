"""Tamaas: shear moduli and characteristic times of ``MaxwellViscoelastic``, as Python lines.

Young's modulus and Poisson ratio of the model are the long-term ones. Tamaas has no units: the
lengths of the model must be consistent with the unit of pressure.
"""

import ast

from viscotack.errors import InputError
from viscotack.materials.branched_solids import Prony
from viscotack.materials.exchange.units import Card, Units, head, series, shear_factor, units_of

_NAMES = ("model.E", "model.nu", "shear_moduli", "characteristic_times")


def written(card: Card, units: Units, notes: tuple[str, ...]) -> str:
    """Format assignments to paste before ``MaxwellViscoelastic(model, ..., shear_moduli=...)``."""
    material = card.material
    factor = shear_factor(material.poisson_ratio) / units.pascal
    values = (
        material.rubbery_modulus / units.pascal,
        material.poisson_ratio,
        [E * factor for E, _ in material.branches],
        [time / units.second for _, time in material.branches],
    )
    lines = head("#", units, notes)
    lines += [f"{name} = {value!r}" for name, value in zip(_NAMES, values, strict=True)]
    return "\n".join(lines) + "\n"


def read(text: str, units: Units | None) -> Prony:
    """Read the series from four assignments of plain numbers; nothing is executed."""
    unit = units_of(text, units)
    found = {}
    try:
        tree = ast.parse(text)
    except SyntaxError as error:
        raise InputError(f"line {error.lineno}: this is not valid Python") from None
    for node in tree.body:
        if isinstance(node, ast.Assign) and len(node.targets) == 1:
            name = ast.unparse(node.targets[0])
            if name in _NAMES:
                try:
                    found[name] = ast.literal_eval(node.value)
                except ValueError:
                    raise InputError(
                        f"line {node.lineno}: {name} must be plain numbers, got "
                        f"{ast.unparse(node.value)!r}"
                    ) from None
    missing = [name for name in _NAMES if name not in found]
    if missing:
        raise InputError(f"{' and '.join(missing)} missing")
    modulus, nu, moduli, times = (found[name] for name in _NAMES)
    try:
        pairs = [(float(G), float(t)) for G, t in zip(moduli, times, strict=True)]
        modulus, nu = float(modulus), float(nu)
    except (TypeError, ValueError):
        raise InputError(
            "shear_moduli and characteristic_times must be lists of equal length"
        ) from None
    factor = shear_factor(nu)
    branches = [(G * unit.pascal / factor, time * unit.second) for G, time in pairs]
    return series(modulus * unit.pascal, branches, nu)
