"""Small files of tack tests in the layouts of rigs and microscopes, all of one invented test.

A sphere of 5 mm on rubber by JKR: approach, dwell, retraction, then free of contact. Layouts follow
the instruments' exports; names and numbers are made up.
"""

import io
import struct
import zipfile
from dataclasses import dataclass

import numpy as np

from viscotack.theory import jkr

SPHERE = {"radius": 5e-3, "contact_modulus": 1e6, "work_of_adhesion": 0.152}
SPEED, APPROACH_SPEED, DWELL = 20e-6, 50e-6, 10.0
FAR, DEEP = 200e-6, 20e-6  # where approach and retraction begin and end


@dataclass(frozen=True)
class Test:
    """What a rig would write: compression positive, depth positive into the solid."""

    time: np.ndarray
    force: np.ndarray
    drive: np.ndarray
    contact_radius: np.ndarray
    parts: tuple[int, ...]


def made(noise=0.0, zero=0.0, drift=0.0, tilt=0.0, compliance=0.0, sphere=SPHERE, seed=0):
    """Return approach, dwell and retraction of an elastic sphere, with the faults of a rig."""
    leaves = jkr.instability(**sphere).depth
    down = np.linspace(-FAR, DEEP, 500)
    up = np.linspace(DEEP, -FAR, 700)
    radius = [
        np.array([_radius(d, sphere, 0.0) for d in down]),
        np.full(60, _radius(DEEP, sphere, 0.0)),
        np.array([_radius(d, sphere, leaves) for d in up]),
    ]
    depth = np.concatenate([down, np.full(60, DEEP), up])
    a = np.concatenate(radius)
    force = np.where(a > 0, jkr.force(a, **sphere), 0.0)
    drive = depth + compliance * force
    way = np.abs(np.diff(drive, prepend=drive[0]))
    step = np.concatenate([way[:500] / APPROACH_SPEED, np.full(60, DWELL / 60), way[560:] / SPEED])
    time = np.cumsum(step)
    rng = np.random.default_rng(seed)
    force = force + zero + drift * time + tilt * drive + noise * rng.standard_normal(time.size)
    return Test(time, force, drive, a, (500, 560, 1260))


def _radius(depth, sphere, first):
    """Return the contact radius at a depth; on the way in contact begins at depth 0."""
    return jkr.contact_radius_at_depth(depth, **sphere) if depth > first else 0.0


def text(headings, columns, above=(), separator=",", decimal=".", units=None, encoding="utf-8"):
    lines = [*above, separator.join(headings)]
    lines += [] if units is None else [separator.join(units)]
    for row in zip(*columns, strict=True):
        lines.append(separator.join(f"{x:.7g}" for x in row).replace(".", decimal))
    return ("\r\n".join(lines) + "\r\n").encode(encoding)


def plain(test):
    return text(
        ["Time [s]", "Depth [um]", "Force [mN]"],
        [test.time, 1e6 * test.drive, 1e3 * test.force],
    )


def with_camera(test):
    return text(
        ["Time [s]", "Depth [um]", "Force [mN]", "Contact radius [um]"],
        [test.time, 1e6 * test.drive, 1e3 * test.force, 1e6 * test.contact_radius],
    )


def anton_paar(test):
    """One file for each interval: numbers, newtons, a gap in millimetres."""
    edges = (0, *test.parts)
    files = []
    for begin, end in zip(edges, edges[1:], strict=False):
        part = slice(begin, end)
        files.append(
            text(
                ["Point No.", "Normal Force [N]", "Gap [mm]", "Time [s]"],
                [
                    np.arange(1.0, end - begin + 1),
                    test.force[part],
                    3 - 1e3 * test.drive[part],
                    test.time[part],
                ],
            )
        )
    return files


