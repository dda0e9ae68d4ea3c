"""Numbers of a picture in SI, read as a person does: by the ticks and the unit of the axis."""

import re

import numpy as np
import pytest

_FACTORS = {"n": 1e-9, "µ": 1e-6, "m": 1e-3, "k": 1e3, "M": 1e6}


def in_si(axis, values):
    """Return drawn values in SI; ticks must be numbers in proportion to their places."""
    axis.axes.figure.draw_without_rendering()
    words = re.search(r"\[(.+)\]$", axis.get_label_text())
    assert words, axis.get_label_text()
    unit = words[1]
    factor = 1.0 if unit in ("m", "m/s", "N", "s", "Pa") else _FACTORS[unit[0]]
    ticks = [tick for tick in axis.get_major_ticks() if tick.label1.get_text()]
    stated = [factor * float(tick.label1.get_text().replace("−", "-")) for tick in ticks]
    places = [tick.get_loc() for tick in ticks]
    largest = int(np.argmax(np.abs(places)))
    scale = stated[largest] / places[largest]
    assert stated == pytest.approx([scale * x for x in places], rel=1e-5, abs=1e-12 * scale)
    return scale * np.asarray(values)
