"""A problem as tables: the TOML file of a case, JSON, and the body of a request.

docs/input.md describes the format; the keys of a table follow from the cards of its class. Tables
in SI are [material], [interface], one for the shape, perhaps one for the body, and [protocol]; a
dimensionless problem has [groups] in place of [protocol], and numbers without units. A rough
surface has [surface] in place of the shape.
"""

import hashlib
import json
import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

from viscotack.cards import Exact, Field, Quantity, card_of, cards, with_units
from viscotack.errors import InputError, placed
from viscotack.files.quantities import read_quantities
from viscotack.files.toml import read_toml
from viscotack.model.geometry import (
    Bonded,
    Cone,
    FlatPunch,
    Frictionless,
    HalfSpace,
    Layer,
    MeasuredProfile,
    PowerLawProfile,
    Sphere,
)
from viscotack.model.materials import Elastic, Material, Prony
from viscotack.model.materials.constants import ModulusRatio
from viscotack.model.materials.conversion import scaled
from viscotack.model.materials.library import MATERIALS, published
from viscotack.model.materials.material import word_of
from viscotack.model.materials.passport import Passport
from viscotack.model.materials.passport_file import read_passport
from viscotack.model.problem import plane, revolution
from viscotack.model.problem.nouns import known
from viscotack.model.problem.problem import (
    Case,
    Cohesion,
    Groups,
    Problem,
    Rate,
    Spring,
    Tabor,
)
from viscotack.model.problem.rough_case import RoughCase, StatedSurface, hash_of
from viscotack.model.protocol import (
    Apart,
    AtDepth,
    AtForce,
    AtRadius,
    Move,
    Retraction,
    Speed,
    Start,
    Stiffness,
    check_number_of_moves,
)
from viscotack.model.protocol_words import (
    PURE_NUMBERS,
    history_from_file,
    move_from_words,
    start_from_words,
    words_of_move,
)
from viscotack.model.tables import OWN, Reading, UnknownNoun, read_as, refuse_unknown, stated
from viscotack.model.traction import LAWS, LennardJones, Tabulated, Traction, has_rest
from viscotack.units import readable

Tables = Mapping[str, Any]
# Largest thickness of a layer over the contact's length.
_THICKEST = 1e9


def read_case(path: str | os.PathLike[str], *, also: Iterable[Any] = ()) -> Case:
    """Read a problem from a TOML file, in SI or with the table [groups] dimensionless.

    Parameters
    ----------
    path : path
        File with the tables [material], [interface], [protocol] and one for the indenter: [sphere],
        [cone], [profile], [disc], [wavy-sphere], [measured-profile], or [punch] and [layer].
        Quantities are texts with units, such as ``radius = "5.19 mm"``; files named in it are
        relative to its folder.
    also : iterable of classes
        User-defined laws, materials, shapes and bodies that the file may name by their words.

    Returns
    -------
    Problem or Groups
        The problem, in SI or dimensionless.

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    ValueError
        If it is not TOML, a table or key is missing, unknown or of the wrong kind, or the problem
        is invalid; the message names file, table and key.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> text = '''
    ... [material]
    ... model = "elastic"
    ... rubbery_modulus = "1 MPa"
    ... poisson_ratio = 0.5
    ... [interface]
    ... law = "lennard-jones"
    ... work_of_adhesion = "50 mJ/m^2"
    ... equilibrium_gap = "1 um"
    ... [sphere]
    ... radius = "1 mm"
    ... [protocol]
    ... preload_depth = "1 um"
    ... speed = "10 um/s"
    ... '''
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "case.toml")
    ...     _ = file.write_text(text)
    ...     problem = read_case(file)
    >>> problem.geometry
    Sphere(radius=0.001)
    """
    path = Path(path)
    reading = Reading(str(path), known(also), path.parent.joinpath)
    problem = problem_of(read_toml(path), reading)
    if isinstance(problem, RoughCase):
        raise InputError(
            f"{path} states a map of heights; read it with viscotack.simulate.rough.read_rough"
        )
    return problem


