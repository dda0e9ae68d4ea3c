"""Layouts of force curves of microscopes and indenters.

- JPK's .jpk-force: an archive of segments, each with text headers and raw numbers. A channel
  consists of integers. An encoder converts them to volts or metres, and a chain of conversions to
  metres and newtons. Newer files store encoders and conversions in one shared header.
- JPK's text: a header in comments above each segment, which names the columns (``# columns:
  vDeflection measuredHeight seriesTime``), their units (``# units: N m s``) and the spring
  constant, then columns of numbers.
- Igor binary waves (.ibw, version 5) of Asylum Research: a fixed header, columns of numbers, a text
  note with the spring constant and the sampling rate, and the names of the columns: deflection and
  height of the sensor, in metres.
- Nanosurf's .nid: a text header with the number of points and the range of numbers of each curve,
  then integers, curve after curve. Points are equidistant in time; the modulation time covers all
  planned points of the forward or the backward curve.
- A LabVIEW program for a MEMS indenter: a line with the name of the routine, a date and headings
  stand above a line ``eoh``. Tests of an array follow each other in blocks, each behind its place
  and a line ``POC``. Numbers have decimal commas. The force is the spring constant, which the file
  does not state, times the displacement.
- What afmformats (extra ``afm``) reads: maps of JPK (.jpk-force-map, .jpk-qi-data), curves of AFM
  Workshop, text of Optics11 Chiaro and NT-MDT, and its own formats (.h5, .tab). Its heights
  increase away from the sample. Text of NT-MDT has columns of numbers alone; it is read if the
  caller names the format and states the spring constant and the sensitivity. afmformats is by Paul
  Müller and others, under the MIT licence: https://afmformats.readthedocs.io.
"""

import logging
import re
import struct
from collections.abc import Callable
from importlib import import_module
from itertools import groupby, zip_longest
from pathlib import PurePath

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import install_command
from viscotack.lab.options import TackOptions
from viscotack.units import parse

from .file import Curve, LabFile, entries, in_sequence, unpacked
from .headings import scale

_INTEGERS = {
    "signedshort": ">i2", "unsignedshort": ">u2", "signedinteger": ">i4", "unsignedinteger": ">u4",
    "signedlong": ">i8",
}  # fmt: skip
_FLOATS = {"float": ">f4", "float-data": ">f4", "double": ">f8", "double-data": ">f8"}
# height of the cantilever's carrier; measured is preferred to commanded
HEIGHTS = ("measuredHeight", "capacitiveSensorHeight", "strainGaugeHeight", "height")
_SEGMENT = re.compile(r"segments/(\d{1,4})/segment-header\.properties")
_FORCE = "conversion-set.conversion.force."
_Words = dict[str, str]


def jpk(file: LabFile, *_: object) -> list[Curve] | None:
    """Return the consecutive segments of a force curve as one curve; None for other files.

    Raises
    ------
    ValueError
        If the archive is damaged, or deflections are not calibrated in newtons.
    """
    if not (file.content.startswith(b"PK\x03\x04") and b"segments/0" in file.content):
        return None
    files = unpacked(file)
    if "data-image.jpk-qi-image" in files or any(part.startswith("index/") for part in files):
        raise file.error("the file is a map of many curves; export one curve per file")
    shared = _properties(files.get("shared-data/header.properties", b""))
    parts: list[list[Array]] = []
    used, stiffness = "", 0.0
    for number in sorted(int(match[1]) for part in files if (match := _SEGMENT.fullmatch(part))):
        folder = f"segments/{number}/"
        own = _properties(files[f"{folder}segment-header.properties"])
        points = int(own["force-segment-header.num-points"])
        if points == 0:
            continue
        present = own.get("channels.list", "").split()
        used = used or next((channel for channel in HEIGHTS if channel in present), "")
        if not used:
            raise file.error(f"no channel of height; the channels are {', '.join(present)}")
        duration = float(own["force-segment-header.duration"])
        numbers, stiffness = [duration * np.arange(1, points + 1) / points], 0.0  # unknown
        for name in ("vDeflection", used):
            # the header of a channel is in that of its segment, or in the shared one
            slot = own.get(f"channel.{name}.lcd-info.*")
            words, before = own, f"channel.{name}."
            if slot is not None:
                words, before = shared, f"lcd-info.{slot}."
            words = {k.removeprefix(before): v for k, v in words.items() if k.startswith(before)}
            # older headers store the encoder below "data"
            older = {k: v for k, v in words.items() if k.startswith("data.enc")}
            words |= {k.removeprefix("data."): v for k, v in older.items()}
            numbers.append(_calibrated(file, name, words, files[f"{folder}channels/{name}.dat"]))
            if words.get(f"{_FORCE}base-calibration-slot") == "distance":
                stiffness = stiffness or abs(float(words[f"{_FORCE}scaling.multiplier"]))
        parts.append(numbers)
    if not parts:
        raise file.error("no segment of a force curve has points")
    # heights increase away from the sample
    return [Curve(*in_sequence(parts), -1, stiffness, (f"height from the channel {used}",))]


