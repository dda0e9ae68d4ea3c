"""The authors' public archive: <https://github.com/alimaghamii/ML4Adh>, MIT licence.

Give a checkout of it by ``--archive PATH``. The rows that chapter 5 learned from are
``Data_Files/aug_comb_1to9.csv``, with the descriptor as the authors computed it; those before it
was added, and 85 that it lacks, ``Data_Files/comb_1to9.csv``. Nothing of it is stored here but a
sample (tests/data/README.md) and these checksums.
"""

import hashlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from viscotack import InputError

from .table import Array

# SHA-256 of files of the archive's commit be1b880 of 14 July 2025.
CHECKSUMS = {
    "aug_comb_1to9.csv": "8dc3baed1feb90ff002c869f0e3653366a862c12e4f0af2b0e589c4788c765cb",
    "comb_1to9.csv": "05420a545be203539c413e8dcc5628e086ffda6e6faa9bac69741f557fa6e550",
}


@dataclass(frozen=True, eq=False)
class Learned:
    """The rows that chapter 5 learned from, in the authors' order and units.

    Inputs are log10 rate, log10 depth, Tabor number, log10 modulus ratio, exponent; the descriptor
    is not a logarithm; force [1.5 pi R dg0] and work [pi R dg0 h0] are log10.
    """

    inputs: Array
    descriptor: Array
    force: Array
    work: Array

    def features(self, *, descriptor: bool) -> Array:
        """Return the inputs, with the descriptor beside them or not."""
        return np.column_stack([self.inputs, self.descriptor]) if descriptor else self.inputs


def file_of(archive: Path, name: str) -> Path:
    """Return a file of the archive; refused if it is not the one that was measured here."""
    path = archive / "Data_Files" / name
    if not path.is_file():
        raise InputError(f"{archive} has no Data_Files/{name}; give a checkout of the archive")
    if hashlib.sha256(path.read_bytes()).hexdigest() != CHECKSUMS[name]:
        raise InputError(f"{path} is not the file of the archive's commit be1b880")
    return path


def learned(archive: Path) -> Learned:
    """Return the rows that chapter 5 learned from."""
    found = np.genfromtxt(file_of(archive, "aug_comb_1to9.csv"), delimiter=",", names=True)
    logs = {name: np.log10(np.abs(found[name])) for name in ("runload", "alphaload", "k")}
    inputs = [logs["runload"], logs["alphaload"], found["mu"], logs["k"], found["n"]]
    force, work = (np.log10(np.abs(found[x])) for x in ("outputAmplification", "workofSepration"))
    return Learned(np.column_stack(inputs), found["PB"], force, work)
