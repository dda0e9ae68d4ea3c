"""The tiers of predictions, and the choice among them.

A tier accepts only problems on its allow-list: shapes, bodies, laws, solids, tests and ranges for
which it was compared with simulations. It rejects everything else with a reason, so that a new
class is rejected until it has been compared. Each prediction has a value, an interval, the basis of
the interval, and the name of the tier.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from viscotack.errors import InputError, OutOfRange
from viscotack.model.materials import Elastic, RetardationPowerLaw

from .prediction import Prediction
from .tier import (
    CRACK_CONTACT,
    LEARNED_CRACK,
    LEARNED_PUNCH,
    SIMULATION,
    SOLIDS,
    SURROGATE,
    Question,
    Tier,
    Uncertain,
)

# Time budgets [s]: surrogates alone; surrogates and theories, the default.
AT_ONCE, SOON = 0.01, 1.0
SIMULATE = (
    "a simulation can compute it (`exact`, or `viscotack simulate`), mostly in 0.1 to 3 s and "
    "above a Tabor number of 30 in up to a minute"
)

LEARNED = (
    Tier(SURROGATE, 1e-3, "power_laws"),
    Tier(SOLIDS, 4e-3, "solids"),
    Tier(LEARNED_PUNCH, 2e-3, "punches"),
    Tier(LEARNED_CRACK, 1e-3, "learned_crack"),
)
_OF_MODEL = {"sphere": LEARNED[0], "punch": LEARNED[2]}
CLOSED_FORMS = {
    name: Tier(name, 0.02, "theories")
    for name in ("elastic", "unloading", "detachment", "rate-fit", "glassy")
}
CRACK = Tier(CRACK_CONTACT, 0.5, "theories")
THEORIES = (CRACK, *CLOSED_FORMS.values())
EXACT = Tier(SIMULATION, 3.0, "simulation")
TIERS = (*LEARNED, *THEORIES, EXACT)


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
    return _OF_MODEL[name].ask(asked)


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
    refused: dict[str, OutOfRange] = {}
    for found in _answers(LEARNED, asked, refused):
        return found
    # not above: it loads the simulation, which most answers do without
    from viscotack.simulate import has_start

    out = _reason_of_surrogates(asked, refused)
    if asked.relaxed_start and budget > AT_ONCE and not has_start(asked.problem):
        raise InputError(
            f"there is no contact to pull off: no relaxed one exists at {asked.groups.start}"
        )
    # the time of a simulation is known in the ranges of the surrogates
    abstained = any(isinstance(reason, Uncertain) for reason in refused.values())
    if budget >= (SOON if abstained else EXACT.cost):
        try:
            return EXACT.ask(asked).because(out)
        except OutOfRange:
            pass  # a theory may do
        except ValueError:
            if budget >= EXACT.cost:
                raise
    affordable = [tier for tier in THEORIES if tier.cost <= budget]
    theories = list(_answers(affordable, asked, refused))
    if theories:
        return min(theories, key=lambda x: x.interval[1] - x.interval[0]).because(out)
    if budget <= AT_ONCE:
        raise OutOfRange(out)
    # the reasons of the other closed forms are similar
    form = "elastic" if isinstance(asked.groups.material, Elastic) else "detachment"
    words = [out, *(str(refused[name]) for name in (form, CRACK_CONTACT) if name in refused)]
    raise OutOfRange(f"{'; '.join(dict.fromkeys(words))}; no theory applies either; {SIMULATE}")


def _answers(
    tiers: Iterable[Tier], asked: Question, refused: dict[str, OutOfRange]
) -> Iterator[Prediction]:
    """Iterate over the predictions of the tiers that accept a problem; collect other reasons."""
    for tier in tiers:
        try:
            yield tier.ask(asked)
        except OutOfRange as reason:
            refused[tier.name] = reason


def _reason_of_surrogates(asked: Question, refused: dict[str, OutOfRange]) -> str:
    """Return why the surrogate closest to a problem does not accept it."""
    if asked.groups.in_plane_strain:
        return str(refused[LEARNED_PUNCH])
    power_law = isinstance(asked.groups.material, RetardationPowerLaw)
    return str(refused[SURROGATE if power_law else SOLIDS])
