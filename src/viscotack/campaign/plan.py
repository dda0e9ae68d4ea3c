"""Plans of campaigns: cases and settings, from a TOML file, a table, or Python.

Cases are every combination of given values, or points that fill a region evenly. A range is written
as values with a scale, ``{ log = [0.01, 10] }`` or ``{ linear = [0.2, 2] }``. With more than two
values, equal shares of the points lie between neighbours: the values are then equally spaced
quantiles, and any distribution can be stated.
"""

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from viscotack.errors import InputError, placed
from viscotack.files.toml import read_toml
from viscotack.model.problem import RoughCase
from viscotack.model.problem.case_file import from_dict, read_case, run_id, to_dict
from viscotack.model.problem.nouns import own_nouns
from viscotack.model.problem.rows import (
    KINDS,
    Column,
    Kind,
    columns_of,
    kind_of_columns,
    kind_of_problem,
)
from viscotack.model.tables import Reading, read_as
from viscotack.simulate import has_start
from viscotack.simulate.rough import read_rough_case

from .case import CaseSettings
from .listed import read_words

_KEYS = ("kind", "problem", "with", "settings", "grid", "fill", "list")
# A region in which fewer points than this share are contacts is not worth being searched.
_LEAST_ACCEPTED = 1e-2
# A Sobol sequence is drawn in blocks of this power of two, its balance asks for one.
_BLOCK = 10
# Values of a range are rounded to these digits: cases are named by their numbers, and the last
# digit of an exponential is not the same on every machine.
_DIGITS = 9
# Cases that a plan may have: they are made before the first is run.
_MOST = 10_000_000


@dataclass(frozen=True, slots=True)
class Case:
    """One case of a plan.

    Attributes
    ----------
    name : str
        By the content of its problem: equal problems have equal names.
    inputs : dict
        The numbers that state it, by column.
    """

    name: str
    inputs: dict[str, float]


@dataclass(frozen=True)
class Plan:
    """Cases and settings of a campaign, without repetitions; returned by :func:`read_plan`.

    Attributes
    ----------
    kind : Kind
        What the inputs mean.
    cases : tuple of Case
        Without repetitions.
    settings : CaseSettings
        How they are solved.
    base : dict or None
        Record of the problem in which inputs are replaced, with ``problem = "FILE.toml"``.
    rejected, repeated : int
        Points of grids and fills that are not contacts, and cases stated more than once.
    refusal : str
        Why the first of the points that were rejected was.
    shard : str or None
        Which part of the whole plan this is, "3/20".
    """

    kind: Kind
    cases: tuple[Case, ...]
    settings: CaseSettings
    base: dict[str, Any] | None = None
    rejected: int = 0
    repeated: int = 0
    refusal: str = ""
    shard: str | None = None


# A block that states cases, and its key in a file.
_Blocks = list[tuple[str, Any]]
# Inputs of a case, its problem, and why it is not run.
_Row = tuple[dict[str, float], Any, str]


class _Listed:
    """The rows of a table, read again at each iteration.

    A column is an input, with its unit in the heading or in the cells where cases are in SI.
    """

    def __init__(self, path: Path, kind: Kind | None) -> None:
        self.path = path
        headings = read_words(path)[0]
        self.kind = kind or kind_of_columns(headings)
        self.columns, unknown = columns_of(headings, self.kind.inputs)
        if unknown:
            raise InputError(
                f"{path}: the columns {', '.join(unknown)} are no inputs; they are "
                f"{', '.join(self.kind.inputs)}"
            )

    def __iter__(self) -> Iterator[_Row]:
        headings, lines = read_words(self.path)
        for line, words in lines:
            cells = dict(zip(headings, words, strict=True))
            with placed(f"{self.path}, line {line}:"):
                row = {c.number.path: c.read(cells[c.heading]) for c in self.columns}
                problem = self.kind.problem(row)
            yield row, problem, ""


