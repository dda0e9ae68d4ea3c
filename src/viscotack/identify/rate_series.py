r"""The interface from a rate series: pull-off forces at several speeds, and a material.

The forward model is the contact whose edge is a steady crack
(:mod:`viscotack.theory.crack.contact`), with Lennard-Jones forces. All works of adhesion and ranges
that are looked at are computed at once, on a grid, and interpolated in their logarithms; the search
and its intervals then cost nothing.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.interpolate import RectBivariateSpline

from viscotack.errors import InputError
from viscotack.geometry import Sphere
from viscotack.lab.tack import Cycle, Measured
from viscotack.materials import Material
from viscotack.problem import Problem
from viscotack.protocol import AtForce, Retraction
from viscotack.theory import SteadyCrack, lennard_jones
from viscotack.theory.crack.contact import profile_of, radius_at_force, recede
from viscotack.traction import LennardJones

from .objective import Best, Interval, Objective, Parameter

Array = npt.NDArray[np.float64]

_WORKS, _GAPS = 9, 21
_LEAST_TABOR = 2.0  # effective: below it the theory does not hold
_THEORY = 0.02  # relative standard uncertainty of the forward model
_LOUD = 2.0  # residuals over their uncertainty: no such interface gives the forces
_SAME = 0.03  # speeds within this part are one
_MOST = 40  # speeds


@dataclass(frozen=True)
class PullOff:
    """One pull-off: true speed [m/s] and force [N]; a positive number with its uncertainty."""

    speed: float
    force: Measured


@dataclass(frozen=True)
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
    """

    work_of_adhesion: float
    equilibrium_gap: float
    tabor: float
    intervals: dict[str, Interval]
    forces: tuple[float, ...]
    scatter: float
    words: tuple[str, ...]


def identify_rates(
    series: Sequence[PullOff],
    *,
    material: Material,
    radius: float,
    preload: float,
    gaps: tuple[float, float] = (0.3e-9, 3e-6),
    work_of_adhesion: tuple[float, float] | None = None,
    theory: float = _THEORY,
    level: float = 0.9,
) -> RateSeriesFit:
    """Return work of adhesion and range of attraction from pull-off forces at several speeds.

    Parameters
    ----------
    series : sequence of PullOff
        Two speeds and more, of one sphere relaxed under one preload.
    material : Material
        Of the solid, as a passport has it; taken as exact.
    radius, preload : float
        Of the sphere [m], and the force under which it relaxed [N].
    gaps : (float, float)
        Ranges of attraction h0 that are looked at [m]; cut where the theory ends.
    work_of_adhesion : (float, float), optional
        Known from a slow test, with its standard uncertainty [J/m2].
    theory : float
        Relative standard uncertainty of the forward model itself.
    level : float
        Confidence level of the intervals.

    Raises
    ------
    ValueError
        If there are fewer than two speeds, or the theory holds for no range looked at.

    Notes
    -----
    The bulk is linear and the interface elastic: where forces rise more steeply than any range
    gives, residuals say so. 1 to 10 s.
    """
    _check(series, radius, preload, gaps, theory, level)
    speeds = np.array([one.speed for one in series])
    force = np.array([one.force.value for one in series])
    sigma = np.hypot([one.force.uncertainty for one in series], theory * force)
    model = _Table(material, radius, preload, speeds, gaps, float(force.min()))
    prior = None
    if work_of_adhesion is not None:
        prior = (work_of_adhesion[0], work_of_adhesion[1] / work_of_adhesion[0])
    low, high = model.works[0], model.works[-1]
    parameters = (
        Parameter("work_of_adhesion", low, high, float(np.sqrt(low * high)), prior=prior),
        Parameter(
            "equilibrium_gap",
            model.gaps[0],
            model.gaps[-1],
            float(np.sqrt(model.gaps[0] * model.gaps[-1])),
        ),
    )
    objective = Objective(lambda values: (model(values) - force) / sigma, parameters)
    best = _best(objective)
    intervals = {one.name: objective.interval(one.name, best, level) for one in parameters}
    if model.effective(best.values) < _LEAST_TABOR:
        raise InputError(
            f"the most likely range, {best.values['equilibrium_gap']:.3g} m, lies where the zone "
            "at the edge is as large as the contact and the theory does not hold: simulate"
        )
    rest = objective.residuals(best.values)
    scatter = float(np.sqrt(np.sum(rest**2) / max(rest.size - 2, 1)))
    w, gap = best.values["work_of_adhesion"], best.values["equilibrium_gap"]
    tabor = _problem(material, radius, preload, w, gap, 1e-6).groups().tabor
    return RateSeriesFit(
        w,
        gap,
        tabor,
        intervals,
        tuple(model(best.values).tolist()),
        scatter,
        tuple(_words(best, intervals, scatter, level)),
    )


