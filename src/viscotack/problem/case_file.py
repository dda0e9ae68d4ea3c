"""Read a problem from a case file: TOML in SI, quantities as text with units.

docs/input.md describes the format; the keys of a table follow from the cards of its class.
"""

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from viscotack.cards import cards
from viscotack.errors import InputError
from viscotack.files.quantities import read_quantities
from viscotack.files.toml import read_toml
from viscotack.geometry import (
    Bonded,
    Cone,
    Frictionless,
    HalfSpace,
    Layer,
    MeasuredProfile,
    PowerLawProfile,
)
from viscotack.materials import Elastic, Material, Prony
from viscotack.materials.checks import rests
from viscotack.materials.library import MATERIALS, published
from viscotack.materials.passport import Passport
from viscotack.materials.passport_file import read_passport
from viscotack.materials.scaling import scaled
from viscotack.materials.words import FITS_ONLY
from viscotack.problem import plane, revolution
from viscotack.problem.case_table import OWN, Table, refuse_maps, refuse_unknown
from viscotack.problem.law_table import law_from_table
from viscotack.problem.nouns import Nouns, known
from viscotack.problem.problem import Problem
from viscotack.problem.prony_file import read_prony
from viscotack.problem.protocol_table import protocol_from_table
from viscotack.units import parse, readable

_COMMON = ("material", "interface", "protocol")