def read_plan(
    path: str | os.PathLike[str], *, own: Iterable[str | os.PathLike[str]] = (), **changed: Any
) -> Plan:
    r"""Read a plan from a file.

    Parameters
    ----------
    path : path
        A TOML file as docs/campaigns.md describes it, or a table, CSV or .xlsx, with a column per
        input.
    own : iterable of path
        Python files that may be executed, with observables, laws, materials, shapes and bodies:
        those that the file names in ``with``, and further ones.
    **changed
        Settings (fields of `CaseSettings`) that replace those of the file; None leaves one.

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    ValueError
        If a key, a column or a number is wrong. The message contains its place.

    Returns
    -------
    Plan
        The cases and settings.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder, "cases.csv")
    ...     text = "tabor,modulus_ratio,exponent,preload,rate\n1,0.1,0.5,5,10\n"
    ...     _ = file.write_text(text)
    ...     plan = read_plan(file, accuracy=0.02)
    >>> len(plan.cases), plan.settings.accuracy
    (1, 0.02)
    """
    path, settings = Path(path), {name: v for name, v in changed.items() if v is not None}
    with placed(f"{path}:"):
        is_table = path.suffix.lower() in (".csv", ".xlsx")
        tables: dict[str, Any] = {"list": [{"file": path.name}]} if is_table else read_toml(path)
        if unknown := tables.keys() - set(_KEYS):
            raise InputError(f"unknown {', '.join(sorted(unknown))}; a plan has {', '.join(_KEYS)}")
        if files := _permitted(path, tables, own):
            settings["own"] = files
        given = tables.get("settings", {})
        if not isinstance(given, dict) or "own" in given:
            raise InputError(f"[settings] is a table without `own`, got {given!r:.60}")
        reading = Reading(str(path), bare=True)
        settings = read_as(CaseSettings, given | settings, reading, "settings")
        problem = None
        if "problem" in tables:
            if "kind" in tables:
                raise InputError("kind and problem exclude each other; leave one out")
            file = path.parent / str(tables["problem"])
            read = read_rough_case if "surface" in read_toml(file) else read_case
            problem = read(file, also=own_nouns(files))
            kind = kind_of_problem(problem, set())
        elif (name := tables.get("kind", "sphere")) in KINDS:
            kind = None if is_table else KINDS[name]
        else:
            raise InputError(f"kind must be one of {', '.join(KINDS)}, got {name!r}")
        blocks = _blocks(path, tables, kind)
        if kind is None:
            kind = blocks[0][1].kind
    return _planned(str(path), kind, blocks, settings, problem)


def _blocks(path: Path, tables: Mapping[str, Any], kind: Kind | None) -> _Blocks:
    """Return the blocks that state cases, those of lists as the rows of their files."""
    found: _Blocks = []
    for key in ("grid", "list", "fill"):
        blocks = tables.get(key, [])
        if not isinstance(blocks, list) or not all(isinstance(b, dict) for b in blocks):
            raise InputError(f"write [[{key}]] with two brackets; there may be several")
        for block in blocks:
            if key == "list":
                if block.keys() != {"file"}:
                    raise InputError('[[list]]: needs file = "cases.csv" and nothing else')
                found.append((key, _Listed(path.parent / str(block["file"]), kind)))
            else:
                found.append((key, _flat(block)))
    if not found:
        raise InputError("no [[grid]], [[list]] or [[fill]]: there is nothing to run")
    return found


def space_filling(
    problem: Any,
    over: Mapping[str, Any],
    *,
    cases: int,
    seed: int = 0,
    settings: CaseSettings | None = None,
) -> Plan:
    """Plan cases that evenly fill ranges of numbers of a problem.

    Parameters
    ----------
    problem : Problem or Groups
        Shape, body, solid, law and history that all cases have; the numbers that are not varied.
    over : mapping
        Ranges by the paths of numbers, as in a file: ``{"sphere.radius": {"log": ["1 mm", "1
        cm"]}}``; `inputs_of` returns the paths. Text with units where the problem is in SI.
    cases, seed
        As in a ``[[fill]]`` of a file.
    settings : CaseSettings, optional
        Accuracy, end and limits of the cases, and files with user-defined classes.

    Returns
    -------
    Plan
        The cases and settings.

    Raises
    ------
    ValueError
        If a path is no number of the problem, a range is impossible, or next to no point of the
        region is a contact.

    Examples
    --------
    Cones of all slopes, after dwells of all lengths:

    >>> from viscotack import AtDepth, Cone, Dwell, Elastic, LennardJones, Problem, Retraction
    >>> soft = Elastic(rubbery_modulus=1e6, poisson_ratio=0.5)
    >>> law = LennardJones(work_of_adhesion=0.05, equilibrium_gap=1e-6)
    >>> test = Retraction(start=AtDepth(2e-6), speed=1e-5, moves=(Dwell(1.0),))
    >>> base = Problem(material=soft, traction=law, geometry=Cone(0.1), protocol=test)
    >>> plan = space_filling(
    ...     base,
    ...     {
    ...         "cone.slope": {"log": [0.05, 0.2]},
    ...         "protocol.moves.0.duration": {"log": ["1 s", "1 h"]},
    ...     },
    ...     cases=8,
    ... )
    >>> len(plan.cases), plan.rejected
    (8, 0)
    """
    return _of_problem(problem, "fill", {**over, "cases": cases, "seed": seed}, settings)


