"""The command of the steady crack: its energy at a speed, and how far simpler theories are off."""

import re
from typing import Annotated, Any

import numpy as np
from typer import Option

from viscotack.errors import InputError
from viscotack.operations.declare.questions import SCALES, SPHERE, material_from, require
from viscotack.problem.law_table import law_from_words
from viscotack.theory.crack.steady import Comparison, SteadyCrack, compared
from viscotack.theory.crack.steady.comparison import THESIS_RATIO
from viscotack.traction import LennardJones, grows
from viscotack.units import finite, parse, positive

from .commands import AsJson, PlotFile, wrong_input
from .options import Exponent, Ratio, flag
from .theory import Material, answer_with, theory
from .writing import check_files

# Of a table over the range that matters: parts of ln Gamma between the slowest and the fastest.
_ROWS, _PARTS = 41, (0.005, 0.995)
_LAW = next(question.words for question in SPHERE.questions if question.name == "law")
_SCALES = ("contact-modulus", "work-of-adhesion", "equilibrium-gap", "tau0")
_THEORIES = ("persson_brener", "greenwood", "slow", "fast")


def _scale(name: str) -> Any:
    return flag(
        f"--{name}", SCALES[name].unit, f"For an answer in SI as well: {SCALES[name].words}."
    )


Speed = Annotated[
    list[str] | None,
    Option(
        "--speed",
        metavar="V",
        help="Crack speed in E0* h0^2/(dg tau), tau the time of the material, negative where the "
        "crack closes; with the scales of SI also as '10 um/s'. Repeat it for more. Without it a "
        "table over the range that matters.",
    ),
]


@theory.command("steady-crack")
def theory_steady_crack(
    material: Material = None,
    modulus_ratio: Ratio = None,
    exponent: Exponent = None,
    speed: Speed = None,
    law: Annotated[str | None, flag("--law", "LAW", _LAW)] = None,
    strength_ratio: Annotated[
        float,
        Option("--strength-ratio", metavar="ALPHA", help="Alpha of Persson and Brener's length."),
    ] = THESIS_RATIO,
    contact_modulus: Annotated[str | None, _scale("contact-modulus")] = None,
    work_of_adhesion: Annotated[str | None, _scale("work-of-adhesion")] = None,
    equilibrium_gap: Annotated[str | None, _scale("equilibrium-gap")] = None,
    tau0: Annotated[str | None, _scale("tau0")] = None,
    plot_file: PlotFile = None,
    as_json: AsJson = False,
) -> None:
    """Effective over intrinsic surface energy of a steady crack with its whole traction law.

    Beside it by which part Persson-Brener, Greenwood and the slow and fast asymptotes are off.
    A material without --material and without --exponent is the standard solid.

    Example: viscotack theory steady-crack --modulus-ratio 0.1 --speed 10, or: viscotack theory
    steady-crack --modulus-ratio 0.1 --exponent 0.6 --law exponential:0.25 --speed -1 --json
    """
    flags = {
        "material": "sls" if material is None and exponent is None else material,
        "modulus-ratio": modulus_ratio,
        "exponent": exponent,
    }
    scales: dict[str, str | None] = dict(
        zip(_SCALES, (contact_modulus, work_of_adhesion, equilibrium_gap, tau0), strict=True)
    )
    with wrong_input():
        check_files({"--plot": plot_file})
        solid, _ = material_from({k: v for k, v in flags.items() if v is not None})
        crack = SteadyCrack(solid, law_from_words(law or LennardJones.word))
        units = _units(scales)
        v = _speeds(speed, crack, units)
        answer, curves = _answer(crack, v, units, positive("--strength-ratio", strength_ratio, "1"))
    labels = ("speed [E0* h0^2/(dg tau)]", "amplification")
    answer_with(answer, (np.abs(v), curves), labels, as_json, plot_file, logarithmic=True)


def _units(scales: dict[str, str | None]) -> tuple[float, float] | None:
    """Return the units of length [m] and speed [m/s], or None where no scale is given."""
    given = {name: value for name, value in scales.items() if value is not None}
    if not given:
        return None
    require(given, _SCALES, " for an answer in SI")
    E, w, h0, tau = (
        positive(f"--{name}", parse(given[name], SCALES[name].unit), SCALES[name].unit)
        for name in _SCALES
    )
    length = E * h0**2 / w
    return length, length / tau


def _speeds(
    given: list[str] | None, crack: SteadyCrack, units: tuple[float, float] | None
) -> np.ndarray:
    if given:
        return np.array([_one_speed(text, units) for text in given])
    if crack.largest == 1:
        raise InputError("an elastic solid has an amplification of 1 at every speed")
    low, high = np.asarray(crack.speed(crack.largest ** np.array(_PARTS)))
    return np.geomspace(low, high, _ROWS)


def _one_speed(text: str, units: tuple[float, float] | None) -> float:
    if re.fullmatch(r"[-+0-9.eE]+", text.strip()):
        return finite("--speed", text, "1")
    if units is None:
        names = ", ".join(f"--{name}" for name in _SCALES)
        raise InputError(f"--speed {text!r} has a unit; it needs {names}")
    return parse(text, "m/s") / units[1]


def _answer(
    crack: SteadyCrack, v: np.ndarray, units: tuple[float, float] | None, strength_ratio: float
) -> tuple[dict[str, Any], np.ndarray]:
    """Return the table, columns of lists, and the curves that are drawn."""
    gamma = np.asarray(crack.amplification(v))
    profiles = [crack.at(speed) for speed in v]
    zone = np.array([profile.zone_length for profile in profiles])
    law: Any = crack.traction
    # the other theories are of cracks that open, with an interface at rest
    rest = SteadyCrack(crack.material, law.at_rest) if grows(law) else crack
    found = compared(rest, np.where(v > 0, v, 1.0), strength_ratio=strength_ratio)
    comparable = (v > 0) & (not grows(law))
    off = {name: np.where(comparable, found.off(name), np.nan) for name in _THEORIES}
    table: dict[str, np.ndarray] = {
        "speed": v,
        "amplification": gamma,
        "error_estimate": np.asarray(crack.error(v)),
        "zone_length": zone,
        "heat": np.array([profile.heat for profile in profiles]),
    }
    if grows(law):
        table["interface_heat"] = np.array([profile.interface_heat for profile in profiles])
    if units is not None:
        table |= {"speed_m_per_s": v * units[1], "zone_length_m": zone * units[0]}
    table |= {f"{name}_off": values for name, values in off.items()}
    listed = {
        name: [None if np.isnan(x) else float(x) for x in values] for name, values in table.items()
    }
    return listed, np.stack([gamma, *(_drawn(found, name, v) for name in _THEORIES[:2])], axis=-1)


def _drawn(found: Comparison, name: str, v: np.ndarray) -> np.ndarray:
    return np.where(v > 0, getattr(found, name), np.nan)
