"""The operations ``theory ...``: closed forms and steady cracks, without simulation."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import numpy as np

from viscotack.errors import InputError
from viscotack.model.geometry import FlatPunch
from viscotack.units import is_number, parse

from .flags import LAW
from .options import Number, contact, csv_file, file_name, number, option, picture, quoted, text
from .parts.record_words import read
from .parts.solid import OnLayer, Reduced
from .request import Answer, Caller, Request

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from viscotack.theory import CrackLaw, SteadyCrack
    from viscotack.theory.punch import Pad, RegimeMap

_RADIUS = Number('Sphere radius R, "5.19 mm".', unit="m", above=0)
_MODULUS = Number('E* = E/(1 - nu^2), "1.94 MPa".', unit="Pa", above=0)
_WORK = Number('dg0, "0.1523 J/m^2".', unit="J/m^2", above=0)


def _closed_form(
    found: Any, record: dict[str, Any], curve: Any, *labels: str, scale: str = "linear"
) -> Answer:
    """Return the answer with numbers, or lists of them, by name; `curve` is drawn as a line."""

    def draw() -> "Figure":
        from matplotlib.figure import Figure

        figure = Figure(layout="constrained")
        axes = figure.subplots()
        axes.plot(*curve)
        axes.set(xlabel=labels[0], ylabel=labels[1], xscale=scale, yscale=scale)
        return figure

    return Answer(found, data=record, pictures={"plot": draw})


class Jkr(OnLayer):
    """Detachment of an elastic sphere, forces of short range (JKR), from a half-space or a film.

    Example: viscotack theory jkr --radius "1 mm" --contact-modulus "1 MPa"
    --work-of-adhesion "50 mJ/m^2" --thickness "60 um" --bonded 0.49
    """

    word: ClassVar = "theory jkr"
    outputs: ClassVar = (picture(),)

    radius: Annotated[float, _RADIUS]
    contact_modulus: Annotated[float, _MODULUS]
    work_of_adhesion: Annotated[float, _WORK]

    def answer(self, caller: Caller) -> Answer:
        """Evaluate the theory."""
        from viscotack.model.geometry import HalfSpace, Layer, Sphere
        from viscotack.model.protocol import AtForce
        from viscotack.theory import film
        from viscotack.theory.elastic import relaxed

        body = self.body
        solid: Any = {"shape": Sphere(self.radius)}
        solid |= self.values("contact_modulus", "work_of_adhesion")
        end, fold = film.pull_off(body=body, **solid), film.instability(body=body, **solid)
        free = relaxed.contact(AtForce(0.0), body=body, **solid)
        assert free is not None, "every JKR contact has a state without load"
        record = {
            "pull_off_force_N": -end.force,
            "contact_radius_at_pull_off_m": end.contact_radius,
            "depth_at_pull_off_m": end.depth,
            "work_to_pull_off_J": film.work_to_pull_off(body=body, **solid),
            "contact_radius_without_load_m": free.contact_radius,
            "instability_depth_m": fold.depth,
        }
        if isinstance(body, Layer):
            limit = self.values("radius", "work_of_adhesion")
            record |= {
                "over_half_space": end.force / film.pull_off(body=HalfSpace(), **solid).force,
                "thin_limit_N": film.thin_limit(base=body.base, **limit),
                "half_space_thickness_m": film.half_space_thickness(base=body.base, **solid),
            }
        a = np.linspace(0.0, 1.5 * float(free.contact_radius), 201)[1:]
        depth, force = relaxed.curve(body=body, **solid)
        return _closed_form(end, record, (depth(a), force(a)), "depth [m]", "force [N]")


class OfDisc(OnLayer):
    """Detachment of a disc, the flat end of a cylinder, from a half-space or a film (Kendall).

    Example: viscotack theory disc --radius "1 mm" --contact-modulus "1 MPa"
    --work-of-adhesion "50 mJ/m^2" --strength "50 kPa" --thickness "200 um" --bonded 0.49
    """

    word: ClassVar = "theory disc"
    outputs: ClassVar = (picture("Draw the force against the radius of the disc."),)

    radius: float = number('Radius of the disc a, "1 mm".', "m", above=0, default=...)
    contact_modulus: Annotated[float, _MODULUS]
    work_of_adhesion: Annotated[float, _WORK]
    strength: float | None = number(
        'Of the interface, "50 kPa"; its force limits that of Kendall.', "Pa", above=0
    )

    def answer(self, caller: Caller) -> Answer:
        """Evaluate the theory."""
        from viscotack.theory import disc, indenter
        from viscotack.theory.elastic.on_layer import LARGEST as WIDEST

        a, E, body = self.radius, self.contact_modulus, self.body
        solid: Any = {"contact_modulus": E, "work_of_adhesion": self.work_of_adhesion}
        limits: Any = {**solid, "strength": self.strength, "body": body}
        force = disc.pull_off_force(contact_radius=a, **limits)
        stiffness = indenter.stiffness(a, contact_modulus=E, body=body)
        record = {
            "pull_off_force_N": force,
            "depth_at_pull_off_m": -np.asarray(force) / stiffness,
            "stiffness_N_per_m": stiffness,
            "kendall_force_N": disc.pull_off_force(contact_radius=a, body=body, **solid),
        }
        if self.strength is not None:
            uniform = disc.strength_limit(contact_radius=a, strength=self.strength)
            record["strength_force_N"] = uniform
            if self.thickness is None:
                crossover = disc.crossover_radius(strength=self.strength, **solid)
                record["crossover_radius_m"] = crossover
        if self.thickness is not None:
            whole = disc.pull_off_force(contact_radius=a, strength=self.strength, **solid)
            record["over_half_space"] = force / whole
        # the theory of a layer ends at a hundred thicknesses
        most = 10.0 if self.thickness is None else min(10.0, WIDEST * self.thickness / a)
        radii = a * np.geomspace(0.1, most, 61)
        curve = radii, np.asarray(disc.pull_off_force(contact_radius=radii, **limits))
        labels = "radius of the disc [m]", "pull-off force [N]"
        return _closed_form(force, record, curve, *labels, scale="log")


class Maugis(Request):
    """Detachment of an elastic sphere, forces of any range (Maugis-Dugdale).

    In SI: viscotack theory maugis --radius "1 um" --contact-modulus "1 GPa"
    --work-of-adhesion "50 mJ/m^2" --strength "20 MPa"

    Without dimensions: viscotack theory maugis --tabor 1
    """

    word: ClassVar = "theory maugis"
    outputs: ClassVar = (picture(),)

    radius: Annotated[float | None, _RADIUS] = None
    contact_modulus: Annotated[float | None, _MODULUS] = None
    work_of_adhesion: Annotated[float | None, _WORK] = None
    strength: float | None = number('Tension in the ring, "5 MPa".', "Pa", above=0)
    tabor: float | None = number(
        "Instead of all: Tabor number of a Lennard-Jones contact of equal work and peak.", above=0
    )

    def check(self) -> None:
        """Refuse options that exclude each other."""
        given = [name for name, value in self._sphere.items() if value is not None]
        missing = [name for name, value in self._sphere.items() if value is None]
        if self.tabor is not None and given:
            raise InputError(
                f"tabor states the whole problem; leave out {quoted(given)}", field="tabor"
            )
        if self.tabor is None and missing:
            raise InputError(f"{quoted(missing)} missing; or give tabor alone")

    @property
    def _sphere(self) -> dict[str, Any]:
        return self.values("radius", "contact_modulus", "work_of_adhesion", "strength")

    def answer(self, caller: Caller) -> Answer:
        """Evaluate the theory."""
        from viscotack.theory import maugis

        if self.tabor is None:
            case = self._sphere
            units, tails = (1.0, 1.0, 1.0), ("_N", "_m", "_m", "_J")
            labels = ("depth [m]", "force [N]")
        else:
            # R = E* = dg0 = 1: h0 is 1/mu, and the strength what makes the Maugis parameter
            case = {"radius": 1.0, "contact_modulus": 1.0, "work_of_adhesion": 1.0}
            wanted = maugis.parameter_from_tabor(self.tabor)
            of_one = maugis.maugis_parameter(**case, strength=1.0)
            case["strength"] = float(np.asarray(wanted) / of_one)
            units, tails = (1.5 * np.pi, np.cbrt(np.pi), 1 / self.tabor), ("", "", "", "")
            labels = ("depth / h0", "force / (1.5 pi R dg0)")
        load, length, height = units
        end = maugis.pull_off(**case)
        excess = float(end.cohesive_radius) / float(end.contact_radius) - 1
        states = maugis.curve(1 + excess * np.geomspace(1e-3, 1e3, 400), **case)
        record = {
            "maugis_parameter": maugis.maugis_parameter(**case),
            f"pull_off_force{tails[0]}": -end.force / load,
            f"contact_radius_at_pull_off{tails[1]}": end.contact_radius / length,
            f"cohesive_radius_at_pull_off{tails[1]}": end.cohesive_radius / length,
            f"depth_at_pull_off{tails[2]}": end.depth / height,
            f"work_to_pull_off{tails[3]}": maugis.work_to_pull_off(**case) / (load * height),
        }
        return _closed_form(end, record, (states.depth / height, states.force / load), *labels)


class OfCrack(Request):
    """Compute a contact history with the steady-crack contact model.

    The problem is given as for simulate sphere, by options or by a file in SI. The model has no
    fitted constant and holds for Tabor numbers above a few. It takes about 0.1 s.

    Example: viscotack theory crack-contact --tabor 10000 --material sls --modulus-ratio 0.1
    --preload 200000 --rate 10000
    """

    word: ClassVar = "theory crack-contact"
    outputs: ClassVar = (csv_file("Write the history as CSV, dimensionless.", "curve"), picture())
    takes_own: ClassVar = True

    problem: Any = contact("The contact, of revolution.", default=...)

    def answer(self, caller: Caller) -> Answer:
        """Compute the history."""
        from viscotack.model.problem import Groups, Problem
        from viscotack.simulate.crack_contact.by_crack import crack_contact, summary

        stated = self.stated(caller)
        problem = stated.problem
        assert isinstance(problem, Problem | Groups), "of no map of heights"
        found = crack_contact(problem)
        record = summary(found)
        labels = "depth / h0", "force / (1.5 pi R dg0)"
        answer = _closed_form(found, record, (found.depth, found.force), *labels)
        columns = ("time", "depth", "force", "contact_radius")
        columns += ("edge_speed", "amplification", "move")
        return replace(answer, files={"curve": read(found, *columns)}, notes=stated.notes)


# Of a regime map: thicknesses and speeds, and how thin and thick it gets beside b0 and a.
_ROWS, _THIN, _THICK = 121, 0.3, 5.0
# Of the way from the slow to the fast energy of a crack, where the speeds of a map begin and end.
_SLOW, _FAST = 0.003, 0.99


class OfPad(Request):
    """Flat punch on a layer: pull-off stress for a thickness, or thickness for a stress.

    A theory without simulation; its stress is up to 19 % above simulations. The problem is given in
    SI, by options or by a file.

    Example: viscotack theory punch --half-width "1 mm" --contact-modulus "1 MPa"
    --work-of-adhesion "50 mJ/m^2" --strength "50 kPa" --modulus-ratio 0.1 --tau0 "1 ms"
    --speed "100 um/s" --stress "30 kPa"
    """

    word: ClassVar = "theory punch"
    outputs: ClassVar = (picture("Draw how the pad detaches by thickness and speed."),)

    problem: Any = contact(
        "The punch, its layer and its interface in SI; the start of the test does not matter.",
        indenters=("punch",),
        in_si=True,
        default=...,
    )
    stress: float | None = number(
        'In place of a thickness: wanted pull-off stress, "30 kPa".', "Pa", above=0
    )
    theory: Literal["greenwood", "persson-brener"] = option(
        "Theory of the moving crack.", default="greenwood"
    )

    def answer(self, caller: Caller) -> Answer:
        """Evaluate the theory."""
        from viscotack.plot.design import draw_regimes

        pad, solid, wanted = self._pad(caller)
        # overflow must raise an error rather than return nan
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            crack = pad.crack_law(self.theory, material=solid)
            record = _boundaries(pad, crack) | _asked(pad, crack, wanted)
            regimes = _regimes(pad, crack) if "plot" in caller.wants else None
        draw = {} if regimes is None else {"plot": lambda: draw_regimes(regimes)}
        return Answer(record, data=record, pictures=draw)

    def _pad(self, caller: Caller) -> "tuple[Pad, Any, dict[str, float]]":
        """Return the pad and its solid in SI, and the requested numbers."""
        said, given = self.problem, {"thickness", "speed"}
        if isinstance(said, Mapping) and "indenter" in said and "case" not in said:
            said = {name: x for name, x in said.items() if x is not None}
            given &= said.keys()
            # of what is not asked for, any number does
            usual = {"thickness": said.get("half_width"), "speed": "1 m/s", "preload": "0 m"}
            said = usual | said
            if self.stress is not None and "thickness" in given:
                raise InputError("give either thickness or stress, not both", field="stress")
        problem: Any = self.model_copy(update={"problem": said}).stated(caller).problem
        if problem.scales() is None or not isinstance(problem.geometry, FlatPunch):
            raise InputError("theory punch needs a flat punch in SI")
        numbers = {"thickness": problem.body.thickness, "speed": problem.protocol.speed}
        wanted = {name: x for name, x in numbers.items() if name in given and x is not None}
        if self.stress is not None:
            wanted["stress"] = self.stress
        if wanted.keys() & {"thickness", "stress"} and "speed" not in wanted:
            raise InputError(
                'speed is missing, the retraction speed; for example "100 um/s"', field="speed"
            )
        return pad_of(problem), problem.material, wanted


def pad_of(problem: Any) -> "Pad":
    """Return the pad of a problem of a punch in SI."""
    from viscotack.theory.punch import Pad

    return Pad(
        half_width=problem.geometry.half_width,
        contact_modulus=problem.material.contact_modulus,
        work_of_adhesion=problem.traction.work_of_adhesion,
        strength=problem.traction.strength,
        base=problem.body.base,
    )


def _boundaries(pad: "Pad", law: "CrackLaw") -> dict[str, Any]:
    """Return the boundaries between the detachment regimes."""
    from viscotack.theory import punch

    b0, fast, b1 = punch.regime_thicknesses(pad, modulus_ratio=law.material.modulus_ratio)
    return {
        "cohesive_below_m": b0,
        "cohesive_when_fast_below_m": fast,
        "half_plane_above_m": b1,
    }


def _asked(pad: "Pad", law: "CrackLaw", wanted: Mapping[str, float]) -> dict[str, Any]:
    """Return the thickness for a stress, or the state at pull-off of a thickness."""
    from viscotack.theory import punch

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
    return {
        "regime": str(found.regime[0, 0]),
        "pull_off_stress_Pa": state.stress,
        "slowest_pull_off_stress_Pa": min(slow, pad.strength),
        "fastest_pull_off_stress_Pa": min(fast, pad.strength),
        "depth_at_pull_off_m": state.depth,
        "ligament_at_pull_off_m": state.ligament,
        "crack_speed_at_pull_off_m_per_s": state.crack_speed,
        "effective_surface_energy": state.amplification,
    }


def _regimes(pad: "Pad", law: "CrackLaw") -> "RegimeMap":
    """Return the regime map of the pad over the relevant thicknesses and speeds."""
    from viscotack.theory import punch

    a = pad.half_width
    if law.largest == 1:
        raise InputError("an elastic layer has no rate dependence, so there is no regime map")
    cracks = law.speed(1 + np.array([_SLOW, _FAST]) * (law.largest - 1))
    # a punch moved by the depth of its pull-off while the cracks run through it
    slow, fast = np.asarray(cracks) * -pad.elastic_depth(a) / a
    speed = np.geomspace(slow, fast, _ROWS)
    thinnest = min(_THIN * float(_boundaries(pad, law)["cohesive_below_m"]), 0.1 * a)
    return punch.regime_map(np.geomspace(thinnest, _THICK * a, _ROWS), speed, pad, law)


# Of a table over the range that matters.
_SPEEDS = 41
# Where it begins and ends: parts of ln Gamma between the slowest and the fastest crack.
_PARTS = (0.005, 0.995)
_SCALES = ("contact_modulus", "work_of_adhesion", "equilibrium_gap", "tau0")
_STILL = "an elastic solid has an amplification of 1 at every speed"


class _OfTheory(Reduced):
    """A theory of the moving crack, named by the last word: of a solid, or of a measured modulus.

    Measured moduli end somewhere, so that their answer is two bounds.
    """

    outputs: ClassVar = (picture(),)

    speed: tuple[float, ...] = number(
        "Crack speed, in the theory's length over the time of the material (s with "
        "--modulus-table); repeatable. Default: a table over the range that matters.",
        default=(),
    )
    modulus_table: Path | None = file_name(
        "Instead of a material: a measured modulus, CSV with the header "
        "'frequency_Hz,storage_MPa,loss_MPa' or other units; the answer is two bounds."
    )
    rubbery_modulus: float | None = number(
        'Goes with --modulus-table: E0, the plateau at low frequency, "1.2 MPa".', "Pa", above=0
    )

    def answer(self, caller: Caller) -> Answer:
        """Evaluate the theory at the speeds, or over the range that matters."""
        if self.modulus_table is None and self.rubbery_modulus is None:
            (v, found), unit = self._of_solid(caller), "the time of the material"
        else:
            (v, found), unit = self._of_table(caller), "s"
        columns, curve = {"speed": v} | found, (v, np.stack([*found.values()], axis=-1))
        labels = f"speed [length of the theory / {unit}]", "amplification"
        return _closed_form(columns, columns, curve, *labels, scale="log")

    def _of_solid(self, caller: Caller) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        from viscotack.theory.crack.law import THEORIES

        law: Any = THEORIES[self.word.removeprefix("theory ")]
        solid = self.solid(caller)
        if self.speed:
            v = np.array(self.speed)
        elif solid.modulus_ratio < 1:
            # from 1 % above the slowest crack to 1 % below the fastest
            part = np.array([0.01, 0.99])
            low, high = law.speed(1 + part * (1 / solid.modulus_ratio - 1), material=solid)
            v = np.geomspace(low, high, _SPEEDS)
        else:
            raise InputError(_STILL)
        return v, {"amplification": np.asarray(law.amplification(v, material=solid))}

    def _of_table(self, caller: Caller) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        from viscotack.lab import master_curve, read_dma
        from viscotack.lab.sweeps import GAP
        from viscotack.theory import tabulated_modulus

        if given := self.given:
            raise InputError(f"`modulus_table` states the solid; leave out {quoted(given)}")
        if self.modulus_table is None or self.rubbery_modulus is None:
            raise InputError("`modulus_table` and `rubbery_modulus` go together; give both")
        of = "greenwood_" if isinstance(self, Greenwood) else ""
        amplification, speed_range = (
            getattr(tabulated_modulus, f"{of}{name}") for name in ("amplification", "speed_range")
        )
        table = read_dma(caller.file(self.modulus_table), kind="E")
        if np.ptp(table.sweep) or np.ptp(table.temperature) > GAP:
            raise InputError(
                "`modulus_table` has several sweeps or temperatures; fit a material to it by "
                "`viscotack material fit`, and give that as `material`"
            )
        curve = master_curve(table, reference_temperature=None)
        modulus = tabulated_modulus.TabulatedModulus(
            self.rubbery_modulus,
            *(tuple(x.tolist()) for x in (curve.angular_frequency, curve.storage, curve.loss)),
        )
        # not the ends themselves, which round-off may put outside
        low, high = speed_range(modulus=modulus)
        v = np.geomspace(low * (1 + 1e-9), high * (1 - 1e-9), _SPEEDS)
        v = np.array(self.speed) if self.speed else v
        found = amplification(v, modulus=modulus)
        return v, {
            f"amplification_{end}": np.asarray(getattr(found, end)) for end in ("low", "high")
        }


class PerssonBrener(_OfTheory):
    """Effective over intrinsic surface energy of a moving crack (Persson and Brener).

    Example: viscotack theory persson-brener --modulus-ratio 0.1 --exponent 0.6 --speed 1

    From a DMA: viscotack theory persson-brener --modulus-table dma.csv --rubbery-modulus "1.2 MPa"
    """

    word: ClassVar = "theory persson-brener"


class Greenwood(_OfTheory):
    """Effective over intrinsic surface energy of a moving crack with a cohesive zone (Greenwood).

    Example: viscotack theory greenwood --material sls --modulus-ratio 0.1 --speed 1 --speed 10

    From a DMA: viscotack theory greenwood --modulus-table dma.csv --rubbery-modulus "1.2 MPa"
    """

    word: ClassVar = "theory greenwood"


def _speed(value: Any) -> float | str:
    """Return a crack speed: a pure number in the unit of the theory, or the text of one in m/s."""
    if not isinstance(value, str) or is_number(value):
        return parse(value, "1")
    parse(value, "m/s")
    return value


def _scale(words: str, unit: str) -> Number:
    words = f"For an answer in SI as well: {words}."
    return Number(words, unit=unit, above=0, metavar=unit)


class OfSteadyCrack(Reduced):
    """Effective over intrinsic surface energy of a steady crack with its whole traction law.

    Beside it by which part Persson-Brener, Greenwood and the slow and fast asymptotes are off.
    Without --material the solid is a power law with --exponent, and the standard solid (sls)
    without it. zone_length is the length from the largest tension to a tenth of it.

    Example: viscotack theory steady-crack --modulus-ratio 0.1 --speed 10

    A crack that closes: viscotack theory steady-crack --modulus-ratio 0.1 --exponent 0.6
    --law exponential:0.25 --speed -1
    """

    word: ClassVar = "theory steady-crack"
    outputs: ClassVar = (picture(),)

    speed: tuple[Any, ...] = text(
        "Crack speed in E0* h0^2/(dg tau), negative where the crack closes; with the scales of "
        "SI also '10 um/s'. Repeatable. Default: a table over the range that matters.",
        to=_speed,
        default=(),
    )
    law: str | None = option(LAW, metavar="LAW")
    contact_modulus: Annotated[float | None, _scale("rubbery contact modulus E0*", "Pa")] = None
    work_of_adhesion: Annotated[float | None, _scale("work of adhesion dg", "J/m^2")] = None
    equilibrium_gap: Annotated[float | None, _scale("equilibrium gap h0", "m")] = None
    tau0: Annotated[float | None, _scale("time of the material", "s")] = None

    def answer(self, caller: Caller) -> Answer:
        """Solve the crack at the speeds, or over the range that matters."""
        from viscotack.model.problem.case_file import law_from_words
        from viscotack.model.traction import LennardJones
        from viscotack.theory import SteadyCrack

        given = self.given
        solid = self.solid(caller, "power-law" if "exponent" in given else "sls")
        crack = SteadyCrack(
            solid, law_from_words(self.law or LennardJones.word, beside=caller.file)
        )
        units = self._units()
        v = self._speeds(crack, units)
        record, curves = _columns(crack, v, units)
        labels = "speed [E0* h0^2/(dg tau)]", "amplification"
        return _closed_form(crack, record, (np.abs(v), curves), *labels, scale="log")

    def _units(self) -> tuple[float, float] | None:
        """Return the units of length [m] and speed [m/s]; None where none is given."""
        scales = self.values(*_SCALES)
        missing = [name for name, x in scales.items() if x is None]
        if len(missing) == len(_SCALES):
            return None
        if missing:
            raise InputError(f"{quoted(missing)} missing for an answer in SI")
        E, w, h0, tau = scales.values()
        length = E * h0**2 / w
        return length, length / tau

    def _speeds(self, crack: "SteadyCrack", units: tuple[float, float] | None) -> np.ndarray:
        if not self.speed:
            if crack.largest == 1:
                raise InputError(_STILL)
            low, high = np.asarray(crack.speed(crack.largest ** np.array(_PARTS)))
            return np.geomspace(low, high, _SPEEDS)
        in_si = [one for one in self.speed if isinstance(one, str)]
        if in_si and units is None:
            raise InputError(f"speed {in_si[0]} has a unit; it needs {quoted(_SCALES)}")
        unit = 1.0 if units is None else units[1]
        return np.array([parse(x, "m/s") / unit if x in in_si else x for x in self.speed])


def _columns(
    crack: "SteadyCrack", v: np.ndarray, units: tuple[float, float] | None
) -> tuple[dict[str, Any], np.ndarray]:
    """Return the columns of the table, and the curves that are drawn."""
    from viscotack.model.traction import grows
    from viscotack.theory import SteadyCrack
    from viscotack.theory.crack.steady import compared

    gamma, profiles = np.asarray(crack.amplification(v)), [crack.at(speed) for speed in v]
    law: Any = crack.traction
    # the other theories are of cracks that open, with an interface at rest
    rest = SteadyCrack(crack.material, law.at_rest) if grows(law) else crack
    found = compared(rest, np.where(v > 0, v, 1.0))
    table: dict[str, np.ndarray] = {
        "speed": v,
        "amplification": gamma,
        "error_estimate": np.asarray(crack.error(v)),
        "zone_length": np.array([profile.zone_length for profile in profiles]),
        "heat": np.array([profile.heat for profile in profiles]),
    }
    if grows(law):
        table["interface_heat"] = np.array([profile.interface_heat for profile in profiles])
    if units is not None:
        table["speed_m_per_s"] = v * units[1]
        table["zone_length_m"] = table["zone_length"] * units[0]
    comparable = (v > 0) & (not grows(law))
    for name in ("persson_brener", "greenwood", "slow", "fast"):
        table[f"{name}_off"] = np.where(comparable, found.off(name), np.nan)
    others = (np.where(v > 0, x, np.nan) for x in (found.persson_brener, found.greenwood))
    return table, np.stack([gamma, *others], axis=-1)
