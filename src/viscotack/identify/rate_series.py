r"""The interface from a rate series: pull-off forces at several speeds, and a material.

The forward model is the contact whose edge is a steady crack (:mod:`.forward`). All works of
adhesion and ranges that are looked at are computed at once, on a grid, and interpolated in their
logarithms; the search and its intervals then cost nothing. Noise of the forces, the error of the
theory and the doubt about the material (:mod:`.doubt`) are one covariance of the relative forces.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.interpolate import RectBivariateSpline

from viscotack.bem import crack_contact
from viscotack.errors import InputError
from viscotack.lab.tack import Cycle, Measured
from viscotack.materials import Material, Passport

from .doubt import allowed, covariance, log_forces, theory_covariance
from .forward import Forward
from .objective import Best, Interval, Objective, Parameter
from .travel import travels

Array = npt.NDArray[np.float64]

_WORKS, _GAPS = 8, 21  # works a decade, and ranges, of the table
LEAST_TABOR = 2.0  # effective: below it the theory does not hold
_THEORY = 0.02  # relative standard uncertainty of the forward model
_LOUD = 2.0  # residuals over their uncertainty: no such interface gives the forces
_SAME = 0.03  # speeds within this part are one
_MOST = 40  # speeds


@dataclass(frozen=True)
class PullOff:
    """One pull-off, or the mean of several at one speed.

    Parameters
    ----------
    speed : float
        True one of the retraction [m/s].
    force : Measured
        A positive number [N].
    preload : float, optional
        Under which the contact relaxed [N].
    travels : tuple of Measured, optional
        What the whole curve says beside it [m], as :func:`.travel.travels` has it.
    """

    speed: float
    force: Measured
    preload: float | None = None
    travels: tuple[Measured, ...] | None = None


@dataclass(frozen=True, eq=False)
class RateSeriesFit:
    """What a rate series says of the interface.

    Parameters
    ----------
    work_of_adhesion, equilibrium_gap : float
        Most likely [J/m2] and [m], of Lennard-Jones forces.
    tabor : float
        Tabor number of both with the material.
    intervals : dict of str to Interval
        Of "work_of_adhesion" and "equilibrium_gap", by profile likelihood.
    forces : tuple of float
        Pull-off forces of the most likely interface at the speeds of the series [N].
    scatter : float
        Root of the mean square of the residuals over their uncertainty.
    words : tuple of str
        What the data say and what they cannot tell.
    series : tuple of PullOff
        What was fitted, each with its preload.
    passport : Passport
        Of the material.
    forward : Forward
        The pull-offs of the material.
    covariance : ndarray, shape (S, S)
        Of the relative forces: noise, theory and material.
    objective : Objective
        To ask more of: its profiles, its density.
    theory : float
        Relative standard uncertainty of the forward model, which is in the covariance.
    level : float
        Confidence level of the intervals.
    stiffness : float or None
        Of the machine [N/m].
    yielding : ndarray, shape (S,)
        Forces through that over those of a rigid machine.
    """

    work_of_adhesion: float
    equilibrium_gap: float
    tabor: float
    intervals: dict[str, Interval]
    forces: tuple[float, ...]
    scatter: float
    words: tuple[str, ...]
    series: tuple[PullOff, ...]
    passport: Passport
    forward: Forward
    covariance: Array
    objective: Objective
    theory: float
    level: float
    stiffness: float | None
    yielding: Array

    @property
    def best(self) -> Best:
        """The most likely interface."""
        values = {
            "work_of_adhesion": self.work_of_adhesion,
            "equilibrium_gap": self.equilibrium_gap,
        }
        return self.objective.best(values)


def identify_rates(
    series: Sequence[PullOff],
    *,
    material: Material | Passport,
    radius: float,
    preload: float | None = None,
    gaps: tuple[float, float] = (0.3e-9, 3e-6),
    work_of_adhesion: tuple[float, float] | None = None,
    stiffness: float | None = None,
    curves: bool = False,
    scatter: float = 0.0,
    theory: float = _THEORY,
    level: float = 0.9,
) -> RateSeriesFit:
    """Return work of adhesion and range of attraction from pull-off forces at several speeds.

    Parameters
    ----------
    series : sequence of PullOff
        Two speeds and more, of one sphere relaxed under its preload.
    material : Passport or Material
        Of the solid, at the temperature of the tests. Of a passport the solids that its
        measurement allows as well widen the answer; a bare material is taken as exact.
    radius : float
        Of the sphere [m].
    preload : float, optional
        The force under which all of them relaxed [N]; else that of each pull-off.
    gaps : (float, float)
        Ranges of attraction h0 that are looked at [m]; cut where the theory ends.
    work_of_adhesion : (float, float), optional
        Known from a slow test, with its standard uncertainty [J/m2].
    stiffness : float, optional
        Of the machine between drive and sphere [N/m], one over its compliance; None if it is
        rigid. While the tension grows the sphere goes more slowly than the drive.
    curves : bool
        Take the whole curves too, by the travels between forces that each pull-off has; one
        speed is enough then, and a test that is not slow is not taken for one.
    scatter : float
        Relative standard deviation from test to test, where the tests do not show it themselves.
    theory : float
        Relative standard uncertainty of the forward model itself, shared by near speeds.
    level : float
        Confidence level of the intervals.

    Raises
    ------
    OutOfRange
        If the most likely interface leaves the range of the theory.
    ValueError
        If there are fewer than two speeds without curves, a pull-off has none, or the theory
        holds for no range looked at.

    Notes
    -----
    The bulk is linear and the interface elastic: where forces rise more steeply than any range
    gives, residuals say so. 1 to 20 s, most of it the cracks of the material.
    """
    passport = material if isinstance(material, Passport) else Passport(name="", material=material)
    series = [_loaded(one, preload) for one in series]
    _check(series, radius, gaps, stiffness, curves, scatter, theory, level)
    speed = np.array([one.speed for one in series])
    load = np.array([one.preload for one in series], dtype=float)
    force = np.array([one.force.value for one in series])
    noise = np.array([one.force.uncertainty for one in series]) / force
    forward = Forward(passport.material, radius)
    model = _Table(forward, speed, load, gaps, float(force.min()))
    prior = None
    if work_of_adhesion is not None:
        prior = (work_of_adhesion[0], work_of_adhesion[1] / work_of_adhesion[0])
    parameters = (
        _between("work_of_adhesion", model.works, prior),
        _between("equilibrium_gap", model.gaps, None),
    )

    shapes = _Shapes(series, model, theory) if curves else None

    def asked(spread: Array, yielding: Array) -> Objective:
        white = np.linalg.inv(np.linalg.cholesky(spread))

        def residuals(values: Mapping[str, float]) -> Array:
            rest = white @ (model(values) * yielding / force - 1)
            return rest if shapes is None else np.concatenate([rest, shapes(values)])

        return Objective(residuals, parameters)

    spread = np.diag(np.maximum(noise, 1e-9) ** 2 + scatter**2) + theory_covariance(speed, theory)
    yielding = np.ones(speed.size)
    objective = asked(spread, yielding)
    best = _best(objective)
    solids = allowed(passport)
    if solids or stiffness is not None:
        # what doubt about the material and a soft machine do hardly changes with the interface
        w, gap = best.values["work_of_adhesion"], best.values["equilibrium_gap"]
        yielding = forward.changed(w, gap, speed, load, stiffness=stiffness)
        if solids:
            spread = spread + covariance(log_forces(forward, solids, w, gap, speed, load))
        objective = asked(spread, yielding)
        best = _best(objective)
    intervals = {one.name: objective.interval(one.name, best, level) for one in parameters}
    if model.effective(best.values) < LEAST_TABOR:
        raise InputError(
            f"the most likely range, {best.values['equilibrium_gap']:.3g} m, lies where the zone "
            "at the edge is as large as the contact and the theory does not hold: simulate"
        )
    rest = objective.residuals(best.values)
    scatter = float(np.sqrt(np.sum(rest**2) / max(rest.size - 2, 1)))
    w, gap = best.values["work_of_adhesion"], best.values["equilibrium_gap"]
    fastest = int(np.argmax(speed))
    # refuses an edge that has no way to become a steady crack
    crack_contact(forward.problem(w, gap, float(load[fastest]), float(speed[fastest])))
    return RateSeriesFit(
        w,
        gap,
        forward.problem(w, gap, float(load[0])).groups().tabor,
        intervals,
        tuple((model(best.values) * yielding).tolist()),
        scatter,
        tuple(_words(best, intervals, scatter, level, bool(solids))),
        tuple(series),
        passport,
        forward,
        spread,
        objective,
        theory,
        level,
        stiffness,
        yielding,
    )


def _loaded(one: PullOff, preload: float | None) -> PullOff:
    load = one.preload if preload is None else preload
    if load is None:
        raise InputError(
            f"the pull-off at {one.speed:.3g} m/s has no preload; say the force [N] under which "
            "the contact relaxed"
        )
    return replace(one, preload=load)


def _between(name: str, values: Array, prior: tuple[float, float] | None) -> Parameter:
    low, high = float(values[0]), float(values[-1])
    return Parameter(name, low, high, float(np.sqrt(low * high)), prior=prior)


def _check(
    series: Sequence[PullOff],
    radius: float,
    gaps: tuple[float, float],
    stiffness: float | None,
    curves: bool,
    scatter: float,
    theory: float,
    level: float,
) -> None:
    speeds = {one.speed for one in series}
    if curves and any(one.travels is None for one in series):
        raise InputError(
            "whole curves begin in compression and have points between zero force and the "
            "pull-off; one of these has not: leave out curves, or that test"
        )
    if not curves and len(speeds) < 2 or not 0 < len(series) <= _MOST:
        raise InputError(
            f"a rate series has pull-offs at two speeds and more, up to {_MOST} in all; got "
            f"{len(series)} at {len(speeds)}"
        )
    if not all(one.speed > 0 and one.force.value > 0 for one in series):
        raise InputError("speeds and pull-off forces must be positive")
    loads = [one.preload or 0.0 for one in series]
    if stiffness is not None and not 0 < stiffness < np.inf:
        raise InputError(f"the stiffness of a machine must be positive, got {stiffness} N/m")
    if not (radius > 0 and min(loads) > 0 and 0 < level < 1):
        raise InputError(
            f"radius and preload must be positive, the level a part of one; got {radius} m, "
            f"{min(loads)} N, {level}"
        )
    if not (0 <= scatter < 1 and 0 <= theory < 1):
        raise InputError(
            f"scatter and error of the theory must be parts of one, got {scatter}, {theory}"
        )
    if not 0 < gaps[0] < gaps[1]:
        raise InputError(f"gaps must be two ranges, the smaller first [m], got {gaps!r}")


def pull_offs(cycles: Sequence[Cycle]) -> list[PullOff]:
    """Return one pull-off for each speed: repeated cycles are averaged.

    Speeds within 3 % are one. The uncertainty of a mean holds the scatter of its cycles; the
    preload is the force where retractions begin, none where one of them begins in tension.
    """
    found: list[PullOff] = []
    rest = sorted(cycles, key=lambda cycle: cycle.speed.value)
    while rest:
        first = rest[0].speed.value
        same = [cycle for cycle in rest if cycle.speed.value <= (1 + _SAME) * first]
        rest = rest[len(same) :]
        forces = np.array([cycle.pull_off_force.value for cycle in same])
        own = float(np.mean([cycle.pull_off_force.uncertainty for cycle in same]))
        spread = float(np.std(forces, ddof=1) / np.sqrt(forces.size)) if forces.size > 1 else 0.0
        speed = float(np.mean([cycle.speed.value for cycle in same]))
        begins = [float(cycle.force[cycle.segments.retract]) for cycle in same]
        force = Measured(float(forces.mean()), float(np.hypot(own, spread)))
        preload = float(np.mean(begins)) if min(begins) > 0 else None
        found.append(PullOff(speed, force, preload, _mean([travels(cycle) for cycle in same])))
    return found


def _mean(rows: Sequence[tuple[Measured, ...] | None]) -> tuple[Measured, ...] | None:
    """Return the means of travels; None where a curve has none."""
    told = [row for row in rows if row is not None]
    if len(told) < len(rows):
        return None
    columns = list(zip(*told, strict=True))
    return tuple(
        Measured(
            float(np.mean([one.value for one in column])),
            float(np.mean([one.uncertainty for one in column])),
        )
        for column in columns
    )


class _Table:
    """Pull-off forces over work of adhesion, range and speed, interpolated in logarithms."""

    def __init__(
        self,
        forward: Forward,
        speed: Array,
        preload: Array,
        gaps: tuple[float, float],
        least: float,
    ):
        # no energy at an opening edge is less than the work of adhesion, and none larger than 1/k
        most = 1.2 * least / (1.5 * np.pi * forward.radius)
        span = 2.0 / forward.material.modulus_ratio
        self.works = np.geomspace(most / span, most, 3 + round(_WORKS * float(np.log10(span))))
        self.gaps = np.geomspace(*gaps, _GAPS)
        found = forward.pulled(self.works[:, None, None], self.gaps[:, None], speed, preload)
        force, effective = found.force, found.effective_tabor
        # where the most work of adhesion still gives a crack; less is checked where it is found
        holds = np.all(effective[-1] >= LEAST_TABOR, axis=-1)
        count = int(np.argmin(holds)) if not holds.all() else holds.size
        if count < 5:
            raise InputError(
                f"the theory of a crack holds for no range looked at ({gaps[0]:.3g} to "
                f"{gaps[1]:.3g} m): the zone at the edge is as large as the contact; look at "
                "smaller ranges, or simulate"
            )
        self.gaps = self.gaps[:count]
        x, y = np.log(self.works), np.log(self.gaps)
        self._splines = [
            RectBivariateSpline(x, y, np.log(force[:, :count, i])) for i in range(speed.size)
        ]
        # asked for only where starts are in compression, which the travels need
        with np.errstate(invalid="ignore", divide="ignore"):
            ways = np.log(found.travels[:, :count])
        self._travels = [
            [RectBivariateSpline(x, y, ways[:, :, i, j]) for j in range(ways.shape[-1])]
            for i in range(speed.size)
            if np.all(np.isfinite(ways[:, :, i]))
        ]
        self._effective = RectBivariateSpline(x, y, np.log(effective.min(axis=-1)[:, :count]))

    def __call__(self, values: Mapping[str, float]) -> Array:
        x, y = np.log(values["work_of_adhesion"]), np.log(values["equilibrium_gap"])
        return np.exp([float(spline(x, y)[0, 0]) for spline in self._splines])

    def travels(self, values: Mapping[str, float]) -> Array:
        """Return travels between forces [m], shape (speeds, travels)."""
        x, y = np.log(values["work_of_adhesion"]), np.log(values["equilibrium_gap"])
        rows = [[float(spline(x, y)[0, 0]) for spline in row] for row in self._travels]
        return np.exp(rows)

    def effective(self, values: Mapping[str, float]) -> float:
        """Return the least effective Tabor number of the series."""
        x, y = np.log(values["work_of_adhesion"]), np.log(values["equilibrium_gap"])
        return float(np.exp(self._effective(x, y)[0, 0]))


class _Shapes:
    """Residuals of travels, in standard deviations."""

    def __init__(self, series: Sequence[PullOff], model: _Table, theory: float):
        self._model = model
        self._log, self._white = [], []
        for one in series:
            assert one.travels is not None, "checked before"
            value = np.array([x.value for x in one.travels])
            noise = np.array([x.uncertainty for x in one.travels]) / value
            # what the theory errs in one curve it errs in all of it, half of it
            own = noise**2 + theory**2 / 2
            spread = np.diag(own) + np.full((value.size, value.size), theory**2 / 2)
            self._log.append(np.log(value))
            self._white.append(np.linalg.inv(np.linalg.cholesky(spread)))

    def __call__(self, values: Mapping[str, float]) -> Array:
        found = np.log(self._model.travels(values))
        rows = zip(self._white, found, self._log, strict=True)
        return np.concatenate([white @ (one - measured) for white, one, measured in rows])


def _best(objective: Objective) -> Best:
    """Return the best of several starts along the range."""
    (gap,) = (one for one in objective.parameters if one.name == "equilibrium_gap")
    low, high = gap.inner(gap.low), gap.inner(gap.high)
    found = []
    for part in (0.1, 0.3, 0.5, 0.7, 0.9):
        held = objective.best({"equilibrium_gap": gap.outer(low + part * (high - low))})
        found.append(objective.best(near=held))
    return min(found, key=lambda best: best.misfit)


def _words(
    best: Best, intervals: dict[str, Interval], scatter: float, level: float, doubted: bool
) -> list[str]:
    said = []
    labels = {
        "work_of_adhesion": ("work of adhesion", "J/m2"),
        "equilibrium_gap": ("range of attraction h0", "m"),
    }
    for name, ends in intervals.items():
        label, unit = labels[name]
        if ends.told:
            said.append(
                f"{label} {best.values[name]:.3g} {unit} ({ends.low:.3g} to {ends.high:.3g}, "
                f"{level:.0%})"
            )
        elif ends.closed_below:
            said.append(
                f"{label} above {ends.low:.3g} {unit} ({level:.0%}); not identifiable above"
            )
        elif ends.closed_above:
            said.append(
                f"{label} below {ends.high:.3g} {unit} ({level:.0%}); not identifiable below"
            )
        else:
            said.append(f"{label}: not identifiable from these speeds")
        if ends.split:
            said.append(
                f"of the {label} there are two ranges in that interval which give these forces, "
                "with a gap between: another speed, whole curves or a slow test would tell"
            )
    if scatter > _LOUD:
        said.append(
            f"residuals are {scatter:.2g} times their uncertainty: no work of adhesion and range "
            "of a linear solid with an elastic interface give these forces; the interface may "
            "grow with speed, or the material be another one"
        )
    if not doubted:
        said.append("the material is taken as exact: nothing says how well it is known")
    return said
