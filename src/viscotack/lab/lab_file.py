"""Content of a laboratory file: bytes, text, lines, hash and notes."""

import hashlib
import re
import shlex
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from itertools import chain
from os import PathLike, fspath
from types import ModuleType
from zipfile import ZipFile

from viscotack.errors import InputError
from viscotack.files.bounded import check_lines, read_bytes

from .quantities import recognise

LARGEST = 50_000_000  # bytes; sweeps are thousands of times smaller
# Most cells of a text, as many as of a workbook, and its longest line [bytes].
MOST_CELLS, LONGEST_LINE = 5_000_000, 100_000

_MARKS = ((b"\xef\xbb\xbf", "utf-8-sig"), (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"))
# of Chinese, Japanese, Korean and Russian computers; headings are in the first characters
_CODE_PAGES, _HEADED = ("gb18030", "cp932", "cp949", "big5", "cp1251"), 20_000
_POINTER = b"version https://git-lfs.github.com/spec/"
# `str.splitlines` would also split at a dozen characters that exports do not use as line ends.
_LINE_END = re.compile(r"\r\n|\n|\r")


@dataclass(frozen=True)
class LabFile:
    """Content of one file; `lines` is empty for a workbook.

    `rest` is the text after the last line end. It may be truncated and is not read.
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

    def command(self, flags: str) -> str:
        """Return an example of a command that reads the file with further options."""
        name = shlex.quote(self.path)
        return f"for example: viscotack material fit {name} --poisson-ratio 0.5 {flags}"


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
        If the file is empty, larger than 50 MB, has more than 5 million cells or a line of more
        than 100 kB, or is neither text nor a workbook.
    OSError
        If the file cannot be opened.

    Notes
    -----
    A last line without a line end may be truncated in the middle of a number, which cannot be
    detected. It is ignored, and a note states so.
    """
    name = fspath(path)
    content = read_bytes(path, LARGEST)
    empty = LabFile(name, content, (), ())
    if not content.strip():
        raise empty.error("the file is empty")
    if content.startswith(_POINTER):
        raise empty.error("a pointer of Git LFS, not the file itself; fetch it with git lfs pull")
    if empty.is_workbook or content.startswith(raw):
        return empty
    _check_cells(empty)
    text, encoding = _decoded(empty)
    if "\0" in text:
        raise empty.error("the file is neither text nor an Excel workbook; export it as text")
    lines = _LINE_END.split(text)
    notes = () if encoding == "utf-8" else (f"text in {encoding}",)
    last = lines.pop()
    return LabFile(name, content, tuple(lines), notes, last)


def _check_cells(file: LabFile) -> None:
    """Refuse a text that is far larger as a table than as a file."""
    start = file.content[:100].lstrip(b"\xef\xbb\xbf\xff\xfe\0 \t\r\n")
    if not start.startswith(b"{"):  # JSON may have one line
        check_lines(file.path, file.content, LONGEST_LINE)
    # the brackets are those of JSON
    count = sum(map(file.content.count, (b",", b";", b"\t", b"\n", b"\r", b"[", b"{")))
    if count > MOST_CELLS:
        raise file.error(
            f"the file has {count:,} cells, more than the limit of {MOST_CELLS:,}; export the "
            "relevant part"
        )


def _decoded(file: LabFile) -> tuple[str, str]:
    content = file.content
    encoding = next((name for mark, name in _MARKS if content.startswith(mark)), None)
    if encoding is None and b"\0" in content[:200]:
        # UTF-16 without byte order mark: every other byte of Latin text is 0
        encoding = "utf-16-le" if content[1:2] == b"\0" else "utf-16-be"
    if encoding and encoding.startswith("utf-16") and len(content) % 2:
        # an incomplete character at the end: the text before it is complete
        content = content[:-1]
    try:
        return content.decode(encoding or "utf-8"), encoding or "utf-8"
    except UnicodeDecodeError as error:
        if encoding is None:
            return _by_code_page(content)
        raise file.error(
            f"the bytes after {error.start} are not {encoding} text; the file is truncated or "
            "damaged"
        ) from None


def _by_code_page(content: bytes) -> tuple[str, str]:
    """Decode text of an unknown code page: the one in which most headings have a meaning.

    Two letters of Latin text beside each other are rarely both accented, and bytes of other
    alphabets read as Latin letters have no meaning as a heading. Without such a heading the text is
    Latin; old exports encode the degree sign in one byte.
    """
    found = [(content.decode("latin-1"), "latin-1")]
    for name in _CODE_PAGES:
        with suppress(UnicodeDecodeError):
            found.append((content.decode(name), name))
    return max(found, key=lambda pair: _known_words(pair[0]))


def _known_words(text: str) -> int:
    cells = re.split(r"[\t;,\r\n]", text[:_HEADED])
    return sum(not cell.isascii() and recognise(cell) is not None for cell in cells)


def refuse_huge(archive: ZipFile) -> None:
    """Raise an error if an archive unpacks to more than 200 MB."""
    if sum(part.file_size for part in archive.infolist()) > 4 * LARGEST:
        raise InputError("it unpacks to more than 200 MB")


def format_of(
    file: LabFile, formats: Mapping[str, ModuleType], said: str | None, otherwise: str
) -> str:
    """Return the format given by the caller, or the first layout that recognises the file.

    `otherwise` is the format whose reader raises the error for unrecognised files.
    """
    found = (layout.name(file) for layout in dict.fromkeys(formats.values()))
    return said or next(filter(None, found), otherwise)


def refuse_unknown(format: str | None, formats: Mapping[str, ModuleType]) -> None:
    """Raise an error for an unknown format."""
    if format is not None and format not in formats:
        raise InputError(f"--format must be one of {', '.join(formats)}, got {format!r}")
