"""Study files: a request in TOML, ``operation = "identify rates"`` and its options.

Quantities are text with units; file names are relative to the folder of the study. A table
``[write]`` lists the output files.
"""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from viscotack.errors import InputError
from viscotack.files.toml import read_toml, toml_value
from viscotack.files.whole import is_standard_output

from . import operation
from .options import Named, Number, option_of
from .request import Request, options, request_of

_OPERATION, _WRITE = "operation", "write"


@dataclass(frozen=True)
class Study:
    """Content of a study file.

    Attributes
    ----------
    request : Request
        The request.
    write : mapping
        Name of an output -> file.
    """

    request: Request
    write: Mapping[str, Path]


def read_study(path: str | os.PathLike[str], *words: str) -> Study:
    """Read a study file.

    Parameters
    ----------
    path : path
        The file.
    *words : str
        Operations of which it must have one; none for any.

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    InputError
        If it is not TOML or states no valid request. The message contains the file name.
    """
    path = Path(path)
    table = dict(read_toml(path))
    try:
        found = table.pop(_OPERATION, "")
        if not isinstance(found, str) or not found:
            raise InputError('operation is missing; write for example operation = "predict"')
        if words and found not in words:
            raise InputError(
                f"its operation is {found}; this needs a study of {' or '.join(words)}"
            )
        kind = operation(found)
        write = table.pop(_WRITE, {})
        return Study(request_of(kind, table), _files(kind, write, path.parent))
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def _files(kind: type[Request], write: Any, folder: Path) -> dict[str, Path]:
    names = [output.name for output in kind.outputs]
    if not isinstance(write, Mapping) or not all(isinstance(x, str) and x for x in write.values()):
        raise InputError(f"[{_WRITE}] must list file names, such as {names[0] if names else 'csv'}")
    if unknown := [name for name in write if name not in names]:
        raise InputError(
            f"{kind.word} has no output {unknown[0]!r:.60}; known are {', '.join(names) or 'none'}"
        )
    # "-" is standard output in every folder
    return {
        name: Path(file) if is_standard_output(file) else folder / file
        for name, file in write.items()
    }


def study_text(request: Request, folder: Path = Path()) -> str:
    """Return the text of a study file of a request; reading it gives the same request.

    Paths are written relative to the folder of the file, numbers with all their digits. Options
    with their default values are left out.
    """
    from viscotack.model.materials.library import MATERIALS

    lines = [f"{_OPERATION} = {toml_value(request.word)}"]
    for name, info in options(type(request)).items():
        value, option = getattr(request, name), option_of(info)
        if value == info.default:
            continue
        if isinstance(option, Number) and option.unit != "1":
            value = _each(value, lambda x, unit=option.unit: f"{float(x)!r} {unit}")
        elif isinstance(option, Named) and isinstance(value, str) and value not in MATERIALS:
            value = value if value.lstrip().startswith("[") else os.path.relpath(value, folder)
        else:
            value = _each(value, lambda x: os.path.relpath(x, folder) if isinstance(x, Path) else x)
        if not isinstance(value, str | float | int | list):
            raise InputError(
                f"a study names files: write the {type(value).__name__} to a file and give its name"
            )
        lines.append(f"{name} = {toml_value(value)}")
    return "\n".join(lines) + "\n"


def _each(value: Any, convert: Any) -> Any:
    return [convert(x) for x in value] if isinstance(value, list | tuple) else convert(value)
