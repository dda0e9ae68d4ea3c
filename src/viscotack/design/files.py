"""Read a design, a window or an array from a TOML file.

All have contacts in the tables of a case file without its protocol, materials or an interface, and
tables of their own; docs/design.md, docs/pick_and_print.md and docs/arrays.md describe them.
"""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import product
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from viscotack.cards import Exact, Pairs, Quantity, cards
from viscotack.errors import InputError
from viscotack.files.toml import read_toml
from viscotack.model.materials import Elastic, Material
from viscotack.model.materials.passport import Passport
from viscotack.model.problem import Problem
from viscotack.model.problem.case_file import case_of_tables, passport_of
from viscotack.model.problem.nouns import known
from viscotack.model.protocol import Speed, Stiffness
from viscotack.model.tables import Read, Reading, read_as, refuse_named, refuse_unknown
from viscotack.model.traction import ages

from .arrays.load import Hold
from .arrays.pulling import MOST_PADS, Backing, PadArray, Scatter, check_draws, grid
from .space import (
    INTERFACE,
    VARIABLES,
    Between,
    Bounds,
    Choice,
    Conditions,
    DesignSpace,
    Targets,
    ends,
)
from .window.picking import DONOR, RECEIVER, STAMP, WindowScatter, aged

_DESIGN = ("targets", "bounds", "conditions", "scatter", "material", "materials", "interface")
_MOST_MATERIALS = 10
# Names of a viscoelastic base, which is not computed.
_VISCOELASTIC = ("base_material", "base_glassy", "base_tau", "base_exponent", "base_rubbery")
# Numbers of a range, per decade and at most.
_PER_DECADE, _MOST = 3, 1000


def _opened(
    path: str | os.PathLike[str],
    names: Iterable[str],
    also: Iterable[Any],
    beside: Callable[[str], Path] | None,
    *,
    not_computed: Iterable[str],
) -> tuple[dict[str, Any], Reading]:
    """Return the tables of a TOML file, which have these names, and how their values are read."""
    path = Path(path)
    tables = read_toml(path)
    why = "contacts are pulled along their axis from a rigid plate or object"
    refuse_named(f"{path}", tables, not_computed, why)
    refuse_unknown(f"{path}", tables, names, "table")
    return tables, Reading(str(path), known(also), beside or path.parent.joinpath)


