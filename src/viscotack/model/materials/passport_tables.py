"""Format a passport as the text of its TOML file, with all digits."""

from dataclasses import fields
from typing import Any

from viscotack.cards import Pairs, cards
from viscotack.files.toml import toml_value
from viscotack.model.materials.branched_solids import Prony, StandardSolid
from viscotack.model.materials.conversion import prony_form, relaxation_form, retardation_series
from viscotack.model.materials.passport import Passport
from viscotack.model.materials.shift import WLF, Arrhenius, FittedShift, Shift, TabulatedShift
from viscotack.model.materials.words import units_of, word_of

VERSION = 1
_NOT_EXACT = 1e-3  # relative error of the Prony series written for a power law
_TIMES = {
    "elastic": "none",
    "sls": "tau0 is the retardation time",
    "prony": "branches have relaxation times",
    "power-law": "tau0 is the characteristic retardation time",
    "relaxation-power-law": "tau0 is the characteristic relaxation time",
    "fractional-zener": "tau0 is the retardation time",
}
_OWN_TIMES = "as the class of the model defines them"


def passport_text(passport: Passport) -> str:
    """Format a passport as the text of its file."""
    lines = [
        "# A material and its papers, written by viscotack. Moduli are Young's moduli.",
        f"passport = {VERSION}",
        f"name = {toml_value(passport.name)}",
    ]
    for name, values in _tables(passport).items():
        if values:
            lines += ["", f"[{name}]", *(f"{key} = {toml_value(v)}" for key, v in values.items())]
    for solid in passport.allowed:
        rows = _solid(solid).items()
        lines += ["", "[[allowed]]", *(f"{key} = {toml_value(v)}" for key, v in rows)]
    return "\n".join(lines) + "\n"


def _tables(passport: Passport) -> dict[str, dict[str, Any]]:
    """Return the tables of the file, without empty ones."""
    solid = _solid(passport.material)
    convention = {
        "modulus": "E",
        "measured": passport.measured or "not stated",
        "times": _TIMES.get(solid["model"], _OWN_TIMES),
    }
    temperature: dict[str, Any] = {}
    if passport.temperature is not None:
        temperature["reference"] = _quantity(passport.temperature, "K")
    if passport.temperatures is not None:
        temperature["measured"] = [_quantity(T, "K") for T in passport.temperatures]
    if passport.shift is not None:
        temperature |= _shift_words(passport.shift)
    bounds = passport.frequencies
    return {
        "material": solid,
        "convention": convention,
        "temperature": temperature,
        "nearest_law": _fitted_words(passport.fitted_shift),
        "range": {"angular_frequency": [_quantity(w, "rad/s") for w in bounds]} if bounds else {},
        "origin": _plain(passport.origin),
        "evidence": _plain(passport.evidence) if passport.evidence else {},
        **_forms(passport),
    }


def _solid(material: Any) -> dict[str, Any]:
    """Return a material as the word of its model and its constants."""
    constants: dict[str, Any] = {
        name: _quantity(getattr(material, name), unit)
        for name, unit in units_of(type(material)).items()
    }
    for name, field in cards(type(material), Pairs).items():
        constants[name] = _pairs(getattr(material, name), *field.card.units)
    return {"model": word_of(material)} | constants


def _forms(passport: Passport) -> dict[str, dict[str, Any]]:
    """Return the relaxation and the retardation form as exponentials."""
    material = passport.material
    exact = isinstance(material, Prony | StandardSolid)
    error = 0.0
    if material.modulus_ratio == 1:
        return {}
    if exact:
        series = relaxation_form(material)
    elif passport.frequencies is not None:
        form = prony_form(material, frequencies=passport.frequencies, tolerance=_NOT_EXACT)
        series, error = form.material, form.error
    else:
        return {}
    creep = retardation_series(series)
    relaxation = {
        "largest_error": error,
        "rubbery_modulus": _quantity(series.rubbery_modulus, "Pa"),
        "branches": _pairs(series.branches, "Pa", "s"),
    }
    return {
        # [material] already contains the relaxation form of a Prony series
        "relaxation": {} if isinstance(material, Prony) else relaxation,
        "retardation": {
            "largest_error": error,
            "glassy_modulus": _quantity(creep.glassy_modulus, "Pa"),
            "elements": _pairs(creep.elements, "1/Pa", "s"),
        },
    }


def _shift_words(shift: Shift) -> dict[str, Any]:
    if isinstance(shift, TabulatedShift):
        rows = zip(shift.temperature, shift.values, strict=True)
        columns = {"uncertainty": list(shift.uncertainty), "vertical": list(shift.vertical)}
        return {
            "law": "table",
            "zero": _quantity(shift.reference_temperature, "K"),
            "shifts": [[_quantity(T, "K"), value] for T, value in rows],
        } | {key: values for key, values in columns.items() if values}
    return _law_words(shift)


def _law_words(law: WLF | Arrhenius) -> dict[str, Any]:
    constants = {key: _quantity(getattr(law, key), unit) for key, unit in law.units.items()}
    return {"law": law.word, "zero": _quantity(law.reference_temperature, "K")} | constants


def _fitted_words(fitted: FittedShift | None) -> dict[str, Any]:
    if fitted is None:
        return {}
    errors = {"standard_error": list(fitted.standard_error), "misfit": fitted.misfit}
    return _law_words(fitted.law) | errors


def _plain(record: Any) -> dict[str, Any]:
    """Return the non-empty fields of a record."""
    values = {field.name: getattr(record, field.name) for field in fields(record)}
    return {key: value for key, value in values.items() if value not in ("", (), None)}


def _quantity(value: float, unit: str) -> Any:
    """Format a number with its unit; repr keeps all digits."""
    return float(value) if unit == "1" else f"{float(value)!r} {unit}"


def _pairs(pairs: Any, first: str, second: str) -> list[list[str]]:
    return [[_quantity(a, first), _quantity(b, second)] for a, b in pairs]