def _calibrated(file: LabFile, name: str, words: _Words, content: bytes) -> Array:
    """Return the deflections in newtons, or the heights in metres, of a channel."""
    kind, unit = words.get("encoder.type", ""), "N" if name == "vDeflection" else "m"
    dtype = _INTEGERS.get(kind) or _FLOATS[words.get("type", words.get("data.type", ""))]
    slot = "force" if unit == "N" else words.get("conversion-set.conversions.default", "")
    base = words.get("conversion-set.conversions.base", "")
    steps: list[str] = []
    while slot != base:
        key = f"conversion-set.conversion.{slot}."
        if words.get(f"{key}defined") != "true" or key in steps:
            raise file.error(f"{name} is not calibrated in {unit}; calibrate and save it again")
        steps.insert(0, key)
        slot = words.get(f"{key}base-calibration-slot", "")
    if kind in _INTEGERS:
        steps.insert(0, "encoder.")
    said = words.get(f"{steps[-1] if steps else 'encoder.'}scaling.unit.unit", "")
    if said != unit:
        raise file.error(f"{name} is in {said[:20]!r}; expected {unit}")
    values = np.frombuffer(content, dtype=dtype).astype(float)
    for key in steps:
        if words.get(f"{key}scaling.style", "offsetmultiplier") != "offsetmultiplier":
            raise file.error(f"{key}scaling.style must be offsetmultiplier")
        multiplier = float(words[f"{key}scaling.multiplier"])
        values = float(words[f"{key}scaling.offset"]) + multiplier * values
    return values


def _properties(content: bytes) -> _Words:
    return entries(content.decode("latin-1").splitlines())


_JPK_TEXT_LOOKED = 300  # lines searched for the first header
# positions of the tip, from which the bending of the cantilever is already subtracted
_TIPS = ("verticalTipPosition", "tipSampleSeparation")


