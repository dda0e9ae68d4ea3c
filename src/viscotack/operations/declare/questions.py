"""Options that define a problem by numbers, generated from the cards of the nouns.

An :class:`Indenter` has :attr:`Indenter.questions`, each with name, description, unit and example;
:func:`stated` builds the problem from the values.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from viscotack.cards import Quantity, card_of, cards
from viscotack.errors import InputError
from viscotack.geometry import (
    Bonded,
    Disc,
    FlatPunch,
    Frictionless,
    Layer,
    MeasuredProfile,
    PowerLawProfile,
    Sphere,
)
from viscotack.materials import (
    Elastic,
    Material,
    Prony,
    RelaxationPowerLaw,
    RetardationPowerLaw,
    StandardSolid,
)
from viscotack.materials.checks import rests
from viscotack.materials.constants import ContactModulus, ModulusRatio
from viscotack.materials.library import MATERIALS, passport_of
from viscotack.materials.passport import Passport
from viscotack.materials.words import FITS_ONLY, MODELS
from viscotack.problem import Groups, Problem, plane, revolution
from viscotack.problem.case_file import measured_profile, moved
from viscotack.problem.law_table import law_from_words
from viscotack.problem.nouns import Nouns, known
from viscotack.problem.prony_file import read_prony
from viscotack.problem.tables import OWN
from viscotack.protocol import Apart, AtDepth, AtForce, AtRadius, Start, check_number_of_moves
from viscotack.protocol.words import PURE_NUMBERS, move_from_words
from viscotack.theory.elastic.relaxed import radius_without_adhesion
from viscotack.traction import LennardJones
from viscotack.units import parse, positive

from .wording import listed

# Start -> name of its command-line option.
STARTS: dict[str, Any] = {
    "preload": AtDepth,
    "preload-force": AtForce,
    "preload-radius": AtRadius,
    "apart": Apart,
}
# Largest contact radius of the start, in the unit of --preload-radius: the mesh size is limited.
_LARGEST_START = 1000.0
_SOLID = cards(RetardationPowerLaw)
# Scales that convert a sphere to SI.
SCALES: dict[str, Quantity] = {
    "radius": cards(Sphere)["radius"].card,
    "contact-modulus": card_of(ContactModulus),
    "work-of-adhesion": cards(LennardJones)["work_of_adhesion"].card,
    "equilibrium-gap": cards(LennardJones)["equilibrium_gap"].card,
    "tau0": _SOLID["tau0"].card,
    "poisson-ratio": _SOLID["poisson_ratio"].card,
}
_MOVES = (
    "What the machine does before the retraction; give it once for each move. 'approach SPEED to "
    "WHERE', 'retract SPEED to WHERE' (WHERE: depth, force or radius and a number), 'move to DEPTH "
    "in TIME', 'load to FORCE in TIME', 'dwell TIME', 'hold drive|depth|force TIME'; all "
    "dimensionless."
)
_LAWS = (
    "Forces across the gap: lennard-jones (also when left out), dugdale, exponential:DECAY (decay "
    "length over h0), or table:FILE, a CSV file with the header 'gap_nm,traction_kPa' or other "
    "units; NAME:NUMBERS for one of --with. Strength that grows with the opening speed: "
    "gent-schultz:SPEED,EXPONENT or eyring:SPEED,SENSITIVITY (reference speed in h0 over the unit "
    "of time); with the time in contact: logarithmic-ageing:TIME,SENSITIVITY or "
    "saturating-ageing:TIME,GROWTH; with :LAW behind it for another law at rest than "
    "lennard-jones."
)
_MATERIALS = {
    "power-law": "modified power law by its retardation spectrum",
    "sls": "standard linear solid, tau0 is its retardation time",
}
_OTHER_MATERIALS = (
    "fractional-zener:ORDER: standard solid with a springpot of this order, 0.02 to 0.95. "
    "elastic: no memory; --rate is only needed in SI, in h0/s. prony:FILE: CSV file with the "
    "header 'modulus_ratio,relaxation_time_s' and a branch a row, its modulus over the rubbery "
    "modulus and its relaxation time. The unit of time (of --rate and of the crack speed) is then "
    "that of the header: s, ms, ..., or none. FILE.toml: a passport, as `viscotack material fit` "
    "writes it, or the name of a published material (`viscotack material list`), as pdms-10-1. "
    "NAME:NUMBERS for one of --with."
)


_TEMPERATURE = (
    'Temperature of a passport material, "0 degC", within its measured range; shifts its times.'
)
_ALONE = (
    "For results in SI only, because a dimensionless rate is relative to the time of the material. "
    "Also for CASE.toml."
)


@dataclass(frozen=True)
class Question:
    """A number or text that defines part of a problem.

    Attributes
    ----------
    name : str
        Name of the option, without leading dashes.
    words : str
        Description with the unit.
    text : bool
        Whether the value is text (a quantity with its unit, a name), not a number.
    many : bool
        Whether it may be repeated.
    """

    name: str
    words: str
    text: bool = False
    many: bool = False


@dataclass(frozen=True)
class Indenter:
    """An indenter that can be defined by numbers.

    Attributes
    ----------
    word : str
        Name in the command.
    numbers : mapping
        Numbers of the geometry: name of the option -> card.
    units : mapping
        Units of the numbers of the machine.
    starts : tuple of str
        Available starts.
    material : str
        Default material.
    in_si : bool
        Whether results in SI are available.
    more : mapping
        Cards of optional numbers, as `numbers`.
    """

    word: str
    numbers: Mapping[str, Quantity]
    units: Mapping[str, str]
    starts: tuple[str, ...]
    material: str
    in_si: bool = False
    more: Mapping[str, Quantity] = field(default_factory=dict)

    @cached_property
    def questions(self) -> tuple[Question, ...]:
        """All options of the indenter."""
        solid = "; ".join(
            f"{word}{' (also when left out)' if word == self.material else ''}: {words}"
            for word, words in _MATERIALS.items()
        )
        numbers = {**self.numbers, **self.more}
        asked = [
            *(Question(n, question_of(card)) for n, card in numbers.items()),
            *([Question(_FILE, _MEASURED, text=True)] if "profile-exponent" in numbers else ()),
            *([Question("bonded", _GLUED)] if "thickness" in numbers else ()),
            Question("material", f"{solid}. {_OTHER_MATERIALS}", text=True),
            Question("temperature", f"{_TEMPERATURE} {_ALONE}", text=True),
            _SET,
            Question("modulus-ratio", question_of(card_of(ModulusRatio))),
            Question("exponent", question_of(_SOLID["exponent"].card)),
        ]
        for number, name in enumerate(self.starts):
            (field,) = cards(STARTS[name]).values()
            words = question_of(field.card, self.units[field.card.measure])
            asked.append(Question(name, f"Or: {words[0].lower()}{words[1:]}" if number else words))
        test = cards(Groups)
        asked += [
            Question("move", _MOVES, text=True, many=True),
            Question("stiffness", question_of(test["stiffness"].card, self.units["stiffness"])),
            Question(
                "rate",
                f"Retraction speed, in {self.units['speed']} (prony: h0 per unit of time); with "
                "--move it may be left out, and the test ends with the last move.",
            ),
            Question("law", _LAWS, text=True),
        ]
        if self.in_si:
            asked += [
                Question(name, f"For answers in SI as well: {question_of(card)}", text=True)
                for name, card in SCALES.items()
            ]
        return tuple(asked)


def question_of(card: Quantity, unit: str = "") -> str:
    """Return the help text of a card: description, unit, range and example."""
    head, comma, rest = card.words.partition(",")
    words = f"{head[0].upper()}{head[1:]}" + (f", in {unit}" if unit else "") + comma + rest
    symbol = f" ({card.symbol})" if card.symbol else ""
    words += f"{symbol}; must {card.range}" if card.bounded and not unit else ""
    return words + (f', for example "{card.example}"' if card.example and not unit else "") + "."


_FILE = "points"
_MEASURED = (
    "In place of --profile-exponent: CSV file of a measured profile with the columns radius_1 (in "
    "beta) and height_1 (heights in any unit; they are scaled so that the sphere closest to the "
    "profile has the radius R)."
)
_GLUED = (
    "Poisson ratio, 0 to 0.5, of a layer bonded to its base; without this option the layer slides "
    "on its base."
)
_TABOR = {"tabor": cards(Groups)["tabor"].card}
_LAYER = {
    "thickness": Quantity(
        "beta",
        "b/beta",
        "thickness of the layer, a half-space when left out; beta = (R^2 dg0/E0*)^(1/3)",
        above=0,
        most=1e9,
    )
}
_PUNCH = plane.SIZES | {"cohesion": cards(Groups)["cohesion"].card}

SPHERE = Indenter(
    "sphere", _TABOR, revolution.GROUPS, tuple(STARTS), "power-law", in_si=True, more=_LAYER
)
PROFILE = Indenter(
    "profile",
    _TABOR | {"profile-exponent": cards(PowerLawProfile)["exponent"].card},
    revolution.GROUPS,
    tuple(STARTS),
    "power-law",
    more=_LAYER,
)
DISC = Indenter(
    "disc",
    _TABOR,
    revolution.GROUPS,
    ("preload", "preload-force", "apart"),
    "power-law",
    more=_LAYER,
)
PUNCH = Indenter("punch", _PUNCH, plane.GROUPS, ("preload", "preload-force", "apart"), "sls")
# Of a problem that a file states whole.
_SET = Question(
    "set",
    'Replace a number of CASE.toml, sphere.radius="6 mm"; `viscotack campaign inputs CASE.toml` '
    "lists the names. Repeatable.",
    text=True,
    many=True,
)
OF_FILE = (Question("temperature", _TEMPERATURE, text=True), _SET)


def stated(
    indenter: Indenter, answers: Mapping[str, Any], also: Iterable[Any] = ()
) -> Groups | Problem:
    """Build the problem: dimensionless, or in SI if scales are given.

    Parameters
    ----------
    indenter : Indenter
        The indenter.
    answers : mapping
        Values by the names of the options; None if not given.
    also : iterable of classes
        User-defined laws and materials.

    Raises
    ------
    ValueError
        If a value is missing, excluded by another one, or invalid.
    """
    given, nouns = given_of(answers), known(also)
    if _FILE in given:
        if "profile-exponent" in given:
            raise InputError(f"give either --profile-exponent or --{_FILE}, not both")
        indenter = replace(indenter, numbers=_TABOR)
    given |= _scales_of_passport(given, nouns)
    in_si = bool(given.keys() & SCALES.keys())
    if "temperature" in given and not in_si:
        raise InputError(
            "--temperature has no effect on a dimensionless problem, because --rate is relative to "
            "the time of the material; give --radius and --work-of-adhesion, or CASE.toml"
        )
    _refuse_missing(indenter, given, in_si, nouns)
    solid, unit = material_from({"material": indenter.material, **given}, nouns)
    elastic = isinstance(solid, Elastic)
    check_number_of_moves(len(given.get("move", ())))
    moves = tuple(move_from_words(words, PURE_NUMBERS) for words in given.get("move", ()))
    numbers = {
        name.replace("-", "_"): card.checked(f"--{name}", given[name], "1")
        for name, card in indenter.numbers.items()
    }
    parts: dict[str, Any] = {
        "material": solid,
        "start": _start(indenter, given, numbers),
        # An elastic solid has no time of its own: without a rate the time unit of a dimensionless
        # answer is that in which the drive travels h0. Seconds need a speed.
        "rate": _positive(given, "rate", None if moves else 1.0),
        "traction": law_from_words(given.get("law", LennardJones.word), nouns.laws),
        "moves": moves,
        "stiffness": _positive(given, "stiffness", None),
    }
    if indenter is PUNCH:
        parts |= {"geometry": FlatPunch(numbers["size"]), "body": _layer(given)}
        return Groups(tabor=None, cohesion=numbers["cohesion"], **parts)
    if _FILE in given:
        parts["geometry"] = _measured(given[_FILE])
    elif indenter is PROFILE:
        q = numbers.pop("profile_exponent")
        parts["geometry"] = PowerLawProfile(1 / q, q)
    if indenter is DISC:
        parts["geometry"] = Disc(1.0)
    if "thickness" in given:
        parts["body"] = _layer(given)
    elif "bonded" in given:
        raise InputError("--bonded needs a layer; give its --thickness as well")
    groups = Groups(**numbers, **parts)
    return _in_si(groups, given, "s" if elastic else unit) if in_si else groups


def _measured(file: str) -> MeasuredProfile:
    """Read a profile without dimensions, scaled to the equivalent radius 1."""
    if not file.endswith(".csv"):
        raise InputError(f"--{_FILE} must name a file FILE.csv, got {file!r:.60}")
    return measured_profile(Path(file), pure=True)


def _layer(given: Mapping[str, Any]) -> Layer:
    """Build the layer from the values."""
    glued = "bonded" in given
    base = Bonded(poisson_ratio=given["bonded"]) if glued else Frictionless()
    return Layer(_LAYER["thickness"].checked("--thickness", given["thickness"], "1"), base)


def material_from(given: Mapping[str, Any], nouns: Nouns | None = None) -> tuple[Material, str]:
    """Return the reduced material, and the time unit given by its file, else "1"."""
    nouns = known() if nouns is None else nouns
    name = given.get("material", "power-law")
    if is_passport(name):
        refuse_beside(name, given, ("modulus-ratio", "exponent"))
        return _solid_of(given, nouns).reduced(), "1"
    if "temperature" in given:
        raise InputError(
            "--temperature needs a passport with a shift law; give --material FILE.toml"
        )
    kind = _kind_of_material(name, nouns)
    word, _, rest = name.partition(":")
    require(given, material_needs(given, nouns), f" for --material {word}")
    numbers = material_numbers(kind)
    for flag in ("modulus-ratio", "exponent"):
        if flag in given and flag not in numbers:
            raise InputError(f"--{flag} is not an option of --material {word}; remove it")
    values: dict[str, Any] = {"rubbery_modulus": 1.0, "poisson_ratio": 0.0}
    if kind is Prony:
        branches, unit = read_prony(rest)
        return Prony(**values, branches=branches), unit
    if "modulus-ratio" in numbers:
        k = positive("--modulus-ratio", given["modulus-ratio"], "1")
        if k > 1:
            raise InputError(
                f"--modulus-ratio is the rubbery over the glassy modulus, in (0, 1], got {k:g}; "
                f"did you mean {1 / k:.4g}?"
            )
        values["glassy_modulus"] = 1 / k
    if "tau0" in cards(kind):
        values["tau0"] = 1.0
    if "exponent" in numbers:
        values["exponent"] = positive("--exponent", given["exponent"], "1")
    return kind(**values | _own_numbers(kind, values, rest, name)), "1"


def is_passport(material: Any) -> bool:
    """Whether a material is given by a passport: an object, a file or a published name."""
    return isinstance(material, Passport) or material.endswith(".toml") or material in MATERIALS


def passport_in(material: Any, also: Iterable[Any] = ()) -> Passport:
    """Return the passport of a material."""
    return material if isinstance(material, Passport) else passport_of(material, also=also)


def refuse_beside(material: Any, given: Mapping[str, Any], flags: Iterable[str]) -> None:
    """Raise InputError for options that the passport already defines."""
    if beside := [f"--{flag}" for flag in flags if flag in given]:
        name = material.name if isinstance(material, Passport) else material
        raise InputError(f"{name} defines the whole material; remove {listed(beside)}")


def _kind_of_material(name: Any, nouns: Nouns) -> Any:
    """Return the class of the named material, None for a passport."""
    if is_passport(name):
        return None
    word, _, rest = name.partition(":")
    kind = nouns.materials.get(word)
    rests(FITS_ONLY.get(word))
    spelled = kind in (RetardationPowerLaw, Elastic, StandardSolid, Prony)
    if kind is None or kind is RelaxationPowerLaw or spelled and (kind is Prony) != bool(rest):
        own = [w for w in nouns.materials if w not in MODELS]
        raise InputError(
            "--material must be a passport FILE.toml, "
            f"{', '.join(['power-law', 'elastic', 'sls', 'fractional-zener:ORDER', *own])} "
            f"or prony:FILE, got {name!r}"
            f"{OWN}"
        )
    return kind


def material_numbers(kind: Any) -> list[str]:
    """Return the flags that a dimensionless material of a class takes."""
    fields = cards(kind)
    asked = {"modulus-ratio": "glassy_modulus", "exponent": "exponent"}
    return [flag for flag, name in asked.items() if name in fields]


def material_needs(given: Mapping[str, Any], nouns: Nouns) -> list[str]:
    """Return the flags without which the material of a command is not stated."""
    kind = _kind_of_material(given.get("material", "power-law"), nouns)
    return [] if kind is None else material_numbers(kind)


def _own_numbers(kind: Any, values: Mapping[str, Any], rest: str, name: str) -> dict[str, float]:
    """Return the pure numbers of a user's own material, NAME:NUMBERS in the order of its fields."""
    fields = [f for f in cards(kind).values() if f.name not in values]
    given = [text for text in rest.split(",") if text]
    needed = [f for f in fields if f.needed]
    if not len(needed) <= len(given) <= len(fields):
        wanted = ",".join(f.name.upper() for f in fields)
        raise InputError(
            f"write {kind.word}{':' if wanted else ''}{wanted} for --material, got {name!r}"
        )
    return {f.name: f.card.checked(f.name, text) for f, text in zip(fields, given, strict=False)}


