"""The command of a pad: a flat punch on a layer, and what the theory says of its thickness."""

import json
from collections.abc import Mapping
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from typer import Option

from viscotack.errors import InputError
from viscotack.geometry import Base, Bonded, FlatPunch, Frictionless
from viscotack.materials import Elastic, Material
from viscotack.materials.passport_file import read_passport
from viscotack.operations.declare.questions import PUNCH, material_from, require
from viscotack.pictures import plot
from viscotack.problem.case_file import read_case
from viscotack.problem.units import material_in_si
from viscotack.theory import CrackLaw, punch
from viscotack.theory.punch import Pad
from viscotack.units import parse

from .commands import (
    AsJson,
    CaseFile,
    wrong_input,
)
from .options import Exponent, Ratio, flag
from .theory import theory
from .writing import Writing, check_files

# Of a regime map: thicknesses and speeds, and how thin and thick it gets beside b0 and a.
_ROWS, _THIN, _THICK = 121, 0.3, 5.0
# Of the way from the slow to the fast energy of a crack, where the speeds of a map begin and end.
_SLOW, _FAST = 0.003, 0.99

Solid = Annotated[
    str | None,
    flag(
        "--material",
        "MATERIAL",
        "sls (also when left out): standard linear solid, tau0 is its retardation time. power-law, "
        "elastic, prony:FILE and FILE.toml as for simulate sphere.",
    ),
]
_GLUED = next(question.words for question in PUNCH.questions if question.name == "bonded")
Glued = Annotated[float | None, flag("--bonded", "NU", _GLUED)]


class Law(StrEnum):
    """Which theory of the moving crack."""

    GREENWOOD = "greenwood"
    PERSSON_BRENER = "persson-brener"


def _given(flags: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in flags.items() if value is not None}


def _base(given: Mapping[str, Any]) -> Base:
    return Bonded(poisson_ratio=given["bonded"]) if "bonded" in given else Frictionless()


