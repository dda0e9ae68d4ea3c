"""The problem of a request: an object, a case file, its tables, or the flags of an indenter."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from viscotack.errors import InputError

from .flags import FLAGS, INDENTERS, stated
from .options import Contact, quoted
from .request import Caller

if TYPE_CHECKING:
    from viscotack.model.materials.passport import Passport
    from viscotack.model.problem import Case

# Keys of a statement by flags, and of one by a file.
_INDENTER, _CASE, _TEMPERATURE, _SET = "indenter", "case", "temperature", "set"


@dataclass(frozen=True)
class Statement:
    """A problem and what is known of its material.

    Attributes
    ----------
    problem : Problem, Groups or RoughCase
        In SI or dimensionless.
    deviation : float
        Standard deviation of log10 of the times of its material, from its shift with temperature.
    passport : Passport or None
        Passport of the material at its temperature; None if numbers or an object define it.
    """

    problem: "Case"
    deviation: float = 0.0
    passport: "Passport | None" = None

    @property
    def improbable(self) -> tuple[str, ...]:
        """Warnings of numbers of an improbable magnitude."""
        from viscotack.model.problem.inputs import improbable

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


def statement(given: Any, option: Contact, caller: Caller) -> Statement:
    """Return the problem that was given for an option.

    Parameters
    ----------
    given : object
        A problem; the name of a case file; ``{"case": FILE, "temperature": "0 degC", "set":
        ["sphere.radius=6 mm"]}``; the tables of a case, with numbers in SI; or the flags of an
        indenter, ``{"indenter": "sphere", "tabor": 3.24, ...}``.
    option : Contact
        What the option takes.
    caller : Caller
        Resolves names of files.
    """
    if isinstance(given, str | Path):
        given = {_CASE: given}
    if not isinstance(given, Mapping):
        return Statement(_checked(given, option))
    given = {name: value for name, value in given.items() if value is not None and value != []}
    if _CASE in given:
        return _of_case(given, option, caller)
    if _INDENTER in given:
        word = given[_INDENTER]
        if word not in option.indenters:
            known = ", ".join(option.indenters)
            raise InputError(f"indenter must be one of {known}, got {word!r:.60}", field=_INDENTER)
        said = {n: x for n, x in given.items() if n != _INDENTER}
        pure = [n for n in said if n in FLAGS and not FLAGS[n].si]
        if option.in_si and pure:
            raise InputError(
                f"{pure[0]} is dimensionless, and this problem is stated in SI; leave it out",
                field=pure[0],
            )
        return stated(word, said, caller)
    from viscotack.model.problem.case_file import passport_of, problem_of
    from viscotack.model.problem.nouns import known
    from viscotack.model.problem.tables import Reading

    reading = Reading("the problem", known(caller.also), caller.file, bare=True)
    problem = _checked(problem_of(given, reading), option)
    passport, deviation = passport_of(given, reading)
    return Statement(problem, deviation, passport)


def _checked(problem: Any, option: Contact) -> Any:
    from viscotack.model.problem import Groups, Problem, RoughCase

    if not isinstance(problem, (Problem, Groups, *((RoughCase,) if option.rough else ()))):
        raise InputError(
            "problem must be a Problem or Groups, a case file or its tables, got a "
            f"{type(problem).__name__}; `viscotack rough` reads a map of heights"
        )
    return problem


def _of_case(given: Mapping[str, Any], option: Contact, caller: Caller) -> Statement:
    from viscotack.files.toml import read_toml
    from viscotack.model.problem.case_file import passport_of, problem_of
    from viscotack.model.problem.nouns import known
    from viscotack.model.problem.tables import Reading
    from viscotack.units import parse

    if not isinstance(given[_CASE], str | Path):
        raise InputError(f"case must be the name of a file, got {given[_CASE]!r:.60}", field=_CASE)
    case = caller.file(given[_CASE])
    beside = [n for n in given if n not in (_CASE, _TEMPERATURE, _SET, _INDENTER)]
    if beside:
        raise InputError(f"{case} defines the whole problem; leave out {quoted(beside)}")
    kelvin = None
    if _TEMPERATURE in given:
        try:
            kelvin = parse(given[_TEMPERATURE], "K")
        except InputError as error:
            raise InputError(
                f'temperature: {error}; for example "0 degC"', field=_TEMPERATURE
            ) from None
    tables = read_toml(case)
    reading = Reading(str(case), known(caller.also), caller.within(case).file)
    problem = _checked(problem_of(tables, reading, kelvin), option)
    if _SET in given:
        problem = _with_numbers(problem, given[_SET], tables)
    passport, deviation = passport_of(tables, reading, kelvin)
    found = Statement(problem, deviation, passport)
    if not hasattr(problem, "geometry"):  # a map of heights
        return found
    wanted, indenter = given.get(_INDENTER), indenter_of(problem)
    if wanted not in (None, indenter) or not (option.whole or indenter in option.indenters):
        command = indenter if indenter in INDENTERS else "case"
        raise InputError(f"{case} contains a {indenter}; use viscotack simulate {command} {case}")
    return found


def indenter_of(problem: Any) -> str:
    """Return the name of the indenter of a problem, as used in commands."""
    from viscotack.model.geometry import Cone, MeasuredProfile

    is_profile = isinstance(problem.geometry, Cone | MeasuredProfile)
    return "profile" if is_profile else problem.geometry.word


def _with_numbers(problem: Any, said: Any, tables: Mapping[str, Any]) -> Any:
    """Return a problem with numbers replaced, each as ``sphere.radius=6 mm``."""
    from viscotack.model.problem import Groups
    from viscotack.model.problem.inputs import changed, inputs_of
    from viscotack.units import parse

    known, values = inputs_of(problem), dict[str, float]()
    for words in said if isinstance(said, list | tuple) else [said]:
        name, equals, text = (part.strip() for part in str(words).partition("="))
        if name in values:
            raise InputError(f"set: {name} is given twice; leave one out", field=_SET)
        if not equals or name not in known:
            raise InputError(
                f'set must name a number of the file, sphere.radius="6 mm", got {words!r:.60}; '
                f"it has {', '.join(known)}",
                field=_SET,
            )
        if name.startswith("material.") and "passport" in tables["material"]:
            raise InputError(f"set: {name}: the passport defines the whole material", field=_SET)
        unit = "1" if isinstance(problem, Groups) else known[name].unit
        try:
            values[name] = known[name].card.checked(name, parse(text, unit), unit)
        except InputError as error:
            raise InputError(f"set: {name}: {error}", field=_SET) from None
    return changed(problem, values)
