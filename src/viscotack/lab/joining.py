"""Join several files into the sweeps of one material; read temperatures from file names."""

import hashlib
import re
from collections.abc import Sequence
from pathlib import PurePath

import numpy as np

from viscotack.errors import InputError

from .formats.file import LabFile
from .formats.headings import in_kelvin
from .sweeps import FrequencySweeps, Source

_IN_NAME = re.compile(
    r"(?<![0-9.A-SU-Za-su-z])(?P<number>[+-]?[0-9]+(?:\.[0-9]+)?) ?(?P<unit>degC|°C|C|K)"
    r"(?![A-Za-z0-9])"
)
_HYPHEN = re.compile(r"[A-Za-z0-9](-[0-9.]+ ?(?:degC|°C|C|K))(?![A-Za-z0-9])")


def joined(parts: Sequence[FrequencySweeps]) -> FrequencySweeps:
    """Join the sweeps of several files into one set, with consecutive sweep numbers.

    Raises
    ------
    ValueError
        If some files are tensile and others shear, or two files are identical.

    Notes
    -----
    The source names all files; its hash is the hash of the files' hashes in this order, and each
    of these is noted.
    """
    if len(parts) == 1:
        return parts[0]
    if len({part.kind for part in parts}) > 1:
        raise InputError(
            "some files are tensile (E), others shear (G); read them separately, or set --kind"
        )
    return numbered_on(parts, joined_source([part.source for part in parts]))


def numbered_on(parts: Sequence[FrequencySweeps], source: Source) -> FrequencySweeps:
    """Join sweeps of one kind into one set, with consecutive sweep numbers."""
    numbers, count = [], 0
    for part in parts:
        own, renumbered = np.unique(part.sweep, return_inverse=True)
        numbers.append(renumbered + count)
        count += own.size
    names = ("temperature", "angular_frequency", "storage", "loss")
    return FrequencySweeps(
        **{name: np.concatenate([getattr(part, name) for part in parts]) for name in names},
        kind=parts[0].kind,
        sweep=np.concatenate(numbers),
        source=source,
    )


def joined_source(sources: Sequence[Source]) -> Source:
    """Join several files into one source of one material, with the notes of each."""
    hashes = [source.sha256 for source in sources]
    for i, digest in enumerate(hashes):
        if digest and digest in hashes[:i]:
            twin = sources[hashes.index(digest)].path
            raise InputError(f"{sources[i].path} is the same file as {twin}; omit one of them")
    notes = [f"{len(sources)} files joined as one material"]
    notes += [f"{source.path}: sha256 {source.sha256}" for source in sources]
    notes += [f"{source.path}: {note}" for source in sources for note in source.notes]
    return Source(
        path=", ".join(source.path for source in sources),
        sha256=hashlib.sha256("".join(hashes).encode()).hexdigest(),
        format=", ".join(dict.fromkeys(source.format for source in sources)),
        notes=tuple(notes),
    )


def kelvins_in_name(path: str) -> set[float]:
    """Return the temperatures in the name of a file [K].

    Examples
    --------
    >>> kelvins_in_name("probe_300K_2.csv"), kelvins_in_name("probe_2.csv")
    ({300.0}, set())
    """
    found = _IN_NAME.finditer(PurePath(path).stem)
    return {in_kelvin(float(one["number"]), one["unit"]) for one in found}


def kelvin_in_name(file: LabFile) -> float:
    """Return the single temperature in the name of a file [K].

    Examples
    --------
    >>> round(kelvin_in_name(LabFile("data/foam_dma_-25C.csv", b"", (), ())), 2)
    248.15
    """
    stem = PurePath(file.path).stem
    if match := _HYPHEN.search(stem):
        raise file.error(
            f"{match[1]!r} in the file name has a minus sign or a hyphen; write '_' for a hyphen"
        )
    found = kelvins_in_name(file.path)
    if len(found) != 1 or min(found) <= 0:
        raise file.error(
            f"--temperature-in-name needs one temperature such as '25C', found {len(found)}"
        )
    return found.pop()
