"""The operation ``theory punch``: theory of a flat punch on a layer."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from viscotack.errors import InputError

from .flags import FLAGS
from .options import Contact, file_name, named, number, option, option_of, picture, switch
from .parts.record_words import read
from .parts.solid import Reduced
from .request import Answer, Caller
from .statement import statement

if TYPE_CHECKING:
    from viscotack.model.materials import Material
    from viscotack.theory import CrackLaw
    from viscotack.theory.punch import Pad, RegimeMap

# Of a regime map: thicknesses and speeds, and how thin and thick it gets beside b0 and a.
_ROWS, _THIN, _THICK = 121, 0.3, 5.0
# Of the way from the slow to the fast energy of a crack, where the speeds of a map begin and end.
_SLOW, _FAST = 0.003, 0.99
# Options of the problem that are those of `simulate punch`.
_OF_PAD = ("half_width", "contact_modulus", "work_of_adhesion", "strength", "bonded", "tau0")
_OF_PAD += tuple(Reduced.model_fields)
_PUNCH = Contact("", indenters=("punch",), whole=False)


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
        record = dict(numbers)
        if self.map and regimes:
            names = ("thickness_m", "speed_m_per_s", "regime")
            record["map"] = read(regimes, *names) | {"pull_off_stress_Pa": regimes.stress}
        return Answer(
            record,
            data=lambda: record,
            words=lambda: numbers,
            pictures={"plot": lambda: draw_regimes(regimes or _map(pad, crack))},
        )

    def _pad(self, caller: Caller) -> "tuple[Pad, Material, dict[str, float]]":
        """Return the pad and its solid in SI, and the requested numbers."""
        problem = self._problem(caller)
        wanted = {"thickness": self.thickness, "stress": self.stress, "speed": self.speed}
        if self.case is not None:
            wanted["speed"] = self.speed or problem.protocol.speed
            if self.stress is None:
                wanted["thickness"] = self.thickness or problem.body.thickness
        wanted = {name: value for name, value in wanted.items() if value is not None}
        if wanted.keys() & {"thickness", "stress"} and "speed" not in wanted:
            raise InputError(
                'speed is missing, the retraction speed; for example "100 um/s"', field="speed"
            )
        return pad_of(problem), problem.material, wanted

    def _problem(self, caller: Caller) -> Any:
        """Return the problem of the case file, or of the options as `simulate punch` reads them."""
        from viscotack.model.materials.library import MATERIALS
        from viscotack.model.materials.passport import Passport

        said: dict[str, Any] = {"indenter": "punch"}
        for name in (*_OF_PAD, "thickness", "speed"):
            value = getattr(self, name)
            unit = getattr(option_of(OfPad.model_fields[name]), "unit", "1")
            said[name] = value if value is None or unit == "1" else f"{value!r} {unit}"
        passport = self.material if isinstance(self.material, Passport) else None
        if passport is not None:
            # a published material stands in for the object
            said["material"] = MATERIALS[0]
        if self.case is not None:
            said |= {"case": str(self.case), "thickness": None, "speed": None}
        else:
            # the start does not matter to the theory, nor thickness and speed of a wanted stress
            usual = {"thickness": said["half_width"], "speed": "1 m/s", "preload": "0 m"}
            said = usual | {name: value for name, value in said.items() if value is not None}
        problem: Any = statement(said, _PUNCH, caller).problem
        if problem.scales() is None:
            raise InputError(f"{self.case} states no units; this command needs a flat punch in SI")
        return problem if passport is None else replace(problem, material=passport.material)


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
