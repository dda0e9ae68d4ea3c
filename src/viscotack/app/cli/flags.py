"""The flags of ``viscotack simulate sphere`` as a problem: which go together, what is missing."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from viscotack.materials import Elastic, Material, Prony, RetardationPowerLaw, StandardSolid
from viscotack.materials.passport_file import read_passport
from viscotack.problem import Groups, Problem
from viscotack.problem.case_file import read_prony
from viscotack.problem.traction_file import law_from_words
from viscotack.protocol import Apart, AtDepth, AtForce, AtRadius, Start
from viscotack.protocol.words import PURE_NUMBERS, move_from_words
from viscotack.units import finite, parse, positive

_STARTS = {
    "preload": AtDepth,
    "preload-force": AtForce,
    "preload-radius": AtRadius,
    "apart": Apart,
}
# Contact radius of the start, in the unit of --preload-radius: a mesh for more has no end.
_LARGEST_START = 1000.0
_SCALES = {
    "radius": ("m", '"5.19 mm"'),
    "contact-modulus": ("Pa", '"1.94 MPa"'),
    "equilibrium-gap": ("m", '"1.55 um"'),
    "work-of-adhesion": ("J/m^2", '"0.1523 J/m^2"'),
    "tau0": ("s", '"18.76 ms"'),
    "poisson-ratio": ("1", "0.5"),
}


def problem_from_flags(flags: Mapping[str, Any]) -> Groups | Problem:
    """Return the problem that the flags state: dimensionless, or in SI when scales are given.

    Parameters
    ----------
    flags : mapping
        Names without dashes in front, such as ``"preload-force"``; None where not given.

    Raises
    ------
    ValueError
        If a flag is missing, does not go with another, or is impossible.
    """
    given = {name: value for name, value in flags.items() if value is not None}
    given |= _scales_of_passport(given)
    material, unit = material_from_flags(given)
    elastic = isinstance(material, Elastic)
    # An elastic solid has no time of its own: without a rate the time unit of a dimensionless
    # answer is that in which the drive travels h0. Seconds need a speed.
    timeless = elastic and not given.keys() & _SCALES.keys()
    moves = tuple(move_from_words(words, PURE_NUMBERS) for words in given.get("move", ()))
    require(given, ["tabor"] if timeless or moves else ["tabor", "rate"])
    rate = given.get("rate", None if moves else 1.0)
    stiffness = given.get("stiffness")
    tabor = positive("--tabor", given["tabor"], "1")
    groups = Groups(
        tabor=tabor,
        material=material,
        start=_start(given, tabor),
        rate=None if rate is None else positive("--rate", rate, "1"),
        traction=law_from_words(given.get("law", "lennard-jones")),
        moves=moves,
        stiffness=None if stiffness is None else positive("--stiffness", stiffness, "1"),
    )
    if not given.keys() & _SCALES.keys():
        return groups
    return _in_si(groups, given, "s" if elastic else unit)


def material_from_flags(given: Mapping[str, Any]) -> tuple[Material, str]:
    """Return the reduced material, and the unit of its times if a file states one, else "1"."""
    name = given.get("material", "power-law")
    if name.endswith(".toml"):
        for flag in ("modulus-ratio", "exponent"):
            if flag in given:
                raise ValueError(f"{name} states the whole material; leave out --{flag}")
        return read_passport(name).material.reduced(), "1"
    kind, _, file = name.partition(":")
    needs = {"power-law": ["modulus-ratio", "exponent"], "sls": ["modulus-ratio"]}
    if (kind not in ("power-law", "sls", "elastic", "prony")) or (kind == "prony") != bool(file):
        raise ValueError(
            "--material must be a passport FILE.toml, power-law, elastic, sls or prony:FILE, "
            f"got {name!r}"
        )
    require(given, needs.get(kind, []), f" for --material {kind}")
    for flag in ("modulus-ratio", "exponent"):
        if flag in given and flag not in needs.get(kind, []):
            raise ValueError(f"--{flag} does not go with --material {kind}; leave it out")
    solid: dict[str, float] = {"rubbery_modulus": 1.0, "poisson_ratio": 0.0}
    if kind == "elastic":
        return Elastic(**solid), "1"
    if kind == "prony":
        branches, unit = read_prony(file)
        return Prony(**solid, branches=branches), unit
    k = positive("--modulus-ratio", given["modulus-ratio"], "1")
    if k > 1:
        raise ValueError(
            f"--modulus-ratio is the rubbery over the glassy modulus, in (0, 1], got {k:g}; "
            f"perhaps {1 / k:.4g} is meant"
        )
    solid |= {"glassy_modulus": 1 / k, "tau0": 1.0}
    if kind == "sls":
        return StandardSolid(**solid), "1"
    return RetardationPowerLaw(
        **solid, exponent=positive("--exponent", given["exponent"], "1")
    ), "1"


def _scales_of_passport(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a passport says of the scales, where the answer is wanted in SI."""
    name = given.get("material", "")
    if not name.endswith(".toml") or not given.keys() & _SCALES.keys():
        return {}
    for flag in ("contact-modulus", "poisson-ratio", "tau0"):
        if flag in given:
            raise ValueError(f"{name} states the whole material; leave out --{flag}")
    solid = read_passport(name).material
    scales = {
        "contact-modulus": f"{solid.contact_modulus!r} Pa",
        "poisson-ratio": solid.poisson_ratio,
    }
    return scales if isinstance(solid, Elastic) else scales | {"tau0": f"{solid.time_unit!r} s"}


