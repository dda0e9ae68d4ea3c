"""The operations ``theory persson-brener``, ``greenwood`` and ``steady-crack``: moving cracks."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np

from viscotack.errors import InputError
from viscotack.theory.crack.steady.cracks import THESIS_RATIO
from viscotack.units import is_number, parse

from .flags import LAW
from .options import Number, file_name, number, option, picture, quoted, text
from .parts.closed_form import closed_form
from .parts.solid import Reduced
from .request import Answer, Caller

if TYPE_CHECKING:
    from viscotack.theory import SteadyCrack
    from viscotack.theory.crack.steady import Comparison

# Of a table over the range that matters.
_ROWS = 41
# Where it begins and ends: parts of ln Gamma between the slowest and the fastest crack.
_PARTS = (0.005, 0.995)
_SCALES = ("contact_modulus", "work_of_adhesion", "equilibrium_gap", "tau0")
_THEORIES = ("persson_brener", "greenwood", "slow", "fast")
_STILL = "an elastic solid has an amplification of 1 at every speed"


class _OfTheory(Reduced):
    """A theory of the moving crack, named by the last word: of a solid, or of a measured modulus.

    Measured moduli end somewhere, so that their answer is two bounds.
    """

    outputs: ClassVar = (picture(),)

    speed: tuple[float, ...] = number(
        "Crack speed, in the theory's length over the time of the material (a second with "
        "--modulus-table); repeat it for more. Without it a table over the range that matters.",
        default=(),
    )
    modulus_table: Path | None = file_name(
        "Instead of a material: a measured complex modulus, CSV with the header "
        "'frequency_Hz,storage_MPa,loss_MPa' (or angular_frequency_rad/s, and other units). "
        "The answer is two bounds, for what the solid may do outside of the table."
    )
    rubbery_modulus: float | None = number(
        'Goes with --modulus-table: E0, the plateau at low frequency, "1.2 MPa".', "Pa", above=0
    )

    def answer(self, caller: Caller) -> Answer:
        """Evaluate the theory at the speeds, or over the range that matters."""
        if self.modulus_table is None and self.rubbery_modulus is None:
            v, found = self._of_solid(caller)
            unit = "the time of the material"
        else:
            v, found = self._of_table(caller)
            unit = "s"
        columns = {"speed": v} | found
        return closed_form(
            columns,
            columns,
            (v, np.stack(list(found.values()), axis=-1)),
            (f"speed [length of the theory / {unit}]", "amplification"),
            logarithmic=True,
        )

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
            v = np.geomspace(low, high, _ROWS)
        else:
            raise InputError(_STILL)
        return v, {"amplification": np.asarray(law.amplification(v, material=solid))}

    def _of_table(self, caller: Caller) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        from viscotack.lab.reading import read_dma
        from viscotack.theory import tabulated_modulus

        if given := self.given:
            raise InputError(f"`modulus_table` states the solid; leave out {quoted(given)}")
        if self.modulus_table is None or self.rubbery_modulus is None:
            raise InputError("`modulus_table` and `rubbery_modulus` go together; give both")
        amplification = tabulated_modulus.amplification
        speed_range = tabulated_modulus.speed_range
        if isinstance(self, Greenwood):
            amplification = tabulated_modulus.greenwood_amplification
            speed_range = tabulated_modulus.greenwood_speed_range
        table = read_dma(caller.file(self.modulus_table), kind="E")
        if len(table.ids) > 1:
            raise InputError(
                "`modulus_table` has several sweeps; give one master curve, as `viscotack material "
                "fit` makes it"
            )
        curve = table.at(min(table.ids))
        modulus = tabulated_modulus.TabulatedModulus(
            self.rubbery_modulus,
            *(tuple(x.tolist()) for x in (curve.angular_frequency, curve.storage, curve.loss)),
        )
        # not the ends themselves, which round-off may put outside
        low, high = speed_range(modulus=modulus)
        v = np.geomspace(low * (1 + 1e-9), high * (1 - 1e-9), _ROWS)
        v = np.array(self.speed) if self.speed else v
        found = amplification(v, modulus=modulus)
        return v, {
            "amplification_low": np.asarray(found.low),
            "amplification_high": np.asarray(found.high),
        }


class PerssonBrener(_OfTheory):
    """Effective over intrinsic surface energy of a moving crack (Persson and Brener).

    Example: viscotack theory persson-brener --modulus-ratio 0.1 --exponent 0.6 --speed 1, or:
    viscotack theory persson-brener --modulus-table dma.csv --rubbery-modulus "1.2 MPa"
    """

    word: ClassVar = "theory persson-brener"


class Greenwood(_OfTheory):
    """Effective over intrinsic surface energy of a moving crack with a cohesive zone (Greenwood).

    Example: viscotack theory greenwood --material sls --modulus-ratio 0.1 --speed 1 --speed 10, or:
    viscotack theory greenwood --modulus-table dma.csv --rubbery-modulus "1.2 MPa"
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


