"""The tiers of predictions, and the choice among them.

A tier accepts only problems on its allow-list: shapes, bodies, laws, solids, tests and ranges for
which it was compared with simulations. It rejects everything else with a reason, so that a new
class is rejected until it has been compared. Each prediction has a value, an interval, the basis of
the interval, and the name of the tier.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

from viscotack.errors import InputError, OutOfRange
from viscotack.materials import Elastic, RetardationPowerLaw
from viscotack.problem import Case

from .allow_list import Verified
from .learned import (
    LEARNED_CRACK,
    OTHER_SOLIDS,
    POWER_LAWS,
    SOLIDS,
    SURROGATE,
    by_learned_crack,
    by_power_laws,
    by_solids,
    learned_crack_limits,
    power_law_limits,
    solid_limits,
)
from .prediction import NOT_MEASURED, Prediction
from .punches import LEARNED_PUNCH, PUNCHES, by_punches, punch_limits
from .question import Question
from .simulation import SIMULATION, by_simulation
from .theories import (
    CLOSED_FORM,
    CRACK,
    CRACK_CONTACT,
    ELASTIC,
    by_closed_form,
    by_crack_contact,
    closed_form_limits,
    crack_limits,
    elastic_limits,
)

# Time budgets [s]: surrogates alone; surrogates and theories, the default.
AT_ONCE, SOON = 0.01, 1.0
_SIMULATE = (
    "`viscotack simulate`, or `predict` with --exact, can compute it, mostly in 0.1 to 3 s and "
    "above a Tabor number of 30 in up to a minute"
)


@dataclass(frozen=True, eq=False)
class Tier:
    """One way to predict: a surrogate, a theory or the simulation.

    Attributes
    ----------
    name : str
        Name, as in the `method` of its predictions.
    cost : float
        Approximate time of a prediction [s].
    verified : tuple of Verified
        Its allow-lists, one of which must contain the problem; empty if it accepts all classes.
    limits : callable
        Names the number of a listed problem that is out of range, or returns an empty string.
    reply : callable
        Computes the prediction.
    """

    name: str
    cost: float
    verified: tuple[Verified, ...]
    limits: Callable[[Question], str]
    reply: Callable[[Question], Prediction]

    def covers(self, problem: Case) -> str:
        """Return the reason why the tier does not accept a problem, or an empty string.

        A theory that accepts a problem may still find during evaluation that its conditions on
        speed and start are not met; :meth:`answer` then raises an error.
        """
        return self.refuses(Question(problem))

    def answer(self, problem: Case, *, confidence: float = 0.9) -> Prediction:
        """Predict by this tier.

        Raises
        ------
        OutOfRange
            If the tier does not accept the problem, with the reason.
        """
        return self.ask(Question(problem, confidence))

    def refuses(self, asked: Question) -> str:
        """Return :meth:`covers` for a question with cached results."""
        reasons = [each.refuses(asked.groups) for each in self.verified]
        if reasons and all(reasons):
            return reasons[0]
        try:
            return self.limits(asked)
        except ValueError as error:
            return str(error)

    def ask(self, asked: Question) -> Prediction:
        """Return :meth:`answer` for a question with cached results."""
        if reason := self.refuses(asked):
            raise OutOfRange(reason)
        try:
            return self.reply(asked)
        except ValueError as error:
            if not self.verified:
                raise  # a rejection by the simulation is bad input
            raise OutOfRange(str(error)) from error


def _no_limits(asked: Question) -> str:
    return ""


LEARNED = (
    Tier(SURROGATE, 1e-3, (POWER_LAWS,), power_law_limits, by_power_laws),
    Tier(SOLIDS, 4e-3, (OTHER_SOLIDS,), solid_limits, by_solids),
    Tier(LEARNED_PUNCH, 2e-3, (PUNCHES,), punch_limits, by_punches),
    Tier(LEARNED_CRACK, 1e-3, (POWER_LAWS,), learned_crack_limits, by_learned_crack),
)
_OF_MODEL = {"sphere": LEARNED[0], "punch": LEARNED[2]}
THEORIES = (
    Tier(CRACK_CONTACT, 0.5, (CRACK,), crack_limits, by_crack_contact),
    Tier(
        "elastic",
        0.02,
        (CLOSED_FORM, ELASTIC),
        elastic_limits,
        partial(by_closed_form, name="elastic"),
    ),
    *(
        Tier(name, 0.02, (CLOSED_FORM,), closed_form_limits, partial(by_closed_form, name=name))
        for name in ("unloading", "detachment", "rate-fit", "glassy")
    ),
)
EXACT = Tier(SIMULATION, 3.0, (), _no_limits, by_simulation)
TIERS = (*LEARNED, *THEORIES, EXACT)


def _abstention_limits(asked: Question) -> str:
    """Return a reason unless a surrogate covers the problem, so that the time is known."""
    covered = any(not tier.refuses(asked) for tier in LEARNED)
    return "" if covered else "outside the ranges of the surrogates a simulation may take longer"


# The simulation in the ranges of the surrogates, for cases in which these are not certain.
_ABSTAINED = Tier(
    SIMULATION, SOON, (POWER_LAWS, OTHER_SOLIDS, PUNCHES), _abstention_limits, by_simulation
)


def by_model(asked: Question) -> Prediction:
    """Predict by the surrogate that was given, and by nothing else.

    Raises
    ------
    OutOfRange
        If the problem is outside its range or class, or it is not certain.
    """
    assert asked.model is not None, "the caller has one"
    name = asked.model.contact.name
    if name not in _OF_MODEL:
        raise InputError(f"model must be a surrogate of spheres or punches, got one of {name!r}")
    found = _OF_MODEL[name].ask(asked)
    if asked.model.move is None:
        return found
    count = len(asked.model.move.points)
    return replace(
        found,
        method=f"{found.method}, moved",
        why=f"{found.why}; moved by {count} measured force{'s' * (count > 1)}",
        confidence=None,
        band=NOT_MEASURED,
    )


def best(asked: Question, budget: float) -> Prediction:
    """Predict by the best tier within a budget.

    Surrogates come first, because their intervals are the narrowest and they are fastest; then, if
    the budget allows it, the simulation, from 1 s where a surrogate abstains; then the theory with
    the narrowest band.

    Parameters
    ----------
    asked : Question
        The problem with the confidence of its intervals.
    budget : float
        Largest cost of a tier [s].

    Raises
    ------
    OutOfRange
        If no tier within the budget was verified for the problem, with the reason of each.
    ValueError
        If there is no relaxed contact to pull off.
    """
    refused: dict[str, str] = {}
    for found in _answers(LEARNED, asked, budget, refused):
        return found
    # not above: it loads the simulation, which most answers do without
    from viscotack.campaign.columns import has_relaxed_contact

    out = _reason_of_surrogates(asked, refused)
    if asked.relaxed_start and budget > AT_ONCE and not has_relaxed_contact(asked.problem):
        raise InputError(
            f"there is no contact to pull off: no relaxed one exists at {asked.groups.start}"
        )
    for found in _answers((_ABSTAINED, EXACT), asked, budget, refused):
        return found.because(out)
    theories = list(_answers(THEORIES, asked, budget, refused))
    if theories:
        return min(theories, key=lambda x: x.interval[1] - x.interval[0]).because(out)
    raise OutOfRange(_no_tier(out, asked, refused, budget))


def _answers(
    tiers: tuple[Tier, ...], asked: Question, budget: float, refused: dict[str, str]
) -> Iterator[Prediction]:
    """Iterate over the predictions of the tiers that accept a problem; collect other reasons."""
    for tier in tiers:
        if tier.cost > budget:
            continue
        try:
            yield tier.ask(asked)
        except OutOfRange as reason:
            refused[tier.name] = str(reason)


def _reason_of_surrogates(asked: Question, refused: dict[str, str]) -> str:
    """Return why the surrogate closest to a problem does not accept it."""
    if asked.groups.in_plane_strain:
        return refused[LEARNED_PUNCH]
    power_law = isinstance(asked.groups.material, RetardationPowerLaw)
    return refused[SURROGATE if power_law else SOLIDS]


def _no_tier(out: str, asked: Question, refused: dict[str, str], budget: float) -> str:
    """Describe why no tier within a budget applies."""
    if budget <= AT_ONCE:
        return out
    # the reasons of the other closed forms are similar
    form = "elastic" if isinstance(asked.groups.material, Elastic) else "detachment"
    theories = (refused.get(form, ""), refused.get(CRACK_CONTACT, ""))
    words = dict.fromkeys(each for each in (out, *theories) if each)
    return f"{'; '.join(words)}; no theory applies either; {_SIMULATE}"
