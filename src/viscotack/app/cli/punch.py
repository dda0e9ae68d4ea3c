"""The commands of a flat punch on a layer: simulate it, or ask the theory how thick to make it."""

import json
from collections.abc import Mapping
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from typer import Option

from viscotack.geometry import Base, Bonded, Frictionless
from viscotack.materials import Elastic, Material
from viscotack.materials.passport_file import read_passport
from viscotack.pictures import plot
from viscotack.problem import material_in_si
from viscotack.problem.punch_problem import PunchGroups, PunchProblem
from viscotack.problem.traction_file import law_from_words
from viscotack.protocol import Apart, AtDepth, AtForce, Start
from viscotack.protocol.words import PURE_NUMBERS, move_from_words
from viscotack.theory import CrackLaw, punch
from viscotack.theory.punch import Pad
from viscotack.units import finite, parse

from .commands import (
    Accuracy,
    AsJson,
    CaseFile,
    CsvFile,
    Exponent,
    Gap,
    HowFar,
    LawName,
    Moves,
    PlotFile,
    PlotKind,
    PlotWhat,
    Rate,
    Ratio,
    SaveFile,
    Until,
    carry_out,
    check_files,
    flag,
    simulate,
    stated_problem,
    wrong_input,
)
from .flags import material_from_flags, one_of, require
from .theory import theory

_STARTS = {"preload": AtDepth, "preload-force": AtForce, "apart": Apart}
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
Glued = Annotated[
    float | None,
    flag(
        "--bonded",
        "NU",
        "The layer is glued to its base and has this Poisson ratio, 0 to 0.5; without it, it "
        "slides on its base.",
    ),
]


class Law(StrEnum):
    """Which theory of the moving crack."""

    GREENWOOD = "greenwood"
    PERSSON_BRENER = "persson-brener"


@simulate.command("punch")
def simulate_punch(
    case: CaseFile = None,
    size: Annotated[float | None, flag("--size", "A", "Half width of the punch, a/a0.")] = None,
    thickness: Annotated[
        float | None, flag("--thickness", "B", "Thickness of the layer, b/a0.")
    ] = None,
    cohesion: Annotated[
        float | None, flag("--cohesion", "S", "Strength of the interface, sigma0/E0*.")
    ] = None,
    bonded: Glued = None,
    material: Solid = None,
    modulus_ratio: Ratio = None,
    exponent: Exponent = None,
    preload: Annotated[
        float | None,
        flag("--preload", "DEPTH", "Relaxed start at this depth, in h0, positive into the layer."),
    ] = None,
    preload_force: Annotated[
        float | None,
        flag(
            "--preload-force",
            "STRESS",
            "Or: relaxed start under this mean stress, in sigma0, positive in compression.",
        ),
    ] = None,
    apart: Gap = None,
    move: Moves = None,
    stiffness: Annotated[
        float | None,
        flag("--stiffness", "K", "Of the machine, in sigma0/h0; rigid when left out."),
    ] = None,
    rate: Rate = None,
    law: LawName = None,
    until: HowFar = Until.DETACHED,
    accuracy: Accuracy = 2e-3,
    plot_file: PlotFile = None,
    plot_kind: PlotWhat = PlotKind.FORCE,
    csv_file: CsvFile = None,
    save_file: SaveFile = None,
    as_json: AsJson = False,
) -> None:
    """Pull a rigid flat punch off a soft viscoelastic layer.

    Plane strain. The problem is stated by dimensionless numbers, or in SI by a file. a is the half
    width of the punch, b the thickness of the layer, E0* the rubbery contact modulus, dg0 the work
    of adhesion, sigma0 the strength of the interface, h0 the equilibrium gap, tau0 the time of the
    material, and a0 = pi E0* dg0/(2 sigma0^2).

    Example: viscotack simulate punch --size 64.85 --thickness 3.24 --cohesion 0.05
    --modulus-ratio 0.1 --preload 1 --rate 10
    """
    flags = {
        "size": size,
        "thickness": thickness,
        "cohesion": cohesion,
        "bonded": bonded,
        "material": material,
        "modulus-ratio": modulus_ratio,
        "exponent": exponent,
        "preload": preload,
        "preload-force": preload_force,
        "apart": apart,
        "move": move,
        "stiffness": stiffness,
        "rate": rate,
        "law": law,
    }
    carry_out(
        lambda: stated_problem(case, flags, punch_from_flags, PunchProblem),
        accuracy=accuracy,
        until=until,
        files=(plot_file, csv_file, save_file),
        plot_kind=plot_kind,
        as_json=as_json,
    )