class Scales(Reduced):
    """A request with what takes a crack to SI: all of them or none."""

    contact_modulus: Annotated[float | None, _scale("rubbery contact modulus E0*", "Pa")] = None
    work_of_adhesion: Annotated[float | None, _scale("work of adhesion dg", "J/m^2")] = None
    equilibrium_gap: Annotated[float | None, _scale("equilibrium gap h0", "m")] = None
    tau0: Annotated[float | None, _scale("time of the material", "s")] = None

    @property
    def units(self) -> tuple[float, float] | None:
        """The units of length [m], E0* h0^2/dg, and speed [m/s], or None where none is given."""
        scales = self.values(*_SCALES)
        missing = [name for name, x in scales.items() if x is None]
        if len(missing) == len(_SCALES):
            return None
        if missing:
            raise InputError(f"{quoted(missing)} missing for an answer in SI")
        E, w, h0, tau = scales.values()
        length = E * h0**2 / w
        return length, length / tau


class OfSteadyCrack(Scales):
    """Effective over intrinsic surface energy of a steady crack with its whole traction law.

    Beside it by which part Persson-Brener, Greenwood and the slow and fast asymptotes are off.
    Without --material the solid is a power law with --exponent, and the standard solid (sls)
    without it. zone_length is the length from the largest tension to a tenth of it.

    Example: viscotack theory steady-crack --modulus-ratio 0.1 --speed 10, or: viscotack theory
    steady-crack --modulus-ratio 0.1 --exponent 0.6 --law exponential:0.25 --speed -1 --json
    """

    word: ClassVar = "theory steady-crack"
    outputs: ClassVar = (picture(),)

    speed: tuple[Any, ...] = text(
        "Crack speed in E0* h0^2/(dg tau), tau the time of the material, negative where the "
        "crack closes; with the scales of SI also as '10 um/s'. Repeat it for more. Without "
        "it a table over the range that matters.",
        to=_speed,
        default=(),
    )
    law: str | None = option(LAW, metavar="LAW")
    strength_ratio: float = number(
        "Alpha of Persson and Brener's length.", above=0, default=THESIS_RATIO
    )

    def answer(self, caller: Caller) -> Answer:
        """Solve the crack at the speeds, or over the range that matters."""
        from viscotack.model.problem.law_table import law_from_words
        from viscotack.model.traction import LennardJones
        from viscotack.theory import SteadyCrack

        given = self.given
        solid = self.solid(caller, "power-law" if "exponent" in given else "sls")
        crack = SteadyCrack(
            solid, law_from_words(self.law or LennardJones.word, beside=caller.file)
        )
        units = self.units
        v = self._speeds(crack, units)
        record, curves = _columns(crack, v, units, self.strength_ratio)
        labels = ("speed [E0* h0^2/(dg tau)]", "amplification")
        return closed_form(crack, record, (np.abs(v), curves), labels, logarithmic=True)

    def _speeds(self, crack: "SteadyCrack", units: tuple[float, float] | None) -> np.ndarray:
        if not self.speed:
            if crack.largest == 1:
                raise InputError(_STILL)
            low, high = np.asarray(crack.speed(crack.largest ** np.array(_PARTS)))
            return np.geomspace(low, high, _ROWS)
        in_si = [one for one in self.speed if isinstance(one, str)]
        if in_si and units is None:
            raise InputError(f"speed {in_si[0]} has a unit; it needs {quoted(_SCALES)}")
        unit = 1.0 if units is None else units[1]
        return np.array([parse(x, "m/s") / unit if x in in_si else x for x in self.speed])


def _columns(
    crack: "SteadyCrack", v: np.ndarray, units: tuple[float, float] | None, strength_ratio: float
) -> tuple[dict[str, Any], np.ndarray]:
    """Return the columns of the table, and the curves that are drawn."""
    from viscotack.model.traction import grows
    from viscotack.theory import SteadyCrack
    from viscotack.theory.crack.steady import compared

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
    return table, np.stack([gamma, *(_drawn(found, name, v) for name in _THEORIES[:2])], axis=-1)


def _drawn(found: "Comparison", name: str, v: np.ndarray) -> np.ndarray:
    return np.where(v > 0, getattr(found, name), np.nan)
