"""Conformance checks for tiers: they answer the problems that they list, and reject all others."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Protocol

import numpy as np

from viscotack.errors import OutOfRange
from viscotack.forecast import Prediction
from viscotack.forecast.prediction import MEASURED, NOT_MEASURED
from viscotack.geometry import FlatPunch, HalfSpace, Layer, Sphere
from viscotack.materials import Elastic, RetardationPowerLaw, StandardSolid
from viscotack.problem import Groups
from viscotack.protocol import AtForce
from viscotack.traction import LennardJones

from . import simulated
from .findings import Finding, Report, holds, refused, report, same


class Tier(Protocol):
    """Method of prediction: a theory, a surrogate or the simulation.

    Check an implementation with :func:`check_tier`.

    Attributes
    ----------
    name : str
        Name used in predictions.
    cost : float
        Time of one evaluation [s], order of magnitude.
    """

    @property
    def name(self) -> str: ...  # noqa: D102
    @property
    def cost(self) -> float: ...  # noqa: D102

    def covers(self, problem: Any) -> str:
        """Reason why a problem is not covered, or "" if it is."""
        ...

    def answer(self, problem: Any, *, confidence: float = 0.9) -> Prediction:
        """Predict the pull-off force of a covered problem."""
        ...


@dataclass(frozen=True, kw_only=True)
class UnknownSolid(StandardSolid):
    """A material for which no tier was verified."""

    word: ClassVar[str] = "unknown-solid"


@dataclass(frozen=True)
class UnknownLaw(LennardJones):
    """A traction law for which no tier was verified."""

    word: ClassVar[str] = "unknown-law"


@dataclass(frozen=True)
class UnknownShape(Sphere):
    """A shape for which no tier was verified."""

    word: ClassVar[str] = "unknown-shape"


@dataclass(frozen=True)
class UnknownBody(HalfSpace):
    """A body for which no tier was verified."""

    word: ClassVar[str] = "unknown-body"
    symmetries: ClassVar[tuple[str, ...]] = ("revolution", "plane")


_SOLID = {"rubbery_modulus": 1.0, "glassy_modulus": 10.0, "tau0": 1.0, "poisson_ratio": 0.0}


def problems() -> tuple[Groups, ...]:
    """Test problems: spheres over the Tabor numbers, materials and rates of tiers; a punch."""
    solids = (StandardSolid(**_SOLID), RetardationPowerLaw(**_SOLID, exponent=0.6))
    soft = Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
    elastic = tuple(Groups(tabor, soft, AtForce(1.0), 1.0) for tabor in (0.2, 1.5, 8.0))
    # a large preload, from which a fast retraction meets the glassy solid
    fast = Groups(1.5, solids[0], AtForce(300.0), 1e7)
    punch = Groups(
        None,
        solids[0],
        AtForce(0.1),
        10.0,
        geometry=FlatPunch(60.0),
        body=Layer(3.0),
        cohesion=0.05,
    )
    return (*elastic, fast, punch) + tuple(
        Groups(tabor, solid, AtForce(2.0 * max(tabor, 1.0)), rate)
        for tabor, rate in ((0.05, 1.0), (1.5, 10.0), (4.0, 100.0), (60.0, 1e3), (1e7, 1.0))
        for solid in solids
    )


def check_tier(
    tier: Tier,
    *,
    cases: Iterable[Any] = (),
    takes: Iterable[str] = (),
    digits: float = 1e-9,
) -> Report:
    """Check that a tier answers covered problems with an interval and rejects all others.

    Parameters
    ----------
    tier : Tier
        Object with ``name``, ``cost``, ``covers(problem)`` and ``answer(problem, confidence=)``.
    cases : iterable of Problem or Groups
        Problems that are tested in addition to those of this module.
    takes : iterable of str
        Those of "solid", "law", "shape" and "body" of which the tier accepts any object, because
        it evaluates their functions, as the simulation does.
    digits : float
        Required relative agreement between a problem in SI and its dimensionless form. Use 1e-4
        for a simulation, whose steps depend on round-off.

    Returns
    -------
    Report
        The findings.

    Examples
    --------
    >>> from viscotack.forecast.tiers import TIERS
    >>> check_tier(TIERS[0]).passed
    True
    """
    return report(
        tier, (_labels, _answers, _units, _unknown), (*problems(), *cases), frozenset(takes), digits
    )


def _labels(tier: Any, cases: Any, takes: Any, digits: float) -> Iterator[Finding]:
    """Check name and cost."""
    yield holds("name is a word", bool(str(tier.name).strip()), "a name", tier.name)
    yield holds("cost is a time in seconds", 0 < tier.cost < 1e5, "> 0 s", tier.cost)


def _covered(tier: Any, cases: Any) -> list[Any]:
    return [case for case in cases if tier.covers(case) == ""]


def _answers(tier: Any, cases: Any, takes: Any, digits: float) -> Iterator[Finding]:
    """Check the predictions of the tier."""
    reasons = [tier.covers(case) for case in cases]
    words = all(isinstance(r, str) and (r == "" or len(r.split()) >= 2) for r in reasons)
    yield holds("covers returns '' or a reason", words, "'' or a reason", reasons)
    answered = any(_answered(tier, case) for case in _covered(tier, cases))
    yield holds("answers one of the cases", answered, "one case or more", "none")
    for case, reason in zip(cases, reasons, strict=True):
        name = case.geometry.word if case.tabor is None else f"Tabor number {case.tabor:g}"
        where = f"{name}, {type(case.material).__name__}"
        if reason == "":
            yield from _answer(tier, case, where)
        else:
            yield _refusal(tier, case, f"{where} is not covered: answer raises a reason")


def _answer(tier: Any, case: Any, where: str) -> Iterator[Finding]:
    try:
        found = tier.answer(case)
    except OutOfRange as error:
        # a limit that is known only after evaluation; a rejection like that of `covers`
        yield holds(f"{where}: returns a value or a reason", refused(error), "a reason", error)
        return
    force = found.pull_off_force
    yield holds(
        f"{where}: the force is a positive number", np.isfinite(force) and force > 0, "> 0", force
    )
    low, high = found.interval
    yield holds(
        f"{where}: the interval holds the force", low <= force <= high, found.interval, force
    )
    band = found.band in (MEASURED, NOT_MEASURED)
    yield holds(f"{where}: band is a known word", band, (MEASURED, NOT_MEASURED), found.band)
    yield holds(f"{where}: method is not empty", bool(found.method), "a name", found.method)
    yield holds(f"{where}: why is a reason", len(found.why.split()) > 2, "words", found.why)
    sphere = isinstance(case, Groups) and not case.in_plane_strain
    if sphere and case.effective_tabor < 100:
        least, most = simulated.bounds(case)
        meets = low <= most and high >= least
        yield holds(
            f"{where}: the interval meets the slow and fast limits",
            meets,
            f"{least:.4g} to {most:.4g}",
            found.interval,
        )
    narrow, wide = (tier.answer(case, confidence=c).interval for c in (0.5, 0.9))
    nested = wide[0] <= narrow[0] * (1 + 1e-12) and narrow[1] <= wide[1] * (1 + 1e-12)
    yield holds(f"{where}: intervals of more confidence are wider", nested, wide, narrow)


def _answered(tier: Any, case: Any) -> bool:
    try:
        tier.answer(case)
    except OutOfRange:
        return False
    return True


def _refusal(tier: Any, case: Any, name: str) -> Finding:
    try:
        found = tier.answer(case)
    except Exception as error:
        return holds(name, refused(error), "a refusal", f"{type(error).__name__}: {error}")
    return holds(name, False, "a refusal", f"an answer of {found.pull_off_force:.4g}")


def _units(tier: Any, cases: Any, takes: Any, digits: float) -> Iterator[Finding]:
    """Check that the same problem in SI has the same prediction."""
    groups = [case for case in _covered(tier, cases) if isinstance(case, Groups)]
    for case in [case for case in groups if _answered(tier, case)][:2]:
        problem = case.in_si(
            radius=None if case.in_plane_strain else 1e-3,
            contact_modulus=2e6,
            work_of_adhesion=0.05,
            time_unit=0.3,
            poisson_ratio=0.5,
        )
        reason = tier.covers(problem)
        name = "a problem in SI is covered like its dimensionless form"
        yield holds(name, reason == "", "''", reason)
        found, expected = tier.answer(problem).pull_off_force, tier.answer(case).pull_off_force
        yield same(
            "a problem in SI has the same value as its dimensionless form",
            found,
            expected,
            rtol=digits,
        )


def _unknown(tier: Any, cases: Any, takes: Any, digits: float) -> Iterator[Finding]:
    """Check that unverified materials, laws, shapes and bodies are rejected."""
    covered = [case for case in _covered(tier, cases) if isinstance(case, Groups)]
    if not covered:
        return
    case = covered[0]
    strangers = {
        "solid": replace(case, material=UnknownSolid(**_SOLID)),
        "law": replace(case, traction=UnknownLaw(1.0, 1.0)),
        "body": replace(case, body=UnknownBody()),
    }
    if not case.in_plane_strain:
        strangers["shape"] = replace(case, geometry=UnknownShape(1.0))
    for noun, stranger in strangers.items():
        if noun in takes:
            continue
        reason = tier.covers(stranger)
        name = f"an unverified {noun} is not covered"
        yield holds(name, reason != "", "a reason", "covered")
        yield _refusal(tier, stranger, f"an unverified {noun} is rejected by answer")
