"""Numbers of a picture in SI, read as a person does: by the ticks and the unit of the axis."""

import re

import numpy as np
import pytest

_FACTORS = {"n": 1e-9, "µ": 1e-6, "m": 1e-3, "k": 1e3, "M": 1e6}


def in_si(axis, values):
    """Return drawn values in SI; ticks must be plain numbers at the places that they state."""
    axis.axes.figure.draw_without_rendering()
    words = re.search(r"\[(.+)\]$", axis.get_label_text())
    assert words, axis.get_label_text()
    unit = words[1]
    ticks = [tick for tick in axis.get_major_ticks() if tick.label1.get_text()]
    assert ticks
    for tick in ticks:
        stated = float(tick.label1.get_text().replace("−", "-"))
        assert stated == pytest.approx(tick.get_loc(), rel=1e-6, abs=1e-12)
    plain = unit in ("m", "m/s", "N", "s", "Pa")
    return np.asarray(values) * (1.0 if plain else _FACTORS[unit[0]])
