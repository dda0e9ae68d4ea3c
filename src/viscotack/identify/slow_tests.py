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
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.geometry import Sphere
from viscotack.lab.tack import Cycle
from viscotack.materials import Material
from viscotack.materials.passport import Passport
from viscotack.materials.passport_uncertainty import allowed
from viscotack.prediction import advise
from viscotack.problem import Problem
from viscotack.protocol import AtForce, Retraction
from viscotack.theory import maugis, transition
from viscotack.traction import LennardJones
from viscotack.units import readable, readable_interval

from .contacts import MODELS, ElasticModel
from .objective import Best, Interval, Objective, Parameter
from .temperatures import assumed_temperature

_FEWEST = 12  # smallest number of points
_MOST = 300
_DIFFERENT = 6.0  # difference of the criterion: strong evidence
_HOPELESS = 20.0  # difference of the criterion above which no intervals are computed
_LOUD = 2.0  # residuals over the noise above which no elastic law holds
_APART = 3.0  # deviations of the fitted from the given modulus above which they contradict
_SLOW = 1.05  # force over the slow force up to which a test is slow
_SHORT = 5.0  # Tabor number of the comparison where the data determine none
_SAME = 0.02  # relative difference up to which the works of two models are one answer
_LAMBDA = (0.02, 60.0)  # searched Maugis parameters
_TRANSITION = (1e-3, 0.979)


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
        if self.force.shape != self.at.shape or self.force.ndim != 1:
            raise InputError(
                "force and at must be one-dimensional arrays of the same length, got shapes "
                f"{self.force.shape} and {self.at.shape}"
            )
        if self.force.size < _FEWEST:
            raise InputError(f"a fit needs at least {_FEWEST} points, got {self.force.size}")
        if not np.all(np.isfinite(self.force) & np.isfinite(self.at)):
            raise InputError("forces and radii or depths must be finite")
        if not (0 < self.radius < np.inf and 0 < self.force_noise < np.inf):
            raise InputError(
                f"radius and force_noise must be positive, got {self.radius} m and "
                f"{self.force_noise} N"
            )
        if self.against == "radius" and np.any(self.at <= 0):
            raise InputError(f"contact radii must be positive, got {readable(self.at.min(), 'm')}")
        if not self.force.min() < 0:
            raise InputError(
                "no force is tensile, so adhesion cannot be determined; check the sign "
                "(compression positive)"
            )


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
        raise InputError(
            f"a fit needs at least {_FEWEST} points up to the pull-off, got {points.size}"
        )
    chosen = points[np.unique(np.linspace(0, points.size - 1, _MOST, dtype=int))]
    noise = max(cycle.noise, 1e-6 * cycle.pull_off_force.value)
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
    work_of_adhesion, contact_modulus : float
        Fitted values [J/m2] and [Pa].
    tabor : float or None
        Tabor number of a Lennard-Jones contact with the same work and strength; None for the
        limits JKR and DMT.
    intervals : dict of str to Interval
        Profile likelihood intervals of the same quantities; empty if another model is far more
        likely.
    scatter : float
        Standard deviation of the residuals [N].
    criterion : float
        Bayesian information criterion; smaller is better.
    values : mapping
        All fitted values, by the names of the model.
    """

    model: str
    work_of_adhesion: float
    contact_modulus: float
    tabor: float | None
    intervals: dict[str, Interval]
    scatter: float
    criterion: float
    values: Mapping[str, float]


@dataclass(frozen=True)
class SlowTestFit:
    """Models fitted to a slow test, ranked by evidence.

    Parameters
    ----------
    test : SlowTest
        Fitted test.
    fits : tuple of ModelFit
        Fits, best first.
    alike : tuple of ModelFit
        Those that the data do not distinguish from the best, which is first.
    level : float
        Confidence level of the intervals.
    evidence : str
        Criterion by which the model was chosen.
    work_of_adhesion : Interval
        Interval that covers all models that the data do not distinguish [J/m2]; without a lower
        end if the test is not slow.
    upper_bound : tuple of str
        Reasons why the work is an upper bound; empty for a slow test.
    words : tuple of str
        Sentences on the result and on what the data do not determine.
    """

    test: SlowTest
    fits: tuple[ModelFit, ...]
    alike: tuple[ModelFit, ...]
    level: float
    evidence: str
    work_of_adhesion: Interval
    upper_bound: tuple[str, ...]
    words: tuple[str, ...]

    @property
    def best(self) -> ModelFit:
        """The model with the best criterion."""
        return self.fits[0]

    @property
    def undetermined(self) -> bool:
        """Whether models that the data do not distinguish give different works of adhesion."""
        return _differ(self.alike)


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
    chosen = [_known(name) for name in dict.fromkeys(models)]
    chosen = [model for model in chosen if test.against == "radius" or model.by_depth is not None]
    if not chosen:
        raise InputError("Carpick's equation has no depth; fit another model, or contact radii")
    solid, of_solid, remarks = _at_temperature(material, test.temperature)
    contact_modulus = contact_modulus or of_solid
    sigma = _sigma(test)
    first = [_objective(model, test, sigma, contact_modulus) for model in chosen]
    bests = [_found(objective) for objective in first]
    # the scatter of the best model replaces the noise if it is larger
    least = min(bests, key=lambda best: best.misfit)
    size = max(np.sqrt(least.misfit / max(test.force.size - 3, 1)), 1e-6)
    fits = []
    for model, best in zip(chosen, bests, strict=True):
        objective = _objective(model, test, size * sigma, contact_modulus)
        refined = objective.best(near=best)
        fits.append((_criterion(refined, objective, test), model, objective, refined))
    fits.sort(key=lambda fit: fit[0])
    fits = [
        _model_fit(*rest, criterion, test, level, size)
        if criterion < fits[0][0] + _HOPELESS
        else _model_fit(*rest, criterion, test, None, size)
        for criterion, *rest in fits
    ]
    alike = [fit for fit in fits if fit.criterion - fits[0].criterion < _DIFFERENT]
    reasons = [*_of_residuals(size), *_of_modulus(fits[0], contact_modulus)]
    # a test that is not slow has a wrong range
    too_fast, unchecked = _of_material([] if reasons else fits, alike, test, solid)
    reasons += too_fast
    work = _work(alike, test, bool(reasons))
    return SlowTestFit(
        test,
        tuple(fits),
        tuple(alike),
        level,
        "Bayesian information criterion, chi2 + k ln n, with the scatter of the best model",
        work,
        tuple(reasons),
        (*_words(test, fits, alike, work, reasons, level), *unchecked, *remarks),
    )


def _at_temperature(
    given: Passport | Material | None, temperature: float | None
) -> tuple[Material | None, tuple[float, float] | None, list[str]]:
    """Return a material at a temperature, its E0* with uncertainty if known, and a remark."""
    if not isinstance(given, Passport):
        return given, None, []
    given.refuse_liquid("no test is slow, because the solid does not relax")
    remarks = assumed_temperature(given, () if temperature is None else (temperature,))
    if temperature is not None and given.temperature is not None:
        given = given.moved_to(temperature)
    rubbery = [float(solid.rubbery_modulus) for solid in allowed(given)]
    spread = float(np.std(rubbery)) if len(rubbery) > 1 else 0.0
    plane = 1 - given.material.poisson_ratio**2
    modulus = (given.material.rubbery_modulus / plane, spread / plane) if spread else None
    return given.material, modulus, remarks


def _of_residuals(size: float) -> list[str]:
    if size <= _LOUD:
        return []
    return [
        f"residuals are {size:.2g} times the noise: no elastic law fits. If the test was not "
        "slow, energy dissipated at a viscoelastic edge appears as a longer range; use a slower "
        "test, or `viscotack identify rates`"
    ]


def _of_modulus(best: ModelFit, given: tuple[float, float] | None) -> list[str]:
    """Return a reason if the fitted modulus contradicts the given one."""
    if given is None:
        return []
    deviations = abs(np.log(best.contact_modulus / given[0])) * given[0] / given[1]
    if deviations <= _APART:
        return []
    return [
        f"the fitted E0* {readable(best.contact_modulus, 'Pa')} is {deviations:.2g} standard "
        f"deviations from the given {readable(given[0], 'Pa')} +- {readable(given[1], 'Pa')}: "
        "the contact was not that of the relaxed solid, or the given modulus or the compliance of "
        "the rig is wrong"
    ]


def _of_material(
    fits: list[ModelFit], alike: list[ModelFit], test: SlowTest, solid: Material | None
) -> tuple[list[str], list[str]]:
    """Return a reason if the material gives more than the slow force, and a remark if unknown.

    The interface is the fitted one with the largest range that the fits allow, which amplifies
    least.
    """
    if solid is None:
        return [], []
    if test.speed is None or test.preload is None:
        return [], ["without speed and preload the material cannot show whether the test was slow"]
    work, tabor = max(fit.work_of_adhesion for fit in alike), None
    ranged = next((fit for fit in fits if "tabor" in fit.intervals), None)
    if ranged is not None and ranged in alike:
        ends = ranged.intervals["tabor"]
        if ends.told or (ends.closed_below and ends.low > _SHORT):
            tabor = ends.low
    gap = (test.radius * work**2 / solid.contact_modulus**2) ** (1 / 3) / (tabor or _SHORT)
    said = (
        f"at {readable(test.speed, 'm/s')}, {readable(work, 'J/m2')} and a range of "
        f"{readable(gap, 'm', digits=2)}"
    )
    if tabor is None:
        said += f", assumed at a Tabor number of {_SHORT:g} because the data do not determine it"
    try:
        pull = Problem(
            material=solid,
            geometry=Sphere(test.radius),
            traction=LennardJones(work_of_adhesion=work, equilibrium_gap=gap),
            protocol=Retraction(start=AtForce(test.preload), speed=test.speed),
        )
        ratio = advise(pull).amplification
    except InputError as error:
        return [], [f"whether the test was slow is not checked {said}: {error}"]
    if ratio is None:
        return [], [f"whether the test was slow is not known {said}: simulate this pull"]
    if ratio <= _SLOW:
        return [], [
            f"the material gives {ratio:.4g} times the slow force {said}: the test was slow"
        ]
    return [
        f"the material gives {ratio:.3g} times the slow force {said}, a slow test at most "
        f"{_SLOW:g}: the test was not slow. Use a slower test, or `viscotack identify rates`"
    ], []


def _differ(alike: Sequence[ModelFit]) -> bool:
    works = [fit.work_of_adhesion for fit in alike]
    return max(works) > (1 + _SAME) * min(works)


def _work(alike: list[ModelFit], test: SlowTest, bounded: bool) -> Interval:
    """Return the interval of the work of adhesion over models that the data do not distinguish."""
    ends = [fit.intervals["work_of_adhesion"] for fit in alike]
    high = max(end.high for end in ends)
    if bounded:
        # of all elastic laws JKR needs the largest work for a force
        of_jkr = -float(test.force.min()) / (1.5 * np.pi * test.radius)
        return Interval(0.0, max(high, of_jkr), False, True)
    low = min(end.low for end in ends)
    return Interval(
        low, high, all(end.closed_below for end in ends), all(end.closed_above for end in ends)
    )


def _known(name: str) -> ElasticModel:
    if name not in MODELS:
        raise InputError(f"models must be among {', '.join(MODELS)}; got {name!r}")
    return MODELS[name]


def _sigma(test: SlowTest) -> Array:
    """Return the uncertainty of each force [N], including that of its radius or depth."""
    if not test.at_noise:
        return np.full(test.force.size, test.force_noise)
    order = np.argsort(test.at)
    smooth = np.polynomial.Polynomial.fit(test.at[order], test.force[order], 4)
    return np.hypot(test.force_noise, test.at_noise * smooth.deriv()(test.at))


def _objective(
    model: ElasticModel, test: SlowTest, sigma: Array, modulus: tuple[float, float] | None
) -> Objective:
    w, E = _start(test, None if modulus is None else modulus[0])
    prior = None if modulus is None else (modulus[0], modulus[1] / modulus[0])
    parameters = [
        Parameter("work_of_adhesion", 1e-3 * w, 1e3 * w, w),
        Parameter("contact_modulus", 1e-3 * E, 1e3 * E, E, prior=prior),
    ]
    if model.range_parameter == "maugis_parameter":
        parameters.append(Parameter("maugis_parameter", *_LAMBDA, 1.0))
    if model.range_parameter == "transition":
        parameters.append(Parameter("transition", *_TRANSITION, 0.6, logarithmic=False))
    if test.against == "depth":
        scale = float(np.ptp(test.at)) + (test.radius * w**2 / E**2) ** (1 / 3)
        parameters.append(Parameter("zero", -scale, scale, 0.01 * scale, logarithmic=False))
    return Objective(partial(_residuals, model, test, sigma), tuple(parameters))


def fitted_force(fit: ModelFit, test: SlowTest) -> Array:
    """Return the forces of a fitted model at the radii or depths of a test [N]."""
    return _force(MODELS[fit.model], test, fit.values)


def _force(model: ElasticModel, test: SlowTest, values: Mapping[str, float]) -> Array:
    if test.against == "radius":
        return model.by_radius(test.at, values, test.radius)
    assert model.by_depth is not None, "models without a depth were rejected"
    return model.by_depth(test.at - values["zero"], values, test.radius)


def _residuals(
    model: ElasticModel, test: SlowTest, sigma: Array, values: Mapping[str, float]
) -> Array:
    return (_force(model, test, values) - test.force) / sigma


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


def _found(objective: Objective) -> Best:
    """Return the best fit from several starts: the range has several local minima."""
    starts = [objective.best()]
    for parameter in objective.parameters:
        if parameter.name in ("maugis_parameter", "transition"):
            low, high = parameter.inner(parameter.low), parameter.inner(parameter.high)
            for part in (0.15, 0.4, 0.65, 0.9):
                held = {parameter.name: parameter.outer(low + part * (high - low))}
                starts.append(objective.best(near=objective.best(held)))
    return min(starts, key=lambda best: best.misfit)


def _criterion(best: Best, objective: Objective, test: SlowTest) -> float:
    return best.misfit + len(objective.parameters) * float(np.log(test.force.size))


def _model_fit(
    model: ElasticModel,
    objective: Objective,
    best: Best,
    criterion: float,
    test: SlowTest,
    level: float | None,
    size: float,
) -> ModelFit:
    """Return the fit of a model; without a level no intervals are computed."""
    intervals = {}
    if level is not None:
        names = ["work_of_adhesion", "contact_modulus"]
        intervals = {name: objective.interval(name, best, level) for name in names}
    tabor = None
    if (name := model.range_parameter) is not None:
        tabor = _tabor(name, best.values[name])
        if level is not None:
            ends = objective.interval(name, best, level)
            intervals["tabor"] = Interval(
                _tabor(name, ends.low), _tabor(name, ends.high), ends.closed_below,
                ends.closed_above,
            )  # fmt: skip
    rest = objective.residuals(best.values)
    return ModelFit(
        model.name,
        best.values["work_of_adhesion"],
        best.values["contact_modulus"],
        tabor,
        intervals,
        float(np.sqrt(np.mean(rest**2))) * size * test.force_noise,
        criterion,
        best.values,
    )


def _tabor(name: str, value: float) -> float:
    """Return the Tabor number of a Lennard-Jones contact of the same work and strength."""
    lam = value if name == "maugis_parameter" else float(transition.maugis_parameter(value))
    return lam / float(maugis.parameter_from_tabor(1.0))


def _words(
    test: SlowTest,
    fits: list[ModelFit],
    alike: list[ModelFit],
    work: Interval,
    reasons: list[str],
    level: float,
) -> list[str]:
    names = [fit.model.upper() for fit in alike]
    if reasons:
        said = [
            f"the work of adhesion is at most {readable(work.high, 'J/m2')} ({level:.0%}), an "
            "upper bound: an elastic fit does not determine it from this test",
            *reasons,
        ]
    elif _differ(alike):
        by_each = [
            f"{_with_interval(fit.work_of_adhesion, fit.intervals['work_of_adhesion'], level)} by "
            f"{fit.model.upper()}"
            for fit in alike
        ]
        apart = alike[1].criterion - alike[0].criterion
        said = [
            f"the work of adhesion is undetermined between models: {' or '.join(by_each)} "
            f"(criteria {apart:.1f} apart, {_DIFFERENT:g} would be evidence); contact radii from a "
            "camera, or E0* with its uncertainty, distinguish them"
        ]
    else:
        said = [
            f"work of adhesion {_with_interval(alike[0].work_of_adhesion, work, level)} by "
            f"{' and '.join(names)}"
        ]
    if len(names) > 1 and (reasons or not _differ(alike)):
        said.append(
            f"the data do not distinguish {names[0]} from {' and '.join(names[1:])} "
            f"(criteria within {_DIFFERENT:g})"
        )
    ranged = next((fit for fit in fits if "tabor" in fit.intervals), None)
    if ranged is not None and not reasons:
        said.append(_of_range(ranged, names, level))
    if test.against == "depth":
        said.append(
            "the zero of depth was also fitted; without a camera the range is poorly determined"
        )
    return said


def _with_interval(value: float, ends: Interval, level: float) -> str:
    both = readable_interval(ends.low, ends.high, "J/m2")
    return f"{readable(value, 'J/m2')} ({both}, {level:.0%})"


def _of_range(fit: ModelFit, alike: list[str], level: float) -> str:
    """Describe the range; `alike` are the models that the data do not distinguish."""
    ends = fit.intervals["tabor"]
    name = fit.model.upper()
    if ends.told:
        return (
            f"Tabor number {fit.tabor:.3g} ({ends.low:.3g} to {ends.high:.3g}, {level:.0%}) by "
            f"{name}"
        )
    if ends.closed_below and "DMT" not in alike:
        return (
            f"the Tabor number is above {ends.low:.3g} ({level:.0%}, {name}); these data give no "
            "upper bound, hence no range of attraction: JKR is sufficient"
        )
    if ends.closed_above and "JKR" not in alike:
        return (
            f"the Tabor number is below {ends.high:.3g} ({level:.0%}, {name}); these data give no "
            "lower bound: DMT is sufficient"
        )
    return f"these data do not determine the range of attraction ({name})"
