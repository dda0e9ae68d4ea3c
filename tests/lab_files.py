"""Small files in the formats of laboratories, all of the same invented measurement.

Three sweeps of four frequencies, E' and E'' in MPa. The layouts follow the instruments' exports;
names and numbers are made up. A file is named after its format.
"""

from pathlib import Path

import numpy as np
from numpy.testing import assert_allclose

LAYOUTS = Path(__file__).parent / "data" / "layouts" / "material"
CELSIUS = (-40.0, -30.0, -20.0)
HERTZ = (0.1, 1.0, 10.0, 100.0)
STORAGE = np.array([[812.4, 905.1, 1004.7, 1101.9], [301.2, 402.5, 508.8, 640.3],
                    [52.17, 88.04, 151.6, 240.9]])  # fmt: skip
LOSS = np.array([[122.6, 118.3, 109.9, 96.21], [140.8, 151.3, 158.2, 150.4],
                 [18.44, 36.91, 64.05, 98.73]])  # fmt: skip

# what every reader must find
TEMPERATURE = np.repeat(np.array(CELSIUS) + 273.15, len(HERTZ))
OMEGA = np.tile(2 * np.pi * np.array(HERTZ), len(CELSIUS))
PASCAL = STORAGE.ravel() * 1e6, LOSS.ravel() * 1e6

# one temperature, shear, in rad/s and Pa; the rheometer's own headings above shorter rows
REPTATE, RHEOMETER = ((LAYOUTS / f"reptate{more}.osc").read_bytes() for more in ("", "_rheometer"))
TEXTS = {
    path.stem: path.read_bytes()
    for path in sorted(LAYOUTS.iterdir())
    if path.suffix in (".csv", ".txt", ".json")
}


def assert_the_film(sweeps, kind="E"):
    """Compare sweeps with what every reader must find."""
    assert sweeps.kind == kind
    assert_allclose(sweeps.temperature, TEMPERATURE, rtol=1e-14)
    assert_allclose(sweeps.angular_frequency, OMEGA, rtol=1e-10)
    assert_allclose(sweeps.storage, PASCAL[0], rtol=1e-10)
    assert_allclose(sweeps.loss, PASCAL[1], rtol=1e-10)
    assert_allclose(sweeps.complex_modulus.imag, PASCAL[1], rtol=1e-10)
    assert sweeps.sweep.tolist() == [0] * 4 + [1] * 4 + [2] * 4


def notes(test):
    return "; ".join(test.source.notes)
