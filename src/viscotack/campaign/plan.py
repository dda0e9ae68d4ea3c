"""Plans of campaigns: cases and settings, from a TOML file or a CSV file."""

import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from viscotack.cards import cards
from viscotack.errors import InputError
from viscotack.files.text import read_text
from viscotack.files.toml import parse_toml, read_toml
from viscotack.model.problem.case_file import read_case
from viscotack.model.problem.inputs import check_exponent
from viscotack.model.problem.nouns import own_nouns
from viscotack.model.problem.record import from_dict, run_id, to_dict
from viscotack.simulate.rough import read_rough_case
from viscotack.units import parse

from .case import CaseSettings
from .columns import KINDS, Kind, has_relaxed_contact, kind_of_columns, kind_of_problem
from .design import Tally, accepted, fill, grid
from .listed import Listed

_KEYS = ("kind", "problem", "temperature", "with", "settings", "grid", "fill", "list")


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
    source : str
        Text of the file; "" for a plan made otherwise.
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
    source: str = ""
    shard: str | None = None


def read_plan(
    path: str | os.PathLike[str], *, own: Iterable[str | os.PathLike[str]] = (), **changed: Any
) -> Plan:
    r"""Read a plan from a file.

    Parameters
    ----------
    path : path
        A TOML file as docs/campaigns.md describes it, or a CSV file with a column per input.
    own : iterable of path
        Python files that may be executed, with observables, laws, materials, shapes and bodies:
        those that the file names in ``with``, and further ones.
    **changed
        Settings (fields of `CaseSettings`) that replace those of the file; None leaves one. And
        `temperature`, in words, which replaces that of the base problem's material.

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
    source = read_text(path)
    with _placed(str(path)):
        if path.suffix == ".csv":
            rows = Listed(path, source)
            tables: dict[str, Any] = {"kind": kind_of_columns(set(rows.names))}
            blocks: list[tuple[str, Any]] = [("list", rows)]
        else:
            tables = parse_toml(source, path)
            if unknown := tables.keys() - set(_KEYS):
                raise InputError(
                    f"unknown {', '.join(sorted(unknown))}; a plan has {', '.join(_KEYS)}"
                )
            blocks = _blocks(path, tables)
        if "temperature" in settings:
            tables["temperature"] = settings.pop("temperature")
        if files := _permitted(path, tables, own):
            settings["own"] = files
        kind, base = _kind(path, tables, blocks, own_nouns(files))
        settings = _settings(tables.get("settings", {}), settings)
    return _planned(str(path), kind, blocks, settings, base, source)


@contextmanager
def _placed(where: str, file: str = "") -> Iterator[None]:
    """Put a place before what is wrong, unless a place in this file or in another one is there."""
    try:
        yield
    except (ValueError, TypeError) as error:
        is_placed = str(error).startswith((where, file or where))
        raise InputError(str(error) if is_placed else f"{where}: {error}") from None


def _blocks(path: Path, tables: Mapping[str, Any]) -> list[tuple[str, Any]]:
    """Return the blocks that state cases, those of lists as the rows of their files."""
    found: list[tuple[str, Any]] = []
    for key in ("grid", "list", "fill"):
        blocks = tables.get(key, [])
        if not isinstance(blocks, list) or not all(isinstance(b, dict) for b in blocks):
            raise InputError(f"write [[{key}]] with two brackets; there may be several")
        for block in blocks:
            if key == "list":
                if block.keys() != {"file"}:
                    raise InputError('[[list]]: needs file = "cases.csv" and nothing else')
                file = path.parent / str(block["file"])
                found.append((key, Listed(file, read_text(file))))
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
    method: str = "sobol",
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
    cases, method, seed
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
    block = {**over, "cases": cases, "method": method, "seed": seed}
    return _of_problem(problem, "fill", block, settings)


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
    _check_own(problem, settings)
    kind = _kind_over(problem, [(key, block)], settings.nouns)
    return _planned("the plan", kind, [(key, block)], settings, to_dict(problem))


def _kind_over(problem: Any, blocks: list[tuple[str, Any]], also: tuple[Any, ...]) -> Kind:
    names = {name for key, block in blocks for name in _inputs(key, block)}
    check_exponent(problem, names)
    return kind_of_problem(problem, names, also)


def _check_own(problem: Any, settings: CaseSettings) -> None:
    """Refuse a problem of user-defined classes without the files that define them."""
    try:
        from_dict(to_dict(problem), settings.nouns, beside=Path)
    except InputError as error:
        parts = (type(part) for part in vars(problem).values())
        own = [
            t.__name__ for t in parts if t.__module__.split(".")[0] not in ("builtins", "viscotack")
        ]
        if not own:
            raise
        raise InputError(
            f"{', '.join(own)} is a user-defined class, which the workers read from its file: give "
            'settings=CaseSettings(own=["FILE.py"]) here and own=["FILE.py"] to run'
        ) from error


def _planned(
    where: str,
    kind: Kind,
    blocks: list[tuple[str, Any]],
    settings: CaseSettings,
    base: dict[str, Any] | None,
    source: str = "",
) -> Plan:
    tally = Tally()
    cases: dict[str, Case] = {}
    for case in _stated(where, kind, blocks, tally):
        tally.stated += 1
        cases.setdefault(case.name, case)
    if not cases:
        raise InputError(
            f"{where}: none of its {tally.rejected} points is a contact, so there is nothing to "
            f"run. The first: {tally.why}"
        )
    return Plan(
        kind=kind,
        cases=tuple(cases.values()),
        settings=settings,
        base=base,
        rejected=tally.rejected,
        repeated=tally.stated - len(cases),
        refusal=tally.why,
        source=source,
    )


def restored_kind(
    name: str, base: dict[str, Any] | None, columns: Iterable[str], also: tuple[Any, ...] = ()
) -> Kind:
    """Return the kind of a stored plan, whose problem uses these user-defined classes."""
    if base is not None:
        return kind_of_problem(from_dict(base, also, beside=Path), set(columns), also)
    if name not in KINDS:
        raise InputError(f"unknown kind of case {name!r}; a newer version may know it")
    return KINDS[name]


def _kind(
    path: Path, tables: Mapping[str, Any], blocks: list[tuple[str, Any]], also: tuple[Any, ...]
) -> tuple[Kind, dict[str, Any] | None]:
    """Return the kind of the cases, and the record of their base problem."""
    if "problem" not in tables:
        if "temperature" in tables:
            raise InputError("temperature goes with problem, whose material it shifts")
        if (name := tables.get("kind", "sphere")) not in KINDS:
            raise InputError(f"kind must be one of {', '.join(KINDS)}, got {name!r}")
        return KINDS[name], None
    if "kind" in tables:
        raise InputError("kind and problem exclude each other; leave one out")
    file, kelvin = path.parent / str(tables["problem"]), None
    if "temperature" in tables:
        with _placed('temperature, such as "20 degC"'):
            kelvin = parse(tables["temperature"], "K")
    if "surface" not in read_toml(file):
        problem = read_case(file, also=also, temperature=kelvin)
    elif kelvin is None:
        problem = read_rough_case(file, also=also)
    else:
        raise InputError("a rough surface states the temperature of its material in its own file")
    return _kind_over(problem, blocks, also), to_dict(problem)


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
        return set(block.names)
    return set(block) - ({"cases", "method", "seed"} if key == "fill" else set())


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


def _stated(where: str, kind: Kind, blocks: list[tuple[str, Any]], tally: Tally) -> Iterator[Case]:
    """Yield the cases of all blocks, in their order."""
    for number, (key, block) in enumerate(blocks, 1):
        place = f"{where}, block {number} ([[{key}]])"
        with _placed(place, str(getattr(block, "path", ""))):
            kind.check(_inputs(key, block))
            for row in _rows(kind, key, block, tally):
                yield Case(run_id(kind.problem(row)), row)


def _rows(kind: Kind, key: str, block: Any, tally: Tally) -> Iterator[dict[str, float]]:
    if key == "list":
        for line, row in block:
            with _placed(f"{block.path}, line {line}"):
                kind.problem(row)
            yield row
        return

    def refusal(row: dict[str, float]) -> str:
        try:
            is_contact = has_relaxed_contact(kind.problem(row))
        except InputError as error:
            if key == "grid":  # its values were chosen, each with all the others
                raise
            return str(error)
        return "" if is_contact else "there is no relaxed contact to begin with"

    values = dict(block)
    if key == "grid":
        yield from accepted(grid(_read(kind, values)), refusal, None, tally)
        return
    cases, method = values.pop("cases", None), values.pop("method", "sobol")
    seed = values.pop("seed", 0)
    if not _is_whole(cases) or cases < 1 or not _is_whole(seed) or seed < 0:
        raise InputError(f"needs cases = a whole number, and perhaps a seed, got {cases!r}, {seed}")
    # The dimensions of the sequence follow the kind, not the order in which a file was written.
    ordered = {n: values[n] for n in [*kind.columns, *kind.choices] if n in values}
    points = fill(_read(kind, ordered), cases=cases, method=method, seed=seed)
    yield from accepted(points, refusal, cases, tally)


def _is_whole(number: Any) -> bool:
    return isinstance(number, int) and not isinstance(number, bool)


def _read(kind: Kind, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return values, lists and ranges with their text as numbers, each within its card's range."""

    def read(name: str, given: Any) -> Any:
        if isinstance(given, Mapping):
            kept = ("count", "weights")
            return {key: v if key in kept else read(name, v) for key, v in given.items()}
        if isinstance(given, list):
            return [read(name, v) for v in given]
        entry = kind.inputs.get(name)
        if isinstance(given, str):
            if not kind.in_si:
                raise InputError(
                    f"{name} must be a number, and without a unit, for cases of kind {kind.name!r} "
                    f"are dimensionless; got {given!r}"
                )
            if entry is not None:
                with _placed(name):
                    given = parse(given, entry.unit)
        is_number = isinstance(given, int | float) and not isinstance(given, bool)
        return entry.card.checked(name, given, entry.unit) if entry and is_number else given

    return {name: read(name, given) for name, given in values.items()}


def _settings(given: Any, changed: Mapping[str, Any]) -> CaseSettings:
    names = [field.name for field in fields(CaseSettings) if field.name != "own"]
    if not isinstance(given, dict) or given.keys() - set(names):
        raise InputError(f"[settings]: may have {', '.join(names)}, got {given!r}")
    values = given | dict(changed)
    with _placed("[settings]"):
        for name, field in cards(CaseSettings).items():
            if name in values:
                with _placed(name):
                    values[name] = parse(values[name], field.card.unit)
        return CaseSettings(**values)