def read_case(
    path: str | os.PathLike[str],
    *,
    also: Iterable[Any] = (),
    temperature: float | None = None,
    beside: Callable[[str], Path] | None = None,
) -> Problem:
    """Read a problem in SI from a TOML file.

    Parameters
    ----------
    path : path
        File with the tables [material], [interface], [protocol] and one for the indenter: [sphere],
        [cone], [profile], [wavy-sphere], or [punch] and [layer]. Quantities are texts with units,
        such as ``radius = "5.19 mm"``.
    also : iterable of classes
        User-defined laws, materials, shapes and bodies that the file may name by their words.
    temperature : float, optional
        Temperature of the material [K], overriding that in the file; only for a passport, within
        its measured range.
    beside : callable, optional
        Returns the path of a file named in a table; by default relative to the folder of the case.

    Returns
    -------
    Problem
        The problem in SI.

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
    beside = beside or path.parent.joinpath
    return _stated(path, read_toml(path), known(also), temperature, beside)


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
    return _stated(where, tables, known(also), temperature, beside)


def _stated(
    path: Path | str,
    tables: Mapping[str, Any],
    nouns: Nouns,
    temperature: float | None,
    beside: Callable[[str], Path] | None = None,
) -> Problem:
    """Return the problem of tables from a file or a request."""
    shape = _shape_table(path, tables, nouns)
    plain = nouns.shapes[shape].symmetry == "plane"
    bodies = [name for name in tables if name in nouns.bodies] or ([Layer.word] if plain else [])
    if len(bodies) > 1:
        raise InputError(f"{path}: only one body is allowed, got [{'] and ['.join(bodies)}]")
    names = (*_COMMON, shape, *bodies)
    more = f", or another indenter: {', '.join(nouns.shapes)}{OWN}"
    refuse_maps(f"{path}", tables)
    refuse_unknown(f"{path}", tables, names, "table", more)
    if len(missing := [f"[{name}]" for name in names if name not in tables]) > 1:
        raise InputError(
            f"{path}: the tables {', '.join(missing[:-1])} and {missing[-1]} are missing; see "
            "docs/input.md"
        )
    units = (plane if plain else revolution).SI
    table = Table(path, shape, tables, beside)
    geometry = _shape(table, nouns.shapes[shape])
    parts = _parts(path, tables, nouns, bodies, units, beside, temperature)
    table.finish()
    try:
        return Problem(geometry=geometry, **parts)
    except ValueError as error:
        raise InputError(f"{path}: {error}") from None


def parts_of_tables(
    path: Path | str,
    tables: Mapping[str, Any],
    *,
    also: Iterable[Any] = (),
    beside: Callable[[str], Path] | None = None,
) -> dict[str, Any]:
    """Return material, traction law, protocol and body, a half-space or a layer, of tables.

    The parameters are those of :func:`case_of_tables`; forces of the protocol are in N.
    """
    bodies = [Layer.word] if Layer.word in tables else []
    return _parts(path, tables, known(also), bodies, revolution.SI, beside, None)


def _parts(
    path: Path | str,
    tables: Mapping[str, Any],
    nouns: Nouns,
    bodies: list[str],
    units: Mapping[str, str],
    beside: Callable[[str], Path] | None,
    temperature: float | None,
) -> dict[str, Any]:
    """Return the parts of a problem but its shape, by the names of the attributes."""
    found = {name: Table(path, name, tables, beside) for name in (*_COMMON, *bodies)}
    material = _material(found["material"], nouns, temperature)
    law = law_from_table(found["interface"], nouns.laws)
    body = HalfSpace()
    if bodies:
        body = _body(found[bodies[0]], nouns.bodies[bodies[0]], material)
    protocol = protocol_from_table(found["protocol"], units, law.equilibrium_gap)
    for table in found.values():
        table.finish()
    return {"material": material, "traction": law, "body": body, "protocol": protocol}


def _shape_table(path: Path | str, tables: Mapping[str, Any], nouns: Nouns) -> str:
    """Return the name of the table that states the indenter."""
    given = [name for name in tables if name in nouns.shapes]
    if len(given) > 1:
        raise InputError(f"{path}: only one indenter is allowed, got [{'] and ['.join(given)}]")
    if given:
        return given[0]
    return "punch" if "layer" in tables else "sphere"


def _shape(table: Table, kind: Any) -> Any:
    """Return the indenter stated by a table, by the cards of its class.

    A [profile] is a measured one by its file, a cone by its slope, or the exponent q and one point
    of z = A r^q, its height at a radius, instead of a coefficient in m^(1-q).
    """
    if "file" in table.values and kind in (PowerLawProfile, MeasuredProfile):
        return _measured(table)
    if kind is not PowerLawProfile:
        return table.make(kind, **table.numbers(kind))
    if "slope" in table.values:
        return table.make(Cone, **table.numbers(Cone))
    exponent = table.number(cards(PowerLawProfile)["exponent"])
    height = table.quantity("height", "m", '"10 um"')
    radius = table.quantity("at_radius", "m", '"200 um"')
    if not (height > 0 and radius > 0):
        raise InputError(
            f"{table.name} height and at_radius must be positive, got {height} m and {radius} m"
        )
    return table.make(PowerLawProfile, coefficient=height / radius**exponent, exponent=exponent)


def _measured(table: Table) -> MeasuredProfile:
    """Return the profile of a CSV file with the columns radius and height."""
    columns = read_quantities(table.beside("file", '"tip.csv"'), {"radius": "m", "height": "m"})
    points = tuple(zip(columns["radius"], columns["height"], strict=True))
    return table.make(MeasuredProfile, points)


def _body(table: Table, kind: Any, material: Material) -> Any:
    """Return the body stated by a table; a bonded layer takes the Poisson ratio of its material."""
    if kind is not Layer:
        return table.make(kind, **table.numbers(kind))
    bonded = table.word("base", (Frictionless.word, Bonded.word)) == Bonded.word
    base = Bonded(poisson_ratio=material.poisson_ratio) if bonded else Frictionless()
    return table.make(Layer, **table.numbers(Layer), base=base)


def passport_of_tables(
    tables: Mapping[str, Any],
    *,
    where: Path | str = "the case",
    temperature: float | None = None,
    also: Iterable[Any] = (),
    beside: Callable[[str], Path] | None = None,
) -> tuple[Passport | None, float]:
    """Return the passport of a case's material at its temperature, and the doubt of its shift.

    The parameters are those of :func:`case_of_tables`, which has checked the tables.

    Returns
    -------
    passport : Passport or None
        Moved to the temperature of the case; None if numbers define the material.
    deviation : float
        Standard deviation of log10 a_T; 0 without a passport, or at its own temperature.
    """
    table = Table(where, "material", tables, beside)
    if "passport" not in table.values:
        return None, 0.0
    return moved(*_passport(table, known(also), temperature))


def moved(passport: Passport, temperature: float | None) -> tuple[Passport, float]:
    """Return a passport at a temperature [K], and the standard deviation of its log10 a_T."""
    if temperature is None:
        return passport, 0.0
    return passport.moved_to(temperature), passport.shift_deviation(temperature)


def _material(table: Table, nouns: Nouns, temperature: float | None) -> Material:
    if "passport" in table.values:
        passport, stated = _passport(table, nouns, temperature)
        return passport.material if stated is None else table.make(passport.at_temperature, stated)
    if temperature is not None:
        raise InputError(
            f"{table.path}: a temperature of {temperature:g} K needs a material from a passport, "
            'which contains the shift of its times; [material] passport = "pdms.toml"'
        )
    rests(FITS_ONLY.get(str(table.values.get("model"))))
    kind = nouns.materials[table.word("model", nouns.materials, OWN)]
    if kind is Prony and "file" in table.values:
        return _prony(table)
    return table.make(kind, **table.numbers(kind))


def _passport(
    table: Table, nouns: Nouns, temperature: float | None
) -> tuple[Passport, float | None]:
    """Return the passport next to the file, and the requested temperature [K]."""
    own = nouns.materials.values()
    name = table.get("passport", '"pdms.toml"')
    passport = (
        published(name)
        if isinstance(name, str) and name in MATERIALS
        else read_passport(table.beside("passport", '"pdms.toml"'), also=own)
    )
    if "rubbery_modulus" in table.values:
        passport = _scaled(passport, table.number(cards(Elastic)["rubbery_modulus"]))
    stated = None
    if "temperature" in table.values:
        stated = table.quantity("temperature", "K", '"20 degC"')
    return passport, stated if temperature is None else temperature


def _scaled(passport: Passport, modulus: float) -> Passport:
    """Return a passport whose moduli are scaled to a rubbery modulus [Pa], for a like material."""
    factor = modulus / passport.material.rubbery_modulus
    solid = scaled(passport.material, modulus=factor, time=1.0)
    words = f"{passport.name}, scaled to {readable(modulus, 'Pa')}"
    return replace(passport, name=words, material=solid, evidence=None, allowed=())


def _prony(table: Table) -> Prony:
    """Return a Prony series with branches from a file, as moduli over the rubbery modulus."""
    ratios, unit = read_prony(table.beside("file", '"prony.csv"'))
    if unit == "1":
        raise InputError(
            f"{table.name} file: the times have no unit; name the column relaxation_time_s"
        )
    second = parse(f"1 {unit}", "s")
    plain = {name: table.number(field) for name, field in cards(Prony).items()}
    E0 = plain["rubbery_modulus"]
    branches = tuple((ratio * E0, time * second) for ratio, time in ratios)
    return table.make(Prony, **plain, branches=branches)
