"""What a tier is: one way to predict, and the classes of problems for which it was verified."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import TYPE_CHECKING, Any, TypeVar

from viscotack.errors import OutOfRange
from viscotack.model.problem import Case, Groups, Problem
from viscotack.model.protocol import Start

if TYPE_CHECKING:
    from viscotack.prediction.surrogate.model import Surrogate

    from .prediction import Prediction

# Names of the tiers other than the closed forms, as in the `method` of their predictions.
SURROGATE, SOLIDS = "surrogate", "surrogate of solids"
LEARNED_PUNCH, LEARNED_CRACK = "surrogate of punches", "learned crack contact"
CRACK_CONTACT, SIMULATION = "crack contact", "simulation"
_T = TypeVar("_T")


@dataclass(frozen=True, eq=False)
class Question:
    """A problem, and the confidence of the requested intervals.

    Attributes
    ----------
    problem : Problem or Groups
        Problem as stated by the user.
    confidence : float
        Fraction of cases inside the intervals.
    joint : bool
        Whether force, work and curve of a surrogate are to be inside together.
    model : Surrogate or None
        The surrogate to use in place of that of the package.
    """

    problem: Case
    confidence: float = 0.9
    joint: bool = False
    model: Surrogate | None = None
    _known: dict[Callable[[Question], Any], Any] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        if not isinstance(self.problem, Problem | Groups):
            raise TypeError(
                f"predict needs a Problem or Groups, got {self.problem!r}; for a file use "
                "viscotack.read_case(path)"
            )

    @property
    def groups(self) -> Any:
        """The dimensionless problem."""
        return self.once(_groups)

    @property
    def relaxed_start(self) -> bool:
        """Whether the test begins in a relaxed contact."""
        return isinstance(self.groups.start, Start)

    def once(self, compute: Callable[[Question], _T]) -> _T:
        """Return the result of a function of this question, computed on the first call only."""
        if compute not in self._known:
            self._known[compute] = compute(self)
        return self._known[compute]


def _groups(asked: Question) -> Any:
    return asked.problem.groups()


# For `Verified.solids`: any linear solid.
ANY: tuple[type, ...] = ()


class Uncertain(OutOfRange):
    """A problem in the range of a surrogate, which is not certain of its answer."""


def _word(kind: Any) -> str:
    """Return the word of a class of shapes, bodies, laws, solids or starts."""
    return getattr(kind, "word", kind.__name__)


@dataclass(frozen=True)
class Verified:
    """The classes for which a tier was compared with simulations; one tuple per kind.

    Classes are compared exactly, because a subclass may behave differently.

    Attributes
    ----------
    shapes, bodies, laws : tuple of type
        Indenters, bodies (for a layer the class of its base) and traction laws.
    solids : tuple of type
        Materials; empty for any linear solid, if the tier itself compares its creep or its
        modulus with the verified ones.
    starts : tuple of type
        States in which the test may begin.
    moves, springs : bool
        Whether moves before the retraction, and a compliant machine, are allowed.
    ranges : mapping
        Smallest and largest value of each input, for
        :func:`viscotack.model.problem.accuracy.outside`.
    """

    shapes: tuple[type, ...]
    bodies: tuple[type, ...]
    laws: tuple[type, ...]
    solids: tuple[type, ...]
    starts: tuple[Any, ...]
    moves: bool = False
    springs: bool = False
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    def refuses(self, groups: Groups) -> str:
        """Return the reason why a problem is not on the list, or an empty string."""
        solid = type(groups.material)
        for what, given, allowed in (
            ("shape", type(groups.geometry), self.shapes),
            ("body", type(getattr(groups.body, "base", groups.body)), self.bodies),
            ("traction law", type(groups.traction), self.laws),
            ("solid", solid, self.solids or (solid,)),
            ("start", type(groups.start), self.starts),
        ):
            if given not in allowed:
                names = [_word(each) for each in allowed]
                # a class of the user may have the word of its base
                own = f" of class {given.__name__}" if _word(given) in names else ""
                return f"the {what} is {_word(given)}{own}; verified only for {', '.join(names)}"
        if groups.moves and not self.moves:
            return (
                f"the machine moves before the retraction: {groups.moves[0]!r}; verified only for "
                "a retraction from rest"
            )
        if groups.stiffness is not None and not self.springs:
            return (
                f"the machine has a stiffness of {groups.stiffness:.4g} x "
                f"{groups.units['stiffness']}; verified only for a rigid machine"
            )
        if groups.rate is None and not self.moves:
            return "the test has no retraction at constant speed"
        return ""


@dataclass(frozen=True, eq=False)
class Tier:
    """One way to predict: a surrogate, a theory or the simulation.

    Attributes
    ----------
    name : str
        Name, as in the `method` of its predictions.
    cost : float
        Approximate time of a prediction [s].
    module : str
        Its module in this folder, imported on first use. `TIERS` there gives, by name, its
        allow-lists and the function that predicts, which raises OutOfRange if a number is out of
        range.
    """

    name: str
    cost: float
    module: str

    @property
    def verified(self) -> tuple[Verified, ...]:
        """Its allow-lists, one of which must contain the problem; empty if it accepts all."""
        return self._of_module[0]

    @property
    def _of_module(self) -> tuple[tuple[Verified, ...], Callable[[Question], Prediction]]:
        return import_module(f".{self.module}", __package__).TIERS[self.name]

    def answer(self, problem: Case, *, confidence: float = 0.9) -> Prediction:
        """Predict by this tier.

        Raises
        ------
        OutOfRange
            If the tier does not accept the problem, with the reason.
        """
        return self.ask(Question(problem, confidence))

    def ask(self, asked: Question) -> Prediction:
        """Return :meth:`answer` for a question with cached results."""
        verified, reply = self._of_module
        reasons = [each.refuses(asked.groups) for each in verified]
        if reasons and all(reasons):
            raise OutOfRange(reasons[0])
        try:
            return reply(asked)
        except OutOfRange:
            raise
        except ValueError as error:
            if not verified:
                raise  # a rejection by the simulation is bad input
            raise OutOfRange(str(error)) from error
