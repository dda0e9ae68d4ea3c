"""A problem stated by flags: each is a key of a table of its file, dimensionless or in SI.

`viscotack simulate sphere --tabor 3.24 --rate 316 ...` states [groups], `--radius "5 mm" --speed
"10 um/s" ...` a problem in SI. The tables are read as those of a file, and what is wrong with a key
is said of its flag.
"""

import os
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from viscotack.errors import InputError

from .options import INDENTERS, flag_of, option_of, quoted

if TYPE_CHECKING:
    from .request import Request

ROUND = ("sphere", "profile", "disc")
_PUNCH = ("punch",)
BONDED = "Poisson ratio, 0 to 0.5, of a layer bonded to its base; it slides when left out."


@dataclass(frozen=True)
class Flag:
    """A flag of a problem.

    Attributes
    ----------
    words : str
        Description.
    pure, si : str
        Key, as TABLE.KEY, that it states without dimensions and in SI; "" where it has none. A
        table "shape" is that of the indenter.
    indenters : tuple of str
        Indenters that have it.
    many : bool
        Whether it may be repeated.
    metavar : str
        Placeholder of the value; "" for a number.
    """

    words: str
    pure: str = ""
    si: str = ""
    indenters: tuple[str, ...] = INDENTERS
    many: bool = False
    metavar: str = ""


def _both(words: str, key: str, **more: Any) -> Flag:
    """Return a flag that states the same key without dimensions and in SI."""
    return Flag(words, key, key, **more)


_MATERIAL = (
    "power-law (default; of a punch sls), sls, fractional-zener:ORDER, elastic, prony:FILE (CSV, "
    "modulus_ratio and relaxation_time_s, whose unit is then that of --rate), a passport "
    "FILE.toml, a published name (`viscotack material list`), or NAME:NUMBERS for one of your own."
)
_MOVE = (
    "A move before the retraction, repeatable: 'approach SPEED to WHERE', 'retract SPEED to WHERE' "
    "(depth, force or radius and a number), 'move to DEPTH in TIME', 'load to FORCE in TIME', "
    "'dwell TIME', 'hold drive|depth|force TIME'."
)
LAW = (
    "lennard-jones (default), dugdale, exponential:DECAY (over h0), table:FILE (CSV, gap_nm and "
    "traction_kPa), or NAME:NUMBERS for one of your own. Growing with the opening speed: "
    "gent-schultz:SPEED,EXPONENT, eyring:SPEED,SENSITIVITY; with the time in contact: "
    "logarithmic-ageing:TIME,SENSITIVITY, saturating-ageing:TIME,GROWTH; :LAW behind one is its "
    "law at rest."
)
# Of a problem that a file states.
OF_FILE = {
    "temperature": Flag(
        'Temperature of a passport, "0 degC"; shifts its times.', si="material.temperature"
    ),
    "set": Flag(
        'Change a number of CASE.toml, sphere.radius="6 mm"; `viscotack campaign inputs CASE.toml` '
        "lists them. Repeatable.",
        many=True,
        metavar="NAME=VALUE",
    ),
}
FLAGS: Mapping[str, Flag] = {
    "radius": Flag(
        'Radius of the sphere or disc, "5 mm".', si="shape.radius", indenters=("sphere", "disc")
    ),
    "half_width": Flag('Half width of the punch, "1 mm".', si="punch.half_width", indenters=_PUNCH),
    "rubbery_modulus": Flag(
        'Young\'s modulus E0 of the relaxed solid, "1.5 MPa"; a passport is scaled to it.',
        si="material.rubbery_modulus",
    ),
    "contact_modulus": Flag('Or: E0* = E0/(1 - nu^2), "1.94 MPa".', si="material.contact_modulus"),
    "poisson_ratio": Flag("0.5 when left out.", si="material.poisson_ratio"),
    "tau0": Flag('Time of the solid, "100 ms"; not with a passport.', si="material.tau0"),
    "temperature": OF_FILE["temperature"],
    "work_of_adhesion": Flag('Work of adhesion dg0, "50 mJ/m^2".', si="interface.work_of_adhesion"),
    "equilibrium_gap": Flag('Range of attraction h0, "100 nm".', si="interface.equilibrium_gap"),
    "strength": Flag('Or: largest tension, "100 kPa".', si="interface.strength"),
    "speed": Flag('Retraction speed, "10 um/s".', si="protocol.speed"),
    "tabor": Flag(
        "Tabor number mu = (R dg0^2/(E0*^2 h0^3))^(1/3).", "groups.tabor", indenters=ROUND
    ),
    "size": Flag("Half width of the punch over a0.", "punch.half_width", indenters=_PUNCH),
    "cohesion": Flag("Strength over E0*, of a punch.", "groups.cohesion", indenters=_PUNCH),
    "profile_exponent": Flag(
        "Exponent q of z = A r^q, from 1 (cone).", "shape.exponent", indenters=("profile",)
    ),
    "points": Flag(
        "Or: a profile as CSV, radius_1 (in beta) and height_1 (scaled to the radius R of the "
        "closest sphere).",
        "shape.file",
        indenters=("profile",),
        metavar="FILE.csv",
    ),
    "rate": Flag(
        "Retraction speed [h0/tau0; prony: h0 per unit of time]; without it a test ends with its "
        "last --move.",
        "groups.rate",
    ),
    "material": _both(_MATERIAL, "material.model", metavar="MATERIAL"),
    "modulus_ratio": _both("Rubbery over glassy modulus k, up to 1.", "material.modulus_ratio"),
    "exponent": _both("Exponent n of the modified power law.", "material.exponent"),
    "law": _both(LAW, "interface.law", metavar="LAW"),
    "thickness": _both(
        "Thickness of a layer [beta = (R^2 dg0/E0*)^(1/3), of a punch a0]; a half-space when left "
        "out.",
        "layer.thickness",
    ),
    "bonded": _both(BONDED, "layer.poisson_ratio"),
    "preload": Flag(
        "Depth of the relaxed start, positive into the solid [h0].",
        "groups.preload",
        "protocol.preload_depth",
    ),
    "preload_force": Flag(
        "Or: its force, positive in compression [1.5 pi R dg0]; of a punch the mean stress "
        "[strength].",
        "groups.preload_force",
        "protocol.preload_force",
    ),
    "preload_radius": Flag(
        "Or: its contact radius [(pi R^2 dg0/E0*)^(1/3)].",
        "groups.preload_radius",
        "protocol.preload_radius",
        ("sphere", "profile"),
    ),
    "apart": Flag(
        "Or: apart, by this gap of the undeformed surfaces [h0].", "groups.apart", "protocol.start"
    ),
    "move": Flag(_MOVE, "groups.moves", "protocol.moves", many=True, metavar="WORDS"),
    "stiffness": Flag(
        "Stiffness of the machine [1.5 pi R dg0/h0, of a punch strength/h0].",
        "groups.stiffness",
        "protocol.stiffness",
    ),
    "set": OF_FILE["set"],
}