def every_combination(
    problem: Any, over: Mapping[str, Any], *, settings: CaseSettings | None = None
) -> Plan:
    """Plan every combination of values of numbers of a problem.

    Parameters
    ----------
    problem : Problem or Groups
        The problem; numbers that are not varied keep their values.
    over : mapping
        Path of a number -> a number, a list, or a range with a count, ``{"log": ["1 um/s", "1
        mm/s"], "count": 7}``.
    settings : CaseSettings, optional
        Accuracy, end and limits of the cases.

    Returns
    -------
    Plan
        The cases and settings.

    Raises
    ------
    ValueError
        If a path is not a number of the problem or no combination is a contact.

    Examples
    --------
    >>> from viscotack import AtDepth, Elastic, Groups
    >>> solid = Elastic(rubbery_modulus=1, poisson_ratio=0)
    >>> base = Groups(tabor=1.0, material=solid, start=AtDepth(5.0), rate=1.0)
    >>> len(every_combination(base, {"tabor": [1, 2], "preload": [1, 2, 3]}).cases)
    6
    """
    return _of_problem(problem, "grid", dict(over), settings)


def _of_problem(
    problem: Any, key: str, block: dict[str, Any], settings: CaseSettings | None
) -> Plan:
    settings = settings or CaseSettings()
    # as the workers will read it: refused without the files of its user-defined classes
    problem = from_dict(to_dict(problem), settings.nouns, beside=Path)
    return _planned("the plan", kind_of_problem(problem, set()), [(key, block)], settings, problem)


def _planned(where: str, kind: Kind, blocks: _Blocks, settings: CaseSettings, problem: Any) -> Plan:
    """Return the plan of blocks that state cases of a kind, or change this problem."""
    if problem is not None:
        with placed(f"{where}:"):
            names = {name for key, block in blocks for name in _inputs(key, block)}
            kind = kind_of_problem(problem, names)
    cases: dict[str, Case] = {}
    stated, rejected, refusal = 0, 0, ""
    for number, (key, block) in enumerate(blocks, 1):
        with placed(f"{where}, block {number} ([[{key}]]):"):
            kind.check(_inputs(key, block))
            rows = iter(block) if key == "list" else _of_ranges(kind, key, block)
            for inputs, stated_problem, why in rows:
                if why:
                    rejected, refusal = rejected + 1, refusal or why
                    continue
                stated += 1
                case = Case(run_id(stated_problem), inputs)
                cases.setdefault(case.name, case)
    if not cases:
        raise InputError(
            f"{where}: none of its {rejected} points is a contact, so there is nothing to run. The "
            f"first: {refusal}"
        )
    return Plan(
        kind=kind,
        cases=tuple(cases.values()),
        settings=settings,
        base=None if problem is None else to_dict(problem),
        rejected=rejected,
        repeated=stated - len(cases),
        refusal=refusal,
    )


def shard_of(plan: Plan, shard: str) -> Plan:
    """Select a shard of a plan.

    Parameters
    ----------
    plan : Plan
        The whole plan.
    shard : str
        Number of the shard and of shards, "3/20".

    Returns
    -------
    Plan
        Every n-th case of the plan.

    Raises
    ------
    ValueError
        If there is no such shard, or it has no cases.

    Examples
    --------
    >>> from viscotack import AtDepth, Elastic, Groups
    >>> from viscotack.campaign import every_combination
    >>> solid = Elastic(rubbery_modulus=1, poisson_ratio=0)
    >>> base = Groups(tabor=1.0, material=solid, start=AtDepth(5.0), rate=1.0)
    >>> plan = every_combination(base, {"tabor": [1, 2, 3, 4]})
    >>> len(shard_of(plan, "1/2").cases)
    2
    """
    number, count = numbers_of(shard)
    if count > len(plan.cases):
        raise InputError(f"a plan of {len(plan.cases)} cases has no {count} shards")
    return replace(plan, cases=plan.cases[number - 1 :: count], shard=shard)


def numbers_of(shard: str) -> tuple[int, int]:
    """Return the number of a shard and of shards: 3 and 20 of "3/20"."""
    number, _, count = shard.partition("/")
    if not (number.isdecimal() and count.isdecimal() and 1 <= int(number) <= int(count)):
        raise InputError(f"a shard is written '3/20', the third of twenty; got {shard!r}")
    return int(number), int(count)


