"""Statistics of maps and their files against SurfaceTopography (MIT), an independent code.

Left out where it is not installed: `pip install -e ".[peers]"`.
"""

import numpy as np
import pytest

from viscotack.errors import InputError
from viscotack.model.surfaces import read_map, roughness, self_affine

reason = "SurfaceTopography of ContactEngineering is not installed"
peer = pytest.importorskip("SurfaceTopography", reason=reason)

# It calls functions of its own that it has deprecated.
pytestmark = pytest.mark.filterwarnings("ignore:Function/property:DeprecationWarning")

ROUND_OFF = 1e-10


def both(periodic, shortest=8e-6):
    """Return a map, and the same for the peer, without mean and tilt."""
    found = self_affine(
        96, 1e-6, hurst=0.7, rms_height=2e-7, seed=5, shortest=shortest, periodic=periodic
    )
    if not periodic:
        found = found.levelled()
    return found, peer.Topography(found.heights, found.size, periodic=periodic, unit="m")


@pytest.mark.parametrize("periodic", [True, False])
def test_rms_height_and_curvature_are_those_of_the_peer(periodic):
    surface, theirs = both(periodic)
    found = roughness(surface)
    assert found.rms_height == pytest.approx(theirs.rms_height_from_area(), rel=ROUND_OFF)
    assert found.rms_curvature == pytest.approx(theirs.rms_curvature_from_area(), rel=ROUND_OFF)


def test_the_rms_slope_is_that_of_the_peer():
    surface, theirs = both(True)
    assert roughness(surface).rms_slope == pytest.approx(theirs.rms_gradient(), rel=ROUND_OFF)
    # without neighbours the peer leaves out the differences along two sides
    surface, theirs = both(False)
    assert roughness(surface).rms_slope == pytest.approx(theirs.rms_gradient(), rel=4 / 96)


def test_the_spectrum_is_that_of_the_peer():
    surface, theirs = both(True)
    *_, C = theirs.power_spectrum_from_area(return_map=True, reliable=False)
    q = 2 * np.pi * np.fft.fftfreq(96, 1e-6)
    ring = np.rint(np.hypot(q[:, None], q) / (2 * np.pi / 96e-6))
    mean = [C[ring == n].mean() for n in range(1, 13)]
    assert roughness(surface).spectrum[:12] == pytest.approx(mean, rel=ROUND_OFF)


@pytest.mark.parametrize("ending", ["gwy", "x3p", "nc"])
def test_files_that_the_peer_writes_are_read(tmp_path, ending):
    surface, _ = both(False)
    micro = peer.Topography(
        surface.heights * 1e6, tuple(1e6 * side for side in surface.size), unit="µm"
    )
    path = tmp_path / f"map.{ending}"
    {"gwy": micro.to_gwy, "x3p": micro.to_x3p, "nc": micro.to_netcdf}[ending](str(path))
    found = read_map(path)
    assert found.pixel == pytest.approx(1e-6, rel=1e-9)
    assert found.heights == pytest.approx(surface.heights, rel=1e-6, abs=1e-13)
    with pytest.raises(InputError, match="leave pixel out"):
        read_map(path, pixel=1e-6)
    with pytest.raises(InputError, match="leave height_unit out"):
        read_map(path, unit=1e-6)
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(InputError, match="cannot read it"):
        read_map(path)