def bluehill(test):
    """A block of parameters, quoted headings and units; tension is positive, up is positive."""
    above = ['"Test start","12.03.2026"', '"Rate 1","1.2","mm/min"', '"Results Table 1"', ""]
    columns = [test.time, -1e3 * test.drive, -test.force]
    content = text(
        ['"Time"', '"Extension"', '"Load"'], columns, above, units=['"(s)"', '"(mm)"', '"(N)"']
    )
    return content


def texture_analyser(test):
    above = ["Test ID: probe tack 3", "Trigger force 5 g"]
    return text(
        ["Force (g)", "Distance (mm)", "Time (sec)"],
        [test.force / 9.80665e-3, 1e3 * test.drive, test.time],
        above,
    )


def testxpert(test):
    """German headings and decimal commas, units below."""
    return text(
        ["Prüfzeit", "Standardkraft", "Standardweg"],
        [test.time, test.force, 1e3 * test.drive],
        separator=";",
        decimal=",",
        units=["s", "N", "mm"],
        encoding="latin-1",
    )


def nanoindenter(test):
    """Tabs, micronewtons in Latin-1, and the same words over volts."""
    return text(
        ["Depth (nm)", "Load (µN)", "Time (s)", "Depth (V)", "Load (V)"],
        [1e9 * test.drive, 1e6 * test.force, test.time, test.drive, test.force],
        ["Thu Oct 24 2024", "", f"Number of Points = {test.time.size}"],
        separator="\t",
        encoding="latin-1",
    )


TEXTS = {
    "plain": plain,
    "with camera": with_camera,
    "bluehill": bluehill,
    "texture analyser": texture_analyser,
    "testxpert": testxpert,
    "nanoindenter": nanoindenter,
}


def workbook(test, path):
    from openpyxl import Workbook

    book = Workbook()
    book.active.title = "Results"
    book.active.append(["Specimen", "Fmax"])
    sheet = book.create_sheet("Values Specimen 1")
    sheet.append(["Specimen 1"])
    sheet.append([])
    sheet.append(["Test time", "Standard force", "Standard travel"])
    sheet.append(["s", "N", "mm"])
    for row in zip(test.time, test.force, 1e3 * test.drive, strict=True):
        sheet.append([float(x) for x in row])
    book.save(path)


def even(test):
    """Return the parts of a test at equal steps of time, as microscopes write them."""
    edges = (0, *test.parts)
    parts = []
    for begin, end in zip(edges, edges[1:], strict=False):
        start = test.time[begin - 1] if begin else 0.0
        duration = float(test.time[end - 1] - start)
        time = start + duration * np.arange(1, end - begin + 1) / (end - begin)
        own = test.time[begin:end]
        parts.append(
            (
                duration,
                np.interp(time, own, test.drive[begin:end]),
                np.interp(time, own, test.force[begin:end]),
            )
        )
    return parts


STIFFNESS = 1e4  # N/m, of an invented cantilever


def jpk(test):
    """An archive: one segment for each part, whole numbers and conversions based on each other."""
    words = {
        "vDeflection": ("V", 1e-8, [("distance", "m", 1e-7), ("force", "N", STIFFNESS)]),
        "height": ("m", -1e-13, []),
    }
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr("header.properties", "force-scan-series.force-segments.count=3\n")
        for number, (duration, drive, force) in enumerate(even(test)):
            # the height grows away from the sample
            raw = {
                "vDeflection": np.round(force / (1e-8 * 1e-7 * STIFFNESS)),
                "height": np.round(drive / 1e-13),
            }
            lines = [
                f"force-segment-header.num-points={drive.size}",
                f"force-segment-header.duration={duration!r}",
                "channels.list=height vDeflection",
            ]
            for channel, (unit, multiplier, conversions) in words.items():
                lines += _channel(channel, unit, multiplier, conversions)
                content = raw[channel].astype(">i4").tobytes()
                archive.writestr(f"segments/{number}/channels/{channel}.dat", content)
            archive.writestr(f"segments/{number}/segment-header.properties", "\n".join(lines))
    return stream.getvalue()


