"""A force table as C source and as an FMU, and a reduced contact as C source."""

from __future__ import annotations

import io
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from hashlib import sha256
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.version import __version__

from . import reduced
from .reduced import ReducedContact
from .release import CATCH_UP, PAST
from .table import ForceTable

_SYSTEMS = {"linux": ("linux", ".so"), "darwin": ("darwin", ".dylib"), "win32": ("windows", ".dll")}
_MACHINES = {"amd64": "x86_64", "x86_64": "x86_64", "arm64": "aarch64", "aarch64": "aarch64"}


def c_header(table: ForceTable, name: str = "contact") -> str:
    """Return C source: force, pull-off force and the controller, in one header of C99.

    Parameters
    ----------
    table : ForceTable
        The contact.
    name : str
        Prefix of its functions, a name in C.

    Returns
    -------
    str
        The header. It needs math.h alone, and gives the digits of the table and of `Release` to
        round-off.

    Raises
    ------
    InputError
        If the prefix is no name in C.
    """
    return _filled(
        "force_table.h",
        _heading(name, table.of),
        error=f"{table.error:.2g}",
        speeds=len(table.speed),
        shares=len(table.share),
        peak=int(np.searchsorted(table.share, 1.0)),
        past=PAST,
        catch_up=CATCH_UP,
        start_depth=f"{table.start_depth:.17g}",
        speed=_initialiser(table.speed),
        travel=_initialiser(table.travel),
        share=_initialiser(table.share),
        force=_initialiser(table.force),
    )


def fmu(table: ForceTable, name: str = "contact") -> bytes:
    """Return an FMU for co-simulation, FMI 3.0: the archive with source and a library for here.

    Inputs are depth and speed, outputs force, slope and pull-off force; they do not depend on the
    time. The library is built for the system and processor of this machine; the sources are inside,
    so that a tool can build it for others.

    Parameters
    ----------
    table : ForceTable
        The contact.
    name : str
        Name of the model, a name in C.

    Raises
    ------
    InputError
        If no C compiler (cc, gcc or clang) is found or it fails.
    """
    header = c_header(table, name)
    system = next((x for s, x in _SYSTEMS.items() if sys.platform.startswith(s)), None)
    machine = _MACHINES.get(platform.machine().lower())
    if system is None or machine is None:
        raise InputError(f"FMI has no name for this system, {sys.platform}, {platform.machine()}")
    numbers = {
        "name": name,
        "token": f"{{{sha256(header.encode()).hexdigest()[:32]}}}",
        "version": __version__,
        "of": quoteattr(table.of),
        "start_depth": f"{table.start_depth:.17g}",
        "speed": f"{table.speed[0]:.17g}",
    }
    source = _filled("fmu.c", numbers)
    contents = {
        "modelDescription.xml": _filled("modelDescription.xml", numbers),
        f"binaries/{machine}-{system[0]}/{name}{system[1]}": _built(
            {f"{name}.h": header, "fmu.c": source}, f"{name}{system[1]}"
        ),
        "sources/buildDescription.xml": _filled("buildDescription.xml", numbers),
        "sources/fmu.c": source,
        f"sources/{name}.h": header,
    }
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content in contents.items():
            archive.writestr(zipfile.ZipInfo(path), content, zipfile.ZIP_DEFLATED)
    return packed.getvalue()


def reduced_header(contact: ReducedContact, name: str = "contact") -> str:
    """Return C source of a reduced contact, in one header of C99 that needs math.h alone.

    Parameters
    ----------
    contact : ReducedContact
        The contact.
    name : str
        Its type in C, and prefix of its functions.

    Returns
    -------
    str
        The header. Its steps are those of the Python class to round-off.

    Raises
    ------
    InputError
        If the name is no name in C.
    """
    arrays = ("node", "modulus", "relaxation_time", "first", "per", "energy", "zone_time")
    numbers = ("surface", "length", "force_unit", "radius_unit")
    return _filled(
        "reduced_contact.h",
        _heading(name, contact.of),
        **{each: _initialiser(getattr(contact, each)) for each in arrays},
        **{each: f"{getattr(contact, each):.17g}" for each in numbers},
        range=contact.range,
        fastest="HUGE_VAL" if np.isinf(contact.fastest) else f"{contact.fastest:.17g}",
        force_band=" to ".join(f"{x:.2g}" for x in contact.force_band),
        work_band=" to ".join(f"{x:.2g}" for x in contact.work_band),
        cells=contact.node.size - 1,
        modes=contact.modulus.size,
        rows=contact.energy.shape[1],
        start=reduced.FIRST,
        small=reduced.SMALL,
        gone=reduced.GONE,
        rest=reduced.REST,
        against=reduced.AGAINST,
        series=reduced.SERIES,
        doublings=reduced.DOUBLINGS,
        halvings=reduced.HALVINGS,
    )


def _filled(name: str, words: dict[str, str], **more: Any) -> str:
    """Return a file of the folder `code` with its words filled in."""
    text = (files(__package__ or "") / "code" / name).read_text(encoding="utf-8")
    return Template(text).substitute(words, **more)


def _heading(name: str, of: str) -> dict[str, str]:
    """Return name, guard, version and content of a header; refuse what is no name in C."""
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,30}", name):
        raise InputError(
            f"{name!r:.40} cannot be the name of a function: take letters, digits and _, a letter "
            "first, at most 31"
        )
    printed = re.sub(r"[^ -~]|\*/", " ", of)
    return {"name": name, "guard": name.upper(), "version": __version__, "of": printed}


def _initialiser(values: Array) -> str:
    """Return the rows of an array as initialisers of C, 17 digits each."""
    if values.ndim > 1:
        return ",\n    ".join(f"{{{_initialiser(row)}}}" for row in values)
    return ",\n    ".join(
        ", ".join(f"{x:.17g}" for x in values[i : i + 4]) for i in range(0, len(values), 4)
    )


def _built(sources: dict[str, str], library: str) -> bytes:
    """Compile sources to a shared library and return it."""
    command = next((path for x in ("cc", "gcc", "clang") if (path := shutil.which(x))), None)
    if command is None:
        raise InputError(
            "an FMU needs a C compiler, and cc, gcc or clang was not found; install one, or write "
            "the C header"
        )
    with tempfile.TemporaryDirectory() as folder:
        for name, text in sources.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        options = "-std=c99 -O2 -shared -fPIC -fvisibility=hidden -ffp-contract=off".split()
        done = subprocess.run(
            [command, *options, "fmu.c", "-o", library, "-lm"],
            cwd=folder,
            capture_output=True,
            text=True,
            errors="replace",
            check=False,
        )
        if done.returncode:
            raise InputError(f"the C compiler {command} failed: {done.stderr.strip()[-400:]}")
        return (Path(folder) / library).read_bytes()