@contextmanager
def _at(where: str) -> Iterator[None]:
    """Name the place in a file of an InputError."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{where} {error}") from None


def _listed(value: Any, reading: Reading, unit: str) -> tuple[float, ...]:
    """Return a list of quantities."""
    if not isinstance(value, list) or not value:
        raise InputError(f"must be a list, one entry for each, got {value!r:.60}")
    return tuple(reading.parsed(each, unit) for each in value)


def _numbers(value: Any, reading: Reading, unit: str) -> tuple[float, ...]:
    """Return a quantity, a list of them, or the numbers of a range "1 um/s..1 mm/s"."""
    if isinstance(value, list) and value:
        return _listed(value, reading, unit)
    low, *high = ends(value, reading, unit)
    if not high:
        return (low,)
    if not 0 < low < high[0]:
        raise InputError(f"a range begins above 0, got {value!r:.60}")
    count = min(1 + round(_PER_DECADE * np.log10(high[0] / low)), _MOST)
    return tuple(float(x) for x in np.geomspace(low, high[0], max(count, 2)))


def _of(unit: str) -> Read:
    return Read(partial(_numbers, unit=unit))


def _contact(
    tables: Mapping[str, Any],
    name: str,
    reading: Reading,
    also: Iterable[Any],
    *,
    preload: float,
    speed: float,
    temperature: float | None = None,
) -> Problem:
    """Return the contact of a table that has the tables of a case file without its protocol."""
    table, path = tables.get(name), reading.where
    if not isinstance(table, Mapping):
        raise InputError(f"{path}: the table [{name}] is missing; write [{name}.material] and more")
    if "protocol" in table:
        raise InputError(f"{path}: [{name}.protocol] is stated by [pull]; remove it")
    protocol = {"preload_force": f"{preload!r} N", "speed": f"{speed!r} m/s"}
    if temperature is not None:
        table = {**table, "material": {**table["material"], "temperature": f"{temperature!r} K"}}
    return case_of_tables(
        {**table, "protocol": protocol},
        where=f"{path}, [{name}]",
        also=also,
        beside=reading.beside,
    )


@dataclass(frozen=True)
class _ConditionsTable:
    """The table [conditions]: speeds and temperatures at which all targets count."""

    hold_speed: Annotated[Bounds | None, Between("m/s", "100 um/s..10 mm/s")] = None
    release_speed: Annotated[Bounds | None, Between("m/s", "0.1 um/s..10 um/s")] = None
    temperature: Annotated[Bounds | None, Between("K", "10 degC..30 degC")] = None


# Indenter and test used in place of those of a design while material and interface are read.
_POSED = {
    "sphere": {"radius": "1 m"},
    "protocol": {"preload_depth": "0 m", "speed": "1 um/s"},
}


@dataclass(frozen=True)
class DesignFile:
    """Contents of a file.

    Attributes
    ----------
    materials : mapping of str to material
        Materials to choose from.
    traction : traction law
        The interface.
    space : DesignSpace
        Bounds of the variables.
    targets : Targets
        Wanted forces.
    conditions : Conditions
        Speeds, temperatures and tolerances at which they count.
    passports : mapping of str to Passport
        Passports of the materials that have one, at the temperature of the material.
    """

    materials: Mapping[str, Material]
    traction: Any
    space: DesignSpace
    targets: Targets
    conditions: Conditions = Conditions()
    passports: Mapping[str, Passport] = field(default_factory=dict)

    def cautions(self, choice: Choice) -> list[str]:
        """Return the cautions on the forces of a design, each with the speeds it belongs to."""
        from viscotack.prediction.cautions import cautions_on

        from .fast import SURROGATES, FastTier
        from .margins import pad_of

        fast = FastTier(self.materials, self.traction, SURROGATES)
        found: dict[str, list[str]] = {}
        for name, speed in (("hold", choice.hold_speed), ("release", choice.release_speed)):
            if speed is None:
                continue
            # without its backing, whose compliance changes the speed of the edge little
            pad = replace(pad_of(choice, speed, bonded=self.space.bonded), backing=None)
            passport = self.passports.get(choice.material)
            for words in cautions_on(fast.problem(pad), passport=passport):
                found.setdefault(words, []).append(name)
        return [f"to {' and '.join(names)}: {words}" for words, names in found.items()]


def read_design(
    path: str | os.PathLike[str],
    *,
    also: Iterable[Any] = (),
    beside: Callable[[str], Path] | None = None,
) -> DesignFile:
    """Read a design from a TOML file.

    Parameters
    ----------
    path : path
        The file; docs/design.md describes its tables.
    also : iterable of classes
        User-defined laws and materials that the file may name by their words.
    beside : callable, optional
        Returns the path of a file named in a table; by default relative to the folder of the file.

    Raises
    ------
    ValueError
        If it is not TOML, or a table or key is missing, unknown or invalid.
    """
    tables, reading = _opened(path, _DESIGN, also, beside, not_computed=("shear", "peel", "tilt"))
    materials = _materials(reading.where, tables)
    problems, passports = {}, {}
    for name, table in materials.items():
        case = {"material": table, "interface": tables.get("interface"), **_POSED}
        where = f"{path}, material {name!r}"
        problems[name] = case_of_tables(case, where=where, also=also, beside=reading.beside)
        passports[name] = passport_of({"material": table}, reading)[0]
    given = read_as(_ConditionsTable, tables.get("conditions", {}), reading, "conditions")
    speeds = {"hold_speed": given.hold_speed, "release_speed": given.release_speed}
    windows = {name: each for name, each in speeds.items() if each is not None}
    shifts: dict[str, tuple[float, float]] = {}
    if (kelvins := given.temperature) is not None:
        for name, passport in passports.items():
            with _at(f"{path}, material {name!r}:"):
                shifts[name] = _shifts(passport, kelvins)
    deviations = _scatter(tables, reading)
    share = deviations.pop("yield", 0.0)
    window = {f"{name.removesuffix('_speed')}_window": x.top / x.low for name, x in windows.items()}
    with _at(f"{path}, [scatter]"):
        conditions = Conditions(**window, shifts=shifts, deviations=deviations, share=share)
    space = read_as(DesignSpace, tables.get("bounds"), reading, "bounds")
    with _at(f"{reading.where}, [bounds]"):
        if twice := [name for name in windows if getattr(space, name) is not None]:
            raise InputError(f"{twice[0]}: all speeds in [conditions] count; remove it")
    slowest: dict[str, Any] = {
        name: Bounds(x.low if name == "hold_speed" else x.top) for name, x in windows.items()
    }
    return DesignFile(
        {name: each.material for name, each in problems.items()},
        next(iter(problems.values())).traction,
        replace(space, **slowest),
        read_as(Targets, tables.get("targets"), reading, "targets"),
        conditions,
        {name: each for name, each in passports.items() if each is not None},
    )


def _shifts(passport: Passport | None, ends: Bounds) -> tuple[float, float]:
    """Return the least and largest factor on the times of a material over the temperatures."""
    if passport is None:
        raise InputError("temperatures need a passport, which has the shift of the times")
    if passport.temperature is None:
        raise InputError("the temperature of the passport is unknown")
    own = passport.shift_factor(passport.temperature)
    found = [passport.shift_factor(T) / own for T in (ends.low, ends.top)]
    return min(found), max(found)


def _scatter(tables: Mapping[str, Any], reading: Reading) -> dict[str, float]:
    """Return the tolerances, and as "yield" the least share of parts that meet the targets."""
    given = tables.get("scatter", {})
    where = f"{reading.where}, [scatter]"
    if not isinstance(given, Mapping):
        raise InputError(f"{where} must be a table")
    known = [name for name in (*VARIABLES, *INTERFACE, "yield") if name != "pads"]
    refuse_unknown(where, given, known, "key")
    found = {}
    for name, value in given.items():
        with _at(f"{where} {name}:"):
            found[name] = reading.parsed(value, "1", "3 %")
    return found


def _materials(path: str, tables: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tables of the materials by their names."""
    if ("material" in tables) == ("materials" in tables):
        raise InputError(f"{path}: a design needs either [material] or a list of [[materials]]")
    if "material" in tables:
        only = tables["material"]
        named = only.get("passport", only.get("model")) if isinstance(only, Mapping) else None
        return {named if isinstance(named, str) else "material": only}
    given = tables["materials"]
    if not isinstance(given, list) or not 0 < len(given) <= _MOST_MATERIALS:
        raise InputError(f"{path}: [[materials]] must be a list of 1 to {_MOST_MATERIALS} tables")
    found: dict[str, Any] = {}
    for number, each in enumerate(given, start=1):
        name = each.get("name") if isinstance(each, Mapping) else None
        if not isinstance(name, str) or not name or name in found:
            raise InputError(
                f"{path}: each of [[materials]] needs a name of its own; number {number} has "
                f"{name!r:.60}"
            )
        found[name] = {key: value for key, value in each.items() if key != "name"}
    return found