def flags_of(indenters: tuple[str, ...]) -> dict[str, Flag]:
    """Return the flags of some indenters."""
    return {n: x for n, x in FLAGS.items() if set(x.indenters) & set(indenters)}


def tables_of(word: str, said: Mapping[str, Any], nouns: Any) -> dict[str, dict[str, Any]]:
    """Return the tables that flags state: dimensionless, or in SI.

    Parameters
    ----------
    word : str
        The indenter.
    said : mapping
        Flags -> values.
    nouns : Nouns
        Known laws and materials.
    """
    from viscotack.model.problem.case_file import table_of_words

    known, of_si = flags_of((word,)), of_si_alone(said)
    in_si = bool(of_si)
    if unknown := [n for n in said if n not in known or not (known[n].pure or known[n].si)]:
        words = f"a {word} has no option {quoted(unknown[:1])}; leave it out"
        raise InputError(words, field=unknown[0])
    if in_si and (pure := [name for name in said if not known[name].si]):
        raise InputError(
            f"{quoted(pure[:1])} is dimensionless and {quoted(of_si[:1])} in SI; state the whole "
            "problem in one of the two",
            field=pure[0],
        )
    test = "protocol" if in_si else "groups"
    tables: dict[str, dict[str, Any]] = {"material": {}, "interface": {}, word: {}, test: {}}
    for name, value in said.items():
        table, _, key = _place(name, word, in_si=in_si).partition(".")
        value = os.fspath(value) if isinstance(value, os.PathLike) else value
        tables.setdefault(table, {})[key] = f"apart {value}" if key == "start" else value
    if word == "disc" and not in_si:
        tables[word]["radius"] = 1.0
    if word == "punch" or "layer" in tables:
        base = "bonded" if "bonded" in said else "frictionless"
        tables.setdefault("layer", {})["base"] = base
    tables["interface"] |= table_of_words(_text(said, "law", "lennard-jones"), nouns.laws)
    solid = _text(said, "material", "sls" if word == "punch" else "power-law")
    tables["material"] = table_of_solid(solid, tables["material"], nouns, in_si=in_si)
    if solid == "elastic" and not in_si and "move" not in said:
        # an elastic solid has no time: the unit is that in which the drive travels h0
        tables["groups"].setdefault("rate", 1.0)
    # what the reader would name by a key that is no flag
    needed = [] if "move" in said else ["protocol.speed" if in_si else "groups.rate"]
    if not in_si:
        needed.append("groups.cohesion" if word == "punch" else "groups.tabor")
    elif "passport" not in tables["material"]:
        needed.append("material.rubbery_modulus")
    if word == "profile" and "file" not in tables[word]:
        needed.append("profile.exponent")
    places = (place.split(".") for place in needed)
    if missing := [f"{of}.{key}" for of, key in places if key not in tables[of]]:
        flags = [_flags_by_place(word, in_si=in_si)[place] for place in missing]
        verb = "are" if flags[1:] else "is"
        raise InputError(f"{quoted(flags)} {verb} missing", field=flags[0])
    return tables


