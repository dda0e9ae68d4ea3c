"""RheoJAX: the record of a ``GeneralizedMaxwell`` as from its ``to_dict``, in JSON.

Parameters ``G_inf``, ``G_1`` ..., ``tau_1`` ..., shear moduli [Pa] and times [s]. A model with the
same number of modes loads them by
``model.parameters = ParameterSet.from_dict(record["parameters"])``. Additional keys of this
package, ignored by RheoJAX, contain notes and the Poisson ratio.
"""

import json
from typing import Any

from viscotack.errors import InputError
from viscotack.materials.branched_solids import Prony
from viscotack.materials.exchange.units import Card, Units, refuse_units, series, shear_factor


def written(card: Card, units: Units, notes: tuple[str, ...]) -> str:
    """Format the record of the model."""
    refuse_units("RheoJAX", units)
    material = card.material
    factor = shear_factor(material.poisson_ratio)
    moduli = {"G_inf": material.rubbery_modulus * factor}
    moduli |= {f"G_{i}": E * factor for i, (E, _) in enumerate(material.branches, 1)}
    times = {f"tau_{i}": time for i, (_, time) in enumerate(material.branches, 1)}
    parameters = {name: _parameter(name, value, "Pa", 0.0) for name, value in moduli.items()}
    parameters |= {name: _parameter(name, value, "s", 1e-30) for name, value in times.items()}
    record = {
        "class": "GeneralizedMaxwell",
        "parameters": parameters,
        "fitted": True,
        "n_modes": len(material.branches),
        "poisson_ratio": material.poisson_ratio,
        "notes": [*notes, units.words()],
    }
    return json.dumps(record, indent=1) + "\n"


def read(
    text: str,
    units: Units | None,
    *,
    rubbery_modulus: float | None = None,
    poisson_ratio: float | None = None,
) -> Prony:
    """Read a record; it supplies the Poisson ratio if none is given."""
    if rubbery_modulus is not None:
        raise InputError("a record of RheoJAX states its modulus, G_inf; omit rubbery_modulus")
    if units is not None:
        refuse_units("RheoJAX", units)
    try:
        record = json.loads(text)
        values = {name: float(each["value"]) for name, each in record["parameters"].items()}
        nu = record.get("poisson_ratio") if poisson_ratio is None else poisson_ratio
        nu = None if nu is None else float(nu)
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError) as error:
        raise InputError(f"the text is not a record of a GeneralizedMaxwell: {error}") from None
    if nu is None:
        raise InputError("a record of RheoJAX lacks the Poisson ratio; give poisson_ratio")
    count = sum(name.startswith("tau_") for name in values)
    wanted = {"G_inf"} | {f"{what}_{i}" for what in ("G", "tau") for i in range(1, count + 1)}
    missing = wanted - values.keys()
    if missing:
        raise InputError(f"the record lacks {min(missing)}")
    factor = shear_factor(nu)
    pairs = [(values[f"G_{i}"] / factor, values[f"tau_{i}"]) for i in range(1, count + 1)]
    return series(values["G_inf"] / factor, [pair for pair in pairs if pair[0] > 0], nu)


def _parameter(name: str, value: float, unit: str, least: float) -> dict[str, Any]:
    # widen the bounds, because the model rejects values outside them and its defaults end at 1 GPa
    return {
        "name": name,
        "value": value,
        "bounds": [least, max(1e9, 10 * value)],
        "units": unit,
        "description": "",
    }