@dataclass(frozen=True)
class _WindowPull:
    """The table [pull]: speeds, preloads, the machine, and what more maps are drawn for."""

    speeds: Annotated[tuple[float, ...], _of("m/s")]
    preloads: Annotated[tuple[float, ...], _of("N")]
    stiffness: Stiffness | None = None
    temperatures: Annotated[tuple[float | None, ...], _of("K")] = (None,)
    dwells: Annotated[tuple[float | None, ...], _of("s")] = (None,)


@dataclass(frozen=True)
class WindowFile:
    """One map of a file: the arguments of :func:`viscotack.window`.

    Attributes
    ----------
    stamp, donor, receiver : Problem or None
        The contacts.
    speeds, preloads : tuple of float
        Speeds [m/s] and preloads [N].
    stiffness : float or None
        Of the machine [N/m].
    scatter : WindowScatter or None
        Scatter of works and preload.
    temperature, dwell : float or None
        Temperature [K] and dwell [s] of the contacts, where the file states some.
    """

    stamp: Problem
    donor: Problem | None
    receiver: Problem | None
    speeds: tuple[float, ...]
    preloads: tuple[float, ...]
    stiffness: float | None
    scatter: WindowScatter | None = None
    temperature: float | None = None
    dwell: float | None = None


def read_window(
    path: str | os.PathLike[str],
    *,
    also: Iterable[Any] = (),
    beside: Callable[[str], Path] | None = None,
) -> tuple[WindowFile, ...]:
    """Read a window from a TOML file: a map for each temperature and dwell.

    Parameters
    ----------
    path : path
        The file; docs/pick_and_print.md describes its tables.
    also : iterable of classes
        User-defined laws, materials, shapes and bodies that the file may name by their words.
    beside : callable, optional
        Returns the path of a file named in a table; by default relative to the folder of the file.

    Raises
    ------
    ValueError
        If it is not TOML, or a table or key is missing, unknown or invalid.
    """
    known = (STAMP, DONOR, RECEIVER, "pull", "scatter")
    tables, reading = _opened(path, known, also, beside, not_computed=("shear", "peel", "tilt"))
    pull = read_as(_WindowPull, tables.get("pull"), reading, "pull")
    scatter = None
    if "scatter" in tables:
        scatter = read_as(WindowScatter, tables["scatter"], reading, "scatter")
    names = [name for name in (STAMP, DONOR, RECEIVER) if name in tables]
    if STAMP not in names or len(names) == 1:
        raise InputError(f"{path}: a window needs [stamp], and [donor], [receiver] or both")
    stated = {name: _material(tables[name]) for name in names}
    for name, table in stated.items() if pull.temperatures != (None,) else ():
        if "passport" not in table and table.get("model") != Elastic.word:
            raise InputError(
                f"{path}: temperatures need the shift of the times of [{name}.material]; state it "
                'by a passport, passport = "pdms.toml"'
            )
    maps = []
    for temperature, dwell in product(pull.temperatures, pull.dwells):
        contacts = {
            name: _contact(
                tables,
                name,
                reading,
                also,
                # speed and preload of the map replace these
                preload=pull.preloads[0],
                speed=pull.speeds[0],
                temperature=temperature if "passport" in table else None,
            )
            for name, table in stated.items()
        }
        if dwell is not None:
            if not any(ages(each.traction) for each in contacts.values()):
                raise InputError(
                    f"{path}: dwells need an interface that ages, for example [stamp.interface] "
                    'law = "logarithmic-ageing"'
                )
            contacts = {name: aged(each, dwell) for name, each in contacts.items()}
        bases = contacts.get(DONOR), contacts.get(RECEIVER)
        drive = pull.speeds, pull.preloads, pull.stiffness
        maps.append(WindowFile(contacts[STAMP], *bases, *drive, scatter, temperature, dwell))
    return tuple(maps)


