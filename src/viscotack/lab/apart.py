"""Files of instruments read in a child process with limits, unless they are small text."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from os import PathLike
from pathlib import Path
from typing import Any
from zipfile import BadZipFile, ZipFile

from viscotack.files.bounded import open_regular
from viscotack.pool.apart import Apart, Exceeded

from .workbook_bounds import is_small

AnyPath = str | PathLike[str]
Reader = Callable[..., Any]

# Text up to this size is read in the process: it does not expand, and takes less than 100 MB.
SMALL = 1_000_000
_LOOKED = 4096
_MARKS = (b"\xff\xfe", b"\xfe\xff")  # of text in UTF-16, which contains zero bytes
# Limits of the child: for a small file, and per byte of the files.
_MEMORY, _MEMORY_PER_BYTE = 150e6, 20.0
_SECONDS, _SECONDS_PER_BYTE = 60.0, 4e-6


@contextmanager
def limited() -> Iterator[Callable[..., Any]]:
    r"""Yield a function that calls a reader of files with limits.

    It takes the reader, the paths and keyword arguments of the reader. Small text and
    small workbooks are read in this process, which takes no time to start. Other files are read in
    a child process, because the memory that a library takes for a workbook, an archive or a binary
    file does not follow from the size of the file. They may take 150 MB and 20 times their size,
    and 60 s and 4 s/MB.

    Examples
    --------
    >>> from viscotack.lab import read_shifts
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder, limited() as call:
    ...     file = Path(folder, "shifts.csv")
    ...     _ = file.write_text("T,log_aT\nC,-\n20,0\n0,2.1\n")
    ...     found = call(read_shifts, file)
    >>> found.log10_shift.tolist()
    [2.1, 0.0]
    """
    with Apart() as child:

        def call(read: Reader, paths: AnyPath | Sequence[AnyPath], **more: Any) -> Any:
            files = [paths] if isinstance(paths, str | PathLike) else list(paths)
            size = sum(Path(file).stat().st_size for file in files)
            # afmformats reads some text, too
            if size <= SMALL and more.get("format") != "afmformats" and all(map(_is_safe, files)):
                return read(paths, **more)
            limits = {
                "seconds": _SECONDS + _SECONDS_PER_BYTE * size,
                "memory": _MEMORY + _MEMORY_PER_BYTE * size,
            }
            try:
                return child.call(read, paths, **limits, **more)
            except Exceeded as error:
                raise Exceeded(f"{', '.join(str(file) for file in files)}: {error}") from None

        yield call


def _is_safe(file: AnyPath) -> bool:
    """Whether a file is text by its first bytes, which no library reads, or a small workbook."""
    with open_regular(file) as stream:
        first = stream.read(_LOOKED)
        if first.startswith(_MARKS) or b"\0" not in first:
            return True
        with suppress(BadZipFile), ZipFile(stream) as archive:
            return is_small(archive, Path(file).stat().st_size)
    return False
