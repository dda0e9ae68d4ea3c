"""The operation ``theory punch``: theory of a flat punch on a layer."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from viscotack.errors import InputError
from viscotack.units import parse

from .flags import FLAGS
from .parts.solid import Reduced, passport_of
from .request import Answer, Caller, file_name, named, number, option, picture, quoted, switch

if TYPE_CHECKING:
    from viscotack.model.materials import Material
    from viscotack.theory import CrackLaw
    from viscotack.theory.punch import Pad, RegimeMap

# Of a regime map: thicknesses and speeds, and how thin and thick it gets beside b0 and a.
_ROWS, _THIN, _THICK = 121, 0.3, 5.0
# Of the way from the slow to the fast energy of a crack, where the speeds of a map begin and end.
_SLOW, _FAST = 0.003, 0.99
# What states a solid and its scales, which a passport does alone.
_OF_SOLID = ("contact_modulus", "modulus_ratio", "exponent", "tau0")


class OfPad(Reduced):
    """Flat punch on a layer: pull-off stress for a thickness, or thickness for a stress.

    A theory without simulation; its stress is up to 19 % above simulations. The problem is given in
    SI, by options or by a file.

    Example: viscotack theory punch --half-width "1 mm" --contact-modulus "1 MPa"
    --work-of-adhesion "50 mJ/m^2" --strength "50 kPa" --modulus-ratio 0.1 --tau0 "1 ms"
    --speed "100 um/s" --stress "30 kPa"
    """

    word: ClassVar = "theory punch"
    outputs: ClassVar = (picture("Draw that map."),)

    case: Path | None = file_name(
        "A problem in SI with units, instead of the flags of the problem; docs/input.md "
        "describes it.",
        metavar="CASE.toml",
        argument=True,
    )
    half_width: float | None = number('Half width of the punch a, "1 mm".', "m", above=0)
    thickness: float | None = number(
        'Thickness of the layer b, "200 um": what does it hold?', "m", above=0
    )
    stress: float | None = number(
        'Or: wanted pull-off stress, "30 kPa": how thick must the layer be?', "Pa", above=0
    )
    speed: float | None = number('Retraction speed, "100 um/s".', "m/s", above=0)
    contact_modulus: float | None = number('E0* = E0/(1 - nu^2), "1 MPa".', "Pa", above=0)
    work_of_adhesion: float | None = number('dg0, "50 mJ/m^2".', "J/m^2", above=0)
    strength: float | None = number('Of the interface, sigma0, "50 kPa".', "Pa", above=0)
    bonded: float | None = number(FLAGS["bonded"].words, least=0, most=0.5)
    material: Any = named(
        "sls (also when left out): standard linear solid, tau0 is its retardation time. "
        "power-law, elastic, prony:FILE and FILE.toml as for simulate sphere.",
        metavar="MATERIAL",
    )
    tau0: float | None = number('Time of the material, "1 ms" (not for prony:FILE).', "s", above=0)
    theory: Literal["greenwood", "persson-brener"] = option(
        "Theory of the moving crack.", default="greenwood"
    )
    map: bool = switch("Add to the JSON how the pad detaches by thickness and speed.")

    def check(self) -> None:
        """Refuse options that exclude each other."""
        if self.thickness is not None and self.stress is not None:
            raise InputError("give either thickness or stress, not both", field="stress")

    def answer(self, caller: Caller) -> Answer:
        """Evaluate the theory."""
        from viscotack.plot.regimes import draw_regimes

        pad, solid, wanted = self._pad(caller)
        # overflow must raise an error rather than return nan
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            crack = pad.crack_law(self.theory, material=solid)
            numbers = _boundaries(pad, crack) | _asked(pad, crack, wanted)
            regimes = _map(pad, crack) if self.map or "plot" in caller.wants else None
        record = numbers | ({"map": _rows(regimes)} if self.map and regimes else {})
        return Answer(
            record,
            record=lambda: record,
            words=lambda: numbers,
            pictures={"plot": lambda: draw_regimes(regimes or _map(pad, crack))},
        )

    @property
    def _of_pad(self) -> dict[str, Any]:
        """Options that define the pad."""
        names = ("half_width", "contact_modulus", "work_of_adhesion", "strength", "bonded")
        said = {name: getattr(self, name) for name in (*names, "tau0")} | self.given
        return {name: value for name, value in said.items() if value is not None}

    def _pad(self, caller: Caller) -> "tuple[Pad, Material, dict[str, float]]":
        """Return the pad and its solid in SI, and the requested numbers."""
        wanted = {"thickness": self.thickness, "stress": self.stress, "speed": self.speed}
        wanted = {name: value for name, value in wanted.items() if value is not None}
        if self.case is None:
            pad, solid = self._of_flags(caller)
        else:
            problem = self._of_case(caller.file(self.case), caller)
            pad, solid = _pad_of(problem), problem.material
            stated = {} if "stress" in wanted else {"thickness": problem.body.thickness}
            if problem.protocol.speed is not None:
                stated["speed"] = problem.protocol.speed
            wanted = stated | wanted
        if wanted.keys() & {"thickness", "stress"} and "speed" not in wanted:
            raise InputError(
                'speed is missing, the retraction speed; for example "100 um/s"', field="speed"
            )
        return pad, solid, wanted

    def _of_case(self, case: Path, caller: Caller) -> Any:
        """Return the problem of a case file."""
        from viscotack.model.geometry import FlatPunch
        from viscotack.model.problem import Groups
        from viscotack.model.problem.case_file import read_case

        if self._of_pad:
            given = ", ".join(self._of_pad)
            raise InputError(f"{case} defines the whole problem; leave out {given}")
        problem = read_case(case, beside=caller.within(case).file)
        if not isinstance(problem.geometry, FlatPunch) or isinstance(problem, Groups):
            raise InputError(
                f"{case} states a {problem.geometry.word} or no units; this command needs a "
                "flat punch in SI"
            )
        return problem

    def _of_flags(self, caller: Caller) -> "tuple[Pad, Material]":
        from viscotack.model.geometry import Bonded, Frictionless
        from viscotack.model.materials.library import MATERIALS
        from viscotack.theory.punch import Pad

        given, words = self._of_pad, self.material or ""
        passport = not isinstance(words, str) or words.endswith(".toml") or words in MATERIALS
        needed = ["half_width", "work_of_adhesion", "strength"]
        needed += [] if passport else ["contact_modulus"]
        if missing := [name for name in needed if name not in given]:
            raise InputError(f"{quoted(missing)} missing")
        if passport:
            if beside := [name for name in _OF_SOLID if name in given]:
                raise InputError(f"{words} defines the whole material; leave out `{beside[0]}`")
            solid = passport_of(words, caller).material
            modulus = solid.contact_modulus
        else:
            modulus = given["contact_modulus"]
            solid = self._solid_in_si(modulus, caller)
        pad = Pad(
            half_width=given["half_width"],
            contact_modulus=modulus,
            work_of_adhesion=given["work_of_adhesion"],
            strength=given["strength"],
            base=Frictionless() if self.bonded is None else Bonded(poisson_ratio=self.bonded),
        )
        return pad, solid

    def _solid_in_si(self, contact_modulus: float, caller: Caller) -> "Material":
        from viscotack.model.materials import Elastic
        from viscotack.model.problem.units import material_in_si

        solid, unit = self.solid(caller, "sls")
        if isinstance(solid, Elastic) or unit != "1":
            if self.tau0 is not None:
                raise InputError("the material has its times; leave out tau0", field="tau0")
            time = parse("1 s" if unit == "1" else f"1 {unit}", "s")
        elif self.tau0 is None:
            raise InputError("tau0 is missing, the time of the material", field="tau0")
        else:
            time = self.tau0
        # only times and ratios of it are used
        return material_in_si(solid, contact_modulus, time, 0.0)


def _pad_of(problem: Any) -> "Pad":
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
    running = np.isfinite(state.crack_speed)
    return {
        "regime": str(found.regime[0, 0]),
        "pull_off_stress_Pa": state.stress,
        "slowest_pull_off_stress_Pa": min(slow, pad.strength),
        "fastest_pull_off_stress_Pa": min(fast, pad.strength),
        "depth_at_pull_off_m": state.depth,
        "ligament_at_pull_off_m": state.ligament,
        "crack_speed_at_pull_off_m_per_s": state.crack_speed if running else None,
        "effective_surface_energy": state.amplification,
    }


def _map(pad: "Pad", law: "CrackLaw") -> "RegimeMap":
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


def _rows(found: "RegimeMap") -> dict[str, Any]:
    return {
        "thickness_m": found.thickness.tolist(),
        "speed_m_per_s": found.speed.tolist(),
        "regime": found.regime.tolist(),
        "pull_off_stress_Pa": found.stress.tolist(),
    }
