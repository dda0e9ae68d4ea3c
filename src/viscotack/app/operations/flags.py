"""A problem stated by flags: each is a key of a table of its file, dimensionless or in SI.

`viscotack simulate sphere --tabor 3.24 --rate 316 ...` states [groups], `--radius "5 mm" --speed
"10 um/s" ...` a problem in SI. The tables are read as those of a file.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from viscotack.errors import InputError

from .options import quoted
from .request import Caller

if TYPE_CHECKING:
    from .statement import Statement

# Words of what can be stated by flags.
INDENTERS = ("sphere", "punch", "profile", "disc")
ROUND = ("sphere", "profile", "disc")
_BY_RADIUS = ("sphere", "disc")
_STARTS = ("preload", "preload_force", "preload_radius", "apart")


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


_MATERIAL = (
    "power-law (also when left out, for a punch sls): modified power law by its retardation "
    "spectrum; sls: standard linear solid; fractional-zener:ORDER: standard solid with a springpot "
    "of this order; elastic: no memory; prony:FILE: CSV file with the header "
    "'modulus_ratio,relaxation_time_s' and a branch a row, whose unit of time is then that of "
    "--rate; a passport FILE.toml, as `viscotack material fit` writes it, or the name of a "
    "published material (`viscotack material list`), as pdms-10-1; NAME:NUMBERS for one of --with."
)
_MOVE = (
    "What the machine does before the retraction; give it once for each move. 'approach SPEED to "
    "WHERE', 'retract SPEED to WHERE' (WHERE: depth, force or radius and a number), 'move to DEPTH "
    "in TIME', 'load to FORCE in TIME', 'dwell TIME', 'hold drive|depth|force TIME'; with units in "
    "SI."
)
LAW = (
    "Forces across the gap: lennard-jones (also when left out), dugdale, exponential:DECAY (decay "
    "length over h0), or table:FILE, a CSV file with the header 'gap_nm,traction_kPa' or other "
    "units; NAME:NUMBERS for one of --with. Strength that grows with the opening speed: "
    "gent-schultz:SPEED,EXPONENT or eyring:SPEED,SENSITIVITY (reference speed in h0 over the unit "
    "of time); with the time in contact: logarithmic-ageing:TIME,SENSITIVITY or "
    "saturating-ageing:TIME,GROWTH; with :LAW behind it for another law at rest than lennard-jones."
)
# Of a problem that a file states.
OF_FILE = {
    "temperature": Flag(
        'Temperature of a passport material, "0 degC", within its measured range; shifts its '
        "times. In SI only.",
        si="material.temperature",
    ),
    "set": Flag(
        'Replace a number of CASE.toml, sphere.radius="6 mm"; `viscotack campaign inputs '
        "CASE.toml` lists the names. Repeatable.",
        many=True,
        metavar="NAME=VALUE",
    ),
}
FLAGS: Mapping[str, Flag] = {
    "tabor": Flag(
        "Tabor number mu = (R dg0^2/(E0*^2 h0^3))^(1/3), E0* the rubbery contact modulus.",
        "groups.tabor",
        indenters=ROUND,
    ),
    "size": Flag("Half width of the punch over a0.", "punch.half_width", indenters=("punch",)),
    "cohesion": Flag("Strength over E0*.", "groups.cohesion", indenters=("punch",)),
    "profile_exponent": Flag(
        "Exponent q of the profile z = A r^q, from 1 (cone).",
        "shape.exponent",
        indenters=("profile",),
    ),
    "points": Flag(
        "In place of --profile-exponent: CSV file of a measured profile with the columns radius_1 "
        "(in beta) and height_1 (heights in any unit; they are scaled so that the sphere closest "
        "to the profile has the radius R).",
        "shape.file",
        indenters=("profile",),
        metavar="FILE.csv",
    ),
    "modulus_ratio": Flag(
        "Rubbery over glassy modulus k, up to 1.",
        "material.modulus_ratio",
        "material.modulus_ratio",
    ),
    "exponent": Flag(
        "Exponent n of the modified power law.", "material.exponent", "material.exponent"
    ),
    "preload": Flag(
        "Depth of the relaxed start, positive into the solid, in h0.",
        "groups.preload",
        "protocol.preload_depth",
    ),
    "preload_force": Flag(
        "Or: force of the relaxed start, positive in compression, in 1.5 pi R dg0; of a punch the "
        "mean stress, in the strength.",
        "groups.preload_force",
        "protocol.preload_force",
    ),
    "preload_radius": Flag(
        "Or: contact radius of the relaxed start, in (pi R^2 dg0/E0*)^(1/3).",
        "groups.preload_radius",
        "protocol.preload_radius",
        ("sphere", "profile"),
    ),
    "apart": Flag(
        "Or: gap between the undeformed surfaces at a start apart, in h0.",
        "groups.apart",
        "protocol.start",
    ),
    "rate": Flag(
        "Retraction speed, in h0/tau0 (prony: h0 per unit of time); with --move it may be left "
        "out, and the test ends with the last move.",
        "groups.rate",
    ),
    "material": Flag(_MATERIAL, "-", "-", metavar="MATERIAL"),
    "law": Flag(LAW, "-", "-", metavar="LAW"),
    "thickness": Flag(
        "Thickness of the layer over beta = (R^2 dg0/E0*)^(1/3), a half-space when left out; of "
        "the layer under a punch over a0.",
        "layer.thickness",
        "layer.thickness",
    ),
    "bonded": Flag(
        "Poisson ratio, 0 to 0.5, of a layer bonded to its base; without this option the layer "
        "slides on its base.",
        "layer.poisson_ratio",
        "layer.poisson_ratio",
    ),
    "move": Flag(_MOVE, "groups.moves", "protocol.moves", many=True, metavar="WORDS"),
    "stiffness": Flag(
        "Stiffness of the machine, in 1.5 pi R dg0/h0; of that of a punch, in the strength over "
        "h0.",
        "groups.stiffness",
        "protocol.stiffness",
    ),
    "radius": Flag(
        'In SI, with units on all numbers: radius of the sphere or disc, "5 mm".',
        si="shape.radius",
        indenters=_BY_RADIUS,
    ),
    "half_width": Flag(
        'In SI: half width of the punch, "1 mm".', si="punch.half_width", indenters=("punch",)
    ),
    "speed": Flag('In SI: retraction speed, "10 um/s".', si="protocol.speed"),
    "work_of_adhesion": Flag(
        'In SI: work of adhesion dg0, "50 mJ/m^2".', si="interface.work_of_adhesion"
    ),
    "equilibrium_gap": Flag(
        'In SI: range of the attraction h0, "100 nm".', si="interface.equilibrium_gap"
    ),
    "strength": Flag(
        'In SI, in place of --equilibrium-gap: largest tension of the law, "100 kPa".',
        si="interface.strength",
    ),
    "rubbery_modulus": Flag(
        'In SI: Young\'s modulus E0 of the relaxed solid, "1.5 MPa"; not with a passport.',
        si="material.rubbery_modulus",
    ),
    "contact_modulus": Flag(
        'In SI, in place of --rubbery-modulus: E0* = E0/(1 - nu^2), "1.94 MPa".', si="-"
    ),
    "poisson_ratio": Flag(
        "In SI: Poisson ratio of the solid, 0.5 when left out.", si="material.poisson_ratio"
    ),
    "tau0": Flag('In SI: time of the solid, "100 ms"; not with a passport.', si="material.tau0"),
    **OF_FILE,
}


def flags_of(indenters: tuple[str, ...]) -> dict[str, Flag]:
    """Return the flags of some indenters."""
    return {n: x for n, x in FLAGS.items() if set(x.indenters) & set(indenters)}


def stated(word: str, given: Mapping[str, Any], caller: Caller) -> "Statement":
    """Return the problem that flags state: dimensionless, or in SI.

    Parameters
    ----------
    word : str
        The indenter.
    given : mapping
        Flags -> values.
    caller : Caller
        Resolves names of files.

    Raises
    ------
    InputError
        If a flag is missing, excluded by another one, or invalid.
    """
    from viscotack.model.problem.case_file import passport_of, problem_of
    from viscotack.model.problem.nouns import known
    from viscotack.model.problem.tables import Reading

    from .statement import Statement

    said = dict(given)
    known_flags = flags_of((word,))
    if unknown := [name for name in said if name not in known_flags]:
        raise InputError(f"a {word} has no option {quoted(unknown[:1])}; leave it out")
    for name, value in said.items():
        several = value if known_flags[name].many and isinstance(value, list | tuple) else [value]
        if any(isinstance(x, bool) or not isinstance(x, str | int | float) for x in several):
            raise InputError(f"{name} must be text or a number, got {value!r:.60}", field=name)
    for name in {"material", "law", "points"} & said.keys():
        said[name] = str(said[name])
    if "set" in said:
        raise InputError("set replaces a number of a file; give the option itself", field="set")
    only_si = [n for n in said if not known_flags[n].pure and n != "temperature"]
    in_si = bool(only_si)
    if in_si and (pure := [name for name in said if not known_flags[name].si]):
        raise InputError(
            f"{quoted(pure[:1])} is dimensionless and {quoted(only_si[:1])} in SI; state the whole "
            "problem in one of the two",
            field=pure[0],
        )
    nouns = known(caller.also)
    _refuse_missing(word, said, in_si, nouns)
    tables, flag_at = _tables(word, said, in_si, nouns)
    reading = Reading("the flags", nouns, caller.file)
    try:
        problem = problem_of(tables, reading)
    except InputError as error:
        if (name := flag_at.get(error.field)) is None:
            raise
        rest = str(error).partition(error.field.partition(".")[2])[2]
        # what most mean by a preload
        more = "; a force is `preload_force`" if name == "preload" else ""
        raise InputError(f"{name}{rest}{more}", field=name) from None
    passport, deviation = passport_of(tables, reading)
    return Statement(problem, deviation, passport)  # type: ignore[arg-type]


def _tables(
    word: str, said: Mapping[str, Any], in_si: bool, nouns: Any
) -> tuple[dict[str, dict[str, Any]], dict[str, str]]:
    """Return the tables that flags state, and the flag of each key."""
    from viscotack.model.problem.law_table import table_of_words

    test = "protocol" if in_si else "groups"
    shape: dict[str, Any] = {"radius": 1.0} if word == "disc" and not in_si else {}
    tables: dict[str, dict[str, Any]] = {"material": {}, "interface": {}, word: shape, test: {}}
    flag_at = {}
    for name, value in said.items():
        place = FLAGS[name].si if in_si else FLAGS[name].pure
        table, _, key = place.replace("shape.", f"{word}.").partition(".")
        if not key:
            continue
        if word == "punch" and key == "preload_force" and in_si:
            key = "preload_stress"
        value = f"apart {value}" if key == "start" else value
        tables.setdefault(table, {})[key] = value
        flag_at[f"{table}.{key}"] = name
    if "layer" in tables:
        tables["layer"]["base"] = "bonded" if "bonded" in said else "frictionless"
    tables["interface"] |= table_of_words(said.get("law", "lennard-jones"), nouns.laws)
    tables["material"] |= material_table(
        said.get("material", _usual(word)), said, in_si=in_si, nouns=nouns
    )
    if tables["material"].get("model") == "elastic" and not in_si and "move" not in said:
        # an elastic solid has no time: the unit is that in which the drive travels h0
        tables["groups"].setdefault("rate", 1.0)
    return tables, flag_at


def _usual(word: str) -> str:
    return "sls" if word == "punch" else "power-law"


def material_table(
    words: str, said: Mapping[str, Any], *, in_si: bool = False, nouns: Any
) -> dict[str, Any]:
    """Return the table [material] of the words of an option and the flags beside them."""
    from viscotack.cards import cards
    from viscotack.model.materials.library import MATERIALS
    from viscotack.model.problem.tables import OWN
    from viscotack.units import parse

    numbers = ("modulus_ratio", "exponent", "rubbery_modulus", "poisson_ratio", "tau0")
    others = (*numbers, "contact_modulus")
    if words.endswith(".toml") or words in MATERIALS:
        if beside := [name for name in others if name in said]:
            raise InputError(
                f"{words} defines the whole material; leave out {quoted(beside)}",
                field=beside[0],
            )
        return {"passport": words}
    if "contact_modulus" in said:
        nu = parse(said.get("poisson_ratio", 0.5), "1")
        modulus = parse(said["contact_modulus"], "Pa") * (1 - nu**2)
        said = {**said, "rubbery_modulus": f"{modulus!r} Pa"}
    word, _, rest = words.partition(":")
    kind = nouns.materials.get(word)
    if kind is None or (word == "prony") != bool(rest) and word in ("prony", "power-law", "sls"):
        raise InputError(
            "material must be a passport FILE.toml, a published material, power-law, sls, elastic, "
            f"fractional-zener:ORDER or prony:FILE, got {words!r:.60}{OWN}",
            field="material",
        )
    table: dict[str, Any] = {"model": word}
    if word == "prony":
        table["file"], rest = rest, ""
    by_flags = {"rubbery_modulus", "glassy_modulus", "poisson_ratio", "tau0"}
    by_flags |= {"exponent"} if word == "power-law" else set()
    own = [name for name in cards(kind) if name not in by_flags]
    values = [text for text in rest.split(",") if text]
    needed = [name for name in own if cards(kind)[name].needed]
    if not len(needed) <= len(values) <= len(own):
        wanted = ",".join(name.upper() for name in own)
        raise InputError(
            f"write {word}{':' if wanted else ''}{wanted}, got {words!r:.60}", field="material"
        )
    table |= dict(zip(own, values, strict=False))
    for name in numbers:
        of = "glassy_modulus" if name == "modulus_ratio" else name
        if name in said and of not in cards(kind):
            raise InputError(f"a solid {word} has no {name}; leave it out", field=name)
        if name in said:
            table[name] = said[name]
    return ({"poisson_ratio": 0.5} if in_si else {}) | table


def needs_of(words: str, nouns: Any, *, in_si: bool = False) -> list[str]:
    """Return the numbers that a material stated by words needs."""
    from viscotack.cards import cards

    word = words.partition(":")[0]
    kind = nouns.materials.get(word)
    if kind is None or word == "prony":
        return []
    asked = {"modulus_ratio": "glassy_modulus", "exponent": "exponent"}
    found = [name for name, of in asked.items() if of in cards(kind)]
    return found + (["tau0"] if in_si and "tau0" in cards(kind) else [])


def _refuse_missing(word: str, said: Mapping[str, Any], in_si: bool, nouns: Any) -> None:
    """Raise InputError that lists all missing flags."""
    solid, punch = said.get("material", _usual(word)), word == "punch"
    of_solid = needs_of(solid, nouns, in_si=in_si)
    # of some, one is enough
    needed: list[tuple[str, ...]] = [(name,) for name in of_solid]
    if in_si:
        needed = [("half_width" if punch else "radius",), ("work_of_adhesion",), *needed]
        if solid.partition(":")[0] in nouns.materials:
            needed.append(("rubbery_modulus", "contact_modulus"))
        needed += [("equilibrium_gap", "strength"), ("speed", "move")]
    else:
        needed = [("size",), ("cohesion",), *needed] if punch else [("tabor",), *needed]
        needed += [("profile_exponent", "points")] * (word == "profile")
        needed += [] if solid == "elastic" else [("rate", "move")]
    needed += [("thickness",)] * punch
    if "bonded" in said and "thickness" not in said:
        raise InputError("bonded needs a layer; give its thickness as well", field="bonded")
    if "points" in said and "profile_exponent" in said:
        raise InputError("give either profile_exponent or points, not both", field="points")
    starts = [name for name in _STARTS if name in said]
    of = [name for name in _STARTS if word in FLAGS[name].indenters]
    one_of = f"exactly one of {quoted(of)}"
    if missing := [names[0] for names in needed if not said.keys() & set(names)]:
        more = "" if starts else f"; also give {one_of}"
        why = "" if "material" in said or in_si else f" for the material {solid}, the usual one"
        why = why if set(missing) & set(of_solid) else ""
        verb = "are" if missing[1:] else "is"
        raise InputError(f"{quoted(missing)} {verb} missing{why}{more}")
    if len(starts) != 1:
        raise InputError(f"give {one_of}, got {quoted(starts) or 'none'}")