def case_of_tables(
    tables: Mapping[str, Any],
    *,
    where: str = "the case",
    also: Iterable[Any] = (),
    beside: Callable[[str], Path] | None = None,
) -> Problem:
    """Return the problem stated by the tables of a case file, without a file.

    Parameters
    ----------
    tables : mapping
        Tables as in :func:`read_case`.
    where : str
        Name of the case in error messages.
    also : iterable of classes
        User-defined laws, materials, shapes and bodies that it may name by their words.
    beside : callable, optional
        Returns the path of a file named in a table; without it tables may not name files.

    Raises
    ------
    ValueError
        As :func:`read_case`; and if a table names a file and may not.

    Examples
    --------
    >>> problem = case_of_tables(
    ...     {
    ...         "material": {
    ...             "model": "elastic", "rubbery_modulus": "1 MPa", "poisson_ratio": 0.5
    ...         },
    ...         "interface": {
    ...             "law": "lennard-jones",
    ...             "work_of_adhesion": "50 mJ/m^2",
    ...             "equilibrium_gap": "1 um",
    ...         },
    ...         "sphere": {"radius": "1 mm"},
    ...         "protocol": {"preload_depth": "1 um", "speed": "10 um/s"},
    ...     }
    ... )
    >>> problem.geometry
    Sphere(radius=0.001)
    """
    problem = problem_of(tables, Reading(where, known(also), beside))
    if not isinstance(problem, Problem):
        raise InputError(f"{where} must state a shape and a test in SI, [protocol]")
    return problem


def from_dict(
    record: Mapping[str, Any],
    also: Iterable[Any] = (),
    *,
    beside: Callable[[str], Path] | None = None,
) -> Any:
    """Restore a problem from a dictionary of :func:`to_dict`, or from the tables of a file.

    Parameters
    ----------
    record : dict
        Tables of a problem. Numbers without a unit are in SI.
    also : iterable of classes
        User-defined laws, materials, shapes and bodies that it may name.
    beside : callable, optional
        Returns the path of a file named in a table; without it tables may not name files.

    Returns
    -------
    Problem, Groups or RoughCase
        Equal to the original object.

    Raises
    ------
    InputError
        If a table or key is missing or unknown, or a value is invalid.

    Examples
    --------
    >>> tables = {
    ...     "groups": {"tabor": 3.24, "preload": 73, "rate": 316.23},
    ...     "material": {"model": "power-law", "modulus_ratio": 0.1, "exponent": 0.8},
    ... }
    >>> from_dict(tables).start
    AtDepth(depth=73.0)
    """
    return problem_of(record, Reading("the problem", known(also), beside, bare=True))


