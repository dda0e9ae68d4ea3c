r"""A rate series: pull-off forces of a sphere at several speeds, and what is known beside them.

At a temperature T all times of the solid are :math:`a_T` times those at the reference temperature.
A linear solid therefore reaches the same force at the speed :math:`a_T v`, after an approach at
:math:`a_T` times the speed and a dwell of :math:`1/a_T` times the duration, if the interface does
not depend on temperature. So tests at several temperatures are one series.
"""

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.tack import Survey
from viscotack.model.geometry import HalfSpace, Layer
from viscotack.model.materials import Material, Passport
from viscotack.model.materials.passport import shift_error
from viscotack.model.protocol import Move

from .approach import range_bound
from .contact_time import APART, check_relaxed
from .pull_off import History, PullOff, pull_offs

DIFFERENT = 3.0  # K: larger differences are not due to the control of a chamber


def shifted(tests: Sequence[PullOff], passport: Passport, growth: bool = False) -> list[PullOff]:
    """Return pull-offs with speeds at the temperature of a material, slowest first.

    Parameters
    ----------
    tests : sequence of PullOff
        Tests with their temperatures; tests without one are at that of the material.
    passport : Passport
        The material, with its shift of times.
    growth : bool
        Whether the interface grows with speed; its dependence on temperature is unknown.

    Raises
    ------
    ValueError
        If temperatures differ from the material's and its shift is unknown there, or with growth.
    """
    known = [one.temperature for one in tests if one.temperature is not None]
    if not known:
        return list(tests)
    if len(known) < len(tests):
        raise InputError(
            f"the temperature of {len(tests) - len(known)} of {len(tests)} tests is unknown; "
            "write it into the files or file names, or set `temperature` for all"
        )
    if why := unshiftable(passport, growth):
        low, high = min(known), max(known)
        if high - low > DIFFERENT:
            raise InputError(
                f"tests were made at {celsius(low, high)}, and {why}; give tests at one temperature"
            )
        if growth and apart(tests, passport):
            raise InputError(
                f"tests were made at {celsius(low, high)}, and the material is at "
                f"{celsius(passport.temperature)}; set `temperature` to move the material"
            )
        return list(tests)
    try:
        factors = [passport.shift_factor(temperature) for temperature in known]
    except InputError as error:
        raise InputError(
            f"{error}; to take all tests at one temperature, set `temperature`"
        ) from None
    found = []
    for one, factor in zip(tests, factors, strict=True):
        more, past = factor / one.shift, one.history
        if past is not None:
            past = History(more * past.approach_speed, past.peak, past.dwell / more)
        found.append(replace(one, speed=more * one.speed, shift=factor, history=past))
    return sorted(found, key=lambda one: one.speed)


def unshiftable(passport: Passport, growth: bool) -> str:
    """Return why speeds cannot be shifted to the temperature of a material, or ""."""
    if growth:
        return "the temperature dependence of a speed-dependent interface is unknown"
    if passport.temperature is None or passport.shift is None:
        return "the material has no shift of times with temperature"
    return ""


def apart(tests: Sequence[PullOff], passport: Passport) -> bool:
    """Whether the middle of the temperatures of tests differs from that of a material."""
    known = [one.temperature for one in tests if one.temperature is not None]
    reference = passport.temperature
    if reference is None or not known:
        return False
    return abs((min(known) + max(known)) / 2 - reference) > DIFFERENT


def assumed_temperature(passport: Passport, known: Sequence[float | None]) -> list[str]:
    """Return a remark on the temperature that is assumed where files state none.

    `known` are the temperatures of the tests [K]; without tests, or where one is None, that of the
    passport is assumed.
    """
    if (known and None not in known) or passport.temperature is None:
        return []
    at = celsius(passport.temperature)
    return [f"no temperature of the tests is stated: {at} of the material is assumed"]


def celsius(low: float | None, high: float | None = None) -> str:
    """Return a temperature [K], or a range, in degrees Celsius."""
    both = [f"{kelvin - 273.15:.3g}" for kelvin in (low, high) if kelvin is not None]
    return f"{' to '.join(dict.fromkeys(both))} C"