def given_of(answers: Mapping[str, Any]) -> dict[str, Any]:
    """Return the answers that were given."""
    return {name: value for name, value in answers.items() if value not in (None, (), [])}


def _positive(given: Mapping[str, Any], name: str, otherwise: float | None) -> float | None:
    return positive(f"--{name}", given[name], "1") if name in given else otherwise


def _refuse_missing(
    indenter: Indenter, given: Mapping[str, Any], in_si: bool, nouns: Nouns
) -> None:
    """Raise InputError that lists all missing options."""
    solid = {"material": indenter.material, **given}
    elastic = solid["material"] == Elastic.word
    moved = bool(given.get("move"))
    rate = ["rate"] if not moved and (in_si or not elastic) else []
    needs = material_needs(solid, nouns)
    missing = [f"--{name}" for name in (*indenter.numbers, *needs, *rate) if name not in given]
    start = ""
    if not given.keys() & set(indenter.starts):
        start = f"exactly one of {', '.join(f'--{name}' for name in indenter.starts)}"
    if missing:
        of_solid = any(name not in given for name in needs)
        why = f" for --material {solid['material']}" if of_solid else ""
        if of_solid and "material" not in given:
            why += ", the one that is taken without --material (sls, elastic and others exist)"
        more = f"; also give {start}" if start else ""
        raise InputError(f"{listed(missing)} missing{why}{more}; see --help")
    if start:
        raise InputError(f"give {start}, got none; see --help")