def _material(contact: Any) -> Mapping[str, Any]:
    """Return the table of the material of a contact; empty if there is none."""
    table = contact.get("material") if isinstance(contact, Mapping) else None
    return table if isinstance(table, Mapping) else {}


@dataclass(frozen=True)
class _ArrayPull:
    """The table [pull]."""

    speed: Speed
    preload: Annotated[float, Quantity("N", "P", "preload of all pads", example="20 mN")]
    hold_time: Annotated[float, Quantity("s", "t", "time held", example="10 s")] | None = None


@dataclass(frozen=True)
class _Layout:
    """The table [array]: rows, columns and spacing, or positions; heights, works and scatter."""

    positions: (
        Annotated[
            tuple[tuple[float, float], ...],
            Pairs(("m", "m"), "x, y", "x and y", example='[["0 mm", "0 mm"], ["4 mm", "0 mm"]]'),
        ]
        | None
    ) = None
    rows: Annotated[int, Exact] | None = None
    columns: Annotated[int, Exact] | None = None
    spacing: (
        Annotated[float, Quantity("m", "d", "distance of the pads", above=0, example="4 mm")] | None
    ) = None
    heights: Annotated[tuple[float, ...], Read(partial(_listed, unit="m"))] = ()
    works: Annotated[tuple[float, ...], Read(partial(_listed, unit="1"))] = ()
    height_scatter: Annotated[float, cards(Scatter)["height"].card] | None = None
    work_scatter: Annotated[float, cards(Scatter)["work"].card] | None = None
    seed: Annotated[int, Exact] = 0
    draws: Annotated[int, Exact] = 300

    def __post_init__(self) -> None:
        if self.seed < 0 or self.draws < 0:
            raise InputError("seed and draws must be whole numbers that are not negative")
        if self.positions is None and None in (self.rows, self.columns, self.spacing):
            raise InputError(
                "an array needs rows, columns and spacing, or positions; write for example "
                'rows = 3, columns = 3, spacing = "4 mm"'
            )
        rows, columns = self.rows or 1, self.columns or 1
        if rows < 0 or not 0 < rows * columns <= MOST_PADS:
            raise InputError(f"rows and columns must be from 1 up, with {MOST_PADS:,} pads at most")

    @property
    def places(self) -> tuple[tuple[float, float], ...]:
        """Places of the pads [m]."""
        if self.positions is not None:
            return self.positions
        return grid(self.rows or 1, self.columns or 1, self.spacing or 0.0)

    @property
    def scatter(self) -> Scatter | None:
        """Scatter of heights and works; None if neither is stated."""
        if self.height_scatter is self.work_scatter is None:
            return None
        return Scatter(self.height_scatter or 0.0, self.work_scatter or 0.0, self.seed)