def jpk_text(file: LabFile, *_: object) -> list[Curve] | None:
    """Return the consecutive segments of a force curve as one curve; None for other files.

    Raises
    ------
    ValueError
        If a row is damaged, a column is missing, or a force is not in newtons.
    """
    if not any(text.startswith("# columns:") for text in file.lines[:_JPK_TEXT_LOOKED]):
        return None
    # what one header states holds for the next until it is stated again
    words: dict[str, str] = {}
    segments = []
    lines = filter(str.strip, file.lines)
    for above, group in groupby(lines, lambda text: text.startswith("#")):
        if above:
            words |= entries((text.lstrip("# ") for text in group), ":")
            continue
        columns = zip_longest(words["columns"].split(), words.get("units", "").split())
        numbers = np.loadtxt(list(group), ndmin=2).T
        segments.append(dict(zip(columns, numbers, strict=True)))
    if not segments:
        raise file.error("no segment has points below '# columns:' and '# units:'")
    shared = set.intersection(*map(set, segments))
    clock, used = (
        next((each for each in names if (each, unit) in shared), "")
        for names, unit in ((("seriesTime", "time"), "s"), ((*HEIGHTS, *_TIPS), "m"))
    )
    if not (clock and used and ("vDeflection", "N") in shared):
        found = ", ".join(f"{name} [{unit}]" for name, unit in segments[0])
        raise file.error(
            f"each segment needs a calibrated vDeflection [N], a height [m] and seriesTime or time "
            f"[s]; found {found}"
        )
    stiffness = 0.0 if used in _TIPS else float(words["springConstant"])
    wanted = ((clock, "s"), ("vDeflection", "N"), (used, "m"))
    parts = [[segment[column] for column in wanted] for segment in segments]
    # the time of a series, or of each segment from its own start
    series = np.hstack(parts) if clock == "seriesTime" else in_sequence(parts)
    time, force, position = series
    # heights increase away from the sample
    return [Curve(time, force, position, -1, stiffness, (f"position from the column {used}",))]


START = b"\x05\x00"  # version 5, little-endian
_HEAD = struct.Struct("<hHiiii4i4iiii")
_DATA = 384  # bytes of both headers
_TYPES = {2: "<f4", 4: "<f8"}
_LABEL = 32  # bytes
_NOTED = re.compile(r"(?:^|[\r\n])(\w+):\s*([0-9.eE+-]+)")


def ibw(file: LabFile, *_: object) -> list[Curve] | None:
    """Return the force curve of a wave; None for other files.

    Raises
    ------
    ValueError
        If the wave is truncated, of another kind, or not calibrated.
    """
    if not file.content.startswith(START) or file.lines or len(file.content) <= _DATA:
        return None
    content = file.content
    _, _, _, formula, note, units, *sizes = _HEAD.unpack_from(content)[:14]
    points, kind = struct.unpack_from("<ih", content, 64 + 12)
    shape = struct.unpack_from("<2i", content, 64 + 68)
    table = np.frombuffer(content, _TYPES[kind], points, _DATA).astype(float)
    end = _DATA + points * np.dtype(_TYPES[kind]).itemsize
    at = end + formula + note + units + sum(sizes[:5])
    names = content[at : at + sizes[5]]
    if len(names) < sizes[5]:
        raise file.error("the wave is shorter than its header states; the file is truncated")
    rows = iter(table.reshape(shape, order="F").T)
    labels = (names[i : i + _LABEL].split(b"\0")[0] for i in range(_LABEL, len(names), _LABEL))
    columns = dict(zip((label.decode("latin-1") for label in labels), rows, strict=False))
    note = content[end + formula : end + formula + note].decode("latin-1")
    # the first entry counts
    noted = dict(reversed(_NOTED.findall(note)))
    if missing := {"Defl", "ZSnsr"} - columns.keys() or {"SpringConstant"} - noted.keys():
        raise file.error(f"the wave lacks {min(missing)}; calibrate and save the curve again")
    stiffness, rate = float(noted["SpringConstant"]), float(noted["NumPtsPerSec"])
    deflection, height = columns["Defl"], columns["ZSnsr"]
    keep = np.isfinite(deflection) & np.isfinite(height)
    time = np.arange(1, height.size + 1) / rate
    # the sensor value increases when the tip is lowered
    return [Curve(time[keep], stiffness * deflection[keep], height[keep], 1, stiffness)]


MARK = b"[DataSet]"
_END = b"#!"
_CURVE = re.compile(r"DataSet-(\d+):(\d+)")
_NID_UNITS = {"Deflection": "N", "Z-Axis Sensor": "m", "Z-Axis": "m"}
_FRAMES = ("Spec forward", "Spec fwd pause", "Spec backward", "Spec bwd pause")
_Sections = dict[str, dict[str, str]]


