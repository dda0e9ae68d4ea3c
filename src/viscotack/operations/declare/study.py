"""Study files: an operation with its options in TOML, ``operation = "identify rates"``.

Options of a part are in a separate table; quantities are text with units; file names are relative
to the folder of the study. A table ``[write]`` lists the output files.
"""

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

from viscotack.errors import InputError
from viscotack.files.toml import read_toml, toml_value
from viscotack.files.whole import is_standard_output

from .cards import Naming, Place
from .options import Here, Operation, Option, options, respelled, take

if TYPE_CHECKING:
    from viscotack.files.whole import Target

_OPERATION, _WRITE = "operation", "write"


@dataclass(frozen=True)
class Asked:
    """Content of a study file.

    Attributes
    ----------
    operation : Operation
        The operation with its options.
    write : mapping
        Name of an output -> file.
    """

    operation: Operation
    write: Mapping[str, Path]


def read_study(
    path: str | os.PathLike[str],
    *,
    known: Callable[[str], type[Operation]],
    also: tuple[Any, ...] = (),
    place: Place | None = None,
) -> Asked:
    """Read a study file.

    Parameters
    ----------
    path : path
        The file.
    known : callable
        Returns the class of an operation by name.
    also : tuple of classes
        User-defined classes.
    place : Place, optional
        Origin of the request; default: this machine.

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    InputError
        If it is not TOML or defines no operation. The message contains the file name.
    """
    path = Path(path)
    table = dict(read_toml(path))
    try:
        word = table.pop(_OPERATION, "")
        if not isinstance(word, str) or not word:
            raise InputError('operation is missing; write for example operation = "predict"')
        kind = known(word)
        write = table.pop(_WRITE, {})
        given = _flat(kind, table)
        try:
            operation = take(kind, given, (place or Here(also=also)).within(path))
        except InputError as error:
            raise respelled(error, kind) from None
        return Asked(operation, _files(kind, write, path.parent))
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def _flat(kind: type[Operation], table: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options of a study, including those in the tables of parts."""
    tables = {option.table for option in options(kind)} - {""}
    given: dict[str, Any] = {}
    for name, value in table.items():
        inner = value if name in tables and isinstance(value, Mapping) else {name: value}
        if twice := given.keys() & inner.keys():
            raise InputError(f"{', '.join(sorted(twice))} is given twice")
        given |= inner
    return given


def _files(kind: type[Operation], write: Any, folder: Path) -> dict[str, Path]:
    names = [output.name for output in kind.outputs]
    if not isinstance(write, Mapping) or not all(isinstance(x, str) and x for x in write.values()):
        raise InputError(f"[{_WRITE}] must list file names, such as {names[0] if names else 'csv'}")
    unknown = [name for name in write if name not in names]
    if unknown:
        raise InputError(
            f"{kind.word} has no output {unknown[0]!r:.60}; known are {', '.join(names) or 'none'}"
        )
    # "-" is standard output in every folder
    return {
        name: Path(file) if is_standard_output(file) else folder / file
        for name, file in write.items()
    }


def study_file(operation: Operation, beside: Path = Path()) -> Callable[["Target"], None]:
    """Return a function that writes an operation as a study file."""

    def write(target: "Target") -> None:
        from viscotack.files.whole import write_whole

        inside = isinstance(target, str | os.PathLike) and not is_standard_output(target)
        folder = Path(os.fspath(target)).parent if inside else beside  # type: ignore[arg-type]
        write_whole(target, study_text(operation, folder).encode())

    return write


def study_text(operation: Operation, folder: str | os.PathLike[str] = ".") -> str:
    """Return the text of a study file that defines the operation and is saved in a folder.

    Reading the file gives the same operation. Paths are written relative to the folder, numbers
    with all their digits. Options with default values are left out.
    """
    lines = [f"{_OPERATION} = {toml_value(operation.word)}"]
    tables: dict[str, list[str]] = {}
    for option in options(type(operation)):
        if option.uncertainty:
            continue
        holder = getattr(operation, option.part) if option.part else operation
        value = getattr(holder, option.field)
        if value is None or value == option.default:
            continue
        line = f"{option.name} = {toml_value(_written(option, value, Path(folder)))}"
        (tables.setdefault(option.table, []) if option.table else lines).append(line)
    for name, inner in tables.items():
        lines += ["", f"[{name}]", *inner]
    return "\n".join(lines) + "\n"


def _written(option: Option, value: Any, folder: Path) -> Any:
    if option.many:
        return [_written_one(option, each, folder) for each in value]
    return _written_one(option, value, folder)


def _written_one(option: Option, value: Any, folder: Path) -> Any:
    is_object = isinstance(value, option.card.objects)
    return _relative(value if is_object else option.card.written(value), folder)


def _relative(value: Any, folder: Path) -> Any:
    """Make the paths in a value relative to the folder of the study."""
    if isinstance(value, Mapping):
        return {name: _relative(entry, folder) for name, entry in value.items()}
    if isinstance(value, Naming):
        return f"{value.words}{_relative(value.file, folder)}"
    if isinstance(value, Path):
        return os.path.relpath(value, folder)
    if not isinstance(value, str | Real | list | tuple):
        raise InputError(
            f"a study names files: write the {type(value).__name__} to a file and give its name"
        )
    return value
