"""A problem as tables: the TOML file of a case, JSON, and the body of a request.

docs/input.md describes the format; the keys of a table follow from the cards of its class. Tables
in SI are [material], [interface], one for the shape, perhaps one for the body, and [protocol]; a
dimensionless problem has [groups] in place of [protocol], and numbers without units. A rough
surface has [surface] in place of the shape.
"""

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

from viscotack.cards import Quantity, card_of, cards
from viscotack.errors import InputError
from viscotack.files.quantities import read_quantities
from viscotack.files.text import read_rows
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
from viscotack.model.materials.passport import Passport
from viscotack.model.materials.passport_file import read_passport
from viscotack.model.materials.words import word_of
from viscotack.model.problem import plane, revolution
from viscotack.model.problem.law_table import law_from_table, table_of_law
from viscotack.model.problem.nouns import known
from viscotack.model.problem.problem import Case, Groups, Problem
from viscotack.model.problem.protocol_table import (
    protocol_from_table,
    table_of_groups,
    table_of_protocol,
    test_of_groups,
)
from viscotack.model.problem.rough_case import RoughCase, StatedSurface, hash_of
from viscotack.model.tables import OWN, Reading, read_as, refuse_unknown, stated
from viscotack.units import parse, positive, readable


def read_prony(path: str | os.PathLike[str]) -> tuple[tuple[tuple[float, float], ...], str]:
    """Read the branches of a Prony series from a CSV file, and the unit of their times.

    Parameters
    ----------
    path : path
        First row ``modulus_ratio,relaxation_time_s``, then one row per branch: its modulus over the
        rubbery modulus, and its relaxation time. The unit ``s`` may be any unit of time (``ms``,
        ``h``); ``relaxation_time`` without a unit means dimensionless times. Lines that begin with
        ``#`` are ignored.

    Returns
    -------
    tuple of (float, float), str
        Branches as (modulus ratio, relaxation time in the file's unit), and that unit ("1" for
        pure numbers).

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    ValueError
        If the header or a row is not as described; the message names the line.
    """
    path = Path(path)
    header, rows = read_rows(path)
    if (
        len(header) != 2
        or header[0] != "modulus_ratio"
        or not header[1].startswith("relaxation_time")
    ):
        raise InputError(
            f"{path}: the first row must be 'modulus_ratio,relaxation_time_s' (or another unit of "
            f"time), got {','.join(header)!r}"
        )
    unit = header[1].removeprefix("relaxation_time").removeprefix("_") or "1"
    if unit != "1":
        try:
            parse(f"1 {unit}", "s")
        except ValueError as error:
            raise InputError(f"{path}, the name of the second column: {error}") from None
    branches = []
    for line, row in rows:
        try:
            if len(row) != 2:
                raise InputError(f"a row must be a modulus ratio and a time, got {','.join(row)!r}")
            ratio, time = row
            branches.append((positive("modulus_ratio", ratio, "1"), positive("time", time, unit)))
        except ValueError as error:
            raise InputError(f"{path}, line {line}: {error}") from None
    if not branches:
        raise InputError(f"{path}: the file has no branch below the header")
    return tuple(branches), unit


Tables = Mapping[str, Any]
# Largest thickness of a layer over the contact's length.
_THICKEST = 1e9