def punch_from_flags(flags: Mapping[str, Any]) -> PunchGroups:
    """Return the punch that the flags state.

    Parameters
    ----------
    flags : mapping
        Names without dashes in front, such as ``"preload-force"``; None where not given.

    Raises
    ------
    ValueError
        If a flag is missing, does not go with another, or is impossible.
    """
    given = _given(flags)
    solid, _ = material_from_flags({"material": "sls", **given})
    moves = tuple(move_from_words(words, PURE_NUMBERS) for words in given.get("move", ()))
    # An elastic solid has no time of its own, and its answer does not depend on the rate.
    timeless = isinstance(solid, Elastic)
    require(given, ["size", "thickness", "cohesion", *([] if timeless or moves else ["rate"])])
    return PunchGroups(
        size=given["size"],
        thickness=given["thickness"],
        cohesion=given["cohesion"],
        material=solid,
        start=_start(given),
        rate=given.get("rate", None if moves else 1.0),
        base=_base(given),
        traction=law_from_words(given.get("law", "lennard-jones")),
        moves=moves,
        stiffness=given.get("stiffness"),
    )


def _given(flags: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in flags.items() if value is not None}


def _start(given: Mapping[str, Any]) -> Start | Apart:
    name = one_of(given, _STARTS)
    return _STARTS[name](finite(f"--{name}", given[name], "1"))


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
        check_files(plot_file)
        pad, solid, wanted = _stated_pad(case, flags, asked)
        crack = pad.crack_law(law, material=solid)
        answer = _boundaries(pad, crack) | _asked(pad, crack, wanted)
        found = _map(pad, crack) if with_map or plot_file is not None else None
    if plot_file is not None and found is not None:
        plot.save_figure(plot.draw_regimes(found), plot_file)
        typer.echo(f"drew {plot_file}", err=True)
    if as_json:
        rows = {} if not with_map or found is None else {"map": _rows(found)}
        typer.echo(json.dumps(answer | rows, indent=2, allow_nan=False))
        return
    for name, value in answer.items():
        words = "none" if value is None else value if isinstance(value, str) else f"{value:.5g}"
        typer.echo(f"  {name:<36}{words:>12}")


def _stated_pad(
    case: Path | None, flags: Mapping[str, Any], asked: Mapping[str, Any]
) -> tuple[Pad, Material, dict[str, float]]:
    """Return the pad and its solid in SI, and what is asked."""
    units = {"thickness": "m", "stress": "Pa", "speed": "m/s"}
    wanted = {name: _quantity(name, text, units[name]) for name, text in _given(asked).items()}
    if "thickness" in wanted and "stress" in wanted:
        raise ValueError("give --thickness or --stress, not both: one answers the other")
    if case is None:
        pad, solid = _pad_from_flags(_given(flags))
    else:
        problem = stated_problem(case, flags, punch_from_flags, PunchProblem)
        assert isinstance(problem, PunchProblem)
        pad, solid = _pad_of(problem), problem.material
        stated = {"speed": problem.protocol.speed}
        if "stress" not in wanted:
            stated["thickness"] = problem.layer.thickness
        wanted = _given(stated) | wanted
    if wanted.keys() & {"thickness", "stress"} and "speed" not in wanted:
        raise ValueError('--speed missing, the retraction speed; for example --speed "100 um/s"')
    return pad, solid, wanted


def _quantity(name: str, text: str, unit: str) -> float:
    try:
        return parse(text, unit)
    except ValueError as error:
        raise ValueError(f"--{name}: {error}") from None


def _pad_of(problem: PunchProblem) -> Pad:
    return Pad(
        half_width=problem.punch.half_width,
        contact_modulus=problem.material.contact_modulus,
        work_of_adhesion=problem.traction.work_of_adhesion,
        strength=problem.traction.strength,
        base=problem.layer.base,
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
    solid, unit = material_from_flags({"material": "sls", **given})
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
        raise ValueError("an elastic layer comes off in the same way at every speed: no map")
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