def _channel(channel, unit, multiplier, conversions):
    key = f"channel.{channel}."
    slots = " ".join(slot for slot, _, _ in conversions)
    lines = [
        f"{key}type=integer-data",
        f"{key}encoder.type=signedinteger",
        f"{key}encoder.scaling.offset=0.0",
        f"{key}encoder.scaling.multiplier={multiplier!r}",
        f"{key}encoder.scaling.unit.unit={unit}",
        f"{key}conversion-set.conversions.list={slots}",
        f"{key}conversion-set.conversions.default={conversions[-1][0] if conversions else 'base'}",
        f"{key}conversion-set.conversions.base=base",
    ]
    before = "base"
    for slot, into, factor in conversions:
        own = f"{key}conversion-set.conversion.{slot}."
        lines += [
            f"{own}defined=true",
            f"{own}base-calibration-slot={before}",
            f"{own}scaling.offset=0.0",
            f"{own}scaling.multiplier={factor!r}",
            f"{own}scaling.unit.unit={into}",
        ]
        before = slot
    return lines


def nid(test):
    """Forward, held and backward curves of 32 bits, the last one from the same end as the first."""
    parts = even(test)
    frames = ("Spec forward", "Spec fwd pause", "Spec backward")
    span_force, span_height = 4 * np.abs(test.force).max(), 4 * np.abs(test.drive).max()
    index, sections, data = [], [], b""
    step = 0.01
    for i, (frame, (duration, drive, force)) in enumerate(zip(frames, parts, strict=True)):
        count = round(duration / step)
        time = duration * np.arange(1, count + 1) / count
        own = duration * np.arange(1, drive.size + 1) / drive.size
        for j, (channel, unit, span, values) in enumerate(
            (("Deflection", "N", span_force, force), ("Z-Axis Sensor", "m", span_height, drive))
        ):
            row = np.interp(time, own, values)
            row = row[::-1] if frame == "Spec backward" else row
            index.append(f"Gr{i}-Ch{j}=DataSet-{i}:{j}")
            sections += [
                f"[DataSet-{i}:{j}]", f"Points={count}", "Lines=1", f"Frame={frame}",
                f"Dim2Name={channel}", f"Dim2Unit={unit}", f"Dim2Range={span:.9e}",
                f"Dim2Min={-span / 2:.9e}", "SaveMode=Binary", "SaveBits=32", "SaveSign=Signed",
                "SaveOrder=Intel",
            ]  # fmt: skip
            data += np.round(row / span * 2.0**32).astype("<i4").tobytes()
    head = ["[DataSet]", "Version=2", *index, "[DataSet\\DataSetInfos\\Spec]",
            "Modulation time=10 s", "Data points=1000"]  # fmt: skip
    return ("\r\n".join([*head, *sections]) + "\r\n").encode("latin-1") + b"#!" + data


def ibw(test):
    """A wave of version 5 with three named columns and a note."""
    time = np.arange(test.time[0], test.time[-1], 0.02)
    force, drive = (np.interp(time, test.time, x) for x in (test.force, test.drive))
    columns = np.stack([drive, force / STIFFNESS, drive], axis=1)
    note = f"\rSpringConstant: {STIFFNESS}\rNumPtsPerSec: 50\rVelocity: 1\r".encode()
    names = b"".join(word.ljust(32, b"\0") for word in (b"", b"Raw", b"Defl", b"ZSnsr"))
    data = columns.astype("<f8").tobytes(order="F")
    head = struct.pack("<hHiiii4i4iiii", 5, 0, 320 + len(data), 0, len(note), 0, 0, 0, 0, 0,
                       0, len(names), 0, 0, 0, 0, 0)  # fmt: skip
    wave = bytearray(320)
    struct.pack_into("<ih", wave, 12, columns.size, 4)
    struct.pack_into("<4i", wave, 68, *columns.shape, 0, 0)
    return head + bytes(wave) + data + note + names


BINARIES = {"curve.jpk-force": jpk, "curve.nid": nid, "curve.ibw": ibw}