def nid(file: LabFile, *_: object) -> list[Curve] | None:
    """Return the forward, pause and backward curves as one curve; None for other files.

    Raises
    ------
    ValueError
        If the header is incomplete, a curve is truncated, or there is no force.
    """
    if not file.content.startswith(MARK):
        return None
    head, end, content = file.content.partition(_END)
    if not end:
        raise file.error("the header has no end; the file is truncated or not a .nid file")
    sections: _Sections = {}
    for section in re.split(rb"^\[", head, flags=re.MULTILINE)[1:]:
        title, lines = section.partition(b"]")[::2]
        sections.setdefault(title.decode("latin-1"), {}).update(_properties(lines))
    channels = _channels(file, sections, content)
    planned = next(
        (x for key, x in sections.items() if key.endswith("Spec") and "Modulation time" in x), None
    )
    if planned is None:
        raise file.error("the header lacks the modulation time and the number of points")
    step = parse(planned["Modulation time"], "s") / int(planned["Data points"])
    parts: list[tuple[Array, ...]] = []
    for frame in _FRAMES:
        one = {channel: values for (where, channel), values in channels.items() if where == frame}
        if not one:
            continue
        deflection, height = one.get("Deflection"), one.get("Z-Axis Sensor", one.get("Z-Axis"))
        if deflection is None or height is None:
            raise file.error(f'the part "{frame}" lacks a deflection in newtons or a height')
        if frame == "Spec backward":
            # stored in the direction of the forward part, like the lines of an image
            deflection, height = deflection[::-1], height[::-1]
        parts.append((step * np.arange(1.0, height.size + 1), deflection, height))
    if not parts:
        raise file.error("the file has no part Spec forward or Spec backward; it may be an image")
    planned_in = f"planned in {planned['Modulation time']}"
    note = f"{planned['Data points']} equidistant points were {planned_in}"
    # direction unknown: when the head is lowered, the numbers rise on some heads and fall on others
    return [Curve(*in_sequence(parts), notes=(note,))]


def _channels(file: LabFile, sections: _Sections, content: bytes) -> dict[tuple[str, str], Array]:
    """Return the spectroscopy curves by part and channel, in SI."""
    found: dict[tuple[str, str], Array] = {}
    at = 0
    for title in filter(_CURVE.fullmatch, sections["DataSet"].values()):
        head = sections[title]
        points, lines, bits = (int(head[key]) for key in ("Points", "Lines", "SaveBits"))
        encoding = head.get("SaveOrder", "Intel"), head.get("SaveSign", "Signed")
        if encoding != ("Intel", "Signed"):
            raise file.error(f"[{title}] has an unsupported encoding ({' '.join(encoding)})")
        count = points * lines
        counts = np.frombuffer(content, f"<i{bits // 8}", count, at) if count else np.empty(0)
        at += counts.nbytes
        frame, channel = head.get("Frame", ""), head.get("Dim2Name", "")
        wanted = channel in _NID_UNITS and head.get("Dim2Unit") == _NID_UNITS[channel]
        if not (frame.startswith("Spec") and count and wanted):
            continue
        if lines > 1:
            raise file.error(f"[{title}] contains {lines} curves; export one curve per file")
        low, span = float(head["Dim2Min"]), float(head["Dim2Range"])
        found[frame, channel] = low + span * (counts.astype(float) / 2.0**bits + 0.5)
    return found


_MEMS_FIRST = "Quasi static measurement routine"
_MEMS_LOOKED = 20  # lines searched for the end of the headings
_COLUMNS = ("Piezo position", "MEMS displ.", "Time")


