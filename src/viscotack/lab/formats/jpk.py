"""Layout of JPK's .jpk-force: an archive of segments, each with text headers and raw numbers.

A channel consists of integers. An encoder converts them to volts or metres, and a chain of
conversions to metres and newtons. Newer files store encoders and conversions in one shared
header.
"""

import re
from dataclasses import dataclass

import numpy as np

from viscotack.arrays import Array

from .file import Curve, LabFile, in_sequence, unpacked

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
_Words = dict[str, str]


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
    if "data-image.jpk-qi-image" in files or any(part.startswith("index/") for part in files):
        raise file.error("the file is a map of many curves; export one curve per file")
    shared = _properties(files.get("shared-data/header.properties", b""))
    parts: list[tuple[Array, Array, Array]] = []
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
        force, height = (
            _Channel(file, name, own, shared).numbers(files[f"{folder}channels/{name}.dat"], unit)
            for name, unit in (("vDeflection", "N"), (used, "m"))
        )
        stiffness = _Channel(file, "vDeflection", own, shared).stiffness
        duration = float(own["force-segment-header.duration"])
        parts.append((duration * np.arange(1, points + 1) / points, force, height))
    if not parts:
        raise file.error("no segment of a force curve has points")
    # heights increase away from the sample
    return [Curve(*in_sequence(parts), -1, stiffness, (f"height from the channel {used}",))]


@dataclass(frozen=True)
class _Channel:
    """One channel of a segment, with the segment's own and the shared header."""

    file: LabFile
    name: str
    own: _Words
    shared: _Words

    @property
    def header(self) -> _Words:
        """Header entries of the channel, without their prefixes."""
        slot = self.own.get(f"channel.{self.name}.lcd-info.*")
        before = f"channel.{self.name}." if slot is None else f"lcd-info.{slot}."
        words = self.own if slot is None else self.shared
        found = {k.removeprefix(before): v for k, v in words.items() if k.startswith(before)}
        # older headers store the encoder below "data"
        older = {k.removeprefix("data."): v for k, v in found.items() if k.startswith("data.enc")}
        return found | older

    @property
    def stiffness(self) -> float:
        """Stiffness of the cantilever [N/m], 0 if unknown."""
        key = "conversion-set.conversion.force."
        if self.header.get(f"{key}base-calibration-slot") != "distance":
            return 0.0
        return abs(float(self.header[f"{key}scaling.multiplier"]))

    def numbers(self, content: bytes, unit: str) -> Array:
        """Return the numbers in metres or newtons."""
        words = self.header
        kind = words.get("encoder.type", "")
        dtype = _INTEGERS.get(kind) or _FLOATS[words.get("type", words.get("data.type", ""))]
        slot = "force" if unit == "N" else words.get("conversion-set.conversions.default", "")
        base = words.get("conversion-set.conversions.base", "")
        steps: list[str] = []
        while slot != base:
            key = f"conversion-set.conversion.{slot}."
            if words.get(f"{key}defined") != "true" or key in steps:
                raise self.file.error(
                    f"{self.name} is not calibrated in {unit}; calibrate the cantilever and save "
                    "it again"
                )
            steps.insert(0, key)
            slot = words.get(f"{key}base-calibration-slot", "")
        if kind in _INTEGERS:
            steps.insert(0, "encoder.")
        said = words.get(f"{steps[-1] if steps else 'encoder.'}scaling.unit.unit", "")
        if said != unit:
            raise self.file.error(f"{self.name} is in {said[:20]!r}; expected {unit}")
        values = np.frombuffer(content, dtype=dtype).astype(float)
        for key in steps:
            if words.get(f"{key}scaling.style", "offsetmultiplier") != "offsetmultiplier":
                raise self.file.error(f"{key}scaling.style must be offsetmultiplier")
            multiplier = float(words[f"{key}scaling.multiplier"])
            values = float(words[f"{key}scaling.offset"]) + multiplier * values
        return values


def _properties(content: bytes) -> _Words:
    pairs = (
        line.partition("=")
        for line in content.decode("latin-1").splitlines()
        if not line.startswith("#") and "=" in line
    )
    return {key.strip(): value.strip() for key, _, value in pairs}