# Relative standard uncertainty of the forward model, without and with growth, and on a layer
# much thicker than the contact.
_THEORY, _GROWING_THEORY, _LAYER_THEORY = 0.02, 0.03, 0.03
_MOST = 40  # largest number of speeds
_TEMPERATURE = 2.0  # K: standard uncertainty of the temperature of tests where none is stated
_WARMEST = 50.0  # K: largest uncertainty of a temperature; 2 degC would be read as 275 K


@dataclass(frozen=True, eq=False)
class RateSeries:
    """Pull-off forces of one sphere at several speeds, with material, machine and assumptions.

    Parameters
    ----------
    tests : sequence of PullOff
        Tests at two or more speeds, relaxed under their preload. Those with a temperature are
        shifted to that of the passport (:func:`shifted`).
    material : Passport or Material
        Solid at the temperature of tests that state none. The sampled solids of a passport widen
        the intervals; a bare material is assumed exact.
    radius : float
        Radius of the sphere [m].
    preload : float, optional
        Force under which all contacts relaxed [N]; by default that of each pull-off.
    body : HalfSpace or Layer
        Sample: thick, or a layer of known thickness [m] on a rigid base. On a layer only pull-off
        forces of relaxed contacts, a stiff machine and interfaces without growth are known.
    gaps : (float, float)
        Searched ranges of attraction h0 [m]; reduced to the validity of the theory.
    work_of_adhesion : (float, float), optional
        Value known from a slow test, with its standard uncertainty [J/m2].
    stiffness : float, optional
        Stiffness of the machine between drive and sphere [N/m], the inverse of its compliance; None
        if rigid. While the tension grows, the sphere moves more slowly than the drive.
    compliance_uncertainty : float
        Relative standard uncertainty of this compliance.
    temperature_uncertainty : float, optional
        Standard uncertainty of the temperature of the tests [K]; by default 2 K. It changes all
        times of the material by the shift law of the passport; without one it has no effect.
    curves : bool
        Whether to fit whole curves, by the travels between forces of each pull-off; then one
        speed is sufficient, and rate effects within the curve are included.
    growth : bool
        Whether to fit an interface that grows with the opening speed (Gent and Schultz), and test
        whether the data need growth. Its four unknowns need at least four speeds.
    history : bool
        Whether to compute the forces with approach and dwell of each test, mostly by simulation;
        by default contacts have relaxed under the preload. Not with `curves`, `growth` or a layer.
    scatter : float
        Relative standard deviation between tests, if repeated tests do not show it.
    theory : float, optional
        Relative standard uncertainty of the theory, correlated between near speeds; by default
        2 %, or 3 % with growth or on a layer. Where the forces reach through a layer, 7 % times
        the zone length times the contact radius over the squared thickness is added. Simulated
        forces have the error of their interpolation.
    level : float
        Confidence level of the intervals.
    range_bound : float, optional
        Upper bound of h0 [m] from the approach (:func:`.identify_approach`). It is compared with
        the fitted range, and changes no number.

    Raises
    ------
    ValueError
        If a number is out of its range, an option is not available for a layer, there are fewer
        than two speeds (without curves), or a pull-off has no travels (with curves).
    """

    tests: Sequence[PullOff]
    _: KW_ONLY
    material: Passport | Material
    radius: float
    preload: float | None = None
    body: HalfSpace | Layer = HalfSpace()
    gaps: tuple[float, float] = (0.3e-9, 3e-6)
    work_of_adhesion: tuple[float, float] | None = None
    stiffness: float | None = None
    compliance_uncertainty: float = 0.1
    temperature_uncertainty: float | None = None
    curves: bool = False
    growth: bool = False
    history: bool = False
    scatter: float = 0.0
    theory: float | None = None
    level: float = 0.9
    range_bound: float | None = None

    def __post_init__(self) -> None:
        self.passport.refuse_liquid("a rate series cannot be identified: contacts do not relax")
        tests = self.tests
        if self.preload is not None:
            tests = [replace(one, preload=self.preload) for one in tests]
        if without := [one.at for one in tests if one.preload is None]:
            raise InputError(f"the pull-off at {without[0]} has no preload; state it by preload")
        tests = shifted(tests, self.passport, self.growth)
        object.__setattr__(self, "tests", tuple(tests))
        speeds = {one.speed for one in tests}
        if self.curves and any(one.travels is None for one in tests):
            raise InputError(
                "curves must begin in compression and have points up to the pull-off; omit curves"
            )
        if not self.curves and len(speeds) < 2 or not 0 < len(tests) <= _MOST:
            raise InputError(
                f"a rate series needs up to {_MOST} pull-offs at two or more speeds; got "
                f"{len(tests)} at {len(speeds)}"
            )
        if not np.all([self.speed > 0, self.force > 0, self.load > 0]):
            raise InputError("speeds, pull-off forces and preloads must be positive")
        if self.history and (self.curves or self.growth or isinstance(self.body, Layer)):
            raise InputError(
                "approach and dwell are taken into account for pull-off forces on thick samples "
                "without growth only; omit history, or curves, growth and thickness"
            )
        if self.history and any(one.history is None for one in tests):
            raise InputError("a test has no speed of its approach; omit history")
        rules = {
            "radius": 0 < self.radius < np.inf,
            "stiffness": self.stiffness is None or 0 < self.stiffness < np.inf,
            "compliance_uncertainty": 0 <= self.compliance_uncertainty < 1,
            "scatter": 0 <= self.scatter < 1,
            "theory": 0 <= self.theory_error < 1,
            "level": 0 < self.level < 1,
            "temperature_uncertainty": 0 <= self.temperature_error <= _WARMEST,
            "gaps": 0 < self.gaps[0] < self.gaps[1],
        }
        for name, valid in rules.items():
            if not valid:
                raise InputError(f"{name} is out of its range: {getattr(self, name)!r}")
        if self.decades is not None and not self.history:
            shifts = np.array([one.shift for one in tests])
            check_relaxed(self.passport.material, self.contact_times / shifts)

    @cached_property
    def passport(self) -> Passport:
        """The material with what is known of it."""
        return Passport.of(self.material)

    @cached_property
    def speed(self) -> Array:
        """Speeds [m/s] at the temperature of the material, shape (S,)."""
        return np.array([one.speed for one in self.tests])

    @cached_property
    def load(self) -> Array:
        """Preloads [N], shape (S,)."""
        return np.array([one.preload for one in self.tests], dtype=float)

    @cached_property
    def force(self) -> Array:
        """Pull-off forces [N], shape (S,)."""
        return np.array([one.force.value for one in self.tests])

    @cached_property
    def contact_times(self) -> Array:
        """Times in contact [s], shape (S,); nan where they are unknown."""
        return np.array([one.contact_time for one in self.tests], dtype=float)

    @property
    def middle_time(self) -> float:
        """Geometric mean of the times in contact [s]."""
        return float(np.exp(np.log(self.contact_times).mean()))

    def middle_times(self, tests: int) -> Array | None:
        """Return `middle_time` for tests, whose work grows with the time; None where it does not.

        Such tests have no times of their own.
        """
        return None if self.decades is None else np.full(tests, self.middle_time)

    @cached_property
    def decades(self) -> Array | None:
        """Decades from `middle_time` to the time in contact of each test, shape (S,).

        None where no two tests at one speed and temperature have different times: such tests do
        not determine a growth with time, because it could be one with speed.
        """
        times, same = self.contact_times, {}
        for one, time in zip(self.tests, times.tolist(), strict=True):
            same.setdefault((one.speed, one.temperature), []).append(time)
        if np.isnan(times).any() or not any(max(x) >= APART * min(x) for x in same.values()):
            return None
        return np.log10(times / self.middle_time)

    @property
    def confounded(self) -> bool:
        """Whether times in contact differ from speed to speed alone, so that effects are one."""
        times = self.contact_times
        return self.decades is None and bool(times.max() >= APART * times.min())

    @property
    def largest_work(self) -> float:
        """Work of adhesion [J/m2] above those of a search: a slow force is 1.5 pi R w."""
        at = {v: float(self.force[self.speed == v].max()) for v in self.speed}
        return 1.2 * min(at.values()) / (1.5 * np.pi * self.radius)

    @cached_property
    def noise(self) -> Array:
        """Covariance of the relative noise of the forces, shape (S, S)."""
        own = np.array([one.force.uncertainty for one in self.tests]) / self.force
        return np.diag(np.maximum(own, 1e-9) ** 2 + self.scatter**2)

    @property
    def moves(self) -> tuple[tuple[Move, ...], ...]:
        """Moves of each test before its retraction; empty if all contacts are relaxed."""
        known = ((one.history, one.preload) for one in self.tests if self.history)
        return tuple(past.moves(load) for past, load in known if past and load is not None)

    @property
    def prior(self) -> tuple[float, float] | None:
        """Known work of adhesion [J/m2] and its relative uncertainty."""
        known = self.work_of_adhesion
        return None if known is None else (known[0], known[1] / known[0])

    @property
    def theory_error(self) -> float:
        """Relative standard uncertainty of the theory."""
        if self.theory is not None:
            return self.theory
        if self.growth:
            return _GROWING_THEORY
        return _LAYER_THEORY if isinstance(self.body, Layer) else _THEORY

    @property
    def temperature_error(self) -> float:
        """Standard uncertainty of the temperature [K]."""
        known = self.temperature_uncertainty
        return _TEMPERATURE if known is None else known

    @property
    def time_error(self) -> float:
        """Relative standard error of all times of the material by the temperature."""
        return shift_error(self.passport, self.temperature_error)

    @cached_property
    def temperatures(self) -> list[float | None]:
        """Temperature of each test [K]; that of the material for an unshifted one."""
        own = self.passport.temperature
        return [own if one.shift == 1.0 else one.temperature for one in self.tests]

    def time_errors(self) -> Array:
        """Return the error of each test at its temperature over `time_error`, shape (S,)."""
        reference = self.time_error
        if not reference:
            return np.ones(len(self.tests))
        kelvins, solid = self.temperature_error, self.passport
        return np.array([shift_error(solid, kelvins, at) for at in self.temperatures]) / reference

    def shift_deviations(self) -> Array:
        """Return the standard deviation of ln(a_T) of each test by the shift law, shape (S,)."""
        solid = self.passport
        known = [0.0 if at is None else solid.shift_deviation(at) for at in self.temperatures]
        return np.log(10.0) * np.array(known)