def problem_of(tables: Tables, reading: Reading) -> Problem | Groups | RoughCase:
    """Return the problem of tables: in SI, dimensionless with [groups], rough with [surface].

    Parameters
    ----------
    tables : mapping
        Tables as in :func:`read_case`.
    reading : Reading
        How their values are read.
    """
    where, nouns = reading.where, reading.nouns
    if not isinstance(tables, Mapping):
        raise InputError(f"{where} must be tables with keys, got {tables!r:.60}")
    test = "groups" if "groups" in tables else "protocol"
    reading = replace(reading, pure=test == "groups")
    shapes = [name for name in tables if name in nouns.shapes]
    if len(shapes) > 1:
        raise InputError(
            f"{where}: only one indenter is allowed, got [{'] and ['.join(shapes)}]",
            field=shapes[1],
        )
    shape = shapes[0] if shapes else FlatPunch.word if Layer.word in tables else Sphere.word
    if "surface" in tables:
        if reading.pure:
            raise InputError(
                f"{where}: a map of heights, [surface], is stated in SI with a [protocol]"
            )
        shape = "surface"
    plain = shape != "surface" and nouns.shapes[shape].symmetry == "plane"
    bodies = [name for name in tables if name in nouns.bodies] or ([Layer.word] if plain else [])
    if len(bodies) > 1:
        raise InputError(
            f"{where}: only one body is allowed, got [{'] and ['.join(bodies)}]", field=bodies[1]
        )
    names = ("material", "interface", test, shape, *bodies)
    more = f", or another indenter: {', '.join(nouns.shapes)}{OWN}"
    refuse_unknown(where, tables, names, "table", more)
    if reading.pure:
        tables = {"interface": {"law": "lennard-jones"}, shape: {}, **tables}
    if len(missing := [f"[{name}]" for name in names if name not in tables]) > 1:
        raise InputError(
            f"{where}: the tables {', '.join(missing[:-1])} and {missing[-1]} are missing; see "
            "docs/input.md"
        )
    units = PURE_NUMBERS if reading.pure else (plane if plain else revolution).SI
    reading = replace(reading, units=units)
    material = material_of(tables.get("material"), reading)
    law = law_from_table(tables.get("interface"), reading)
    body = _body(tables.get(bodies[0]), bodies[0], reading, material) if bodies else HalfSpace()
    parts: dict[str, Any] = {"material": material, "traction": law, "body": body}
    with placed(f"{where}:"):
        if reading.pure:
            geometry = _shape(tables[shape], shape, reading)
            return Groups(geometry=geometry, **parts, **_test_of_groups(tables["groups"], reading))
        parts["protocol"] = _protocol(tables.get("protocol"), reading, law.equilibrium_gap)
        if shape == "surface":
            return RoughCase(surface=_surface(tables["surface"], reading), **parts)
        return Problem(geometry=_shape(tables.get(shape), shape, reading), **parts)


def to_dict(problem: Problem | Groups | RoughCase) -> dict[str, Any]:
    """Convert a problem to the tables of its file, with numbers in SI.

    Values equal to the default are omitted, so that new options do not change the ids of old
    problems. The dictionary contains only dictionaries, lists, texts and numbers: ``json.dumps``
    writes it, and :func:`from_dict` restores an equal object.

    Parameters
    ----------
    problem : Problem, Groups or RoughCase
        Object to convert.

    Returns
    -------
    dict
        Ready for JSON.

    Raises
    ------
    InputError
        If the object is not a problem.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> to_dict(Groups(tabor=2, material=solid, start=AtDepth(20), rate=1))["groups"]
    {'tabor': 2.0, 'preload': 20.0, 'rate': 1.0}
    """
    if not isinstance(problem, Problem | Groups | RoughCase):
        raise InputError(f"expected a Problem or Groups, got {type(problem).__name__}")
    found: dict[str, Any] = {
        "material": {"model": word_of(problem.material), **stated(problem.material)},
        "interface": _table_of_law(problem.traction, pure=isinstance(problem, Groups)),
    }
    if isinstance(problem, RoughCase):
        found["surface"] = stated(problem.surface)
    else:
        found[problem.geometry.word] = stated(problem.geometry)
    if isinstance(problem.body, Layer):
        base = problem.body.base
        found[Layer.word] = {"thickness": problem.body.thickness, "base": base.word, **stated(base)}
    elif problem.body != HalfSpace():
        found[problem.body.word] = stated(problem.body)
    if isinstance(problem, Groups):
        name = "tabor" if problem.cohesion is None else "cohesion"
        test = _table_of_test(problem, PURE_NUMBERS, rate=problem.rate)
        return found | {"groups": {name: getattr(problem, name), **test}}
    speed = problem.protocol.speed
    return found | {"protocol": _table_of_test(problem.protocol, problem.units, speed=speed)}