def restored_kind(name: str, base: dict[str, Any] | None, also: tuple[Any, ...]) -> Kind:
    """Return the kind of a stored plan, whose problem uses these user-defined classes."""
    return kind_of_problem(from_dict(base, also, beside=Path), set()) if base else KINDS[name]


def _permitted(
    path: Path, tables: Mapping[str, Any], own: Iterable[str | os.PathLike[str]]
) -> tuple[str, ...]:
    """List the Python files of a campaign; those that the plan names must be permitted."""
    files = tables.get("with", [])
    if not isinstance(files, list) or not all(isinstance(file, str) for file in files):
        raise InputError('with must be a list of files, with = ["my_laws.py"]')
    named = [str((path.parent / file).resolve()) for file in files]
    given = [str(Path(file).resolve()) for file in own]
    if missing := [file for file in named if file not in given]:
        raise InputError(
            "it names Python that would be executed: permit it, "
            f"{' '.join(f'--with {file}' for file in missing)} on the command line, own=[...] in "
            "Python"
        )
    return tuple(dict.fromkeys([*named, *given]))


def _inputs(key: str, block: Any) -> set[str]:
    """Return the names of the inputs of a block."""
    if key == "list":
        return {column.number.path for column in block.columns}
    return set(block) - ({"cases", "seed"} if key == "fill" else set())


