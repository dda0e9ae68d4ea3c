"""A laboratory file as bytes, as text and as lines, with its hash and what was noticed about it."""

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import chain
from os import PathLike, fspath
from types import ModuleType
from zipfile import ZipFile

from viscotack.errors import InputError
from viscotack.files.bounded import read_bytes

LARGEST = 50_000_000  # bytes; a sweep is thousands of times smaller

_MARKS = ((b"\xef\xbb\xbf", "utf-8-sig"), (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"))
# `str.splitlines` would also break lines at a dozen characters that no export uses.
_LINE_END = re.compile(r"\r\n|\n|\r")


@dataclass(frozen=True)
class LabFile:
    """The content of one file; `lines` is empty for a workbook.

    `rest` is what follows the last line end, which no line may rely on.
    """

    path: str
    content: bytes
    lines: tuple[str, ...]
    notes: tuple[str, ...]
    rest: str = ""

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
        """What a reader of lines notes about a last line without an end."""
        if not self.rest:
            return ()
        return (
            f"line {len(self.lines) + 1}, the last, has no line end and may be cut in the middle "
            f"of a number: left out ({self.rest.strip()[:40]!r}); end the file with a new line to "
            "keep it",
        )

    def error(self, what: str, line: int | None = None) -> InputError:
        """Return an error that names the file and, where there is one, the line or row."""
        rows = self.is_workbook or self.is_record
        place = "" if line is None else f", {'row' if rows else 'line'} {line}"
        return InputError(f"{self.path}{place}: {what}")


def load(path: str | PathLike[str], *, raw: tuple[bytes, ...] = ()) -> LabFile:
    """Return a file's bytes and lines.

    Parameters
    ----------
    path : path-like
        The file.
    raw : tuple of bytes
        How files begin whose bytes are no text although they are no workbook: without lines.

    Raises
    ------
    ValueError
        If the file is empty, larger than 50 MB, or neither text nor a workbook.
    OSError
        If it cannot be opened.

    Notes
    -----
    A last line without a line end may have been cut in the middle of a number, which nothing in
    it would show. It is left out, and a note says so.
    """
    name = fspath(path)
    content = read_bytes(path, LARGEST)
    empty = LabFile(name, content, (), ())
    if not content.strip():
        raise empty.error("the file is empty")
    if empty.is_workbook or content.startswith(raw):
        return empty
    text, encoding = _decoded(empty)
    if "\0" in text:
        raise empty.error("the file is neither text nor an Excel workbook; export it as text")
    lines = _LINE_END.split(text)
    notes = () if encoding == "utf-8" else (f"text in {encoding}",)
    last = lines.pop()
    return LabFile(name, content, tuple(lines), notes, last)


def _decoded(file: LabFile) -> tuple[str, str]:
    content = file.content
    encoding = next((name for mark, name in _MARKS if content.startswith(mark)), None)
    if encoding is None and b"\0" in content[:200]:
        # text in two bytes per character, without its mark: Latin letters leave every other byte 0
        encoding = "utf-16-le" if content[1:2] == b"\0" else "utf-16-be"
    if encoding and encoding.startswith("utf-16") and len(content) % 2:
        # half a character at the end: what stands before it is whole
        content = content[:-1]
    try:
        return content.decode(encoding or "utf-8"), encoding or "utf-8"
    except UnicodeDecodeError as error:
        if encoding is None:
            # old exports write the degree sign in one byte
            return content.decode("latin-1"), "latin-1"
        raise file.error(
            f"the bytes after {error.start} are not {encoding} text: the file is cut or damaged"
        ) from None


def huge(archive: ZipFile) -> bool:
    """Return whether an archive unpacks to more than 200 MB."""
    return sum(part.file_size for part in archive.infolist()) > 4 * LARGEST


def format_of(
    file: LabFile, formats: Mapping[str, ModuleType], said: str | None, otherwise: str
) -> str:
    """Return the name of the format that was said, or that of the first layout that knows a file.

    `otherwise` is the one whose reader says what it expected.
    """
    found = (layout.name(file) for layout in dict.fromkeys(formats.values()))
    return said or next(filter(None, found), otherwise)


def refuse_unknown(format: str | None, formats: Mapping[str, ModuleType]) -> None:
    """Refuse a format that no layout has."""
    if format is not None and format not in formats:
        raise InputError(f"--format must be one of {', '.join(formats)}, got {format!r}")