def run_id(case: Any) -> str:
    """Return a short id that depends only on the content of a problem.

    Equal problems have equal ids, on all machines.

    Parameters
    ----------
    case : Problem or Groups
        The problem.

    Returns
    -------
    str
        Hexadecimal digits.

    Raises
    ------
    InputError
        If the object is not a problem.

    Examples
    --------
    >>> from viscotack import AtDepth, Groups, StandardSolid
    >>> solid = StandardSolid(rubbery_modulus=1, glassy_modulus=10, tau0=1, poisson_ratio=0)
    >>> one, same = (Groups(tabor=2, material=solid, start=AtDepth(d), rate=1) for d in (20, 20.0))
    >>> run_id(one) == run_id(same)
    True
    """
    text = json.dumps(to_dict(case), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


@dataclass(frozen=True)
class PassportTable:
    """A passport by its file or published name, at a temperature, perhaps scaled to a modulus."""

    passport: str
    temperature: Annotated[float, Quantity("K", "T", "temperature", example="20 degC")] | None = (
        None
    )
    rubbery_modulus: Annotated[float, cards(Elastic)["rubbery_modulus"].card] | None = None


def material_of(given: Any, reading: Reading) -> Material:
    """Return the material that a table [material] states."""
    where, table = f"{reading.where}, [material]", reading.given(given, "material")
    if "passport" in table:
        passport, kelvin = _passport(given, reading)
        with placed(where):
            if not reading.pure:
                return passport.material if kelvin is None else passport.at_temperature(kelvin)
            if kelvin is not None:
                raise InputError(
                    "temperature has no effect on a dimensionless problem, because its rate is "
                    "relative to the time of the material"
                )
            return passport.material.reduced()
    kind = reading.choice(table, "material", "model", reading.nouns.materials, OWN)
    del table["model"]
    if reading.pure:
        implied = {"rubbery_modulus": 1.0, "poisson_ratio": 0.0, "tau0": 1.0}
        table = {k: v for k, v in implied.items() if k in cards(kind)} | table
    if {"modulus_ratio", "rubbery_modulus"} <= table.keys():
        if "glassy_modulus" in table:
            raise InputError(
                f"{where} modulus_ratio and glassy_modulus determine each other; give only one",
                field="material.modulus_ratio",
            )
        card, name = cards(Elastic)["rubbery_modulus"].card, "modulus_ratio"
        ratio = reading.key("material", name, card_of(ModulusRatio), table.pop(name))
        glassy = reading.key("material", "rubbery_modulus", card, table["rubbery_modulus"]) / ratio
        table["glassy_modulus"] = glassy if reading.pure else f"{glassy!r} Pa"
    if kind is not Prony or "file" not in table:
        return read_as(kind, table, reading, "material")
    file = reading.file("material", "file", table.pop("file"))
    # without dimensions the unit of the file is that of the rate
    units = {"modulus_ratio": "1", "relaxation_time": "" if reading.pure else "s"}
    ratios, times = read_quantities(file, units).values()
    plain = read_as(Elastic, table, reading, "material")
    branches = tuple(
        (ratio * plain.rubbery_modulus, t) for ratio, t in zip(ratios, times, strict=True)
    )
    with placed(f"{file}:"):
        if min(ratios) <= 0:
            raise InputError(f"modulus_ratio must be positive, got {min(ratios):g}")
        return Prony(**vars(plain), branches=branches)


def _passport(given: Any, reading: Reading) -> tuple[Passport, float | None]:
    """Return the passport that a table names, and the requested temperature [K]."""
    table = read_as(PassportTable, given, replace(reading, pure=False), "material")
    if table.passport in MATERIALS:
        passport = published(table.passport)
    else:
        file = reading.file("material", "passport", table.passport)
        passport = read_passport(file, also=reading.nouns.materials.values())
    modulus = table.rubbery_modulus
    if modulus is not None:  # of a like material
        factor = modulus / passport.material.rubbery_modulus
        passport = replace(
            passport,
            name=f"{passport.name}, scaled to {readable(modulus, 'Pa')}",
            material=scaled(passport.material, modulus=factor, time=1.0),
            evidence=None,
            allowed=(),
        )
    return passport, table.temperature


def passport_of(tables: Tables, reading: Reading) -> tuple[Passport | None, float]:
    """Return the passport of a problem's material at its temperature, and the doubt of its shift.

    The parameters are those of :func:`problem_of`, which has checked the tables.

    Returns
    -------
    passport : Passport or None
        Moved to the temperature of the case; None if numbers define the material.
    deviation : float
        Standard deviation of log10 a_T; 0 without a passport, or at its own temperature.
    """
    if "passport" not in tables["material"]:
        return None, 0.0
    passport, kelvin = _passport(tables["material"], reading)
    if kelvin is None:
        return passport, 0.0
    return passport.moved_to(kelvin), passport.shift_deviation(kelvin)


STRENGTH = Quantity("Pa", "sigma0", "largest tension of the law", above=0, example="100 kPa")
_SCALES = ("work_of_adhesion", "equilibrium_gap")


def law_from_table(given: Any, reading: Reading) -> Traction:
    """Return the law of the table [interface].

    Its range is equilibrium_gap or strength. A law that grows or ages has the word of its law at
    rest as ``base``, and the constants of both.
    """
    table = reading.given(given, "interface")
    kind = reading.choice(table, "interface", "law", reading.nouns.laws, OWN)
    del table["law"]
    if reading.pure and "file" not in table:
        table = dict.fromkeys(_SCALES, 1.0) | table
    if not has_rest(kind):
        law = _of_gap(kind, table, reading)
        return law.reduced() if reading.pure else law
    rest = {word: law for word, law in reading.nouns.laws.items() if not has_rest(law)}
    table = {"base": LennardJones.word} | table
    base = reading.choice(table, "interface", "base", rest, OWN)
    growth = {field.name for field in _constants(kind)}
    of_base = {*cards(base), "strength", "file", "points"} - growth
    at_rest: Any = _of_gap(base, {k: v for k, v in table.items() if k in of_base}, reading)
    scales = dict.fromkeys(_SCALES, 1.0) if reading.pure else with_units(at_rest)
    own = {k: v for k, v in table.items() if k not in of_base}
    own |= {k: scales[k] for k in _SCALES} | {"base": at_rest.reduced()}
    return read_as(kind, own, reading, "interface")


def _whole(table: Tables, name: str, reading: Reading) -> Path:
    """Return the path of the file that states all of a table; InputError for a key beside it."""
    for key in table.keys() - {"file"}:
        words = f"{reading.where}, [{name}] file states the whole {name}; leave out {key}"
        raise InputError(words, field=f"{name}.{key}")
    return reading.file(name, "file", table["file"])


def _of_gap(kind: Any, table: Tables, reading: Reading) -> Any:
    """Return a law of the gap alone."""
    if kind is Tabulated and "file" in table:
        file = _whole(table, "interface", reading)
        columns = read_quantities(file, {"gap": "m", "traction": "Pa"})
        with placed(f"{file}:"):
            return Tabulated.of_points(columns["gap"], columns["traction"])
    if "strength" not in table:
        return read_as(kind, table, reading, "interface")
    if "equilibrium_gap" in table:
        raise InputError(
            f"{reading.where}, [interface] strength and equilibrium_gap determine each other; "
            "give only one",
            field="interface.strength",
        )
    table = dict(table)
    strength = reading.key("interface", "strength", STRENGTH, table.pop("strength"))
    law = read_as(kind, table | {"equilibrium_gap": "1 m"}, reading, "interface")
    gap = law.reduced().strength * law.work_of_adhesion / strength
    return replace(law, equilibrium_gap=gap)


def _table_of_law(law: Any, *, pure: bool) -> dict[str, Any]:
    """Return the table [interface] of a law, with numbers in SI."""
    found, table = stated(law), {"law": law.word}
    if (base := found.pop("base", None)) is not None:
        own = {k: v for k, v in stated(base).items() if k not in _SCALES}
        table |= {"base": base.word, **own}
    return {k: v for k, v in (table | found).items() if not (pure and k in _SCALES)}


def law_from_words(words: str, beside: Callable[[str], Path] = Path) -> Traction:
    """Return the reduced law stated by an option: its name and, after a colon, its constants.

    `beside` returns the path of a file that it names.

    Examples
    --------
    >>> law_from_words("exponential:0.25")
    Exponential(work_of_adhesion=1.0, equilibrium_gap=1.0, decay=0.25)
    >>> law_from_words("dugdale").strength
    1.0

    For a law that grows with the opening speed or ages in contact, the law at rest follows after a
    second colon:

    >>> law_from_words("gent-schultz:10,0.4:exponential:0.25").base.decay
    0.25
    """
    return law_from_table(table_of_words(words), Reading("the law", beside=beside, pure=True))


def table_of_words(words: str, laws: Mapping[str, Any] = LAWS) -> dict[str, Any]:
    """Return the table [interface] that the words of an option state.

    Examples
    --------
    >>> table_of_words("gent-schultz:10,0.4:exponential:0.25")["base"]
    'exponential'
    """
    name, _, rest = words.partition(":")
    if name not in laws:
        said = f"the law must be one of {', '.join(laws)}, got {words!r}{OWN}"
        raise UnknownNoun(said, field="law")
    kind: Any = laws[name]
    if kind is Tabulated:
        if not rest:
            raise InputError("the law table needs a file: table:FILE.csv")
        return {"law": name, "file": rest}
    base = ""
    if has_rest(kind):
        rest, _, base = rest.partition(":")
    constants = [constant.name for constant in _constants(kind)]
    needed = [constant.name for constant in _constants(kind) if constant.needed]
    given = rest.split(",") if rest else []
    if not len(needed) <= len(given) <= len(constants):
        wanted = ",".join(constant.upper() for constant in constants)
        more = "[:LAW AT REST]" if has_rest(kind) else ""
        raise InputError(f"write {name}{':' if wanted else ''}{wanted}{more}, got {words!r}")
    of_base = table_of_words(base, laws) if base else {}
    of_base = {"base" if key == "law" else key: value for key, value in of_base.items()}
    return {**of_base, "law": name, **dict(zip(constants, given, strict=False))}


def _constants(kind: Any) -> list[Field]:
    """Return the cards of a law except work and gap."""
    return [field for name, field in cards(kind).items() if name not in _SCALES]


@dataclass(frozen=True)
class ProfilePoint:
    """A power-law profile by its exponent and one point of its flank."""

    exponent: Annotated[float, cards(PowerLawProfile)["exponent"].card]
    height: Annotated[
        float, Quantity("m", "z", "height of the profile there", above=0, example="10 um")
    ]
    at_radius: Annotated[
        float, Quantity("m", "r", "radius at which it has its height", above=0, example="0.2 mm")
    ]


def _shape(given: Any, name: str, reading: Reading) -> Any:
    """Return the indenter stated by a table.

    A [profile] is a measured one by its file, a cone by its slope, or the exponent q and one point
    of z = A r^q, its height at a radius, or its coefficient A in m^(1-q).
    """
    kind = reading.nouns.shapes[name]
    table = given if isinstance(given, Mapping) else {}
    if kind in (PowerLawProfile, MeasuredProfile) and "file" in table:
        with placed(f"{reading.where}, [{name}]"):
            return _measured(_whole(table, name, reading), pure=reading.pure)
    if reading.pure and kind is Sphere:
        return read_as(kind, {"radius": 1.0} | dict(table), reading, name)
    if kind is not PowerLawProfile:
        return read_as(kind, given, reading, name)
    if "slope" in table:
        return read_as(Cone, given, reading, name)
    if reading.pure and "coefficient" not in table and "exponent" in table:
        card = cards(PowerLawProfile)["exponent"].card
        table = {**table, "coefficient": 1 / reading.key(name, "exponent", card, table["exponent"])}
    if reading.pure or "coefficient" in table:
        return read_as(kind, table, replace(reading, bare=True), name)
    point = read_as(ProfilePoint, given, reading, name)
    return PowerLawProfile(point.height / point.at_radius**point.exponent, point.exponent)


def _measured(file: Path, *, pure: bool) -> MeasuredProfile:
    """Return the profile of a CSV file with the columns radius and height.

    Without dimensions radii are in beta and heights in any unit, scaled to the equivalent radius 1.
    """
    columns = read_quantities(file, dict.fromkeys(("radius", "height"), "1" if pure else "m"))
    shape = MeasuredProfile(tuple(zip(columns["radius"], columns["height"], strict=True)))
    return shape.reduced(1.0, 1 / shape.equivalent_radius(1.0)) if pure else shape


@dataclass(frozen=True)
class LayerTable:
    """A layer and the word of its base; bonded, it has the Poisson ratio of the material."""

    thickness: Annotated[float, cards(Layer)["thickness"].card]
    base: str | None = None
    poisson_ratio: Annotated[float, cards(Bonded)["poisson_ratio"].card] | None = None


def _body(entries: Any, name: str, reading: Reading, material: Material) -> Any:
    """Return the body stated by a table."""
    kind = reading.nouns.bodies[name]
    if kind is not Layer:
        return read_as(kind, entries, reading, name)
    table = read_as(LayerTable, entries, reading, name)
    if reading.pure and table.thickness > _THICKEST:
        raise InputError(
            f"{reading.where}, [{name}] thickness must be at most {_THICKEST:g}, got "
            f"{table.thickness:g}; leave out the layer for a half-space",
            field=f"{name}.thickness",
        )
    bases = {base.word: base for base in (Frictionless, Bonded)}
    word = table.base or (Frictionless.word if reading.pure else None)
    base = reading.choice({} if word is None else {"base": word}, name, "base", bases)
    if base is Frictionless:
        return Layer(table.thickness)
    nu = material.poisson_ratio if table.poisson_ratio is None else table.poisson_ratio
    return Layer(table.thickness, Bonded(poisson_ratio=nu))


def _surface(given: Any, reading: Reading) -> StatedSurface:
    """Return the surface stated by the table [surface]; a file is known by its hash."""
    table = dict(given) if isinstance(given, Mapping) else {}
    if isinstance(table.get("kind"), str):
        table["kind"] = [table["kind"]]
    if "file" in table:
        file = reading.file("surface", "file", table["file"]).resolve()
        table = {"sha256": hash_of(file), **table, "file": str(file)}
    return read_as(StatedSurface, table, reading, "surface")


# Keys of starts, by the unit of a force: that of a punch is a mean stress, and [groups] have none.
STARTS: Mapping[str, Mapping[str, Any]] = {
    "N": {"preload_depth": AtDepth, "preload_force": AtForce, "preload_radius": AtRadius},
    "Pa": {"preload_depth": AtDepth, "preload_stress": AtForce},
    "1": {
        "preload": AtDepth,
        "preload_force": AtForce,
        "preload_radius": AtRadius,
        "apart": Apart,
    },
}
_Depth = Annotated[float, cards(AtDepth)["depth"].card]
_Force = Annotated[float, cards(AtForce)["force"].card]
_Radius = Annotated[float, cards(AtRadius)["contact_radius"].card]
_Apart = Annotated[float, cards(Apart)["gap"].card]
_Stress = Annotated[
    float,
    Quantity(
        "Pa", "p", "mean stress of the relaxed start, positive in compression", measure="force"
    ),
]


@dataclass(frozen=True)
class ProtocolTable:
    """The table [protocol]: one start, moves and their repetitions, a retraction, the machine."""

    preload_depth: _Depth | None = None
    preload_force: _Force | None = None
    preload_stress: _Stress | None = None
    preload_radius: _Radius | None = None
    start: str | None = None
    history: str | None = None
    moves: tuple[str | dict[str, str | float], ...] = ()
    cycles: Annotated[int, Exact] = 1
    speed: Speed | None = None
    stiffness: Stiffness | None = None

    def __post_init__(self) -> None:
        if self.cycles < 1:
            raise InputError(f"cycles must be a positive integer, got {self.cycles!r}")


@dataclass(frozen=True)
class GroupsTable:
    """The table [groups]: the dimensionless numbers of a problem and its test."""

    tabor: Tabor | None = None
    cohesion: Cohesion | None = None
    preload: _Depth | None = None
    preload_force: _Force | None = None
    preload_radius: _Radius | None = None
    apart: _Apart | None = None
    moves: tuple[str, ...] = ()
    rate: Rate | None = None
    stiffness: Spring | None = None


def _protocol(given: Any, reading: Reading, equilibrium_gap: float) -> Retraction:
    """Return the test stated by the table [protocol].

    The equilibrium gap [m] defines the zero of the displacement of a history.
    """
    table = read_as(ProtocolTable, given, reading, "protocol")
    where, moves = f"{reading.where}, [protocol]", tuple[Move, ...]()
    if table.history is not None:
        for key in (*_starts(table), *(["moves"] if table.moves else [])):
            raise InputError(
                f"{where} history states the start and the moves; omit {key}",
                field=f"protocol.{key}",
            )
        file = reading.file("protocol", "history", table.history)
        start, moves = history_from_file(file, equilibrium_gap)
    with placed(where, "protocol"):
        if table.history is None:
            start = _start(table, reading.units)
            check_number_of_moves(len(table.moves))
            moves = tuple(move_from_words(move, reading.units) for move in table.moves)
        check_number_of_moves(table.cycles * len(moves))
        if table.speed is None and not moves:
            raise InputError(
                'speed is missing; write for example speed = "100 um/s"', field="protocol.speed"
            )
        return Retraction(
            start=start, speed=table.speed, moves=moves * table.cycles, stiffness=table.stiffness
        )


def _test_of_groups(given: Any, reading: Reading) -> dict[str, Any]:
    """Return the numbers and the test of the table [groups], as arguments of Groups."""
    table = read_as(GroupsTable, given, reading, "groups")
    with placed(f"{reading.where}, [groups]", "groups"):
        start = _start(table, reading.units)
        moves = tuple(move_from_words(move, reading.units) for move in table.moves)
    numbers = ("tabor", "cohesion", "rate", "stiffness")
    return {"start": start, "moves": moves, **{name: getattr(table, name) for name in numbers}}


def _starts(table: ProtocolTable | GroupsTable) -> list[str]:
    """Return the keys of the starts that a table states."""
    keys = {"start", *(key for starts in STARTS.values() for key in starts)}
    return [key for key, value in vars(table).items() if key in keys and value is not None]


def _start(table: ProtocolTable | GroupsTable, units: Mapping[str, str]) -> Start | Apart:
    """Return the start that a table states; InputError unless it is a single one."""
    starts, given, example = STARTS[units["force"]], _starts(table), ""
    possible = tuple(starts)
    if isinstance(table, ProtocolTable):
        possible += ("start",)
        example = '; write for example preload_depth = "2 um", or start = "apart 20 um"'
    if len(given) != 1 or given[0] not in possible:
        raise InputError(
            f"needs exactly one of {', '.join(possible)}, got "
            f"{' and '.join(given) or 'none'}{example}"
        )
    value = getattr(table, given[0])
    return start_from_words(value, units) if given == ["start"] else starts[given[0]](value)


def _table_of_test(test: Any, units: Mapping[str, str], **numbers: float | None) -> dict[str, Any]:
    """Return the table [protocol] or [groups] of a test, with its speed or rate."""
    starts = {kind: key for key, kind in STARTS[units["force"]].items()}
    key, value = starts.get(type(test.start), "start"), test.start.value
    found: dict[str, Any] = {key: f"apart {value!r} {units['depth']}" if key == "start" else value}
    if test.moves:
        found["moves"] = [words_of_move(move, units) for move in test.moves]
    numbers |= {"stiffness": test.stiffness}
    return found | {name: number for name, number in numbers.items() if number is not None}