@theory.command("punch")
def theory_punch(
    case: CaseFile = None,
    half_width: Annotated[
        str | None, flag("--half-width", "LENGTH", 'Half width of the punch a, "1 mm".')
    ] = None,
    thickness: Annotated[
        str | None,
        flag("--thickness", "LENGTH", 'Thickness of the layer b, "200 um": what does it hold?'),
    ] = None,
    stress: Annotated[
        str | None,
        flag(
            "--stress",
            "PRESSURE",
            'Or: wanted pull-off stress, "30 kPa": how thick must the layer be?',
        ),
    ] = None,
    speed: Annotated[str | None, flag("--speed", "SPEED", 'Retraction speed, "100 um/s".')] = None,
    contact_modulus: Annotated[
        str | None, flag("--contact-modulus", "PRESSURE", 'E0* = E0/(1 - nu^2), "1 MPa".')
    ] = None,
    work_of_adhesion: Annotated[
        str | None, flag("--work-of-adhesion", "ENERGY", 'dg0, "50 mJ/m^2".')
    ] = None,
    strength: Annotated[
        str | None, flag("--strength", "PRESSURE", 'Of the interface, sigma0, "50 kPa".')
    ] = None,
    bonded: Glued = None,
    material: Solid = None,
    modulus_ratio: Ratio = None,
    exponent: Exponent = None,
    tau0: Annotated[
        str | None, flag("--tau0", "TIME", 'Time of the material, "1 ms" (not for prony:FILE).')
    ] = None,
    law: Annotated[
        Law, Option("--theory", help="Theory of the moving crack.", show_default=True)
    ] = Law.GREENWOOD,
    with_map: Annotated[
        bool,
        Option("--map", help="Add to the JSON how the pad comes off by thickness and speed."),
    ] = False,
    plot_file: Annotated[
        Path | None,
        Option("--plot", metavar="FILE", help="Draw that map to a .png, .pdf or .svg file."),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Flat punch on a layer: how thick must a pad be, and what does it hold.

    Without simulation, and up to 19 % high in stress against simulations. Stated in SI, by flags or
    by a file.

    Example: viscotack theory punch --half-width "1 mm" --contact-modulus "1 MPa"
    --work-of-adhesion "50 mJ/m^2" --strength "50 kPa" --modulus-ratio 0.1 --tau0 "1 ms"
    --speed "100 um/s" --stress "30 kPa"
    """
    flags = {
        "half-width": half_width,
        "contact-modulus": contact_modulus,
        "work-of-adhesion": work_of_adhesion,
        "strength": strength,
        "bonded": bonded,
        "material": material,
        "modulus-ratio": modulus_ratio,
        "exponent": exponent,
        "tau0": tau0,
    }
    asked = {"thickness": thickness, "stress": stress, "speed": speed}
    with wrong_input():
        check_files({"--plot": plot_file}, reads=(case,))
        pad, solid, wanted = _stated_pad(case, flags, asked)
        crack = pad.crack_law(law, material=solid)
        answer = _boundaries(pad, crack) | _asked(pad, crack, wanted)
        found = _map(pad, crack) if with_map or plot_file is not None else None
    write = Writing()
    if found is not None:
        write.picture(plot_file, lambda: plot.draw_regimes(found))
    if as_json:
        rows = {} if not with_map or found is None else {"map": _rows(found)}
        write.answer(json.dumps(answer | rows, indent=2, allow_nan=False))
    else:
        write.answer("\n".join(_line(name, value) for name, value in answer.items()))
    write.end()


def _line(name: str, value: Any) -> str:
    words = "none" if value is None else value if isinstance(value, str) else f"{value:.5g}"
    return f"  {name:<36}{words:>12}"


def _stated_pad(
    case: Path | None, flags: Mapping[str, Any], asked: Mapping[str, Any]
) -> tuple[Pad, Material, dict[str, float]]:
    """Return the pad and its solid in SI, and what is asked."""
    units = {"thickness": "m", "stress": "Pa", "speed": "m/s"}
    wanted = {name: _quantity(name, text, units[name]) for name, text in _given(asked).items()}
    if "thickness" in wanted and "stress" in wanted:
        raise InputError("give --thickness or --stress, not both: one answers the other")
    if case is None:
        pad, solid = _pad_from_flags(_given(flags))
    else:
        problem = _pad_problem(case, flags)
        pad, solid = _pad_of(problem), problem.material
        stated = {"speed": problem.protocol.speed}
        if "stress" not in wanted:
            stated["thickness"] = problem.body.thickness
        wanted = _given(stated) | wanted
    if wanted.keys() & {"thickness", "stress"} and "speed" not in wanted:
        raise InputError('--speed missing, the retraction speed; for example --speed "100 um/s"')
    return pad, solid, wanted


def _pad_problem(case: Path, flags: Mapping[str, Any]) -> Any:
    given = [f"--{name}" for name in _given(flags)]
    if given:
        raise InputError(f"{case} states the whole problem; leave out {', '.join(given)}")
    problem = read_case(case)
    if not isinstance(problem.geometry, FlatPunch):
        raise InputError(f"{case} states a {problem.geometry.word}, which has commands of its own")
    return problem


def _quantity(name: str, text: str, unit: str) -> float:
    try:
        return parse(text, unit)
    except ValueError as error:
        raise InputError(f"--{name}: {error}") from None


def _pad_of(problem: Any) -> Pad:
    return Pad(
        half_width=problem.geometry.half_width,
        contact_modulus=problem.material.contact_modulus,
        work_of_adhesion=problem.traction.work_of_adhesion,
        strength=problem.traction.strength,
        base=problem.body.base,
    )


def _pad_from_flags(given: dict[str, Any]) -> tuple[Pad, Material]:
    needed = {"half-width": "m", "work-of-adhesion": "J/m^2", "strength": "Pa"}
    passport = str(given.get("material", "")).endswith(".toml")
    if not passport:
        needed["contact-modulus"] = "Pa"
    require(given, needed)
    stated = {
        name.replace("-", "_"): _quantity(name, given[name], unit) for name, unit in needed.items()
    }
    if passport:
        solid = read_passport(given["material"]).material
        stated["contact_modulus"] = solid.contact_modulus
    else:
        solid = _solid_in_si(given, stated["contact_modulus"])
    return Pad(**stated, base=_base(given)), solid


def _solid_in_si(given: Mapping[str, Any], contact_modulus: float) -> Material:
    solid, unit = material_from({"material": "sls", **given})
    if isinstance(solid, Elastic):
        time = 1.0
    elif unit == "1":
        require(given, ["tau0"])
        time = _quantity("tau0", given["tau0"], "s")
    else:
        time = parse(f"1 {unit}", "s")
    # only times and ratios of it are used
    return material_in_si(solid, contact_modulus, time, 0.0)


def _boundaries(pad: Pad, law: CrackLaw) -> dict[str, Any]:
    """Return where the ways to come off meet."""
    b0, fast, b1 = punch.regime_thicknesses(pad, modulus_ratio=law.material.modulus_ratio)
    return {
        "cohesive_below_m": b0,
        "cohesive_when_fast_below_m": fast,
        "half_plane_above_m": b1,
    }


def _asked(pad: Pad, law: CrackLaw, wanted: Mapping[str, float]) -> dict[str, Any]:
    """Return the thickness for a stress, or the state at pull-off of a thickness."""
    if "stress" in wanted:
        b = punch.thickness_at_speed(wanted["stress"], pad, law, speed=wanted["speed"])
        return {"thickness_m": b}
    if "thickness" not in wanted:
        return {}
    b, speed = wanted["thickness"], wanted["speed"]
    found = punch.regime_map([b], [speed], pad, law)
    state = punch.pull_off(speed, pad, law, thickness=b)
    slow = float(pad.elastic_stress(b))
    fast = slow / law.material.modulus_ratio**0.5
    running = np.isfinite(state.crack_speed)
    return {
        "regime": str(found.regime[0, 0]),
        "pull_off_stress_Pa": state.stress,
        "slowest_pull_off_stress_Pa": min(slow, pad.strength),
        "fastest_pull_off_stress_Pa": min(fast, pad.strength),
        "pull_off_depth_m": state.depth,
        "ligament_at_pull_off_m": state.ligament,
        "crack_speed_at_pull_off_m_per_s": state.crack_speed if running else None,
        "effective_surface_energy": state.amplification,
    }


def _map(pad: Pad, law: CrackLaw) -> punch.RegimeMap:
    """Return how the pad comes off, over the thicknesses and speeds that matter to it."""
    a = pad.half_width
    if law.largest == 1:
        raise InputError("an elastic layer comes off in the same way at every speed: no map")
    cracks = law.speed(1 + np.array([_SLOW, _FAST]) * (law.largest - 1))
    # a punch moved by the depth of its pull-off while the cracks run through it
    slow, fast = np.asarray(cracks) * -pad.elastic_depth(a) / a
    speed = np.geomspace(slow, fast, _ROWS)
    thinnest = min(_THIN * float(_boundaries(pad, law)["cohesive_below_m"]), 0.1 * a)
    return punch.regime_map(np.geomspace(thinnest, _THICK * a, _ROWS), speed, pad, law)


def _rows(found: punch.RegimeMap) -> dict[str, Any]:
    return {
        "thickness_m": found.thickness.tolist(),
        "speed_m_per_s": found.speed.tolist(),
        "regime": found.regime.tolist(),
        "pull_off_stress_Pa": found.stress.tolist(),
    }