def of_si_alone(said: Mapping[str, Any]) -> list[str]:
    """Return those of some flags that state a problem in SI, as they have no other meaning."""
    return [name for name in said if name in FLAGS and FLAGS[name].si and not FLAGS[name].pure]


def table_of_solid(
    words: str, said: Mapping[str, Any], nouns: Any, *, in_si: bool = False
) -> dict[str, Any]:
    """Return the table [material] of the words of an option and the numbers beside them."""
    from viscotack.cards import cards
    from viscotack.model.materials.library import MATERIALS
    from viscotack.model.tables import OWN
    from viscotack.units import parse

    numbers = {name: value for name, value in said.items() if name != "model"}
    if words.endswith(".toml") or words in MATERIALS:
        if beside := [n for n in numbers if n not in ("rubbery_modulus", "temperature")]:
            raise InputError(
                f"{words} defines the whole material; leave out {quoted(beside)}", field=beside[0]
            )
        return {"passport": words, **numbers}
    if in_si:
        numbers = {"poisson_ratio": 0.5} | numbers
    if "contact_modulus" in numbers:
        if "rubbery_modulus" in numbers:
            raise InputError(
                "give either `contact_modulus` or `rubbery_modulus`", field="contact_modulus"
            )
        nu = parse(numbers["poisson_ratio"], "1")
        modulus = parse(numbers.pop("contact_modulus"), "Pa") * (1 - nu**2)
        numbers["rubbery_modulus"] = f"{modulus!r} Pa"
    word, _, rest = words.partition(":")
    kind = nouns.materials.get(word)
    if kind is None:
        raise InputError(
            "material must be a passport FILE.toml, a published material, or one of "
            f"{', '.join(nouns.materials)}; got {words!r:.60}{OWN}",
            field="material",
        )
    by_flags = {"rubbery_modulus", "glassy_modulus", "poisson_ratio", "tau0"}
    by_flags |= {"exponent"} if word == "power-law" else set()
    own = {name: card.needed for name, card in cards(kind).items() if name not in by_flags}
    values = [text for text in rest.split(",") if text]
    if word == "prony":
        own, values = {"file": True}, [rest] if rest else []
    if not sum(own.values()) <= len(values) <= len(own):
        wanted = ":".join(filter(None, [word, ",".join(own).upper()]))
        raise InputError(f"material: write {wanted}, got {words!r:.60}", field="material")
    return {"model": word, **dict(zip(own, values, strict=False)), **numbers}


@contextmanager
def named_as_flags(word: str, *, in_si: bool) -> Iterator[None]:
    """Say errors of the tables that flags state of the flags."""
    try:
        yield
    except InputError as error:
        flags = _flags_by_place(word, in_si=in_si)
        name = flags.get(error.field, error.field)
        table = error.field.partition(".")[0]
        words = re.sub(r"^the options(, \[[\w-]+\])?:? |; write for example.*", "", str(error))
        for place, flag in flags.items():
            of, _, key = place.partition(".")
            if key and of == table:
                words = re.sub(rf"(?<![\w`.]){key}(?![\w`.=])", f"`{flag}`", words)
        if words.startswith("needs exactly one of "):
            # no start of a punch or a disc, which the tables of groups have for all shapes
            words = "the test " + words.replace("preload_radius, ", "")
        if "unknown key" in words:
            words = f"this solid has no `{name}`; leave it out"
        # what most mean by a preload
        words += "; a force is `preload_force`" if name == "preload" else ""
        raise InputError(words, field=name) from None


def _flags_by_place(word: str, *, in_si: bool) -> dict[str, str]:
    """Return the flags of an indenter by the keys that they state."""
    found = {_place(name, word, in_si=in_si): name for name in flags_of((word,))}
    return found | {"material.glassy_modulus": "modulus_ratio", "": ""}


def _place(name: str, word: str, *, in_si: bool) -> str:
    """Return table and key of a flag of an indenter."""
    if word == "punch" and in_si and name == "preload_force":
        return "protocol.preload_stress"
    return (FLAGS[name].si if in_si else FLAGS[name].pure).replace("shape.", f"{word}.")


def _text(said: Mapping[str, Any], name: str, usual: str) -> str:
    value = said.get(name, usual)
    if not isinstance(value, str | os.PathLike):
        raise InputError(f"{name} must be text, got {value!r:.60}", field=name)
    return os.fspath(value)


def in_flags(words: str, kind: "type[Request] | None") -> str:
    """Return a text with the options that it quotes as the command line spells them.

    Examples
    --------
    >>> from viscotack.app.operations.forecast import NextTest
    >>> in_flags("the wanted forecast needs its speed, `forecast_speed`", NextTest)
    'the wanted forecast needs its speed, --forecast-speed'
    """

    def flag(name: str) -> str:
        if kind is not None and name in kind.model_fields:
            option = option_of(kind.model_fields[name])
            return name if option.argument else flag_of(name, option)
        return f"--{name.replace('_', '-')}" if kind is not None and name in FLAGS else name

    return re.sub(r"`(\w+)`", lambda found: flag(found[1]), words)
