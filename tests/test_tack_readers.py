"""Files of tack tests: every layout gives the same test, in SI, or is refused with the cause."""

import sys
from types import SimpleNamespace

import numpy as np
import pytest

import tack_files
from viscotack.errors import InputError
from viscotack.lab import tack

WHOLE = tack_files.made()
PLAIN = tack_files.plain(WHOLE)


def read(tmp_path, content, name="test.csv", **said):
    path = tmp_path / name
    path.write_bytes(content)
    return tack.read(path, **said)


@pytest.mark.parametrize("name", [*tack_files.TEXTS, "workbook"])
def test_every_text_layout_gives_the_same_test(name):
    path = tack_files.TEXTS.get(name, tack_files.LAYOUTS / "workbook.xlsx")
    if name == "workbook":
        pytest.importorskip("openpyxl")
    (record,) = tack.read(path)
    assert record.time == pytest.approx(WHOLE.time[::10], rel=1e-6)
    sign = -1 if name == "bluehill" else 1
    assert sign * record.force == pytest.approx(WHOLE.force[::10], rel=1e-6)
    assert sign * record.position == pytest.approx(WHOLE.drive[::10], rel=1e-6)
    assert record.into == (name == "nanoindenter")
    assert record.source.format == ("workbook" if name == "workbook" else "text")


def test_a_contact_radius_is_read_where_there_is_one(tmp_path):
    (record,) = read(tmp_path, tack_files.with_camera(WHOLE))
    assert record.contact_radius == pytest.approx(WHOLE.contact_radius, rel=1e-6)
    area = tack_files.with_camera(WHOLE).replace(b"Contact radius [um]", b"Contact area [um^2]")
    (other,) = read(tmp_path, area)
    assert other.contact_radius == pytest.approx(
        1e-3 * np.sqrt(WHOLE.contact_radius / np.pi), rel=1e-6
    )


def test_intervals_in_files_of_their_own_are_one_test(tmp_path):
    # numbered so that the order of names is not that of the intervals
    paths = []
    for number, content in zip((9, 10, 11), tack_files.anton_paar(WHOLE), strict=True):
        paths.append(tmp_path / f"probe_Interval_{number}.csv")
        paths[-1].write_bytes(content)
    (tmp_path / "probe_Interval_12.csv").write_bytes(b"")
    (record,) = tack.read([*reversed(paths), tmp_path / "probe_Interval_12.csv"])
    assert record.time == pytest.approx(WHOLE.time, rel=1e-6)
    assert record.into == -1
    assert "interval 12 is empty" in record.source.notes
    (only,) = tack.read(paths[:1])
    with pytest.raises(InputError, match="retraction.*all intervals"):
        tack.evaluate(only)


@pytest.mark.parametrize("name", tack_files.BINARIES)
def test_every_microscope_gives_the_same_test(name):
    (record,) = tack.read(tack_files.BINARIES[name])
    assert record.source.format == name.partition(".")[2]
    (cycle,) = tack.evaluate(record, compliance=0.0).cycles
    assert cycle.pull_off_force.value == pytest.approx(-WHOLE.force.min(), rel=2e-3)
    assert cycle.speed.value == pytest.approx(tack_files.SPEED, rel=5e-3)
    assert cycle.dwell_time == pytest.approx(tack_files.DWELL, rel=0.02)


def test_a_cantilever_that_the_file_names_bends():
    (record,) = tack.read(tack_files.BINARIES["curve.jpk-force"])
    assert record.compliance == pytest.approx(1 / tack_files.STIFFNESS)
    (bent,), (stiff,) = tack.evaluate(record).cycles, tack.evaluate(record, compliance=0).cycles
    force = bent.pull_off_force.value
    shift = bent.depth_at_pull_off.value - stiff.depth_at_pull_off.value
    assert shift == pytest.approx(force / tack_files.STIFFNESS, rel=1e-2)


