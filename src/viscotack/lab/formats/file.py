"""Content of a laboratory file: bytes, text, lines, hash and notes."""

import hashlib
import io
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import chain
from os import PathLike, fspath
from typing import Any, NamedTuple, TypeVar
from zipfile import ZipFile

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.files.archive import check_unpacked
from viscotack.files.text import read_bytes

from .headings import recognise

LARGEST, LARGEST_UNPACKED = 50_000_000, 200_000_000  # bytes; sweeps are thousands of times smaller

_MARKS = ((b"\xef\xbb\xbf", "utf-8-sig"), (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"))
# of Chinese, Japanese, Korean and Russian computers; headings are in the first characters
_CODE_PAGES, _HEADED = ("gb18030", "cp932", "cp949", "big5", "cp1251"), 20_000
_POINTER = b"version https://git-lfs.github.com/spec/"
# `str.splitlines` would also split at a dozen characters that exports do not use as line ends.
_LINE_END = re.compile(r"\r\n|\n|\r")


@dataclass(frozen=True)
class LabFile:
    """Content of one file; `lines` is empty for a workbook.

    `rest` is the text after the last line end. It may be truncated and is not read. `format` is the
    name of its layout, once that is known.
    """

    path: str
    content: bytes
    lines: tuple[str, ...]
    notes: tuple[str, ...]
    rest: str = ""
    format: str = ""

    @property
    def sha256(self) -> str:
        """Hash of the bytes, in hexadecimal."""
        return hashlib.sha256(self.content).hexdigest()

    @property
    def is_workbook(self) -> bool:
        """Whether the bytes begin like an Excel file, old (OLE) or new (zip)."""
        return self.content.startswith((b"\xd0\xcf\x11\xe0", b"PK\x03\x04"))

    @property
    def is_record(self) -> bool:
        """Whether the text begins like JSON."""
        return next(filter(None, map(str.strip, chain(self.lines, [self.rest]))), "")[:1] == "{"

    @property
    def left_out(self) -> tuple[str, ...]:
        """Note on a last line without a line end."""
        if not self.rest:
            return ()
        return (
            f"line {len(self.lines) + 1}, the last, has no line end and may be truncated in the "
            f"middle of a number: ignored ({self.rest.strip()[:40]!r}); end the file with a line "
            "end to keep it",
        )

    def error(self, what: str, line: int | None = None) -> InputError:
        """Return an error that names the file and, if given, the line or row."""
        rows = self.is_workbook or self.is_record
        place = "" if line is None else f", {'row' if rows else 'line'} {line}"
        return InputError(f"{self.path}{place}: {what}")


def load(path: str | PathLike[str], *, raw: tuple[bytes, ...] = ()) -> LabFile:
    """Read the bytes and lines of a file.

    Parameters
    ----------
    path : path-like
        Path of the file.
    raw : tuple of bytes
        First bytes of binary formats other than workbooks; such files are not split into lines.

    Raises
    ------
    ValueError
        If the file is empty, larger than 50 MB, or neither text nor a workbook.
    OSError
        If the file cannot be opened.

    Notes
    -----
    A last line without a line end may be truncated in the middle of a number, which cannot be
    detected. It is ignored, and a note states so.
    """
    name = fspath(path)
    content = read_bytes(path, LARGEST)
    file = LabFile(name, content, (), ())
    if not content.strip():
        raise file.error("the file is empty")
    if content.startswith(_POINTER):
        raise file.error("a pointer of Git LFS, not the file itself; fetch it with git lfs pull")
    if file.is_workbook or content.startswith(raw):
        return file
    encoding = next((name for mark, name in _MARKS if content.startswith(mark)), None)
    if encoding is None and b"\0" in content[:200]:
        # UTF-16 without byte order mark: every other byte of Latin text is 0
        encoding = "utf-16-le" if content[1:2] == b"\0" else "utf-16-be"
    if encoding and encoding.startswith("utf-16") and len(content) % 2:
        # an incomplete character at the end: the text before it is complete
        content = content[:-1]
    try:
        text = content.decode(encoding or "utf-8")
    except UnicodeDecodeError as error:
        if encoding is not None:
            raise file.error(
                f"the bytes after {error.start} are not {encoding} text; it is damaged or no table"
            ) from None
        text, encoding = _by_code_page(content)
    if "\0" in text:
        raise file.error("the file is neither text nor an Excel workbook; export it as text")
    *lines, last = _LINE_END.split(text)
    notes = () if encoding is None else (f"text in {encoding}",)
    return replace(file, lines=tuple(lines), notes=notes, rest=last)


def _by_code_page(content: bytes) -> tuple[str, str]:
    """Decode text of an unknown code page: the one in which most headings have a meaning.

    Two letters of Latin text beside each other are rarely both accented, and bytes of other
    alphabets read as Latin letters have no meaning as a heading. Without such a heading the text is
    Latin; old exports encode the degree sign in one byte.
    """

    def known(text: str) -> int:
        cells = re.split(r"[\t;,\r\n]", text[:_HEADED])
        return sum(not cell.isascii() and recognise(cell) is not None for cell in cells)

    found = [(content.decode("latin-1"), "latin-1")]
    for name in _CODE_PAGES:
        with suppress(UnicodeDecodeError):
            found.append((content.decode(name), name))
    return max(found, key=lambda pair: known(pair[0]))


def unpacked(file: LabFile) -> dict[str, bytes]:
    """Return the files in an archive by name; refuse one of more than 200 MB."""
    content = io.BytesIO(file.content)
    try:
        check_unpacked(content, LARGEST_UNPACKED)
        with ZipFile(content) as parts:
            return {part: parts.read(part) for part in parts.namelist()}
    except MemoryError:
        raise
    except Exception as error:
        # The library raises many undocumented errors for damaged archives.
        raise file.error(f"the archive may be truncated or damaged: {error}") from None


Found = TypeVar("Found")


def first_fitting(
    file: LabFile, readers: Mapping[str, Callable[..., Found | None]], said: str | None, *more: Any
) -> tuple[LabFile, Found | None]:
    """Return the file with the format given by the caller, or the first that fits, and its content.

    The content is what the reader of this format returns, None if no format fits. A reader returns
    None for a file of another layout. A damaged header lacks an entry, or has no number there,
    which the reader does not expect.
    """
    for name, reader in readers.items():
        if said not in (None, name):
            continue
        try:
            found = reader(file, *more)
        except InputError:
            raise
        except (LookupError, TypeError, ValueError, AttributeError, RecursionError) as error:
            raise file.error(f"truncated, damaged or no {name} file: {error!r}") from None
        if found is not None:
            return replace(file, format=name), found
    if said is not None:
        raise file.error(f"the file does not have the format {said}; leave out `format`")
    return file, None


def entries(lines: Iterable[str], mark: str = "=") -> dict[str, str]:
    """Return the entries of a header by key, from its lines ``key = value``."""
    parts = (line.partition(mark) for line in lines)
    return {key.strip(): value.strip() for key, found, value in parts if found}


# ---- force curves of microscopes -----------------------------------------------------------------


class Curve(NamedTuple):
    """Numbers of a force curve in SI, as the instrument stored them.

    `into` is 1 if a larger position is deeper in the sample, -1 if it is further away, 0 if
    unknown; `stiffness` is that of the cantilever whose bending the position contains [N/m], or 0.
    """

    time: Array
    force: Array
    position: Array
    into: int = 0
    stiffness: float = 0.0
    notes: tuple[str, ...] = ()


def in_sequence(parts: Iterable[Sequence[Array]]) -> tuple[Array, Array, Array]:
    """Return time, force and position of parts whose time begins with each of them."""
    rows: list[Array] = []
    for time, *numbers in parts:
        begin = rows[-1][0, -1] if rows else 0.0
        rows.append(np.array([begin + time, *numbers]))
    time, force, position = np.hstack(rows)
    return time, force, position
