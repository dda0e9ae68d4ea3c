"""Covariance of ln(force) over tests, by the errors of model, material, temperature and machine.

A passport contains solids sampled from the uncertainty of its measurement. Each gives pull-off
forces; their scatter is a low-rank covariance of ln(force) over the speeds: a stiffer solid
raises all forces, a slower one those of one flank. It is computed at one interface near the best
one, because it hardly depends on the interface, and is added to the noise in fit and prediction.
The uncertainty of the temperature of the tests, by which all times of the solid are multiplied, is
added in the same way, and that of the compliance of the machine.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import exp, log
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from viscotack.arrays import Array
from viscotack.lab.sweeps import GAP
from viscotack.model.materials import Passport
from viscotack.model.materials.conversion import slowed
from viscotack.model.materials.passport import allowed, shift_error
from viscotack.model.protocol import Move

from .forward import Changed, Forward, Interface, Pulled
from .pull_off import Trial
from .rate_series import RateSeries

# Part of the variance between speeds that is a power of the speed, where there is a trend.
TREND = 0.8
_OF_TRIAL = ("speed", "preload")
_RADII = 40  # points of a curve; sufficient for differences between solids
# Errors of the theory at speeds a factor of e apart correlate by exp(-1/2.3).
_TOGETHER = log(10.0)


class SphereTests(NamedTuple):
    """Tests of one sphere at one temperature.

    Attributes
    ----------
    forward : Forward
        Forward model of the sphere and the material.
    passport : Passport
        The material at the temperature of the tests.
    speed, load : ndarray, shape (n,)
        Retraction speed [m/s] and preload [N].
    stiffness : float or None
        Stiffness of the machine [N/m]; None for a rigid one.
    moves : tuple of tuple of Move
        Moves of each test before the retraction; empty if all contacts are relaxed.
    """

    forward: Forward
    passport: Passport
    speed: Array
    load: Array
    stiffness: float | None = None
    moves: tuple[tuple[Move, ...], ...] = ()

    def stated(self, trial: Trial) -> Trial:
        """Return a test with preload and radius, by default the mean preload and the radius."""
        load = float(self.load.mean()) if trial.preload is None else trial.preload
        radius = self.forward.radius if trial.radius is None else trial.radius
        return replace(trial, preload=load, radius=radius)

    def of(self, trials: Sequence[Trial]) -> "SphereTests":
        """Return tests of one sphere, with approach and dwell if all of them have these.

        Their preload and radius are known; the material and the machine are those of these tests.
        """
        forward, radius = self.forward, trials[0].radius
        if radius is not None and radius != forward.radius:
            forward = replace(forward, radius=radius)
        speed, load = (np.array([getattr(x, n) for x in trials], float) for n in _OF_TRIAL)
        moves = tuple(each for x in trials if (each := x.moves()))
        moves = moves if len(moves) == len(trials) else ()
        return self._replace(forward=forward, speed=speed, load=load, moves=moves)

    def some(self, at: npt.NDArray[Any]) -> "SphereTests":
        """Select tests."""
        moves = tuple(self.moves[i] for i in np.arange(self.speed.size)[at]) if self.moves else ()
        return self._replace(speed=self.speed[at], load=self.load[at], moves=moves)

    def at(self, speed: Array) -> "SphereTests":
        """Return tests at other speeds, with load and moves of the first."""
        load = np.full(speed.size, self.load[0])
        return self._replace(speed=speed, load=load, moves=self.moves[:1] * speed.size)

    def changed(self, interface: Interface) -> Changed:
        """Return the effect of machine and moves on the forces."""
        how: dict[str, Any] = {"stiffness": self.stiffness, "moves": self.moves}
        return self.forward.changed(interface, self.speed, self.load, **how)

    def pulled(self, interface: Interface, radii: int = 160) -> Pulled:
        """Return the pull-offs of relaxed contacts and a rigid machine."""
        work, gap, growth = interface
        return self.forward.pulled(work, gap, self.speed, self.load, radii, growth)

    def log_forces(self, solids: Sequence[Any], interface: Interface) -> Array:
        """Return ln of the pull-off forces of neighbouring solids, shape (solids, n)."""
        others = (self._replace(forward=self.forward.beside(solid)) for solid in solids)
        return np.log([one.pulled(interface, _RADII).force for one in others])

    def slower(self, error: float, interface: Interface) -> Array:
        """Return the change of ln(force) by a relative error of all times, shape (n,)."""
        if not error:
            return np.zeros(self.speed.size)
        solids = [slowed(self.forward.material, exp(sign * error)) for sign in (1, -1)]
        slow, fast = self.log_forces(solids, interface)
        return (slow - fast) / 2


@dataclass(frozen=True, eq=False)
class ModelError:
    """Relative standard errors of the forces of tests, by theory or by simulation.

    Parameters
    ----------
    theory, simulation : ndarray, shape (S,)
        Error by the tier that gives the force of a test; 0 for the other.
    """

    theory: Array
    simulation: Array

    @classmethod
    def of_theory(cls, error: float, tests: int) -> "ModelError":
        """Return the errors of tests whose forces are all by theory."""
        return cls(np.full(tests, error), np.zeros(tests))

    def covariance(self, speed: Array) -> Array:
        """Return the covariance, correlated between near speeds.

        The errors of theory and simulation are independent.
        """
        apart = np.abs(np.subtract.outer(np.log(speed), np.log(speed)))
        square = np.multiply.outer(self.theory, self.theory)
        return (square + np.multiply.outer(self.simulation, self.simulation)) * np.exp(
            -apart / _TOGETHER
        )

    def joined(self, other: "ModelError") -> "ModelError":
        """Return the errors of these tests and of others."""
        return ModelError(
            np.concatenate([self.theory, other.theory]),
            np.concatenate([self.simulation, other.simulation]),
        )


def joint_covariance(
    series: RateSeries,
    tests: Sequence[SphereTests],
    interface: Interface,
    model: ModelError,
    softer: Array,
    others: Array,
) -> Array:
    """Return the covariance of ln(force) over tests.

    Parameters
    ----------
    series : RateSeries
        Measured series, with the uncertainties of temperature and material.
    tests : sequence of SphereTests
        The tests of the series first, then others of the same material.
    interface : Interface
        Interface at which the covariance is computed.
    model : ModelError
        Errors of the forces of all tests.
    softer : ndarray
        Error of ln(force) by the compliance of the machine, at all tests.
    others : ndarray
        Covariance by other errors, such as noise.
    """
    speed = np.concatenate([x.speed for x in tests])
    work, gap, _ = interface
    thin = [x.forward.layer_error(work, gap, x.speed, x.load) for x in tests]
    # one thermometer for all tests
    kelvins = series.temperature_error
    errors = [x.slower(shift_error(x.passport, kelvins), interface) for x in tests]
    warmer = np.concatenate([errors[0] * series.time_errors(), *errors[1:]])
    spread = others + replace(model, theory=model.theory + np.concatenate(thin)).covariance(speed)
    if allowed(series.passport):
        rows = [x.log_forces(_solids(series.passport, x.passport), interface) for x in tests]
        spread = spread + np.cov(np.concatenate(rows, axis=1), rowvar=False)
    return spread + np.outer(warmer, warmer) + np.outer(softer, softer)


def _solids(first: Passport, second: Passport) -> Sequence[Any]:
    """Return sampled solids of a material whose temperature may be another."""
    if second is first or second.allowed:
        return allowed(second)
    solids, temperature = allowed(first), second.temperature
    if temperature == first.temperature or temperature is None:
        return solids
    factor = first.shift_factor(temperature)
    return [slowed(solid, factor) for solid in solids]


def shift_covariance(series: RateSeries, own: SphereTests, interface: Interface) -> Array:
    """Return the covariance of ln(force) by the errors of a measured table of shifts.

    Errors at different temperatures are independent.
    """
    deviation = series.shift_deviations()
    if not deviation.any():
        return np.zeros((deviation.size, deviation.size))
    step = float(deviation.max())
    change = own.slower(step, interface) * deviation / step
    kelvins = np.array(series.temperatures, dtype=float)
    same = np.abs(np.subtract.outer(kelvins, kelvins)) <= GAP
    return np.outer(change, change) * same


def trend_covariance(speed: Array, measured: Array, between: float) -> Array:
    """Return the covariance of a relative error that follows a power of the speed.

    It is the part TREND of a variance between speeds, in the mean over the measured ones. Beyond
    them it grows, and the power may change by twice itself.
    """
    logs, wanted = np.log(measured), np.log(speed)
    at = between * (wanted - logs.mean()) / logs.std()
    beyond = np.abs(wanted - np.clip(wanted, logs.min(), logs.max()))
    change = 2 * between * beyond / logs.std()
    return TREND * np.outer(at, at) + np.diag(change**2)