def _flat(block: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Return a block with dotted names: TOML reads ``protocol.speed = 1`` as a table."""
    found: dict[str, Any] = {}
    for key, value in block.items():
        is_range = isinstance(value, dict) and value.keys() & {"log", "linear", "choose"}
        if isinstance(value, dict) and not is_range:
            found |= _flat(value, f"{prefix}{key}.")
        else:
            found[f"{prefix}{key}"] = value
    return found


def _of_ranges(kind: Kind, key: str, block: dict[str, Any]) -> Iterator[_Row]:
    """Yield the points of a grid or a fill, or why one is not run; a fill draws another one."""
    # The dimensions of the sequence follow the kind, not the order in which a file was written.
    names = [name for name in (*kind.columns, *kind.choices) if name in block]
    values = {name: _read(kind, name, block[name]) for name in names}
    if key == "grid":
        yield from (_contact(kind, row) for row in grid(values))
        return
    wanted, kept, rejected = block.get("cases"), 0, 0
    for row in fill(values, cases=wanted, seed=block.get("seed", 0)):
        try:
            _, problem, why = _contact(kind, row)
        except InputError as error:  # in a grid its values were chosen, each with all the others
            problem, why = None, str(error)
        kept, rejected = kept + (not why), rejected + bool(why)
        yield row, problem, why
        if kept == wanted:
            return
        if rejected > 2 / _LEAST_ACCEPTED and kept < _LEAST_ACCEPTED * rejected:
            raise InputError(
                f"only {kept} of the first {kept + rejected} points of a fill are contacts; "
                f"change its ranges. The last that is not: {why}"
            )


def _contact(kind: Kind, row: dict[str, float]) -> _Row:
    """Return a point with its problem, and why it is not run."""
    problem = kind.problem(row)
    is_contact = isinstance(problem, RoughCase) or has_start(problem)
    return row, problem, "" if is_contact else "there is no relaxed contact to begin with"


def _read(kind: Kind, name: str, given: Any) -> Any:
    """Return a value, a list or a range with its text as numbers, each within its card's range."""
    if isinstance(given, Mapping):
        kept = ("count", "weights")
        return {key: v if key in kept else _read(kind, name, v) for key, v in given.items()}
    if isinstance(given, list):
        return [_read(kind, name, v) for v in given]
    if isinstance(given, bool):
        raise InputError(f"{name} must be a number, got {given}")
    entry = kind.inputs[name]
    number = Column(name, entry).read(given)
    return entry.card.checked(name, number, entry.unit)


def grid(values: Mapping[str, Any]) -> Iterator[dict[str, float]]:
    """Return every combination of the values of the inputs.

    Parameters
    ----------
    values : mapping of str to number, list, or range with a count
        A number, a list of numbers, or ``{"log": [1, 100], "count": 5}`` (or ``"linear"``).

    Examples
    --------
    >>> list(grid({"tabor": 1.0, "rate": {"log": [1, 100], "count": 3}}))
    [{'tabor': 1.0, 'rate': 1.0}, {'tabor': 1.0, 'rate': 10.0}, {'tabor': 1.0, 'rate': 100.0}]
    """
    lists = [_steps(name, given) for name, given in values.items()]
    check_number(prod(map(len, lists)))
    for combination in product(*lists):
        yield dict(zip(values, combination, strict=True))


def fill(values: Mapping[str, Any], *, cases: Any, seed: Any = 0) -> Iterator[dict[str, float]]:
    """Return points of a Sobol sequence, without end, that fill the ranges of the inputs evenly.

    The first points do not depend on their number.

    Parameters
    ----------
    values : mapping of str to number or range
        ``{"log": [0.01, 10]}``, ``{"linear": [...]}``, a fixed number, or
        ``{"choose": [0.1, 0.3], "weights": [5, 1]}``; the weights may be left out.
    cases : int
        How many points are wanted.
    seed : int
        Of the scrambling.
    """
    for name, number, least in (("cases", cases, 1), ("seed", seed, 0)):
        if not isinstance(number, int) or isinstance(number, bool) or number < least:
            raise InputError(f"{name} must be a whole number of at least {least}, got {number!r}")
    check_number(cases)
    makers = {name: _mapping(name, given) for name, given in values.items()}
    free = [name for name in makers if isinstance(values[name], Mapping)]
    if not free:
        raise InputError("a fill needs at least one range; give a grid for a single case")
    # Takes a while to import, and a worker that imports this module never draws a point.
    from scipy.stats import qmc

    # The name that every supported version of scipy knows; the checker knows the newest only.
    generator: dict[str, Any] = {"seed": seed}
    sequence = qmc.Sobol(len(free), **generator)
    while True:
        for point in sequence.random(2**_BLOCK).tolist():
            places = dict(zip(free, point, strict=True))
            yield {name: make(places.get(name, 0.0)) for name, make in makers.items()}


def check_number(cases: int) -> None:
    """Refuse more cases than a plan may have."""
    if cases > _MOST:
        raise InputError(
            f"a plan has at most {_MOST} cases, got {cases:.3g}; split it into several plans with "
            "separate folders"
        )


def _steps(name: str, given: Any) -> list[float]:
    if isinstance(given, Mapping):
        count = given.get("count")
        if not isinstance(count, int) or count < 1 or "choose" in given:
            raise InputError(f"{name}: a range of a grid needs its count, got {dict(given)}")
        check_number(count)
        make = _mapping(name, {k: v for k, v in given.items() if k != "count"})
        places = np.linspace(0.0, 1.0, count) if count > 1 else [0.0]
        return [make(place) for place in places]
    return _numbers(name, given if isinstance(given, list) else [given])


def _mapping(name: str, given: Any) -> Any:
    """Return the function that maps [0, 1) to values of the input."""
    if isinstance(given, int | float):
        (fixed,) = _numbers(name, [given])
        return lambda _: fixed
    scales = [key for key in ("log", "linear", "choose") if key in given]
    allowed = {*scales, "weights"} if scales == ["choose"] else set(scales)
    if len(scales) != 1 or given.keys() - allowed:
        raise InputError(
            f"{name} must be a number, {{ log = [low, high] }}, {{ linear = [low, high] }} or "
            f"{{ choose = [...], weights = [...] }}, got {given}"
        )
    values = np.array(_numbers(name, given[scales[0]]))
    if scales == ["choose"]:
        return _choice(name, values, given.get("weights", [1] * len(values)))
    if len(values) < 2 or np.any(np.diff(values) < 0):
        raise InputError(f"{name}: a range is two or more rising values, got {values.tolist()}")
    logarithmic = scales == ["log"]
    if logarithmic and values[0] <= 0:
        raise InputError(f"{name}: a log range must be positive, got {values.tolist()}")
    ends, places = np.log(values) if logarithmic else values, np.linspace(0, 1, len(values))

    def value(place: float) -> float:
        found = np.interp(place, places, ends)
        return float(f"{np.exp(found) if logarithmic else found:.{_DIGITS}g}")

    return value


def _choice(name: str, values: npt.NDArray, weights: Sequence[float]) -> Any:
    shares = np.cumsum(_numbers(f"{name}, weights", weights))
    if len(shares) != len(values) or shares[-1] <= 0 or np.any(np.diff(shares, prepend=0) < 0):
        raise InputError(
            f"{name}: needs a weight, not negative, for each of its {len(values)} choices, "
            f"got {list(weights)}"
        )
    return lambda place: float(values[np.searchsorted(shares, place * shares[-1], side="right")])


def _numbers(name: str, given: Any) -> list[float]:
    good = isinstance(given, list | tuple) and given
    if not good or any(isinstance(v, bool) or not isinstance(v, int | float) for v in given):
        raise InputError(f"{name} must be a number or a list of numbers, got {given!r}")
    if not np.all(np.isfinite(given)):
        raise InputError(f"{name} must be finite, got {given!r}")
    return [float(v) for v in given]