def _start(given: Mapping[str, Any], tabor: float) -> Start | Apart:
    name = one_of(given, _STARTS)
    kind = _STARTS[name]
    checked = positive if kind in (AtRadius, Apart) else finite
    value = checked(f"--{name}", given[name], "1")
    # a large contact is Hertz's
    radius = {
        AtDepth: (max(value, 0.0) / tabor) ** (1 / 2) / np.cbrt(np.pi),
        AtForce: (9 / 8 * max(value, 0.0)) ** (1 / 3),
        AtRadius: value,
        Apart: 0.0,
    }[kind]
    if radius > _LARGEST_START:
        raise ValueError(
            f"--{name} {value:g} is a contact of radius {radius:.3g} (pi R^2 dg0/E0*)^(1/3), and "
            f"a simulation takes up to {_LARGEST_START:g}; give less"
        )
    return kind(value)


def _in_si(groups: Groups, given: Mapping[str, Any], unit: str) -> Problem:
    """Return the problem in SI; `unit` is the unit of time, or "1" where --tau0 must tell it."""
    lengths = [name for name in ("equilibrium-gap", "work-of-adhesion") if name in given]
    if len(lengths) != 1:
        raise ValueError(
            "for SI give exactly one of --equilibrium-gap and --work-of-adhesion, "
            f"got {'both' if lengths else 'none'}; the Tabor number tells the other"
        )
    needed = ["radius", "contact-modulus", "poisson-ratio", *(["tau0"] if unit == "1" else [])]
    require(given, needed, " to go to SI")
    if unit != "1" and "tau0" in given:
        raise ValueError(f"--tau0 is not needed, the unit of time is {unit}; leave it out")
    scales = {}
    for name, (si, example) in _SCALES.items():
        if name in given:
            try:
                scales[name.replace("-", "_")] = parse(given[name], si)
            except ValueError as error:
                raise ValueError(f"--{name}: {error}; for example --{name} {example}") from None
    time_unit = scales.pop("tau0", None)
    if time_unit is None:
        time_unit = parse(f"1 {unit}", "s")
    return groups.in_si(**scales, time_unit=time_unit)


def one_of(given: Mapping[str, Any], names: Iterable[str]) -> str:
    """Return which one of some flags is given; refuse none and several."""
    found = [name for name in names if name in given]
    if len(found) != 1:
        got = " and ".join(f"--{name}" for name in found) or "none"
        known = ", ".join(f"--{name}" for name in names)
        raise ValueError(f"give exactly one of {known}, got {got}")
    return found[0]


def require(given: Mapping[str, Any], names: Iterable[str], why: str = "") -> None:
    """Refuse flags of which some are missing, and say which."""
    missing = [f"--{name}" for name in names if name not in given]
    if missing:
        raise ValueError(f"{' and '.join(missing)} missing{why}; --help says what they are")
