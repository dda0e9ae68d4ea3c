"""TOML files, with errors that show the line."""

import json
import os
import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from viscotack.errors import InputError

from .text import read_text

# Of a line that is shown.
_SHOWN = 60
# Longest file, and most parts of a dotted name, for which time and memory grow with their square.
_MOST_TEXT, _MOST_PARTS = 10_000_000, 50
_PART = r"""(?:[\w-]+|"[^"\n]*"|'[^'\n]*')"""
_LONG_NAME = re.compile(rf"(?<![\w-]){_PART}(?:[ \t]*\.[ \t]*{_PART}){{{_MOST_PARTS},}}")
# Lines of a file that are looked through for what stands twice.
_LOOKED_THROUGH = 2000
# Characters that may be read on the way: a long array is read once for each of its lines.
_MOST_READ = 2_000_000
_TWICE = ("Cannot overwrite", "Cannot declare", "Cannot mutate", "Duplicate")


def read_toml(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the tables of a TOML file.

    Parameters
    ----------
    path : path
        In UTF-8, with or without a byte-order mark, or in UTF-16 with one.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    InputError
        If it is not TOML: with the line, and a name that stands twice with both lines.
    """
    # a character has four bytes at most
    return parse_toml(read_text(path, most=4 * _MOST_TEXT), path)


def parse_toml(text: str, path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the tables of a text that was read from a file; errors as of `read_toml`."""
    if len(text) > _MOST_TEXT:
        raise InputError(
            f"{os.fspath(path)} has {len(text):,} characters, more than the {_MOST_TEXT:,} that a "
            "TOML file may have here; long tables go into CSV files"
        )
    if found := _LONG_NAME.search(text):
        line = text.count("\n", 0, found.start()) + 1
        raise InputError(
            f"{os.fspath(path)}, line {line}: a name of more than {_MOST_PARTS} parts, "
            f"`{found[0][:_SHOWN]} ...`; write what it leads to as tables"
        )
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        words, number = _place(str(error), text)
    except RecursionError:
        raise InputError(
            f"{os.fspath(path)} has brackets in brackets, more than can be read; nothing here "
            "needs more than a few"
        ) from None
    except ValueError as error:  # a whole number of thousands of digits
        raise InputError(f"{os.fspath(path)} has a number that cannot be read: {error}") from None
    if number <= _LOOKED_THROUGH and words.startswith(_TWICE) and (twice := _twice(text, number)):
        raise InputError(f"{os.fspath(path)}: {twice}; leave out one of them")
    shown = text.split("\n")[number - 1].strip()
    shown = f"{shown[:_SHOWN]} ..." if len(shown) > _SHOWN else shown
    words = words[:1].lower() + words[1:]
    raise InputError(f"{os.fspath(path)} is not a TOML file, line {number}, `{shown}`: {words}")


def toml_value(value: Any) -> str:
    """Return a value as TOML writes it: text, a number, true or false, a list, a table in a line.

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
    """Return an error without its place, and the line."""
    bare, _, place = words.rpartition(" (at ")
    found = re.match(r"line (\d+)", place)
    # otherwise it is the end of the document: the last line with something on it
    return bare, int(found[1]) if found else text.rstrip().count("\n") + 1


@dataclass(frozen=True)
class _Statement:
    """A key with its value, or the header of a table: where it begins, and its full name."""

    line: int
    name: tuple[str, ...]
    table: tuple[str, ...]
    is_header: bool


def _twice(text: str, number: int) -> str:
    """Return words for what the statement on a line says again; none where that is not found."""
    known = list(_statements(text.split("\n")[:number]))
    if not known:
        return ""
    last = known[-1]
    for one in reversed(known[:-1]):
        # a = 1 and a.b = 2 say a twice, while [a] and [a.b] are two tables
        short = None if last.is_header else min(len(one.name), len(last.name))
        if one.is_header != last.is_header or one.name[:short] != last.name[:short]:
            continue
        if last.is_header:
            what = f"the table [{'.'.join(last.name)}] stands twice"
        else:
            inside = f" in [{'.'.join(last.table)}]" if last.table else ""
            what = f"key {'.'.join(last.name[len(last.table) : short])!r} stands twice{inside}"
        return f"{what}, lines {one.line} and {last.line}"
    return ""


def _statements(lines: list[str]) -> Iterator[_Statement]:
    """Yield the statements of a file: the shortest runs of lines that are TOML by themselves."""
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
    """Return the dotted name before the equals sign, none where a name holds such a sign."""
    left = line.partition("=")[0]
    return _path(tomllib.loads(f"{left} = 0")) if _is_toml([f"{left} = 0"]) else ()


def _path(tables: Any) -> tuple[str, ...]:
    """Return the names that lead to the only thing in a table of tables."""
    found: list[str] = []
    while tables and isinstance(tables, dict | list):
        if isinstance(tables, dict):
            found.append(next(iter(tables)))
        tables = tables[found[-1]] if isinstance(tables, dict) else tables[0]
    return tuple(found)
