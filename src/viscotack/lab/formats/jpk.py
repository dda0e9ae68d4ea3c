"""Layout of JPK's .jpk-force: an archive of segments, each with text headers and raw numbers.

A channel consists of integers. An encoder converts them to volts or metres, and a chain of
conversions to metres and newtons. Newer files store encoders and conversions in one shared
header.
"""

import re
from dataclasses import dataclass

import numpy as np

from viscotack.arrays import Array

from .file import Curve, LabFile, Words, positive, real, unpacked, whole

_INTEGERS = {
    "signedshort": ">i2",
    "unsignedshort": ">u2",
    "signedinteger": ">i4",
    "unsignedinteger": ">u4",
    "signedlong": ">i8",
}
_FLOATS = {"float": ">f4", "float-data": ">f4", "double": ">f8", "double-data": ">f8"}
# height of the cantilever's carrier; measured is preferred to commanded
HEIGHTS = ("measuredHeight", "capacitiveSensorHeight", "strainGaugeHeight", "height")
_SEGMENT = re.compile(r"segments/(\d{1,4})/segment-header\.properties")


def curves(file: LabFile, *_: object) -> list[Curve] | None:
    """Return the consecutive segments of a force curve as one curve; None for other files.

    Raises
    ------
    ValueError
        If the archive is damaged, or deflections are not calibrated in newtons.
    """
    if not (file.content.startswith(b"PK\x03\x04") and b"segments/0" in file.content):
        return None
    files = unpacked(file)
    numbers = sorted(int(match[1]) for part in files if (match := _SEGMENT.fullmatch(part)))
    if not numbers:
        raise file.error("the archive has no segments of a force curve")
    if "data-image.jpk-qi-image" in files or any(part.startswith("index/") for part in files):
        raise file.error("the file is a map of many curves; export one curve per file")
    shared = _properties(files.get("shared-data/header.properties", b""))
    columns: list[tuple[Array, Array, Array]] = []
    clock, used, stiffness = 0.0, "", 0.0
    for number in numbers:
        folder = f"segments/{number}/"
        segment = _Segment(
            file, files, folder, _properties(files[f"{folder}segment-header.properties"]), shared
        )
        points = whole(file, segment.own, "force-segment-header.num-points")
        if points == 0:
            continue
        force = segment.channel("vDeflection", "N")
        stiffness = segment.stiffness
        used = used or segment.height
        height = segment.channel(used, "m")
        if not force.size == height.size == points:
            raise file.error(f"segment {number} states {points} points but has {force.size}")
        duration = positive(file, segment.own, "force-segment-header.duration")
        columns.append((clock + duration * np.arange(1, points + 1) / points, force, height))
        clock += duration
    if not columns:
        raise file.error("no segment has points")
    time, force, height = map(np.concatenate, zip(*columns, strict=True))
    # heights increase away from the sample
    return [Curve(time, force, height, -1, stiffness, (f"height from the channel {used}",))]


@dataclass(frozen=True)
class _Segment:
    """One segment: the files of the archive, its folder, and its own and the shared header."""

    file: LabFile
    files: dict[str, bytes]
    folder: str
    own: Words
    shared: Words

    @property
    def height(self) -> str:
        """Name of the channel of height to use."""
        present = self.own.get("channels.list", "").split()
        if found := [channel for channel in HEIGHTS if channel in present]:
            return found[0]
        raise self.file.error(
            f"no channel of height; the channels are {', '.join(present) or 'none'}"
        )

    @property
    def stiffness(self) -> float:
        """Stiffness of the cantilever [N/m], 0 if unknown."""
        words = self.header("vDeflection")
        key = "conversion-set.conversion.force."
        if words.get(f"{key}base-calibration-slot") != "distance":
            return 0.0
        return abs(real(self.file, words, f"{key}scaling.multiplier"))

    def header(self, channel: str) -> Words:
        """Return the header entries of one channel, without their prefixes."""
        slot = self.own.get(f"channel.{channel}.lcd-info.*")
        before = f"channel.{channel}." if slot is None else f"lcd-info.{slot}."
        words = self.own if slot is None else self.shared
        found = {k.removeprefix(before): v for k, v in words.items() if k.startswith(before)}
        if not found:
            raise self.file.error(f"the headers have no entry for channel {channel}")
        # older headers store the encoder below "data"
        older = {k.removeprefix("data."): v for k, v in found.items() if k.startswith("data.enc")}
        return found | older

    def channel(self, channel: str, unit: str) -> Array:
        """Return one channel in metres or newtons."""
        file, place = self.file, f"{self.folder}channels/{channel}.dat"
        content = self.files.get(place)
        if content is None:
            raise file.error(f"{self.folder} has no channel {channel}")
        words = self.header(channel)
        kind = words.get("encoder.type", "")
        dtype = _INTEGERS.get(kind) or _FLOATS.get(words.get("type", words.get("data.type", "")))
        if dtype is None:
            raise file.error(f"{channel} is encoded as {kind[:30]!r}, which is not supported")
        if len(content) % np.dtype(dtype).itemsize:
            raise file.error(f"{place} is truncated in the middle of a number")
        slot = "force" if unit == "N" else words.get("conversion-set.conversions.default", "")
        base = words.get("conversion-set.conversions.base", "")
        steps: list[str] = []
        while slot != base:
            key = f"conversion-set.conversion.{slot}."
            if words.get(f"{key}defined") != "true" or key in steps:
                raise file.error(
                    f"{channel} is not calibrated in {unit}; calibrate the cantilever and save it "
                    "again"
                )
            steps.insert(0, key)
            slot = words.get(f"{key}base-calibration-slot", "")
        if kind in _INTEGERS:
            steps.insert(0, "encoder.")
        said = words.get(f"{steps[-1] if steps else 'encoder.'}scaling.unit.unit", "")
        if said != unit:
            raise file.error(f"{channel} is in {said[:20]!r}; expected {unit}")
        values = np.frombuffer(content, dtype=dtype).astype(float)
        for key in steps:
            if words.get(f"{key}scaling.style", "offsetmultiplier") != "offsetmultiplier":
                raise file.error(f"{key}scaling.style must be offsetmultiplier")
            multiplier = real(file, words, f"{key}scaling.multiplier")
            values = real(file, words, f"{key}scaling.offset") + multiplier * values
        return values


def _properties(content: bytes) -> Words:
    pairs = (
        line.partition("=")
        for line in content.decode("latin-1").splitlines()
        if not line.startswith("#") and "=" in line
    )
    return {key.strip(): value.strip() for key, _, value in pairs}
