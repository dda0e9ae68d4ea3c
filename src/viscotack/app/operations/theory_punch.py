"""The operation ``theory punch``: theory of a flat punch on a layer."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from viscotack.errors import InputError
from viscotack.model.geometry import FlatPunch

from .options import contact, number, option, picture, switch
from .parts.record_words import read
from .request import Answer, Caller, Request

if TYPE_CHECKING:
    from viscotack.model.materials import Material
    from viscotack.theory import CrackLaw
    from viscotack.theory.punch import Pad, RegimeMap

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
    outputs: ClassVar = (picture("Draw that map."),)

    problem: Any = contact(
        "The punch, its layer and its interface in SI; the start of the test does not matter.",
        indenters=("punch",),
        in_si=True,
        default=...,
    )
    stress: float | None = number(
        'In place of a thickness: wanted pull-off stress, "30 kPa": how thick must the layer be?',
        "Pa",
        above=0,
    )
    theory: Literal["greenwood", "persson-brener"] = option(
        "Theory of the moving crack.", default="greenwood"
    )
    map: bool = switch("Add to the JSON how the pad detaches by thickness and speed.")

    def answer(self, caller: Caller) -> Answer:
        """Evaluate the theory."""
        from viscotack.plot.design import draw_regimes

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
