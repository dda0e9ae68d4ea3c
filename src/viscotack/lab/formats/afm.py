"""Layouts of atomic force microscopes that are read by afmformats (extra ``afm``).

These are maps of JPK (.jpk-force-map, .jpk-qi-data), curves of AFM Workshop, text of Optics11
Chiaro and NT-MDT, and the formats of afmformats itself (.h5, .tab). Its heights increase away from
the sample. Text of NT-MDT has columns of numbers alone; it is read if the caller names the format
and states the spring constant and the sensitivity. afmformats is by Paul
Müller and others, under the MIT licence: https://afmformats.readthedocs.io.
"""

import logging
from importlib import import_module
from pathlib import PurePath

import numpy as np

from viscotack.errors import install_command
from viscotack.lab.options import TackOptions

from .file import Curve, LabFile, unpacked

HDF = b"\x89HDF"  # first bytes of an .h5 file
_ENDINGS = (".jpk-force-map", ".jpk-qi-data", ".h5")
# Endings of files that may be read if the caller names the format. This excludes those of Igor,
# which this package reads: a damaged one takes the memory of the machine in the library.
_ALLOWED = (*_ENDINGS, ".jpk-force", ".tab", ".csv", ".txt", ".tsv")
_LOOKED = 60  # lines searched for the name of the device
_FIRST = ("Force-Distance Curve", "# afmformats")  # first lines of AFM Workshop and .tab files


def curves(file: LabFile, given: TackOptions) -> list[Curve] | None:
    """Return every curve of a file; None for other files unless the caller names the format.

    Raises
    ------
    ValueError
        If afmformats is not installed or cannot read the file, or a curve has no force, or has no
        time while no nominal speed was given.
    """
    first = file.lines[0] if file.lines else ""
    known = PurePath(file.path).suffix.casefold() in _ENDINGS or first.startswith(_FIRST)
    chiaro = any("Device:" in text and "Chiaro" in text for text in file.lines[:_LOOKED])
    if not (known or chiaro or given.format):
        return None
    if not file.path.casefold().endswith(_ALLOWED):
        raise file.error(f"afmformats reads only files that end with {', '.join(_ALLOWED)}")
    try:
        library = import_module("afmformats")
    except ImportError:
        raise file.error(
            f"this format needs afmformats; install it with: {install_command('afm')}"
        ) from None
    if file.content.startswith(b"PK"):
        unpacked(file)
    # afmformats also logs the tracebacks of its errors
    logging.getLogger("afmformats").setLevel(logging.CRITICAL)
    stated = {"spring constant": given.spring_constant, "sensitivity": given.sensitivity}
    known = {key: value for key, value in stated.items() if value is not None}
    try:
        found = list(library.load_data(file.path, **({"meta_override": known} if known else {})))
    except (KeyboardInterrupt, SystemExit, MemoryError):
        raise
    except BaseException as error:
        # its errors do not derive from Exception, and damaged files raise others
        cure = " (--sensitivity, --spring-constant)" if "specify" in str(error) else ""
        raise file.error(f"afmformats cannot read it: {error}{cure}") from None
    # what Chiaro exports as measured is the indentation, zero before contact
    answer = []
    for curve in found:
        measured = not chiaro and "height (measured)" in curve.columns
        used = "height (measured)" if measured else "height (piezo)"
        if not {"force", used} <= set(curve.columns):
            raise file.error(f"curve {curve.enum} has no force and measured height")
        force, height = (np.asarray(curve[key], float) for key in ("force", used))
        notes = [f"curve {curve.enum} of the file, read by afmformats"]
        if "time" in curve.columns:
            time = np.asarray(curve["time"], dtype=float)
        else:
            time = given.time_of(file, height, notes)
        stiffness = float(curve.metadata.get("spring constant", np.nan))
        stiffness = stiffness if 0 < stiffness < np.inf else 0.0
        answer.append(Curve(time, force, height, -1, stiffness, tuple(notes)))
    return answer
