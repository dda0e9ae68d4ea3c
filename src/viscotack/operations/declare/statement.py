"""Problems as options: defined by numbers, a case file, its tables, or a Python object."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from viscotack.errors import InputError
from viscotack.materials.passport import Passport

from .cards import Card, Place, Spelled
from .wording import flag

if TYPE_CHECKING:
    from viscotack.problem import Case

    from .questions import Indenter, Question

# Words of what can be stated by numbers.
INDENTERS = ("sphere", "punch", "profile", "disc")
# Keys of a statement by numbers, and of one by a file.
_INDENTER, _CASE, _TEMPERATURE, _SET = "indenter", "case", "temperature", "set"
# Answers that may name a file.
_NAMING = {
    "material": Spelled("", before=("prony:",), endings=(".toml",), objects=(Passport,)),
    "law": Spelled("", before=("table:",)),
    "points": Spelled("", endings=(".csv",)),
}


@dataclass(frozen=True)
class Statement:
    """A problem and the uncertainty of its material times.

    Attributes
    ----------
    problem : Problem, Groups or RoughCase
        In SI or dimensionless.
    deviation : float
        Standard deviation of log10 of the times of its material, from its shift with temperature.
    given : object
        The input of the user.
    passport : Passport or None
        Passport of the material at its temperature; None if numbers or an object define it.
    """

    problem: "Case"
    deviation: float = 0.0
    given: Any = None
    passport: Passport | None = None

    @property
    def improbable(self) -> tuple[str, ...]:
        """Warnings of numbers of an improbable magnitude."""
        from viscotack.problem.inputs import improbable

        return improbable(self.problem)

    @property
    def notes(self) -> tuple[str, ...]:
        """Warnings for answers that do not include the uncertainty of the material times."""
        if self.deviation == 0:
            return self.improbable
        return (
            *self.improbable,
            f"the material times are uncertain by {self.deviation:.2g} decades because of the "
            "temperature shift; this answer does not include that, viscotack predict does",
        )


@dataclass(frozen=True)
class Stated(Card):
    """A problem: an object, a case file, its tables, or numbers.

    Tables may have numbers without units, in SI. Numbers are a mapping with the word of an
    indenter and its answers: ``{"indenter": "sphere",
    "tabor": 3.24, "modulus_ratio": 0.1, ...}``; ``{"case": FILE, "temperature": "0 degC"}`` moves
    the material of a case.

    Attributes
    ----------
    indenters : tuple of str
        Indenters that can be defined by numbers.
    spelling : str
        On the command line the indenter is a subcommand ("command"), an argument or fixed, or only
        a case file is accepted ("case").
    whole : bool
        Whether a case file with any indenter is accepted.
    rough : bool
        Whether a file of ``viscotack rough`` is accepted, which states a map of heights.
    table, expected : str
        Option that receives the name of a CSV file given in place of the problem, and the text of
        the error message for other arguments.
    """

    late: ClassVar = True
    form: ClassVar = "problem"

    argument: bool = field(default=True, kw_only=True)
    indenters: tuple[str, ...] = field(default=("sphere",), kw_only=True)
    spelling: Literal["flags", "commands", "word", "case"] = field(default="flags", kw_only=True)
    whole: bool = field(default=True, kw_only=True)
    table: str = field(default="", kw_only=True)
    expected: str = field(default="", kw_only=True)
    rough: bool = field(default=False, kw_only=True)

    def read(self, value: Any, place: Place) -> Statement:
        """Return the problem."""
        if isinstance(value, Statement):
            return value
        if isinstance(value, str | Path):
            return self._of_case({_CASE: value}, place)
        if not isinstance(value, Mapping):
            return Statement(self._checked(value), given=value)
        if _CASE in value:
            return self._of_case(value, place)
        if _INDENTER in value:
            return self._of_numbers(value, place)
        from viscotack.problem.case_file import passport_of, problem_of
        from viscotack.problem.nouns import known
        from viscotack.problem.tables import Reading

        reading = Reading("the problem", known(place.also), place.file, bare=True)
        problem = self._checked(problem_of(value, reading))
        passport, deviation = passport_of(value, reading)
        return Statement(problem, deviation, value, passport)

    def written(self, value: Statement) -> Any:
        """Return the input of the user, or the tables of the problem."""
        if isinstance(value.given, Mapping):
            said = {name: entry for name, entry in value.given.items() if entry is not None}
            return {
                n: _NAMING[n].written(x) if n in _NAMING and isinstance(x, str) else x
                for n, x in said.items()
            }
        if isinstance(value.given, str | Path):
            return Path(value.given)
        from viscotack.problem.record import to_dict

        return to_dict(value.problem)

    @property
    def asks(self) -> tuple[str, ...]:
        """Names of the questions that its indenters ask, without duplicates."""
        asked = (
            question.name for word in self.indenters for question in indenter_named(word).questions
        )
        return tuple(dict.fromkeys(asked))

    @property
    def schema(self) -> dict[str, Any]:
        """The tables of a case, or the numbers of an indenter."""
        return {"$ref": "#/components/schemas/Stated"}

    def _checked(self, problem: Any) -> Any:
        from viscotack.problem import Groups, Problem, RoughCase

        if not isinstance(problem, (Problem, Groups, *((RoughCase,) if self.rough else ()))):
            raise InputError(
                "problem must be a Problem or Groups, a case file or its tables, got a "
                f"{type(problem).__name__}; `viscotack rough` reads a map of heights"
            )
        return problem

    def _of_case(self, value: Mapping[str, Any], place: Place) -> Statement:
        from viscotack.files.toml import read_toml
        from viscotack.problem.case_file import passport_of, problem_of
        from viscotack.problem.nouns import known
        from viscotack.problem.tables import Reading

        from .questions import given_of, temperature_of

        case = place.file(str(value[_CASE]))
        given = given_of(value)
        flags = [flag(name) for name in given if name not in (_CASE, _TEMPERATURE, _SET, _INDENTER)]
        if flags:
            raise InputError(f"{case} defines the whole problem; remove {', '.join(flags)}")
        kelvin = temperature_of(given)
        beside = place.within(case).file
        tables = read_toml(case)
        reading = Reading(str(case), known(place.also), beside)
        problem = self._checked(problem_of(tables, reading, kelvin))
        if _SET in given:
            problem = _with_numbers(problem, given[_SET], tables)
        passport, deviation = passport_of(tables, reading, kelvin)
        stated = Statement(
            problem, deviation, {**given, _CASE: case} if len(given) > 1 else case, passport
        )
        if not hasattr(problem, "geometry"):  # a map of heights
            return stated
        wanted, found = given.get(_INDENTER), indenter_of(problem)
        if (wanted is not None and wanted != found) or not (self.whole or found in self.indenters):
            command = found if found in INDENTERS else "case"
            raise InputError(f"{case} contains a {found}; use viscotack simulate {command} {case}")
        return stated

    def _of_numbers(self, value: Mapping[str, Any], place: Place) -> Statement:
        from .questions import given_of, passport_at, stated

        word = value[_INDENTER]
        if value.get(_SET):
            raise InputError("--set replaces a number of a file; give the option itself")
        if word not in self.indenters:
            raise InputError(
                f"indenter must be one of {', '.join(self.indenters)}, got {word!r:.60}"
            )
        indenter = indenter_named(word)
        given = {n.replace("_", "-"): v for n, v in given_of(value).items() if n != _INDENTER}
        asked = {question.name: question for question in indenter.questions}
        unknown = [name for name in given if name not in asked]
        if unknown:
            raise InputError(f"a {word} has no option {', '.join(map(flag, unknown))}; remove it")
        given = {name: _answered(asked[name], answer) for name, answer in given.items()}
        for name, card in _NAMING.items():
            if name in given:
                given[name] = card.value(given[name], place)
        problem = stated(indenter, given, place.also)
        said = {n.replace("-", "_"): v for n, v in given.items()}
        passport, deviation = passport_at(given, place.also)
        return Statement(problem, deviation, {_INDENTER: word, **said}, passport)


def _with_numbers(problem: Any, said: Any, tables: Mapping[str, Any]) -> Any:
    """Return a problem with numbers replaced, each as ``sphere.radius=6 mm``."""
    from viscotack.problem import Groups
    from viscotack.problem.inputs import changed, inputs_of
    from viscotack.units import parse

    known, values = inputs_of(problem), dict[str, float]()
    for words in [said] if isinstance(said, str) else said:
        name, equals, text = (part.strip() for part in str(words).partition("="))
        if name in values:
            raise InputError(f"--set {name} is given twice; remove one")
        if not equals or name not in known:
            raise InputError(
                f'--set must name a number of the file, sphere.radius="6 mm", got {words!r:.60}; '
                f"it has {', '.join(known)}"
            )
        if name.startswith("material.") and "passport" in tables["material"]:
            raise InputError(f"--set {name}: the passport defines the whole material")
        unit = "1" if isinstance(problem, Groups) else known[name].unit
        try:
            values[name] = known[name].card.checked(name, parse(text, unit), unit)
        except InputError as error:
            raise InputError(f"--set {name}: {error}") from None
    return changed(problem, values)


def indenter_named(word: str) -> "Indenter":
    """Return an indenter by name."""
    from .questions import DISC, PROFILE, PUNCH, SPHERE

    return {indenter.word: indenter for indenter in (SPHERE, PUNCH, PROFILE, DISC)}[word]


def indenter_of(problem: Any) -> str:
    """Return the name of the indenter of a problem in SI, as used in commands."""
    from viscotack.geometry import Cone, MeasuredProfile

    is_profile = isinstance(problem.geometry, Cone | MeasuredProfile)
    return "profile" if is_profile else problem.geometry.word


def _answered(question: "Question", answer: Any) -> Any:
    """Check a value; repeated values become a list."""
    if question.name in _NAMING and isinstance(answer, _NAMING[question.name].objects):
        return answer
    several = list(answer) if isinstance(answer, list | tuple) else [answer]
    is_plain = all(isinstance(x, str | Real) and not isinstance(x, bool) for x in several)
    if not is_plain or isinstance(answer, list | tuple) > question.many:
        wanted = "words" if question.text else "a number"
        raise InputError(f"{flag(question.name)} must be {wanted}, got {answer!r:.60}")
    return several if question.many else answer