def read_case(
    path: str | os.PathLike[str],
    *,
    also: Iterable[Any] = (),
    temperature: float | None = None,
) -> Case:
    """Read a problem from a TOML file, in SI or with the table [groups] dimensionless.

    Parameters
    ----------
    path : path
        File with the tables [material], [interface], [protocol] and one for the indenter: [sphere],
        [cone], [profile], [wavy-sphere], or [punch] and [layer]. Quantities are texts with units,
        such as ``radius = "5.19 mm"``; files named in it are relative to its folder.
    also : iterable of classes
        User-defined laws, materials, shapes and bodies that the file may name by their words.
    temperature : float, optional
        Temperature of the material [K], overriding that in the file; only for a passport, within
        its measured range.

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
    problem = problem_of(read_toml(path), reading, temperature)
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
    temperature: float | None = None,
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
    temperature : float, optional
        As for :func:`read_case`.

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
    problem = problem_of(tables, Reading(where, known(also), beside), temperature)
    if not isinstance(problem, Problem):
        raise InputError(f"{where} must state a shape and a test in SI, [protocol]")
    return problem


def problem_of(
    tables: Tables, reading: Reading, temperature: float | None = None
) -> Problem | Groups | RoughCase:
    """Return the problem of tables: in SI, dimensionless with [groups], rough with [surface].

    Parameters
    ----------
    tables : mapping
        Tables as in :func:`read_case`.
    reading : Reading
        How their values are read.
    temperature : float, optional
        As for :func:`read_case`.
    """
    where, nouns = reading.where, reading.nouns
    if not isinstance(tables, Mapping):
        raise InputError(f"{where} must be tables with keys, got {tables!r:.60}")
    test = "groups" if "groups" in tables else "protocol"
    reading = replace(reading, pure=test == "groups")
    if reading.pure and "surface" in tables:
        raise InputError(f"{where}: a map of heights, [surface], is stated in SI with a [protocol]")
    shape = "surface" if "surface" in tables else _indenter(tables, nouns.shapes, where)
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
    reading = replace(reading, units=(plane if plain else revolution).SI)
    material = material_of(tables.get("material"), reading, temperature)
    law = law_from_table(tables.get("interface"), reading)
    body = _body(tables.get(bodies[0]), bodies[0], reading, material) if bodies else HalfSpace()
    parts: dict[str, Any] = {"material": material, "traction": law, "body": body}
    try:
        if reading.pure:
            geometry = _shape(tables[shape], shape, reading)
            return Groups(geometry=geometry, **parts, **test_of_groups(tables["groups"], reading))
        parts["protocol"] = protocol_from_table(
            tables.get("protocol"), reading, law.equilibrium_gap
        )
        if shape == "surface":
            return RoughCase(surface=_surface(tables["surface"], reading), **parts)
        return Problem(geometry=_shape(tables.get(shape), shape, reading), **parts)
    except ValueError as error:
        if isinstance(error, InputError) and str(error).startswith(where):
            raise
        raise InputError(f"{where}: {error}", field=getattr(error, "field", "")) from None


def tables_of(problem: Problem | Groups | RoughCase) -> dict[str, Any]:
    """Return the tables that state a problem, with numbers in SI; :func:`problem_of` reads them."""
    pure = isinstance(problem, Groups)
    material = stated(problem.material)
    found: dict[str, Any] = {
        "material": {"model": word_of(problem.material), **material},
        "interface": table_of_law(problem.traction, pure=pure),
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
        return found | {"groups": table_of_groups(problem)}
    return found | {"protocol": table_of_protocol(problem.protocol, problem.units)}


def _indenter(tables: Tables, known: Mapping[str, Any], where: str) -> str:
    """Return the name of the table that states the indenter."""
    given = [name for name in tables if name in known]
    if len(given) > 1:
        raise InputError(
            f"{where}: only one indenter is allowed, got [{'] and ['.join(given)}]", field=given[1]
        )
    return given[0] if given else FlatPunch.word if Layer.word in tables else Sphere.word


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
        for key in table.keys() - {"file"}:
            raise InputError(
                f"{reading.where}, [{name}] file states the whole profile; leave out {key}",
                field=f"{name}.{key}",
            )
        try:
            file = reading.file(name, "file", table["file"])
            return measured_profile(file, pure=reading.pure)
        except ValueError as error:
            already = str(error).startswith(reading.where)
            raise InputError(
                str(error) if already else f"{reading.where}, [{name}] {error}"
            ) from None
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


def measured_profile(file: Path, *, pure: bool = False) -> MeasuredProfile:
    """Return the profile of a CSV file with the columns radius and height.

    Without dimensions radii are in beta and heights in any unit, scaled to the equivalent radius 1.
    """
    unit = "1" if pure else "m"
    columns = read_quantities(file, {"radius": unit, "height": unit})
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


def passport_of(
    tables: Tables, reading: Reading, temperature: float | None = None
) -> tuple[Passport | None, float]:
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
    return moved(*_passport(tables["material"], reading, temperature))


def moved(passport: Passport, temperature: float | None) -> tuple[Passport, float]:
    """Return a passport at a temperature [K], and the standard deviation of its log10 a_T."""
    if temperature is None:
        return passport, 0.0
    return passport.moved_to(temperature), passport.shift_deviation(temperature)


@dataclass(frozen=True)
class PassportTable:
    """A passport by its file or published name, at a temperature, perhaps scaled to a modulus."""

    passport: str
    temperature: Annotated[float, Quantity("K", "T", "temperature", example="20 degC")] | None = (
        None
    )
    rubbery_modulus: Annotated[float, cards(Elastic)["rubbery_modulus"].card] | None = None


def material_of(given: Any, reading: Reading, temperature: float | None = None) -> Material:
    """Return the material that a table [material] states."""
    where, table = f"{reading.where}, [material]", reading.given(given, "material")
    if "passport" in table:
        passport, kelvin = _passport(given, reading, temperature)
        if reading.pure:
            if kelvin is not None:
                raise InputError(
                    f"{where} temperature has no effect on a dimensionless problem, because its "
                    "rate is relative to the time of the material"
                )
            return passport.material.reduced()
        try:
            return passport.material if kelvin is None else passport.at_temperature(kelvin)
        except ValueError as error:
            raise InputError(f"{where} {error}") from None
    if temperature is not None:
        raise InputError(
            f"{reading.where}: a temperature of {temperature:g} K needs a material from a "
            'passport, which contains the shift of its times; [material] passport = "pdms.toml"'
        )
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
    if kind is Prony and "file" in table:
        return _prony(table, reading)
    return read_as(kind, table, reading, "material")


def _passport(
    given: Any, reading: Reading, temperature: float | None
) -> tuple[Passport, float | None]:
    """Return the passport beside the file, and the requested temperature [K]."""
    table = read_as(PassportTable, given, replace(reading, pure=False), "material")
    if table.passport in MATERIALS:
        passport = published(table.passport)
    else:
        file = reading.file("material", "passport", table.passport)
        passport = read_passport(file, also=reading.nouns.materials.values())
    if table.rubbery_modulus is not None:
        passport = _scaled(passport, table.rubbery_modulus)
    return passport, table.temperature if temperature is None else temperature


def _scaled(passport: Passport, modulus: float) -> Passport:
    """Return a passport whose moduli are scaled to a rubbery modulus [Pa], for a like material."""
    factor = modulus / passport.material.rubbery_modulus
    solid = scaled(passport.material, modulus=factor, time=1.0)
    words = f"{passport.name}, scaled to {readable(modulus, 'Pa')}"
    return replace(passport, name=words, material=solid, evidence=None, allowed=())


def _prony(table: dict[str, Any], reading: Reading) -> Prony:
    """Return a Prony series with branches from a file, as moduli over the rubbery modulus."""
    ratios, unit = read_prony(reading.file("material", "file", table.pop("file")))
    if unit == "1" and not reading.pure:
        raise InputError(
            f"{reading.where}, [material] file: the times have no unit; name the column "
            "relaxation_time_s"
        )
    plain = read_as(Elastic, table, reading, "material")
    # without dimensions the unit of the file is that of the rate
    second = 1.0 if reading.pure else parse(f"1 {unit}", "s")
    E0 = plain.rubbery_modulus
    branches = tuple((ratio * E0, time * second) for ratio, time in ratios)
    return Prony(rubbery_modulus=E0, poisson_ratio=plain.poisson_ratio, branches=branches)
