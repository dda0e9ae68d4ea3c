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
from xml.sax.saxutils import quoteattr

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.files.whole import write_whole
from viscotack.version import __version__

from . import reduced
from .reduced import ReducedContact
from .release import CATCH_UP, PAST
from .table import ForceTable

_VARIABLES = (
    # name, unit, causality, description; numbered from 1, 0 is the time
    ("depth", "m", "input", "depth of the indenter, positive into the solid"),
    ("speed", "m/s", "input", "speed of the retraction of the contact, positive"),
    ("force", "N", "output", "force, positive in compression"),
    ("slope", "N/m", "output", "derivative of the force by the depth"),
    ("pull_off_force", "N", "output", "pull-off force at the speed, positive"),
)
# Powers of the SI base units, as FMI states units.
_UNITS = {"m": 'm="1"', "m/s": 'm="1" s="-1"', "N": 'kg="1" m="1" s="-2"', "N/m": 'kg="1" s="-2"'}
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
    return _filled(table, name)


def fmu(table: ForceTable, name: str = "contact", *, compiler: str | None = None) -> bytes:
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
    compiler : str, optional
        C compiler, a command with the options of cc; by default cc, gcc or clang.

    Raises
    ------
    InputError
        If no compiler is found or it fails.
    """
    header = c_header(table, name)
    token = f"{{{sha256(header.encode()).hexdigest()[:32]}}}"
    source = Template(_code("fmu.c")).substitute(name=name, token=token)
    system = next((x for s, x in _SYSTEMS.items() if sys.platform.startswith(s)), None)
    machine = _MACHINES.get(platform.machine().lower())
    if system is None or machine is None:
        raise InputError(f"FMI has no name for this system, {sys.platform}, {platform.machine()}")
    library = _built({f"{name}.h": header, "fmu.c": source}, f"{name}{system[1]}", compiler)
    build = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<fmiBuildDescription fmiVersion="3.0">\n'
        f'  <BuildConfiguration modelIdentifier="{name}">\n'
        '    <SourceFileSet language="C99"><SourceFile name="fmu.c"/></SourceFileSet>\n'
        "  </BuildConfiguration>\n</fmiBuildDescription>\n"
    )
    contents = {
        "modelDescription.xml": _description(table, name, token).encode(),
        f"binaries/{machine}-{system[0]}/{name}{system[1]}": library,
        "sources/buildDescription.xml": build.encode(),
        "sources/fmu.c": source.encode(),
        f"sources/{name}.h": header.encode(),
    }
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content in contents.items():
            archive.writestr(zipfile.ZipInfo(path), content, zipfile.ZIP_DEFLATED)
    return packed.getvalue()


def _code(name: str) -> str:
    return (files(__package__ or "") / "code" / name).read_text(encoding="utf-8")


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
    return Template(_code("reduced_contact.h")).substitute(
        _heading(name, contact.of),
        **{each: _initialiser(getattr(contact, each)) for each in arrays},
        **{each: f"{getattr(contact, each):.17g}" for each in numbers},
        range=contact.range,
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


def _filled(table: ForceTable, name: str) -> str:
    """Return the header with the numbers of a table."""
    return Template(_code("force_table.h")).substitute(
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


def _description(table: ForceTable, name: str, token: str) -> str:
    """Return modelDescription.xml."""
    units = "\n".join(
        f'    <Unit name="{unit}"><BaseUnit {powers}/></Unit>' for unit, powers in _UNITS.items()
    )
    variables = ['    <Float64 name="time" valueReference="0" causality="independent"/>']
    starts = {"depth": table.start_depth, "speed": float(table.speed[0])}
    for number, (word, unit, causality, words) in enumerate(_VARIABLES, 1):
        start = f' start="{starts[word]:.17g}"' if word in starts else ""
        variables.append(
            f'    <Float64 name="{word}" valueReference="{number}" causality="{causality}"'
            f' unit="{unit}" description="{words}"{start}/>'
        )
    outputs = "\n".join(
        f'    <{tag} valueReference="{number}" dependencies="{"2" if number == 5 else "1 2"}"/>'
        for tag in ("Output", "InitialUnknown")
        for number in (3, 4, 5)
    )
    step = 'canHandleVariableCommunicationStepSize="true"'
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="{name}" instantiationToken="{token}"
  description={quoteattr(table.of)} generationTool="viscotack {__version__}">
  <CoSimulation modelIdentifier="{name}" {step}/>
  <UnitDefinitions>
{units}
  </UnitDefinitions>
  <LogCategories><Category name="logStatusError"/></LogCategories>
  <ModelVariables>
{chr(10).join(variables)}
  </ModelVariables>
  <ModelStructure>
{outputs}
  </ModelStructure>
</fmiModelDescription>
"""


def _built(sources: dict[str, str], library: str, compiler: str | None) -> bytes:
    """Compile sources to a shared library and return it."""
    found = [compiler] if compiler else ["cc", "gcc", "clang"]
    command = next((path for each in found if (path := shutil.which(each))), None)
    if command is None:
        raise InputError(
            f"an FMU needs a C compiler, and {' or '.join(found)} was not found; install one, or "
            "write the C header"
        )
    with tempfile.TemporaryDirectory() as folder:
        for name, text in sources.items():
            write_whole(Path(folder) / name, text.encode())
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