def mems_text(file: LabFile, given: TackOptions) -> list[Curve] | None:
    """Return the tests of a file; None for other files.

    Raises
    ------
    ValueError
        If the spring constant is not given, or a row is damaged.
    """
    if not file.lines or not file.lines[0].startswith(_MEMS_FIRST):
        return None
    if given.spring_constant is None:
        raise file.error("the file states no stiffness of its spring; set `spring_constant`")
    end = [text.strip() for text in file.lines[:_MEMS_LOOKED]].index("eoh")
    heads = [text for text in file.lines[:end] if text.startswith(_COLUMNS[0])][0].split("\t")
    names, units = zip(*(re.split(r"\s*[\[\]]", f"{head}[]")[:2] for head in heads), strict=True)
    if not set(_COLUMNS) <= set(names):
        raise file.error(f"expected the columns {', '.join(_COLUMNS)} with units")
    places = [names.index(name) for name in _COLUMNS]
    factors = np.array([[scale(units[i], x)] for i, x in zip(places, "mms", strict=True)])
    found = []
    below = file.lines[end + 1 :]
    for whole, lines in groupby(below, lambda text: text.count("\t") == len(heads) - 1):
        if not whole:
            continue
        numbers = [text.replace(",", ".") for text in lines]
        rows = np.loadtxt(numbers, delimiter="\t", usecols=places, ndmin=2)
        piezo, spring, time = factors * rows.T
        notes = ()
        if np.ptp(piezo) < np.ptp(spring):
            # a spring bends no farther than its drive moves
            piezo, time = 1e3 * piezo, 1e3 * time
            notes = ("piezo and time read in um and s: by the headings it moves too little",)
        stiffness = given.spring_constant
        found.append(Curve(time, stiffness * spring, piezo, 1, stiffness, notes))
    if not found:
        raise file.error("no rows of numbers below 'eoh'")
    return found


HDF = b"\x89HDF"  # first bytes of an .h5 file
_ENDINGS = (".jpk-force-map", ".jpk-qi-data", ".h5")
# Endings of files that may be read if the caller names the format. This excludes those of Igor,
# which this package reads: a damaged one takes the memory of the machine in the library.
_ALLOWED = (*_ENDINGS, ".jpk-force", ".tab", ".csv", ".txt", ".tsv")
_AFM_LOOKED = 60  # lines searched for the name of the device
_AFM_FIRST = ("Force-Distance Curve", "# afmformats")  # first lines of AFM Workshop and .tab files


def afm(file: LabFile, given: TackOptions) -> list[Curve] | None:
    """Return every curve of a file; None for other files unless the caller names the format.

    Raises
    ------
    ValueError
        If afmformats is not installed or cannot read the file, or a curve has no force, or has no
        time while no nominal speed was given.
    """
    first = file.lines[0] if file.lines else ""
    known = PurePath(file.path).suffix.casefold() in _ENDINGS or first.startswith(_AFM_FIRST)
    chiaro = any("Device:" in text and "Chiaro" in text for text in file.lines[:_AFM_LOOKED])
    if not (known or chiaro or given.format):
        return None
    if not file.path.casefold().endswith(_ALLOWED):
        raise file.error(f"afmformats reads only files that end with {', '.join(_ALLOWED)}")
    try:
        library = import_module("afmformats")
    except ImportError:
        command = install_command("afm")
        raise file.error(f"this format needs afmformats; install it with: {command}") from None
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
        cure = " (`sensitivity`, `spring_constant`)" if "specify" in str(error) else ""
        raise file.error(f"afmformats cannot read it: {error}{cure}") from None
    # what Chiaro exports as measured is the indentation, zero before contact
    answer = []
    for curve in found:
        measured = not chiaro and "height (measured)" in curve.columns
        used = "height (measured)" if measured else "height (piezo)"
        if not {"force", used} <= {*curve.columns}:
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


# in order of detection
READERS: dict[str, Callable[[LabFile, TackOptions], list[Curve] | None]] = {
    "afmformats": afm,
    "jpk-force": jpk,
    "jpk-text": jpk_text,
    "mems-text": mems_text,
    "nid": nid,
    "ibw": ibw,
}
# first bytes of those that are neither text nor workbooks
RAW = (MARK, START, HDF)