def series_of(
    found: Survey,
    material: Passport | Material,
    *,
    temperature: float | None = None,
    compliance: float | None = None,
    compliance_uncertainty: float = 0.0,
    bounded: bool = False,
    **known: Any,
) -> RateSeries:
    """Return the rate series of evaluated files of a rig.

    Parameters
    ----------
    found : Survey
        The files.
    material : Passport or Material
        Solid at the temperature of the tests.
    temperature : float, optional
        Temperature of all tests [K]; by default that stated in each file.
    compliance, compliance_uncertainty : float, optional
        Compliance of the machine and its standard uncertainty [m/N]; by default that stated in the
        files.
    bounded : bool
        Whether the approaches bound the range of attraction, on a half-space.
    **known
        Other parameters of :class:`RateSeries`.

    Raises
    ------
    ValueError
        If no cycle is valid, or the tests are no rate series.
    """
    tests = pull_offs(found.cycles)
    if temperature is not None:
        tests = [replace(one, temperature=temperature) for one in tests]
    soft = compliance or max(one.record.compliance for one in found.evaluations)
    if soft > 0:
        known["stiffness"] = 1 / soft
        if compliance_uncertainty > 0:
            known["compliance_uncertainty"] = compliance_uncertainty / soft
    if bounded and isinstance(known.get("body", HalfSpace()), HalfSpace):
        modulus = Passport.of(material).material.contact_modulus
        case = known["radius"], modulus, known.get("level", 0.9)
        known["range_bound"] = range_bound(found.cycles, *case)
    return RateSeries(tests, material=material, **known)
