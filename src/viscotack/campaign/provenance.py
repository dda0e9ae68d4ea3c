"""provenance.json: settings and history of a campaign, with a hash that detects edits."""

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from viscotack.errors import InputError
from viscotack.files.whole import write_whole

FORMAT, FORMAT_VERSION = "viscotack campaign", 2
# Longest file that is read [bytes]: a million cases in a thousand parts have a tenth of it.
_LONGEST = 50e6


def read_provenance(folder: Path) -> dict[str, Any]:
    """Return the provenance of a folder.

    Raises
    ------
    FileNotFoundError
        If there is no such folder.
    ValueError
        If it holds no campaign, a damaged or edited one, or one of a newer version.
    """
    path = folder / "provenance.json"
    if not folder.is_dir():
        raise FileNotFoundError(2, "No such folder", str(folder))
    if not path.exists():
        raise InputError(f"{folder} holds no campaign: it has no provenance.json")
    try:
        if path.stat().st_size > _LONGEST:
            raise InputError("it is far too long")
        found = json.loads(path.read_text(encoding="utf-8"))
        if found["format"] != FORMAT:
            raise InputError("it is of another kind")
        version = found["format_version"]
        is_newer = version > FORMAT_VERSION
        if version != FORMAT_VERSION and not is_newer:
            raise InputError(f"there is no version {version!r}")
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise InputError(f"{path} is damaged: {error}") from None
    if is_newer:
        raise InputError(f"{folder} was written by a newer version of viscotack; update viscotack")
    if found.pop("seal", None) != seal(found):
        raise InputError(
            f"{path} was edited or damaged since viscotack wrote it: its seal does not fit. What "
            "is in it is not changed by hand: put it back as it was, or give another --out"
        )
    return found


def write_provenance(folder: Path, content: Mapping[str, Any]) -> None:
    """Write the provenance of a folder with its seal."""
    sealed = {**content, "seal": seal(content)}
    write_whole(folder / "provenance.json", (json.dumps(sealed, indent=2) + "\n").encode())


def seal(content: Mapping[str, Any]) -> str:
    """Return the hash of the content, in a fixed order."""
    text = json.dumps(content, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()