def _check(
    series: Sequence[PullOff],
    radius: float,
    preload: float,
    gaps: tuple[float, float],
    theory: float,
    level: float,
) -> None:
    speeds = {one.speed for one in series}
    if len(speeds) < 2 or len(series) > _MOST:
        raise InputError(
            f"a rate series has pull-offs at two speeds and more, up to {_MOST} in all; got "
            f"{len(series)} at {len(speeds)}"
        )
    if not all(one.speed > 0 and one.force.value > 0 for one in series):
        raise InputError("speeds and pull-off forces must be positive")
    if not (radius > 0 and preload > 0 and 0 <= theory < 1 and 0 < level < 1):
        raise InputError(
            f"radius and preload must be positive, theory and level parts of one; got {radius} m, "
            f"{preload} N, {theory}, {level}"
        )
    if not 0 < gaps[0] < gaps[1]:
        raise InputError(f"gaps must be two ranges, the smaller first [m], got {gaps!r}")


def _problem(
    material: Material, radius: float, preload: float, w: float, gap: float, speed: float
) -> Problem:
    return Problem(
        material=material,
        traction=LennardJones(work_of_adhesion=w, equilibrium_gap=gap),
        geometry=Sphere(radius=radius),
        protocol=Retraction(start=AtForce(preload), speed=speed),
    )


def pull_offs(cycles: Sequence[Cycle]) -> list[PullOff]:
    """Return one pull-off for each speed: repeated cycles are averaged.

    Speeds within 3 % are one. The uncertainty of a mean holds the scatter of its cycles.
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
        found.append(PullOff(speed, Measured(float(forces.mean()), float(np.hypot(own, spread)))))
    return found


class _Table:
    """Pull-off forces over work of adhesion, range and speed, interpolated in logarithms."""

    def __init__(
        self,
        material: Material,
        radius: float,
        preload: float,
        speeds: Array,
        gaps: tuple[float, float],
        least: float,
    ):
        # no energy at an opening edge is less than the work of adhesion
        most = 1.2 * least / (1.5 * np.pi * radius)
        self.works = np.geomspace(most / 12, most, _WORKS)
        self.gaps = np.geomspace(*gaps, _GAPS)
        force, effective = _grid(material, radius, preload, speeds, self.works, self.gaps)
        # where the most work of adhesion still gives a crack; less is checked where it is found
        holds = np.all(effective[-1] >= _LEAST_TABOR, axis=-1)
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
            RectBivariateSpline(x, y, np.log(force[:, :count, i])) for i in range(speeds.size)
        ]
        self._effective = RectBivariateSpline(x, y, np.log(effective.min(axis=-1)[:, :count]))

    def __call__(self, values: Mapping[str, float]) -> Array:
        x, y = np.log(values["work_of_adhesion"]), np.log(values["equilibrium_gap"])
        return np.exp([float(spline(x, y)[0, 0]) for spline in self._splines])

    def effective(self, values: Mapping[str, float]) -> float:
        """Return the least effective Tabor number of the series."""
        x, y = np.log(values["work_of_adhesion"]), np.log(values["equilibrium_gap"])
        return float(np.exp(self._effective(x, y)[0, 0]))


def _grid(
    material: Material, radius: float, preload: float, speeds: Array, works: Array, gaps: Array
) -> tuple[Array, Array]:
    """Return pull-off forces [N] and effective Tabor numbers, shape (works, gaps, speeds)."""
    groups = [
        [_problem(material, radius, preload, w, gap, 1e-6).groups() for gap in gaps] for w in works
    ]
    one = groups[0][0]
    unit = one.material.time_unit
    crack, profile = SteadyCrack(one.material, one.traction), profile_of(one.geometry)
    shape = (works.size, gaps.size, speeds.size)
    start = np.array([radius_at_force(profile, preload / (radius * w)) for w in works])
    tabor = np.array([[group.tabor for group in row] for row in groups])
    rate = np.array([[(group.rate or 0.0) * unit / group.tabor for group in row] for row in groups])
    found = recede(
        crack,
        profile,
        radius=np.broadcast_to(start[:, None, None], shape).ravel(),
        rate=(rate[:, :, None] * speeds / 1e-6).ravel(),
        tabor=np.broadcast_to(tabor[:, :, None], shape).ravel(),
    )
    mu = np.broadcast_to(tabor[:, :, None], shape).ravel()
    effective = mu * np.maximum(found.amplification, 1.0) ** (-1 / 3)
    ratio = np.asarray(lennard_jones.pull_off_ratio(effective))
    tension = np.where(found.force < 0, -ratio * found.force, 0.0)
    at = np.argmax(tension, axis=0), np.arange(mu.size)
    scale = radius * works[:, None, None]
    return tension[at].reshape(shape) * scale, effective[at].reshape(shape)


def _best(objective: Objective) -> Best:
    """Return the best of several starts along the range."""
    (gap,) = (one for one in objective.parameters if one.name == "equilibrium_gap")
    low, high = gap.inner(gap.low), gap.inner(gap.high)
    found = []
    for part in (0.1, 0.3, 0.5, 0.7, 0.9):
        held = objective.best({"equilibrium_gap": gap.outer(low + part * (high - low))})
        found.append(objective.best(near=held))
    return min(found, key=lambda best: best.misfit)


def _words(best: Best, intervals: dict[str, Interval], scatter: float, level: float) -> list[str]:
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
    if scatter > _LOUD:
        said.append(
            f"residuals are {scatter:.2g} times their uncertainty: no work of adhesion and range "
            "of a linear solid with an elastic interface give these forces; the interface may "
            "grow with speed, or the material be another one"
        )
    return said
