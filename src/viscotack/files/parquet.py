"""Parquet files, read whole if their bytes have a known hash."""

import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from viscotack.errors import InputError

from .arrow import arrow
from .bounded import LARGEST_PART, read_bytes


def read_parquet(path: Path, sha256: str, columns: Sequence[str] | None = None) -> Any:
    """Return the table of a Parquet file whose bytes have a hash.

    Raises
    ------
    FileNotFoundError
        If it is not there.
    ValueError
        If it is another one, or damaged; with its name.
    """
    try:
        content = read_bytes(path, LARGEST_PART)
    except FileNotFoundError:
        raise
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}") from None
    if hashlib.sha256(content).hexdigest() != sha256:
        raise InputError(
            f"{path} is damaged: it is not what was written, its hash is another; move it away, "
            "and run the campaign again for its cases"
        )
    pa = arrow()
    try:
        file = pa.parquet.ParquetFile(pa.BufferReader(content), page_checksum_verification=True)
        known = file.schema_arrow.names
        wanted = None if columns is None else [name for name in columns if name in known]
        # threads of Arrow that still run when Python ends may abort the process
        return file.read(columns=wanted, use_threads=False)
    except (OSError, MemoryError, pa.ArrowException) as error:
        raise InputError(
            f"{path} is damaged: {error}; move it away, and run the campaign again for its cases"
        ) from None
