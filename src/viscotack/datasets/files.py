"""Read a dataset, after its checksum has been compared."""

import hashlib
import json
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from viscotack.errors import InputError, NotInstalled, install_command
from viscotack.files.frame import arrow
from viscotack.version import __version__

NAMES = (
    "thesis",
    "broad",
    "chosen",
    "steep",
    "fast",
    "fresh",
    "unseen",
    "hard",
    "solids",
    "rough",
    "deep",
    "sharp",
    "punch",
    "punch_limits",
    "punch_starts",
    "punch_faces",
)
_HERE = Path(__file__).parent
# Of the files of the distribution viscotack-data, in the format of `sha256sum`: data of another
# version, or damaged ones, are refused.
_CHECKSUMS = _HERE / "SHA256SUMS"
# The data of a checkout, which need no installation.
_CHECKOUT = _HERE.parents[2] / "data"
_DISTRIBUTION, _PACKAGE = f"viscotack-data=={__version__}", "viscotack_data"
# The key of the metadata of a Parquet file that holds what is said of the set as a whole.
METADATA_KEY = b"viscotack dataset"


def path(name: str) -> Path:
    """Return the Parquet file of a set.

    Parameters
    ----------
    name : str
        One of ``datasets.NAMES``.

    Returns
    -------
    Path
        Path of the file; it may be absent.

    Raises
    ------
    InputError
        If there is no set of that name.
    NotInstalled
        Without the distribution ``viscotack-data``, outside a checkout.

    Examples
    --------
    >>> path("broad").name
    'broad.parquet'
    """
    file = f"{_known(name)}.parquet"  # an unknown name is rejected first
    return _folder() / file


def plan_path(name: str) -> Path:
    """Return the plan of a set, for ``viscotack campaign``.

    Parameters
    ----------
    name : str
        One of ``datasets.NAMES``.

    Returns
    -------
    Path
        Path of the TOML file.

    Raises
    ------
    InputError
        If there is no set of that name.
    NotInstalled
        Without the distribution ``viscotack-data``, outside a checkout.

    Examples
    --------
    >>> plan_path("broad").name
    'broad.toml'
    """
    file = f"{_known(name)}.toml"
    return _folder() / "plans" / file


def load(name: str) -> Any:
    """Return a set as a ``pyarrow.Table``, a row per case in the order of its plan.

    Columns, units and errors: docs/datasets.md. ``.to_pandas()`` where pandas is installed.

    Parameters
    ----------
    name : str
        One of ``datasets.NAMES``. ``thesis``: 8,505 spheres distributed as in Table A.1 of Maghami,
        PhD thesis (2025). ``broad``: 20,000 spheres that fill a far wider range evenly. ``chosen``:
        2,000 spheres of that range where models trained on these two agreed least; ``steep``: those
        where errors of a later one reached furthest. ``fast``: 4,096 spheres retracted so fast that
        nothing relaxes, over the same Tabor numbers, modulus ratios and depths. ``fresh``: 1,119
        spheres that no network learned from, evenly in that range, on its faces and in boxes;
        ``unseen``: others of these designs, on which nothing was measured. ``hard``: those of an
        adversary that looked for the furthest out of their intervals. ``solids``: spheres on as
        many random linear solids; ``rough``: others, simulated less finely, to learn from.
        ``deep`` and ``sharp``: spheres on power laws and on random solids, pulled from deep starts
        about as fast as the bulk relaxes.
        ``punch``: 2,000 flat punches on a layer. ``punch_limits``: such punches on elastic layers,
        and retracted so fast that nothing relaxes. ``punch_starts``: such punches from starts of
        any stress. ``punch_faces``: such at the ends of the range.

    Returns
    -------
    pyarrow.Table
        One row per case; units and descriptions of the columns: :func:`metadata`.

    Raises
    ------
    InputError
        If there is no set of that name, or its file is not the one that was published.
    NotInstalled
        Without pyarrow; without the distribution ``viscotack-data``, outside a checkout.

    Examples
    --------
    >>> table = load("thesis")
    >>> table.num_rows
    8505
    """
    content = _checked(name)
    pa = arrow("the datasets are stored")
    return pa.parquet.ParquetFile(pa.BufferReader(content)).read(use_threads=False)


def metadata(name: str) -> dict[str, Any]:
    """Read the metadata of a data set: units, errors, plan, licence, versions.

    Parameters
    ----------
    name : str
        One of ``datasets.NAMES``.

    Returns
    -------
    dict
        Units, errors, plan, licence and versions of the set.

    Raises
    ------
    InputError
        If there is no set of that name, or its file is not the one that was published.
    NotInstalled
        Without pyarrow; without the distribution ``viscotack-data``, outside a checkout.

    Examples
    --------
    >>> metadata("thesis")["licence"]
    'CC BY 4.0'
    """
    content = _checked(name)
    pa = arrow("the datasets are stored")
    schema = pa.parquet.read_schema(pa.BufferReader(content))
    return json.loads(schema.metadata[METADATA_KEY])


def checksum(content: bytes) -> str:
    """Return the SHA-256 of a file's content, in hexadecimal digits.

    Examples
    --------
    >>> checksum(b"")[:16]
    'e3b0c44298fc1c14'
    """
    return hashlib.sha256(content).hexdigest()


def _folder() -> Path:
    """Folder of the files: that of the checkout, or of the installed distribution."""
    checkout = _CHECKOUT / _PACKAGE
    if checkout.is_dir():
        return checkout
    found = find_spec(_PACKAGE)
    if found is None or found.origin is None:
        raise NotInstalled(
            f"the datasets are in the distribution {_DISTRIBUTION}, which is not installed; "
            f"install it with: {install_command('data')}, or from a checkout with "
            "pip install ./data"
        )
    return Path(found.origin).parent


def _known(name: str) -> str:
    if name not in NAMES:
        raise InputError(f"there is no dataset {name!r}; there are {', '.join(NAMES)}")
    return name


def _checked(name: str) -> bytes:
    file = path(name)
    expected = _checksums()[file.name]
    content = file.read_bytes()
    if checksum(content) != expected:
        raise InputError(
            f"{file} is damaged or of another version: its SHA-256 is {checksum(content)}, that of "
            f"{_DISTRIBUTION} is {expected}; install it with "
            f"pip install --force-reinstall '{_DISTRIBUTION}'"
        )
    return content


def _checksums() -> dict[str, str]:
    lines = _CHECKSUMS.read_text(encoding="utf-8").splitlines()
    return {file: digest for digest, file in (line.split() for line in lines)}