def _solid_of(given: Mapping[str, Any], nouns: Nouns) -> Material:
    """Return the material of a passport, at the requested temperature."""
    passport = passport_in(given["material"], nouns.materials.values())
    temperature = temperature_of(given)
    return passport.material if temperature is None else passport.at_temperature(temperature)


def temperature_of(answers: Mapping[str, Any]) -> float | None:
    """Return the requested temperature [K], or None."""
    given = given_of(answers)
    if "temperature" not in given:
        return None
    try:
        return parse(given["temperature"], "K")
    except ValueError as error:
        raise InputError(f'--temperature: {error}; for example --temperature "0 degC"') from None


def passport_at(
    answers: Mapping[str, Any], also: Iterable[Any] = ()
) -> tuple[Passport | None, float]:
    """Return the passport of the material at the requested temperature, and the doubt of its shift.

    None and 0 for a material stated by numbers; the doubt is the standard deviation of log10 a_T.
    """
    given = given_of(answers)
    if not is_passport(given.get("material", "")):
        return None, 0.0
    return moved(passport_in(given["material"], also), temperature_of(given))


def _scales_of_passport(given: Mapping[str, Any], nouns: Nouns) -> dict[str, Any]:
    """Return the scales that a passport defines, if the result is requested in SI."""
    name = given.get("material", "")
    if not is_passport(name) or not given.keys() & SCALES.keys():
        return {}
    refuse_beside(name, given, ("contact-modulus", "poisson-ratio", "tau0"))
    solid = _solid_of(given, nouns)
    scales = {
        "contact-modulus": f"{solid.contact_modulus!r} Pa",
        "poisson-ratio": solid.poisson_ratio,
    }
    return scales if isinstance(solid, Elastic) else scales | {"tau0": f"{solid.time_unit!r} s"}


