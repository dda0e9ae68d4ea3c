r"""Identify the interface from a slow test: elastic model, work of adhesion and range.

In a slow test the solid is relaxed everywhere, including the edge of the contact.
All models are fitted to the same points. The Bayesian information criterion
:math:`\chi^2 + k \ln n`, with the scatter of the best model, measures the evidence (twice the
logarithm of a Bayes factor for wide priors). Intervals are profile likelihoods; that of the work
of adhesion covers all models that the criterion does not distinguish. Where these disagree on the
work, it is undetermined, and the answer gives the work by each of them.

A test that is not slow contains losses at the edge, so that the work it gives is an upper bound.
Three signs show it: residuals above the noise, a modulus that contradicts the known one, and, with
a known material, a force by :func:`viscotack.advise` above that of the slowest retraction.

Of a folder of curves each retraction gives work, modulus and, against depth, the unknown zero of
the depth, by least squares. Their standard errors are those of the linearised model,
:math:`s^2 (J^T J)^{-1}` with the scatter s of the residuals: they contain the noise of one curve
only. Curves of equal temperature and speed are averaged; the interval of a mean is Student's, from
the scatter between the curves. The work is that of the fastest place of the edge: of a viscoelastic
solid it grows with speed and is an upper bound of the work of adhesion.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.stats import t

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.tack import Cycle
from viscotack.lab.tack.record import Measured
from viscotack.lab.tack.repeats import same_speeds, temperature_of
from viscotack.model.geometry import Sphere
from viscotack.model.materials import Material
from viscotack.model.materials.passport import Passport, allowed
from viscotack.model.problem import Problem
from viscotack.model.protocol import AtForce, Retraction
from viscotack.model.traction import LennardJones
from viscotack.prediction.advice import advise
from viscotack.theory import maugis, transition
from viscotack.units import readable, readable_interval

from .approach import of_every
from .contacts import MODELS, RANGES, ElasticModel
from .likelihood import EVIDENCE, Best, Interval, Objective, Parameter
from .rate_series import assumed_temperature
from .words import interval_words

_FEWEST, _MOST = 12, 300  # numbers of points
_QUIET = 1e-6  # smallest noise over the pull-off force
_HOPELESS = 20.0  # difference of the criterion above which no intervals are computed
_LOUD = 2.0  # residuals over the noise above which no elastic law holds
_APART = 3.0  # deviations of the fitted from the given modulus above which they contradict
_SLOW = 1.05  # force over the slow force up to which a test is slow
_SHORT = 5.0  # Tabor number of the comparison where the data determine none
_SAME = 0.02  # relative difference up to which the works of two models are one answer
_STARTS = (0.15, 0.4, 0.65, 0.9)  # parts of a range at which a search begins


@dataclass(frozen=True, eq=False)
class SlowTest:
    """Points of a slow retraction up to the pull-off.

    Parameters
    ----------
    force : array_like, shape (N,)
        Force, compression positive [N].
    at : array_like, shape (N,)
        Contact radius or depth [m].
    against : {"radius", "depth"}
        Meaning of `at`. The unknown zero of a depth is fitted.
    radius : float
        Radius of the sphere [m].
    force_noise : float
        Standard deviation of single forces [N].
    at_noise : float
        Standard deviation of single radii or depths [m].
    speed, preload : float, optional
        Speed of the retraction [m/s] and force at its start [N], to compare with the force of a
        known material.
    temperature : float, optional
        Temperature of the test [K].
    """

    force: Array
    at: Array
    against: str
    radius: float
    force_noise: float
    at_noise: float = 0.0
    speed: float | None = None
    preload: float | None = None
    temperature: float | None = None

    def __post_init__(self):
        for name in ("force", "at"):
            row = np.array(getattr(self, name), dtype=float)
            row.flags.writeable = False
            object.__setattr__(self, name, row)
        if self.against not in ("radius", "depth"):
            raise InputError(f"against must be 'radius' or 'depth', got {self.against!r}")
        rows = self.force, self.at
        if rows[0].ndim != 1 or rows[0].shape != rows[1].shape or not np.all(np.isfinite(rows)):
            raise InputError("force and at must be finite, one-dimensional and of one length")
        if self.force.size < _FEWEST:
            raise InputError(f"a fit needs at least {_FEWEST} points, got {self.force.size}")
        for name in ("radius", "force_noise"):
            if not 0 < getattr(self, name) < np.inf:
                raise InputError(f"{name} must be positive, got {getattr(self, name)}")
        if self.against == "radius" and np.any(self.at <= 0):
            raise InputError(f"contact radii must be positive, got {readable(self.at.min(), 'm')}")
        if not self.force.min() < 0:
            raise InputError("no force is tensile; check the sign (compression positive)")

    @cached_property
    def sigma(self) -> Array:
        """Uncertainty of each force [N], including that of its radius or depth."""
        if not self.at_noise:
            return np.full(self.force.size, self.force_noise)
        order = np.argsort(self.at)
        smooth = np.polynomial.Polynomial.fit(self.at[order], self.force[order], 4)
        return np.hypot(self.force_noise, self.at_noise * smooth.deriv()(self.at))


def slow_test(cycle: Cycle, radius: float, against: str | None = None) -> SlowTest:
    """Return the retraction of a cycle up to its pull-off as a slow test.

    By default `against` is "radius" if a camera measured contact radii, otherwise "depth".
    """
    points = np.arange(cycle.segments.retract, cycle.pull_off_at + 1)
    size = cycle.contact_radius
    if against is None:
        against = "depth" if size is None else "radius"
    if against == "radius" and size is None:
        raise InputError("the test has no contact radius; set against='depth'")
    at = cycle.depth if against == "depth" or size is None else size
    points = points[np.isfinite(at[points]) & ((against == "depth") | (at[points] > 0))]
    if points.size < _FEWEST:
        raise InputError(f"a fit needs at least {_FEWEST} points up to the pull-off")
    chosen = points[np.unique(np.linspace(0, points.size - 1, _MOST, dtype=int))]
    noise = max(cycle.noise, _QUIET * cycle.pull_off_force.value)
    return SlowTest(
        cycle.force[chosen],
        at[chosen],
        against,
        radius,
        noise,
        speed=cycle.speed.value,
        preload=cycle.preload.value,
        temperature=cycle.temperature,
    )


@dataclass(frozen=True)
class ModelFit:
    """Fit of one model to a slow test.

    Parameters
    ----------
    model : str
        "jkr", "dmt", "maugis" or "carpick".
    values : mapping
        All fitted values, by the names of the model.
    intervals : dict of str to Interval
        Profile likelihood intervals of "work_of_adhesion", "contact_modulus" and, where a range is
        fitted, "tabor"; empty if another model is far more likely.
    scatter : float
        Standard deviation of the residuals [N].
    criterion : float
        Bayesian information criterion; smaller is better.
    """

    model: str
    values: Mapping[str, float]
    intervals: dict[str, Interval]
    scatter: float
    criterion: float

    @property
    def work_of_adhesion(self) -> float:
        """Work of adhesion [J/m2]."""
        return self.values["work_of_adhesion"]

    @property
    def contact_modulus(self) -> float:
        """Contact modulus E0* [Pa]."""
        return self.values["contact_modulus"]

    @property
    def tabor(self) -> float | None:
        """Tabor number of a Lennard-Jones contact with the same work and strength, if fitted."""
        name = MODELS[self.model].range_parameter
        return None if name is None else _tabor(name, self.values[name])


@dataclass(frozen=True)
class SamePull:
    """The pull of a slow test, on the viscoelastic solid.

    Parameters
    ----------
    work, gap : float
        Interface [J/m2] and [m], the fitted one that amplifies least.
    assumed : float or None
        Tabor number that is assumed because the data determine none.
    ratio : float or None
        Its force over that of the slowest retraction; None if unknown.
    error : str
        Reason why no method has this force.
    """

    work: float
    gap: float
    assumed: float | None
    ratio: float | None = None
    error: str = ""

    @property
    def fast(self) -> bool:
        """Whether the edge dissipates, so that the test was not slow."""
        return self.ratio is not None and self.ratio > _SLOW


@dataclass(frozen=True)
class SlowTestFit:
    """Models fitted to a slow test, ranked by evidence.

    Parameters
    ----------
    test : SlowTest
        Fitted test.
    fits : tuple of ModelFit
        Fits, best first.
    level : float
        Confidence level of the intervals.
    residual : float
        Scatter of the best model over the noise.
    modulus : (float, float) or None
        Given contact modulus and its standard uncertainty [Pa].
    material : Passport, Material or None
        Solid of the test.
    same_pull : SamePull or None
        This pull on that solid, if speed and preload are known.
    """

    test: SlowTest
    fits: tuple[ModelFit, ...]
    level: float
    residual: float
    modulus: tuple[float, float] | None = None
    material: Passport | Material | None = None
    same_pull: SamePull | None = None

    @property
    def best(self) -> ModelFit:
        """The model with the best criterion."""
        return self.fits[0]

    @property
    def alike(self) -> tuple[ModelFit, ...]:
        """Fits that the data do not distinguish from the best, which is first."""
        most = self.best.criterion + EVIDENCE
        return tuple(fit for fit in self.fits if fit.criterion < most)

    @property
    def ranged(self) -> ModelFit | None:
        """The best model with an interval of the range of attraction."""
        return next((one for one in self.fits if "tabor" in one.intervals), None)

    @property
    def undetermined(self) -> bool:
        """Whether models that the data do not distinguish give different works of adhesion."""
        works = [fit.work_of_adhesion for fit in self.alike]
        return max(works) > (1 + _SAME) * min(works)

    @cached_property
    def upper_bound(self) -> tuple[str, ...]:
        """Reasons why the work is an upper bound; empty for a slow test."""
        return tuple(_upper_bound(self))

    @property
    def work_of_adhesion(self) -> Interval:
        """Interval over models that the data do not distinguish [J/m2].

        Without a lower end if the test is not slow.
        """
        ends = [fit.intervals["work_of_adhesion"] for fit in self.alike]
        high = max(end.high for end in ends)
        if self.upper_bound:
            # of all elastic laws JKR needs the largest work for a force
            of_jkr = -float(self.test.force.min()) / (1.5 * np.pi * self.test.radius)
            return Interval(0.0, max(high, of_jkr), False, True)
        closed = (all(end.closed_below for end in ends), all(end.closed_above for end in ends))
        return Interval(min(end.low for end in ends), high, *closed)

    @cached_property
    def words(self) -> tuple[str, ...]:
        """Sentences on the result and on what the data do not determine."""
        return tuple(_words(self))


def identify_slow(
    test: SlowTest,
    *,
    models: Sequence[str] = tuple(MODELS),
    contact_modulus: tuple[float, float] | None = None,
    material: Passport | Material | None = None,
    level: float = 0.9,
) -> SlowTestFit:
    """Fit elastic models to a slow test and rank them by evidence.

    Parameters
    ----------
    test : SlowTest
        Forces against contact radii or depths.
    models : sequence of str
        Any of "jkr", "dmt", "maugis" and "carpick".
    contact_modulus : (float, float), optional
        E0* of the relaxed solid and its standard uncertainty [Pa]. By default that of the
        material, if its uncertainty is known; else it is fitted without a prior.
    material : Passport or Material, optional
        Solid of the test. The force that :func:`viscotack.advise` gives for it decides whether the
        test was slow. A passport is used at the temperature of the test.
    level : float
        Confidence level of the intervals.

    Raises
    ------
    ValueError
        If a model is unknown, or has no depth while the test is against depth.

    Notes
    -----
    A test whose edge is a viscoelastic crack is NOT slow: the energy at the edge
    changes along the curve, and an elastic fit interprets that as a range of attraction. The
    sentences of the result report residuals above the noise; docs/tack_tests.md shows the error.

    Examples
    --------
    >>> from viscotack.theory import jkr
    >>> sphere = dict(radius=5e-3, contact_modulus=1e6, work_of_adhesion=0.15)
    >>> a = np.linspace(1.6e-4, 4e-4, 40)
    >>> force = jkr.force(a, **sphere) + 1e-6 * np.cos(np.arange(40) ** 2)
    >>> fit = identify_slow(SlowTest(force, a, "radius", 5e-3, 1e-6), models=["jkr", "dmt"])
    >>> fit.best.model, f"{fit.best.work_of_adhesion:.3f} J/m2"
    ('jkr', '0.150 J/m2')
    """
    if not 0 < level < 1:
        raise InputError(f"level must lie between 0 and 1, got {level!r}")
    if contact_modulus is not None and not (0 < contact_modulus[1] < contact_modulus[0] < np.inf):
        raise InputError(
            "contact_modulus must be a value [Pa] and a smaller uncertainty [Pa], got "
            f"{contact_modulus!r}"
        )
    for name in models:
        if name not in MODELS:
            raise InputError(f"models must be among {', '.join(MODELS)}; got {name!r}")
    chosen = [MODELS[name] for name in dict.fromkeys(models)]
    chosen = [model for model in chosen if test.against == "radius" or model.by_depth is not None]
    if not chosen:
        raise InputError("Carpick's equation has no depth; fit another model, or contact radii")
    solid, of_solid = _at_temperature(material, test.temperature)
    modulus = contact_modulus or of_solid
    size, fitted = with_own_scatter(test, chosen, modulus)
    each = float(np.log(test.force.size))
    criteria = [best.misfit + len(objective.parameters) * each for objective, best in fitted]
    fits = []
    for model, (objective, best), criterion in zip(chosen, fitted, criteria, strict=True):
        intervals = {}
        if criterion < min(criteria) + _HOPELESS:
            names = ("work_of_adhesion", "contact_modulus")
            intervals = {name: objective.interval(name, best, level) for name in names}
            if (name := model.range_parameter) is not None:
                ends = objective.interval(name, best, level)
                low, high = _tabor(name, ends.low), _tabor(name, ends.high)
                intervals["tabor"] = replace(ends, low=low, high=high, split=False)
        rest = objective.residuals(best.values)
        scatter = float(np.sqrt(np.mean(rest**2))) * size * test.force_noise
        fits.append(ModelFit(model.name, best.values, intervals, scatter, criterion))
    fits.sort(key=lambda fit: fit.criterion)
    found = SlowTestFit(test, tuple(fits), level, size, modulus, material)
    return replace(found, same_pull=_same_pull(found, solid))


def _at_temperature(
    given: Passport | Material | None, temperature: float | None
) -> tuple[Material | None, tuple[float, float] | None]:
    """Return a material at a temperature, and its E0* with uncertainty if known."""
    if given is None:
        return None, None
    passport = Passport.of(given)
    passport.refuse_liquid("no test is slow, because the solid does not relax")
    if temperature is not None and passport.temperature is not None:
        passport = passport.moved_to(temperature)
    rubbery = [float(solid.rubbery_modulus) for solid in allowed(passport)]
    spread, material = float(np.std(rubbery)) if rubbery else 0.0, passport.material
    plane = 1 - material.poisson_ratio**2
    return material, (material.rubbery_modulus / plane, spread / plane) if spread else None


def _same_pull(fit: SlowTestFit, solid: Material | None) -> SamePull | None:
    """Compute the force of the same pull on the viscoelastic solid.

    The interface is the fitted one with the largest range that the fits allow, which amplifies
    least. A test that is not slow has a wrong range.
    """
    test, alike = fit.test, fit.alike
    if solid is None or test.speed is None or test.preload is None:
        return None
    work, tabor = max(one.work_of_adhesion for one in alike), None
    if not fit.upper_bound and fit.ranged is not None and fit.ranged in alike:
        ends = fit.ranged.intervals["tabor"]
        if ends.told or (ends.closed_below and ends.low > _SHORT):
            tabor = ends.low
    gap = (test.radius * work**2 / solid.contact_modulus**2) ** (1 / 3) / (tabor or _SHORT)
    found = SamePull(work, gap, _SHORT if tabor is None else None)
    try:
        pull = Problem(
            material=solid,
            geometry=Sphere(test.radius),
            traction=LennardJones(work_of_adhesion=work, equilibrium_gap=gap),
            protocol=Retraction(start=AtForce(test.preload), speed=test.speed),
        )
        return replace(found, ratio=advise(pull).amplification)
    except InputError as error:
        return replace(found, error=str(error))


def with_own_scatter(
    test: SlowTest, models: Sequence[ElasticModel], modulus: tuple[float, float] | None
) -> tuple[float, list[tuple[Objective, Best]]]:
    """Return the scatter of the best model over the noise, and all models fitted with it."""
    bests = []
    for model in models:
        objective = _objective(model, test, test.sigma, modulus)
        # the range has several local minima
        ranges = [one for one in objective.parameters if one.name in RANGES]
        found = [objective.best(), *(objective.best_along(one, _STARTS) for one in ranges)]
        bests.append(min(found, key=lambda best: best.misfit))
    least = min(best.misfit for best in bests)
    size = float(max(np.sqrt(least / max(test.force.size - 3, 1)), 1e-6))
    objectives = [_objective(model, test, size * test.sigma, modulus) for model in models]
    rows = zip(objectives, bests, strict=True)
    return size, [(objective, objective.best(near=near)) for objective, near in rows]


def _objective(
    model: ElasticModel, test: SlowTest, sigma: Array, modulus: tuple[float, float] | None
) -> Objective:
    """Return residuals over their standard deviations, and the unknowns, of a model."""
    w, E = _start(test, None if modulus is None else modulus[0])
    prior = None if modulus is None else (modulus[0], modulus[1] / modulus[0])
    parameters = [
        Parameter("work_of_adhesion", 1e-3 * w, 1e3 * w, w),
        Parameter("contact_modulus", 1e-3 * E, 1e3 * E, E, prior=prior),
    ]
    if model.range_parameter is not None:
        parameters.append(RANGES[model.range_parameter])
    if test.against == "depth":
        scale = float(np.ptp(test.at)) + (test.radius * w**2 / E**2) ** (1 / 3)
        parameters.append(Parameter("zero", -scale, scale, 0.01 * scale, logarithmic=False))

    def residuals(values: Mapping[str, float]) -> Array:
        return (fitted_force(test, model.name, values) - test.force) / sigma

    return Objective(residuals, tuple(parameters))


def fitted_force(test: SlowTest, name: str, values: Mapping[str, float]) -> Array:
    """Return the forces of a model with its fitted values at the points of a test [N]."""
    model = MODELS[name]
    if test.against == "radius":
        return model.by_radius(test.at, values, test.radius)
    assert model.by_depth is not None, "models without a depth were rejected"
    return model.by_depth(test.at - values["zero"], values, test.radius)


def _start(test: SlowTest, modulus: float | None) -> tuple[float, float]:
    """Return initial values of work of adhesion and contact modulus."""
    R, pull = test.radius, -float(test.force.min())
    w = pull / (1.5 * np.pi * R)
    if modulus is not None:
        return w, modulus
    top = int(np.argmax(test.at))
    if test.against == "radius":
        # JKR at the largest radius, solved for the square root of the modulus
        a, P = float(test.at[top]), float(test.force[top])
        b, c = np.sqrt(8 * np.pi * a**3 * w), 4 * a**3 / (3 * R)
        return w, float(((b + np.sqrt(max(b**2 + 4 * c * P, 0.0))) / (2 * c)) ** 2)
    span = float(np.ptp(test.at))
    return w, float(0.75 * np.ptp(test.force) / np.sqrt(R) / max(span, 1e-12) ** 1.5)


def _tabor(name: str, value: float) -> float:
    """Return the Tabor number of a Lennard-Jones contact of the same work and strength."""
    lam = value if name == "maugis_parameter" else float(transition.maugis_parameter(value))
    return lam / float(maugis.parameter_from_tabor(1.0))


def _upper_bound(fit: SlowTestFit) -> Iterator[str]:
    """Yield the reasons why the work of a fit is an upper bound; none for a slow test."""
    if fit.residual > _LOUD:
        yield (
            f"residuals are {fit.residual:.2g} times the noise: no elastic law fits. If the test "
            "was not slow, energy dissipated at a viscoelastic edge appears as a longer range; use "
            "a slower test, or `viscotack identify rates`"
        )
    if fit.modulus is not None:
        (given, uncertainty), found = fit.modulus, fit.best.contact_modulus
        apart = abs(np.log(found / given)) * given / uncertainty
        if apart > _APART:
            yield (
                f"the fitted E0* {readable(found, 'Pa')} is {apart:.2g} standard deviations from "
                f"the given {readable(given, 'Pa')} +- {readable(uncertainty, 'Pa')}: the contact "
                "was not that of the relaxed solid, or the given modulus or the compliance of the "
                "rig is wrong"
            )
    if fit.same_pull is not None and fit.same_pull.fast:
        yield (
            f"{_of_pull(fit, fit.same_pull)}: the test was not slow. Use a slower test, or "
            "`viscotack identify rates`"
        )


def _words(fit: SlowTestFit) -> Iterator[str]:
    """Yield sentences on the result and on what the data do not determine."""
    alike, reasons, level = fit.alike, fit.upper_bound, fit.level
    names = [one.model.upper() for one in alike]
    if reasons:
        most = readable(fit.work_of_adhesion.high, "J/m2")
        yield (
            f"the work of adhesion is at most {most} ({level:.0%}), an upper bound: an elastic fit "
            "does not determine it from this test"
        )
        yield from reasons
    elif fit.undetermined:
        works = [_work(one, one.intervals["work_of_adhesion"], level) for one in alike]
        by_each = " or ".join(f"{x} by {name}" for x, name in zip(works, names, strict=True))
        yield (
            f"the work of adhesion is undetermined between models: {by_each} (criteria "
            f"{alike[1].criterion - alike[0].criterion:.1f} apart, {EVIDENCE:g} would be "
            "evidence); contact radii from a camera, or E0* with its uncertainty, distinguish them"
        )
    else:
        work = _work(alike[0], fit.work_of_adhesion, level)
        yield f"work of adhesion {work} by {' and '.join(names)}"
    if len(names) > 1 and (reasons or not fit.undetermined):
        others = " and ".join(names[1:])
        yield f"the data do not distinguish {names[0]} from {others} (criteria within {EVIDENCE:g})"
    if fit.ranged is not None and not reasons:
        ends, name = fit.ranged.intervals["tabor"], fit.ranged.model.upper()
        said = interval_words("Tabor number", "", fit.ranged.tabor or np.nan, ends, level)
        if ends.told:
            yield f"{said} by {name}"
        elif ends.closed_below and "DMT" not in names:
            yield f"{said} ({name}), hence no range of attraction: JKR is sufficient"
        elif ends.closed_above and "JKR" not in names:
            yield f"{said} ({name}): DMT is sufficient"
        else:
            yield f"these data do not determine the range of attraction ({name})"
    if fit.test.against == "depth":
        yield "the zero of depth was also fitted; without a camera the range is poorly determined"
    if fit.same_pull is None and fit.material is not None:
        yield "without speed and preload the material cannot show whether the test was slow"
    if fit.same_pull is not None and not fit.same_pull.fast:
        yield _of_pull(fit, fit.same_pull)
    if isinstance(fit.material, Passport):
        known = () if fit.test.temperature is None else (fit.test.temperature,)
        yield from assumed_temperature(fit.material, known)


def _of_pull(fit: SlowTestFit, pull: SamePull) -> str:
    """Return whether the test was slow on its material."""
    at = (
        f"at {readable(fit.test.speed or 0.0, 'm/s')}, {readable(pull.work, 'J/m2')} and a range "
        f"of {readable(pull.gap, 'm', digits=2)}"
    )
    if pull.assumed is not None:
        at += f" (an assumed Tabor number of {pull.assumed:g}: the data do not determine it)"
    if pull.ratio is None:
        why = pull.error or "simulate this pull"
        return f"whether the test was slow is not known {at}: {why}"
    said = f"the material gives {pull.ratio:.4g} times the slow force {at}"
    return said if pull.fast else f"{said}: the test was slow"


def _work(fit: ModelFit, ends: Interval, level: float) -> str:
    both = readable_interval(ends.low, ends.high, "J/m2")
    return f"{readable(fit.work_of_adhesion, 'J/m2')} ({both}, {level:.0%})"


@dataclass(frozen=True, eq=False)
class CurveFit:
    """Elastic contact fitted to one retraction.

    Attributes
    ----------
    cycle : Cycle
        The curve.
    model : str
        "jkr" or "dmt".
    test : SlowTest
        Its fitted points.
    values : mapping
        All fitted values, by the names of the model.
    work_of_adhesion, contact_modulus : Measured
        [J/m2] and [Pa], with the standard error of the fit.
    scatter : float
        Standard deviation of the residuals [N].
    """

    cycle: Cycle
    model: str
    test: SlowTest
    values: Mapping[str, float]
    work_of_adhesion: Measured
    contact_modulus: Measured
    scatter: float


@dataclass(frozen=True)
class Mean:
    """Mean of repeated curves, their standard deviation, and the interval of the mean.

    The deviation and the ends are None for a single curve.
    """

    value: float
    deviation: float | None
    low: float | None
    high: float | None


@dataclass(frozen=True, eq=False)
class CurveGroup:
    """Curves of one temperature [K] and speed [m/s], and their means [J/m2], [Pa] and [N]."""

    curves: tuple[CurveFit, ...]
    temperature: float | None
    speed: float
    work_of_adhesion: Mean
    contact_modulus: Mean
    pull_off_force: Mean


def fit_curves(
    cycles: Sequence[Cycle],
    radius: float,
    *,
    model: str = "jkr",
    contact_modulus: tuple[float, float] | None = None,
) -> tuple[tuple[CurveFit, ...], tuple[str, ...]]:
    """Fit JKR or DMT to the retraction of every cycle.

    Parameters
    ----------
    cycles : sequence of Cycle
        Evaluated cycles of tack tests or force curves.
    radius : float
        Radius of the sphere [m].
    model : {"jkr", "dmt"}
        Elastic contact, of a large or a small Tabor number.
    contact_modulus : (float, float), optional
        Known E0* and its standard uncertainty [Pa]; fitted without a prior by default.

    Returns
    -------
    fits : tuple of CurveFit
        Of the curves that can be fitted.
    refused : tuple of str
        The others, each with its reason.

    Raises
    ------
    InputError
        If the model is another one.
    """
    if model not in ("jkr", "dmt"):
        raise InputError(f"model must be jkr or dmt, got {model!r}", field="model")

    def fitted(cycle: Cycle) -> CurveFit:
        test = slow_test(cycle, radius)
        size, ((objective, best),) = with_own_scatter(test, [MODELS[model]], contact_modulus)
        errors = np.sqrt(np.diag(objective.covariance(best)))
        work, modulus = (
            Measured(best.values[one.name], float(error) * best.values[one.name])
            for one, error in zip(objective.parameters[:2], errors, strict=False)
        )
        scatter = float(size * np.mean(test.sigma))
        return CurveFit(cycle, model, test, best.values, work, modulus, scatter)

    return of_every(cycles, fitted)


def group_curves(fits: Sequence[CurveFit], level: float = 0.9) -> tuple[CurveGroup, ...]:
    """Return the means of the curves of each temperature and speed, coldest and slowest first.

    Parameters
    ----------
    fits : sequence of CurveFit
        Of :func:`fit_curves`.
    level : float
        Confidence level of the intervals of the means.
    """
    if not 0 < level < 1:
        raise InputError(f"level must lie between 0 and 1, got {level!r}", field="level")
    groups = []
    for same in same_speeds([fit.cycle for fit in fits]):
        # in the order of the files, which shows a drift
        curves = tuple(fit for fit in fits if any(fit.cycle is cycle for cycle in same))
        work = _mean([fit.work_of_adhesion.value for fit in curves], level)
        modulus = _mean([fit.contact_modulus.value for fit in curves], level)
        force = _mean([one.pull_off_force.value for one in same], level)
        speed = float(np.mean([one.speed.value for one in same]))
        groups.append(CurveGroup(curves, temperature_of(same), speed, work, modulus, force))
    return tuple(groups)


def _mean(values: Sequence[float], level: float) -> Mean:
    mean = float(np.mean(values))
    if len(values) == 1:
        return Mean(mean, None, None, None)
    deviation = float(np.std(values, ddof=1))
    half = float(t.ppf((1 + level) / 2, len(values) - 1)) * deviation / np.sqrt(len(values))
    return Mean(mean, deviation, mean - half, mean + half)
