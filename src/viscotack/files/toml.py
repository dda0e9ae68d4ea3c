"""TOML files; error messages contain the line."""

import json
import os
import re
import tomllib
from typing import Any

from viscotack.errors import InputError

from .text import read_text

# Characters of a line that an error message shows.
_SHOWN = 60
# Largest file [bytes].
_MOST = 6_000_000
_TWICE = ("cannot overwrite", "cannot declare", "cannot mutate")


def read_toml(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Read the tables of a TOML file.

    Parameters
    ----------
    path : path
        File in UTF-8, with or without byte-order mark, or in UTF-16 with one.

    Raises
    ------
    FileNotFoundError
        If the file does not exist.
    InputError
        If it is not TOML. The message contains the line.
    """
    return parse_toml(read_text(path, most=_MOST), path)


def parse_toml(text: str, path: str | os.PathLike[str]) -> dict[str, Any]:
    """Parse the text of a TOML file; errors as for `read_toml`."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        words, number = _place(str(error), text)
    except (ValueError, RecursionError) as error:  # an integer or brackets of thousands of digits
        raise InputError(f"{os.fspath(path)}: {error}") from None
    shown = text.split("\n")[number - 1].strip()
    shown = f"{shown[:_SHOWN]} ..." if len(shown) > _SHOWN else shown
    words = words[:1].lower() + words[1:]
    if words.startswith(_TWICE):
        words = "this key or table is there already; remove one of them"
    if "\\" in shown and '"' in shown:
        words += "; write a path with / or in single quotes, 'C:\\lab\\pdms.toml'"
    raise InputError(f"{os.fspath(path)} is not a TOML file, line {number}, `{shown}`: {words}")


def toml_value(value: Any) -> str:
    """Format a value as TOML: text, number, boolean, list or inline table.

    Examples
    --------
    >>> toml_value(["5 MPa", 0.5])
    '["5 MPa", 0.5]'
    """
    if isinstance(value, list | tuple) and value and isinstance(value[0], list | tuple):
        return "[\n" + "".join(f"    {toml_value(row)},\n" for row in value) + "]"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(toml_value(entry) for entry in value) + "]"
    if isinstance(value, dict):
        entries = (f"{toml_value(str(key))} = {toml_value(entry)}" for key, entry in value.items())
        return "{" + ", ".join(entries) + "}"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return str(value).lower() if isinstance(value, bool) else repr(value)


def _place(words: str, text: str) -> tuple[str, int]:
    """Split an error message of the parser into the message and the line number."""
    bare, _, place = words.rpartition(" (at ")
    found = re.match(r"line (\d+)", place)
    # otherwise the end of the document: the last line that is not empty
    return bare, int(found[1]) if found else text.rstrip().count("\n") + 1
