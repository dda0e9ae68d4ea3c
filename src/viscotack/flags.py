"""The flags of ``viscotack simulate sphere`` as a problem: which go together, what is missing."""

from collections.abc import Mapping
from typing import Any

from .case_file import read_prony
from .materials import Elastic, Material, Prony, RetardationPowerLaw, StandardSolid
from .problem import Groups, Problem
from .protocol import AtDepth, AtForce, AtRadius, Start
from .units import parse, positive

_PRELOADS = {"preload": AtDepth, "preload-force": AtForce, "preload-radius": AtRadius}
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
    material, unit = material_from_flags(given)
    elastic = isinstance(material, Elastic)
    # An elastic solid has no time of its own: without a rate the time unit of a dimensionless
    # answer is that in which the drive travels h0. Seconds need a speed.
    timeless = elastic and not given.keys() & _SCALES.keys()
    _require(given, ["tabor"] if timeless else ["tabor", "rate"])
    groups = Groups(
        tabor=positive("--tabor", given["tabor"], "1"),
        material=material,
        start=_start(given),
        rate=positive("--rate", given.get("rate", 1.0), "1"),
    )
    if not given.keys() & _SCALES.keys():
        return groups
    return _in_si(groups, given, "s" if elastic else unit)


def material_from_flags(given: Mapping[str, Any]) -> tuple[Material, str]:
    """Return the reduced material, and the unit of its times if a file states one, else "1"."""
    name = given.get("material", "power-law")
    kind, _, file = name.partition(":")
    needs = {"power-law": ["modulus-ratio", "exponent"], "sls": ["modulus-ratio"]}
    if (kind not in ("power-law", "sls", "elastic", "prony")) or (kind == "prony") != bool(file):
        raise ValueError(f"--material must be power-law, elastic, sls or prony:FILE, got {name!r}")
    _require(given, needs.get(kind, []), f" for --material {kind}")
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


def _start(given: Mapping[str, Any]) -> Start:
    names = [name for name in _PRELOADS if name in given]
    if len(names) != 1:
        got = " and ".join(f"--{name}" for name in names) or "none"
        raise ValueError(
            f"give exactly one of {', '.join(f'--{name}' for name in _PRELOADS)}, got {got}"
        )
    return _PRELOADS[names[0]](given[names[0]])


def _in_si(groups: Groups, given: Mapping[str, Any], unit: str) -> Problem:
    """Return the problem in SI; `unit` is the unit of time, or "1" where --tau0 must tell it."""
    if ("equilibrium-gap" in given) == ("work-of-adhesion" in given):
        raise ValueError("for SI give --equilibrium-gap or --work-of-adhesion, not both")
    needed = ["radius", "contact-modulus", "poisson-ratio", *(["tau0"] if unit == "1" else [])]
    _require(given, needed, " to go to SI")
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


def _require(given: Mapping[str, Any], names: list[str], why: str = "") -> None:
    missing = [f"--{name}" for name in names if name not in given]
    if missing:
        raise ValueError(
            f"{' and '.join(missing)} missing{why}; see viscotack simulate sphere --help"
        )