def _start(
    indenter: Indenter, given: Mapping[str, Any], numbers: Mapping[str, float]
) -> Start | Apart:
    name = one_of(given, indenter.starts)
    kind = STARTS[name]
    (field,) = cards(kind).values()
    value = field.card.checked(f"--{name}", given[name], "1")
    if "tabor" in numbers:
        q = numbers.get("profile_exponent", 2.0)
        _refuse_large(name, kind(value), numbers["tabor"], q)
    return kind(value)


def _refuse_large(name: str, start: Start | Apart, tabor: float, exponent: float) -> None:
    radius = radius_without_adhesion(start, tabor=tabor, exponent=exponent)
    (value,) = vars(start).values()
    if radius > _LARGEST_START and tabor < (least := revolution.SIMULATED_TABOR[0]):
        raise InputError(
            f"--tabor must be at least {least:g} for a simulation, got {tabor:g}; use "
            "theory.bradley below"
        )
    if radius > _LARGEST_START:
        raise InputError(
            f"--{name} {value:g} at --tabor {tabor:g} gives a contact radius of {radius:.3g} "
            f"(pi R^2 dg0/E0*)^(1/3), above the limit of {_LARGEST_START:g}; give less"
        )


def _in_si(groups: Groups, given: Mapping[str, Any], unit: str) -> Problem:
    """Return the problem in SI; `unit` is the unit of time, or "1" where --tau0 must state it."""
    lengths = [name for name in ("equilibrium-gap", "work-of-adhesion") if name in given]
    if len(lengths) != 1:
        raise InputError(
            "for SI give exactly one of --equilibrium-gap and --work-of-adhesion, "
            f"got {'both' if lengths else 'none'}; the Tabor number determines the other"
        )
    needed = ["radius", "contact-modulus", "poisson-ratio", *(["tau0"] if unit == "1" else [])]
    require(given, needed, " to go to SI")
    refuse_time(given, unit)
    scales = {}
    for name, card in SCALES.items():
        if name in given:
            example = f'"{card.example}"' if card.unit != "1" else card.example
            try:
                scales[name.replace("-", "_")] = parse(given[name], card.unit)
            except ValueError as error:
                raise InputError(f"--{name}: {error}; for example --{name} {example}") from None
    time_unit = scales.pop("tau0", None)
    if time_unit is None:
        time_unit = parse(f"1 {unit}", "s")
    return groups.in_si(**scales, time_unit=time_unit)


def refuse_time(given: Mapping[str, Any], unit: str) -> None:
    """Refuse a time beside a material whose times have a unit, "1" being none."""
    if unit != "1" and "tau0" in given:
        raise InputError(f"--tau0 is not needed because the time unit is {unit}; remove it")


def one_of(given: Mapping[str, Any], names: Iterable[str]) -> str:
    """Return the one option that is given; InputError for none or several."""
    found = [name for name in names if name in given]
    if len(found) != 1:
        got = " and ".join(f"--{name}" for name in found) or "none"
        known = ", ".join(f"--{name}" for name in names)
        raise InputError(f"give exactly one of {known}, got {got}")
    return found[0]


def require(given: Mapping[str, Any], names: Iterable[str], why: str = "") -> None:
    """Raise InputError that lists the missing options."""
    missing = [f"--{name}" for name in names if name not in given]
    if missing:
        raise InputError(f"{listed(missing)} missing{why}; see --help")
