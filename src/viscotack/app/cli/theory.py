"""The commands that answer at once: ``viscotack theory jkr ...`` and ``viscotack advise ...``."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer
from typer import Option

from viscotack.errors import InputError
from viscotack.operations.declare.questions import material_from
from viscotack.theory import jkr, maugis, tabulated_modulus
from viscotack.theory.crack.law import THEORIES
from viscotack.theory.crack.modulus_file import read_modulus
from viscotack.units import parse, positive

from .commands import (
    AsJson,
    PlotFile,
    application,
    wrong_input,
)
from .options import Exponent, Ratio
from .writing import Writing, check_files

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Of a table over the range that matters.
_ROWS = 41

theory = typer.Typer(help="Ask a closed form.", no_args_is_help=True, rich_markup_mode=None)
application.add_typer(theory, name="theory")

_RADIUS = Option("--radius", metavar="LENGTH", help='Sphere radius R, "5.19 mm".')
_MODULUS = Option("--contact-modulus", metavar="PRESSURE", help='E* = E/(1 - nu^2), "1.94 MPa".')
_WORK = Option("--work-of-adhesion", metavar="ENERGY", help='dg0, "0.1523 J/m^2".')
Radius = Annotated[str, _RADIUS]
Modulus = Annotated[str, _MODULUS]
Work = Annotated[str, _WORK]
Material = Annotated[
    str | None,
    Option(
        "--material",
        metavar="MATERIAL",
        help="power-law (also when left out), sls, prony:FILE or a passport FILE.toml, as for "
        "simulate sphere.",
    ),
]
Speed = Annotated[
    list[float] | None,
    Option(
        "--speed",
        metavar="V",
        help="Crack speed, in the theory's length over the time of the material (a second with "
        "--modulus-table); repeat it for more. Without it a table over the range that matters.",
    ),
]
ModulusTable = Annotated[
    Path | None,
    Option(
        "--modulus-table",
        metavar="FILE",
        help="Instead of a material: a measured complex modulus, CSV with the header "
        "'frequency_Hz,storage_MPa,loss_MPa' (or angular_frequency_rad/s, and other units). The "
        "answer is two bounds, for what the solid may do outside of the table.",
    ),
]
RubberyModulus = Annotated[
    str | None,
    Option(
        "--rubbery-modulus",
        metavar="PRESSURE",
        help='Goes with --modulus-table: E0, the plateau at low frequency, "1.2 MPa".',
    ),
]


@theory.command("jkr")
def theory_jkr(
    radius: Radius,
    contact_modulus: Modulus,
    work_of_adhesion: Work,
    plot_file: PlotFile = None,
    as_json: AsJson = False,
) -> None:
    """Detachment of an elastic sphere, forces of short range (JKR).

    Example: viscotack theory jkr --radius "1 mm" --contact-modulus "1 MPa" --work-of-adhesion
    "50 mJ/m^2"
    """
    with wrong_input():
        check_files({"--plot": plot_file})
        case = _sphere(radius, contact_modulus, work_of_adhesion)
        end, fold = jkr.pull_off(**case), jkr.instability(**case)
        free = jkr.contact_radius_at_force(0.0, **case)
        a = np.linspace(0.0, 1.5 * float(free), 400)
        curve = jkr.depth(a, **case), jkr.force(a, **case)
    answer = {
        "pull_off_force_N": -end.force,
        "contact_radius_at_pull_off_m": end.contact_radius,
        "pull_off_depth_m": end.depth,
        "work_to_pull_off_J": jkr.work_to_pull_off(**case),
        "contact_radius_without_load_m": free,
        "instability_depth_m": fold.depth,
    }
    answer_with(answer, curve, ("depth [m]", "force [N]"), as_json, plot_file)


@theory.command("maugis")
def theory_maugis(
    radius: Annotated[str | None, _RADIUS] = None,
    contact_modulus: Annotated[str | None, _MODULUS] = None,
    work_of_adhesion: Annotated[str | None, _WORK] = None,
    strength: Annotated[
        str | None, Option("--strength", metavar="PRESSURE", help='Tension in the ring, "5 MPa".')
    ] = None,
    tabor: Annotated[
        float | None,
        Option(
            "--tabor",
            metavar="MU",
            help="Instead of all of them, for dimensionless answers: the Tabor number of a "
            "Lennard-Jones contact of the same work and peak tension.",
        ),
    ] = None,
    plot_file: PlotFile = None,
    as_json: AsJson = False,
) -> None:
    """Detachment of an elastic sphere, forces of any range (Maugis-Dugdale).

    Example: viscotack theory maugis --radius "1 um" --contact-modulus "1 GPa" --work-of-adhesion
    "50 mJ/m^2" --strength "20 MPa", or: viscotack theory maugis --tabor 1
    """
    quantities = {
        "--radius": radius,
        "--contact-modulus": contact_modulus,
        "--work-of-adhesion": work_of_adhesion,
        "--strength": strength,
    }
    with wrong_input():
        check_files({"--plot": plot_file})
        _check_maugis(quantities, tabor)
        if tabor is None:
            case = _sphere(str(radius), str(contact_modulus), str(work_of_adhesion))
            case["strength"] = parse(str(strength), "Pa")
            units, tails = (1.0, 1.0, 1.0), ("_N", "_m", "_m", "_J")
            labels = ("depth [m]", "force [N]")
        else:
            # R = E* = dg0 = 1: h0 is 1/mu, and the strength what makes the Maugis parameter
            case = {"radius": 1.0, "contact_modulus": 1.0, "work_of_adhesion": 1.0}
            wanted = maugis.parameter_from_tabor(positive("--tabor", tabor, "1"))
            of_one = maugis.maugis_parameter(**case, strength=1.0)
            case["strength"] = float(np.asarray(wanted) / of_one)
            units, tails = (1.5 * np.pi, np.cbrt(np.pi), 1 / tabor), ("", "", "", "")
            labels = ("depth / h0", "force / (1.5 pi R dg0)")
        load, length, height = units
        end = maugis.pull_off(**case)
        excess = float(end.cohesive_radius) / float(end.contact_radius) - 1
        states = maugis.curve(1 + excess * np.geomspace(1e-3, 1e3, 400), **case)
        answer = {
            "maugis_parameter": maugis.maugis_parameter(**case),
            f"pull_off_force{tails[0]}": -end.force / load,
            f"contact_radius_at_pull_off{tails[1]}": end.contact_radius / length,
            f"cohesive_radius_at_pull_off{tails[1]}": end.cohesive_radius / length,
            f"pull_off_depth{tails[2]}": end.depth / height,
            f"work_to_pull_off{tails[3]}": maugis.work_to_pull_off(**case) / (load * height),
        }
    curve = (states.depth / height, states.force / load)
    answer_with(answer, curve, labels, as_json, plot_file)


@theory.command("persson-brener")
def theory_persson_brener(
    material: Material = None,
    modulus_ratio: Ratio = None,
    exponent: Exponent = None,
    speed: Speed = None,
    modulus_table: ModulusTable = None,
    rubbery_modulus: RubberyModulus = None,
    plot_file: PlotFile = None,
    as_json: AsJson = False,
) -> None:
    """Effective over intrinsic surface energy of a moving crack (Persson and Brener).

    Example: viscotack theory persson-brener --modulus-ratio 0.1 --exponent 0.6 --speed 1, or:
    viscotack theory persson-brener --modulus-table dma.csv --rubbery-modulus "1.2 MPa"
    """
    flags = {"material": material, "modulus-ratio": modulus_ratio, "exponent": exponent}
    _crack("persson-brener", flags, speed, (modulus_table, rubbery_modulus), plot_file, as_json)


@theory.command("greenwood")
def theory_greenwood(
    material: Material = None,
    modulus_ratio: Ratio = None,
    exponent: Exponent = None,
    speed: Speed = None,
    modulus_table: ModulusTable = None,
    rubbery_modulus: RubberyModulus = None,
    plot_file: PlotFile = None,
    as_json: AsJson = False,
) -> None:
    """Effective over intrinsic surface energy of a moving crack with a cohesive zone (Greenwood).

    Example: viscotack theory greenwood --material sls --modulus-ratio 0.1 --speed 1 --speed 10, or:
    viscotack theory greenwood --modulus-table dma.csv --rubbery-modulus "1.2 MPa"
    """
    flags = {"material": material, "modulus-ratio": modulus_ratio, "exponent": exponent}
    _crack("greenwood", flags, speed, (modulus_table, rubbery_modulus), plot_file, as_json)


def _sphere(radius: str, contact_modulus: str, work_of_adhesion: str) -> dict[str, float]:
    return {
        "radius": parse(radius, "m"),
        "contact_modulus": parse(contact_modulus, "Pa"),
        "work_of_adhesion": parse(work_of_adhesion, "J/m^2"),
    }


def _check_maugis(quantities: dict[str, str | None], tabor: float | None) -> None:
    """Refuse a sphere that is stated twice or in part."""
    given = [name for name, value in quantities.items() if value is not None]
    missing = [name for name, value in quantities.items() if value is None]
    if tabor is not None and given:
        raise InputError(f"--tabor states the whole problem; leave out {', '.join(given)}")
    if tabor is None and missing:
        raise InputError(f"{' and '.join(missing)} missing; or give --tabor alone")


_TABLE_LAWS = {
    "persson-brener": (tabulated_modulus.amplification, tabulated_modulus.speed_range),
    "greenwood": (
        tabulated_modulus.greenwood_amplification,
        tabulated_modulus.greenwood_speed_range,
    ),
}


def _crack(
    name: str,
    flags: dict[str, Any],
    speed: list[float] | None,
    measured: tuple[Path | None, str | None],
    plot_file: Path | None,
    as_json: bool,
) -> None:
    """Answer for a material stated by flags, or for a table of a modulus and its plateau."""
    with wrong_input():
        check_files({"--plot": plot_file}, reads=(measured[0],))
        given = {flag: value for flag, value in flags.items() if value is not None}
        if measured == (None, None):
            v, found = _of_material(THEORIES[name], given, speed)
            unit = "the time of the material"
        else:
            v, found = _of_table(name, given, speed, *measured)
            unit = "s"
    answer = {"speed": v} | found
    labels = (f"speed [length of the theory / {unit}]", "amplification")
    curve = (v, np.stack(list(found.values()), axis=-1))
    table = {column: values.tolist() for column, values in answer.items()}
    answer_with(table, curve, labels, as_json, plot_file, logarithmic=True)


def _of_material(
    law: Any, given: dict[str, Any], speed: list[float] | None
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    solid, _ = material_from(given)
    if speed:
        v = np.array(speed)
    elif solid.modulus_ratio < 1:
        # from 1 % above the slowest crack to 1 % below the fastest
        part = np.array([0.01, 0.99])
        low, high = law.speed(1 + part * (1 / solid.modulus_ratio - 1), material=solid)
        v = np.geomspace(low, high, _ROWS)
    else:
        raise InputError("an elastic solid has an amplification of 1 at every speed")
    return v, {"amplification": np.asarray(law.amplification(v, material=solid))}


def _of_table(
    name: str,
    given: dict[str, Any],
    speed: list[float] | None,
    file: Path | None,
    rubbery_modulus: str | None,
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    if given:
        others = ", ".join(f"--{flag}" for flag in given)
        raise InputError(f"--modulus-table states the solid; leave out {others}")
    if file is None or rubbery_modulus is None:
        missing = "--modulus-table" if file is None else "--rubbery-modulus"
        raise InputError(f"{missing} missing; --modulus-table and --rubbery-modulus go together")
    amplification, speed_range = _TABLE_LAWS[name]
    plateau = positive("--rubbery-modulus", parse(rubbery_modulus, "Pa"), "Pa")
    modulus = read_modulus(file, rubbery_modulus=plateau)
    # not the ends themselves, which round-off may put outside
    low, high = speed_range(modulus=modulus)
    v = np.array(speed) if speed else np.geomspace(low * (1 + 1e-9), high * (1 - 1e-9), _ROWS)
    found = amplification(v, modulus=modulus)
    return v, {
        "amplification_low": np.asarray(found.low),
        "amplification_high": np.asarray(found.high),
    }


def answer_with(
    answer: dict[str, Any],
    curve: tuple[Any, Any],
    labels: tuple[str, str],
    as_json: bool,
    plot_file: Path | None,
    *,
    logarithmic: bool = False,
) -> None:
    """Print numbers as JSON or as lines, and draw the curve if wanted: a theory is a line."""
    write = Writing()
    write.picture(plot_file, lambda: _drawn(curve, labels, logarithmic))
    write.answer(json.dumps(answer, indent=2, allow_nan=False) if as_json else _words(answer))
    write.end()


def _drawn(curve: tuple[Any, Any], labels: tuple[str, str], logarithmic: bool) -> "Figure":
    from matplotlib.figure import Figure

    figure = Figure(layout="constrained")
    axes = figure.subplots()
    axes.plot(*curve)
    axes.set_xlabel(labels[0])
    axes.set_ylabel(labels[1])
    if logarithmic:
        axes.set_xscale("log")
        axes.set_yscale("log")
    return figure


def _words(answer: dict[str, Any]) -> str:
    if not isinstance(next(iter(answer.values())), list):
        return "\n".join(f"  {name:<32}{value:>12.5g}" for name, value in answer.items())
    rows = zip(*answer.values(), strict=True)
    lines = ["  ".join(_cell(value) for value in row) for row in rows]
    return "\n".join(["  ".join(f"{name:>18}" for name in answer), *lines])


def _cell(value: float | None) -> str:
    return f"{'-':>18}" if value is None else f"{value:18.6g}"
