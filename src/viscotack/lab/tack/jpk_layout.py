"""Layout of JPK's .jpk-force: an archive of segments, each with text headers and raw numbers.

A channel consists of integers. An encoder converts them to volts or metres, and a chain of
conversions to metres and newtons. Newer files store encoders and conversions in one shared
header.
"""

import io
import re
import zipfile

import numpy as np

from viscotack.arrays import Array
from viscotack.errors import InputError
from viscotack.lab.lab_file import LabFile, refuse_huge

from .header import Words, bending, real, recorded, whole
from .record import TackRecord

_TYPES = {
    "signedshort": ">i2",
    "unsignedshort": ">u2",
    "signedinteger": ">i4",
    "unsignedinteger": ">u4",
    "signedlong": ">i8",
}
_PLAIN = {"float": ">f4", "float-data": ">f4", "double": ">f8", "double-data": ">f8"}
# height of the cantilever's carrier; measured is preferred to commanded
HEIGHTS = ("measuredHeight", "capacitiveSensorHeight", "strainGaugeHeight", "height")
_SEGMENT = re.compile(r"segments/(\d{1,4})/segment-header\.properties")
_MOST = 64  # segments


def name(file: LabFile) -> str | None:
    """Return the name of the format, or None for other files."""
    packed = file.content.startswith(b"PK\x03\x04") and b"segments/0" in file.content
    return "jpk-force" if packed else None


