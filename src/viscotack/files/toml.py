"""TOML files; error messages contain the line."""

import json
import os
import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from viscotack.errors import InputError

from .text import read_text

# Characters of a line that an error message shows.
_SHOWN = 60
# Longest file, and most parts of a dotted name: parsing takes time and memory quadratic in both.
_MOST_TEXT, _MOST_PARTS = 1_500_000, 50
_PART = r"""(?:[\w-]+|"[^"\n]*"|'[^'\n]*')"""
_LONG_NAME = re.compile(rf"(?<![\w-]){_PART}(?:[ \t]*\.[ \t]*{_PART}){{{_MOST_PARTS},}}")
# Number of lines that are searched for a duplicate key.
_LOOKED_THROUGH = 2000
# Characters that may be read on the way: a long array is read once for each of its lines.
_MOST_READ = 2_000_000
_TWICE = ("Cannot overwrite", "Cannot declare", "Cannot mutate", "Duplicate")


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
        If it is not TOML. The message contains the line, for a duplicate key both lines.
    """
    # a character has four bytes at most
    return parse_toml(read_text(path, most=4 * _MOST_TEXT), path)


def parse_toml(text: str, path: str | os.PathLike[str]) -> dict[str, Any]:
    """Parse the text of a TOML file; errors as for `read_toml`."""
    if len(text) > _MOST_TEXT:
        raise InputError(
            f"{os.fspath(path)} has {len(text):,} characters, more than the limit of "
            f"{_MOST_TEXT:,}; move long tables into CSV files"
        )
    if found := _LONG_NAME.search(text):
        line = text.count("\n", 0, found.start()) + 1
        raise InputError(
            f"{os.fspath(path)}, line {line}: dotted key of more than {_MOST_PARTS} parts, "
            f"`{found[0][:_SHOWN]} ...`; write it as tables"
        )
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        words, number = _place(str(error), text)
    except RecursionError:
        raise InputError(f"{os.fspath(path)} has too many nested brackets") from None
    except ValueError as error:  # an integer of thousands of digits
        raise InputError(f"{os.fspath(path)}: invalid number: {error}") from None
    if number <= _LOOKED_THROUGH and words.startswith(_TWICE) and (twice := _twice(text, number)):
        raise InputError(f"{os.fspath(path)}: {twice}; remove one of them")
    shown = text.split("\n")[number - 1].strip()
    shown = f"{shown[:_SHOWN]} ..." if len(shown) > _SHOWN else shown
    words = words[:1].lower() + words[1:]
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


@dataclass(frozen=True)
class _Statement:
    """A key with its value, or a table header: its first line and its full name."""

    line: int
    name: tuple[str, ...]
    table: tuple[str, ...]
    is_header: bool


def _twice(text: str, number: int) -> str:
    """Describe the duplicate that a statement on a line causes; "" if none is found."""
    known = list(_statements(text.split("\n")[:number]))
    if not known:
        return ""
    last = known[-1]
    for one in reversed(known[:-1]):
        # a = 1 and a.b = 2 define a twice, while [a] and [a.b] are two tables
        short = None if last.is_header else min(len(one.name), len(last.name))
        if one.is_header != last.is_header or one.name[:short] != last.name[:short]:
            continue
        if last.is_header:
            what = f"duplicate table [{'.'.join(last.name)}]"
        else:
            inside = f" in [{'.'.join(last.table)}]" if last.table else ""
            what = f"duplicate key {'.'.join(last.name[len(last.table) : short])!r}{inside}"
        return f"{what}, lines {one.line} and {last.line}"
    return ""


def _statements(lines: list[str]) -> Iterator[_Statement]:
    """Yield the statements of a file: the shortest sequences of lines that are valid TOML."""
    begin, table = 0, ()
    left = _MOST_READ
    while begin < len(lines):
        end, size = begin, 0
        while end == begin or not _is_toml(lines[begin:end]):
            if end == len(lines) or left < 0:
                return
            size += len(lines[end]) + 1
            left -= size
            end += 1
        head = lines[begin].strip()
        if head.startswith("["):
            table = _path(tomllib.loads(head))
            yield _Statement(begin + 1, table, table, is_header=True)
        elif head and not head.startswith("#") and (key := _key(head)):
            yield _Statement(begin + 1, (*table, *key), table, is_header=False)
        begin = end


def _is_toml(lines: list[str]) -> bool:
    try:
        tomllib.loads("\n".join(lines))
    except tomllib.TOMLDecodeError:
        return False
    return True


def _key(line: str) -> tuple[str, ...]:
    """Return the dotted name before the equals sign; () if the name contains an equals sign."""
    left = line.partition("=")[0]
    return _path(tomllib.loads(f"{left} = 0")) if _is_toml([f"{left} = 0"]) else ()


def _path(tables: Any) -> tuple[str, ...]:
    """Return the keys that lead to the only entry of nested tables."""
    found: list[str] = []
    while tables and isinstance(tables, dict | list):
        if isinstance(tables, dict):
            found.append(next(iter(tables)))
        tables = tables[found[-1]] if isinstance(tables, dict) else tables[0]
    return tuple(found)
