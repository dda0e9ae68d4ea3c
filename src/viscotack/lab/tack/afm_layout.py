"""Layouts of atomic force microscopes that are read by afmformats (extra ``afm``).

These are maps of JPK (.jpk-force-map, .jpk-qi-data), curves of AFM Workshop, text of Optics11
Chiaro and NT-MDT, and the formats of afmformats itself (.h5, .tab). Its heights increase away from
the sample. Text of NT-MDT has columns of numbers alone; it is read if the caller names the format
and states the spring constant and the sensitivity. afmformats is by Paul
Müller and others, under the MIT licence: https://afmformats.readthedocs.io.
"""

import io
import logging
import zipfile
from importlib import import_module
from pathlib import PurePath
from typing import Any

import numpy as np

from viscotack.errors import InputError, install_command
from viscotack.lab.lab_file import LabFile, refuse_huge

from .grid import Given, time_by_speed
from .header import bending, recorded
from .record import TackRecord

HDF = b"\x89HDF"  # first bytes of an .h5 file
_ENDINGS = (".jpk-force-map", ".jpk-qi-data", ".h5")
# Endings of files that may be read if the caller names the format. This excludes those of Igor,
# which this package reads: a damaged one takes the memory of the machine in the library.
_ALLOWED = (*_ENDINGS, ".jpk-force", ".tab", ".csv", ".txt", ".tsv")
_LOOKED = 60  # lines searched for the name of the device
_FIRST = ("Force-Distance Curve", "# afmformats")  # first lines of AFM Workshop and .tab files


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None for other files."""
    first = file.lines[0] if file.lines else ""
    known = PurePath(file.path).suffix.casefold() in _ENDINGS or first.startswith(_FIRST)
    return "afmformats" if known or _is_chiaro(file) else None


def _is_chiaro(file: LabFile) -> bool:
    return any("Device:" in text and "Chiaro" in text for text in file.lines[:_LOOKED])


def records(file: LabFile, given: Given) -> list[TackRecord]:
    """Return every curve of a file as a record.

    Raises
    ------
    ValueError
        If afmformats is not installed or cannot read the file, or a curve has no force, or has no
        time while no nominal speed was given.
    """
    if not file.path.casefold().endswith(_ALLOWED):
        raise file.error(
            f"afmformats is used only for files that end with {', '.join(_ALLOWED)}; "
            "leave out --format"
        )
    try:
        library = import_module("afmformats")
    except ImportError:
        raise file.error(
            f"this format needs afmformats; install it with: {install_command('afm')}"
        ) from None
    if file.content.startswith(b"PK"):
        try:
            with zipfile.ZipFile(io.BytesIO(file.content)) as parts:
                refuse_huge(parts)
        except zipfile.BadZipFile as error:
            raise file.error(f"the file is truncated or damaged: {error}") from None
        except InputError as error:
            raise file.error(str(error)) from None
    # afmformats also logs the tracebacks of its errors
    logging.getLogger("afmformats").setLevel(logging.CRITICAL)
    try:
        stated = {"spring constant": given.spring_constant, "sensitivity": given.sensitivity}
        known = {key: value for key, value in stated.items() if value is not None}
        more = {"meta_override": known} if known else {}
        curves = list(library.load_data(file.path, **more))
    except (KeyboardInterrupt, SystemExit, MemoryError):
        raise
    except BaseException as error:
        # its errors do not derive from Exception, and damaged files raise others
        cure = " (--sensitivity, --spring-constant)" if "specify" in str(error) else ""
        raise file.error(f"afmformats cannot read it: {error}{cure}") from None
    return [found for curve in curves for found in _record(file, curve, given)]


def _record(file: LabFile, curve: Any, given: Given) -> list[TackRecord]:
    # what Chiaro exports as measured is the indentation, zero before contact
    measured = not _is_chiaro(file) and "height (measured)" in curve.columns
    used = "height (measured)" if measured else "height (piezo)"
    if not {"force", used} <= set(curve.columns):
        raise file.error(f"curve {curve.enum} has no force and measured height")
    force, height = (np.asarray(curve[key], float) for key in ("force", used))
    notes = [f"curve {curve.enum} of the file, read by afmformats"]
    if "time" in curve.columns:
        time = np.asarray(curve["time"], dtype=float)
    else:
        time = time_by_speed(file, height, given, notes)
    stiffness = float(curve.metadata.get("spring constant", np.nan))
    known = 0 < stiffness < np.inf
    more = {"into": -1, "compliance": 1 / stiffness if known else 0.0}
    notes += [bending(stiffness)] * known
    return recorded(file, "afmformats", notes, (time, force, height), **more)