def records(file: LabFile) -> list[TackRecord]:
    """Return the consecutive segments of a force curve as one record.

    Raises
    ------
    ValueError
        If the archive is damaged, or deflections are not calibrated in newtons.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(file.content)) as parts:
            refuse_huge(parts)
            files = {part: parts.read(part) for part in parts.namelist()}
    except InputError as error:
        raise file.error(str(error)) from None
    except MemoryError:
        raise
    except Exception as error:
        # The library raises many undocumented errors for damaged archives.
        raise file.error(
            f"the archive cannot be read; it may be truncated or damaged: {error}"
        ) from None
    numbers = sorted(int(match[1]) for part in files if (match := _SEGMENT.fullmatch(part)))
    if not numbers or len(numbers) > _MOST:
        raise file.error(f"expected 1 to {_MOST} segments of one force curve, got {len(numbers)}")
    if "data-image.jpk-qi-image" in files or any(part.startswith("index/") for part in files):
        raise file.error("the file is a map of many curves; export one curve per file")
    shared = _properties(files.get("shared-data/header.properties", b""))
    columns: list[list[Array]] = [[], [], []]
    clock, used, stiffness = 0.0, "", 0.0
    for number in numbers:
        folder = f"segments/{number}/"
        own = _properties(files[folder + "segment-header.properties"])
        points = whole(file, own, "force-segment-header.num-points")
        if points == 0:
            continue
        deflection, stiffness = _deflection(file, files, folder, own, shared)
        used = used or _height(file, own)
        height = _channel(file, files, folder, own, shared, used, "m")
        if not deflection.size == height.size == points:
            raise file.error(f"segment {number} states {points} points but has {deflection.size}")
        duration = real(file, own, "force-segment-header.duration")
        if not duration > 0:
            raise file.error(
                f"the duration of segment {number} must be positive, got {duration:g} s"
            )
        columns[0].append(clock + duration * np.arange(1, points + 1) / points)
        columns[1].append(deflection)
        columns[2].append(height)
        clock += duration
    if not columns[0]:
        raise file.error("no segment has points")
    notes = (f"height from the channel {used}",)
    if stiffness:
        notes += (bending(stiffness),)
    return recorded(
        file,
        "jpk-force",
        notes,
        map(np.concatenate, columns),
        into=-1,  # heights increase away from the sample
        compliance=1 / stiffness if stiffness else 0.0,
    )


def _deflection(
    file: LabFile, files: dict[str, bytes], folder: str, own: Words, shared: Words
) -> tuple[Array, float]:
    """Return the force [N] and the stiffness of the cantilever [N/m], 0 if unknown."""
    force = _channel(file, files, folder, own, shared, "vDeflection", "N")
    words = _of_channel(file, own, shared, "vDeflection")
    key = "conversion-set.conversion.force."
    based = words.get(key + "base-calibration-slot") == "distance"
    stiffness = abs(real(file, words, key + "scaling.multiplier")) if based else 0.0
    return force, stiffness


def _height(file: LabFile, own: Words) -> str:
    present = own.get("channels.list", "").split()
    for channel in HEIGHTS:
        if channel in present:
            return channel
    raise file.error(f"no channel of height; the channels are {', '.join(present) or 'none'}")


def _of_channel(file: LabFile, own: Words, shared: Words, channel: str) -> Words:
    """Return the header entries of one channel, without their prefixes."""
    slot = own.get(f"channel.{channel}.lcd-info.*")
    before = f"channel.{channel}." if slot is None else f"lcd-info.{slot}."
    words = own if slot is None else shared
    found = {k.removeprefix(before): v for k, v in words.items() if k.startswith(before)}
    # older headers store the encoder below "data"
    found |= {k.removeprefix("data."): v for k, v in found.items() if k.startswith("data.encoder")}
    if not found:
        raise file.error(f"the headers have no entry for channel {channel}")
    return found


def _channel(
    file: LabFile,
    files: dict[str, bytes],
    folder: str,
    own: Words,
    shared: Words,
    channel: str,
    unit: str,
) -> Array:
    """Return one channel of one segment in metres or newtons."""
    content = files.get(f"{folder}channels/{channel}.dat")
    if content is None:
        raise file.error(f"{folder} has no channel {channel}")
    words = _of_channel(file, own, shared, channel)
    kind = words.get("encoder.type", "")
    dtype = _TYPES.get(kind) or _PLAIN.get(words.get("type", words.get("data.type", "")))
    if dtype is None:
        raise file.error(f"{channel} is encoded as {kind[:30]!r}, which is not supported")
    if len(content) % np.dtype(dtype).itemsize:
        raise file.error(f"{folder}channels/{channel}.dat is truncated in the middle of a number")
    values = np.frombuffer(content, dtype=dtype).astype(float)
    if kind in _TYPES:
        values = _scaled(file, words, "encoder.", values)
    slot = "force" if unit == "N" else words.get("conversion-set.conversions.default", "")
    base = words.get("conversion-set.conversions.base", "")
    chain: list[str] = []
    while slot != base:
        key = f"conversion-set.conversion.{slot}."
        if words.get(key + "defined") != "true" or slot in chain:
            raise file.error(
                f"{channel} is not calibrated in {unit} (no conversion {slot!r}); calibrate the "
                "cantilever and save the curve again"
            )
        chain.append(slot)
        slot = words.get(key + "base-calibration-slot", "")
    for slot in reversed(chain):
        values = _scaled(file, words, f"conversion-set.conversion.{slot}.", values)
    ends_in = f"conversion-set.conversion.{chain[0]}." if chain else "encoder."
    said = words.get(ends_in + "scaling.unit.unit", "")
    if said != unit:
        raise file.error(f"{channel} is in {said[:20]!r}; expected {unit}")
    return values


def _scaled(file: LabFile, words: Words, key: str, values: Array) -> Array:
    if words.get(key + "scaling.style", "offsetmultiplier") != "offsetmultiplier":
        raise file.error(f"{key}scaling.style must be offsetmultiplier")
    offset = real(file, words, key + "scaling.offset")
    return offset + real(file, words, key + "scaling.multiplier") * values


def _properties(content: bytes) -> Words:
    found: Words = {}
    for line in content.decode("latin-1").splitlines():
        if not line.startswith("#") and "=" in line:
            key, _, value = line.partition("=")
            found[key.strip()] = value.strip()
    return found