@dataclass(frozen=True)
class ArrayFile:
    """Contents of a file.

    Attributes
    ----------
    array : PadArray
        Pads and backing, without scatter.
    speed, preload : float
        Of the pull [m/s, N].
    scatter : Scatter or None
        Scatter of heights and works.
    draws : int
        Number of arrays drawn for the yield.
    hold : Hold or None
        The load.
    hold_time : float or None
        Time for which the pressed plate is held in place [s].
    """

    array: PadArray
    speed: float
    preload: float
    scatter: Scatter | None
    draws: int
    hold: Hold | None
    hold_time: float | None = None


def read_array(
    path: str | os.PathLike[str],
    *,
    also: Iterable[Any] = (),
    beside: Callable[[str], Path] | None = None,
) -> ArrayFile:
    """Read an array from a TOML file.

    Parameters
    ----------
    path : path
        The file; docs/arrays.md describes its tables.
    also : iterable of classes
        User-defined laws, materials, shapes and bodies that the file may name by their words.
    beside : callable, optional
        Returns the path of a file named in a table; by default relative to the folder of the file.

    Raises
    ------
    ValueError
        If it is not TOML, or a table or key is missing, unknown or invalid.
    """
    tables, reading = _opened(
        path,
        ("pad", "array", "backing", "pull", "hold"),
        also,
        beside,
        not_computed=("shear", "peel"),
    )
    backing = tables.get("backing", {})
    if isinstance(backing, Mapping):
        refuse_named(
            reading.where,
            backing,
            _VISCOELASTIC,
            "the common base is elastic, because point loads have no memory here; base_modulus may "
            "be the relaxed modulus for a slow pull, or the glassy one for a fast pull",
        )
    pull = read_as(_ArrayPull, tables.get("pull"), reading, "pull")
    pad = _contact(tables, "pad", reading, also, preload=pull.preload, speed=pull.speed)
    layout = read_as(_Layout, tables.get("array"), reading, "array")
    carried = read_as(Backing, backing, reading, "backing")
    with _at(f"{path}, [array]"):
        places, scatter = layout.places, layout.scatter
        check_draws(layout.draws, len(places))
        array = PadArray(pad, places, heights=layout.heights, works=layout.works, backing=carried)
    hold = read_as(Hold, tables["hold"], reading, "hold") if "hold" in tables else None
    return ArrayFile(array, pull.speed, pull.preload, scatter, layout.draws, hold, pull.hold_time)
