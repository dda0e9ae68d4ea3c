"""The problem of a request: an object, a case file, its tables, or the flags of an indenter."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from viscotack.errors import InputError
from viscotack.units import is_number

from .flags import INDENTERS, named_as_flags, of_si_alone, tables_of
from .options import Contact, quoted
from .request import Caller

if TYPE_CHECKING:
    from viscotack.model.materials.passport import Passport
    from viscotack.model.problem import Case
    from viscotack.model.problem.nouns import Nouns
    from viscotack.model.tables import Reading

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
    from viscotack.model.problem.nouns import known
    from viscotack.model.tables import Reading

    nouns = known(caller.also)
    given = {name: value for name, value in given.items() if value is not None and value != []}
    if _CASE in given:
        return _of_case(given, option, caller, nouns)
    if _INDENTER not in given:
        return _read(given, Reading("the problem", nouns, caller.file, bare=True), option)
    word = given.pop(_INDENTER)
    if word not in option.indenters:
        words = ", ".join(option.indenters)
        raise InputError(f"indenter must be one of {words}, got {word!r:.60}", field=_INDENTER)
    with named_as_flags(word, in_si=bool(of_si_alone(given))):
        tables = tables_of(word, given, nouns)
        return _read(tables, Reading("the options", nouns, caller.file), option)


def _read(tables: Mapping[str, Any], reading: "Reading", option: Contact) -> Statement:
    """Return the problem of tables, and the passport of its material."""
    from viscotack.model.problem.case_file import passport_of, problem_of

    problem = _checked(problem_of(tables, reading), option)
    passport, deviation = passport_of(tables, reading)
    return Statement(problem, deviation, passport)


def _checked(problem: Any, option: Contact) -> Any:
    from viscotack.model.problem import Groups, Problem, RoughCase

    if not isinstance(problem, (Problem, Groups, *((RoughCase,) if option.rough else ()))):
        raise InputError(
            "problem must be a Problem or Groups, a case file or its tables, got a "
            f"{type(problem).__name__}; `viscotack rough` reads a map of heights"
        )
    return problem


def _of_case(
    given: Mapping[str, Any], option: Contact, caller: Caller, nouns: "Nouns"
) -> Statement:
    """Return the problem of a file, at another temperature or with other numbers."""
    from viscotack.files.toml import read_toml
    from viscotack.model.tables import Reading

    if not isinstance(given[_CASE], str | Path):
        raise InputError(f"case must be the name of a file, got {given[_CASE]!r:.60}", field=_CASE)
    case = caller.file(given[_CASE])
    beside = [n for n in given if n not in (_CASE, _TEMPERATURE, _SET, _INDENTER)]
    if beside:
        raise InputError(f"{case} defines the whole problem; leave out {quoted(beside)}")
    tables = read_toml(case)
    if (kelvin := given.get(_TEMPERATURE)) is not None:
        if "passport" not in tables.get("material", {}):
            raise InputError(
                "temperature needs a material from a passport, which contains the shift of its "
                "times",
                field=_TEMPERATURE,
            )
        kelvin = kelvin if isinstance(kelvin, str) else f"{kelvin!r} K"
        tables = tables | {"material": tables["material"] | {_TEMPERATURE: kelvin}}
    found = _read(tables, Reading(str(case), nouns, caller.within(case).file), option)
    if _SET in given:
        found = replace(found, problem=_with_numbers(found, given[_SET]))
    problem = found.problem
    if not hasattr(problem, "geometry"):  # a map of heights
        return found
    wanted, indenter = given.get(_INDENTER), indenter_of(problem)
    if wanted not in (None, indenter):
        command = indenter if indenter in INDENTERS else "case"
        raise InputError(f"{case} contains a {indenter}; use viscotack simulate {command} {case}")
    return found


def indenter_of(problem: Any) -> str:
    """Return the name of the indenter of a problem, as used in commands."""
    from viscotack.model.geometry import Cone, MeasuredProfile

    is_profile = isinstance(problem.geometry, Cone | MeasuredProfile)
    return "profile" if is_profile else problem.geometry.word


def _with_numbers(found: Statement, said: Any) -> Any:
    """Return a problem with numbers replaced, each as ``sphere.radius=6 mm``: a row of changes."""
    from viscotack.model.problem.rows import changes_of

    row: dict[str, str] = {}
    for words in said if isinstance(said, list | tuple) else [said]:
        name, equals, text = (part.strip() for part in str(words).partition("="))
        if not equals or name in row:
            raise InputError(
                f'set must name each number once, sphere.radius="6 mm", got {words!r:.60}',
                field=_SET,
            )
        row[name] = text
    try:
        changes = changes_of(found.problem, row)
        if changes.carried:
            raise InputError(f"the problem has no number {changes.carried[0]!r}")
        for column in changes.columns:
            if found.passport is not None and column.number.path.startswith("material."):
                raise InputError(f"{column.heading}: the passport defines the whole material")
            if (
                not column.number.pure
                and column.number.unit != "1"
                and is_number(row[column.heading])
            ):
                raise InputError(f"{column.heading} has no unit, got {row[column.heading]}")
        return changes.kind().problem(changes.values(row))
    except InputError as error:
        raise InputError(f"set: {error}", field=_SET) from None