REFUSED = {
    "no unit": (PLAIN.replace(b"[mN]", b""), "`force_unit`"),
    "two forces": (PLAIN.replace(b"Time [s]", b"Load [N]"), "`force_column`"),
    "a cell lost": (PLAIN.replace(b",-199.5591,0", b",-199.5591"), "line 3: 2 cells under"),
    "time goes back": (
        b"\r\n".join([PLAIN.split(b"\r\n")[0], *PLAIN.split(b"\r\n")[300:], PLAIN.split(b"\r\n")[9],
                      b""]),
        "time must increase",
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_a_file_that_leaves_something_open_is_refused_with_what_to_do(what, tmp_path):
    content, words = REFUSED[what]
    assert content != PLAIN
    with pytest.raises(InputError) as error:
        read(tmp_path, content)
    assert words in str(error.value)
    assert "test.csv" in str(error.value)


def test_values_missing_from_a_file_can_be_given(tmp_path):
    bare = PLAIN.replace(b"[mN]", b"").replace(b"[um]", b"").replace(b"[s]", b"")
    units = {"force_unit": "mN", "length_unit": "um", "time_unit": "s"}
    (record,) = read(tmp_path, bare, **units)
    assert record.force == pytest.approx(WHOLE.force, rel=1e-6)
    (named,) = read(
        tmp_path, PLAIN.replace(b"Force [mN]", b"Signal 3"), force_column="Signal 3",
        position_column="depth [um]", force_unit="mN",
    )  # fmt: skip
    assert named.force == pytest.approx(WHOLE.force, rel=1e-6)
    (timed,) = read(tmp_path, PLAIN.replace(b"Time [s]", b"Number"), nominal_speed=1e-5)
    assert np.ptp(timed.time) == pytest.approx(np.sum(np.abs(np.diff(WHOLE.drive))) / 1e-5)
    with pytest.raises(InputError, match="`format` must be one of"):
        read(tmp_path, PLAIN, format="csv")


def test_a_microscope_that_was_not_calibrated_is_refused(tmp_path):
    wave, nid = (tack_files.BINARIES[f"curve.{end}"].read_bytes() for end in ("ibw", "nid"))
    content = wave.replace(b"SpringConstant", b"SpringConstanT")
    with pytest.raises(InputError, match="SpringConstant"):
        read(tmp_path, content, "curve.ibw")
    with pytest.raises(InputError, match="curve.nid"):
        read(tmp_path, nid[:-100], "curve.nid")


class Curve(dict):
    """A curve as afmformats has it: columns by name, metadata, its number in the file."""

    columns = property(lambda self: list(self))

    def __init__(self, test, enum, **metadata):
        super().__init__(force=test.force, time=test.time)
        self["height (measured)"] = -test.drive
        self.enum, self.metadata = enum, metadata


def stand_in(monkeypatch, load_data):
    monkeypatch.setitem(sys.modules, "afmformats", SimpleNamespace(load_data=load_data))


def test_a_map_is_read_by_afmformats_curve_by_curve(tmp_path, monkeypatch):
    def load_data(path):
        assert path == str(tmp_path / "map.jpk-force-map")
        bent, bare = {"spring constant": 1e4}, {"spring constant": float("nan")}
        return [Curve(WHOLE, 7, **bent), Curve(WHOLE, 8, **bare)]

    stand_in(monkeypatch, load_data)
    packed = tack_files.BINARIES["curve.jpk-force"].read_bytes()
    first, second = read(tmp_path, packed, "map.jpk-force-map")
    assert np.array_equal(first.force, WHOLE.force) and np.array_equal(first.time, WHOLE.time)
    assert (first.into, first.compliance, second.compliance) == (-1, 1e-4, 0.0)
    assert first.source.format == "afmformats" and "curve 7" in first.source.notes[0]
    (cycle,) = tack.evaluate(second).cycles
    # the minimum lies between two points
    assert cycle.pull_off_force.value == pytest.approx(-WHOLE.force.min(), rel=5e-4)
